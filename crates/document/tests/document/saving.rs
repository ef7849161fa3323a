//! Steps of undo, and what saving writes.

use super::*;

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
fn marks_and_line_ends_stay() {
    let (place, mut document) = opened("\u{feff}(\r\n  a: 1,\r\n)\r\n");
    assert_eq!(&**document.text(), "(\r\n  a: 1,\r\n)\r\n");
    edit(&mut document, "(\r\n  a: 2,\r\n)\r\n");
    document.save().unwrap();
    assert_eq!(place.read(), "\u{feff}(\r\n  a: 2,\r\n)\r\n");
    place.write("(\n)\n");
    assert_eq!(wait(&mut document), DiskChange::Reloaded);
    // What is taken over in a conflict brings its mark along.
    edit(&mut document, "(a: 3)\n");
    place.write("\u{feff}(b: 1)\n");
    assert_eq!(wait(&mut document), DiskChange::Conflict);
    document.take_theirs();
    edit(&mut document, "(b: 2)\n");
    document.save().unwrap();
    assert_eq!(place.read(), "\u{feff}(b: 2)\n");
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
