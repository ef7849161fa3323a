//! Every parameter of every table is shown, and has a name.

use crate::pane::{Kind, Pane, names, open_all};
use effects::Param;
use effects::preset::{LAYER, may_say};
use egui_kittest::Harness;
use stage::{
    BODIES, LINES, MESHES, MOTION_PARTS, ObjectSection, PASSES, Preset, STYLE_PARTS, Sections,
};
use std::path::{Path, PathBuf};

fn presets() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../presets")
}

fn opened<'a>(kind: Kind, text: &str, width: f32) -> Harness<'a, Pane> {
    let mut harness = Pane::new(kind, text).harness(width);
    open_all(&mut harness);
    assert_eq!(harness.state().text, text);
    harness
}

/// Asserts that each parameter of the table has a control, or several.
fn has_all(names: &[String], owner: &str, table: &[Param], but: &[&str]) {
    for param in table.iter().filter(|param| !but.contains(&param.name)) {
        let name = format!("{owner} {}", param.name);
        let part = format!("{name} ");
        let found = names
            .iter()
            .any(|known| *known == name || known.starts_with(&part));
        assert!(found, "no {name} in {names:#?}");
    }
}

#[test]
fn every_section_is_there() {
    for width in [300.0, 700.0] {
        let harness = opened(Kind::Look, "(version: 1, layers: [])", width);
        let names = names(&harness);
        has_all(&names, "preset", Preset::TOP, &[]);
        for (name, _, table) in Sections::ALL {
            has_all(&names, name, table, &[]);
        }
    }
    let passes = "(version: 1, layers: [], passes: [(edges: level), ()])";
    let names_of_passes = names(&opened(Kind::Look, passes, 300.0));
    has_all(&names_of_passes, "pass 1: level", PASSES.table, &[]);
    has_all(&names_of_passes, "pass 2: strand", PASSES.table, &[]);
    let meshes = "(version: 1, layers: [], meshes: [(file: \"eyes.obj\")])";
    let names_of_meshes = names(&opened(Kind::Look, meshes, 300.0));
    has_all(&names_of_meshes, "mesh 1: eyes.obj", MESHES.table, &[]);
    let lines = "(version: 1, layers: [], lines: [(name: \"rim\")])";
    let names_of_lines = names(&opened(Kind::Look, lines, 300.0));
    has_all(&names_of_lines, "lines 1: rim", LINES.table, &[]);
    let bodies = "(version: 1, layers: [], bodies: [(name: \"ball\"), (shape: capsule)])";
    let names_of_bodies = names(&opened(Kind::Look, bodies, 300.0));
    has_all(&names_of_bodies, "body 1: ball", BODIES.table, &[]);
    has_all(&names_of_bodies, "body 2: capsule", BODIES.table, &[]);
    let objects = "(version: 1, objects: [(preset: \"a.ron\"), (preset: \"b.ron\")])";
    let harness = opened(Kind::Look, objects, 300.0);
    let names = names(&harness);
    has_all(&names, "object 2", ObjectSection::TABLE, &[]);
    assert!(!names.contains(&"clump size".to_owned()));
}

#[test]
fn every_effect_is_there() {
    let registry = inkstrand::builtin_effects();
    let layers = registry
        .iter()
        .map(|effect| format!("(effect: \"{}\")", effect.id()));
    let text = format!(
        "(version: 1, layers: [{}])",
        layers.collect::<Vec<_>>().join(", ")
    );
    let names = names(&opened(Kind::Layers, &text, 300.0));
    for effect in registry.iter() {
        has_all(&names, effect.id(), effect.params(), &[]);
        let own = LAYER.iter().filter(|param| may_say(effect, param.name));
        let own: Vec<Param> = own.copied().collect();
        has_all(&names, effect.id(), &own, &["effect"]);
    }
}

#[test]
fn every_part_of_styles_is_there() {
    let text = "(version: 1, whorl: (0, 1), zones: [(name: \"a\", roots: whorl, tips: [(0, 1)])], \
                edits: [(zone: \"a\")], strands: [(points: [(0, 1, 0), (0, 2, 0)])], \
                accessories: [(at: [(0, 1)])])";
    let names = names(&opened(Kind::Style, text, 300.0));
    let owners = ["style", "zone a", "edit 1: a 0", "strand 1", "accessory 1"];
    assert_eq!(owners.len(), STYLE_PARTS.len());
    for (part, owner) in STYLE_PARTS.iter().zip(owners) {
        has_all(&names, owner, part.table, &[]);
        for (place, _) in part.places {
            assert!(
                names.contains(&format!("{owner} {place}")),
                "{owner} {place} in {names:#?}"
            );
        }
    }
}

#[test]
fn every_part_of_scripts_is_there() {
    let text = "(version: 1, moves: [()], keys: [()], winds: [()], shapes: [(hair: \"a.tfx\")], \
                bodies: [(name: \"ball\")], body_keys: [(body: \"ball\")])";
    let names = names(&opened(Kind::Motion, text, 300.0));
    let owners = [
        "script",
        "move 1: turn at 0 s",
        "key 1: 0 s",
        "wind 1: at 0 s",
        "shape 1: 0 s",
        "body 1: ball",
        "body key 1: ball at 0 s",
    ];
    assert_eq!(owners.len(), MOTION_PARTS.len());
    for (part, owner) in MOTION_PARTS.iter().zip(owners) {
        has_all(&names, owner, part.table, &[]);
    }
}

#[test]
fn all_presets_styles_and_scripts_are_shown_and_left_alone() {
    let mut count = 0;
    for (folder, ending, kind) in [
        ("", ".ron", Kind::Layers),
        ("", ".ron", Kind::Look),
        ("styles", ".style.ron", Kind::Style),
        ("motions", ".style.ron", Kind::Style),
        ("motions", ".motion.ron", Kind::Motion),
    ] {
        // One window for all, as a new one draws its letters anew.
        let mut harness = Pane::new(kind, "").harness(300.0);
        for file in std::fs::read_dir(presets().join(folder)).unwrap() {
            let path = file.unwrap().path();
            let name = path.to_string_lossy().into_owned();
            if path.is_file() && name.ends_with(ending) {
                let text = std::fs::read_to_string(&path).unwrap();
                harness.state_mut().text.clone_from(&text);
                harness.run();
                open_all(&mut harness);
                assert_eq!(harness.state().text, text, "{name}");
                assert_eq!(harness.state().edits, [], "{name}");
                count += 1;
            }
        }
    }
    assert!(count > 20, "{count}");
}

#[test]
fn broken_texts_are_shown_as_far_as_they_go() {
    for text in [
        "",
        "(",
        "()",
        "[1, 2]",
        "(version: 1, camera: 3, layers: 4, zones: 5, moves: (6))",
        "(layers: [7, (), (effect: hair), (effect: \"x\", params: 8)], zones: [9, ()], keys: [(time: x), 1])",
        "(zones: [(name: \"a\", roots: [(0, 1), 2], tips: (3))], edits: [1, (zone: 2)], strands: [(points: 3)])",
        "(version: 1, camera: (yaw: , pitch 3))",
        "(camera: (yaw: 1), camera: (yaw: 2), \"é\": 3)",
    ] {
        for kind in [Kind::Layers, Kind::Look, Kind::Style, Kind::Motion] {
            opened(kind, text, 300.0);
        }
    }
}

#[test]
fn nothing_is_wider_than_the_pane() {
    for (kind, file) in [
        (Kind::Layers, "twin-tails.ron"),
        (Kind::Look, "twin-tails.ron"),
        (Kind::Style, "styles/layered-medium.style.ron"),
        (Kind::Motion, "motions/take-off.motion.ron"),
    ] {
        let text = std::fs::read_to_string(presets().join(file)).unwrap();
        let harness = opened(kind, &text, 280.0);
        for name in names(&harness) {
            use egui_kittest::kittest::Queryable;
            for node in harness.query_all_by_label(&name) {
                assert!(
                    node.rect().right() <= 280.5,
                    "{kind:?} {name}: {:?}",
                    node.rect()
                );
            }
        }
    }
}
