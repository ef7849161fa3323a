//! What turns a scene into pictures, kept from frame to frame: the CPU, or a graphics card.

#[cfg(feature = "gpu")]
mod card;
#[cfg(not(feature = "gpu"))]
#[path = "painter/no_card.rs"]
mod card;

use crate::Failure;
use crate::cli::Backend;
use crate::pass::{Gathered, Pass, PassPicture, Scale};
use crate::stats::{Bytes, FrameStats, StrandCounts, buffer_bytes, layer_counts};
use card::Card;
use glam::Vec3;
use render::cpu::{Evaluator, Rasterizer};
use render::{Drawing, Frame, Picture, SamplePlanes};
use stage::Stage;
use std::sync::Arc;
use std::time::Instant;

/// Draws a scene in motion.
pub(crate) struct Painter {
    samples: u32,
    card: Option<Card>,
    /// Whether the CPU draws on where the graphics card fails.
    may_fall_back: bool,
    cpu: Option<Cpu>,
    is_quiet: bool,
    /// Whether what each layer draws is counted.
    counts_layers: bool,
    /// The last picture, and what drew it.
    last: Option<Drawn>,
    /// Pictures before it, whose memory the next one may have when nobody holds them any more.
    shown: Vec<Arc<Picture>>,
}

struct Drawn {
    picture: Arc<Picture>,
    backend: &'static str,
    bytes: Bytes,
}

/// The CPU's part.
struct Cpu {
    evaluator: Evaluator,
    rasterizer: Rasterizer,
    drawing: Drawing,
    planes: SamplePlanes,
}

impl Painter {
    /// A painter for that backend. `auto` takes a graphics card where there is one that can draw, and goes on with the
    /// CPU where it fails, in the middle of a sequence too. It counts nothing.
    pub(crate) fn new(backend: Backend, samples: u32, is_quiet: bool) -> Result<Self, Failure> {
        let card = match backend {
            Backend::Cpu => None,
            Backend::Gpu => Some(Card::any(is_quiet)?),
            Backend::Auto => Card::hardware(is_quiet),
        };
        let mut painter = Self {
            samples,
            card,
            may_fall_back: backend == Backend::Auto,
            cpu: None,
            is_quiet,
            counts_layers: false,
            last: None,
            shown: Vec::new(),
        };
        if painter.card.is_none() {
            painter.cpu()?;
        }
        Ok(painter)
    }

    /// From now on what each layer draws is counted.
    pub(crate) fn count_layers(&mut self) {
        self.counts_layers = true;
    }

    /// Draws the scene at `time`, in seconds. Where nothing changed since the last picture, which must have been of the same scene, it
    /// is that one.
    pub(crate) fn paint(
        &mut self,
        stage: &mut Stage,
        frame: u32,
        time: f32,
    ) -> Result<(Arc<Picture>, FrameStats), Failure> {
        let started = Instant::now();
        let mut lap = Lap(started);
        let mut stats = FrameStats {
            frame,
            samples: self.samples,
            ..FrameStats::default()
        };
        stage.advance_to(time)?;
        stats.milliseconds.simulate = lap.passed();
        let drawn = match self.last.take() {
            Some(last) if stage.is_as_before()? => {
                stats.reused = true;
                last
            }
            last => {
                self.reuse(last);
                let picture = self.draw(stage, &mut stats, &mut lap)?;
                Drawn {
                    picture: Arc::new(picture),
                    backend: stats.backend,
                    bytes: stats.bytes,
                }
            }
        };
        (stats.backend, stats.bytes) = (drawn.backend, drawn.bytes);
        let picture = drawn.picture.clone();
        self.last = Some(drawn);
        stats.milliseconds.total = started.elapsed().as_secs_f64() * 1e3;
        stats.size = [picture.width, picture.height];
        stats.strands = StrandCounts {
            total: stage.strand_count(),
            culled: stage.culled(),
            asleep: stage.simulated().asleep,
        };
        Ok((picture, stats))
    }

    /// Draws a pass of the scene at `time`, in seconds, seen from so many head heights.
    pub(crate) fn paint_pass(
        &mut self,
        stage: &mut Stage,
        number: u32,
        time: f32,
        pass: Pass,
        distance: f32,
    ) -> Result<(PassPicture, FrameStats), Failure> {
        let started = Instant::now();
        let mut lap = Lap(started);
        let mut stats = FrameStats {
            frame: number,
            samples: self.samples,
            ..FrameStats::default()
        };
        stage.advance_to(time)?;
        stats.milliseconds.simulate = lap.passed();
        let head = stage.head();
        let mut frame = stage.frame()?;
        frame.features = pass.features();
        stats.milliseconds.paths = lap.passed();
        let axis = |x, y, z| frame.camera.world_from_view_direction(Vec3::new(x, y, z));
        let scale = Scale {
            head_m: head.height_m,
            distance_m: distance * head.height_m,
            axes: [
                axis(1.0, 0.0, 0.0),
                axis(0.0, 1.0, 0.0),
                axis(0.0, 0.0, -1.0),
            ],
        };
        let gathered = self.gather(&frame, pass, scale, &mut stats, &mut lap)?;
        if self.counts_layers {
            stats.layers = layer_counts(&frame);
        }
        stats.size = frame.camera.size_px();
        stats.milliseconds.total = started.elapsed().as_secs_f64() * 1e3;
        stats.strands = StrandCounts {
            total: stage.strand_count(),
            culled: stage.culled(),
            asleep: stage.simulated().asleep,
        };
        Ok((gathered.finish(), stats))
    }

    /// Draws the samples of a pass.
    fn gather(
        &mut self,
        frame: &Frame,
        pass: Pass,
        scale: Scale,
        stats: &mut FrameStats,
        lap: &mut Lap,
    ) -> Result<Gathered, Failure> {
        let samples = self.samples;
        let begin = || Gathered::new(pass, scale, frame.camera.size_px(), samples);
        if let Some(card) = &mut self.card {
            let mut gathered = begin();
            match card.draw_samples(frame, samples, &mut gathered, stats, lap) {
                Ok(()) => return Ok(gathered),
                Err(error) if self.may_fall_back => {
                    card::tell(self.is_quiet, &error);
                    self.card = None;
                }
                Err(error) => return Err(card::explained(error)),
            }
        }
        let mut gathered = begin();
        let Cpu {
            evaluator,
            rasterizer,
            drawing,
            planes,
        } = self.cpu()?;
        evaluator.evaluate(frame, drawing)?;
        stats.milliseconds.effects = lap.passed();
        rasterizer.draw_samples(drawing, planes, |planes| gathered.add(planes))?;
        stats.milliseconds.raster = lap.passed();
        stats.backend = "cpu";
        stats.bytes = Bytes {
            buffers: buffer_bytes(drawing),
        };
        Ok(gathered)
    }

    fn draw(
        &mut self,
        stage: &mut Stage,
        stats: &mut FrameStats,
        lap: &mut Lap,
    ) -> Result<Picture, Failure> {
        let frame = stage.frame()?;
        stats.milliseconds.paths = lap.passed();
        let picture = self.draw_frame(&frame, stats, lap)?;
        if self.counts_layers {
            stats.layers = layer_counts(&frame);
        }
        Ok(picture)
    }

    fn draw_frame(
        &mut self,
        frame: &Frame,
        stats: &mut FrameStats,
        lap: &mut Lap,
    ) -> Result<Picture, Failure> {
        if let Some(card) = &mut self.card {
            match card.draw(frame, self.samples, stats, lap) {
                Ok(picture) => return Ok(picture),
                Err(error) if self.may_fall_back => {
                    card::tell(self.is_quiet, &error);
                    self.card = None;
                }
                Err(error) => return Err(card::explained(error)),
            }
        }
        let cpu = self.cpu()?;
        cpu.evaluator.evaluate(frame, &mut cpu.drawing)?;
        stats.milliseconds.effects = lap.passed();
        let picture = cpu.rasterizer.draw(&cpu.drawing)?;
        stats.milliseconds.raster = lap.passed();
        stats.backend = "cpu";
        stats.bytes = Bytes {
            buffers: buffer_bytes(&cpu.drawing),
        };
        Ok(picture)
    }

    /// Lets the CPU draw in the memory of a picture that is written already.
    fn reuse(&mut self, last: Option<Drawn>) {
        let Some(cpu) = &mut self.cpu else { return };
        // The last one may be on its way to its file; the one before it is there.
        self.shown.extend(last.map(|last| last.picture));
        let is_free = |picture: &Arc<Picture>| Arc::strong_count(picture) == 1;
        if let Some(free) = self.shown.iter().position(is_free)
            && let Some(picture) = Arc::into_inner(self.shown.swap_remove(free))
        {
            cpu.rasterizer.give_back(picture);
        }
        // Whoever still holds one keeps it.
        if self.shown.len() > 1 {
            self.shown.remove(0);
        }
    }

    fn cpu(&mut self) -> Result<&mut Cpu, Failure> {
        let cpu = match self.cpu.take() {
            Some(cpu) => cpu,
            None => Cpu {
                evaluator: Evaluator::of_samples(self.samples),
                rasterizer: Rasterizer::new(self.samples, None)?,
                drawing: Drawing::default(),
                planes: SamplePlanes::default(),
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

#[cfg(all(test, feature = "gpu"))]
mod tests;
