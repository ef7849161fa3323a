//! `inkstrand check`: every mistake of every file, with those of the files that presets name.

use super::progress::Bar;
use super::{mistakes, preset_folder, read_text};
use crate::paths::file_name;
use crate::say::say;
use crate::{Failure, counted};
use effects::Registry;
use stage::{
    Files, Preset, check_hair, check_mesh, check_motion, check_style, is_hair_file, is_mesh_file,
};
use std::collections::HashSet;
use std::fs;
use std::io::{self, IsTerminal as _};
use std::path::{Path, PathBuf};

pub(crate) fn check(paths: &[PathBuf], registry: &Registry) -> Result<(), Failure> {
    let mut found = Vec::new();
    let mut files = Vec::new();
    for path in paths {
        if path.is_dir() {
            let inside = files_in(path, &mut found);
            files.extend(inside);
        } else {
            files.push(path.clone());
        }
    }
    let wrong_folders = found.len();

    let mut bar = Bar::new(false, files.len() as u64, "files", None);
    let mut wrong = 0;
    // A script's mistakes are those of the preset that names it, too.
    let mut told = HashSet::new();
    for file in &files {
        let mistakes = mistakes_of(file, registry);
        wrong += usize::from(!mistakes.is_empty());
        found.extend(
            mistakes
                .into_iter()
                .filter(|mistake| told.insert(mistake.clone())),
        );
        bar.inc()?;
    }
    bar.finish();

    let checked = counted(files.len(), "file");
    if !found.is_empty() {
        if files.len() + wrong_folders > 1 {
            let folders = match wrong_folders {
                0 => String::new(),
                _ => format!("; mistakes in {}", counted(wrong_folders, "folder")),
            };
            say(format_args!(
                "{checked}, {wrong} of them with mistakes{folders}\n"
            ));
        }
        return Err(Failure::Mistakes(found));
    }
    // Scripts go by the exit status.
    if io::stderr().is_terminal() {
        say(format_args!("ok: {checked}"));
    }
    Ok(())
}

/// The .ron files in a folder and in those in it, sorted; hidden ones are left out. Folders that cannot be read, or where there is nothing to check, are
/// added to the mistakes, one each.
fn files_in(folder: &Path, mistakes: &mut Vec<String>) -> Vec<PathBuf> {
    let mut files = Vec::new();
    let mut unread = Vec::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(inner) = folders.pop() {
        if let Err(error) = look_into(&inner, &mut files, &mut folders) {
            unread.push(format!("{}: {error}", inner.display()));
        }
    }
    if files.is_empty() && unread.is_empty() {
        mistakes.push(format!(
            "{}: there is no .ron file in this folder",
            folder.display()
        ));
    }
    unread.sort();
    mistakes.extend(unread);
    files.sort();
    files
}

/// Adds the .ron files and the folders in a folder, but for hidden ones.
fn look_into(
    folder: &Path,
    files: &mut Vec<PathBuf>,
    folders: &mut Vec<PathBuf>,
) -> io::Result<()> {
    for entry in fs::read_dir(folder)? {
        let entry = entry?;
        let (path, kind) = (entry.path(), entry.file_type()?);
        let name = file_name(&path);
        if name.starts_with('.') {
            continue;
        }
        // Links to folders may lead around in a circle.
        if kind.is_dir() {
            folders.push(path);
        } else if name.ends_with(".ron") && path.is_file() {
            files.push(path);
        }
    }
    Ok(())
}

/// What is wrong with a file of the kind that its name says.
fn mistakes_of(path: &Path, registry: &Registry) -> Vec<String> {
    let name = path.display().to_string();
    if is_hair_file(path) {
        let wrong = check_hair(path).err();
        return wrong.map(|error| error.to_string()).into_iter().collect();
    }
    if is_mesh_file(path) {
        let wrong = check_mesh(path).err();
        return wrong.map(|error| error.to_string()).into_iter().collect();
    }
    let text = match read_text(path) {
        Ok(text) => text,
        Err(message) => return vec![message],
    };
    let found = if name.ends_with(".motion.ron") {
        check_motion(path, &text)
    } else if name.ends_with(".style.ron") {
        check_style(path, &text)
    } else {
        let files = Files {
            preset_folder: preset_folder(path),
            ..Files::default()
        };
        Preset::check(&name, &text, registry, &files)
    };
    found.err().iter().flat_map(mistakes).collect()
}
