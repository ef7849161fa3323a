//! `inkstrand render`: a preset to pictures.

use super::read_preset;
use super::scene::{check, open, parse};
use crate::Failure;
use crate::cli::{Background, Numbers, RenderOptions};
use crate::output::Output;
use crate::painter::Painter;
use crate::whole_file::WholeFile;
use effects::Registry;
use indicatif::{ProgressBar, ProgressStyle};
use stage::{Preset, SceneSection, Sections};
use std::io::{IsTerminal as _, Write as _};

pub(crate) fn render(options: &RenderOptions, registry: &Registry) -> Result<(), Failure> {
    // All that runs in parallel runs in here: simulation, effects and rasteriser.
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(options.threads.unwrap_or(0) as usize) // 0 is rayon's own choice
        .build()?;
    pool.install(|| draw(options, registry))
}

fn draw(options: &RenderOptions, registry: &Registry) -> Result<(), Failure> {
    let text = read_preset(&options.preset).map_err(Failure::Failed)?;
    let mut preset = parse(&options.preset, &text, registry)?;
    options.scene.apply(&mut preset).map_err(Failure::Usage)?;
    apply(options, &mut preset).map_err(Failure::Usage)?;
    let mut files = options.scene.files(&options.preset);
    files.bake.clone_from(&options.bake);
    let mut stage = open(&preset, &files, options.quiet)?;

    let SceneSection {
        fps,
        samples,
        background,
        ..
    } = preset.sections.scene;
    let transparent = background.is_none();
    let sequence = options.frames.is_some();
    let output = Output::new(
        options.output.as_deref(),
        &options.preset,
        sequence,
        transparent,
    )
    .map_err(Failure::Usage)?;
    let mut painter = Painter::new(options.backend, samples, options.quiet)?;

    let (first, last) = options.frames.unwrap_or((0, 0));
    let bar = progress_bar(options.quiet, u64::from(last - first) + 1);
    let mut stats = match &options.stats {
        Some(path) => Some(WholeFile::create(path)?),
        None => None,
    };
    for frame in first..=last {
        let time = options.time.unwrap_or(frame as f32 / fps);
        let (picture, line) = painter.paint(&mut stage, frame, time)?;
        let path = output.write(&picture, frame)?;
        if let Some(stats) = &mut stats {
            // A line as its frame is there, for whoever watches the file grow.
            writeln!(stats, "{}", serde_json::to_string(&line)?)?;
            stats.flush()?;
        }
        bar.inc(1);
        if !options.quiet && !sequence {
            eprintln!("wrote {}", path.display());
        }
    }
    bar.finish_and_clear();
    if !options.quiet && stage.left_out() > 0 {
        eprintln!(
            "hair: {} strands reach too far away to be drawn and are left out",
            stage.left_out()
        );
    }
    if !options.quiet && sequence {
        let (from, to) = (output.path(first), output.path(last));
        eprintln!("wrote {} to {}", from.display(), to.display());
    }
    if let Some(stats) = stats {
        stats.finish()?;
    }
    Ok(())
}

/// Puts the command line's options in place of the preset's.
fn apply(options: &RenderOptions, preset: &mut Preset) -> Result<(), String> {
    let Sections {
        scene,
        camera,
        light,
        ..
    } = &mut preset.sections;
    scene.size = options.size.map_or(scene.size, |(w, h)| [w, h]);
    scene.samples = options.samples.unwrap_or(scene.samples);
    if let Some(Background(background)) = options.background {
        scene.background = background;
    }
    if let Some(Numbers(numbers)) = &options.camera {
        let [yaw, pitch, distance] = match numbers[..] {
            [yaw, pitch] => [yaw, pitch, camera.distance],
            [yaw, pitch, distance] => [yaw, pitch, distance],
            _ => return Err("--camera takes YAW,PITCH or YAW,PITCH,DISTANCE".to_owned()),
        };
        (camera.yaw, camera.pitch, camera.distance) = (yaw, pitch, distance);
    }
    if let Some(Numbers(numbers)) = &options.light {
        let [yaw, pitch] = numbers[..] else {
            return Err("--light takes YAW,PITCH".to_owned());
        };
        (light.yaw, light.pitch) = (yaw, pitch);
    }
    check(preset)?;
    if !options.only.is_empty() {
        preset
            .keep_only(&options.only)
            .map_err(|e| format!("--only: {e}"))?;
    }
    Ok(())
}

/// A bar for sequences on a terminal; nothing on a pipe.
pub(super) fn progress_bar(quiet: bool, frames: u64) -> ProgressBar {
    if quiet || frames < 2 || !std::io::stderr().is_terminal() {
        return ProgressBar::hidden();
    }
    let bar = ProgressBar::new(frames);
    if let Ok(style) = ProgressStyle::with_template("{bar:40} {pos}/{len} frames, {eta} left") {
        bar.set_style(style);
    }
    bar
}
