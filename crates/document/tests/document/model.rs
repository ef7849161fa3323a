//! Documents do what a model of them does, whatever happens in which order.

use super::*;
use proptest::prelude::*;

#[derive(Clone, Debug)]
enum Act {
    Edit(u8, Option<u64>),
    Undo,
    Redo,
    Save,
    /// Somebody writes the file, and it is told.
    Write(u8),
    /// Somebody writes it, and nobody was told when it is saved.
    WriteAndSave(u8),
    Delete,
    KeepMine,
    TakeTheirs,
}

fn act() -> impl Strategy<Value = Act> {
    prop_oneof![
        6 => (0..6_u8, prop::option::of(0..2_u64)).prop_map(|(text, gesture)| Act::Edit(text, gesture)),
        3 => Just(Act::Undo),
        2 => Just(Act::Redo),
        2 => Just(Act::Save),
        2 => (0..6_u8).prop_map(Act::Write),
        1 => (0..6_u8).prop_map(Act::WriteAndSave),
        1 => Just(Act::Delete),
        1 => Just(Act::KeepMine),
        1 => Just(Act::TakeTheirs),
    ]
}

/// What a document is, with nothing behind it.
struct Model {
    /// All texts, each with the gesture that made it, and which is shown.
    texts: Vec<(u8, Option<u64>)>,
    shown: usize,
    /// Whether an edit was the last act that makes or ends a step, so that its gesture may go on.
    editing: bool,
    base: Option<u8>,
    disk: Option<u8>,
    /// What is in conflict: another text, or none.
    conflict: Option<Option<u8>>,
}

impl Model {
    fn text(&self) -> u8 {
        self.texts[self.shown].0
    }

    fn is_changed(&self) -> bool {
        self.conflict.is_some() || self.base != Some(self.text())
    }

    fn edit(&mut self, text: u8, gesture: Option<u64>) {
        if text == self.text() {
            return;
        }
        self.texts.truncate(self.shown + 1);
        let goes_on = self.editing && gesture.is_some() && self.texts[self.shown].1 == gesture;
        if goes_on && self.shown > 0 {
            self.texts.pop();
            self.editing = self.texts[self.shown - 1].0 != text;
            if !self.editing {
                self.shown -= 1;
                return;
            }
        } else {
            self.shown += 1;
            self.editing = true;
        }
        self.texts.push((text, gesture));
    }

    /// What is told of the disk as it is now.
    fn look(&mut self, was: Option<u8>) -> Option<DiskChange> {
        let Some(disk) = self.disk else {
            was?;
            if self.base.is_some() {
                self.conflict = Some(None);
            }
            return Some(DiskChange::Deleted);
        };
        if self.base == Some(disk) || self.text() == disk {
            self.base = Some(disk);
            let had = self.conflict.take().is_some();
            return (had || was.is_none()).then_some(DiskChange::Back);
        }
        if self.base == Some(self.text()) {
            self.conflict = None;
            self.edit(disk, None);
            self.base = Some(disk);
            return Some(DiskChange::Reloaded);
        }
        let is_news = self.conflict != Some(Some(disk));
        self.conflict = Some(Some(disk));
        is_news.then_some(DiskChange::Conflict)
    }

    /// Whether it is saved.
    fn save(&mut self) -> bool {
        let text = self.text();
        if self.disk != self.base && self.disk != Some(text) {
            self.conflict = Some(self.disk);
            return false;
        }
        self.disk = Some(text);
        self.base = self.disk;
        self.conflict = None;
        // What was saved can be had again by undo: a drag that goes on is a step of its own.
        self.editing = false;
        true
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 100, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn documents_do_what_the_model_does(acts in prop::collection::vec(act(), 1..25)) {
        let word = |text: u8| format!("text {text}");
        let (place, mut document) = opened(&word(0));
        let mut model = Model {
            texts: vec![(0, None)], shown: 0, editing: false, base: Some(0), disk: Some(0), conflict: None,
        };
        for act in acts {
            let version = document.version();
            let before = model.text();
            let was = model.disk;
            match act {
                Act::Edit(text, gesture) => {
                    document.edit(word(text), gesture);
                    model.edit(text, gesture);
                }
                Act::Undo => {
                    prop_assert_eq!(document.undo(), model.shown > 0);
                    model.shown = model.shown.saturating_sub(1);
                    model.editing = false;
                }
                Act::Redo => {
                    let can = model.shown + 1 < model.texts.len();
                    prop_assert_eq!(document.redo(), can);
                    model.shown += usize::from(can);
                    model.editing = false;
                }
                Act::Save => prop_assert_eq!(document.save().is_ok(), model.save()),
                Act::WriteAndSave(text) => {
                    place.rename_over(&word(text));
                    model.disk = Some(text);
                    prop_assert_eq!(document.save().is_ok(), model.save());
                }
                Act::Write(text) => {
                    place.rename_over(&word(text));
                    model.disk = Some(text);
                    if let Some(change) = model.look(was) {
                        prop_assert_eq!(wait(&mut document), change);
                    } else {
                        // No news, but that they wrote the same.
                        let is_changed = model.is_changed();
                        let begin = Instant::now();
                        while document.is_changed() != is_changed {
                            prop_assert_eq!(document.poll(), None);
                            prop_assert!(begin.elapsed() < Duration::from_secs(20));
                        }
                    }
                }
                Act::Delete => {
                    if was.is_some() {
                        fs::remove_file(place.file()).unwrap();
                        model.disk = None;
                        prop_assert_eq!(Some(wait(&mut document)), model.look(was));
                    }
                }
                Act::KeepMine => {
                    document.keep_mine();
                    if let Some(theirs) = model.conflict.take() {
                        model.base = theirs;
                    }
                }
                Act::TakeTheirs => {
                    document.take_theirs();
                    if let Some(Some(theirs)) = model.conflict {
                        model.conflict = None;
                        model.edit(theirs, None);
                        model.base = Some(theirs);
                    }
                }
            }
            prop_assert_eq!(&**document.text(), &word(model.text()));
            prop_assert_eq!(document.version() > version, model.text() != before);
            prop_assert_eq!(document.is_changed(), model.is_changed());
            prop_assert_eq!(document.can_undo(), model.shown > 0);
            prop_assert_eq!(document.can_redo(), model.shown + 1 < model.texts.len());
            let conflict = model.conflict.map(|theirs| match theirs {
                Some(theirs) => Conflict::Changed { on_disk: word(theirs).into() },
                None => Conflict::Deleted,
            });
            prop_assert_eq!(document.conflict(), conflict.as_ref());
            prop_assert_eq!(fs::read_to_string(place.file()).ok(), model.disk.map(word));
        }
    }
}
