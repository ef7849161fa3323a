//! Files that this project did not make, in the folder that `INKSTRAND_DATA` names.
#![expect(clippy::print_stderr, reason = "skipped tests say so")]

use std::path::{Path, PathBuf};

use glam::Vec3;
use hair_io::orient::{self, Axes, Given};
use hair_io::{HairError, HairFile, HairOptions, HeadFile, HeadFrame, read_hair, read_head, tfx};
use hair_sim::Strands;

fn data() -> Option<PathBuf> {
    let folder = std::env::var_os("INKSTRAND_DATA").map(PathBuf::from);
    if folder.is_none() {
        eprintln!("SKIPPED 1 test: INKSTRAND_DATA is not set");
    }
    folder
}

fn hair(data: &Path, name: &str, head: Option<&HeadFile>) -> HairFile {
    let options = HairOptions {
        head: head.map(|h| &h.mesh),
        ..Default::default()
    };
    let file = read_hair(&data.join(name), &options).unwrap();
    eprintln!("{name}: {:?}", file.notes);
    file
}

fn head(data: &Path, name: &str) -> HeadFile {
    let file = read_head(&data.join(name), None, None).unwrap();
    eprintln!("{name}: {:?}", file.notes);
    file
}

fn roots(strands: &Strands) -> Vec<Vec3> {
    strands.roots().collect()
}

fn middle(points: &[Vec3]) -> Vec3 {
    points.iter().sum::<Vec3>() / points.len() as f32
}

const DENSE: &str = "sintel/sintel_hair_16points.tfx";
const LITE: &str = "sintel/sintel_lite_hair.tfx";
const MOHAWK: &str = "ratboy/Ratboy_mohawk.tfx";

#[test]
fn sintel_fits_her_head_as_it_is() {
    let Some(data) = data() else { return };
    let sintel = head(&data, "sintel/sintel.obj");
    assert!(sintel.notes[0].ends_with("guessed Y up, metres"));
    assert_eq!(sintel.mesh.positions.len(), 3046);
    for head in [Some(&sintel), None] {
        let file = hair(&data, DENSE, head);
        assert_eq!(file.notes, ["hair: 11,400 strands, guessed Y up, metres"]);
        assert_eq!(file.strands.len(), 11_400);
        assert_eq!(file.strands.points().len(), 11_400 * 16);
    }
    let roots = roots(&hair(&data, DENSE, None).strands);
    for roots in [&roots[..], &[]] {
        let frame = HeadFrame::find(Some(&sintel.mesh), roots);
        eprintln!("sintel's head: {frame:?}");
        assert!((frame.height - 0.245).abs() < 0.01, "{frame:?}");
        assert!(
            frame.center.distance(Vec3::new(0.0, 1.532, 0.005)) < 0.02,
            "{frame:?}"
        );
    }
    let frame = HeadFrame::find(None, &roots);
    assert!((frame.height - 0.245).abs() < 0.02, "{frame:?}");
}

#[test]
fn the_light_hair_is_brought_beside_the_dense() {
    let Some(data) = data() else { return };
    let sintel = head(&data, "sintel/sintel.obj");
    let dense = roots(&hair(&data, DENSE, Some(&sintel)).strands);
    let file = hair(&data, LITE, Some(&sintel));
    assert!(file.notes[0].starts_with("hair: 228 strands, guessed Y up, centimetres, moved by"));
    let lite = roots(&file.strands);
    let near = |r: &Vec3| {
        dense
            .iter()
            .map(|d| d.distance(*r))
            .fold(f32::MAX, f32::min)
    };
    let away = lite.iter().map(near).sum::<f32>() / lite.len() as f32;
    eprintln!("mean distance of the light hair's roots from the dense hair's: {away} m");
    assert!(away < 0.005, "{away}");
}

#[test]
fn turned_and_scaled_hair_is_brought_back() {
    let Some(data) = data() else { return };
    let sintel = head(&data, "sintel/sintel.obj");
    let dense = hair(&data, DENSE, None).strands;
    let units = [
        (1.0, "metres"),
        (0.01, "centimetres"),
        (0.001, "millimetres"),
        (0.1, "decimetres"),
        (0.0254, "inches"),
        (0.3048, "feet"),
    ];
    for up in [Axes::Y, Axes::Z] {
        for (scale, name) in units {
            let mut file = dense.clone();
            for p in file.points_mut() {
                *p = if up == Axes::Y {
                    *p
                } else {
                    Vec3::new(p.x, -p.z, p.y)
                } / scale;
            }
            for mesh in [None, Some(&sintel.mesh)] {
                let (found, note) = orient::hair(&file, mesh, &Given::default());
                assert_eq!(
                    (found.up, found.scale, found.offset),
                    (up, scale, Vec3::ZERO),
                    "{name}: {note}"
                );
            }
        }
    }
}

#[test]
fn makehuman_is_in_decimetres_and_wears_other_hair() {
    let Some(data) = data() else { return };
    let human = head(&data, "makehuman/makehuman_base.obj");
    assert!(human.notes[0].contains("helper and joint groups"));
    assert!(
        human.notes[1].ends_with("guessed Y up, decimetres"),
        "{:?}",
        human.notes
    );
    let body = 1.666;
    let frame = HeadFrame::find(Some(&human.mesh), &[]);
    eprintln!("MakeHuman's head: {frame:?}");
    assert!(
        (frame.height / (body / 7.5) - 1.0).abs() < 0.06,
        "{frame:?}"
    );
    for name in [DENSE, LITE] {
        let roots = roots(&hair(&data, name, Some(&human)).strands);
        let frame = HeadFrame::find(Some(&human.mesh), &roots);
        eprintln!("with {name}: {frame:?}");
        assert!(
            (frame.height / (body / 7.5) - 1.0).abs() < 0.06,
            "{frame:?}"
        );
        let top = roots.iter().map(|r| r.y).fold(f32::MIN, f32::max);
        assert!(
            (top - (frame.center.y + frame.height / 2.0)).abs() < 0.03,
            "{top}"
        );
        assert!(middle(&roots).x.abs() < 0.01);
    }
}

/// Of a whole character, whose belly and chin other units would put the roots on.
#[test]
fn hair_lies_on_a_character_s_head() {
    let Some(data) = data() else { return };
    let character = head(&data, "vrm/Godette_vrm_v4.vrm");
    let frame = HeadFrame::find(Some(&character.mesh), &[]);
    for name in [DENSE, LITE] {
        let roots = roots(&hair(&data, name, Some(&character)).strands);
        let away = middle(&roots).distance(frame.center) / frame.height;
        eprintln!("{name} on {frame:?}: {away:.2} head heights from its middle");
        assert!(away < 0.3, "{name}: {away}");
    }
}

#[test]
fn the_mohawk_and_blenders_strands_are_read_the_right_way_up() {
    let Some(data) = data() else { return };
    let file = hair(&data, MOHAWK, None);
    assert_eq!(file.notes, ["hair: 2,228 strands, guessed Y up, metres"]);
    assert_eq!(file.strands.points().len(), 2228 * 32);

    // [frame, strand, point, xyz] as f32 or f64 behind a short header.
    let bytes = std::fs::read(data.join("blender/strands_world_24x72x20x3.npy")).unwrap();
    let values = 24 * 72 * 20 * 3;
    let size = (bytes.len() / values).min(8);
    let at = bytes.len() - values * size;
    let value = |i: usize| match size {
        4 => f32::from_le_bytes(bytes[at + i * 4..][..4].try_into().unwrap()),
        _ => f64::from_le_bytes(bytes[at + i * 8..][..8].try_into().unwrap()) as f32,
    };
    let mut strands = Strands::new();
    for strand in 0..72 {
        let point =
            |k: usize| Vec3::from([0, 1, 2].map(|axis| value((strand * 20 + k) * 3 + axis)));
        strands
            .push(strand as u32, &(0..20).map(point).collect::<Vec<_>>(), None)
            .unwrap();
    }
    let (found, note) = orient::hair(&strands, None, &Given::default());
    eprintln!("blender: {note}");
    assert_eq!((found.up, found.scale), (Axes::Z, 1.0), "{note}");
}

#[test]
fn truncated_real_files_are_refused() {
    let Some(data) = data() else { return };
    for name in [LITE, MOHAWK] {
        let bytes = std::fs::read(data.join(name)).unwrap();
        assert!(tfx::from_bytes(&bytes).is_ok());
        let somewhere = (0..200u64).map(|i| (i * 2_654_435_761 % bytes.len() as u64) as usize);
        for len in (0..160).chain(somewhere).chain([bytes.len() - 1]) {
            assert!(tfx::from_bytes(&bytes[..len]).is_err(), "{name}: {len}");
        }
        // Flips that leave the file readable cost a reading each: the small file will do.
        for bit in (0..160 * 8).filter(|_| name == LITE) {
            let mut flipped = bytes.clone();
            flipped[bit / 8] ^= 1 << (bit % 8);
            let _ = tfx::from_bytes(&flipped);
        }
    }
}

#[test]
fn formats_that_are_not_read_are_named() {
    let Some(data) = data() else { return };
    for (name, format) in [
        ("blender/hair72_anim.usdc", "USD"),
        ("blender/hair72_anim.abc", "Alembic"),
        ("blender/hair_lines_morph.glb", "glTF"),
    ] {
        let error = read_hair(&data.join(name), &HairOptions::default()).unwrap_err();
        assert!(
            matches!(&error, HairError::Format { found, .. } if found == format),
            "{error}"
        );
        eprintln!("{error}");
    }
}
