//! Presets and what they name, opened, saved, and changed by others.

use crate::common::{LOOK, Looks, recovering, text, viewer, viewer_of, wait_for, wait_for_picture};
use crate::hands::{COMMAND, click, drag, press, type_path, undo, wait_for_label};
use eframe::egui::{Key, Vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use std::path::Path;
use viewer::app::App;
use viewer::documents::Which::{Motion, Preset, Style};
use viewer::prompt::Prompt;
use viewer::studio::Tool;

#[test]
fn a_new_look_begins_with_a_style() {
    let looks = Looks::new();
    let mut harness = viewer_of(None);
    harness.run_steps(3);
    press(&mut harness, COMMAND, Key::N);
    // A name that is taken is refused, in place.
    type_path(&mut harness, &looks.path("look.ron"));
    click(&mut harness, "Write");
    wait_for_label(&mut harness, "is already there");
    type_path(&mut harness, &looks.path("mine.ron"));
    click(&mut harness, "Write");
    assert!(looks.path("mine.ron").is_file() && looks.path("mine.style.ron").is_file());
    wait_for_picture(&mut harness);
    assert!(harness.state().studio.problems.is_empty());
}

#[test]
fn unsaved_changes_are_asked_for() {
    let looks = Looks::new();
    std::fs::write(looks.path("other.ron"), LOOK).unwrap();
    let mut harness = viewer(&looks);
    wait_for_picture(&mut harness);
    harness.state_mut().studio.tool = Tool::Light;
    drag(&mut harness, [0.0, 0.0], [0.1, 0.1]);
    let open = |harness: &mut Harness<App>| {
        press(harness, COMMAND, Key::O);
        type_path(harness, &looks.path("other.ron"));
        click(harness, "Open");
    };
    let name = |harness: &Harness<App>| {
        harness
            .state()
            .studio
            .documents
            .as_ref()
            .unwrap()
            .preset()
            .name()
    };
    open(&mut harness);
    click(&mut harness, "Cancel");
    assert_eq!(name(&harness), "look.ron");
    open(&mut harness);
    click(&mut harness, "Save");
    assert_eq!(
        name(&harness),
        "other.ron",
        "{:?}",
        harness.state().studio.told()
    );
    assert_ne!(looks.read("look.ron"), LOOK);
}

#[test]
fn files_are_dropped() {
    let looks = Looks::new();
    let mut harness = viewer(&looks);
    wait_for_picture(&mut harness);
    std::fs::copy(
        looks.path("turn.motion.ron"),
        looks.path("other.motion.ron"),
    )
    .unwrap();
    harness
        .state_mut()
        .studio
        .take_file(&looks.path("other.motion.ron"));
    harness.run_steps(3);
    assert!(
        text(&harness).contains(r#"motion: (file: "other.motion.ron")"#),
        "{}",
        text(&harness)
    );
    harness
        .state_mut()
        .studio
        .take_file(Path::new("letter.docx"));
    harness.run_steps(2);
    harness.get_by_label_contains("can be dropped here");
    for head in ["a.obj", "a.ply", "a.gltf", "a.glb", "a.vrm"] {
        harness.state_mut().studio.take_file(&looks.path(head));
        let is_head = format!("head: (shape: bust, file: \"{head}\")");
        assert!(text(&harness).contains(&is_head), "{}", text(&harness));
    }
    // What can't be written into a text isn't told to be there.
    let studio = &mut harness.state_mut().studio;
    studio.write(Preset, LOOK.replace("],\n)", ""), None);
    studio.take_file(&looks.path("other.motion.ron"));
    let told = studio.told().unwrap();
    assert!(
        !told.contains("is now") && !told.ends_with(" now"),
        "{told}"
    );
}

#[test]
fn changes_outlive_a_crash() {
    let looks = Looks::new();
    let copies = looks.path("copies");
    let size = Vec2::new(1280.0, 800.0);
    let open = || {
        let recovery = document::Recovery::in_folder(&copies);
        recovering(Some(looks.path("look.ron")), size, recovery)
    };
    let mut harness = open();
    wait_for_picture(&mut harness);
    harness.state_mut().studio.tool = Tool::Light;
    drag(&mut harness, [0.0, 0.0], [0.2, 0.1]);
    let changed = text(&harness);
    // The first copy may have been written during the drag: the last change is waited for.
    let is_kept = |app: &App| {
        let preset = app.studio.documents.as_ref().unwrap().preset();
        !preset.wants_recovery_copy()
            && std::fs::read_dir(&copies).is_ok_and(|mut entries| entries.next().is_some())
    };
    wait_for(&mut harness, "the copy of the last change", is_kept);
    // It ends without a word.
    drop(harness);
    assert_eq!(looks.read("look.ron"), LOOK);

    let mut harness = open();
    harness.run_steps(3);
    click(&mut harness, "Take the copy");
    assert_eq!(text(&harness), changed);
    undo(&mut harness);
    assert_eq!(text(&harness), LOOK);
}

/// Who was to close the window, and stays, is asked again what becomes of the copies.
#[test]
fn copies_are_offered_still_where_the_window_stays() {
    let looks = Looks::new();
    let recovery = document::Recovery::in_folder(&looks.path("copies"));
    let mut left = document::Document::open(&looks.path("look.ron"), &recovery).unwrap();
    left.edit(format!("// lost\n{LOOK}"), None);
    left.keep_recovery_copy();
    drop(left);
    let size = Vec2::new(1280.0, 800.0);
    let mut harness = recovering(Some(looks.path("look.ron")), size, recovery);
    harness.run_steps(3);
    let studio = &mut harness.state_mut().studio;
    assert!(matches!(studio.prompt, Some(Prompt::Recover)));
    studio.write(Preset, format!("{LOOK}// new"), None);
    let close = || eframe::egui::ViewportEvent::Close;
    for _ in 0..2 {
        let viewports = &mut harness.input_mut().viewports;
        viewports
            .values_mut()
            .for_each(|window| window.events.push(close()));
        harness.step();
        let prompt = &harness.state().studio.prompt;
        assert!(matches!(prompt, Some(Prompt::Unsaved(None))));
    }
    click(&mut harness, "Cancel");
    let prompt = &harness.state().studio.prompt;
    assert!(matches!(prompt, Some(Prompt::Recover)));
    click(&mut harness, "Take the copy");
    assert!(text(&harness).starts_with("// lost"));
}

#[test]
fn copies_are_offered_of_styles_that_are_opened_later() {
    let looks = Looks::new();
    let path = looks.path("other.style.ron");
    let own = looks.read("bob.style.ron");
    std::fs::write(&path, &own).unwrap();
    let recovery = document::Recovery::in_folder(&looks.path("copies"));
    let mut left = document::Document::open(&path, &recovery).unwrap();
    let lost = format!("// lost\n{own}");
    left.edit(lost.clone(), None);
    left.keep_recovery_copy();
    drop(left);

    let size = Vec2::new(1280.0, 800.0);
    let mut harness = recovering(Some(looks.path("look.ron")), size, recovery);
    harness.run_steps(3);
    assert!(harness.state().studio.prompt.is_none());
    let renamed = LOOK.replace("bob.style", "other.style");
    harness
        .state_mut()
        .studio
        .write(Preset, renamed.clone(), None);
    click(&mut harness, "Take the copy");
    let style = |harness: &Harness<App>| {
        let documents = harness.state().studio.documents.as_ref().unwrap();
        documents.get(Style).unwrap().text().to_string()
    };
    assert_eq!(style(&harness), lost);
    assert!(harness.state().studio.prompt.is_none());
    undo(&mut harness);
    assert_eq!(style(&harness), own);
    assert_eq!(text(&harness), renamed);
}

#[test]
fn a_file_that_both_changed_shows_both() {
    let looks = Looks::new();
    let mut harness = viewer(&looks);
    wait_for_picture(&mut harness);
    harness.state_mut().studio.tool = Tool::Light;
    drag(&mut harness, [0.0, 0.0], [0.2, 0.1]);
    let mine = text(&harness);
    let theirs = LOOK.replace("1.5", "3.5");
    std::fs::write(looks.path("look.ron"), &theirs).unwrap();
    wait_for_label(&mut harness, "was changed here and on the disk.");
    harness.get_by_label_contains("width: 3.5");
    // Saving before one is chosen loses nobody's change.
    press(&mut harness, COMMAND, Key::S);
    assert_eq!(looks.read("look.ron"), theirs);
    click(&mut harness, "Keep mine");
    press(&mut harness, COMMAND, Key::S);
    assert_eq!(looks.read("look.ron"), mine);
}

#[test]
fn a_file_deleted_while_open_is_written_again() {
    let looks = Looks::new();
    let mut harness = viewer(&looks);
    wait_for_picture(&mut harness);
    std::fs::remove_file(looks.path("look.ron")).unwrap();
    wait_for_label(&mut harness, "is no more on the disk");
    let studio = &harness.state().studio;
    assert!(
        studio.documents.as_ref().unwrap().is_changed(),
        "quitting asks"
    );
    press(&mut harness, COMMAND, Key::S);
    assert_eq!(looks.read("look.ron"), LOOK);
    assert!(
        !harness
            .state()
            .studio
            .documents
            .as_ref()
            .unwrap()
            .is_changed()
    );
}

#[test]
fn files_that_the_preset_names_are_watched() {
    let looks = Looks::new();
    let strands = "(version: 1, strands: [(size: 14, mirror: true, points: [(0.02, 1.619, 0), (0.058, 1.6, 0), (0.083, 1.55, 0.01)])])";
    std::fs::write(looks.path("few.strands.ron"), strands).unwrap();
    std::fs::write(
        looks.path("look.ron"),
        LOOK.replace("bob.style.ron", "few.strands.ron"),
    )
    .unwrap();
    let mut harness = viewer(&looks);
    wait_for_picture(&mut harness);
    let before = harness.state().studio.pixels(0).unwrap().to_vec();
    std::fs::write(
        looks.path("few.strands.ron"),
        strands.replace("0.083", "0.12"),
    )
    .unwrap();
    wait_for(&mut harness, "other hair", |app| {
        app.studio.is_sharp && app.studio.pixels(0).is_some_and(|pixels| pixels != before)
    });
}

/// Materials and their pictures, in folders of their own.
#[test]
fn files_that_a_mesh_names_are_watched() {
    let looks = Looks::new();
    std::fs::create_dir_all(looks.path("paint/pictures")).unwrap();
    let write = |name: &str, text: &str| std::fs::write(looks.path(name), text).unwrap();
    let paint = |name: &str, shade: u8| {
        let path = looks.path("paint/pictures").join(name);
        image::RgbImage::from_pixel(4, 4, image::Rgb([shade; 3]))
            .save(path)
            .unwrap();
    };
    paint("a.png", 250);
    paint("b.png", 20);
    let material = "newmtl paint\nmap_Kd pictures/a.png\n";
    write("paint/card.mtl", material);
    write(
        "card.obj",
        "mtllib paint/card.mtl\nv -0.2 1.4 0.2\nv 0.2 1.4 0.2\nv 0 1.8 0.2\nvt 0 0\nvt 1 0\nvt 0 1\n\
         usemtl paint\nf 1/1 2/2 3/3\n",
    );
    let text = LOOK.replace(
        "head: (shape: bust),",
        "head: (shape: bust), meshes: [(file: \"card.obj\")],",
    );
    write("look.ron", &text);
    let mut harness = viewer(&looks);
    wait_for_picture(&mut harness);
    for (what, change) in [
        ("another picture", &(|| paint("a.png", 120)) as &dyn Fn()),
        ("another material", &|| {
            write("paint/card.mtl", &material.replace("a.png", "b.png"))
        }),
        ("its picture", &|| paint("b.png", 200)),
    ] {
        let before = harness.state().studio.pixels(0).unwrap().to_vec();
        change();
        wait_for(&mut harness, what, |app| {
            app.studio.is_sharp && app.studio.pixels(0).is_some_and(|pixels| pixels != before)
        });
    }
    assert!(harness.state().studio.problems.is_empty());
}

#[test]
fn another_preset_that_is_compared_with_is_watched() {
    let looks = Looks::new();
    std::fs::create_dir(looks.path("other")).unwrap();
    let strands = "(version: 1, strands: [(size: 14, mirror: true, points: [(0.02, 1.619, 0), (0.058, 1.6, 0), (0.083, 1.55, 0.01)])])";
    let other = "(version: 1, hair: (file: \"few.strands.ron\"), head: (shape: bust), layers: [(effect: \"hair.base\")])";
    let write = |name: &str, text: &str| std::fs::write(looks.path(name), text).unwrap();
    write("other/few.strands.ron", strands);
    write("other/other.ron", other);
    let mut harness = viewer(&looks);
    wait_for_picture(&mut harness);
    let studio = &mut harness.state_mut().studio;
    studio.compare_with(&looks.path("other/other.ron")).unwrap();
    wait_for(&mut harness, "both", |app| {
        app.studio.is_sharp && app.studio.pixels(1).is_some()
    });
    for (what, name, text) in [
        (
            "other hair",
            "other/few.strands.ron",
            strands.replace("0.083", "0.12"),
        ),
        (
            "another look",
            "other/other.ron",
            other.replace("layers", "clump: (size: 2), layers"),
        ),
    ] {
        let before = harness.state().studio.pixels(1).unwrap().to_vec();
        write(name, &text);
        wait_for(&mut harness, what, |app| {
            app.studio.is_sharp && app.studio.pixels(1).is_some_and(|pixels| pixels != before)
        });
    }
}

#[test]
fn what_the_preset_builds_on_is_read_anew() {
    let looks = Looks::new();
    std::fs::write(looks.path("under.ron"), LOOK).unwrap();
    std::fs::write(
        looks.path("look.ron"),
        "(version: 1, base: \"under.ron\", light: (yaw: 50))",
    )
    .unwrap();
    let mut harness = viewer(&looks);
    wait_for_picture(&mut harness);
    assert_eq!(harness.state().studio.sections.camera.yaw, 20.0);
    std::fs::write(
        looks.path("under.ron"),
        LOOK.replace("(yaw: 20)", "(yaw: 35)"),
    )
    .unwrap();
    wait_for(&mut harness, "the camera of the file below", |app| {
        app.studio.sections.camera.yaw == 35.0
    });
    assert_eq!(harness.state().studio.sections.light.yaw, 50.0);
}

/// A look that says only what is otherwise than in `looks/under.ron`, with hair and script beside that.
fn based(looks: &Looks) {
    std::fs::create_dir(looks.path("looks")).unwrap();
    for name in ["bob.style.ron", "turn.motion.ron"] {
        std::fs::rename(looks.path(name), looks.path("looks").join(name)).unwrap();
    }
    std::fs::write(looks.path("looks/under.ron"), LOOK).unwrap();
    let look = "(version: 1, base: \"looks/under.ron\", light: (yaw: 50))";
    std::fs::write(looks.path("look.ron"), look).unwrap();
}

#[test]
fn style_and_script_of_the_base_are_changed() {
    let looks = Looks::new();
    based(&looks);
    let mut harness = viewer(&looks);
    wait_for_picture(&mut harness);
    let studio = &mut harness.state_mut().studio;
    assert_eq!(studio.track.spans.len(), 1);
    let documents = studio.documents.as_ref().unwrap();
    let style = documents.get(Style).unwrap().text().to_string();
    let script = documents.get(Motion).unwrap().path();
    assert_eq!(script, looks.path("looks/turn.motion.ron"));
    let before = studio.pixels(0).unwrap().to_vec();
    let more = style.replacen("count: 7", "count: 17", 1);
    studio.write(Style, more, None);
    wait_for(&mut harness, "other hair", |app| {
        app.studio.is_sharp && app.studio.pixels(0).is_some_and(|pixels| pixels != before)
    });
    assert!(harness.state().studio.problems.is_empty());

    // Another one that the base names from now on.
    std::fs::copy(
        looks.path("looks/turn.motion.ron"),
        looks.path("looks/other.motion.ron"),
    )
    .unwrap();
    let renamed = LOOK.replace("turn.motion", "other.motion");
    std::fs::write(looks.path("looks/under.ron"), renamed).unwrap();
    wait_for(&mut harness, "the other script", |app| {
        let documents = app.studio.documents.as_ref().unwrap();
        documents.get(Motion).unwrap().name() == "other.motion.ron"
    });
}

#[test]
fn a_first_look_is_drawn_once_its_files_are_mended() {
    let looks = Looks::new();
    based(&looks);
    let hair = "(version: 1, strands: [(size: 14, mirror: true, points: [(0.02, 1.619, 0), (0.058, 1.6, 0), (0.083, 1.55, 0.01)])])";
    let under = LOOK.replace("bob.style.ron", "hair/few.strands.ron");
    std::fs::write(looks.path("looks/under.ron"), "(version: 1,").unwrap();
    let mut harness = viewer(&looks);
    let is_told = |message: &'static str| {
        move |app: &App| {
            let problems = &app.studio.problems;
            problems.iter().any(|p| p.to_string().contains(message))
        }
    };
    wait_for(&mut harness, "the mistake", is_told("under.ron"));
    std::fs::write(looks.path("looks/under.ron"), &under).unwrap();
    wait_for(&mut harness, "the next", is_told("few.strands.ron"));
    assert!(harness.state().studio.shown[0].is_none());
    // Nor is the folder of its hair there before.
    std::fs::create_dir(looks.path("looks/hair")).unwrap();
    std::fs::write(looks.path("looks/hair/few.strands.ron"), hair).unwrap();
    wait_for_picture(&mut harness);
    assert!(harness.state().studio.problems.is_empty());
}

/// A style that was deleted when it was named, and isn't named any more, is missed by nobody, also later.
#[test]
fn a_deleted_style_that_is_not_named_leaves_no_copy() {
    let looks = Looks::new();
    let style = looks.read("bob.style.ron");
    std::fs::write(looks.path("other.style.ron"), &style).unwrap();
    let copies = looks.path("copies");
    let recovery = document::Recovery::in_folder(&copies);
    let size = Vec2::new(1280.0, 800.0);
    let mut harness = recovering(Some(looks.path("look.ron")), size, recovery);
    harness.run_steps(3);
    std::fs::remove_file(looks.path("bob.style.ron")).unwrap();
    let count = move || std::fs::read_dir(&copies).map_or(0, Iterator::count);
    wait_for(&mut harness, "the copy", |_| count() > 0);
    let renamed = LOOK.replace("bob.style", "other.style");
    harness.state_mut().studio.write(Preset, renamed, None);
    harness.run_steps(2);
    harness.state_mut().studio.save();
    assert_eq!(count(), 0);
}

/// A name that is typed letter by letter is another one for a moment: what it named comes back with it.
#[test]
fn a_deleted_style_outlives_a_name_that_is_being_typed() {
    let looks = Looks::new();
    let style = looks.read("bob.style.ron");
    let copies = looks.path("copies");
    let recovery = document::Recovery::in_folder(&copies);
    let size = Vec2::new(1280.0, 800.0);
    let mut harness = recovering(Some(looks.path("look.ron")), size, recovery);
    harness.run_steps(3);
    std::fs::remove_file(looks.path("bob.style.ron")).unwrap();
    let count = move || std::fs::read_dir(&copies).map_or(0, Iterator::count);
    wait_for(&mut harness, "the copy", |_| count() > 0);
    for text in [LOOK.replace("bob.style", "bo.style"), LOOK.to_owned()] {
        harness.state_mut().studio.write(Preset, text, None);
        harness.run_steps(2);
    }
    let documents = harness.state().studio.documents.as_ref().unwrap();
    let there = documents.get(Style).expect("the style is open");
    assert_eq!(&**there.text(), style);
}
