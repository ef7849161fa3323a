//! Recovery copies: unsaved texts of documents, beside which a lock says whether their process is alive.
//!
//! A copy `PROCESS-COUNT.recovery` is one line with the file that it is of, then the text. While the document is open its
//! process holds the lock of `PROCESS-COUNT.lock`; the system lets go of it when the process ends, however that happens.

use hair_io::{MOST_OF_TEXT, read_bytes, write_whole};
use std::fs::{self, File, TryLockError};
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::SystemTime;
use std::{env, process};

/// How a copy begins, before the name of its file.
const BEGINNING: &str = "inkstrand recovery copy of ";
const COPY: &str = "recovery";
const LOCK: &str = "lock";

/// Where recovery copies are kept: a folder, by default `inkstrand/recovery` in the user's folder for the state of programs.
#[derive(Clone, Debug)]
pub struct Recovery {
    folder: Option<PathBuf>,
}

impl Default for Recovery {
    fn default() -> Self {
        Self {
            folder: state_folder().map(|folder| folder.join("inkstrand").join("recovery")),
        }
    }
}

/// The user's folder for the state of programs.
fn state_folder() -> Option<PathBuf> {
    let given = |name| {
        env::var_os(name)
            .map(PathBuf::from)
            .filter(|path| path.is_absolute())
    };
    if cfg!(windows) {
        return given("LOCALAPPDATA");
    }
    let home = || env::home_dir().filter(|home| home.is_absolute());
    if cfg!(target_os = "macos") {
        return Some(home()?.join("Library").join("Application Support"));
    }
    given("XDG_STATE_HOME").or_else(|| Some(home()?.join(".local").join("state")))
}

/// A text that a crash has left of a file.
#[derive(Clone, Debug)]
pub struct Recovered {
    /// The text.
    pub text: Arc<str>,
    /// When it was written.
    pub when: SystemTime,
    /// Whether the file was written after that.
    pub is_older_than_file: bool,
    copy: PathBuf,
}

impl Recovered {
    pub(crate) fn remove(self) {
        // A copy that cannot be removed is offered again.
        let _ = fs::remove_file(&self.copy);
    }
}

impl Recovery {
    /// Copies in this folder, which is made when there is one.
    #[must_use]
    pub fn in_folder(folder: &Path) -> Self {
        Self {
            folder: Some(folder.to_owned()),
        }
    }

    /// No copies.
    #[must_use]
    pub fn none() -> Self {
        Self { folder: None }
    }

    /// Where copies are kept, if they are.
    #[must_use]
    pub fn folder(&self) -> Option<&Path> {
        self.folder.as_deref()
    }

    /// The copies of a file whose processes are gone, the newest first. Those that have its text, where it has one, are removed.
    pub(crate) fn find(&self, path: &Path, text: Option<&str>) -> Vec<Recovered> {
        let mut found = Vec::new();
        let Some(entries) = self.folder().and_then(|folder| fs::read_dir(folder).ok()) else {
            return found;
        };
        let written = fs::metadata(path).and_then(|file| file.modified()).ok();
        let first_line = first_line(path);
        // What cannot be read is nothing that could be offered, now.
        for copy in entries.flatten().map(|entry| entry.path()) {
            if copy.extension().is_none_or(|ending| ending != COPY) {
                continue;
            }
            let Some((left, when)) = read_copy(&copy, &first_line) else {
                continue;
            };
            let Some(_lock) = lock_of_dead(&copy) else {
                continue;
            };
            let recovered = Recovered {
                is_older_than_file: written.is_some_and(|written| when < written),
                when,
                copy,
                text: left.into(),
            };
            if text.is_some_and(|text| *recovered.text == *text) {
                recovered.remove();
            } else {
                found.push(recovered);
            }
        }
        found.sort_by_key(|recovered| std::cmp::Reverse(recovered.when));
        found
    }

    /// A place for a copy of this process, if there are any.
    pub(crate) fn new_copy(&self) -> io::Result<Option<Copy>> {
        self.folder().map(Copy::new).transpose()
    }
}

/// The text of a copy of the file that the line names, and when it was written.
fn read_copy(copy: &Path, first_line: &str) -> Option<(String, SystemTime)> {
    let most = MOST_OF_TEXT + first_line.len() as u64;
    let when = fs::metadata(copy).and_then(|file| file.modified()).ok()?;
    let text = String::from_utf8(read_bytes(copy, most).ok()?).ok()?;
    Some((text.strip_prefix(first_line)?.to_owned(), when))
}

/// Removes the lock of a copy whose process is gone; `None` if it is not. As long as the answer is held, nobody else looks.
fn lock_of_dead(copy: &Path) -> Option<Option<File>> {
    let path = copy.with_extension(LOCK);
    let lock = match File::options().write(true).open(&path) {
        Ok(lock) => lock,
        Err(error) if error.kind() == ErrorKind::NotFound => return Some(None),
        Err(_) => return None,
    };
    if matches!(lock.try_lock(), Err(TryLockError::WouldBlock)) {
        return None;
    }
    let _ = fs::remove_file(&path); // left, it says the same
    Some(Some(lock))
}

/// What a copy of the file begins with: its one path, however it is spelled, on one line.
fn first_line(path: &Path) -> String {
    let whole = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    // One that was deleted is called as it was while it was there.
    let beside = || {
        Some(
            fs::canonicalize(whole.parent()?)
                .ok()?
                .join(whole.file_name()?),
        )
    };
    let place = fs::canonicalize(path).ok().or_else(beside).unwrap_or(whole);
    format!("{BEGINNING}{place:?}\n")
}

/// The copy of a document of this process. Dropped it is removed.
pub(crate) struct Copy {
    path: PathBuf,
    /// Held as long as the document is open.
    lock: File,
    /// What was last written.
    kept: Option<(PathBuf, Arc<str>)>,
    leave: bool,
}

impl Copy {
    fn new(folder: &Path) -> io::Result<Self> {
        fs::create_dir_all(folder).map_err(|e| hair_io::named(folder, &e))?;
        for count in 0.. {
            let name = format!("{}-{count}.{COPY}", process::id());
            let path = folder.join(name);
            let lock = path.with_extension(LOCK);
            // An older process may have had the same number.
            if path.exists() {
                continue;
            }
            match File::create_new(&lock) {
                Ok(file) => {
                    // Where nothing can be locked, copies are taken for those of dead processes: better than never.
                    let _ = file.try_lock();
                    return Ok(Self {
                        path,
                        lock: file,
                        kept: None,
                        leave: false,
                    });
                }
                Err(error) if error.kind() == ErrorKind::AlreadyExists => {}
                Err(error) => return Err(hair_io::named(&lock, &error)),
            }
        }
        Err(ErrorKind::AlreadyExists.into())
    }

    /// Writes the text, unless it was the last one written.
    pub fn keep(&mut self, of: &Path, text: &Arc<str>) -> io::Result<()> {
        let is_kept = |(path, kept): &(PathBuf, Arc<str>)| path == of && kept == text;
        if self.kept.as_ref().is_some_and(is_kept) {
            return Ok(());
        }
        write_whole(&self.path, (first_line(of) + text).as_bytes())?;
        self.kept = Some((of.to_owned(), text.clone()));
        Ok(())
    }

    /// Leaves the copy, for whoever opens the file next.
    pub fn leave(mut self) {
        self.leave = true;
    }
}

impl Drop for Copy {
    fn drop(&mut self) {
        // Nobody is left to tell; what stays is offered when the file is opened.
        if !self.leave {
            let _ = fs::remove_file(&self.path);
        }
        let _ = fs::remove_file(self.path.with_extension(LOCK));
        let _ = self.lock.unlock();
    }
}
