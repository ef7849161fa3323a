//! How far long work is, or that it goes on: on a terminal, or to the program that this is a part of; and the work before the first frame.

use crate::Failure;
use indicatif::{ProgressBar, ProgressStyle};
use stage::{Preset, Stage};
use std::io::IsTerminal as _;
use std::time::Duration;

/// The most parts that the way to the first frame is gone in.
const PARTS: u64 = 1000;

/// Shows that something of unknown length goes on, and for how long it has, on a terminal alone.
pub(super) struct Wait(ProgressBar);

impl Wait {
    /// It is what goes on: `loading look.ron`.
    pub fn begin(quiet: bool, what: String) -> Self {
        if quiet || !std::io::stderr().is_terminal() {
            return Self(ProgressBar::hidden());
        }
        let bar = ProgressBar::new_spinner().with_message(what);
        let bar = match ProgressStyle::with_template("{spinner} {msg}, {elapsed}") {
            Ok(style) => bar.with_style(style),
            Err(_) => bar,
        };
        bar.enable_steady_tick(Duration::from_millis(100));
        Self(bar)
    }
}

impl Drop for Wait {
    fn drop(&mut self) {
        self.0.finish_and_clear();
    }
}

/// How far a command is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Progress {
    /// Frames that are done. Those before the first one that is wanted, which only move hair, count too.
    pub done: u64,
    /// All of them.
    pub all: u64,
}

/// Who is told how far a command is, and says whether it goes on.
pub(crate) type Watch<'a> = &'a mut (dyn FnMut(Progress) -> bool + Send);

/// What shows how far a command is.
pub(super) struct Bar<'a> {
    bar: ProgressBar,
    progress: Progress,
    watch: Option<Watch<'a>>,
}

impl<'a> Bar<'a> {
    /// A bar for some pieces of work on a terminal; nothing on a pipe. A watch is told in any case.
    pub fn new(quiet: bool, all: u64, noun: &str, watch: Option<Watch<'a>>) -> Self {
        let progress = Progress { done: 0, all };
        let bar = if quiet || all < 2 || !std::io::stderr().is_terminal() {
            ProgressBar::hidden()
        } else {
            let template = format!("{{bar:30}} {{pos}}/{{len}} {noun}{{msg}}, {{eta}} left");
            let bar = ProgressBar::new(all);
            match ProgressStyle::with_template(&template) {
                Ok(style) => bar.with_style(style),
                Err(_) => bar,
            }
        };
        Self {
            bar,
            progress,
            watch,
        }
    }

    /// The bar of a command that makes `frames`, the first of them at `time` (seconds). When it returns, hair has come to the frame
    /// before that.
    pub fn from_first_frame(
        quiet: bool,
        stage: &mut Stage,
        preset: &Preset,
        time: f32,
        frames: u64,
        watch: Option<Watch<'a>>,
    ) -> Result<Self, Failure> {
        let fps = f64::from(preset.sections.scene.fps);
        let warm_up = (f64::from(preset.sections.dynamics.warm_up) * fps).ceil();
        let before = (warm_up + f64::from(time) * fps) as u64;
        let before = before.saturating_sub(1);
        let mut bar = Self::new(quiet, before + frames, "frames", watch);
        bar.bar.set_message(", the first to come");
        // In parts, so that the bar moves; hair moves alike in any.
        let parts = before.min(PARTS);
        for part in 1..=parts {
            let done = before * part / parts;
            stage.advance_to(((done as f64 - warm_up) / fps) as f32)?;
            bar.set(done)?;
        }
        bar.bar.set_message("");
        Ok(bar)
    }

    /// One piece more is done. It fails where who watches wants no more.
    pub fn inc(&mut self) -> Result<(), Failure> {
        self.set(self.progress.done + 1)
    }

    fn set(&mut self, done: u64) -> Result<(), Failure> {
        self.progress.done = done;
        self.bar.set_position(done);
        let goes_on = (self.watch.as_mut()).is_none_or(|watch| watch(self.progress));
        match goes_on {
            true => Ok(()),
            false => Err(Failure::Failed("cancelled".to_owned())),
        }
    }

    /// Takes the bar away.
    pub fn finish(self) {
        self.bar.finish_and_clear();
    }
}
