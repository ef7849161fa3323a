use super::*;
use base64::Engine as _;
use serde_json::{Value, json};

const QUARTER: f64 = std::f64::consts::FRAC_1_SQRT_2;

/// Node, property, interpolation, times, values.
type Channel<'a> = (usize, &'a str, &'a str, &'a [f32], &'a [f32]);

/// A character of hips, neck and head, the neck 1.4 m up and the head 0.1 m above it.
fn character(channels: &[Channel]) -> Value {
    let mut bytes = Vec::new();
    let (mut views, mut accessors) = (Vec::new(), Vec::new());
    let mut push = |numbers: &[f32], kind: &str, count: usize| {
        views
            .push(json!({"buffer": 0, "byteOffset": bytes.len(), "byteLength": numbers.len() * 4}));
        bytes.extend(numbers.iter().flat_map(|x| x.to_le_bytes()));
        accessors.push(json!({
            "bufferView": accessors.len(), "componentType": 5126, "count": count, "type": kind,
            "min": [0.0], "max": [1.0],
        }));
        accessors.len() - 1
    };
    let (mut samplers, mut targets) = (Vec::new(), Vec::new());
    for (node, path, interpolation, times, values) in channels {
        let input = push(times, "SCALAR", times.len());
        let (kind, width) = if *path == "rotation" {
            ("VEC4", 4)
        } else {
            ("VEC3", 3)
        };
        let output = push(values, kind, values.len() / width);
        targets.push(json!({"sampler": samplers.len(), "target": {"node": node, "path": path}}));
        samplers.push(json!({"input": input, "output": output, "interpolation": interpolation}));
    }
    let data = base64::engine::general_purpose::STANDARD.encode(&bytes);
    json!({
        "asset": {"version": "2.0"},
        "nodes": [
            {"name": "hips", "translation": [0.0, 1.0, 0.0], "children": [1]},
            {"name": "neck", "translation": [0.0, 0.4, 0.0], "children": [2]},
            {"name": "Head", "translation": [0.0, 0.1, 0.0]},
        ],
        "buffers": [{"byteLength": bytes.len(), "uri": format!("data:application/octet-stream;base64,{data}")}],
        "bufferViews": views,
        "accessors": accessors,
        "animations": [
            {"name": "turn", "channels": targets.clone(), "samplers": samplers.clone()},
            {"channels": targets, "samplers": samplers},
        ],
    })
}

fn read(file: &Value, bone: &str, animation: Option<&str>) -> Result<BoneMotion, SkeletonError> {
    BoneMotion::from_bytes(file.to_string().as_bytes(), Path::new(""), bone, animation)
}

#[track_caller]
fn assert_pose(motion: &BoneMotion, time: f64, turned: DQuat, moved: DVec3) {
    let (rotation, translation) = motion.at(time);
    assert!(
        rotation.dot(turned).abs() > 1.0 - 1e-9,
        "{time}: {rotation}"
    );
    assert!(
        (translation - moved).length() < 1e-6,
        "{time}: {translation}"
    );
}

#[test]
fn a_bone_moves_with_its_parents() {
    // The neck turns to the left by a quarter, then the hips rise.
    let turn = [0.0, 0.0, 0.0, 1.0, 0.0, QUARTER as f32, 0.0, QUARTER as f32];
    let rise = [0.0, 1.0, 0.0, 0.0, 1.5, 0.0];
    let file = character(&[
        (1, "rotation", "LINEAR", &[1.0, 2.0], &turn),
        (0, "translation", "LINEAR", &[2.0, 4.0], &rise),
    ]);
    let motion = read(&file, "head", None).unwrap();
    assert_eq!(motion.length(), 4.0);
    let quarter = DQuat::from_rotation_y(std::f64::consts::FRAC_PI_2);
    assert_pose(&motion, 0.0, DQuat::IDENTITY, DVec3::ZERO);
    // Along the great circle, evenly.
    for i in 0..=10 {
        let share = f64::from(i) / 10.0;
        let angle = std::f64::consts::FRAC_PI_2 * share;
        assert_pose(
            &motion,
            1.0 + share,
            DQuat::from_rotation_y(angle),
            DVec3::ZERO,
        );
    }
    assert_pose(&motion, 3.0, quarter, DVec3::Y * 0.25);
    assert_pose(&motion, 99.0, quarter, DVec3::Y * 0.5);
    // The place goes with a turn about a parent.
    let lean = [0.0, 0.0, QUARTER as f32, QUARTER as f32];
    let file = character(&[(0, "rotation", "STEP", &[1.0], &lean)]);
    let motion = read(&file, "Head", Some("1")).unwrap();
    let side = DVec3::new(-0.5, -0.5, 0.0);
    assert_pose(
        &motion,
        0.0,
        DQuat::from_rotation_z(std::f64::consts::FRAC_PI_2),
        side,
    );
}

#[test]
fn steps_and_cubics_are_those_of_the_specification() {
    let rise = [0.0, 1.0, 0.0, 0.0, 2.0, 0.0];
    let file = character(&[(0, "translation", "STEP", &[0.0, 1.0], &rise)]);
    let motion = read(&file, "head", Some("turn")).unwrap();
    assert_pose(&motion, 0.99, DQuat::IDENTITY, DVec3::ZERO);
    assert_pose(&motion, 1.0, DQuat::IDENTITY, DVec3::Y);
    // Slope before, value, slope after: of x^3 from 0 to 2 about its place of rest.
    let cubic = [
        0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, //
        0.0, 12.0, 0.0, 0.0, 9.0, 0.0, 0.0, 0.0, 0.0,
    ];
    let file = character(&[(0, "translation", "CUBICSPLINE", &[0.0, 2.0], &cubic)]);
    let motion = read(&file, "head", None).unwrap();
    for i in 0..=8 {
        let t = 0.25 * f64::from(i);
        assert_pose(&motion, t, DQuat::IDENTITY, DVec3::Y * (t * t * t));
    }
}

#[test]
fn what_is_not_there_is_named() {
    let rise = [0.0, 1.0, 0.0];
    let file = character(&[(0, "translation", "STEP", &[0.0], &rise)]);
    let error = |bone, animation| read(&file, bone, animation).unwrap_err().to_string();
    let message = error("haed", None);
    assert_eq!(
        message,
        "there is no bone `haed`; the nearest names are: Head, hips, neck"
    );
    let message = error("head", Some("trun"));
    assert!(
        message.contains("no animation `trun`; the nearest names are: turn, 1"),
        "{message}"
    );
    let mut still = file.clone();
    still.as_object_mut().unwrap().remove("animations");
    let message = read(&still, "head", None).unwrap_err().to_string();
    assert_eq!(message, "there is no animation in it");
}

#[test]
fn broken_files_are_refused() {
    let rise = [0.0, 1.0, 0.0, 0.0, 2.0, 0.0];
    let file = character(&[(0, "translation", "LINEAR", &[0.0, 1.0], &rise)]);
    let broken = |path: &str, value: Value, expected: &str| {
        let mut file = file.clone();
        *file.pointer_mut(path).unwrap() = value;
        let message = read(&file, "head", None).unwrap_err().to_string();
        assert!(message.contains(expected), "{path}: {message}");
    };
    broken(
        "/buffers/0/uri",
        json!("data:application/octet-stream;base64,AAAA"),
        "beyond its buffer",
    );
    broken("/buffers/0/uri", json!("nowhere.bin"), "nowhere.bin");
    broken("/accessors/1/count", json!(1), "2 keys and 1 values");
    broken("/accessors/1/count", json!(usize::MAX), "beyond its buffer");
    broken(
        "/accessors/0/type",
        json!("VEC2"),
        "accessor 0 is not of 1 numbers",
    );
    broken(
        "/accessors/0/componentType",
        json!(5125),
        "accessor 0 is not of 1 numbers",
    );
    broken(
        "/nodes/2",
        json!({"name": "Head", "children": [0]}),
        "its own parent",
    );
    let nan = [0.0, 1.0, 0.0, f32::NAN, 2.0, 0.0];
    let file = character(&[(0, "translation", "LINEAR", &[0.0, 1.0], &nan)]);
    let message = read(&file, "head", None).unwrap_err().to_string();
    assert!(
        message.contains("channel 0: accessor 1 has numbers that are not finite"),
        "{message}"
    );
    let file = character(&[(0, "translation", "LINEAR", &[1.0, 1.0], &rise)]);
    assert!(
        read(&file, "head", None)
            .unwrap_err()
            .to_string()
            .contains("must increase")
    );
    for text in ["", "{", "glTF\0\0\0\0", "[]"] {
        let error = BoneMotion::from_bytes(text.as_bytes(), Path::new(""), "head", None);
        assert!(matches!(error, Err(SkeletonError::Gltf(_))), "{text}");
    }
}
