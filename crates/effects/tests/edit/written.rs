//! Values as they are written into a text.

use effects::preset::{Field, Reader, edit};
use effects::{Param, ParamKind, Value, Variation};
use proptest::prelude::*;

/// The value that is read where `written` stands.
fn read(written: &str, kind: ParamKind) -> Option<Value> {
    let text = format!("(p: {written})");
    let mut reader = Reader::new("it", &text);
    let root = reader.text();
    let fields: Vec<Field> = reader.fields(root, "it");
    let param = Param {
        name: "p",
        doc: "",
        unit: "",
        kind,
    };
    let value = reader.value(fields.first()?, &param);
    reader.report().ok().and(value)
}

fn number(varies: bool) -> ParamKind {
    ParamKind::Number {
        min: f32::MIN,
        max: f32::MAX,
        default: 0.0,
        varies,
    }
}

fn any_number() -> impl Strategy<Value = f32> {
    let bits = any::<u32>().prop_map(f32::from_bits);
    prop_oneof![
        bits.prop_filter("finite", |n| n.is_finite()),
        -10.0..10.0_f32,
        (0..2000_i16).prop_map(|n| f32::from(n) / 100.0)
    ]
}

proptest! {
    #[test]
    fn written_values_are_read_as_they_were(
        n in any_number(), whole: i32, flag: bool, text in "\\PC{1,12}|[\\x00-\\x7f]{1,8}",
        triple in prop::array::uniform3(any_number()), size: [u32; 2],
        mut curve in prop::collection::vec((0.0..=1.0_f32, any_number()), 1..4), vary in 0.0..=1.0_f32,
        bytes: [u8; 3],
    ) {
        curve.sort_by(|a, b| a.0.total_cmp(&b.0));
        let names: &[&str] = &["round", "flat"];
        let hex = bytes.map(|byte| format!("{byte:02X}")).concat();
        let color = effects::parse_hex(&hex);
        let (min, max) = (f32::MIN, f32::MAX);
        for (value, kind) in [
            (Value::Number(n), number(false)),
            (Value::Number(n), number(true)),
            (Value::Varying(Variation { curve: curve.clone(), vary }), number(true)),
            (Value::Varying(Variation { curve, vary: 0.0 }), number(true)),
            (Value::Varying(Variation { curve: vec![(0.0, n)], vary }), number(true)),
            (Value::Varying(Variation { curve: vec![(0.0, n)], vary: 0.0 }), number(true)),
            (Value::Integer(whole), ParamKind::Integer { min: i32::MIN, max: i32::MAX, default: 0 }),
            (Value::Flag(flag), ParamKind::Flag { default: false }),
            (Value::Choice(u32::from(flag)), ParamKind::Choice { names, default: 0 }),
            (Value::Color(color), ParamKind::Color { default: "000000" }),
            (Value::Color(color), ParamKind::OptionalColor { default: None }),
            (Value::Color(None), ParamKind::OptionalColor { default: None }),
            (Value::Text(Some(text)), ParamKind::Text),
            (Value::Triple(triple), ParamKind::Triple { min, max, default: [0.0; 3] }),
            (Value::Pair([triple[0], n]), ParamKind::Pair { min, max, default: [0.0; 2] }),
            (Value::Size(size), ParamKind::Size { min: 0, max: u32::MAX, default: [1; 2] }),
        ] {
            let written = edit::written(&value, &kind);
            prop_assert_eq!(read(&written, kind), Some(value), "{}", written);
            let is_number = matches!(kind, ParamKind::Number { .. }) && !written.starts_with('(');
            prop_assert!(!is_number || !written.contains(['e', 'E']), "{}", written);
        }
    }
}

#[test]
fn written_values_are_short() {
    let triple = ParamKind::Triple {
        min: -1.0,
        max: 1.0,
        default: [0.0; 3],
    };
    let color = ParamKind::Color { default: "000000" };
    for (value, kind, expected) in [
        (Value::Number(0.1), number(false), "0.1"),
        (Value::Number(1.0), number(false), "1"),
        (Value::Number(-0.0), number(false), "0"),
        (Value::Number(1e-7), number(false), "0.0000001"),
        (Value::Number(1e9), number(false), "1000000000"),
        (Value::Number(0.3), number(false), "0.3"),
        (Value::Triple([0.0, -0.5, 1.0]), triple, "(0, -0.5, 1)"),
        (Value::Triple([1.0, 2.0, 0.0]), color, "\"FFFF00\""),
        (
            Value::Varying(Variation {
                curve: vec![(0.0, 2.0)],
                vary: 0.2,
            }),
            number(true),
            "(value: 2, vary: 0.2)",
        ),
        (
            Value::Varying(Variation {
                curve: vec![(0.0, 1.0), (0.5, 2.0)],
                vary: 0.0,
            }),
            number(true),
            "(curve: [(0, 1), (0.5, 2)])",
        ),
        (
            Value::Text(Some("a \"b\" \\ c\n".into())),
            ParamKind::Text,
            r#""a \"b\" \\ c\n""#,
        ),
    ] {
        assert_eq!(edit::written(&value, &kind), expected);
    }
}
