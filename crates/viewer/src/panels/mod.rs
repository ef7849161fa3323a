//! STUB
use crate::edit::Edit;
use crate::layers_shown::LayersShown;
use eframe::egui::Ui;
pub fn layers(
    ui: &mut Ui,
    _: &str,
    _: &effects::Registry,
    _: &mut LayersShown,
    _: &str,
    _: &mut Vec<Edit>,
) {
    ui.label("layers");
}
pub fn look(ui: &mut Ui, _: &str, _: &str, _: &mut Vec<Edit>) {
    ui.label("look");
}
pub fn style(ui: &mut Ui, _: &str, _: &str, _: &mut Vec<Edit>) {
    ui.label("style");
}
pub fn motion_script(ui: &mut Ui, _: &str, _: &str, _: &mut Vec<Edit>) {
    ui.label("motion");
}
