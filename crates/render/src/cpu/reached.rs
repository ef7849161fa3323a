//! The segments of a stroke that reach a row of cells, and which of them make a difference in one.
//!
//! Joints of a wide stroke lie closer to each other than it is wide, so that many segments cover a sample; but its depth is that of the
//! nearest disc, and its colour that of the nearest point of the axis. So those that were the nearest in the last cell come first, and others
//! are worked out only where they may be nearer yet: the same bits, as they would have changed nothing.

use super::stroke::{Depths, Nearest, Placed, Ratios, slack};
use super::tile::{Cell, LaneMask, columns};

/// So many segments are all worked out: to choose among them would take longer.
const FEW: usize = 4;

/// Segments of a stroke that cover some samples of a row of stacks.
#[derive(Default)]
pub(super) struct Reached {
    /// Their places among the stroke's segments, and the columns.
    segments: Vec<(usize, u32)>,
    /// As [`Nearest::may_gain`] asks for.
    slack: f32,
    /// Of the last cell: the place of a segment near the eye, and of one near the axis.
    to_eye: usize,
    to_axis: usize,
}

impl Reached {
    /// Finds those that cover one of the columns.
    #[inline(always)]
    pub(super) fn find(&mut self, placed: &[Placed], row: usize, wanted: u32) {
        self.segments.clear();
        for (i, placed) in placed.iter().enumerate() {
            let reached = columns(&placed.covered, row) & wanted;
            if reached != 0 {
                self.segments.push((i, reached));
            }
        }
        if self.segments.len() > FEW {
            self.slack = slack(self.segments.len());
        }
        self.to_eye = self.to_eye.min(placed.len() - 1);
        self.to_axis = self.to_axis.min(placed.len() - 1);
    }

    /// Offers those to `depths` and `nearest`, in order, that may make a difference to them at some samples of a cell; elsewhere these are
    /// numbers without meaning.
    #[inline(always)]
    pub(super) fn measure(
        &mut self,
        placed: &[Placed],
        cell: Cell,
        samples: &LaneMask,
        depths: &mut Depths,
        nearest: &mut impl Nearest,
    ) {
        if self.segments.len() <= FEW {
            for &(place, reached) in &self.segments {
                if reached & cell.columns() != 0 {
                    let at = placed[place].at(cell);
                    depths.offer(&placed[place], &at);
                    nearest.offer(&placed[place], &at);
                }
            }
            return;
        }
        let first = self.to_eye;
        depths.offer(&placed[first], &placed[first].at(cell));
        let known = self.known(placed, cell);
        for &(place, reached) in &self.segments {
            if reached & cell.columns() == 0 {
                continue;
            }
            let segment = &placed[place];
            let at = segment.at(cell);
            if place != first && depths.may_gain(segment, &at, samples) {
                depths.offer(segment, &at);
                self.to_eye = place;
            }
            if nearest.may_gain(&known, segment, &at, samples, self.slack) {
                nearest.offer(segment, &at);
                self.to_axis = place;
            }
        }
    }

    /// Offers those to `nearest`, in order, that may make a difference to it at some samples of a cell.
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
        let known = self.known(placed, cell);
        for &(place, reached) in &self.segments {
            if reached & cell.columns() == 0 {
                continue;
            }
            let segment = &placed[place];
            let at = segment.at(cell);
            if nearest.may_gain(&known, segment, &at, samples, self.slack) {
                nearest.offer(segment, &at);
                self.to_axis = place;
            }
        }
    }

    /// The ratios of the segment that was near the axis in the last cell. It is offered in its turn once more, as of equals the first one is
    /// taken.
    #[inline(always)]
    fn known(&self, placed: &[Placed], cell: Cell) -> Ratios {
        let mut known = Ratios::new();
        known.offer(&placed[self.to_axis], &placed[self.to_axis].at(cell));
        known
    }
}
