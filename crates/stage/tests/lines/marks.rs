//! Marks along lines: those of the sequence, on their edges.

use super::*;

#[test]
fn marks_are_those_of_the_sequence_whichever_frame_is_asked_for() {
    let lines = "(name: \"rim\", kind: \"contour, crease\")";
    let make = || things("(shape: wings)", lines, CHALK).unwrap();
    let at = |stage: &mut Stage, frame: u32| {
        stage.advance_to(frame as f32 / 24.0).unwrap();
        let frame = stage.frame().unwrap();
        assert_eq!(frame.marks.len(), frame.paths.len());
        (frame.marks.to_vec(), drawn(&frame).pixels)
    };
    let mut all = make();
    let sequence: Vec<_> = (0..6).map(|frame| at(&mut all, frame)).collect();
    assert!(at(&mut make(), 5) == sequence[5], "alone");
    assert!(at(&mut all, 2) == sequence[2], "back");
    assert!(at(&mut all, 5) == sequence[5], "and forth");
    assert!(at(&mut all, 5) == sequence[5], "again");
}

/// Also where a frame's time in single precision is another than in double, which may be another picture.
#[test]
fn a_late_frame_is_that_of_the_sequence_at_any_rate() {
    let lines = "(name: \"rim\", kind: \"contour, crease\", crease: 24)";
    for (fps, on) in [(24.0_f32, 1), (24.0, 2), (30.0, 1), (60.0, 2)] {
        let make = || {
            let registry = registry();
            let text = format!(
                "(version: 1, head: (shape: none), meshes: [(shape: wings, turn: (38, 0, 0))], motion: (on: {on}),
                 scene: (size: (240, 240), fps: {fps}), camera: (distance: 2, pitch: 34), lines: [{lines}], layers: [{CHALK}])"
            );
            let preset = Preset::parse("look.ron", &text, &registry).unwrap();
            Stage::new(&preset, &Files::default()).unwrap()
        };
        let at = |stage: &mut Stage, frame: u32| {
            stage.advance_to(frame as f32 / fps).unwrap();
            let frame = stage.frame().unwrap();
            (frame.paths.center.to_vec(), frame.marks.to_vec())
        };
        let mut all = make();
        let sequence: Vec<_> = (0..46).map(|frame| at(&mut all, frame)).collect();
        for frame in [29, 38, 45] {
            let alone = at(&mut make(), frame);
            assert!(alone == sequence[frame as usize], "{fps}, {on}: {frame}");
        }
    }
}

/// What has grown or gone by the end of a round isn't otherwise at its start.
#[test]
fn lines_come_round_in_a_loop() {
    let folder = tempfile::tempdir().unwrap();
    let script = folder.path().join("loop.motion.ron");
    fs::write(&script, "(version: 1, period: 1.5, loop: true)").unwrap();
    let files = Files {
        motion: Some(script),
        ..Files::default()
    };
    let lines = "(name: \"rim\", kind: \"contour, crease\", crease: 24)";
    let make = || {
        things_of(
            "(shape: wings, turn: (38, 0, 0), beat: 2)",
            lines,
            CHALK,
            &files,
        )
        .unwrap()
    };
    let at = |stage: &mut Stage, frame: u32| {
        stage.advance_to(frame as f32 / 24.0).unwrap();
        stage.frame().unwrap().paths.center.to_vec()
    };
    let mut all = make();
    let rounds: Vec<_> = (0..73).map(|frame| at(&mut all, frame)).collect();
    let is_alike = |frame: &usize| {
        let (one, other) = (&rounds[*frame], &rounds[*frame + 36]);
        one.len() == other.len() && one.iter().zip(other).all(|(a, b)| a.distance(*b) < 0.01)
    };
    assert!(is_alike(&0) && is_alike(&36));
    // In a few the last digits of a time decide what is seen: wings stand edge on.
    let alike = (0..37).filter(is_alike).count();
    assert!(alike >= 33, "{alike}");
    assert!(at(&mut make(), 70) == rounds[70], "alone");
}

/// Round after round, also where nothing moves as one begins, so that a picture is shown once more, and of a head that moves while hair is held.
#[test]
fn a_frame_of_a_loop_is_that_of_the_sequence() {
    let lines = "(name: \"rim\", kind: \"contour, crease\", crease: 24)";
    let turns = "moves: [(move: turn, start: 0.1, length: 0.1, angle: 20), (move: turn, start: 0.25, length: 0.1, angle: -20)]";
    let beating = "(shape: wings, turn: (38, 0, 0), beat: 2)";
    for (meshes, moves, motion) in [
        (beating, "", ""),
        ("(shape: cup)", turns, ""),
        ("(shape: cup)", turns, "on: 2, held: hair"),
        (beating, turns, "on: 2"),
    ] {
        let folder = tempfile::tempdir().unwrap();
        let script = folder.path().join("loop.motion.ron");
        let text = format!("(version: 1, period: 0.5, loop: true, {moves})");
        fs::write(&script, text).unwrap();
        let files = Files {
            motion: Some(script),
            ..Files::default()
        };
        let registry = registry();
        let make = || {
            let text = format!(
                "(version: 1, head: (shape: none), meshes: [{meshes}], motion: ({motion}), scene: (size: (240, 240)),
                 camera: (distance: 2, pitch: 34), lines: [{lines}], layers: [{CHALK}])"
            );
            let preset = Preset::parse("look.ron", &text, &registry).unwrap();
            Stage::new(&preset, &files).unwrap()
        };
        let mut last = Default::default();
        // As programs do: what would be the last frame once more isn't made again.
        let mut at = |stage: &mut Stage, frame: u32| {
            stage.advance_to(frame as f32 / 24.0).unwrap();
            if !stage.is_as_before().unwrap() {
                let frame = stage.frame().unwrap();
                last = (frame.paths.center.to_vec(), frame.marks.to_vec());
            }
            last.clone()
        };
        let mut all = make();
        let sequence: Vec<_> = (0..26).map(|frame| at(&mut all, frame)).collect();
        for frame in [1, 7, 11, 12, 13, 19, 24, 25] {
            let (alone, expected) = (at(&mut make(), frame), &sequence[frame as usize]);
            assert!(alone == *expected, "{meshes}, {moves}, {motion}: {frame}");
        }
    }
}

/// As `--time` asks for them, and as what is blurred by motion is made of.
#[test]
fn moments_between_frames_follow_the_one_before_and_are_not_followed() {
    let lines = "(name: \"rim\", kind: \"contour, crease\")";
    let make = || things("(shape: wings)", lines, CHALK).unwrap();
    let at = |stage: &mut Stage, frame: f32| {
        stage.advance_to(frame / 24.0).unwrap();
        let frame = stage.frame().unwrap();
        assert_eq!(frame.marks.len(), frame.paths.len());
        (frame.paths.center.to_vec(), frame.marks.to_vec())
    };
    let mut all = make();
    let sequence: Vec<_> = (0..6).map(|frame| at(&mut all, frame as f32)).collect();
    let moment = at(&mut make(), 3.5);
    let mut stage = make();
    for earlier in [0.0, 1.25, 3.0, 3.25, 3.75] {
        at(&mut stage, earlier);
    }
    assert!(at(&mut stage, 3.5) == moment, "after others");
    assert!(at(&mut stage, 4.0) == sequence[4], "the frame after it");
    assert!(at(&mut stage, 3.5) == moment, "back");
    assert!(at(&mut stage, 5.0) == sequence[5], "and forth");
    // On it is neither what the frame before it was nor the one after.
    assert!(moment != sequence[3] && moment != sequence[4]);
}

#[test]
fn what_leaves_no_marks_is_not_followed() {
    let lines = "(name: \"rim\", kind: \"contour, crease\")";
    let mut stage = things("(shape: wings)", lines, INK).unwrap();
    assert!(stage.frame().unwrap().marks.is_empty());
}

#[test]
fn marks_stay_on_edges_whatever_hides_them() {
    // The cube before it moves on the screen as the camera does; an edge's marks are those of the edge.
    let meshes = "(shape: cube, name: \"far\"), (shape: cube, name: \"near\", size: 0.5, at: (0.3, 0.2, 0.9))";
    let lines = "(name: \"rim\", of: \"far\", kind: \"crease\")";
    let mut stage = things(meshes, lines, CHALK).unwrap();
    let height_m = stage.head().height_m;
    let mut seen = |yaw: f32| -> Vec<(Vec3, f32)> {
        stage.scene.camera.yaw = yaw;
        let frame = stage.frame().unwrap();
        let positions = frame.paths.position.iter().copied();
        positions.zip(frame.marks.iter().copied()).collect()
    };
    let (before, after) = (seen(10.0), seen(16.0));
    let (mut compared, mut stayed) = (0, 0);
    for (place, mark) in &before {
        let near = after
            .iter()
            .filter(|(other, _)| other.distance(*place) < 0.012);
        let off = near.map(|(other, at)| (at - mark).abs() * height_m - other.distance(*place));
        if let Some(least) = off.reduce(f32::min) {
            compared += 1;
            stayed += usize::from(least < 1e-3);
        }
    }
    // But where edges meet, of which one may be seen in one picture alone.
    assert!(compared > 50, "{compared}");
    assert!(
        stayed as f32 > 0.95 * compared as f32,
        "{stayed} of {compared}"
    );
}
