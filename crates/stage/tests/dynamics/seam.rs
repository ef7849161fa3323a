//! Animations that repeat and start again elsewhere than they ended: hair goes over that as if they went on.

use super::{farthest, means, scene, written};
use effects::Registry;
use glam::{Quat, Vec3};
use stage::{Files, Motion, Preset, Scene};
use std::fs;
use std::path::Path;
use stroke_path::{Camera, OrbitView};

/// How far hair may be from where a motion that goes on has it, m: a hair's thickness.
const ALIKE_M: f32 = 1e-4;

/// A character that walks on and turns on evenly.
struct Walk {
    /// Seconds of a round.
    round_s: f32,
    /// m/s.
    speed: Vec3,
    /// Degrees a second, to its left.
    turn: f32,
}

impl Walk {
    fn ahead(round_s: f32) -> Self {
        Self {
            round_s,
            speed: Vec3::new(0.3, 0.0, 1.0),
            turn: 0.0,
        }
    }

    /// Writes the character in an animation of so many rounds.
    fn write(&self, path: &Path, rounds: u16) {
        let keys = 4 * rounds;
        let times = (0..=keys).map(|key| self.round_s * f32::from(key) / 4.0);
        let half = |time: f32| (0.5 * self.turn * time).to_radians();
        let turns = times.clone().flat_map(|time| {
            let (sin, cos) = half(time).sin_cos();
            [0.0, sin, 0.0, cos]
        });
        let places = times
            .clone()
            .flat_map(|time| (self.speed * time).to_array());
        let numbers: Vec<f32> = times.clone().chain(turns).chain(places).collect();
        let bytes: Vec<u8> = numbers.iter().flat_map(|x| x.to_le_bytes()).collect();
        fs::write(path.with_extension("bin"), &bytes).unwrap();
        let name = path.with_extension("bin");
        let name = name.file_name().unwrap().to_string_lossy();
        let count = usize::from(keys) + 1;
        let view = |first: usize, width: usize| {
            format!(
                r#"{{"buffer": 0, "byteOffset": {}, "byteLength": {}}}"#,
                4 * count * first,
                4 * count * width
            )
        };
        let (inputs, rotations, translations) = (view(0, 1), view(1, 4), view(5, 3));
        let text = format!(
            r#"{{
            "asset": {{"version": "2.0"}},
            "nodes": [{{"name": "hips", "children": [1]}}, {{"name": "head", "translation": [0, 1.5, 0]}}],
            "buffers": [{{"byteLength": {}, "uri": "{name}"}}],
            "bufferViews": [{inputs}, {rotations}, {translations}],
            "accessors": [
                {{"bufferView": 0, "componentType": 5126, "count": {count}, "type": "SCALAR"}},
                {{"bufferView": 1, "componentType": 5126, "count": {count}, "type": "VEC4"}},
                {{"bufferView": 2, "componentType": 5126, "count": {count}, "type": "VEC3"}}
            ],
            "animations": [{{
                "samplers": [{{"input": 0, "output": 1}}, {{"input": 0, "output": 2}}],
                "channels": [
                    {{"sampler": 0, "target": {{"node": 0, "path": "rotation"}}}},
                    {{"sampler": 1, "target": {{"node": 0, "path": "translation"}}}}
                ]
            }}]
        }}"#,
            bytes.len()
        );
        fs::write(path, text).unwrap();
    }

    /// Scenes of it in a round that repeats, and in one that is five times as long; with this head, hair and script.
    fn scenes(&self, fps: u32, head: &str, style: &str, script: &str) -> [Scene; 2] {
        let folder = tempfile::tempdir().unwrap();
        let files = Files {
            hair: Some(written(folder.path(), style_name(style), style)),
            motion: Some(written(folder.path(), "a.motion.ron", script)),
            preset_folder: folder.path().to_owned(),
            ..Files::default()
        };
        let mut registry = Registry::new();
        effects_builtin::register(&mut registry).unwrap();
        [("round.gltf", 1), ("on.gltf", 5)].map(|(name, rounds)| {
            self.write(&folder.path().join(name), rounds);
            let text = format!(
                "(version: 1, head: {head}, scene: (fps: {fps}), motion: (gltf: \"{name}\", repeat: true), layers: [(effect: \"hair.base\")])"
            );
            let preset = Preset::parse("look.ron", &text, &registry).unwrap();
            Scene::load(&preset, &files).unwrap()
        })
    }

    /// How far hair of the first scene is at most from where that of the second is beside its head, in m, in two rounds and a half. It is looked at in each
    /// frame and between frames, which changes nothing; a live program may look by a camera.
    fn apart(&self, fps: u32, [round, on]: &[Scene; 2], seen_by: Option<&Camera>) -> f32 {
        let mut motions = [Motion::new(), Motion::new()];
        let height_m = round.head().height_m;
        let pivot = round.head().center - Vec3::new(0.0, 0.0, 0.12 * height_m);
        let half_frames = (2.5 * self.round_s * 2.0 * fps as f32) as u32;
        let mut most = 0.0_f32;
        let mut time = 0.0;
        for half_frame in 0..half_frames {
            time = half_frame as f32 / (2 * fps) as f32;
            for (motion, scene) in motions.iter_mut().zip([round, on]) {
                match seen_by {
                    None => motion.advance_to(scene, time).unwrap(),
                    Some(camera) => motion.advance_to_seen_by(scene, time, camera).unwrap(),
                }
            }
            // In which round it is, in single precision.
            let gone_s = (time / self.round_s + 1e-5).floor() * self.round_s;
            let back = Quat::from_rotation_y(-(self.turn * gone_s).to_radians());
            let beside = |at: &Vec3| back * (*at - pivot) + pivot - self.speed * gone_s;
            let expected: Vec<Vec3> = motions[1].points(on, 0).iter().map(beside).collect();
            most = most.max(farthest(motions[0].points(round, 0), &expected));
        }
        if seen_by.is_none() {
            let mut at_once = Motion::new();
            at_once.advance_to(round, time).unwrap();
            assert!(at_once.points(round, 0) == motions[0].points(round, 0));
        }
        assert_eq!(motions[0].steps_taken(), motions[1].steps_taken());
        most
    }
}

/// Strands around a head.
fn strands() -> String {
    let strands = (0..12).map(|strand| {
        let away = Quat::from_rotation_y(strand as f32 * std::f32::consts::TAU / 12.0) * Vec3::Z;
        let points = (0..10).map(|point| {
            let at = Vec3::Y * (1.6 - 0.03 * point as f32) + away * 0.1;
            format!("({}, {}, {})", at.x, at.y, at.z)
        });
        format!("(points: [{}])", points.collect::<Vec<_>>().join(", "))
    });
    format!(
        "(version: 1, strands: [{}])",
        strands.collect::<Vec<_>>().join(",\n")
    )
}

fn style_name(style: &str) -> &'static str {
    match style.contains("zones") {
        true => "a.style.ron",
        false => "a.strands.ron",
    }
}

/// A tail that is tied twice and lies on a bag that she carries on her back, in the lee of her head.
const TIED: &str = r#"(version: 1, zones: [
    (name: "cap", roots: whorl, tips: hairline(-180, 180), count: 12, hang: 0.3, lift: 0.03),
    (name: "tail", form: tail, roots: [(150, 35)], hang: 1.4, count: 5, tie: 0.07, low_tie: 0.5, low_tie_size: 0.07, feel: limp),
])"#;
const LEE: &str = r#"(version: 1, wake: true, winds: [(speed: 5, gusts: 0, yaw: 30)],
    bodies: [(name: "bag", on: shoulders, at: (0, -1.2, -0.5), radius: 0.3)])"#;

#[test]
fn hair_walks_on_over_seams() {
    for (fps, round_s) in [(24, 1.0), (30, 1.0), (60, 1.0), (24, 0.77)] {
        let walk = Walk::ahead(round_s);
        let apart = walk.apart(fps, &walk.scenes(fps, "(shape: bust)", TIED, LEE), None);
        println!("{fps} frames a second, rounds of {round_s} s: {apart:.1e} m");
        assert!(apart < ALIKE_M, "{fps} {round_s}: {apart}");
    }
}

/// In long steps, too: those of hair that is not seen.
#[test]
fn hair_off_screen_walks_on_over_seams() {
    let walk = Walk::ahead(0.77);
    let scenes = walk.scenes(24, "(shape: none)", &strands(), LEE);
    let view = OrbitView {
        target: Vec3::X * 500.0,
        yaw_degrees: 0.0,
        pitch_degrees: 0.0,
        distance_m: 2.0,
        vertical_fov_degrees: 40.0,
    };
    let camera = Camera::orbit(view, [640, 640], 0.1).unwrap();
    let apart = walk.apart(24, &scenes, Some(&camera));
    println!("off screen: {apart:.1e} m");
    assert!(apart < ALIKE_M, "{apart}");
}

/// Around a head that turns on, and with it a ball that hair lies on.
#[test]
fn hair_turns_on_over_seams() {
    let script =
        r#"(version: 1, bodies: [(name: "ball", on: head, at: (0, -0.8, 0), radius: 0.6)])"#;
    let hair = strands();
    for (fps, round_s) in [(24, 1.0), (30, 1.0), (60, 1.0), (24, 0.77)] {
        let walk = Walk {
            round_s,
            speed: Vec3::ZERO,
            turn: 200.0,
        };
        let apart = walk.apart(fps, &walk.scenes(fps, "(shape: none)", &hair, script), None);
        println!("{fps} frames a second, rounds of {round_s} s: {apart:.1e} m");
        assert!(apart < ALIKE_M, "{fps} {round_s}: {apart}");
    }
}

/// In an even walk through still air hair comes to hang still beside the head, in all of a loop.
#[test]
fn a_loop_is_closed_over_seams() {
    let walk = Walk {
        round_s: 0.5,
        speed: Vec3::Z,
        turn: 0.0,
    };
    let hair = "(version: 1, strands: [(points: [(0, 1.6, -0.1), (0, 1.5, -0.12), (0, 1.4, -0.12), (0, 1.3, -0.12)])])";
    let script = "(version: 1, period: 2.5, loop: true)";
    let [round, _] = walk.scenes(24, "(shape: none)", hair, script);
    let mut motion = Motion::new();
    let mut at = |frame: u32| {
        let time = frame as f32 / 24.0;
        motion.advance_to(&round, time).unwrap();
        let gone = walk.speed * (time % walk.round_s);
        let points = motion.points(&round, 0).iter();
        points.map(|point| *point - gone).collect::<Vec<Vec3>>()
    };
    let first = at(0);
    let still = Motion::new();
    assert!(
        farthest(&first, still.points(&round, 0)) > 0.01,
        "the air keeps it back"
    );
    for frame in 1..60 {
        let apart = farthest(&at(frame), &first);
        assert!(apart < ALIKE_M, "{frame}: {apart}");
    }
    let left_m = motion.returns().map(|own| own.left_m).fold(0.0, f32::max);
    println!("a loop with five seams is blended by {left_m:.1e} m");
    assert!(left_m < ALIKE_M, "{left_m}");
}

/// A script that starts again elsewhere jumps there, which hair feels; at the very start nothing has jumped.
#[test]
fn what_jumps_at_the_end_of_a_period_is_not_felt_at_the_start() {
    let with = |period: &str| {
        let script =
            format!("(version: 1, {period} keys: [(time: 0), (time: 0.9, turn: (60, 0, 0))])");
        scene("twin-tails.style.ron", Some(&script), &[])
    };
    let [mut once, mut again] = ["", "period: 1,"].map(with);
    for frame in 0..24 {
        let time = frame as f32 / 24.0;
        let apart = farthest(&means(&mut once, time), &means(&mut again, time));
        assert!(apart < ALIKE_M, "frame {frame}: {apart}");
    }
}
