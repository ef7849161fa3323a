//! What an artist says of motion: zones, loops, held poses, the shapes of winds.

#![allow(
    clippy::print_stdout,
    reason = "a test shows the figures that it holds"
)]

use effects::Registry;
use effects::preset::PresetErrors;
use glam::Vec3;
use stage::{Files, Motion, Preset, Scene};
use std::fs;
use std::path::{Path, PathBuf};

fn presets() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../presets")
}

/// Tails at these longitudes, in degrees, each with its own words on how it moves.
fn tails(ways: &[(i32, &str)]) -> String {
    let tail = |(index, (longitude, own)): (usize, &(i32, &str))| {
        format!(
            "(name: \"{index}\", form: tail, roots: [({longitude}, 30)], hang: 1.5, count: 2{own})"
        )
    };
    let zones: Vec<String> = ways.iter().enumerate().map(tail).collect();
    format!(
        "(version: 1, undercoat: false, zones: [{}])",
        zones.join(", ")
    )
}

/// Two tails, of which the second may say how it moves.
fn style(own: &str) -> String {
    tails(&[(100, ""), (-100, own)])
}

/// The scene of a style and a script, of a bust.
fn scene_of(style: &str, script: &str, settings: &[(&str, &str)]) -> Result<Scene, String> {
    let mut registry = Registry::new();
    effects_builtin::register(&mut registry).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str, text: &str| {
        let path = folder.path().join(name);
        fs::write(&path, text).unwrap();
        path
    };
    let text = "(version: 1, head: (shape: bust), layers: [(effect: \"hair.base\")])";
    let mut preset = Preset::parse("look.ron", text, &registry).unwrap();
    for (name, value) in settings {
        preset.set(name, value).unwrap();
    }
    let files = Files {
        preset_folder: folder.path().to_owned(),
        hair: Some(path("a.style.ron", style)),
        motion: Some(path("a.motion.ron", script)),
        ..Files::default()
    };
    Scene::load(&preset, &files).map_err(|error| error.to_string())
}

fn scene(own: &str, script: &str, settings: &[(&str, &str)]) -> Scene {
    scene_of(&style(own), script, settings).unwrap()
}

/// All points at a time, reached from the start.
fn points(scene: &Scene, time: f32) -> Vec<Vec3> {
    at(scene, &mut Motion::new(), time)
}

fn at(scene: &Scene, motion: &mut Motion, time: f32) -> Vec<Vec3> {
    motion.advance_to(scene, time).unwrap();
    motion.points(scene, 0).to_vec()
}

fn farthest(a: &[Vec3], b: &[Vec3]) -> f32 {
    let apart = a.iter().zip(b).map(|(a, b)| a.distance(*b));
    apart.fold(0.0, f32::max)
}

const GUST: &str = "(version: 1, winds: [(speed: 6, gusts: 0, yaw: 0)])";
const SHAKE: &str = "(version: 1, moves: [(move: shake, start: 0, length: 1, angle: 25, rate: 2)])";

#[test]
fn a_zone_moves_in_its_own_way() {
    // Nothing acts from tail to tail, so one's words are nothing to the others.
    let apart = &[("dynamics.links", "0"), ("dynamics.volume", "0")][..];
    type Holds = fn(f32, f32) -> bool;
    let ways: [(&str, Holds); 9] = [
        ("", |own, plain| own == plain),
        (", feel: gel", |own, plain| own < 0.3 * plain),
        (", feel: limp", |own, plain| own > 1.02 * plain),
        (", stiffness: 20", |own, plain| own < 0.8 * plain),
        (", damping: 20", |own, plain| own < 0.95 * plain),
        (", drag: 0.2", |own, plain| own < 0.6 * plain),
        (", hold: 20", |own, plain| own < 0.95 * plain),
        (", wind: 0", |own, _| own < 1e-3),
        (
            ", wind: (curve: [(0, 0), (0.5, 0), (1, 1)])",
            |own, plain| own > 0.1 * plain && own < 0.9 * plain,
        ),
    ];
    let words = ways.map(|(own, _)| own);
    let gust = "(version: 1, winds: [(speed: 4, gusts: 0, yaw: 0)])";
    let swung = |words: &[&str]| -> Vec<f32> {
        let tails_of: Vec<(i32, &str)> = words.iter().map(|own| (100, *own)).collect();
        let scene = scene_of(&tails(&tails_of), gust, apart).unwrap();
        let (rest, now) = (points(&scene, 0.0), points(&scene, 0.6));
        let of_tail = rest.len() / words.len();
        let tails = rest.chunks(of_tail).zip(now.chunks(of_tail));
        tails.map(|(rest, now)| farthest(rest, now)).collect()
    };
    let (plain, own) = (swung(&[""; 9]), swung(&words));
    for (((words, holds), plain), own) in ways.into_iter().zip(plain).zip(own) {
        println!("{words}: {own:.4} m where {plain:.4} is without");
        assert!(
            plain > 0.02 && holds(own, plain),
            "{words}: {own} for {plain}"
        );
    }
}

/// What a zone says of `recall` is a factor on the look's: with 0 its hair is not recalled, to the bit, beside other hair that is.
#[test]
fn a_zone_is_recalled_in_its_own_measure() {
    let swung = |recall: &str, own: &str| {
        let settings = [
            ("dynamics.links", "0"),
            ("dynamics.volume", "0"),
            ("dynamics.recall", recall),
        ];
        let all = points(&scene(own, SHAKE, &settings), 1.0);
        let second = all.len() / 2;
        [all[..second].to_vec(), all[second..].to_vec()]
    };
    let [free, plain] = [swung("0", ""), swung("8", "")];
    let apart = farthest(&free[1], &plain[1]);
    println!("recalled: {apart:.3} m from hair that isn't");
    assert!(apart > 0.01, "{apart}");
    assert_eq!(
        swung("8", ", recall: 0"),
        [plain[0].clone(), free[1].clone()]
    );
    assert_eq!(swung("4", ", recall: 2")[1], plain[1]);
    // As far as the solver goes.
    let most = swung("100", ", recall: 100");
    assert!(most.concat().iter().all(|point| point.is_finite()));
}

#[test]
fn a_look_may_vary_along_its_strands_and_from_one_to_the_other() {
    let plain = points(&scene("", GUST, &[]), 0.5);
    let same = points(
        &scene("", GUST, &[("dynamics.stiffness", "(value: 1)")]),
        0.5,
    );
    assert_eq!(plain, same);
    for (name, value) in [
        ("dynamics.stiffness", "(curve: [(0, 4), (1, 0.2)])"),
        ("dynamics.hold", "(value: 2, vary: 1)"),
        ("dynamics.drag", "(curve: [(0, 0.2), (1, 3)])"),
        ("dynamics.wind", "(curve: [(0, 0), (1, 1)])"),
    ] {
        let own = points(&scene("", GUST, &[(name, value)]), 0.5);
        let apart = farthest(&plain, &own);
        assert!(apart > 1e-3 && apart < 0.4, "{name}: {apart}");
    }
}

#[test]
fn a_loop_without_end_is_refused() {
    let scene = scene(
        "",
        "(version: 1, period: 1000000, loop: true, winds: [(speed: 2)])",
        &[],
    );
    let error = Motion::new().advance_to(&scene, 0.0).unwrap_err();
    let error = error.to_string();
    assert!(
        error.contains("loop: 24000000 frames of") && error.contains("shorter `period`"),
        "{error}"
    );
}

/// What is said of a scene beside how much hair it has.
fn said(scene: &Scene) -> String {
    let (hair, notes) = scene.notes().split_first().unwrap();
    assert_eq!(hair, "hair: 4 clumps, grown from the style");
    notes.join("\n")
}

/// What is said of a loop of so many seconds, at 24 frames a second.
fn said_of_loop(period: &str) -> String {
    let script = format!("(version: 1, period: {period}, loop: true, winds: [(speed: 2)])");
    said(&scene("", &script, &[]))
}

#[test]
fn a_loop_that_is_no_whole_number_of_frames_is_named() {
    for whole in ["2", "1.2917", "1.29167", "0.5"] {
        assert_eq!(said_of_loop(whole), "", "{whole}");
    }
    for (period, named) in [
        (
            "1.3",
            "1.3 s is 31.2 frames at 24 a second, so that a sequence of its pictures has a seam; 1.29167 s are 31 frames",
        ),
        ("0.01", "0.24 frames at 24 a second"),
    ] {
        let notes = said_of_loop(period);
        assert!(notes.contains(named), "{notes}");
    }
}

/// A zone's factors on what the look hasn't change nothing, and that is said once for each.
#[test]
fn factors_on_nothing_are_named() {
    let of = |own: &str, settings: &[(&str, &str)]| said(&scene(own, GUST, settings));
    let own = ", recall: 3, locks: 0.5";
    let notes = of(own, &[]);
    for name in ["recall", "locks"] {
        let named = format!(
            "`{name}` of zone `1` is a factor on the look's `dynamics.{name}`, which is 0: it changes nothing"
        );
        assert_eq!(notes.matches(&named).count(), 1, "{notes}");
    }
    let has_both = [("dynamics.recall", "2"), ("dynamics.locks", "1")];
    assert_eq!(of(own, &has_both), "");
    // That they have none is no mistake, nor what a picture at rest doesn't ask for.
    assert_eq!(of(", recall: 0, locks: 0", &[]), "");
    assert_eq!(said(&scene(own, "(version: 1)", &[])), "");
}

#[test]
fn a_loop_ends_where_it_begins_and_as_fast() {
    let breeze = presets().join("motions/breeze-loop.motion.ron");
    let script = fs::read_to_string(breeze).unwrap();
    let scene = scene("", &script, &[]);
    let mut motion = Motion::new();
    let frames: Vec<Vec<Vec3>> = (0..=48)
        .map(|frame| at(&scene, &mut motion, frame as f32 / 24.0))
        .collect();
    let came_back = motion.returns().next().unwrap();
    println!(
        "{} rounds, {:.2e} m left to blend, {:.2e} on average",
        came_back.rounds, came_back.left_m, came_back.mean_left_m
    );
    assert_eq!(came_back.frames, 48);
    assert!(came_back.mean_left_m <= came_back.left_m);
    assert!(farthest(&frames[48], &frames[0]) < 1e-6);
    // From the last frame to the first is a step like any other: as fast, and bent no more.
    let step = |i: usize| farthest(&frames[i % 48], &frames[(i + 1) % 48]);
    let bend = |i: usize| {
        let [a, b, c] = [i + 47, i, i + 1].map(|i| &frames[i % 48]);
        let middle: Vec<Vec3> = a.iter().zip(c).map(|(a, c)| (*a + *c) * 0.5).collect();
        farthest(&middle, b)
    };
    let most = |of: &dyn Fn(usize) -> f32, range: std::ops::Range<usize>| {
        range.map(of).fold(0.0, f32::max)
    };
    assert!(most(&step, 1..47) > 1e-3);
    assert!(step(47) <= 1.2 * most(&step, 1..46), "{}", step(47));
    assert!(most(&bend, 47..50) <= 1.2 * most(&bend, 2..47));
    // It goes on so, and between frames it is where it may be.
    assert!(farthest(&at(&scene, &mut motion, 7.5), &frames[36]) < 1e-6);
    let between = at(&scene, &mut motion, 7.52);
    assert!(farthest(&between, &frames[36]) < farthest(&frames[36], &frames[37]));
    assert!(farthest(&between, &frames[36]) > 0.0);
}

#[test]
fn what_never_repeats_itself_is_blended() {
    // Gel in a fast swing of the head sticks and slips; limp hair swings on for long.
    let script = "(version: 1, period: 0.5, loop: true, moves: [(move: shake, length: 1000, angle: 30, rate: 2)])";
    let limp = &[("dynamics.feel", "limp"), ("dynamics.drag", "0.1")][..];
    let scene = scene("", script, limp);
    let mut motion = Motion::new();
    let start = at(&scene, &mut motion, 0.0);
    let came_back = motion.returns().next().unwrap();
    assert_eq!(came_back.rounds, 12);
    assert!(came_back.left_m > 1e-3, "{came_back:?}");
    assert!(farthest(&start, &at(&scene, &mut motion, 0.5)) < 1e-6);
    // Lengths stay those of the hair.
    let middle = at(&scene, &mut motion, 0.25);
    let length = |points: &[Vec3]| -> f32 {
        let strands = points.chunks(points.len() / 4);
        let links = strands.flat_map(|strand| strand.windows(2));
        links.map(|link| link[0].distance(link[1])).sum()
    };
    let (rest, now) = (length(&points(&scene, 0.0)), length(&middle));
    assert!((now / rest - 1.0).abs() < 0.05, "{now} {rest}");
}

/// Winds blow in the world: a loop is made anew where its object is turned, and no other.
#[test]
fn a_loop_of_what_is_turned_is_another_one() {
    for (moves, is_blown) in [("winds: [(speed: 3)]", true), (SWAYS, false)] {
        let before = scene(
            "",
            &format!("(version: 1, period: 0.5, loop: true, {moves})"),
            &[],
        );
        let object = before.objects()[0].placed(90.0, Vec3::ZERO);
        let turned = before.with_object(0, object).unwrap();
        let mut motion = Motion::new();
        let first = at(&before, &mut motion, 0.25);
        let then = at(&turned, &mut motion, 0.25);
        assert_eq!(then, points(&turned, 0.25), "{moves}");
        assert_eq!(farthest(&first, &then) > 1e-3, is_blown, "{moves}");
    }
}

const SWAYS: &str = "moves: [(move: shake, length: 1000, angle: 10, rate: 2)]";

/// What a body as large as bodies may be swallows comes out far away, and is simulated all the same.
#[test]
fn hair_longer_than_any_is_simulated() {
    let script = "(version: 1, moves: [(move: turn, length: 0.1, angle: 20)], bodies: [(shape: sphere, radius: 1000)])";
    let scene = scene("", script, &[]);
    assert!(points(&scene, 0.1).iter().all(|point| point.is_finite()));
}

#[test]
fn poses_are_held_on_twos_and_threes() {
    let plain = scene("", SHAKE, &[]);
    for on in [2, 3] {
        let number = on.to_string();
        let held = scene("", SHAKE, &[("motion.on", &number)]);
        let hair = scene(
            "",
            SHAKE,
            &[("motion.on", &number), ("motion.held", "hair")],
        );
        let (mut motion, mut hairs, mut plains) = (Motion::new(), Motion::new(), Motion::new());
        let mut last = Vec::new();
        for frame in 0..18_u32 {
            let time = |frame: u32| frame as f32 / 24.0;
            let first = frame / on * on;
            // The simulation goes on underneath: a held pose is that of its frame on ones.
            let now = at(&held, &mut motion, time(frame));
            assert!(now == at(&plain, &mut plains, time(first)));
            assert_eq!(motion.time_s(), time(first));
            assert_eq!(motion.head(&held), plains.head(&plain));
            // Hair alone: on the head where that is now.
            let own = at(&hair, &mut hairs, time(frame));
            plains.advance_to(&plain, time(frame)).unwrap();
            assert_eq!(hairs.head(&hair), plains.head(&plain));
            if frame > first {
                assert!(own != last && own != now);
                assert!((own[0].distance(own[9]) - now[0].distance(now[9])).abs() < 1e-5);
            } else {
                assert_eq!(own, now);
            }
            last = own;
        }
    }
}

#[test]
fn winds_have_shapes() {
    let blown = |winds: &str| {
        let script = format!("(version: 1, winds: [{winds}])");
        let scene = scene("", &script, &[]);
        let (rest, now) = (points(&scene, 0.0), points(&scene, 0.8));
        let half = rest.len() / 2;
        let mean = |tail: std::ops::Range<usize>| {
            let moved = tail.clone().map(|i| now[i] - rest[i]);
            moved.sum::<Vec3>() / tail.len() as f32
        };
        [mean(0..half), mean(half..rest.len())]
    };
    // A fan at her left blows the left tail more, and to her right.
    let [left, right] = blown("(kind: point, place: (2, -0.5, 0), radius: 0.5, speed: 20)");
    assert!(
        left.x < -0.01 && left.length() > 1.3 * right.length(),
        "{left} {right}"
    );
    // A whirl about the upright axis through her takes one tail forwards and the other back.
    let [left, right] = blown("(kind: vortex, pitch: 90, radius: 1, speed: 6)");
    assert!(
        left.z * right.z < 0.0 && left.z.abs() > 0.01,
        "{left} {right}"
    );
    // Turbulence differs from place to place, and from seed to seed.
    let one = blown("(kind: turbulence, speed: 6, size: 4)");
    let other = blown("(kind: turbulence, speed: 6, size: 4, seed: 1)");
    assert!(one[0].length() > 1e-3 && (one[0] - other[0]).length() > 1e-3);
    // Several add up.
    let both =
        blown("(speed: 3, yaw: 0, gusts: 0), (kind: vortex, pitch: 90, radius: 1, speed: 6)");
    assert!(both[0].z < left.z - 0.003, "{both:?}");
}

#[test]
fn a_head_keeps_the_wind_from_what_is_behind_it() {
    let tail = "(version: 1, undercoat: false, zones: [(name: \"tail\", form: tail, roots: [(180, 10)], hang: 1.5)])";
    let blown = |wake: &str| {
        let script = format!("(version: 1{wake}, winds: [(speed: 3, gusts: 0, yaw: 0)])");
        let scene = scene_of(tail, &script, &[]).unwrap();
        let (rest, now) = (points(&scene, 0.0), points(&scene, 0.5));
        // The part of the tail that is behind the head.
        let (centre, height_m) = (scene.head().center, scene.head().height_m);
        let moved = rest.iter().zip(&now);
        let behind = moved.filter(|(rest, _)| rest.y > centre.y - 0.35 * height_m);
        behind
            .map(|(rest, now)| rest.distance(*now))
            .fold(0.0, f32::max)
    };
    let (open, behind) = (blown(""), blown(", wake: true"));
    println!("a tail behind the head is moved by {open:.4} m, in its wake by {behind:.4} m");
    assert!(behind < 0.9 * open, "{open} {behind}");
}

#[test]
fn a_figure_spins_with_its_shoulders() {
    let spin = "(version: 1, moves: [(move: spin, length: 0.5, angle: 90)])";
    let scene = scene("", spin, &[("dynamics.solver", "none")]);
    let (rest, now) = (points(&scene, 0.0), points(&scene, 1.0));
    // To its left: what was at the left (+X) is at the back (-Z).
    let centre = scene.head().center;
    for (rest, now) in rest.iter().zip(&now) {
        let (rest, now) = (*rest - centre, *now - centre);
        let axis = -0.12 * scene.head().height_m;
        let turned = Vec3::new(rest.z - axis, rest.y, -rest.x + axis);
        assert!(now.distance(turned) < 1e-5, "{now} {turned}");
    }
}

#[test]
fn mistakes_are_told_at_their_places() {
    let told =
        |result: Result<(), PresetErrors>| result.err().map_or(String::new(), |e| e.to_string());
    let script = |text: &str| told(stage::check_motion(Path::new("a.motion.ron"), text));
    let styled = |own: &str| told(stage::check_style(Path::new("a.style.ron"), &style(own)));
    for (message, expected) in [
        (
            script("(version: 1, loop: true)"),
            "a.motion.ron:1:14: loop: how long is it? The script needs a `period`",
        ),
        (
            script("(version: 1, loop: true, period: 2, moves: [(move: turn, angle: 30)])"),
            "a.motion.ron:1:14: loop: the head ends elsewhere than it begins: turned by (30, 0, 0)",
        ),
        (
            // Half a swing too many; one that begins within the period and goes on beyond it; three steps.
            script(
                "(version: 1, loop: true, period: 1.5, moves: [(move: shake, length: 10, angle: 30, rate: 1)])",
            ),
            "loop: the head ends in another motion than it begins in: by (-188.5, 0, 0) degrees and",
        ),
        (
            script(
                "(version: 1, loop: true, period: 2, moves: [(move: nod, start: 0.5, length: 10, rate: 2)])",
            ),
            "loop: the head ends in another motion than it begins in",
        ),
        (
            script(
                "(version: 1, loop: true, period: 1.5, moves: [(move: walk, length: 10, rate: 2)])",
            ),
            "a whole number of swings in the period (a walk of two steps)",
        ),
        (
            script("(version: 1, mvoes: [])"),
            "the motion has no `mvoes`, did you mean `moves`?",
        ),
        (
            script("(version: 1, loop: true, period: 2, winds: [(start: 1)])"),
            "loop: wind 1 begins within the period of 2 s and blows beyond it",
        ),
        (
            script("(version: 1, winds: [(kind: whirl)])"),
            "a.motion.ron:1:29: kind: there is no `whirl`",
        ),
        (
            script("(version: 1, winds: [(kind: vortx)])"),
            "did you mean `vortex`?",
        ),
        (
            script("(version: 1, winds: [(radius: 2)])"),
            "a.motion.ron:1:23: radius: a wind of kind direction has none, only point and vortex",
        ),
        (
            styled(", stifness: 2"),
            "a zone has no `stifness`, did you mean `stiffness`?",
        ),
        (styled(", feel: springi"), "did you mean `springy`?"),
        (
            styled(", hold: (curve: [(0, 1), (2, 1)])"),
            "must rise from 0, the root, to 1, the tip",
        ),
    ] {
        assert!(message.contains(expected), "{expected}\n{message}");
    }
    for whole in [
        "(move: spin, length: 2, angle: 360)",
        "(move: shake, length: 10, angle: 30, rate: 1.5)",
        "(move: walk, length: 10, rate: 3)",
        "(move: turn, angle: 30, length: 0.5), (move: turn, angle: -30, start: 1, length: 0.5)",
    ] {
        let text = format!("(version: 1, loop: true, period: 2, moves: [{whole}])");
        assert_eq!(script(&text), "");
    }
}

#[test]
fn a_zone_has_colors_of_its_own() {
    let own = r#", color: "FF0000", tip_color: "FFFFFF""#;
    let scene = scene_of(&style(own), "(version: 1)", &[]).unwrap();
    let mut frames = stage::FrameMaker::new();
    let motion = Motion::new();
    let frame = frames.frame(&scene, &motion).unwrap();
    let colors: Vec<_> = frame.strands.iter().map(|strand| strand.colors).collect();
    let none = [render::NO_COLOR; 2];
    let red = [Vec3::X, Vec3::ONE];
    assert_eq!(colors, [none, none, red, red]);
    let wrong = scene_of(&style(", color: red"), "(version: 1)", &[]);
    let message = wrong.err().unwrap();
    assert!(
        message.contains("color: expected a colour such as"),
        "{message}"
    );
}
