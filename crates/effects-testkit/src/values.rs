//! Parameters to try effects with.

use effects::preset::edit::written;
use effects::{
    AnyEffect, Image, ParamKind, Ramp, Row, Section as _, Texture, Value, Values, Variation,
};
use std::sync::Arc;

/// Parameters, and what to call them in a message.
pub(crate) struct Case {
    pub name: String,
    pub values: Values,
}

/// An effect's defaults.
pub(crate) fn defaults(effect: &dyn AnyEffect) -> Case {
    Case {
        name: "at its defaults".to_owned(),
        values: Values::defaults(effect.params()),
    }
}

/// The defaults, each parameter at each of its extremes, all that vary along the strand, and some
/// mixtures of extremes.
pub(crate) fn extremes(effect: &dyn AnyEffect) -> Vec<Case> {
    let table = effect.params();
    let mut cases = vec![defaults(effect)];
    for (index, param) in table.iter().enumerate() {
        for value in extreme_values(&param.kind) {
            let mut values = Values::defaults(table);
            let name = format!("with {} = {}", param.name, text(&value, &param.kind));
            values.set(index, value);
            cases.push(Case { name, values });
        }
    }
    let mut varied = Values::defaults(table);
    for (index, param) in table.iter().enumerate() {
        if let ParamKind::Number {
            min,
            max,
            varies: true,
            ..
        } = param.kind
        {
            let curve = vec![(0.0, min), (0.5, max), (0.5, min), (1.0, max)];
            varied.set(index, Value::Varying(Variation { curve, vary: 1.0 }));
        }
    }
    cases.push(Case {
        name: "with numbers that vary over all of their ranges".to_owned(),
        values: varied,
    });
    cases.extend((0..32).map(|number| mixture(effect, number)));
    cases.extend(SHARES.map(|share| level(effect, share)));
    cases
}

/// Places in the ranges of numbers at which all of them are tried together.
const SHARES: [f32; 4] = [0.0, 0.25, 0.5, 1.0];

/// Every number at the same place of its range: where two are the ends of something, it has no length.
fn level(effect: &dyn AnyEffect, share: f32) -> Case {
    let mut values = Values::defaults(effect.params());
    for (index, param) in effect.params().iter().enumerate() {
        if let ParamKind::Number { min, max, .. } = param.kind {
            values.set(index, Value::Number(min + (max - min) * share));
        }
    }
    Case {
        name: format!("with each number at {share} of its range"),
        values,
    }
}

/// Every parameter at one of its extremes, the same ones for the same `number`.
fn mixture(effect: &dyn AnyEffect, number: u32) -> Case {
    let mut values = Values::defaults(effect.params());
    let mut names = Vec::new();
    for (index, param) in effect.params().iter().enumerate() {
        let mut choices = extreme_values(&param.kind);
        if choices.is_empty() {
            continue;
        }
        let hash = effects::wgsl::hash(number ^ effects::wgsl::hash(index as u32));
        let value = choices.swap_remove(hash as usize % choices.len());
        names.push(format!("{} = {}", param.name, text(&value, &param.kind)));
        values.set(index, value);
    }
    Case {
        name: format!("with {}", names.join(", ")),
        values,
    }
}

/// The values at the ends of a parameter's range, and 0 within it; all of a choice.
pub(crate) fn extreme_values(kind: &ParamKind) -> Vec<Value> {
    let (black, white) = (Value::Color(Some([0.0; 3])), Value::Color(Some([1.0; 3])));
    match *kind {
        ParamKind::Number { min, max, .. } => {
            let mut numbers = vec![Value::Number(min), Value::Number(max)];
            // Within its range, 0 is what divisions forget.
            if min < 0.0 && max > 0.0 {
                numbers.push(Value::Number(0.0));
            }
            numbers
        }
        ParamKind::Integer { min, max, .. } => vec![Value::Integer(min), Value::Integer(max)],
        ParamKind::Choice { names, .. } => (0..names.len() as u32).map(Value::Choice).collect(),
        ParamKind::Color { .. } => vec![black, white],
        ParamKind::OptionalColor { .. } => vec![Value::Color(None), black, white],
        ParamKind::Flag { .. } => vec![Value::Flag(false), Value::Flag(true)],
        ParamKind::Pair { min, max, .. } => [[min; 2], [max; 2], [min, max], zero_within(min, max)]
            .map(Value::Pair)
            .to_vec(),
        ParamKind::Triple { min, max, .. } => {
            [[min; 3], [max; 3], [min, max, min], zero_within(min, max)]
                .map(Value::Triple)
                .to_vec()
        }
        ParamKind::Texture { .. } => textures(),
        // No effect has these: they are for sections of presets.
        ParamKind::Text | ParamKind::Size { .. } => Vec::new(),
    }
}

/// None, gradients, and a picture of which some texels aren't there.
fn textures() -> Vec<Value> {
    let row = |v, steps| Row {
        v,
        steps,
        stops: vec![(0.2, [0.0; 3]), (0.7, [1.0, 0.5, 0.0])],
    };
    let ramp = |rows| Ramp::new(rows).expect("a gradient");
    let texels = [
        0, 0, 0, 0, 65535, 0, 9000, 65535, 1, 2, 3, 4, 65535, 65535, 65535, 65535,
    ];
    let image = Image::from_srgb([2, 2], &texels).expect("a picture");
    let image = Texture::Image {
        file: "four.png".to_owned(),
        image: Arc::new(image),
    };
    vec![
        Value::Texture(Texture::None),
        Value::Texture(Texture::Ramp(Arc::new(ramp(vec![row(0.0, false)])))),
        Value::Texture(Texture::Ramp(Arc::new(ramp(vec![
            row(0.0, true),
            row(1.0, false),
        ])))),
        Value::Texture(image),
    ]
}

/// Zeros, which have no direction, or what of a range is nearest to them.
fn zero_within<const N: usize>(min: f32, max: f32) -> [f32; N] {
    [0.0_f32.clamp(min, max); N]
}

/// A value as a preset has it.
pub(crate) fn text(value: &Value, kind: &ParamKind) -> String {
    match (value, kind) {
        (Value::Number(number), _) => number.to_string(),
        (Value::Integer(number), _) => number.to_string(),
        (Value::Choice(index), ParamKind::Choice { names, .. }) => {
            names[*index as usize].to_owned()
        }
        (Value::Flag(flag), _) => flag.to_string(),
        (Value::Pair([x, y]), _) => format!("({x}, {y})"),
        (Value::Triple([x, y, z]), _) => format!("({x}, {y}, {z})"),
        (Value::Color(None), _) => "none".to_owned(),
        (Value::Color(Some(color)), _) => match color {
            [0.0, 0.0, 0.0] => "000000".to_owned(),
            _ => "FFFFFF".to_owned(),
        },
        (Value::Texture(_), _) => written(value, kind),
        (other, _) => format!("{other:?}"),
    }
}

/// The strokes to try of `count`: the first, one in the middle and the last.
pub(crate) fn some_instances(count: u32) -> Vec<u32> {
    let mut some = vec![0, count / 2, count.saturating_sub(1)];
    some.dedup();
    some
}
