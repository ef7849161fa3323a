//! Documents on real files, which others change meanwhile.

mod disk;
mod model;
mod recovery;
mod saving;

use document::{Conflict, DiskChange, Document, OpenError, Recovery, SaveError};
use std::fs::{self, Permissions};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::mpsc;
use std::thread::sleep;
use std::time::{Duration, Instant};
use tempfile::TempDir;

struct Place {
    folder: TempDir,
}

impl Place {
    fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        Self { folder }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn file(&self) -> PathBuf {
        self.path("look.ron")
    }

    fn write(&self, text: &str) {
        fs::write(self.file(), text).unwrap();
    }

    /// As many editors save: a new file beside it takes its place.
    fn rename_over(&self, text: &str) {
        let beside = self.path("look.ron~");
        fs::write(&beside, text).unwrap();
        fs::rename(beside, self.file()).unwrap();
    }

    fn read(&self) -> String {
        fs::read_to_string(self.file()).unwrap()
    }

    fn open(&self) -> Document {
        Document::open(&self.file(), &Recovery::none()).unwrap()
    }

    fn recovery(&self) -> Recovery {
        Recovery::in_folder(&self.path("state/recovery"))
    }

    fn open_with_recovery(&self) -> Document {
        Document::open(&self.file(), &self.recovery()).unwrap()
    }

    /// The files in the folder for copies.
    fn copies(&self) -> usize {
        fs::read_dir(self.path("state/recovery")).map_or(0, Iterator::count)
    }
}

/// A file of this text, and its document.
fn opened(text: &str) -> (Place, Document) {
    let place = Place::new();
    place.write(text);
    let document = place.open();
    (place, document)
}

fn wait(document: &mut Document) -> DiskChange {
    let begin = Instant::now();
    loop {
        if let Some(change) = document.poll() {
            return change;
        }
        assert!(
            begin.elapsed() < Duration::from_secs(20),
            "nothing was told"
        );
        sleep(Duration::from_millis(2));
    }
}

fn assert_quiet(document: &mut Document) {
    for _ in 0..30 {
        assert_eq!(document.poll(), None);
        sleep(Duration::from_millis(10));
    }
}

fn edit(document: &mut Document, text: &str) {
    document.edit(text.to_owned(), None);
}
