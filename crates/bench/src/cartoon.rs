//! Suite `cartoon`: looks that paint their samples or draw lines of the whole picture, on scenes as large as those of two older systems, whose speeds are known;
//! and what wide lines cost.
//!
//! - `shin`: Shin, Haller and Mukundan, "A Stylized Cartoon Hair Renderer" (2006): 512 x 512, 3,742 particles; theirs was 3 frames a second.
//! - `ogre`: a dissertation on cartoon hair in Ogre: 1024 x 768, 100 strands of 8 points; theirs was 28 to 32 frames a second. `ogre-32` has 32 points a
//!   strand; theirs was 3 to 4, and twelve pixels of dilation took 1.39 times as long as one.
//!
//! Hair falls on a still bust, and the camera goes round it, so that nothing can be reused.

use crate::BenchError;
use crate::backends::{Backends, Card, ON_CARD_ARE_THE_LEAST};
use crate::frame;
use crate::results::{self, Row};
use crate::targets::{Found, Limit, Target};
use crate::timing::{Effort, medians};
use effects::Registry;
use glam::Vec3;
use hair_sim::Strands;
use indicatif::ProgressBar;
use render::cpu::{Evaluator, Rasterizer};
use render::{Drawing, EdgeChannel};
use stage::{Files, HairModel, HeadModel, Look, Scene, Stage};
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Samples a pixel.
const SAMPLES: u32 = 4;
/// The looks.
const LOOKS: [&str; 6] = [
    "shin-levels",
    "xtoon-depth",
    "xtoon-backlight",
    "xtoon-specular",
    "toon-blinn",
    LINED,
];
/// Of these the one with lines of the whole picture.
const LINED: &str = "ink-sobel";
/// What lines of twelve pixels may take over those of one.
const WIDE: f64 = 1.05;

/// Hair made by code.
struct Subject {
    name: &'static str,
    size: [u32; 2],
    strands: usize,
    /// Of each strand.
    points: usize,
    /// Frames a second that are to be reached.
    fps: f64,
}

const SUBJECTS: [Subject; 3] = [
    Subject {
        name: "shin",
        size: [512, 512],
        strands: 234,
        points: 16,
        fps: 60.0,
    },
    Subject {
        name: "ogre",
        size: [1024, 768],
        strands: 100,
        points: 8,
        fps: 30.0,
    },
    Subject {
        name: "ogre-32",
        size: [1024, 768],
        strands: 100,
        points: 32,
        fps: 20.0,
    },
];

/// What the user asks for.
#[derive(Clone, Debug)]
pub struct Options {
    /// The project's folder, for its presets.
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
    /// A row a scene, look and stage.
    pub rows: Vec<Row>,
    /// Whole frames, and wide lines over thin ones.
    pub targets: Vec<Target>,
}

/// Measures and writes `cartoon.csv`.
///
/// # Errors
///
/// When a preset cannot be read, nothing can be drawn, or a file cannot be written.
pub fn run(options: &Options, progress: &ProgressBar) -> Result<Measured, BenchError> {
    progress.set_length((LOOKS.len() * SUBJECTS.len() + 1) as u64);
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(options.threads)
        .build();
    let pool = pool.map_err(|error| error.to_string())?;
    let mut measured = Measured {
        rows: Vec::new(),
        targets: Vec::new(),
    };
    let registry = frame::registry()?;
    let frames = if options.quick { 8 } else { 60 };
    let mut backends = Backends::new(SAMPLES, options.card)?;
    for look in LOOKS {
        for subject in &SUBJECTS {
            let name = format!("{}: {look}", subject.name);
            progress.set_message(name.clone());
            let mut stage = subject.open(&options.root, look, &registry)?;
            let rows =
                pool.install(|| frame::look(&name, SAMPLES, &mut stage, &mut backends, frames))?;
            for method in ["cpu", "gpu"] {
                let whole = rows.iter().find(|row| row.method == method);
                measured.targets.extend(whole.map(|row| Target {
                    text: format!("{name}, {method}: frames a second"),
                    found: Some(Found::Is(1.0 / row.seconds)),
                    limit: Limit::AtLeast(subject.fps),
                }));
            }
            measured.rows.extend(rows);
            progress.inc(1);
        }
    }
    progress.set_message("wide lines");
    measured.targets.extend(wide_lines(options, &registry)?);
    progress.inc(1);
    let mut comments = vec![
        format!(
            "whole frames and their stages, {SAMPLES} samples a pixel, medians of {frames} frames"
        ),
        "method: a backend and its stage; knob: samples".to_owned(),
        ON_CARD_ARE_THE_LEAST.to_owned(),
    ];
    comments.extend(results::machine(options.threads, &["wgpu"]));
    let text = results::csv("cartoon", &comments, &measured.rows);
    results::save(&options.out, "cartoon.csv", &text)?;
    Ok(measured)
}

impl Subject {
    /// The hair on a bust, in a look of the project.
    fn open(&self, root: &Path, look: &str, registry: &Registry) -> Result<Stage, BenchError> {
        let folder = root.join("presets");
        let mut preset = frame::preset(&folder.join(format!("{look}.ron")), registry)?;
        preset.sections.scene.size = self.size;
        let files = Files {
            preset_folder: folder,
            ..Files::default()
        };
        let failed = |error: stage::StageError| error.to_string();
        let head = HeadModel::bust();
        let look = Look::new(&preset, &files).map_err(failed)?;
        let hair = HairModel::new(self.strands()?, Some(&head)).map_err(failed)?;
        let scene = Scene::of_one(hair, Some(head), look).map_err(failed)?;
        Ok(scene.into())
    }

    /// Strands that fall from the upper half of a head on all sides, in waves.
    fn strands(&self) -> Result<Strands, BenchError> {
        const GOLDEN: f32 = 2.399_963;
        const SKULL_M: f32 = 0.105;
        let mut strands = Strands::new();
        for i in 0..self.strands {
            let up = 1.0 - (i as f32 + 0.5) / self.strands as f32;
            let around = GOLDEN * i as f32;
            let out = (1.0 - up * up).max(0.0).sqrt();
            let root = SKULL_M * Vec3::new(out * around.cos(), up, out * around.sin());
            let side = Vec3::new(-around.sin(), 0.0, around.cos());
            let point = |j: usize| {
                let u = j as f32 / (self.points - 1) as f32;
                let away = Vec3::new(root.x, 0.0, root.z) * (0.5 * u.sqrt());
                let wave = side * (0.02 * (6.0 * u + around).sin() * u);
                root + away + wave - Vec3::Y * (0.3 * u * u)
            };
            let points: Vec<Vec3> = (0..self.points).map(point).collect();
            let pushed = strands.push(i as u32, &points, None);
            pushed.map_err(|error| error.to_string())?;
        }
        Ok(strands)
    }
}

/// What lines of twelve pixels take over those of one: drawings of one frame in turn.
fn wide_lines(options: &Options, registry: &Registry) -> Result<Vec<Target>, BenchError> {
    let subject = &SUBJECTS[1];
    let mut stage = subject.open(&options.root, LINED, registry)?;
    let mut frame = stage.frame().map_err(|error| error.to_string())?;
    if frame.passes.is_empty() {
        // Both drawings would be the same.
        return Err(format!("{LINED} draws no lines of the whole picture").into());
    }
    let mut runs = Vec::new();
    for width_px in [1.0, 12.0] {
        for pass in &mut frame.passes {
            assert_eq!(pass.channel, EdgeChannel::Strand);
            pass.width_px = effects::Variation::constant(width_px);
        }
        let mut drawing = Drawing::default();
        let made = Evaluator::default().evaluate(&frame, &mut drawing);
        made.map_err(|error| error.to_string())?;
        let rasterizer = Rasterizer::new(SAMPLES, Some(options.threads));
        let mut rasterizer = rasterizer.map_err(|error| error.to_string())?;
        runs.push(move || {
            let drawn = rasterizer.draw(&drawing);
            drawn.map(drop).map_err(|error| error.to_string())
        });
    }
    let effort = Effort {
        rounds: 24,
        each: Duration::from_secs(if options.quick { 2 } else { 8 }),
    };
    let seconds = medians(&mut runs, effort, || ())?;
    Ok(vec![Target {
        text: format!("{}: lines of 12 pixels over those of 1, time", subject.name),
        found: Some(Found::Is(seconds[1] / seconds[0])),
        limit: Limit::AtMost(WIDE),
    }])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_looks_open_on_all_hair() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
        let registry = frame::registry().unwrap();
        for look in LOOKS {
            for subject in &SUBJECTS {
                let mut stage = subject.open(&root, look, &registry).unwrap();
                assert_eq!(stage.strand_count(), subject.strands);
                let frame = stage.frame().unwrap();
                assert_eq!(frame.camera.size_px(), subject.size);
                let paints = |layer: &effects::Layer| layer.program.paints().is_some();
                assert!(frame.objects[0].layers.iter().any(paints), "{look}");
                assert!(look != LINED || !frame.passes.is_empty());
            }
        }
    }
}
