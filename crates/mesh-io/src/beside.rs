//! Files that another file names: beside it or below, and nowhere else.

use std::fs;
use std::path::{Component, Path, PathBuf};

/// The file that a URI names in a folder or below; `None` where it would be elsewhere: of a scheme, absolute, or out of the
/// folder by `..`.
#[cfg(feature = "gltf")]
pub(crate) fn file_of_uri(folder: &Path, uri: &str) -> Option<PathBuf> {
    if uri.contains(':') {
        return None;
    }
    file_in(folder, &decoded(uri)?)
}

/// The file of this name in a folder or below; `None` where it would be elsewhere: absolute, out of the folder by `..`, or by a
/// link. It need not be there.
pub(crate) fn file_in(folder: &Path, name: &str) -> Option<PathBuf> {
    // A separator of Windows alone would mean one file here and another there.
    if name.contains(['\\', ':']) {
        return None;
    }
    let mut depth = 0usize;
    for part in Path::new(name).components() {
        depth = match part {
            Component::Normal(_) => depth + 1,
            Component::CurDir => depth,
            Component::ParentDir => depth.checked_sub(1)?,
            Component::RootDir | Component::Prefix(_) => return None,
        };
    }
    let file = folder.join(name);
    let folder = match folder.as_os_str().is_empty() {
        true => Path::new("."),
        false => folder,
    };
    match (fs::canonicalize(&file), fs::canonicalize(folder)) {
        (Ok(file), Ok(folder)) if !file.starts_with(&folder) => None,
        _ => Some(file),
    }
}

#[cfg(feature = "gltf")]
/// The text with `%20` as a space and so on; a `%` that begins no such code stands for itself, as some programs write it.
fn decoded(uri: &str) -> Option<String> {
    let mut bytes = Vec::with_capacity(uri.len());
    let mut rest = uri.as_bytes();
    while let [first, after @ ..] = rest {
        let digit = |i: usize| (*after.get(i)? as char).to_digit(16);
        match (first, digit(0), digit(1)) {
            (b'%', Some(high), Some(low)) => {
                bytes.push((high * 16 + low) as u8);
                rest = &after[2..];
            }
            _ => {
                bytes.push(*first);
                rest = after;
            }
        }
    }
    String::from_utf8(bytes).ok()
}

#[cfg(all(test, feature = "gltf"))]
mod tests {
    use super::*;

    #[test]
    fn names_are_decoded_and_stay_in_the_folder() {
        let file = |uri| file_of_uri(Path::new("hair"), uri);
        let named = |name: &str| Some(Path::new("hair").join(name));
        assert_eq!(file("my%20girl%c3%A4.bin"), named("my girlä.bin"));
        assert_eq!(file("100%.bin"), named("100%.bin"));
        assert_eq!(file("a/../b/./c.bin"), named("a/../b/./c.bin"));
        for outside in [
            "../a.bin",
            "a/../../b.bin",
            "%2e%2e/a.bin",
            "/dev/zero",
            "%2Fdev%2Fzero",
            "file:///dev/zero",
            "https://example.com/a.bin",
            "C:\\a.bin",
            "C%3A/a.bin",
            "..\\a.bin",
            "%ff.bin",
        ] {
            assert_eq!(file(outside), None, "{outside}");
        }
    }
}
