//! `inkstrand new`: a preset that explains itself, and a hair style for it.

use crate::Failure;
use crate::whole_file::{file_name, write_whole};
use std::fs;
use std::path::Path;

/// The preset; NAME and STYLE stand for the files' names.
const PRESET: &str = include_str!("starter.ron");
/// The style: a short cut that inkstrand ships.
const STYLE: &str = include_str!("../../../../presets/styles/bob.style.ron");

/// Writes the starter preset at `path` and its style beside it. Neither may be there already.
pub(crate) fn new(path: &Path) -> Result<(), Failure> {
    let name = file_name(path);
    let stem = name.strip_suffix(".ron").filter(|stem| !stem.is_empty());
    let Some(stem) = stem.filter(|stem| !stem.contains('.')) else {
        let message = format!("{}: a preset's name ends in .ron", path.display());
        return Err(Failure::Usage(message));
    };
    let style_name = format!("{stem}.style.ron");
    let style = path.with_file_name(&style_name);
    for file in [path, &style] {
        if fs::symlink_metadata(file).is_ok() {
            let message = format!("{} is already there, nothing is written", file.display());
            return Err(Failure::Failed(message));
        }
    }
    let preset = PRESET.replace("NAME", &name).replace("STYLE", &style_name);
    write_whole(&style, STYLE.as_bytes())?;
    write_whole(path, preset.as_bytes()).inspect_err(|_| {
        // A style without its preset is of no use; the first error is the one to tell.
        let _ = fs::remove_file(&style);
    })?;
    eprintln!("wrote {} and {}", path.display(), style.display());
    eprintln!("draw it: inkstrand render {}", path.display());
    Ok(())
}
