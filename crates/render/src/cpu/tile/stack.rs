//! Where the samples of a tile lie, and numbers that run linearly over them.

use super::{Cell, LANES, Lanes, ROWS, STACK};
use glam::Vec2;
use std::ops::Range;

/// Samples that lie one below the other, in one pixel or in several.
#[derive(Clone, Debug)]
pub(in crate::cpu) struct Stack {
    /// The samples' places for each lane of a cell, from the cell's upper left corner, in pixels.
    pub(in crate::cpu) x: Lanes,
    pub(in crate::cpu) y: Lanes,
    /// The least and the greatest of the places across, and of those down.
    pub(in crate::cpu) ends: [[f32; 2]; 2],
    /// For each lane the middle of those of its pixel's samples that look pictures up together.
    pub(in crate::cpu) middle: [Lanes; 2],
    /// How many samples of its pixels come before its own.
    pub(in crate::cpu) first: usize,
    /// Pixels one below the other that it holds samples of: 1, 2, 4 or 8.
    pub(in crate::cpu) height: usize,
    /// How many lanes one after the other are a pixel's.
    pub(in crate::cpu) of_pixel: usize,
    /// How many of a pixel's lanes count. Those behind are the pixel's first one again, so that they hide and are hidden as it is.
    pub(in crate::cpu) samples: usize,
}

impl Stack {
    /// The stacks that make up a pixel's samples, given from the pixel's corner, or those of several pixels.
    pub(in crate::cpu) fn of_pixel(samples: &[Vec2]) -> Vec<Self> {
        let of_pixel = samples.len().next_power_of_two().min(STACK);
        let height = STACK / of_pixel;
        let stack = |(number, samples): (usize, &[Vec2])| {
            let pixel = |k: usize| Vec2::new((k / STACK) as f32, (k % STACK / of_pixel) as f32);
            let middle = |k: usize| {
                let together = together(of_pixel);
                let number = k % of_pixel / together;
                let own = samples
                    .chunks(together)
                    .nth(number)
                    .unwrap_or(&samples[..1]);
                own.iter().sum::<Vec2>() / own.len() as f32 + pixel(k)
            };
            let place = |k: usize| *samples.get(k % of_pixel).unwrap_or(&samples[0]) + pixel(k);
            let x: Lanes = std::array::from_fn(|k| place(k).x);
            let y: Lanes = std::array::from_fn(|k| place(k).y);
            let ends = |places: Lanes| {
                let greatest = places.into_iter().fold(f32::NEG_INFINITY, f32::max);
                [places.into_iter().fold(f32::INFINITY, f32::min), greatest]
            };
            Self {
                x,
                y,
                ends: [ends(x), ends(y)],
                middle: [
                    std::array::from_fn(|k| middle(k).x),
                    std::array::from_fn(|k| middle(k).y),
                ],
                first: number * STACK,
                height,
                of_pixel,
                samples: samples.len(),
            }
        };
        samples.chunks(of_pixel).enumerate().map(stack).collect()
    }

    /// How many lanes one after the other look pictures up together.
    #[inline(always)]
    pub(in crate::cpu) fn together(&self) -> usize {
        together(self.of_pixel)
    }

    /// The rows of stacks that hold some rows of pixels.
    #[inline(always)]
    pub(in crate::cpu) fn rows(&self, pixels: Range<usize>) -> Range<usize> {
        let shift = self.height.trailing_zeros(); // of a power of 2
        pixels.start >> shift..(pixels.end + self.height - 1) >> shift
    }
}

/// How many samples, of so many of a pixel, look pictures up together: four at most, as on graphics cards.
#[inline(always)]
fn together(of_pixel: usize) -> usize {
    of_pixel.min(4)
}

/// Height of a tile in pixels, made of such stacks.
pub(in crate::cpu) fn height(stacks: &[Stack]) -> usize {
    ROWS * stacks[0].height
}

/// A value that runs linearly over the screen, seen from a tile.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::cpu) struct Slope {
    /// At the tile's upper left corner.
    pub(in crate::cpu) corner: f32,
    pub(in crate::cpu) per_x: f32,
    pub(in crate::cpu) per_y: f32,
}

/// A [`Slope`] at a tile's samples.
#[derive(Clone, Copy)]
#[repr(align(32))] // as [`Aligned`] cells are
pub(in crate::cpu) struct Samples {
    /// At the lanes of the tile's first cell.
    first: Lanes,
    per_column: f32,
    per_row: f32,
}

impl Slope {
    #[inline(always)]
    pub(in crate::cpu) fn at_samples(&self, stack: &Stack) -> Samples {
        let (x, y) = (&stack.x, &stack.y);
        let mut first = [self.corner; LANES];
        for k in 0..LANES {
            first[k] += x[k] * self.per_x + y[k] * self.per_y;
        }
        Samples {
            first,
            per_column: self.per_x,
            per_row: self.per_y * stack.height as f32,
        }
    }
}

impl Samples {
    /// At the samples of a cell.
    #[inline(always)]
    pub(in crate::cpu) fn of(&self, cell: Cell) -> Lanes {
        let step = number(cell.column) * self.per_column + number(cell.row) * self.per_row;
        self.and(step)
    }

    /// At some lanes of cells that are so far from the tile's first one.
    #[inline(always)]
    pub(in crate::cpu) fn at(&self, lanes: &[u32; LANES], across: &Lanes, down: &Lanes) -> Lanes {
        let mut own = [0.0; LANES];
        for k in 0..LANES {
            let step = across[k] * self.per_column + down[k] * self.per_row;
            own[k] = self.first[lanes[k] as usize % LANES] + step;
        }
        own
    }

    /// At those of a cell where it is so much more than in the tile's first one.
    #[inline(always)]
    pub(in crate::cpu) fn and(&self, step: f32) -> Lanes {
        let mut lanes = self.first;
        for k in 0..LANES {
            lanes[k] += step;
        }
        lanes
    }
}

/// A row or a column. By way of small numbers, as those of 64 bits take a branch.
#[inline(always)]
pub(in crate::cpu) fn number(place: usize) -> f32 {
    f32::from(place as u16)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::samples::sample_positions;

    #[test]
    fn stacks_hold_every_sample_of_their_pixels_once() {
        for samples in [1, 2, 3, 4, 5, 8, 9, 16, 64] {
            let positions = sample_positions(samples).unwrap();
            let stacks = Stack::of_pixel(&positions);
            let Stack {
                height, of_pixel, ..
            } = stacks[0];
            assert_eq!(height * of_pixel, STACK);
            let mut held = Vec::new();
            for stack in &stacks {
                assert_eq!([stack.height, stack.of_pixel], [height, of_pixel]);
                let place = |lane: usize| Vec2::new(stack.x[lane], stack.y[lane]);
                assert_eq!(stack.first, held.len());
                held.extend((0..stack.samples).map(place));
                for k in 0..LANES {
                    let pixel = Vec2::new((k / STACK) as f32, (k % STACK / of_pixel) as f32);
                    // Those that don't count are the pixel's first one.
                    let sample = Some(k % of_pixel).filter(|sample| *sample < stack.samples);
                    assert_eq!(
                        place(k),
                        place(sample.unwrap_or(0)) + pixel,
                        "{samples}, {k}"
                    );
                }
            }
            assert_eq!(held, positions, "{samples} samples");
        }
    }

    #[test]
    fn pictures_are_looked_up_in_the_middle_of_four_samples_at_most() {
        for samples in [1, 3, 4, 5, 8, 16] {
            let positions = sample_positions(samples).unwrap();
            for stack in Stack::of_pixel(&positions) {
                let own = &positions[stack.first..][..stack.samples];
                for (number, four) in own.chunks(4).enumerate() {
                    let middle = four.iter().sum::<Vec2>() / four.len() as f32;
                    let below = Vec2::new(1.0, (stack.height - 1) as f32);
                    let last = LANES - stack.of_pixel + 4 * number;
                    let found = Vec2::new(stack.middle[0][last], stack.middle[1][last]);
                    assert_eq!(found, middle + below, "{samples} samples");
                }
            }
        }
    }
}
