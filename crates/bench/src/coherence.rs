//! Suite `coherence`: how continuous pictures are in time, in every order of strokes.

pub mod animation;
pub mod lines;
pub mod looks;
pub mod painter;
pub mod pictures;
pub mod places;
pub mod scenes;
pub mod search;
pub mod strands;
pub mod targets;
pub mod tiles;
pub mod warp;

use crate::BenchError;
use crate::results::{self, Row};
use crate::targets::Target;
use crate::timing::{Effort, medians};
use animation::{Animation as _, Kind, TICKS, seconds};
use indicatif::ProgressBar;
use looks::Look;
use painter::Painter;
use render::cpu::Rasterizer;
use scenes::{NamedOrder, PART, Subject};
use search::{Continuity, Painters};
use std::fmt::Write as _;
use std::path::PathBuf;
use std::time::Duration;

/// Samples a pixel of the pictures that are timed, and of those of still input.
const TIMED_SAMPLES: u32 = 4;
const STILL_SAMPLES: u32 = 16;
/// Later moments at which a still look is drawn again, in ticks.
const STILL: [animation::Tick; 3] = [0, 1, 5 * TICKS / 2];

/// What the user asks for.
#[derive(Clone, Debug)]
pub struct Options {
    /// The project's folder, for its presets.
    pub root: PathBuf,
    /// Where the files go.
    pub out: PathBuf,
    /// Fewer looks and less time: done within two minutes on two cores.
    pub quick: bool,
    /// Threads.
    pub threads: usize,
    /// The folder of real hair, if there is one.
    pub data: Option<PathBuf>,
    /// Scenes whose names hold this.
    pub only: String,
}

/// All that was measured.
pub struct Measured {
    /// What each scene came to.
    pub scenes: Vec<SceneFigures>,
    /// What the figures are held to.
    pub targets: Vec<Target>,
    /// Pictures of what changes most.
    pub pictures: Vec<PathBuf>,
    /// Lines of meshes.
    pub lines: Vec<lines::LineFigures>,
}

/// What was found in a scene.
pub struct SceneFigures {
    /// Its name.
    pub name: String,
    /// What it is for.
    pub kind: Kind,
    /// How far strands move.
    pub motion: search::Motion,
    /// What it was drawn in.
    pub orders: Vec<NamedOrder>,
    /// Parallel to `orders`.
    pub figures: Vec<Figures>,
}

/// What was found in an order's pictures of a scene.
#[derive(Clone, Debug)]
pub struct Figures {
    /// How changes shrink with time.
    pub continuity: Continuity,
    /// The error of the frame before, warped, for each of [`warp::SAMPLES`].
    pub warp: [Option<f64>; 2],
    /// Pixels that change though nothing moves; looks only.
    pub still: Option<usize>,
    /// To rasterise a frame.
    pub seconds: f64,
}

/// Measures, and writes `coherence.csv` and pictures of what changes most.
///
/// # Errors
///
/// When a look cannot be read or drawn, or a file cannot be written.
pub fn run(options: &Options, progress: &ProgressBar) -> Result<Measured, BenchError> {
    let data = options.data.as_deref();
    let mut scenes = scenes::scenes(&options.root, data, options.quick, &options.only)?;
    let of_lines = lines::measure(options.quick, &options.only)?;
    if scenes.is_empty() && of_lines.is_empty() {
        return Err(format!("no scene's name holds `{}`", options.only).into());
    }
    progress.set_length(scenes.iter().map(search::length).sum::<usize>() as u64);
    let mut painters = Painters::new(options.threads)?;
    let mut of_looks: Vec<(String, OfLook)> = Vec::new();
    let mut figures = Vec::new();
    let mut pictures = Vec::new();
    for scene in &mut scenes {
        progress.set_message(scene.name.clone());
        let of_look = match of_looks
            .iter()
            .find(|(name, _)| Some(name) == scene.look_name())
        {
            Some((_, of_look)) => of_look.clone(),
            None => {
                let of_look = OfLook::measure(scene, options)?;
                of_looks.extend(
                    scene
                        .look_name()
                        .map(|name| (name.clone(), of_look.clone())),
                );
                of_look
            }
        };
        let effort = effort(options.quick);
        let (found, motion) = search::measure(scene, &mut painters, effort, || progress.inc(1))?;
        let warps = warp::measure(scene, options.threads)?;
        for ((name, _), continuity) in scene.orders.iter().zip(&found) {
            if let Some(worst) = &continuity.worst {
                let file = format!("coherence/{}-{name}.png", scene.name);
                let path = options.out.join(file);
                pictures::write(&path, worst)?;
                pictures.push(path);
            }
        }
        let both = found.into_iter().zip(warps).enumerate();
        figures.push(SceneFigures {
            name: scene.name.clone(),
            kind: scene.kind,
            motion,
            orders: scene.orders.clone(),
            figures: both
                .map(|(i, (continuity, warp))| Figures {
                    continuity,
                    warp,
                    still: of_look.still.as_ref().map(|still| still[i]),
                    seconds: of_look.seconds[i],
                })
                .collect(),
        });
    }
    let path = options.out.join("coherence.csv");
    let rows = [rows(&figures), lines::rows(&of_lines)].concat();
    let csv = results::csv("coherence", &comments(options), &rows);
    results::write(&path, &csv).map_err(|error| format!("{}: {error}", path.display()))?;
    Ok(Measured {
        targets: [targets::targets(&figures), lines::targets(&of_lines)].concat(),
        scenes: figures,
        pictures,
        lines: of_lines,
    })
}

fn effort(quick: bool) -> search::Effort {
    let (tiles, intervals) = if quick { (16, 2) } else { (64, 16) };
    search::Effort { tiles, intervals }
}

/// What doesn't depend on how a look moves; lists are parallel to the scene's orders.
#[derive(Clone)]
struct OfLook {
    seconds: Vec<f64>,
    still: Option<Vec<usize>>,
}

impl OfLook {
    fn measure(scene: &mut Subject, options: &Options) -> Result<Self, BenchError> {
        let seconds = times(scene, options)?;
        let still = match &scene.look {
            Some(look) => Some(changes_of_still(look, &scene.orders, options.threads)?),
            None => None,
        };
        Ok(Self { seconds, still })
    }
}

/// Median times to rasterise the scene's look at its full size, or the scene.
fn times(scene: &mut Subject, options: &Options) -> Result<Vec<f64>, BenchError> {
    let mut look = match &scene.look {
        Some(look) => Some(look.open(None, 1)?),
        None => None,
    };
    let mut frame = match &mut look {
        Some(look) => look.at(0)?,
        None => scene.animation.at(scene.windows[0].start)?,
    };
    let mut painter = Painter::new(1, options.threads)?;
    let mut runs = Vec::new();
    for (_, order) in &scene.orders {
        let rasterizer = Rasterizer::new(TIMED_SAMPLES, Some(options.threads));
        let mut rasterizer = rasterizer.map_err(|error| error.to_string())?;
        let drawing = painter.strokes(&mut frame, *order)?.clone();
        runs.push(move || {
            let drawn = rasterizer.draw(&drawing);
            drawn.map(drop).map_err(|error| error.to_string())
        });
    }
    let effort = Effort {
        rounds: 8,
        each: Duration::from_millis(if options.quick { 600 } else { 2000 }),
    };
    Ok(medians(&mut runs, effort, || ())?)
}

/// For each order how many pixels of a look differ in pictures of the same moment, and of later ones at which
/// nothing has moved.
fn changes_of_still(
    look: &Look,
    orders: &[NamedOrder],
    threads: usize,
) -> Result<Vec<usize>, BenchError> {
    let mut look = look.open(None, PART)?;
    let mut changes = Vec::new();
    for (_, order) in orders {
        let mut painter = Painter::new(STILL_SAMPLES, threads)?;
        let first = painter.picture(&mut look.at(0)?, *order)?;
        let mut changed = 0;
        for tick in STILL {
            let again = painter.picture(&mut look.at(tick)?, *order)?;
            let pairs = first.pixels.iter().zip(&again.pixels);
            changed += pairs.filter(|(a, b)| a != b).count();
        }
        changes.push(changed);
    }
    Ok(changes)
}

fn rows(scenes: &[SceneFigures]) -> Vec<Row> {
    let mut rows = Vec::new();
    for scene in scenes {
        for ((order, _), figures) in scene.orders.iter().zip(&scene.figures) {
            let mut add = |measure: &str, knob: u32, error: Option<f64>| {
                rows.push(Row {
                    scene: scene.name.clone(),
                    method: format!("{order}-{measure}"),
                    knob: knob as usize,
                    seconds: figures.seconds,
                    error,
                });
            };
            let continuity = &figures.continuity;
            for (i, step) in search::STEPS.iter().enumerate() {
                add("largest", TICKS / step, Some(continuity.largest[i]));
            }
            for (step, percentile) in search::STEPS.iter().zip(continuity.percentile) {
                add("percentile", TICKS / step, Some(percentile));
            }
            add("popped-worst", TICKS, Some(continuity.popped[0]));
            add("popped-mean", TICKS, Some(continuity.popped[1]));
            for (samples, error) in warp::SAMPLES.iter().zip(figures.warp) {
                add("warp", *samples, error);
            }
            if let Some(still) = figures.still {
                add("still", STILL_SAMPLES, Some(still as f64));
            }
        }
    }
    rows
}

fn comments(options: &Options) -> Vec<String> {
    let mut comments = results::machine(options.threads, &["bench", "render", "stage"]);
    let text = [
        "seconds: median time to rasterise a frame of the look, as its preset says but with 4 samples; scenes \
         without a look: 480 x 360",
        "all errors: linear light, pictures half as wide and high as the presets' (480 x 360)",
        "ORDER-largest, -percentile: the largest change of a tile of 16 x 16 pixels with hair between pictures 1/knob s \
         apart (256 samples a pixel), and the 99.9th percentile (4 samples): mean absolute difference of red, green \
         and blue, 0 to 1",
        "ORDER-popped-worst, -mean: pixels of which a channel changes by more than 0.25 in 1/knob s (64 samples), as a \
         share of the hair's",
        "ORDER-warp: mean difference of a frame's hair from the frame 1/24 s before, moved as the strands have; knob: \
         samples a pixel",
        "ORDER-still: pixels that change though nothing moves",
        "tracker-, arc-length-, votes-: marks along lines of meshes in 1/24 s, pixels of 720 lines, periods of 100 pixels: by mesh-lines' tracker, by \
         the length from a line's beginning, and by what was there in the frame before alone; no time",
    ];
    comments.extend(text.map(str::to_owned));
    comments
}

/// The figures as tables to read, in Markdown.
#[must_use]
pub fn summary(scenes: &[SceneFigures]) -> String {
    let mut text = String::from(
        "| scene | order | largest change in 1/384 s | over that in half | and of half | percentile | popped, worst | mean | warp error | 8 x 8 | ms |\n\
         |---|---|---|---|---|---|---|---|---|---|---|\n",
    );
    let figure = |value: Option<f64>, digits: usize| {
        value.map_or(String::new(), |value| format!("{value:.digits$}"))
    };
    for scene in scenes {
        for ((order, _), figures) in scene.orders.iter().zip(&scene.figures) {
            let of = &figures.continuity;
            let _ = writeln!(
                text,
                "| {} | {order} | {:.4} | {} | {} | {} | {:.2} % | {:.3} % | {} | {} | {:.1} |",
                scene.name,
                of.largest[0],
                figure(of.ratio(), 2),
                figure(of.fine_ratio(), 2),
                figure(of.percentile_ratio(), 2),
                100.0 * of.popped[0],
                100.0 * of.popped[1],
                figure(figures.warp[0], 4),
                figure(figures.warp[1], 4),
                1e3 * figures.seconds,
            );
        }
    }
    text
}

/// How far strands move in each scene, and where most changes: for whoever wants to look at it.
#[must_use]
pub fn places(scenes: &[SceneFigures]) -> String {
    let mut text = String::new();
    for scene in scenes {
        let [long, short] = scene.motion.0;
        let _ = writeln!(
            text,
            "{}: strands move up to {long:.3} px in 1/384 s, {:.3} times as far as in half the time",
            scene.name,
            long / short,
        );
        for ((order, _), figures) in scene.orders.iter().zip(&scene.figures) {
            let of = &figures.continuity;
            let Some(worst) = &of.worst else { continue };
            let [x, y] = worst.corner;
            let _ = writeln!(
                text,
                "  {order}: {:.4} in 1/768 s from {:.4} s (tick {}) in the tile at {x}, {y}; {} intervals of 1/384 s \
                 searched, {} tiles drawn with 256 samples",
                worst.change,
                seconds(worst.tick),
                worst.tick,
                of.intervals,
                of.tiles,
            );
            let (Some((tick, [x, y])), Some(pushed)) = (of.farthest, of.pushed) else {
                continue;
            };
            let _ = writeln!(
                text,
                "  {order}: {:.4} in 1/384 s from tick {tick} in the tile at {x}, {y}; its strokes merely moved as their strands, by up to \
                 {:.2} px, would have a ratio of {:.2}",
                of.largest[0], pushed.moved_px, pushed.ratio,
            );
        }
    }
    text
}
