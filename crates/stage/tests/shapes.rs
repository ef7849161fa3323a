//! Key shapes of hair: what scripts say of them, and that hair follows.

use effects::Registry;
use glam::Vec3;
use stage::{Files, Preset, Stage, check_motion};
use std::fs;
use std::path::Path;

/// Three strands that hang from a row of roots, `slant` metres to the side at the tip.
fn strands(slant: f32, points: usize) -> String {
    let strand = |x: f32| {
        let points = (0..points).map(|i| {
            let t = i as f32 / (points - 1) as f32;
            // On an arc of one length, so that shapes can be reached.
            let (sin, cos) = (slant * t).sin_cos();
            let (side, down) = if slant == 0.0 {
                (0.0, t)
            } else {
                ((1.0 - cos) / slant, sin / slant)
            };
            format!("({}, {}, 0.1)", x + 0.3 * side, -0.3 * down)
        });
        format!(
            "(size: 10.0, points: [{}])",
            points.collect::<Vec<_>>().join(", ")
        )
    };
    let all = [-0.05, 0.0, 0.05].map(strand);
    format!("(version: 1, strands: [{}])", all.join(", "))
}

/// A scene of hanging strands with `other.strands.ron` beside, or why there is none.
fn scene(script: &str, other: &str, settings: &[(&str, &str)]) -> Result<Stage, String> {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
    write("own.strands.ron", &strands(0.0, 12));
    write("other.strands.ron", other);
    write("a.motion.ron", script);
    let text = "(version: 1, hair: (file: \"own.strands.ron\"), motion: (file: \"a.motion.ron\"),
        path: (kind: linear, subdivision: 1), layers: [(effect: \"hair.base\")])";
    let mut registry = Registry::new();
    effects_builtin::register(&mut registry).unwrap();
    let mut preset = Preset::parse("look.ron", text, &registry).unwrap();
    for (name, value) in settings {
        preset.set(name, value).unwrap();
    }
    let files = Files {
        preset_folder: folder.path().to_owned(),
        ..Files::default()
    };
    Stage::new(&preset, &files).map_err(|error| error.to_string())
}

fn points(stage: &mut Stage, time: f32) -> Vec<Vec3> {
    stage.advance_to(time).unwrap();
    stage.frame().unwrap().paths.position.clone()
}

/// How far the points are from others, in all.
fn apart(a: &[Vec3], b: &[Vec3]) -> f32 {
    let sum: f32 = a.iter().zip(b).map(|(a, b)| a.distance_squared(*b)).sum();
    (sum / a.len() as f32).sqrt()
}

const SWAY: &str = "(version: 1, hold: (HOLD), shapes: [
    (time: 0),
    (time: 1, hair: \"other.strands.ron\"),
    (time: 2),
])";

fn sway(hold: &str, settings: &[(&str, &str)]) -> Stage {
    scene(&SWAY.replace("HOLD", hold), &strands(0.8, 12), settings).unwrap()
}

#[test]
fn without_dynamics_hair_is_where_its_keys_have_it() {
    let mut stage = sway("0, 0, 0", &[("dynamics.solver", "none")]);
    let rest = points(&mut stage, 0.0);
    let keyed = points(&mut stage, 1.0);
    let tip = keyed[11];
    assert!(
        (tip.x - (-0.05 + 0.3 * (1.0 - 0.8_f32.cos()) / 0.8)).abs() < 1e-6,
        "{tip}"
    );
    assert!(points(&mut stage, 2.0) == rest && points(&mut stage, 60.0) == rest);
    // The spline starts slowly: 3 t^2 - 2 t^3 and a part of the slope at the middle key, which is 0 here.
    let quarter = points(&mut stage, 0.25)[11];
    assert!(
        (quarter.x - rest[11].x.lerp(tip.x, 0.15625)).abs() < 1e-6,
        "{quarter}"
    );
}

trait Lerp {
    fn lerp(self, to: Self, t: f32) -> Self;
}

impl Lerp for f32 {
    fn lerp(self, to: f32, t: f32) -> f32 {
        self + (to - self) * t
    }
}

#[test]
fn from_pure_dynamics_to_pure_keyframes() {
    let mut keyed = sway("0, 0, 0", &[("dynamics.solver", "none")]);
    let rest = points(&mut keyed, 0.0);
    let wanted = points(&mut keyed, 1.0);
    let whole = apart(&rest, &wanted);
    let left: Vec<f32> = [
        "0, 0, 0",
        "30, 10, 5",
        "300, 200, 100",
        "10000, 10000, 10000",
    ]
    .iter()
    .map(|hold| {
        let mut stage = sway(hold, &[]);
        assert!(points(&mut stage, 0.0) == rest);
        apart(&points(&mut stage, 1.0), &wanted) / whole
    })
    .collect();
    assert!((left[0] - 1.0).abs() < 1e-3, "nothing pulls: {left:?}");
    assert!(left.is_sorted_by(|a, b| a > b), "{left:?}");
    assert!((0.2..0.6).contains(&left[2]) && left[3] < 0.02, "{left:?}");
    // A factor on all of it.
    let mut none = sway("300, 200, 100", &[("dynamics.hold", "0")]);
    assert!((apart(&points(&mut none, 1.0), &wanted) / whole - 1.0).abs() < 1e-3);
}

#[test]
fn the_pull_does_not_hang_on_the_step() {
    let at = |step: &str| points(&mut sway("300, 200, 100", &[("dynamics.step", step)]), 1.0);
    let (coarse, fine) = (at("0.0416666"), at("0.002"));
    let mut still = sway("0, 0, 0", &[("dynamics.solver", "none")]);
    let moved = apart(&points(&mut still, 0.0), &fine);
    assert!(
        apart(&coarse, &fine) < 0.03 * moved,
        "{}",
        apart(&coarse, &fine) / moved
    );
}

#[test]
fn guides_are_pulled_to_their_own_shapes() {
    // A quadratic that holds the roots alone leaves the tips to dynamics.
    let mut roots = sway("3000, 0, 0", &[("dynamics.guides", "2")]);
    let mut tips = sway("0, 0, 3000", &[("dynamics.guides", "2")]);
    let mut keyed = sway("0, 0, 0", &[("dynamics.solver", "none")]);
    let wanted = points(&mut keyed, 1.0);
    let tip = |points: &[Vec3]| points[11].distance(wanted[11]);
    let (roots, tips) = (points(&mut roots, 1.0), points(&mut tips, 1.0));
    assert!(
        tip(&tips) < 0.3 * tip(&roots),
        "{} {}",
        tip(&tips),
        tip(&roots)
    );
}

#[test]
fn a_moment_of_a_bake_is_a_shape() {
    let moving = "(version: 1, strands: [STRANDS], motion: [
        (time: 0.0, strands: [MOTION0]), (time: 2.0, strands: [MOTION1])])";
    let list = |x: f32| {
        let strand = |root: f32| {
            let points =
                (0..12).map(|i| format!("({}, {}, 0.1)", root + x * i as f32, -0.02 * i as f32));
            format!("[{}]", points.collect::<Vec<_>>().join(", "))
        };
        [-0.05, 0.0, 0.05].map(strand).join(", ")
    };
    let still = list(0.0)
        .replace("[(", "(points: [(")
        .replace("1)]", "1)])");
    let text = moving
        .replace("STRANDS", &still)
        .replace("MOTION0", &list(0.0))
        .replace("MOTION1", &list(0.02));
    let script = "(version: 1, shapes: [(time: 0, hair: \"other.strands.ron\", at: 1)])";
    let mut stage = scene(script, &text, &[("dynamics.solver", "none")]).unwrap();
    let tip = points(&mut stage, 0.0)[11];
    assert!(
        tip.distance(Vec3::new(-0.05 + 0.11, -0.22, 0.1)) < 1e-6,
        "{tip}"
    );
}

#[test]
fn mistakes_have_their_places() {
    let fails = |script: &str, other: &str, expected: &str| {
        let message = scene(script, other, &[]).err().unwrap();
        assert!(
            message.contains(expected),
            "`{expected}` is missing in:\n{message}"
        );
    };
    let good = strands(0.5, 12);
    fails(
        "(version: 1,\n shapes: [(time: 0, hair: \"othr.strands.ron\")])",
        &good,
        "a.motion.ron:2:27: hair: there is no",
    );
    fails(
        "(version: 1, shapes: [(time: 0, hair: \"othr.strands.ron\")])",
        &good,
        "did you mean `other.strands.ron`?",
    );
    let one = "(version: 1, shapes: [(time: 1), (time: 2, hair: \"other.strands.ron\")])";
    fails(
        one,
        &strands(0.5, 9),
        "1:50: hair: `other.strands.ron` is not of the same strands: strand 0 has 9 points in place of 12",
    );
    let two = "(version: 1, strands: [(points: [(0.0, 0.0, 0.0), (0.0, -0.1, 0.0)])])";
    fails(
        one,
        two,
        "is not of the same strands: 1 strands in place of 3",
    );
    fails(
        "(version: 1, shapes: [(time: 1, hair: \"other.strands.ron\", at: 3)])",
        &good,
        "has no motion, so no moment 3 s",
    );
    fails(
        "(version: 1, shapes: [(time: 1), (time: 1)])",
        &good,
        "1:34: shapes: times must ascend",
    );
    fails(
        "(version: 1, shapes: [(time: 1, at: 1)])",
        &good,
        "1:33: at: there is no `hair`",
    );
    fails(
        "(version: 1, hold: (1, 2, 3))",
        &good,
        "1:14: hold: the script has no `shapes`",
    );
    fails(
        "(version: 1, hold: (1, -2, 3), shapes: [(time: 1)])",
        &good,
        "hold: expected three numbers",
    );
    fails(
        "(version: 1, shapes: [(time: 1, hare: \"a\")])",
        &good,
        "a shape has no `hare`, did you mean `hair`?",
    );
}

#[test]
fn a_style_in_other_words_is_a_shape() {
    let presets = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../presets");
    let folder = tempfile::tempdir().unwrap();
    let style = fs::read_to_string(presets.join("styles/bob.style.ron")).unwrap();
    fs::write(folder.path().join("own.style.ron"), &style).unwrap();
    let longer = style.replacen("seed: ", "seed: 1", 1);
    fs::write(folder.path().join("other.style.ron"), longer).unwrap();
    let script = "(version: 1, shapes: [(time: 0), (time: 1, hair: \"other.style.ron\")])";
    fs::write(folder.path().join("a.motion.ron"), script).unwrap();
    let mut registry = Registry::new();
    effects_builtin::register(&mut registry).unwrap();
    let text = "(version: 1, hair: (file: \"own.style.ron\"), head: (shape: bust), dynamics: (solver: none),
        motion: (file: \"a.motion.ron\"), layers: [(effect: \"hair.base\")])";
    let preset = Preset::parse("look.ron", text, &registry).unwrap();
    let files = Files {
        preset_folder: folder.path().to_owned(),
        ..Files::default()
    };
    let mut stage = Stage::new(&preset, &files).unwrap();
    let (before, after) = (points(&mut stage, 0.0), points(&mut stage, 1.0));
    assert!(apart(&before, &after) > 1e-4);
    // What the head holds stays.
    let held = before.iter().zip(&after).filter(|(a, b)| a == b).count();
    assert!(held > 100, "{held}");
}

#[test]
fn a_long_script_on_one_line_takes_little_memory() {
    let keys = |count: usize| {
        let keys: Vec<String> = (0..count).map(|i| format!("(time: {i})")).collect();
        format!("(version: 1, shapes: [{}])", keys.join(", "))
    };
    // Each remembers its place, of which the line is a part.
    assert!(check_motion(Path::new("a.motion.ron"), &keys(20_000)).is_ok());
    let wrong = keys(20_000).replace("(time: 10000)", "(time: 10000, hair: \"none.style.ron\")");
    let errors = check_motion(Path::new("a.motion.ron"), &wrong).unwrap_err();
    assert!(errors.0[0].place.source_line.len() <= 100);
}

#[test]
fn more_shapes_than_memory_holds_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let long = "(0, 1, 0), ".repeat(100_000);
    let hair = format!("(version: 1, strands: [(size: 1, points: [{long}])])");
    let keys: String = (0..700).map(|i| format!("(time: {i}), ")).collect();
    fs::write(folder.path().join("own.strands.ron"), hair).unwrap();
    let script = format!("(version: 1, shapes: [{keys}])");
    fs::write(folder.path().join("a.motion.ron"), script).unwrap();
    let text = "(version: 1, hair: (file: \"own.strands.ron\"), motion: (file: \"a.motion.ron\"),
        layers: [(effect: \"hair.base\")])";
    let mut registry = Registry::new();
    effects_builtin::register(&mut registry).unwrap();
    let preset = Preset::parse("look.ron", text, &registry).unwrap();
    let files = Files {
        preset_folder: folder.path().to_owned(),
        ..Files::default()
    };
    let message = Stage::new(&preset, &files).err().unwrap().to_string();
    assert!(message.contains("at most 671 shapes fit"), "{message}");
}
