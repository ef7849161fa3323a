//! What an author does on the picture, and sees in it.

use crate::common::{LOOK, Looks, text, viewer, wait_for, wait_for_picture};
use crate::hands::{COMMAND, drag, press, redo, undo};
use eframe::egui::{Key, Modifiers};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use viewer::app::App;
use viewer::studio::Tool;

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
    undo(&mut harness);
    assert_eq!(text(&harness), changed);
    undo(&mut harness);
    assert_eq!(text(&harness), LOOK);
    redo(&mut harness);
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
    undo(&mut harness);
    assert_eq!(text(&harness), LOOK);
    press(&mut harness, Modifiers::NONE, Key::Num3);
    assert_eq!(harness.state().studio.camera().yaw, 90.0);
    press(&mut harness, Modifiers::NONE, Key::Num0);
    assert_eq!(harness.state().studio.camera().yaw, 20.0);
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
fn a_preset_with_mistakes_shows_nothing_of_the_one_before() {
    let looks = Looks::new();
    let broken = LOOK.replace("hair.base", "hair.bass");
    std::fs::write(looks.path("broken.ron"), broken).unwrap();
    let mut harness = viewer(&looks);
    wait_for_picture(&mut harness);
    // Also while a picture of the one before is under way.
    harness.state_mut().studio.transport.step(3);
    harness.step();
    harness.state_mut().studio.open(&looks.path("broken.ron"));
    let is_told = |app: &App, index: usize| {
        assert!(app.studio.shown[index].is_none());
        !app.studio.problems.is_empty() && !app.studio.is_drawing()
    };
    wait_for(&mut harness, "the mistake", |app| is_told(app, 0));
    // Nor does a comparison with it, with another one on the other side before.
    harness.state_mut().studio.open(&looks.path("look.ron"));
    wait_for_picture(&mut harness);
    let compare = |harness: &mut Harness<App>, name: &str| {
        let studio = &mut harness.state_mut().studio;
        studio.compare_with(&looks.path(name)).unwrap();
    };
    compare(&mut harness, "look.ron");
    wait_for(&mut harness, "the other picture", |app| {
        app.studio.shown[1].is_some()
    });
    compare(&mut harness, "broken.ron");
    wait_for(&mut harness, "the other's mistake", |app| is_told(app, 1));
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
fn only_a_picture_that_is_outdated_is_said_to_be() {
    let looks = Looks::new();
    std::fs::write(looks.path("broken.ron"), "(version: 1,").unwrap();
    let mut harness = viewer(&looks);
    wait_for_picture(&mut harness);
    let compared = harness
        .state_mut()
        .studio
        .compare_with(&looks.path("broken.ron"));
    compared.unwrap();
    let has_problems = |app: &App| !app.studio.problems.is_empty();
    wait_for(&mut harness, "the other's mistake", has_problems);
    let says_so = |harness: &Harness<App>| {
        let sentence = "The picture shows the last look without mistakes.";
        harness.query_by_label(sentence).is_some()
    };
    assert!(!says_so(&harness));
    harness.state_mut().studio.end_compare();
    wait_for(&mut harness, "no mistake", |app| !has_problems(app));
    let wrong = LOOK.replace("yaw: 20", "yaw: much");
    let studio = &mut harness.state_mut().studio;
    studio.write(viewer::documents::Which::Preset, wrong, None);
    wait_for(&mut harness, "the mistake", has_problems);
    assert!(says_so(&harness));
}
