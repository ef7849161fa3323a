//! `inkstrand check`: every mistake of every preset.

use super::{mistakes, preset_folder, read_preset};
use crate::Failure;
use effects::Registry;
use stage::{Files, Preset};
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
    let files = Files {
        preset_folder: preset_folder(path),
        ..Files::default()
    };
    let name = path.display().to_string();
    match Preset::check(&name, &text, registry, &files) {
        Ok(()) => Vec::new(),
        Err(errors) => mistakes(&errors).collect(),
    }
}
