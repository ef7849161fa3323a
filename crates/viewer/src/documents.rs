//! The texts that are edited: the preset, and the style and script that it names.

use crate::edit::{Edit, Place};
use document::{Conflict, DiskChange, Document, OpenError, Recovery, SaveError};
use effects::preset::edit;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Which of the texts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Which {
    /// The preset.
    Preset,
    /// The hair style that it names.
    Style,
    /// The motion script that it names.
    Motion,
}

impl Which {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Preset, Self::Style, Self::Motion];

    /// What it is called.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Preset => "Preset",
            Self::Style => "Style",
            Self::Motion => "Motion",
        }
    }
}

/// The most steps of undo that are kept, as a text keeps them.
const MOST_STEPS: usize = 3000;

/// A step of undo.
#[derive(Clone, Copy, PartialEq)]
struct Step {
    which: Which,
    gesture: Option<u64>,
}

/// The texts that are open.
pub struct Documents {
    open: BTreeMap<Which, Document>,
    recovery: Recovery,
    wake: Arc<dyn Fn() + Send + Sync>,
    /// The texts of the steps that can be taken back, the last one last, and of those that were.
    undo: Vec<Step>,
    redo: Vec<Which>,
    /// Why the style or script that the preset names is not open.
    pub troubles: BTreeMap<Which, String>,
}

impl Documents {
    /// Opens a preset, and the style and script that it names. `wake` is called, from other threads too, when a file changes on the disk.
    ///
    /// # Errors
    ///
    /// When the preset cannot be read.
    pub fn open(
        preset: &Path,
        recovery: Recovery,
        wake: Arc<dyn Fn() + Send + Sync>,
    ) -> Result<Self, OpenError> {
        let mut documents = Self {
            open: BTreeMap::new(),
            recovery,
            wake,
            undo: Vec::new(),
            redo: Vec::new(),
            troubles: BTreeMap::new(),
        };
        let preset = documents.read(preset)?;
        documents.open.insert(Which::Preset, preset);
        documents.follow_names();
        Ok(documents)
    }

    fn read(&self, path: &Path) -> Result<Document, OpenError> {
        let mut document = Document::open(path, &self.recovery)?;
        let wake = self.wake.clone();
        document.on_change(Some(Box::new(move || wake())));
        Ok(document)
    }

    /// The preset.
    #[must_use]
    pub fn preset(&self) -> &Document {
        &self.open[&Which::Preset]
    }

    /// One of the texts, where there is such.
    #[must_use]
    pub fn get(&self, which: Which) -> Option<&Document> {
        self.open.get(&which)
    }

    /// The same, to be changed.
    pub fn get_mut(&mut self, which: Which) -> Option<&mut Document> {
        self.open.get_mut(&which)
    }

    /// All texts that are open.
    pub fn all(&self) -> impl Iterator<Item = (Which, &Document)> {
        self.open.iter().map(|(which, document)| (*which, document))
    }

    /// The folder of the preset.
    #[must_use]
    pub fn folder(&self) -> PathBuf {
        let path = self.preset().path();
        path.parent().unwrap_or(Path::new("")).to_owned()
    }

    /// Styles and scripts as they are edited, in place of those on the disk.
    #[must_use]
    pub fn texts(&self) -> BTreeMap<PathBuf, Arc<str>> {
        let beside = self.all().filter(|(which, _)| *which != Which::Preset);
        beside
            .map(|(_, document)| (document.path().to_owned(), document.text().clone()))
            .collect()
    }

    /// Whether anything is not saved.
    #[must_use]
    pub fn is_changed(&self) -> bool {
        self.open.values().any(Document::is_changed)
    }

    /// Whether the system tells when a file changes on the disk; else somebody has to look.
    #[must_use]
    pub fn is_watched(&self) -> bool {
        self.open.values().all(Document::is_watched)
    }

    /// Makes the changes, one after the other. Those of one `gesture` are one step of undo.
    ///
    /// # Errors
    ///
    /// When one cannot be made; those before it stay.
    pub fn apply(
        &mut self,
        which: Which,
        edits: &[Edit],
        gesture: Option<u64>,
    ) -> Result<(), String> {
        for edit in edits {
            let Some(document) = self.open.get_mut(&which) else {
                return Ok(());
            };
            let text = edit
                .apply(document.text())
                .map_err(|error| error.to_string())?;
            document.edit(text, gesture);
            self.note(which, gesture);
        }
        if which == Which::Preset {
            self.follow_names();
        }
        Ok(())
    }

    /// A text was written by hand.
    pub fn write(&mut self, which: Which, text: String, gesture: Option<u64>) {
        if let Some(document) = self.open.get_mut(&which) {
            document.edit(text, gesture);
            self.note(which, gesture);
        }
        if which == Which::Preset {
            self.follow_names();
        }
    }

    /// Notes a step of undo, where it is another one than the last.
    fn note(&mut self, which: Which, gesture: Option<u64>) {
        let step = Step { which, gesture };
        if gesture.is_none() || self.undo.last() != Some(&step) {
            self.undo.push(step);
        }
        if self.undo.len() > MOST_STEPS {
            self.undo.remove(0);
        }
        self.redo.clear();
    }

    /// Takes the last change of any of the texts back. Whether there was one.
    pub fn undo(&mut self) -> bool {
        while let Some(Step { which, .. }) = self.undo.pop() {
            if self.open.get_mut(&which).is_some_and(Document::undo) {
                self.redo.push(which);
                return true;
            }
        }
        // What was taken from the disk.
        let mut texts = self.open.iter_mut();
        let done = texts.find_map(|(which, document)| document.undo().then_some(*which));
        self.redo.extend(done);
        done.is_some()
    }

    /// Makes the change again that was taken back last. Whether there was one.
    pub fn redo(&mut self) -> bool {
        let Some(which) = self.redo.pop() else {
            return false;
        };
        self.undo.push(Step {
            which,
            gesture: None,
        });
        self.open.get_mut(&which).is_some_and(Document::redo)
    }

    /// Opens the style and script that the preset names now. One with changes that are not saved stays open until they are.
    pub fn follow_names(&mut self) {
        for (which, section, ending) in [
            (Which::Style, "hair", ".style.ron"),
            (Which::Motion, "motion", ".ron"),
        ] {
            let place = Place::top().field(section).field("file");
            let named = edit::get(self.preset().text(), &place.steps()).and_then(unquoted);
            let named = named.filter(|name| name.ends_with(ending));
            let path = named.map(|name| self.folder().join(name));
            let there = self.open.get(&which);
            if there.map(Document::path) == path.as_deref() && there.is_some() {
                continue;
            }
            if there.is_some_and(Document::is_changed) {
                continue;
            }
            self.open.remove(&which);
            self.troubles.remove(&which);
            let Some(path) = path else { continue };
            match self.read(&path) {
                Ok(document) => {
                    self.open.insert(which, document);
                }
                Err(error) => {
                    self.troubles.insert(which, error.to_string());
                }
            }
        }
    }

    /// Takes on what has changed on the disk; what is to be told of it.
    pub fn poll(&mut self) -> Vec<String> {
        let mut told = Vec::new();
        let mut reloaded = false;
        for document in self.open.values_mut() {
            let Some(change) = document.poll() else {
                continue;
            };
            let name = document.name();
            told.push(match change {
                DiskChange::Reloaded => {
                    reloaded = true;
                    format!("{name} was changed on the disk, and read again")
                }
                DiskChange::Conflict => {
                    format!("{name} was changed on the disk, and here: choose what to keep")
                }
                DiskChange::Deleted => format!("{name} is no more on the disk; saving writes it"),
                DiskChange::Back => format!("{name} is back on the disk"),
                DiskChange::Unreadable(why) => format!("{name} cannot be read: {why}"),
                _ => continue,
            });
        }
        if reloaded {
            self.follow_names();
        }
        told
    }

    /// Writes all that is not saved, also what is no more on the disk. What could be written is; the errors of the others.
    pub fn save(&mut self) -> Vec<SaveError> {
        let changed = self
            .open
            .values_mut()
            .filter(|document| document.is_changed());
        let saved = changed.map(|document| {
            if document.conflict() == Some(&Conflict::Deleted) {
                document.keep_mine();
            }
            document.save()
        });
        let errors = saved.filter_map(Result::err).collect();
        self.follow_names();
        errors
    }

    /// Looks again for the style and script that could not be opened.
    pub fn look_again(&mut self) {
        if !self.troubles.is_empty() {
            self.follow_names();
        }
    }

    /// Writes the preset under another name, which is its own from then on. Its style and script are those that it named before: their names
    /// are relative to its folder, so it stays there.
    ///
    /// # Errors
    ///
    /// When the name is in another folder, or there is such a file, or it cannot be written.
    pub fn save_preset_as(&mut self, path: &Path) -> Result<(), String> {
        let whole = |path: &Path| std::fs::canonicalize(path.parent().unwrap_or(path)).ok();
        if whole(path) != whole(self.preset().path()) {
            return Err(format!(
                "the files that a preset names are relative to it: save it in {}",
                self.folder().display()
            ));
        }
        let preset = self.open.get_mut(&Which::Preset);
        let saved = preset.map(|preset| preset.save_as(path).map_err(|error| error.to_string()));
        saved.unwrap_or(Ok(()))
    }

    /// Ends a conflict: keeps what is here, or takes what is on the disk.
    pub fn resolve(&mut self, which: Which, keeps_mine: bool) {
        if let Some(document) = self.open.get_mut(&which) {
            match keeps_mine {
                true => document.keep_mine(),
                false => document.take_theirs(),
            }
        }
        self.follow_names();
    }

    /// Why copies that would outlive a crash cannot be kept.
    #[must_use]
    pub fn recovery_error(&self) -> Option<&str> {
        self.open.values().find_map(Document::recovery_error)
    }

    /// Takes on the copy of a text that a crash has left, as a step of undo.
    pub fn accept_recovered(&mut self, which: Which) {
        if let Some(document) = self.open.get_mut(&which) {
            document.accept_recovered();
            self.note(which, None);
        }
        self.follow_names();
    }

    /// Throws the copy of a text away.
    pub fn discard_recovered(&mut self, which: Which) {
        if let Some(document) = self.open.get_mut(&which) {
            document.discard_recovered();
        }
    }

    /// Throws all changes away, with the copies that would outlive a crash, and closes the texts.
    pub fn close(self) {
        self.open.into_values().for_each(Document::close);
    }

    /// Keeps copies that outlive a crash.
    pub fn keep_recovery_copies(&mut self) {
        for document in self.open.values_mut() {
            document.keep_recovery_copy();
        }
    }
}

/// The text between a RON text's quotes, where it has no escapes.
fn unquoted(text: &str) -> Option<&str> {
    let inside = text.strip_prefix('"')?.strip_suffix('"')?;
    (!inside.is_empty() && !inside.contains('\\')).then_some(inside)
}
