//! Reads files as inkstrand does, one after the other, and says what came of each: the program that `cargo xtask fuzz` feeds.
//!
//! Each line of the standard input is a kind of file and a path. For each there is a line on the standard output: `read`, or
//! `refused` and the message, with `\n` for its line ends.
#![allow(clippy::print_stdout, reason = "a program that another one reads")]

use effects::Registry;
use hair_io::{BoneMotion, HairError, MOST_OF_TEXT, SkeletonError};
use stage::{Files, Preset, Stage, check_motion, check_style};
use std::io;
use std::path::Path;

fn main() {
    let mut registry = Registry::new();
    effects_builtin::register(&mut registry).expect("no two of them have one id");
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
        "gltf" => bone(path).map_err(|error| error.to_string()),
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
fn bone(path: &Path) -> Result<(), HairError> {
    let read = |bone: &str| BoneMotion::read(path, bone, None);
    let motion = read("head").or_else(|error| match &error {
        HairError::Skeleton { source, .. } => match &**source {
            SkeletonError::Bone { names, .. } if !names.is_empty() => read(&names[0]),
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
