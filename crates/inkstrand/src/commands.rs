//! The commands.

mod check;
mod completions;
mod effects;
mod new;
mod progress;
mod render;
mod scene;
mod schema;
mod simulate;

pub(crate) use check::check;
pub(crate) use completions::completions;
pub(crate) use effects::effects;
pub(crate) use new::new;
pub(crate) use render::render;
pub(crate) use simulate::simulate;

use ::effects::preset::PresetErrors;
use std::path::{Path, PathBuf};

/// A preset's text, without the mark that some editors put before it.
fn read_preset(path: &Path) -> Result<String, String> {
    let named = |what: &dyn std::fmt::Display| format!("{}: {what}", path.display());
    let bytes = std::fs::read(path).map_err(|e| named(&e))?;
    let text = String::from_utf8(bytes).map_err(|e| {
        let good = &e.as_bytes()[..e.utf8_error().valid_up_to()];
        let line = 1 + good.iter().filter(|byte| **byte == b'\n').count();
        named(&format!("line {line} is not UTF-8 text"))
    })?;
    Ok(match text.strip_prefix('\u{feff}') {
        Some(text) => text.to_owned(),
        None => text,
    })
}

/// The folder that a preset's file names are relative to.
fn preset_folder(preset: &Path) -> PathBuf {
    preset.parent().unwrap_or(Path::new("")).to_owned()
}

/// The mistakes of a preset as texts.
fn mistakes(errors: &PresetErrors) -> impl Iterator<Item = String> {
    errors.0.iter().map(ToString::to_string)
}
