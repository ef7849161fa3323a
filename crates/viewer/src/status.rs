//! The lines at the bottom: what is wrong, what was done, and where the time of a frame went.

use crate::documents::Documents;
use crate::engine::{Drawn, Problem};
use crate::studio::Studio;
use document::Conflict;
use eframe::egui::{Label, RichText, ScrollArea, Ui};
use std::sync::Arc;

/// The most mistakes that are shown.
const MOST_SHOWN: usize = 20;

/// Whether something is wrong, or a text was changed here and on the disk.
#[must_use]
pub fn has_problems(studio: &Studio) -> bool {
    let texts = studio.documents.iter().flat_map(Documents::unsaved);
    !studio.problems.is_empty()
        || texts
            .into_iter()
            .any(|(_, document)| document.conflict().is_some())
}

/// Shows what is wrong, each with its line.
pub fn problems(ui: &mut Ui, studio: &mut Studio) {
    let color = ui.visuals().error_fg_color;
    let share = 0.3 * ui.ctx().content_rect().height();
    ScrollArea::vertical()
        .max_height(share)
        .id_salt("problems")
        .show(ui, |ui| {
            conflicts(ui, studio);
            for problem in studio.problems.iter().take(MOST_SHOWN) {
                let text = RichText::new(problem.to_string()).color(color);
                ui.label(match problem {
                    Problem::Mistake(_) => text.monospace(),
                    Problem::Failed(_) => text,
                });
            }
            if studio.problems.len() > MOST_SHOWN {
                ui.colored_label(
                    color,
                    format!("and {} more", studio.problems.len() - MOST_SHOWN),
                );
            }
        });
    if studio.is_outdated && studio.shown[0].is_some() {
        ui.weak("The picture shows the last look without mistakes.");
    }
}

/// Texts that were changed here and on the disk: both are shown.
fn conflicts(ui: &mut Ui, studio: &mut Studio) {
    let Some(documents) = &mut studio.documents else {
        return;
    };
    let mut chosen = None;
    for (text, document) in documents.unsaved() {
        let Some(conflict) = document.conflict() else {
            continue;
        };
        ui.horizontal_wrapped(|ui| {
            let color = ui.visuals().warn_fg_color;
            ui.colored_label(
                color,
                format!("{} was changed here and on the disk.", document.name()),
            );
            if ui.button("Keep mine").clicked() {
                chosen = Some((text, true));
            }
            let is_there = on_disk(conflict).is_some();
            if is_there && ui.button("Take the disk's").clicked() {
                chosen = Some((text, false));
            }
        });
        ui.columns(2, |columns| {
            for (ui, (title, text)) in columns.iter_mut().zip([
                ("Mine", Some(document.text())),
                ("On the disk", on_disk(conflict)),
            ]) {
                ui.strong(title);
                ScrollArea::vertical()
                    .id_salt((title, document.path()))
                    .max_height(160.0)
                    .show(ui, |ui| match text {
                        Some(text) => ui.monospace(&**text),
                        None => ui.weak("it is no more there"),
                    });
            }
        });
    }
    if let Some((text, keeps_mine)) = chosen {
        documents.resolve(text, keeps_mine);
    }
}

/// What the disk has; nothing where the file is deleted.
fn on_disk(conflict: &Conflict) -> Option<&Arc<str>> {
    match conflict {
        Conflict::Changed { on_disk } => Some(on_disk),
        _ => None,
    }
}

/// Shows the last thing that was done, and what the last frame took. One line, however much there is: the picture above keeps its size.
pub fn status(ui: &mut Ui, studio: &Studio) {
    let line = |ui: &mut Ui, text: RichText| ui.add(Label::new(text).truncate());
    ui.horizontal(|ui| {
        if let Some(told) = studio.told() {
            line(ui, told.into());
            ui.separator();
        }
        if let Some(shown) = &studio.shown[0] {
            let sharp = if studio.is_sharp { "" } else { " (rough)" };
            let mut text = format!("{}{sharp}", frame_in_words(&shown.drawn));
            for note in &shown.drawn.facts.notes {
                text += &format!(" | {note}");
            }
            line(ui, RichText::new(text).weak());
        } else if studio.documents.is_some() && studio.problems.is_empty() {
            line(ui, RichText::new("drawing ...").weak());
        }
    });
}

/// Where the time of a frame went, in words.
fn frame_in_words(drawn: &Drawn) -> String {
    let times = &drawn.times;
    let [width, height] = drawn.size_px;
    format!(
        "{:.1} ms: motion {:.1}, paths {:.1}, strokes {:.1}, pixels {:.1} | {} strands, {} segments | {} | {width} x {height}, {} samples",
        times.frame(),
        times.simulate,
        times.paths,
        times.effects,
        times.raster,
        drawn.strands,
        drawn.segments,
        drawn.backend,
        drawn.samples,
    )
}
