//! Presets to choose from, with small pictures.

use crate::engine::{THUMBNAIL_SIZE_PX, Thumbnail};
use crate::prompt::Prompt;
use crate::studio::Studio;
use eframe::egui::{
    Button, ColorImage, Image, ScrollArea, TextureOptions, Ui, load::SizedTexture, vec2,
};
use std::path::PathBuf;

/// Shows the presets of the folder.
pub(super) fn presets(ui: &mut Ui, studio: &mut Studio) {
    ui.horizontal(|ui| {
        let id = ui.scope_id().with("folder");
        let known: Option<String> = ui.data(|data| data.get_temp(id));
        let mut folder = known.unwrap_or_else(|| studio.folder.display().to_string());
        let label = ui.label("Folder");
        let field = ui.text_edit_singleline(&mut folder).labelled_by(label.id);
        if field.has_focus() {
            ui.data_mut(|data| data.insert_temp(id, folder));
        } else if field.lost_focus() {
            // Not while it is typed: presets of every folder on the way would be drawn.
            studio.folder = PathBuf::from(folder);
            ui.data_mut(|data| data.remove::<String>(id));
        }
        if ui.button("New look...").clicked() {
            studio.prompt = Some(Prompt::new_look(&studio.folder));
        }
    });
    let presets = presets_in(&studio.folder);
    if presets.is_empty() {
        ui.weak("There are no presets in this folder.");
    }
    let mut asked = None;
    ScrollArea::vertical()
        .auto_shrink([false, false])
        .show(ui, |ui| {
            let side = THUMBNAIL_SIZE_PX[0] as f32 + 2.0 * ui.spacing().item_spacing.x;
            let columns = ((ui.available_width() / side) as usize).max(1);
            for row in presets.chunks(columns) {
                ui.horizontal_top(|ui| {
                    for path in row {
                        ui.vertical(|ui| {
                            ui.set_width(THUMBNAIL_SIZE_PX[0] as f32);
                            if preset(ui, studio, path) {
                                asked = Some(path.clone());
                            }
                        });
                    }
                });
                ui.add_space(8.0);
            }
        });
    if let Some(path) = asked {
        studio.ask_to_open(&path);
    }
}

/// Shows a preset. Whether it is chosen.
fn preset(ui: &mut Ui, studio: &mut Studio, path: &std::path::Path) -> bool {
    let name = path
        .file_name()
        .unwrap_or_default()
        .to_string_lossy()
        .into_owned();
    let [width, height] = THUMBNAIL_SIZE_PX.map(|side| side as f32);
    let is_open = studio
        .documents
        .as_ref()
        .is_some_and(|d| d.preset().path() == path);
    let response = match studio.thumbnails.of(path) {
        Thumbnail::Drawn(pixels) => {
            let id = ui
                .scope_id()
                .with(path)
                .with(std::sync::Arc::as_ptr(&pixels) as usize);
            let known = ui.data(|data| data.get_temp::<eframe::egui::TextureHandle>(id));
            let texture = known.unwrap_or_else(|| {
                let size = THUMBNAIL_SIZE_PX.map(|side| side as usize);
                let image = ColorImage::from_rgba_unmultiplied(size, &pixels);
                let texture = ui
                    .ctx()
                    .load_texture(name.clone(), image, TextureOptions::LINEAR);
                ui.data_mut(|data| data.insert_temp(id, texture.clone()));
                texture
            });
            let image = Image::from_texture(SizedTexture::new(texture.id(), [width, height]));
            ui.add(Button::image(image).selected(is_open).frame(true))
        }
        Thumbnail::Waiting => ui.add_sized([width, height], Button::new("...")),
        Thumbnail::Failed(why) => ui
            .add_sized(vec2(width, height), Button::new("it has mistakes"))
            .on_hover_text(why),
    };
    let response = response.accessible_name(format!("Open {name}"));
    ui.label(&name);
    if ui
        .small_button("Compare")
        .on_hover_text("Shows it beside the look that is open")
        .accessible_name(format!("Compare {name}"))
        .clicked()
        && let Err(error) = studio.compare_with(path)
    {
        studio.tell(error);
    }
    response.clicked()
}

/// The presets of a folder, by name.
fn presets_in(folder: &std::path::Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let mut found: Vec<PathBuf> = entries
        .map(|entry| entry.path())
        .filter(|path| {
            let name = path.file_name().unwrap_or_default().to_string_lossy();
            let others = [".style.ron", ".motion.ron", ".strands.ron"];
            name.ends_with(".ron")
                && !name.starts_with('.')
                && !others.iter().any(|other| name.ends_with(other))
        })
        .collect();
    found.sort();
    found
}
