//! What an author reads for each mistake, held as snapshots: read them as an author who has never
//! seen the code. `INSTA_UPDATE=always cargo test -p inkstrand --test mistakes` accepts changes.

use effects::Registry;
use stage::{Files, Preset};
use std::fmt::Write as _;
use std::fs;

fn registry() -> Registry {
    let mut registry = Registry::new();
    effects_builtin::register(&mut registry).unwrap();
    effects_cartoon::register(&mut registry).unwrap();
    effects_surface::register(&mut registry).unwrap();
    registry
}

/// The messages for one preset.
fn messages(registry: &Registry, text: &str) -> String {
    match Preset::parse("look.ron", text, registry) {
        Ok(_) => panic!("this should be refused:\n{text}"),
        Err(errors) => errors.to_string(),
    }
}

/// A good preset with `from` replaced by `to`.
fn spoilt(from: &str, to: &str) -> String {
    const GOOD: &str = r#"// A look.
(
    version: 1,
    hair: (file: "bob.strands.ron", guides: 150),
    scene: (size: (960, 720), background: "FFFFFF"),
    camera: (yaw: 25, target: (0, -0.5, 0)),
    path: (kind: linear),
    clump: (size: 0.8, color: "3FC1C0"),
    layers: [
        (effect: "hair.silhouette", params: (width: 2.4, color: "124A57")),
        (effect: "hair.base"),
    ],
)
"#;
    assert_eq!(GOOD.matches(from).count(), 1, "`{from}`");
    GOOD.replacen(from, to, 1)
}

/// The messages for each spoilt preset, under a line that says what was done to it.
fn report(mistakes: &[(&str, &str)]) -> String {
    let registry = registry();
    let mut report = String::new();
    for (from, to) in mistakes {
        let messages = messages(&registry, &spoilt(from, to));
        let _ = writeln!(report, "## {from:?} -> {to:?}\n{messages}\n");
    }
    report
}

#[test]
fn punctuation() {
    let report = report(&[
        ("version: 1,", "version: 1"),
        ("width: 2.4,", "width: 2.4"),
        ("width: 2.4,", "width: 2.4;"),
        ("width: 2.4,", "width: 2.4,,"),
        ("width: 2.4,", "width: 2,4,"),
        ("width: 2.4", "width = 2.4"),
        ("width: 2.4", "width 2.4"),
        ("width: 2.4", "width"),
        ("width: 2.4", "width:"),
        ("width: 2.4", "\"width\": 2.4"),
        ("width: 2.4", "2.4"),
        ("width: 2.4", "width:\t2.4 px"),
        ("camera: (", "camera ("),
        ("    ],\n", "    ]\n    seed: 3\n"),
        ("\"124A57\")),", "\"124A57\"))"),
    ]);
    insta::assert_snapshot!(report);
}

#[test]
fn brackets_quotes_and_comments() {
    let report = report(&[
        (
            "(yaw: 25, target: (0, -0.5, 0)),",
            "(yaw: 25, target: (0, -0.5, 0),",
        ),
        ("\"124A57\")),", "\"124A57\"),"),
        ("\"124A57\")),", "\"124A57\"))),"),
        ("    ],\n)\n", "    ],\n"),
        ("    ],\n)\n", "    ]\n"),
        ("    ],\n)\n", "    ),\n)\n"),
        ("    ],\n)\n", "    ],\n))\n"),
        ("    ],\n)\n", "    ],\n)\nseed: 3\n"),
        ("// A look.\n(\n", ""),
        (
            "camera: (yaw: 25, target",
            "camera: (\n        yaw: 25), target",
        ),
        ("\"124A57\"", "\"124A57"),
        ("\"124A57\"", "124A57\""),
        ("// A look.", "/* A look."),
        (
            "clump: (size: 0.8, color: \"3FC1C0\")",
            "clump: [size: 0.8, color: \"3FC1C0\"]",
        ),
        (
            "clump: (size: 0.8, color: \"3FC1C0\")",
            "clump: {size: 0.8, color: \"3FC1C0\"}",
        ),
        (
            "clump: (size: 0.8, color: \"3FC1C0\")",
            "clump: Clump(size: 0.8, color: \"3FC1C0\")",
        ),
        ("clump: (size: 0.8, color: \"3FC1C0\")", "clump: 0.8"),
        ("(effect: \"hair.base\"),\n", "\"hair.base\",\n"),
        ("(effect: \"hair.base\"),\n", "effect: \"hair.base\",\n"),
        ("(effect: \"hair.base\"),\n", "[effect: \"hair.base\"],\n"),
        (
            "params: (width: 2.4, color: \"124A57\")",
            "params: [width: 2.4]",
        ),
    ]);
    insta::assert_snapshot!(report);
    let registry = registry();
    let list = "(version: 1, layers: ((effect: \"hair.base\")))";
    let texts = [
        "",
        "// nothing\n",
        "[]",
        "3",
        "Preset(version: 1)",
        list,
        "#![enable(implicit_some)]\n(version: 1)",
    ];
    let mut report = String::new();
    for text in texts {
        let _ = writeln!(report, "## {text:?}\n{}\n", messages(&registry, text));
    }
    insta::assert_snapshot!("whole_files", report);
}

#[test]
fn names() {
    let report = report(&[
        ("hair.silhouette", "hair.silhuette"),
        ("\"hair.silhouette\"", "\"Hair.Silhouette\""),
        ("\"hair.silhouette\"", "\"watercolour\""),
        ("\"hair.silhouette\"", "hair.silhouette"),
        ("(effect: \"hair.base\")", "(name: \"base\")"),
        (
            "(effect: \"hair.base\")",
            "(effect: \"hair.base\", name: \"hair.silhouette\")",
        ),
        (
            "(effect: \"hair.base\")",
            "(effect: \"hair.base\", parms: (brightness: 1))",
        ),
        (
            "(effect: \"hair.base\")",
            "(effect: \"hair.base\", brightness: 1)",
        ),
        ("clump: (", "Clump: ("),
        ("clump: (", "brush: ("),
        ("clump: (size", "clump: (bulk"),
        ("width: 2.4", "widht: 2.4"),
        ("width: 2.4", "width: 2.4, width: 3"),
        (
            "    path: (kind: linear),\n",
            "    path: (kind: linear),\n    path: (kind: linear),\n",
        ),
        ("    version: 1,\n", ""),
        ("version: 1", "version: 2, unheard: of"),
        ("version: 1", "version: 0"),
        ("version: 1", "version: \"1\""),
    ]);
    insta::assert_snapshot!(report);
}

#[test]
fn values() {
    let report = report(&[
        ("width: 2.4", "width: -2.4"),
        ("width: 2.4", "width: NaN"),
        ("width: 2.4", "width: -inf"),
        ("width: 2.4", "width: 1e999"),
        ("width: 2.4", "width: \"2.4\""),
        ("width: 2.4", "width: 2.4px"),
        ("width: 2.4", "width: True"),
        ("width: 2.4", "width: (2.4)"),
        ("width: 2.4", "width: Some(2.4)"),
        ("yaw: 25", "yaw: 25°"),
        ("guides: 150", "guides: 150.5"),
        ("guides: 150", "guides: -1"),
        (
            "guides: 150",
            "guides: 1_000_000_000_000_000_000_000_000_000_000_000_000_000_000_000",
        ),
        ("kind: linear", "kind: \"linear\""),
        ("kind: linear", "kind: Linear"),
        ("kind: linear", "kind: bezier"),
        ("kind: linear", "kind: 0"),
        ("\"3FC1C0\"", "3FC1C0"),
        ("\"3FC1C0\"", "#3FC1C0"),
        ("\"3FC1C0\"", "'3FC1C0'"),
        ("\"3FC1C0\"", "“3FC1C0”"),
        ("\"3FC1C0\"", "\"3FC\""),
        ("\"3FC1C0\"", "\"turquoise\""),
        ("\"3FC1C0\"", "(63, 193, 192)"),
        ("\"3FC1C0\"", "none"),
        ("\"FFFFFF\"", "None"),
        ("\"FFFFFF\"", "\"none\""),
        ("(960, 720)", "960x720"),
        ("(960, 720)", "[960, 720]"),
        ("(960, 720)", "(960, 0)"),
        ("(960, 720)", "(960)"),
        ("(0, -0.5, 0)", "[0, -0.5, 0]"),
        ("(0, -0.5, 0)", "(0, -0.5)"),
        ("(0, -0.5, 0)", "(x: 0, y: -0.5, z: 0)"),
        ("(0, -0.5, 0)", "(0, NaN, 0)"),
        ("\"bob.strands.ron\"", "bob.strands.ron"),
        ("\"bob.strands.ron\"", "\"C:\\hair\\bob.tfx\""),
        ("\"bob.strands.ron\"", "\"\""),
    ]);
    insta::assert_snapshot!(report);
}

#[test]
fn missing_files() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["bob.strands.ron", "bust.obj", "notes.txt"] {
        fs::write(folder.path().join(name), "").unwrap();
    }
    fs::create_dir(folder.path().join("hair")).unwrap();
    let registry = registry();
    let mut report = String::new();
    for (hair, head) in [
        ("bob.strand.ron", "Bust.OBJ.obj"),
        ("groom.tfx", "hair"),
        ("grooms/a.tfx", "../nowhere/b.obj"),
    ] {
        let text = format!(
            "(\n    version: 1,\n    hair: (file: \"{hair}\"),\n    head: (up: y, file: \"{head}\"),\n    layers: [],\n)"
        );
        let preset = Preset::parse("look.ron", &text, &registry).unwrap();
        let files = Files {
            preset_folder: folder.path().to_owned(),
            ..Files::default()
        };
        let errors = preset.check_files(&files).unwrap_err().to_string();
        let errors = errors.replace(&folder.path().display().to_string(), "FOLDER");
        let _ = writeln!(report, "{errors}\n");

        let mut given = files.clone();
        given.hair = Some("other.tfx".into());
        given.head = Some("other.obj".into());
        assert!(
            preset.check_files(&given).is_ok(),
            "these files are not read"
        );
    }
    insta::assert_snapshot!(report);
}
