//! One value from its text, or what is wrong with it and what would be right.

use super::error::suggestion;
use crate::color::parse_hex;
use crate::param::{ParamKind, Value};
use crate::texture::{Ramp, Texture};
use crate::variation::Variation;
use std::sync::Arc;

/// The value that `text`, as it stands in a preset, gives a parameter of this kind.
///
/// # Errors
///
/// What is wrong with the text, and what would be right.
///
/// ```
/// use effects::{ParamKind, Value, preset::read_value};
///
/// let kind = ParamKind::Pair { min: -9.0, max: 9.0, default: [0.0; 2] };
/// assert_eq!(read_value("(1, 2.5)", &kind), Ok(Value::Pair([1.0, 2.5])));
/// assert_eq!(
///     read_value("(1, 20)", &kind),
///     Err("expected two numbers (x, y), each from -9 to 9, found `(1, 20)`".to_owned())
/// );
/// ```
pub fn read_value(text: &str, kind: &ParamKind) -> Result<Value, String> {
    parse_value(text, kind)
}

/// The value that `text` gives a parameter of this kind.
pub(crate) fn parse_value(text: &str, kind: &ParamKind) -> Result<Value, String> {
    read(text, kind).ok_or_else(|| match names_of(kind) {
        Some(names) => {
            let bare = unquoted(text);
            match hint(text, kind) {
                Some(hint) => format!("found `{}`: {hint}", shown(text)),
                None => {
                    let hint = suggestion(bare, names.iter().copied());
                    format!("there is no `{}`{hint}", shown(bare))
                }
            }
        }
        None => {
            let hint = hint(text, kind).map_or(String::new(), |hint| format!(": {hint}"));
            format!(
                "expected {}, found `{}`{hint}",
                kind.expected(),
                shown(text)
            )
        }
    })
}

/// The names that a kind of choice has.
fn names_of(kind: &ParamKind) -> Option<&'static [&'static str]> {
    match *kind {
        ParamKind::Choice { names, .. } => Some(names),
        ParamKind::Flag { .. } => Some(&["false", "true"]),
        _ => None,
    }
}

fn read(text: &str, kind: &ParamKind) -> Option<Value> {
    match *kind {
        ParamKind::Number {
            min,
            max,
            varies: true,
            ..
        } if text.starts_with('(') => {
            let variation = Variation::parse(text, min, max).ok()?;
            Some(Value::Varying(variation))
        }
        ParamKind::Number { min, max, .. } => {
            let number = ron::from_str::<f32>(text).ok()?;
            (number >= min && number <= max).then_some(Value::Number(number))
        }
        ParamKind::Integer { min, max, .. } => {
            let number = ron::from_str::<i32>(text).ok()?;
            (number >= min && number <= max).then_some(Value::Integer(number))
        }
        ParamKind::Choice { names, .. } => {
            let index = names.iter().position(|name| *name == text)?;
            Some(Value::Choice(index as u32))
        }
        ParamKind::Flag { .. } => text.parse().ok().map(Value::Flag),
        ParamKind::OptionalColor { .. } if text == "none" => Some(Value::Color(None)),
        ParamKind::Color { .. } | ParamKind::OptionalColor { .. } => {
            let hex = ron::from_str::<String>(text).ok()?;
            Some(Value::Color(Some(parse_hex(&hex)?)))
        }
        ParamKind::Texture { .. } if text == "none" => Some(Value::Texture(Texture::None)),
        ParamKind::Texture { .. } if text.starts_with('"') => {
            let file = ron::from_str::<String>(text).ok()?;
            (!file.is_empty()).then_some(Value::Texture(Texture::File(file)))
        }
        ParamKind::Texture { .. } => {
            let ramp = Ramp::parse(text).ok()?;
            Some(Value::Texture(Texture::Ramp(Arc::new(ramp))))
        }
        ParamKind::Text => {
            let text = ron::from_str::<String>(text).ok()?;
            (!text.is_empty()).then_some(Value::Text(Some(text)))
        }
        ParamKind::Triple { min, max, .. } => {
            let triple = ron::from_str::<[f32; 3]>(text).ok()?;
            let legal = triple.iter().all(|x| *x >= min && *x <= max);
            legal.then_some(Value::Triple(triple))
        }
        ParamKind::Pair { min, max, .. } => {
            let pair = ron::from_str::<[f32; 2]>(text).ok()?;
            let legal = pair.iter().all(|x| *x >= min && *x <= max);
            legal.then_some(Value::Pair(pair))
        }
        ParamKind::Size { min, max, .. } => {
            let size = ron::from_str::<[u32; 2]>(text).ok()?;
            let legal = size.iter().all(|x| *x >= min && *x <= max);
            legal.then_some(Value::Size(size))
        }
    }
}

/// A value as a message shows it: on one line, and not too much of it.
pub(super) fn shown(text: &str) -> String {
    let mut shown: String = text
        .chars()
        .take(40)
        .map(|c| if c.is_control() { ' ' } else { c })
        .collect();
    if text.chars().nth(40).is_some() {
        shown.push_str("...");
    }
    shown
}

/// The text without quotes of any sort around it.
fn unquoted(text: &str) -> &str {
    text.trim_matches(['"', '\'', '“', '”', '„', '‘', '’', '«', '»'])
}

/// What an author who wrote this may have meant.
fn hint(text: &str, kind: &ParamKind) -> Option<String> {
    let bare = unquoted(text);
    let in_quotes = bare.len() < text.len();
    let double_quotes = in_quotes && text.starts_with('"');
    match *kind {
        ParamKind::Number {
            min,
            max,
            varies: true,
            ..
        } if text.starts_with('(') => Variation::parse(text, min, max).err().map(|message| {
            format!("{message}; write 2, (value: 2, vary: 0.2) or (curve: [(0, 1), (1, 2)])")
        }),
        ParamKind::Number { .. } | ParamKind::Integer { .. } => {
            if in_quotes && read(bare, kind).is_some() {
                return Some(format!("write {bare}, without quotes"));
            }
            let number = number_at_start(text)?;
            read(number, kind).map(|_| format!("write {number} alone"))
        }
        ParamKind::Choice { .. } | ParamKind::Flag { .. } => {
            let is_name = names_of(kind).is_some_and(|names| names.contains(&bare));
            (in_quotes && is_name).then(|| format!("write {bare}, without quotes"))
        }
        ParamKind::Color { .. } | ParamKind::OptionalColor { .. } => {
            let optional = matches!(kind, ParamKind::OptionalColor { .. });
            if ["none", "null", "transparent"].contains(&bare.to_lowercase().as_str()) {
                return Some(if optional {
                    "write none, in lower case and without quotes".to_owned()
                } else {
                    "there must be a colour here".to_owned()
                });
            }
            if !double_quotes && parse_hex(bare).is_some() {
                return Some(format!("write \"{bare}\", in double quotes"));
            }
            Some("a colour is six hexadecimal digits RRGGBB in double quotes".to_owned())
        }
        ParamKind::Texture { .. } if text.starts_with(['(', '[']) => {
            let write = "write [(0, \"2A8F9D\"), (1, \"3FC1C0\")], (steps: [..]), or rows [(v: 0, stops: [..]), ..]";
            let message = Ramp::parse(text).err()?;
            Some(format!("{message}; {write}"))
        }
        ParamKind::Texture { .. } if bare.to_lowercase() == "none" => {
            Some("write none, in lower case and without quotes".to_owned())
        }
        ParamKind::Text | ParamKind::Texture { .. } if double_quotes && bare.is_empty() => {
            Some("it is empty".to_owned())
        }
        ParamKind::Text | ParamKind::Texture { .. } if double_quotes && text.contains('\\') => {
            Some("write / for each \\ in it".to_owned())
        }
        ParamKind::Text if text.starts_with(['(', '[', '{']) => None,
        ParamKind::Text | ParamKind::Texture { .. } => Some(format!("write \"{}\"", shown(bare))),
        ParamKind::Triple { .. } | ParamKind::Pair { .. } | ParamKind::Size { .. } => {
            if text.starts_with(['[', '{']) {
                return Some("write it in ( )".to_owned());
            }
            let (w, h) = bare.split_once(['x', 'X'])?;
            let pair = format!("({}, {})", w.trim(), h.trim());
            read(&pair, kind).map(|_| format!("write {pair}"))
        }
    }
}

/// The number that `45deg` or `50%` begins with.
fn number_at_start(text: &str) -> Option<&str> {
    let end = text.find(|c: char| !(c.is_ascii_digit() || "+-.".contains(c)))?;
    let (number, unit) = text.split_at(end);
    let is_unit = unit.chars().all(|c| c.is_alphabetic() || "°%".contains(c));
    (is_unit && number.ends_with(|c: char| c.is_ascii_digit())).then_some(number)
}
