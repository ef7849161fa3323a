//! Each kind of parameter by keyboard and by assistive technology.

use crate::pane::{Kind, Pane, click, names, node, open_all, set_number, shows, type_into};
use egui_kittest::Harness;
use stage::Preset;

const LOOK: &str = r#"// A look.
(
    version: 1,
    // Seen from the left.
    camera: (yaw: 28, /* up */ pitch: 5, target: (0, -0.5, 0)),
    head: (light: "fbe2ce"), // skin
    layers: [(effect: "hair.base")],
)
"#;

fn look<'a>() -> Harness<'a, Pane> {
    let mut harness = Pane::new(Kind::Look, LOOK).harness(300.0);
    open_all(&mut harness);
    harness
}

/// The text, of which nothing but the marked part may have changed.
fn is(harness: &Harness<Pane>, old: &str, new: &str) {
    assert!(LOOK.contains(old), "{old}");
    assert_eq!(harness.state().text, LOOK.replace(old, new));
    assert_eq!(harness.state().refused, Vec::<String>::new());
}

#[test]
fn numbers_are_typed_with_or_without_their_unit() {
    let mut harness = look();
    type_into(&mut harness, "camera yaw", "30.5");
    is(&harness, "yaw: 28", "yaw: 30.5");
    type_into(&mut harness, "camera yaw", "-12,25°");
    is(&harness, "yaw: 28", "yaw: -12.25");
}

#[test]
fn numbers_go_up_and_down_by_keys_and_sliders() {
    use eframe::egui::Key;
    let mut harness = look();
    node(&harness, "camera yaw").focus();
    harness.run();
    harness.key_press(Key::ArrowUp);
    harness.run();
    assert!(
        harness.state().text.contains("yaw: 30"),
        "{}",
        harness.state().text
    );
    set_number(&mut harness, "camera yaw slider", 100.0);
    is(&harness, "yaw: 28", "yaw: 100");
}

#[test]
fn numbers_out_of_range_come_to_its_end_and_say_so() {
    let mut harness = look();
    type_into(&mut harness, "camera pitch", "100");
    is(&harness, "pitch: 5", "pitch: 90");
    assert!(shows(&harness, "`100` is not from -90 to 90: 90 was taken"));
    let mut harness = look();
    set_number(&mut harness, "camera pitch", -1000.0);
    is(&harness, "pitch: 5", "pitch: -90");
    assert!(shows(&harness, "`-1000` is not from -90 to 90"));
    let mut harness = look();
    type_into(&mut harness, "camera pitch", "steep");
    is(&harness, "pitch: 5", "pitch: 5");
    assert!(shows(&harness, "`steep` is no number"));
    assert_eq!(harness.state().edits.len(), 0);
}

#[test]
fn what_is_not_in_the_text_is_added_where_it_belongs() {
    let mut harness = look();
    type_into(&mut harness, "light pitch", "33");
    let text = harness.state().text.clone();
    assert!(text.contains("    light: (pitch: 33),\n"), "{text}");
    let registry = inkstrand::builtin_effects();
    assert!(
        Preset::parse("look.ron", &text, &registry).is_ok(),
        "{text}"
    );
}

#[test]
fn defaults_come_back_with_a_button_that_is_there_when_needed() {
    let mut harness = look();
    assert!(!names(&harness).contains(&"reset camera fov".to_owned()));
    click(&mut harness, "reset camera pitch");
    is(&harness, "/* up */ pitch: 5, ", "");
    assert!(!names(&harness).contains(&"reset camera pitch".to_owned()));
    // Nothing that a preset must have can be taken out.
    assert!(!names(&harness).contains(&"reset preset version".to_owned()));
}

#[test]
fn whole_numbers_stay_whole() {
    let mut harness = look();
    type_into(&mut harness, "preset seed", "7.6");
    assert!(
        harness.state().text.contains("seed: 8"),
        "{}",
        harness.state().text
    );
    set_number(&mut harness, "path subdivision slider", 9.2);
    assert!(
        harness.state().text.contains("path: (subdivision: 9)"),
        "{}",
        harness.state().text
    );
}

#[test]
fn flags_and_choices() {
    let mut harness = look();
    click(&mut harness, "motion repeat");
    assert!(harness.state().text.contains("motion: (repeat: true)"));
    click(&mut harness, "motion repeat");
    assert!(harness.state().text.contains("motion: (repeat: false)"));
    click(&mut harness, "path brush");
    click(&mut harness, "semicircle");
    assert!(
        harness.state().text.contains("path: (brush: semicircle)"),
        "{}",
        harness.state().text
    );
}

#[test]
fn choices_are_made_by_keys_alone() {
    use eframe::egui::Key;
    let mut harness = look();
    node(&harness, "path brush").focus();
    harness.run();
    harness.key_press(Key::Space);
    harness.run();
    node(&harness, "semicircle").focus();
    harness.run();
    harness.key_press(Key::Enter);
    harness.run();
    assert!(
        harness.state().text.contains("brush: semicircle"),
        "{}",
        harness.state().text
    );
}

#[test]
fn colours_keep_their_digits() {
    let mut harness = look();
    // Looked at, it stays as it was written.
    harness.run_steps(3);
    assert_eq!(harness.state().text, LOOK);
    type_into(&mut harness, "head light hex", "#3fc1c0");
    is(&harness, "\"fbe2ce\"", "\"3FC1C0\"");
    type_into(&mut harness, "head light hex", "skin");
    is(&harness, "\"fbe2ce\"", "\"3FC1C0\"");
    assert!(shows(&harness, "`skin` is no colour"));
}

#[test]
fn a_colour_may_be_none_and_is_remembered() {
    let mut harness = look();
    type_into(&mut harness, "scene background hex", "101112");
    click(&mut harness, "scene background none");
    assert!(harness.state().text.contains("scene: (background: none)"));
    click(&mut harness, "scene background none");
    assert!(
        harness
            .state()
            .text
            .contains("scene: (background: \"101112\")")
    );
}

#[test]
fn texts_are_taken_on_enter_and_given_up_on_escape() {
    use eframe::egui::Key;
    let mut harness = look();
    type_into(&mut harness, "hair file", "styles/a \"b\".style.ron");
    assert!(
        harness
            .state()
            .text
            .contains(r#"hair: (file: "styles/a \"b\".style.ron")"#),
        "{}",
        harness.state().text
    );
    node(&harness, "hair file").focus();
    harness.run();
    node(&harness, "hair file").type_text("x");
    harness.run();
    harness.key_press(Key::Escape);
    harness.run();
    assert_eq!(harness.state().edits.len(), 1);
    // Nothing in it is what the preset says by leaving it out.
    node(&harness, "hair file").set_text_value_accesskit("");
    harness.run();
    assert!(
        harness.state().text.contains("hair: ()"),
        "{}",
        harness.state().text
    );
}

#[test]
fn several_numbers_that_belong_together() {
    let mut harness = look();
    type_into(&mut harness, "camera target y", "-0.25");
    is(&harness, "(0, -0.5, 0)", "(0, -0.25, 0)");
    type_into(&mut harness, "scene size height", "540");
    assert!(
        harness.state().text.contains("scene: (size: (960, 540))"),
        "{}",
        harness.state().text
    );
    type_into(&mut harness, "scene size width", "0");
    assert!(
        harness.state().text.contains("scene: (size: (1, 540))"),
        "{}",
        harness.state().text
    );
}

#[test]
fn what_cannot_be_read_is_shown_and_mended() {
    let text = LOOK.replace("yaw: 28", "yaw: left, pich: 4");
    let mut harness = Pane::new(Kind::Look, &text).harness(300.0);
    open_all(&mut harness);
    assert!(shows(
        &harness,
        "expected a number from -360 to 360, found `left`"
    ));
    assert!(shows(
        &harness,
        "there is no `pich` here, did you mean `pitch`?"
    ));
    // What is no value would break the whole text.
    type_into(&mut harness, "camera yaw", "3)");
    assert_eq!(harness.state().text, text);
    assert!(shows(&harness, "`3)` is not one value"));
    type_into(&mut harness, "camera yaw", "12");
    click(&mut harness, "reset camera pich");
    is(&harness, "yaw: 28", "yaw: 12");
}

const VARIED: &str = r#"(
    version: 1,
    layers: [
        (effect: "hair.highlight", name: "shine", params: (width: (curve: [(0, 1), (1, 3)]), thinnest: 2)),
    ],
)"#;

fn varied<'a>() -> Harness<'a, Pane> {
    let mut harness = Pane::new(Kind::Layers, VARIED).harness(300.0);
    open_all(&mut harness);
    harness
}

fn says(harness: &Harness<Pane>, part: &str) {
    let text = &harness.state().text;
    assert!(text.contains(part), "{part} in {text}");
    let registry = inkstrand::builtin_effects();
    if let Err(errors) = Preset::parse("look.ron", text, &registry) {
        panic!("{errors}\n{text}");
    }
}

#[test]
fn numbers_vary_along_the_strand() {
    let mut harness = varied();
    // A constant becomes a curve, and a number again.
    click(&mut harness, "shine thinnest variation");
    click(&mut harness, "shine thinnest along the strand");
    says(&harness, "thinnest: (curve: [(0, 2), (1, 2)])");
    type_into(&mut harness, "shine thinnest point 2 value", "0.5");
    says(&harness, "thinnest: (curve: [(0, 2), (1, 0.5)])");
    click(&mut harness, "shine thinnest add point");
    says(
        &harness,
        "thinnest: (curve: [(0, 2), (0.5, 1.25), (1, 0.5)])",
    );
    type_into(&mut harness, "shine thinnest point 2 place", "0.25");
    says(&harness, "(0.25, 1.25)");
    // A place stays between its neighbours'.
    type_into(&mut harness, "shine thinnest point 1 place", "0.75");
    says(
        &harness,
        "thinnest: (curve: [(0.25, 2), (0.25, 1.25), (1, 0.5)])",
    );
    click(&mut harness, "shine thinnest remove point 2");
    says(&harness, "thinnest: (curve: [(0.25, 2), (1, 0.5)])");
    type_into(&mut harness, "shine thinnest vary", "0.2");
    says(
        &harness,
        "thinnest: (curve: [(0.25, 2), (1, 0.5)], vary: 0.2)",
    );
    click(&mut harness, "shine thinnest along the strand");
    says(&harness, "thinnest: (value: 2, vary: 0.2)");
    type_into(&mut harness, "shine thinnest", "3");
    says(&harness, "thinnest: (value: 3, vary: 0.2)");
    type_into(&mut harness, "shine thinnest vary", "0");
    says(&harness, "thinnest: 3");
}

#[test]
fn curves_are_drawn_with_the_pointer() {
    use eframe::egui::{Event, Key, Modifiers, PointerButton, Pos2, vec2};
    let mut harness = varied();
    // The curve in little opens the large one.
    click(&mut harness, "shine width");
    let rect = node(&harness, "shine width curve").rect();
    let press = |harness: &mut Harness<Pane>, pos: Pos2, button, pressed| {
        harness.event(Event::PointerMoved(pos));
        harness.event(Event::PointerButton {
            pos,
            button,
            pressed,
            modifiers: Modifiers::NONE,
        });
        harness.run();
    };
    let primary = PointerButton::Primary;
    // The tip's point is dragged to the floor.
    let axes = rect.shrink(8.0);
    let tip = axes.right_bottom() - vec2(0.0, axes.height() * 3.0 / 10.0);
    press(&mut harness, tip, primary, true);
    harness.event(Event::PointerMoved(tip + vec2(0.0, 10.0)));
    harness.run();
    harness.event(Event::PointerMoved(axes.right_bottom()));
    harness.run();
    press(&mut harness, axes.right_bottom(), primary, false);
    says(&harness, "width: (curve: [(0, 1), (1, 0)])");
    // It is the selected one; two are as few as a curve has, one is a number.
    harness.key_press(Key::Delete);
    harness.run();
    says(&harness, "width: 1,");
}

#[test]
fn a_double_click_adds_a_point_and_the_other_button_removes_it() {
    use eframe::egui::{Event, Modifiers, PointerButton};
    let mut harness = varied();
    click(&mut harness, "shine width variation");
    let axes = node(&harness, "shine width curve").rect().shrink(8.0);
    for button in [PointerButton::Primary; 2] {
        harness.event(Event::PointerMoved(axes.center()));
        for pressed in [true, false] {
            harness.event(Event::PointerButton {
                pos: axes.center(),
                button,
                pressed,
                modifiers: Modifiers::NONE,
            });
        }
        harness.step();
    }
    harness.run();
    says(&harness, "width: (curve: [(0, 1), (0.5, 5), (1, 3)])");
    harness.event(Event::PointerMoved(axes.center()));
    for pressed in [true, false] {
        harness.event(Event::PointerButton {
            pos: axes.center(),
            button: PointerButton::Secondary,
            pressed,
            modifiers: Modifiers::NONE,
        });
    }
    harness.run();
    says(&harness, "width: (curve: [(0, 1), (1, 3)])");
}
