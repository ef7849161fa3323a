//! The looks that are shipped: the presets in `presets`.

use std::fs;
use std::path::Path;

use crate::{Outcome, program};

/// The names of `presets/*.ron`, sorted.
///
/// # Errors
/// The folder can't be read, or there is no preset.
pub fn names() -> Outcome<Vec<String>> {
    names_in(&program::root().join("presets"))
}

/// The names of those that paint samples or have passes.
///
/// # Errors
/// As [`names`], or a preset can't be read.
pub fn of_samples() -> Outcome<Vec<String>> {
    let mut found = names()?;
    let mut texts = Vec::new();
    for name in &found {
        let path = program::root().join(format!("presets/{name}.ron"));
        texts.push(fs::read_to_string(path)?);
    }
    let mut is_one = texts.iter().map(|text| {
        ["passes:", ".toon\"", "\"mesh."]
            .iter()
            .any(|word| text.contains(word))
    });
    found.retain(|_| is_one.next() == Some(true));
    Ok(found)
}

fn names_in(folder: &Path) -> Outcome<Vec<String>> {
    let failed = |error| format!("{}: {error}", folder.display());
    let mut names = Vec::new();
    for entry in fs::read_dir(folder).map_err(failed)? {
        let path = entry?.path();
        if path.extension().is_some_and(|extension| extension == "ron") {
            let name = path.file_stem().unwrap_or_default();
            names.push(name.to_string_lossy().into_owned());
        }
    }
    if names.is_empty() {
        return Err(format!("no preset is in {}", folder.display()).into());
    }
    names.sort();
    Ok(names)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn looks_are_found_in_order() {
        let folder = tempfile::tempdir().unwrap();
        assert!(names_in(folder.path()).is_err());
        for name in ["b.ron", "notes.md", "a.ron"] {
            fs::write(folder.path().join(name), "").unwrap();
        }
        assert_eq!(names_in(folder.path()).unwrap(), ["a", "b"]);
        assert!(names_in(&folder.path().join("none")).is_err());
    }
}
