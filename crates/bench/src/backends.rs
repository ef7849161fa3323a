//! Both backends under one clock, for the suites `frame` and `scale`.

use crate::BenchError;
use crate::results::Row;
use render::cpu::{Evaluator, Rasterizer};
use render::gpu::{AdapterKind, GpuError, Offscreen};
use render::{Drawing, Frame, Picture};
use std::time::Instant;

/// Which graphics card to measure.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Card {
    /// A real one, where there is one.
    Hardware,
    /// A real one, or a driver that draws in software: slow, and no measure of anything but itself.
    Any,
}

/// The CPU's rasteriser, which draws on the threads of the pool that it is called in, and a graphics card, kept from frame to frame.
pub struct Backends {
    samples: u32,
    evaluator: Evaluator,
    rasterizer: Rasterizer,
    drawing: Drawing,
    card: Option<Offscreen>,
}

/// What a frame took on the CPU, in seconds.
#[derive(Clone, Copy, Debug)]
pub struct CpuTimes {
    /// Joints to strokes.
    pub effects: f64,
    /// Strokes to a picture.
    pub raster: f64,
}

/// What a frame took with a graphics card, in seconds.
#[derive(Clone, Copy, Debug)]
pub struct CardTimes {
    /// From the frame to the finished picture in the CPU's memory.
    pub whole: f64,
    /// On the card, by its own clock: strokes, sorting into tiles, tiles. Of cards that keep time.
    pub stages: Option<[f64; 3]>,
}

impl Backends {
    /// Both backends, with that many samples a pixel; the card only where there is one.
    ///
    /// # Errors
    ///
    /// When a card is there and can't be used, or there is no such number of samples.
    pub fn new(samples: u32, card: Card) -> Result<Self, BenchError> {
        let kind = match card {
            Card::Hardware => AdapterKind::Hardware,
            Card::Any => AdapterKind::Any,
        };
        let card = match Offscreen::open(kind) {
            Ok(card) => Some(card),
            Err(GpuError::NoAdapter { .. }) => None,
            Err(error) => return Err(error.to_string().into()),
        };
        Ok(Self {
            card,
            ..Self::without_card(samples)?
        })
    }

    /// The CPU alone.
    ///
    /// # Errors
    ///
    /// When there is no such number of samples.
    pub fn without_card(samples: u32) -> Result<Self, BenchError> {
        Ok(Self {
            samples,
            evaluator: Evaluator::of_samples(samples),
            rasterizer: Rasterizer::new(samples, None).map_err(|e| e.to_string())?,
            drawing: Drawing::default(),
            card: None,
        })
    }

    /// The card's name, and its driver's.
    #[must_use]
    pub fn card_name(&self) -> Option<String> {
        let info = self.card.as_ref()?.info();
        Some(format!(
            "{}, {} {}",
            info.name, info.driver, info.driver_info
        ))
    }

    /// Draws on the CPU.
    ///
    /// # Errors
    ///
    /// When the frame can't be drawn.
    pub fn on_cpu(&mut self, frame: &Frame) -> Result<(Picture, CpuTimes), BenchError> {
        let start = Instant::now();
        self.evaluator
            .evaluate(frame, &mut self.drawing)
            .map_err(|e| e.to_string())?;
        let effects = start.elapsed().as_secs_f64();
        let picture = self
            .rasterizer
            .draw(&self.drawing)
            .map_err(|e| e.to_string())?;
        let raster = start.elapsed().as_secs_f64() - effects;
        Ok((picture, CpuTimes { effects, raster }))
    }

    /// Takes a picture of the CPU's back: the next one is drawn in its memory, as those of a program that shows them would be.
    pub fn give_back(&mut self, picture: Picture) {
        self.rasterizer.give_back(picture);
    }

    /// Draws on the card, where there is one.
    ///
    /// # Errors
    ///
    /// When the frame can't be drawn.
    pub fn on_card(&mut self, frame: &Frame) -> Result<Option<(Picture, CardTimes)>, BenchError> {
        let Some(card) = &mut self.card else {
            return Ok(None);
        };
        let start = Instant::now();
        let picture = card
            .draw(frame, self.samples)
            .map_err(|error| error.to_string())?;
        let whole = start.elapsed().as_secs_f64();
        let stages = card
            .stats()
            .milliseconds
            .map(|stages| stages.map(|ms| 1e-3 * ms));
        Ok(Some((picture, CardTimes { whole, stages })))
    }

    /// Bytes of the last frame: strokes on the CPU, and all buffers on the card.
    #[must_use]
    pub fn bytes(&self) -> [u64; 2] {
        let layers = self.drawing.layers.iter();
        let strokes: usize = layers
            .map(|l| size_of_val(l.discs.as_slice()) + size_of_val(l.colors.as_slice()))
            .sum();
        let card = self.card.as_ref().map_or(0, |card| card.stats().bytes);
        [strokes as u64, card]
    }
}

/// The share of pixels of which a channel differs by more than 2/255 of the full range, in linear light.
#[must_use]
pub fn share_that_differs(a: &Picture, b: &Picture) -> f64 {
    let differs =
        |(a, b): (&[f32; 4], &[f32; 4])| (0..4).any(|i| (a[i] - b[i]).abs() > 2.0 / 255.0);
    let count = a
        .pixels
        .iter()
        .zip(&b.pixels)
        .filter(|pair| differs(*pair))
        .count();
    count as f64 / a.pixels.len().max(1) as f64
}

/// The stages of a frame on both backends, in the order in which a frame's times are given; a card's own only where there
/// is one that keeps time.
pub const STAGES: [&str; 8] = [
    "cpu",
    "cpu:effects",
    "cpu:raster",
    "gpu",
    "gpu:strokes",
    "gpu:bins",
    "gpu:tiles",
    "gpu:upload",
];

/// How many of [`STAGES`] are the CPU's.
pub const CPU_STAGES: usize = 3;

/// A frame's times on the CPU, the first of [`STAGES`]. `before` is what comes before drawing, on both backends.
#[must_use]
pub fn cpu_stages(before: f64, cpu: CpuTimes) -> [f64; CPU_STAGES] {
    [before + cpu.effects + cpu.raster, cpu.effects, cpu.raster]
}

/// A frame's times with a card, what follows in [`STAGES`].
#[must_use]
pub fn card_stages(before: f64, card: CardTimes) -> Vec<f64> {
    let mut times = vec![before + card.whole];
    if let Some(stages) = card.stages {
        times.extend(stages);
        times.push(card.whole - stages.iter().sum::<f64>());
    }
    times
}

/// Of [`STAGES`] those that a card times by its own clock.
const ON_CARD: [&str; 3] = ["gpu:strokes", "gpu:bins", "gpu:tiles"];

/// What a reader of [`rows`] must know of them.
pub const ON_CARD_ARE_THE_LEAST: &str = "gpu:strokes, gpu:bins and gpu:tiles: by the card's own clock, which goes up and \
    down: the least of all frames";

/// A row for the median of each stage that has times, of what a card times by itself for the least, as its clock goes up and down; `error` is that of
/// the card's picture.
#[must_use]
pub fn rows<'a>(
    scene: &str,
    knob: usize,
    stages: impl IntoIterator<Item = (&'a str, &'a Times)>,
    error: Option<f64>,
) -> Vec<Row> {
    let row = |(stage, times): (&str, &Times)| {
        let seconds = match ON_CARD.contains(&stage) {
            true => times.least(),
            false => times.median(),
        };
        Some(Row {
            scene: scene.to_owned(),
            method: stage.to_owned(),
            knob,
            seconds: seconds?,
            error: error.filter(|_| stage == "gpu"),
        })
    };
    stages.into_iter().filter_map(row).collect()
}

/// Times of one thing in several frames.
#[derive(Clone, Debug, Default)]
pub struct Times(Vec<f64>);

impl Times {
    /// Another one, in seconds.
    pub fn push(&mut self, seconds: f64) {
        self.0.push(seconds);
    }

    /// The least, once there is one.
    #[must_use]
    pub fn least(&self) -> Option<f64> {
        self.0.iter().copied().min_by(f64::total_cmp)
    }

    /// The median, once there is one.
    #[must_use]
    pub fn median(&self) -> Option<f64> {
        let mut times = self.0.clone();
        times.sort_by(f64::total_cmp);
        times.get(times.len() / 2).copied()
    }
}
