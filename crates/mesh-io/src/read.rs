//! Whole files: what is no regular file, or larger than its kind may be, is refused before memory is taken for it.

use std::fs::{self, File};
use std::io::{self, Read as _};
use std::path::{Path, PathBuf};

/// The most bytes of a text that people write: a preset, a style, a script of motion.
pub const MOST_OF_TEXT: u64 = 64 << 20;
/// The most bytes of hair, a mesh, or a file of numbers.
pub const MOST_OF_DATA: u64 = 4 << 30;

/// Why a file could not be read. Every message names the file.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ReadError {
    /// The file system refused.
    #[error("{}: {source}", path.display())]
    Open {
        /// The file.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// A folder, or something that may never end.
    #[error("{}: a file was expected, this is {found}", path.display())]
    NotAFile {
        /// What was to be read.
        path: PathBuf,
        /// What it is.
        found: &'static str,
    },
    /// More bytes than a file of its kind may have.
    #[error("{}: it has {}, and at most {} of such a file are read", path.display(), size(*found), size(*most))]
    TooLarge {
        /// The file.
        path: PathBuf,
        /// Its size in bytes, as far as it is known.
        found: u64,
        /// The limit in bytes.
        most: u64,
    },
    /// A text that is not UTF-8.
    #[error("{}:{line}:{column}: this is not UTF-8 text (byte {at} of the file)", path.display())]
    NotText {
        /// The file.
        path: PathBuf,
        /// The line of the first byte that is not, 1 first.
        line: usize,
        /// Its column in characters, 1 first.
        column: usize,
        /// The bytes before it.
        at: usize,
    },
}

/// The bytes of a file of at most `most` bytes, such as [`MOST_OF_DATA`].
///
/// # Errors
///
/// When it cannot be read, is a folder, a pipe or a device, or is larger.
pub fn read_bytes(path: &Path, most: u64) -> Result<Vec<u8>, ReadError> {
    let refused = |source| ReadError::Open {
        path: path.into(),
        source,
    };
    let too_large = |found| ReadError::TooLarge {
        path: path.into(),
        found,
        most,
    };
    // Before it is opened: opening a pipe waits for somebody to write into it.
    let file = fs::metadata(path).map_err(refused)?;
    if !file.is_file() {
        return Err(ReadError::NotAFile {
            path: path.into(),
            found: if file.is_dir() {
                "a folder"
            } else {
                "a pipe or a device"
            },
        });
    }
    if file.len() > most {
        return Err(too_large(file.len()));
    }
    let mut bytes = Vec::new();
    let length = usize::try_from(file.len()).map_err(|_| too_large(file.len()))?;
    bytes
        .try_reserve_exact(length)
        .map_err(|_| refused(io::ErrorKind::OutOfMemory.into()))?;
    // It may have grown since.
    let file = File::open(path).map_err(refused)?;
    file.take(most + 1)
        .read_to_end(&mut bytes)
        .map_err(refused)?;
    if bytes.len() as u64 > most {
        return Err(too_large(bytes.len() as u64));
    }
    Ok(bytes)
}

/// The text of a file of at most `most` bytes, such as [`MOST_OF_TEXT`], without the mark that some editors put before it.
///
/// # Errors
///
/// As of [`read_bytes`], and when it is not UTF-8.
pub fn read_text(path: &Path, most: u64) -> Result<String, ReadError> {
    decode_text(path, read_bytes(path, most)?)
}

/// The text that the bytes of the file `path` are, without the mark that some editors put before it.
///
/// # Errors
///
/// When they are not UTF-8.
pub fn decode_text(path: &Path, bytes: Vec<u8>) -> Result<String, ReadError> {
    let marked = String::from_utf8(bytes).map_err(|error| {
        let at = error.utf8_error().valid_up_to();
        let before = String::from_utf8_lossy(&error.as_bytes()[..at]);
        let (line, column) = place_after(&before);
        ReadError::NotText {
            path: path.into(),
            line,
            column,
            at,
        }
    })?;
    Ok(match marked.strip_prefix('\u{feff}') {
        Some(text) => text.to_owned(),
        None => marked,
    })
}

/// The line and the column (in characters), 1 first, of what follows this text.
#[must_use]
pub fn place_after(before: &str) -> (usize, usize) {
    let line_start = before.rfind('\n').map_or(0, |i| i + 1);
    (
        before.matches('\n').count() + 1,
        before[line_start..].chars().count() + 1,
    )
}

/// The most characters of a file that a message repeats.
const MOST_SHOWN: usize = 200;

/// A part of a file, or a message that may repeat one, as it is shown: on one line, and not too much of it.
#[must_use]
pub fn shown(text: &str) -> String {
    let mut shown: String = text
        .chars()
        .take(MOST_SHOWN)
        .map(|c| if c.is_control() { ' ' } else { c })
        .collect();
    if text.chars().nth(MOST_SHOWN).is_some() {
        shown.push_str("...");
    }
    shown
}

/// Bytes as people say them.
fn size(bytes: u64) -> String {
    const UNITS: [(u64, &str); 3] = [(1 << 30, "GiB"), (1 << 20, "MiB"), (1 << 10, "KiB")];
    match UNITS.iter().find(|(unit, _)| bytes >= *unit) {
        Some((unit, name)) => format!("{:.1} {name}", bytes as f64 / *unit as f64),
        None => format!("{bytes} bytes"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_read_up_to_its_limit() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.ron");
        fs::write(&path, "0123456789").unwrap();
        assert_eq!(read_bytes(&path, 10).unwrap(), b"0123456789");
        let message = read_text(&path, 9).unwrap_err().to_string();
        let expected = "a.ron: it has 10 bytes, and at most 9 bytes of such a file are read";
        assert!(message.ends_with(expected), "{message}");
        assert_eq!(size(5 << 29), "2.5 GiB");
        let message = read_bytes(folder.path(), 10).unwrap_err().to_string();
        assert!(message.ends_with("this is a folder"), "{message}");
    }

    #[cfg(unix)]
    #[test]
    fn what_never_ends_is_refused_at_once() {
        let folder = tempfile::tempdir().unwrap();
        let pipe = folder.path().join("pipe.tfx");
        let made = std::process::Command::new("mkfifo").arg(&pipe).status();
        assert!(made.is_ok_and(|status| status.success()));
        for path in [&pipe, Path::new("/dev/zero")] {
            let message = read_bytes(path, MOST_OF_DATA).unwrap_err().to_string();
            assert!(message.ends_with("this is a pipe or a device"), "{message}");
        }
    }

    #[test]
    fn a_byte_that_is_no_text_has_a_place() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.style.ron");
        fs::write(&path, b"(\n  \xc3\xa4 \xff)").unwrap();
        let message = read_text(&path, MOST_OF_TEXT).unwrap_err().to_string();
        let expected = "a.style.ron:2:5: this is not UTF-8 text (byte 7 of the file)";
        assert!(message.ends_with(expected), "{message}");
    }

    #[test]
    fn little_of_a_long_text_is_shown() {
        assert_eq!(shown("a\nb"), "a b");
        assert_eq!(shown(&"ä".repeat(1000)), "ä".repeat(200) + "...");
    }
}
