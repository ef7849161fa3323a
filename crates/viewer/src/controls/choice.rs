//! Flags and choices.

use super::row::Row;
use eframe::egui::{Checkbox, ComboBox, Response, Ui};

/// A check box. Gives what it was changed to.
pub(super) fn flag(ui: &mut Ui, row: &Row, value: bool) -> (Response, Option<bool>) {
    let mut new = value;
    let response = ui.add(Checkbox::without_text(&mut new));
    let response = response.accessible_name(&row.name);
    (response, (new != value).then_some(new))
}

/// A list of names. Gives the number of the one that was chosen.
pub(super) fn choice(
    ui: &mut Ui,
    row: &Row,
    names: &[&str],
    value: usize,
    width: f32,
) -> (Response, Option<usize>) {
    let mut chosen = None;
    let shown = names.get(value).copied().unwrap_or_default();
    let list = ComboBox::from_id_salt("choice")
        .width(width)
        .truncate()
        .selected_text(shown);
    let response = list.show_ui(ui, |ui| {
        for (index, name) in names.iter().enumerate() {
            if ui.selectable_label(index == value, *name).clicked() && index != value {
                chosen = Some(index);
            }
        }
    });
    (response.response.accessible_name(&row.name), chosen)
}
