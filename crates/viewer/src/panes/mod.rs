//! The panes of the window: what there is, and where it is at first.

mod picture;
mod presets;
mod text;
mod timeline;

pub use timeline::timeline;

use crate::documents::Which;
use crate::edit::Edit;
use crate::panels;
use crate::studio::Studio;
use eframe::egui::{Frame, Id, ScrollArea, Ui, WidgetText};
use egui_tiles::{
    Behavior, Linear, LinearDir, SimplificationOptions, TileId, Tiles, Tree, UiResponse,
};

/// A pane.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pane {
    /// The picture.
    Picture,
    /// Presets to choose from.
    Presets,
    /// The preset's layers.
    Layers,
    /// The preset's sections.
    Look,
    /// The hair style.
    Style,
    /// The motion script.
    Motion,
    /// The texts as they are.
    Text,
}

impl Pane {
    /// What is written on its tab.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Picture => "Picture",
            Self::Presets => "Presets",
            Self::Layers => "Layers",
            Self::Look => "Look",
            Self::Style => "Style",
            Self::Motion => "Motion",
            Self::Text => "Text",
        }
    }
}

/// The panes as they are at first: the picture, and beside it the rest as tabs.
#[must_use]
pub fn first_tree() -> Tree<Pane> {
    let mut tiles = Tiles::default();
    let picture = tiles.insert_pane(Pane::Picture);
    let beside = [
        Pane::Layers,
        Pane::Look,
        Pane::Style,
        Pane::Motion,
        Pane::Text,
        Pane::Presets,
    ];
    let tabs: Vec<TileId> = beside.map(|pane| tiles.insert_pane(pane)).into();
    let tabs = tiles.insert_tab_tile(tabs);
    let mut both = Linear::new(LinearDir::Horizontal, vec![picture, tabs]);
    both.shares.set_share(picture, 0.64);
    both.shares.set_share(tabs, 0.36);
    let root = tiles.insert_container(both);
    Tree::new(Id::unique("panes"), root, tiles)
}

/// How panes are shown.
pub struct Panes<'a>(pub &'a mut Studio);

impl Behavior<Pane> for Panes<'_> {
    fn tab_title_for_pane(&mut self, pane: &Pane) -> WidgetText {
        pane.name().into()
    }

    fn simplification_options(&self) -> SimplificationOptions {
        SimplificationOptions {
            all_panes_must_have_tabs: true,
            ..SimplificationOptions::default()
        }
    }

    fn pane_ui(&mut self, ui: &mut Ui, _: TileId, pane: &mut Pane) -> UiResponse {
        let studio = &mut *self.0;
        let frame = match pane {
            // It fills what is to be filled itself.
            Pane::Picture => Frame::NONE,
            _ => Frame::NONE.fill(ui.visuals().panel_fill).inner_margin(6),
        };
        frame.show(ui, |ui| match pane {
            Pane::Picture => picture::picture(ui, studio),
            Pane::Presets => presets::presets(ui, studio),
            Pane::Text => text::text(ui, studio),
            Pane::Layers | Pane::Look | Pane::Style | Pane::Motion => parameters(ui, studio, *pane),
        });
        UiResponse::None
    }
}

/// The panes of parameters, below a field to search in.
fn parameters(ui: &mut Ui, studio: &mut Studio, pane: Pane) {
    let field = eframe::egui::TextEdit::singleline(&mut studio.search)
        .hint_text("Search parameters")
        .desired_width(f32::INFINITY);
    let response = ui.add(field).accessible_name("Search parameters");
    if std::mem::take(&mut studio.focuses_search) {
        response.request_focus();
    }
    let which = match pane {
        Pane::Style => Which::Style,
        Pane::Motion => Which::Motion,
        _ => Which::Preset,
    };
    let Some(documents) = &studio.documents else {
        ui.weak("Open a preset, or begin a new look.");
        return;
    };
    let Some(document) = documents.get(which) else {
        match documents.troubles.get(&which) {
            Some(trouble) => _ = ui.colored_label(ui.visuals().error_fg_color, trouble),
            None => no_document(ui, which),
        }
        return;
    };
    let text = document.text().clone();
    let (search, registry) = (studio.search.clone(), studio.registry.clone());
    let mut edits: Vec<Edit> = Vec::new();
    ScrollArea::vertical()
        .auto_shrink([false, false])
        .id_salt(pane.name())
        .show(ui, |ui| match pane {
            Pane::Layers => panels::layers(
                ui,
                &text,
                &studio.inherited,
                &registry,
                &mut studio.layers,
                &search,
                &mut edits,
            ),
            Pane::Look => panels::look(ui, &text, &studio.inherited, &search, &mut edits),
            Pane::Style => panels::style(ui, &text, &search, &mut edits),
            _ => panels::motion_script(ui, &text, &search, &mut edits),
        });
    studio.change(which, &edits);
}

fn no_document(ui: &mut Ui, which: Which) {
    ui.weak(match which {
        Which::Style => "The preset's hair is no style (hair.file: \"NAME.style.ron\"), so there is nothing to change here.",
        _ => "The preset names no motion script: motion.file, in the pane Look, such as \"motions/walk.motion.ron\".",
    });
}
