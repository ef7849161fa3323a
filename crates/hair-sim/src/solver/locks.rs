//! Locks keep out of each other.
//!
//! Strands that are apart at rest may not pass through each other in motion. Every strand stands for a lock, a tube of
//! [`Params::lock_radius`](crate::Params::lock_radius), and is cut into pieces of a few links. In each step the pieces that come near each
//! other are found by cells of space. Where two of their links would come nearer than both radii, a plane half way between where their own
//! motion takes them keeps both on their sides ([`Contact`]), as a body's surface would: both know it beforehand, so strands stay
//! independent within a step. Pieces that are nearer than that at rest are left alone: a style's locks lie in each other, and
//! [`Mutual`](crate::Mutual) holds them.
//!
//! No strand's answer hangs on the order in which others are found: of all planes the deepest holds.

use glam::DVec3;

use crate::{
    forces::mutual::Course,
    lanes::{LANES, Lane, Mask, Vec3},
    surroundings::Surroundings,
    threads::join,
};

use super::{
    batch::{Batch, BatchState},
    contact::{Contact, Surface},
    drive::roots,
    stage::GAMMA,
};

/// The most links of a piece.
const PIECE: usize = 4;

/// Links that come this near to touching, in m, get a plane, and so do those that would if both went as much farther as they go against their
/// roots: what acts in the step may bring them together.
const NEAR: f64 = 2e-3;

/// Links that are found in each other part by this much of what they lack in a step, at this speed in m/s at the most.
const PART: f64 = 0.2;
const PART_SPEED: f64 = 0.1;

/// How much a plane goes with the mean of two links' motion, where they differ: with 1 locks that lie on each other shake for ever.
const WITH_MEAN: f64 = 0.5;

/// A plane holds the end of a link where it touches within this share of the link from that end.
const END: f64 = 0.75;

/// Pieces that go farther than this against their roots in a step, in m, meet nothing: they would meet all hair there is.
const FARTHEST: f64 = 0.1;

/// Looks along the way of two links for where they meet; they touch where they are farther apart by less than this share.
const MOST_LOOKS: usize = 12;
const TOUCH: f64 = 0.02;

/// Links nearer than this, in m, have no way out.
const LEAST_APART: f64 = 1e-9;

/// Links of one strand.
#[derive(Clone, Copy, Debug)]
struct Piece {
    batch: usize,
    lane: usize,
    first: usize,
    links: usize,
    /// In m.
    radius: f64,
    /// The strand's own number, which hangs on nothing else.
    id: u32,
}

/// A piece in a step: the points of its links, root end first, and a ball around their ways, with the lock's radius.
#[derive(Clone, Copy, Debug)]
struct Way {
    points: [Course; PIECE + 1],
    center: DVec3,
    reach: f64,
    /// Balls around the ways of the links themselves.
    balls: [(DVec3, f64); PIECE],
    /// How far it may be from there, in m.
    slack: f64,
    /// The way of the root.
    shift: DVec3,
}

impl Way {
    const NOWHERE: Self = Self {
        points: [Course {
            before: DVec3::ZERO,
            now: DVec3::ZERO,
        }; PIECE + 1],
        center: DVec3::ZERO,
        reach: f64::NAN,
        balls: [(DVec3::ZERO, 0.0); PIECE],
        slack: 0.5 * NEAR,
        shift: DVec3::ZERO,
    };

    fn link(&self, link: usize) -> [Course; 2] {
        [self.points[link], self.points[link + 1]]
    }
}

/// The locks of a solver.
#[derive(Clone, Debug)]
pub(super) struct Locks {
    pieces: Vec<Piece>,
    /// The first piece of every strand, by batch and lane, and their number at the end.
    first: Vec<usize>,
    /// The pieces that are near a piece at rest: from `near_from` of it to that of the next.
    near: Vec<u32>,
    near_from: Vec<usize>,
    /// Of the step at hand.
    ways: Vec<Way>,
    cells: Cells,
}

/// What a task finds planes with.
#[derive(Clone, Debug, Default)]
pub(crate) struct Finds {
    /// Of every piece: the last one near to which it is at rest, as far as it was asked. It stays true whatever is asked next.
    near: Vec<u32>,
    /// Of every particle of a batch: how far behind its plane it would be, and from whose link that is.
    deepest: Vec<[(f64, u32, usize); LANES]>,
}

impl Locks {
    /// Of strands at rest in `states`, those with a lock's radius; `ids` are of all strands. None without any.
    pub(super) fn new(batches: &[Batch], states: &[BatchState], ids: &[u32]) -> Option<Self> {
        let (mut pieces, mut first) = (Vec::new(), Vec::new());
        for (b, batch) in batches.iter().enumerate() {
            for lane in 0..LANES {
                first.push(pieces.len());
                let (count, radius) = (batch.counts[lane], batch.lock_radius[lane]);
                let Some(strand) = batch.strands[lane].filter(|_| radius > 0.0) else {
                    continue;
                };
                pieces.extend((0..count).step_by(PIECE).map(|first| Piece {
                    batch: b,
                    lane,
                    first,
                    links: PIECE.min(count - first),
                    radius,
                    id: ids[strand],
                }));
            }
        }
        first.push(pieces.len());
        if pieces.is_empty() {
            return None;
        }
        let mut locks = Self {
            ways: vec![Way::NOWHERE; pieces.len()],
            cells: Cells::new(pieces.len()),
            near: Vec::new(),
            near_from: vec![0],
            pieces,
            first,
        };
        let at_rest = |piece: &Piece| {
            let state = &states[piece.batch];
            let root = state.root.get(piece.lane);
            way(piece, DVec3::ZERO, |k| {
                let at = root + k.map_or(DVec3::ZERO, |k| state.y[k].get(piece.lane));
                Course {
                    before: at,
                    now: at,
                }
            })
        };
        for (way, piece) in locks.ways.iter_mut().zip(&locks.pieces) {
            *way = at_rest(piece);
        }
        locks.cells.sort(&locks.ways);
        for (index, piece) in locks.pieces.iter().enumerate() {
            let way = &locks.ways[index];
            locks.cells.around(way, |other| {
                let (whose, its) = (&locks.pieces[other as usize], &locks.ways[other as usize]);
                let keep = piece.radius + whose.radius + NEAR;
                if apart(way, piece.links, its, whose.links) < keep {
                    locks.near.push(other);
                }
            });
            locks.near_from.push(locks.near.len());
        }
        Some(locks)
    }

    /// For a task whose strands have at most `count` links.
    pub(super) fn finds(&self, count: usize) -> Finds {
        Finds {
            near: vec![u32::MAX; self.pieces.len()],
            deepest: vec![[(0.0, 0, 0); LANES]; count],
        }
    }

    /// Finds where all pieces go in a step of `dt` seconds.
    pub(super) fn follow(
        &mut self,
        batches: &[Batch],
        states: &[BatchState],
        surroundings: &Surroundings,
        dt: f64,
    ) {
        let step = (batches, states, surroundings, dt);
        follow(&self.pieces, &mut self.ways, step);
        self.cells.sort(&self.ways);
    }

    /// Adds the planes between the strands of a batch that are `active` and all others to the loads' contacts, where the roots end at
    /// `root`. Returns the number of particles that have one.
    pub(crate) fn part(
        &self,
        (index, batch, state): (usize, &Batch, &BatchState),
        (root, dt): (Vec3, f64),
        active: Mask,
        finds: &mut Finds,
        (contacts, touched): (&mut [Contact], &mut Vec<usize>),
    ) -> usize {
        let count = batch.count();
        for contact in &mut contacts[count..2 * count] {
            (contact.on, contact.holds) = (Lane::ZERO, Lane::ZERO);
        }
        let mut found = 0;
        for lane in (0..LANES).filter(|&lane| active.get(lane)) {
            let place = index * LANES + lane;
            let shift = root.get(lane) - state.root.get(lane);
            for own in self.first[place]..self.first[place + 1] {
                for &near in &self.near[self.near_from[own]..self.near_from[own + 1]] {
                    finds.near[near as usize] = own as u32;
                }
                let first = self.pieces[own].first;
                let Finds { near, deepest } = &mut *finds;
                self.cells.around(&self.ways[own], |other| {
                    let whose = &self.pieces[other as usize];
                    let is_own = (whose.batch, whose.lane) == (index, lane);
                    if is_own || near[other as usize] == own as u32 {
                        return;
                    }
                    self.meet([own, other as usize], dt, |k, meeting, depth, whose| {
                        let contact = &mut contacts[count + k];
                        let is_new = contact.on[lane] < 0.5;
                        let (deep, id, link) = deepest[k][lane];
                        let is_deeper = (depth.total_cmp(&deep)).then((id, link).cmp(&whose));
                        if !is_new && is_deeper.is_le() {
                            return;
                        }
                        deepest[k][lane] = (depth, whose.0, whose.1);
                        found += usize::from(is_new);
                        if contact.on == Lane::ZERO {
                            touched.push(count + k);
                        }
                        let (normal, y) = (meeting.normal, state.y[k].get(lane));
                        let before = normal.dot(y) + meeting.past;
                        let now = self.ways[own].points[k + 1 - first].now - root.get(lane);
                        let end = normal.dot(now) + depth;
                        let surface = Surface {
                            normal,
                            mid: before + (end - before) * GAMMA,
                            end,
                            flow: (meeting.flow - shift) / dt,
                        };
                        contact.set(lane, &surface, (batch, state), (count + k, k));
                    });
                });
            }
        }
        found
    }

    /// Tells of every particle of the first of two pieces how it meets the other in a step of `dt` seconds, how far behind the plane it would be
    /// at the end, and which link that is: its strand's id and its number.
    fn meet(
        &self,
        [own, other]: [usize; 2],
        dt: f64,
        mut tell: impl FnMut(usize, &Meeting, f64, (u32, usize)),
    ) {
        let (piece, whose) = (&self.pieces[own], &self.pieces[other]);
        let (way, its) = (&self.ways[own], &self.ways[other]);
        let keep = piece.radius + whose.radius;
        let slack = way.slack + its.slack;
        let shift = (way.shift + its.shift) * 0.5;
        for i in 0..piece.links {
            let link = way.link(i);
            let (center, reach) = way.balls[i];
            // Most are far from this link as a whole.
            let most = its.reach + reach + piece.radius + way.slack;
            if (its.center - center).length_squared() > most * most {
                continue;
            }
            for j in 0..whose.links {
                let (other_center, other_reach) = its.balls[j];
                let most = reach + other_reach + keep + slack;
                if (center - other_center).length_squared() > most * most {
                    continue;
                }
                let facing = its.link(j);
                let Some(meeting) = Meeting::of(&link, &facing, [keep, slack], (shift, dt)) else {
                    continue;
                };
                let first = piece.first + i;
                let facing = (whose.id, whose.first + j);
                let [start, end] = [meeting.at < END, meeting.at > 1.0 - END];
                // An end that is held alone holds the place where links touch.
                if start && first > 0 {
                    let share = if end { 1.0 } else { 1.0 - meeting.at };
                    tell(first - 1, &meeting, meeting.push / share, facing);
                }
                if end {
                    let share = if start && first > 0 { 1.0 } else { meeting.at };
                    tell(first, &meeting, meeting.push / share, facing);
                }
            }
        }
    }
}

/// The ways of pieces in a step.
fn follow(pieces: &[Piece], ways: &mut [Way], step: (&[Batch], &[BatchState], &Surroundings, f64)) {
    // A task for fewer of them costs more than they do.
    if pieces.len() > 1024 {
        let half = pieces.len() / 2;
        let ((one, other), (these, those)) = (pieces.split_at(half), ways.split_at_mut(half));
        join(|| follow(one, these, step), || follow(other, those, step));
        return;
    }
    let (batches, states, surroundings, dt) = step;
    for (of_batch, ways) in by_batch(pieces, ways) {
        let (batch, state) = (&batches[of_batch[0].batch], &states[of_batch[0].batch]);
        let (root, _) = roots(batch, surroundings);
        for (piece, to) in of_batch.iter().zip(ways) {
            let lane = piece.lane;
            if state.set_aside[lane].is_some() {
                *to = Way::NOWHERE;
                continue;
            }
            let (before, now) = (state.root.get(lane), root.get(lane));
            *to = way(piece, now - before, |k| {
                let Some(k) = k else {
                    return Course { before, now };
                };
                let y = state.y[k].get(lane);
                Course {
                    before: before + y,
                    now: now + y + state.v[k].get(lane) * dt,
                }
            });
        }
    }
}

/// Pieces and their ways, batch by batch.
fn by_batch<'a>(
    pieces: &'a [Piece],
    mut ways: &'a mut [Way],
) -> impl Iterator<Item = (&'a [Piece], &'a mut [Way])> {
    (pieces.chunk_by(|one, next| one.batch == next.batch)).map(move |of_batch| {
        let (these, left) = std::mem::take(&mut ways).split_at_mut(of_batch.len());
        ways = left;
        (of_batch, these)
    })
}

/// The way of a piece whose root moves by `shift`; `at` is where a particle is and goes, and of none the root.
fn way(piece: &Piece, shift: DVec3, at: impl Fn(Option<usize>) -> Course) -> Way {
    let mut way = Way {
        shift,
        ..Way::NOWHERE
    };
    let mut own = 0.0_f64;
    let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    for i in 0..=piece.links {
        let point = at((piece.first + i).checked_sub(1));
        low = low.min(point.before).min(point.now);
        high = high.max(point.before).max(point.now);
        own = own.max((point.now - point.before - shift).length_squared());
        way.points[i] = point;
    }
    way.center = (low + high) * 0.5;
    // What is not finite is nowhere, and so is what flies about.
    let whole = way.points[..=piece.links]
        .iter()
        .all(|point| point.before.is_finite() && point.now.is_finite());
    let own = own.sqrt();
    if whole && own < FARTHEST {
        for i in 0..piece.links {
            way.balls[i] = ball(&way.link(i));
        }
        way.slack += own;
        way.reach = (high - low).length() * 0.5 + piece.radius + way.slack;
    }
    way
}

/// A ball around the way of a link.
fn ball(link: &[Course; 2]) -> (DVec3, f64) {
    let [start, end] = link;
    let (before, now) = (start.before + end.before, start.now + end.now);
    let center = (before + now) * 0.25;
    let (along, other) = (end.before - start.before, end.now - start.now);
    let long = along.length_squared().max(other.length_squared());
    let reach = 0.25 * (now - before).length() + 0.5 * long.sqrt();
    (center, reach)
}

/// How far two pieces with so many links are from each other at the start.
fn apart(one: &Way, links: usize, other: &Way, others: usize) -> f64 {
    let mut least = f64::INFINITY;
    for i in 0..links {
        for j in 0..others {
            let ends = |link: [Course; 2]| link.map(|point| point.before);
            least = least.min(closest(ends(one.link(i)), ends(other.link(j))).length());
        }
    }
    least
}

/// The places on two segments that are nearest to each other, as shares of them, and the way to the first from the other.
#[derive(Clone, Copy)]
struct Closest {
    at: f64,
    other_at: f64,
    apart: DVec3,
}

impl Closest {
    fn length(&self) -> f64 {
        self.apart.length()
    }
}

/// After Ericson 2005, *Real-time collision detection*, 5.1.9.
fn closest([a, b]: [DVec3; 2], [c, d]: [DVec3; 2]) -> Closest {
    const LEAST: f64 = 1e-24;
    let (along, other, between) = (b - a, d - c, a - c);
    let (aa, ee, ff) = (
        along.length_squared(),
        other.length_squared(),
        other.dot(between),
    );
    let cc = along.dot(between);
    let (at, other_at) = if aa <= LEAST && ee <= LEAST {
        (0.0, 0.0)
    } else if aa <= LEAST {
        (0.0, (ff / ee).clamp(0.0, 1.0))
    } else if ee <= LEAST {
        ((-cc / aa).clamp(0.0, 1.0), 0.0)
    } else {
        let bb = along.dot(other);
        let area = aa * ee - bb * bb;
        // Of parallel ones any place will do; the middle changes least.
        let at = if area > 1e-9 * aa * ee {
            ((bb * ff - cc * ee) / area).clamp(0.0, 1.0)
        } else {
            0.5
        };
        let other_at = (bb * at + ff) / ee;
        if other_at < 0.0 {
            ((-cc / aa).clamp(0.0, 1.0), 0.0)
        } else if other_at > 1.0 {
            (((bb - cc) / aa).clamp(0.0, 1.0), 1.0)
        } else {
            (at, other_at)
        }
    };
    Closest {
        at,
        other_at,
        apart: between + along * at - other * other_at,
    }
}

/// How two links meet in a step.
struct Meeting {
    /// Where on the first link, as a share of it.
    at: f64,
    /// Towards the first link.
    normal: DVec3,
    /// How far behind the plane the first link would be at the start and at the end.
    past: f64,
    push: f64,
    /// The mean way of both in the step.
    flow: DVec3,
}

impl Meeting {
    /// None unless two links that keep `keep` metres from each other come as near as that, or nearer by `slack`, by their own motion in a step of
    /// `dt` seconds.
    fn of(
        link: &[Course; 2],
        other: &[Course; 2],
        [keep, slack]: [f64; 2],
        (shift, dt): (DVec3, f64),
    ) -> Option<Self> {
        let start = closest(at_time(link, 0.0), at_time(other, 0.0));
        let distance = start.length();
        // No two points of both come nearer by more than this.
        let ways = |of: &[Course; 2]| of.map(|p| p.now - p.before);
        let (own, its) = (ways(link), ways(other));
        let most = (own.iter().flat_map(|own| its.map(|its| *own - its)))
            .map(DVec3::length_squared)
            .fold(0.0, f64::max)
            .sqrt();
        // Along the way by steps in which they cannot meet, until they touch.
        let touch = keep * (1.0 + TOUCH);
        let (mut found, mut left, mut t) = (start, distance, 0.0);
        for _ in 0..MOST_LOOKS {
            if left <= touch || t >= 1.0 || left > touch + slack + (1.0 - t) * most {
                break;
            }
            t = (t + (left - keep) / most).min(1.0);
            found = closest(at_time(link, t), at_time(other, t));
            left = found.length();
        }
        if left > touch + slack || left < LEAST_APART {
            return None;
        }
        let normal = found.apart / left;
        let (at, other_at) = (found.at, found.other_at);
        let [places, others] = [(link, at), (other, other_at)].map(|(of, at)| {
            [0.0, 1.0].map(|t| {
                let [start, end] = at_time(of, t);
                start + (end - start) * at
            })
        });
        let ways = [places, others].map(|[from, to]| to - from);
        let mean = (ways[0] + ways[1]) * 0.5;
        // Against the roots.
        let [own, its] = ways.map(|way| normal.dot(way - shift));
        let along = normal.dot(shift) + shared_way(own, its);
        // What lies in each other parts slowly.
        let part = (PART * (keep - distance)).clamp(0.0, PART_SPEED * dt);
        let keep = keep.min(distance + part);
        let past = 0.5 * (keep - normal.dot(places[0] - others[0]));
        Some(Self {
            at,
            normal,
            past,
            push: past + along - normal.dot(ways[0]),
            flow: mean + normal * (along - normal.dot(mean)),
        })
    }
}

/// How far the plane between two links goes that would go so far.
///
/// Neither strand knows what the other weighs there, so a plane that went with their mean motion would make energy of a light one that
/// strikes a heavy one. It goes with what both do, and by a part with the rest of their mean.
fn shared_way(one: f64, other: f64) -> f64 {
    let both = if one * other <= 0.0 {
        0.0
    } else if one.abs() < other.abs() {
        one
    } else {
        other
    };
    both + WITH_MEAN * (0.5 * (one + other) - both)
}

/// The ends of a link at a share of the step.
fn at_time(link: &[Course; 2], t: f64) -> [DVec3; 2] {
    link.map(|end| end.before + (end.now - end.before) * t)
}

/// Pieces by the cubes of space that the middles of their ways are in. A cube is as large as the largest of their balls, so that what
/// meets a piece is in a cube beside its own.
#[derive(Clone, Debug)]
struct Cells {
    low: DVec3,
    rate: f64,
    size: [usize; 3],
    /// The cube of every piece, or [`NOWHERE`].
    of: Vec<u32>,
    /// The first of every cube's pieces in `balls`; one more at the end.
    first: Vec<u32>,
    balls: Vec<Ball>,
}

#[derive(Clone, Copy, Debug)]
struct Ball {
    center: DVec3,
    reach: f64,
    piece: u32,
}

const NOWHERE: u32 = u32::MAX;

impl Cells {
    /// For so many pieces.
    fn new(pieces: usize) -> Self {
        Self {
            low: DVec3::ZERO,
            rate: 1.0,
            size: [1; 3],
            of: Vec::with_capacity(pieces),
            first: Vec::with_capacity(Self::most(pieces) + 1),
            balls: Vec::with_capacity(pieces),
        }
    }

    /// The most cubes for so many pieces.
    fn most(pieces: usize) -> usize {
        8 * pieces + 64
    }

    fn sort(&mut self, ways: &[Way]) {
        let (mut low, mut high, mut reach) = (DVec3::INFINITY, DVec3::NEG_INFINITY, 0.0_f64);
        for way in ways.iter().filter(|way| way.reach.is_finite()) {
            low = low.min(way.center);
            high = high.max(way.center);
            reach = reach.max(way.reach);
        }
        self.of.clear();
        self.first.clear();
        self.balls.clear();
        if !(high - low).is_finite() || reach <= 0.0 {
            self.size = [0; 3];
            return;
        }
        let mut edge = 2.0 * reach * (1.0 + 1e-9);
        loop {
            let size = ((high - low) / edge).floor() + DVec3::ONE;
            if size.x * size.y * size.z <= Self::most(ways.len()) as f64 {
                self.size = size.to_array().map(|cubes| cubes as usize);
                break;
            }
            edge *= 2.0;
        }
        (self.low, self.rate) = (low, 1.0 / edge);
        let cubes = self.size.iter().product::<usize>();
        self.first.resize(cubes + 1, 0);
        for way in ways {
            let cube = if way.reach.is_finite() {
                let [x, y, z] = self.cube(way.center);
                self.index(x, y, z) as u32
            } else {
                NOWHERE
            };
            self.of.push(cube);
            if cube != NOWHERE {
                self.first[cube as usize] += 1;
            }
        }
        let mut sum = 0;
        for first in &mut self.first {
            sum += *first;
            *first = sum;
        }
        let none = Ball {
            center: DVec3::ZERO,
            reach: 0.0,
            piece: 0,
        };
        self.balls.resize(sum as usize, none);
        for (piece, (way, &cube)) in ways.iter().zip(&self.of).enumerate().rev() {
            if cube == NOWHERE {
                continue;
            }
            let first = &mut self.first[cube as usize];
            *first -= 1;
            self.balls[*first as usize] = Ball {
                center: way.center,
                reach: way.reach,
                piece: piece as u32,
            };
        }
    }

    fn cube(&self, at: DVec3) -> [usize; 3] {
        let at = ((at - self.low) * self.rate).to_array();
        std::array::from_fn(|axis| (at[axis] as usize).min(self.size[axis] - 1))
    }

    fn index(&self, x: usize, y: usize, z: usize) -> usize {
        (z * self.size[1] + y) * self.size[0] + x
    }

    /// Tells of all pieces whose balls meet that of `way`, itself among them.
    fn around(&self, way: &Way, mut tell: impl FnMut(u32)) {
        if !way.reach.is_finite() || self.size[0] == 0 {
            return;
        }
        let [x, y, z] = self.cube(way.center);
        let beside =
            |at: usize, axis: usize| at.saturating_sub(1)..=(at + 1).min(self.size[axis] - 1);
        for z in beside(z, 2) {
            for y in beside(y, 1) {
                // Cubes in a row lie one after the other.
                let row = beside(x, 0);
                let from = self.first[self.index(*row.start(), y, z)] as usize;
                let to = self.first[self.index(*row.end(), y, z) + 1] as usize;
                for ball in &self.balls[from..to] {
                    let reach = ball.reach + way.reach;
                    if (ball.center - way.center).length_squared() <= reach * reach {
                        tell(ball.piece);
                    }
                }
            }
        }
    }
}
