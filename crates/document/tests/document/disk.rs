//! What becomes of a document when its file changes.

use super::*;

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

    // Who takes back what he did hasn't theirs yet.
    edit(&mut document, "mine again, and more");
    place.write("theirs again");
    assert_eq!(wait(&mut document), DiskChange::Conflict);
    assert!(document.undo());
    assert_eq!(&**document.text(), "mine again");
    assert!(document.is_changed() && !document.was_edited());
    assert!(matches!(document.save(), Err(SaveError::Conflict(_))));
    document.take_theirs();
    assert_eq!(
        (&**document.text(), document.is_changed()),
        ("theirs again", false)
    );
    edit(&mut document, "mine again");
    document.save().unwrap();

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
