//! Suite `scale`: frame time by stages, and memory, for 72 to 100,000 strands of 16 points on both backends.

use crate::BenchError;
use crate::backends::{
    Backends, CPU_STAGES, Card, ON_CARD_ARE_THE_LEAST, STAGES, Times, card_stages, cpu_stages,
    rows, share_that_differs,
};
use crate::frame::CARD_WARM_UP;
use crate::results::{self, Row};
use crate::targets::{Found, Limit, Target};
use effects::preset::Reader;
use effects::{Layer, Parameters, Registry, Values, Varied, clump};
use glam::Vec3;
use indicatif::ProgressBar;
use render::{Brush, Frame, Head, Light, NO_COLOR, NO_TAPER, Object, Order, StrandInfo};
use std::ops::Range;
use std::path::PathBuf;
use std::time::Instant;
use stroke_path::{Camera, OrbitView, PathKind, Paths};

const SAMPLES: u32 = 4;
const POINTS: usize = 16;
const COUNTS: [usize; 4] = [72, 1_000, 10_000, 100_000];
/// How much more than linearly cost may grow, from a count to the next.
const GROWTH: f64 = 1.25;
const HEAD_M: f32 = 0.24;
/// Frames that are drawn before any is counted.
const WARM_UP: u32 = 1;

const LAYERS: &str = "[
    (effect: \"hair.silhouette\"),
    (effect: \"hair.base\"),
    (effect: \"hair.cel\", params: (feathers: 3)),
]";

/// What the user asks for.
#[derive(Clone, Debug)]
pub struct Options {
    /// Where the files go.
    pub out: PathBuf,
    /// Up to 10,000 strands alone.
    pub quick: bool,
    /// Threads of the CPU's backend.
    pub threads: usize,
    /// Which graphics card.
    pub card: Card,
}

/// All that was measured.
pub struct Measured {
    /// A row a count and stage.
    pub rows: Vec<Row>,
    /// Growth of cost, and frames a second.
    pub targets: Vec<Target>,
    /// Bytes of strokes on the CPU, and of all buffers on the card, for each count.
    pub bytes: Vec<(usize, [u64; 2])>,
    /// The graphics card that was measured, if any.
    pub card: Option<String>,
}

/// Measures and writes `scale.csv`.
///
/// # Errors
///
/// When nothing can be drawn, or a file cannot be written.
pub fn run(options: &Options, progress: &ProgressBar) -> Result<Measured, BenchError> {
    let counts = if options.quick {
        &COUNTS[..3]
    } else {
        &COUNTS[..]
    };
    progress.set_length(counts.len() as u64);
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(options.threads)
        .build();
    let pool = pool.map_err(|error| error.to_string())?;
    let mut backends = Backends::new(SAMPLES, options.card)?;
    let mut measured = Measured {
        rows: Vec::new(),
        targets: Vec::new(),
        bytes: Vec::new(),
        card: backends.card_name(),
    };
    for &count in counts {
        progress.set_message(format!("{count} strands"));
        let frames = if options.quick || count > 10_000 {
            3
        } else {
            9
        };
        measured
            .rows
            .extend(pool.install(|| strands(count, &mut backends, frames))?);
        measured.bytes.push((count, backends.bytes()));
        progress.inc(1);
    }
    measured.targets = targets(&measured.rows, counts);
    let mut comments = vec![
        format!(
            "strands of {POINTS} points around a head, 960 x 720, {SAMPLES} samples a pixel; every one moves"
        ),
        "method: a backend and its stage; knob: strands".to_owned(),
        ON_CARD_ARE_THE_LEAST.to_owned(),
        "error of gpu: share of pixels that differ from the CPU's by more than 2/255".to_owned(),
        format!(
            "graphics card: {}",
            measured.card.as_deref().unwrap_or("none")
        ),
    ];
    let memory = measured.bytes.iter().map(|(count, [cpu, gpu])| {
        format!(
            "{count} strands: {cpu} bytes of strokes on the CPU, {gpu} bytes of buffers on the card"
        )
    });
    comments.extend(memory);
    comments.extend(results::machine(options.threads, &["wgpu"]));
    results::save(
        &options.out,
        "scale.csv",
        &results::csv("scale", &comments, &measured.rows),
    )?;
    Ok(measured)
}

/// MadeHair that falls from a head on all sides, in waves that `time` moves. Thinner the more strands there are, as hair that is
/// combed into more clumps is.
struct MadeHair {
    particles: Vec<Vec3>,
    strands: Vec<StrandInfo>,
}

impl MadeHair {
    fn new(count: usize) -> Self {
        let size = 200.0 / (count as f32).sqrt();
        let info = |i: usize| StrandInfo {
            id: i as u32,
            mean: Vec3::ZERO,
            size,
            taper: NO_TAPER,
            colors: [NO_COLOR; 2],
            level: 0,
            lift: 0.0,
            left_out_by: 0,
        };
        Self {
            particles: vec![Vec3::ZERO; count * POINTS],
            strands: (0..count).map(info).collect(),
        }
    }

    fn move_to(&mut self, time: f32) {
        const GOLDEN: f32 = 2.399_963;
        let count = self.strands.len();
        for (i, strand) in self.strands.iter_mut().enumerate() {
            // Evenly over the upper half of a ball.
            let up = 1.0 - (i as f32 + 0.5) / count as f32;
            let around = GOLDEN * (i % 100_003) as f32;
            let out = (1.0 - up * up).max(0.0).sqrt();
            let root = 0.5 * HEAD_M * Vec3::new(out * around.cos(), up, out * around.sin());
            let side = Vec3::new(-around.sin(), 0.0, around.cos());
            let particles = &mut self.particles[i * POINTS..][..POINTS];
            for (j, particle) in particles.iter_mut().enumerate() {
                let u = j as f32 / (POINTS - 1) as f32;
                let away = Vec3::new(root.x, 0.0, root.z) * (1.2 * u.sqrt());
                let wave = side * (0.02 * (9.0 * u + 3.0 * time + around).sin() * u);
                *particle = root + away + wave - Vec3::Y * (0.35 * u * u);
            }
            strand.mean = particles.iter().sum::<Vec3>() / POINTS as f32;
        }
    }
}

fn layers() -> Result<Vec<Layer>, BenchError> {
    let mut registry = Registry::new();
    effects_builtin::register(&mut registry).map_err(|error| error.to_string())?;
    let mut reader = Reader::new("scale", LAYERS);
    let specs = reader.layers(LAYERS, &registry, &[]);
    reader.report().map_err(|errors| errors.to_string())?;
    Ok(specs.iter().map(|spec| spec.build()).collect())
}

/// What comes before drawing, on both backends.
const BEFORE: [&str; 1] = ["paths"];

/// Rows of so many frames of these strands on the CPU, then of as many on the card, where there is one: between pictures of the CPU its clock
/// would go down.
fn strands(count: usize, backends: &mut Backends, frames: u32) -> Result<Vec<Row>, BenchError> {
    let mut clip = Clip::new(count)?;
    let mut times = vec![Times::default(); BEFORE.len() + STAGES.len()];
    let (before, drawing) = times.split_at_mut(BEFORE.len());
    let (on_cpu, on_card) = drawing.split_at_mut(CPU_STAGES);
    let push = |times: &mut [Times], found: &[f64]| {
        for (times, seconds) in times.iter_mut().zip(found) {
            times.push(*seconds);
        }
    };
    for number in 0..WARM_UP + frames {
        let (frame, of_paths) = clip.next()?;
        let (_, cpu) = backends.on_cpu(&frame)?;
        if number >= WARM_UP {
            push(before, &[of_paths]);
            push(on_cpu, &cpu_stages(of_paths, cpu));
        }
    }
    let mut error = None;
    let of_card = backends.card_name().map_or(0, |_| CARD_WARM_UP + frames);
    for number in 0..of_card {
        let (frame, of_paths) = clip.next()?;
        let Some((by_card, card)) = backends.on_card(&frame)? else {
            break;
        };
        if number >= CARD_WARM_UP {
            push(on_card, &card_stages(of_paths, card));
        }
        if number + 1 == of_card {
            let (picture, _) = backends.on_cpu(&frame)?;
            error = Some(share_that_differs(&picture, &by_card));
        }
    }
    let stages = BEFORE.into_iter().chain(STAGES).zip(&times);
    Ok(rows(&format!("{count}x{POINTS}"), count, stages, error))
}

/// Frames of made hair, 1/60 s apart.
struct Clip {
    camera: Camera,
    layers: Vec<Layer>,
    clump: Varied<clump::Program>,
    hair: MadeHair,
    paths: Paths,
    layer_joints: Vec<Range<usize>>,
    number: u32,
}

impl Clip {
    fn new(count: usize) -> Result<Self, BenchError> {
        let view = OrbitView {
            target: Vec3::new(0.0, -0.05, 0.0),
            yaw_degrees: 20.0,
            pitch_degrees: 5.0,
            distance_m: 1.4,
            vertical_fov_degrees: 30.0,
        };
        let camera = Camera::orbit(view, [960, 720], 0.01).map_err(|error| error.to_string())?;
        Ok(Self {
            camera,
            layers: layers()?,
            clump: Varied::new(&Values::defaults(clump::Program::PARAMS)),
            hair: MadeHair::new(count),
            paths: Paths::new(),
            layer_joints: Vec::new(),
            number: 0,
        })
    }

    /// The next frame, and the seconds that its paths took.
    fn next(&mut self) -> Result<(Frame<'_>, f64), BenchError> {
        let time_s = self.number as f32 / 60.0;
        self.number += 1;
        self.hair.move_to(time_s);
        let start = Instant::now();
        self.paths.clear();
        for (i, particles) in self.hair.particles.chunks_exact(POINTS).enumerate() {
            let kind = PathKind::Linear { subdivision: 1 };
            let pushed = self.paths.push_strand(i, particles, kind, &self.camera);
            pushed.map_err(|error| error.to_string())?;
        }
        let of_paths = start.elapsed().as_secs_f64();
        self.layer_joints = vec![0..self.paths.len(); self.layers.len()];
        let frame = Frame {
            camera: &self.camera,
            paths: &self.paths,
            strands: &self.hair.strands,
            objects: vec![Object {
                joints: 0..self.paths.len(),
                head: Head {
                    center: Vec3::ZERO,
                    height_m: HEAD_M,
                },
                solid: None,
                surface_bias_m: 0.0,
                clump: &self.clump,
                seed: 1,
                layers: &self.layers,
                layer_joints: &self.layer_joints,
            }],
            light: Light::Direction(Vec3::new(0.48, 0.6, 0.64)),
            time_s,
            material_normals: &[],
            rest_positions: &[],
            rest_forwards: &[],
            from_ends: &[],
            path_weights: &[],
            marks: &[],
            surfaces: Vec::new(),
            mesh_layers: Vec::new(),
            decals: Vec::new(),
            background: Some([1.0; 3]),
            order: Order::default(),
            edge_depth_m: 0.02 * HEAD_M,
            brush: Brush::Circle,
            features: render::Features::NONE,
            roundness: 1.0,
            passes: Vec::new(),
        };
        Ok((frame, of_paths))
    }
}

/// Cost grows linearly or better; 10,000 strands at 30 frames a second on the CPU, 100,000 at 60 on a card.
fn targets(rows: &[Row], counts: &[usize]) -> Vec<Target> {
    let seconds = |method: &str, count: usize| {
        let is_it = |row: &&Row| row.method == method && row.knob == count;
        rows.iter().find(is_it).map(|row| row.seconds)
    };
    let mut targets = Vec::new();
    for method in ["cpu", "gpu"] {
        for pair in counts.windows(2) {
            let (Some(few), Some(many)) = (seconds(method, pair[0]), seconds(method, pair[1]))
            else {
                continue;
            };
            let growth = (many / few) / (pair[1] as f64 / pair[0] as f64);
            targets.push(Target {
                text: format!(
                    "{method}, {} strands over {}: growth over linear",
                    pair[1], pair[0]
                ),
                found: Some(Found::Is(growth)),
                limit: Limit::AtMost(GROWTH),
            });
        }
    }
    for (method, count, fps) in [("cpu", 10_000, 30.0), ("gpu", 100_000, 60.0)] {
        targets.extend(seconds(method, count).map(|seconds| Target {
            text: format!("{method}, {count} strands: milliseconds a frame"),
            found: Some(Found::Is(1e3 * seconds)),
            limit: Limit::AtMost(1e3 / fps),
        }));
    }
    targets
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(method: &str, knob: usize, seconds: f64) -> Row {
        Row {
            scene: String::new(),
            method: method.to_owned(),
            knob,
            seconds,
            error: None,
        }
    }

    #[test]
    fn growth_beyond_linear_is_a_missed_target() {
        let counts = [100, 1_000, 10_000];
        let rows = [
            row("cpu", 100, 0.001),
            row("cpu", 1_000, 0.009),
            row("cpu", 10_000, 0.2),
        ];
        let found = targets(&rows, &counts);
        let met: Vec<bool> = found.iter().map(Target::is_met).collect();
        assert_eq!(met, [true, false, false], "{found:?}");
    }

    #[test]
    fn few_strands_are_drawn_and_timed() {
        let mut backends = Backends::new(1, Card::Hardware).unwrap();
        let rows = strands(20, &mut backends, 2).unwrap();
        assert!(
            rows.iter()
                .any(|row| row.method == "cpu:raster" && row.seconds > 0.0)
        );
        assert!(backends.bytes()[0] > 0);
    }
}
