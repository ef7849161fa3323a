//! The segments of a stroke that reach a row of cells, and which of them can make a difference in one.
//!
//! Joints of a wide stroke lie closer to each other than it is wide, so that many segments cover a sample; but its depth is that of the
//! nearest disc, and its colour that of the nearest point of the axis. Where there are many segments, eight at a time are held against
//! what is known of the cell so far, and those that are surely farther are left out: the same bits, as they would have changed nothing.

use super::stroke::{Depths, Nearest, Placed, Ratios};
use super::tile::{
    Cell, LANES, LaneMask, Lanes, Stack, bits, columns, greater, greatest_of, number, select,
};

/// So many segments are all worked out: to choose among them would take longer.
const FEW: usize = 10;

/// Segments of a stroke that cover some samples of a row of stacks.
#[derive(Default)]
pub(super) struct Reached {
    /// Their places among the stroke's segments, and the columns.
    segments: Vec<(usize, u32)>,
    /// The same eight at a time, where they are more than [`FEW`].
    eights: Vec<Eight>,
    /// Of the last cell: the place of a segment near the eye, and of one near the axis.
    to_eye: usize,
    to_axis: usize,
}

impl Reached {
    /// Finds those that cover one of the columns.
    #[inline(always)]
    pub(super) fn find(&mut self, placed: &[Placed], stack: &Stack, row: usize, wanted: u32) {
        self.segments.clear();
        for (i, placed) in placed.iter().enumerate() {
            let reached = columns(&placed.covered, row) & wanted;
            if reached != 0 {
                self.segments.push((i, reached));
            }
        }
        if self.segments.len() > FEW {
            self.eights.clear();
            for some in self.segments.chunks(LANES) {
                self.eights.push(Eight::new(placed, some, stack, row));
            }
            self.to_eye = self.to_eye.min(placed.len() - 1);
            self.to_axis = self.to_axis.min(placed.len() - 1);
        }
    }

    /// Offers those to `depths` and `nearest` that may make a difference to them at some samples of a cell; elsewhere these are numbers without
    /// meaning.
    #[inline(always)]
    pub(super) fn measure(
        &mut self,
        placed: &[Placed],
        cell: Cell,
        samples: &LaneMask,
        depths: &mut Depths,
        nearest: &mut impl Nearest,
    ) {
        if self.segments.len() > FEW {
            self.find_depths(placed, cell, samples, depths);
            self.find_nearest(placed, cell, samples, nearest);
            return;
        }
        for &(place, reached) in &self.segments {
            if reached & cell.columns() != 0 {
                let at = placed[place].at(cell);
                depths.offer(&placed[place], &at);
                nearest.offer(&placed[place], &at);
            }
        }
    }

    /// Offers those of many that may be the nearest to the eye.
    #[inline(always)]
    fn find_depths(
        &mut self,
        placed: &[Placed],
        cell: Cell,
        samples: &LaneMask,
        depths: &mut Depths,
    ) {
        let first = self.to_eye;
        depths.offer(&placed[first], &placed[first].at(cell));
        let mut farthest = depths.farthest(samples);
        for (eight, some) in self.eights.iter().zip(self.segments.chunks(LANES)) {
            let mut left = eight.nearer_to_eye(cell, farthest);
            while left != 0 {
                let (place, _) = some[left.trailing_zeros() as usize];
                left &= left - 1;
                if place == first {
                    continue;
                }
                depths.offer(&placed[place], &placed[place].at(cell));
                let now = depths.farthest(samples);
                if now != farthest {
                    (farthest, self.to_eye) = (now, place);
                    left &= eight.nearer_to_eye(cell, farthest);
                }
            }
        }
    }

    /// Offers those to `nearest`, in order, that may be the nearest to the axis.
    #[inline(always)]
    pub(super) fn find_nearest(
        &mut self,
        placed: &[Placed],
        cell: Cell,
        samples: &LaneMask,
        nearest: &mut impl Nearest,
    ) {
        if self.segments.len() <= FEW {
            for &(place, reached) in &self.segments {
                if reached & cell.columns() != 0 {
                    nearest.offer(&placed[place], &placed[place].at(cell));
                }
            }
            return;
        }
        // It is offered in its turn: of equals the first one is taken.
        let mut known = Ratios::new();
        known.offer(&placed[self.to_axis], &placed[self.to_axis].at(cell));
        let mut farthest = greatest_of(known.ratios(), samples);
        for (eight, some) in self.eights.iter().zip(self.segments.chunks(LANES)) {
            let mut left = eight.nearer_to_axis(cell, farthest);
            while left != 0 {
                let (place, _) = some[left.trailing_zeros() as usize];
                left &= left - 1;
                nearest.offer(&placed[place], &placed[place].at(cell));
                let now = greatest_of(nearest.ratios(), samples);
                if now < farthest {
                    (farthest, self.to_axis) = (now, place);
                    left &= eight.nearer_to_axis(cell, farthest);
                }
            }
        }
    }
}

/// Eight segments, seen from a row of stacks.
struct Eight {
    /// Those that they reach, none where there is no segment.
    columns: [u32; LANES],
    /// The middle of the row's first cell in the segment's frame, and what it moves by from column to column.
    x: Lanes,
    x_per_column: Lanes,
    y: Lanes,
    y_per_column: Lanes,
    length: Lanes,
    /// Of the larger disc.
    radius: Lanes,
    /// No disc is nearer than these.
    inv_depth: Lanes,
    biased: Lanes,
    /// How far a cell's samples are from its middle at most.
    cell_radius: f32,
}

/// Ratios that are larger by less than this factor may still decide on which side of a stroke a sample lies
/// ([`Places`](super::stroke::Places)): each of a hundred segments may have kept the one before it from doing so by a thousandth.
const BESIDE: f32 = 1.1;

impl Eight {
    #[inline(always)]
    fn new(placed: &[Placed], some: &[(usize, u32)], stack: &Stack, row: usize) -> Self {
        let mut eight = Self {
            columns: [0; LANES],
            x: [0.0; LANES],
            x_per_column: [0.0; LANES],
            y: [0.0; LANES],
            y_per_column: [0.0; LANES],
            length: [0.0; LANES],
            radius: [0.0; LANES],
            inv_depth: [0.0; LANES],
            biased: [0.0; LANES],
            cell_radius: stack.cell_radius(),
        };
        for (k, &(place, reached)) in some.iter().enumerate() {
            let placed = &placed[place];
            let [x, y] = placed.frame();
            eight.columns[k] = reached;
            eight.x[k] = x.middle_of_row(row);
            eight.x_per_column[k] = x.per_column;
            eight.y[k] = y.middle_of_row(row);
            eight.y_per_column[k] = y.per_column;
            eight.length[k] = placed.shape.sweep.length();
            eight.radius[k] = placed.shape.sweep.radius();
            eight.inv_depth[k] = placed.shape.inv_depth.greatest();
            eight.biased[k] = placed.shape.inv_depth_biased.greatest();
        }
        eight
    }

    /// Those that reach a cell and have a disc that is nearer than either of these depths, a bit for each.
    #[inline(always)]
    fn nearer_to_eye(&self, cell: Cell, [inv_depth, biased]: [f32; 2]) -> u32 {
        let mut nearer = [0; LANES];
        for k in 0..LANES {
            let is_nearer = (self.inv_depth[k] > inv_depth) | (self.biased[k] > biased);
            let reaches = self.columns[k] & cell.columns() != 0;
            nearer[k] = select(is_nearer & reaches, u32::MAX, 0);
        }
        bits(&nearer)
    }

    /// Those that reach a cell and whose ratio may be such a one there or less: at a distance from the axis of at least `d` it is
    /// at least (d / radius)^2.
    #[inline(always)]
    fn nearer_to_axis(&self, cell: Cell, ratio: f32) -> u32 {
        let column = number(cell.column);
        let share = (BESIDE * ratio).sqrt();
        let mut nearer = [0; LANES];
        for k in 0..LANES {
            let x = self.x[k] + column * self.x_per_column[k];
            let y = self.y[k] + column * self.y_per_column[k];
            let beyond = greater(greater(-x, x - self.length[k]), 0.0);
            let within = share * self.radius[k] + self.cell_radius;
            let is_near = beyond * beyond + y * y <= within * within;
            let reaches = self.columns[k] & cell.columns() != 0;
            nearer[k] = select(is_near & reaches, u32::MAX, 0);
        }
        bits(&nearer)
    }
}
