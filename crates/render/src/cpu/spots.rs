//! Samples that lie anywhere in a tile, as many at a time as a cell has: of most cells few are asked for where a stroke lies.

use super::stroke::{InFrame, Nearest, Placed, Places, Ratios, slack};
use super::tile::{CELL_WIDTH, LANES, LaneMask, Lanes, Mask, STACK, Samples, any, select};

/// Some samples of a tile.
pub(super) struct Spots {
    /// The word of a mask that each is in, and its column.
    pub(super) words: [u32; LANES],
    pub(super) columns: [u32; LANES],
    /// How many there are: those behind are the last one again.
    pub(super) count: usize,
    /// Each one's lane in its cell, and how far that is from the tile's first one, in columns and in rows of stacks.
    lanes: [u32; LANES],
    across: Lanes,
    down: Lanes,
}

impl Spots {
    #[inline(always)]
    pub(super) fn new(words: [u32; LANES], columns: [u32; LANES], count: usize) -> Self {
        let mut lanes = [0; LANES];
        let (mut across, mut down) = ([0.0; LANES], [0.0; LANES]);
        for k in 0..LANES {
            let in_cell = columns[k] % CELL_WIDTH as u32;
            lanes[k] = words[k] % STACK as u32 + in_cell * STACK as u32;
            across[k] = (columns[k] - in_cell) as i32 as f32;
            down[k] = (words[k] / STACK as u32) as i32 as f32;
        }
        Self {
            words,
            columns,
            count,
            lanes,
            across,
            down,
        }
    }

    /// Those of a mask.
    #[inline(always)]
    fn of_mask(&self, mask: &Mask) -> LaneMask {
        let mut lanes = [0; LANES];
        for k in 0..LANES {
            let word = mask[self.words[k] as usize % mask.len()];
            lanes[k] = select(word >> self.columns[k] & 1 != 0, u32::MAX, 0);
        }
        lanes
    }

    /// The numbers that they have.
    #[inline(always)]
    fn of(&self, samples: &Samples) -> Lanes {
        samples.at(&self.lanes, &self.across, &self.down)
    }

    /// The axis points of a stroke of such segments, which cover them. `to_axis` is the segment that was near the axis in the last ones.
    #[inline(always)]
    pub(super) fn places(&self, placed: &[Placed], to_axis: &mut usize) -> Places<false> {
        let (mut places, mut known) = (Places::new(), Ratios::new());
        let slack = slack(placed.len());
        let first = &placed[*to_axis];
        known.offer(first, &self.in_frame(first, self.of_mask(&first.covered)));
        for (place, segment) in placed.iter().enumerate() {
            let covered = self.of_mask(&segment.covered);
            if !any(&covered) {
                continue;
            }
            let at = self.in_frame(segment, covered);
            if places.may_gain(&known, segment, &at, &[u32::MAX; LANES], slack) {
                places.offer(segment, &at);
                *to_axis = place;
            }
        }
        places
    }

    #[inline(always)]
    fn in_frame(&self, segment: &Placed, covered: LaneMask) -> InFrame {
        InFrame {
            covered,
            x: self.of(&segment.x),
            y: self.of(&segment.y),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cpu::tile::{Cell, NO_SAMPLES, Slope, Stack, WIDTH};
    use crate::samples::sample_positions;
    use proptest::prelude::*;

    proptest! {
        /// A sample has what it has in its cell, to the last bit.
        #[test]
        fn spots_are_samples_of_cells(
            words in prop::array::uniform16(0..NO_SAMPLES.len() as u32),
            columns in prop::array::uniform16(0..WIDTH as u32),
            slope in (-1e4..1e4_f32, -1e3..1e3_f32, -1e3..1e3_f32),
            set in prop::collection::vec(0..=u32::MAX, NO_SAMPLES.len()),
            samples in prop::sample::select(vec![1_u32, 2, 4, 8]),
        ) {
            let stack = &Stack::of_pixel(&sample_positions(samples).unwrap())[0];
            let (corner, per_x, per_y) = slope;
            let numbers = Slope { corner, per_x, per_y }.at_samples(stack);
            let mut mask = NO_SAMPLES;
            mask.copy_from_slice(&set);
            let spots = Spots::new(words, columns, LANES);
            let (own, is_set) = (spots.of(&numbers), spots.of_mask(&mask));
            for k in 0..LANES {
                let (word, column) = (words[k] as usize, columns[k] as usize);
                let cell = Cell::new(word / STACK, column / CELL_WIDTH * CELL_WIDTH);
                let lane = word % STACK + column % CELL_WIDTH * STACK;
                prop_assert_eq!(own[k], numbers.of(cell)[lane]);
                prop_assert_eq!(is_set[k], cell.lanes(&mask)[lane]);
            }
        }
    }
}
