//! What the strands of a tile are drawn with, and which come first.

use super::bin::{Bounds, cells};
use super::instructions::Instructions;
use super::segment::{Reach, Segment, Segments, Stroke};
use super::tile::{OneByOne, ROWS, Stack, Target, WIDTH, greater};
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

/// The segments that reach each of a band's tiles, strand by strand.
#[derive(Default)]
pub(super) struct TileLists(Vec<TileList>);

/// Those of a tile.
#[derive(Default)]
struct TileList {
    segments: Vec<u32>,
    strands: Vec<StrandOfTile>,
}

/// All that reaches a tile of one strand.
struct StrandOfTile {
    /// The place of its first segment in the tile's list.
    start: usize,
    strand: u32,
    bounds: Bounds,
    inv_depth: f32,
    biased: f32,
}

impl TileLists {
    /// Sorts the segments of a band into so many tiles in place of what was there.
    ///
    /// In loops, not by iterators, whose closures are not compiled for their caller's instructions.
    #[inline(always)]
    pub(super) fn fill(&mut self, tiles: usize, segments: &Segments, band: usize) {
        self.0.resize_with(tiles, TileList::default);
        for tile in &mut self.0 {
            tile.segments.clear();
            tile.strands.clear();
        }
        for (first, some) in segments.of_band(band) {
            for reach in some {
                for tile in &mut self.0[cells(reach.bounds.x(), WIDTH)] {
                    tile.push(first + reach.segment, reach);
                }
            }
        }
    }

    /// The segments of a tile.
    pub(super) fn segments(&self, tile: usize) -> &[u32] {
        &self.0[tile].segments
    }
}

impl TileList {
    #[inline(always)]
    fn push(&mut self, number: u32, segment: &Reach) {
        let start = self.segments.len();
        self.segments.push(number);
        match self.strands.last_mut() {
            Some(last) if last.strand == segment.strand => {
                last.bounds = last.bounds.around(&segment.bounds);
                last.inv_depth = greater(segment.inv_depth, last.inv_depth);
                last.biased = greater(segment.biased, last.biased);
            }
            _ => self.strands.push(StrandOfTile {
                start,
                strand: segment.strand,
                bounds: segment.bounds,
                inv_depth: segment.inv_depth,
                biased: segment.biased,
            }),
        }
    }
}

impl TileContext<'_> {
    /// Replaces `parts` by the strands of a tile, in the order in which they are best drawn.
    #[inline(always)]
    pub(super) fn strands(&self, lists: &TileLists, tile: usize, parts: &mut Vec<Part>) {
        parts.clear();
        let TileList { segments, strands } = &lists.0[tile];
        for (i, strand) in strands.iter().enumerate() {
            let end = strands.get(i + 1).map_or(segments.len(), |next| next.start);
            parts.push(Part {
                segments: strand.start..end,
                inv_depth: strand.inv_depth,
                biased: strand.biased,
                rows: strand.bounds.rows_in(self.origin[1], self.stack),
                columns: strand.bounds.columns_in(self.origin[0]),
            });
        }
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
