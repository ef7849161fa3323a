//! Files that are whole or not there: written beside their place, then renamed.

use std::collections::HashSet;
use std::fs::{self, File, TryLockError};
use std::io::{self, BufWriter, ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::sync::{LazyLock, Mutex, MutexGuard, PoisonError};

/// How names of unfinished files begin and end. They are short: a name of the length that a file system allows has a part too.
const PART: (&str, &str) = (".inkstrand-", ".part");

/// The unfinished files of this process. Whoever creates, renames or removes one holds the lock.
static PARTS: LazyLock<Mutex<Parts>> = LazyLock::new(Mutex::default);

#[derive(Default)]
struct Parts {
    own: Vec<PathBuf>,
    /// Folders in which what others have left is cleaned up.
    clean: HashSet<PathBuf>,
}

fn parts() -> MutexGuard<'static, Parts> {
    // A list of paths is right whoever panicked beside it.
    PARTS.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Removes all unfinished files of this process, which is about to end. As long as the answer is held, no [`WholeFile`] is begun
/// or put in its place.
#[must_use = "once it is dropped, files are begun again"]
pub fn remove_parts() -> NoParts {
    let parts = parts();
    for part in &parts.own {
        let _ = fs::remove_file(part); // nobody is left to tell
    }
    NoParts(parts)
}

/// What [`remove_parts`] gives.
pub struct NoParts(#[expect(dead_code, reason = "held, not read")] MutexGuard<'static, Parts>);

/// A file under way. Dropped before [`WholeFile::finish`] it leaves nothing.
pub struct WholeFile {
    path: PathBuf,
    /// Where it is until it is whole.
    part: Option<PathBuf>,
    /// Locked while it is a part.
    writer: BufWriter<File>,
}

impl WholeFile {
    /// A file that will be at `path`, or where a link there points, with the permissions of the one that is there, which must be
    /// one that may be written to. What is there but no file (a pipe, a device) is written to as it is.
    ///
    /// # Errors
    ///
    /// When nothing can be written there. Like all errors of a whole file it begins with the file's name.
    pub fn create(path: &Path) -> io::Result<Self> {
        let path = end_of_links(path);
        let (part, file) = begin(&path).map_err(|e| named(&path, &e))?;
        Ok(Self {
            path,
            part,
            writer: BufWriter::new(file),
        })
    }

    /// Whether a file of this name is one that isn't whole yet, or that a killed process has left.
    #[must_use]
    pub fn is_part(name: &str) -> bool {
        name.starts_with(PART.0) && name.ends_with(PART.1)
    }

    /// Waits until what was written is on the disk, so that even a loss of power leaves the old file or the new one.
    ///
    /// # Errors
    ///
    /// When it cannot be written.
    pub fn sync(&mut self) -> io::Result<()> {
        self.flush()?;
        match self.part {
            Some(_) => self.writer.get_ref().sync_all(),
            None => Ok(()),
        }
        .map_err(|e| named(&self.path, &e))
    }

    /// Puts the file in its place, where it takes that of an older one.
    ///
    /// # Errors
    ///
    /// When it cannot be written or renamed.
    pub fn finish(mut self) -> io::Result<()> {
        self.flush()?;
        let Some(part) = &self.part else {
            return Ok(());
        };
        let mut parts = parts();
        fs::rename(part, &self.path).map_err(|e| named(&self.path, &e))?;
        // Its name is free for others from now on, and not ours to remove.
        parts.own.retain(|own| own != part);
        self.part = None;
        Ok(())
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
        parts.own.retain(|part| part != own);
    }
}

/// What is written to at first for a file at `path`, which is no link, and where that is if it is a part.
fn begin(path: &Path) -> io::Result<(Option<PathBuf>, File)> {
    let new = || {
        let (part, file) = parts().create(folder_of(path))?;
        Ok((Some(part), file))
    };
    let there = match fs::metadata(path) {
        Err(error) if error.kind() == ErrorKind::NotFound => return new(),
        Ok(there) if there.is_dir() => return Err(ErrorKind::IsADirectory.into()),
        there => there?,
    };
    // Who may write in the folder alone could put another file in the place of one that is protected.
    let own = File::options().write(true).open(path)?;
    if !there.is_file() {
        return Ok((None, own));
    }
    let (part, file) = new()?;
    // Before there is anything to read in it. Not all file systems have permissions.
    let _ = file.set_permissions(there.permissions());
    Ok((part, file))
}

/// A new file in the folder, locked, so that others see that somebody is at it.
fn new_part(folder: &Path) -> io::Result<(PathBuf, File)> {
    let (begin, end) = PART;
    for count in 0.. {
        let path = folder.join(format!("{begin}{}-{count}{end}", std::process::id()));
        let file = match File::create_new(&path) {
            // Another part of ours, or of a process of the same number on another machine.
            Err(error) if error.kind() == ErrorKind::AlreadyExists => continue,
            created => created?,
        };
        // Before it was locked, somebody who cleans up may have taken it for one that was left.
        let is_ours = !matches!(file.try_lock(), Err(TryLockError::WouldBlock));
        if is_ours && path.exists() {
            return Ok((path, file));
        }
    }
    Err(ErrorKind::AlreadyExists.into())
}

impl Parts {
    /// A new part in the folder.
    fn create(&mut self, folder: &Path) -> io::Result<(PathBuf, File)> {
        self.clean_up(folder);
        let (part, file) = new_part(folder)?;
        self.own.push(part.clone());
        Ok((part, file))
    }

    /// Removes the parts that killed processes have left in the folder: those that nobody holds. Once a folder.
    fn clean_up(&mut self, folder: &Path) {
        if !self.clean.insert(folder.to_owned()) {
            return;
        }
        // What cannot be cleaned up stays, and hinders nobody.
        for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
            let name = entry.file_name();
            let is_part = WholeFile::is_part(&name.to_string_lossy());
            if !is_part || !entry.file_type().is_ok_and(|kind| kind.is_file()) {
                continue;
            }
            // To write, without which network file systems lock nothing.
            if let Ok(file) = File::options().write(true).open(entry.path())
                && file.try_lock().is_ok()
            {
                let _ = fs::remove_file(entry.path());
            }
        }
    }
}

/// Tells before the work whether a file can be written at `path`.
///
/// # Errors
///
/// As of [`WholeFile::create`].
pub fn try_to_write(path: &Path) -> io::Result<()> {
    match fs::metadata(path) {
        // Who reads a pipe would take its closing for the end.
        Ok(there) if !there.is_file() && !there.is_dir() => Ok(()),
        // What is written is named so only at its end.
        Err(error) if error.kind() == ErrorKind::InvalidFilename => Err(named(path, &error)),
        _ => WholeFile::create(path).map(drop),
    }
}

/// How many links are followed, one to the next: as many as by Linux.
const MOST_LINKS: usize = 40;

/// The file that a path means: where a link there leads, in the end, also to a file that is not there yet. Without a link it is spelled as it
/// was, unless the file is there.
#[must_use]
pub fn end_of_links(path: &Path) -> PathBuf {
    if let Ok(there) = fs::canonicalize(path) {
        return there;
    }
    let mut path = path.to_owned();
    for _ in 0..MOST_LINKS {
        let Ok(next) = fs::read_link(&path) else {
            break;
        };
        path = folder_of(&path).join(next);
    }
    path
}

/// The error, beginning with the file's name.
#[must_use]
pub fn named(path: &Path, error: &io::Error) -> io::Error {
    io::Error::new(error.kind(), format!("{}: {error}", path.display()))
}

/// Writes a whole file at once.
///
/// # Errors
///
/// When it cannot be written; they begin with its name.
pub fn write_whole(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let mut file = WholeFile::create(path)?;
    file.write_all(bytes)?;
    file.finish()
}

/// The folder of a file, `.` where its path is a mere name.
#[must_use]
pub fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
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
    #[cfg(unix)]
    fn what_a_link_points_to_need_not_be_there() {
        use std::os::unix::fs::symlink;
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        fs::create_dir(path("sub")).unwrap();
        symlink("sub/first", path("link")).unwrap();
        symlink("second", path("sub/first")).unwrap();
        write_whole(&path("link"), b"new").unwrap();
        assert_eq!(fs::read(path("sub/second")).unwrap(), b"new");
        for link in ["link", "sub/first"] {
            assert!(fs::symlink_metadata(path(link)).unwrap().is_symlink());
        }

        // A link that leads nowhere is no file to replace.
        for (link, points_to) in [("away", "none/file"), ("round", "round")] {
            symlink(points_to, path(link)).unwrap();
            assert!(write_whole(&path(link), b"lost").is_err(), "{link}");
            assert!(fs::symlink_metadata(path(link)).unwrap().is_symlink());
        }
    }

    #[test]
    #[expect(clippy::print_stderr, reason = "skipped tests say so")]
    fn a_protected_file_stays() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.txt");
        fs::write(&path, "mine").unwrap();
        let mut permissions = fs::metadata(&path).unwrap().permissions();
        permissions.set_readonly(true);
        fs::set_permissions(&path, permissions).unwrap();
        // Who is root may write everywhere.
        if File::options().write(true).open(&path).is_ok() {
            return eprintln!("SKIPPED 1 test: nothing is protected from root");
        }
        for tried in [try_to_write(&path), write_whole(&path, b"new")] {
            assert_eq!(tried.unwrap_err().kind(), ErrorKind::PermissionDenied);
        }
        assert_eq!(fs::read(&path).unwrap(), b"mine");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
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
        let is_left = |part: &PathBuf| part.starts_with(folder.path());
        assert!(!parts().own.iter().any(is_left));
    }

    #[test]
    #[cfg(unix)]
    fn permissions_stay() {
        use std::os::unix::fs::PermissionsExt as _;
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.txt");
        fs::write(&path, "old").unwrap();
        for mode in [0o600, 0o640, 0o755] {
            fs::set_permissions(&path, fs::Permissions::from_mode(mode)).unwrap();
            let mut file = WholeFile::create(&path).unwrap();
            file.write_all(b"new").unwrap();
            file.sync().unwrap();
            file.finish().unwrap();
            assert_eq!(
                fs::metadata(&path).unwrap().permissions().mode() & 0o777,
                mode
            );
        }
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

    #[test]
    fn parts_that_nobody_holds_are_cleaned_up() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        for name in [
            ".inkstrand-1-0.part",
            ".inkstrand-1-1.part",
            "mine.part",
            ".a.png.1.part",
        ] {
            fs::write(path(name), "half").unwrap();
        }
        let held = File::open(path(".inkstrand-1-1.part")).unwrap();
        held.lock().unwrap();
        write_whole(&path("a.txt"), b"whole").unwrap();
        assert!(!path(".inkstrand-1-0.part").exists());
        for name in [".inkstrand-1-1.part", "mine.part", ".a.png.1.part", "a.txt"] {
            assert!(path(name).exists(), "{name}");
        }
    }

    #[test]
    fn a_name_may_be_as_long_as_the_file_system_allows() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("n".repeat(255));
        write_whole(&path, b"x").unwrap();
        assert_eq!(fs::read(path).unwrap(), b"x");
    }
}
