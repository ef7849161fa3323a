//! `inkstrand new`: a preset that explains itself, and a hair style for it.

use crate::Failure;
use crate::paths::file_name;
use crate::say::{say, shell_word};
use hair_io::write_whole;
use std::fs;
use std::path::{Path, PathBuf};

/// The preset; NAME and STYLE stand for the files' names.
const PRESET: &str = include_str!("starter.ron");
/// The style: a short cut that inkstrand ships.
const STYLE: &str = include_str!("../../../../presets/styles/bob.style.ron");

/// Writes the starter preset at `path` and its style beside it, and tells so. Neither may be there already.
pub(crate) fn new(path: &Path) -> Result<(), Failure> {
    let style = write_new_look(path)?;
    say(format_args!(
        "wrote {} and {}",
        path.display(),
        style.display()
    ));
    say(format_args!(
        "draw it: inkstrand render {}",
        shell_word(path)
    ));
    Ok(())
}

/// Writes the starter preset at `path` and its style beside it. Neither may be there already. The style's path.
pub(crate) fn write_new_look(path: &Path) -> Result<PathBuf, Failure> {
    let name = file_name(path);
    let stem = stem(&name).map_err(|e| Failure::Usage(format!("{}: {e}", path.display())))?;
    let style_name = format!("{stem}.style.ron");
    let style = path.with_file_name(&style_name);
    for file in [path, &style] {
        if fs::symlink_metadata(file).is_ok() {
            let message = format!("{} is already there, nothing is written", file.display());
            return Err(Failure::Failed(message));
        }
    }
    // Each name goes in once, whatever words are in it.
    let (name, style_in_ron) = (shell_word(Path::new(&name)), in_ron(&style_name));
    let parts = PRESET.split("NAME");
    let parts: Vec<String> = parts
        .map(|part| part.replace("STYLE", &style_in_ron))
        .collect();
    let preset = parts.join(&name);
    write_whole(&style, STYLE.as_bytes())?;
    write_whole(path, preset.as_bytes()).inspect_err(|_| {
        // A style without its preset is of no use; the first error is the one to tell.
        let _ = fs::remove_file(&style);
    })?;
    Ok(style)
}

/// The preset's name without `.ron`, or why it is none.
fn stem(name: &str) -> Result<&str, String> {
    let others = [
        (".style.ron", "a hair style"),
        (".motion.ron", "a script of motion"),
        (".strands.ron", "strands"),
    ];
    for (ending, what) in others {
        if let Some(stem) = name.strip_suffix(ending) {
            return Err(format!(
                "{ending} is the name of {what}; `inkstrand new {}` writes a preset, and its hair style beside it",
                shell_word(Path::new(&format!("{stem}.ron")))
            ));
        }
    }
    // Its name goes into a comment and a text of the preset.
    if name.contains(char::is_control) {
        return Err("a preset's name has no line breaks or other control characters".to_owned());
    }
    let stem = name.strip_suffix(".ron").filter(|stem| !stem.is_empty());
    stem.ok_or_else(|| "a preset's name ends in .ron".to_owned())
}

/// A name between the quotes of a text in RON.
fn in_ron(name: &str) -> String {
    name.replace('\\', r"\\").replace('"', "\\\"")
}
