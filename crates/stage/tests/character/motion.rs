//! A character that its own file moves.

use crate::made::{Character, points, scene_of};
use glam::{Quat, Vec3};
use hair_sim::Strands;
use serde_json::{Value, json};
use stage::{Files, FrameMaker, HairModel, Motion, Preset, Scene};
use std::fs;
use std::path::Path;
use tempfile::TempDir;

/// A second in which the neck turns to its left by a quarter.
fn turn() -> Track {
    let half = std::f32::consts::FRAC_1_SQRT_2;
    Track {
        node: 0,
        path: "rotation",
        values: vec![0.0, 0.0, 0.0, 1.0, 0.0, half, 0.0, half],
    }
}

/// What moves a node from time 0 to 1.
struct Track {
    node: usize,
    path: &'static str,
    values: Vec<f32>,
}

/// A folder of the character, which moves so.
fn animated(tracks: &[Track], change: impl FnOnce(&mut Value)) -> TempDir {
    animated_one(&Character::new(), tracks, change)
}

fn animated_one(
    character: &Character,
    tracks: &[Track],
    change: impl FnOnce(&mut Value),
) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let mut numbers = vec![0.0, 1.0];
    let (mut samplers, mut channels, mut views) = (Vec::new(), Vec::new(), Vec::new());
    for (index, track) in tracks.iter().enumerate() {
        views.push((
            4 * numbers.len(),
            4 * track.values.len(),
            track.values.len() / 2,
        ));
        numbers.extend(&track.values);
        samplers.push(index);
        channels
            .push(json!({"sampler": index, "target": {"node": track.node, "path": track.path}}));
    }
    let bytes: Vec<u8> = numbers.iter().flat_map(|x| x.to_le_bytes()).collect();
    let length = bytes.len();
    fs::write(folder.path().join("move.bin"), bytes).unwrap();
    character.write(&folder.path().join("girl.gltf"), |file| {
        let list = |file: &mut Value, name: &str, value: Value| {
            let list = file[name].as_array_mut().unwrap();
            list.push(value);
            list.len() - 1
        };
        let buffer = list(
            file,
            "buffers",
            json!({"byteLength": length, "uri": "move.bin"}),
        );
        let view = list(
            file,
            "bufferViews",
            json!({"buffer": buffer, "byteLength": 8}),
        );
        let input = list(
            file,
            "accessors",
            json!({"bufferView": view, "componentType": 5126, "count": 2, "type": "SCALAR"}),
        );
        let samplers: Vec<Value> = views
            .iter()
            .map(|(at, length, width)| {
                let view = list(
                    file,
                    "bufferViews",
                    json!({"buffer": buffer, "byteOffset": at, "byteLength": length}),
                );
                let kind = if *width == 4 { "VEC4" } else { "VEC3" };
                let output = list(
                    file,
                    "accessors",
                    json!({"bufferView": view, "componentType": 5126, "count": 2, "type": kind}),
                );
                json!({"input": input, "output": output})
            })
            .collect();
        file["animations"] = json!([{"name": "look", "samplers": samplers, "channels": channels}]);
        change(file);
    });
    folder
}

fn scene(folder: &Path, motion: &str, more: &str) -> Result<Scene, String> {
    let text = format!(
        "(version: 1, hair: (from: character), head: (file: \"girl.gltf\", colors: file), motion: ({motion}), {more} \
         scene: (size: (200, 200), samples: 4), layers: [(effect: \"hair.base\")])"
    );
    scene_of(folder, &text, &Files::default())
}

/// The points of all strands at a time.
fn points_at(scene: &Scene, time: f32) -> Vec<Vec3> {
    let mut motion = Motion::new();
    motion.advance_to(scene, time).unwrap();
    motion.points(scene, 0).to_vec()
}

/// Where all corners of meshes are in the picture at a time: pixels.
fn corners_at(scene: &Scene, time: f32) -> Vec<Vec3> {
    let mut motion = Motion::new();
    motion.advance_to(scene, time).unwrap();
    let mut frames = FrameMaker::new();
    let frame = frames.frame(scene, &motion).unwrap();
    let corners = frame.surfaces.iter().flat_map(|surface| &surface.vertices);
    corners.map(|corner| corner.position.extend(0.0)).collect()
}

const STILL: &str = "dynamics: (solver: none),";

#[test]
fn bones_move_meshes_and_roots_alike() {
    let folder = animated(&[turn()], |_| {});
    let moved = scene(folder.path(), "character: true", STILL).unwrap();
    let rest = points(&moved);
    for (time, share) in [(0.0, 0.0), (0.5, 0.5), (1.0, 1.0), (5.0, 1.0)] {
        let turned = Quat::from_rotation_y(share * std::f32::consts::FRAC_PI_2);
        for (found, rest) in points_at(&moved, time).iter().zip(&rest) {
            let expected = turned * *rest;
            assert!(
                found.distance(expected) < 1e-4,
                "{time}: {found} {expected}"
            );
        }
    }
    // A character that stands so from the beginning.
    let half = std::f32::consts::FRAC_1_SQRT_2;
    let baked = animated(&[], |file| {
        file["nodes"][0]["rotation"] = json!([0.0, half, 0.0, half]);
    });
    let still = scene(baked.path(), "", STILL).unwrap();
    let (found, expected) = (corners_at(&moved, 1.0), corners_at(&still, 0.0));
    let before = corners_at(&moved, 0.0);
    let off = |a: &[Vec3], b: &[Vec3]| {
        a.iter()
            .zip(b)
            .map(|(a, b)| a.distance(*b))
            .fold(0.0, f32::max)
    };
    assert_eq!(found.len(), expected.len());
    assert!(off(&found, &expected) < 0.05, "{}", off(&found, &expected));
    assert!(off(&before, &expected) > 5.0);
}

#[test]
fn an_animation_may_repeat() {
    let folder = animated(&[turn()], |_| {});
    let once = scene(folder.path(), "character: true", STILL).unwrap();
    let again = scene(
        folder.path(),
        "character: true, repeat: true, animation: \"look\"",
        STILL,
    )
    .unwrap();
    assert_eq!(points_at(&once, 1.25), points_at(&once, 1.0));
    for (a, b) in points_at(&again, 1.25).iter().zip(points_at(&again, 0.25)) {
        assert!(a.distance(b) < 1e-6);
    }
}

/// The script's turn back undoes the bone's: the head looks ahead from where the neck has come to, mesh and hair alike.
#[test]
fn a_scripts_moves_come_on_top() {
    let folder = animated(&[turn()], |_| {});
    let script = "(version: 1, moves: [(move: turn, length: 0.5, angle: -90)])";
    fs::write(folder.path().join("back.motion.ron"), script).unwrap();
    let scene = scene(
        folder.path(),
        "character: true, file: \"back.motion.ron\"",
        STILL,
    )
    .unwrap();
    let (rest, found) = (points(&scene), points_at(&scene, 1.0));
    let shift = found[0] - rest[0];
    assert!(shift.y.abs() < 1e-5 && shift.length() > 0.01, "{shift}");
    for (found, rest) in found.iter().zip(&rest) {
        assert!((*found - *rest).distance(shift) < 1e-5);
    }
    // In the picture the upper rows of the skull, the first corners, move as roots do; of outlines there are other corners each time.
    let (before, after) = (corners_at(&scene, 0.0), corners_at(&scene, 1.0));
    let face = before.iter().zip(&after).take(8);
    let moves: Vec<Vec3> = face.map(|(a, b)| *b - *a).collect();
    for by in &moves {
        assert!(by.x < -5.0 && by.distance(moves[0]) < 3.0, "{moves:?}");
    }
}

/// The animation is over after a second, and wings beside the character beat on; she moves as without them.
#[test]
fn wings_and_skeletons_keep_their_own_times() {
    let folder = animated(&[turn()], |_| {});
    let alone = scene(folder.path(), "character: true", STILL).unwrap();
    let wings = format!("{STILL} meshes: [(shape: wings, at: (0, 1, 0))],");
    let both = scene(folder.path(), "character: true", &wings).unwrap();
    for time in [0.25, 1.0, 1.3] {
        assert_eq!(points_at(&both, time), points_at(&alone, time));
        let (hers, all) = (corners_at(&alone, time), corners_at(&both, time));
        assert_eq!(all[..hers.len()], hers, "{time}");
    }
    let [at_end, later, a_beat_later] = [1.0, 1.3, 2.0].map(|time| corners_at(&both, time));
    assert!(at_end != later && at_end == a_beat_later);
}

/// A ball on an arm that comes up to the hair pushes it away.
#[test]
fn bodies_follow_the_skeleton() {
    let arm = Track {
        node: 7,
        path: "translation",
        values: vec![0.03, 1.56, 0.5, 0.03, 1.56, 0.125],
    };
    let with = |colliders: Value| {
        let folder = animated(std::slice::from_ref(&arm), |file| {
            file["nodes"]
                .as_array_mut()
                .unwrap()
                .push(json!({"name": "arm", "translation": [0.03, 1.56, 0.5]}));
            file["extensions"]["VRMC_springBone"]["colliders"] = colliders;
        });
        let scene = scene(folder.path(), "character: true", "dynamics: (feel: soft),").unwrap();
        let found = points_at(&scene, 1.2);
        let ball = Vec3::new(0.03, 1.56, 0.125);
        found
            .iter()
            .map(|p| p.distance(ball))
            .fold(f32::INFINITY, f32::min)
    };
    let free = with(json!([]));
    let pushed = with(json!([{"node": 7, "shape": {"sphere": {"radius": 0.05}}}]));
    assert!(free < 0.04 && pushed > 0.047, "{free} {pushed}");
}

/// She walks on for three seconds, with a ball on an arm that hair is blown against; or for one that repeats, as if it went on.
#[test]
fn hair_and_limbs_go_over_the_start_of_a_round() {
    let moved = |rounds: f32| {
        let node = |node: usize, at: Vec3| Track {
            node,
            path: "translation",
            values: [at, at + Vec3::Z * rounds].map(|at| at.to_array()).concat(),
        };
        let arm = Vec3::new(0.03, 1.56, 0.19);
        let folder = animated(&[node(0, Vec3::ZERO), node(7, arm)], |file| {
            let nodes = file["nodes"].as_array_mut().unwrap();
            nodes.push(json!({"name": "arm", "translation": arm.to_array()}));
            file["extensions"]["VRMC_springBone"]["colliders"] =
                json!([{"node": 7, "shape": {"sphere": {"radius": 0.05}}}]);
        });
        // From time 0 on to another.
        let numbers = folder.path().join("move.bin");
        let mut bytes = fs::read(&numbers).unwrap();
        bytes[4..8].copy_from_slice(&rounds.to_le_bytes());
        fs::write(&numbers, bytes).unwrap();
        let script = "(version: 1, winds: [(speed: 12, gusts: 0, yaw: 180)])";
        fs::write(folder.path().join("wind.motion.ron"), script).unwrap();
        let motion = "character: true, repeat: true, file: \"wind.motion.ron\"";
        scene(folder.path(), motion, "dynamics: (feel: soft),").unwrap()
    };
    let (round, on) = (moved(1.0), moved(3.0));
    let mut motions = [Motion::new(), Motion::new()];
    let (mut apart, mut nearest) = (0.0_f32, f32::INFINITY);
    for frame in 0..70 {
        let time = frame as f32 / 24.0;
        motions[0].advance_to(&round, time).unwrap();
        motions[1].advance_to(&on, time).unwrap();
        let gone = Vec3::Z * time.floor();
        let ball = Vec3::new(0.03, 1.56, 0.19 + time.fract());
        let points = motions[0].points(&round, 0);
        for (found, expected) in points.iter().zip(motions[1].points(&on, 0)) {
            apart = apart.max(found.distance(*expected - gone));
            nearest = nearest.min(found.distance(ball));
        }
    }
    assert!(nearest < 0.055, "hair lies on the ball: {nearest}");
    assert!(apart < 1e-5, "{apart}");
}

/// An arm without a collider of the file's is as thick as its skin, where its bones are a humanoid's.
#[test]
fn limbs_push_hair_where_their_bones_take_them() {
    let arm = Track {
        node: 8,
        path: "translation",
        values: vec![-0.1, 1.2, 0.3, -0.1, 1.56, 0.14],
    };
    let nearest = |change: fn(&mut Value)| {
        let character = Character::new().with_arm();
        let folder = animated_one(&character, std::slice::from_ref(&arm), |file| {
            let nodes = file["nodes"].as_array_mut().unwrap();
            nodes[7]["translation"] = json!([0.1, -1.2, -0.3]);
            nodes[7].as_object_mut().unwrap().remove("skin");
            nodes.push(
                json!({"name": "upper", "translation": [-0.1, 1.2, 0.3], "children": [7, 9]}),
            );
            nodes.push(json!({"name": "lower", "translation": [0.26, 0.0, 0.0]}));
            let bones = json!({"head": {"node": 1}, "leftUpperArm": {"node": 8}, "leftLowerArm": {"node": 9}});
            file["extensions"]["VRMC_vrm"] =
                json!({"specVersion": "1.0", "humanoid": {"humanBones": bones}});
            change(file);
        });
        let scene = scene(folder.path(), "character: true", "dynamics: (feel: soft),").unwrap();
        let away = |p: &Vec3| (p.y - 1.56).hypot(p.z - 0.14);
        let found = points_at(&scene, 1.2);
        found.iter().map(away).fold(f32::INFINITY, f32::min)
    };
    let free = nearest(|file| {
        file["extensions"]
            .as_object_mut()
            .unwrap()
            .remove("VRMC_vrm");
    });
    let limb = nearest(|_| {});
    let own = nearest(|file| {
        let shape = json!({"sphere": {"offset": [0.13, 0.0, 0.0], "radius": 0.02}});
        file["extensions"]["VRMC_springBone"]["colliders"] = json!([{"node": 8, "shape": shape}]);
    });
    assert!(free < 0.032 && own < 0.032, "{free} {own}");
    // Three quarters of the skin are no farther than this from the bone.
    assert!(limb > 0.037, "{limb}");
}

/// What was in the old hair and is not in the new one pushes that, as if it had been there from the beginning.
#[test]
fn bodies_are_chosen_anew_for_other_hair() {
    let ball = Vec3::new(-0.06, 1.56, 0.17);
    let arm = Track {
        node: 7,
        path: "translation",
        values: vec![0.03, 1.56, 0.11, ball.x, ball.y, ball.z],
    };
    let folder = animated(&[arm], |file| {
        file["nodes"]
            .as_array_mut()
            .unwrap()
            .push(json!({"name": "arm", "translation": [0.03, 1.56, 0.11]}));
        file["extensions"]["VRMC_springBone"]["colliders"] =
            json!([{"node": 7, "shape": {"sphere": {"radius": 0.05}}}]);
    });
    let own = scene(folder.path(), "character: true", "dynamics: (feel: soft),").unwrap();
    let mut strands = Strands::new();
    let points: Vec<Vec3> = (0..8)
        .map(|i| Vec3::new(-0.06, 1.69 - 0.02 * i as f32, 0.16))
        .collect();
    strands.push(0, &points, None).unwrap();
    let distance = |scene: &Scene| {
        let found = points_at(scene, 1.2);
        let distances = found.iter().map(|p| p.distance(ball));
        distances.fold(f32::INFINITY, f32::min)
    };
    let hair = HairModel::new(strands, None).unwrap();
    let other = own.objects()[0].with_hair(hair).unwrap();
    let other = own.with_object(0, other).unwrap();
    assert!(distance(&other) > 0.047, "{}", distance(&other));
}

/// A file whose triangles face inwards is lit and outlined as one whose triangles face outwards, moved or not.
#[test]
fn what_is_inside_out_is_turned_around_in_each_pose() {
    let [outwards, inwards] = [Character::new(), Character::new().inside_out()].map(|character| {
        let folder = animated_one(&character, &[turn()], |_| {});
        let hair = folder.path().join("a.strands.ron");
        fs::write(
            &hair,
            "(version: 1, strands: [(points: [(0, 1.72, 0), (0, 1.8, 0)])])",
        )
        .unwrap();
        let text = "(version: 1, hair: (file: \"a.strands.ron\"), head: (file: \"girl.gltf\", colors: file), motion: (character: true), \
                    dynamics: (solver: none), scene: (size: (90, 90), samples: 4), layers: [(effect: \"hair.base\")])";
        let scene = scene_of(folder.path(), text, &Files::default()).unwrap();
        let mut motion = Motion::new();
        motion.advance_to(&scene, 0.75).unwrap();
        let frame_maker = &mut FrameMaker::new();
        frame_maker.frame(&scene, &motion).unwrap().surfaces.clone()
    });
    assert!(!outwards.is_empty());
    assert!(inwards == outwards);
}

#[test]
fn mistakes_name_their_place() {
    let told = |folder: &TempDir, motion: &str| scene(folder.path(), motion, "").err().unwrap();
    let folder = animated(&[turn()], |_| {});
    let message = told(&folder, "character: true, animation: \"lok\"");
    assert!(message.contains("look.ron:1:"), "{message}");
    assert!(
        message
            .contains("girl.gltf: none of its 1 animations is called `lok`, did you mean `look`?"),
        "{message}"
    );
    let message = told(&folder, "character: true, bone: \"heat\"");
    assert!(
        message.contains("no bone called `heat`, did you mean `head`?"),
        "{message}"
    );
    let still = animated(&[], |file| {
        file["animations"] = json!([]);
    });
    assert!(told(&still, "character: true").contains("girl.gltf: it has no animation"));
    let flat = Track {
        node: 0,
        path: "scale",
        values: vec![1.0, 1.0, 1.0, 0.0, 0.0, 0.0],
    };
    let message = told(&animated(&[flat], |_| {}), "character: true");
    assert!(
        message.contains("takes the bone `head` nowhere at 1.000 s"),
        "{message}"
    );
    let nan = Track {
        node: 0,
        path: "translation",
        values: vec![0.0, 0.0, 0.0, f32::NAN, 0.0, 0.0],
    };
    let message = told(&animated(&[nan], |_| {}), "character: true");
    assert!(
        message.contains("girl.gltf")
            && message.contains("accessor 8 has numbers that are not finite"),
        "{message}"
    );
    let message = told(&folder, "character: true, gltf: \"girl.gltf\"");
    assert!(
        message.contains("look.ron:1:") && message.contains("both move the head: one of them"),
        "{message}"
    );
    let mut registry = effects::Registry::new();
    effects_builtin::register(&mut registry).unwrap();
    let text = "(version: 1, motion: (character: true), layers: [])";
    let mut preset = Preset::parse("look.ron", text, &registry).unwrap();
    preset.set("motion.gltf", "girl.gltf").unwrap();
    let message = Scene::load(&preset, &Files::default())
        .err()
        .unwrap()
        .to_string();
    assert!(
        message.starts_with("motion: gltf: it and `character` both move"),
        "{message}"
    );
    let text = "(version: 1, hair: (from: character), head: (file: \"girl.gltf\"), motion: (character: true), layers: [])";
    let message = scene_of(folder.path(), text, &Files::default())
        .err()
        .unwrap();
    assert!(
        message.contains("look.ron:1:") && message.contains("colors: file"),
        "{message}"
    );
}
