//! Files that a command reads and writes, held against each other before any work: none is lost to another.

use hair_io::{end_of_links, folder_of};
use std::fs;
use std::path::{Path, PathBuf};

/// The one path of a file, however it is spelled; also of one that is not there yet.
pub(crate) fn place(path: &Path) -> PathBuf {
    let path = end_of_links(path);
    match (fs::canonicalize(folder_of(&path)), path.file_name()) {
        (Ok(folder), Some(name)) => folder.join(name),
        _ => path,
    }
}

/// Whether two paths are one file: by another spelling, or by another name that the file has.
pub(crate) fn is_same(path: &Path, other: &Path) -> bool {
    place(path) == place(other) || has_both_names(path, other)
}

#[cfg(unix)]
fn has_both_names(path: &Path, other: &Path) -> bool {
    use std::os::unix::fs::MetadataExt as _;
    let node = |path| fs::metadata(path).map(|there| (there.dev(), there.ino()));
    matches!((node(path), node(other)), (Ok(one), Ok(another)) if one == another)
}

#[cfg(not(unix))]
fn has_both_names(_path: &Path, _other: &Path) -> bool {
    false
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
        std::os::unix::fs::symlink("sub/../not", folder.join("dangling")).unwrap();
        for (one, other) in [
            ("there", "sub/../there"),
            ("there", "link"),
            ("not", "sub/.././not"),
            ("not", "dangling"),
        ] {
            assert_eq!(place(&folder.join(one)), place(&folder.join(other)));
        }
        assert_ne!(place(&folder.join("there")), place(&folder.join("not")));

        fs::hard_link(folder.join("there"), folder.join("name")).unwrap();
        assert!(is_same(&folder.join("name"), &folder.join("sub/../there")));
        assert!(!is_same(&folder.join("name"), &folder.join("not")));
    }
}
