//! One segment in one tile: which samples it covers, how near, in which colour.

use super::rows::{self, ROWS_AT_ONCE};
use super::segment::Shape;
use super::strand::TileContext;
use super::tile::{
    Cell, LANES, LaneMask, Lanes, Mask, NO_SAMPLES, NOTHING, ROWS, STACK, Samples, Slope, greater,
    least_of, lesser, overwrite, select,
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

    /// The segment's frame: along its axis, and across.
    #[inline(always)]
    pub(super) fn frame(&self) -> [&Samples; 2] {
        [&self.x, &self.y]
    }

    /// Brings the segment's depth at the samples of a cell that it covers into that of its stroke; its ratio too where it is `ROUND`.
    #[inline(always)]
    pub(super) fn measure<const ROUND: bool>(&self, cell: Cell, stroke: &mut Measured) {
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
            let depth = select(is_covered, depth, NOTHING);
            stroke.inv_depth[k] = greater(depth, stroke.inv_depth[k]);
            let biased = select(is_covered, biased, NOTHING);
            stroke.biased[k] = greater(biased, stroke.biased[k]);
            if ROUND {
                let (_, ratio) = sweep.attribute_point(x[k], y[k]);
                let ratio = select(is_covered, ratio, 1.0);
                stroke.ratio[k] = lesser(ratio, stroke.ratio[k]);
            }
        }
    }

    /// The squares of distance over radius at the samples of a cell; infinite where it doesn't cover them.
    #[inline(always)]
    pub(super) fn ratios(&self, cell: Cell) -> Lanes {
        let covered = cell.lanes(&self.covered);
        let (x, y) = (self.x.of(cell), self.y.of(cell));
        let mut ratios = [0.0; LANES];
        for k in 0..LANES {
            let (_, ratio) = self.shape.sweep.attribute_point(x[k], y[k]);
            ratios[k] = select(covered[k] != 0, ratio, f32::INFINITY);
        }
        ratios
    }
}

/// What is known of the nearest axis points of a stroke's segments to the samples of a cell.
pub(super) trait Nearest {
    /// Takes on what the segment has at those that it covers, where its ratio is the least so far.
    fn offer(&mut self, segment: &Placed, cell: Cell);
    /// The least so far.
    fn ratios(&self) -> &Lanes;
}

impl Nearest for Measured {
    #[inline(always)]
    fn offer(&mut self, segment: &Placed, cell: Cell) {
        let ratios = segment.ratios(cell);
        for k in 0..LANES {
            self.ratio[k] = lesser(ratios[k], self.ratio[k]);
        }
    }

    #[inline(always)]
    fn ratios(&self) -> &Lanes {
        &self.ratio
    }
}

impl Nearest for Shaded {
    #[inline(always)]
    fn offer(&mut self, segment: &Placed, cell: Cell) {
        let covered = cell.lanes(&segment.covered);
        let (x, y) = (segment.x.of(cell), segment.y.of(cell));
        let (mut u, mut wins) = ([0.0; LANES], covered);
        for k in 0..LANES {
            let (at, ratio) = segment.shape.sweep.attribute_point(x[k], y[k]);
            // A covered sample has a colour, even at a tip that is a point.
            let ratio = select(ratio < f32::MAX, ratio, f32::MAX);
            let is_less = (covered[k] != 0) & (ratio < self.ratio[k]);
            u[k] = at;
            wins[k] = select(is_less, u32::MAX, 0);
            self.ratio[k] = select(is_less, ratio, self.ratio[k]);
        }
        mix_colors(&segment.shape, &u, &wins, &mut self.color);
    }

    #[inline(always)]
    fn ratios(&self) -> &Lanes {
        &self.ratio
    }
}

/// Takes on a segment's colours at places of its axis.
#[inline(always)]
fn mix_colors(shape: &Shape, u: &Lanes, wins: &LaneMask, colors: &mut [Lanes; 3]) {
    for (color, ramp) in colors.iter_mut().zip(&shape.color) {
        let mut new = [0.0; LANES];
        for k in 0..LANES {
            new[k] = ramp.at(u[k]);
        }
        overwrite(color, &new, wins);
    }
}

impl<const COLORED: bool> Nearest for Places<COLORED> {
    #[inline(always)]
    fn offer(&mut self, segment: &Placed, cell: Cell) {
        let covered = cell.lanes(&segment.covered);
        let (x, y) = (segment.x.of(cell), segment.y.of(cell));
        // Seen from root to tip, whichever end is larger.
        let Shape { sweep, way, .. } = &segment.shape;
        let side = select((way.rise < 0.0) & sweep.has_direction(), -1.0, 1.0);
        let mut index = self.index;
        let (mut u, mut wins) = ([0.0; LANES], covered);
        for k in 0..LANES {
            let (at, ratio) = sweep.attribute_point(x[k], y[k]);
            let ratio = select(ratio < f32::MAX, ratio, f32::MAX);
            let is_less = (covered[k] != 0) & (ratio < self.ratio[k]);
            u[k] = at;
            wins[k] = select(is_less, u32::MAX, 0);
            index[k] = select(is_less, segment.index, index[k]);
            self.ratio[k] = select(is_less, ratio, self.ratio[k]);
            self.way[k] = select(is_less, way.at(at), self.way[k]);
            let is_nearer = (covered[k] != 0) & (ratio < self.side_ratio[k] * NEARER);
            self.side[k] = select(is_nearer, select(y[k] < 0.0, -side, side), self.side[k]);
            self.side_ratio[k] = select(is_nearer, ratio, self.side_ratio[k]);
        }
        self.index = index;
        if COLORED {
            mix_colors(&segment.shape, &u, &wins, &mut self.color);
        }
    }

    #[inline(always)]
    fn ratios(&self) -> &Lanes {
        &self.ratio
    }
}

/// The axis points of a stroke that samples of a cell lie beside: those of the least ratios, which [`Shaded`] takes colours from. Where they are
/// `COLORED`, they have these colours too.
pub(super) struct Places<const COLORED: bool> {
    /// The segments, by their places in the list.
    pub(super) index: [u32; LANES],
    /// The way from the segment's first joint to the next.
    pub(super) way: Lanes,
    /// The stroke's colours there.
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

impl<const COLORED: bool> Places<COLORED> {
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

    /// The farthest depths of some samples.
    #[inline(always)]
    pub(super) fn farthest(&self, samples: &LaneMask) -> [f32; 2] {
        [
            least_of(&self.inv_depth, samples),
            least_of(&self.biased, samples),
        ]
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
