//! Suite `dynamics`: time against error of our strands, of two other ways to simulate them, and of other programs.

pub mod falls;
pub mod mass_spring;
pub mod motion;
pub mod names;
pub mod npz;
pub mod own;
pub mod peers;
pub mod reference;
pub mod rods;
pub mod shown;
pub mod statics;
pub mod stored;
pub mod targets;
pub mod xpbd;

use crate::BenchError;
use crate::plot;
use crate::results::{self, Row};
use crate::targets::Target;
use crate::timing::{Effort, shortest};
use falls::Truth;
use indicatif::ProgressBar;
use peers::Peers;
use rayon::ThreadPoolBuilder;
use std::path::{Path, PathBuf};
use std::time::Duration;
use stored::Against;

/// What the user asks for.
#[derive(Clone, Debug)]
pub struct Options {
    /// The project's folder, for its yardsticks.
    pub root: PathBuf,
    /// Where the files go.
    pub out: PathBuf,
    /// Fewer knobs, scenes and rounds: done within two minutes on two cores.
    pub quick: bool,
    /// Threads of the scenes of many strands; falling strands have one.
    pub threads: usize,
    /// The folder of reference data, if there is one.
    pub data: Option<PathBuf>,
    /// Other programs to run beside ours.
    pub peers: Option<Peers>,
}

/// All that was measured.
pub struct Measured {
    /// A row a scene, method and knob.
    pub rows: Vec<Row>,
    /// What our figures are held to.
    pub targets: Vec<Target>,
    /// Our figures against those stored.
    pub against: Against,
    /// What a reader of the numbers must know.
    pub comments: Vec<String>,
}

/// Measures and writes `dynamics.csv` and `dynamics.svg`.
///
/// # Errors
///
/// When a solver refuses a scene, a counter isn't what it must be, a peer fails, or a file cannot be read or written.
pub fn run(options: &Options, progress: &ProgressBar) -> Result<Measured, BenchError> {
    let scenes = scenes(options.quick);
    progress.set_length(scenes.len() as u64 + names::GAMMAS.len() as u64 * 3 + 2);
    let data = options.data.as_deref();
    let truths = [
        (10.0, falls::truth(10.0, 40, data)?),
        (100.0, falls::truth(100.0, 80, data)?),
    ];
    let mut comments = comments(options, &truths);

    let mut rows = Vec::new();
    let mut slopes = Vec::new();
    let alone = ThreadPoolBuilder::new().num_threads(1).build();
    let alone = alone.map_err(|error| error.to_string())?;
    for (gamma, count) in scenes {
        let scene = scene(gamma, count);
        progress.set_message(scene.clone());
        let truth = &truth_of(&truths, gamma)?.path;
        let fallen = alone.install(|| fall(&scene, gamma, count, truth, options))?;
        rows.extend(fallen);
        if count == 1 && gamma == 10.0 {
            slopes.push((scene, falls::slope_in_time(gamma)?));
        }
        progress.inc(1);
    }
    progress.set_message("cantilevers");
    rows.extend(alone.install(|| statics::rows(|| progress.inc(1)))?);
    progress.set_message("many strands");
    let effort = effort(options.quick);
    let moving = motion::measure(&options.root, options.threads, options.quick, effort)?;
    rows.extend(moving.rows);
    progress.inc(1);
    if let Some(peers) = &options.peers {
        progress.set_message("peers");
        rows.extend(peers.rows(options.quick, truth_of(&truths, peers::GAMMA)?)?);
    }
    rows.sort_by_key(|row| place_of(&row.scene));
    comments.extend(motion::particle_steps(&rows));

    let measured = Measured {
        targets: targets::targets(&rows, &slopes, &moving.fallbacks),
        against: stored::against(&rows, options.quick)?,
        rows,
        comments,
    };
    write(&measured, &options.out)?;
    Ok(measured)
}

fn truth_of(truths: &[(f64, Truth)], gamma: f64) -> Result<&Truth, BenchError> {
    let found = truths.iter().find(|truth| truth.0 == gamma);
    Ok(&found.ok_or("a fall without a reference")?.1)
}

/// Gamma and number of strands of the falls.
fn scenes(quick: bool) -> Vec<(f64, usize)> {
    let mut scenes = vec![(10.0, 1), (10.0, 72), (100.0, 1)];
    if !quick {
        scenes.push((100.0, 72));
    }
    scenes
}

fn scene(gamma: f64, count: usize) -> String {
    let many = if count == 1 { "" } else { names::MANY };
    format!("drop-{gamma}{many}")
}

/// Falls first, one strand before many: the order of the scenes in the files.
fn place_of(scene: &str) -> (usize, String) {
    let kinds = [
        "drop-",
        names::CANTILEVER,
        names::MOTION,
        names::FULL,
        names::REST,
        names::SHOWN,
    ];
    let kind = kinds.iter().position(|kind| scene.starts_with(kind));
    (kind.unwrap_or(kinds.len()), scene.to_owned())
}

fn effort(quick: bool) -> Effort {
    if quick {
        Effort {
            rounds: 4,
            each: Duration::from_millis(150),
        }
    } else {
        Effort {
            rounds: 8,
            each: Duration::from_secs(1),
        }
    }
}

fn fall(
    scene: &str,
    gamma: f64,
    count: usize,
    truth: &[glam::DVec2],
    options: &Options,
) -> Result<Vec<Row>, BenchError> {
    let mut entries = falls::entries(gamma, count, options.quick)?;
    let mut runs: Vec<_> = entries
        .iter_mut()
        .map(|entry| || entry.fall.fall())
        .collect();
    let seconds = shortest(&mut runs, effort(options.quick), || ())?;
    drop(runs);
    let rows = entries.into_iter().zip(seconds);
    Ok(rows
        .map(|(entry, seconds)| Row {
            scene: scene.to_owned(),
            error: Some(entry.fall.error(truth)),
            method: entry.method,
            knob: entry.knob,
            seconds: seconds / count as f64,
        })
        .collect())
}

fn comments(options: &Options, truths: &[(f64, Truth)]) -> Vec<String> {
    let mut comments = results::machine(options.threads, &["bench", "hair-sim", "glam"]);
    let text = [
        "seconds: the shortest of several runs, ours in turns",
        "drop-GAMMA: a strand of 0.3 m, clamped level and let go, undamped, one thread; -x72: 72 of them",
        "  seconds: for a second and strand; error: of the tip at 24 frames, root mean square over the length; inf: diverged",
        "  inkstrand-N: ours, N elements; knob: steps of 1/24 s. All others: 20 elements",
        "  mass-spring: tetrahedra of springs (Selle 2008), implicit; knob: steps of 1/24 s",
        "  xpbd-steps: XPBD rods, one sweep a step; knob: steps of 1/24 s. xpbd-sweeps: 16 steps; knob: sweeps a step",
        "  mujoco-*, pypbd-*: other programs; knob: steps of 1/24 s",
        "cantilever-GAMMA: the same strand at rest; knob: elements; seconds: for a second; error: of the tip over the length",
        "  steps of inkstrand 1/24 s, mass-spring 1/384 s, xpbd-sweeps 1/1536 s with 20 sweeps",
        "motion-STRANDSxELEMENTS: on a head that shakes; full-: with the head in their way, wind and links; knob: threads",
        "rest-: those of full- in still air on a head at rest, asleep",
        "  seconds: for a step of 1/60 s of all strands; xpbd-sweeps: 20 sweeps",
        "shown-10000x16: on a bust that walks in wind, 1500 strands simulated, which carry the others; seconds: for a step of 1/120 s",
    ];
    comments.extend(text.map(str::to_owned));
    comments.extend(
        truths
            .iter()
            .map(|(gamma, truth)| format!("reference of drop-{gamma}: {}", truth.origin)),
    );
    comments
}

fn write(measured: &Measured, out: &Path) -> Result<(), BenchError> {
    let save = |name, text: &str| results::save(out, name, text);
    save(
        "dynamics.csv",
        &results::csv("dynamics", &measured.comments, &measured.rows),
    )?;
    let errors = "error of the tip over the length";
    save(
        "dynamics.svg",
        &plot::time_against_error(&measured.rows, errors)?,
    )
}
