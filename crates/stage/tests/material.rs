//! Material normals of joints: worked out where something reads them, and what they are.

use effects::Registry;
use glam::Vec3;
use stage::{Files, Preset, Stage};
use std::fs;
use std::path::{Path, PathBuf};

fn presets() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../presets")
}

const TURN: &str = "(version: 1, moves: [(move: turn, start: 0.1, length: 0.4, angle: 80)])";

fn scene(style: &str, settings: &[(&str, &str)]) -> Stage {
    let folder = tempfile::tempdir().unwrap();
    let motion = folder.path().join("a.motion.ron");
    fs::write(&motion, TURN).unwrap();
    let mut registry = Registry::new();
    effects_builtin::register(&mut registry).unwrap();
    let text = fs::read_to_string(presets().join("twin-tails.ron")).unwrap();
    let mut preset = Preset::parse("look.ron", &text, &registry).unwrap();
    for (name, value) in settings {
        preset.set(name, value).unwrap();
    }
    take_all_joints(&mut preset);
    let files = Files {
        preset_folder: presets(),
        hair: Some(presets().join("styles").join(style)),
        motion: Some(motion),
        ..Files::default()
    };
    Stage::new(&preset, &files).unwrap()
}

/// Makes the picture so large, and joints so few, that each of them is there in every frame.
fn take_all_joints(preset: &mut Preset) {
    preset.sections.scene.size = [7680, 5760];
    preset.sections.path.subdivision = 2;
}

const READ: &[(&str, &str)] = &[("clump.normal", "material")];

/// Normals, tangents and positions of the joints at a time, and where runs begin.
fn joints(stage: &mut Stage, time: f32) -> (Vec<Vec3>, Vec<Vec3>, Vec<Vec3>, Vec<usize>) {
    stage.advance_to(time).unwrap();
    let frame = stage.frame().unwrap();
    let paths = frame.paths;
    let tangents = paths.forward.iter().zip(&paths.backward);
    (
        frame.material_normals.to_vec(),
        tangents.map(|(f, b)| (*f - *b).normalize_or(*f)).collect(),
        paths.position.clone(),
        paths.runs.iter().map(|run| run.joints.start).collect(),
    )
}

#[test]
fn they_are_worked_out_where_something_reads_them() {
    let mut stage = scene("twin-tails.style.ron", &[]);
    stage.advance_to(0.5).unwrap();
    assert!(stage.frame().unwrap().material_normals.is_empty());
    let mut stage = scene("twin-tails.style.ron", READ);
    let (normals, _, positions, _) = joints(&mut stage, 0.0);
    assert_eq!(normals.len(), positions.len());
}

#[test]
fn they_are_across_the_strand_and_change_gently_along_it_and_in_time() {
    let cases: [(&str, &[(&str, &str)]); 4] = [
        ("twin-tails.style.ron", READ),
        ("waves.style.ron", READ),
        ("waves.style.ron", &[READ[0], ("dynamics.guides", "20")]),
        ("waves.style.ron", &[READ[0], ("dynamics.solver", "none")]),
    ];
    for (style, settings) in cases {
        let mut stage = scene(style, settings);
        let mut before: Option<Vec<Vec3>> = None;
        for step in 0..16 {
            let (normals, tangents, _, starts) = joints(&mut stage, step as f32 / 24.0);
            let mut twisted = 0;
            for (i, (normal, tangent)) in normals.iter().zip(&tangents).enumerate() {
                assert!((normal.length() - 1.0).abs() < 1e-4, "{style}");
                assert!(normal.dot(*tangent).abs() < 1e-4, "{style}");
                if i > 0 && !starts.contains(&i) {
                    let turned = tangents[i - 1].dot(*tangent);
                    let kept = normals[i - 1].dot(*normal);
                    // A normal turns with its tangent, and otherwise little, but where a strand is twisted.
                    twisted += usize::from(kept < turned.min(0.9) - 0.15);
                    assert!(kept > turned.min(0.9) - 0.32, "{style}: {kept} {turned}");
                }
            }
            assert!(
                twisted * 5000 <= normals.len(),
                "{style}: {twisted} of {}",
                normals.len()
            );
            if let Some(before) = &before {
                let still = before
                    .iter()
                    .zip(&normals)
                    .filter(|(a, b)| a.dot(**b) > 0.5)
                    .count();
                assert!(
                    still as f32 > 0.97 * normals.len() as f32,
                    "{style}, frame {step}"
                );
            }
            before = Some(normals);
        }
    }
}

#[test]
fn they_point_away_from_the_head_at_rest_and_turn_with_it() {
    let mut stage = scene("bob.style.ron", &[READ[0], ("dynamics.solver", "none")]);
    let (normals, _, positions, _) = joints(&mut stage, 0.0);
    let head = stage.frame().unwrap().objects[0].head.center;
    let out: f32 = (normals.iter().zip(&positions))
        .map(|(normal, position)| normal.dot((*position - head).normalize()))
        .sum::<f32>()
        / normals.len() as f32;
    assert!(out > 0.5, "{out}");
    let (turned, ..) = joints(&mut stage, 3.0);
    let rotation = glam::Quat::from_rotation_y(80.0_f32.to_radians());
    for (a, b) in normals.iter().zip(&turned) {
        assert!((rotation * *a).distance(*b) < 2e-3, "{a} {b}");
    }
}

#[test]
fn a_bake_gives_nearly_those_of_its_simulation() {
    let mut stage = scene("twin-tails.style.ron", READ);
    let mut bake = stage::Bake::default();
    for step in 0..=8 {
        let time = step as f32 / 24.0;
        stage.advance_to(time).unwrap();
        stage.record(time, &mut bake);
    }
    let text = stage.bake_text(bake).unwrap();
    let (simulated, ..) = joints(&mut stage, 8.0 / 24.0);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("bake.strands.ron");
    fs::write(&path, text).unwrap();
    let motion = folder.path().join("a.motion.ron");
    fs::write(&motion, TURN).unwrap();
    let mut registry = Registry::new();
    effects_builtin::register(&mut registry).unwrap();
    let text = fs::read_to_string(presets().join("twin-tails.ron")).unwrap();
    let mut preset = Preset::parse("look.ron", &text, &registry).unwrap();
    preset.set("clump.normal", "material").unwrap();
    take_all_joints(&mut preset);
    let files = Files {
        preset_folder: presets(),
        bake: Some(path),
        motion: Some(motion),
        ..Files::default()
    };
    let mut played = Stage::new(&preset, &files).unwrap();
    let (played, ..) = joints(&mut played, 8.0 / 24.0);
    let like: f32 = simulated.iter().zip(&played).map(|(a, b)| a.dot(*b)).sum();
    let like = like / simulated.len() as f32;
    assert!(like > 0.9, "{like}");
}

/// A bob whose layer of fine hair makes paths of its own, with an undercoat or without.
fn fine_bob(undercoat: bool) -> Stage {
    let folder = tempfile::tempdir().unwrap();
    let text = "(version: 1, head: (shape: bust), hair: (file: \"h.style.ron\"), clump: (normal: material),
        layers: [(effect: \"hair.base\"), (effect: \"hair.fine\")])";
    let style = fs::read_to_string(presets().join("styles/bob.style.ron")).unwrap();
    let said = format!("version: 1, undercoat: {undercoat},");
    let style = style.replace("version: 1,", &said);
    fs::write(folder.path().join("h.style.ron"), style).unwrap();
    let mut registry = Registry::new();
    effects_builtin::register(&mut registry).unwrap();
    let preset = Preset::parse("look.ron", text, &registry).unwrap();
    let files = Files {
        preset_folder: folder.path().to_owned(),
        ..Files::default()
    };
    Stage::new(&preset, &files).unwrap()
}

#[test]
fn paths_that_layers_make_have_them_of_their_strand() {
    assert!(fine_bob(true).strand_count() > fine_bob(false).strand_count());
    for undercoat in [true, false] {
        let mut stage = fine_bob(undercoat);
        let strands = stage.strand_count();
        let (normals, tangents, ..) = joints(&mut stage, 0.0);
        let frame = stage.frame().unwrap();
        assert!(frame.strands.len() > strands && normals.len() == frame.paths.len());
        for (normal, tangent) in normals.iter().zip(&tangents) {
            assert!((normal.length() - 1.0).abs() < 1e-4 && normal.dot(*tangent).abs() < 1e-4);
        }

        // A made path has its strand's mean, and lies along it.
        let (of_hair, made) = frame.strands.split_at(strands);
        let runs = |strand: usize| {
            frame
                .paths
                .runs
                .iter()
                .filter(move |run| run.strand == strand)
        };
        let mut likeness = Vec::new();
        for (path, info) in (strands..).zip(made) {
            let parent = of_hair
                .iter()
                .position(|hair| hair.mean == info.mean)
                .unwrap();
            let own = || runs(parent).flat_map(|run| run.joints.clone());
            for joint in runs(path).flat_map(|run| run.joints.clone()) {
                let u = frame.paths.u[joint];
                let away = |joint: &usize| (frame.paths.u[*joint] - u).abs();
                let beside = own().min_by(|a, b| away(a).total_cmp(&away(b)));
                likeness.extend(beside.map(|beside| normals[beside].dot(normals[joint])));
            }
        }
        let mean = likeness.iter().sum::<f32>() / likeness.len() as f32;
        let unlike = likeness.iter().filter(|likeness| **likeness < 0.5).count();
        assert!(mean > 0.9, "{mean}");
        assert!(
            unlike < likeness.len() / 20,
            "{unlike} of {}",
            likeness.len()
        );
    }
}
