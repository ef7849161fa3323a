//! Locks keep out of each other.
//!
//! Strands that are apart at rest may not pass through each other in motion. Every strand stands for a lock, a tube of
//! [`Params::lock_radius`](crate::Params::lock_radius), and is cut into pieces of a few links. In each step the pieces that come near each
//! other are found by boxes around what they sweep. Where two of their links would come nearer than both radii, a plane half way between where
//! their own motion takes them keeps both on their sides ([`Contact`]), as a body's surface would: both know it beforehand, so strands stay
//! independent within a step. Pieces that are nearer than that at rest are left alone: a style's locks lie in each other, and
//! [`Mutual`](crate::Mutual) holds them. Those that are a little farther apart keep a share of that distance. What is recalled passes through others, which would
//! hold it on a shoulder, and so do neighbours that a violent motion has brought onto each other's wrong side, which would jam there.
//!
//! No strand's answer hangs on the order in which others are found: of all planes the deepest holds.
//!
//! Its parts, of which each imports those above it alone: `meeting`, two links; `single`, numbers; `boxes`, around what pieces sweep, by fours; `keeps`, how far
//! what is near at rest keeps apart; `ways`, where strands go; `pairs`, which come near each other.

mod boxes;
mod keeps;
mod meeting;
mod pairs;
mod single;
mod ways;

use std::array;

use crate::{
    lanes::{LANES, Lane, Mask, Number, Vec3},
    surroundings::Surroundings,
    threads::join,
};

use super::{
    batch::{Batch, BatchState},
    contact::{Contact, Surface},
    stage::GAMMA,
};
use boxes::FOUR;
use glam::{DQuat, DVec3};
use keeps::Keeps;
use meeting::{Links, Meeting, closest};
use pairs::{Pairs, ones};
use ways::{PIECE, Ways, is_a_lock};

/// Links that come this near to touching, in m, get a plane.
const NEAR: f64 = 2e-3;

/// Locks that are apart at rest don't come nearer than both radii or this share of how far they are apart then, whichever is less. Were it 1,
/// locks side by side would press on each other as soon as they move.
const OF_REST: f64 = 0.5;

/// Of the planes before a particle that one holds behind which it would be deepest, where what two links lack at the start counts this much: those
/// that are about to pass through each other come first.
const LACKING: f64 = 5.0;

/// A plane holds the end of a link where it touches within this share of the link from that end.
const END: f64 = 0.75;

/// Locks part by less once one of both has been restless for the first of these times, in s, and no more after the second: see [`super::unrest`].
pub(super) const PATIENCE: [f64; 2] = [2.0, 4.0];

/// Neighbours at rest are on each other's wrong side where what keeps them apart points against the way that was between them then by more than this, as
/// a cosine. The more is allowed, the more locks stay in tangles.
const WRONG_SIDE: f64 = 0.1;

/// What is recalled by more than this share of what it could be passes through other locks, which would hold it where it lies.
const RECALLED: f64 = 0.1;

/// Tasks that look for planes in a step.
const TASKS: usize = 8;
/// Pairs of fours that are worth a task.
const WORTH_A_TASK: usize = 64;

/// Links of one strand.
#[derive(Clone, Copy, Debug)]
struct Piece {
    batch: usize,
    lane: usize,
    first: usize,
    links: usize,
    /// That of its first link's end, in the list of all.
    particle: usize,
    /// In m.
    radius: f64,
    /// The strand's own number, which hangs on nothing else.
    id: u32,
}

/// A link at rest, in the style's space.
#[derive(Clone, Copy, Debug)]
struct AtRest {
    middle: DVec3,
    direction: DVec3,
}

/// Pairs of links that may meet, lane by lane.
struct Near {
    count: usize,
    /// First those of the strand with the smaller id, so that nothing hangs on the order of strands.
    links: [Links; 2],
    /// How far they keep from each other, how far they go against their roots, and the mean way of these, in m.
    keep: Lane,
    goes: Lane,
    shift: Vec3,
    /// The share that they part by of what those do that aren't restless.
    parts: Lane,
    sides: [[Link; 2]; LANES],
}

impl Near {
    const NONE: Self = Self {
        count: 0,
        links: [Links::NONE; 2],
        keep: Lane::ZERO,
        goes: Lane::ZERO,
        shift: Vec3::ZERO,
        parts: Lane::ZERO,
        sides: [[Link {
            piece: 0,
            number: 0,
        }; 2]; LANES],
    };
}

/// A link by its piece and its number there.
#[derive(Clone, Copy, Debug)]
struct Link {
    piece: usize,
    number: usize,
}

/// Pairs of links of which some meet.
#[derive(Clone, Debug)]
struct Met {
    meeting: Meeting,
    sides: [[Link; 2]; LANES],
}

/// Pieces that may meet: how far they keep from each other, infinite for as far as any; besides their radii, how far that is; by how much going against
/// each other is slow; and how much farther than half way through the step they may meet, besides their radii; in m.
#[derive(Clone, Copy, Debug)]
struct NearPieces {
    pieces: [usize; 2],
    keep: f32,
    more: f32,
    slow: f32,
    farther: f32,
}

/// What a task finds in a step.
#[derive(Clone, Debug, Default)]
struct Found {
    near: Vec<NearPieces>,
    met: Vec<Met>,
    planes: Vec<Plane>,
}

/// The locks of a solver.
#[derive(Clone, Debug)]
pub(super) struct Locks {
    /// Strand by strand, in the order of batches and lanes.
    pieces: Vec<Piece>,
    /// The first piece of every four of a strand.
    fours: Vec<usize>,
    keeps: Keeps,
    /// The links of each piece.
    at_rest: Vec<[AtRest; PIECE]>,
    /// How each piece's root has turned since, at the end of the step at hand; None of strands that are tied, which cross in their ties.
    turns: Vec<Option<DQuat>>,
    /// How much of the way each piece parts by in the step at hand that it would if it weren't restless, 0 to 1.
    parts: Vec<f64>,
    /// Whether each piece passes through others in the step at hand, as it is recalled.
    passes: Vec<bool>,
    /// The first particle of every batch in the list of all: particle by particle, lane by lane.
    particles: Vec<usize>,
    /// Of the step at hand.
    dt: f64,
    ways: Ways,
    pairs: Pairs,
    found: Vec<Found>,
    /// Of every particle, the plane that holds it, and the task that found it.
    holds: Vec<Option<(Plane, usize)>>,
}

/// A plane before a particle: of links that have met, by their place in the list of those, their lane there, and the side that the particle is on.
#[derive(Clone, Copy, Debug)]
struct Plane {
    particle: usize,
    met: usize,
    lane: usize,
    side: usize,
    /// How far behind it the particle would be at the end of the step, by its own motion, in m.
    depth: f64,
    /// What decides which of several holds.
    urgency: f64,
}

impl Locks {
    /// Of strands at rest in `states`, those with a lock's radius; `ids` are of all strands. None without any.
    pub(super) fn new(batches: &[Batch], states: &[BatchState], ids: &[u32]) -> Option<Self> {
        let (mut pieces, mut particles) = (Vec::new(), vec![0]);
        // Of every four of a strand: its first piece, and which strand.
        let (mut fours, mut strands) = (Vec::new(), Vec::new());
        for (b, batch) in batches.iter().enumerate() {
            let particle = particles[b];
            particles.push(particle + batch.count() * LANES);
            for lane in 0..LANES {
                let (count, radius) = (batch.counts[lane], batch.lock_radius[lane]);
                let Some(strand) = batch.strands[lane].filter(|_| is_a_lock(batch, lane)) else {
                    continue;
                };
                for first in (0..count.div_ceil(PIECE)).step_by(FOUR) {
                    fours.push(pieces.len() + first);
                    strands.push(strand as u32);
                }
                pieces.extend((0..count).step_by(PIECE).map(|first| Piece {
                    batch: b,
                    lane,
                    first,
                    links: PIECE.min(count - first),
                    particle: particle + first * LANES + lane,
                    radius,
                    id: ids[strand],
                }));
            }
        }
        if pieces.is_empty() {
            return None;
        }
        let mut locks = Self {
            keeps: Keeps::new(&[]),
            at_rest: Vec::new(),
            turns: vec![None; pieces.len()],
            parts: vec![1.0; pieces.len()],
            passes: vec![false; pieces.len()],
            dt: 0.0,
            ways: Ways::new(batches, &pieces),
            pairs: Pairs::new(strands),
            found: vec![Found::default(); TASKS],
            holds: vec![None; particles[batches.len()]],
            pieces,
            fours,
            particles,
        };
        locks.rest(batches, states);
        Some(locks)
    }

    /// Finds which pieces are near each other at rest.
    fn rest(&mut self, batches: &[Batch], states: &[BatchState]) {
        let still = Surroundings::default();
        // As far as a share of the distance is less than both radii.
        let more = (1.0 / OF_REST - 1.0, NEAR);
        self.ways
            .follow::<Lane>(batches, states, (&still, 0.0), more);
        let at_rest = |piece| {
            array::from_fn(|i| {
                let [[start, _], [end, _]] = self.ways.link(piece, i.min(piece.links - 1));
                AtRest {
                    middle: 0.5 * (start + end),
                    direction: (end - start).normalize_or_zero(),
                }
            })
        };
        self.at_rest = self.pieces.iter().map(at_rest).collect();
        self.pairs.find(&self.ways.bounds);
        let mut near = Vec::new();
        for &pair in self.pairs.all() {
            let [four, other] = pair.map(|four| four as usize);
            let fours = &self.ways.fours;
            let mut of_pair = keeps::Near::new();
            for bit in ones(fours[other].meet(&fours[four])) {
                let (i, j) = (bit / FOUR, bit % FOUR);
                let [one, its] = [self.fours[four] + i, self.fours[other] + j];
                let [one, its] = [one, its].map(|piece| &self.pieces[piece]);
                let radii = one.radius + its.radius;
                let apart = self.apart_at_rest(one, its);
                if apart < radii + NEAR {
                    of_pair.push(([i, j], 0.0));
                } else if apart * OF_REST < radii {
                    of_pair.push(([i, j], (apart * OF_REST) as f32));
                }
            }
            if !of_pair.is_empty() {
                near.push((pair, of_pair));
            }
        }
        self.keeps = Keeps::new(&near);
    }

    /// How far two pieces are from each other at the start.
    fn apart_at_rest(&self, one: &Piece, other: &Piece) -> f64 {
        let mut its = Links::NONE;
        for j in 0..LANES {
            its.set(j, self.ways.link(other, j.min(other.links - 1)));
        }
        let mut least = f64::INFINITY;
        for i in 0..one.links {
            let mut link = Links::NONE;
            (0..LANES).for_each(|lane| link.set(lane, self.ways.link(one, i)));
            let apart = closest([link.start, link.end], [its.start, its.end]).apart;
            let apart = apart.length_squared().sqrt();
            least = (0..LANES).fold(least, |least, j| least.min(apart[j]));
        }
        least
    }

    /// Finds the planes of a step of `dt` seconds, in which particles go on as they do now.
    pub(super) fn find<T: Number>(
        &mut self,
        batches: &[Batch],
        states: &[BatchState],
        surroundings: &Surroundings,
        dt: f64,
    ) {
        self.dt = dt;
        for (parts, piece) in self.parts.iter_mut().zip(&self.pieces) {
            let [from, until] = PATIENCE;
            let restless = states[piece.batch].restless[piece.lane];
            *parts = ((until - restless) / (until - from)).clamp(0.0, 1.0);
        }
        self.follow_roots(batches, states, surroundings);
        self.passes.fill(false);
        if states.iter().any(|state| !state.recalled.is_empty()) {
            for (passes, piece) in self.passes.iter_mut().zip(&self.pieces) {
                let recalled = states[piece.batch].recalled.iter();
                let mut own = recalled.skip(piece.first).take(piece.links);
                *passes = own.any(|share| share[piece.lane] > RECALLED);
            }
        }
        self.ways
            .follow::<T>(batches, states, (surroundings, dt), (0.0, 0.0));
        self.pairs.find(&self.ways.bounds);
        let mut found = std::mem::take(&mut self.found);
        let tasks = (self.pairs.all().len() / WORTH_A_TASK).clamp(1, TASKS);
        // What one task has found another may find in the next step: with room for that, no list grows once hair has moved.
        let most = |count: fn(&Found) -> usize| found.iter().map(count).max().unwrap_or(0);
        let room = [
            most(|found| found.near.len()),
            most(|found| found.met.len()),
            most(|found| found.planes.len()),
        ];
        for Found { near, met, planes } in &mut found {
            near.clear();
            met.clear();
            planes.clear();
            near.reserve(room[0]);
            met.reserve(room[1]);
            planes.reserve(room[2]);
        }
        self.find_all::<T>(self.pairs.all(), &mut found[..tasks]);
        self.holds.fill(None);
        for (task, Found { planes, .. }) in found.iter().enumerate() {
            for plane in planes {
                let holds = &self.holds[plane.particle];
                let is_first = holds.as_ref().is_none_or(|(held, by)| {
                    let whose = || self.facing(plane, &found[task]);
                    let other = || self.facing(held, &found[*by]);
                    let more = plane.urgency.total_cmp(&held.urgency);
                    more.then_with(|| other().cmp(&whose())).is_gt()
                });
                if is_first {
                    self.holds[plane.particle] = Some((*plane, task));
                }
            }
        }
        self.found = found;
    }

    /// Finds how roots have turned since rest.
    fn follow_roots(
        &mut self,
        batches: &[Batch],
        states: &[BatchState],
        surroundings: &Surroundings,
    ) {
        let mut tied: Vec<usize> = surroundings.anchors.iter().map(|own| own.strand).collect();
        tied.sort_unstable();
        for (turn, piece) in self.turns.iter_mut().zip(&self.pieces) {
            // A step that is tried without ties, to find where they go, moves as those before it.
            let was_tied = states[piece.batch].tied[piece.lane];
            let strand = batches[piece.batch].strands[piece.lane];
            let free = strand.filter(|strand| !was_tied && tied.binary_search(strand).is_err());
            *turn = free.map(|strand| surroundings.roots.of(strand).rotation);
        }
    }

    /// The link that a plane keeps a particle from: its strand's id and its number.
    fn facing(&self, plane: &Plane, found: &Found) -> (u32, usize) {
        let link = found.met[plane.met].sides[plane.lane][1 - plane.side];
        let piece = &self.pieces[link.piece];
        (piece.id, piece.first + link.number)
    }

    /// Finds the planes of pairs of fours, in as many tasks as there are lists for what is found.
    fn find_all<T: Number>(&self, pairs: &[[u32; 2]], found: &mut [Found]) {
        if let [found] = found {
            self.pair_up::<T>(pairs, &mut found.near);
            self.find_among::<T>(found);
            return;
        }
        let half = found.len() / 2;
        let (pair, later_pairs) = pairs.split_at(pairs.len() * half / found.len());
        let (found, later_found) = found.split_at_mut(half);
        join(
            || self.find_all::<T>(pair, found),
            || self.find_all::<T>(later_pairs, later_found),
        );
    }

    /// Finds the pieces of pairs of fours that may meet.
    fn pair_up<T: Number>(&self, pairs: &[[u32; 2]], near: &mut Vec<NearPieces>) {
        let fours = &self.ways.fours[..];
        T::run(
            #[inline(always)]
            || {
                for &pair in pairs {
                    let apart = self.keeps.between(pair);
                    let [four, other] = pair.map(|four| four as usize);
                    let (own, its) = (&fours[four], &fours[other]);
                    let mut meet = its.meet(own) & apart.kept;
                    while meet != 0 {
                        let i = meet.trailing_zeros() as usize / FOUR;
                        let of_piece = meet >> (FOUR * i) & 0b1111;
                        meet &= !(0b1111 << (FOUR * i));
                        let keep = apart.keeps[i];
                        let (may_meet, far) = its.near(own, i, keep);
                        let keep = keep.to_array();
                        let [more, slow, farther] = far.map(|of| of.to_array());
                        for j in ones(of_piece & may_meet) {
                            near.push(NearPieces {
                                pieces: [self.fours[four] + i, self.fours[other] + j],
                                keep: keep[j],
                                more: more[j],
                                slow: slow[j],
                                farther: farther[j],
                            });
                        }
                    }
                }
            },
        );
    }

    /// Finds the links of such pieces that may meet, and the planes of those that do, four by four.
    fn find_among<T: Number>(&self, found: &mut Found) {
        let Found {
            near, met, planes, ..
        } = found;
        T::run(
            #[inline(always)]
            || {
                let mut links = Near::NONE;
                for &NearPieces {
                    pieces: [own, other],
                    keep,
                    more,
                    slow,
                    farther,
                } in &*near
                {
                    if self.passes[own] || self.passes[other] {
                        continue;
                    }
                    let [sweep, its] = [&self.ways.sweeps[own], &self.ways.sweeps[other]];
                    let found = sweep.near(its, (more, slow, farther));
                    if found != 0 {
                        let radii = self.pieces[own].radius + self.pieces[other].radius;
                        let keep = f64::from(keep).min(radii);
                        self.meet_all::<T>([own, other], (found, keep), &mut links, (met, planes));
                    }
                }
                self.meet::<T>(&mut links, (met, planes));
            },
        );
    }

    /// Adds the links of two pieces that are near each other to some that are, bits as of [`Sweep::near`](ways::Sweep::near), and has four meet as soon
    /// as there are so many.
    #[inline(always)]
    fn meet_all<T: Number>(
        &self,
        [own, other]: [usize; 2],
        (mut found, keep): (u32, f64),
        near: &mut Near,
        (met, planes): (&mut Vec<Met>, &mut Vec<Plane>),
    ) {
        let goes = f64::from(self.ways.sweeps[own].own + self.ways.sweeps[other].own);
        let [piece, its] = [&self.pieces[own], &self.pieces[other]];
        let shift = (self.ways.shift(piece) + self.ways.shift(its)) * 0.5;
        let parts = self.parts[own].min(self.parts[other]);
        let side = usize::from(piece.id > its.id);
        while found != 0 {
            let link = found.trailing_zeros() as usize;
            found &= found - 1;
            let (i, j) = (link / PIECE, link % PIECE);
            let lane = near.count % LANES;
            near.links[side].set(lane, self.ways.link(piece, i));
            near.links[1 - side].set(lane, self.ways.link(its, j));
            near.keep[lane] = keep;
            near.goes[lane] = goes;
            near.shift.set(lane, shift);
            near.parts[lane] = parts;
            let sides = &mut near.sides[lane];
            (sides[side].piece, sides[side].number) = (own, i);
            (sides[1 - side].piece, sides[1 - side].number) = (other, j);
            near.count += 1;
            if near.count == LANES {
                self.meet::<T>(near, (met, planes));
            }
        }
    }

    /// Adds those of some links that are near that meet, with the planes before their particles, and forgets them.
    fn meet<T: Number>(&self, near: &mut Near, (met, planes): (&mut Vec<Met>, &mut Vec<Plane>)) {
        let count = std::mem::take(&mut near.count);
        let meeting = T::run(
            #[inline(always)]
            || {
                let links = [near.links[0].load::<T>(), near.links[1].load::<T>()];
                let keep = (near.keep.load(), near.goes.load(), near.parts.load());
                Meeting::of(&links[0], &links[1], keep, (near.shift.load(), self.dt))
            },
        );
        let Some(meeting) = meeting else {
            return;
        };
        for lane in (0..count).filter(|&lane| meeting.meets[lane] > 0.0) {
            let normal = meeting.normal.get(lane);
            if self.is_on_wrong_side(near.sides[lane], normal) {
                continue;
            }
            for side in [0, 1] {
                let Link { piece, number } = near.sides[lane][side];
                let piece = &self.pieces[piece];
                let (at, push) = (meeting.at[side][lane], meeting.push[side][lane]);
                // The root's end is held as it is.
                let [start, end] = [at < END && piece.first + number > 0, at > 1.0 - END];
                let particle = piece.particle + number * LANES;
                let mut add = |particle: usize, share: f64| {
                    planes.push(Plane {
                        particle,
                        met: met.len(),
                        lane,
                        side,
                        depth: push / share,
                        urgency: push / share + LACKING * meeting.lacks[lane],
                    });
                };
                // An end that is held alone holds the place where links touch.
                if start {
                    add(particle - LANES, if end { 1.0 } else { 1.0 - at });
                }
                if end {
                    add(particle, if start { 1.0 } else { at });
                }
            }
        }
        met.push(Met {
            meeting,
            sides: near.sides,
        });
    }

    /// Whether two links that a plane would keep apart are neighbours at rest, as seen along the first, which lies on the other side of the second then.
    fn is_on_wrong_side(&self, [own, its]: [Link; 2], normal: DVec3) -> bool {
        let (Some(turn), Some(_)) = (self.turns[own.piece], self.turns[its.piece]) else {
            return false;
        };
        // What goes on all the same is to come to rest as it lies.
        if self.parts[own.piece].min(self.parts[its.piece]) < 1.0 {
            return false;
        }
        let radii = self.pieces[own.piece].radius + self.pieces[its.piece].radius;
        let [link, other] = [own, its].map(|link| &self.at_rest[link.piece][link.number]);
        let way = link.middle - other.middle;
        let beside = way - link.direction * way.dot(link.direction);
        let apart = beside.length();
        apart * OF_REST < radii && normal.dot(turn * beside) < -WRONG_SIDE * apart
    }

    /// Adds the planes before the strands of a batch that are `active` to the loads' contacts, where the roots end at `root`. Returns the number of
    /// particles that have one.
    pub(crate) fn part(
        &self,
        (index, batch, state): (usize, &Batch, &BatchState),
        root: Vec3,
        active: Mask,
        (contacts, touched): (&mut [Contact], &mut Vec<usize>),
    ) -> usize {
        let count = batch.count();
        let holds = &self.holds[self.particles[index]..self.particles[index + 1]];
        let mut found = 0;
        for (k, holds) in holds.chunks_exact(LANES).enumerate() {
            let contact = &mut contacts[count + k];
            (contact.on, contact.holds) = (Lane::ZERO, Lane::ZERO);
            for lane in (0..LANES).filter(|&lane| active.get(lane)) {
                let Some((plane, task)) = &holds[lane] else {
                    continue;
                };
                let meeting = &self.found[*task].met[plane.met].meeting;
                found += 1;
                if touched.last() != Some(&(count + k)) {
                    touched.push(count + k);
                }
                let normal = meeting.normal.get(plane.lane);
                let normal = if plane.side == 0 { normal } else { -normal };
                let (y, v) = (state.y[k].get(lane), state.v[k].get(lane));
                let before = normal.dot(y) + meeting.past[plane.lane];
                let end = normal.dot(y + v * self.dt) + plane.depth;
                let shift = root.get(lane) - state.root.get(lane);
                let surface = Surface {
                    normal,
                    start: f64::NEG_INFINITY, // locks part by little in a step
                    mid: before + (end - before) * GAMMA,
                    end,
                    flow: (meeting.flow.get(plane.lane) - shift) / self.dt,
                };
                contact.set(lane, &surface, (batch, state), (count + k, k));
            }
        }
        found
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Params, Solver, Strands};

    #[test]
    fn boxes_and_balls_hide_nothing_that_meets() {
        // In m/s: links that go slowly against each other, and those that go far.
        for (speed, least) in [(0.2, 50), (0.5, 500), (3.0, 5000)] {
            let found = hides_nothing(speed);
            assert!(found > least, "{speed} m/s: {found}");
        }
    }

    /// Compares what is found among strands that go so fast with all links that meet. Returns the number of planes.
    fn hides_nothing(speed: f64) -> usize {
        let spread = |i: u32, k: u32| ((i * 7919 + k * 104_729) % 1009) as f32 / 1009.0 - 0.5;
        let place = |i, k| glam::Vec3::new(spread(i, k), spread(i, k + 1), spread(i, k + 2));
        let mut strands = Strands::new();
        for id in 0..80 {
            let (from, along) = (place(id, 1), place(id, 4));
            let points: Vec<glam::Vec3> = (0..=4 + id % 7)
                .map(|i| from * 0.2 + along * (0.02 * i as f32))
                .collect();
            strands.push(id, &points, None).unwrap();
        }
        let radius = |i: usize| Params {
            lock_radius: 0.002 * (i % 4) as f64,
            ..Params::default()
        };
        let (mut solver, mut state) = Solver::with(&strands, radius).unwrap();
        for (b, batch) in (0..).zip(&mut state.batches) {
            for (k, v) in (0..).zip(&mut batch.v) {
                for lane in 0..LANES {
                    let way = place(40 * b + k, 7 + lane as u32);
                    v.set(lane, way.as_dvec3() * speed);
                }
            }
        }
        let Solver { locks, batches, .. } = &mut solver;
        let (locks, _) = locks.as_mut().unwrap();
        let surroundings = Surroundings::default();
        locks.find::<Lane>(batches, &state.batches, &surroundings, 1.0 / 60.0);
        let (mut all, mut near) = (Found::default(), Near::NONE);
        for (one, two) in (0..locks.pieces.len()).flat_map(|i| (0..i).map(move |j| (j, i))) {
            let [own, other] = [one, two].map(|i| &locks.pieces[i]);
            let four = |piece| locks.fours.partition_point(|&first| first <= piece) - 1;
            let fours = [four(one), four(two)];
            let [i, j] = [one - locks.fours[fours[0]], two - locks.fours[fours[1]]];
            let apart = locks.keeps.between(fours.map(|four| four as u32));
            let keep = f64::from(apart.keeps[i][j]).min(own.radius + other.radius);
            let pair = [own, other].map(|piece| (piece.batch, piece.lane));
            if pair[0] == pair[1] || keep == 0.0 {
                continue;
            }
            let row = (1 << other.links) - 1;
            let every = (0..own.links).fold(0, |all, i| all | row << (PIECE * i));
            let Found { met, planes, .. } = &mut all;
            locks.meet_all::<Lane>([one, two], (every, keep), &mut near, (met, planes));
        }
        locks.meet::<Lane>(&mut near, (&mut all.met, &mut all.planes));
        let sorted = |found: &[Found]| {
            let of_task = |found: &Found| -> Vec<_> {
                let key = |plane: &Plane| {
                    let whose = locks.facing(plane, found);
                    (plane.particle, whose, plane.depth.to_bits())
                };
                found.planes.iter().map(key).collect()
            };
            let mut keys: Vec<_> = found.iter().flat_map(of_task).collect();
            keys.sort_unstable();
            keys
        };
        let (found, all) = (sorted(&locks.found), sorted(&[all]));
        assert_eq!(found, all);
        found.len()
    }
}
