//! The bar at the top.

use crate::actions::Action;
use crate::engine::Backend;
use crate::studio::Studio;
use eframe::egui::{self, Button, Ui};

/// An action in a menu.
pub fn item(ui: &mut Ui, studio: &mut Studio, action: Action) {
    let entry = action.entry();
    let button = Button::new(entry.name).shortcut_text(entry.key_text(ui.ctx()));
    if ui.add(button).on_hover_text(entry.about).clicked() {
        studio.act(action);
        ui.close();
    }
}

/// The window's colours.
fn theme(ui: &mut Ui) {
    use egui::ThemePreference::{Dark, Light, System};
    let before = ui.ctx().options(|options| options.theme_preference);
    let mut chosen = before;
    for (preference, name) in [(System, "the system's"), (Dark, "dark"), (Light, "light")] {
        ui.radio_value(&mut chosen, preference, name);
    }
    if chosen != before {
        ui.ctx().set_theme(chosen);
    }
}

/// Shows the bar.
pub fn bar(ui: &mut Ui, studio: &mut Studio) {
    egui::MenuBar::new().ui(ui, |ui| {
        ui.menu_button("File", |ui| {
            use Action::{Export, New, Open, Quit, Save, SaveAs};
            for action in [New, Open, Save, SaveAs, Export, Quit] {
                item(ui, studio, action);
            }
        });
        ui.menu_button("Edit", |ui| {
            for action in [Action::Undo, Action::Redo, Action::Search] {
                item(ui, studio, action);
            }
        });
        ui.menu_button("Window", |ui| {
            ui.weak("Colours");
            theme(ui);
            ui.weak("Drawn by");
            for backend in Backend::ALL {
                let about = match backend {
                    Backend::Auto => "A graphics card where there is one, else the CPU",
                    Backend::Cpu => "The CPU",
                    Backend::Gpu => "A graphics card, or a driver that draws in software",
                };
                ui.radio_value(&mut studio.backend, backend, backend.name())
                    .on_hover_text(about);
            }
        });
        ui.menu_button("Help", |ui| item(ui, studio, Action::Help));
        if let Some(documents) = &studio.documents {
            let mark = if documents.is_changed() { " *" } else { "" };
            ui.weak(format!("{}{mark}", documents.preset().path().display()));
        }
    });
}
