//! The commands.

mod check;
mod effects;
mod render;

pub(crate) use check::check;
pub(crate) use effects::effects;
pub(crate) use render::render;

use crate::Failure;
use std::path::Path;

/// A preset's text.
fn read_preset(path: &Path) -> Result<String, Failure> {
    std::fs::read_to_string(path).map_err(|e| Failure::Failed(format!("{}: {e}", path.display())))
}
