//! Suite `frame`: what a whole frame of each yardstick takes, by stages, on both backends; and what one takes in other sizes and with more samples.
//! Suite `looks`: the same of the looks that come with inkstrand.
//! Camera and hair move, so that nothing can be reused.

use crate::BenchError;
use crate::backends::{
    Backends, CPU_STAGES, Card, ON_CARD_ARE_THE_LEAST, STAGES, Times, card_stages, cpu_stages,
    rows, share_that_differs,
};
use crate::character;
use crate::results::{self, Row};
use crate::targets::{Found, Limit, Target};
use crate::timing::Effort;
use effects::Registry;
use indicatif::ProgressBar;
use render::Frame;
use stage::{Files, Preset, Stage};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// Samples a pixel: what a live picture has.
const SAMPLES: u32 = 4;
/// Frames a second of the animation and of the target.
const FPS: f64 = 60.0;
/// Milliseconds of a frame that a look's simulation may take.
const SIMULATION_MS: f64 = 1.5;
/// The yardstick that is drawn in other sizes and with other samples.
const SIZED: &str = "twin-tails";
/// These, with [`SAMPLES`], beside the yardsticks' own: time grows no faster than pixels.
const SIZES: [[u32; 2]; 4] = [[480, 360], [960, 720], [1920, 1440], [3840, 2880]];
/// These, in the yardsticks' own size: beyond [`SAMPLES`] time grows less than they do.
const MORE_SAMPLES: [u32; 2] = [8, 16];
/// Frames that are drawn before any is counted.
const WARM_UP: u32 = 3;
/// The same with a card, whose clock goes up slowly.
pub(crate) const CARD_WARM_UP: u32 = 60;

/// What the user asks for.
#[derive(Clone, Debug)]
pub struct Options {
    /// The project's folder, for its yardsticks.
    pub root: PathBuf,
    /// Where the files go.
    pub out: PathBuf,
    /// Fewer frames.
    pub quick: bool,
    /// Threads of the CPU's backend.
    pub threads: usize,
    /// Which graphics card.
    pub card: Card,
}

/// All that was measured.
pub struct Measured {
    /// A row a look and stage.
    pub rows: Vec<Row>,
    /// Whole frames against 60 frames a second, and their simulation.
    pub targets: Vec<Target>,
    /// The graphics card that was measured, if any.
    pub card: Option<String>,
}

/// Measures all looks and writes `frame.csv`.
///
/// # Errors
///
/// When a preset cannot be read, nothing can be drawn, or a file cannot be written.
pub fn run(options: &Options, progress: &ProgressBar) -> Result<Measured, BenchError> {
    let mut presets = presets(&options.root.join(YARDSTICKS))?;
    if options.quick {
        presets.truncate(3);
    }
    progress.set_length(presets.len() as u64 + 1);
    let mut measured = whole_frames(&presets, None, options, progress)?;
    let frames = options.frames();
    let pool = options.pool()?;
    progress.set_message("other sizes and samples");
    let sized = pool.install(|| sizes(options, if options.quick { 4 } else { 24 }))?;
    measured.rows.extend(sized.rows);
    measured.targets.extend(sized.targets);
    progress.inc(1);
    progress.set_message("character");
    let effort = Effort {
        rounds: frames as usize,
        each: Duration::from_secs(if options.quick { 5 } else { 20 }),
    };
    let (rows, targets) =
        pool.install(|| character::measure(&options.root, &options.out, effort))?;
    measured.rows.extend(rows);
    measured.targets.extend(targets);
    let mut comments = options.comments(&measured);
    comments.push(
        "character: what its meshes add to a frame on the CPU, flat and painted by a layer: the shortest of frames with them less that without"
            .to_owned(),
    );
    comments.extend(results::machine(options.threads, &["wgpu"]));
    results::save(
        &options.out,
        "frame.csv",
        &results::csv("frame", &comments, &measured.rows),
    )?;
    Ok(measured)
}

/// The looks that come with inkstrand, and `looks.csv`: what a frame of each takes, as of the yardsticks.
///
/// # Errors
///
/// As of [`run`].
pub fn run_looks(options: &Options, progress: &ProgressBar) -> Result<Measured, BenchError> {
    let mut presets = presets(&options.root.join(LOOKS))?;
    let registry = registry()?;
    // What is drawn together is measured alone.
    let mut is_alone = Vec::new();
    for path in &presets {
        is_alone.push(preset(path, &registry)?.objects.is_empty());
    }
    let mut is_alone = is_alone.into_iter();
    presets.retain(|_| is_alone.next() == Some(true));
    if options.quick {
        presets.truncate(3);
    }
    progress.set_length(presets.len() as u64);
    let measured = whole_frames(&presets, Some(SIZES[1]), options, progress)?;
    let mut comments = options.comments(&measured);
    comments.extend(results::machine(options.threads, &["wgpu"]));
    results::save(
        &options.out,
        "looks.csv",
        &results::csv("looks", &comments, &measured.rows),
    )?;
    Ok(measured)
}

/// Whole frames of some presets, in their own sizes or another, held to 60 a second.
fn whole_frames(
    presets: &[PathBuf],
    size: Option<[u32; 2]>,
    options: &Options,
    progress: &ProgressBar,
) -> Result<Measured, BenchError> {
    let mut measured = Measured {
        rows: Vec::new(),
        targets: Vec::new(),
        card: None,
    };
    let pool = options.pool()?;
    // One for all looks, as in a program that shows one after the other: a driver may give no more than some dozens of devices.
    let mut backends = Backends::new(SAMPLES, options.card)?;
    measured.card = backends.card_name();
    for preset in presets {
        let name = preset
            .file_stem()
            .unwrap_or_default()
            .to_string_lossy()
            .into_owned();
        progress.set_message(name.clone());
        let mut stage = open(preset, &options.root, size)?;
        let frames = options.frames();
        let rows = pool.install(|| look(&name, SAMPLES, &mut stage, &mut backends, frames))?;
        let simulate = rows.iter().find(|row| row.method == BEFORE[0]);
        measured.targets.extend(simulate.map(|row| Target {
            text: format!("{name}: milliseconds of simulation a frame"),
            found: Some(Found::Is(1e3 * row.seconds)),
            limit: Limit::AtMost(SIMULATION_MS),
        }));
        for method in ["cpu", "gpu"] {
            let whole = rows.iter().find(|row| row.method == method);
            measured.targets.extend(whole.map(|row| Target {
                text: format!("{name}, {method}: milliseconds a frame"),
                found: Some(Found::Is(1e3 * row.seconds)),
                limit: Limit::AtMost(1e3 / FPS),
            }));
        }
        measured.rows.extend(rows);
        progress.inc(1);
    }
    Ok(measured)
}

impl Options {
    /// Frames of each look that are counted.
    fn frames(&self) -> u32 {
        if self.quick { 12 } else { 60 }
    }

    fn pool(&self) -> Result<rayon::ThreadPool, BenchError> {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(self.threads)
            .build();
        pool.map_err(|error| error.to_string().into())
    }

    /// What the rows of whole frames are.
    fn comments(&self, measured: &Measured) -> Vec<String> {
        let frames = self.frames();
        vec![
            format!(
                "whole frames and their stages, {SAMPLES} samples a pixel, medians of {frames} frames 1/{FPS} s apart"
            ),
            "method: a backend and its stage; simulate and paths are of both; knob: samples"
                .to_owned(),
            ON_CARD_ARE_THE_LEAST.to_owned(),
            "error of gpu: share of pixels that differ from the CPU's by more than 2/255"
                .to_owned(),
            format!(
                "graphics card: {}",
                measured.card.as_deref().unwrap_or("none")
            ),
        ]
    }
}

/// Where the looks are that come with inkstrand.
pub(crate) const LOOKS: &str = "presets";
/// Where the looks are that don't change.
pub(crate) const YARDSTICKS: &str = "tests/yardsticks";

/// The presets of a folder, by name.
pub(crate) fn presets(folder: &Path) -> Result<Vec<PathBuf>, BenchError> {
    let failed = |error| format!("{}: {error}", folder.display());
    let mut paths = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(failed)? {
        paths.push(entry.map_err(failed)?.path());
    }
    paths.retain(|path| path.extension().is_some_and(|ending| ending == "ron"));
    if paths.is_empty() {
        return Err(format!("{}: no preset is in it", folder.display()).into());
    }
    paths.sort();
    Ok(paths)
}

/// The effects that come with inkstrand.
pub(crate) fn registry() -> Result<Registry, BenchError> {
    let mut registry = Registry::new();
    effects_builtin::register(&mut registry).map_err(|error| error.to_string())?;
    effects_cartoon::register(&mut registry).map_err(|error| error.to_string())?;
    effects_surface::register(&mut registry).map_err(|error| error.to_string())?;
    Ok(registry)
}

/// Reads a preset.
pub(crate) fn preset<'r>(path: &Path, registry: &'r Registry) -> Result<Preset<'r>, BenchError> {
    let name = path.display().to_string();
    let text = std::fs::read_to_string(path).map_err(|error| format!("{name}: {error}"))?;
    Preset::parse(&name, &text, registry).map_err(|errors| errors.to_string().into())
}

/// [`SIZED`] in several sizes, and with several numbers of samples, on the CPU.
fn sizes(options: &Options, frames: u32) -> Result<Measured, BenchError> {
    let path = options.root.join(YARDSTICKS).join(format!("{SIZED}.ron"));
    let mut measured = Measured {
        rows: Vec::new(),
        targets: Vec::new(),
        card: None,
    };
    // What rasterising takes for each pixel, and for each sample of one.
    let mut raster = |size: [u32; 2], samples: u32| -> Result<f64, BenchError> {
        let mut stage = open(&path, &options.root, Some(size))?;
        let mut backends = Backends::without_card(samples)?;
        let [width, height] = size;
        let name = format!("{SIZED}, {width} x {height}");
        let rows = look(&name, samples, &mut stage, &mut backends, frames)?;
        let raster = rows.iter().find(|row| row.method == "cpu:raster");
        let seconds = raster.map_or(f64::NAN, |row| row.seconds);
        measured.rows.extend(rows);
        Ok(seconds / (f64::from(width) * f64::from(height)))
    };
    let mut targets = Vec::new();
    let mut target = |text: String, found: f64| {
        targets.push(Target {
            text,
            found: Some(Found::Is(found)),
            limit: Limit::AtMost(1.0),
        });
    };
    let own = SIZES[1];
    let (mut before, mut few) = (None, f64::NAN);
    for size @ [width, height] in SIZES {
        let now = raster(size, SAMPLES)?;
        if size == own {
            few = now / f64::from(SAMPLES);
        }
        if let Some(before) = before.replace(now) {
            let text = format!("{SIZED}, {width} x {height}: raster a pixel, of half as wide");
            target(text, now / before);
        }
    }
    for samples in MORE_SAMPLES {
        let now = raster(own, samples)? / f64::from(samples);
        let text = format!("{SIZED}, {samples} samples: raster a sample, of {SAMPLES}");
        target(text, now / few);
    }
    measured.targets = targets;
    Ok(measured)
}

/// A look whose head nods and shakes, in its own size or another.
fn open(path: &Path, root: &Path, size: Option<[u32; 2]>) -> Result<Stage, BenchError> {
    let registry = registry()?;
    let mut preset = preset(path, &registry)?;
    if let Some(size) = size {
        preset.sections.scene.size = size;
    }
    preset.sections.scene.fps = FPS as f32;
    let files = Files {
        motion: Some(
            root.join(YARDSTICKS)
                .join("motions/nod-and-shake.motion.ron"),
        ),
        preset_folder: path.parent().unwrap_or(root).to_owned(),
        ..Files::default()
    };
    Stage::new(&preset, &files).map_err(|error| error.to_string().into())
}

/// What comes before drawing, on both backends.
const BEFORE: [&str; 2] = ["simulate", "paths"];

/// Rows of so many frames of a stage on the CPU, then of as many on the card, where there is one. Alone it has enough to do to keep its
/// clock up: between pictures of the CPU it would rest, and take four times as long.
pub(crate) fn look(
    name: &str,
    samples: u32,
    stage: &mut Stage,
    backends: &mut Backends,
    frames: u32,
) -> Result<Vec<Row>, BenchError> {
    let mut times = vec![Times::default(); BEFORE.len() + STAGES.len()];
    let (before, drawing) = times.split_at_mut(BEFORE.len());
    let (on_cpu, on_card) = drawing.split_at_mut(CPU_STAGES);
    let push = |times: &mut [Times], found: &[f64]| {
        for (times, seconds) in times.iter_mut().zip(found) {
            times.push(*seconds);
        }
    };
    let mut clip = Clip { stage, number: 0 };
    for number in 0..WARM_UP + frames {
        let (frame, taken) = clip.next()?;
        let (picture, cpu) = backends.on_cpu(&frame)?;
        backends.give_back(picture);
        if number >= WARM_UP {
            push(before, &taken);
            push(on_cpu, &cpu_stages(taken.iter().sum(), cpu));
        }
    }
    let mut error = None;
    let of_card = backends.card_name().map_or(0, |_| CARD_WARM_UP + frames);
    for number in 0..of_card {
        let (frame, taken) = clip.next()?;
        let Some((by_card, card)) = backends.on_card(&frame)? else {
            break;
        };
        if number >= CARD_WARM_UP {
            push(on_card, &card_stages(taken.iter().sum(), card));
        }
        if number + 1 == of_card {
            let (picture, _) = backends.on_cpu(&frame)?;
            error = Some(share_that_differs(&picture, &by_card));
            backends.give_back(picture);
        }
    }
    let stages = BEFORE.into_iter().chain(STAGES).zip(&times);
    Ok(rows(name, samples as usize, stages, error))
}

/// Frames of a stage, 1/60 s apart, seen by a camera that goes round by 30 degrees a second.
struct Clip<'a> {
    stage: &'a mut Stage,
    number: u32,
}

impl Clip<'_> {
    /// The next frame, and the seconds that took what comes [`BEFORE`] it is drawn.
    fn next(&mut self) -> Result<(Frame<'_>, [f64; 2]), BenchError> {
        let time = f64::from(self.number) / FPS;
        self.number += 1;
        let start = Instant::now();
        self.stage.scene.camera.yaw = (30.0 * time) as f32;
        let advanced = self.stage.advance_to(time as f32);
        advanced.map_err(|e| e.to_string())?;
        let simulate = start.elapsed().as_secs_f64();
        let frame = self.stage.frame().map_err(|e| e.to_string())?;
        let paths = start.elapsed().as_secs_f64() - simulate;
        Ok((frame, [simulate, paths]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn root() -> PathBuf {
        Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
    }

    #[test]
    fn presets_are_found_by_name_and_a_folder_without_any_is_an_error() {
        let folder = tempfile::tempdir().unwrap();
        assert!(presets(folder.path()).is_err());
        assert!(presets(&folder.path().join("none")).is_err());
        for name in ["b.ron", "notes.md", "a.ron"] {
            std::fs::write(folder.path().join(name), "").unwrap();
        }
        let found = presets(folder.path()).unwrap();
        assert_eq!(
            found,
            ["a.ron", "b.ron"].map(|name| folder.path().join(name))
        );
    }

    #[test]
    fn a_look_has_all_its_stages() {
        let path = root().join(YARDSTICKS).join("short-ash.ron");
        let mut stage = open(&path, &root(), None).unwrap();
        let mut backends = Backends::new(1, Card::Hardware).unwrap();
        let rows = look("short-ash", 1, &mut stage, &mut backends, 2).unwrap();
        let of = |method: &str| {
            rows.iter()
                .find(|row| row.method == method)
                .unwrap()
                .seconds
        };
        let parts = of("simulate") + of("paths") + of("cpu:effects") + of("cpu:raster");
        // Medians of parts are not the parts of a median, but they are near.
        assert!(of("cpu") > 0.5 * parts && of("cpu") < 2.0 * parts);
        assert!(of("cpu:raster") > 0.0 && of("simulate") > 0.0);
    }
}
