//! One segment in one tile: which samples it covers, how near, in which colour.

use super::bin::Bounds;
use super::segment::Segment;
use super::tile::{LANE, LANES, Lanes, NOTHING, Plane, Slope, overwrite, row_start, select};
use glam::{DVec2, Vec2};
use std::ops::Range;

/// Room for rounding in a row's span, in pixels.
const MARGIN: f32 = 0.02;
/// Below this an edge's normal is taken as upright: it then bounds rows, not columns.
const UPRIGHT: f64 = 1e-3;

/// A limit of a row's columns: a pixel's column is at most, or at least, `base + slope * row`.
#[derive(Clone, Copy, Debug)]
struct Limit {
    base: f32,
    slope: f32,
}

/// A segment seen from a tile.
pub(super) struct Placed<'a> {
    segment: &'a Segment,
    bounds: Bounds,
    /// The segment's frame.
    x: Slope,
    y: Slope,
    least: [Limit; 4],
    most: [Limit; 4],
}

impl<'a> Placed<'a> {
    /// `bounds` is the segment's part of the tile, `origin` the tile's upper left pixel.
    pub(super) fn new(segment: &'a Segment, bounds: Bounds, origin: [usize; 2]) -> Self {
        let origin = DVec2::new(origin[0] as f64, origin[1] as f64);
        // From double precision, so that long strokes stay exact in every tile.
        let corner = segment.sweep.local(origin).as_vec2();
        let axis = segment.sweep.axis();
        let mut least = [Limit::at(f32::MIN); 4];
        let mut most = [Limit::at(f32::MAX); 4];
        for (i, (normal, offset)) in segment.sweep.half_planes().into_iter().enumerate() {
            // A pixel may be covered if its nearest corner to the half-plane lies in it.
            let offset = offset - normal.dot(origin) - normal.y.min(0.0);
            let limit = Limit {
                base: (offset / normal.x) as f32,
                slope: (-normal.y / normal.x) as f32,
            };
            if normal.x > UPRIGHT {
                most[i] = limit;
            } else if normal.x < -UPRIGHT {
                least[i] = limit;
            }
        }
        Self {
            segment,
            bounds,
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
            least,
            most,
        }
    }

    /// The chunks of a row in which the segment may cover something.
    #[inline]
    fn chunks(&self, row: usize) -> Range<usize> {
        let row = row as f32;
        let at = |limit: &Limit| limit.base + limit.slope * row;
        let least = self.least.iter().map(at).fold(f32::MIN, f32::max);
        let most = self.most.iter().map(at).fold(f32::MAX, f32::min);
        // Casts saturate, and send what is below the first column to it.
        let first = ((least - MARGIN) as usize).max(self.bounds.x.start);
        let most = most + MARGIN;
        if most < 0.0 {
            return 0..0;
        }
        let end = (most as usize).saturating_add(1).min(self.bounds.x.end);
        if first >= end {
            return 0..0;
        }
        first / LANES..end.div_ceil(LANES)
    }

    /// Calls with the index of each chunk that may be covered, and its lanes' places in the segment's
    /// frame.
    #[inline]
    fn for_each_chunk(&self, samples: &[Vec2], mut visit: impl FnMut(usize, &Lanes, &Lanes)) {
        for row in self.bounds.y.clone() {
            let chunks = self.chunks(row);
            for (sample, offset) in samples.iter().enumerate() {
                let start = row_start(sample, row);
                for chunk in chunks.clone() {
                    let first = *offset + Vec2::new((chunk * LANES) as f32, row as f32);
                    let (x0, y0) = (self.x.at(first), self.y.at(first));
                    let (mut x, mut y) = ([x0; LANES], [y0; LANES]);
                    for k in 0..LANES {
                        x[k] += LANE[k] * self.x.per_x;
                        y[k] += LANE[k] * self.y.per_x;
                    }
                    visit(start + chunk, &x, &y);
                }
            }
        }
    }

    /// Raises both inverse depths of the covered samples to the segment's own.
    pub(super) fn measure(&self, samples: &[Vec2], depths: &mut Depths) {
        let Segment {
            sweep,
            inv_depth,
            inv_depth_biased,
            ..
        } = *self.segment;
        self.for_each_chunk(samples, |cell, x, y| {
            let mut near = depths.inv_depth[cell];
            let mut near_biased = depths.biased[cell];
            for k in 0..LANES {
                let covered = sweep.covers(x[k], y[k]);
                let (low, high) = sweep.interval(x[k], y[k]);
                // Linear, so the greatest is at one of the ends.
                let depth = greater(inv_depth.at(low), inv_depth.at(high));
                let biased = greater(inv_depth_biased.at(low), inv_depth_biased.at(high));
                near[k] = greater(select(covered, depth, NOTHING), near[k]);
                near_biased[k] = greater(select(covered, biased, NOTHING), near_biased[k]);
            }
            depths.inv_depth[cell] = near;
            depths.biased[cell] = near_biased;
        });
    }

    /// Sets the ratio of the covered samples to 0: enough where the whole stroke has one colour.
    pub(super) fn cover(&self, samples: &[Vec2], ratio: &mut Plane) {
        let sweep = self.segment.sweep;
        self.for_each_chunk(samples, |cell, x, y| {
            let mut least = ratio[cell];
            for k in 0..LANES {
                least[k] = select(sweep.covers(x[k], y[k]), 0.0, least[k]);
            }
            ratio[cell] = least;
        });
    }

    /// Gives the covered samples the segment's colour where its ratio is the least so far.
    pub(super) fn shade(&self, samples: &[Vec2], ratio: &mut Plane, color: &mut [Plane; 3]) {
        let sweep = self.segment.sweep;
        self.for_each_chunk(samples, |cell, x, y| {
            let old = ratio[cell];
            let (mut u, mut least, mut wins) = ([0.0; LANES], old, [0.0; LANES]);
            for k in 0..LANES {
                let (at, ratio) = sweep.attribute_point(x[k], y[k]);
                let ratio = select(sweep.covers(x[k], y[k]), ratio, f32::INFINITY);
                u[k] = at;
                wins[k] = select(ratio < old[k], 1.0, 0.0);
                least[k] = select(ratio < old[k], ratio, old[k]);
            }
            ratio[cell] = least;
            for (plane, ramp) in color.iter_mut().zip(self.segment.color) {
                overwrite(&mut plane[cell], &u.map(|u| ramp.at(u)), &wins);
            }
        });
    }
}

impl Limit {
    fn at(base: f32) -> Self {
        Self { base, slope: 0.0 }
    }
}

/// The nearest of a stroke at each sample, 1/m; [`NOTHING`] where it isn't.
pub(super) struct Depths {
    pub(super) inv_depth: Plane,
    pub(super) biased: Plane,
}

#[inline]
fn greater(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}
