//! A text file that an author edits: edits with undo, the file on disk watched, saving that loses nobody's change, a recovery
//! copy that outlives a crash. Knows nothing of what is in the text, and of no window.
//!
//! ```
//! use document::{Document, Recovery};
//!
//! let folder = tempfile::tempdir()?;
//! let path = folder.path().join("look.ron");
//! std::fs::write(&path, "(seed: 1)")?;
//!
//! let mut document = Document::open(&path, &Recovery::none())?;
//! // A drag: one step, however many values it goes through.
//! document.edit("(seed: 2)".into(), Some(7));
//! document.edit("(seed: 3)".into(), Some(7));
//! assert!(document.is_changed());
//! document.save()?;
//! assert_eq!(std::fs::read_to_string(&path)?, "(seed: 3)");
//! document.undo();
//! assert_eq!(&**document.text(), "(seed: 1)");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod disk;
mod history;
mod recovery;
mod watch;

use disk::{Disk, MARK, Seen};
use hair_io::{ReadError, WholeFile};
use history::History;
pub use history::Step;
use recovery::Copy;
pub use recovery::{Recovered, Recovery};
use std::fs::{self, File};
use std::io::{self, ErrorKind, Write as _};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use watch::Watch;

/// A text file that an author edits. Its text has no byte order mark, and its lines end as they do in the file; a mark that
/// the file has stays there.
///
/// Dropped with unsaved changes it leaves its recovery copy; [`Document::close`] doesn't.
pub struct Document {
    path: PathBuf,
    text: Arc<str>,
    version: u64,
    /// Whether the file begins with a byte order mark.
    marked: bool,
    history: History,
    /// What the author knows to be on the disk; `None` where there is no file, and he knows.
    base: Option<Arc<str>>,
    conflict: Option<Conflict>,
    /// Whether the file as it is in a conflict begins with a mark.
    theirs_marked: bool,
    seen: Seen,
    watch: Watch,
    recovery: Recovery,
    copy: Option<Copy>,
    /// The version that was copied last, or could not be.
    copied: Option<u64>,
    copy_error: Option<String>,
    /// Copies of this file that a crash has left, the newest first.
    recovered: Vec<Recovered>,
}

/// What happened to the file on the disk.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum DiskChange {
    /// It has another text, and there were no unsaved changes: the document has that text now. Can be undone.
    Reloaded,
    /// It has another text, and there are unsaved changes: see [`Document::conflict`].
    Conflict,
    /// It is no longer there. The document has its text still; see [`Document::conflict`].
    Deleted,
    /// It is as it was last read or saved, after it was not, or as the document's text is.
    Back,
    /// It cannot be read now; why. The document has its text still.
    Unreadable(String),
}

/// The file is not what was last read or saved, and neither side may get lost.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Conflict {
    /// It has this text.
    Changed {
        /// The file's text.
        on_disk: Arc<str>,
    },
    /// It is no longer there.
    Deleted,
}

/// Why a file was not opened.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum OpenError {
    /// It cannot be read, is too large, or no UTF-8 text.
    #[error(transparent)]
    Read(#[from] ReadError),
}

/// Why a document was not saved. It has its changes still.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SaveError {
    /// The file was changed or deleted since it was read: see [`Document::conflict`].
    #[error("{}: the file was changed or deleted since it was read", .0.display())]
    Conflict(PathBuf),
    /// There is a file of that name already.
    #[error("{}: there is such a file already", .0.display())]
    Exists(PathBuf),
    /// What is there cannot be read, so that nobody knows what would be lost.
    #[error(transparent)]
    Read(#[from] ReadError),
    /// It cannot be written; the message begins with the file's name.
    #[error("{0}")]
    Write(io::Error),
}

impl Document {
    /// Opens a text file of at most [`hair_io::MOST_OF_TEXT`] bytes, watches it, and looks for what a crash has left of it. Of a
    /// file that is no longer there the newest copy is opened, as it was before the crash: in conflict with the disk.
    ///
    /// # Errors
    ///
    /// When it cannot be read, or is no longer there and no crash has left anything of it.
    pub fn open(path: &Path, recovery: &Recovery) -> Result<Self, OpenError> {
        // Watched first: what happens between is told.
        let watch = Watch::new(path);
        let mut seen = Seen::default();
        let read = seen.read_file(path);
        let base = read.as_ref().ok().map(|(text, _)| text.clone());
        let recovered = recovery.find(path, base.as_deref());
        let (text, marked) = match (read, recovered.first()) {
            (Err(error), Some(newest)) if disk::is_gone(&error) => (newest.text.clone(), false),
            (read, _) => read?,
        };
        let mut document = Self {
            path: path.to_owned(),
            base,
            text,
            version: 0,
            marked,
            history: History::default(),
            conflict: None,
            theirs_marked: marked,
            seen,
            watch,
            recovery: recovery.clone(),
            copy: None,
            copied: None,
            copy_error: None,
            recovered,
        };
        if document.base.is_none() {
            document.conflict = Some(Conflict::Deleted);
            let newest = document.recovered.remove(0);
            document.replace_copy(newest);
        }
        Ok(document)
    }

    /// The file, as it was named.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The file's name without its folder.
    #[must_use]
    pub fn name(&self) -> String {
        let name = self.path.file_name().unwrap_or_default();
        name.to_string_lossy().into_owned()
    }

    /// The text as it is edited.
    #[must_use]
    pub fn text(&self) -> &Arc<str> {
        &self.text
    }

    /// Another number after each change of the text, larger than before.
    #[must_use]
    pub fn version(&self) -> u64 {
        self.version
    }

    /// Whether the text is another one than was last read or saved, or than its file has now, or there is no file any more.
    #[must_use]
    pub fn is_changed(&self) -> bool {
        self.conflict.is_some() || self.was_edited()
    }

    /// Whether the text is another one than was last read or saved.
    #[must_use]
    pub fn was_edited(&self) -> bool {
        let is_same = |base: &Arc<str>| Arc::ptr_eq(base, &self.text) || *base == self.text;
        !self.base.as_ref().is_some_and(is_same)
    }

    /// Whether it has what a file has not: then it wants a copy.
    fn has_own(&self) -> bool {
        self.conflict == Some(Conflict::Deleted) || self.was_edited()
    }

    /// Changes the text. Edits one after the other with the same `gesture`, such as those of a drag, are one step of undo.
    /// The text that is there already is no edit.
    pub fn edit(&mut self, text: String, gesture: Option<u64>) -> Step {
        if *text == *self.text {
            return Step::None;
        }
        let step = self.history.edit(&self.text, &text, gesture);
        self.take(text.into());
        step
    }

    /// Goes back a step; whether there was one.
    pub fn undo(&mut self) -> bool {
        let text = self.history.undo(&self.text);
        text.map(|text| self.take(text)).is_some()
    }

    /// Goes forward to the step that was last undone; whether there was one.
    pub fn redo(&mut self) -> bool {
        let text = self.history.redo(&self.text);
        text.map(|text| self.take(text)).is_some()
    }

    /// Whether there is a step to go back.
    #[must_use]
    pub fn can_undo(&self) -> bool {
        self.history.can_undo()
    }

    /// Whether there is a step to go forward.
    #[must_use]
    pub fn can_redo(&self) -> bool {
        self.history.can_redo()
    }

    fn take(&mut self, text: Arc<str>) {
        self.text = text;
        self.version += 1;
    }

    /// What happened to the file since the last call, if anything did. Cheap: the file is read only after a change of it was
    /// told, or its time or size is another one, which is looked at by calls a second apart where nobody watches (else five).
    pub fn poll(&mut self) -> Option<DiskChange> {
        if !self.watch.was_told(|| self.seen.is_outdated(&self.path)) {
            return None;
        }
        let was = self.seen.problem.clone();
        match self.seen.read(&self.path) {
            Disk::Text(text, marked) => self.found(text, marked, was.is_some()),
            Disk::Gone => {
                let is_news = was.as_ref() != self.seen.problem.as_ref();
                if is_news && self.base.is_some() {
                    self.conflict = Some(Conflict::Deleted);
                }
                is_news.then_some(DiskChange::Deleted)
            }
            Disk::Unreadable(error) => {
                let is_news = was.as_ref() != self.seen.problem.as_ref();
                is_news.then(|| DiskChange::Unreadable(error.to_string()))
            }
        }
    }

    /// The file has this text; `was_lost` where it was not there, or not to be read, before.
    fn found(&mut self, text: Arc<str>, marked: bool, was_lost: bool) -> Option<DiskChange> {
        if self.base.as_ref() == Some(&text) || self.text == text {
            self.base = Some(text);
            self.marked = marked;
            let had_conflict = self.conflict.take().is_some();
            return (had_conflict || was_lost).then_some(DiskChange::Back);
        }
        if !self.was_edited() {
            self.conflict = None;
            self.take_over(text, marked);
            return Some(DiskChange::Reloaded);
        }
        let conflict = Some(Conflict::Changed { on_disk: text });
        self.theirs_marked = marked;
        if self.conflict == conflict {
            return None;
        }
        self.conflict = conflict;
        Some(DiskChange::Conflict)
    }

    /// The file's text, as a step that can be undone.
    fn take_over(&mut self, text: Arc<str>, marked: bool) {
        self.base = Some(text.clone());
        self.marked = marked;
        if text != self.text {
            self.history.edit(&self.text, &text, None);
            self.take(text);
        }
    }

    /// What is on the disk in place of what was last read, until the author has chosen.
    #[must_use]
    pub fn conflict(&self) -> Option<&Conflict> {
        self.conflict.as_ref()
    }

    /// The document's text is the one to keep: saving it replaces the file as it is now, or makes it again.
    pub fn keep_mine(&mut self) {
        match self.conflict.take() {
            Some(Conflict::Changed { on_disk }) => self.base = Some(on_disk),
            Some(Conflict::Deleted) => self.base = None,
            None => {}
        }
    }

    /// The file's text is the one to keep; the document's own can be had again by undo. Where the file was deleted there is
    /// nothing to take, and nothing changes.
    pub fn take_theirs(&mut self) {
        if let Some(Conflict::Changed { on_disk }) = &self.conflict {
            let text = on_disk.clone();
            self.conflict = None;
            self.take_over(text, self.theirs_marked);
        }
    }

    /// Writes the file: whole or not at all, with the permissions that it has. Nothing is written where it has the text
    /// already.
    ///
    /// # Errors
    ///
    /// When the file is not what was last read or saved, which is a conflict from then on, or it cannot be written.
    pub fn save(&mut self) -> Result<(), SaveError> {
        match self.seen.read(&self.path) {
            Disk::Unreadable(error) => return Err(error.into()),
            Disk::Gone if self.base.is_some() => {
                self.conflict = Some(Conflict::Deleted);
                return Err(SaveError::Conflict(self.path.clone()));
            }
            Disk::Gone => self.write()?,
            Disk::Text(on_disk, _) if on_disk == self.text => self.saved(),
            Disk::Text(on_disk, marked) if self.base.as_ref() != Some(&on_disk) => {
                self.theirs_marked = marked;
                self.conflict = Some(Conflict::Changed { on_disk });
                return Err(SaveError::Conflict(self.path.clone()));
            }
            Disk::Text(..) => self.write()?,
        }
        Ok(())
    }

    /// Writes a new file, which is the document's from then on.
    ///
    /// # Errors
    ///
    /// When there is such a file, or it cannot be written; then the document has its old file still.
    pub fn save_as(&mut self, path: &Path) -> Result<(), SaveError> {
        if fs::symlink_metadata(path).is_ok() {
            return Err(SaveError::Exists(path.to_owned()));
        }
        self.save_over(path)
    }

    /// Writes a file, which is the document's from then on, whatever is there.
    ///
    /// # Errors
    ///
    /// When it cannot be written; then the document has its old file still.
    pub fn save_over(&mut self, path: &Path) -> Result<(), SaveError> {
        let old = std::mem::replace(&mut self.path, path.to_owned());
        if let Err(error) = self.write() {
            self.path = old;
            return Err(error);
        }
        self.watch.watch(path);
        Ok(())
    }

    fn write(&mut self) -> Result<(), SaveError> {
        self.write_file().map_err(SaveError::Write)?;
        self.saved();
        // It is what was written, or somebody else was quicker: the next look tells.
        self.seen.note(&self.path);
        self.seen.problem = None;
        Ok(())
    }

    fn write_file(&self) -> io::Result<()> {
        // Renaming would replace it in spite of its permissions.
        if let Err(error) = File::options().write(true).open(&self.path)
            && error.kind() != ErrorKind::NotFound
        {
            return Err(hair_io::named(&self.path, &error));
        }
        if fs::metadata(&self.path).is_ok_and(|file| file.permissions().readonly()) {
            let error = io::Error::new(ErrorKind::PermissionDenied, "the file is read-only");
            return Err(hair_io::named(&self.path, &error));
        }
        let mut file = WholeFile::create(&self.path)?;
        if self.marked {
            file.write_all(MARK.as_bytes())?;
        }
        file.write_all(self.text.as_bytes())?;
        file.sync()?;
        file.finish()
    }

    /// The file has the text.
    fn saved(&mut self) {
        self.base = Some(self.text.clone());
        self.conflict = None;
        self.copy = None;
        self.copied = None;
        self.history.end_gesture();
    }

    /// Keeps a recovery copy of unsaved changes, where the text is another one than that of the last call, and removes it
    /// where there are none. To be called at most about once a second, while [`Self::wants_recovery_copy`] says so.
    pub fn keep_recovery_copy(&mut self) {
        if !self.has_own() {
            self.copy = None;
            self.copied = None;
            self.copy_error = None;
            return;
        }
        self.copied = Some(self.version);
        let kept = match &mut self.copy {
            Some(copy) => copy.keep(&self.path, &self.text),
            None => match self.recovery.new_copy() {
                Ok(None) => return,
                Ok(Some(copy)) => self.copy.insert(copy).keep(&self.path, &self.text),
                Err(error) => Err(error),
            },
        };
        self.copy_error = kept.err().map(|error| error.to_string());
    }

    /// Whether [`Self::keep_recovery_copy`] has something to do. A copy that could not be written is wanted again after the next edit.
    #[must_use]
    pub fn wants_recovery_copy(&self) -> bool {
        match self.has_own() {
            true => self.recovery.folder().is_some() && self.copied != Some(self.version),
            false => self.copy.is_some(),
        }
    }

    /// Why the last recovery copy could not be written.
    #[must_use]
    pub fn recovery_error(&self) -> Option<&str> {
        self.copy_error.as_deref()
    }

    /// The newest text that a crash has left of this file, and the file doesn't have.
    #[must_use]
    pub fn recovered(&self) -> Option<&Recovered> {
        self.recovered.first()
    }

    /// Takes the text over, as a step that can be undone; the next older copy is [`Document::recovered`] from then on.
    pub fn accept_recovered(&mut self) -> Step {
        if self.recovered.is_empty() {
            return Step::None;
        }
        let recovered = self.recovered.remove(0);
        let step = self.edit(recovered.text.to_string(), None);
        self.replace_copy(recovered);
        step
    }

    /// Removes a copy whose text is the document's now, but not before this process has a copy of its own.
    fn replace_copy(&mut self, recovered: Recovered) {
        self.keep_recovery_copy();
        if self.copy.is_some() && self.copy_error.is_none() {
            recovered.remove();
        }
    }

    /// Removes the copy; the next older one is [`Document::recovered`] from then on.
    pub fn discard_recovered(&mut self) {
        if !self.recovered.is_empty() {
            self.recovered.remove(0).remove();
        }
    }

    /// What is called, in another thread, when the file may have changed, so that somebody polls. `None` for nobody. It must
    /// not wait for the thread that has the document.
    pub fn on_change(&mut self, callback: Option<Box<dyn Fn() + Send>>) {
        self.watch.on_change(callback);
    }

    /// Whether the file's folder is watched. Where it can't be, nobody is called, and changes are found by [`Document::poll`]
    /// alone, about a second later.
    #[must_use]
    pub fn is_watched(&self) -> bool {
        self.watch.is_on()
    }

    /// Ends the work on it, with unsaved changes gone and no recovery copy left.
    pub fn close(mut self) {
        self.copy = None;
    }
}

impl Drop for Document {
    fn drop(&mut self) {
        if let Some(copy) = self.copy.take().filter(|_| self.has_own()) {
            copy.leave();
        }
    }
}
