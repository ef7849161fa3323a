//! Reading layers from a preset's text: values, and mistakes at their places.

use effects::preset::Reader;
use effects::wgsl::Stroke;
use effects::{
    Input, Joints, Param, ParamKind, Parameters, Program, Registry, RegistryError, StrokeEffect,
    Values,
};

/// An effect without WGSL, to read layers with.
struct Line;
struct LineProgram;

impl Parameters for LineProgram {
    type Params = f32;
    const PARAMS: &'static [Param] = &[
        Param {
            name: "width",
            doc: "Width.",
            unit: "",
            kind: ParamKind::Number {
                min: 0.0,
                max: 9.0,
                default: 2.0,
                varies: true,
            },
        },
        Param {
            name: "kind",
            doc: "Kind.",
            unit: "",
            kind: ParamKind::Choice {
                names: &["plain", "double"],
                default: 0,
            },
        },
        Param {
            name: "color",
            doc: "Colour.",
            unit: "",
            kind: ParamKind::Color { default: "000000" },
        },
    ];
    const INPUTS: &'static [Input] = &[];
    const WGSL: &'static str = "";
    fn params(values: &Values) -> f32 {
        values.number("width")
    }
}

impl Program for LineProgram {
    fn stroke(_: &Joints, _: usize, _: u32, _: u32, width: &f32) -> Stroke {
        let zero = effects::wgsl::vec3([0.0; 3]);
        Stroke {
            offset: effects::wgsl::vec2([0.0; 2]),
            radius: *width,
            depth_offset: 0.0,
            color: zero,
        }
    }
}

impl StrokeEffect for Line {
    type Program = LineProgram;
    const ID: &'static str = "test.line";
    const DOC: &'static str = "a line";
    const RANK: i32 = 7;
    const DEPTH_OFFSET: f32 = 0.5;
}

fn registry() -> Registry {
    let mut registry = Registry::new();
    registry.register::<Line>().unwrap();
    registry
}

/// All messages for a list of layers, as a user reads them.
fn messages(list: &str) -> String {
    let registry = registry();
    let mut reader = Reader::new("look.ron", list);
    reader.layers(list, &registry, &["clump"]);
    reader.report().unwrap_err().to_string()
}

#[test]
fn layers_take_the_effects_defaults_or_their_own() {
    let registry = registry();
    let text = r#"[
        (effect: "test.line"),
        (effect: "test.line", name: "thick", rank: -3, depth_offset: 0.25, units: pixels,
         params: (width: 4.5, kind: double, color: "FF0000")),
    ]"#;
    let mut reader = Reader::new("look.ron", text);
    let layers = reader.layers(text, &registry, &["clump"]);
    reader.report().unwrap();
    assert_eq!(
        (
            layers[0].name.as_str(),
            layers[0].rank,
            layers[0].depth_offset
        ),
        ("test.line", 7, 0.5)
    );
    assert_eq!(layers[0].values.number("width"), 2.0);
    assert_eq!(
        (
            layers[1].name.as_str(),
            layers[1].rank,
            layers[1].depth_offset
        ),
        ("thick", -3, 0.25)
    );
    assert_eq!(layers[1].values.number("width"), 4.5);
    assert_eq!(layers[1].values.choice("kind"), 1);
    assert_eq!(layers[1].values.color("color"), [1.0, 0.0, 0.0]);
    assert_eq!(layers[1].build().units, effects::Units::Pixels);
}

#[test]
fn every_mistake_has_its_place_and_what_would_be_right() {
    let text = "[
        (effect: \"test.lime\"),
        (effect: \"test.line\", params: (widht: 3.0, width: -1.0)),
        (effect: \"test.line\", name: \"b\", rnak: 3),
        (effect: \"test.line\", name: \"c\", params: (kind: dubble, color: \"12345\")),
        (effect: \"test.line\", name: \"c\"),
        (name: \"d\"),
        (effect: \"test.line\", name: \"e\", params: (width: NaN, width: 1e999)),
    ]";
    let messages = messages(text);
    let expected = [
        "look.ron:2:18: there is no effect `test.lime`, did you mean `test.line`?",
        "look.ron:3:40: test.line has no `widht`, did you mean `width`?",
        "look.ron:3:59: width: expected a number from 0 to 9, found `-1.0`",
        "look.ron:4:42: a layer has no `rnak`, did you mean `rank`?",
        "look.ron:5:57: kind: there is no `dubble`, did you mean `double`?",
        "look.ron:5:72: color: expected a colour such as \"3FC1C0\", found `\"12345\"`",
        "look.ron:6:9: there is already a layer `c`",
        "look.ron:7:9: a layer needs `effect`",
        "look.ron:8:58: width: expected a number from 0 to 9, found `NaN`",
        "look.ron:8:63: test.line has `width` twice",
        "look.ron:8:70: width: expected a number from 0 to 9, found `1e999`",
    ];
    for line in expected {
        assert!(
            messages.contains(line),
            "`{line}` is missing in:\n{messages}"
        );
    }
    assert_eq!(
        messages.matches("look.ron:").count(),
        expected.len(),
        "{messages}"
    );
    assert!(messages.contains(" 4 |         (effect: \"test.line\", name: \"b\", rnak: 3),"));
}

#[test]
fn syntax_errors_keep_the_files_line_and_column() {
    let text = "[\n    (effect: \"test.line\" rank: 3),\n]";
    assert!(
        messages(text).starts_with("look.ron:2:2"),
        "{}",
        messages(text)
    );
    let text = "[\n    (effect: \"test.line\",\n     params: (width: 3.0 kind: plain)),\n]";
    assert!(
        messages(text).starts_with("look.ron:3:2"),
        "{}",
        messages(text)
    );
}

#[test]
fn reading_goes_on_after_a_mistake_of_punctuation() {
    let text = "[
        (effect: \"test.line\" name: \"a\", rank = 3; units: inches)
        (effect: \"test.line\", name: \"b\", params: (width 3, kind: dubble)),,
    ]";
    let messages = messages(text);
    let expected = [
        "look.ron:2:30: a comma is missing before `name`",
        "look.ron:2:46: write `rank: value`, with `:` in place of `=`",
        "look.ron:2:49: write `,` in place of `;`",
        "look.ron:2:58: units: there is no `inches`; there are: world, pixels",
        "look.ron:3:9: a comma is missing before this",
        "look.ron:3:51: a `:` is missing after `width`",
        "look.ron:3:66: kind: there is no `dubble`, did you mean `double`?",
        "look.ron:3:75: there is a comma too many",
    ];
    for line in expected {
        assert!(
            messages.contains(line),
            "`{line}` is missing in:\n{messages}"
        );
    }
    assert_eq!(
        messages.matches("look.ron:").count(),
        expected.len(),
        "{messages}"
    );
}

#[test]
fn comments_and_raw_texts_are_read_as_ron_reads_them() {
    let registry = registry();
    let text = "[ // (
        (/* [ /* ( */ \" */ effect: r#\"test.line\"#, // ]
         name: \"a // no comment \\\" ) \", params: ( /**/ width/**/:/**/3/**/ ),),
    ] /* ) */ // end";
    let mut reader = Reader::new("look.ron", text);
    let layers = reader.layers(reader.text(), &registry, &[]);
    reader.report().unwrap();
    assert_eq!(layers[0].name, "a // no comment \" ) ");
    assert_eq!(layers[0].values.number("width"), 3.0);
}

#[test]
fn a_file_of_mistakes_is_cut_short_and_read_quickly() {
    let text = format!("[{}]", "(effect: 3),".repeat(100_000));
    assert_eq!(messages(&text).matches("look.ron:").count(), 101);
    let fields = (0..100_000).fold(String::new(), |text, i| text + &format!("a{i}: 3,"));
    let text = format!("[(effect: \"test.line\", {fields})]");
    assert_eq!(messages(&text).matches("look.ron:").count(), 101);
    for deep in [
        "(".repeat(200_000),
        "([".repeat(100_000) + &"])".repeat(100_000),
    ] {
        assert!(messages(&deep).starts_with("look.ron:1:"));
    }
}

#[test]
fn set_takes_the_texts_that_presets_take() {
    let registry = registry();
    let text = "[(effect: \"test.line\")]";
    let mut layers = Reader::new("look.ron", text).layers(text, &registry, &["clump"]);
    let layer = &mut layers[0];
    layer.set("width", "3").unwrap();
    layer.set("color", "00FF00").unwrap();
    layer.set("kind", "double").unwrap();
    assert_eq!(layer.values.number("width"), 3.0);
    assert_eq!(layer.values.color("color"), [0.0, 1.0, 0.0]);
    layer.set("depth_offset", "0.25").unwrap();
    layer.set("rank", "-2").unwrap();
    layer.set("units", "pixels").unwrap();
    assert_eq!((layer.depth_offset, layer.rank), (0.25, -2));
    assert_eq!(layer.units, effects::Units::Pixels);
    assert!(layer.set("rank", "2.5").is_err());
    assert!(
        layer
            .set("width", "wide")
            .unwrap_err()
            .to_string()
            .contains("a number from 0 to 9")
    );
    assert!(
        layer
            .set("withd", "1")
            .unwrap_err()
            .to_string()
            .contains("did you mean `width`?")
    );
}

#[test]
fn layers_keep_off_the_names_of_sections() {
    let text = "[(effect: \"test.line\", name: \"clump\")]";
    let message = messages(text);
    assert!(
        message.starts_with("look.ron:1:2: `clump` is a section's name"),
        "{message}"
    );
}

#[test]
fn ids_are_unique_and_have_a_vendor() {
    struct Nameless;
    impl StrokeEffect for Nameless {
        type Program = LineProgram;
        const ID: &'static str = "line";
        const DOC: &'static str = "";
    }
    let mut registry = registry();
    assert_eq!(
        registry.register::<Line>(),
        Err(RegistryError::Duplicate { id: "test.line" })
    );
    assert_eq!(
        registry.register::<Nameless>(),
        Err(RegistryError::Id { id: "line" })
    );
    assert_eq!(registry.iter().count(), 1);
}

#[test]
fn of_thousands_of_mistakes_a_hundred_are_shown_and_all_are_counted() {
    let registry = registry();
    let list = format!("[{}]", "3,\n".repeat(3000));
    let mut reader = Reader::new("look.ron", &list);
    reader.layers(&list, &registry, &[]);
    let errors = reader.report().unwrap_err().0;
    assert_eq!(errors.len(), 101);
    let last = &errors[100];
    assert_eq!(last.message, "100 of 3000 mistakes are shown, not this one");
    assert_eq!((last.place.line, last.place.column), (101, 1));
}

#[test]
fn places_are_right_in_any_order_and_show_little_of_a_long_line() {
    let line: String = (0..20_000).map(|i| format!("ä{i} ")).collect();
    let text = format!("one\n{line}\nthree");
    let reader = Reader::new("look.ron", &text);
    let check = |offset: usize| {
        let place = reader.place(&text[offset..]);
        let before = &text[..offset];
        let in_line = before.rsplit('\n').next().unwrap();
        assert_eq!(place.line, before.matches('\n').count() + 1);
        assert_eq!(place.column, in_line.chars().count() + 1);
        let whole = text.lines().nth(place.line - 1).unwrap();
        let shown: String = whole
            .chars()
            .skip(place.column.saturating_sub(60))
            .take(100)
            .collect();
        assert_eq!(place.source_line, shown, "{offset}");
    };
    for offset in [5, 70_000, 4, 0, 120_000, 99_000, text.len() - 5, 2] {
        let offset = (offset..).find(|i| text.is_char_boundary(*i)).unwrap();
        check(offset);
    }
}

#[test]
fn little_of_a_long_name_is_repeated() {
    let long = "x".repeat(100_000);
    for list in [
        format!("[(effect: \"{long}\")]"),
        format!("[({long}: 1)]"),
        format!("[(\"{long}\": 1)]"),
        format!("[({long} = 1)]"),
        format!("[({long}: 1, {long}: 2)]"),
        format!("[(effect: \"test.line\", params: ({long}: 2))]"),
        format!("[(effect: \"test.line\", params: (width: (value: 1, {long}: 2)))]"),
        format!(
            "[(effect: \"test.line\", name: \"{long}\"), (effect: \"test.line\", name: \"{long}\")]"
        ),
        long.clone(),
    ] {
        let text = messages(&list);
        let mistakes = text.matches("look.ron:").count();
        assert!(text.len() < 500 * mistakes, "{text}");
    }
}

#[test]
fn messages_have_no_characters_that_terminals_obey() {
    let text = messages("[(\u{1b}[31m\0: \u{7})]");
    let line_ends = text.matches('\n').count();
    assert_eq!(
        text.matches(char::is_control).count(),
        line_ends,
        "{text:?}"
    );
}

#[test]
fn any_number_of_missing_commas_is_told() {
    let text = messages(&format!("[({})]", "a: 1 ".repeat(200_000)));
    assert!(text.contains("a comma is missing before `a`"), "{text}");
}
