//! Whole presets: what they mean, and every mistake at its place.

use effects::Registry;
use stage::{Files, Preset};

fn registry() -> Registry {
    let mut registry = Registry::new();
    effects_builtin::register(&mut registry).unwrap();
    registry
}

fn errors(text: &str) -> String {
    let registry = registry();
    match Preset::parse("look.ron", text, &registry) {
        Ok(_) => panic!("this should be refused:\n{text}"),
        Err(errors) => errors.to_string(),
    }
}

const SMALL: &str = "(version: 1, layers: [(effect: \"hair.base\")])";

#[test]
fn a_preset_needs_little() {
    let registry = registry();
    let preset = Preset::parse("look.ron", SMALL, &registry).unwrap();
    assert_eq!(preset.sections.camera.fov, 30.0);
    assert_eq!(preset.sections.scene.size, [960, 720]);
    assert_eq!(preset.layers[0].rank, 0);
}

#[test]
fn comments_and_names_of_sections_do_not_move_errors() {
    let text = "// a look\n(\n    version: 1,\n    /* é */ camera: (yaw: 20, pich: 3),\n    layers: [],\n)";
    assert!(
        errors(text).starts_with("look.ron:4:31: camera has no `pich`, did you mean `pitch`?"),
        "{}",
        errors(text)
    );
}

#[test]
fn all_mistakes_of_a_file_come_at_once() {
    let text = r#"(
    version: 1,
    seed: -3,
    hiar: (file: "a.tfx"),
    scene: (size: (0, 720), background: "blue"),
    camera: (target: (0, 1)),
    light: (fixed_to: world, kind: sun),
    clump: (mix: 2.0, shading: difuse),
    layers: [(effect: "hair.bose")],
)"#;
    let errors = errors(text);
    for line in [
        "look.ron:3:11: seed: expected a whole number from 0",
        "look.ron:4:5: a preset has no `hiar`, did you mean `hair`?",
        "look.ron:5:19: size: expected width and height",
        "look.ron:5:41: background: expected a colour such as \"3FC1C0\", or none",
        "look.ron:6:22: target: expected three numbers",
        "look.ron:7:36: kind: there is no `sun`; there are: direction, point",
        "look.ron:8:18: mix: expected a number from 0 to 1, found `2.0`",
        "look.ron:8:32: shading: there is no `difuse`, did you mean `diffuse`?",
        "look.ron:9:23: there is no effect `hair.bose`, did you mean `hair.base`?",
    ] {
        assert!(errors.contains(line), "`{line}` is missing in:\n{errors}");
    }
}

#[test]
fn versions() {
    assert!(
        errors("(version: 2, unheard_of: 3)")
            .contains("look.ron:1:11: this preset is of version 2, this build reads up to 1")
    );
    assert_eq!(
        errors("(version: 2, unheard_of: 3)")
            .matches("look.ron:")
            .count(),
        1
    );
    assert!(errors("(layers: [])").contains("needs `version: 1`"));
    assert!(errors("(version: 0, layers: [])").contains("look.ron:1:11: version: expected"));
    assert!(errors("(version: one, layers: [])").contains("look.ron:1:11: version: expected"));
}

#[test]
fn hostile_texts_are_errors() {
    let deep = "(".repeat(100_000);
    let unclosed = SMALL.trim_end_matches(')');
    for text in [
        "",
        "()",
        "[]",
        "3",
        "(version: 1",
        "\u{0}",
        "(version: 1, layers: 3)",
        &deep,
        unclosed,
        "\u{feff}(",
    ] {
        assert!(errors(text).starts_with("look.ron:"), "{text:.40}");
    }
    // Every beginning of a good preset is an error with a place, never a panic.
    let preset = include_str!("../../../presets/twin-tails.ron");
    for end in (0..preset.trim_end().len()).filter(|i| preset.is_char_boundary(*i)) {
        assert!(
            errors(&preset[..end]).starts_with("look.ron:"),
            "cut at {end}"
        );
    }
}

#[test]
fn missing_files_are_named_at_their_place_in_the_preset() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("bob.tfx"), "").unwrap();
    let files = Files {
        preset_folder: folder.path().to_owned(),
        ..Files::default()
    };
    let registry = registry();
    let text = "(version: 1, layers: [],\n head: (file: \"b.obj\"), hair: (file: \"bab.tfx\"))";
    let mut preset = Preset::parse("look.ron", text, &registry).unwrap();
    let errors = preset.check_files(&files).unwrap_err();
    let places: Vec<_> = errors
        .0
        .iter()
        .map(|e| (e.place.line, e.place.column))
        .collect();
    assert_eq!(places, [(2, 15), (2, 38)]);
    assert!(
        errors.0[1]
            .message
            .ends_with("bab.tfx`, did you mean `bob.tfx`?"),
        "{errors}"
    );

    // Together with all other mistakes, in the file's order.
    let wrong = text.replace("layers", "sed: 1, layers");
    let errors = Preset::check("look.ron", &wrong, &registry, &files).unwrap_err();
    let lines: Vec<_> = errors.0.iter().map(|e| e.place.line).collect();
    assert_eq!(lines, [1, 2, 2], "{errors}");
    assert!(Preset::check("look.ron", SMALL, &registry, &files).is_ok());

    // What the caller gives instead is looked for by whoever reads it.
    let given = Files {
        hair: Some("other.tfx".into()),
        ..files.clone()
    };
    assert_eq!(preset.check_files(&given).unwrap_err().0.len(), 1);
    preset.set("head.file", "other.obj").unwrap();
    assert!(preset.check_files(&given).is_ok());
    preset.set("hair.file", "bob.tfx").unwrap();
    assert!(preset.check_files(&files).is_ok());
}

#[test]
fn set_reaches_layers_and_sections() {
    let registry = registry();
    let text = "(version: 1, layers: [(effect: \"hair.base\"), (effect: \"hair.silhouette\", name: \"line\")])";
    let mut preset = Preset::parse("look.ron", text, &registry).unwrap();
    preset.set("line.width", "4").unwrap();
    preset.set("hair.base.brightness", "0.5").unwrap();
    preset.set("clump.size", "2").unwrap();
    preset.set("scene.background", "none").unwrap();
    assert_eq!(preset.layers[1].values.number("width"), 4.0);
    assert_eq!(preset.layers[0].values.number("brightness"), 0.5);
    assert_eq!(preset.sections.clump.0.number("size"), 2.0);
    assert_eq!(preset.sections.scene.background, None);
    assert!(
        preset
            .set("lime.width", "4")
            .unwrap_err()
            .to_string()
            .contains("did you mean `line`?")
    );
    assert!(
        preset
            .set("width", "4")
            .unwrap_err()
            .to_string()
            .contains("LAYER.PARAM")
    );
    preset.set("seed", "7").unwrap();
    assert_eq!(preset.seed, 7);
    let error = preset.set("seed", "-7").unwrap_err().to_string();
    assert!(error.contains("seed: expected a whole number"), "{error}");
    assert!(preset.set("version", "1").is_err());

    assert!(preset.keep_only(&["liine".to_owned()]).is_err());
    preset.keep_only(&["line".to_owned()]).unwrap();
    assert_eq!(preset.layers.len(), 1);
}

#[test]
fn defaults_are_within_their_own_ranges() {
    use effects::{Param, ParamKind};
    fn legal(param: &Param) -> bool {
        match param.kind {
            ParamKind::Number {
                min, max, default, ..
            } => (min..=max).contains(&default),
            ParamKind::Integer { min, max, default } => (min..=max).contains(&default),
            ParamKind::Flag { .. } => true,
            ParamKind::Choice { names, default } => default < names.len(),
            ParamKind::Color { default } => effects::parse_hex(default).is_some(),
            ParamKind::OptionalColor { default } => {
                default.is_none_or(|hex| effects::parse_hex(hex).is_some())
            }
            ParamKind::Texture { default, .. } => {
                effects::preset::read_value(default, &param.kind).is_ok()
            }
            ParamKind::Text => true,
            ParamKind::Triple { min, max, default } => {
                default.iter().all(|x| (min..=max).contains(x))
            }
            ParamKind::Pair { min, max, default } => {
                default.iter().all(|x| (min..=max).contains(x))
            }
            ParamKind::Size { min, max, default } => {
                default.iter().all(|x| (min..=max).contains(x))
            }
        }
    }
    for (section, doc, table) in stage::Sections::ALL {
        assert!(!doc.is_empty());
        for param in *table {
            assert!(legal(param), "{section}.{}", param.name);
            assert!(
                param.doc.ends_with('.'),
                "{section}.{}: {}",
                param.name,
                param.doc
            );
        }
    }
}

#[test]
fn passes_are_a_list_whose_lines_are_set_by_number() {
    let registry = registry();
    let text = "(version: 1, layers: [], passes: [(width: 2), (edges: object, width: (curve: [(0, 0), (1, 3)]), fade: 0.4)])";
    let mut preset = Preset::parse("look.ron", text, &registry).unwrap();
    assert_eq!(preset.passes.len(), 2);
    assert_eq!(preset.passes[0].edges, stage::EdgesChoice::Strand);
    assert_eq!(preset.passes[1].width.at(0.5), 1.5);
    preset.set("passes.2.fade", "0.1").unwrap();
    preset.set("passes.1.edges", "level").unwrap();
    assert_eq!(preset.passes[1].fade, 0.1);
    assert_eq!(preset.passes[0].edges, stage::EdgesChoice::Level);
    for (name, message) in [
        (
            "passes.3.fade",
            "no pass `3`: they are passes.1 to passes.2",
        ),
        ("passes.0.fade", "no pass `0`"),
        ("passes.one.fade", "no pass `one`"),
        (
            "passes.1.fad",
            "passes.1 has no `fad`, did you mean `fade`?",
        ),
        ("passes.fade", "by their numbers, such as passes.1.fade"),
        ("bodies.radius", "by their numbers, such as bodies.1.radius"),
        ("zones.fringe.count", "`zones` is a list of a hair style"),
        ("winds.speed", "`winds` is a list of a motion script"),
        ("layers.zones", "layers are set by their names"),
    ] {
        let error = preset.set(name, "1").unwrap_err().to_string();
        assert!(error.contains(message), "{name}: {error}");
    }
}

#[test]
fn mistakes_in_passes_are_told_at_their_place() {
    for (passes, message) in [
        (
            "(edges: strand, edges_width: 2)",
            "2:9: passes is a list, of one set of lines too: passes: [(edges: strand, width: 1.5",
        ),
        ("3", "2:9: passes is a list, written [..., ...], found `3`"),
        (
            "[(edges: strands)]",
            "2:18: edges: there is no `strands`, did you mean `strand`?",
        ),
        (
            "[(), (widht: 2)]",
            "2:15: a pass has no `widht`, did you mean `width`?",
        ),
        (
            "[(fade: (curve: [(0, 1)]))]",
            "2:17: fade: expected a number from 0 to 1",
        ),
    ] {
        let errors = errors(&format!("(version: 1, layers: [],\npasses: {passes})"));
        assert!(
            errors.starts_with(&format!("look.ron:{message}")),
            "{errors}"
        );
    }
    let many = "(),".repeat(65);
    let errors = errors(&format!("(version: 1, layers: [], passes: [{many}])"));
    assert!(
        errors.contains("there are 65, and at most 64 are drawn"),
        "{errors}"
    );
}
