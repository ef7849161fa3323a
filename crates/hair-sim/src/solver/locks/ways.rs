//! Where strands go in a step by their own motion, and boxes and balls around that.
//!
//! Boxes and balls are in single precision, and larger by what that leaves out: they tell what is far off.

use glam::{DVec3, Vec3A, Vec4};

use crate::{
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
    meeting::{TOUCH, least, most},
};

/// The most links of a piece.
pub(super) const PIECE: usize = 4;

/// Pieces that go farther than this against their roots in a step, in m, meet nothing: they would meet all hair there is.
const FARTHEST: f64 = 0.1;

/// What single precision may change a coordinate by, as a share of it.
const ROUNDING: f64 = 1.0 / (1 << 22) as f64;
/// A factor on a length in single precision that makes up for it.
pub(super) const ROUNDED: f32 = 1.0 + 1e-6;

/// A box along the axes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bounds {
    pub low: Vec3A,
    pub high: Vec3A,
}

impl Bounds {
    /// Around nothing: it meets no other.
    pub(super) const NONE: Self = Self {
        low: Vec3A::INFINITY,
        high: Vec3A::NEG_INFINITY,
    };

    pub(super) fn and(&self, other: &Self) -> Self {
        Self {
            low: self.low.min(other.low),
            high: self.high.max(other.high),
        }
    }

    #[inline(always)]
    pub(super) fn meets(&self, other: &Self) -> bool {
        let gaps = (self.low - other.high).max(other.low - self.high);
        gaps.cmple(Vec3A::ZERO).all()
    }

    pub(super) fn larger_by(&self, by: f32) -> Self {
        Self {
            low: self.low - by,
            high: self.high + by,
        }
    }
}

/// A vector of each link of a piece, coordinate by coordinate.
#[derive(Clone, Copy, Debug)]
struct OfLinks([Vec4; 3]);

impl OfLinks {
    const ZERO: Self = Self([Vec4::ZERO; 3]);

    /// That of one link, four times.
    #[inline(always)]
    fn of(&self, link: usize) -> Self {
        Self(self.0.map(|axis| Vec4::splat(axis[link])))
    }

    #[inline(always)]
    fn minus(&self, other: &Self) -> Self {
        let ([x, y, z], [ox, oy, oz]) = (self.0, other.0);
        Self([x - ox, y - oy, z - oz])
    }

    #[inline(always)]
    fn times(&self, by: Vec4) -> Self {
        Self(self.0.map(|axis| axis * by))
    }

    #[inline(always)]
    fn dot(&self, other: &Self) -> Vec4 {
        let ([x, y, z], [ox, oy, oz]) = (self.0, other.0);
        x * ox + y * oy + z * oz
    }

    #[inline(always)]
    fn length_squared(&self) -> Vec4 {
        self.dot(self)
    }
}

/// What a piece sweeps in a step: a box around all that it may meet in it, as far as it is known by itself; and for what both of two pieces do, a box
/// around it half way through the step, its links there, its mean way, and how far the ways of its points are from that. Boxes have the lock's
/// radius.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sweep {
    pub bounds: Bounds,
    pub mid: Bounds,
    /// Bits of [`Sweep::near`] for links that the piece has, as the first and as the other. What it lacks of four is as its last.
    rows: u32,
    columns: u32,
    /// The middle of the piece, the way from its start to its end, and what rounding may make of a coordinate.
    middle: Vec3A,
    along: Vec3A,
    rounding: f32,
    /// The links' middles.
    center: OfLinks,
    /// From there to the links' ends, half their lengths, and one over the squares of those.
    half: OfLinks,
    reach: Vec4,
    per_square: Vec4,
    /// The mean ways of the links, and how far those of their ends are from that.
    ways: OfLinks,
    spreads: Vec4,
    /// The lock's radius, by itself and with what comes to it.
    pub radius: f32,
    keep: f32,
    pub way: Vec3A,
    pub spread: f32,
    /// How far it goes against its root, in m.
    pub own: f32,
}

impl Sweep {
    pub(super) const NONE: Self = Self {
        bounds: Bounds::NONE,
        mid: Bounds::NONE,
        rows: 0,
        columns: 0,
        middle: Vec3A::ZERO,
        along: Vec3A::ZERO,
        rounding: 0.0,
        center: OfLinks::ZERO,
        half: OfLinks::ZERO,
        reach: Vec4::ZERO,
        per_square: Vec4::ZERO,
        ways: OfLinks::ZERO,
        spreads: Vec4::ZERO,
        radius: 0.0,
        keep: 0.0,
        way: Vec3A::ZERO,
        spread: 0.0,
        own: 0.0,
    };

    /// Which links of two pieces may meet, as bits, those of the other for every link of the first, where both keep `more` metres besides their radii,
    /// where going by `slow` metres against each other is slow, and
    /// they may meet so much `farther` than half way through the step. It looks at both pieces as wholes first, then at balls around links.
    #[inline(always)]
    pub(super) fn near(&self, other: &Self, (more, slow, farther): (f32, f32, f32)) -> u32 {
        let keep = Vec4::splat(self.keep + other.keep + farther);
        let around = other.reach + keep;
        let mut near = self.not_apart(other, keep[0]);
        if near == 0 {
            return 0;
        }
        for link in 0..PIECE {
            let between = other.center.minus(&self.center.of(link));
            let reach = around + Vec4::splat(self.reach[link]);
            let meets = between.length_squared().cmple(reach * reach);
            near &= meets.bitmask() << (PIECE * link) | !(0xf << (PIECE * link));
        }
        let mut found = 0;
        while near != 0 {
            let link = near.trailing_zeros() as usize / PIECE;
            let at = PIECE * link;
            let its = near & (((1 << PIECE) - 1) << at);
            near &= !its;
            found |= its & (self.near_link(link, other, (more, slow)) << at);
        }
        found
    }

    /// Which links of two pieces may be nearer to each other than `keep` m half way through the step, as bits: those that aren't between two planes at a
    /// right angle to where strands that hang side by side are nearest, whatever rounding makes of that.
    #[inline(always)]
    fn not_apart(&self, other: &Self, keep: f32) -> u32 {
        let between = other.middle - self.middle;
        let along = self.along * self.along.dot(other.along).signum();
        let along = along + other.along;
        let way = between - along * (between.dot(along) / along.length_squared().max(1e-20));
        let toward = OfLinks([Vec4::splat(way.x), Vec4::splat(way.y), Vec4::splat(way.z)]);
        let far = toward.dot(&self.center) + toward.dot(&self.half).abs();
        let its = toward.dot(&other.center) - toward.dot(&other.half).abs();
        let keep = (keep + self.rounding + other.rounding) * way.length() * ROUNDED;
        let far = far + Vec4::splat(keep);
        let apart = |link: usize| its.cmpgt(Vec4::splat(far[link])).bitmask() << (PIECE * link);
        !(0..PIECE).fold(0, |bits, link| bits | apart(link)) & self.rows & other.columns
    }

    /// Which of the other's links may meet a link, as bits: of each link and the ball around the other, and between two planes at a right angle to where
    /// they seem to be nearest half way through the step, whatever rounding makes of that.
    #[inline(always)]
    fn near_link(&self, link: usize, other: &Self, (more, slow): (f32, f32)) -> u32 {
        let own = Vec4::splat(self.own + other.own);
        let against = other.ways.minus(&self.ways.of(link)).length_squared();
        let against = against.sqrt() * ROUNDED + Vec4::splat(self.spreads[link]) + other.spreads;
        let acts = own.min(against);
        let acts = Vec4::select(acts.cmpgt(Vec4::splat(slow)), acts, Vec4::ZERO);
        let keep = Vec4::splat(self.keep + other.keep + more) + 0.5 * against + acts;

        let (half, its_half) = (self.half.of(link), &other.half);
        let (per_square, its_per_square) = (Vec4::splat(self.per_square[link]), other.per_square);
        let between = other.center.minus(&self.center.of(link));
        let (along, its_along) = (half.dot(&between), its_half.dot(&between));
        // From the middle of a link to its end is 1.
        let on_link = |t: Vec4| t.clamp(Vec4::NEG_ONE, Vec4::ONE);
        let one = between.minus(&half.times(on_link(along * per_square)));
        let two = between.minus(&its_half.times(on_link(its_along * its_per_square)));
        let (reach, its_reach) = (other.reach + keep, Vec4::splat(self.reach[link]) + keep);
        let meets = (one.length_squared().cmple(reach * reach))
            & two.length_squared().cmple(its_reach * its_reach);
        if !meets.any() {
            return 0;
        }

        let both = half.dot(its_half);
        let (square, its_square) = (half.length_squared(), its_half.length_squared());
        let area = (square * its_square - both * both).max(Vec4::splat(1e-30));
        let t = on_link((along * its_square - both * its_along) / area);
        let its_t = on_link((t * both - its_along) * its_per_square);
        let t = on_link((along + its_t * both) * per_square);
        let [x, y, z] = between.0;
        let ([hx, hy, hz], [ix, iy, iz]) = (half.times(t).0, its_half.times(its_t).0);
        let way = OfLinks([x + ix - hx, y + iy - hy, z + iz - hz]);
        let apart = way.dot(&between) - way.dot(&half).abs() - way.dot(its_half).abs();
        let keep = keep + (x.abs() + y.abs() + z.abs()) * 2e-6;
        let is_apart = (apart.cmpgt(Vec4::ZERO))
            & (apart * apart).cmpgt(keep * keep * way.length_squared() * ROUNDED);
        meets.bitmask() & !is_apart.bitmask()
    }
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

    /// Where a link's ends are, before and after, by its number on the piece.
    #[inline(always)]
    pub(super) fn link(&self, piece: &Piece, link: usize) -> [[DVec3; 2]; 2] {
        let from = self.first[piece.batch] + piece.first + link;
        let [start, end] = [&self.points[from], &self.points[from + 1]];
        [
            [start[0].get(piece.lane), start[1].get(piece.lane)],
            [end[0].get(piece.lane), end[1].get(piece.lane)],
        ]
    }

    /// The way of a piece's root.
    #[inline(always)]
    pub(super) fn shift(&self, piece: &Piece) -> DVec3 {
        let [before, now] = &self.points[self.first[piece.batch]];
        now.get(piece.lane) - before.get(piece.lane)
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
        let shift = (root - state.root).load::<T>();
        // The first piece of every lane, which lie one after the other.
        let from: [usize; LANES + 1] =
            std::array::from_fn(|lane| pieces.partition_point(|piece| piece.lane < lane));
        for (number, first) in (0..batch.count()).step_by(PIECE).enumerate() {
            let links = &points[first..=(first + PIECE).min(batch.count())];
            let swept = Swept::of::<T>(links, shift, self.origin);
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
    fn of<T: Number>(points: &[[Vec3; 2]], shift: Vec3<T>, origin: DVec3) -> Self {
        let (zero, half, quarter) = (T::splat(0.0), T::splat(0.5), T::splat(0.25));
        let origin = Vec3::<T>::all(origin);
        let load = |[before, now]: &[Vec3; 2]| [before.load::<T>(), now.load::<T>()];
        let [first, last] = [load(&points[0]), load(&points[points.len() - 1])];
        let way = (first[1] - first[0] + last[1] - last[0]).scale(half);
        let (mut low, mut high) = (first[0] - origin, first[0] - origin);
        let middle = (first[0] + first[1]).scale(half) - origin;
        let (mut mid_low, mut mid_high) = (middle, middle);
        let (mut own, mut spread, mut broken) = (zero, zero, zero);
        for point in points {
            let [before, now] = load(point);
            let (from, to) = (before - origin, now - origin);
            let mid = (from + to).scale(half);
            (low, high) = (low.least(from).least(to), high.most(from).most(to));
            (mid_low, mid_high) = (mid_low.least(mid), mid_high.most(mid));
            let goes = now - before;
            own = most(own, (goes - shift).length_squared());
            spread = most(spread, (goes - way).length_squared());
            // NaN where a way is not finite.
            broken = broken + goes.x * zero + goes.y * zero + goes.z * zero;
        }
        let mut swept = Self {
            low: low.store(),
            high: high.store(),
            mid_low: mid_low.store(),
            mid_high: mid_high.store(),
            centers: [Vec3::ZERO; PIECE],
            halves: [Vec3::ZERO; PIECE],
            reaches: [Lane::ZERO; PIECE],
            ways: [Vec3::ZERO; PIECE],
            spreads: [Lane::ZERO; PIECE],
            way: way.store(),
            spread: spread.sqrt().store(),
            own: (own.sqrt() + broken).store(),
        };
        for (i, ends) in points.windows(2).enumerate() {
            let [[start, start_now], [end, end_now]] = [load(&ends[0]), load(&ends[1])];
            let long = (end - start).length_squared();
            let long = most(long, (end_now - start_now).length_squared());
            let (start_mid, end_mid) = (start + start_now, end + end_now);
            swept.centers[i] = ((start_mid + end_mid).scale(quarter) - origin).store();
            swept.halves[i] = (end_mid - start_mid).scale(quarter).store();
            let (start_way, end_way) = (start_now - start, end_now - end);
            swept.ways[i] = (start_way + end_way).scale(half).store();
            let spread = (end_way - start_way).length_squared().sqrt() * half;
            swept.spreads[i] = spread.store();
            swept.reaches[i] = (long.sqrt() * half).store();
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
            low: (low - more).as_vec3a(),
            high: (high + more).as_vec3a(),
        };
        let (mid_low, mid_high) = (self.mid_low.get(lane), self.mid_high.get(lane));
        let mut sweep = Sweep {
            bounds: around(low, high, keep + own + rounding),
            mid: around(mid_low, mid_high, keep + rounding),
            radius: piece.radius as f32,
            keep: (keep + rounding) as f32,
            way: self.way.get(lane).as_vec3a(),
            spread: (spread + rounding) as f32,
            own: (own + rounding) as f32,
            ..Sweep::NONE
        };
        let links = piece.links as u32;
        sweep.rows = (1 << (PIECE as u32 * links)) - 1;
        sweep.columns = ((1 << links) - 1) * 0x1111;
        sweep.rounding = (largest * 2e-6) as f32;
        for i in 0..PIECE {
            let link = i.min(piece.links - 1);
            let center = self.centers[link].get(lane).as_vec3();
            let half = self.halves[link].get(lane).as_vec3();
            let way = self.ways[link].get(lane).as_vec3();
            for axis in 0..3 {
                sweep.center.0[axis][i] = center[axis];
                sweep.half.0[axis][i] = half[axis];
                sweep.ways.0[axis][i] = way[axis];
            }
            sweep.spreads[i] = (self.spreads[link][lane] + rounding) as f32;
            sweep.reach[i] = (self.reaches[link][lane] + rounding) as f32;
            sweep.per_square[i] = 1.0 / half.length_squared().max(1e-20);
        }
        let end = |i: usize, side: f32| {
            let axis = |axis: usize| sweep.center.0[axis][i] + sweep.half.0[axis][i] * side;
            Vec3A::new(axis(0), axis(1), axis(2))
        };
        let (start, end) = (end(0, -1.0), end(PIECE - 1, 1.0));
        (sweep.middle, sweep.along) = ((start + end) * 0.5, end - start);
        sweep
    }
}

impl<T: Number> Vec3<T> {
    #[inline(always)]
    fn least(self, other: Self) -> Self {
        Self::new(
            least(self.x, other.x),
            least(self.y, other.y),
            least(self.z, other.z),
        )
    }

    #[inline(always)]
    fn most(self, other: Self) -> Self {
        Self::new(
            most(self.x, other.x),
            most(self.y, other.y),
            most(self.z, other.z),
        )
    }
}
