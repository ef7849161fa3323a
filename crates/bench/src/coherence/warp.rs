//! How well a picture is the one before, moved as the strands have moved.

use super::NamedOrder;
use super::animation::{TICKS, Tick};
use super::painter::Painter;
use super::places::Places;
use super::scenes::Subject;
use crate::BenchError;
use glam::Vec2;
use render::{Frame, Order, Picture};

/// From frame to frame: 24 a second.
const FRAME: Tick = TICKS / 24;
/// Samples a pixel: a fast picture, and one of 8 x 8.
pub const SAMPLES: [u32; 2] = [4, 64];
/// Stretches of a scene's time that are looked at, at most.
const MOST_WINDOWS: usize = 2;
/// Farthest that anything moves from frame to frame, in pixels.
const REACH: f32 = 256.0;

/// For each of a scene's orders and each of [`SAMPLES`] the mean difference of a frame's hair from the frame before,
/// warped: of red, green and blue, linear light, 0 to 1. Nothing where no two frames can be compared.
///
/// # Errors
///
/// When a frame can't be made or drawn.
pub fn measure(scene: &mut Subject, threads: usize) -> Result<Vec<[Option<f64>; 2]>, BenchError> {
    let mut motion_painter = Painter::new(1, threads)?;
    let mut painters = Vec::new();
    for samples in SAMPLES {
        painters.push(Painter::new(samples, threads)?);
    }
    let mut errors = vec![[Mean::default(); 2]; scene.orders.len()];
    for window in scene.windows.iter().take(MOST_WINDOWS).cloned() {
        let mut before = Shown::new(
            &mut scene.animation.at(window.start)?,
            &scene.orders,
            &mut motion_painter,
            &mut painters,
        )?;
        for tick in window.step_by(FRAME as usize) {
            let mut frame = scene.animation.at(tick + FRAME)?;
            let after = Shown::new(
                &mut frame,
                &scene.orders,
                &mut motion_painter,
                &mut painters,
            )?;
            for (i, (_, order)) in scene.orders.iter().enumerate() {
                let moved = motion(&mut frame, *order, &before, &after, &mut motion_painter)?;
                for sampling in 0..SAMPLES.len() {
                    let pictures = [&before, &after].map(|of| &of.pictures[i][sampling]);
                    errors[i][sampling].add(pictures, &moved);
                }
            }
            before = after;
        }
    }
    let means = errors.into_iter();
    Ok(means.map(|means| means.map(Mean::value)).collect())
}

/// What a frame shows.
struct Shown {
    /// Of the clumps' joints.
    places: Places,
    /// By order and sampling.
    pictures: Vec<Vec<Picture>>,
}

impl Shown {
    fn new(
        frame: &mut Frame,
        orders: &[NamedOrder],
        centers: &mut Painter,
        painters: &mut [Painter],
    ) -> Result<Self, BenchError> {
        let drawing = centers.strokes(frame, Order::default())?;
        let centers = drawing.clump.iter().map(|disc| disc.center).collect();
        let places = Places::new(frame, centers);
        let mut pictures = Vec::new();
        for (_, order) in orders {
            let of_order = painters.iter_mut();
            let of_order = of_order.map(|painter| painter.picture(frame, *order));
            pictures.push(of_order.collect::<Result<_, _>>()?);
        }
        Ok(Self { places, pictures })
    }
}

/// For each pixel of the frame how far the strand that it shows has come since the frame before, in pixels;
/// nothing where there is no hair.
fn motion(
    frame: &mut Frame,
    order: Order,
    before: &Shown,
    after: &Shown,
    painter: &mut Painter,
) -> Result<Vec<Option<Vec2>>, BenchError> {
    // Colours can hold 0 to 1. Strands that enter the view have no motion.
    let color = |joint: usize| {
        let Some(moved) = after.places.moved_since(&before.places, joint) else {
            return [0.0; 3];
        };
        let shares = (moved / (2.0 * REACH) + 0.5).clamp(Vec2::ZERO, Vec2::ONE);
        [shares.x, shares.y, 1.0]
    };
    let picture = painter.recolored(frame, order, color)?;
    let moved = |[x, y, hair, _]: &[f32; 4]| {
        let shares = Vec2::new(*x, *y) / *hair;
        (*hair > 0.5).then(|| (shares - 0.5) * (2.0 * REACH))
    };
    Ok(picture.pixels.iter().map(moved).collect())
}

/// A mean in the making.
#[derive(Clone, Copy, Debug, Default)]
struct Mean {
    sum: f64,
    count: u64,
}

impl Mean {
    fn add(&mut self, [before, after]: [&Picture; 2], moved: &[Option<Vec2>]) {
        let width = after.width as usize;
        for (i, moved) in moved.iter().enumerate() {
            let Some(moved) = moved else { continue };
            let middle = Vec2::new((i % width) as f32, (i / width) as f32) + 0.5;
            let Some(color) = sample(before, middle - *moved) else {
                continue;
            };
            let apart = (0..3).map(|c| f64::from((after.pixels[i][c] - color[c]).abs()));
            self.sum += apart.sum::<f64>() / 3.0;
            self.count += 1;
        }
    }

    fn value(self) -> Option<f64> {
        (self.count > 0).then(|| self.sum / self.count as f64)
    }
}

/// The colour at a place (pixels from the upper left corner) between the middles of four pixels; nothing
/// outside of them.
fn sample(picture: &Picture, at: Vec2) -> Option<[f32; 3]> {
    let from_middle = at - 0.5;
    let whole = from_middle.floor();
    let share = from_middle - whole;
    let inside = whole.min_element() >= 0.0
        && whole.x + 1.0 < picture.width as f32
        && whole.y + 1.0 < picture.height as f32;
    if !inside {
        return None;
    }
    let width = picture.width as usize;
    let corner = whole.y as usize * width + whole.x as usize;
    let pixel = |offset: usize, c: usize| picture.pixels[corner + offset][c];
    let mix = |a: f32, b: f32, share: f32| a + (b - a) * share;
    Some(std::array::from_fn(|c| {
        let upper = mix(pixel(0, c), pixel(1, c), share.x);
        let lower = mix(pixel(width, c), pixel(width + 1, c), share.x);
        mix(upper, lower, share.y)
    }))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A ramp whose level lines stand upright, moved to the right.
    fn ramp(moved: f32) -> Picture {
        let pixels = (0..64 * 8).map(|i| {
            let gray = ((i % 64) as f32 - moved) / 64.0;
            [gray, gray, gray, 1.0]
        });
        Picture {
            width: 64,
            height: 8,
            pixels: pixels.collect(),
        }
    }

    fn error(moved: Vec2) -> Option<f64> {
        let mut mean = Mean::default();
        let moved: Vec<Option<Vec2>> = (0..64 * 8)
            .map(|i| (20..40).contains(&(i % 64)).then_some(moved))
            .collect();
        mean.add([&ramp(0.0), &ramp(3.25)], &moved);
        mean.value()
    }

    #[test]
    fn what_moves_as_it_is_told_has_no_error() {
        assert!(error(Vec2::new(3.25, 0.0)).unwrap() < 1e-6);
        assert!((error(Vec2::ZERO).unwrap() - 3.25 / 64.0).abs() < 1e-6);
        // All of it comes from outside the picture.
        assert_eq!(error(Vec2::new(0.0, 100.0)), None);
    }
}
