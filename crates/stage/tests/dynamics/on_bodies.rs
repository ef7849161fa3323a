//! Hair that has come to lie on a body.

use super::*;

/// Long hair that falls on a ball beside it as the head turns, and stays there.
fn on_a_ball(settings: &[(&str, &str)]) -> Stage {
    let folder = tempfile::tempdir().unwrap();
    let file = |name, text| written(folder.path(), name, text);
    let hair = file(
        "a.style.ron",
        r#"(version: 1, zones: [(name: "cap", roots: whorl, tips: hairline(-180, 180), count: 40, hang: 0.9, lift: 0.04, overlap: 2)])"#,
    );
    let turn = file(
        "turn.motion.ron",
        r#"(version: 1, moves: [(move: turn, start: 0.1, length: 0.5, angle: 45)],
            bodies: [(name: "ball", shape: sphere, at: (0.5, -0.5, 0.1), radius: 0.2)])"#,
    );
    let mut registry = Registry::new();
    effects_builtin::register(&mut registry).unwrap();
    let text = r#"(version: 1, head: (shape: figure), layers: [(effect: "hair.base")])"#;
    let mut preset = Preset::parse("look.ron", text, &registry).unwrap();
    for (name, value) in settings {
        preset.set(name, value).unwrap();
    }
    let files = Files {
        preset_folder: presets(),
        hair: Some(hair),
        motion: Some(turn),
        ..Files::default()
    };
    Stage::new(&preset, &files).unwrap()
}

/// Where tips are at a time, in m.
fn tips(stage: &mut Stage, time: f32) -> Vec<Vec3> {
    stage.advance_to(time).unwrap();
    let frame = stage.frame().unwrap();
    let runs = frame.paths.runs.iter();
    runs.map(|run| frame.paths.position[run.joints.end - 1])
        .collect()
}

/// A strand that hangs over a ball held on it by friction can find no rest in steps of a frame: it rocks to and fro, by 0.2 to 0.6 mm in
/// each, for as long as nothing calms it.
#[test]
fn what_rocks_on_a_body_comes_to_rest() {
    for (settings, fps) in [
        (&[][..], 24.0),
        (&[("dynamics.links", "0")], 24.0),
        (&[("dynamics.stiffness", "2")], 24.0),
        (&[("scene.fps", "60")], 60.0),
    ] {
        let mut stage = on_a_ball(settings);
        let mut way_mm = |second: f32| {
            let mut last = tips(&mut stage, second);
            (1..=6).fold(0.0_f32, |farthest_mm, frame| {
                let next = tips(&mut stage, second + frame as f32 / fps);
                let way = farthest(&last, &next) * 1e3;
                last = next;
                farthest_mm.max(way)
            })
        };
        let ways_mm = [1.0, 4.0, 11.0].map(&mut way_mm);
        println!("{settings:?}: {ways_mm:.3?} mm a frame");
        assert!(ways_mm[0] > 1.0, "{settings:?}: {ways_mm:?}");
        assert!(ways_mm[2] < 0.02, "{settings:?}: {ways_mm:?}");
    }
}
