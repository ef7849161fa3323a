//! Every field of every preset, spoilt in every way: an error that names the line, or a value that is
//! legal. Never a panic, never silence.

use effects::preset::{LAYER, Reader, may_say};
use effects::{AnyEffect, BrushSection, Param, ParamKind, Registry};
use proptest::prelude::*;
use ron::value::RawValue;
use stage::{BODIES, LineSection, MeshSection, ObjectSection, PassSection, Preset, Sections};
use std::collections::HashSet;
use std::fmt::Write as _;
use std::ops::Range;
use std::path::Path;

fn registry() -> Registry {
    let mut registry = Registry::new();
    effects_builtin::register(&mut registry).unwrap();
    effects_cartoon::register(&mut registry).unwrap();
    effects_surface::register(&mut registry).unwrap();
    registry
}

/// Every preset that is shipped, and one with every field of every table.
fn presets(registry: &Registry) -> Vec<(String, String)> {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../presets");
    let mut presets: Vec<(String, String)> = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        // Not hair styles or strands, whose names end in `.style.ron` and `.strands.ron`.
        .filter(|path| path.extension().is_some_and(|e| e == "ron"))
        .filter(|path| Path::new(path.file_stem().unwrap()).extension().is_none())
        .map(|path| {
            let text = std::fs::read_to_string(&path).unwrap();
            (path.display().to_string(), text)
        })
        .collect();
    presets.sort();
    assert!(!presets.is_empty());
    presets.push(("everything".to_owned(), everything(registry)));
    presets
}

/// A preset with every field of every table at its default.
fn everything(registry: &Registry) -> String {
    let list = |table: &[Param], indent: &str| {
        table.iter().fold(String::new(), |mut text, param| {
            let _ = writeln!(text, "{indent}{}: {},", param.name, default(&param.kind));
            text
        })
    };
    // A base would be another file.
    let of_base =
        |line: &&str| !["base", "without"].contains(&line.trim().split(':').next().unwrap());
    let top = list(Preset::TOP, "    ");
    let top: Vec<&str> = top.lines().filter(of_base).collect();
    let mut text = format!("(\n{}\n", top.join("\n"));
    for (name, _, table) in Sections::ALL {
        let _ = writeln!(text, "    {name}: (\n{}    ),", list(table, "        "));
    }
    let mesh = list(MeshSection::TABLE, "            ");
    let _ = writeln!(text, "    meshes: [\n        (\n{mesh}        ),\n    ],");
    let lines = list(LineSection::TABLE, "            ").replace("kind: \"x\"", "kind: \"crease\"");
    let _ = writeln!(text, "    lines: [\n        (\n{lines}        ),\n    ],");
    let body = list(BODIES.table, "            ").replace("shape: sphere", "shape: mesh");
    let _ = writeln!(text, "    bodies: [\n        (\n{body}        ),\n    ],");
    let pass = list(PassSection::TABLE, "            ");
    let _ = writeln!(text, "    passes: [\n        (\n{pass}        ),\n    ],");
    text += "    layers: [\n";
    for effect in registry.iter() {
        let own = LAYER.iter().filter(|param| may_say(effect, param.name));
        let own: Vec<Param> = own.copied().collect();
        let fields = list(&own, "            ").replace("effect: \"x\"", "effect: \"ID\"");
        let fields = fields.replace("\"x\"", "\"ID\"").replace("ID", effect.id());
        let params = list(effect.params(), "                ");
        let brush = list(BrushSection::TABLE, "                ");
        let brush = match may_say(effect, "brush") {
            true => format!("            brush: (\n{brush}            ),\n"),
            false => String::new(),
        };
        let _ = writeln!(
            text,
            "        (\n{fields}{brush}            params: (\n{params}            ),\n        ),"
        );
    }
    text + "    ],\n)\n"
}

fn default(kind: &ParamKind) -> String {
    match *kind {
        ParamKind::Number { default, .. } => default.to_string(),
        ParamKind::Integer { default, .. } => default.to_string(),
        ParamKind::Flag { default } => default.to_string(),
        ParamKind::Choice { names, default } => names[default].to_owned(),
        ParamKind::Color { default } => format!("\"{default}\""),
        ParamKind::OptionalColor { default } => {
            default.map_or("none".to_owned(), |hex| format!("\"{hex}\""))
        }
        ParamKind::Texture { default, .. } => default.to_owned(),
        ParamKind::Text => "\"x\"".to_owned(),
        ParamKind::Triple {
            default: [x, y, z], ..
        } => format!("({x}, {y}, {z})"),
        ParamKind::Pair {
            default: [x, y], ..
        } => format!("({x}, {y})"),
        ParamKind::Size {
            default: [w, h], ..
        } => format!("({w}, {h})"),
    }
}

/// A field of a preset: where its name and value stand, and what it takes.
struct Place {
    name: Range<usize>,
    value: Range<usize>,
    /// `None` for sections, lists and `params`.
    kind: Option<ParamKind>,
    /// Where the table lies that has it: one section's or effect's.
    table: *const Param,
}

/// All fields of a good preset, at any depth.
fn places(text: &str, registry: &Registry) -> Vec<Place> {
    let mut reader = Reader::new("", text);
    let mut places = Vec::new();
    let range = |slice: &str| {
        let start = slice.as_ptr() as usize - text.as_ptr() as usize;
        start..start + slice.len()
    };
    let mut add = |name: &str, value: &str, table: &[Param]| {
        let param = table.iter().find(|param| param.name == name);
        places.push(Place {
            name: range(name),
            value: range(value),
            kind: param.map(|param| param.kind),
            table: table.as_ptr(),
        });
    };
    for field in reader.fields(reader.text(), "the preset") {
        add(field.name, field.value, Preset::TOP);
        if let Some((_, _, table)) = Sections::ALL.iter().find(|(name, ..)| *name == field.name) {
            for inner in reader.fields(field.value, "a section") {
                add(inner.name, inner.value, table);
            }
        }
        if field.name == "passes" {
            for pass in reader.list(field.value, "passes") {
                for inner in reader.fields(pass, "a pass") {
                    add(inner.name, inner.value, PassSection::TABLE);
                }
            }
        }
        if field.name == "bodies" {
            for body in reader.list(field.value, "bodies") {
                for inner in reader.fields(body, "a body") {
                    add(inner.name, inner.value, BODIES.table);
                }
            }
        }
        if field.name == "meshes" {
            for mesh in reader.list(field.value, "meshes") {
                for inner in reader.fields(mesh, "a mesh") {
                    add(inner.name, inner.value, MeshSection::TABLE);
                }
            }
        }
        if field.name == "lines" {
            for lines in reader.list(field.value, "lines") {
                for inner in reader.fields(lines, "lines") {
                    add(inner.name, inner.value, LineSection::TABLE);
                }
            }
        }
        if field.name == "objects" {
            for object in reader.list(field.value, "objects") {
                for inner in reader.fields(object, "an object") {
                    add(inner.name, inner.value, ObjectSection::TABLE);
                }
            }
        }
        if field.name == "layers" {
            for layer in reader.list(field.value, "layers") {
                let fields = reader.fields(layer, "a layer");
                let id = fields.iter().find(|f| f.name == "effect").unwrap().value;
                let effect = registry.get(id.trim_matches('"')).unwrap();
                for inner in &fields {
                    add(inner.name, inner.value, LAYER);
                    if inner.name == "brush" {
                        for field in reader.fields(inner.value, "brush") {
                            add(field.name, field.value, BrushSection::TABLE);
                        }
                    }
                    if inner.name == "params" {
                        for param in reader.fields(inner.value, "params") {
                            add(param.name, param.value, AnyEffect::params(effect));
                        }
                    }
                }
            }
        }
    }
    reader.report().unwrap();
    places
}

/// Fields of sections and effects that have been met: each is spoilt in the first preset that has it, as there are many, and some have nothing that others lack; with
/// `INKSTRAND_PRESETS=all` in each.
#[derive(Default)]
struct Firsts(HashSet<(String, *const Param)>);

impl Firsts {
    fn is_first(&mut self, text: &str, place: &Place) -> bool {
        let name = &text[place.name.clone()];
        let wants_all = std::env::var("INKSTRAND_PRESETS").is_ok_and(|wanted| wanted == "all");
        self.0.insert((name.to_owned(), place.table)) || wants_all
    }
}

fn replaced(text: &str, range: &Range<usize>, by: &str) -> String {
    format!("{}{by}{}", &text[..range.start], &text[range.end..])
}

fn line_of(text: &str, offset: usize) -> usize {
    1 + text[..offset].matches('\n').count()
}

/// Values that are wrong for nearly every field, each on one line.
const VALUES: &[&str] = &[
    "",
    "-1",
    "0",
    "1",
    "0.5",
    "-1e30",
    "1e30",
    "1e999",
    "-1e999",
    "NaN",
    "-NaN",
    "inf",
    "-inf",
    "99999999999999999999999999",
    "0x10",
    "1_0",
    "1.2.3",
    "1,5",
    "1 2",
    "1; 2",
    "1px",
    "true",
    "True",
    "none",
    "None",
    "Some(1)",
    "nonsense",
    "é",
    "日本",
    "\u{0}",
    "\u{202e}x",
    "\"\"",
    "\"x\"",
    "\"é\"",
    "\"FFFFFF\"",
    "\"FFFFF\"",
    "\"GGGGGG\"",
    "\"none\"",
    "\"\\q\"",
    "\"\\u{110000}\"",
    "'x'",
    "r\"x\"",
    "r#\"x\"#",
    "“x”",
    "()",
    "(1)",
    "(1, 2)",
    "(1, 2, 3)",
    "(1, 2, 3, 4)",
    "(0, NaN, 0)",
    "(0, 1e999, 0)",
    "(-1, 1)",
    "(960, 720)",
    "[]",
    "[1, 2, 3]",
    "{}",
    "{\"a\": 1}",
    "(a: 1)",
    "x(1, 2)",
    "(",
    "[",
    "{",
    ")",
    "]",
    "}",
    "((((((((((",
    "\"",
    "'",
    "r\"",
    "r#\"x\"",
    "/*",
    "/* /* */",
    ",",
    ":",
    "=",
    "+",
    "-",
    ".",
    "#",
    "@",
    "\\",
];

/// Whether a field of this kind may say `text`: the rules of the tables, without the parser.
fn is_legal(kind: &ParamKind, text: &str) -> bool {
    let numbers = |text: &str| -> Option<Vec<f64>> {
        let inside = text.strip_prefix('(')?.strip_suffix(')')?;
        inside
            .split(',')
            .map(|part| part.trim().parse().ok())
            .collect()
    };
    let quoted = match text {
        "r\"x\"" | "r#\"x\"#" => Some("x"),
        _ => text
            .strip_prefix('"')
            .and_then(|text| text.strip_suffix('"'))
            .filter(|text| !text.contains('\\')),
    };
    let is_color = |hex: Option<&str>| {
        hex.is_some_and(|hex| hex.len() == 6 && hex.bytes().all(|b| b.is_ascii_hexdigit()))
    };
    match *kind {
        ParamKind::Number { min, max, .. } => {
            let number = text.replace('_', "").parse::<f32>();
            number.is_ok_and(|number| (min..=max).contains(&number))
        }
        ParamKind::Integer { min, max, .. } => {
            let number = text.replace('_', "").replace("0x10", "16").parse::<i32>();
            number.is_ok_and(|number| (min..=max).contains(&number))
        }
        ParamKind::Flag { .. } => ["true", "false"].contains(&text),
        ParamKind::Choice { names, .. } => names.contains(&text),
        ParamKind::Color { .. } => is_color(quoted),
        ParamKind::OptionalColor { .. } => text == "none" || is_color(quoted),
        ParamKind::Texture { .. } => effects::preset::read_value(text, kind).is_ok(),
        ParamKind::Text => quoted.is_some_and(|text| !text.is_empty()),
        ParamKind::Triple { min, max, .. } => numbers(text).is_some_and(|numbers| {
            numbers.len() == 3
                && numbers
                    .iter()
                    .all(|x| (f64::from(min)..=f64::from(max)).contains(x))
        }),
        ParamKind::Pair { min, max, .. } => numbers(text).is_some_and(|numbers| {
            numbers.len() == 2
                && numbers
                    .iter()
                    .all(|x| (f64::from(min)..=f64::from(max)).contains(x))
        }),
        ParamKind::Size { min, max, .. } => numbers(text).is_some_and(|numbers| {
            numbers.len() == 2
                && numbers
                    .iter()
                    .all(|x| (f64::from(min)..=f64::from(max)).contains(x))
        }),
    }
}

#[test]
fn a_preset_with_every_field_is_accepted() {
    let registry = registry();
    for (file, text) in presets(&registry) {
        if let Err(errors) = Preset::parse(&file, &text, &registry) {
            panic!("{errors}\n{text}");
        }
        assert!(ron::from_str::<&RawValue>(&text).is_ok(), "{file} is RON");
    }
}

#[test]
fn every_wrong_value_is_an_error_at_its_line() {
    let registry = registry();
    let deep = "(".repeat(5_000) + &")".repeat(5_000);
    let long = format!("\"{}\"", "é".repeat(50_000));
    let mut tried = 0;
    let mut firsts = Firsts::default();
    for (file, text) in presets(&registry) {
        for place in places(&text, &registry) {
            if !firsts.is_first(&text, &place) {
                continue;
            }
            let name = &text[place.name.clone()];
            let line = line_of(&text, place.value.start);
            for value in VALUES.iter().copied().chain([&*deep, &*long]) {
                tried += 1;
                let spoilt = replaced(&text, &place.value, value);
                let what = || format!("{file}:{line}: {name}: {value:.60}");
                // An effect is a text of few values; a layer's name may be any.
                let legal = place.kind.is_some_and(|kind| is_legal(&kind, value))
                    && name != "effect"
                    || place.kind.is_none()
                        && value == "()"
                        && !["layers", "meshes", "lines", "bodies", "passes", "objects"]
                            .contains(&name)
                    || place.kind.is_none()
                        && ["layers", "meshes", "lines", "bodies", "passes"].contains(&name)
                        && value == "[]";
                match Preset::parse("look.ron", &spoilt, &registry) {
                    Ok(_) => assert!(legal, "{} is accepted", what()),
                    // Two layers of one name are the layer's mistake, not its name's; substeps are another solver's;
                    // one of two things moves a head; and bodies have what their shape has.
                    Err(errors) if legal => assert!(
                        name == "name" && errors.to_string().contains("already a layer")
                            || name == "kind" && errors.to_string().contains("lines of the kind")
                            || name == "character"
                                && errors.to_string().contains("both move the head")
                            || name == "substeps" && errors.to_string().contains("solver: rods")
                            || name == "shape"
                                && errors.to_string().contains("a mesh needs `file:")
                            || errors.to_string().contains("has none, only")
                            || name == "animation"
                                && errors.to_string().contains("are forms already"),
                        "{} is legal, but:\n{errors}",
                        what()
                    ),
                    Err(errors) => {
                        assert!(
                            errors.0.iter().any(|e| e.place.line == line
                                || e.message.contains(&format!("line {line}"))),
                            "{}: line {line} is not named:\n{errors}",
                            what()
                        )
                    }
                }
            }
        }
    }
    assert!(tried > 5_000, "{tried}");
}

#[test]
fn every_misspelt_name_is_an_error_at_its_place() {
    let registry = registry();
    let mut firsts = Firsts::default();
    for (file, text) in presets(&registry) {
        for place in places(&text, &registry) {
            if !firsts.is_first(&text, &place) {
                continue;
            }
            let name = text[place.name.clone()].to_owned();
            let line = line_of(&text, place.name.start);
            let wrong = [
                format!("{name}x"),
                name[1..].to_owned(),
                name.to_uppercase(),
                format!("é{name}"),
                format!("\"{name}\""),
                format!("{name} {name}"),
                "3".to_owned(),
                String::new(),
            ];
            for wrong in &wrong {
                let spoilt = replaced(&text, &place.name, wrong);
                let errors = Preset::parse("look.ron", &spoilt, &registry).err();
                let errors = errors.unwrap_or_else(|| panic!("{file}:{line}: {wrong} is accepted"));
                assert!(
                    errors.0.iter().any(|e| e.place.line == line),
                    "{file}:{line}: {wrong}:\n{errors}"
                );
            }
        }
    }
}

/// One change of a text's bytes.
#[derive(Clone, Debug)]
enum Change {
    Delete(usize, usize),
    Repeat(usize, usize),
    Put(usize, char),
}

fn change() -> impl Strategy<Value = Change> {
    let marks: Vec<char> = "()[]{},:;='\"\\/*#\n\t\r -+.09eNré\u{feff}\u{0}"
        .chars()
        .collect();
    prop_oneof![
        (any::<usize>(), 1usize..40).prop_map(|(at, length)| Change::Delete(at, length)),
        (any::<usize>(), 1usize..40).prop_map(|(at, length)| Change::Repeat(at, length)),
        (any::<usize>(), prop::sample::select(marks)).prop_map(|(at, mark)| Change::Put(at, mark)),
    ]
}

fn apply(bytes: &mut Vec<u8>, change: &Change) {
    let range = |at: usize, length: usize, total: usize| {
        let start = at % (total + 1);
        start..(start + length).min(total)
    };
    match *change {
        Change::Delete(at, length) => {
            bytes.drain(range(at, length, bytes.len()));
        }
        Change::Repeat(at, length) => {
            let range = range(at, length, bytes.len());
            let again = bytes[range.clone()].to_vec();
            bytes.splice(range.start..range.start, again);
        }
        Change::Put(at, mark) => {
            let start = range(at, 0, bytes.len()).start;
            bytes.splice(start..start, mark.to_string().into_bytes());
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2_000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn damaged_presets_never_panic(which in any::<usize>(), changes in prop::collection::vec(change(), 1..6)) {
        let registry = registry();
        let presets = presets(&registry);
        let mut bytes = presets[which % presets.len()].1.clone().into_bytes();
        for change in &changes {
            apply(&mut bytes, change);
        }
        let text = String::from_utf8_lossy(&bytes);
        match Preset::parse("look.ron", &text, &registry) {
            Ok(_) => prop_assert!(ron::from_str::<&RawValue>(&text).is_ok(), "this is no RON:\n{text}"),
            Err(errors) => {
                let lines = 1 + text.matches('\n').count();
                prop_assert!(!errors.0.is_empty());
                for error in &errors.0 {
                    prop_assert!((1..=lines).contains(&error.place.line) && error.place.column >= 1);
                    let length = error.place.source_line.chars().count();
                    let not_shown = error.place.column.saturating_sub(60);
                    prop_assert!(error.place.column - not_shown <= length + 2, "{error}");
                }
            }
        }
    }
}
