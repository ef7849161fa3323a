//! A pane that shows a text and does what it asks for.

use effects::Registry;
use eframe::egui::accesskit::Toggled;
use eframe::egui::{Event, Modifiers, PointerButton, Pos2};
use egui_kittest::kittest::{NodeT, Queryable};
use egui_kittest::{Harness, Node};
use viewer::edit::Edit;
use viewer::inherited::Inherited;
use viewer::layers_shown::LayersShown;
use viewer::panels;

/// Which pane.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    Layers,
    Look,
    Style,
    Motion,
}

/// What is shown, and what was asked for.
pub struct Pane {
    pub kind: Kind,
    pub registry: Registry,
    pub text: String,
    pub search: String,
    pub shown: LayersShown,
    /// All edits so far.
    pub edits: Vec<Edit>,
    /// Edits that the text didn't allow.
    pub refused: Vec<String>,
    /// What the base says, and of which text: it isn't read in each frame.
    pub inherited: (String, Inherited),
}

impl Pane {
    pub fn new(kind: Kind, text: &str) -> Self {
        Self {
            kind,
            registry: inkstrand::builtin_effects(),
            text: text.to_owned(),
            search: String::new(),
            shown: LayersShown::default(),
            edits: Vec::new(),
            refused: Vec::new(),
            inherited: Default::default(),
        }
    }

    /// Shows the pane at that width, as high as it gets.
    pub fn harness<'a>(self, width: f32) -> Harness<'a, Self> {
        Harness::builder()
            .with_size([width, 20_000.0])
            .with_step_dt(0.05)
            .build_ui_state(Self::frame, self)
    }

    pub fn frame(ui: &mut eframe::egui::Ui, pane: &mut Self) {
        let mut edits = Vec::new();
        let (text, search) = (pane.text.clone(), pane.search.clone());
        if matches!(pane.kind, Kind::Layers | Kind::Look) && pane.inherited.0 != text {
            pane.inherited = (text.clone(), inherited(&text, &pane.registry));
        }
        match pane.kind {
            Kind::Layers => {
                let Self {
                    registry, shown, ..
                } = pane;
                let inherited = &pane.inherited.1;
                panels::layers(ui, &text, inherited, registry, shown, &search, &mut edits);
            }
            Kind::Look => {
                panels::look(ui, &text, &pane.inherited.1, &search, &mut edits);
            }
            Kind::Style => panels::style(ui, &text, &search, &mut edits),
            Kind::Motion => panels::motion_script(ui, &text, &search, &mut edits),
        }
        for edit in edits {
            match edit.apply(&pane.text) {
                Ok(text) => pane.text = text,
                Err(error) => pane.refused.push(format!("{edit:?}: {error}")),
            }
            pane.edits.push(edit);
        }
    }
}

/// What the base of a preset says, as the window knows it: nothing of one that has none, or mistakes.
fn inherited(text: &str, registry: &Registry) -> Inherited {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../presets");
    let read = stage::Preset::parse_in(&folder, "look.ron", text, registry);
    read.map_or_else(|_| Inherited::default(), |read| Inherited::below(&read))
}

/// Names of all nodes that have one.
pub fn names(harness: &Harness<Pane>) -> Vec<String> {
    let nodes = harness.root().children_recursive();
    nodes
        .filter_map(|node| node.accesskit_node().label())
        .collect()
}

/// Opens all parts, also those within parts.
pub fn open_all(harness: &mut Harness<Pane>) {
    // All that are closed at once, as one after the other they would take minutes, until what is opened holds no more.
    for _ in 0..20 {
        let closed = harness.root().children_recursive().filter(|node| {
            let node = node.accesskit_node();
            let is_opener = node.label().is_some_and(|name| name.starts_with("open "));
            is_opener && node.toggled() == Some(Toggled::False)
        });
        let closed: Vec<_> = closed.collect();
        if closed.is_empty() {
            return;
        }
        for node in closed {
            node.click_accesskit();
        }
        harness.run();
    }
}

/// The primary button goes down or up there.
pub fn primary(pos: Pos2, pressed: bool) -> Event {
    Event::PointerButton {
        pos,
        button: PointerButton::Primary,
        pressed,
        modifiers: Modifiers::NONE,
    }
}

/// Whether a text is to be read somewhere.
pub fn shows(harness: &Harness<Pane>, part: &str) -> bool {
    let mut texts = harness.root().children_recursive().flat_map(|node| {
        let node = node.accesskit_node();
        [node.label(), node.value()].into_iter().flatten()
    });
    texts.any(|text| text.contains(part))
}

/// What has that name.
pub fn node<'t>(harness: &'t Harness<Pane>, name: &'t str) -> Node<'t> {
    let names = names(harness);
    assert!(
        names.iter().any(|known| known == name),
        "no {name} in {names:#?}"
    );
    harness.get_by_label(name)
}

/// Clicks what has that name.
pub fn click(harness: &mut Harness<Pane>, name: &str) {
    node(harness, name).click_accesskit();
    harness.run();
}

/// Types a text into the field of that name, in place of what is there, and presses Enter.
pub fn type_into(harness: &mut Harness<Pane>, name: &str, text: &str) {
    use eframe::egui::Key;
    node(harness, name).focus();
    harness.run();
    harness.key_press_modifiers(Modifiers::COMMAND, Key::A);
    node(harness, name).type_text(text);
    harness.run();
    harness.key_press(Key::Enter);
    harness.run();
}

/// Sets a number as assistive technology does.
pub fn set_number(harness: &mut Harness<Pane>, name: &str, number: f64) {
    node(harness, name).set_value_accesskit(number);
    harness.run();
}
