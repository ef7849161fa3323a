//! Hair that has come to lie on a body.

use super::*;

/// Long hair.
const LONG: &str = r#"(version: 1, zones: [(name: "cap", roots: whorl, tips: hairline(-180, 180), count: 40, hang: 0.9, lift: 0.04, overlap: 2)])"#;

/// The head turns.
const TURN: &str = "(move: turn, start: 0.1, length: 0.5, angle: 45)";

/// Hair of this style beside bodies, as the head makes a move.
fn on_bodies(style: &str, (a_move, bodies): (&str, &str), settings: &[(&str, &str)]) -> Stage {
    let folder = tempfile::tempdir().unwrap();
    let file = |name, text: &str| written(folder.path(), name, text);
    let hair = file("a.style.ron", style);
    let script = format!("(version: 1, moves: [{a_move}], bodies: [{bodies}])");
    let turn = file("a.motion.ron", &script);
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

/// Long hair that falls on a ball beside it as the head turns, and stays there.
fn on_a_ball(settings: &[(&str, &str)]) -> Stage {
    let ball = r#"(name: "ball", at: (0.5, -0.5, 0.1), radius: 0.2)"#;
    on_bodies(LONG, (TURN, ball), settings)
}

/// How far the farthest tip goes in a frame of the quarter of a second from this one on, in mm.
fn way_mm(stage: &mut Stage, second: f32, fps: f32) -> f32 {
    let mut last = tips(stage, second);
    (1..=6).fold(0.0_f32, |farthest_mm, frame| {
        let next = tips(stage, second + frame as f32 / fps);
        let way = farthest(&last, &next) * 1e3;
        last = next;
        farthest_mm.max(way)
    })
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
        let ways_mm = [1.0, 4.0, 11.0].map(|second| way_mm(&mut stage, second, fps));
        println!("{settings:?}: {ways_mm:.3?} mm a frame");
        assert!(ways_mm[0] > 1.0, "{settings:?}: {ways_mm:?}");
        assert!(ways_mm[2] < 0.02, "{settings:?}: {ways_mm:?}");
    }
}

/// What links need to keep off a ball grows as fast as they turn. Where it pushed their ends, it threw a tail that hung on one after a nod about by up to 5 cm a
/// frame, for ever.
#[test]
fn what_hangs_on_a_body_is_not_thrown() {
    let tail = r#"(version: 1, zones: [
        (name: "cap", roots: whorl, tips: hairline(-180, 180), count: 30, hang: 0.05, lift: 0.03),
        (name: "tail", form: tail, roots: [(180, 35)], hang: 1.8, count: 11, tie: 0.07, fullness: 0.2, feel: limp)])"#;
    let nod = "(move: nod, start: 0.2, length: 1, angle: 10)";
    for body in [
        r#"(name: "a", at: (0, -1.2, -0.85), radius: 0.2)"#,
        r#"(name: "a", on: shoulders, at: (0, -1.2, -0.5), radius: 0.3)"#,
        r#"(name: "a", on: shoulders, shape: capsule, at: (-0.5, -1.1, -0.5), to: (0.5, -1.1, -0.5), radius: 0.15)"#,
    ] {
        let mut stage = on_bodies(tail, (nod, body), &[]);
        let ways_mm = [1.0, 12.0, 13.0].map(|second| way_mm(&mut stage, second, 24.0));
        println!("{body}: {ways_mm:.3?} mm a frame");
        assert!(ways_mm[0] > 1.0, "{body}: {ways_mm:?}");
        assert!(ways_mm[1].max(ways_mm[2]) < 0.05, "{body}: {ways_mm:?}");
    }
}
