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

fn read(file: &Value, bone: &str, animation: Option<&str>) -> Result<BoneMotion, GltfError> {
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
fn an_animation_is_as_long_as_all_that_moves_in_it() {
    let [turn, rise] = [[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0], [0.0; 8]];
    let file = character(&[
        (2, "rotation", "LINEAR", &[0.0, 6.0], &turn),
        (0, "translation", "LINEAR", &[2.0, 4.0], &rise[..6]),
    ]);
    // The head's keys are no part of what moves the neck.
    assert_eq!(read(&file, "neck", None).unwrap().length(), 6.0);
    // Shapes count; keys that cannot be read are the fault of who needs them.
    let mut shapes = file.clone();
    for animation in 0..2 {
        shapes["animations"][animation]["channels"][0]["target"]["path"] = json!("weights");
    }
    assert_eq!(read(&shapes, "neck", None).unwrap().length(), 6.0);
    let mut broken = file.clone();
    for animation in 0..2 {
        broken["animations"][animation]["samplers"][0]["input"] = json!(99);
    }
    assert_eq!(read(&broken, "neck", None).unwrap().length(), 4.0);
    assert!(read(&broken, "head", None).is_err());
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

/// A character of VRM 0.x looks along -Z, and her bones have VRM's names whatever the file calls them.
#[test]
fn a_bone_of_vrm_0_moves_as_seen_from_where_the_face_is_ours() {
    let nod = [-QUARTER as f32, 0.0, 0.0, QUARTER as f32];
    let on = [0.0, 0.0, -1.0, 0.0, 0.0, -3.0];
    let mut file = character(&[
        (2, "rotation", "STEP", &[1.0], &nod),
        (0, "translation", "STEP", &[0.0, 1.0], &on),
    ]);
    file["nodes"][2]["name"] = json!("J_Bip_C_Head");
    let bones = json!([{"bone": "head", "node": 2}, {"bone": "neck", "node": 9}]);
    file["extensions"] = json!({"VRM": {"humanoid": {"humanBones": bones}}});
    let nodded = DQuat::from_rotation_x(std::f64::consts::FRAC_PI_2);
    for bone in ["head", "J_Bip_C_Head"] {
        let motion = read(&file, bone, None).unwrap();
        let moved = DVec3::new(0.0, -1.0, 3.0);
        assert_pose(&motion, 1.0, nodded, moved);
    }
    file["nodes"][2]["name"] = json!("head");
    assert_eq!(
        read(&file, "head", None).unwrap(),
        read(&file, "HEAD", None).unwrap()
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
        "accessor 0 is of whole numbers that are not `normalized`",
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
    for text in ["", "{", "[]", "{\"asset\": {}}"] {
        let error = BoneMotion::from_bytes(text.as_bytes(), Path::new(""), "head", None);
        assert!(matches!(error, Err(GltfError::Json { .. })), "{text}");
    }
}

#[test]
fn what_a_channel_names_must_be_there() {
    let rise = [0.0, 1.0, 0.0, 0.0, 2.0, 0.0];
    let file = character(&[(0, "translation", "LINEAR", &[0.0, 1.0], &rise)]);
    let channel = "/animations/0/channels/0";
    let sampler = "/animations/0/samplers/0";
    for (path, value, expected) in [
        ("target/node", json!(3), "node 3, and there are 3"),
        ("sampler", json!(1), "sampler 1, and there are 1"),
    ] {
        let mut file = file.clone();
        *file.pointer_mut(&format!("{channel}/{path}")).unwrap() = value;
        let message = read(&file, "head", None).unwrap_err().to_string();
        assert!(message.contains(expected), "{message}");
    }
    for (path, value, expected) in [
        (&*format!("{sampler}/input"), json!(9), "accessor 9"),
        (
            &*format!("{sampler}/interpolation"),
            json!("X"),
            "variant `X`",
        ),
        ("/accessors/0/bufferView", json!(9), "buffer view 9"),
        ("/bufferViews/0/buffer", json!(9), "buffer 9"),
        ("/bufferViews/0/byteLength", json!(usize::MAX), "beyond"),
        ("/nodes/0/children/0", json!(7), "node 0 has the child 7"),
    ] {
        let mut file = file.clone();
        *file.pointer_mut(path).unwrap() = value;
        let message = read(&file, "head", None).unwrap_err().to_string();
        assert!(message.contains(expected), "{path}: {message}");
    }
    // All numbers at one place: as many as one likes.
    let mut many = file.clone();
    many["bufferViews"][0]["byteStride"] = json!(0);
    many["accessors"][0]["count"] = json!(usize::MAX);
    let message = read(&many, "head", None).unwrap_err().to_string();
    assert!(message.contains("accessor 0 is one too many"), "{message}");
    let mut twice = file.clone();
    let channels = twice.pointer_mut("/animations/0/channels").unwrap();
    *channels = json!([channels[0], channels[0]]);
    let message = read(&twice, "head", None).unwrap_err().to_string();
    assert!(message.contains("channel 1: the translation of its node is moved by another"));
}

#[test]
fn a_pointer_to_a_node_moves_it() {
    let rise = [0.0, 1.0, 0.0, 0.0, 2.0, 0.0];
    let mut file = character(&[(0, "translation", "LINEAR", &[0.0, 1.0], &rise)]);
    let mut point_to = |pointer: &str| {
        *file.pointer_mut("/animations/0/channels/0/target").unwrap() = json!({
            "path": "pointer", "extensions": {"KHR_animation_pointer": {"pointer": pointer}},
        });
        read(&file, "head", None)
    };
    let motion = point_to("/nodes/0/translation").unwrap();
    assert_pose(&motion, 1.0, DQuat::IDENTITY, DVec3::Y);
    let still = point_to("/materials/7/emissiveFactor").unwrap();
    assert_pose(&still, 1.0, DQuat::IDENTITY, DVec3::ZERO);
    assert!(point_to("/nodes/7/translation").is_err());
}

/// A `.glb` of these chunks.
fn glb(chunks: &[(&[u8; 4], &[u8])]) -> Vec<u8> {
    let mut bytes = b"glTF\x02\0\0\0\0\0\0\0".to_vec();
    for (kind, chunk) in chunks {
        bytes.extend((chunk.len() as u32).to_le_bytes());
        bytes.extend_from_slice(*kind);
        bytes.extend_from_slice(chunk);
    }
    let length = bytes.len() as u32;
    bytes[8..12].copy_from_slice(&length.to_le_bytes());
    bytes
}

#[test]
fn a_binary_file_is_read_by_its_chunks() {
    let rise = [0.0, 1.0, 0.0, 0.0, 2.0, 0.0];
    let mut file = character(&[(0, "translation", "LINEAR", &[0.0, 1.0], &rise)]);
    let uri = file.pointer_mut("/buffers/0/uri").unwrap().take();
    let data = uri.as_str().unwrap().split_once(',').unwrap().1;
    let data = base64::engine::general_purpose::STANDARD
        .decode(data)
        .unwrap();
    let json = file.to_string();
    let read = |bytes: &[u8]| BoneMotion::from_bytes(bytes, Path::new(""), "head", None);
    let whole = glb(&[
        (b"JSON", json.as_bytes()),
        (b"what", b"?"),
        (b"BIN\0", &data),
    ]);
    assert_pose(&read(&whole).unwrap(), 1.0, DQuat::IDENTITY, DVec3::Y);
    let refused = |bytes: &[u8], expected: &str| {
        let message = read(bytes).unwrap_err().to_string();
        assert!(message.contains(expected), "{message}");
    };
    refused(&glb(&[(b"JSON", json.as_bytes())]), "no binary part");
    refused(&glb(&[(b"BIN\0", &data)]), "the first chunk is not JSON");
    refused(&glb(&[]), "the first chunk is not JSON");
    for end in 4..whole.len() {
        assert!(read(&whole[..end]).is_err(), "{end}");
    }
    for (at, value, expected) in [
        (4, 1, "version 1"),
        (8, 3, "the first chunk is not JSON"),
        (8, u32::MAX, "shorter than its header says"),
        (12, u32::MAX, "byte 12: a chunk reaches beyond"),
    ] {
        let mut broken = whole.clone();
        broken[at..at + 4].copy_from_slice(&value.to_le_bytes());
        refused(&broken, expected);
    }
}

#[test]
fn files_of_buffers_are_beside_the_character() {
    let rise = [0.0, 1.0, 0.0, 0.0, 2.0, 0.0];
    let mut file = character(&[(0, "translation", "LINEAR", &[0.0, 1.0], &rise)]);
    let uri = file["buffers"][0]["uri"].as_str().unwrap().to_owned();
    let data = base64::engine::general_purpose::STANDARD
        .decode(uri.split_once(',').unwrap().1)
        .unwrap();
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("my girl.bin"), data).unwrap();
    let mut with_uri = |uri: &str| {
        file["buffers"][0]["uri"] = json!(uri);
        BoneMotion::from_bytes(file.to_string().as_bytes(), folder.path(), "head", None)
    };
    let motion = with_uri("my%20girl.bin").unwrap();
    assert_pose(&motion, 1.0, DQuat::IDENTITY, DVec3::Y);
    for uri in ["../my%20girl.bin", "/dev/zero", "file:///dev/zero"] {
        let message = with_uri(uri).unwrap_err().to_string();
        let expected = format!("buffer 0: `{uri}` is not in the folder of the file that names it");
        assert!(message.contains(&expected), "{message}");
    }
    let message = with_uri(&"x/".repeat(9999)).unwrap_err().to_string();
    assert!(message.contains("buffer 0: "), "{message}");
}
