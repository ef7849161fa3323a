//! How large and how sharp a picture may be while something moves, so that there are sixty a second.

use super::Times;
use std::time::Duration;

/// Milliseconds that drawing may take while something moves: a sixtieth of a second, less what the window needs.
const BUDGET_MS: f64 = 13.0;
/// The same at rest, before the sharp picture: what nobody waits for.
const ROUGH_MS: f64 = 60.0;
/// Milliseconds of a sharp picture that keep whoever goes on working waiting.
const LONG_MS: f64 = 300.0;
/// How long such a picture waits for him to do so.
const PATIENCE: Duration = Duration::from_millis(500);
/// Samples a pixel of a sharp picture, as most presets have them.
const SHARP_SAMPLES: u32 = 16;
/// Samples a pixel while something moves.
const MOVING_SAMPLES: u32 = 4;
/// Sides of pictures get smaller in these steps, so that they don't change with every frame.
const SCALES: [f64; 7] = [1.0, 0.85, 0.7, 0.6, 0.5, 0.4, 0.3];
/// How far below the budget a larger picture must be, before it is taken again.
const HEADROOM: f64 = 0.8;
/// The least time that pixels get, in parts of what strokes take.
const LEAST_FOR_PIXELS: f64 = 0.5;
/// How much of what is known comes from the last frame.
const NEWS: f64 = 0.25;

/// What pictures have taken so far.
pub(super) struct Quality {
    /// Milliseconds of a frame that don't hang on its pixels: simulation, paths, strokes.
    base_ms: f64,
    /// Milliseconds a million samples.
    sample_ms: f64,
    scale: usize,
}

impl Quality {
    pub fn new() -> Self {
        Self {
            base_ms: 5.0,
            sample_ms: 10.0,
            scale: 2,
        }
    }

    /// Size and samples of the next picture of several, where `size_px` and `samples` are wanted.
    pub fn choose(
        &mut self,
        size_px: [u32; 2],
        samples: u32,
        is_moving: bool,
        pictures: usize,
    ) -> ([u32; 2], u32) {
        let few = samples.min(MOVING_SAMPLES);
        if !is_moving {
            // What is wanted at once, where that takes no longer than anybody notices.
            let is_quick = self.base_ms + self.expected_ms(size_px, samples, 1.0) <= ROUGH_MS;
            return (size_px, if is_quick { samples } else { few });
        }
        // Where strokes alone take too long, fewer pixels help little, and the picture is kept readable.
        let budget = BUDGET_MS / pictures.max(1) as f64 - self.base_ms;
        let budget = budget.max(LEAST_FOR_PIXELS * self.base_ms);
        let fits =
            |scale: usize, budget: f64| self.expected_ms(size_px, few, SCALES[scale]) <= budget;
        let last = SCALES.len() - 1;
        let wanted = (0..=last)
            .find(|&scale| fits(scale, budget))
            .unwrap_or(last);
        let larger = wanted < self.scale && !fits(wanted, budget * HEADROOM);
        if !larger {
            self.scale = wanted;
        }
        let scale = SCALES[self.scale];
        (
            size_px.map(|side| ((f64::from(side) * scale).round() as u32).max(1)),
            few,
        )
    }

    /// How long nothing must be wished for before a sharp picture of this size is begun: one that takes long would keep the next wish waiting.
    pub fn patience(&self, size_px: [u32; 2]) -> Duration {
        let sharp_ms = self.base_ms + self.expected_ms(size_px, SHARP_SAMPLES, 1.0);
        match sharp_ms > LONG_MS {
            true => PATIENCE,
            false => Duration::ZERO,
        }
    }

    /// What the pixels are expected to take.
    fn expected_ms(&self, [width, height]: [u32; 2], samples: u32, scale: f64) -> f64 {
        let pixels = f64::from(width) * f64::from(height) * scale * scale;
        self.sample_ms * pixels * f64::from(samples) * 1e-6
    }

    /// Takes on what a picture took.
    pub fn learn(&mut self, [width, height]: [u32; 2], samples: u32, times: &Times) {
        let megasamples = f64::from(width) * f64::from(height) * f64::from(samples) * 1e-6;
        let blend = |known: &mut f64, new: f64| *known += NEWS * (new - *known);
        // Hair that comes after from far behind tells nothing about the next picture.
        let simulate = times.simulate.min(LONG_MS);
        blend(&mut self.base_ms, simulate + times.paths + times.effects);
        blend(&mut self.sample_ms, times.raster / megasamples.max(1e-3));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: [u32; 2] = [960, 720];

    /// Draws as a machine does that takes so long, until nothing changes.
    fn settled(base_ms: f64, sample_ms: f64) -> (Quality, [u32; 2]) {
        let mut quality = Quality::new();
        let mut size = SIZE;
        for _ in 0..60 {
            let samples;
            (size, samples) = quality.choose(SIZE, 16, true, 1);
            let megasamples = f64::from(size[0] * size[1] * samples) * 1e-6;
            let times = Times {
                effects: base_ms,
                raster: sample_ms * megasamples,
                ..Times::default()
            };
            quality.learn(size, samples, &times);
        }
        (quality, size)
    }

    #[test]
    fn a_fast_machine_draws_all_and_a_slow_one_what_fits() {
        assert_eq!(settled(1.0, 1.0).1, SIZE);
        let (_, size) = settled(3.0, 10.0);
        let took = 3.0 + 10.0 * f64::from(size[0] * size[1] * MOVING_SAMPLES) * 1e-6;
        assert!(took <= BUDGET_MS && size[0] < SIZE[0], "{size:?}: {took}");
        // One that can't keep up whatever the size draws what takes about half as long as the strokes.
        let (_, [width, height]) = settled(40.0, 10.0);
        let pixels = 10.0 * f64::from(width * height * MOVING_SAMPLES) * 1e-6;
        assert!((12.0..=20.0).contains(&pixels), "{pixels}");
        assert_eq!(settled(13.0, 90.0).1, [288, 216]);
    }

    #[test]
    fn the_size_stays_where_times_waver() {
        let (mut quality, size) = settled(3.0, 10.0);
        let mut sizes = vec![size];
        for frame in 0..100 {
            let (size, samples) = quality.choose(SIZE, 16, true, 1);
            let megasamples = f64::from(size[0] * size[1] * samples) * 1e-6;
            let waver = if frame % 2 == 0 { 0.97 } else { 1.03 };
            let times = Times {
                effects: 3.0,
                raster: 10.0 * megasamples * waver,
                ..Times::default()
            };
            quality.learn(size, samples, &times);
            sizes.push(size);
        }
        sizes.dedup();
        assert_eq!(sizes.len(), 1, "{sizes:?}");
    }

    #[test]
    fn a_sharp_picture_that_takes_long_is_begun_when_nothing_happens() {
        assert_eq!(settled(3.0, 10.0).0.patience(SIZE), Duration::ZERO);
        assert_eq!(settled(3.0, 90.0).0.patience(SIZE), PATIENCE);
    }

    #[test]
    fn at_rest_the_size_is_whole() {
        let (mut quality, _) = settled(3.0, 10.0);
        assert_eq!(quality.choose(SIZE, 16, false, 1), (SIZE, 4));
        assert_eq!(quality.choose([64, 48], 16, false, 1), ([64, 48], 16));
        assert_eq!(quality.choose(SIZE, 1, false, 1), (SIZE, 1));
    }
}
