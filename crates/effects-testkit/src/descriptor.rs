//! What an effect says of itself, in lists, messages and the parser.

use crate::values::{defaults, extreme_values, text};
use effects::preset::{LAYER, read_value};
use effects::{AnyEffect, Param, ParamKind, Values, parse_hex};
use std::collections::BTreeSet;

/// `inkstrand effects` shows it in one line.
pub(crate) fn words(effect: &dyn AnyEffect) -> Result<(), String> {
    let doc = effect.doc();
    if doc.trim().is_empty() {
        return Err("DOC is empty: say in one line what it draws".to_owned());
    }
    if doc.contains('\n') {
        return Err("DOC has several lines: lists of effects show one".to_owned());
    }
    Ok(())
}

/// A preset's layer may say the same of rank, depth offset and reach; and decals can be drawn.
pub(crate) fn order(effect: &dyn AnyEffect) -> Result<(), String> {
    let (rank, depth_offset) = (effect.rank() as f32, effect.depth_offset());
    let own = [
        ("rank", rank),
        ("depth_offset", depth_offset),
        ("reach", effect.clip_reach()),
    ];
    for (name, value) in own {
        let kind = LAYER.iter().find(|p| p.name == name).map(|p| p.kind);
        let (min, max) = match kind {
            Some(ParamKind::Integer { min, max, .. }) => (min as f32, max as f32),
            Some(ParamKind::Number { min, max, .. }) => (min, max),
            _ => continue,
        };
        if !(min..=max).contains(&value) {
            return Err(format!("its {name} is {value}, not from {min} to {max}"));
        }
    }
    let casts = effect.program(&defaults(effect).values).casts();
    if casts && effect.clip().is_none() {
        return Err("it CASTS, and it has no CLIP: say what its shadows fall on".to_owned());
    }
    for name in effect.program(&defaults(effect).values).shadow_colors() {
        let param = effect.params().iter().find(|p| p.name == *name);
        if !param.is_some_and(|p| matches!(p.kind, ParamKind::OptionalColor { .. })) {
            return Err(format!(
                "shadow_colors names `{name}`: it is no parameter that is a colour or none"
            ));
        }
    }
    if effect.clip().is_some() && effect.paints().is_some() {
        return Err(
            "it has a CLIP and paints samples: decals have their strokes' colours".to_owned(),
        );
    }
    Ok(())
}

pub(crate) fn parameters(effect: &dyn AnyEffect) -> Result<(), String> {
    let mut names = BTreeSet::new();
    let mut wrong = Vec::new();
    for param in effect.params() {
        let mut tell = |message: String| wrong.push(format!("{}: {message}", param.name));
        if !names.insert(param.name) {
            tell("two parameters have this name".to_owned());
        }
        if LAYER.iter().any(|own| own.name == param.name) {
            tell("every layer has a setting of this name; call it otherwise".to_owned());
        }
        if !is_name(param.name) {
            tell("a name is lower case letters, digits and `_`, a letter first".to_owned());
        }
        if param.doc.trim().is_empty() {
            tell("nothing says what it does".to_owned());
        }
        if let Err(message) = default_is_allowed(&param.kind) {
            tell(message);
        } else if let Some(message) = not_readable(effect, param) {
            tell(message);
        }
    }
    if wrong.is_empty() {
        return Ok(());
    }
    Err(wrong.join("\n"))
}

fn is_name(name: &str) -> bool {
    let is_word = |b: u8| b.is_ascii_lowercase() || b.is_ascii_digit() || b == b'_';
    name.starts_with(|c: char| c.is_ascii_lowercase()) && name.bytes().all(is_word)
}

fn default_is_allowed(kind: &ParamKind) -> Result<(), String> {
    let in_range = |value: f64, min: f64, max: f64| {
        if !(min.is_finite() && max.is_finite() && min <= max) {
            return Err(format!("{min} to {max} is no range"));
        }
        if !(min..=max).contains(&value) {
            return Err(format!("its default {value} is not from {min} to {max}"));
        }
        Ok(())
    };
    match *kind {
        ParamKind::Number {
            min, max, default, ..
        } => in_range(default.into(), min.into(), max.into()),
        ParamKind::Integer { min, max, default } => {
            in_range(default.into(), min.into(), max.into())
        }
        ParamKind::Choice { names, default } if default >= names.len() => {
            Err(format!("its default is choice {default} of {names:?}"))
        }
        ParamKind::Choice { names, .. } if !names.iter().all(|name| is_name(name)) => Err(format!(
            "its choices {names:?} are not names as parameters have"
        )),
        ParamKind::Color { default: hex } | ParamKind::OptionalColor { default: Some(hex) }
            if parse_hex(hex).is_none() =>
        {
            Err(format!("its default \"{hex}\" is no colour \"RRGGBB\""))
        }
        ParamKind::Choice { .. } | ParamKind::Color { .. } | ParamKind::OptionalColor { .. } => {
            Ok(())
        }
        ParamKind::Flag { .. } => Ok(()),
        ParamKind::Pair { min, max, default } => default
            .iter()
            .try_for_each(|number| in_range((*number).into(), min.into(), max.into())),
        ParamKind::Triple { min, max, default } => default
            .iter()
            .try_for_each(|number| in_range((*number).into(), min.into(), max.into())),
        ParamKind::Texture { default, .. } => read_value(default, kind).map(|_| ()),
        ParamKind::Text | ParamKind::Size { .. } => {
            Err("an effect has no parameters of this kind".to_owned())
        }
    }
}

/// What the preset's parser says against a value that the table allows.
fn not_readable(effect: &dyn AnyEffect, param: &Param) -> Option<String> {
    extreme_values(&param.kind).iter().find_map(|value| {
        let text = text(value, &param.kind);
        let mut values = Values::defaults(effect.params());
        let error = values.set_text(effect.id(), param.name, &text).err()?;
        Some(error.to_string())
    })
}
