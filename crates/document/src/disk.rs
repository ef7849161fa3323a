//! The file as it is on the disk.

use hair_io::{MOST_OF_TEXT, ReadError, decode_text, read_bytes};
use std::fs;
use std::io::ErrorKind;
use std::path::Path;
use std::sync::Arc;
use std::time::SystemTime;

/// What some editors put before a text: the byte order mark of UTF-8.
pub(crate) const MARK: &str = "\u{feff}";

pub(crate) enum Disk {
    /// The text, and whether a mark is before it.
    Text(Arc<str>, bool),
    Gone,
    Unreadable(ReadError),
}

/// The file when it was last looked at.
#[derive(Default)]
pub(crate) struct Seen {
    /// Its time and size; `None` where there was none.
    stamp: Option<(Option<SystemTime>, u64)>,
    /// Why it could not be read.
    pub problem: Option<String>,
}

impl Seen {
    pub fn read(&mut self, path: &Path) -> Disk {
        match self.read_file(path) {
            Ok((text, marked)) => Disk::Text(text, marked),
            Err(error) if is_gone(&error) => Disk::Gone,
            Err(error) => Disk::Unreadable(error),
        }
    }

    pub fn read_file(&mut self, path: &Path) -> Result<(Arc<str>, bool), ReadError> {
        // Before it is read: a change while that goes on is another one.
        self.note(path);
        let read = || {
            let bytes = read_bytes(path, MOST_OF_TEXT)?;
            let marked = bytes.starts_with(MARK.as_bytes());
            Ok((decode_text(path, bytes)?.into(), marked))
        };
        let read = read();
        self.problem = read.as_ref().err().map(ReadError::to_string);
        read
    }

    /// Notes time and size.
    pub fn note(&mut self, path: &Path) {
        self.stamp = stamp(path);
    }

    /// Whether time or size are others than when it was last looked at.
    pub fn is_outdated(&self, path: &Path) -> bool {
        self.stamp != stamp(path)
    }
}

/// Whether a file could not be read because there is none.
pub(crate) fn is_gone(error: &ReadError) -> bool {
    matches!(error, ReadError::Open { source, .. } if source.kind() == ErrorKind::NotFound)
}

fn stamp(path: &Path) -> Option<(Option<SystemTime>, u64)> {
    let file = fs::metadata(path).ok()?;
    Some((file.modified().ok(), file.len()))
}
