//! Copies that outlive a crash.

use super::*;

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
            .args(["--exact", "recovery::a_crash_loses_nothing", "--nocapture"])
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

/// A file that is deleted while it is open has its text nowhere else.
#[test]
fn a_crash_loses_no_file_that_was_deleted() {
    let place = Place::new();
    place.write("one");
    let mut document = place.open_with_recovery();
    fs::remove_file(place.file()).unwrap();
    assert_eq!(wait(&mut document), DiskChange::Deleted);
    document.keep_recovery_copy();
    drop(document);

    let mut document = place.open_with_recovery();
    assert_eq!(
        (&**document.text(), document.conflict()),
        ("one", Some(&Conflict::Deleted))
    );
    assert!(document.is_changed() && document.recovered().is_none());
    // It has a copy again, so that the next crash loses nothing either.
    assert_eq!(place.copies(), 2);
    assert_quiet(&mut document);
    document.keep_mine();
    document.save().unwrap();
    assert_eq!((&*place.read(), place.copies()), ("one", 0));

    fs::remove_file(place.file()).unwrap();
    drop(document);
    let opened = Document::open(&place.file(), &place.recovery());
    assert!(matches!(opened, Err(OpenError::Read(_))));
}

#[test]
#[cfg(unix)]
fn copies_of_deleted_files_are_found_by_any_name_of_their_folder() {
    let place = Place::new();
    std::os::unix::fs::symlink(place.folder.path(), place.path("link")).unwrap();
    place.write("one");
    let mut document = place.open_with_recovery();
    edit(&mut document, "two");
    document.keep_recovery_copy();
    drop(document);
    fs::remove_file(place.file()).unwrap();
    let document = Document::open(&place.path("link/look.ron"), &place.recovery()).unwrap();
    assert_eq!(&**document.text(), "two");
}
