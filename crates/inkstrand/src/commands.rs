//! The commands.

mod check;
mod effects;
mod render;

pub(crate) use check::check;
pub(crate) use effects::effects;
pub(crate) use render::render;

use ::effects::preset::PresetErrors;
use std::path::Path;

/// A preset's text.
fn read_preset(path: &Path) -> Result<String, String> {
    std::fs::read_to_string(path).map_err(|e| format!("{}: {e}", path.display()))
}

/// The mistakes of a preset as texts.
fn mistakes(errors: &PresetErrors) -> impl Iterator<Item = String> {
    errors.0.iter().map(ToString::to_string)
}
