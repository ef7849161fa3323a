//! What a studio does around each frame of the window: texts are read, time passes, pictures are wished for and come in.

use super::{HOUSEKEEPING, Shown, Studio};
use crate::documents::{Documents, Which};
use crate::engine::{Drawn, Look, Wish};
use crate::inherited::Inherited;
use crate::motion_script::{LATEST_END_S, MotionTrack};
use crate::prompt::Prompt;
use crate::transport::SETTLING_S;
use eframe::egui::{ColorImage, TextureOptions};
use stage::Hand;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

impl Studio {
    /// The look as it is edited.
    #[must_use]
    pub fn look(&self) -> Option<Look> {
        let documents = self.documents.as_ref()?;
        Some(Look {
            name: documents.preset().path().display().to_string(),
            folder: documents.folder(),
            text: documents.preset().text().clone(),
            texts: documents.texts(),
            files_changed: self.files_changed,
            layers: self.layers.clone(),
        })
    }

    /// What happens before a frame of the window is made: time passes, pictures and changed files come in.
    pub fn before_frame(&mut self) {
        self.is_picture_there = false;
        if let Some(action) = self.pending {
            self.act(action);
            self.pending = None;
        }
        // The window's own clock: what it calls the time of a frame is a guess where nothing was asked for.
        let now_s = self.ctx.input(|input| input.time);
        let before_s = self.last_tick.replace(now_s).unwrap_or(now_s);
        let passed_s = (now_s - before_s) as f32;
        self.presses += u64::from(self.ctx.input(|input| input.pointer.any_pressed()));
        if self.last_housekeeping.elapsed() >= HOUSEKEEPING {
            self.last_housekeeping = Instant::now();
            if let Some(documents) = &mut self.documents {
                documents.keep_recovery_copies();
                documents.look_again();
                let error = documents.recovery_error().map(str::to_owned);
                // Once: it would hide all else that is told.
                let is_news = error != self.recovery_error;
                self.recovery_error.clone_from(&error);
                if let Some(error) = error.filter(|_| is_news) {
                    self.tell(format!(
                        "no copy is kept that would outlive a crash: {error}"
                    ));
                }
            }
        }
        if self.files.has_changed() {
            self.files_changed += 1;
            if let Some(compare) = &mut self.compare {
                compare.read_again(self.files_changed);
            }
            // A base may name others.
            if let Some(documents) = &mut self.documents {
                documents.follow_names();
            }
        }
        let told = self.documents.as_mut().map(Documents::poll);
        for sentence in told.into_iter().flatten() {
            self.files_changed += 1;
            self.tell(sentence);
        }
        self.read_texts();
        // What was still drawn of the preset before is not this one's.
        let answer = self.engine.answer();
        if let Some(answer) = answer.filter(|answer| answer.opened == self.opened) {
            self.is_sharp = answer.is_final;
            self.problems = answer.problems;
            self.is_outdated = answer.is_outdated;
            self.watch_files(answer.files);
            for (index, drawn) in answer.pictures.into_iter().enumerate().take(2) {
                if let Some(drawn) = drawn {
                    self.show(index, drawn);
                }
            }
        }
        self.follow_end();
        self.transport.tick(passed_s);
        let step_s = 1.0 / self.transport.fps();
        self.grip.advance_to(self.transport.shown_s(), step_s);
    }

    /// What happens after: the picture that is wanted now is wished for.
    pub fn after_frame(&mut self) {
        self.look_after_texts();
        let Some(look) = self.look().filter(|_| self.picture_px != [0, 0]) else {
            return;
        };
        let mut looks = vec![look];
        looks.extend(self.compare.as_ref().map(|compare| compare.look.clone()));
        let is_moving = self.transport.is_playing || self.is_dragging;
        let wish = Wish {
            looks,
            opened: self.opened,
            camera: Some(self.camera()),
            size_px: self.picture_px,
            is_moving,
            samples: None,
            time_s: self.transport.shown_s(),
            hand: self.grip.hand().clone(),
            backend: self.backend,
        };
        // Of one that nobody sees only its mistakes are of interest: it stays as it was seen last, or at the beginning where that is of another
        // preset or time was put back.
        let last = self.engine.last();
        let last = last.filter(|last| last.opened == wish.opened && last.time_s <= wish.time_s);
        let wish = match (self.is_picture_there, last) {
            (true, _) => wish,
            (false, Some(last)) => Wish {
                looks: wish.looks,
                is_moving: false,
                ..last.clone()
            },
            (false, None) => Wish {
                is_moving: false,
                time_s: 0.0,
                hand: Hand::new(),
                ..wish
            },
        };
        let is_new = self.engine.wish(wish);
        self.is_sharp &= !is_new;
        let is_held = self.ctx.input(|input| input.pointer.any_down());
        if self.transport.is_playing && !self.engine.is_drawing() {
            // While a frame is drawn its end is waited for: a window that is drawn in software would take the time that hair needs.
            let due = Duration::from_secs_f32(self.transport.next_frame_in_s());
            self.ctx.request_repaint_after(due);
        } else if self.is_dragging && !is_held {
            // What was dragged is at rest from the next frame on.
            self.ctx.request_repaint();
        }
        self.is_dragging = false;
    }

    /// Asks what becomes of copies that a crash has left, and wakes the window when its texts want care.
    fn look_after_texts(&mut self) {
        let Some(documents) = &mut self.documents else {
            return;
        };
        if self.prompt.is_none() && documents.take_copies() {
            self.prompt = Some(Prompt::Recover);
            self.ctx.request_repaint();
        }
        if documents.wants_care() || self.files.wants_care() {
            self.ctx.request_repaint_after(HOUSEKEEPING);
        }
    }

    /// Watches what the look is read from, and another preset that it is compared with, whether it could be drawn or not: somebody may mend it.
    fn watch_files(&mut self, mut files: Vec<PathBuf>) {
        if self.is_outdated {
            // It may be a base that can't be read.
            files.extend(self.documents.iter().flat_map(Documents::bases));
        }
        files.extend(
            self.compare
                .iter()
                .filter_map(|compare| compare.path.clone()),
        );
        self.files.watch(&files);
    }

    fn show(&mut self, index: usize, drawn: Drawn) {
        let size = drawn.size_px.map(|side| side as usize);
        let image = ColorImage::from_rgba_unmultiplied(size, &drawn.pixels);
        if let Some(shown) = &mut self.shown[index] {
            shown.texture.set(image, TextureOptions::LINEAR);
            shown.drawn = drawn;
        } else {
            let texture =
                self.ctx
                    .load_texture(format!("picture {index}"), image, TextureOptions::LINEAR);
            self.shown[index] = Some(Shown { drawn, texture });
        }
    }

    /// Whether what is wished for is not drawn yet.
    #[must_use]
    pub fn is_drawing(&self) -> bool {
        self.engine.is_drawing()
    }

    /// The pixels of a picture: rows from above, red, green, blue, alpha, sRGB, straight.
    #[must_use]
    pub fn pixels(&self, index: usize) -> Option<&[u8]> {
        Some(&self.shown[index].as_ref()?.drawn.pixels)
    }

    /// Reads what of the texts the window itself needs.
    fn read_texts(&mut self) {
        let Some(documents) = &self.documents else {
            return;
        };
        let version = |which| {
            let document = documents.get(which)?;
            Some((document.path().to_owned(), document.version()))
        };
        // What the preset builds on is read with it, and may have changed on the disk.
        let versions = [Which::Preset, Which::Motion].map(version);
        let versions = (self.files_changed, versions);
        if self.read.as_ref() == Some(&versions) {
            return;
        }
        self.read = Some(versions);
        let preset = documents.preset();
        let folder = preset.path().parent().unwrap_or(Path::new(""));
        let (name, text) = (preset.name(), preset.text());
        if let Ok(read) = stage::Preset::parse_in(folder, &name, text, &self.registry) {
            let names: BTreeSet<&str> = read
                .layers
                .iter()
                .map(|layer| layer.name.as_str())
                .collect();
            self.layers.forget_others(&names);
            self.inherited = Inherited::below(&read);
            // Motion that begins anew is simulated from the beginning: where no script says what is when, that is now.
            let [own, new] =
                [&self.sections, &read.sections].map(|s| (&s.hair, &s.head, &s.dynamics));
            if own != new && self.track.end_s(SETTLING_S) == 0.0 {
                self.transport.seek(0.0);
            }
            self.sections = read.sections;
        }
        let script = documents.get(Which::Motion);
        self.track = script.map_or_else(MotionTrack::default, |script| {
            MotionTrack::read(script.text())
        });
    }

    /// Lets time go as far as the script does, or an animation beside it that is longer.
    fn follow_end(&mut self) {
        let shown = self.shown[0].as_ref();
        let animation_s = shown.map_or(0.0, |shown| shown.drawn.facts.animation_s);
        let end_s = match self.track.end_s(SETTLING_S) {
            0.0 => 0.0,
            script_s => script_s.max(animation_s.min(LATEST_END_S)),
        };
        self.transport.follow(self.sections.scene.fps, end_s);
    }
}
