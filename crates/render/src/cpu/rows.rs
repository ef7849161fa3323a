//! Which samples of a tile a segment covers: one run of columns in each row of samples.
//!
//! A swept segment is the convex hull of its two discs, so each row of samples meets it in one
//! interval. Its ends are the least and the greatest of where the row meets the discs and the two
//! outer tangents between them. That is a few operations a row in place of some for each sample, and
//! the interval's columns are the bits of one word.
//!
//! Between half discs it is the hull of these, again convex.

use super::tile::{LANES, Lanes, Mask, ROWS, STACK, Stack, WIDTH, greater, lesser, select};
use glam::{DVec2, Vec2};
use std::ops::Range;
use stroke_path::sweep::{FlatEnd, Sweep};

/// A disc, from the tile's corner.
#[derive(Clone, Copy)]
struct Disc {
    center: Vec2,
    radius: f32,
}

/// A straight part of the outline, such as an outer tangent from where it touches one disc to where it
/// touches the other.
#[derive(Clone, Copy)]
struct Tangent {
    start: Vec2,
    /// How far it goes to the right for each pixel down; 0 for a level one, which has but one row.
    slope: f32,
    top: f32,
    bottom: f32,
}

impl Tangent {
    /// No line at all.
    const NONE: Self = Self {
        start: Vec2::ZERO,
        slope: 0.0,
        top: f32::INFINITY,
        bottom: f32::NEG_INFINITY,
    };

    #[inline(always)]
    fn new(start: Vec2, end: Vec2) -> Self {
        let along = end - start;
        Self {
            start,
            slope: select(along.y == 0.0, 0.0, along.x / along.y),
            top: lesser(start.y, end.y),
            bottom: greater(start.y, end.y),
        }
    }
}

/// The points that lie not ahead of `point` in the direction `ahead`.
#[derive(Clone, Copy)]
struct HalfPlane {
    point: Vec2,
    ahead: Vec2,
}

/// The interval of x of each of some rows; empty where the least is above the greatest.
struct Intervals {
    least: Lanes,
    greatest: Lanes,
}

impl Intervals {
    #[inline(always)]
    fn add_disc(&mut self, disc: &Disc, y: &Lanes) {
        for k in 0..LANES {
            let dy = y[k] - disc.center.y;
            // Written so that nothing cancels at the top and the bottom.
            let square = (disc.radius - dy) * (disc.radius + dy);
            let half = select(square > 0.0, square, 0.0).sqrt();
            let (left, right) = (disc.center.x - half, disc.center.x + half);
            self.least[k] = lesser(select(square >= 0.0, left, f32::INFINITY), self.least[k]);
            self.greatest[k] = greater(
                select(square >= 0.0, right, f32::NEG_INFINITY),
                self.greatest[k],
            );
        }
    }

    /// All of the tangent is part of the hull, so it may widen both ends.
    #[inline(always)]
    fn add_tangent(&mut self, tangent: &Tangent, y: &Lanes) {
        for k in 0..LANES {
            // Kept between the ends, so that a flat tangent's steep slope can't lead astray.
            let beside = lesser(greater(y[k], tangent.top), tangent.bottom);
            let is_beside = beside == y[k];
            let x = tangent.start.x + (beside - tangent.start.y) * tangent.slope;
            self.least[k] = lesser(select(is_beside, x, f32::INFINITY), self.least[k]);
            self.greatest[k] = greater(select(is_beside, x, f32::NEG_INFINITY), self.greatest[k]);
        }
    }

    /// Leaves what lies in the half-plane.
    #[inline(always)]
    fn clip(&mut self, half_plane: &HalfPlane, y: &Lanes) {
        let HalfPlane { point, ahead } = half_plane;
        for k in 0..LANES {
            let over = (y[k] - point.y) * ahead.y;
            let x = point.x - over / ahead.x;
            let least = select(ahead.x < 0.0, greater(self.least[k], x), self.least[k]);
            let greatest = select(ahead.x > 0.0, lesser(self.greatest[k], x), self.greatest[k]);
            // A row along the edge is in it or not.
            let is_empty = (least > greatest) | ((ahead.x == 0.0) & (over > 0.0));
            self.least[k] = select(is_empty, f32::INFINITY, least);
            self.greatest[k] = select(is_empty, f32::NEG_INFINITY, greatest);
        }
    }

    /// The columns whose samples, `offset` to the right of them, lie in the intervals; ends included.
    #[inline(always)]
    fn columns(&self, offset: &Lanes) -> [u32; LANES] {
        let mut columns = [0; LANES];
        for k in 0..LANES {
            let from = greater(self.least[k] - offset[k], 0.0);
            let from = lesser(from, WIDTH as f32);
            let to = lesser(self.greatest[k] - offset[k], (WIDTH - 1) as f32);
            let to = greater(to, -1.0);
            let ((first, at_first), (last, at_last)) = (round(from), round(to));
            let first = first + select(at_first < from, 1, 0);
            let end = last + select(at_last > to, 0, 1);
            columns[k] = lowest(end) & !lowest(first);
        }
        columns
    }
}

/// The nearest whole number, also as a float, of a small number that is finite.
///
/// By the sum with a number whose last bit is 1: a cast would look for infinities, and keep the loop
/// from compiling to vector instructions.
#[inline(always)]
fn round(value: f32) -> (i32, f32) {
    const WHOLE: f32 = 8_388_608.0 + 64.0;
    let sum = value + WHOLE;
    (sum.to_bits() as i32 - WHOLE.to_bits() as i32, sum - WHOLE)
}

/// The lowest `number` bits, of 0 to 32.
#[inline(always)]
fn lowest(number: i32) -> u32 {
    let some = 1_u32.wrapping_shl(number as u32).wrapping_sub(1);
    select(number >= 32, u32::MAX, some)
}

/// Rows of stacks whose samples are worked on at once.
pub(super) const ROWS_AT_ONCE: usize = LANES / STACK;

/// Sets the bits of the open samples in the tile at `origin` that the segment covers: `open` are columns of each row of stacks, and those that the
/// segment may reach. Only `rows` are looked at, which begin and end at multiples of [`ROWS_AT_ONCE`].
#[inline(always)]
pub(super) fn cover(
    sweep: &Sweep,
    origin: DVec2,
    rows: &Range<usize>,
    (open, reached): (&[u32; ROWS], u32),
    stack: &Stack,
    mask: &mut Mask,
) {
    let discs = sweep.ends().map(|(center, radius)| Disc {
        // From double precision, so that long strokes stay exact in every tile.
        center: (center - origin).as_vec2(),
        radius,
    });
    let outline = Outline::new(sweep, discs);
    let mut offset = [0.0; LANES];
    for k in 0..LANES {
        offset[k] = stack.x[k % STACK];
    }
    for first in rows.clone().step_by(ROWS_AT_ONCE) {
        let open = &open[first..first + ROWS_AT_ONCE];
        if open.iter().all(|open| open & reached == 0) {
            continue;
        }
        let mut y = [0.0; LANES];
        for k in 0..LANES {
            y[k] = ((first + k / STACK) * stack.height) as f32 + stack.y[k % STACK];
        }
        let words = &mut mask[first * STACK..][..LANES];
        let columns = outline.intervals(&y).columns(&offset);
        for k in 0..LANES {
            words[k] = columns[k] & open[k / STACK];
        }
    }
}

/// What bounds a segment.
enum Outline {
    /// The hull of two discs; the tangents are none where one disc holds the other. Of half discs that
    /// run to the larger it is what lies behind that one's centre.
    Discs([Disc; 2], [Tangent; 2], Option<HalfPlane>),
    /// Half a disc, and the trapezoid from there to the end of the smaller half disc.
    HalfDisc(Disc, HalfPlane, [Tangent; 3]),
}

impl Outline {
    /// `discs` are the larger and the smaller.
    #[inline(always)]
    fn new(sweep: &Sweep, discs: [Disc; 2]) -> Self {
        let axis = sweep.axis();
        let touch = |disc: &Disc, normal: Vec2| disc.center + disc.radius * normal;
        let behind = |ahead: Vec2| HalfPlane {
            point: discs[0].center,
            ahead,
        };
        if sweep.flat_end() == FlatEnd::Smaller {
            let across = axis.perp();
            let side = |normal: Vec2| [touch(&discs[0], normal), touch(&discs[1], normal)];
            let ([a, b], [c, d]) = (side(across), side(-across));
            let edges = [Tangent::new(a, b), Tangent::new(c, d), Tangent::new(b, d)];
            return Self::HalfDisc(discs[0], behind(axis), edges);
        }
        let tangents = match sweep.tangent_normals() {
            Some(normals) => normals
                .map(|normal| Tangent::new(touch(&discs[0], normal), touch(&discs[1], normal))),
            None => [Tangent::NONE; 2],
        };
        let flat = (sweep.flat_end() == FlatEnd::Larger).then(|| behind(-axis));
        Self::Discs(discs, tangents, flat)
    }

    #[inline(always)]
    fn intervals(&self, y: &Lanes) -> Intervals {
        let mut intervals = Intervals {
            least: [f32::INFINITY; LANES],
            greatest: [f32::NEG_INFINITY; LANES],
        };
        match self {
            Self::Discs(discs, tangents, flat) => {
                intervals.add_disc(&discs[0], y);
                intervals.add_disc(&discs[1], y);
                intervals.add_tangent(&tangents[0], y);
                intervals.add_tangent(&tangents[1], y);
                if let Some(half_plane) = flat {
                    intervals.clip(half_plane, y);
                }
            }
            Self::HalfDisc(disc, half_plane, edges) => {
                intervals.add_disc(disc, y);
                intervals.clip(half_plane, y);
                for edge in edges {
                    intervals.add_tangent(edge, y);
                }
            }
        }
        intervals
    }
}
