//! Rows of the tables that presets, styles and scripts are read by.

use effects::{Param, ParamKind};

pub(crate) const fn number(
    name: &'static str,
    doc: &'static str,
    unit: &'static str,
    range: std::ops::RangeInclusive<f32>,
    default: f32,
) -> Param {
    let kind = ParamKind::Number {
        min: *range.start(),
        max: *range.end(),
        default,
        varies: false,
    };
    Param {
        name,
        doc,
        unit,
        kind,
    }
}

pub(crate) const fn param(name: &'static str, doc: &'static str, kind: ParamKind) -> Param {
    Param {
        name,
        doc,
        unit: "",
        kind,
    }
}

pub(crate) const fn color(name: &'static str, doc: &'static str, default: &'static str) -> Param {
    param(name, doc, ParamKind::Color { default })
}

pub(crate) const fn choice(
    name: &'static str,
    doc: &'static str,
    names: &'static [&'static str],
    default: usize,
) -> Param {
    param(name, doc, ParamKind::Choice { names, default })
}
