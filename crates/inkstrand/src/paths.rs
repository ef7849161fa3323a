//! Files that a command reads and writes, held against each other before any work: none is lost to another.

use std::fs;
use std::path::{Path, PathBuf};

/// The one path of a file, however it is spelled; also of one that is not there yet.
pub(crate) fn place(path: &Path) -> PathBuf {
    if let Ok(place) = fs::canonicalize(path) {
        return place;
    }
    match (fs::canonicalize(folder_of(path)), path.file_name()) {
        (Ok(folder), Some(name)) => folder.join(name),
        _ => path.to_owned(),
    }
}

/// The folder of a file, `.` where its path is a mere name.
pub(crate) fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
}

/// The last part of a path as text.
pub(crate) fn file_name(path: &Path) -> String {
    path.file_name()
        .unwrap_or_default()
        .to_string_lossy()
        .into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    #[cfg(unix)]
    fn one_file_has_one_place() {
        let folder = tempfile::tempdir().unwrap();
        let folder = folder.path();
        fs::create_dir(folder.join("sub")).unwrap();
        fs::write(folder.join("there"), "").unwrap();
        std::os::unix::fs::symlink(folder.join("there"), folder.join("link")).unwrap();
        for (one, other) in [
            ("there", "sub/../there"),
            ("there", "link"),
            ("not", "sub/.././not"),
        ] {
            assert_eq!(place(&folder.join(one)), place(&folder.join(other)));
        }
        assert_ne!(place(&folder.join("there")), place(&folder.join("not")));
    }
}
