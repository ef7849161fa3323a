//! Presets that build on another one: what the base says is shown, and what is changed is written into the preset alone.

use crate::pane::{Kind, Pane, click, names, node, open_all, set_number, shows};
use egui_kittest::Harness;
use egui_kittest::kittest::NodeT;

const LOOK: &str = r#"(
    version: 1,
    base: "twin-tails.ron",
    camera: (yaw: -10),
    layers: [
        (effect: "hair.fine"),
    ],
)
"#;

fn shown<'a>(kind: Kind) -> Harness<'a, Pane> {
    let mut harness = Pane::new(kind, LOOK).harness(300.0);
    open_all(&mut harness);
    harness
}

fn number(harness: &Harness<Pane>, name: &str) -> f64 {
    let value = node(harness, name).accesskit_node().numeric_value();
    value.unwrap_or_else(|| panic!("{name} has no number"))
}

#[test]
fn sections_show_what_the_base_says_and_write_what_is_otherwise() {
    let mut harness = shown(Kind::Look);
    assert_eq!(number(&harness, "camera yaw"), -10.0);
    assert_eq!(number(&harness, "camera pitch"), 4.0);
    set_number(&mut harness, "camera pitch", 9.0);
    let text = &harness.state().text;
    assert!(text.contains("camera: (yaw: -10, pitch: 9)"), "{text}");
    // Taken back, it is the base's again.
    click(&mut harness, "reset camera pitch");
    assert!(!harness.state().text.contains("pitch"));
    harness.run();
    assert_eq!(number(&harness, "camera pitch"), 4.0);
    assert!(shows(&harness, "F9DFCC"), "a colour of the base");
}

#[test]
fn layers_of_the_base_are_changed_by_their_names() {
    let mut harness = shown(Kind::Layers);
    for layer in [
        "contour",
        "inner",
        "hair.base",
        "hair.cel",
        "deep",
        "ring",
        "tail light",
    ] {
        assert!(
            names(&harness).contains(&format!("change layer {layer}")),
            "{layer}"
        );
    }
    click(&mut harness, "change layer contour");
    harness.run();
    open_all(&mut harness);
    assert!(!names(&harness).contains(&"change layer contour".to_owned()));
    assert_eq!(number(&harness, "contour width"), 2.8);
    set_number(&mut harness, "contour width", 4.0);
    let Pane { text, refused, .. } = harness.state();
    assert_eq!(*refused, Vec::<String>::new());
    assert!(
        text.contains(r#"(name: "contour", params: (width: 4))"#),
        "{text}"
    );
    // A new layer of the effect doesn't change the base's by its name.
    click(&mut harness, "add layer");
    click(&mut harness, "add hair.cel");
    let text = &harness.state().text;
    assert!(
        text.contains(r#"(effect: "hair.cel", name: "hair.cel-2")"#),
        "{text}"
    );
}

/// What has its effect by its name alone keeps it, and says all that it has under another one.
#[test]
fn layers_of_the_base_keep_their_names_and_are_copied_whole() {
    let look =
        r#"(version: 1, base: "twin-tails.ron", layers: [(name: "contour", params: (width: 4))])"#;
    let harness = copied_whole(look);
    let all = names(&harness);
    assert!(!all.contains(&"contour name".to_owned()), "{all:#?}");
    // One that says its effect, too, has as much of the base's.
    copied_whole(&look.replace("(name", r#"(effect: "hair.ink", name"#));
}

/// The pane of a look in which `contour` has been duplicated.
fn copied_whole(look: &str) -> Harness<'_, Pane> {
    let mut harness = Pane::new(Kind::Layers, look).harness(300.0);
    open_all(&mut harness);
    click(&mut harness, "duplicate layer contour");
    let Pane { text, refused, .. } = harness.state();
    assert_eq!(*refused, Vec::<String>::new());
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../presets");
    let registry = inkstrand::builtin_effects();
    let read = stage::Preset::parse_in(&folder, "look.ron", text, &registry).unwrap();
    let layer = |name: &str| read.layers.iter().find(|layer| layer.name == name).unwrap();
    let (own, copy) = (layer("contour"), layer("contour-2"));
    assert_eq!((own.rank, own.units), (copy.rank, copy.units));
    assert_eq!(own.depth_offset, copy.depth_offset);
    for index in 0..effects::AnyEffect::params(own.effect).len() {
        use effects::section::Section;
        assert_eq!(own.values.get(index), copy.values.get(index), "{text}");
    }
    harness
}

#[test]
fn layers_of_meshes_of_the_base_show_what_they_are_on() {
    let look = r#"(version: 1, base: "long-fringe.ron", layers: [(name: "eyes")])"#;
    let mut harness = Pane::new(Kind::Layers, look).harness(300.0);
    open_all(&mut harness);
    let on = node(&harness, "eyes on").accesskit_node().value();
    assert_eq!(on.as_deref(), Some("eyes, brows"));
    assert_eq!(number(&harness, "eyes through_hair"), 0.6);
}
