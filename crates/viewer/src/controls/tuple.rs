//! Several numbers that belong together.

use super::number::{NumberField, drag_value};
use super::row::Row;
use eframe::egui::{Response, Ui};

/// A field for each number, of these names. Gives all of them where one was changed.
pub(super) fn tuple<const N: usize>(
    ui: &mut Ui,
    row: &Row,
    field: &NumberField,
    names: [&str; N],
    values: [f64; N],
    width: f32,
) -> (Option<Response>, Option<[f64; N]>) {
    let gap = 3.0;
    ui.spacing_mut().item_spacing.x = gap;
    let width = (width - gap * (N as f32 - 1.0)) / N as f32;
    let [min, max] = field.range;
    let mut new = values;
    let mut first = None;
    for (i, name) in names.into_iter().enumerate() {
        // Units of two or three numbers would not fit.
        let field = NumberField {
            unit: if field.unit == "degrees" {
                "degrees"
            } else {
                ""
            },
            ..*field
        };
        let speed = match field.is_whole {
            true => 1.0,
            false if field.unit == "degrees" => 0.5,
            false => (values[i].abs() / 100.0)
                .max(0.005)
                .min((max - min) / 300.0),
        };
        let (response, number) = drag_value(ui, row, name, &field, values[i], speed, width);
        new[i] = number.unwrap_or(values[i]);
        first = first.or(Some(response));
    }
    (first, (new != values).then_some(new))
}
