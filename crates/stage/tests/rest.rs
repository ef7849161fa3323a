//! What frames tell of hair at rest, for effects that stay where they are on it.

use effects::Registry;
use glam::Vec3;
use stage::{Files, Preset, Stage};
use std::path::Path;

fn registry() -> Registry {
    let mut registry = Registry::new();
    effects_builtin::register(&mut registry).unwrap();
    registry
}

/// How hair runs at rest is told as where it is: the same while the head leans, also for hairs that come loose.
#[test]
fn hair_is_told_how_it_runs_at_rest() {
    let layers = r#"[(effect: "hair.band"), (effect: "hair.fine", params: (per_strand: 2))]"#;
    let text = format!(
        "(version: 1, head: (shape: bust), hair: (file: \"styles/bob.style.ron\"), layers: {layers})"
    );
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/yardsticks");
    let script = Path::new(env!("CARGO_TARGET_TMPDIR")).join("leans.motion.ron");
    let leans = "(version: 1, keys: [(time: 0, turn: (0, 0, 65)), (time: 1, turn: (0, 0, 65))])";
    std::fs::write(&script, leans).unwrap();
    let files = Files {
        preset_folder: folder,
        motion: Some(script),
        ..Files::default()
    };
    let registry = registry();
    let preset = Preset::parse("look.ron", &text, &registry).unwrap();
    let mut stage = Stage::new(&preset, &files).unwrap();
    let frame = stage.frame().unwrap();
    let mut count = 0;
    for run in &frame.paths.runs {
        for joint in run.joints.start..run.joints.end - 1 {
            let way = frame.rest_positions[joint + 1] - frame.rest_positions[joint];
            let told = frame.rest_forwards[joint];
            assert!(told.distance(way.normalize_or_zero()) < 1e-3, "{told}");
            count += usize::from(told.distance(frame.paths.forward[joint]) > 0.5);
        }
        let [before, last] = [2, 1].map(|back| frame.rest_forwards[run.joints.end - back]);
        assert_eq!(before, last);
    }
    assert!(count > 500, "the head leans: {count}");
}

/// A strand of one point runs nowhere.
#[test]
fn a_point_has_no_direction_at_rest() {
    let hair = Path::new(env!("CARGO_TARGET_TMPDIR")).join("point.strands.ron");
    std::fs::write(&hair, "(version: 1, strands: [(points: [(0, 0.1, 0)])])").unwrap();
    let text = r#"(version: 1, head: (shape: none), layers: [(effect: "hair.band")])"#;
    let registry = registry();
    let preset = Preset::parse("look.ron", text, &registry).unwrap();
    let files = Files {
        hair: Some(hair),
        ..Files::default()
    };
    let mut stage = Stage::new(&preset, &files).unwrap();
    assert!(
        stage
            .frame()
            .unwrap()
            .rest_forwards
            .iter()
            .all(|way| *way == Vec3::ZERO)
    );
}
