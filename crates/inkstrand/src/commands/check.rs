//! `inkstrand check`: every mistake of every preset, with the script, style and bake that it names.

use super::{mistakes, preset_folder, read_preset};
use crate::Failure;
use effects::Registry;
use effects::preset::PresetErrors;
use stage::{Files, Preset, check_motion, check_style};
use std::path::{Path, PathBuf};

pub(crate) fn check(presets: &[PathBuf], registry: &Registry) -> Result<(), Failure> {
    let found: Vec<String> = presets
        .iter()
        .flat_map(|path| mistakes_of(path, registry))
        .collect();
    if found.is_empty() {
        Ok(())
    } else {
        Err(Failure::Mistakes(found))
    }
}

fn mistakes_of(path: &Path, registry: &Registry) -> Vec<String> {
    let text = match read_preset(path) {
        Ok(text) => text,
        Err(message) => return vec![message],
    };
    let found = match path.to_string_lossy() {
        name if name.ends_with(".motion.ron") => check_motion(path, &text),
        name if name.ends_with(".style.ron") => check_style(path, &text),
        name => check_preset(path, &name, &text, registry),
    };
    match found {
        Ok(()) => Vec::new(),
        Err(errors) => mistakes(&errors).collect(),
    }
}

fn check_preset(
    path: &Path,
    name: &str,
    text: &str,
    registry: &Registry,
) -> Result<(), PresetErrors> {
    let files = Files {
        preset_folder: preset_folder(path),
        ..Files::default()
    };
    Preset::check(name, text, registry, &files)
}
