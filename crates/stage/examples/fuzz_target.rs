//! Reads files as inkstrand does, one after the other, and says what came of each: the program that `cargo xtask fuzz` feeds.
//!
//! Each line of the standard input is a kind of file and a path. For each there is a line on the standard output: `read`, or
//! `refused` and the message, with `\n` for its line ends.
#![allow(clippy::print_stdout, reason = "a program that another one reads")]

use effects::Registry;
use hair_io::MOST_OF_TEXT;
use mesh_io::{BoneMotion, GltfError, MeshError, read_model};
use stage::{Files, Preset, Stage, check_motion, check_style};
use std::io;
use std::path::Path;

fn main() {
    let mut registry = Registry::new();
    let register = [
        effects_builtin::register,
        effects_cartoon::register,
        effects_surface::register,
    ];
    for register in register {
        register(&mut registry).expect("no two of them have one id");
    }
    for line in io::stdin().lines() {
        let line = line.expect("whoever runs this writes UTF-8");
        let (kind, path) = line.split_once(' ').expect("a kind and a path");
        match read(kind, Path::new(path), &registry) {
            Ok(()) => println!("read"),
            Err(message) => println!("refused {}", message.replace('\n', "\\n")),
        }
    }
}

/// Reads one file of a kind, or says what is wrong with it.
fn read(kind: &str, path: &Path, registry: &Registry) -> Result<(), String> {
    let text = || hair_io::read_text(path, MOST_OF_TEXT).map_err(|error| error.to_string());
    match kind {
        "preset" => Preset::parse("look.ron", &text()?, registry)
            .map(drop)
            .map_err(|error| error.to_string()),
        "style" => {
            check_style(path, &text()?).map_err(|error| error.to_string())?;
            scene(path, "bust", registry)
        }
        "motion" => check_motion(path, &text()?).map_err(|error| error.to_string()),
        // Fitting hair to a head would take seconds.
        "strands" | "tfx" => scene(path, "none", registry),
        "obj" => hair_io::read_head(path, None, None)
            .map(drop)
            .map_err(|error| error.to_string()),
        "ply" => shapes(path).map_err(|error| error.to_string()),
        "gltf" => {
            // What has no head that moves may still have meshes, and the other way round.
            let meshes = shapes(path);
            bone(path).and(meshes).map_err(|error| error.to_string())
        }
        other => panic!("no kind of file is called {other}"),
    }
}

/// A scene of this hair on a head of this shape.
fn scene(hair: &Path, head: &str, registry: &Registry) -> Result<(), String> {
    let text = format!("(version: 1, head: (shape: {head}), layers: [(effect: \"hair.base\")])");
    let preset = Preset::parse("look.ron", &text, registry).expect("it is a preset");
    let files = Files {
        hair: Some(hair.to_owned()),
        ..Files::default()
    };
    Stage::new(&preset, &files)
        .map(drop)
        .map_err(|error| error.to_string())
}

/// The motion of a file's head, or of some other bone.
fn bone(path: &Path) -> Result<(), MeshError> {
    let read = |bone: &str| BoneMotion::read(path, bone, None);
    let motion = read("head").or_else(|error| match &error {
        MeshError::Gltf { source, .. } => match &**source {
            GltfError::Bone { names, .. } if !names.is_empty() => read(&names[0]),
            _ => Err(error),
        },
        _ => Err(error),
    })?;
    for time in [-1.0, 0.0, 0.3, motion.length(), 1e30] {
        let (rotation, moved) = motion.at(time);
        assert!(rotation.is_finite() && moved.is_finite(), "at {time} s");
    }
    Ok(())
}

/// The meshes of a file, at rest and in its animations.
fn shapes(path: &Path) -> Result<(), MeshError> {
    let model = read_model(path)?;
    let animations = model.rig.as_ref().map_or(0, |rig| rig.animations.len());
    for animation in (0..animations.min(4)).map(Some).chain([None]) {
        for time in [0.3, f64::NAN] {
            let Some(pose) = model.pose(animation, time) else {
                continue;
            };
            for shape in model.shapes(&pose) {
                assert!(shape.positions.iter().all(|place| place.is_finite()));
            }
        }
    }
    Ok(())
}
