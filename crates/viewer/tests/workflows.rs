//! What an author does, from the first to the last step, on a viewer without a window.

mod common;

use common::{LOOK, Looks, text, viewer, viewer_of, wait_for, wait_for_picture};
use eframe::egui::{Key, Modifiers, Pos2, Rect, Vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use std::path::Path;
use viewer::app::App;
use viewer::panes::Pane;
use viewer::studio::Tool;

const COMMAND: Modifiers = Modifiers::COMMAND;

fn click(harness: &mut Harness<App>, label: &str) {
    // A window takes some frames to find its place.
    harness.run_steps(4);
    harness.get_by_label(label).click();
    harness.run_steps(2);
}

fn press(harness: &mut Harness<App>, modifiers: Modifiers, key: Key) {
    harness.key_press_modifiers(modifiers, key);
    harness.run_steps(2);
}

fn picture(harness: &Harness<App>) -> Rect {
    harness.get_by_label("The picture").rect()
}

/// Drags on the picture, in parts of its size from its middle, and lets go.
fn drag(harness: &mut Harness<App>, from: [f32; 2], to: [f32; 2]) {
    let rect = picture(harness);
    let at = |[x, y]: [f32; 2]| rect.center() + Vec2::new(x * rect.width(), y * rect.height());
    harness.hover_at(at(from));
    harness.step();
    harness.drag_at(at(from));
    harness.step();
    for step in 1..=4 {
        let share = step as f32 / 4.0;
        let between: Pos2 = at(from).lerp(at(to), share);
        harness.hover_at(between);
        harness.step();
    }
    harness.drop_at(at(to));
    harness.run_steps(2);
}

/// Writes into the prompt's path.
fn type_path(harness: &mut Harness<App>, path: &Path) {
    let field = harness.get_by_label("Path");
    field.focus();
    harness.step();
    press(harness, COMMAND, Key::A);
    harness
        .get_by_label("Path")
        .type_text(&path.display().to_string());
    harness.run_steps(2);
}

#[test]
fn the_light_is_dragged_taken_back_and_saved() {
    let looks = Looks::new();
    let mut harness = viewer(&looks);
    wait_for_picture(&mut harness);
    harness.state_mut().studio.tool = Tool::Light;
    drag(&mut harness, [0.0, 0.0], [0.2, 0.1]);
    let changed = text(&harness);
    // The light, and nothing else: comments and layout are the author's.
    let line = changed
        .lines()
        .find(|line| line.contains("light:"))
        .unwrap();
    assert_eq!(
        changed.replace(line, "    light: (yaw: 40, pitch: 45),"),
        LOOK
    );
    assert_ne!(changed, LOOK);
    assert!(line.contains("pitch: -"), "light from below: {line}");

    // A drag is one step, and the next drag of the same is another.
    drag(&mut harness, [0.2, 0.1], [-0.2, 0.1]);
    assert_ne!(text(&harness), changed);
    press(&mut harness, COMMAND, Key::Z);
    assert_eq!(text(&harness), changed);
    press(&mut harness, COMMAND, Key::Z);
    assert_eq!(text(&harness), LOOK);
    press(
        &mut harness,
        Modifiers {
            shift: true,
            ..COMMAND
        },
        Key::Z,
    );
    assert_eq!(text(&harness), changed);
    assert_eq!(
        looks.read("look.ron"),
        LOOK,
        "nothing is written before it is saved"
    );
    press(&mut harness, COMMAND, Key::S);
    assert_eq!(looks.read("look.ron"), changed);
}

#[test]
fn the_view_is_turned_and_written_into_the_preset() {
    let looks = Looks::new();
    let mut harness = viewer(&looks);
    wait_for_picture(&mut harness);
    drag(&mut harness, [0.0, 0.0], [0.2, 0.0]);
    assert_eq!(
        text(&harness),
        LOOK,
        "a view is not the preset's before it is written"
    );
    let yaw = harness.state().studio.camera().yaw;
    assert!(yaw < 19.0, "{yaw}");
    press(&mut harness, Modifiers::NONE, Key::K);
    let found = text(&harness);
    assert!(
        found.contains("// from the right") && found.contains("// A bob for tests."),
        "{found}"
    );
    assert!((harness.state().studio.sections.camera.yaw - yaw).abs() < 1e-3);
    // All of the view is one step.
    press(&mut harness, COMMAND, Key::Z);
    assert_eq!(text(&harness), LOOK);
    press(&mut harness, Modifiers::NONE, Key::Num3);
    assert_eq!(harness.state().studio.camera().yaw, 90.0);
    press(&mut harness, Modifiers::NONE, Key::Num0);
    assert_eq!(harness.state().studio.camera().yaw, 20.0);
}

#[test]
fn a_preset_that_breaks_while_open_shows_its_last_good_look() {
    let looks = Looks::new();
    let mut harness = viewer(&looks);
    wait_for_picture(&mut harness);
    let broken = LOOK.replace("width: 1.5", "widht: 1.5");
    std::fs::write(looks.path("look.ron"), &broken).unwrap();
    wait_for(&mut harness, "the mistake", |app| {
        !app.studio.problems.is_empty()
    });
    let told = harness.state().studio.problems[0].to_string();
    assert!(
        told.contains("look.ron:12:46") && told.contains("did you mean `width`"),
        "{told}"
    );
    assert!(harness.state().studio.shown[0].is_some());
    harness.get_by_label_contains("did you mean `width`");
    harness.get_by_label_contains("last look without mistakes");
    // Mended from outside, as editors do it: written beside and renamed.
    std::fs::write(looks.path("new"), LOOK.replace("1.5", "2.5")).unwrap();
    std::fs::rename(looks.path("new"), looks.path("look.ron")).unwrap();
    wait_for(&mut harness, "the end of the mistake", |app| {
        app.studio.problems.is_empty()
    });
    assert!(text(&harness).contains("2.5"));
}

#[test]
fn an_export_is_what_the_command_line_draws() {
    let looks = Looks::new();
    let mut harness = viewer(&looks);
    wait_for_picture(&mut harness);
    harness.state_mut().studio.tool = Tool::Light;
    drag(&mut harness, [0.0, 0.0], [0.2, -0.2]);
    press(&mut harness, Modifiers::NONE, Key::Num2);
    press(&mut harness, Modifiers::NONE, Key::Period);
    press(&mut harness, COMMAND, Key::E);
    click(&mut harness, "Save and export");
    wait_for(&mut harness, "the picture's file", |_| {
        looks.path("look.png").is_file()
    });
    harness.run_steps(3);
    harness.get_by_label_contains("wrote ");
    assert_eq!(looks.read("look.ron"), text(&harness));
    let drawn = std::fs::read(looks.path("look.png")).unwrap();

    // The line that is shown draws the same.
    let studio = &harness.state().studio;
    let state = studio.export_state().unwrap();
    assert!(state.view.is_some() && state.time_s > 0.0);
    let preset = looks.path("look.ron").display().to_string();
    let line: Vec<String> = ["render", &preset, "-o"].map(String::from).into();
    let camera = state.view.unwrap();
    let view = format!("{},{},{}", camera.yaw, camera.pitch, camera.distance);
    let time = state.time_s.to_string();
    let output = looks.path("again.png").display().to_string();
    let more = [
        output,
        "--camera".to_owned(),
        view,
        "--time".to_owned(),
        time,
    ];
    let arguments: Vec<String> = line.into_iter().chain(more).collect();
    inkstrand::render_with(&arguments, &inkstrand::builtin_effects(), &mut |_| true).unwrap();
    assert!(std::fs::read(looks.path("again.png")).unwrap() == drawn);
}

#[test]
fn what_is_shown_at_rest_is_what_the_command_line_draws() {
    let looks = Looks::new();
    let mut harness = viewer(&looks);
    wait_for_picture(&mut harness);
    let shown = harness.state().studio.shown[0].as_ref().unwrap();
    let [width, height] = shown.drawn.size_px;
    let output = looks.path("x.png").display().to_string();
    let preset = looks.path("look.ron").display().to_string();
    let size = format!("{width}x{height}");
    let arguments = [
        "render",
        &preset,
        "-o",
        &output,
        "--size",
        &size,
        "--backend",
        "cpu",
    ]
    .map(String::from);
    inkstrand::render_with(&arguments, &inkstrand::builtin_effects(), &mut |_| true).unwrap();
    let file = image::open(looks.path("x.png")).unwrap().to_rgba8();
    assert!(
        *file == *harness.state().studio.pixels(0).unwrap(),
        "{size}"
    );
}

#[test]
fn a_sequence_is_cancelled() {
    let looks = Looks::new();
    let mut harness = viewer(&looks);
    wait_for_picture(&mut harness);
    press(&mut harness, COMMAND, Key::E);
    click(&mut harness, "a sequence");
    click(&mut harness, "Export");
    wait_for(&mut harness, "the first frame", |_| {
        looks.path("look.0000.png").is_file()
    });
    click(&mut harness, "Cancel");
    wait_for_label(&mut harness, "cancelled");
    assert!(!looks.path("look.0047.png").exists());
    click(&mut harness, "Close");
    assert!(harness.state().studio.prompt.is_none());
}

fn wait_for_label(harness: &mut Harness<App>, label: &str) {
    for _ in 0..2_000 {
        if harness.query_by_label_contains(label).is_some() {
            return;
        }
        std::thread::sleep(std::time::Duration::from_millis(10));
        harness.step();
    }
    panic!("there is no `{label}`");
}

#[test]
fn a_new_look_begins_with_a_style() {
    let looks = Looks::new();
    let mut harness = viewer_of(None);
    harness.run_steps(3);
    press(&mut harness, COMMAND, Key::N);
    // A name that is taken is refused, in place.
    type_path(&mut harness, &looks.path("look.ron"));
    click(&mut harness, "Write");
    harness.get_by_label_contains("is already there");
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
fn time_runs_steps_and_loops() {
    let looks = Looks::new();
    let mut harness = viewer(&looks);
    wait_for_picture(&mut harness);
    let time = |harness: &Harness<App>| harness.state().studio.transport.shown_s();
    press(&mut harness, Modifiers::NONE, Key::Period);
    press(&mut harness, Modifiers::NONE, Key::Period);
    assert_eq!(time(&harness), 2.0 / 24.0);
    press(&mut harness, Modifiers::NONE, Key::Comma);
    assert_eq!(time(&harness), 1.0 / 24.0);
    click(&mut harness, "Play or pause");
    // The script ends after 0.6 s, and hair gets two more.
    harness.run_steps(60);
    assert!(time(&harness) > 0.8 && harness.state().studio.transport.is_playing);
    harness.run_steps(110);
    assert!(time(&harness) < 0.8, "it begins again: {}", time(&harness));
    press(&mut harness, Modifiers::NONE, Key::Space);
    assert!(!harness.state().studio.transport.is_playing);
    press(&mut harness, Modifiers::NONE, Key::Home);
    assert_eq!(time(&harness), 0.0);
}

#[test]
fn the_head_is_dragged_and_hair_follows() {
    let looks = Looks::new();
    let mut harness = viewer(&looks);
    wait_for_picture(&mut harness);
    let before = harness.state().studio.pixels(0).unwrap().to_vec();
    harness.state_mut().studio.tool = Tool::Head;
    drag(&mut harness, [0.0, 0.0], [0.15, 0.0]);
    assert!(!harness.state().studio.grip.hand().is_idle());
    assert!(
        harness.state().studio.transport.is_playing,
        "a hand lets time run"
    );
    harness.run_steps(10);
    press(&mut harness, Modifiers::NONE, Key::Space);
    wait_for_picture(&mut harness);
    assert!(harness.state().studio.pixels(0).unwrap() != before);
    press(&mut harness, Modifiers::NONE, Key::Home);
    wait_for_picture(&mut harness);
    assert!(
        harness.state().studio.pixels(0).unwrap() == before,
        "at the beginning all is as it was"
    );
}

#[test]
fn two_states_are_compared() {
    let looks = Looks::new();
    let mut harness = viewer(&looks);
    wait_for_picture(&mut harness);
    press(&mut harness, COMMAND, Key::K);
    harness.state_mut().studio.tool = Tool::Light;
    drag(&mut harness, [0.2, 0.0], [0.3, 0.3]);
    wait_for(&mut harness, "both pictures", |app| {
        app.studio.shown[1].is_some() && app.studio.is_sharp
    });
    let [now, before] = [0, 1].map(|index| harness.state().studio.pixels(index).unwrap().to_vec());
    assert_ne!(now, before);
    // The line between is dragged as itself.
    harness.state_mut().studio.tool = Tool::View;
    let yaw = harness.state().studio.camera().yaw;
    drag(&mut harness, [0.0, 0.2], [0.25, 0.2]);
    assert_eq!(harness.state().studio.camera().yaw, yaw);
    assert!(harness.state().studio.compare.as_ref().unwrap().split > 0.6);
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
}

#[test]
fn an_edited_style_is_seen_before_it_is_saved() {
    let looks = Looks::new();
    let mut harness = viewer(&looks);
    wait_for_picture(&mut harness);
    let before = harness.state().studio.pixels(0).unwrap().to_vec();
    let style = looks.read("bob.style.ron");
    let other = style.replacen("count: ", "count: 1", 1);
    assert_ne!(style, other);
    harness
        .state_mut()
        .studio
        .write(viewer::documents::Which::Style, other.clone(), None);
    wait_for_picture(&mut harness);
    assert!(
        harness.state().studio.problems.is_empty(),
        "{:?}",
        harness.state().studio.problems
    );
    assert!(harness.state().studio.pixels(0).unwrap() != before);
    assert_eq!(looks.read("bob.style.ron"), style);
    press(&mut harness, COMMAND, Key::S);
    assert_eq!(looks.read("bob.style.ron"), other);
}

#[test]
fn every_pane_is_shown_in_windows_of_any_size() {
    let looks = Looks::new();
    for size in [Vec2::new(640.0, 480.0), Vec2::new(3840.0, 2160.0)] {
        let mut harness = common::sized(Some(looks.path("look.ron")), size);
        wait_for_picture(&mut harness);
        for pane in [
            Pane::Layers,
            Pane::Look,
            Pane::Style,
            Pane::Motion,
            Pane::Text,
            Pane::Presets,
        ] {
            harness.state_mut().show_pane(pane);
            harness.run_steps(3);
            assert!(picture(&harness).width() > 100.0, "{pane:?} at {size}");
        }
        press(&mut harness, Modifiers::NONE, Key::F1);
        harness.get_by_label("Turn the head");
    }
}

#[test]
fn changes_outlive_a_crash() {
    let looks = Looks::new();
    let copies = looks.path("copies");
    let size = Vec2::new(1280.0, 800.0);
    let open = || {
        let recovery = document::Recovery::in_folder(&copies);
        common::recovering(Some(looks.path("look.ron")), size, recovery)
    };
    let mut harness = open();
    wait_for_picture(&mut harness);
    harness.state_mut().studio.tool = Tool::Light;
    drag(&mut harness, [0.0, 0.0], [0.2, 0.1]);
    let changed = text(&harness);
    let is_kept = || std::fs::read_dir(&copies).is_ok_and(|mut entries| entries.next().is_some());
    wait_for(&mut harness, "the copy", |_| is_kept());
    // It ends without a word.
    drop(harness);
    assert_eq!(looks.read("look.ron"), LOOK);

    let mut harness = open();
    harness.run_steps(3);
    click(&mut harness, "Take the copy");
    assert_eq!(text(&harness), changed);
    press(&mut harness, COMMAND, Key::Z);
    assert_eq!(text(&harness), LOOK);
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
fn at_rest_the_window_sleeps() {
    let looks = Looks::new();
    let mut harness = viewer(&looks);
    wait_for_picture(&mut harness);
    // It fails where frames go on being asked for.
    let frames = harness.try_run().expect("the window sleeps");
    assert!(frames < 20, "{frames}");
    // While time runs it doesn't.
    press(&mut harness, Modifiers::NONE, Key::Space);
    assert!(harness.state().studio.transport.is_playing);
    let before = harness.state().studio.transport.frame();
    harness.run_steps(30);
    assert!(harness.state().studio.transport.frame() > before);
}

#[test]
fn layers_are_switched_off_for_the_eye_alone() {
    let looks = Looks::new();
    let mut harness = viewer(&looks);
    wait_for_picture(&mut harness);
    let before = harness.state().studio.pixels(0).unwrap().to_vec();
    harness
        .state_mut()
        .studio
        .layers
        .hidden
        .insert("hair.base".to_owned());
    wait_for_picture(&mut harness);
    assert!(harness.state().studio.pixels(0).unwrap() != before);
    assert_eq!(
        text(&harness),
        LOOK,
        "what is looked at is not the preset's"
    );
    let only = harness.state().studio.export_state().unwrap().only;
    assert_eq!(only, ["hair.silhouette"]);
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
fn changes_of_different_texts_are_taken_back_in_their_order() {
    use viewer::documents::Which::{Motion, Preset};
    let looks = Looks::new();
    let mut harness = viewer(&looks);
    harness.run_steps(3);
    let write = |harness: &mut Harness<App>, which, text: &str| {
        harness
            .state_mut()
            .studio
            .write(which, text.to_owned(), None);
        harness.step();
    };
    let [first, third] = ["1.6", "1.7"].map(|width| LOOK.replace("1.5", width));
    let second = common::SCRIPT.replace("40", "50");
    write(&mut harness, Preset, &first);
    write(&mut harness, Motion, &second);
    write(&mut harness, Preset, &third);
    let texts = |harness: &Harness<App>| {
        let documents = harness.state().studio.documents.as_ref().unwrap();
        [Preset, Motion].map(|which| documents.get(which).unwrap().text().to_string())
    };
    press(&mut harness, COMMAND, Key::Z);
    assert_eq!(texts(&harness), [first.clone(), second]);
    press(&mut harness, COMMAND, Key::Z);
    assert_eq!(texts(&harness), [first, common::SCRIPT.to_owned()]);
    press(&mut harness, COMMAND, Key::Z);
    assert_eq!(
        texts(&harness),
        [LOOK.to_owned(), common::SCRIPT.to_owned()]
    );
    for _ in 0..3 {
        press(
            &mut harness,
            Modifiers {
                shift: true,
                ..COMMAND
            },
            Key::Z,
        );
    }
    assert_eq!(texts(&harness)[0], third);
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
fn a_preset_with_mistakes_shows_nothing_of_the_one_before() {
    let looks = Looks::new();
    std::fs::write(
        looks.path("broken.ron"),
        LOOK.replace("hair.base", "hair.bass"),
    )
    .unwrap();
    let mut harness = viewer(&looks);
    wait_for_picture(&mut harness);
    harness.state_mut().studio.open(&looks.path("broken.ron"));
    wait_for(&mut harness, "the mistake", |app| {
        !app.studio.problems.is_empty()
    });
    assert!(harness.state().studio.shown[0].is_none());
    // Nor does a comparison with it.
    harness.state_mut().studio.open(&looks.path("look.ron"));
    wait_for_picture(&mut harness);
    harness
        .state_mut()
        .studio
        .compare_with(&looks.path("broken.ron"))
        .unwrap();
    wait_for(&mut harness, "the other's mistake", |app| {
        !app.studio.problems.is_empty()
    });
    assert!(harness.state().studio.shown[1].is_none());
}

#[test]
fn nothing_is_exported_where_nothing_is_shown() {
    let looks = Looks::new();
    let mut harness = viewer(&looks);
    wait_for_picture(&mut harness);
    let hidden = ["hair.base", "hair.silhouette"].map(String::from);
    harness.state_mut().studio.layers.hidden.extend(hidden);
    wait_for_picture(&mut harness);
    press(&mut harness, COMMAND, Key::E);
    harness.get_by_label_contains("nothing to draw");
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
