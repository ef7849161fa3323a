//! One segment in one tile: which samples it covers, how near, in which colour.

use super::rows::{self, ROWS_AT_ONCE};
use super::segment::Shape;
use super::strand::TileContext;
use super::tile::{
    Cell, LANES, Lanes, Mask, NO_SAMPLES, NOTHING, ROWS, STACK, Samples, Slope, greater, lesser,
    overwrite, select,
};
use glam::DVec2;

/// A segment seen from a tile.
pub(super) struct Placed {
    pub(super) shape: Shape,
    /// Its place in the list of segments.
    pub(super) index: u32,
    /// As [`Segment::drawn_as`](super::segment::Segment::drawn_as).
    pub(super) drawn_as: u32,
    /// The samples that it covers.
    pub(super) covered: Mask,
    /// The segment's frame.
    x: Samples,
    y: Samples,
}

impl Placed {
    /// Nothing where the segment reaches none of the open samples, which are given
    /// as columns of the rows of stacks.
    #[inline(always)]
    pub(super) fn new(scene: &TileContext, index: u32, open: &[u32; ROWS]) -> Option<Self> {
        let TileContext { origin, stack, .. } = *scene;
        let segment = &scene.segments[index as usize];
        let rows = segment.bounds.rows_in(origin[1], stack);
        let mut reached = 0;
        for row in rows.clone() {
            reached |= open[row];
        }
        if reached & segment.bounds.columns_in(origin[0]) == 0 {
            return None;
        }
        let rows =
            rows.start / ROWS_AT_ONCE * ROWS_AT_ONCE..rows.end.next_multiple_of(ROWS_AT_ONCE);
        let shape = segment.shape(scene.drawing, scene.strokes)?;
        let origin = DVec2::new(origin[0] as f64, origin[1] as f64);
        let mut covered = NO_SAMPLES;
        rows::cover(&shape.sweep, origin, &rows, stack, &mut covered);
        for row in rows {
            for sample in 0..STACK {
                covered[row * STACK + sample] &= open[row];
            }
        }
        // From double precision, so that long strokes stay exact in every tile.
        let corner = shape.sweep.local(origin).as_vec2();
        let axis = shape.sweep.axis();
        let x = Slope {
            corner: corner.x,
            per_x: axis.x,
            per_y: axis.y,
        };
        let y = Slope {
            corner: corner.y,
            per_x: -axis.y,
            per_y: axis.x,
        };
        Some(Self {
            shape,
            index,
            drawn_as: segment.drawn_as,
            covered,
            x: x.at_samples(stack),
            y: y.at_samples(stack),
        })
    }

    /// Brings the segment's depth and ratio at the samples of a cell that it covers into those of its stroke.
    #[inline(always)]
    pub(super) fn measure(&self, cell: Cell, stroke: &mut Measured) {
        let Shape {
            sweep,
            inv_depth,
            inv_depth_biased,
            ..
        } = &self.shape;
        let covered = cell.lanes(&self.covered);
        let (x, y) = (self.x.of(cell), self.y.of(cell));
        for k in 0..LANES {
            let is_covered = covered[k] != 0;
            let (low, high) = sweep.interval(x[k], y[k]);
            // Linear, so the greatest is at one of the ends.
            let depth = greater(inv_depth.at(low), inv_depth.at(high));
            let biased = greater(inv_depth_biased.at(low), inv_depth_biased.at(high));
            let (_, ratio) = sweep.attribute_point(x[k], y[k]);
            let depth = select(is_covered, depth, NOTHING);
            stroke.inv_depth[k] = greater(depth, stroke.inv_depth[k]);
            let biased = select(is_covered, biased, NOTHING);
            stroke.biased[k] = greater(biased, stroke.biased[k]);
            let ratio = select(is_covered, ratio, 1.0);
            stroke.ratio[k] = lesser(ratio, stroke.ratio[k]);
        }
    }

    /// Gives the samples of a cell that the segment covers its colour where its ratio is the least so far.
    #[inline(always)]
    pub(super) fn shade(&self, cell: Cell, stroke: &mut Shaded) {
        let covered = cell.lanes(&self.covered);
        let (x, y) = (self.x.of(cell), self.y.of(cell));
        let (mut u, mut wins) = ([0.0; LANES], covered);
        for k in 0..LANES {
            let (at, ratio) = self.shape.sweep.attribute_point(x[k], y[k]);
            // A covered sample has a colour, even at a tip that is a point.
            let ratio = select(ratio < f32::MAX, ratio, f32::MAX);
            let is_less = (covered[k] != 0) & (ratio < stroke.ratio[k]);
            u[k] = at;
            wins[k] = select(is_less, u32::MAX, 0);
            stroke.ratio[k] = select(is_less, ratio, stroke.ratio[k]);
        }
        for (color, ramp) in stroke.color.iter_mut().zip(&self.shape.color) {
            let mut new = [0.0; LANES];
            for k in 0..LANES {
                new[k] = ramp.at(u[k]);
            }
            overwrite(color, &new, &wins);
        }
    }
}

impl Placed {
    /// Where on its axis, and where across it, the samples of a cell lie that the segment covers, where its ratio is the least so far:
    /// of the same axis points as [`Self::shade`] takes colours from, which are found as well where they are `COLORED`.
    #[inline(always)]
    pub(super) fn find_place<const COLORED: bool>(&self, cell: Cell, places: &mut Places) {
        let covered = cell.lanes(&self.covered);
        let (x, y) = (self.x.of(cell), self.y.of(cell));
        // Seen from root to tip, whichever end is larger.
        let Shape { sweep, way, .. } = &self.shape;
        let side = select((way.rise < 0.0) & sweep.has_direction(), -1.0, 1.0);
        let mut index = places.index;
        let (mut u, mut wins) = ([0.0; LANES], covered);
        for k in 0..LANES {
            let (at, ratio) = sweep.attribute_point(x[k], y[k]);
            let ratio = select(ratio < f32::MAX, ratio, f32::MAX);
            let is_less = (covered[k] != 0) & (ratio < places.ratio[k]);
            u[k] = at;
            wins[k] = select(is_less, u32::MAX, 0);
            index[k] = select(is_less, self.index, index[k]);
            places.ratio[k] = select(is_less, ratio, places.ratio[k]);
            places.way[k] = select(is_less, way.at(at), places.way[k]);
            let is_nearer = (covered[k] != 0) & (ratio < places.side_ratio[k] * NEARER);
            places.side[k] = select(is_nearer, select(y[k] < 0.0, -side, side), places.side[k]);
            places.side_ratio[k] = select(is_nearer, ratio, places.side_ratio[k]);
        }
        places.index = index;
        if COLORED {
            for (color, ramp) in places.color.iter_mut().zip(&self.shape.color) {
                let mut new = [0.0; LANES];
                for k in 0..LANES {
                    new[k] = ramp.at(u[k]);
                }
                overwrite(color, &new, &wins);
            }
        }
    }
}

/// The axis points of a stroke that samples of a cell lie beside.
pub(super) struct Places {
    /// The segments, by their places in the list.
    pub(super) index: [u32; LANES],
    /// The way from the segment's first joint to the next.
    pub(super) way: Lanes,
    /// The stroke's colours there, where they are asked for.
    pub(super) color: [Lanes; 3],
    /// The square of distance over radius; infinite where no segment covers the sample.
    ratio: Lanes,
    /// 1 to the right of who walks from root to tip, else -1; and the ratio of the segment that says so.
    side: Lanes,
    side_ratio: Lanes,
}

/// A later segment says on which side a sample lies only where its ratio is less by this factor: around a joint, where a stroke turns back, two
/// segments are equally near and may see the sample on other sides, which rounding must not decide.
const NEARER: f32 = 0.999;

impl Places {
    #[inline(always)]
    pub(super) fn new() -> Self {
        Self {
            index: [0; LANES],
            way: [0.0; LANES],
            color: [[0.0; LANES]; 3],
            ratio: [f32::INFINITY; LANES],
            side: [1.0; LANES],
            side_ratio: [f32::INFINITY; LANES],
        }
    }

    /// Places across the stroke, -1 to 1.
    #[inline(always)]
    pub(super) fn across(&self) -> Lanes {
        let mut across = self.side;
        for k in 0..LANES {
            across[k] *= lesser(self.ratio[k], 1.0).sqrt();
        }
        across
    }
}

/// What a stroke's segments that cover the samples of a cell come to.
pub(super) struct Measured {
    /// The nearest, 1/m; [`NOTHING`] where none covers the sample.
    pub(super) inv_depth: Lanes,
    pub(super) biased: Lanes,
    /// The least square of distance over radius, at most 1.
    pub(super) ratio: Lanes,
}

impl Measured {
    #[inline(always)]
    pub(super) fn new() -> Self {
        Self {
            inv_depth: [NOTHING; LANES],
            biased: [NOTHING; LANES],
            ratio: [1.0; LANES],
        }
    }
}

/// The colours of a stroke at the samples of a cell, and the ratios at which they were found.
pub(super) struct Shaded {
    ratio: Lanes,
    pub(super) color: [Lanes; 3],
}

impl Shaded {
    #[inline(always)]
    pub(super) fn new() -> Self {
        Self {
            ratio: [f32::INFINITY; LANES],
            color: [[0.0; LANES]; 3],
        }
    }
}
