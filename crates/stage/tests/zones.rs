//! Layers that draw on the hair of some zones of its style alone.

use effects::Registry;
use stage::{Files, Preset, Stage, StageError};
use std::fs;
use std::path::{Path, PathBuf};

/// Two zones that are no mirrors of themselves, and a clump drawn by hand, which is in none.
const STYLE: &str = r#"(
    version: 1, undercoat: false,
    zones: [
        (name: "fringe", count: 5, roots: [(-40, 60), (40, 60)], hang: 0.3),
        (name: "tail-left", count: 4, roots: [(150, 10), (170, 10)], hang: 0.8),
    ],
    strands: [(points: [(0, 80, 0), (0, 60, 0.1), (0, 40, 0.1)])],
)"#;

fn registry() -> Registry {
    let mut registry = Registry::new();
    effects_builtin::register(&mut registry).unwrap();
    effects_surface::register(&mut registry).unwrap();
    effects_cartoon::register(&mut registry).unwrap();
    registry
}

/// A folder of this test's own with the style in it.
fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("zones-{name}"));
    fs::create_dir_all(&folder).unwrap();
    fs::write(folder.join("two.style.ron"), STYLE).unwrap();
    folder
}

fn preset(layers: &str) -> String {
    format!(
        "(version: 1, hair: (file: \"two.style.ron\"), head: (shape: bust),\n\
         layers: [{layers}])"
    )
}

fn in_folder(folder: &Path) -> Files {
    Files {
        preset_folder: folder.to_owned(),
        ..Files::default()
    }
}

/// How many strands each layer draws on, which are the layers' zones and hair of no zone.
fn drawn(name: &str, layers: &str) -> Vec<usize> {
    let registry = registry();
    let preset = Preset::parse("look.ron", &preset(layers), &registry).unwrap();
    let mut stage = Stage::new(&preset, &in_folder(&folder(name))).unwrap();
    let frame = stage.frame().unwrap();
    let layers = frame.objects[0].layers.len();
    let of_layer = |layer| {
        let strands = frame.strands.iter();
        strands
            .filter(|strand| !strand.is_left_out_by(layer))
            .count()
    };
    (0..layers).map(of_layer).collect()
}

#[test]
fn a_layer_draws_on_its_zones_alone() {
    let layers = r#"(effect: "hair.base"), (effect: "hair.silhouette", zones: "fringe"),
        (effect: "hair.cel", zones: "Tail*"), (effect: "hair.highlight", zones: "fringe, tail-left")"#;
    assert_eq!(drawn("alone", layers), [10, 5, 4, 9]);
}

#[test]
fn fine_hairs_come_loose_from_these_zones_alone() {
    let count = |name: &str, zones: &str| {
        let layers = format!("(effect: \"hair.fine\", {zones} params: (per_strand: 3))");
        let registry = registry();
        let preset = Preset::parse("look.ron", &preset(&layers), &registry).unwrap();
        let mut stage = Stage::new(&preset, &in_folder(&folder(name))).unwrap();
        let frame = stage.frame().unwrap();
        let drawn = frame.objects[0].layer_joints[0].clone();
        let runs = frame.paths.runs.iter();
        runs.filter(|run| drawn.contains(&run.joints.start)).count()
    };
    let (all, some) = (
        count("fine-all", ""),
        count("fine-some", "zones: \"tail*\","),
    );
    assert!(all > 20 && some > 0 && some < all / 2, "{some} of {all}");
}

/// Joints of strips of light on hair of this style, with how much there is of each.
fn strips(name: &str, style: &str, zones: &str) -> Vec<(glam::Vec3, f32)> {
    let folder = folder(name);
    fs::write(folder.join("two.style.ron"), style).unwrap();
    let shines = "params: (exponent: 1, threshold: 0, full: 0, longest: 4)";
    let text = preset(&format!("(effect: \"hair.zigzag\", {zones} {shines})"));
    let registry = registry();
    let preset = Preset::parse("look.ron", &text, &registry).unwrap();
    let mut stage = Stage::new(&preset, &in_folder(&folder)).unwrap();
    let frame = stage.frame().unwrap();
    let drawn = frame.objects[0].layer_joints[0].clone();
    let of_joint = |joint: usize| (frame.paths.position[joint], frame.path_weights[joint]);
    drawn.map(of_joint).collect()
}

/// Hair of other zones takes no part in a strip, and doesn't end it.
#[test]
fn strips_of_light_lie_on_these_zones_as_if_they_were_all_hair() {
    let fringe = STYLE.find("        (name: \"fringe\"").unwrap();
    let end = STYLE.find("        (name: \"tail-left\"").unwrap();
    let tail_alone = [&STYLE[..fringe], &STYLE[end..]].concat();
    let some = strips("strips-some", STYLE, "zones: \"tail*\",");
    assert!(some.iter().any(|(_, weight)| *weight > 0.0));
    assert!(some == strips("strips-tail", &tail_alone, ""));
    assert!(some != strips("strips-all", STYLE, ""));
}

fn mistakes(layers: &str, name: &str) -> String {
    let (registry, text) = (registry(), preset(layers));
    let preset = Preset::parse("look.ron", &text, &registry).unwrap();
    let files = in_folder(&folder(name));
    let errors = preset.check_scene("look.ron", &text, &files).unwrap_err();
    errors.to_string()
}

#[test]
fn a_zone_that_is_not_there_is_a_mistake_at_its_place() {
    let said = mistakes(
        "(effect: \"hair.base\", zones: \"fringe, tial-left\")",
        "typo",
    );
    assert!(
        said.contains(
            "look.ron:2:39: the hair's style has no zone `tial-left`, did you mean `tail-left`?"
        ),
        "{said}"
    );
    let layers: Vec<String> = (0..33)
        .map(|i| format!("(effect: \"hair.base\", name: \"{i}\", zones: \"fringe\")"))
        .collect();
    let said = mistakes(&layers.join(","), "many");
    assert!(
        said.contains("only the first 32 layers may say their zones"),
        "{said}"
    );
    assert_eq!(said.matches("only the first").count(), 1, "{said}");
}

#[test]
fn layers_that_draw_no_strokes_are_not_counted() {
    let draws = |count: usize| {
        let of = |i: usize| format!("(effect: \"hair.base\", name: \"{i}\", zones: \"fringe\")");
        (0..count).map(of).collect::<Vec<String>>().join(",")
    };
    let others =
        "(effect: \"line.ink\", on: \"rim\"), (effect: \"hair.fine\", params: (width: 0)),";
    let lines = "], lines: [(name: \"rim\", of: \"*\")";
    let layers = |count: usize| format!("{others} {}{lines}", draws(count));
    let (registry, text) = (registry(), preset(&layers(32)));
    let preset = Preset::parse("look.ron", &text, &registry).unwrap();
    let files = in_folder(&folder("uncounted"));
    preset.check_scene("look.ron", &text, &files).unwrap();
    let said = mistakes(&layers(33), "uncounted-more");
    assert_eq!(said.matches("only the first").count(), 1, "{said}");
}

#[test]
fn one_that_is_set_is_a_mistake_of_its_layer() {
    let registry = registry();
    let mut preset =
        Preset::parse("look.ron", &preset("(effect: \"hair.base\")"), &registry).unwrap();
    preset.layers[0].set("zones", "frinch").unwrap();
    let error = Stage::new(&preset, &in_folder(&folder("set")))
        .err()
        .unwrap();
    assert!(matches!(error, StageError::Zones { .. }), "{error}");
    assert_eq!(
        error.to_string(),
        "hair.base.zones: the hair's style has no zone `frinch`, did you mean `fringe`?"
    );
}

/// Other hair than the preset's own may lack its zones, or all: that is noted.
#[test]
fn hair_that_is_given_may_lack_them() {
    let folder = folder("given");
    fs::write(folder.join("own.strands.ron"), "(version: 1, strands: [(points: [(0, 0.1, 0.1), (0, 0, 0.2)]), (points: [(0.05, 0.1, 0.1), (0.05, 0, 0.2)])])").unwrap();
    fs::write(
        folder.join("other.style.ron"),
        STYLE.replace("tail-left", "braid"),
    )
    .unwrap();
    let registry = registry();
    let text = preset("(effect: \"hair.base\", zones: \"tail*\")");
    let preset = Preset::parse("look.ron", &text, &registry).unwrap();
    for (hair, note, drawn) in [
        (
            "own.strands.ron",
            "hair.base.zones: this hair has none, so that the layer draws on all of it",
            2,
        ),
        (
            "other.style.ron",
            "hair.base.zones: the hair's style has no zone `tail*`",
            0,
        ),
    ] {
        let files = Files {
            hair: Some(folder.join(hair)),
            ..in_folder(&folder)
        };
        let mut stage = Stage::new(&preset, &files).unwrap();
        let notes = stage.notes().join("\n");
        assert!(notes.contains(note), "{notes}");
        let frame = stage.frame().unwrap();
        let strands = frame.strands.iter();
        assert_eq!(
            strands.filter(|strand| !strand.is_left_out_by(0)).count(),
            drawn,
            "{hair}"
        );
    }
}

/// Hair that is set is given, as by an option: a look is tried on it.
#[test]
fn hair_that_is_set_may_lack_them() {
    let folder = folder("set-hair");
    fs::write(
        folder.join("other.style.ron"),
        STYLE.replace("tail-left", "braid"),
    )
    .unwrap();
    let registry = registry();
    let text = preset("(effect: \"hair.base\", zones: \"tail*\")");
    let mut preset = Preset::parse("look.ron", &text, &registry).unwrap();
    preset.set("hair.file", "other.style.ron").unwrap();
    let files = in_folder(&folder);
    let stage = Stage::new(&preset, &files).unwrap();
    let notes = stage.notes().join("\n");
    let note = "hair.base.zones: the hair's style has no zone `tail*`";
    assert!(notes.contains(note), "{notes}");
    preset.check_scene("look.ron", &text, &files).unwrap();

    // Where something else is set, the file's own hair must have them.
    let mut preset = Preset::parse("look.ron", &text.replace("tail*", "tial*"), &registry).unwrap();
    preset.set("hair.guides", "3").unwrap();
    assert!(Stage::new(&preset, &files).is_err());
}
