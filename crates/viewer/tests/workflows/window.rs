//! The window: time, panes, sleep.

use crate::common::{LOOK, Looks, recovering, sized, viewer, wait_for_picture};
use crate::hands::{click, picture, press};
use eframe::egui::{Key, Modifiers, Pos2, Rect, Vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use std::time::{Duration, Instant};
use viewer::actions::Action;
use viewer::app::App;
use viewer::documents::Which::Preset;
use viewer::panes::Pane;

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

/// A character whose head rises for eight seconds.
fn write_riser(looks: &Looks) {
    let numbers = [0.0_f32, 8.0, 0.0, 0.0, 0.0, 0.0, 0.1, 0.0];
    let bytes: Vec<u8> = numbers.iter().flat_map(|x| x.to_le_bytes()).collect();
    std::fs::write(looks.path("riser.bin"), bytes).unwrap();
    let text = r#"{
        "asset": {"version": "2.0"},
        "nodes": [{"name": "head"}],
        "buffers": [{"byteLength": 32, "uri": "riser.bin"}],
        "bufferViews": [{"buffer": 0, "byteLength": 8}, {"buffer": 0, "byteOffset": 8, "byteLength": 24}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 2, "type": "SCALAR"},
            {"bufferView": 1, "componentType": 5126, "count": 2, "type": "VEC3"}
        ],
        "animations": [{
            "samplers": [{"input": 0, "output": 1}],
            "channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}]
        }]
    }"#;
    std::fs::write(looks.path("riser.gltf"), text).unwrap();
}

#[test]
fn time_goes_as_far_as_an_animation() {
    let looks = Looks::new();
    write_riser(&looks);
    let script = "motion: (file: \"turn.motion.ron\"";
    let animated = LOOK.replace(script, &format!("{script}, gltf: \"riser.gltf\""));
    std::fs::write(looks.path("look.ron"), animated).unwrap();
    let mut harness = viewer(&looks);
    wait_for_picture(&mut harness);
    let transport = &mut harness.state_mut().studio.transport;
    assert_eq!(transport.span_s(), 8.0);
    transport.seek(7.5);
    assert_eq!(transport.shown_s(), 7.5);
}

#[test]
fn every_pane_is_shown_in_windows_of_any_size() {
    let looks = Looks::new();
    for size in [Vec2::new(640.0, 480.0), Vec2::new(3840.0, 2160.0)] {
        let mut harness = sized(Some(looks.path("look.ron")), size);
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
fn every_prompt_fits_a_small_window() {
    let looks = Looks::new();
    let size = Vec2::new(640.0, 480.0);
    let mut harness = sized(Some(looks.path("look.ron")), size);
    wait_for_picture(&mut harness);
    for (action, last) in [
        (Action::New, "Cancel"),
        (Action::Open, "Cancel"),
        (Action::SaveAs, "Cancel"),
        (Action::Export, "Close"),
        (Action::Help, "Close"),
    ] {
        harness.state_mut().studio.act(action);
        // A window takes some frames to find its place.
        harness.run_steps(5);
        let rect = harness.get_by_label(last).rect();
        let window = Rect::from_min_size(Pos2::ZERO, size);
        assert!(
            window.shrink(8.0).contains_rect(rect),
            "{action:?}: {rect:?}"
        );
        harness.get_by_label(last).click();
        harness.run_steps(3);
        assert!(harness.state().studio.prompt.is_none(), "{action:?}");
    }
}

#[test]
fn pictures_have_the_pixels_of_the_screen() {
    let looks = Looks::new();
    for density in [1.0, 1.5, 2.0] {
        let mut harness = sized(Some(looks.path("look.ron")), Vec2::new(1280.0, 800.0));
        harness.set_pixels_per_point(density);
        wait_for_picture(&mut harness);
        let place = picture(&harness);
        let shown = harness.state().studio.shown[0].as_ref().unwrap();
        let [width, height] = shown.drawn.size_px.map(|side| side as f32);
        assert!(width <= density * place.width() + 1.0);
        let fills = |side: f32, place: f32| (side - density * place).abs() <= 1.0;
        assert!(
            fills(width, place.width()) || fills(height, place.height()),
            "{width} x {height} in {place:?}"
        );
    }
}

/// One that lies behind another tab is not drawn as time runs, but what is edited is read, and its mistakes are told.
#[test]
fn a_picture_that_nobody_sees_is_not_drawn() {
    let looks = Looks::new();
    let mut harness = viewer(&looks);
    wait_for_picture(&mut harness);
    let studio = &mut harness.state_mut().studio;
    for time_s in [0.1, 0.2, 0.3] {
        studio.transport.seek(time_s);
        studio.before_frame();
        studio.after_frame();
        assert!(!studio.is_drawing(), "{time_s}");
    }
    studio.write(Preset, LOOK.replace("1.5", "1.6"), None);
    studio.before_frame();
    studio.after_frame();
    assert!(studio.is_drawing());
    wait_for_picture(&mut harness);
    let shown = harness.state().studio.shown[0].as_ref().unwrap();
    let [there, drawn] = [&harness.state().studio.picture_px, &shown.drawn.size_px];
    assert_eq!(there, drawn);
    harness.state_mut().studio.transport.seek(0.4);
    harness.step();
    assert!(harness.state().studio.is_drawing());
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
fn a_change_wakes_the_window_once_for_its_copy() {
    let looks = Looks::new();
    let copies = looks.path("copies");
    let recovery = document::Recovery::in_folder(&copies);
    let size = Vec2::new(1280.0, 800.0);
    let mut harness = recovering(Some(looks.path("look.ron")), size, recovery);
    wait_for_picture(&mut harness);
    // How long the last frame asked the window to sleep.
    let sleep = |harness: &Harness<App>| {
        let windows = harness.output().viewport_output.values();
        windows.map(|window| window.repaint_delay).min().unwrap()
    };
    let pitches = ["pitch: 30", "pitch: 31"];
    let changed = pitches.map(|pitch| LOOK.replace("pitch: 45", pitch));
    for text in &changed {
        let studio = &mut harness.state_mut().studio;
        studio.write(Preset, text.clone(), None);
        wait_for_picture(&mut harness);
    }
    harness.run();
    // On a slow machine it has its copy already.
    let until_copied = sleep(&harness);
    if until_copied < Duration::MAX {
        assert!(until_copied <= Duration::from_secs(1), "{until_copied:?}");
        std::thread::sleep(until_copied);
        harness.step();
    }
    let copied = std::fs::read_dir(&copies).unwrap();
    let copied = copied.map(|entry| entry.unwrap().path());
    let copied = copied.filter(|path| path.extension().is_some_and(|ending| ending == "recovery"));
    let copied: Vec<String> = copied
        .map(|path| std::fs::read_to_string(path).unwrap())
        .collect();
    assert_eq!(copied.len(), 1);
    assert!(copied[0].ends_with(&changed[1]), "{}", copied[0]);
    harness.run();
    // A picture that is still being drawn on a slow machine wakes it, too.
    let deadline = Instant::now() + Duration::from_secs(10);
    while sleep(&harness) < Duration::MAX && Instant::now() < deadline {
        std::thread::sleep(Duration::from_millis(5));
        harness.run();
    }
    assert_eq!(sleep(&harness), Duration::MAX);
}
