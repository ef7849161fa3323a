//! One segment in one tile: which samples it covers, how near, in which colour.

use super::context::TileContext;
use super::rows::{self, ROWS_AT_ONCE};
use super::segment::Shape;
use super::tile::{
    Cell, LANES, LaneMask, Lanes, Mask, NO_SAMPLES, NOTHING, ROWS, Samples, Slope, add, any,
    greater, lesser, overwrite, select,
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
    pub(super) x: Samples,
    pub(super) y: Samples,
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
        let columns = segment.bounds.columns_in(origin[0]);
        if reached & columns == 0 {
            return None;
        }
        let rows =
            rows.start / ROWS_AT_ONCE * ROWS_AT_ONCE..rows.end.next_multiple_of(ROWS_AT_ONCE);
        let shape = segment.shape(scene.drawing, scene.strokes)?;
        let origin = DVec2::new(origin[0] as f64, origin[1] as f64);
        let mut covered = NO_SAMPLES;
        rows::cover(
            &shape.sweep,
            origin,
            &rows,
            (open, columns),
            stack,
            &mut covered,
        );
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

    /// Adds those of some segments that cover any open samples to `placed`, and gives these.
    #[inline(always)]
    pub(super) fn add_all(
        scene: &TileContext,
        segments: &[u32],
        open: &[u32; ROWS],
        placed: &mut Vec<Self>,
    ) -> Mask {
        let mut samples = NO_SAMPLES;
        for &index in segments {
            if let Some(segment) = Self::new(scene, index, open) {
                add(&mut samples, &segment.covered);
                placed.push(segment);
            }
        }
        samples
    }

    /// The samples of a cell in its frame.
    #[inline(always)]
    pub(super) fn at(&self, cell: Cell) -> InFrame {
        InFrame {
            covered: cell.lanes(&self.covered),
            x: self.x.of(cell),
            y: self.y.of(cell),
        }
    }
}

/// The axis point of a segment that is the nearest to each sample of a cell: the square of distance over radius, and what is there.
pub(super) struct Beside {
    pub(super) ratio: Lanes,
    pub(super) inv_depth: Lanes,
    pub(super) color: [Lanes; 3],
}

impl Placed {
    #[inline(always)]
    pub(super) fn beside(&self, cell: Cell) -> Beside {
        let (x, y) = (self.x.of(cell), self.y.of(cell));
        let Shape {
            sweep,
            inv_depth,
            color: [red, green, blue],
            ..
        } = &self.shape;
        let (mut ratio, mut depth, mut color) = ([0.0; LANES], [0.0; LANES], [[0.0; LANES]; 3]);
        for k in 0..LANES {
            let (u, square) = sweep.attribute_point(x[k], y[k]);
            ratio[k] = select(square < f32::MAX, square, f32::MAX);
            depth[k] = inv_depth.at(u);
            color[0][k] = red.at(u);
            color[1][k] = green.at(u);
            color[2][k] = blue.at(u);
        }
        Beside {
            ratio,
            inv_depth: depth,
            color,
        }
    }
}

impl Placed {
    /// The way from the segment's first joint to the next at the axis points that are the nearest to the samples of a cell, and the samples' sides:
    /// 1 to the right of who walks from root to tip, else -1.
    #[inline(always)]
    pub(super) fn place(&self, cell: Cell) -> (Lanes, Lanes) {
        let (x, y) = (self.x.of(cell), self.y.of(cell));
        let Shape { sweep, way, .. } = &self.shape;
        let side = select((way.rise < 0.0) & sweep.has_direction(), -1.0, 1.0);
        let (mut ways, mut sides) = ([0.0; LANES], [0.0; LANES]);
        for k in 0..LANES {
            let (u, _) = sweep.attribute_point(x[k], y[k]);
            ways[k] = way.at(u);
            sides[k] = select(y[k] < 0.0, -side, side);
        }
        (ways, sides)
    }
}

/// Samples in a segment's frame, and those that it covers.
pub(super) struct InFrame {
    pub(super) covered: LaneMask,
    pub(super) x: Lanes,
    pub(super) y: Lanes,
}

/// How near a stroke is at the samples of a cell, 1/m; [`NOTHING`] where no segment of it covers them.
pub(super) struct Depths {
    pub(super) inv_depth: Lanes,
    pub(super) biased: Lanes,
}

impl Depths {
    #[inline(always)]
    pub(super) fn new() -> Self {
        Self {
            inv_depth: [NOTHING; LANES],
            biased: [NOTHING; LANES],
        }
    }

    /// Takes on a segment's where they are nearer.
    #[inline(always)]
    pub(super) fn offer(&mut self, segment: &Placed, at: &InFrame) {
        let Shape {
            sweep,
            inv_depth,
            inv_depth_biased,
            ..
        } = &segment.shape;
        for k in 0..LANES {
            let is_covered = at.covered[k] != 0;
            let (low, high) = sweep.interval(at.x[k], at.y[k]);
            // Linear, so the greatest is at one of the ends.
            let depth = greater(inv_depth.at(low), inv_depth.at(high));
            let biased = greater(inv_depth_biased.at(low), inv_depth_biased.at(high));
            let depth = select(is_covered, depth, NOTHING);
            self.inv_depth[k] = greater(depth, self.inv_depth[k]);
            let biased = select(is_covered, biased, NOTHING);
            self.biased[k] = greater(biased, self.biased[k]);
        }
    }

    /// Whether a segment may have a disc that is nearer at some samples.
    #[inline(always)]
    pub(super) fn may_gain(&self, segment: &Placed, at: &InFrame, samples: &LaneMask) -> bool {
        let inv_depth = segment.shape.inv_depth.greatest();
        let biased = segment.shape.inv_depth_biased.greatest();
        let mut gains = at.covered;
        for k in 0..LANES {
            let is_nearer = (inv_depth > self.inv_depth[k]) | (biased > self.biased[k]);
            gains[k] &= samples[k] & select(is_nearer, u32::MAX, 0);
        }
        any(&gains)
    }
}

/// What is known of the axis points that are the nearest to the samples of a cell: those of the least ratio, the square of distance over radius.
pub(super) trait Nearest {
    /// Takes on what a segment has at those that it covers, where its ratio is less.
    fn offer(&mut self, segment: &Placed, at: &InFrame);
    /// The least ratios so far; infinite where no segment covers the sample.
    fn ratios(&self) -> &Lanes;
    /// Whether a segment may make a difference at some samples, where those `known` are offered too: at a distance `d` from its axis a ratio is at
    /// least (d / radius)^2. `slack` is that of the segments ([`slack`]).
    #[inline(always)]
    fn may_gain(
        &self,
        known: &Ratios,
        segment: &Placed,
        at: &InFrame,
        samples: &LaneMask,
        slack: f32,
    ) -> bool {
        let (length, radius) = (segment.shape.sweep.length(), segment.shape.sweep.radius());
        let most = slack * radius * radius;
        let mut gains = at.covered;
        for k in 0..LANES {
            let beyond = greater(greater(-at.x[k], at.x[k] - length), 0.0);
            let square = beyond * beyond + at.y[k] * at.y[k];
            let ratio = lesser(known.0[k], self.ratios()[k]);
            gains[k] &= samples[k] & select(square <= ratio * most, u32::MAX, 0);
        }
        any(&gains)
    }
}

/// Ratios that are larger by less than this factor may still make a difference, where so many segments are offered: each may have kept the one
/// before it from deciding on which side of a stroke a sample lies ([`NEARER`]). And a lesser ratio may have been rounded up.
#[inline(always)]
pub(super) fn slack(segments: usize) -> f32 {
    const ROUNDED: f32 = 1.02;
    const MOST: usize = 10_000; // still a number
    ROUNDED * (1.0 / NEARER).powi(segments.min(MOST) as i32)
}

/// Nothing is asked.
pub(super) struct Unasked;

impl Nearest for Unasked {
    #[inline(always)]
    fn offer(&mut self, _: &Placed, _: &InFrame) {}

    #[inline(always)]
    fn ratios(&self) -> &Lanes {
        &[0.0; LANES]
    }

    #[inline(always)]
    fn may_gain(&self, _: &Ratios, _: &Placed, _: &InFrame, _: &LaneMask, _: f32) -> bool {
        false
    }
}

/// Their ratios alone.
pub(super) struct Ratios(Lanes);

impl Ratios {
    #[inline(always)]
    pub(super) fn new() -> Self {
        Self([f32::INFINITY; LANES])
    }
}

impl Nearest for Ratios {
    #[inline(always)]
    fn offer(&mut self, segment: &Placed, at: &InFrame) {
        for k in 0..LANES {
            let (_, ratio) = segment.shape.sweep.attribute_point(at.x[k], at.y[k]);
            let ratio = select(at.covered[k] != 0, ratio, f32::INFINITY);
            self.0[k] = lesser(ratio, self.0[k]);
        }
    }

    #[inline(always)]
    fn ratios(&self) -> &Lanes {
        &self.0
    }
}

/// Their colours.
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

impl Nearest for Shaded {
    #[inline(always)]
    fn offer(&mut self, segment: &Placed, at: &InFrame) {
        let (mut u, mut wins) = ([0.0; LANES], at.covered);
        for k in 0..LANES {
            let (at_u, ratio) = segment.shape.sweep.attribute_point(at.x[k], at.y[k]);
            // A covered sample has a colour, even at a tip that is a point.
            let ratio = select(ratio < f32::MAX, ratio, f32::MAX);
            let is_less = (at.covered[k] != 0) & (ratio < self.ratio[k]);
            u[k] = at_u;
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
    fn offer(&mut self, segment: &Placed, at: &InFrame) {
        // Seen from root to tip, whichever end is larger.
        let Shape { sweep, way, .. } = &segment.shape;
        let side = select((way.rise < 0.0) & sweep.has_direction(), -1.0, 1.0);
        let mut index = self.index;
        let (mut u, mut wins) = ([0.0; LANES], at.covered);
        for k in 0..LANES {
            let (at_u, ratio) = sweep.attribute_point(at.x[k], at.y[k]);
            let ratio = select(ratio < f32::MAX, ratio, f32::MAX);
            let is_covered = at.covered[k] != 0;
            let is_less = is_covered & (ratio < self.ratio[k]);
            u[k] = at_u;
            wins[k] = select(is_less, u32::MAX, 0);
            index[k] = select(is_less, segment.index, index[k]);
            self.ratio[k] = select(is_less, ratio, self.ratio[k]);
            self.way[k] = select(is_less, way.at(at_u), self.way[k]);
            let is_nearer = is_covered & (ratio < self.side_ratio[k] * NEARER);
            let own = select(at.y[k] < 0.0, -side, side);
            self.side[k] = select(is_nearer, own, self.side[k]);
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
pub(super) const NEARER: f32 = 0.999;

/// Places across a stroke, -1 to 1, of samples on these sides of it and with these squares of distance over radius.
#[inline(always)]
pub(super) fn across(side: &Lanes, ratio: &Lanes) -> Lanes {
    let mut across = *side;
    for k in 0..LANES {
        across[k] *= lesser(ratio[k], 1.0).sqrt();
    }
    across
}

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
        across(&self.side, &self.ratio)
    }
}
