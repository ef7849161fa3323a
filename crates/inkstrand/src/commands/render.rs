//! `inkstrand render`: a preset to pictures.

use super::progress::{Bar, Watch};
use super::scene::{Source, check, check_kind, check_named, say_returns};
use crate::Failure;
use crate::cli::{Background, Numbers, RenderOptions};
use crate::output::Output;
use crate::painter::Painter;
use crate::pass::PassPicture;
use crate::paths::is_same;
use crate::say::say;
use crate::stats::{FrameStats, Lines};
use effects::Registry;
use hair_io::try_to_write;
use render::Picture;
use stage::{Files, Preset, SceneSection, Sections};
use std::io;
use std::ops::RangeInclusive;
use std::path::Path;
use std::sync::Arc;

/// Draws, and tells what was written. Who watches is told of each frame, and may end it.
pub(crate) fn render(
    options: &RenderOptions,
    registry: &Registry,
    watch: Option<Watch>,
) -> Result<String, Failure> {
    // All that runs in parallel runs in here: simulation, effects and rasteriser.
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(options.threads.unwrap_or(0) as usize) // 0 is rayon's own choice
        .build()?;
    pool.install(|| draw(options, registry, watch))
}

/// A frame that is drawn, and not written yet.
enum Drawn {
    Picture(Arc<Picture>),
    Pass(PassPicture),
}

fn write(drawn: Option<(Drawn, u32)>, output: &mut Output) -> io::Result<()> {
    match drawn {
        Some((Drawn::Picture(picture), frame)) => output.write(&picture, frame),
        Some((Drawn::Pass(picture), frame)) => output.write_pass(&picture, frame),
        None => Ok(()),
    }
}

fn draw(
    options: &RenderOptions,
    registry: &Registry,
    watch: Option<Watch>,
) -> Result<String, Failure> {
    let source = Source::read(&options.preset)?;
    let mut preset = source.parse(registry)?;
    options.scene.apply(&mut preset).map_err(Failure::Usage)?;
    apply(options, &mut preset).map_err(Failure::Usage)?;
    let mut files = options.scene.files(&options.preset, &preset)?;
    check_named("--bake", options.bake.as_deref())?;
    check_kind("--bake", "bake", options.bake.as_deref())?;
    files.bake.clone_from(&options.bake);

    let SceneSection {
        fps,
        samples,
        background,
        ..
    } = preset.sections.scene;
    let mut output = Output::new(
        options.output.as_deref(),
        &options.preset,
        options.frames,
        fps,
        background.is_none(),
    )
    .map_err(Failure::Usage)?;
    if options.pass.is_some() && output.is_moving() {
        let message = "--pass: what it tells, in up to 16 bits, is no frame of an .apng: -o must be a name in .png";
        return Err(Failure::Usage(message.to_owned()));
    }
    let (first, last) = frames(options, fps);
    check_outputs(&output, &(first..=last), options, &preset, &files)?;

    let mut stage = source.open(&preset, &files, options.quiet)?;
    let time_of = |frame: u32| options.time.unwrap_or(frame as f32 / fps);
    for time in [first, last].map(time_of) {
        stage.scene.check_time(time)?;
    }
    let samples = options.pass.map_or(samples, |pass| pass.samples(samples));
    let mut painter = Painter::new(options.backend, samples, options.quiet)?;
    if options.stats.is_some() {
        painter.count_layers();
    }

    let mut bar = Bar::from_first_frame(
        options.quiet,
        &mut stage,
        &preset,
        time_of(first),
        u64::from(last - first) + 1,
        watch,
    )?;
    let mut stats = options.stats.as_deref().map(Lines::create).transpose()?;
    let mut paint = |frame: u32| -> Result<(Drawn, FrameStats), Failure> {
        let time = time_of(frame);
        let Some(pass) = options.pass else {
            let (picture, line) = painter.paint(&mut stage, frame, time)?;
            return Ok((Drawn::Picture(picture), line));
        };
        let distance = preset.sections.camera.distance;
        let (picture, line) = painter.paint_pass(&mut stage, frame, time, pass, distance)?;
        Ok((Drawn::Pass(picture), line))
    };
    let mut drawn = None;
    for frame in first..=last {
        // Times are told of frames that nothing else goes on beside.
        if stats.is_some() {
            write(drawn.take(), &mut output)?;
        }
        let waiting = drawn.take();
        let (written, painted) = rayon::join(|| write(waiting, &mut output), || paint(frame));
        written?;
        let (picture, line) = painted?;
        drawn = Some((picture, frame));
        if let Some(stats) = &mut stats {
            stats.push(&line)?;
        }
        bar.inc()?;
    }
    write(drawn, &mut output)?;
    output.finish()?;
    bar.finish();
    if !options.quiet {
        say_returns(&stage);
    }
    if !options.quiet && stage.left_out() > 0 {
        say(format_args!(
            "hair: {} strands reach too far away to be drawn and are left out",
            stage.left_out()
        ));
    }
    let (from, to) = (output.path(first), output.path(last));
    let mut written = format!("wrote {}", from.display());
    if from != to {
        written += &format!(" to {}", to.display());
    }
    if !options.quiet {
        say(&written);
    }
    Ok(written)
}

/// The first frame to draw and the last; of one moment the frame that is nearest to it.
fn frames(options: &RenderOptions, fps: f32) -> (u32, u32) {
    let at = (options.time.unwrap_or(0.0) * fps).round() as u32;
    options.frames.unwrap_or((at, at))
}

/// Refuses what cannot be written, and what would be written over by another file or over one that is read.
fn check_outputs(
    output: &Output,
    frames: &RangeInclusive<u32>,
    options: &RenderOptions,
    preset: &Preset,
    files: &Files,
) -> Result<(), Failure> {
    let stats = options
        .stats
        .as_deref()
        .filter(|path| *path != Path::new("-"));
    let mut read = preset.all_files(files);
    read.push(options.preset.clone());
    if let Some(path) = output.writes_over(&read, frames.clone()) {
        let message = format!(
            "-o: a picture would be written over {}, which is read",
            path.display()
        );
        return Err(Failure::Usage(message));
    }
    if let Some(stats) = stats
        && let Some(path) = read.iter().find(|path| is_same(stats, path))
    {
        let message = format!("--stats: {} is read, and cannot be written", path.display());
        return Err(Failure::Usage(message));
    }
    if let Some(stats) = stats {
        if (output.writes_over(&[stats.to_owned()], frames.clone())).is_some() {
            let message = format!("--stats: {} is a picture of -o", stats.display());
            return Err(Failure::Usage(message));
        }
        Lines::try_path(stats)?;
    }
    Ok(try_to_write(&output.path(*frames.start()))?)
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
