//! `inkstrand effects`: what it lists is what the parser reads by, as text and as JSON.

use assert_cmd::Command;
use effects::preset::{LAYER, OF_THE_EFFECT, may_say};
use effects::{BrushSection, Param, ParamKind, Registry, Section};
use predicates::prelude::*;
use predicates::str::contains;
use serde_json::{Value, json};
use stage::{
    BODIES, BodySection, LineSection, MOTION_PARTS, MeshSection, ObjectSection, PassSection,
    Preset, STYLE_PARTS, Sections,
};
use std::collections::BTreeSet;

fn registry() -> Registry {
    let mut registry = Registry::new();
    effects_builtin::register(&mut registry).unwrap();
    effects_cartoon::register(&mut registry).unwrap();
    effects_surface::register(&mut registry).unwrap();
    registry
}

fn effects(arguments: &[&str]) -> Command {
    let mut command = Command::cargo_bin("inkstrand").unwrap();
    command.arg("effects").args(arguments);
    command
}

/// What the program writes as JSON.
fn schema(arguments: &[&str]) -> Value {
    let output = effects(arguments).arg("--json").output().unwrap();
    assert!(output.status.success());
    serde_json::from_slice(&output.stdout).unwrap()
}

#[test]
fn effects_and_sections_are_listed() {
    let mut all = contains("`inkstrand effects NAME`").count(1);
    effects(&[]).assert().success().stdout(all);
    for name in [
        "hair.base",
        "hair.silhouette",
        "preset",
        "clump",
        "camera",
        "layers",
        "style",
        "zones",
        "edits",
        "strands",
        "motion",
        "script",
        "moves",
        "keys",
        "winds",
    ] {
        all = contains(format!("\n{name} ")).count(1);
        effects(&[]).assert().success().stdout(all);
    }
}

#[test]
fn one_effect_or_section_is_described() {
    effects(&["hair.silhouette"])
        .assert()
        .success()
        .stdout(contains("width: a number from 0 to 100").and(contains("default 2.2; unit:")))
        .stdout(contains("; may vary").and(contains("(value: 2, vary: 0.2)")));
    effects(&["camera"])
        .assert()
        .success()
        .stdout(contains("camera: (name: value, ...)"))
        .stdout(contains(
            "yaw: a number from -360 to 360\n      default 0; unit: degrees",
        ));
    effects(&["layers"])
        .assert()
        .success()
        .stdout(contains("rank: a whole number").and(contains("default the effect's own")));
    effects(&["zones"])
        .assert()
        .success()
        .stdout(contains("roots: places").and(contains("hairline(FROM, TO)")))
        .stdout(contains("form: one of rows, tail, bun, braid"));
    for (wrong, right) in [
        ("hair.silhuette", "hair.silhouette"),
        ("camrea", "camera"),
        ("zone", "zones"),
    ] {
        effects(&[wrong])
            .assert()
            .code(2)
            .stderr(contains(format!("did you mean `{right}`?")));
    }
}

/// Holds the parameters of a schema against their table.
fn assert_is_table(schema: &Value, table: &[Param]) {
    let parameters = schema["parameters"].as_array().unwrap();
    assert_eq!(parameters.len(), table.len(), "{schema}");
    for (value, param) in parameters.iter().zip(table) {
        assert_eq!(value["name"], param.name);
        assert_eq!(value["meaning"], param.doc);
        assert_eq!(value["unit"].as_str().unwrap_or_default(), param.unit);
        let close = |name: &str, number: f32| {
            let given = value[name].as_f64().unwrap();
            assert_eq!(given as f32, number, "{}.{name}", param.name);
        };
        let kind = match param.kind {
            ParamKind::Number {
                min, max, varies, ..
            } => {
                assert_eq!(value["varies"], varies);
                close("min", min);
                close("max", max);
                "number"
            }
            ParamKind::Integer { min, max, .. } => {
                assert_eq!((&value["min"], &value["max"]), (&json!(min), &json!(max)));
                "integer"
            }
            ParamKind::Flag { default } => {
                assert_eq!(value["default"], default);
                "true or false"
            }
            ParamKind::Choice { names, .. } => {
                assert_eq!(value["choices"], json!(names));
                "choice"
            }
            ParamKind::Color { .. } => "color",
            ParamKind::OptionalColor { .. } => "color or none",
            ParamKind::Texture { repeats, .. } => {
                assert_eq!(value["repeats"], repeats);
                "texture"
            }
            ParamKind::Text => "text",
            ParamKind::Triple { min, max, .. } => {
                close("min", min);
                close("max", max);
                "three numbers"
            }
            ParamKind::Pair { min, max, .. } => {
                close("min", min);
                close("max", max);
                "two numbers"
            }
            ParamKind::Size { min, max, .. } => {
                assert_eq!((&value["min"], &value["max"]), (&json!(min), &json!(max)));
                "size"
            }
        };
        assert_eq!(value["type"], kind);
    }
}

/// The fields of a schema at their defaults, as a preset writes them.
fn defaults(schema: &Value) -> String {
    let parameters = schema["parameters"].as_array().unwrap();
    let fields = parameters
        .iter()
        .filter(|value| !value["default"].is_null());
    let fields = fields.map(|value| {
        let default = &value["default"];
        let text = match value["type"].as_str().unwrap() {
            "number" | "integer" | "true or false" => default.to_string(),
            "choice" | "texture" => default.as_str().unwrap().to_owned(),
            "color or none" if default == "none" => "none".to_owned(),
            "color" | "color or none" => default.to_string(),
            "three numbers" | "size" => default.to_string().replace('[', "(").replace(']', ")"),
            "text" => default.to_string(),
            other => panic!("type {other}"),
        };
        let name = value["name"].as_str().unwrap();
        format!("{name}: {text}")
    });
    fields.collect::<Vec<_>>().join(", ")
}

#[test]
fn the_schema_is_the_tables() {
    let registry = registry();
    let schema = schema(&[]);
    assert_eq!(schema["version"], stage::VERSION);
    let sections = schema["sections"].as_array().unwrap();
    assert_eq!(sections.len(), Sections::ALL.len() + 8);
    assert_eq!(sections[0]["id"], "preset");
    assert_is_table(&sections[0], Preset::TOP);
    for (section, (name, doc, table)) in sections[1..].iter().zip(Sections::ALL) {
        assert_eq!(
            (&section["id"], &section["meaning"]),
            (&json!(name), &json!(doc))
        );
        assert_is_table(section, table);
    }
    let layers = &sections[Sections::ALL.len() + 1];
    assert_eq!(layers["id"], "layers");
    assert_is_table(layers, LAYER);
    let brush = &sections[Sections::ALL.len() + 2];
    assert_eq!(brush["id"], "brush");
    assert_is_table(brush, BrushSection::TABLE);
    let meshes = &sections[Sections::ALL.len() + 3];
    assert_eq!(meshes["id"], "meshes");
    assert_is_table(meshes, MeshSection::TABLE);
    let lines = &sections[Sections::ALL.len() + 4];
    assert_eq!(lines["id"], "lines");
    assert_is_table(lines, LineSection::TABLE);
    let bodies = &sections[Sections::ALL.len() + 5];
    assert_eq!(bodies["id"], "bodies");
    assert_is_table(bodies, BODIES.table);
    let passes = &sections[Sections::ALL.len() + 6];
    assert_eq!(passes["id"], "passes");
    assert_is_table(passes, PassSection::TABLE);
    let objects = &sections[Sections::ALL.len() + 7];
    assert_eq!(objects["id"], "objects");
    assert_is_table(objects, ObjectSection::TABLE);
    for value in layers["parameters"].as_array().unwrap() {
        let own = OF_THE_EFFECT.contains(&value["name"].as_str().unwrap());
        assert!(!own || value["default"].is_null(), "{value}");
    }
    let effects = schema["effects"].as_array().unwrap();
    assert_eq!(effects.len(), registry.iter().count());
    for (value, effect) in effects.iter().zip(registry.iter()) {
        assert_eq!(
            (&value["id"], &value["rank"]),
            (&json!(effect.id()), &json!(effect.rank()))
        );
        assert_eq!(
            value["depth_offset"].as_f64().unwrap() as f32,
            effect.depth_offset()
        );
        assert_is_table(value, effect.params());
    }
    let parts = |name: &str| schema[name].as_array().unwrap();
    assert_eq!(parts("style").len(), STYLE_PARTS.len());
    assert_eq!(parts("motion").len(), MOTION_PARTS.len());
    let listed = parts("style").iter().chain(parts("motion"));
    for (value, part) in listed.zip(STYLE_PARTS.iter().chain(MOTION_PARTS)) {
        let parameters = value["parameters"].as_array().unwrap();
        let (table, places) = parameters.split_at(part.table.len());
        assert_is_table(&json!({ "parameters": table }), part.table);
        let names = places.iter().map(|place| place["name"].as_str().unwrap());
        assert!(names.eq(part.places.iter().map(|(name, _)| *name)));
    }
}

#[test]
fn a_part_of_the_schema_is_the_same_part() {
    let all = schema(&[]);
    for part in ["sections", "effects"] {
        for value in all[part].as_array().unwrap() {
            assert_eq!(schema(&[value["id"].as_str().unwrap()]), *value);
        }
    }
}

/// Adds the keys of all objects in a value, and the types of parameters.
fn collect(value: &Value, keys: &mut BTreeSet<String>, types: &mut BTreeSet<String>) {
    let Value::Object(fields) = value else {
        let list = value.as_array().into_iter().flatten();
        list.for_each(|value| collect(value, keys, types));
        return;
    };
    types.extend(fields.get("type").map(|kind| kind.as_str().unwrap().into()));
    for (key, value) in fields {
        keys.insert(key.clone());
        collect(value, keys, types);
    }
}

#[test]
fn help_says_all_that_there_is_in_json() {
    let (mut keys, mut types) = (BTreeSet::new(), BTreeSet::new());
    let schema = schema(&[]);
    collect(&schema, &mut keys, &mut types);
    let output = effects(&["--help"]).output().unwrap();
    let help = String::from_utf8(output.stdout).unwrap();

    let in_braces = help.split(['{', '}']).skip(1).step_by(2);
    let said = in_braces.flat_map(|names| names.split(','));
    let said: BTreeSet<String> = said
        .map(|name| name.trim().trim_end_matches('?').to_owned())
        .collect();
    assert_eq!(said, keys);

    let (_, table) = help.split_once("Types and their defaults").unwrap();
    let columns = table
        .lines()
        .map(|line| line.trim().split("  ").next().unwrap());
    let said: BTreeSet<String> = columns
        .flat_map(|names| names.split(", "))
        .map(str::to_owned)
        .collect();
    assert!(types.is_subset(&said), "{types:?} in {said:?}");

    // What has no default says so.
    for group in ["sections", "effects", "style", "motion"] {
        for owner in schema[group].as_array().unwrap() {
            for parameter in owner["parameters"].as_array().unwrap() {
                assert!(parameter.get("default").is_some(), "{parameter}");
            }
        }
    }
}

/// All values of a section, whether the preset gives them or not.
fn values(section: &dyn Section) -> Vec<effects::Value> {
    let rows = section.table().iter().enumerate();
    rows.map(|(index, param)| {
        let value = section.get(index);
        value.unwrap_or_else(|| param.kind.default_value())
    })
    .collect()
}

#[test]
fn a_preset_of_all_defaults_is_accepted_and_says_nothing_new() {
    let registry = registry();
    let schema = schema(&[]);
    let mut text = "(".to_owned();
    let (mut layer_fields, mut brush_fields) = (String::new(), String::new());
    for section in schema["sections"].as_array().unwrap() {
        let fields = defaults(section);
        match section["id"].as_str().unwrap() {
            "preset" => text += &format!("{fields}, "),
            "layers" => layer_fields = fields,
            "brush" => brush_fields = fields,
            "meshes" => text += &format!("meshes: [(file: \"eyes.obj\", {fields})], "),
            "lines" => text += &format!("lines: [(name: \"rim\", {fields})], "),
            "bodies" => text += &format!("bodies: [({fields})], "),
            "passes" => text += &format!("passes: [({fields})], "),
            // In place of most sections.
            "objects" => {}
            name => text += &format!("{name}: ({fields}), "),
        }
    }
    let layers = schema["effects"].as_array().unwrap().iter().map(|effect| {
        let params = defaults(effect);
        // What is said of strokes isn't of meshes, and the other way around.
        let own = registry.get(effect["id"].as_str().unwrap()).unwrap();
        let fields = layer_fields.split(", ").filter(|field| {
            let (name, _) = field.split_once(':').unwrap();
            may_say(own, name)
        });
        let mut fields: Vec<&str> = fields.collect();
        if own.is_for_meshes() || own.is_for_lines() {
            fields.push("on: \"*\"");
        }
        let brush = format!("brush: ({brush_fields})");
        fields.extend(may_say(own, "brush").then_some(&brush[..]));
        let fields = fields.join(", ");
        format!("(effect: {}, {fields}, params: ({params}))", effect["id"])
    });
    text += &format!("layers: [{}])", layers.collect::<Vec<_>>().join(", "));

    let preset = match Preset::parse("all.ron", &text, &registry) {
        Ok(preset) => preset,
        Err(errors) => panic!("{errors}"),
    };
    let layers =
        registry.iter().map(
            |effect| match effect.is_for_meshes() || effect.is_for_lines() {
                true => format!("(effect: \"{}\", on: \"*\")", effect.id()),
                false => format!("(effect: \"{}\")", effect.id()),
            },
        );
    let layers = layers.collect::<Vec<_>>().join(", ");
    let small = format!("(version: 1, layers: [{layers}])");
    let small = Preset::parse("small.ron", &small, &registry).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(preset.seed, small.seed);
    assert_eq!(preset.passes, [PassSection::default()]);
    assert_eq!(preset.bodies[0].section, BodySection::default());
    let mesh = MeshSection {
        file: Some("eyes.obj".to_owned()),
        ..MeshSection::default()
    };
    assert_eq!(preset.meshes[0].section, mesh);
    let lines = LineSection {
        name: Some("rim".to_owned()),
        ..LineSection::default()
    };
    assert_eq!(preset.lines[0].section, lines);
    let (mut all, mut none) = (preset.sections.clone(), small.sections.clone());
    for (name, ..) in Sections::ALL {
        let [all, none] = [&mut all, &mut none].map(|sections| sections.by_name(name).unwrap());
        assert_eq!(values(all), values(none), "{name}");
    }
    for (all, none) in preset.layers.iter().zip(&small.layers) {
        assert_eq!(values(&all.values), values(&none.values));
        assert_eq!((&all.name, all.rank), (&none.name, none.rank));
        assert_eq!(all.depth_offset, none.depth_offset);
        assert_eq!(all.brush, none.brush);
    }
}
