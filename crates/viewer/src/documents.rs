//! The texts that are edited: the preset, and the style and script that it, or its base, names.

use crate::edit::{Edit, Place};
use document::{Conflict, DiskChange, Document, OpenError, Recovery, SaveError, Step};
use effects::preset::edit;
use std::collections::{BTreeMap, BTreeSet};
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
/// The most presets that are looked at of a chain, each the base of the one before.
const MOST_BASES: usize = 16;

/// Which of all texts that were open since the preset is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Id(u64);

/// The texts that are open, and those that the preset named before: these keep their changes and steps, for when it names them again.
pub struct Documents {
    texts: BTreeMap<Id, (Which, Document)>,
    /// Those that are named now.
    open: BTreeMap<Which, Id>,
    opened: u64,
    recovery: Recovery,
    wake: Arc<dyn Fn() + Send + Sync>,
    /// The texts of the steps that can be taken back, the last one last, and of those that were.
    undo: Vec<Id>,
    redo: Vec<Id>,
    /// Whether a crash has left copies of what was opened since this was asked last.
    has_copies: bool,
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
            texts: BTreeMap::new(),
            open: BTreeMap::new(),
            opened: 0,
            recovery,
            wake,
            undo: Vec::new(),
            redo: Vec::new(),
            has_copies: false,
            troubles: BTreeMap::new(),
        };
        documents.read(Which::Preset, preset)?;
        documents.follow_names();
        Ok(documents)
    }

    /// Opens a text from the disk.
    fn read(&mut self, which: Which, path: &Path) -> Result<(), OpenError> {
        let mut document = Document::open(path, &self.recovery)?;
        let wake = self.wake.clone();
        document.on_change(Some(Box::new(move || wake())));
        self.has_copies |= document.recovered().is_some();
        let id = Id(self.opened);
        self.opened += 1;
        self.texts.insert(id, (which, document));
        self.open.insert(which, id);
        Ok(())
    }

    /// The preset.
    #[must_use]
    pub fn preset(&self) -> &Document {
        &self.texts[&self.open[&Which::Preset]].1
    }

    /// One of the texts, where there is such.
    #[must_use]
    pub fn get(&self, which: Which) -> Option<&Document> {
        let (_, document) = self.texts.get(self.open.get(&which)?)?;
        Some(document)
    }

    /// The same, to be changed.
    pub fn get_mut(&mut self, which: Which) -> Option<&mut Document> {
        let (_, document) = self.texts.get_mut(self.open.get(&which)?)?;
        Some(document)
    }

    /// All texts that are open.
    pub fn all(&self) -> impl Iterator<Item = (Which, &Document)> {
        let open = self.open.iter();
        open.map(|(which, id)| (*which, &self.texts[id].1))
    }

    fn is_open(&self, text: Id) -> bool {
        self.open.values().any(|open| *open == text)
    }

    /// Texts with changes that are not saved, also of those that the preset named before.
    pub fn unsaved(&self) -> impl Iterator<Item = (Id, &Document)> {
        let texts = self.texts.iter().map(|(id, (_, document))| (*id, document));
        // What is no more on the disk, and no more named, is missed by nobody.
        texts.filter(|(id, document)| {
            document.is_changed() && (self.is_open(*id) || document.was_edited())
        })
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
        self.unsaved().next().is_some()
    }

    /// Whether there is something to be done in a while, without anybody's doing: copies that outlive a crash, files whose changes
    /// the system doesn't tell.
    #[must_use]
    pub fn wants_care(&self) -> bool {
        let wants_care = |(_, document): &(Which, Document)| {
            document.wants_recovery_copy() || !document.is_watched()
        };
        !self.troubles.is_empty() || self.texts.values().any(wants_care)
    }

    /// Whether a crash has left copies of what was opened since this was asked last.
    pub fn take_copies(&mut self) -> bool {
        std::mem::take(&mut self.has_copies)
    }

    /// Makes the changes, one after the other. They are one step of undo, with all of one `gesture`.
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
        let version = self.get(which).map_or(0, Document::version);
        let gesture = gesture.or(Some(u64::MAX - version));
        for edit in edits {
            let Some(document) = self.get_mut(which) else {
                return Ok(());
            };
            let text = edit
                .apply(document.text())
                .map_err(|error| error.to_string())?;
            let step = document.edit(text, gesture);
            self.note(which, step);
        }
        self.follow_names();
        Ok(())
    }

    /// A text was written by hand.
    pub fn write(&mut self, which: Which, text: String, gesture: Option<u64>) {
        if let Some(document) = self.get_mut(which) {
            let step = document.edit(text, gesture);
            self.note(which, step);
        }
        self.follow_names();
    }

    /// Notes what an edit of a text made of its steps.
    fn note(&mut self, which: Which, step: Step) {
        let text = self.open[&which];
        match step {
            Step::None => return,
            Step::New => self.undo.push(text),
            Step::Same => {}
            Step::Gone => {
                let last = self.undo.iter().rposition(|own| *own == text);
                last.map(|last| self.undo.remove(last));
            }
        }
        if self.undo.len() > MOST_STEPS {
            self.undo.remove(0);
        }
        self.redo.clear();
    }

    /// Takes the last change of any of the texts back. Whether there was one. Those of texts that are not named now wait until they are.
    pub fn undo(&mut self) -> bool {
        let done = self.undo_step();
        self.follow_names();
        done
    }

    fn undo_step(&mut self) -> bool {
        while let Some(last) = (self.undo.iter()).rposition(|text| self.is_open(*text)) {
            let text = self.undo.remove(last);
            if self.texts.get_mut(&text).is_some_and(|(_, own)| own.undo()) {
                self.redo.push(text);
                return true;
            }
        }
        // What was taken from the disk.
        for text in self.open.values() {
            if self.texts.get_mut(text).is_some_and(|(_, own)| own.undo()) {
                self.redo.push(*text);
                return true;
            }
        }
        false
    }

    /// Makes the change again that was taken back last. Whether there was one.
    pub fn redo(&mut self) -> bool {
        let done = self.redo_step();
        self.follow_names();
        done
    }

    fn redo_step(&mut self) -> bool {
        while let Some(last) = (self.redo.iter()).rposition(|text| self.is_open(*text)) {
            let text = self.redo.remove(last);
            // A text that was taken from the disk since has none.
            if self.texts.get_mut(&text).is_some_and(|(_, own)| own.redo()) {
                self.undo.push(text);
                return true;
            }
        }
        false
    }

    /// Opens the style and script that the preset, or where it says nothing its base, names now. Those that it named before are set aside.
    pub fn follow_names(&mut self) {
        for (which, section, ending) in [
            (Which::Style, "hair", ".style.ron"),
            (Which::Motion, "motion", ".ron"),
        ] {
            let place = Place::top().field(section).field("file");
            let named = self.chain().find_map(|(folder, text)| {
                let said = edit::get(&text, &place.steps())?;
                let name = unquoted(said).filter(|name| name.ends_with(ending));
                Some(name.map(|name| folder.join(name)))
            });
            let path = named.flatten();
            let there = self.get(which);
            if there.map(Document::path) == path.as_deref() && there.is_some() {
                continue;
            }
            self.set_aside(which);
            self.troubles.remove(&which);
            let Some(path) = path else { continue };
            let known = (self.texts.iter())
                .find(|(_, (of, document))| *of == which && document.path() == path);
            if let Some((id, _)) = known {
                self.open.insert(which, *id);
            } else if let Err(error) = self.read(which, &path) {
                self.troubles.insert(which, error.to_string());
            }
        }
    }

    /// The preset, its base, that one's base and so on, each with its folder and text, as far as they can be read.
    fn chain(&self) -> impl Iterator<Item = (PathBuf, Arc<str>)> {
        chain(self.folder(), self.preset().text().clone())
    }

    /// The files that the preset builds on, also one that can't be read.
    #[must_use]
    pub fn bases(&self) -> Vec<PathBuf> {
        bases(self.folder(), self.preset().text().clone())
    }

    /// A text that is no longer named: one with nothing to be kept is closed.
    fn set_aside(&mut self, which: Which) {
        let Some(id) = self.open.remove(&which) else {
            return;
        };
        let has_steps = |document: &Document| document.can_undo() || document.can_redo();
        // The last place of a text whose file is gone is its copy: a name that is typed letter by letter leaves it for a moment only.
        let is_gone = |document: &Document| document.conflict() == Some(&Conflict::Deleted);
        let is_kept = |(_, document): &(Which, Document)| {
            has_steps(document)
                || document.was_edited()
                || document.recovered().is_some()
                || is_gone(document)
        };
        if !self.texts.get(&id).is_some_and(is_kept)
            && let Some((_, document)) = self.texts.remove(&id)
        {
            document.close();
        }
    }

    /// Takes on what has changed on the disk; what is to be told of it.
    pub fn poll(&mut self) -> Vec<String> {
        let mut told = Vec::new();
        let mut reloaded = false;
        let open: BTreeSet<Id> = self.open.values().copied().collect();
        for (id, (_, document)) in &mut self.texts {
            let change = document.poll();
            // Of those that are set aside only what somebody must choose from is of interest.
            let Some(change) =
                change.filter(|change| open.contains(id) || matches!(change, DiskChange::Conflict))
            else {
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
        let unsaved: Vec<Id> = self.unsaved().map(|(id, _)| id).collect();
        let saved = unsaved.iter().filter_map(|id| {
            let (_, document) = self.texts.get_mut(id)?;
            if document.conflict() == Some(&Conflict::Deleted) {
                document.keep_mine();
            }
            document.save().err()
        });
        let errors = saved.collect();
        self.close_gone();
        errors
    }

    /// Closes texts that are no more on the disk and no more named, which are missed by nobody.
    fn close_gone(&mut self) {
        let open: BTreeSet<Id> = self.open.values().copied().collect();
        let is_missed = |id: &Id, document: &Document| {
            let is_gone = document.conflict() == Some(&Conflict::Deleted);
            !is_gone || open.contains(id) || document.was_edited()
        };
        let gone = self
            .texts
            .extract_if(.., |id, (_, document)| !is_missed(id, document));
        gone.for_each(|(_, (_, document))| document.close());
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
        let preset = self.get_mut(Which::Preset);
        let saved = preset.map(|preset| preset.save_as(path).map_err(|error| error.to_string()));
        saved.unwrap_or(Ok(()))
    }

    /// Ends a conflict of one of [`Self::unsaved`]: keeps what is here, or takes what is on the disk.
    pub fn resolve(&mut self, text: Id, keeps_mine: bool) {
        if let Some((_, document)) = self.texts.get_mut(&text) {
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
        let mut texts = self.texts.values();
        texts.find_map(|(_, document)| document.recovery_error())
    }

    /// Takes on the copy of a text that a crash has left, as a step of undo.
    pub fn accept_recovered(&mut self, which: Which) {
        if let Some(document) = self.get_mut(which) {
            let step = document.accept_recovered();
            self.note(which, step);
        }
        self.follow_names();
    }

    /// Throws the copy of a text away.
    pub fn discard_recovered(&mut self, which: Which) {
        if let Some(document) = self.get_mut(which) {
            document.discard_recovered();
        }
    }

    /// Throws all changes away, with the copies that would outlive a crash, and closes the texts.
    pub fn close(self) {
        let texts = self.texts.into_values();
        texts.for_each(|(_, document)| document.close());
    }

    /// Keeps copies that outlive a crash.
    pub fn keep_recovery_copies(&mut self) {
        for (_, document) in self.texts.values_mut() {
            document.keep_recovery_copy();
        }
    }
}

/// A preset of a folder, its base, that one's base and so on, each with its folder and text, as far as they can be read.
fn chain(folder: PathBuf, text: Arc<str>) -> impl Iterator<Item = (PathBuf, Arc<str>)> {
    let below = |(folder, text): &(PathBuf, Arc<str>)| {
        let path = base_of(folder, text)?;
        let text = hair_io::read_text(&path, hair_io::MOST_OF_TEXT).ok()?;
        Some((path.parent()?.to_owned(), text.into()))
    };
    std::iter::successors(Some((folder, text)), below).take(1 + MOST_BASES)
}

/// The files that the text of a preset in `folder` builds on, also one that can't be read.
pub(crate) fn bases(folder: PathBuf, text: Arc<str>) -> Vec<PathBuf> {
    let base = |(folder, text): (PathBuf, Arc<str>)| base_of(&folder, &text);
    chain(folder, text).filter_map(base).collect()
}

/// The base that the text of a preset in `folder` names.
fn base_of(folder: &Path, text: &str) -> Option<PathBuf> {
    let name = unquoted(edit::get(text, &Place::top().field("base").steps())?)?;
    Some(folder.join(name))
}

/// The text between a RON text's quotes, where it has no escapes.
fn unquoted(text: &str) -> Option<&str> {
    let inside = text.strip_prefix('"')?.strip_suffix('"')?;
    (!inside.is_empty() && !inside.contains('\\')).then_some(inside)
}
