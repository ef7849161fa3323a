//! Locks keep out of each other.
//!
//! Strands that are apart at rest may not pass through each other in motion. Every strand stands for a lock, a tube of
//! [`Params::lock_radius`](crate::Params::lock_radius), and is cut into pieces of a few links. In each step the pieces that come near each
//! other are found by boxes around what they sweep. Where two of their links would come nearer than both radii, a plane half way between where
//! their own motion takes them keeps both on their sides ([`Contact`]), as a body's surface would: both know it beforehand, so strands stay
//! independent within a step. Pieces that are nearer than that at rest are left alone: a style's locks lie in each other, and
//! [`Mutual`](crate::Mutual) holds them. Those that are a little farther apart keep a share of that distance.
//!
//! No strand's answer hangs on the order in which others are found: of all planes the deepest holds.
//!
//! Its parts, of which each imports those above it alone: `keeps`, how far what is near at rest keeps apart; `meeting`, two links; `ways`, where
//! strands go; `pairs`, which come near each other.

mod keeps;
mod meeting;
mod pairs;
mod ways;

use glam::DVec3;

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
use keeps::Keeps;
use meeting::{Links, Meeting, closest};
use pairs::Pairs;
use ways::{PIECE, Ways};

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

/// Tasks that look for planes in a step.
const TASKS: usize = 8;
/// Pairs of strands that are worth a task.
const WORTH_A_TASK: usize = 64;

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

/// Pairs of links that may meet, lane by lane.
struct Near {
    count: usize,
    /// First those of the strand with the smaller id.
    links: [Links; 2],
    /// How far they keep from each other, how far they go against their roots, and the mean way of these, in m.
    keep: Lane,
    goes: Lane,
    shift: Vec3,
    /// Pieces, and the links' numbers on them.
    sides: [[(usize, usize); 2]; LANES],
}

impl Near {
    const NONE: Self = Self {
        count: 0,
        links: [Links::NONE; 2],
        keep: Lane::ZERO,
        goes: Lane::ZERO,
        shift: Vec3::ZERO,
        sides: [[(0, 0); 2]; LANES],
    };
}

/// The locks of a solver.
#[derive(Clone, Debug)]
pub(super) struct Locks {
    /// Strand by strand, in the order of batches and lanes.
    pieces: Vec<Piece>,
    /// The first piece of every strand; one more at the end.
    strands: Vec<usize>,
    keeps: Keeps,
    /// The first particle of every batch in the list of all: particle by particle, lane by lane.
    particles: Vec<usize>,
    /// Of the step at hand.
    dt: f64,
    ways: Ways,
    pairs: Pairs,
    found: Vec<Vec<Plane>>,
    /// Of every particle, the plane that holds it: the task that found it, and its place there.
    holds: Vec<Option<(u32, u32)>>,
}

/// A plane before a particle.
#[derive(Clone, Copy, Debug)]
struct Plane {
    particle: usize,
    normal: DVec3,
    /// How far behind it the particle would be at the end of the step, by its own motion; and its link at the start. In m.
    depth: f64,
    past: f64,
    /// What decides which of several holds.
    urgency: f64,
    /// The plane's way in the step.
    flow: DVec3,
    /// Whose link it is: its strand's id and its number.
    whose: (u32, usize),
}

impl Plane {
    fn is_before(&self, other: &Self) -> bool {
        let more = self.urgency.total_cmp(&other.urgency);
        more.then(other.whose.cmp(&self.whose)).is_gt()
    }
}

impl Locks {
    /// Of strands at rest in `states`, those with a lock's radius; `ids` are of all strands. None without any.
    pub(super) fn new(batches: &[Batch], states: &[BatchState], ids: &[u32]) -> Option<Self> {
        let (mut pieces, mut strands) = (Vec::new(), Vec::new());
        for (b, batch) in batches.iter().enumerate() {
            for lane in 0..LANES {
                let (count, radius) = (batch.counts[lane], batch.lock_radius[lane]);
                let Some(strand) = batch.strands[lane].filter(|_| radius > 0.0) else {
                    continue;
                };
                strands.push(pieces.len());
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
        if pieces.is_empty() {
            return None;
        }
        strands.push(pieces.len());
        let mut particles = vec![0];
        for batch in batches {
            particles.push(particles[particles.len() - 1] + batch.count() * LANES);
        }
        let mut locks = Self {
            keeps: Keeps::default(),
            dt: 0.0,
            ways: Ways::new(batches, pieces.len()),
            pairs: Pairs::new(&strands),
            found: vec![Vec::new(); TASKS],
            holds: vec![None; particles[batches.len()]],
            pieces,
            strands,
            particles,
        };
        locks.rest(batches, states);
        Some(locks)
    }

    /// Finds which pieces are near each other at rest.
    fn rest(&mut self, batches: &[Batch], states: &[BatchState]) {
        let still = Surroundings::default();
        self.ways
            .follow::<Lane>(&self.pieces, batches, states, (&still, 0.0));
        // As far as a share of the distance is less than both radii.
        let more = 1.0 / OF_REST - 1.0;
        for (sweep, piece) in self.ways.sweeps.iter_mut().zip(&self.pieces) {
            sweep.bounds = sweep.bounds.larger_by((piece.radius * more + NEAR) as f32);
        }
        self.pairs.find(&self.ways.sweeps, &self.strands);
        let mut keeps = Keeps::default();
        for pair in self.pairs.all() {
            let mut near = Vec::new();
            let look = |own: usize, other: usize| {
                let [one, two] = [own, other].map(|i| &self.pieces[i]);
                let radii = one.radius + two.radius;
                let apart = self.apart_at_rest(one, two);
                if apart < radii + NEAR {
                    near.push(([own, other], 0.0));
                } else if apart * OF_REST < radii {
                    near.push(([own, other], (apart * OF_REST) as f32));
                }
            };
            let sweeps = &self.ways.sweeps;
            self.pairs
                .pieces(pair, sweeps, &self.strands, |_, _| !0, look);
            keeps.add(*pair, &near, &self.strands);
        }
        keeps.sort(self.strands.len() as u32 - 1);
        self.keeps = keeps;
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
        self.ways
            .follow::<T>(&self.pieces, batches, states, (surroundings, dt));
        self.pairs.find(&self.ways.sweeps, &self.strands);
        let mut found = std::mem::take(&mut self.found);
        let tasks = (self.pairs.all().len() / WORTH_A_TASK).clamp(1, TASKS);
        for planes in &mut found {
            planes.clear();
        }
        self.find_all::<T>(self.pairs.all(), &mut found[..tasks]);
        self.holds.fill(None);
        for (task, planes) in found.iter().enumerate() {
            for (index, plane) in planes.iter().enumerate() {
                let holds = &mut self.holds[plane.particle];
                let is_first = holds.is_none_or(|(task, index)| {
                    plane.is_before(&found[task as usize][index as usize])
                });
                if is_first {
                    *holds = Some((task as u32, index as u32));
                }
            }
        }
        self.found = found;
    }

    /// Finds the planes of pairs of strands, in as many tasks as there are lists for what is found.
    fn find_all<T: Number>(&self, pairs: &[[u32; 2]], found: &mut [Vec<Plane>]) {
        if let [planes] = found {
            T::run(
                #[inline(always)]
                || {
                    let mut near = Near::NONE;
                    for pair in pairs {
                        self.find_between::<T>(pair, &mut near, planes);
                    }
                    self.meet::<T>(&mut near, planes);
                },
            );
            return;
        }
        let half = found.len() / 2;
        let (pair, later_pairs) = pairs.split_at(pairs.len() * half / found.len());
        let (planes, later_planes) = found.split_at_mut(half);
        join(
            || self.find_all::<T>(pair, planes),
            || self.find_all::<T>(later_pairs, later_planes),
        );
    }

    /// Finds the links of a pair of strands that may meet, and the planes of those that do, as four have been found.
    #[inline(always)]
    fn find_between<T: Number>(&self, pair: &[u32; 2], near: &mut Near, planes: &mut Vec<Plane>) {
        let sweeps = &self.ways.sweeps;
        let keeps = self.keeps.between(pair, &self.strands);
        self.pairs.pieces(
            pair,
            sweeps,
            &self.strands,
            #[inline(always)]
            |own, from| keeps.kept(own, from),
            #[inline(always)]
            |own, other| {
                let radii = self.pieces[own].radius + self.pieces[other].radius;
                let keep = keeps.of(own, other).min(radii);
                let (sweep, its) = (&sweeps[own], &sweeps[other]);
                let more = (keep - radii) as f32;
                let Some(farther) = sweep.farther(its, more) else {
                    return;
                };
                let mut links = sweep.near(its, (more, farther));
                if links == 0 {
                    return;
                }
                let goes = f64::from(sweep.own + its.own);
                let [piece, its] = [&self.pieces[own], &self.pieces[other]];
                let shift = (self.ways.shift(piece) + self.ways.shift(its)) * 0.5;
                while links != 0 {
                    let link = links.trailing_zeros() as usize;
                    links &= links - 1;
                    // In an order that hangs on nothing but the strands' own numbers.
                    let mut sides = [(own, link / PIECE), (other, link % PIECE)];
                    if piece.id > its.id {
                        sides.swap(0, 1);
                    }
                    let lane = near.count;
                    for side in 0..2 {
                        let (piece, link) = sides[side];
                        near.links[side].set(lane, self.ways.link(&self.pieces[piece], link));
                    }
                    (near.keep[lane], near.goes[lane]) = (keep, goes);
                    near.shift.set(lane, shift);
                    near.sides[lane] = sides;
                    near.count += 1;
                    if near.count == LANES {
                        self.meet::<T>(near, planes);
                    }
                }
            },
        );
    }

    /// Adds the planes before the particles of links that meet, among some that are near, and forgets these.
    #[inline(always)]
    fn meet<T: Number>(&self, near: &mut Near, planes: &mut Vec<Plane>) {
        let count = std::mem::take(&mut near.count);
        let meeting = Meeting::of(
            &near.links[0].load::<T>(),
            &near.links[1].load::<T>(),
            (near.keep.load(), near.goes.load()),
            (near.shift.load(), self.dt),
        );
        let Some(meeting) = meeting else {
            return;
        };
        for lane in (0..count).filter(|&lane| meeting.meets[lane] > 0.0) {
            self.add(&near.sides[lane], (&meeting, lane), planes);
        }
    }

    /// Adds the planes before the particles of two links that meet.
    fn add(
        &self,
        sides: &[(usize, usize); 2],
        (meeting, lane): (&Meeting, usize),
        planes: &mut Vec<Plane>,
    ) {
        for side in [0, 1] {
            let [(piece, link), facing] = [sides[side], sides[1 - side]];
            let (piece, facing_piece) = (&self.pieces[piece], &self.pieces[facing.0]);
            let link = piece.first + link;
            let (at, push) = (meeting.at[side][lane], meeting.push[side][lane]);
            let normal = meeting.normal.get(lane);
            // The root's end is held as it is.
            let [start, end] = [at < END && link > 0, at > 1.0 - END];
            let mut add = |k: usize, share: f64| {
                planes.push(Plane {
                    particle: self.particles[piece.batch] + k * LANES + piece.lane,
                    normal: if side == 0 { normal } else { -normal },
                    depth: push / share,
                    urgency: push / share + LACKING * meeting.lacks[lane],
                    past: meeting.past[lane],
                    flow: meeting.flow.get(lane),
                    whose: (facing_piece.id, facing_piece.first + facing.1),
                });
            };
            // An end that is held alone holds the place where links touch.
            if start {
                add(link - 1, if end { 1.0 } else { 1.0 - at });
            }
            if end {
                add(link, if start { 1.0 } else { at });
            }
        }
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
                let Some((task, plane)) = holds[lane] else {
                    continue;
                };
                let plane = &self.found[task as usize][plane as usize];
                found += 1;
                if touched.last() != Some(&(count + k)) {
                    touched.push(count + k);
                }
                let (y, v) = (state.y[k].get(lane), state.v[k].get(lane));
                let before = plane.normal.dot(y) + plane.past;
                let end = plane.normal.dot(y + v * self.dt) + plane.depth;
                let shift = root.get(lane) - state.root.get(lane);
                let surface = Surface {
                    normal: plane.normal,
                    mid: before + (end - before) * GAMMA,
                    end,
                    flow: (plane.flow - shift) / self.dt,
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
                    v.set(lane, way.as_dvec3() * 3.0);
                }
            }
        }
        let Solver { locks, batches, .. } = &mut solver;
        let (locks, _) = locks.as_mut().unwrap();
        let surroundings = Surroundings::default();
        locks.find::<Lane>(batches, &state.batches, &surroundings, 1.0 / 60.0);
        let mut all = Vec::new();
        for (one, two) in (0..locks.pieces.len()).flat_map(|i| (0..i).map(move |j| (j, i))) {
            let [own, other] = [one, two].map(|i| &locks.pieces[i]);
            let strand = |piece| locks.strands.partition_point(|&first| first <= piece) - 1;
            let pair = [strand(one), strand(two)];
            let keeps = (locks.keeps).between(&pair.map(|strand| strand as u32), &locks.strands);
            let keep = keeps.of(one, two).min(own.radius + other.radius);
            if pair[0] == pair[1] || keep == 0.0 {
                continue;
            }
            let row = (1 << other.links) - 1;
            let every = (0..own.links).fold(0, |all, i| all | row << (PIECE * i));
            locks.meet::<Lane>([one, two], every, keep, &mut all);
        }
        let sorted = |planes: Vec<Plane>| {
            let mut keys: Vec<_> = planes
                .iter()
                .map(|plane| (plane.particle, plane.whose, plane.depth.to_bits()))
                .collect();
            keys.sort_unstable();
            keys
        };
        let (found, all) = (sorted(locks.found.concat()), sorted(all));
        assert!(found.len() > 200, "{}", found.len());
        assert_eq!(found, all);
    }
}
