//! Lines of text.

use super::row::Row;
use effects::preset::edit::{self, Step};
use eframe::egui::{Color32, Key, TextEdit, Ui};

/// What is being typed, and the text that it began with.
#[derive(Clone)]
struct Typing {
    typed: String,
    of: String,
}

/// A line of text, handed over when Enter is pressed or the focus goes elsewhere. Escape takes back what was typed.
pub(crate) fn text_line(
    ui: &mut Ui,
    row: &Row,
    part: &str,
    text: &str,
    width: f32,
    color: Option<Color32>,
) -> Option<String> {
    let name = if part.is_empty() {
        row.name.clone()
    } else {
        row.part(part)
    };
    let id = row.id.with(("text", part));
    let typing = ui.data(|data| data.get_temp::<Typing>(id));
    // What was changed elsewhere in the meantime counts.
    let typing = typing.filter(|typing| typing.of == text);
    let mut typed = typing.map_or_else(|| text.to_owned(), |typing| typing.typed);

    let line = TextEdit::singleline(&mut typed)
        .id(id)
        .desired_width(width)
        .text_color_opt(color);
    let response = ui.add(line).accessible_name(name);

    if response.has_focus() {
        let of = text.to_owned();
        ui.data_mut(|data| data.insert_temp(id, Typing { typed, of }));
        return None;
    }
    ui.data_mut(|data| data.remove::<Typing>(id));
    let is_taken_back = ui.input(|input| input.key_pressed(Key::Escape));
    let is_done = response.lost_focus() || response.changed();
    (is_done && !is_taken_back && typed != text).then_some(typed)
}

/// Whether a text can stand where a value stands, whatever it means.
pub(crate) fn is_one_value(text: &str) -> bool {
    edit::set("(a: 0)", &[Step::Field("a")], text).is_ok()
}
