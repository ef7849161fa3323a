//! Changes of several texts, and the steps back.

use crate::common::{LOOK, Looks, SCRIPT, viewer, wait_for, wait_for_picture};
use crate::hands::{COMMAND, press, redo, undo};
use eframe::egui::{Key, Modifiers};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use viewer::app::App;
use viewer::documents::Which;
use viewer::panes::Pane;

fn write(harness: &mut Harness<App>, which: Which, text: &str, gesture: Option<u64>) {
    let studio = &mut harness.state_mut().studio;
    studio.write(which, text.to_owned(), gesture);
    harness.step();
}

/// The preset and its script.
fn texts(harness: &Harness<App>) -> [String; 2] {
    let documents = harness.state().studio.documents.as_ref().unwrap();
    [Which::Preset, Which::Motion].map(|which| documents.get(which).unwrap().text().to_string())
}

#[test]
fn changes_of_different_texts_are_taken_back_in_their_order() {
    use viewer::documents::Which::{Motion, Preset};
    let looks = Looks::new();
    let mut harness = viewer(&looks);
    harness.run_steps(3);
    let [first, third] = ["1.6", "1.7"].map(|width| LOOK.replace("1.5", width));
    let second = SCRIPT.replace("40", "50");
    write(&mut harness, Preset, &first, None);
    write(&mut harness, Motion, &second, None);
    write(&mut harness, Preset, &third, None);
    undo(&mut harness);
    assert_eq!(texts(&harness), [first.clone(), second]);
    undo(&mut harness);
    assert_eq!(texts(&harness), [first, SCRIPT.to_owned()]);
    undo(&mut harness);
    assert_eq!(texts(&harness), [LOOK.to_owned(), SCRIPT.to_owned()]);
    for _ in 0..3 {
        redo(&mut harness);
    }
    assert_eq!(texts(&harness)[0], third);
}

/// A drag that ends where it began is no step: what is taken back is what was done before it, in whatever text.
#[test]
fn a_drag_back_to_its_start_takes_no_step_of_another_text() {
    use viewer::documents::Which::{Motion, Preset};
    let looks = Looks::new();
    let mut harness = viewer(&looks);
    harness.run_steps(3);
    let [first, other] = ["1.6", "1.7"].map(|width| LOOK.replace("1.5", width));
    let second = SCRIPT.replace("40", "50");
    write(&mut harness, Preset, &first, None);
    write(&mut harness, Motion, &second, None);
    write(&mut harness, Preset, &other, Some(7));
    write(&mut harness, Preset, &first, Some(7));
    undo(&mut harness);
    assert_eq!(texts(&harness), [first.clone(), SCRIPT.to_owned()]);
    // Nor is what changes nothing, so that what was taken back can be made again.
    write(&mut harness, Preset, &first, None);
    redo(&mut harness);
    assert_eq!(texts(&harness), [first, second]);
}

/// Lines that end with a return and a line feed go on doing so, whatever is typed.
#[test]
fn what_is_typed_has_the_ends_of_lines_that_the_text_has() {
    let looks = Looks::new();
    let before = LOOK.replace('\n', "\r\n");
    std::fs::write(looks.path("look.ron"), &before).unwrap();
    let mut harness = viewer(&looks);
    harness.state_mut().show_pane(Pane::Text);
    harness.run_steps(3);
    harness.get_by_label("Preset text").focus();
    harness.run_steps(2);
    harness.get_by_label("Preset text").type_text("// mine");
    harness.run_steps(2);
    press(&mut harness, Modifiers::NONE, Key::Enter);
    harness.get_by_label("Preset text").type_text("// too");
    press(&mut harness, Modifiers::NONE, Key::Enter);
    let written = texts(&harness)[0].clone();
    assert_eq!(written, format!("{before}// mine\r\n// too\r\n"));
}

#[test]
fn what_is_typed_is_taken_before_it_is_saved() {
    let looks = Looks::new();
    let mut harness = viewer(&looks);
    wait_for_picture(&mut harness);
    harness.state_mut().show_pane(Pane::Look);
    harness.state_mut().studio.search = "background".to_owned();
    harness.run_steps(3);
    let field = harness.get_by_label("scene background hex");
    field.focus();
    harness.run_steps(2);
    press(&mut harness, COMMAND, Key::A);
    harness
        .get_by_label("scene background hex")
        .type_text("123456");
    harness.run_steps(2);
    press(&mut harness, COMMAND, Key::S);
    harness.run_steps(4);
    assert!(
        looks.read("look.ron").contains("123456"),
        "{}",
        looks.read("look.ron")
    );
}

#[test]
fn a_style_that_is_named_again_has_its_changes_and_steps() {
    use viewer::documents::Which::{Preset, Style};
    let looks = Looks::new();
    let own = looks.read("bob.style.ron");
    std::fs::write(looks.path("other.style.ron"), &own).unwrap();
    let mut harness = viewer(&looks);
    harness.run_steps(3);
    let style = |harness: &Harness<App>| {
        let documents = harness.state().studio.documents.as_ref().unwrap();
        let style = documents.get(Style).unwrap();
        (style.name(), style.text().to_string())
    };
    let is = |name: &str, text: &str| (name.to_owned(), text.to_owned());
    let [mine, others] = ["mine", "other's"].map(|name| format!("// {name}\n{own}"));
    let renamed = LOOK.replace("bob.style", "other.style");
    write(&mut harness, Style, &mine, None);
    write(&mut harness, Preset, &renamed, None);
    assert_eq!(style(&harness), is("other.style.ron", &own));
    write(&mut harness, Style, &others, None);

    // Named again it is as it was left.
    write(&mut harness, Preset, LOOK, None);
    assert_eq!(style(&harness), is("bob.style.ron", &mine));
    // Steps back go through all of them in their order, and names are followed.
    for (name, text) in [
        ("other.style.ron", &others),
        ("other.style.ron", &own),
        ("bob.style.ron", &mine),
        ("bob.style.ron", &own),
    ] {
        undo(&mut harness);
        assert_eq!(style(&harness), is(name, text));
    }
    for (name, text) in [
        ("bob.style.ron", &mine),
        ("other.style.ron", &own),
        ("other.style.ron", &others),
    ] {
        redo(&mut harness);
        assert_eq!(style(&harness), is(name, text));
    }
    // What is not named now is saved, too.
    press(&mut harness, COMMAND, Key::S);
    assert_eq!(looks.read("look.ron"), renamed);
    assert_eq!(looks.read("bob.style.ron"), mine);
    assert_eq!(looks.read("other.style.ron"), others);
    // Without it nobody misses it.
    std::fs::remove_file(looks.path("bob.style.ron")).unwrap();
    std::thread::sleep(std::time::Duration::from_millis(600));
    harness.run_steps(2);
    let documents = harness.state().studio.documents.as_ref().unwrap();
    assert!(!documents.is_changed());
}

/// What was taken back and then replaced from the disk can't be made again; what was taken back of other texts can.
#[test]
fn what_was_taken_from_the_disk_ends_no_steps_of_another_text() {
    use viewer::documents::Which::{Motion, Preset};
    let looks = Looks::new();
    let mut harness = viewer(&looks);
    harness.run_steps(3);
    let [first, theirs] = ["1.6", "1.7"].map(|width| LOOK.replace("1.5", width));
    let second = SCRIPT.replace("40", "50");
    write(&mut harness, Motion, &second, None);
    write(&mut harness, Preset, &first, None);
    undo(&mut harness);
    undo(&mut harness);
    write_back(&looks, &mut harness, &theirs);
    // The script's is the next that was taken back; the preset's own is gone.
    redo(&mut harness);
    assert_eq!(texts(&harness), [theirs.clone(), second.clone()]);
    redo(&mut harness);
    assert_eq!(texts(&harness), [theirs.clone(), second]);
    undo(&mut harness);
    assert_eq!(texts(&harness), [theirs, SCRIPT.to_owned()]);
}

/// Somebody else writes the preset, which is read again.
fn write_back(looks: &Looks, harness: &mut Harness<App>, theirs: &str) {
    std::fs::write(looks.path("look.ron"), theirs).unwrap();
    wait_for(harness, "the preset of the disk", |app| {
        let documents = app.studio.documents.as_ref().unwrap();
        **documents.preset().text() == *theirs
    });
}

#[test]
fn what_is_changed_at_once_is_taken_back_at_once() {
    use viewer::edit::{Edit, Place};
    let looks = Looks::new();
    let mut harness = viewer(&looks);
    harness.run_steps(3);
    let light = |name: &str| Place::top().field("light").field(name);
    let edits = [
        Edit::Set(light("yaw"), "10".to_owned()),
        Edit::Remove(light("pitch")),
    ];
    let studio = &mut harness.state_mut().studio;
    assert!(studio.change(Which::Preset, &edits));
    assert!(texts(&harness)[0].contains("light: (yaw: 10)"));
    undo(&mut harness);
    assert_eq!(texts(&harness)[0], LOOK);
}
