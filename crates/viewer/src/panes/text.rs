//! The texts as they are, with what is wrong with them at its place.

use crate::documents::Which;
use crate::engine::Problem;
use crate::studio::Studio;
use eframe::egui::{
    Color32, FontId, RichText, ScrollArea, TextEdit, TextFormat, Ui, text::LayoutJob,
};

/// Shows one of the texts, to be written in.
pub(super) fn text(ui: &mut Ui, studio: &mut Studio) {
    let Some(documents) = &studio.documents else {
        ui.weak("Open a preset, or begin a new look.");
        return;
    };
    let id = ui.scope_id().with("which");
    let mut which: Which = ui.data(|data| data.get_temp(id)).unwrap_or(Which::Preset);
    ui.horizontal(|ui| {
        for other in Which::ALL {
            if let Some(document) = documents.get(other) {
                let mark = if document.is_changed() { " *" } else { "" };
                ui.selectable_value(&mut which, other, format!("{}{mark}", other.name()))
                    .on_hover_text(document.path().display().to_string());
            }
        }
    });
    let Some(document) = documents.get(which) else {
        ui.data_mut(|data| data.insert_temp(id, Which::Preset));
        return;
    };
    ui.data_mut(|data| data.insert_temp(id, which));
    let path = document.path().display().to_string();
    let mistakes: Vec<(usize, String)> = (studio.problems.iter())
        .filter_map(|problem| match problem {
            Problem::Mistake(mistake) if mistake.place.file == path => {
                Some((mistake.place.line, problem.to_string()))
            }
            _ => None,
        })
        .collect();
    for (_, message) in &mistakes {
        ui.label(
            RichText::new(message)
                .monospace()
                .color(ui.visuals().error_fg_color),
        );
    }
    // Returns are not seen, and are written again: what is typed has line feeds alone.
    let has_returns = has_returns(document.text());
    let mut text = match has_returns {
        true => document.text().replace("\r\n", "\n"),
        false => document.text().to_string(),
    };
    let lines: Vec<usize> = mistakes.iter().map(|(line, _)| *line).collect();
    let colors = Colors::of(ui);
    let mut layouter = |ui: &Ui, text: &dyn eframe::egui::TextBuffer, _: f32| {
        ui.fonts_mut(|fonts| fonts.layout_job(highlighted(text.as_str(), &lines, &colors)))
    };
    let response = ScrollArea::both()
        .auto_shrink([false, false])
        .show(ui, |ui| {
            ui.add(
                TextEdit::multiline(&mut text)
                    .code_editor()
                    .desired_width(f32::INFINITY)
                    .desired_rows(30)
                    .layouter(&mut layouter),
            )
            .accessible_name(format!("{} text", which.name()))
        });
    if response.inner.changed() {
        // Ctrl+Z is ours before it is the field's: what is typed within a second is one step of undo.
        let second = ui.input(|input| input.time) as u64;
        if has_returns {
            text = text.replace("\r\n", "\n").replace('\n', "\r\n");
        }
        studio.write(which, text, Some(u64::MAX / 2 + second));
    }
}

/// Whether all lines of a text end with a return and a line feed.
fn has_returns(text: &str) -> bool {
    let lines = text.matches('\n').count();
    lines > 0 && text.matches("\r\n").count() == lines
}

struct Colors {
    plain: Color32,
    comment: Color32,
    quoted: Color32,
    wrong: Color32,
}

impl Colors {
    fn of(ui: &Ui) -> Self {
        let visuals = ui.visuals();
        let pick = |dark: [u8; 3], light: [u8; 3]| {
            let [r, g, b] = if visuals.dark_mode { dark } else { light };
            Color32::from_rgb(r, g, b)
        };
        Self {
            plain: visuals.text_color(),
            comment: pick([120, 150, 120], [70, 110, 70]),
            quoted: pick([205, 160, 120], [150, 80, 20]),
            wrong: visuals.error_fg_color.gamma_multiply(0.25),
        }
    }
}

/// The text with comments and texts in colours, and a ground under lines with mistakes.
fn highlighted(text: &str, wrong: &[usize], colors: &Colors) -> LayoutJob {
    let mut job = LayoutJob::default();
    for (index, line) in text.split_inclusive('\n').enumerate() {
        let background = match wrong.contains(&(index + 1)) {
            true => colors.wrong,
            false => Color32::TRANSPARENT,
        };
        for (part, color) in parts(line, colors) {
            let format = TextFormat {
                font_id: FontId::monospace(12.5),
                color,
                background,
                ..TextFormat::default()
            };
            job.append(part, 0.0, format);
        }
    }
    job
}

/// A line's parts: texts in quotes, a comment at the end, and what is between.
fn parts<'t>(line: &'t str, colors: &Colors) -> Vec<(&'t str, Color32)> {
    let mut parts = Vec::new();
    let mut start = 0;
    let mut is_quoted = false;
    for (at, character) in line.char_indices() {
        if character == '"' {
            let end = if is_quoted { at + 1 } else { at };
            let color = if is_quoted {
                colors.quoted
            } else {
                colors.plain
            };
            parts.push((&line[start..end], color));
            start = end;
            is_quoted = !is_quoted;
        } else if !is_quoted && line[at..].starts_with("//") {
            parts.push((&line[start..at], colors.plain));
            parts.push((&line[at..], colors.comment));
            return parts;
        }
    }
    parts.push((
        &line[start..],
        if is_quoted {
            colors.quoted
        } else {
            colors.plain
        },
    ));
    parts
}
