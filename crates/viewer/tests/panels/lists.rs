//! Hair styles and motion scripts: lists of parts, and places on the head.

use crate::pane::{
    Kind, Pane, click, names, node, open_all, primary, set_number, shows, type_into,
};
use egui_kittest::Harness;
use std::path::Path;

const STYLE: &str = r#"(
    version: 1,
    zones: [
        // Over the brow.
        (name: "fringe", count: 4, roots: [(-70, 72), (0, 79), (70, 72)], tips: [(-56, 1), (188, 4)]),
        (name: "tail", form: tail, roots: [(104, 38)], hang: 2),
    ],
    edits: [(zone: "fringe", clump: 3, size: 2), (zone: "tail", clump: 0)],
)
"#;

const SCRIPT: &str = r#"(
    version: 1,
    moves: [(move: turn, start: 0.25, angle: 55), (move: nod, start: 2)],
    keys: [(time: 0), (time: 1, turn: (40, 0, 0))],
    shapes: [(time: 0, hair: "a.style.ron", at: 2)],
    hold: (900, 500, 150),
)
"#;

fn shown<'a>(kind: Kind, text: &str) -> Harness<'a, Pane> {
    let mut harness = Pane::new(kind, text).harness(300.0);
    open_all(&mut harness);
    harness
}

/// Asserts that the text says something, and is a style or a script.
fn says(harness: &Harness<Pane>, part: &str) {
    let Pane {
        kind,
        text,
        refused,
        ..
    } = harness.state();
    assert_eq!(*refused, Vec::<String>::new());
    assert!(text.contains(part), "{part} in {text}");
    let checked = match kind {
        Kind::Style => stage::check_style(Path::new("a.style.ron"), text),
        _ => stage::check_motion(
            Path::new("a.motion.ron"),
            &text.replace(", hair: \"a.style.ron\", at: 2", ""),
        ),
    };
    if let Err(errors) = checked {
        panic!("{errors}\n{text}");
    }
}

#[test]
fn zones_are_added_copied_moved_and_removed() {
    let mut harness = shown(Kind::Style, STYLE);
    click(&mut harness, "add zone");
    says(&harness, "(name: \"zone\", roots: [(-40, 60), (40, 60)]");
    click(&mut harness, "duplicate zone fringe");
    says(&harness, "(name: \"fringe-2\", count: 4,");
    click(&mut harness, "move zone tail up");
    says(
        &harness,
        "(name: \"tail\", form: tail, roots: [(104, 38)], hang: 2),\n        (name: \"fringe-2\"",
    );
    // What changes its clumps goes with a zone.
    click(&mut harness, "remove zone fringe");
    says(&harness, "edits: [(zone: \"tail\", clump: 0)]");
    assert!(
        !harness.state().text.contains("brow"),
        "{}",
        harness.state().text
    );
}

#[test]
fn the_last_hair_stays() {
    let mut harness = shown(Kind::Style, STYLE);
    click(&mut harness, "remove zone fringe");
    let node = node(&harness, "remove zone tail");
    assert!(egui_kittest::kittest::NodeT::accesskit_node(&node).is_disabled());
    click(&mut harness, "add strand");
    says(
        &harness,
        "strands: [(points: [(0, 60, 0.05), (0, 20, 0.1)])]",
    );
    click(&mut harness, "remove zone tail");
    says(&harness, "zones: [");
}

#[test]
fn hair_wears_what_is_added() {
    let mut harness = shown(Kind::Style, STYLE);
    click(&mut harness, "add accessory");
    says(&harness, "accessories: [(kind: clip, at: [(40, 30)])]");
    click(&mut harness, "open accessory 1");
    type_into(&mut harness, "accessory 1 size", "0.1");
    says(&harness, "(kind: clip, at: [(40, 30)], size: 0.1)");
    click(&mut harness, "duplicate accessory 1");
    click(&mut harness, "remove accessory 1");
    says(
        &harness,
        "accessories: [(kind: clip, at: [(40, 30)], size: 0.1)]",
    );
}

#[test]
fn edits_follow_the_name_of_their_zone_and_have_its_clumps() {
    let mut harness = shown(Kind::Style, STYLE);
    type_into(&mut harness, "zone fringe name", "bangs");
    says(
        &harness,
        "edits: [(zone: \"bangs\", clump: 3, size: 2), (zone: \"tail\", clump: 0)]",
    );
    type_into(&mut harness, "edit 1: bangs 3 clump", "9");
    says(&harness, "clump: 3,");
    type_into(&mut harness, "edit 1: bangs 3 clump", "1");
    says(&harness, "clump: 1,");
    click(&mut harness, "add edit");
    says(&harness, ", (zone: \"bangs\", clump: 0)]");
}

/// What is typed into a change of a clump is taken where it was typed, also in the frame in which changes before it go.
#[test]
fn what_is_typed_as_a_zone_goes_stays_where_it_is() {
    let mut harness = shown(Kind::Style, STYLE);
    let size = "edit 2: tail 0 size";
    node(&harness, size).focus();
    harness.run();
    harness.key_press_modifiers(eframe::egui::Modifiers::COMMAND, eframe::egui::Key::A);
    node(&harness, size).type_text("3");
    harness.run();
    // All in one frame, as where the window is slow.
    let pos = node(&harness, "remove zone fringe").rect().center();
    let moved = eframe::egui::Event::PointerMoved(pos);
    let events = &mut harness.input_mut().events;
    events.extend([moved, primary(pos, true), primary(pos, false)]);
    harness.step();
    says(&harness, "edits: [(zone: \"tail\", clump: 0, size: 3)]");
    assert_eq!(harness.state().refused, Vec::<String>::new());
}

#[test]
fn names_of_zones_are_unique_and_those_of_edits_are_there() {
    let mut harness = shown(Kind::Style, STYLE);
    type_into(&mut harness, "zone fringe name", "tail");
    assert!(shows(&harness, "there is already a zone \"tail\""));
    type_into(&mut harness, "edit 2: tail 0 zone", "tial");
    assert!(shows(
        &harness,
        "there is no zone \"tial\", did you mean `tail`?"
    ));
    node(&harness, "zone fringe name").set_text_value_accesskit("");
    harness.run();
    assert!(shows(&harness, "it can't be left out"));
    assert_eq!(harness.state().text, STYLE);
}

#[test]
fn places_are_typed_as_text() {
    let mut harness = shown(Kind::Style, STYLE);
    type_into(&mut harness, "zone fringe roots", "hairline(30, 179)");
    says(&harness, "roots: hairline(30, 179)");
    type_into(&mut harness, "zone fringe roots", "[(0, 100)]");
    says(&harness, "roots: hairline(30, 179)");
    type_into(&mut harness, "zone fringe roots", "parting");
    says(&harness, "roots: parting");
    // It can't be left out, tips can.
    node(&harness, "zone fringe roots").set_text_value_accesskit("");
    harness.run();
    says(&harness, "roots: parting");
    assert!(!names(&harness).contains(&"reset zone fringe roots".to_owned()));
    click(&mut harness, "add zone tail tips");
    says(&harness, "hang: 2, tips: [(-40, 20), (40, 20)])");
    click(&mut harness, "reset zone tail tips");
    assert!(harness.state().text.contains("hang: 2)"));
    for name in ["whorl", "parting", "hairline"] {
        click(&mut harness, &format!("add style {name}"));
        says(&harness, name);
    }
}

#[test]
fn places_are_numbers_too() {
    let mut harness = shown(Kind::Style, STYLE);
    type_into(&mut harness, "zone fringe roots point 2 latitude", "60.5");
    says(&harness, "[(-70, 72), (0, 60.5), (70, 72)]");
    click(&mut harness, "zone fringe roots remove point 1");
    says(&harness, "[(0, 60.5), (70, 72)]");
    click(&mut harness, "zone fringe roots add point");
    says(&harness, "[(0, 60.5), (70, 72), (140, 83.5)]");
    // The last place stays.
    assert!(!names(&harness).contains(&"zone tail roots remove point 1".to_owned()));
    click(&mut harness, "add style hairline");
    open_all(&mut harness);
    type_into(&mut harness, "style hairline point 2 longitude", "170");
    says(&harness, "(73.5, 33)");
}

#[test]
fn places_are_dragged_on_the_map() {
    use eframe::egui::{Event, Pos2, pos2};
    let mut harness = shown(Kind::Style, STYLE);
    let map = node(&harness, "zone fringe map").rect().shrink(7.0);
    let at = |longitude: f32, latitude: f32| {
        pos2(
            map.left() + (longitude + 180.0) / 360.0 * map.width(),
            map.top() + (90.0 - latitude) / 180.0 * map.height(),
        )
    };
    let drag = |harness: &mut Harness<Pane>, from: Pos2, to: Pos2| {
        harness.event(Event::PointerMoved(from));
        harness.event(primary(from, true));
        harness.run();
        for share in [0.5, 1.0] {
            harness.event(Event::PointerMoved(from.lerp(to, share)));
            harness.run();
        }
        harness.event(primary(to, false));
        harness.run();
    };
    drag(&mut harness, at(-70.0, 72.0), at(-90.0, 45.0));
    says(&harness, "[(-90, 45), (0, 79), (70, 72)]");
    // Longitude 188 is beside the back on the right, and stays beyond 180.
    drag(&mut harness, at(-172.0, 4.0), at(-150.0, -30.0));
    says(&harness, "tips: [(-56, 1), (210, -30)]");
}

#[test]
fn keys_and_shapes_stay_in_the_order_of_their_times() {
    let mut harness = shown(Kind::Motion, SCRIPT);
    type_into(&mut harness, "key 1: 0 s time", "5");
    says(&harness, "keys: [(time: 0.999),");
    click(&mut harness, "add key");
    says(&harness, "(time: 1.5)]");
    click(&mut harness, "duplicate key 2: 1 s");
    says(
        &harness,
        "(time: 1, turn: (40, 0, 0)), (time: 1.25, turn: (40, 0, 0)), (time: 1.5)]",
    );
    click(&mut harness, "add shape");
    says(&harness, "(time: 0.5)]");
    assert!(!names(&harness).contains(&"move key 1: 0 s down".to_owned()));
}

#[test]
fn what_needs_another_goes_with_it() {
    let mut harness = shown(Kind::Motion, SCRIPT);
    click(&mut harness, "reset shape 1: 0 s hair");
    says(&harness, "shapes: [(time: 0)]");
    click(&mut harness, "remove shape 1: 0 s");
    says(&harness, "shapes: []");
    assert!(!harness.state().text.contains("hold"));
    assert!(!names(&harness).contains(&"script hold x".to_owned()));
}

#[test]
fn moves_and_winds_are_added_and_changed() {
    let mut harness = shown(Kind::Motion, SCRIPT);
    click(&mut harness, "add wind");
    open_all(&mut harness);
    type_into(&mut harness, "wind 1: at 0 s speed", "7");
    says(&harness, "winds: [(speed: 7)]");
    click(&mut harness, "move move 2: nod at 2 s up");
    says(&harness, "moves: [(move: nod, start: 2), (move: turn");
    type_into(&mut harness, "move 1: nod at 2 s angle", "12");
    says(&harness, "(move: nod, start: 2, angle: 12)");
}

#[test]
fn passes_of_a_look_are_added_set_moved_and_removed() {
    let look = "(\n    version: 1,\n    layers: [],\n)\n";
    let mut harness = shown(Kind::Look, look);
    let passes = |harness: &Harness<Pane>| {
        let Pane { text, refused, .. } = harness.state();
        assert_eq!(*refused, Vec::<String>::new());
        let registry = inkstrand::builtin_effects();
        match stage::Preset::parse("look.ron", text, &registry) {
            Ok(preset) => preset.passes,
            Err(errors) => panic!("{errors}\n{text}"),
        }
    };
    assert!(passes(&harness).is_empty());
    click(&mut harness, "add pass");
    click(&mut harness, "add pass");
    open_all(&mut harness);
    type_into(&mut harness, "pass 2: strand width", "4");
    assert_eq!(passes(&harness)[1].width.as_constant(), Some(4.0));
    click(&mut harness, "move pass 2: strand up");
    assert_eq!(passes(&harness)[0].width.as_constant(), Some(4.0));
    click(&mut harness, "remove pass 2: strand");
    let left = passes(&harness);
    assert_eq!((left.len(), left[0].width.as_constant()), (1, Some(4.0)));
}

/// Points that are nearer to each other than hands put them are a style's own.
#[test]
fn opening_points_changes_nothing() {
    let style = STYLE.replace(
        "version: 1,",
        "version: 1, hairline: [(0, 30), (0.2, 31), (0.4, 30), (180, -20)],",
    );
    let mut harness = shown(Kind::Style, &style);
    assert_eq!(harness.state().edits, []);
    // What is chosen is within the limits.
    set_number(&mut harness, "style hairline point 3 longitude", 200.0);
    says(&harness, "(179.5, 30)");
}

#[test]
fn a_mesh_is_of_a_file_or_of_a_shape() {
    let mut harness = shown(Kind::Look, "(version: 1, layers: [])");
    click(&mut harness, "add mesh");
    open_all(&mut harness);
    click(&mut harness, "mesh 1: mesh.obj shape");
    click(&mut harness, "gear");
    let meshes = |harness: &Harness<Pane>| {
        let text = &harness.state().text;
        text[text.find("meshes").unwrap()..].to_owned()
    };
    assert_eq!(meshes(&harness), "meshes: [(shape: gear)])");
    open_all(&mut harness);
    assert!(names(&harness).contains(&"open mesh 1: gear".to_owned()));
    type_into(&mut harness, "mesh 1: gear file", "eyes.obj");
    assert_eq!(meshes(&harness), "meshes: [(file: \"eyes.obj\")])");
}
