//! The graphics card's part of a painter.

use super::Lap;
use crate::Failure;
use crate::pass::Gathered;
use crate::say::say;
use crate::stats::{Bytes, FrameStats};
use render::gpu::{AdapterKind, GpuError, Offscreen};
use render::{Frame, Picture, SamplePlanes};

/// A graphics card that draws.
pub(super) struct Card {
    pub offscreen: Offscreen,
    planes: SamplePlanes,
}

impl Card {
    /// What draws there.
    pub fn on(offscreen: Offscreen) -> Self {
        Self {
            offscreen,
            planes: SamplePlanes::default(),
        }
    }

    /// A graphics card, or a driver that draws in software where there is none.
    pub fn any(is_quiet: bool) -> Result<Self, Failure> {
        let offscreen = Offscreen::open(AdapterKind::Any).map_err(explained)?;
        if offscreen.is_software() && !is_quiet {
            say(format_args!(
                "WARNING: there is no graphics card: {} runs its programs on the CPU, slowly, and may break them off where hair is dense, which spoils \
                 parts of the picture; --backend cpu draws it faster, and whole",
                offscreen.info().name
            ));
        }
        Ok(Self::on(offscreen))
    }

    /// A graphics card, where there is one that can draw.
    pub fn hardware(is_quiet: bool) -> Option<Self> {
        match Offscreen::open(AdapterKind::Hardware) {
            Ok(gpu) => Some(Self::on(gpu)),
            Err(GpuError::NoAdapter { .. }) => None,
            Err(error) => {
                tell(is_quiet, &error);
                None
            }
        }
    }

    /// Draws a frame, and says what it took.
    pub fn draw(
        &mut self,
        frame: &Frame,
        samples: u32,
        stats: &mut FrameStats,
        lap: &mut Lap,
    ) -> Result<Picture, GpuError> {
        let picture = self.offscreen.draw(frame, samples)?;
        self.note(stats, lap.passed());
        Ok(picture)
    }

    /// Draws the samples of a pass, and says what it took.
    pub fn draw_samples(
        &mut self,
        frame: &Frame,
        samples: u32,
        gathered: &mut Gathered,
        stats: &mut FrameStats,
        lap: &mut Lap,
    ) -> Result<(), GpuError> {
        let add = |planes: &mut SamplePlanes| gathered.add(planes);
        self.offscreen
            .draw_samples(frame, samples, &mut self.planes, add)?;
        self.note(stats, lap.passed());
        Ok(())
    }

    /// Notes what a frame took, of so many milliseconds.
    fn note(&self, stats: &mut FrameStats, whole: f64) {
        let card = self.offscreen.stats();
        let strokes = card.milliseconds.map_or(0.0, |[strokes, ..]| strokes);
        stats.backend = "gpu";
        stats.milliseconds.effects = strokes;
        stats.milliseconds.raster = whole - strokes;
        stats.milliseconds.card = card.milliseconds;
        stats.bytes = Bytes {
            buffers: card.bytes as usize,
        };
    }
}

/// Says that the CPU draws in place of the graphics card.
pub(super) fn tell(is_quiet: bool, error: &GpuError) {
    if !is_quiet {
        say(format_args!("the CPU draws: {error}"));
    }
}

pub(super) fn explained(error: GpuError) -> Failure {
    Failure::Failed(format!(
        "{error}\n--backend cpu draws without a graphics card"
    ))
}
