//! Simulated hair in scenes.

#![allow(
    clippy::print_stdout,
    reason = "a test shows the figures that it holds"
)]

mod combed;
mod locks;
mod on_bodies;
mod rates;
mod seam;

use effects::Registry;
use glam::Vec3;
use stage::{Files, FrameMaker, Hand, Motion, Preset, Scene, Stage};
use std::fs;
use std::path::{Path, PathBuf};
use stroke_path::{Camera, OrbitView};

const TURN: &str = "(version: 1, moves: [(move: turn, start: 0.1, length: 0.3, angle: 60)])";
const TURN_AND_BACK: &str = "(version: 1, moves: [(move: turn, start: 0.5, length: 0.4, angle: 60), (move: turn, start: 1.5, length: 0.4, angle: -60)])";
const GALE: &str = "(version: 1, winds: [(speed: 25, gusts: 10, yaw: 90)])";

fn presets() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../presets")
}

/// Looks that stay as they are, for what is measured.
fn yardsticks() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/yardsticks")
}

/// A scene of this style with a script and settings.
fn scene(style: &str, script: Option<&str>, settings: &[(&str, &str)]) -> Stage {
    let mut registry = Registry::new();
    effects_builtin::register(&mut registry).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let motion = script.map(|script| {
        let path = folder.path().join("a.motion.ron");
        fs::write(&path, script).unwrap();
        path
    });
    let text = fs::read_to_string(yardsticks().join("twin-tails.ron")).unwrap();
    let mut preset = Preset::parse("look.ron", &text, &registry).unwrap();
    for (name, value) in settings {
        preset.set(name, value).unwrap();
    }
    let files = Files {
        preset_folder: yardsticks(),
        hair: Some(yardsticks().join("styles").join(style)),
        motion,
        ..Files::default()
    };
    Stage::new(&preset, &files).unwrap()
}

fn means(stage: &mut Stage, time: f32) -> Vec<Vec3> {
    stage.advance_to(time).unwrap();
    let frame = stage.frame().unwrap();
    frame.strands.iter().map(|strand| strand.mean).collect()
}

fn farthest(a: &[Vec3], b: &[Vec3]) -> f32 {
    let apart = a.iter().zip(b).map(|(a, b)| a.distance(*b));
    apart.fold(0.0, f32::max)
}

/// A file of this text in a folder.
fn written(folder: &Path, name: &str, text: &str) -> PathBuf {
    let path = folder.join(name);
    fs::write(&path, text).unwrap();
    path
}

/// How far nine of ten strands are at most from where others have them, and how far all are, in m.
fn nine_of_ten(a: &[Vec3], b: &[Vec3]) -> [f32; 2] {
    let mut apart: Vec<f32> = a.iter().zip(b).map(|(a, b)| a.distance(*b)).collect();
    apart.sort_by(f32::total_cmp);
    [apart[apart.len() * 9 / 10], apart[apart.len() - 1]]
}

/// How far the point of a look's hair that goes farthest goes from each frame to the next, m.
fn ways(look: &str, script: &str, sets: &[(&str, &str)], fps: f32, length_s: f32) -> Vec<f32> {
    let folder = tempfile::tempdir().unwrap();
    let mut registry = Registry::new();
    effects_builtin::register(&mut registry).unwrap();
    effects_cartoon::register(&mut registry).unwrap();
    effects_surface::register(&mut registry).unwrap();
    let text = fs::read_to_string(presets().join(format!("{look}.ron"))).unwrap();
    let mut preset = Preset::parse(look, &text, &registry).unwrap();
    preset.set("scene.fps", &fps.to_string()).unwrap();
    for (name, value) in sets {
        preset.set(name, value).unwrap();
    }
    let files = Files {
        preset_folder: presets(),
        motion: Some(written(folder.path(), "a.motion.ron", script)),
        ..Files::default()
    };
    let scene = Scene::load(&preset, &files).unwrap();
    let mut motion = Motion::new();
    let mut points = |frame: u32| {
        motion.advance_to(&scene, frame as f32 / fps).unwrap();
        motion.points(&scene, 0).to_vec()
    };
    let mut last: Vec<Vec3> = points(0);
    (1..=(length_s * fps) as u32)
        .map(|frame| {
            let now = points(frame);
            let ways = last.iter().zip(&now).map(|(a, b)| a.distance(*b));
            let farthest = ways.fold(0.0, f32::max);
            last = now;
            farthest
        })
        .collect()
}

#[test]
fn hair_at_rest_is_not_simulated() {
    let mut stage = scene("twin-tails.style.ron", None, &[]);
    let before = means(&mut stage, 0.0);
    assert!(means(&mut stage, 5.0) == before);
    assert_eq!(stage.simulated().strands, 0);
    let mut stage = scene(
        "twin-tails.style.ron",
        Some(TURN),
        &[("dynamics.solver", "none")],
    );
    means(&mut stage, 1.0);
    assert_eq!(stage.simulated().strands, 0);
}

#[test]
fn hair_lags_behind_the_head_and_comes_back_to_its_style() {
    let rigid = &[("dynamics.solver", "none")];
    let mut with_head = scene("twin-tails.style.ron", Some(TURN), rigid);
    let mut stage = scene("twin-tails.style.ron", Some(TURN), &[]);
    assert!(means(&mut stage, 0.0) == means(&mut with_head, 0.0));
    // Tails swing out by more than a tenth of the head's height, and settle to the style on the turned head.
    let swung = farthest(&means(&mut stage, 0.4), &means(&mut with_head, 0.4));
    assert!(swung > 0.024, "{swung}");
    assert!(stage.simulated().strands > 50);
    let settled = farthest(&means(&mut stage, 30.0), &means(&mut with_head, 30.0));
    assert!(settled < 0.2 * swung, "{settled} of {swung}");
}

#[test]
fn a_moment_is_the_same_however_it_is_reached() {
    let mut steps = scene("bob.style.ron", Some(GALE), &[]);
    for frame in 0..=12 {
        steps.advance_to(frame as f32 / 24.0).unwrap();
    }
    let at_once = means(&mut scene("bob.style.ron", Some(GALE), &[]), 0.5);
    assert!(means(&mut steps, 0.5) == at_once);
    assert!(means(&mut steps, 0.0) != at_once);
    assert!(means(&mut steps, 0.5) == at_once);
}

#[test]
fn a_simulation_that_is_interrupted_goes_on_from_there() {
    let scene = scene("bob.style.ron", Some(GALE), &[]).scene;
    let (mut motion, mut frames) = (Motion::new(), FrameMaker::new());
    let mut means = |scene: &Scene, motion: &Motion| -> Vec<Vec3> {
        let frame = frames.frame(scene, motion).unwrap();
        frame.strands.iter().map(|strand| strand.mean).collect()
    };
    let at = |time: f32, scene: &Scene| {
        let mut motion = Motion::new();
        motion.advance_to(scene, time).unwrap();
        motion
    };
    // Three steps of 24, two in each of 24 frames a second: heads and hair are at the same time.
    let hand = Hand::new();
    let mut left = 3;
    let goes_on = || {
        left -= 1;
        left >= 0
    };
    let advanced = motion.advance_by_hand_while(&scene, 0.5, &hand, goes_on);
    assert!(!advanced.unwrap());
    assert_eq!(motion.time_s(), 3.0 / 48.0);
    assert_eq!(motion.steps_taken(), 3);
    assert!(means(&scene, &motion) == means(&scene, &at(3.0 / 48.0, &scene)));
    let advanced = motion.advance_by_hand_while(&scene, 0.5, &hand, || true);
    assert!(advanced.unwrap());
    assert_eq!(motion.time_s(), 0.5);
    assert_eq!(motion.steps_taken(), 24);
    assert!(means(&scene, &motion) == means(&scene, &at(0.5, &scene)));
}

#[test]
fn between_two_steps_hair_is_where_a_shorter_step_has_it() {
    let in_steps = |step| {
        scene(
            "twin-tails.style.ron",
            Some(TURN),
            &[("dynamics.step", step)],
        )
    };
    let (mut coarse, mut fine) = (in_steps("0.02"), in_steps("0.001"));
    // Off the finer steps too, which a script's times need not be on.
    let error = |coarse: &mut Stage, fine: &mut Stage, time| {
        farthest(&means(coarse, time), &means(fine, time))
    };
    let on_a_step = error(&mut coarse, &mut fine, 0.32);
    let between = error(&mut coarse, &mut fine, 0.3301);
    // How far hair goes in half a step, by which the nearest step would be wrong.
    let half_a_step = farthest(&means(&mut fine, 0.32), &means(&mut fine, 0.33));
    println!("m: error on a step {on_a_step}, between {between}; half a step {half_a_step}");
    assert!(
        between < 1.5 * on_a_step && between < 0.4 * half_a_step,
        "{on_a_step} {between} {half_a_step}"
    );

    // It arrives at the next step without a jump, and looking changes nothing.
    let ahead = means(&mut coarse, 0.3999);
    let there = means(&mut coarse, 0.4);
    assert!(farthest(&ahead, &there) < 0.02 * half_a_step);
    assert!(means(&mut in_steps("0.02"), 0.4) == there);
    // From the start on.
    let rigid = &[("dynamics.solver", "none")];
    let calm = means(&mut scene("twin-tails.style.ron", Some(GALE), rigid), 0.015);
    let first = means(&mut scene("twin-tails.style.ron", Some(GALE), &[]), 0.015);
    assert!(first != calm && farthest(&first, &calm) < 0.01);
}

#[test]
fn guides_carry_the_other_strands() {
    let mut all = scene("long-straight.style.ron", Some(TURN), &[]);
    let mut few = scene(
        "long-straight.style.ron",
        Some(TURN),
        &[("dynamics.guides", "30")],
    );
    let rest = means(&mut few, 0.0);
    assert!(rest == means(&mut all, 0.0));
    let (wanted, carried) = (means(&mut all, 0.5), means(&mut few, 0.5));
    assert_eq!(few.simulated().strands, 30);
    assert!(all.simulated().strands > 60);
    // On the whole the carried hair does what it would by itself.
    let mean = |a: &[Vec3], b: &[Vec3]| {
        a.iter().zip(b).map(|(a, b)| a.distance(*b)).sum::<f32>() / a.len() as f32
    };
    let (moved, apart) = (mean(&wanted, &rest), mean(&wanted, &carried));
    assert!(apart < 0.25 * moved, "{apart} of {moved}");
}

#[test]
fn warm_up_is_before_the_first_frame() {
    let script = "(version: 1, period: 2, winds: [(speed: 8, gusts: 0)])";
    let mut cold = scene("bob.style.ron", Some(script), &[]);
    let mut warm = scene("bob.style.ron", Some(script), &[("dynamics.warm_up", "2")]);
    let still = means(&mut cold, 0.0);
    assert!(farthest(&means(&mut warm, 0.0), &still) > 0.002);
    assert!(means(&mut warm, 0.0) == means(&mut cold, 2.0));
}

#[cfg(feature = "compare")]
#[test]
fn the_solvers_for_comparison_do_nearly_the_same() {
    // They know no other hair.
    let apart = [("dynamics.links", "0"), ("dynamics.volume", "0")];
    let style = "twin-tails.style.ron";
    let solver = |name, substeps| {
        let settings = [("dynamics.solver", name), ("dynamics.substeps", substeps)];
        scene(style, Some(TURN), &settings)
    };
    let held = means(&mut solver("none", "0"), 0.4);
    let wanted = means(&mut scene(style, Some(TURN), &apart), 0.4);
    let mean = |a: &[Vec3], b: &[Vec3]| {
        a.iter().zip(b).map(|(a, b)| a.distance(*b)).sum::<f32>() / a.len() as f32
    };
    let swung = mean(&held, &wanted);
    // Trusses are not rods: hair swings as far, but not to the same places.
    for (name, substeps, most) in [("xpbd", "200", 0.25), ("mass_spring", "4", 0.4)] {
        let mut stage = solver(name, substeps);
        let found = means(&mut stage, 0.4);
        assert!(stage.simulated().strands > 50);
        let (far, apart) = (mean(&held, &found) / swung, mean(&wanted, &found) / swung);
        println!("{name}: swings {far:.2} of what rods do, {apart:.2} of it apart from them");
        assert!(
            apart < most && (0.7..1.4).contains(&far),
            "{name}: {far}, {apart}"
        );
        // The same again from the start.
        means(&mut stage, 0.0);
        assert!(means(&mut stage, 0.4) == found);
    }
}

/// The mistakes of a preset with this section.
fn error(dynamics: &str) -> String {
    let mut registry = Registry::new();
    effects_builtin::register(&mut registry).unwrap();
    let text = format!("(version: 1, dynamics: ({dynamics}), layers: [])");
    let preset = Preset::parse("look.ron", &text, &registry);
    preset
        .err()
        .map(|errors| errors.to_string())
        .unwrap_or_default()
}

#[cfg(not(feature = "compare"))]
#[test]
fn solvers_to_compare_with_are_refused_without_their_feature() {
    for solver in ["xpbd", "mass_spring"] {
        let error = error(&format!("solver: {solver}"));
        let place = format!("look.ron:1:25: solver: {solver} is for comparison");
        assert!(error.contains(&place), "{error}");
    }
    assert_eq!(error("solver: none"), "");
}

#[cfg(feature = "compare")]
#[test]
fn what_a_solver_cannot_do_is_refused_at_its_place() {
    let links = error("solver: xpbd, links: 2");
    assert!(
        links.contains("look.ron:1:39: links: solver: xpbd has none"),
        "{links}"
    );
    assert!(error("solver: xpbd, damping: 0.5").contains("damping: solver: xpbd"));
    let volume = error("solver: mass_spring, volume: 1");
    assert!(
        volume.contains("volume: solver: mass_spring has none"),
        "{volume}"
    );
    let locks = error("solver: xpbd, locks: 1");
    assert!(locks.contains("locks: solver: xpbd has none"), "{locks}");
    assert!(error("solver: mass_sprong").contains("mass_spring"));
    assert!(error("solver: rods, substeps: 4").contains("substeps: solver: rods"));
    for good in [
        "solver: xpbd, links: 0, volume: 0",
        "solver: xpbd, substeps: 9",
        "solver: mass_spring, substeps: 9",
        "links: 3",
    ] {
        assert!(!error(good).contains("solver:"), "{good}");
    }
}

/// What strands that hold each other do to one isn't done to the others in return: without any damping they made each other swing more and more, from 1.7 mm a frame to 60.
#[test]
fn hair_without_damping_comes_to_rest_with_its_links() {
    for (look, feel) in [("short-ash", "stiff"), ("long-pink", "soft")] {
        for fps in [24.0, 60.0] {
            let sets = [
                ("dynamics.feel", feel),
                ("dynamics.damping", "0"),
                ("dynamics.hold", "0"),
            ];
            let ways = ways(look, TURN_AND_BACK, &sets, fps, 14.0);
            let farthest = |ways: &[f32]| ways.iter().copied().fold(0.0, f32::max);
            let (moves, last) = ways.split_at((13.0 * fps) as usize);
            let [moves, last] = [moves, last].map(|ways| 1e3 * farthest(ways));
            println!(
                "{look}, {feel}, {fps} frames a second: {moves:.1} mm a frame, {last:.2} in the end"
            );
            assert!(
                moves * fps > 300.0 && last < 0.1,
                "{look}, {fps}: {moves} {last}"
            );
        }
    }
}

#[test]
fn extremes_stay_finite() {
    let script = "(version: 1, moves: [(move: turn, length: 0.1, angle: 3600), (move: walk, step: 5, rate: 50)], \
                  winds: [(speed: 200, gusts: 200)])";
    let extremes = [
        [
            ("dynamics.feel", "gel"),
            ("dynamics.stiffness", "1000"),
            ("dynamics.step", "0.1"),
        ],
        [
            ("dynamics.feel", "limp"),
            ("dynamics.stiffness", "0.001"),
            ("dynamics.gravity", "-10"),
        ],
        [
            ("dynamics.hold", "100"),
            ("dynamics.damping", "100"),
            ("dynamics.drag", "100"),
        ],
        [
            ("dynamics.solver", "xpbd"),
            ("dynamics.stiffness", "1000"),
            ("dynamics.step", "0.1"),
        ],
        [
            ("dynamics.solver", "mass_spring"),
            ("dynamics.stiffness", "0.001"),
            ("dynamics.step", "0.1"),
        ],
        [
            ("dynamics.solver", "mass_spring"),
            ("dynamics.feel", "gel"),
            ("dynamics.stiffness", "1000"),
        ],
        [
            ("dynamics.shape", "curl"),
            ("dynamics.curl_radius", "0.001"),
            ("dynamics.curl_pitch", "-10"),
        ],
        [
            ("dynamics.shape", "sagging"),
            ("dynamics.distance", "2"),
            ("dynamics.friction", "10"),
        ],
        [
            ("dynamics.shape", "straight"),
            ("dynamics.feel", "limp"),
            ("dynamics.damping", "0.5"),
        ],
        [
            ("dynamics.shape", "straight"),
            ("dynamics.feel", "gel"),
            ("dynamics.damping", "0"),
        ],
    ];
    let stays_finite = |settings: &[(&str, &str)]| {
        let mut stage = scene("waves.style.ron", Some(script), settings);
        for frame in 0..24 {
            let means = means(&mut stage, frame as f32 / 24.0);
            assert!(
                means.iter().all(|p| p.is_finite()),
                "{settings:?}, frame {frame}"
            );
        }
    };
    std::thread::scope(|scope| {
        for settings in &extremes {
            scope.spawn(|| stays_finite(settings));
        }
    });
}

/// The safe integrator is for what breaks strands: in what scenes are made of it takes hardly a step, and none is set aside.
#[test]
fn ordinary_motions_need_no_rescue() {
    let mut registry = Registry::new();
    effects_builtin::register(&mut registry).unwrap();
    let looks = [
        ("short-ash", "soft"),
        ("manga-ink", "soft"),
        ("long-pink", "soft"),
        ("twin-tails", "soft"),
        ("flat-tails-black", "soft"),
        ("flat-tails-red", "soft"),
        ("short-ash", "limp"),
        ("long-pink", "limp"),
        ("twin-tails", "gel"),
    ];
    for (look, feel) in looks {
        let text = fs::read_to_string(presets().join(format!("{look}.ron"))).unwrap();
        let mut preset = Preset::parse("look.ron", &text, &registry).unwrap();
        preset.set("dynamics.feel", feel).unwrap();
        for motion in ["head-turn", "nod-and-shake", "walk-in-wind"] {
            let files = Files {
                preset_folder: presets(),
                motion: Some(presets().join(format!("motions/{motion}.motion.ron"))),
                ..Files::default()
            };
            let mut stage = Stage::new(&preset, &files).unwrap();
            let (mut steps, mut fallbacks, mut set_aside) = (0, 0, 0);
            for frame in 1..=96 {
                stage.advance_to(frame as f32 / 24.0).unwrap();
                let stats = stage.simulated();
                steps += stats.strands;
                fallbacks += stats.fallbacks;
                set_aside += stats.set_aside;
            }
            let what = format!("{look}, {feel}, {motion}: {fallbacks} of {steps} steps");
            println!("{what}");
            assert!(steps > 1000, "{what}");
            assert!(fallbacks * 100 <= steps, "{what}");
            assert_eq!(set_aside, 0, "{what}");
        }
    }
}
