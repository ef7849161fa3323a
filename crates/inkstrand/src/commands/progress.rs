//! Bars that show how far long work is, and the work before the first frame.

use crate::Failure;
use indicatif::{ProgressBar, ProgressStyle};
use stage::{Preset, Stage};
use std::io::IsTerminal as _;

/// The most parts that the way to the first frame is gone in.
const PARTS: u64 = 1000;

/// A bar for some pieces of work on a terminal; nothing on a pipe.
pub(super) fn bar(quiet: bool, length: u64, noun: &str) -> ProgressBar {
    if quiet || length < 2 || !std::io::stderr().is_terminal() {
        return ProgressBar::hidden();
    }
    let bar = ProgressBar::new(length);
    let template = format!("{{bar:30}} {{pos}}/{{len}} {noun}{{msg}}, {{eta}} left");
    if let Ok(style) = ProgressStyle::with_template(&template) {
        bar.set_style(style);
    }
    bar
}

/// The bar of a command that makes `frames`, the first of them at `time` (seconds). When it returns, hair has come to the frame
/// before that.
pub(super) fn bar_from_first_frame(
    quiet: bool,
    stage: &mut Stage,
    preset: &Preset,
    time: f32,
    frames: u64,
) -> Result<ProgressBar, Failure> {
    let fps = f64::from(preset.sections.scene.fps);
    let warm_up = (f64::from(preset.sections.dynamics.warm_up) * fps).ceil();
    let before = (warm_up + f64::from(time) * fps) as u64;
    let before = before.saturating_sub(1);
    let bar = bar(quiet, before + frames, "frames");
    bar.set_message(", the first to come");
    // In parts, so that the bar moves; hair moves alike in any.
    let parts = before.min(PARTS);
    for part in 1..=parts {
        let done = before * part / parts;
        stage.advance_to(((done as f64 - warm_up) / fps) as f32)?;
        bar.set_position(done);
    }
    bar.set_message("");
    Ok(bar)
}
