//! `inkstrand new`: a preset to start from, and strands for it.

use super::starter;
use crate::Failure;
use crate::whole_file::{file_name, write_whole};
use std::fs;
use std::path::Path;

/// Writes the starter preset at `path` and its strands beside it. Neither may be there already.
pub(crate) fn new(path: &Path) -> Result<(), Failure> {
    let name = file_name(path);
    let stem = name.strip_suffix(".ron").filter(|stem| !stem.is_empty());
    let Some(stem) = stem.filter(|stem| !stem.ends_with(".strands")) else {
        let message = format!("{}: a preset's name ends in .ron", path.display());
        return Err(Failure::Usage(message));
    };
    let strands_name = format!("{stem}.strands.ron");
    let strands = path.with_file_name(&strands_name);
    for file in [path, &strands] {
        if fs::symlink_metadata(file).is_ok() {
            let message = format!("{} is already there, nothing is written", file.display());
            return Err(Failure::Failed(message));
        }
    }
    write_whole(&strands, starter::strands().as_bytes())?;
    write_whole(path, starter::preset(&name, &strands_name).as_bytes()).inspect_err(|_| {
        // Strands without their preset are of no use; the first error is the one to tell.
        let _ = fs::remove_file(&strands);
    })?;
    eprintln!("wrote {} and {}", path.display(), strands.display());
    eprintln!("draw it: inkstrand render {}", path.display());
    Ok(())
}
