//! What a parameter is, in words.

use effects::preset::edit::written;
use effects::{Param, ParamKind, Value};

/// A unit as it stands beside a number: short, or not there at all; the help has it in full.
pub(super) fn short_unit(unit: &str) -> &str {
    match unit {
        "degrees" => "°",
        "head heights" => " heads",
        "1/300 head height" => " /300",
        "1/s^2" => " /s²",
        "1/s" => " /s",
        "s" => " s",
        "m" => " m",
        "m/s" => " m/s",
        "px" => " px",
        _ => "",
    }
}

/// All that its schema says of a parameter.
pub(super) fn help(param: &Param) -> String {
    let mut help = param.doc.to_owned();
    if !param.unit.is_empty() {
        help += &format!("\nUnit: {}.", param.unit);
    }
    help += &format!("\nTakes {}.", param.kind.expected());
    match param.kind.default_value() {
        Value::Text(None) => help += "\nNot set by default.",
        default => help += &format!("\nDefault: {}.", written(&default, &param.kind)),
    }
    if let ParamKind::Number { varies: true, .. } = param.kind {
        help += "\nMay vary along the strand and from strand to strand.";
    }
    help
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn help_has_doc_unit_range_and_default() {
        let kind = ParamKind::Number {
            min: 0.0,
            max: 9.5,
            default: 2.0,
            varies: true,
        };
        let param = Param {
            name: "width",
            doc: "How wide.",
            unit: "head heights",
            kind,
        };
        let help = help(&param);
        for part in [
            "How wide.",
            "Unit: head heights.",
            "a number from 0 to 9.5",
            "Default: 2.",
            "along the strand",
        ] {
            assert!(help.contains(part), "{help}");
        }
    }
}
