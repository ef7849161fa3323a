//! Suite `strokes`: time against error of the exact sweep, of stamping, and of libraries that fill
//! outlines, on the same strokes.

pub mod contenders;
pub mod order;
pub mod outline;
pub mod scenes;
pub mod stamping;
pub mod targets;

use crate::BenchError;
use crate::plot;
use crate::ratios::Ratio;
use crate::results::{self, Row};
use crate::timing::{Effort, medians};
use contenders::{
    Contender, Library, OnCard, Outlines, PathsAlone, Sweep, TinySkia, Vello, in_order,
};
use indicatif::ProgressBar;
use reference::compare::{self, Difference};
use render::Order;
use render::gpu::Offscreen;
use scenes::TestDrawing;
use stamping::Stamping;
use std::cell::RefCell;
use std::path::{Path, PathBuf};
use std::rc::Rc;
use std::time::Duration;
use targets::{PATHS_ALONE, STAMPING, SWEEP, SWEEP_SHIFTED, VELLO};

/// The sweep on a graphics card, and the part of its time that the card itself took.
const CARD: &str = "gpu-sweep";
const WITHIN: &str = "-on-card";

/// Most stamps an interval, times the source's.
const MOST_STAMPS: usize = 13;

/// What the user asks for.
#[derive(Clone, Debug)]
pub struct Options {
    /// The project's folder, for its presets.
    pub root: PathBuf,
    /// Where the files go.
    pub out: PathBuf,
    /// Fewer scenes, stamps and rounds: done within two minutes on two cores.
    pub quick: bool,
    /// Threads of whatever can use several.
    pub threads: usize,
}

impl Options {
    /// Samples a side of a pixel of the reference.
    fn grid(&self) -> u32 {
        if self.quick { 10 } else { 16 }
    }
}

/// All that was measured.
pub struct Measured {
    /// A row a method, knob and scene.
    pub rows: Vec<Row>,
    /// TestDrawing, method, knob and distance from the reference of each picture.
    pub differences: Vec<(String, String, usize, Difference)>,
    /// The ratios of times.
    pub ratios: Vec<Ratio>,
    /// What a reader of the numbers must know.
    pub comments: Vec<String>,
}

/// A way to draw one scene.
struct Entry {
    method: String,
    knob: usize,
    order: Order,
    contender: Box<dyn Contender>,
}

/// Measures and writes `strokes.csv`, `strokes-errors.csv` and `strokes.svg`.
///
/// # Errors
///
/// When a preset cannot be read, nothing can be drawn, or a file cannot be written.
pub fn run(options: &Options, progress: &ProgressBar) -> Result<Measured, BenchError> {
    let mut scenes = scenes::all(&options.root)?;
    if options.quick {
        scenes.truncate(2);
    }
    let card = OnCard::card()?;
    let mut entries_of_scenes = Vec::new();
    for scene in &scenes {
        entries_of_scenes.push(entries(scene, card.as_ref(), options)?);
    }
    let effort = effort(options);
    let entries = entries_of_scenes.iter().map(Vec::len).sum::<usize>();
    progress.set_length(((effort.rounds + 1) * entries) as u64);

    let mut measured = Measured {
        rows: Vec::new(),
        differences: Vec::new(),
        ratios: Vec::new(),
        comments: comments(&scenes, options),
    };
    for (scene, mut entries) in scenes.iter().zip(entries_of_scenes) {
        progress.set_message(format!("{}: times", scene.name));
        let times = times(scene, &mut entries, effort, progress)?;
        progress.set_message(format!("{}: errors", scene.name));
        let differences = differences(scene, &entries, options.grid(), progress)?;
        for ((entry, seconds), difference) in entries.iter().zip(times).zip(differences) {
            measured.rows.push(Row {
                scene: scene.name.to_owned(),
                method: entry.method.clone(),
                knob: entry.knob,
                seconds,
                error: difference.map(|difference| difference.mean),
            });
            if let Some(seconds) = entry.contender.seconds_within() {
                measured.rows.push(Row {
                    scene: scene.name.to_owned(),
                    method: format!("{}{WITHIN}", entry.method),
                    knob: entry.knob,
                    seconds,
                    error: None,
                });
            }
            measured.differences.extend(difference.map(|difference| {
                let method = entry.method.clone();
                (scene.name.to_owned(), method, entry.knob, difference)
            }));
        }
    }
    let stamps: Vec<_> = scenes.iter().map(|s| (s.name, s.source_stamps)).collect();
    measured.ratios = targets::ratios(&measured.rows, &stamps);
    write(&measured, &options.out)?;
    Ok(measured)
}

/// Everything that draws a scene.
fn entries(
    scene: &TestDrawing,
    card: Option<&Rc<RefCell<Offscreen>>>,
    options: &Options,
) -> Result<Vec<Entry>, BenchError> {
    let threads = options.threads;
    let mut entries = Vec::new();
    let mut add = |method: String, knob, order, contender: Box<dyn Contender>| {
        entries.push(Entry {
            method,
            knob,
            order,
            contender,
        });
    };
    for samples in [1, 2, 4, 8, 16] {
        for (method, order) in [(SWEEP, Order::Rounded), (SWEEP_SHIFTED, Order::Shifted)] {
            let sweep = Box::new(Sweep::new(samples, threads)?);
            add(method.to_owned(), samples as usize, order, sweep);
        }
    }
    for samples in [1, 4, 16] {
        if let Some(card) = card {
            let (knob, order) = (samples as usize, Order::Rounded);
            add(
                CARD.to_owned(),
                knob,
                order,
                Box::new(OnCard::new(card, samples)),
            );
        }
    }
    for &(samples, stamps) in stamps(options.quick) {
        let sensible = |stamps: &&usize| **stamps <= MOST_STAMPS * scene.source_stamps;
        for &stamps in stamps.iter().filter(sensible) {
            let stamping = Box::new(Stamping::new(stamps, samples, threads)?);
            let method = format!("{STAMPING}{samples}");
            add(method, stamps, Order::Shifted, stamping);
        }
    }
    let [width, height] = scene.drawing.size;
    let small = |side| u16::try_from(side).map_err(|_| format!("{side} pixels are too many"));
    let size = [small(width)?, small(height)?];
    let order = Order::Rounded;
    for outlines in [Outlines::Segments, Outlines::Strokes] {
        if outlines == Outlines::Strokes && !scene.is_apart {
            continue;
        }
        let name = match outlines {
            Outlines::Segments => "segments",
            Outlines::Strokes => "strokes",
        };
        // With a core for the thread that records and without; at least on two cores also alone.
        let mut workers = vec![0, threads - 1, threads];
        workers.dedup();
        for workers in workers {
            let vello = Vello::new(size, outlines, u16::try_from(workers).unwrap_or(u16::MAX));
            add(format!("{VELLO}{name}"), workers, order, Box::new(vello));
        }
        let tiny_skia = TinySkia::new(size, outlines)?;
        add(format!("tiny-skia-{name}"), 1, order, Box::new(tiny_skia));
        for (library, prefix) in [(Library::Vello, VELLO), (Library::TinySkia, "tiny-skia-")] {
            let paths = Box::new(PathsAlone::new(library, outlines));
            add(format!("{prefix}{name}{PATHS_ALONE}"), 1, order, paths);
        }
    }
    Ok(entries)
}

/// Samples a pixel, and stamps an interval with them.
fn stamps(quick: bool) -> &'static [(u32, &'static [usize])] {
    if quick {
        &[(4, &[2, 10, 32]), (16, &[10, 64])]
    } else {
        &[
            (4, &[1, 2, 4, 10, 16, 32, 64, 128]),
            (8, &[10, 16, 32, 64, 128]),
            (16, &[10, 16, 32, 64, 128]),
        ]
    }
}

fn effort(options: &Options) -> Effort {
    if options.quick {
        Effort {
            rounds: 5,
            each: Duration::from_millis(300),
        }
    } else {
        Effort {
            rounds: 8,
            each: Duration::from_secs(1),
        }
    }
}

fn times(
    scene: &TestDrawing,
    entries: &mut [Entry],
    effort: Effort,
    progress: &ProgressBar,
) -> Result<Vec<f64>, BenchError> {
    let rounded = in_order(&scene.drawing, Order::Rounded);
    let shifted = in_order(&scene.drawing, Order::Shifted);
    let mut runs: Vec<_> = entries
        .iter_mut()
        .map(|entry| {
            let drawing = if entry.order == Order::Shifted {
                &shifted
            } else {
                &rounded
            };
            let contender = &mut entry.contender;
            move || contender.draw(drawing)
        })
        .collect();
    medians(&mut runs, effort, || progress.inc(1))
}

/// How far the last picture of each is from the reference in its order.
fn differences(
    scene: &TestDrawing,
    entries: &[Entry],
    grid: u32,
    progress: &ProgressBar,
) -> Result<Vec<Option<Difference>>, BenchError> {
    let reference = |order| reference::picture(&in_order(&scene.drawing, order), grid);
    let rounded = reference(Order::Rounded);
    let shifted = reference(Order::Shifted);
    // Both orders show strokes at the same pixels but where strokes are clipped to clumps.
    let masks = [compare::mask(&rounded), compare::mask(&shifted)];
    let mut differences = Vec::new();
    for entry in entries {
        let (reference, mask) = if entry.order == Order::Shifted {
            (&shifted, &masks[1])
        } else {
            (&rounded, &masks[0])
        };
        let difference = match entry.contender.picture() {
            Some(picture) => {
                let error = compare::error(&picture, reference, mask);
                Some(error.map_err(|error| format!("{}: {error}", entry.method))?)
            }
            None => None,
        };
        differences.push(difference);
        progress.inc(1);
    }
    Ok(differences)
}

fn comments(scenes: &[TestDrawing], options: &Options) -> Vec<String> {
    let packages = ["bench", "vello_cpu", "tiny-skia"];
    let mut comments = results::machine(options.threads, &packages);
    let grid = options.grid();
    comments.push(format!(
        "error: mean over the strokes' pixels (and 2 pixels around) of the largest difference of a \
         channel, linear and premultiplied, 0 to 1, from the f64 reference of {grid} x {grid} samples"
    ));
    let text = [
        "seconds: median time from the drawing to its pixels, in memory",
        "sweep, sweep-shifted: exact, in the order by strands and in the source's; knob: samples a \
         pixel",
        "stamping-4, -8, -16: the source's method in the source's order with that many samples a \
         pixel; knob: stamps between two joints",
        "gpu-sweep: the same on a graphics card, from memory to memory; gpu-sweep-on-card: what of it \
         the card took in its last picture, by its own clock, which goes up and down",
        "vello-*: knob: worker threads beside the caller's (0: that alone); tiny-skia-*: one thread",
        "*-segments: an outline each segment, *-strokes: each stroke; filled in painter's order, far \
         strands first, in linear colours",
        "of painter's order the order itself is an error where strands cross (all scenes but curtain)",
        "*-paths: the share of the method that sorts strands and builds paths; no picture, no error",
    ];
    comments.extend(text.map(str::to_owned));
    comments.extend(scenes.iter().map(|scene| {
        let [all, inked] = scene.segments();
        format!(
            "scene {}: {} strands, {all} segments, {inked} of them with ink; the source's stamps an \
             interval: {}",
            scene.name,
            scene.drawing.runs.len(),
            scene.source_stamps
        )
    }));
    comments
}

fn write(measured: &Measured, out: &Path) -> Result<(), BenchError> {
    let save = |name, text: &str| results::save(out, name, text);
    let lines = measured.differences.iter().map(|row| {
        let (scene, method, knob, of) = row;
        format!(
            "strokes,{scene},{method},{knob},{:.3e},{:.3e},{:.5}",
            of.mean, of.percentile_99, of.ink_ratio
        )
    });
    let columns = "suite,scene,method,knob,mean,percentile_99,ink_ratio";
    save(
        "strokes.csv",
        &results::csv("strokes", &measured.comments, &measured.rows),
    )?;
    save(
        "strokes-errors.csv",
        &results::table(&measured.comments, columns, lines),
    )?;
    let errors = "mean error (linear light, 0 to 1)";
    save(
        "strokes.svg",
        &plot::time_against_error(&measured.rows, errors)?,
    )
}

/// What was set as a target and is not measured here.
pub const NOT_MEASURED: &str = "Not measured: stamping on a graphics card (not built); without a card, sweeping there.\n\
    Whole frames of the looks of table 6.1 are suite `frame`'s.";
