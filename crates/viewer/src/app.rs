//! The window: bar, panes, time, what is wrong.

use crate::actions;
use crate::documents::Documents;
use crate::engine::Backend;
use crate::panes::{self, Pane, Panes};
use crate::prompt::Prompt;
use crate::studio::Studio;
use crate::{menu, status};
use document::Recovery;
use effects::Registry;
use eframe::egui::{CentralPanel, Color32, Context, Panel, Ui, ViewportCommand};
use egui_tiles::Tree;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// How much of a text's colour is left where it is of less weight: it is read still.
const WEAK: f32 = 0.75;
/// Mistakes: full red is hard to read on dark.
const MISTAKE_ON_DARK: Color32 = Color32::from_rgb(255, 120, 110);
const MISTAKE_ON_LIGHT: Color32 = Color32::from_rgb(190, 20, 20);
/// Width of a scroll bar and what is around it, points.
const SCROLL_BAR: f32 = 8.0;

/// The viewer as [`eframe`] runs it.
pub struct App {
    /// All but the panes.
    pub studio: Studio,
    panes: Tree<Pane>,
    /// What was dropped and is not taken yet.
    dropped: Vec<PathBuf>,
    /// The prompt that was open when the window was to close: it is there again where its user stays.
    behind: Option<Prompt>,
}

impl App {
    /// A viewer of a preset, or of none, with these effects. `recovery` says where copies are kept that outlive a crash.
    #[must_use]
    pub fn new(
        ctx: &Context,
        registry: Registry,
        preset: Option<&Path>,
        backend: Backend,
        recovery: Recovery,
    ) -> Self {
        ctx.all_styles_mut(|style| {
            // Scroll bars have room of their own, beside what is scrolled.
            style.spacing.scroll.floating_allocated_width = SCROLL_BAR;
            style.visuals.weak_text_alpha = WEAK;
            let is_dark = style.visuals.dark_mode;
            style.visuals.error_fg_color = if is_dark {
                MISTAKE_ON_DARK
            } else {
                MISTAKE_ON_LIGHT
            };
        });
        let mut studio = Studio::new(Arc::new(registry), ctx, backend, recovery);
        if let Some(preset) = preset {
            studio.open(preset);
        }
        Self {
            studio,
            panes: panes::first_tree(),
            dropped: Vec::new(),
            behind: None,
        }
    }

    /// Brings a pane to the front.
    pub fn show_pane(&mut self, wanted: Pane) {
        self.panes
            .make_active(|_, tile| matches!(tile, egui_tiles::Tile::Pane(pane) if *pane == wanted));
    }

    /// Files that were dropped on the window.
    fn take_dropped(&mut self, ctx: &Context) {
        ctx.input(|input| {
            let files = input.raw.dropped_files.iter();
            self.dropped
                .extend(files.map(|file| file.path().to_owned()));
        });
        // What is typed and not taken yet is taken first, in the next frame.
        if self.dropped.is_empty() || self.studio.leave_field() {
            return;
        }
        let dropped = std::mem::take(&mut self.dropped);
        if self.studio.prompt.is_some() {
            self.studio.tell("close the window that is open first");
            return;
        }
        for path in dropped {
            self.studio.take_file(&path);
        }
    }

    /// Asks before the window closes with changes that are not saved.
    fn ask_before_closing(&mut self, ctx: &Context) {
        let is_asked = ctx.input(|input| input.viewport().close_requested());
        // What is typed and not taken yet is a change, too.
        if is_asked && !self.studio.may_close && self.studio.leave_field() {
            ctx.send_viewport_cmd(ViewportCommand::CancelClose);
            ctx.send_viewport_cmd(ViewportCommand::Close);
            return;
        }
        let is_changed = self
            .studio
            .documents
            .as_ref()
            .is_some_and(Documents::is_changed);
        if is_asked && is_changed && !self.studio.may_close {
            ctx.send_viewport_cmd(ViewportCommand::CancelClose);
            let before = self.studio.prompt.replace(Prompt::Unsaved(None));
            let before = before.filter(|before| !matches!(before, Prompt::Unsaved(_)));
            self.behind = before.or(self.behind.take());
        }
    }
}

impl eframe::App for App {
    fn ui(&mut self, ui: &mut Ui, _: &mut eframe::Frame) {
        let ctx = ui.ctx().clone();
        self.ask_before_closing(&ctx);
        self.studio.before_frame();
        if self.studio.prompt.is_none() {
            for action in actions::pressed(&ctx, self.studio.is_picture_focused) {
                self.studio.act(action);
            }
            if self.studio.focuses_search {
                self.show_pane(Pane::Look);
            }
        }
        self.take_dropped(&ctx);
        Panel::top("menu").show(ui, |ui| menu::bar(ui, &mut self.studio));
        Panel::bottom("status").show(ui, |ui| status::status(ui, &self.studio));
        if status::has_problems(&self.studio) {
            Panel::bottom("problems").show(ui, |ui| status::problems(ui, &mut self.studio));
        }
        Panel::bottom("time").show(ui, |ui| panes::timeline(ui, &mut self.studio));
        CentralPanel::no_frame().show(ui, |ui| self.panes.ui(&mut Panes(&mut self.studio), ui));
        if let Some(prompt) = self.studio.prompt.take() {
            let next = prompt.show(ui, &mut self.studio);
            if self.studio.prompt.is_none() {
                self.studio.prompt = next;
            }
            if self.studio.prompt.is_none() && !self.studio.may_close {
                self.studio.prompt = self.behind.take();
            }
        }
        self.studio.after_frame();
    }
}
