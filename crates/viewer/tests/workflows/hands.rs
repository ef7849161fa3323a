//! An author's hands: mouse and keyboard on a viewer without a window.

use eframe::egui::{Key, Modifiers, Pos2, Rect, Vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use std::path::Path;
use viewer::app::App;

pub const COMMAND: Modifiers = Modifiers::COMMAND;

pub fn click(harness: &mut Harness<App>, label: &str) {
    // A window takes some frames to find its place.
    harness.run_steps(4);
    harness.get_by_label(label).click();
    harness.run_steps(2);
}

pub fn press(harness: &mut Harness<App>, modifiers: Modifiers, key: Key) {
    harness.key_press_modifiers(modifiers, key);
    harness.run_steps(2);
}

/// Takes the last step back.
pub fn undo(harness: &mut Harness<App>) {
    press(harness, COMMAND, Key::Z);
}

/// Makes the step again that was taken back last.
pub fn redo(harness: &mut Harness<App>) {
    press(harness, COMMAND.plus(Modifiers::SHIFT), Key::Z);
}

pub fn picture(harness: &Harness<App>) -> Rect {
    harness.get_by_label("The picture").rect()
}

/// Drags on the picture, in parts of its size from its middle, and lets go.
pub fn drag(harness: &mut Harness<App>, from: [f32; 2], to: [f32; 2]) {
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
pub fn type_path(harness: &mut Harness<App>, path: &Path) {
    let field = harness.get_by_label("Path");
    field.focus();
    harness.step();
    press(harness, COMMAND, Key::A);
    harness
        .get_by_label("Path")
        .type_text(&path.display().to_string());
    harness.run_steps(2);
}

pub fn wait_for_label(harness: &mut Harness<App>, label: &str) {
    for _ in 0..2_000 {
        if harness.query_by_label_contains(label).is_some() {
            return;
        }
        std::thread::sleep(std::time::Duration::from_millis(10));
        harness.step();
    }
    panic!("there is no `{label}`");
}
