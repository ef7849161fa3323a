//! Motion scripts: what is refused, and that heads and hair follow.

use effects::Registry;
use glam::Vec3;
use stage::{Files, Preset, Stage};
use std::fs;
use std::path::{Path, PathBuf};

fn presets() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../presets")
}

fn registry() -> Registry {
    let mut registry = Registry::new();
    effects_builtin::register(&mut registry).unwrap();
    registry
}

/// A scene of twin tails with this script, or why there is none.
fn scene(script: &str) -> Result<Stage, String> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.motion.ron");
    fs::write(&path, script).unwrap();
    scene_of(path)
}

/// The same with the script of this file.
fn scene_of(path: PathBuf) -> Result<Stage, String> {
    let registry = registry();
    let text = fs::read_to_string(presets().join("twin-tails.ron")).unwrap();
    let mut preset = Preset::parse("look.ron", &text, &registry).unwrap();
    // What the script does to the head, and nothing else.
    preset.set("dynamics.solver", "none").unwrap();
    let files = Files {
        preset_folder: presets(),
        motion: Some(path),
        ..Files::default()
    };
    Stage::new(&preset, &files).map_err(|error| error.to_string())
}

#[test]
fn mistakes_in_scripts_have_their_places() {
    let message = scene(
        "(
    version: 1,
    moves: [(move: trun), (move: shake, length: 0)],
    keys: [(time: 1), (time: 1, turn: (0, 0))],
    winds: [(speed: -1, from: 3)],
    gusts: 1,
)",
    )
    .err()
    .unwrap();
    for line in [
        "a.motion.ron:3:20: move: there is no `trun`, did you mean `turn`?",
        "a.motion.ron:3:49: length: expected a number from 0.001",
        "a.motion.ron:4:23: keys: times must ascend",
        "a.motion.ron:4:39: turn: expected",
        "a.motion.ron:5:21: speed: expected a number from 0 to 200",
        "a.motion.ron:5:25: a wind has no `from`",
        "a.motion.ron:6:5: the motion has no `gusts`",
    ] {
        assert!(message.contains(line), "`{line}` is missing in:\n{message}");
    }
    let message = scene("(moves: [])").err().unwrap();
    assert!(message.contains("needs `version: 1`"), "{message}");
}

#[test]
fn scripts_that_come_with_inkstrand_are_read() {
    let folder = presets().join("motions");
    let mut scripts = 0;
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        // Beside them are the key shapes of hair.
        if path.to_string_lossy().ends_with(".motion.ron") {
            scene_of(path).unwrap();
            scripts += 1;
        }
    }
    assert!(scripts >= 4);
}

#[test]
fn the_head_turns_and_what_stands_on_it_turns_with_it() {
    let script = "(version: 1, moves: [(move: turn, start: 1, length: 0.5, angle: 90)])";
    let mut stage = scene(script).unwrap();
    let means = |stage: &mut Stage| -> (render::Head, Vec<Vec3>) {
        let frame = stage.frame().unwrap();
        let means = frame.strands.iter().map(|strand| strand.mean).collect();
        (frame.objects[0].head, means)
    };
    let before = means(&mut stage);
    stage.advance_to(1.0).unwrap();
    assert_eq!(means(&mut stage), before);
    stage.advance_to(2.0).unwrap();
    let after = means(&mut stage);
    // About the top of the neck, towards the character's left (+X).
    let head = before.0;
    let pivot = head.center - Vec3::new(0.0, 0.0, 0.12 * head.height_m);
    let turned = |p: Vec3| {
        let way = p - pivot;
        pivot + Vec3::new(way.z, way.y, -way.x)
    };
    for (from, to) in before.1.iter().zip(&after.1) {
        assert!((turned(*from) - *to).length() < 2e-4, "{from} {to}");
    }
    stage.advance_to(0.0).unwrap();
    assert_eq!(means(&mut stage), before);
}
