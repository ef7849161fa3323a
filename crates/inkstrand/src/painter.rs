//! What turns a scene into pictures, kept from frame to frame: the CPU, or a graphics card.

use crate::Failure;
use crate::cli::Backend;
use crate::stats::{Bytes, FrameStats, StrandCounts, buffer_bytes, drawing_counts, frame_counts};
use render::cpu::{Evaluator, Rasterizer};
use render::gpu::{AdapterKind, GpuError, Offscreen};
use render::{Drawing, Picture};
use stage::Stage;
use std::time::Instant;

/// Draws scenes.
pub(crate) struct Painter {
    samples: u32,
    gpu: Option<Offscreen>,
    /// Whether the CPU draws on where the graphics card fails.
    may_fall_back: bool,
    cpu: Option<Cpu>,
    is_quiet: bool,
}

/// The CPU's part.
struct Cpu {
    evaluator: Evaluator,
    rasterizer: Rasterizer,
    drawing: Drawing,
}

impl Painter {
    /// A painter for that backend. `auto` takes a graphics card where there is one that can draw, and goes on with the
    /// CPU where it fails, in the middle of a sequence too.
    pub(crate) fn new(backend: Backend, samples: u32, is_quiet: bool) -> Result<Self, Failure> {
        let gpu = match backend {
            Backend::Cpu => None,
            Backend::Gpu => Some(Offscreen::open(AdapterKind::Any).map_err(explained)?),
            Backend::Auto => match Offscreen::open(AdapterKind::Hardware) {
                Ok(gpu) => Some(gpu),
                Err(GpuError::NoAdapter { .. }) => None,
                Err(error) => {
                    tell(is_quiet, &error);
                    None
                }
            },
        };
        let mut painter = Self {
            samples,
            gpu,
            may_fall_back: backend == Backend::Auto,
            cpu: None,
            is_quiet,
        };
        if painter.gpu.is_none() {
            painter.cpu()?;
        }
        Ok(painter)
    }

    /// Draws the scene at `time`, in seconds.
    pub(crate) fn paint(
        &mut self,
        stage: &mut Stage,
        frame: u32,
        time: f32,
    ) -> Result<(Picture, FrameStats), Failure> {
        let started = Instant::now();
        let mut lap = Lap(started);
        let mut stats = FrameStats {
            frame,
            samples: self.samples,
            ..FrameStats::default()
        };
        stage.advance_to(time)?;
        stats.milliseconds.simulate = lap.passed();
        let picture = self.draw(stage, &mut stats, &mut lap)?;
        stats.milliseconds.total = started.elapsed().as_secs_f64() * 1e3;
        stats.size = [picture.width, picture.height];
        stats.strands = StrandCounts {
            total: stage.strand_count(),
            culled: stage.culled(),
            asleep: stage.simulated().asleep,
        };
        Ok((picture, stats))
    }

    fn draw(
        &mut self,
        stage: &mut Stage,
        stats: &mut FrameStats,
        lap: &mut Lap,
    ) -> Result<Picture, Failure> {
        let frame = stage.frame()?;
        stats.milliseconds.paths = lap.passed();
        if let Some(gpu) = &mut self.gpu {
            match gpu.draw(&frame, self.samples) {
                Ok(picture) => {
                    let whole = lap.passed();
                    let card = gpu.stats();
                    let strokes = card.milliseconds.map_or(0.0, |[strokes, ..]| strokes);
                    stats.backend = "gpu";
                    stats.milliseconds.effects = strokes;
                    stats.milliseconds.raster = whole - strokes;
                    stats.milliseconds.card = card.milliseconds;
                    stats.layers = frame_counts(&frame);
                    stats.bytes = Bytes {
                        buffers: card.bytes as usize,
                    };
                    return Ok(picture);
                }
                Err(error) if self.may_fall_back => {
                    tell(self.is_quiet, &error);
                    self.gpu = None;
                }
                Err(error) => return Err(explained(error)),
            }
        }
        let cpu = self.cpu()?;
        cpu.evaluator.evaluate(&frame, &mut cpu.drawing);
        stats.milliseconds.effects = lap.passed();
        let picture = cpu.rasterizer.draw(&cpu.drawing)?;
        stats.milliseconds.raster = lap.passed();
        stats.backend = "cpu";
        stats.layers = drawing_counts(&cpu.drawing);
        stats.bytes = Bytes {
            buffers: buffer_bytes(&cpu.drawing),
        };
        Ok(picture)
    }

    fn cpu(&mut self) -> Result<&mut Cpu, Failure> {
        let cpu = match self.cpu.take() {
            Some(cpu) => cpu,
            None => Cpu {
                evaluator: Evaluator::default(),
                rasterizer: Rasterizer::new(self.samples, None)?,
                drawing: Drawing::default(),
            },
        };
        Ok(self.cpu.insert(cpu))
    }
}

/// A stop watch.
struct Lap(Instant);

impl Lap {
    /// Milliseconds since it was last asked.
    fn passed(&mut self) -> f64 {
        let now = Instant::now();
        let passed = now.duration_since(self.0);
        self.0 = now;
        passed.as_secs_f64() * 1e3
    }
}

/// Says that the CPU draws in place of the graphics card.
fn tell(is_quiet: bool, error: &GpuError) {
    if !is_quiet {
        eprintln!("the CPU draws: {error}");
    }
}

fn explained(error: GpuError) -> Failure {
    Failure::Failed(format!(
        "{error}\n--backend cpu draws without a graphics card"
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::builtin_effects;
    use render::gpu::Gpu;
    use stage::{Files, Preset};

    const PRESET: &str = "(
        version: 1,
        hair: (file: \"../../presets/styles/bob.style.ron\"), head: (shape: bust),
        scene: (size: (24, 18), samples: 1),
        layers: [(effect: \"hair.base\")],
    )";

    fn stage() -> Stage {
        let registry = builtin_effects();
        let preset = Preset::parse("test.ron", PRESET, &registry).unwrap();
        let files = Files {
            preset_folder: env!("CARGO_MANIFEST_DIR").into(),
            ..Files::default()
        };
        Stage::new(&preset, &files).unwrap()
    }

    /// Nothing where there is no driver.
    fn on_card(may_fall_back: bool) -> Option<(Painter, impl FnOnce())> {
        let gpu = match Gpu::open(AdapterKind::Any) {
            Ok(gpu) => gpu,
            Err(GpuError::NoAdapter { .. })
                if std::env::var_os("CI").is_none_or(|ci| ci != "true") =>
            {
                eprintln!("SKIPPED: no driver for a graphics card");
                return None;
            }
            Err(error) => panic!("{error}"),
        };
        let device = gpu.device.clone();
        let painter = Painter {
            samples: 1,
            gpu: Some(Offscreen::on(gpu).unwrap()),
            may_fall_back,
            cpu: None,
            is_quiet: true,
        };
        Some((painter, move || device.destroy()))
    }

    #[test]
    fn auto_goes_on_with_the_cpu_in_the_middle_of_a_sequence() {
        let Some((mut painter, lose)) = on_card(true) else {
            return;
        };
        let mut stage = stage();
        let (first, stats) = painter.paint(&mut stage, 0, 0.0).ok().unwrap();
        assert_eq!(stats.backend, "gpu");
        lose();
        for frame in 1..3 {
            let (next, stats) = painter.paint(&mut stage, frame, 0.0).ok().unwrap();
            assert_eq!((stats.backend, stats.frame), ("cpu", frame));
            let is_far =
                |(a, b): (&[f32; 4], &[f32; 4])| (0..4).any(|i| (a[i] - b[i]).abs() > 0.01);
            let far = first
                .pixels
                .iter()
                .zip(&next.pixels)
                .filter(|pair| is_far(*pair));
            assert!(far.count() <= 1);
        }
    }

    #[test]
    fn gpu_alone_fails_and_says_what_to_do() {
        let Some((mut painter, lose)) = on_card(false) else {
            return;
        };
        lose();
        let Err(Failure::Failed(message)) = painter.paint(&mut stage(), 0, 0.0) else {
            panic!("a lost card draws nothing");
        };
        assert!(
            message.contains("was lost") && message.contains("--backend cpu"),
            "{message}"
        );
    }
}
