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
pub(crate) use new::{new, write_new_look};
pub use progress::Progress;
pub(crate) use render::render;
pub(crate) use simulate::simulate;

use ::effects::preset::PresetErrors;
use std::path::{Path, PathBuf};

/// A text file's whole text.
fn read_text(path: &Path) -> Result<String, String> {
    check_there(path)?;
    hair_io::read_text(path, hair_io::MOST_OF_TEXT).map_err(|error| error.to_string())
}

/// Refuses a path where nothing is.
fn check_there(path: &Path) -> Result<(), String> {
    match path.exists() && !path.is_dir() {
        true => Ok(()),
        false => stage::no_file(path, "").map_or(Ok(()), Err),
    }
}

/// The folder that a preset's file names are relative to.
fn preset_folder(preset: &Path) -> PathBuf {
    preset.parent().unwrap_or(Path::new("")).to_owned()
}

/// The mistakes of a preset as texts.
fn mistakes(errors: &PresetErrors) -> impl Iterator<Item = String> {
    errors.0.iter().map(ToString::to_string)
}
