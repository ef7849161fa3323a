//! Colours: their six digits are what is shown, changed and written, so that none changes by being looked at.

use super::row::Row;
use super::text::text_line;
use eframe::egui::{Checkbox, Response, Ui};

/// Width of a field for six digits.
const DIGITS: f32 = 64.0;
/// Width of a colour's button.
const BUTTON: f32 = 26.0;
/// The least width that the word `none` has room in.
const ROOM_FOR_NONE: f32 = 160.0;

/// A button with a colour's picker, and its digits beside it. Gives the digits that were chosen.
pub(super) fn color(ui: &mut Ui, row: &Row, hex: &str) -> (Response, Option<String>) {
    let before = bytes(hex).unwrap_or_default();
    let mut picked = before;
    ui.spacing_mut().item_spacing.x = 4.0;
    ui.spacing_mut().interact_size.x = BUTTON;
    let button = ui.color_edit_button_srgb(&mut picked);
    let button = button.accessible_name(&row.name);
    let mut chosen = (picked != before).then(|| digits(picked));
    if let Some(typed) = text_line(ui, row, "hex", hex, DIGITS, None) {
        match bytes(&typed) {
            Some(bytes) => chosen = Some(digits(bytes)),
            None => row.note(
                ui,
                format!("`{typed:.20}` is no colour: it has six hexadecimal digits RRGGBB"),
            ),
        }
    }
    (button, chosen)
}

/// What was chosen for a colour that may be none.
pub(super) enum Chosen {
    None,
    Color(String),
}

/// The same with a check box for none. `otherwise` is the colour where none was before.
pub(super) fn optional_color(
    ui: &mut Ui,
    row: &Row,
    hex: Option<&str>,
    otherwise: &str,
    width: f32,
) -> (Response, Option<Chosen>) {
    let last = row.id.with("last colour");
    let mut chosen = None;
    let mut shown = None;
    if let Some(hex) = hex {
        ui.data_mut(|data| data.insert_temp(last, hex.to_owned()));
        let (response, picked) = color(ui, row, hex);
        shown = Some(response);
        chosen = picked.map(Chosen::Color);
    }
    let mut is_none = hex.is_none();
    let has_room = is_none || width >= ROOM_FOR_NONE;
    let word = if has_room { "none" } else { "" };
    let response = ui.add(Checkbox::new(&mut is_none, word));
    let response = response
        .on_hover_text("No colour")
        .accessible_name(row.part("none"));
    if is_none != hex.is_none() {
        chosen = Some(if is_none {
            Chosen::None
        } else {
            let last = ui.data(|data| data.get_temp::<String>(last));
            Chosen::Color(last.unwrap_or_else(|| otherwise.to_owned()))
        });
    }
    (shown.unwrap_or(response), chosen)
}

/// The bytes of `3FC1C0`, `#3fc1c0` or `#3cc`.
fn bytes(hex: &str) -> Option<[u8; 3]> {
    let hex = hex.trim().trim_start_matches('#');
    if !hex.bytes().all(|b| b.is_ascii_hexdigit()) {
        return None;
    }
    let byte = |digits: &str| u8::from_str_radix(digits, 16).ok();
    match hex.len() {
        6 => Some([byte(&hex[0..2])?, byte(&hex[2..4])?, byte(&hex[4..6])?]),
        3 => {
            let twice = |i: usize| byte(&hex[i..=i].repeat(2));
            Some([twice(0)?, twice(1)?, twice(2)?])
        }
        _ => None,
    }
}

fn digits([red, green, blue]: [u8; 3]) -> String {
    format!("{red:02X}{green:02X}{blue:02X}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits_stay_what_they_are() {
        for (text, expected) in [
            ("3FC1C0", Some("3FC1C0")),
            (" #3fc1c0", Some("3FC1C0")),
            ("3cc", Some("33CCCC")),
            ("3FC1C", None),
            ("éé", None),
            ("red", None),
        ] {
            let found = bytes(text).map(digits);
            assert_eq!(found.as_deref(), expected, "{text}");
        }
    }
}
