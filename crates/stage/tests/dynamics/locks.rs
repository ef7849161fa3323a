//! Locks that keep out of each other.

use super::*;

/// Locks of looks that keep out of each other when a head turns fast, at 60 frames a second: it moves them, and costs few iterations more.
#[test]
fn locks_keep_out_of_each_other_in_looks() {
    let folder = tempfile::tempdir().unwrap();
    let file = |name, text| written(folder.path(), name, text);
    let turn = file("turn.motion.ron", TURN);
    let ponytail = file(
        "ponytail.style.ron",
        r#"(version: 1, zones: [
            (name: "cap", roots: whorl, tips: hairline(-180, 180), count: 30, hang: 0.05, lift: 0.03, locks: 0),
            (name: "tail", form: tail, roots: [(180, 40)], hang: 1.6, count: 20, tie: 0.07),
        ])"#,
    );
    let mut registry = Registry::new();
    effects_builtin::register(&mut registry).unwrap();
    let one = rayon::ThreadPoolBuilder::new().num_threads(1);
    let one = one.build().unwrap();
    let looks = [
        ("twin-tails", None),
        ("short-ash", None),
        ("outlined", Some(&ponytail)),
    ];
    for (look, hair) in looks {
        let text = fs::read_to_string(presets().join(format!("{look}.ron"))).unwrap();
        let [free, kept] = ["0", "1"].map(|locks| {
            let mut preset = Preset::parse("look.ron", &text, &registry).unwrap();
            preset.set("scene.fps", "60").unwrap();
            preset.set("dynamics.locks", locks).unwrap();
            let files = Files {
                preset_folder: presets(),
                hair: hair.cloned(),
                motion: Some(turn.clone()),
                ..Files::default()
            };
            let mut stage = Stage::new(&preset, &files).unwrap();
            let (mut iterations, mut meetings) = (0, 0);
            for frame in 1..=60 {
                one.install(|| stage.advance_to(frame as f32 / 60.0))
                    .unwrap();
                let stats = stage.simulated();
                assert_eq!(stats.set_aside, 0, "{look}");
                iterations += stats.iterations;
                meetings += stats.meetings;
            }
            (iterations, meetings, means(&mut stage, 1.0))
        });
        let ratio = kept.0 as f64 / free.0 as f64;
        println!(
            "{look}: {} particles meet other locks, {ratio:.2} times the iterations",
            kept.1
        );
        assert!(free.1 == 0 && kept.1 > 0 && free.2 != kept.2, "{look}");
        assert!(ratio < 1.4, "{look}: {ratio}");
    }
}

/// Locks that a violent shake leaves pressed against each other come to rest at 60 frames a second, and sleep: those of a ponytail, and of pigtails that are tied
/// further down, too.
#[test]
fn locks_that_jam_come_to_rest() {
    let ponytail = r#"(name: "tail", form: tail, roots: [(180, 60)], root_lift: 0.06, hang: 2.4, count: 14, fullness: 0.22, tie: 0.07,
        length_variation: 0.4, groups: 4, gather: 0.6, root_size: 0.7)"#;
    let pigtails = r#"(name: "tail", form: tail, mirror: true, roots: [(110, 20)], hang: 1.5, count: 9, fullness: 0.18, tie: 0.06,
        low_tie: 0.6, low_tie_size: 0.05, feel: limp)"#;
    for (name, seed, tail, feel) in [
        ("ponytail", 6, ponytail, "springy"),
        ("pigtails", 5, pigtails, "soft"),
    ] {
        let style = format!(
            r#"(version: 1, seed: {seed}, zones: [
                (name: "cap", roots: whorl, tips: hairline(-180, 180), count: 30, hang: 0.05, lift: 0.03),
                {tail},
                (name: "fringe", count: 13, roots: [(-84, 70), (0, 84), (84, 70)], tips: [(-62, -10), (-30, 2), (0, -4), (30, 2), (62, -12)],
                    root_lift: 0.04, lift: 0.08, tip_lift: 0.03, size: 24, mixed_sizes: 0.4, length_variation: 0.25, groups: 5, gather: 0.7),
            ])"#
        );
        let mut stage = shaken(&style, feel);
        // The speed of the fastest middle of a strand in each second, in mm/s.
        let mut last = means(&mut stage, 0.0);
        let speeds: Vec<f32> = (0..14)
            .map(|second| {
                (1..=60).fold(0.0_f32, |fastest, frame| {
                    let next = means(&mut stage, second as f32 + frame as f32 / 60.0);
                    let way = farthest(&next, &last);
                    last = next;
                    fastest.max(way * 60e3)
                })
            })
            .collect();
        let asleep = (15..=40).find(|&second| {
            stage.advance_to(second as f32).unwrap();
            let stats = stage.simulated();
            stats.strands == 0 && stats.asleep > 0
        });
        println!("{name}: {speeds:.1?} mm/s; asleep after {asleep:?} s");
        assert!(speeds[1] > 100.0, "{name}");
        assert!(speeds[13] < 0.3, "{name}");
        assert!(
            asleep.is_some_and(|second| second <= 30),
            "{name}: {asleep:?}"
        );
    }
}

/// Hair of a style that keeps out of each other, on a head that is shaken for two seconds at 60 frames a second.
fn shaken(style: &str, feel: &str) -> Stage {
    let folder = tempfile::tempdir().unwrap();
    let file = |name, text| written(folder.path(), name, text);
    let hair = file("a.style.ron", style);
    let shake = file(
        "shake.motion.ron",
        "(version: 1, moves: [(move: turn, start: 0.2, length: 0.2, angle: 80), (move: turn, start: 1, length: 0.2, angle: -150),
            (move: turn, start: 1.8, length: 0.25, angle: 70)])",
    );
    let mut registry = Registry::new();
    effects_builtin::register(&mut registry).unwrap();
    let text = fs::read_to_string(presets().join("outlined.ron")).unwrap();
    let mut preset = Preset::parse("look.ron", &text, &registry).unwrap();
    let settings = [
        ("scene.fps", "60"),
        ("dynamics.locks", "1"),
        ("dynamics.feel", feel),
    ];
    for (name, value) in settings {
        preset.set(name, value).unwrap();
    }
    let files = Files {
        preset_folder: presets(),
        hair: Some(hair),
        motion: Some(shake),
        ..Files::default()
    };
    Stage::new(&preset, &files).unwrap()
}
