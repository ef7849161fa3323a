//! One segment in one tile: which samples it covers, how near, in which colour.

use super::rows;
use super::segment::Segment;
use super::tile::{
    Cell, HEIGHT, LANE, LANES, Lanes, Mask, NO_SAMPLES, NOTHING, Plane, Slope, Target, both, cells,
    greater, has, overwrite, select,
};
use glam::{DVec2, Vec2};

/// A segment seen from a tile.
pub(super) struct Placed {
    /// Its place in the list of segments.
    pub(super) segment: u32,
    /// The samples that it covers.
    pub(super) covered: Mask,
    /// The segment's frame.
    x: Slope,
    y: Slope,
}

impl Placed {
    /// `origin` is the tile's upper left pixel. A segment that reaches none of the open samples covers nothing.
    #[inline(always)]
    pub(super) fn new(
        index: u32,
        segment: &Segment,
        origin: [usize; 2],
        samples: &[Vec2],
        open: &Mask,
    ) -> Self {
        let rows = segment.rows_in(origin[1]);
        let rows = rows.start / LANES * LANES..rows.end.next_multiple_of(LANES);
        let columns = segment.columns_in(origin[0]);
        let mut reached = 0;
        for sample in 0..samples.len() {
            for row in rows.clone() {
                reached |= open[sample * HEIGHT + row];
            }
        }
        let rows = select(reached & columns == 0, 0..0, rows);
        let origin = DVec2::new(origin[0] as f64, origin[1] as f64);
        let mut covered = NO_SAMPLES;
        rows::cover(segment, origin, &rows, samples, &mut covered);
        // From double precision, so that long strokes stay exact in every tile.
        let corner = segment.sweep.local(origin).as_vec2();
        let axis = segment.sweep.axis();
        Self {
            segment: index,
            covered,
            x: Slope {
                corner: corner.x,
                per_x: axis.x,
                per_y: axis.y,
            },
            y: Slope {
                corner: corner.y,
                per_x: -axis.y,
                per_y: axis.x,
            },
        }
    }

    /// The places of a cell's samples in the segment's frame.
    #[inline(always)]
    fn local(&self, samples: &[Vec2], cell: Cell) -> (Lanes, Lanes) {
        let (sample, row) = (cell.row / HEIGHT, cell.row % HEIGHT);
        let first = samples[sample] + Vec2::new(cell.column as f32, row as f32);
        let (x0, y0) = (self.x.at(first), self.y.at(first));
        let (mut x, mut y) = ([x0; LANES], [y0; LANES]);
        for k in 0..LANES {
            x[k] += LANE[k] * self.x.per_x;
            y[k] += LANE[k] * self.y.per_x;
        }
        (x, y)
    }

    /// Raises both inverse depths of some of the covered samples to the segment's own.
    #[inline(always)]
    pub(super) fn measure(
        &self,
        segment: &Segment,
        samples: &[Vec2],
        wanted: &Mask,
        depths: &mut Depths,
    ) {
        let Segment {
            sweep,
            inv_depth,
            inv_depth_biased,
            ..
        } = segment;
        for cell in cells(&both(&self.covered, wanted)) {
            let (x, y) = self.local(samples, cell);
            let mut near = depths.inv_depth[cell.index];
            let mut near_biased = depths.biased[cell.index];
            for k in 0..LANES {
                let (low, high) = sweep.interval(x[k], y[k]);
                // Linear, so the greatest is at one of the ends.
                let depth = greater(inv_depth.at(low), inv_depth.at(high));
                let biased = greater(inv_depth_biased.at(low), inv_depth_biased.at(high));
                let is_nearer = has(cell.bits, k) & (depth > near[k]);
                near[k] = select(is_nearer, depth, near[k]);
                let is_nearer = has(cell.bits, k) & (biased > near_biased[k]);
                near_biased[k] = select(is_nearer, biased, near_biased[k]);
            }
            depths.inv_depth[cell.index] = near;
            depths.biased[cell.index] = near_biased;
        }
    }

    /// Lowers the squares of distance over radius to the segment's own.
    #[inline(always)]
    pub(super) fn ratio(
        &self,
        segment: &Segment,
        samples: &[Vec2],
        wanted: &Mask,
        ratio: &mut Plane,
    ) {
        for cell in cells(&both(&self.covered, wanted)) {
            let (x, y) = self.local(samples, cell);
            let mut least = ratio[cell.index];
            for k in 0..LANES {
                let (_, ratio) = segment.sweep.attribute_point(x[k], y[k]);
                let is_less = has(cell.bits, k) & (ratio < least[k]);
                least[k] = select(is_less, ratio, least[k]);
            }
            ratio[cell.index] = least;
        }
    }

    /// Gives some of the covered samples the segment's colour where its ratio is the least so far.
    #[inline(always)]
    pub(super) fn shade(
        &self,
        segment: &Segment,
        samples: &[Vec2],
        wanted: &Mask,
        ratio: &mut Plane,
        color: &mut [Plane; 3],
    ) {
        for cell in cells(&both(&self.covered, wanted)) {
            let (x, y) = self.local(samples, cell);
            let mut least = ratio[cell.index];
            let (mut u, mut wins) = ([0.0; LANES], [0.0; LANES]);
            for k in 0..LANES {
                let (at, ratio) = segment.sweep.attribute_point(x[k], y[k]);
                // A covered sample has a colour, even at a tip that is a point.
                let ratio = select(ratio < f32::MAX, ratio, f32::MAX);
                let is_less = has(cell.bits, k) & (ratio < least[k]);
                u[k] = at;
                wins[k] = select(is_less, 1.0, 0.0);
                least[k] = select(is_less, ratio, least[k]);
            }
            ratio[cell.index] = least;
            for (plane, ramp) in color.iter_mut().zip(&segment.color) {
                let mut new = [0.0; LANES];
                for k in 0..LANES {
                    new[k] = ramp.at(u[k]);
                }
                overwrite(&mut plane[cell.index], &new, &wins);
            }
        }
    }
}

/// The nearest of a strand at each sample, 1/m; [`NOTHING`] where it isn't.
pub(super) struct Depths {
    pub(super) inv_depth: Plane,
    pub(super) biased: Plane,
}

impl Depths {
    /// Those of the samples that may show if they lie no nearer than this.
    #[inline(always)]
    pub(super) fn before(&self, samples: &Mask, target: &Target) -> Mask {
        target.before(samples, |cell| {
            (self.inv_depth[cell.index], self.biased[cell.index])
        })
    }

    /// Forgets the cells that hold one of the samples.
    #[inline(always)]
    pub(super) fn clear(&mut self, mask: &Mask) {
        for cell in cells(mask) {
            self.inv_depth[cell.index] = [NOTHING; LANES];
            self.biased[cell.index] = [NOTHING; LANES];
        }
    }
}
