//! The backends, kept from frame to frame.

use super::{Problem, Times};
use render::cpu::{Evaluator, Rasterizer};
use render::gpu::{AdapterKind, GpuError, Offscreen};
use render::{Drawing, Frame, Picture};
use std::time::Instant;

/// What draws.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Backend {
    /// A graphics card where there is one, else the CPU.
    #[default]
    Auto,
    /// The CPU.
    Cpu,
    /// A graphics card, or a driver that draws in software.
    Gpu,
}

impl Backend {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Auto, Self::Cpu, Self::Gpu];

    /// As the command line calls it.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Auto => "auto",
            Self::Cpu => "cpu",
            Self::Gpu => "gpu",
        }
    }
}

/// Draws frames by the backend that is asked for.
pub(super) struct Painter {
    /// A card for the backend that it was opened for; none where there is none, or it failed.
    card: Option<(Backend, Option<Offscreen>)>,
    evaluator: Evaluator,
    rasterizer: Option<(u32, Rasterizer)>,
    drawing: Drawing,
    /// Why the CPU draws in place of a graphics card.
    problem: Option<Problem>,
}

/// A picture, and what it took.
pub(super) struct Painted {
    pub picture: Picture,
    pub effects_ms: f64,
    pub raster_ms: f64,
    pub backend: String,
}

impl Painter {
    pub fn new() -> Self {
        Self {
            card: None,
            evaluator: Evaluator::default(),
            rasterizer: None,
            drawing: Drawing::default(),
            problem: None,
        }
    }

    /// Why the CPU draws in place of the graphics card that is asked for.
    pub fn problem(&self) -> Option<Problem> {
        self.problem.clone()
    }

    /// Draws a frame. Where a graphics card fails the CPU draws, from then on until another backend is asked for; where it refuses a frame, that one.
    pub fn paint(
        &mut self,
        frame: &Frame,
        backend: Backend,
        samples: u32,
    ) -> Result<Painted, Problem> {
        if self.card.as_ref().is_none_or(|(of, _)| *of != backend) {
            self.problem = None;
            let card = self.open(backend);
            self.card = Some((backend, card));
        }
        if let Some((_, card @ Some(_))) = &mut self.card {
            let started = Instant::now();
            match card.as_mut().map(|card| (card.draw(frame, samples), card)) {
                Some((Ok(picture), card)) => {
                    self.problem = None;
                    let whole = started.elapsed().as_secs_f64() * 1e3;
                    let effects_ms = card
                        .stats()
                        .milliseconds
                        .map_or(0.0, |[strokes, ..]| strokes);
                    return Ok(Painted {
                        picture,
                        effects_ms,
                        raster_ms: whole - effects_ms,
                        backend: format!("graphics card: {}", card.info().name),
                    });
                }
                Some((Err(error), _)) => {
                    self.problem = Some(falls_back(&error));
                    // What is too large of one look may fit of the next.
                    let is_of_frame =
                        matches!(error, GpuError::TooLarge { .. } | GpuError::Limit { .. });
                    if !is_of_frame {
                        *card = None;
                    }
                }
                None => {}
            }
        }
        self.paint_on_cpu(frame, samples)
    }

    fn open(&mut self, backend: Backend) -> Option<Offscreen> {
        let opened = match backend {
            Backend::Cpu => return None,
            Backend::Auto => Offscreen::open(AdapterKind::Hardware),
            Backend::Gpu => Offscreen::open(AdapterKind::Any),
        };
        match opened {
            Ok(card) => Some(card),
            Err(GpuError::NoAdapter { .. }) if backend == Backend::Auto => None,
            Err(error) => {
                self.problem = Some(falls_back(&error));
                None
            }
        }
    }

    fn paint_on_cpu(&mut self, frame: &Frame, samples: u32) -> Result<Painted, Problem> {
        let failed = |error: &dyn std::fmt::Display| Problem::Failed(error.to_string());
        let started = Instant::now();
        self.evaluator.set_samples(samples);
        let evaluated = self.evaluator.evaluate(frame, &mut self.drawing);
        evaluated.map_err(|error| failed(&error))?;
        let effects_ms = started.elapsed().as_secs_f64() * 1e3;
        let rasterizer = match self.rasterizer.take() {
            Some((of, rasterizer)) if of == samples => rasterizer,
            _ => Rasterizer::new(samples, None).map_err(|error| failed(&error))?,
        };
        let (_, rasterizer) = self.rasterizer.insert((samples, rasterizer));
        let picture = rasterizer
            .draw(&self.drawing)
            .map_err(|error| failed(&error))?;
        Ok(Painted {
            picture,
            effects_ms,
            raster_ms: started.elapsed().as_secs_f64() * 1e3 - effects_ms,
            backend: "CPU".to_owned(),
        })
    }

    /// Lets the CPU draw in the memory of a picture that nobody needs any more.
    pub(super) fn give_back(&mut self, picture: Picture) {
        if let Some((_, rasterizer)) = &mut self.rasterizer {
            rasterizer.give_back(picture);
        }
    }
}

fn falls_back(error: &GpuError) -> Problem {
    Problem::Failed(format!("the CPU draws: {error}"))
}

impl Times {
    /// Adds what painting took.
    pub(super) fn painted(&mut self, painted: &Painted) {
        self.effects = painted.effects_ms;
        self.raster = painted.raster_ms;
    }
}
