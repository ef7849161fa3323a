//! Windows that ask something, one at a time.

use crate::actions;
use crate::documents::Documents;
use crate::engine::Backend;
use crate::export::{Running, Settings, State};
use crate::path_field::PathField;
use crate::studio::Studio;
use eframe::egui::{self, Id, Key, Label, Modal, ProgressBar, RichText, Ui, Vec2, vec2};
use std::path::{Path, PathBuf};
use std::time::SystemTime;

/// The largest width of a window, points.
const MOST_WIDTH: f32 = 560.0;
/// What is seen of the viewer beside a window at least, and what the window's frame takes, points.
const MARGIN: Vec2 = vec2(48.0, 48.0);
/// Height of the shortcuts' heading and button, points.
const AROUND_SHORTCUTS: f32 = 110.0;

/// What is asked.
pub enum Prompt {
    /// Where a new look goes.
    NewLook(PathField),
    /// What is to be opened.
    Open(PathField),
    /// Where the preset goes.
    SaveAs(PathField),
    /// A picture to draw after.
    Reference(PathField),
    /// A preset to compare with.
    Compare(PathField),
    /// What is drawn into files.
    Export(Box<Export>),
    /// What to do with changes that a crash has left.
    Recover,
    /// What to do with changes before another preset is opened, or the window is closed.
    Unsaved(Option<PathBuf>),
    /// All keys.
    Shortcuts,
}

/// The export that is asked for, and how far it is.
pub struct Export {
    settings: Settings,
    is_sequence: bool,
    frames: [u32; 2],
    running: Option<Running>,
}

/// What came of a window's frame.
enum Answer {
    Stays,
    Closes,
    Becomes(Prompt),
}

impl Prompt {
    /// Asks where a new look goes.
    #[must_use]
    pub fn new_look(folder: &Path) -> Self {
        Self::NewLook(PathField::new(folder, "look.ron", &["ron"]))
    }

    /// Asks what is to be opened.
    #[must_use]
    pub fn open(folder: &Path) -> Self {
        Self::Open(PathField::new(folder, "", &["ron"]))
    }

    /// Asks where the preset goes.
    #[must_use]
    pub fn save_as(documents: &Documents) -> Self {
        let name = documents.preset().name();
        Self::SaveAs(PathField::new(&documents.folder(), &name, &["ron"]))
    }

    /// Asks for a picture to draw after.
    #[must_use]
    pub fn reference(folder: &Path) -> Self {
        Self::Reference(PathField::new(folder, "", &["png", "jpg", "jpeg"]))
    }

    /// Asks for a preset to compare with.
    #[must_use]
    pub fn compare(folder: &Path) -> Self {
        Self::Compare(PathField::new(folder, "", &["ron"]))
    }

    /// Asks what is drawn into files.
    #[must_use]
    pub fn export(documents: &Documents, backend: Backend) -> Self {
        let path = documents.preset().path().with_extension("png");
        Self::Export(Box::new(Export {
            settings: Settings {
                output: path.display().to_string(),
                frames: None,
                size_px: None,
                samples: None,
                backend,
                is_transparent: false,
            },
            is_sequence: false,
            frames: [0, 47],
            running: None,
        }))
    }

    /// Shows the window; what is asked next, if anything.
    pub fn show(mut self, ui: &mut Ui, studio: &mut Studio) -> Option<Self> {
        let mut answer = Answer::Stays;
        let modal = Modal::new(Id::unique(("prompt", self.name()))).show(ui.ctx(), |ui| {
            // A small window has room for less.
            let room = ui.ctx().content_rect().size() - MARGIN;
            ui.set_max_width(room.x.min(MOST_WIDTH));
            // As high as what it shows: it scrolls only where the window has no more room.
            egui::ScrollArea::vertical()
                .max_height(room.y)
                .min_scrolled_height(room.y)
                .show(ui, |ui| answer = self.ask(ui, studio));
        });
        let is_busy = matches!(&self, Self::Export(export) if export.is_busy());
        if modal.should_close() && !is_busy && !matches!(self, Self::Recover) {
            return None;
        }
        match answer {
            Answer::Stays => Some(self),
            Answer::Closes => None,
            Answer::Becomes(next) => Some(next),
        }
    }

    /// Tells the windows apart, which have sizes of their own.
    fn name(&self) -> &'static str {
        match self {
            Self::NewLook(_) => "new",
            Self::Open(_) => "open",
            Self::SaveAs(_) => "save as",
            Self::Reference(_) => "reference",
            Self::Compare(_) => "compare",
            Self::Export(_) => "export",
            Self::Recover => "recover",
            Self::Unsaved(_) => "unsaved",
            Self::Shortcuts => "shortcuts",
        }
    }

    fn ask(&mut self, ui: &mut Ui, studio: &mut Studio) -> Answer {
        match self {
            Self::NewLook(field) => ask_path(ui, "New look", "Write", field, |path| {
                inkstrand::write_new_look(path)?;
                Ok(open_or_ask(studio, path))
            }),
            Self::Open(field) => ask_path(ui, "Open a preset", "Open", field, |path| {
                match path.is_file() {
                    true => Ok(open_or_ask(studio, path)),
                    false => Err(format!("there is no file {}", path.display())),
                }
            }),
            Self::SaveAs(field) => ask_path(ui, "Save the preset as", "Save", field, |path| {
                let Some(documents) = &mut studio.documents else {
                    return Ok(Answer::Closes);
                };
                documents.save_preset_as(path)?;
                studio.tell(format!("wrote {}", path.display()));
                Ok(Answer::Closes)
            }),
            Self::Reference(field) => {
                ask_path(ui, "A picture to draw after", "Show", field, |path| {
                    studio.show_reference(path)?;
                    Ok(Answer::Closes)
                })
            }
            Self::Compare(field) => {
                ask_path(ui, "A preset to compare with", "Compare", field, |path| {
                    studio.compare_with(path)?;
                    Ok(Answer::Closes)
                })
            }
            Self::Export(export) => export.ask(ui, studio),
            Self::Recover => ask_recover(ui, studio),
            Self::Unsaved(next) => ask_unsaved(ui, studio, next.take()),
            Self::Shortcuts => show_shortcuts(ui),
        }
    }
}

/// Opens a preset at once, or asks first what becomes of changes.
fn open_or_ask(studio: &mut Studio, path: &Path) -> Answer {
    if studio.documents.as_ref().is_some_and(Documents::is_changed) {
        return Answer::Becomes(Prompt::Unsaved(Some(path.to_owned())));
    }
    studio.open(path);
    Answer::Closes
}

/// A window with a path, which does something with it.
fn ask_path(
    ui: &mut Ui,
    title: &str,
    verb: &str,
    field: &mut PathField,
    done: impl FnOnce(&Path) -> Result<Answer, String>,
) -> Answer {
    ui.heading(title);
    let is_entered = field.show(ui);
    if let Some(error) = &field.error {
        ui.colored_label(ui.visuals().error_fg_color, error);
    }
    let mut answer = Answer::Stays;
    ui.horizontal(|ui| {
        if ui.button(verb).clicked() || is_entered {
            answer = done(&field.path()).unwrap_or_else(|error| {
                field.error = Some(error);
                Answer::Stays
            });
        }
        if ui.button("Cancel").clicked() {
            answer = Answer::Closes;
        }
    });
    answer
}

fn ask_recover(ui: &mut Ui, studio: &mut Studio) -> Answer {
    ui.heading("Changes were not saved");
    ui.label("The viewer ended before these texts were saved, and kept copies:");
    let Some(documents) = &mut studio.documents else {
        return Answer::Closes;
    };
    let mut taken = None;
    let mut thrown = None;
    for (which, document) in documents.all() {
        let Some(copy) = document.recovered() else {
            continue;
        };
        ui.separator();
        ui.strong(document.path().display().to_string());
        ui.label(match copy.is_older_than_file {
            true => format!(
                "a copy of {}: the file was written after that",
                ago(copy.when)
            ),
            false => format!("a copy of {}", ago(copy.when)),
        });
        ui.horizontal(|ui| {
            if ui.button("Take the copy").clicked() {
                taken = Some(which);
            }
            if ui.button("Throw it away").clicked() {
                thrown = Some(which);
            }
        });
    }
    ui.separator();
    let is_later = ui
        .button("Later")
        .on_hover_text("The copies stay, and are offered when the texts are opened again")
        .clicked();
    if let Some(which) = taken {
        documents.accept_recovered(which);
    }
    if let Some(which) = thrown {
        documents.discard_recovered(which);
    }
    // Older copies of what was taken are no more wanted now.
    let left = documents
        .all()
        .any(|(which, document)| taken != Some(which) && document.recovered().is_some());
    match is_later || !left {
        true => Answer::Closes,
        false => Answer::Stays,
    }
}

/// How long ago that was, in words.
fn ago(when: SystemTime) -> String {
    let seconds = when.elapsed().map_or(0, |passed| passed.as_secs());
    match seconds {
        0..120 => "a minute ago".to_owned(),
        120..7200 => format!("{} minutes ago", seconds / 60),
        7200..172_800 => format!("{} hours ago", seconds / 3600),
        _ => format!("{} days ago", seconds / 86_400),
    }
}

fn ask_unsaved(ui: &mut Ui, studio: &mut Studio, next: Option<PathBuf>) -> Answer {
    ui.heading("There are changes that are not saved");
    for (_, document) in studio.documents.iter().flat_map(Documents::unsaved) {
        ui.label(document.path().display().to_string());
    }
    let mut goes_on = false;
    let mut is_thrown = false;
    let mut answer = Answer::Becomes(Prompt::Unsaved(next.clone()));
    ui.horizontal(|ui| {
        if ui.button("Save").clicked() {
            studio.save();
            goes_on = !studio.documents.as_ref().is_some_and(Documents::is_changed);
        }
        if ui.button("Throw away").clicked() {
            is_thrown = true;
            goes_on = true;
        }
        if ui.button("Cancel").clicked() {
            answer = Answer::Closes;
        }
    });
    if !goes_on {
        return answer;
    }
    match next {
        // Only when the other is open nothing is left of this one.
        Some(path) => {
            studio.open(&path);
            Answer::Closes
        }
        None => {
            if let Some(documents) = studio.documents.take().filter(|_| is_thrown) {
                documents.close();
            }
            studio.may_close = true;
            ui.ctx().send_viewport_cmd(egui::ViewportCommand::Close);
            Answer::Closes
        }
    }
}

fn show_shortcuts(ui: &mut Ui) -> Answer {
    ui.heading("Shortcuts");
    let room = ui.ctx().content_rect().height() - MARGIN.y - AROUND_SHORTCUTS;
    egui::ScrollArea::vertical()
        .max_height(room.min(420.0))
        .show(ui, |ui| {
            egui::Grid::new("shortcuts")
                .num_columns(3)
                .striped(true)
                .show(ui, |ui| {
                    for entry in actions::ALL {
                        ui.label(RichText::new(entry.key_text(ui.ctx())).monospace());
                        ui.label(entry.name);
                        ui.add(Label::new(RichText::new(entry.about).weak()).truncate());
                        ui.end_row();
                    }
                    for (key, name, about) in [
                        (
                            "drag",
                            "Turn the view",
                            "On the picture, with the view tool",
                        ),
                        (
                            "Shift+drag",
                            "Move the view",
                            "Or the middle or right button",
                        ),
                        ("wheel", "Nearer, farther", "Also a pinch"),
                        ("L+drag", "Move the light", "Or with the light tool"),
                        (
                            "H+drag",
                            "Turn the head",
                            "Or with the head tool: let go, and it swings back",
                        ),
                        ("double click", "Look at the head", "On the picture"),
                        (
                            "arrows",
                            "Turn the view",
                            "While the picture has the keyboard (Tab)",
                        ),
                    ] {
                        ui.label(RichText::new(key).monospace());
                        ui.label(name);
                        ui.add(Label::new(RichText::new(about).weak()).truncate());
                        ui.end_row();
                    }
                });
        });
    let is_closed = ui.button("Close").clicked();
    match is_closed || ui.input(|input| input.key_pressed(Key::Escape)) {
        true => Answer::Closes,
        false => Answer::Stays,
    }
}

impl Export {
    fn is_busy(&self) -> bool {
        self.running
            .as_ref()
            .is_some_and(|running| running.result().is_none())
    }

    fn ask(&mut self, ui: &mut Ui, studio: &mut Studio) -> Answer {
        ui.heading("Draw into files");
        let Some(state) = studio.export_state() else {
            ui.label("No layer is shown, so there is nothing to draw.");
            return match ui.button("Close").clicked() {
                true => Answer::Closes,
                false => Answer::Stays,
            };
        };
        let is_busy = self.is_busy();
        ui.add_enabled_ui(!is_busy, |ui| self.settings(ui, studio));
        if !self.is_sequence && Path::new(&self.settings.output).exists() && self.running.is_none()
        {
            ui.weak("There is such a file: it will be written over.");
        }
        let line = self.settings.command_line(&state);
        ui.label("The same from a shell:");
        ui.horizontal_wrapped(|ui| {
            ui.code(&line);
            if ui.button("Copy").clicked() {
                ui.ctx().copy_text(line);
            }
        });
        if !studio.grip.hand().is_idle() {
            ui.weak("The hand on the head and the dial's wind are not in it: what files have moves the hair.");
        }
        if let Some(running) = &self.running {
            let [done, all] = running.progress();
            match running.result() {
                None => {
                    let share = done as f32 / all.max(1) as f32;
                    let text = format!("{done} of {all} frames");
                    ui.add(ProgressBar::new(share).text(text));
                }
                Some(Ok(written)) => _ = ui.label(written),
                Some(Err(error)) => _ = ui.colored_label(ui.visuals().error_fg_color, error),
            }
        }
        let is_changed = studio.documents.as_ref().is_some_and(Documents::is_changed);
        let mut answer = Answer::Stays;
        ui.horizontal(|ui| {
            let verb = if is_changed {
                "Save and export"
            } else {
                "Export"
            };
            if ui.add_enabled(!is_busy, egui::Button::new(verb)).clicked() {
                self.start(ui, studio, &state);
            }
            if is_busy && ui.button("Cancel").clicked() {
                self.running.iter().for_each(Running::cancel);
            }
            if !is_busy && ui.button("Close").clicked() {
                answer = Answer::Closes;
            }
        });
        answer
    }

    fn settings(&mut self, ui: &mut Ui, studio: &Studio) {
        let settings = &mut self.settings;
        egui::Grid::new("export").num_columns(2).show(ui, |ui| {
            let label = ui.label("File");
            ui.text_edit_singleline(&mut settings.output)
                .labelled_by(label.id)
                .on_hover_text("A name that ends in .png; # marks become the frame's number; or in .apng for one file that moves");
            ui.end_row();
            ui.label("What");
            ui.horizontal(|ui| {
                ui.radio_value(&mut self.is_sequence, false, "this frame");
                ui.radio_value(&mut self.is_sequence, true, "a sequence");
            });
            ui.end_row();
            if self.is_sequence {
                ui.label("Frames");
                ui.horizontal(|ui| {
                    let [first, last] = &mut self.frames;
                    ui.add(egui::DragValue::new(first))
                        .accessible_name("First frame");
                    ui.label("to");
                    *last = (*last).max(*first);
                    ui.add(egui::DragValue::new(last).range(*first..=999_999))
                        .accessible_name("Last frame");
                });
                ui.end_row();
            }
            let own = studio.sections.scene.size;
            let mut is_own = settings.size_px.is_none();
            ui.label("Size");
            ui.horizontal(|ui| {
                ui.checkbox(&mut is_own, format!("the preset's, {}x{}", own[0], own[1]));
                if is_own {
                    settings.size_px = None;
                } else {
                    let [width, height] = settings.size_px.get_or_insert(own);
                    for (side, name) in [(width, "Width"), (height, "Height")] {
                        ui.add(egui::DragValue::new(side).range(1..=16_384))
                            .accessible_name(name);
                    }
                }
            });
            ui.end_row();
            let own = studio.sections.scene.samples;
            let mut is_own = settings.samples.is_none();
            ui.label("Samples");
            ui.horizontal(|ui| {
                ui.checkbox(&mut is_own, format!("the preset's, {own} a pixel"));
                if is_own {
                    settings.samples = None;
                } else {
                    let samples = settings.samples.get_or_insert(own);
                    ui.add(egui::DragValue::new(samples).range(1..=256))
                        .accessible_name("Samples");
                }
            });
            ui.end_row();
            ui.label("Drawn by");
            ui.horizontal(|ui| {
                for backend in Backend::ALL {
                    ui.radio_value(&mut settings.backend, backend, backend.name());
                }
            });
            ui.end_row();
            ui.label("Background");
            ui.checkbox(&mut settings.is_transparent, "none, a transparent picture");
            ui.end_row();
        });
        settings.frames = self.is_sequence.then_some(self.frames);
    }

    fn start(&mut self, ui: &Ui, studio: &mut Studio, state: &State) {
        studio.save();
        if studio.documents.as_ref().is_some_and(Documents::is_changed) {
            // Why it could not be saved is told.
            return;
        }
        let ctx = ui.ctx().clone();
        let arguments = self.settings.arguments(state);
        let wake = move || ctx.request_repaint();
        self.running = Some(Running::start(arguments, studio.registry.clone(), wake));
    }
}
