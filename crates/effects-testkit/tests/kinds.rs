//! An effect with parameters of all kinds that the other tests' effects don't have.

use effects::{ParamKind, Parameters as _, Section as _, StrokeEffect, Value, Values};

effects::effect!("kinds");

struct Kinds;

impl StrokeEffect for Kinds {
    type Program = Program;
    const ID: &'static str = "test.kinds";
    const DOC: &'static str = "strokes of many kinds";
    fn instances(_: &Params) -> u32 {
        3
    }
}

#[test]
fn it_conforms() {
    effects_testkit::assert_conforms::<Kinds>();
    effects_testkit::assert_steady::<Kinds>(&[("both", "false"), ("tint", "(0, 4, 1)")]);
}

#[test]
fn presets_say_them_and_programs_read_them() {
    let mut values = Values::defaults(Program::PARAMS);
    let params = Program::params(&values);
    assert!(params.both && params.shift == 0);
    assert_eq!((params.radii.x, params.radii.y), (1.0, 0.5));
    for (name, text) in [
        ("both", "false"),
        ("shift", "-2"),
        ("radii", "(0.5, 2)"),
        ("tint", "(1, 2, 3)"),
    ] {
        values.set_text("test.kinds", name, text).unwrap();
    }
    let params = Program::params(&values);
    assert!(!params.both && params.shift == -2 && params.tint.z == 3.0);
    assert_eq!(values.get(2), Some(Value::Pair([0.5, 2.0])));
    for (name, text, message) in [
        ("both", "1", "both: "),
        ("shift", "-4", "a whole number from -3 to 3"),
        (
            "radii",
            "(0.5, 2, 1)",
            "two numbers (x, y), each from 0 to 2",
        ),
        ("radii", "[0.5, 2]", "write it in ( )"),
        (
            "tint",
            "(1, 2, 5)",
            "three numbers (x, y, z), each from 0 to 4",
        ),
    ] {
        let error = values.set_text("test.kinds", name, text).unwrap_err();
        assert!(error.to_string().contains(message), "{error}");
    }
    let kind = Program::PARAMS[1].kind;
    assert!(matches!(
        kind,
        ParamKind::Integer {
            min: -3,
            max: 3,
            default: 0
        }
    ));
}
