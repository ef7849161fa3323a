//! Where strands go in a step by their own motion, and boxes and balls around that.
//!
//! Boxes and balls are in single precision, and larger by what that leaves out: they tell what is far off.

use glam::DVec3;

use crate::{
    forces::mutual::Course,
    lanes::{LANES, Lane, Number, Vec3},
    surroundings::Surroundings,
    threads::join,
};

use super::{
    super::{
        batch::{Batch, BatchState},
        drive::roots,
    },
    NEAR, Piece,
    meeting::TOUCH,
};

/// The most links of a piece.
pub(super) const PIECE: usize = 4;

/// Pieces that go farther than this against their roots in a step, in m, meet nothing: they would meet all hair there is.
const FARTHEST: f64 = 0.1;

/// What single precision may change a coordinate by, as a share of it.
const ROUNDING: f64 = 1.0 / (1 << 22) as f64;
/// A factor on a length in single precision that makes up for it.
const ROUNDED: f32 = 1.0 + 1e-6;

/// A box along the axes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bounds {
    pub low: [f32; 3],
    pub high: [f32; 3],
}

impl Bounds {
    /// Around nothing: it meets no other.
    pub(super) const NONE: Self = Self {
        low: [f32::INFINITY; 3],
        high: [f32::NEG_INFINITY; 3],
    };

    pub(super) fn and(&self, other: &Self) -> Self {
        Self {
            low: std::array::from_fn(|axis| self.low[axis].min(other.low[axis])),
            high: std::array::from_fn(|axis| self.high[axis].max(other.high[axis])),
        }
    }

    #[inline]
    pub(super) fn meets(&self, other: &Self) -> bool {
        self.meets_within(other, 0.0)
    }

    /// Whether they meet where one is larger by so much on all sides.
    #[inline]
    fn meets_within(&self, other: &Self, by: f32) -> bool {
        let meets = |axis: usize| {
            (self.low[axis] - other.high[axis] <= by) & (other.low[axis] - self.high[axis] <= by)
        };
        meets(0) && meets(1) && meets(2)
    }

    pub(super) fn larger_by(&self, by: f32) -> Self {
        Self {
            low: self.low.map(|low| low - by),
            high: self.high.map(|high| high + by),
        }
    }
}

/// What a piece sweeps in a step: a box around all that it may meet in it, as far as it is known by itself; and for what both of two pieces do, a box
/// around it half way through the step, its links there, its mean way, and how far the ways of its points are from that. Boxes have the lock's
/// radius.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sweep {
    pub bounds: Bounds,
    mid: Bounds,
    /// Coordinate by coordinate; of links that the piece has not NaN, which is near nothing.
    center: [[f32; PIECE]; 3],
    /// From there to the links' ends, half their lengths, and one over the squares of those.
    half: [[f32; PIECE]; 3],
    reach: [f32; PIECE],
    per_square: [f32; PIECE],
    /// The mean ways of the links, and how far those of their ends are from that.
    ways: [[f32; PIECE]; 3],
    spreads: [f32; PIECE],
    /// The lock's radius, and what comes to it.
    keep: f32,
    way: [f32; 3],
    spread: f32,
    /// How far it goes against its root, in m.
    pub own: f32,
}

impl Sweep {
    pub(super) const NONE: Self = Self {
        bounds: Bounds::NONE,
        mid: Bounds::NONE,
        center: [[f32::NAN; PIECE]; 3],
        half: [[0.0; PIECE]; 3],
        reach: [0.0; PIECE],
        per_square: [0.0; PIECE],
        ways: [[0.0; PIECE]; 3],
        spreads: [0.0; PIECE],
        keep: 0.0,
        way: [0.0; 3],
        spread: 0.0,
        own: 0.0,
    };

    /// How much farther than half way through the step two pieces may meet that keep `more` metres besides their radii (less, where it is below
    /// 0); None where they are too far from each other for that.
    #[inline]
    pub(super) fn farther(&self, other: &Self, more: f32) -> Option<f32> {
        let ([x, y, z], [ox, oy, oz]) = (self.way, other.way);
        let square = length_squared(x - ox, y - oy, z - oz);
        let against = square.sqrt() * ROUNDED + self.spread + other.spread;
        let farther = more + 0.5 * against + against.min(self.own + other.own);
        (self.mid.meets_within(&other.mid, farther)).then_some(farther)
    }

    /// Which of the other's links may meet a link, as bits, where both pieces keep `more` metres besides their radii, and may meet so much `farther`
    /// than half way through the step. It looks at balls around them first, then at each link and the balls of the other's.
    #[inline]
    pub(super) fn near(&self, link: usize, other: &Self, (more, farther): (f32, f32)) -> u32 {
        let at = |of: &[[f32; PIECE]; 3], i: usize| (of[0][i], of[1][i], of[2][i]);
        let keep = self.keep + other.keep;
        let ((x, y, z), long) = (at(&self.center, link), self.reach[link]);
        let mut is_near = [false; PIECE];
        for j in 0..PIECE {
            let (cx, cy, cz) = at(&other.center, j);
            let reach = other.reach[j] + long + (keep + farther);
            is_near[j] = length_squared(cx - x, cy - y, cz - z) <= reach * reach;
        }
        if is_near == [false; PIECE] {
            return 0;
        }
        let ((hx, hy, hz), per_square) = (at(&self.half, link), self.per_square[link]);
        let ((wx, wy, wz), spread) = (at(&self.ways, link), self.spreads[link]);
        let own = self.own + other.own;
        let (mut bits, mut keeps) = ([0_u32; PIECE], [0.0; PIECE]);
        for j in 0..PIECE {
            let (vx, vy, vz) = at(&other.ways, j);
            let against = length_squared(vx - wx, vy - wy, vz - wz).sqrt() * ROUNDED;
            let against = against + spread + other.spreads[j];
            let slower = if own < against { own } else { against };
            let keep = keep + more + 0.5 * against + slower;
            let (cx, cy, cz) = at(&other.center, j);
            let (x, y, z) = (cx - x, cy - y, cz - z);
            let along = ((x * hx + y * hy + z * hz) * per_square).clamp(-1.0, 1.0);
            let one = length_squared(x - hx * along, y - hy * along, z - hz * along);
            let (ix, iy, iz) = at(&other.half, j);
            let along = ((x * ix + y * iy + z * iz) * other.per_square[j]).clamp(-1.0, 1.0);
            let two = length_squared(x - ix * along, y - iy * along, z - iz * along);
            let (reach, its) = (other.reach[j] + keep, long + keep);
            let meets = is_near[j] & (one <= reach * reach) & (two <= its * its);
            bits[j] = u32::from(meets) << j;
            keeps[j] = keep;
        }
        let near = bits[0] | bits[1] | bits[2] | bits[3];
        if near == 0 {
            return 0;
        }
        near & !self.apart(link, other, &keeps)
    }

    /// Which of the other's links are farther from a link than `keeps` m half way through the step, as bits: between two planes at a right angle to
    /// where they seem to be nearest, whatever rounding makes of that.
    #[inline]
    fn apart(&self, link: usize, other: &Self, keeps: &[f32; PIECE]) -> u32 {
        let at = |of: &[[f32; PIECE]; 3], i: usize| (of[0][i], of[1][i], of[2][i]);
        let dot = |a: (f32, f32, f32), b: (f32, f32, f32)| a.0 * b.0 + a.1 * b.1 + a.2 * b.2;
        let (center, half) = (at(&self.center, link), at(&self.half, link));
        let (square, per_square) = (dot(half, half), self.per_square[link]);
        let mut bits = [0_u32; PIECE];
        for j in 0..PIECE {
            let its = at(&other.center, j);
            let between = (its.0 - center.0, its.1 - center.1, its.2 - center.2);
            let its = at(&other.half, j);
            let (both, along, its_along) = (dot(half, its), dot(half, between), dot(its, between));
            let its_square = dot(its, its);
            let area = (square * its_square - both * both).max(1e-30);
            // From the middle of the link to its end is 1.
            let t = ((along * its_square - both * its_along) / area).clamp(-1.0, 1.0);
            let its_t = ((t * both - its_along) * other.per_square[j]).clamp(-1.0, 1.0);
            let t = ((along + its_t * both) * per_square).clamp(-1.0, 1.0);
            let away = |between: f32, its: f32, half: f32| between + its_t * its - t * half;
            let way = (
                away(between.0, its.0, half.0),
                away(between.1, its.1, half.1),
                away(between.2, its.2, half.2),
            );
            let apart = dot(way, between) - dot(way, half).abs() - dot(way, its).abs();
            let size = between.0.abs() + between.1.abs() + between.2.abs();
            let keep = keeps[j] + size * 2e-6;
            let is_apart = (apart > 0.0) & (apart * apart > keep * keep * dot(way, way) * ROUNDED);
            bits[j] = u32::from(is_apart) << j;
        }
        bits[0] | bits[1] | bits[2] | bits[3]
    }
}

#[inline]
fn length_squared(x: f32, y: f32, z: f32) -> f32 {
    x * x + y * y + z * z
}

/// Where the strands of some batches go in a step.
#[derive(Clone, Debug)]
pub(super) struct Ways {
    /// Of every batch, batch by batch: the roots, then the particles; before and after.
    points: Vec<[Vec3; 2]>,
    /// The first of every batch.
    first: Vec<usize>,
    /// Of every piece.
    pub sweeps: Vec<Sweep>,
}

impl Ways {
    pub(super) fn new(batches: &[Batch], pieces: usize) -> Self {
        let mut first = vec![0];
        for batch in batches {
            first.push(first[first.len() - 1] + batch.count() + 1);
        }
        Self {
            points: vec![[Vec3::ZERO; 2]; first[batches.len()]],
            first,
            sweeps: vec![Sweep::NONE; pieces],
        }
    }

    /// Finds where all strands go in a step of `dt` seconds.
    pub(super) fn follow<T: Number>(
        &mut self,
        pieces: &[Piece],
        batches: &[Batch],
        states: &[BatchState],
        (surroundings, dt): (&Surroundings, f64),
    ) {
        // What is near is in fine steps.
        let origin = states
            .first()
            .map_or(DVec3::ZERO, |state| state.root.get(0));
        let step = Step {
            surroundings,
            dt,
            origin: if origin.is_finite() {
                origin
            } else {
                DVec3::ZERO
            },
        };
        let Self { points, sweeps, .. } = self;
        step.follow::<T>(0, (batches, states), points, (pieces, sweeps));
    }

    /// A particle's way, by its number on the strand; the root's is 0.
    #[inline]
    pub(super) fn point(&self, piece: &Piece, k: usize) -> Course {
        let [before, now] = &self.points[self.first[piece.batch] + k];
        Course {
            before: before.get(piece.lane),
            now: now.get(piece.lane),
        }
    }

    /// The ways of a link's ends, by its number on the piece.
    #[inline]
    pub(super) fn link(&self, piece: &Piece, link: usize) -> [Course; 2] {
        let start = piece.first + link;
        [self.point(piece, start), self.point(piece, start + 1)]
    }

    /// The way of a piece's root.
    #[inline]
    pub(super) fn shift(&self, piece: &Piece) -> DVec3 {
        let root = self.point(piece, 0);
        root.now - root.before
    }
}

/// What happens in a step of `dt` seconds, around an origin.
struct Step<'a> {
    surroundings: &'a Surroundings<'a>,
    dt: f64,
    origin: DVec3,
}

impl Step<'_> {
    /// Follows batches, of which the first is number `first` of all.
    fn follow<T: Number>(
        &self,
        first: usize,
        (batches, states): (&[Batch], &[BatchState]),
        points: &mut [[Vec3; 2]],
        (pieces, sweeps): (&[Piece], &mut [Sweep]),
    ) {
        // A task for fewer of them costs more than they do.
        if batches.len() > 16 {
            let half = batches.len() / 2;
            let (these, later) = (batches.split_at(half), states.split_at(half));
            let count: usize = these.0.iter().map(|batch| batch.count() + 1).sum();
            let (point, later_points) = points.split_at_mut(count);
            let middle = pieces.partition_point(|piece| piece.batch < first + half);
            let (piece, later_pieces) = pieces.split_at(middle);
            let (sweep, later_sweeps) = sweeps.split_at_mut(middle);
            join(
                || self.follow::<T>(first, (these.0, later.0), point, (piece, sweep)),
                || {
                    let (first, pieces) = (first + half, (later_pieces, later_sweeps));
                    self.follow::<T>(first, (these.1, later.1), later_points, pieces);
                },
            );
            return;
        }
        let (mut points, mut pieces, mut sweeps) = (points, pieces, sweeps);
        for (index, (batch, state)) in batches.iter().zip(states).enumerate() {
            let (own, later) = points.split_at_mut(batch.count() + 1);
            points = later;
            let count = pieces.partition_point(|piece| piece.batch == first + index);
            let (of_batch, later) = pieces.split_at(count);
            pieces = later;
            let (swept, later) = sweeps.split_at_mut(count);
            sweeps = later;
            if !of_batch.is_empty() {
                T::run(
                    #[inline(always)]
                    || self.sweep::<T>((batch, state), own, (of_batch, swept)),
                );
            }
        }
    }

    /// Follows the strands of a batch.
    #[inline(always)]
    fn sweep<T: Number>(
        &self,
        (batch, state): (&Batch, &BatchState),
        points: &mut [[Vec3; 2]],
        (pieces, sweeps): (&[Piece], &mut [Sweep]),
    ) {
        let (root, _) = roots(batch, self.surroundings);
        points[0] = [state.root, root];
        for (k, point) in points[1..].iter_mut().enumerate() {
            let (y, v) = (state.y[k].load::<T>(), state.v[k].load::<T>());
            let before = state.root.load::<T>() + y;
            let now = root.load::<T>() + y + v * self.dt;
            *point = [before.store(), now.store()];
        }
        let shift = root - state.root;
        // The first piece of every lane, which lie one after the other.
        let from: [usize; LANES + 1] =
            std::array::from_fn(|lane| pieces.partition_point(|piece| piece.lane < lane));
        for (number, first) in (0..batch.count()).step_by(PIECE).enumerate() {
            let links = &points[first..=(first + PIECE).min(batch.count())];
            let swept = Swept::of(links, shift, self.origin);
            for lane in 0..LANES {
                let piece = from[lane] + number;
                if piece < from[lane + 1] {
                    let is_there = state.set_aside[lane].is_none();
                    sweeps[piece] = match is_there {
                        true => swept.of_lane(&pieces[piece]),
                        false => Sweep::NONE,
                    };
                }
            }
        }
    }
}

/// What a piece of every strand of a batch sweeps.
struct Swept {
    low: Vec3,
    high: Vec3,
    mid_low: Vec3,
    mid_high: Vec3,
    centers: [Vec3; PIECE],
    halves: [Vec3; PIECE],
    reaches: [Lane; PIECE],
    ways: [Vec3; PIECE],
    spreads: [Lane; PIECE],
    way: Vec3,
    spread: Lane,
    own: Lane,
}

impl Swept {
    /// Of points whose roots go by `shift`, against an origin.
    #[inline(always)]
    fn of(points: &[[Vec3; 2]], shift: Vec3, origin: DVec3) -> Self {
        let origin = Vec3::splat(origin);
        let [first, last] = [points[0], points[points.len() - 1]];
        let way = (first[1] - first[0] + last[1] - last[0]) * 0.5;
        let (mut low, mut high) = (first[0] - origin, first[0] - origin);
        let middle = (first[0] + first[1]) * 0.5 - origin;
        let (mut mid_low, mut mid_high) = (middle, middle);
        let (mut own, mut spread, mut broken) = (Lane::ZERO, Lane::ZERO, Lane::ZERO);
        for [before, now] in points {
            let (from, to) = (*before - origin, *now - origin);
            let mid = (from + to) * 0.5;
            (low, high) = (least(least(low, from), to), most(most(high, from), to));
            (mid_low, mid_high) = (least(mid_low, mid), most(mid_high, mid));
            let goes = *now - *before;
            own = own.max((goes - shift).length_squared());
            spread = spread.max((goes - way).length_squared());
            // NaN where a way is not finite.
            broken += goes.x * 0.0 + goes.y * 0.0 + goes.z * 0.0;
        }
        let mut swept = Self {
            low,
            high,
            mid_low,
            mid_high,
            centers: [Vec3::ZERO; PIECE],
            halves: [Vec3::ZERO; PIECE],
            reaches: [Lane::ZERO; PIECE],
            ways: [Vec3::ZERO; PIECE],
            spreads: [Lane::ZERO; PIECE],
            way,
            spread: spread.sqrt(),
            own: own.sqrt() + broken,
        };
        for (i, ends) in points.windows(2).enumerate() {
            let [[start, start_now], [end, end_now]] = [ends[0], ends[1]];
            let long = (end - start).length_squared();
            let long = long.max((end_now - start_now).length_squared());
            let (start_mid, end_mid) = (start + start_now, end + end_now);
            swept.centers[i] = (start_mid + end_mid) * 0.25 - origin;
            swept.halves[i] = (end_mid - start_mid) * 0.25;
            let (start_way, end_way) = (start_now - start, end_now - end);
            swept.ways[i] = (start_way + end_way) * 0.5;
            swept.spreads[i] = (end_way - start_way).length_squared().sqrt() * 0.5;
            swept.reaches[i] = long.sqrt() * 0.5;
        }
        swept
    }

    /// That of one of them. What isn't finite is nowhere, and so is what flies about.
    fn of_lane(&self, piece: &Piece) -> Sweep {
        let lane = piece.lane;
        let (own, spread) = (self.own[lane], self.spread[lane]);
        let (low, high) = (self.low.get(lane), self.high.get(lane));
        let largest = low.abs().max(high.abs()).max_element();
        if !(own < FARTHEST && largest.is_finite()) {
            return Sweep::NONE;
        }
        let keep = piece.radius * (1.0 + TOUCH) + 0.5 * NEAR;
        let rounding = (largest + keep + own + spread) * ROUNDING;
        let around = |low: DVec3, high: DVec3, more: f64| Bounds {
            low: (low - more).as_vec3().to_array(),
            high: (high + more).as_vec3().to_array(),
        };
        let (mid_low, mid_high) = (self.mid_low.get(lane), self.mid_high.get(lane));
        let mut sweep = Sweep {
            bounds: around(low, high, keep + own + rounding),
            mid: around(mid_low, mid_high, keep + rounding),
            keep: (keep + rounding) as f32,
            way: self.way.get(lane).as_vec3().to_array(),
            spread: (spread + rounding) as f32,
            own: (own + rounding) as f32,
            ..Sweep::NONE
        };
        for i in 0..piece.links {
            let center = self.centers[i].get(lane).as_vec3();
            let half = self.halves[i].get(lane).as_vec3();
            let way = self.ways[i].get(lane).as_vec3();
            for axis in 0..3 {
                sweep.center[axis][i] = center[axis];
                sweep.half[axis][i] = half[axis];
                sweep.ways[axis][i] = way[axis];
            }
            sweep.spreads[i] = (self.spreads[i][lane] + rounding) as f32;
            sweep.reach[i] = (self.reaches[i][lane] + rounding) as f32;
            sweep.per_square[i] = 1.0 / half.length_squared().max(1e-20);
        }
        sweep
    }
}

#[inline(always)]
fn least(one: Vec3, other: Vec3) -> Vec3 {
    let (x, y, z) = (one.x.min(other.x), one.y.min(other.y), one.z.min(other.z));
    Vec3::new(x, y, z)
}

#[inline(always)]
fn most(one: Vec3, other: Vec3) -> Vec3 {
    let (x, y, z) = (one.x.max(other.x), one.y.max(other.y), one.z.max(other.z));
    Vec3::new(x, y, z)
}
