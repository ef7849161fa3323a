//! Where strands go in a step by their own motion, and boxes and balls around that.
//!
//! Boxes and balls are in single precision, and larger by what that leaves out: they tell what is far off.

use glam::{BVec4A, DVec3, Mat4, Vec3A, Vec4};

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
    boxes::{Bounds, FOUR, Four, Row},
    meeting::{TOUCH, most},
    single::{ROUNDED, Vectors, all, one, single},
};

/// The most links of a piece.
pub(super) const PIECE: usize = 4;

/// Pieces that go farther than this against their roots in a step, in m, meet nothing: they would meet all hair there is.
const FARTHEST: f32 = 0.1;

/// What single precision may change a coordinate by, as a share of it.
const ROUNDING: f32 = 1.0 / (1 << 21) as f32;

/// What the links of a piece sweep in a step: where they are half way through it, their mean ways, and how far the ways of their points are from those.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sweep {
    /// Bits of [`Sweep::near`] for links that the piece has, as the first and as the other.
    rows: u32,
    columns: u32,
    /// How far the piece goes against its root, in m.
    pub own: f32,
    /// The middle of the piece, with its lock's radius and what comes to that, and the way from its start to its end, with what rounding may make of a
    /// coordinate.
    middle: Vec4,
    along: Vec4,
    /// The links' middles.
    center: Vectors,
    /// From there to the links' ends, half their lengths, and one over the squares of those.
    half: Vectors,
    reach: Vec4,
    per_square: Vec4,
    /// The mean ways of the links, and how far those of their ends are from that.
    ways: Vectors,
    spreads: Vec4,
}

impl Sweep {
    const NONE: Self = Self {
        rows: 0,
        columns: 0,
        own: 0.0,
        middle: Vec4::ZERO,
        along: Vec4::ZERO,
        center: Vectors::ZERO,
        half: Vectors::ZERO,
        reach: Vec4::ZERO,
        per_square: Vec4::ZERO,
        ways: Vectors::ZERO,
        spreads: Vec4::ZERO,
    };

    /// Of a piece with so many links.
    fn with(links: usize) -> Self {
        let links = links as u32;
        Self {
            rows: (1 << (PIECE as u32 * links)) - 1,
            columns: ((1 << links) - 1) * 0x1111,
            ..Self::NONE
        }
    }

    /// Which links of two pieces may meet, as bits, those of the other for every link of the first, where both keep `more` metres besides their radii,
    /// where going by `slow` metres against each other is slow, and
    /// they may meet so much `farther` than half way through the step. It looks at both pieces as wholes first, then at balls around links.
    #[inline(always)]
    pub(super) fn near(&self, other: &Self, (more, slow, farther): (f32, f32, f32)) -> u32 {
        let keep = Vec4::splat(self.middle.w + other.middle.w + farther);
        let around = other.reach + keep;
        let mut near = self.not_apart(other, keep[0]);
        if near == 0 {
            return 0;
        }
        for link in 0..PIECE {
            let between = other.center.minus(&self.center.of(link));
            let reach = around + all(&self.reach, link);
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
        let between = Vec3A::from_vec4(other.middle - self.middle);
        let [along, its_along] = [self, other].map(|sweep| Vec3A::from_vec4(sweep.along));
        let along = if along.dot(its_along) < 0.0 {
            its_along - along
        } else {
            its_along + along
        };
        let way = between - along * (between.dot(along) / along.length_squared().max(1e-20));
        let toward = Vectors([Vec4::splat(way.x), Vec4::splat(way.y), Vec4::splat(way.z)]);
        let far = toward.dot(&self.center) + toward.dot(&self.half).abs();
        let its = toward.dot(&other.center) - toward.dot(&other.half).abs();
        let keep = (keep + self.along.w + other.along.w) * way.length() * ROUNDED;
        let far = far + Vec4::splat(keep);
        let apart = |link: usize| its.cmpgt(all(&far, link)).bitmask() << (PIECE * link);
        !(0..PIECE).fold(0, |bits, link| bits | apart(link)) & self.rows & other.columns
    }

    /// Which of the other's links may meet a link, as bits: of each link and the ball around the other, and between two planes at a right angle to where
    /// they seem to be nearest half way through the step, whatever rounding makes of that.
    #[inline(always)]
    fn near_link(&self, link: usize, other: &Self, (more, slow): (f32, f32)) -> u32 {
        let own = Vec4::splat(self.own + other.own);
        let against = other.ways.minus(&self.ways.of(link)).length_squared();
        let against = against.sqrt() * ROUNDED + all(&self.spreads, link) + other.spreads;
        let acts = own.min(against);
        let acts = Vec4::select(acts.cmpgt(Vec4::splat(slow)), acts, Vec4::ZERO);
        let keep = Vec4::splat(self.middle.w + other.middle.w + more) + 0.5 * against + acts;

        let (half, its_half) = (self.half.of(link), &other.half);
        let (per_square, its_per_square) = (all(&self.per_square, link), other.per_square);
        let between = other.center.minus(&self.center.of(link));
        let (along, its_along) = (half.dot(&between), its_half.dot(&between));
        // From the middle of a link to its end is 1.
        let on_link = |t: Vec4| t.clamp(Vec4::NEG_ONE, Vec4::ONE);
        let one = between.minus(&half.times(on_link(along * per_square)));
        let two = between.minus(&its_half.times(on_link(its_along * its_per_square)));
        let (reach, its_reach) = (other.reach + keep, all(&self.reach, link) + keep);
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
        let way = Vectors([x + ix - hx, y + iy - hy, z + iz - hz]);
        let apart = way.dot(&between) - way.dot(&half).abs() - way.dot(its_half).abs();
        let keep = keep + (x.abs() + y.abs() + z.abs()) * 2e-6;
        let is_apart = (apart.cmpgt(Vec4::ZERO))
            & (apart * apart).cmpgt(keep * keep * way.length_squared() * ROUNDED);
        meets.bitmask() & !is_apart.bitmask()
    }
}

/// Where what is known of a batch begins in the lists of all.
#[derive(Clone, Copy, Debug, Default)]
struct Place {
    points: usize,
    pieces: usize,
    fours: usize,
}

/// Where the strands of some batches go in a step.
#[derive(Clone, Debug)]
pub(super) struct Ways {
    /// Of every batch, batch by batch: the roots, then the particles; before and after.
    points: Vec<[Vec3; 2]>,
    /// Of every batch; one more at the end.
    places: Vec<Place>,
    /// Of every piece.
    pub sweeps: Vec<Sweep>,
    /// Of every four pieces of a strand.
    pub fours: Vec<Four>,
    /// Around all that these may meet.
    pub bounds: Vec<Bounds>,
}

impl Ways {
    pub(super) fn new(batches: &[Batch], pieces: &[Piece]) -> Self {
        let mut places = vec![Place::default()];
        for (index, batch) in batches.iter().enumerate() {
            let Place {
                points,
                mut pieces,
                mut fours,
            } = places[index];
            for lane in (0..LANES).filter(|&lane| is_a_lock(batch, lane)) {
                let count = batch.counts[lane].div_ceil(PIECE);
                pieces += count;
                fours += count.div_ceil(FOUR);
            }
            places.push(Place {
                points: points + batch.count() + 1,
                pieces,
                fours,
            });
        }
        let all = places[batches.len()];
        Self {
            points: vec![[Vec3::ZERO; 2]; all.points],
            places,
            sweeps: pieces
                .iter()
                .map(|piece| Sweep::with(piece.links))
                .collect(),
            fours: vec![Four::NONE; all.fours],
            bounds: vec![Bounds::NONE; all.fours],
        }
    }

    /// Finds where all strands go in a step of `dt` seconds. What they keep is larger by a factor and by so many metres, which steps have not.
    pub(super) fn follow<T: Number>(
        &mut self,
        batches: &[Batch],
        states: &[BatchState],
        (surroundings, dt): (&Surroundings, f64),
        more: (f64, f64),
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
            more,
        };
        let all = Part {
            batches,
            states,
            places: &self.places,
            points: &mut self.points,
            sweeps: &mut self.sweeps,
            fours: &mut self.fours,
            bounds: &mut self.bounds,
        };
        step.follow::<T>(all);
    }

    /// Where a link's ends are, before and after, by its number on the piece.
    #[inline(always)]
    pub(super) fn link(&self, piece: &Piece, link: usize) -> [[DVec3; 2]; 2] {
        let from = self.places[piece.batch].points + piece.first + link;
        let [start, end] = [&self.points[from], &self.points[from + 1]];
        // Known to be a lane without a look.
        let lane = piece.lane % LANES;
        [
            [start[0].get(lane), start[1].get(lane)],
            [end[0].get(lane), end[1].get(lane)],
        ]
    }

    /// The way of a piece's root.
    #[inline(always)]
    pub(super) fn shift(&self, piece: &Piece) -> DVec3 {
        let [before, now] = &self.points[self.places[piece.batch].points];
        let lane = piece.lane % LANES;
        now.get(lane) - before.get(lane)
    }
}

/// Whether there is a strand in a lane of a batch that keeps apart from others.
pub(super) fn is_a_lock(batch: &Batch, lane: usize) -> bool {
    batch.strands[lane].is_some() && batch.lock_radius[lane] > 0.0 && batch.counts[lane] > 0
}

/// Some batches, and what is to be known of them.
struct Part<'a> {
    batches: &'a [Batch],
    states: &'a [BatchState],
    /// One more than batches.
    places: &'a [Place],
    points: &'a mut [[Vec3; 2]],
    sweeps: &'a mut [Sweep],
    fours: &'a mut [Four],
    bounds: &'a mut [Bounds],
}

impl<'a> Part<'a> {
    /// The first so many batches, and the others.
    #[inline(always)]
    fn split(self, count: usize) -> (Self, Self) {
        let (from, to) = (self.places[0], self.places[count]);
        let (batches, later_batches) = self.batches.split_at(count);
        let (states, later_states) = self.states.split_at(count);
        let (points, later_points) = self.points.split_at_mut(to.points - from.points);
        let (sweeps, later_sweeps) = self.sweeps.split_at_mut(to.pieces - from.pieces);
        let (fours, later_fours) = self.fours.split_at_mut(to.fours - from.fours);
        let (bounds, later_bounds) = self.bounds.split_at_mut(to.fours - from.fours);
        let first = Part {
            batches,
            states,
            places: &self.places[..=count],
            points,
            sweeps,
            fours,
            bounds,
        };
        let later = Part {
            batches: later_batches,
            states: later_states,
            places: &self.places[count..],
            points: later_points,
            sweeps: later_sweeps,
            fours: later_fours,
            bounds: later_bounds,
        };
        (first, later)
    }
}

/// Those of every lane, which has so many, one lane after the other.
fn by_lane<V>(all: &mut [V], counts: [usize; LANES]) -> [&mut [V]; LANES] {
    let mut left = all;
    counts.map(|count| {
        let (own, later) = std::mem::take(&mut left).split_at_mut(count);
        left = later;
        own
    })
}

/// What happens in a step of `dt` seconds, around an origin.
struct Step<'a> {
    surroundings: &'a Surroundings<'a>,
    dt: f64,
    origin: DVec3,
    more: (f64, f64),
}

impl Step<'_> {
    fn follow<T: Number>(&self, part: Part) {
        let count = part.batches.len();
        // A task for fewer of them costs more than they do.
        if count > 16 {
            let (first, later) = part.split(count / 2);
            join(|| self.follow::<T>(first), || self.follow::<T>(later));
            return;
        }
        let mut left = part;
        for _ in 0..count {
            let (first, later) = left.split(1);
            left = later;
            T::run(
                #[inline(always)]
                || self.sweep::<T>(first),
            );
        }
    }

    /// Follows the strands of a batch.
    #[inline(always)]
    fn sweep<T: Number>(&self, part: Part) {
        let (batch, state) = (&part.batches[0], &part.states[0]);
        let points = part.points;
        let (root, _) = roots(batch, self.surroundings);
        points[0] = [state.root, root];
        for (k, point) in points[1..].iter_mut().enumerate() {
            let (y, v) = (state.y[k].load::<T>(), state.v[k].load::<T>());
            let before = state.root.load::<T>() + y;
            let now = root.load::<T>() + y + v * self.dt;
            *point = [before.store(), now.store()];
        }
        if part.fours.is_empty() {
            return;
        }
        let shift = (root - state.root).load::<T>();
        let radius = batch.lock_radius;
        let keep = radius * (1.0 + TOUCH + self.more.0) + Lane::splat(0.5 * NEAR + self.more.1);
        let (radius, keep) = (single(radius), single(keep));
        // How many pieces every lane has, where those begin that are there, and its fours.
        let has = |lane: usize| match is_a_lock(batch, lane) {
            true => batch.counts[lane].div_ceil(PIECE),
            false => 0,
        };
        let has: [usize; LANES] = std::array::from_fn(has);
        let is_there = |lane: usize| match state.set_aside[lane] {
            None => has[lane] as f32,
            Some(_) => 0.0,
        };
        let there = Vec4::from_array(std::array::from_fn(is_there));
        let mut sweeps = by_lane(part.sweeps, has);
        let has_fours = has.map(|count| count.div_ceil(FOUR));
        let mut fours = by_lane(part.fours, has_fours);
        let mut bounds = by_lane(part.bounds, has_fours);
        let (mut spare, mut spare_fours) = ([Sweep::NONE; LANES], [Four::NONE; LANES]);
        let mut whole = Row::NONE;
        let mut rows = [Row::NONE; FOUR];
        let last = batch.count().div_ceil(PIECE) - 1;
        for (number, first) in (0..batch.count()).step_by(PIECE).enumerate() {
            let links = &points[first..=(first + PIECE).min(batch.count())];
            let swept = Swept::of::<T>(links, shift, self.origin, keep);
            let is_here = there.cmpgt(Vec4::splat(number as f32)) & swept.is_near();
            let row = swept.row(radius).only(is_here);
            whole.add(&row);
            rows[number % FOUR] = row;
            let [a, b, c, d] = &mut spare;
            let [of_a, of_b, of_c, of_d] = &mut sweeps;
            swept.store([
                of_a.get_mut(number).unwrap_or(a),
                of_b.get_mut(number).unwrap_or(b),
                of_c.get_mut(number).unwrap_or(c),
                of_d.get_mut(number).unwrap_or(d),
            ]);
            if number % FOUR == FOUR - 1 || number == last {
                rows[number % FOUR + 1..].fill(Row::NONE);
                let [of_a, of_b, of_c, of_d] = &mut bounds;
                let of_lanes = [of_a, of_b, of_c, of_d];
                for (of_lane, bounds) in of_lanes.into_iter().zip(whole.bounds()) {
                    if let Some(of_four) = of_lane.get_mut(number / FOUR) {
                        *of_four = bounds;
                    }
                }
                whole = Row::NONE;
                let four = number / FOUR;
                let [a, b, c, d] = &mut spare_fours;
                let [of_a, of_b, of_c, of_d] = &mut fours;
                Row::store(
                    &rows,
                    [
                        of_a.get_mut(four).unwrap_or(a),
                        of_b.get_mut(four).unwrap_or(b),
                        of_c.get_mut(four).unwrap_or(c),
                        of_d.get_mut(four).unwrap_or(d),
                    ],
                );
            }
        }
    }
}

/// What a piece of every strand of a batch sweeps.
struct Swept {
    /// Boxes around the pieces half way through the step.
    low: Vectors,
    high: Vectors,
    way: Vectors,
    spread: Vec4,
    own: Vec4,
    keep: Vec4,
    middle: Vectors,
    along: Vectors,
    rounding: Vec4,
    /// Of every link.
    center: [Vectors; PIECE],
    half: [Vectors; PIECE],
    reach: [Vec4; PIECE],
    per_square: [Vec4; PIECE],
    ways: [Vectors; PIECE],
    spreads: [Vec4; PIECE],
}

impl Swept {
    /// Of points whose roots go by `shift`, against an origin; they keep `keep` metres from others.
    #[inline(always)]
    fn of<T: Number>(points: &[[Vec3; 2]], shift: Vec3<T>, origin: DVec3, keep: Vec4) -> Self {
        let (zero, half) = (T::splat(0.0), T::splat(0.5));
        let origin = Vec3::<T>::all(origin);
        let (mut own, mut broken) = (zero, zero);
        let (mut mid, mut goes) = ([Vectors::ZERO; PIECE + 1], [Vectors::ZERO; PIECE + 1]);
        for (i, [before, now]) in points.iter().enumerate() {
            let (before, now) = (before.load::<T>(), now.load::<T>());
            let way = now - before;
            let against = (way - shift).length_squared();
            own = most(own, against);
            // NaN where a way is not finite.
            broken = broken + against * zero;
            mid[i] = Vectors::single((before + now).scale(half) - origin);
            goes[i] = Vectors::single(way);
        }
        let own = single(own.sqrt() + broken);
        let last = points.len() - 1;
        let way = goes[0].plus(&goes[last]).times(Vec4::splat(0.5));
        let (mut low, mut high, mut spread) = (mid[0], mid[0], Vec4::ZERO);
        for (mid, goes) in mid[..=last].iter().zip(&goes) {
            (low, high) = (low.least(mid), high.most(mid));
            spread = spread.max(goes.minus(&way).length_squared());
        }
        let spread = spread.sqrt();
        let largest = low.abs().most(&high.abs()).largest();
        let rounding = (largest + keep + way.abs().largest() + own + spread) * ROUNDING;
        let mut swept = Self {
            low,
            high,
            way,
            spread: spread + rounding,
            own: own + rounding,
            keep: keep + rounding,
            middle: mid[0].plus(&mid[last]).times(Vec4::splat(0.5)),
            along: mid[last].minus(&mid[0]),
            rounding: largest * 2e-6,
            center: [Vectors::ZERO; PIECE],
            half: [Vectors::ZERO; PIECE],
            reach: [Vec4::ZERO; PIECE],
            per_square: [Vec4::ZERO; PIECE],
            ways: [Vectors::ZERO; PIECE],
            spreads: [Vec4::ZERO; PIECE],
        };
        let half = Vec4::splat(0.5);
        for i in 0..PIECE {
            // What a piece lacks of four is as its last.
            let link = i.min(last - 1);
            let [start, end] = [&mid[link], &mid[link + 1]];
            let [way, end_way] = [&goes[link], &goes[link + 1]];
            let along = end.minus(start).times(half);
            let square = along.length_squared();
            swept.center[i] = start.plus(end).times(half);
            swept.half[i] = along;
            swept.reach[i] = square.sqrt() + rounding;
            swept.per_square[i] = square.max(Vec4::splat(1e-20)).recip();
            swept.ways[i] = way.plus(end_way).times(half);
            swept.spreads[i] = end_way.minus(way).length_squared().sqrt() * half + rounding;
        }
        swept
    }

    /// Those of which something is known. What isn't finite is nowhere, and so is what flies about.
    #[inline(always)]
    fn is_near(&self) -> BVec4A {
        self.own.cmplt(Vec4::splat(FARTHEST)) & self.keep.cmplt(Vec4::INFINITY)
    }

    /// Of the pieces as wholes.
    #[inline(always)]
    fn row(&self, radius: Vec4) -> Row {
        Row::of(
            [&self.low, &self.high, &self.way],
            [self.spread, self.own, radius, self.keep],
        )
    }

    /// Of the links of every lane's piece.
    #[inline(always)]
    fn store(&self, mut sweeps: [&mut Sweep; LANES]) {
        let [x, y, z] = self.middle.0;
        hand_out([x, y, z, self.keep], &mut sweeps, |sweep| &mut sweep.middle);
        let [x, y, z] = self.along.0;
        let along = [x, y, z, self.rounding];
        hand_out(along, &mut sweeps, |sweep| &mut sweep.along);
        for axis in 0..3 {
            let of_axis = |vectors: &[Vectors; PIECE]| vectors.map(|vectors| vectors.0[axis]);
            let center = of_axis(&self.center);
            hand_out(center, &mut sweeps, |sweep| &mut sweep.center.0[axis]);
            let half = of_axis(&self.half);
            hand_out(half, &mut sweeps, |sweep| &mut sweep.half.0[axis]);
            let ways = of_axis(&self.ways);
            hand_out(ways, &mut sweeps, |sweep| &mut sweep.ways.0[axis]);
        }
        hand_out(self.reach, &mut sweeps, |sweep| &mut sweep.reach);
        hand_out(self.per_square, &mut sweeps, |sweep| &mut sweep.per_square);
        hand_out(self.spreads, &mut sweeps, |sweep| &mut sweep.spreads);
        for (lane, sweep) in sweeps.into_iter().enumerate() {
            sweep.own = one(&self.own, lane);
        }
    }
}

/// Hands out four vectors, of four strands each, to those strands.
#[inline(always)]
fn hand_out(
    [a, b, c, d]: [Vec4; 4],
    sweeps: &mut [&mut Sweep; LANES],
    field: impl Fn(&mut Sweep) -> &mut Vec4,
) {
    let by_lane = Mat4::from_cols(a, b, c, d).transpose();
    *field(sweeps[0]) = by_lane.x_axis;
    *field(sweeps[1]) = by_lane.y_axis;
    *field(sweeps[2]) = by_lane.z_axis;
    *field(sweeps[3]) = by_lane.w_axis;
}
