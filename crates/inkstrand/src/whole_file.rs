//! Files that are whole or not there: written beside their place, then renamed.

use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// The unfinished files of this process. Whoever creates, renames or removes one holds the lock.
static PARTS: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

fn parts() -> MutexGuard<'static, Vec<PathBuf>> {
    // A list of paths is right whoever panicked beside it.
    PARTS.lock().unwrap_or_else(PoisonError::into_inner)
}

/// From now on an interrupt removes what is unfinished and ends the process with 130.
pub(crate) fn leave_no_parts() {
    let set = ctrlc::set_handler(|| {
        // Held until the end of the process: nothing is created or renamed after this.
        let parts = parts();
        for part in parts.iter() {
            let _ = fs::remove_file(part); // nobody is left to tell
        }
        std::process::exit(130);
    });
    // It fails where the program that calls us has a handler of its own, which is then in charge.
    drop(set);
}

/// A file under way. Dropped before [`WholeFile::finish`] it leaves nothing.
pub(crate) struct WholeFile {
    path: PathBuf,
    /// Where it is until it is whole.
    part: Option<PathBuf>,
    writer: BufWriter<File>,
}

impl WholeFile {
    /// A file that will be at `path`, or where a link there points. What is there but no file (a
    /// pipe, a device) is written to as it is.
    pub fn create(path: &Path) -> io::Result<Self> {
        let path = &fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
        if fs::metadata(path).is_ok_and(|there| !there.is_file() && !there.is_dir()) {
            let file = File::options()
                .write(true)
                .open(path)
                .map_err(|e| named(path, &e))?;
            return Ok(Self {
                path: path.clone(),
                part: None,
                writer: BufWriter::new(file),
            });
        }
        let part = path.with_file_name(format!(".{}.{}.part", file_name(path), std::process::id()));
        let mut parts = parts();
        let file = File::create(&part).map_err(|e| named(path, &e))?;
        parts.push(part.clone());
        Ok(Self {
            path: path.to_owned(),
            part: Some(part),
            writer: BufWriter::new(file),
        })
    }

    /// Puts the file in its place, where it takes that of an older one.
    pub fn finish(mut self) -> io::Result<()> {
        self.flush()?;
        let _parts = parts();
        match &self.part {
            Some(part) => fs::rename(part, &self.path).map_err(|e| named(&self.path, &e)),
            None => Ok(()),
        }
    }
}

impl Write for WholeFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.writer.write(bytes).map_err(|e| named(&self.path, &e))
    }

    fn flush(&mut self) -> io::Result<()> {
        self.writer.flush().map_err(|e| named(&self.path, &e))
    }
}

impl Drop for WholeFile {
    fn drop(&mut self) {
        let Some(own) = &self.part else { return };
        let mut parts = parts();
        // The first error is the one to tell; a finished part is no longer there.
        let _ = fs::remove_file(own);
        parts.retain(|part| part != own);
    }
}

/// The error, beginning with the file's name.
fn named(path: &Path, error: &io::Error) -> io::Error {
    io::Error::new(error.kind(), format!("{}: {error}", path.display()))
}

/// Writes a whole file at once. Errors begin with its name.
pub(crate) fn write_whole(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let mut file = WholeFile::create(path)?;
    file.write_all(bytes)?;
    file.finish()
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
    fn links_and_devices_stay_what_they_are() {
        let folder = tempfile::tempdir().unwrap();
        let (file, link) = (folder.path().join("a.txt"), folder.path().join("b.txt"));
        fs::write(&file, "old").unwrap();
        std::os::unix::fs::symlink(&file, &link).unwrap();
        write_whole(&link, b"new").unwrap();
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        assert_eq!(fs::read(&file).unwrap(), b"new");

        write_whole(Path::new("/dev/null"), b"gone").unwrap();
        assert!(!fs::metadata("/dev/null").unwrap().is_file());
    }

    #[test]
    fn a_file_is_whole_or_not_there() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.txt");
        let names = || {
            let entries = fs::read_dir(folder.path()).unwrap();
            entries.map(|e| e.unwrap().file_name()).collect::<Vec<_>>()
        };

        let mut dropped = WholeFile::create(&path).unwrap();
        dropped.write_all(b"half").unwrap();
        assert_eq!(names().len(), 1, "the part");
        assert!(!path.exists());
        drop(dropped);
        assert!(names().is_empty());

        write_whole(&path, b"one").unwrap();
        write_whole(&path, b"two").unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"two");
        assert_eq!(names(), ["a.txt"]);
        assert!(parts().iter().all(|part| !part.starts_with(folder.path())));
    }

    #[test]
    fn errors_name_the_file() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("none/a.txt");
        let error = write_whole(&path, b"x").unwrap_err();
        assert!(error.to_string().contains("none/a.txt: "), "{error}");
        // A folder in the file's place.
        fs::create_dir(folder.path().join("taken")).unwrap();
        assert!(write_whole(&folder.path().join("taken"), b"x").is_err());
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }
}
