//! What the strands of a tile are drawn with, and which come first.

use super::bin::Bounds;
use super::instructions::Instructions;
use super::segment::{Segment, Stroke};
use super::tile::{OneByOne, ROWS, Stack, Target, greater};
use crate::drawing::{Drawing, Order};
use std::ops::Range;

/// What stays the same from strand to strand.
pub(super) struct TileContext<'a> {
    pub(super) drawing: &'a Drawing,
    pub(super) strokes: &'a [Stroke],
    pub(super) segments: &'a [Segment],
    /// The tile's upper left pixel.
    pub(super) origin: [usize; 2],
    /// The samples that are worked on.
    pub(super) stack: &'a Stack,
    /// What all of it is compiled for.
    pub(super) instructions: Instructions,
}

/// A strand's part of a tile.
pub(super) struct Part {
    /// Its segments in drawing order, among the tile's.
    pub(super) segments: Range<usize>,
    /// No disc of it is nearer than these.
    inv_depth: f32,
    biased: f32,
    /// Rows of stacks that it may reach.
    rows: Range<usize>,
    /// Columns that it may reach, a bit for each.
    columns: u32,
}

impl TileContext<'_> {
    /// Replaces `parts` by the strands of a tile, in the order in which they are best drawn.
    #[inline(always)]
    pub(super) fn strands(&self, tile: &[u32], parts: &mut Vec<Part>) {
        parts.clear();
        let mut rest = tile.iter().zip(0..);
        let Some((&first, _)) = rest.next() else {
            return;
        };
        let mut start = 0;
        let first = &self.segments[first as usize];
        let (mut strand, mut bounds) = (first.strand, first.bounds);
        let (mut inv_depth, mut biased) = (first.inv_depth, first.biased);
        let part = |segments: Range<usize>, inv_depth, biased, bounds: &Bounds| Part {
            segments,
            inv_depth,
            biased,
            rows: bounds.rows_in(self.origin[1], self.stack),
            columns: bounds.columns_in(self.origin[0]),
        };
        for (&index, place) in rest {
            let segment = &self.segments[index as usize];
            if segment.strand != strand {
                parts.push(part(start..place, inv_depth, biased, &bounds));
                start = place;
                (strand, bounds) = (segment.strand, segment.bounds);
                (inv_depth, biased) = (segment.inv_depth, segment.biased);
                continue;
            }
            bounds = bounds.around(&segment.bounds);
            inv_depth = greater(segment.inv_depth, inv_depth);
            biased = greater(segment.biased, biased);
        }
        parts.push(part(start..tile.len(), inv_depth, biased, &bounds));
        // What lies behind the nearer ones is then seen to be hidden. Shifted strokes of equal depth
        // need their strands' order.
        if self.drawing.order != Order::Shifted {
            parts.sort_by(|a, b| b.inv_depth.total_cmp(&a.inv_depth));
        }
    }

    /// The columns of each row of stacks that the strand may reach where it is not sure, for a whole cell, to be hidden.
    #[inline(always)]
    pub(super) fn open(&self, part: &Part, target: &Target) -> [u32; ROWS] {
        let mut open = [0; ROWS];
        for row in OneByOne::of(&part.rows) {
            open[row] = part.columns & target.open(row, part.inv_depth, part.biased);
        }
        open
    }
}
