//! Short notes below a control, such as that a number was too large.

use eframe::egui::{Id, RichText, Ui};

/// How long a note stays, in seconds.
const STAYS: f64 = 6.0;

/// A note, and until when it is shown.
#[derive(Clone)]
struct Note {
    text: String,
    until: f64,
}

/// Leaves a note at `id`, in place of the one that is there.
pub(super) fn leave(ui: &Ui, id: Id, text: impl Into<String>) {
    let until = ui.input(|input| input.time) + STAYS;
    let text = text.into();
    ui.data_mut(|data| data.insert_temp(id.with("note"), Note { text, until }));
}

/// Shows the note at `id`, if there is one.
pub(super) fn show(ui: &mut Ui, id: Id) {
    let id = id.with("note");
    let Some(note) = ui.data(|data| data.get_temp::<Note>(id)) else {
        return;
    };
    let left = note.until - ui.input(|input| input.time);
    if left <= 0.0 {
        ui.data_mut(|data| data.remove::<Note>(id));
        return;
    }
    let color = ui.visuals().warn_fg_color;
    ui.label(RichText::new(note.text).small().color(color));
    let left = std::time::Duration::from_secs_f64(left);
    ui.request_repaint_after(left);
}
