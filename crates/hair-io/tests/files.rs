//! Files of our own: choosing readers, writing, keeping guides with their motion.

use std::fmt::Write as _;
use std::fs;
use std::path::PathBuf;

use glam::Vec3;
use hair_io::orient::{Axes, Given};
use hair_io::{HairError, HairOptions, read_hair, read_head, write_strands};
use hair_sim::{PointCache, Strands};

/// A fresh folder for one test.
fn folder(test: &str) -> PathBuf {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(format!("hair-io-{test}"));
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    folder
}

fn moving() -> (Strands, PointCache) {
    let mut strands = Strands::new();
    for i in 0..5 {
        let root = Vec3::new(i as f32 * 0.01, 1.7, 0.0);
        let points: Vec<Vec3> = (0..=i).map(|k| root - Vec3::Y * k as f32 * 0.1).collect();
        strands
            .push(i, &points, (i % 2 == 0).then_some(i as f32))
            .unwrap();
    }
    let sample = |t: f32| {
        (
            t,
            strands.points().iter().map(|p| *p + Vec3::X * t).collect(),
        )
    };
    let motion = PointCache::new(vec![sample(0.0), sample(0.5), sample(2.0)]).unwrap();
    (strands, motion)
}

#[test]
fn written_strands_are_read_again_and_thinned_with_their_motion() {
    let path = folder("round-trip").join("a.strands.ron");
    let (strands, motion) = moving();
    write_strands(&path, &strands, Some(&motion)).unwrap();
    assert_eq!(fs::read_dir(path.parent().unwrap()).unwrap().count(), 1);
    let mut file = read_hair(&path, &HairOptions::default()).unwrap();
    assert_eq!(
        (&file.strands, file.motion.as_ref()),
        (&strands, Some(&motion))
    );
    assert_eq!(file.notes, ["hair: 5 strands, Y up, metres"]);

    file.keep(&[1, 4]);
    assert_eq!((file.strands.id(0), file.strands.id(1)), (1, 4));
    let mut points = vec![Vec3::ZERO; 7];
    file.motion.unwrap().sample(2.0, &mut points);
    let expected: Vec<Vec3> = file
        .strands
        .points()
        .iter()
        .map(|p| *p + Vec3::X * 2.0)
        .collect();
    assert_eq!(points, expected);
}

#[test]
fn given_axes_and_units_hold_for_motion_too() {
    let path = folder("given").join("a.strands.ron");
    let (strands, motion) = moving();
    write_strands(&path, &strands, Some(&motion)).unwrap();
    let given = Given {
        up: Some(Axes::Z),
        scale: Some(2.0),
        offset: Some(Vec3::ONE),
    };
    let file = read_hair(&path, &HairOptions { given, head: None }).unwrap();
    let mut points = vec![Vec3::ZERO; strands.points().len()];
    file.motion.unwrap().sample(0.0, &mut points);
    assert_eq!(points, file.strands.points());
    assert_eq!(points[0], Vec3::new(1.0, 1.0, 1.0 - 3.4));
    for scale in [f32::NAN, 0.0, -1.0, f32::INFINITY, 1e38] {
        let given = Given {
            scale: Some(scale),
            ..Given::default()
        };
        let error = read_hair(&path, &HairOptions { given, head: None });
        let large = scale == 1e38; // 1.7e38 m is still a number
        assert_eq!(error.is_ok(), large, "{scale}");
        if !large {
            assert!(matches!(error, Err(HairError::Scale { .. })));
        }
    }
}

#[test]
fn messages_name_the_file_and_what_is_read() {
    let folder = folder("messages");
    let message = |name: &str, bytes: &[u8]| {
        let path = folder.join(name);
        fs::write(&path, bytes).unwrap();
        let error = read_hair(&path, &HairOptions::default())
            .unwrap_err()
            .to_string();
        let (file, message) = error.split_once(name).unwrap();
        assert!(file.ends_with('/'));
        message.trim_start_matches(": ").to_string()
    };
    let reads = "is not a format that this build reads; it reads TressFX (.tfx) and own strands (.strands.ron)";
    assert_eq!(message("a.abc", b"Ogawa"), format!("Alembic {reads}"));
    assert_eq!(
        message("a.hair", b"x"),
        format!("Cem Yuksel's .hair {reads}")
    );
    assert_eq!(
        message("a.bin", b"HAIR..."),
        format!("Cem Yuksel's .hair {reads}")
    );
    assert_eq!(message("a.png", b"?"), format!("\".png\" {reads}"));
    for name in ["a.usd", "a.usdc", "a.glb", "a.data", "a.ply"] {
        assert!(message(name, b"").ends_with(reads), "{name}");
    }
    assert_eq!(
        message("a.tfx", b"abc"),
        "byte 0: a header of 160 bytes was expected, the file has 3 bytes"
    );
    assert!(message("named.otherwise", &4.0f32.to_le_bytes()).starts_with("byte 0: a header"));
    assert_eq!(
        message("a.ron", b"(\xff"),
        ":1:2: this is not UTF-8 text (byte 1 of the file)"
    );
    assert!(message("b.ron", b"(version: 1,\n strands: 3)").starts_with(":2:"));
    let deep = format!("(version: 1, strands: [{}", "(".repeat(9999));
    let too_deep = message("deep.ron", deep.as_bytes());
    assert!(too_deep.starts_with(":1:"), "{too_deep}");
    assert!(too_deep.ends_with("nested too deeply here"), "{too_deep}");
    let long = format!("(version: 1, {}: 3)", "x".repeat(100_000));
    assert!(message("long.ron", long.as_bytes()).len() < 400);
    let missing = read_hair(&folder.join("none.tfx"), &HairOptions::default()).unwrap_err();
    assert!(missing.to_string().contains("none.tfx: "));

    let broken = folder.join("broken.obj");
    fs::write(&broken, "v 0 0 0\nf 1 2 3\n").unwrap();
    let error = read_head(&broken, None, None).unwrap_err();
    let expected = "broken.obj:2: corner 2 of the face: there is no vertex 2, there are 1";
    assert!(error.to_string().ends_with(expected), "{error}");
    let error = read_head(&folder.join("a.tfx"), None, None)
        .unwrap_err()
        .to_string();
    assert!(
        error.ends_with(
            "TressFX is not a format that this build reads; it reads Wavefront OBJ (.obj), PLY (.ply), glTF 2.0 (.gltf, .glb) and VRM (.vrm)"
        ),
        "{error}"
    );
}

#[test]
fn a_file_that_cannot_be_written_leaves_nothing() {
    let folder = folder("unwritable");
    let taken = folder.join("taken.ron");
    fs::create_dir(&taken).unwrap();
    let error = write_strands(&taken, &moving().0, None).unwrap_err();
    assert!(matches!(error, HairError::Write { .. }));
    assert_eq!(fs::read_dir(&folder).unwrap().count(), 1);
}

/// Height and radius of a standing figure, turned as on a lathe: body, neck and head, metres.
const FIGURE: [[f32; 2]; 12] = [
    [0.0, 0.02],
    [0.02, 0.12],
    [1.0, 0.15],
    [1.3, 0.19],
    [1.38, 0.16],
    [1.42, 0.06],
    [1.48, 0.055],
    [1.5, 0.08],
    [1.6, 0.098],
    [1.68, 0.085],
    [1.71, 0.05],
    [1.72, 0.005],
];

/// An OBJ's group: `rows` of as many points each (metres), whose neighbours are joined, after so many vertices.
fn sheet(name: &str, rows: &[Vec<Vec3>], vertices: usize) -> String {
    let mut text = format!("g {name}\n");
    for point in rows.iter().flatten() {
        writeln!(text, "v {} {} {}", point.x, point.y, point.z).unwrap();
    }
    let width = rows[0].len();
    for row in 0..rows.len() - 1 {
        for column in 0..width - 1 {
            let a = vertices + row * width + column + 1;
            let (b, c, d) = (a + 1, a + width, a + width + 1);
            writeln!(text, "f {a} {b} {c}\nf {b} {d} {c}").unwrap();
        }
    }
    text
}

fn around(radius: f32, y: f32, degrees: f32) -> Vec3 {
    let (sine, cosine) = degrees.to_radians().sin_cos();
    Vec3::new(radius * sine, y, radius * cosine)
}

/// Ribbons of hair that hang from the crown beside the neck.
fn long_hair(vertices: usize) -> String {
    let ribbon = |number: usize| {
        let row = |step: u8| {
            let along = f32::from(step) / 20.0;
            let over = (3.0 * along).clamp(0.12, 1.0) * std::f32::consts::FRAC_PI_2;
            let hang = (along - 1.0 / 3.0).max(0.0);
            let y = 1.6 + 0.13 * over.cos() - 0.9 * hang;
            let side = |by: f32| around(0.11 * over.sin(), y, 40.0 + 10.0 * number as f32 + by);
            vec![side(-6.0), side(6.0)]
        };
        let rows: Vec<Vec<Vec3>> = (0..=20).map(row).collect();
        sheet("Long_Hair", &rows, vertices + 42 * number)
    };
    (0..29).map(ribbon).collect()
}

/// Long hair of a file's own hides the neck, by which a unit is guessed.
#[test]
fn a_unit_is_guessed_without_what_is_called_hair() {
    let folder = tempfile::tempdir().unwrap();
    let ring = |[y, radius]: [f32; 2]| {
        let places = 0..=24_u8;
        places
            .map(|k| around(radius, y, 15.0 * f32::from(k)))
            .collect()
    };
    let rings: Vec<Vec<Vec3>> = FIGURE.into_iter().map(ring).collect();
    let figure = sheet("body", &rings, 0);
    let read = |name: &str, text: &str| {
        let path = folder.path().join(name);
        fs::write(&path, text).unwrap();
        read_head(&path, None, None).unwrap()
    };
    let bald = read("bald.obj", &figure);
    assert_eq!(bald.orientation.scale, 1.0);
    let hair = long_hair(rings.len() * 25);
    let haired = read("haired.obj", &format!("{figure}{hair}"));
    assert_eq!(haired.orientation, bald.orientation);
    assert!(haired.mesh.triangles.len() > bald.mesh.triangles.len());
    // By another name it is as much of a body as all else.
    let named = hair.replace("Long_Hair", "Veil");
    let veiled = read("veiled.obj", &format!("{figure}{named}"));
    assert!(veiled.orientation.scale < 1.0);
    // Where all is called hair all of it is looked at.
    let alone = read("alone.obj", &long_hair(0));
    assert!(!alone.mesh.triangles.is_empty());
}
