//! Pictures that are written.

use crate::common::{Looks, text, viewer, wait_for, wait_for_picture};
use crate::hands::{COMMAND, click, drag, press, wait_for_label};
use eframe::egui::{Key, Modifiers};
use egui_kittest::kittest::Queryable;
use viewer::studio::Tool;

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
