//! Bodies of presets and scripts, and ties that move with the hair.

#![allow(
    clippy::print_stdout,
    reason = "a test shows the figures that it holds"
)]

mod meshes;

use effects::Registry;
use glam::Vec3;
use stage::{Bake, Files, Motion, Preset, Scene, Stage};
use std::fs;
use std::path::{Path, PathBuf};
use stroke_path::PathKind;

/// The head's height and middle of the bust.
const TAIL: &str = "(version: 1, undercoat: false, zones: [(name: \"tail\", form: tail, roots: [(180, 30)], hang: 1.5, count: 6)])";

fn registry() -> Registry {
    let mut registry = Registry::new();
    effects_builtin::register(&mut registry).unwrap();
    registry
}

/// A folder with a style, a script, and a preset on a bust that says more.
struct Given {
    folder: tempfile::TempDir,
    preset: String,
}

impl Given {
    fn new(style: &str, script: &str, more: &str) -> Self {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("a.style.ron"), style).unwrap();
        fs::write(folder.path().join("a.motion.ron"), script).unwrap();
        let preset = format!(
            "(version: 1, hair: (file: \"a.style.ron\"), head: (shape: bust), motion: (file: \"a.motion.ron\"), {more}\n\
             layers: [(effect: \"hair.base\")])"
        );
        Self { folder, preset }
    }

    fn files(&self) -> Files {
        Files {
            preset_folder: self.folder.path().to_owned(),
            ..Files::default()
        }
    }

    fn scene(&self) -> Result<Scene, String> {
        let registry = registry();
        let preset = Preset::parse("look.ron", &self.preset, &registry);
        let preset = preset.map_err(|errors| errors.to_string())?;
        Scene::load(&preset, &self.files()).map_err(|error| error.to_string())
    }

    /// All that `inkstrand check` says.
    fn checked(&self) -> String {
        let registry = registry();
        let checked = Preset::check("look.ron", &self.preset, &registry, &self.files());
        checked
            .err()
            .map_or(String::new(), |errors| errors.to_string())
    }
}

fn points(scene: &Scene, motion: &mut Motion, time: f32) -> Vec<Vec3> {
    motion.advance_to(scene, time).unwrap();
    motion.points(scene, 0).to_vec()
}

/// How deep the way that is drawn through the points of strands is in a ball, m.
fn depth_in(points: &[Vec3], strands: usize, center: Vec3, radius_m: f32) -> f32 {
    let drawn = PathKind::CatmullRom { subdivision: 8 };
    let strands = points.chunks(points.len() / strands);
    strands
        .flat_map(|strand| drawn.joints(strand).unwrap())
        .map(|at| radius_m - at.distance(center))
        .fold(0.0, f32::max)
}

#[test]
fn hair_styled_in_a_body_lies_around_it_and_stays_there() {
    let still = Given::new(TAIL, "(version: 1)", "");
    let scene = still.scene().unwrap();
    let styled = points(&scene, &mut Motion::new(), 0.0);
    let (center, height_m) = (scene.head().center, scene.head().height_m);
    // Where the tail is half way down.
    let middle = styled.iter().sum::<Vec3>() / styled.len() as f32;
    let at = (middle - center) / height_m;
    let radius_m = 0.15 * height_m;
    assert!(depth_in(&styled, 6, middle, radius_m) > 0.01);
    let body = format!(
        "bodies: [(at: ({}, {}, {}), radius: 0.15)],",
        at.x, at.y, at.z
    );
    // In still air, and while something else moves far away.
    let far = "(version: 1, bodies: [(name: \"far\", at: (50, 0, 0))], \
               body_keys: [(body: \"far\", time: 0), (body: \"far\", time: 9, at: (5, 0, 0))])";
    for script in ["(version: 1)", far] {
        let given = Given::new(TAIL, script, &body);
        assert_eq!(given.checked(), "");
        let scene = given.scene().unwrap();
        let mut motion = Motion::new();
        let first = points(&scene, &mut motion, 0.0);
        let deepest = depth_in(&first, 6, middle, radius_m);
        assert!(deepest < 1e-4, "{deepest}");
        let later = points(&scene, &mut motion, 3.0);
        let sagged = first.iter().zip(&later).map(|(a, b)| a.distance(*b));
        let sagged = sagged.fold(0.0, f32::max);
        println!("styled in a ball: {deepest:.1e} m in it, and {sagged:.1e} m away after 3 s");
        assert!(sagged < 1e-4, "{sagged}");
    }
}

/// Hair has the bits that it has without bodies which it never comes to, however they move, and sleeps while they do.
#[test]
fn bodies_out_of_reach_cost_nothing() {
    let nod = "moves: [(move: nod, start: 0.1, length: 0.4, angle: 20)]";
    let far = "bodies: [(name: \"a\", at: (9, 0, 0)), (name: \"b\", shape: capsule, at: (0, -9, 1), to: (0, -9, -1), radius: 2), \
               (name: \"c\", shape: mesh, file: \"c.####.obj\", at: (0, 0, 40))], \
               body_keys: [(body: \"a\", time: 0), (body: \"a\", time: 30, at: (9, 9, 0))]";
    let scene = |script: String| {
        let given = Given::new(TAIL, &script, "");
        // It changes its form.
        for (number, half) in [0.2, 0.3].into_iter().enumerate() {
            let cube = meshes::cube([half; 3], [0.0; 3]);
            fs::write(given.folder.path().join(format!("c.000{number}.obj")), cube).unwrap();
        }
        given.scene().unwrap()
    };
    let without = scene(format!("(version: 1, {nod})"));
    let with = scene(format!("(version: 1, {nod}, {far})"));
    let [mut one, mut other] = [(); 2].map(|()| Motion::new());
    for time in [0.0, 0.3, 0.6, 1.0] {
        assert_eq!(
            points(&without, &mut one, time),
            points(&with, &mut other, time),
            "{time}"
        );
    }
    points(&with, &mut other, 15.0);
    let stats = other.simulated();
    assert!(stats.strands == 0 && stats.asleep > 0, "{stats:?}");
}

#[test]
fn a_body_that_moves_takes_hair_along_and_what_it_swallows_comes_out() {
    let script = |keys: &str| {
        format!(
            "(version: 1, bodies: [(name: \"ball\", at: (3, -0.7, -0.65), radius: 0.2)], body_keys: [{keys}])"
        )
    };
    // Slowly from the side, and at once into the tail's midst.
    let slow = "(body: \"ball\", time: 0), (body: \"ball\", time: 1, at: (-3.2, 0, 0)), (body: \"ball\", time: 1.01, at: (-3.2, 0, 0)), (body: \"ball\", time: 3, at: (-3.2, 0, 0))";
    let sudden = "(body: \"ball\", time: 0.5), (body: \"ball\", time: 0.54, at: (-3, 0, 0)), (body: \"ball\", time: 0.55, at: (-3, 0, 0)), (body: \"ball\", time: 3, at: (-3, 0, 0))";
    for (what, keys, within, x) in [
        ("pushed", slow, 1.02, -0.2),
        ("swallowed", sudden, 1.54, 0.0),
    ] {
        for rate in [24.0_f32, 60.0] {
            let given = Given::new(TAIL, &script(keys), &format!("scene: (fps: {rate}),"));
            let scene = given.scene().unwrap();
            let (center, height_m) = (scene.head().center, scene.head().height_m);
            let mut motion = Motion::new();
            let rest = points(&scene, &mut motion, 0.0);
            let mut deepest: f32 = 0.0;
            for frame in 0..(3.0 * rate) as u32 {
                let time = frame as f32 / rate;
                let now = points(&scene, &mut motion, time);
                if time >= within {
                    let ball = center + Vec3::new(x, -0.7, -0.65) * height_m;
                    deepest = deepest.max(depth_in(&now, 6, ball, 0.2 * height_m));
                }
                assert!(now.iter().all(|point| point.is_finite()));
            }
            let moved = points(&scene, &mut motion, 3.0);
            let moved = rest.iter().zip(&moved).map(|(a, b)| a.distance(*b));
            let moved = moved.fold(0.0, f32::max);
            println!(
                "{what} at {rate} frames a second: {deepest:.1e} m in it from {within} s on; moved by {moved:.3} m"
            );
            assert!(deepest < 1e-3, "{what}, {rate}: {deepest}");
            assert!(moved > 0.01, "{what}: {moved}");
        }
    }
}

/// Held hair goes with the head from frame to frame, and would go into what stays: simulated, in a loop, and of a bake, which shows what was baked.
#[test]
fn held_hair_keeps_out_of_bodies() {
    let bodies =
        "bodies: [(at: (0.35, -0.7, -0.65), radius: 0.2), (at: (-0.35, -0.7, -0.65), radius: 0.2)]";
    let once = format!(
        "(version: 1, moves: [(move: turn, start: 0.1, length: 0.4, angle: 60)], {bodies})"
    );
    let round = format!(
        "(version: 1, period: 1, loop: true, moves: [(move: turn, start: 0.1, length: 0.4, angle: 60), \
         (move: turn, start: 0.5, length: 0.4, angle: -60)], {bodies})"
    );
    let times = || (0..20_u32).map(|frame| frame as f32 / 24.0);
    for (what, script) in [("once", once), ("in a loop", round)] {
        let given = Given::new(TAIL, &script, "");
        let mut held = Given::new(TAIL, &script, "");
        held.preset = held.preset.replace(
            "motion: (file: \"a.motion.ron\")",
            "motion: (file: \"a.motion.ron\", on: 4, held: hair)",
        );
        let all_points = |scene: &Scene| -> Vec<Vec<Vec3>> {
            let mut motion = Motion::new();
            times()
                .map(|time| points(scene, &mut motion, time))
                .collect()
        };
        let scene = held.scene().unwrap();
        let shown = all_points(&scene);
        assert!(shown != all_points(&given.scene().unwrap()), "{what}");
        let (center, height_m) = (scene.head().center, scene.head().height_m);
        let depths = shown.iter().flat_map(|now| {
            [0.35, -0.35].map(|x| {
                let ball = center + Vec3::new(x, -0.7, -0.65) * height_m;
                depth_in(now, 6, ball, 0.2 * height_m)
            })
        });
        let deepest = depths.fold(0.0, f32::max);
        println!("held hair {what}: {deepest:.1e} m in a ball");
        assert!(deepest < 1e-3, "{what}: {deepest}");

        let registry = registry();
        let preset = Preset::parse("look.ron", &held.preset, &registry).unwrap();
        let mut stage = Stage::new(&preset, &held.files()).unwrap();
        let mut bake = Bake::new(&preset, &held.files(), &stage.scene).unwrap();
        for time in times() {
            stage.advance_to(time).unwrap();
            stage.record(time, &mut bake);
        }
        let file = held.folder.path().join("bake.strands.ron");
        fs::write(&file, stage.bake_text(bake).unwrap()).unwrap();
        let files = Files {
            bake: Some(file),
            ..held.files()
        };
        let baked = all_points(&Scene::load(&preset, &files).unwrap());
        assert!(baked == shown, "{what}, of a bake");
    }
}

#[test]
fn mistakes_of_bodies_are_told_at_their_places() {
    let given = |more: &str, script: &str| Given::new(TAIL, script, more);
    let still = "(version: 1)";
    let preset = |more: &str| given(more, still).checked();
    let script = |text: &str| given("", text).checked();
    for (message, expected) in [
        (
            preset("bodies: (radius: 1),"),
            "bodies is a list, of one body too",
        ),
        (
            preset("bodies: [(shape: ball)],"),
            "shape: there is no `ball`",
        ),
        (
            preset("bodies: [(shape: capsul)],"),
            "did you mean `capsule`?",
        ),
        (
            preset("bodies: [(radios: 1)],"),
            "a body has no `radios`, did you mean `radius`?",
        ),
        (
            preset("bodies: [(radius: -1)],"),
            "radius: expected a number from 0",
        ),
        (
            preset("bodies: [(to: (1, 1, 1))],"),
            "to: a sphere has none, only capsule",
        ),
        (
            preset("bodies: [(shape: mesh)],"),
            "a body of shape mesh needs `file",
        ),
        (
            preset("bodies: [(shape: mesh, file: \"nobody.obj\")],"),
            "file: there is no `",
        ),
        (
            preset("bodies: [(name: \"a\"), (name: \"a\")],"),
            "name: two bodies are called `a`",
        ),
        (
            script("(version: 1, body_keys: [(time: 1)])"),
            "a key of a body needs `body: \"...\"`",
        ),
        (
            script("(version: 1, bodies: [(name: \"hand\")], body_keys: [(body: \"hnad\")])"),
            "a.motion.ron:1:59: body: neither the script nor the preset has a body `hnad`, did you mean `hand`?",
        ),
        (
            script(
                "(version: 1, bodies: [(name: \"a\")], body_keys: [(body: \"a\", time: 2), (body: \"a\", time: 1)])",
            ),
            "the keys of the body `a` must ascend",
        ),
        (
            script(
                "(version: 1, period: 2, loop: true, bodies: [(name: \"a\")], \
                    body_keys: [(body: \"a\"), (body: \"a\", time: 2, at: (1, 0, 0))])",
            ),
            "body: `a` ends elsewhere than it begins",
        ),
        (
            script("(version: 1, bodies: [(shape: mesh, file: \"b.obj\")])"),
            "file: there is no `",
        ),
    ] {
        assert!(message.contains(expected), "{expected}\n{message}");
    }
    // A mesh that closes nothing in.
    let empty = given("bodies: [(shape: mesh, file: \"a.obj\")],", still);
    fs::write(
        empty.folder.path().join("a.obj"),
        "v 0 0 0\nv 1 0 0\nv 0 1 0\n",
    )
    .unwrap();
    let message = empty.checked();
    assert!(
        message.contains("look.ron:1:") && message.contains("file: "),
        "{message}"
    );
}

#[test]
fn the_preset_s_bodies_are_moved_by_the_script() {
    let more = "bodies: [(name: \"hand\", at: (0, -0.9, -3), radius: 0.2)],";
    let keys = "(version: 1, body_keys: [(body: \"hand\", time: 0), (body: \"hand\", time: 1, at: (0, 0, 2.4))])";
    let moved = Given::new(TAIL, keys, more).scene().unwrap();
    let own = "(version: 1, bodies: [(name: \"ball\", at: (0, -0.9, -3), radius: 0.2)], \
               body_keys: [(body: \"ball\", time: 0), (body: \"ball\", time: 1, at: (0, 0, 2.4))])";
    let scripted = Given::new(TAIL, own, "").scene().unwrap();
    let [one, other] = [moved, scripted].map(|scene| points(&scene, &mut Motion::new(), 1.5));
    assert!(one == other);
}

/// Carried strands are kept out of the shoulders and of all bodies.
#[test]
fn strands_that_guides_carry_are_kept_out_too() {
    let style = "(version: 1, undercoat: false, zones: [(name: \"back\", roots: [(120, 30), (180, 40), (-120, 30)], hang: 1.6, count: 60, spread: 0.3)])";
    let ball = "(version: 1, moves: [(move: turn, start: 0.1, length: 0.4, angle: 40)], \
                bodies: [(name: \"ball\", at: (3, -0.55, -0.3), radius: 0.25)], \
                body_keys: [(body: \"ball\", time: 0), (body: \"ball\", time: 1, at: (-2.25, 0, 0)), (body: \"ball\", time: 2, at: (-2.25, 0, 0))])";
    let given = Given::new(style, ball, "dynamics: (guides: 12),");
    let scene = given.scene().unwrap();
    let (center, height_m) = (scene.head().center, scene.head().height_m);
    let mut motion = Motion::new();
    let mut deepest: f32 = 0.0;
    for frame in 0..48 {
        let now = points(&scene, &mut motion, frame as f32 / 24.0);
        if frame >= 24 {
            let ball = center + Vec3::new(0.75, -0.55, -0.3) * height_m;
            deepest = deepest.max(depth_in(&now, 60, ball, 0.25 * height_m));
        }
    }
    assert_eq!(motion.simulated().strands, 12);
    println!("60 strands, 12 of them guides: {deepest:.1e} m in the ball");
    assert!(deepest < 1e-3, "{deepest}");
}

#[test]
fn tied_hair_stays_together_and_its_tie_goes_with_it() {
    let style = |low: &str| {
        format!(
            "(version: 1, undercoat: false, zones: [(name: \"tail\", form: tail, roots: [(180, 30)], hang: 1.6, count: 9, \
             fullness: 0.25, sway: 0.5, length_variation: 0, feel: limp{low})])"
        )
    };
    let thrown = "(version: 1, moves: [(move: turn, start: 0.1, length: 0.4, angle: 60), (move: turn, start: 1.1, length: 0.5, angle: -60)], \
                  winds: [(speed: 4, gusts: 2, yaw: 60)])";
    let tie = ", low_tie: 0.5, low_tie_size: 0.06";
    let scenes = |rate: f32| {
        let more = format!("scene: (fps: {rate}),");
        ["", tie].map(|low| Given::new(&style(low), thrown, &more).scene().unwrap())
    };
    let [free, tied] = scenes(24.0);
    let radius_m = 0.06 * free.head().height_m;
    // How far tied points are from their middle.
    let spread = |points: &[Vec3], at: usize| {
        let strands = points.chunks(points.len() / 9);
        let tied: Vec<Vec3> = strands.map(|strand| strand[at]).collect();
        let middle = tied.iter().sum::<Vec3>() / 9.0;
        tied.iter()
            .map(|point| point.distance(middle))
            .fold(0.0, f32::max)
    };
    let rest = points(&tied, &mut Motion::new(), 0.0);
    let count = rest.len() / 9;
    let at = (2..count)
        .min_by(|a, b| spread(&rest, *a).total_cmp(&spread(&rest, *b)))
        .unwrap();
    assert!(spread(&rest, at) < radius_m, "{at}");
    for rate in [24.0_f32, 60.0] {
        let widest = scenes(rate).map(|scene| {
            let mut motion = Motion::new();
            let frames = (2.5 * rate) as u32;
            let widest = (0..frames).map(|frame| {
                let now = points(&scene, &mut motion, frame as f32 / rate);
                assert!(now.iter().all(|point| point.is_finite()));
                spread(&now, at)
            });
            widest.fold(0.0, f32::max)
        });
        println!(
            "{rate} frames a second: tied points at most {:.4} m from their middle, free ones {:.4}; the tie's radius is {radius_m:.4} m",
            widest[1], widest[0]
        );
        assert!(
            widest[1] < radius_m && widest[0] > 1.5 * radius_m,
            "{widest:?}"
        );
    }
    // It comes to rest for the eye, if not yet to sleep.
    let calm = "(version: 1, moves: [(move: turn, start: 0.1, length: 0.3, angle: 40)])";
    let scene = Given::new(&style(tie), calm, "").scene().unwrap();
    let mut motion = Motion::new();
    let [one, other] = [30.0, 31.0].map(|time| points(&scene, &mut motion, time));
    let moved = one.iter().zip(&other).map(|(a, b)| a.distance(*b));
    let moved = moved.fold(0.0, f32::max);
    let asleep = motion.simulated().asleep;
    println!(
        "tied hair moves by {moved:.1e} m in a second after half a minute, and {asleep} strands of 9 sleep"
    );
    assert!(moved < 1e-3, "{moved}");
    // A moment is the same however it is reached.
    let at_once = points(&tied, &mut Motion::new(), 1.0);
    let mut motion = Motion::new();
    for frame in 0..30 {
        points(&tied, &mut motion, frame as f32 / 29.0);
    }
    assert!(points(&tied, &mut motion, 1.0) == at_once);
}

#[test]
fn the_bits_are_the_same_for_any_number_of_threads() {
    let style = "(version: 1, zones: [(name: \"tail\", form: tail, roots: [(180, 30)], hang: 1.6, count: 24, low_tie: 0.6)])";
    let script = "(version: 1, moves: [(move: shake, length: 1, angle: 30)], bodies: [(on: shoulders, shape: capsule, at: (-1, -1, -0.4), to: (1, -1, -0.4))])";
    let scene = Given::new(style, script, "").scene().unwrap();
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        let pool = pool.build().unwrap();
        pool.install(|| points(&scene, &mut Motion::new(), 1.5))
    };
    assert!(with(1) == with(2));
}

#[test]
fn a_folder_is_no_mesh() {
    let given = Given::new(
        TAIL,
        "(version: 1)",
        "bodies: [(shape: mesh, file: \"sub\")],",
    );
    fs::create_dir(given.folder.path().join("sub")).unwrap();
    let message = given.checked();
    let path: PathBuf = Path::new("sub").to_owned();
    assert!(
        message.contains("is a folder") && message.contains(&path.display().to_string()),
        "{message}"
    );
}
