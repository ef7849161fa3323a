//! Layers: added, named, switched off, looked at alone, put in order, copied, taken away.

use crate::pane::{Kind, Pane, click, names, node, open_all, primary, shows, type_into};
use effects::preset::{LayerSpec, PresetErrors};
use effects::wgsl::Stroke;
use effects::{
    Input, Joints, Param, ParamKind, Parameters, Program, Registry, StrokeEffect, Values,
};
use eframe::egui::{Event, Key};
use egui_kittest::Harness;
use egui_kittest::kittest::NodeT;
use stage::Preset;

const LOOK: &str = r#"(
    version: 1,
    layers: [
        // Around the hair.
        (effect: "hair.silhouette", params: (width: 2.5)),
        (effect: "hair.base"),
        (effect: "hair.fine", name: "dark"), // loose hairs
    ],
)
"#;

fn shown<'a>(text: &str) -> Harness<'a, Pane> {
    let mut harness = Pane::new(Kind::Layers, text).harness(300.0);
    open_all(&mut harness);
    harness
}

fn read(text: &str, registry: &Registry) -> Result<Vec<String>, PresetErrors> {
    let name = |layer: &LayerSpec| layer.name.clone();
    let preset = Preset::parse("look.ron", text, registry)?;
    Ok(preset.layers.iter().map(name).collect())
}

/// The names of the layers, of a text that is a preset.
fn layers(harness: &Harness<Pane>) -> Vec<String> {
    let Pane {
        text,
        registry,
        refused,
        ..
    } = harness.state();
    assert_eq!(*refused, Vec::<String>::new());
    read(text, registry).unwrap_or_else(|errors| panic!("{errors}\n{text}"))
}

#[test]
fn layers_are_put_in_order_with_their_comments() {
    let mut harness = shown(LOOK);
    click(&mut harness, "move layer hair.silhouette down");
    click(&mut harness, "move layer dark up");
    assert_eq!(layers(&harness), ["hair.base", "dark", "hair.silhouette"]);
    let text = &harness.state().text;
    assert!(
        text.contains("// Around the hair.\n        (effect: \"hair.silhouette\""),
        "{text}"
    );
    // What was open is open in its new place.
    assert!(names(&harness).contains(&"hair.silhouette ratio".to_owned()));
}

#[test]
fn only_open_layers_stay_open_when_they_move() {
    let mut harness = Pane::new(Kind::Layers, LOOK).harness(300.0);
    click(&mut harness, "open layer hair.base");
    click(&mut harness, "move layer hair.base up");
    let has =
        |harness: &Harness<Pane>, name: &str| names(harness).iter().any(|known| known == name);
    assert!(has(&harness, "hair.base rank") && !has(&harness, "hair.silhouette rank"));
    click(&mut harness, "remove layer hair.base");
    assert!(!has(&harness, "hair.silhouette rank") && !has(&harness, "dark rank"));
}

#[test]
fn layers_are_dragged_to_another_place() {
    let mut harness = Pane::new(Kind::Layers, LOOK).harness(300.0);
    let from = node(&harness, "dark").rect().center();
    let to = node(&harness, "hair.silhouette").rect().center_top();
    harness.event(Event::PointerMoved(from));
    harness.event(primary(from, true));
    harness.run();
    for step in 1..=4 {
        harness.event(Event::PointerMoved(from.lerp(to, step as f32 / 4.0)));
        harness.run();
    }
    harness.event(primary(to, false));
    harness.run();
    assert_eq!(layers(&harness), ["dark", "hair.silhouette", "hair.base"]);
}

/// Undone while it is dragged, a layer that was there is dropped as nothing.
#[test]
fn a_layer_that_is_gone_may_be_dropped() {
    let mut harness = Pane::new(Kind::Layers, LOOK).harness(300.0);
    let from = node(&harness, "dark").rect().center();
    let to = node(&harness, "hair.silhouette").rect().center_top();
    harness.event(Event::PointerMoved(from));
    harness.event(primary(from, true));
    harness.run();
    harness.event(Event::PointerMoved(from.lerp(to, 0.5)));
    harness.run();
    let without = LOOK.replace(
        "(effect: \"hair.fine\", name: \"dark\"), // loose hairs",
        "",
    );
    harness.state_mut().text = without.clone();
    for step in 3..=4 {
        harness.event(Event::PointerMoved(from.lerp(to, step as f32 / 4.0)));
        harness.run();
    }
    harness.event(primary(to, false));
    harness.run();
    assert_eq!(harness.state().text, without);
}

#[test]
fn layers_are_added_under_names_of_their_own() {
    let mut harness = shown(LOOK);
    for effect in ["hair.highlight", "hair.base", "hair.base"] {
        click(&mut harness, "add layer");
        click(&mut harness, &format!("add {effect}"));
    }
    let expected = [
        "hair.silhouette",
        "hair.base",
        "dark",
        "hair.highlight",
        "hair.base-2",
        "hair.base-3",
    ];
    assert_eq!(layers(&harness), expected);
}

#[test]
fn a_first_layer_is_added() {
    for text in ["(version: 1)", "(version: 1, layers: [])"] {
        let mut harness = shown(text);
        click(&mut harness, "add layer");
        click(&mut harness, "add hair.base");
        assert_eq!(layers(&harness), ["hair.base"]);
    }
}

#[test]
fn layers_are_copied_and_removed() {
    let mut harness = shown(LOOK);
    click(&mut harness, "duplicate layer hair.silhouette");
    let expected = ["hair.silhouette", "hair.silhouette-2", "hair.base", "dark"];
    assert_eq!(layers(&harness), expected);
    assert_eq!(harness.state().text.matches("width: 2.5").count(), 2);
    click(&mut harness, "remove layer hair.silhouette");
    click(&mut harness, "remove layer dark");
    assert_eq!(layers(&harness), ["hair.silhouette-2", "hair.base"]);
    // The comments of what is gone went with it.
    let text = &harness.state().text;
    assert!(
        !text.contains("loose") && !text.contains("Around"),
        "{text}"
    );
}

#[test]
fn layers_are_renamed_and_keep_their_eyes() {
    let mut harness = shown(LOOK);
    click(&mut harness, "hide layer hair.base");
    type_into(&mut harness, "hair.base name", "flat");
    assert_eq!(layers(&harness), ["hair.silhouette", "flat", "dark"]);
    assert!(!harness.state().shown.is_shown("flat"));
    // Back to the effect's id.
    click(&mut harness, "reset flat name");
    assert_eq!(layers(&harness), ["hair.silhouette", "hair.base", "dark"]);
    assert_eq!(harness.state().text, LOOK);
}

#[test]
fn a_layer_gets_no_name_that_is_taken() {
    for name in ["dark", "light", "seed", "layers"] {
        let mut harness = shown(LOOK);
        type_into(&mut harness, "hair.base name", name);
        assert_eq!(harness.state().text, LOOK, "{name}");
    }
    let text = LOOK.replace("(effect: \"hair.base\")", "(effect: \"hair.fine\")");
    let mut harness = shown(&text);
    // The effect's id is another layer's name.
    click(&mut harness, "reset dark name");
    assert_eq!(harness.state().text, text);
}

#[test]
fn layers_are_switched_off_and_looked_at_alone_without_a_change_of_the_preset() {
    let mut harness = shown(LOOK);
    let seen = |harness: &Harness<Pane>| {
        let shown = &harness.state().shown;
        ["hair.silhouette", "hair.base", "dark"].map(|name| shown.is_shown(name))
    };
    click(&mut harness, "hide layer dark");
    assert_eq!(seen(&harness), [true, true, false]);
    click(&mut harness, "solo layer hair.base");
    assert_eq!(seen(&harness), [false, true, false]);
    click(&mut harness, "solo layer hair.base");
    click(&mut harness, "show layer dark");
    assert_eq!(seen(&harness), [true, true, true]);
    assert_eq!(harness.state().edits, []);
    // A layer that is gone hides no others.
    click(&mut harness, "solo layer dark");
    click(&mut harness, "remove layer dark");
    harness.run();
    assert_eq!(seen(&harness)[..2], [true, true]);
}

#[test]
fn layers_have_their_effects_rank_by_default() {
    let mut harness = shown(LOOK);
    let rank = |harness: &Harness<Pane>| node(harness, "hair.silhouette rank").value();
    let registry = inkstrand::builtin_effects();
    let own = registry.get("hair.silhouette").unwrap().rank().to_string();
    assert_eq!(rank(&harness), Some(own));
    type_into(&mut harness, "hair.silhouette rank", "-3");
    assert!(
        harness
            .state()
            .text
            .contains("params: (width: 2.5), rank: -3)"),
        "{}",
        harness.state().text
    );
    assert_eq!(layers(&harness).len(), 3);
}

#[test]
fn an_effect_that_is_not_there_is_told_and_replaced() {
    let text = LOOK.replace("hair.base", "hair.bass");
    let mut harness = shown(&text);
    let told = "there is no effect `hair.bass`, did you mean `hair.base`?";
    assert!(shows(&harness, told));
    click(&mut harness, "hair.bass effect");
    click(&mut harness, "hair.base");
    assert_eq!(harness.state().text, LOOK);
}

/// An effect of somebody else.
struct Glow;
struct GlowProgram;

impl Parameters for GlowProgram {
    type Params = f32;
    const PARAMS: &'static [Param] = &[
        Param {
            name: "halo",
            doc: "How far it shines.",
            unit: "lamps",
            kind: ParamKind::Number {
                min: 0.0,
                max: 9.0,
                default: 2.0,
                varies: true,
            },
        },
        Param {
            name: "drift",
            doc: "Where it goes.",
            unit: "",
            kind: ParamKind::Pair {
                min: -0.5,
                max: 0.5,
                default: [0.0, 0.25],
            },
        },
    ];
    const INPUTS: &'static [Input] = &[];
    const WGSL: &'static str = "";
    fn params(values: &Values) -> f32 {
        values.number("halo")
    }
}

impl Program for GlowProgram {
    fn stroke(_: &Joints, _: usize, _: u32, _: u32, halo: &f32) -> Stroke {
        Stroke {
            offset: effects::wgsl::vec2([0.0; 2]),
            radius: *halo,
            depth_offset: 0.0,
            color: effects::wgsl::vec3([0.0; 3]),
        }
    }
}

impl StrokeEffect for Glow {
    type Program = GlowProgram;
    const ID: &'static str = "theirs.glow";
    const DOC: &'static str = "a glow around hair";
}

#[test]
fn a_third_partys_effect_has_its_panel() {
    let mut pane = Pane::new(Kind::Layers, LOOK);
    pane.registry.register::<Glow>().unwrap();
    let mut harness = pane.harness(300.0);
    click(&mut harness, "add layer");
    click(&mut harness, "add theirs.glow");
    open_all(&mut harness);
    type_into(&mut harness, "theirs.glow halo", "3.5");
    type_into(&mut harness, "theirs.glow drift x", "7");
    let text = &harness.state().text;
    assert!(
        text.contains("params: (halo: 3.5, drift: (0.5, 0.25))"),
        "{text}"
    );
    assert_eq!(
        layers(&harness).last().map(String::as_str),
        Some("theirs.glow")
    );
    let halo = node(&harness, "theirs.glow halo");
    let help = halo
        .accesskit_node()
        .data()
        .description()
        .unwrap_or_default()
        .to_owned();
    assert!(
        help.contains("How far it shines.\nUnit: lamps.\nTakes a number from 0 to 9.\nDefault: 2."),
        "{help}"
    );
}

#[test]
fn a_search_opens_what_it_finds_and_closes_it_again() {
    let mut pane = Pane::new(Kind::Layers, LOOK);
    pane.search = "PER_strand".to_owned();
    let mut harness = pane.harness(300.0);
    let found = names(&harness);
    assert!(found.contains(&"dark per_strand".to_owned()), "{found:#?}");
    assert!(
        !found
            .iter()
            .any(|name| name.contains("hair.base") || name == "dark color"),
        "{found:#?}"
    );
    // By what stands in its help.
    harness.state_mut().search = "line grows nothing".to_owned();
    harness.run();
    let found = names(&harness);
    assert!(
        found.contains(&"hair.silhouette root_fade".to_owned()),
        "{found:#?}"
    );
    assert!(
        !found.contains(&"hair.silhouette width".to_owned()),
        "{found:#?}"
    );
    harness.state_mut().search.clear();
    harness.run();
    assert!(!names(&harness).contains(&"hair.silhouette root_fade".to_owned()));
}

#[test]
fn everything_is_done_by_keys() {
    let mut harness = Pane::new(Kind::Layers, LOOK).harness(300.0);
    // To the first triangle, and open it.
    for key in [Key::Tab, Key::Space] {
        harness.key_press(key);
        harness.run();
    }
    assert!(names(&harness).contains(&"hair.silhouette width".to_owned()));
    let order = [
        "hide layer hair.silhouette",
        "solo layer hair.silhouette",
        "hair.silhouette",
    ];
    for name in order {
        harness.key_press(Key::Tab);
        harness.run();
        let focused = node(&harness, name).is_focused();
        // The title is no stop of its own: its triangle does the same.
        assert_eq!(focused, name != "hair.silhouette", "{name}");
    }
}
