//! Values as presets write them.

use crate::color::to_hex;
use crate::param::{ParamKind, Value};
use crate::texture::Texture;
use crate::variation::Variation;
use std::fmt::Write as _;

/// A value as a preset writes it for a parameter of this kind: what is read from that is the value again, but of a colour
/// the nearest that has six digits, and of -0 the number 0.
///
/// Numbers have the fewest digits that give the same `f32`, without an exponent. What the kind doesn't take
/// ([`ParamKind::takes`]) is written as it is, and refused where it is read; so is a text of no characters, or none, which a
/// preset says by leaving the field out.
#[must_use]
pub fn written(value: &Value, kind: &ParamKind) -> String {
    match (value, kind) {
        (Value::Number(value), _) => number(*value),
        (Value::Varying(variation), _) => written_variation(variation),
        (Value::Integer(value), _) => value.to_string(),
        (Value::Flag(value), _) => value.to_string(),
        (Value::Choice(index), ParamKind::Choice { names, .. }) => match names.get(*index as usize)
        {
            Some(name) => (*name).to_owned(),
            None => index.to_string(),
        },
        (Value::Choice(index), _) => index.to_string(),
        (Value::Color(None), _) => "none".to_owned(),
        (Value::Color(Some(color)), _)
        | (Value::Triple(color), ParamKind::Color { .. } | ParamKind::OptionalColor { .. }) => {
            format!("\"{}\"", to_hex(*color))
        }
        (Value::Texture(Texture::None), _) => "none".to_owned(),
        (Value::Texture(Texture::Ramp(ramp)), _) => ramp.written(),
        (Value::Texture(Texture::File(file) | Texture::Image { file, .. }), _) => quoted(file),
        (Value::Text(value), _) => quoted(value.as_deref().unwrap_or_default()),
        (Value::Triple(values), _) => in_brackets(values.iter().map(|value| number(*value))),
        (Value::Pair(values), _) => in_brackets(values.iter().map(|value| number(*value))),
        (Value::Size(values), _) => in_brackets(values.iter().map(u32::to_string)),
    }
}

fn number(value: f32) -> String {
    // Nobody means -0.
    if value == 0.0 {
        return "0".to_owned();
    }
    value.to_string()
}

fn in_brackets(values: impl Iterator<Item = String>) -> String {
    format!("({})", values.collect::<Vec<_>>().join(", "))
}

fn written_variation(variation: &Variation) -> String {
    let mut written = match variation.curve[..] {
        // As it is read: a value is one place at the root.
        [(0.0, value)] => format!("(value: {}", number(value)),
        ref curve => {
            let points = curve
                .iter()
                .map(|(place, value)| format!("({}, {})", number(*place), number(*value)));
            let points = points.collect::<Vec<_>>().join(", ");
            format!("(curve: [{points}]")
        }
    };
    if variation.vary != 0.0 {
        written += &format!(", vary: {}", number(variation.vary));
    }
    written + ")"
}

/// A text in quotes, on one line.
fn quoted(text: &str) -> String {
    let mut quoted = String::from("\"");
    for c in text.chars() {
        match c {
            '"' => quoted += "\\\"",
            '\\' => quoted += "\\\\",
            '\n' => quoted += "\\n",
            '\r' => quoted += "\\r",
            '\t' => quoted += "\\t",
            // A String takes all that is written to it.
            c if c.is_control() => drop(write!(quoted, "\\u{{{:x}}}", c as u32)),
            c => quoted.push(c),
        }
    }
    quoted + "\""
}
