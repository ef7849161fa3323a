//! Documents on real files, which others change meanwhile.

use document::{Conflict, DiskChange, Document, OpenError, Recovery, SaveError};
use proptest::prelude::*;
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

#[test]
fn what_others_write_is_taken_over() {
    let (place, mut document) = opened("one");
    let version = document.version();
    place.rename_over("two");
    assert_eq!(wait(&mut document), DiskChange::Reloaded);
    assert_eq!((&**document.text(), document.is_changed()), ("two", false));
    assert!(document.version() > version);
    place.write("three");
    assert_eq!(wait(&mut document), DiskChange::Reloaded);
    assert_eq!(&**document.text(), "three");

    // A step like any other.
    assert!(document.undo() && document.is_changed());
    assert_eq!(&**document.text(), "two");
    assert!(document.redo() && !document.is_changed());
    // Neither another file nor the same text again is a change.
    fs::write(place.path("other.ron"), "x").unwrap();
    place.rename_over("three");
    assert_quiet(&mut document);
}

#[test]
fn a_file_that_is_emptied_and_written_is_never_seen_empty() {
    let (place, mut document) = opened("one");
    for i in 0..10 {
        place.write("");
        sleep(Duration::from_millis(5));
        place.write(&format!("text {i}"));
        assert_eq!(wait(&mut document), DiskChange::Reloaded);
        assert_eq!(**document.text(), format!("text {i}"));
    }
}

#[test]
fn a_file_that_is_deleted_and_comes_back() {
    let (place, mut document) = opened("one");
    fs::remove_file(place.file()).unwrap();
    assert_eq!(wait(&mut document), DiskChange::Deleted);
    assert_eq!(document.conflict(), Some(&Conflict::Deleted));
    assert_eq!(&**document.text(), "one");
    assert!(matches!(document.save(), Err(SaveError::Conflict(_))));
    place.write("one");
    assert_eq!(wait(&mut document), DiskChange::Back);
    assert_eq!(document.conflict(), None);

    fs::remove_file(place.file()).unwrap();
    assert_eq!(wait(&mut document), DiskChange::Deleted);
    place.write("two");
    assert_eq!(wait(&mut document), DiskChange::Reloaded);
    assert_eq!((&**document.text(), document.conflict()), ("two", None));

    // It is made again for who says so.
    fs::remove_file(place.file()).unwrap();
    assert_eq!(wait(&mut document), DiskChange::Deleted);
    document.take_theirs();
    assert_eq!(document.conflict(), Some(&Conflict::Deleted));
    document.keep_mine();
    assert!(document.is_changed());
    document.save().unwrap();
    assert_eq!((&*place.read(), document.is_changed()), ("two", false));
    assert_quiet(&mut document);
}

#[test]
fn where_both_changed_both_are_there() {
    let (place, mut document) = opened("one");
    edit(&mut document, "mine");
    place.rename_over("theirs");
    assert_eq!(wait(&mut document), DiskChange::Conflict);
    let theirs = Conflict::Changed {
        on_disk: "theirs".into(),
    };
    assert_eq!(document.conflict(), Some(&theirs));
    let error = document.save().unwrap_err();
    assert!(error.to_string().contains("look.ron: "), "{error}");
    assert_eq!((&*place.read(), &**document.text()), ("theirs", "mine"));

    document.take_theirs();
    assert_eq!(
        (&**document.text(), document.is_changed()),
        ("theirs", false)
    );
    assert!(document.undo());
    assert_eq!((&**document.text(), document.is_changed()), ("mine", true));
    // He knows what is there.
    document.save().unwrap();
    assert_eq!(place.read(), "mine");
    assert_quiet(&mut document);

    edit(&mut document, "mine again");
    place.write("theirs again");
    assert_eq!(wait(&mut document), DiskChange::Conflict);
    document.keep_mine();
    assert_eq!((document.conflict(), document.is_changed()), (None, true));
    document.save().unwrap();
    assert_eq!(place.read(), "mine again");

    // What they did they may undo, or do as I did.
    for theirs in ["mine again", "mine at last"] {
        edit(&mut document, "mine at last");
        place.write("else");
        assert_eq!(wait(&mut document), DiskChange::Conflict);
        place.write(theirs);
        assert_eq!(wait(&mut document), DiskChange::Back);
        assert_eq!(document.conflict(), None);
        assert_eq!(document.is_changed(), theirs == "mine again");
    }
}

#[test]
fn saving_looks_first() {
    let (place, mut document) = opened("one");
    edit(&mut document, "mine");
    // Nobody has polled since.
    place.write("theirs");
    assert!(matches!(document.save(), Err(SaveError::Conflict(_))));
    assert_eq!(place.read(), "theirs");
    assert!(document.conflict().is_some());
    // They wrote the same.
    place.write("mine");
    document.save().unwrap();
    assert_eq!((document.conflict(), document.is_changed()), (None, false));
}

#[test]
fn a_file_that_cannot_be_read() {
    let (place, mut document) = opened("one");
    fs::write(place.file(), b"a\nb\xff").unwrap();
    match wait(&mut document) {
        DiskChange::Unreadable(message) => assert!(message.contains("look.ron:2:2: "), "{message}"),
        other => panic!("{other:?}"),
    }
    edit(&mut document, "mine");
    assert!(matches!(document.save(), Err(SaveError::Read(_))));
    assert_eq!(fs::read(place.file()).unwrap(), b"a\nb\xff");
    place.write("one");
    assert_eq!(wait(&mut document), DiskChange::Back);
    document.save().unwrap();

    fs::write(place.file(), b"\xff").unwrap();
    let error = Document::open(&place.file(), &Recovery::none())
        .err()
        .unwrap();
    assert!(matches!(error, OpenError::Read(_)) && error.to_string().contains("UTF-8"));
    assert!(Document::open(&place.path("none.ron"), &Recovery::none()).is_err());
    assert!(Document::open(place.folder.path(), &Recovery::none()).is_err());
}

#[test]
fn marks_and_line_ends_stay() {
    let (place, mut document) = opened("\u{feff}(\r\n  a: 1,\r\n)\r\n");
    assert_eq!(&**document.text(), "(\r\n  a: 1,\r\n)\r\n");
    edit(&mut document, "(\r\n  a: 2,\r\n)\r\n");
    document.save().unwrap();
    assert_eq!(place.read(), "\u{feff}(\r\n  a: 2,\r\n)\r\n");
    place.write("(\n)\n");
    assert_eq!(wait(&mut document), DiskChange::Reloaded);
    edit(&mut document, "(a: 1)\n");
    document.save().unwrap();
    assert_eq!(place.read(), "(a: 1)\n");
}

#[test]
#[cfg(unix)]
fn links_and_permissions_stay() {
    use std::os::unix::fs::PermissionsExt as _;
    let place = Place::new();
    fs::create_dir(place.path("there")).unwrap();
    let target = place.path("there/real.ron");
    fs::write(&target, "one").unwrap();
    fs::set_permissions(&target, Permissions::from_mode(0o640)).unwrap();
    std::os::unix::fs::symlink(&target, place.file()).unwrap();
    let mut document = place.open();
    assert_eq!(document.name(), "look.ron");
    edit(&mut document, "two");
    document.save().unwrap();
    assert!(fs::symlink_metadata(place.file()).unwrap().is_symlink());
    assert_eq!(fs::read_to_string(&target).unwrap(), "two");
    let mode = fs::metadata(&target).unwrap().permissions().mode();
    assert_eq!(mode & 0o777, 0o640);
    // The file is watched where it is.
    fs::write(&target, "three").unwrap();
    assert_eq!(wait(&mut document), DiskChange::Reloaded);
}

#[test]
fn what_cannot_be_written_keeps_its_changes() {
    let (place, mut document) = opened("one");
    let set_readonly = |path: &Path, readonly: bool| {
        let mut permissions: Permissions = fs::metadata(path).unwrap().permissions();
        permissions.set_readonly(readonly);
        fs::set_permissions(path, permissions).unwrap();
    };
    edit(&mut document, "two");
    set_readonly(&place.file(), true);
    let error = document.save().unwrap_err();
    assert!(matches!(error, SaveError::Write(_)));
    assert!(error.to_string().contains("look.ron: "), "{error}");
    assert_eq!((&*place.read(), document.is_changed()), ("one", true));
    set_readonly(&place.file(), false);

    set_readonly(place.folder.path(), true);
    let can_write = fs::write(place.path("try"), "").is_ok();
    let saved = document.save();
    set_readonly(place.folder.path(), false);
    if can_write {
        skipped("a read-only folder: this user writes into it");
    } else {
        assert!(saved.unwrap_err().to_string().contains("look.ron: "));
        assert_eq!((&*place.read(), document.is_changed()), ("one", true));
    }
    document.save().unwrap();
    assert_eq!(place.read(), "two");
}

#[expect(clippy::print_stderr, reason = "whoever runs tests reads it")]
fn skipped(what: &str) {
    eprintln!("SKIPPED {what}");
}

#[test]
fn another_name() {
    let (place, mut document) = opened("one");
    fs::write(place.path("taken.ron"), "theirs").unwrap();
    edit(&mut document, "two");
    for name in ["taken.ron", "look.ron"] {
        let error = document.save_as(&place.path(name)).unwrap_err();
        assert!(matches!(error, SaveError::Exists(_)), "{error}");
    }
    assert!(document.save_as(&place.path("none/new.ron")).is_err());
    assert_eq!(
        (document.path(), document.is_changed()),
        (&*place.file(), true)
    );

    document.save_as(&place.path("new.ron")).unwrap();
    assert_eq!(
        (&*document.name(), document.is_changed()),
        ("new.ron", false)
    );
    assert_eq!(place.read(), "one");
    // The new one is watched, the old one no more.
    place.write("x");
    assert_quiet(&mut document);
    fs::write(place.path("new.ron"), "three").unwrap();
    assert_eq!(wait(&mut document), DiskChange::Reloaded);

    document.save_over(&place.path("taken.ron")).unwrap();
    assert_eq!(
        fs::read_to_string(place.path("taken.ron")).unwrap(),
        "three"
    );
}

#[test]
fn somebody_is_called() {
    let (place, mut document) = opened("one");
    assert!(document.is_watched());
    let (call, called) = mpsc::channel();
    document.on_change(Some(Box::new(move || call.send(()).unwrap())));
    place.write("two");
    called.recv_timeout(Duration::from_secs(20)).unwrap();
    assert_eq!(document.poll(), Some(DiskChange::Reloaded));
    document.on_change(None);
    place.write("three");
    assert_eq!(wait(&mut document), DiskChange::Reloaded);
}

#[test]
fn a_drag_is_one_step() {
    let (_place, mut document) = opened("0");
    for i in 1..5 {
        document.edit(i.to_string(), Some(1));
    }
    edit(&mut document, "5");
    edit(&mut document, "6");
    document.edit("7".into(), Some(2));
    document.edit("7".into(), Some(3));
    document.edit("8".into(), Some(2));
    let mut texts = Vec::new();
    while document.undo() {
        texts.push(document.text().to_string());
    }
    assert_eq!(texts, ["6", "5", "4", "0"]);
    assert!(!document.is_changed() && !document.can_undo());
    while document.redo() {}
    assert_eq!(&**document.text(), "8");
    // After an undo the same gesture is another step.
    document.undo();
    document.edit("9".into(), Some(2));
    assert!(!document.can_redo());
    document.undo();
    assert_eq!(&**document.text(), "6");
    // A drag that ends where it began is none.
    document.edit("x".into(), Some(9));
    document.edit("6".into(), Some(9));
    document.undo();
    assert_eq!(&**document.text(), "5");
}

#[test]
fn recovery_copies_come_and_go() {
    let place = Place::new();
    place.write("one");
    let mut document = place.open_with_recovery();
    document.keep_recovery_copy();
    assert_eq!(place.copies(), 0);
    assert!(!document.wants_recovery_copy());
    edit(&mut document, "two");
    assert!(document.wants_recovery_copy());
    document.keep_recovery_copy();
    assert_eq!(place.copies(), 2, "the copy and its lock");
    assert!(!document.wants_recovery_copy());
    document.undo();
    assert!(document.wants_recovery_copy());
    document.keep_recovery_copy();
    assert_eq!(place.copies(), 0);
    assert!(!document.wants_recovery_copy());
    document.redo();
    document.keep_recovery_copy();
    document.save().unwrap();
    assert_eq!(place.copies(), 0);
    edit(&mut document, "three");
    document.keep_recovery_copy();
    document.close();
    assert_eq!(place.copies(), 0);

    // Ended without a word, as when the session ends.
    let mut document = place.open_with_recovery();
    edit(&mut document, "four");
    document.keep_recovery_copy();
    drop(document);
    assert_eq!(place.copies(), 1);
    let mut document = place.open_with_recovery();
    assert_eq!(&*document.recovered().unwrap().text, "four");
    document.discard_recovered();
    assert!(document.recovered().is_none());
    assert_eq!(place.copies(), 0);

    // A folder that cannot be made.
    fs::write(place.path("file"), "").unwrap();
    let nowhere = Recovery::in_folder(&place.path("file/recovery"));
    let mut document = Document::open(&place.file(), &nowhere).unwrap();
    edit(&mut document, "five");
    document.keep_recovery_copy();
    assert!(document.recovery_error().unwrap().contains("recovery: "));
    document.undo();
    document.keep_recovery_copy();
    assert_eq!(document.recovery_error(), None);
}

#[test]
fn two_with_the_same_file_leave_each_other_alone() {
    let place = Place::new();
    place.write("one");
    let mut first = place.open_with_recovery();
    edit(&mut first, "first");
    first.keep_recovery_copy();
    let mut second = place.open_with_recovery();
    assert!(second.recovered().is_none(), "the first is alive");
    edit(&mut second, "second");
    second.keep_recovery_copy();
    assert_eq!(place.copies(), 4);
    second.close();
    assert_eq!(place.copies(), 2);
    drop(first);
    // A copy of another file is not of this one.
    fs::write(place.path("other.ron"), "one").unwrap();
    let other = Document::open(&place.path("other.ron"), &place.recovery()).unwrap();
    assert!(other.recovered().is_none());
    let third = place.open_with_recovery();
    assert_eq!(&*third.recovered().unwrap().text, "first");
}

/// Where the process that is to crash finds its file.
const CRASH: &str = "DOCUMENT_TEST_CRASH";

#[test]
fn a_crash_loses_nothing() {
    if let Some(folder) = std::env::var_os(CRASH) {
        let folder = PathBuf::from(folder);
        let recovery = Recovery::in_folder(&folder.join("state/recovery"));
        let mut document = Document::open(&folder.join("look.ron"), &recovery).unwrap();
        edit(&mut document, "half");
        document.keep_recovery_copy();
        edit(&mut document, "(\n  unsaved\n)");
        document.keep_recovery_copy();
        std::process::abort();
    }
    let place = Place::new();
    place.write("one");
    let crash = || {
        let crashed = Command::new(std::env::current_exe().unwrap())
            .args(["--exact", "a_crash_loses_nothing", "--nocapture"])
            .env(CRASH, place.folder.path())
            .output()
            .unwrap();
        assert!(!crashed.status.success());
        assert_eq!(place.read(), "one");
    };
    crash();
    assert_eq!(place.copies(), 2, "the copy, and a lock that nobody holds");
    let mut document = place.open_with_recovery();
    let recovered = document.recovered().unwrap();
    assert_eq!(&*recovered.text, "(\n  unsaved\n)");
    assert!(!recovered.is_older_than_file);
    assert!(recovered.when.elapsed().unwrap() < Duration::from_secs(600));
    document.accept_recovered();
    assert_eq!(
        (&**document.text(), document.is_changed()),
        ("(\n  unsaved\n)", true)
    );
    assert!(document.recovered().is_none());
    // It has a copy again, so that the next crash loses nothing either.
    assert_eq!(place.copies(), 2);
    assert!(document.undo());
    document.redo();
    document.save().unwrap();
    assert_eq!(place.copies(), 0);

    // What was saved after all needs no recovery; what was written since is said to be newer.
    place.write("one");
    crash();
    place.write("(\n  unsaved\n)");
    assert!(place.open_with_recovery().recovered().is_none());
    assert_eq!(place.copies(), 0);
    place.write("one");
    crash();
    sleep(Duration::from_millis(20));
    place.write("newer");
    assert!(
        place
            .open_with_recovery()
            .recovered()
            .unwrap()
            .is_older_than_file
    );
}

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
        self.conflict == Some(None) || self.base != Some(self.text())
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
