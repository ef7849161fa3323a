//! The strand solver: strands in batches, each stepped by itself.
//!
//! Its parts, of which each imports those above it alone:
//!
//! - `link`, `batch`, `chain`, `stage`, `contact`: data; what strands are, where they are, what a stage of a step is, what touches
//!   them
//! - `load`: what acts on particles in a stage
//! - `rods`: the two kinds of strands, `curled` and `straight`, behind one interface
//! - `scratch`: what a step works with
//! - `neighbours`; `locks`: strands that meet; `drive`: what drives a batch in a step
//! - `unrest`: strands that jam; `sleep`: which strands cost nothing
//! - `tr_bdf2`, the integrator; `safe`, the one behind it; `energy`, which keeps them from making any; `finish`
//! - `step`: all of a batch's step; `groups`: all batches' steps, beside each other
//!
//! What works on all particles is compiled for several instruction sets, see [`crate::lanes`]: a function for every phase of a
//! step, by [`Number::run`](crate::lanes::Number::run).

mod batch;
mod chain;
mod contact;
mod drive;
mod energy;
mod finish;
#[cfg(test)]
mod free_flight;
mod groups;
#[cfg(test)]
mod instructions_agree;
mod link;
mod load;
mod locks;
mod neighbours;
#[cfg(test)]
mod ring;
mod rods;
mod safe;
mod scratch;
mod sleep;
mod stage;
mod step;
mod tr_bdf2;
mod unrest;

use glam::{DQuat, DVec3, Vec3};

use crate::{
    collision::shape::Collider,
    error::{DynamicsError, Fault},
    forces::{
        mutual::{Course, Mutual, Pair},
        wind::Blown,
    },
    lanes::{LANES, Lane, Vec3 as LaneVec3, instructions::Instructions},
    params::Params,
    rest::RestStrand,
    stats::Stats,
    strands::Strands,
    surroundings::{Acceleration, Anchor, Roots, Surroundings},
    threads::join,
};

#[cfg(target_arch = "x86_64")]
use crate::lanes::avx2::Avx2;
use batch::{Batch, BatchState};
use contact::{find::settle_in, guard::Guard};
use drive::{Anchored, Drive, Others, roots, whole_poses};
use energy::whole_energy;
use groups::step_all;
use locks::Locks;
use rods::Rods;
use scratch::Scratch;
use sleep::{Islands, Sleepers};
use stage::GAMMA;
use step::advance;

/// The most groups of batches, so of tasks in a step.
const MOST_GROUPS: usize = 64;

/// The constants of some strands, and scratch. The strands' motion is in [`State`].
#[derive(Clone, Debug)]
pub struct Solver {
    batches: Vec<Batch>,
    /// One for every group of batches.
    scratch: Vec<Scratch>,
    /// Batches in a group: a task steps them one after the other in the same scratch, which stays in the processor's cache.
    group: usize,
    /// Batch and lane of every strand.
    places: Vec<(usize, usize)>,
    /// The number of points of every strand, and the index of the first in the list of all.
    points: Vec<usize>,
    first_points: Vec<usize>,
    ids: Vec<u32>,
    /// Whether every strand has more than a root.
    have_links: bool,
    interaction: Option<Interaction>,
    /// Where strands meet, and that all of them are one island then.
    locks: Option<(Locks, Islands)>,
    /// Of the bodies in the step at hand, and who sleeps in it.
    guards: Vec<Guard>,
    sleepers: Sleepers,
    /// Of the step at hand, batch by batch.
    anchored: Vec<Anchored>,
    instructions: Instructions,
}

/// How the strands act on each other.
#[derive(Clone, Debug)]
struct Interaction {
    mutual: Mutual,
    /// Of every batch.
    pairs: Vec<Vec<Pair>>,
    /// Of every particle: batch by batch, particle by particle, lane by lane.
    courses: Vec<Course>,
    islands: Islands,
}

/// Where every particle is, and where its own motion takes it.
fn follow(
    batches: &[Batch],
    states: &[BatchState],
    courses: &mut [Course],
    surroundings: &Surroundings,
    dt: f64,
) {
    // A task for fewer of them costs more than they do.
    if batches.len() > 64 {
        let half = batches.len() / 2;
        let (first, second) = batches.split_at(half);
        let particles: usize = first.iter().map(Batch::count).sum();
        let (these, those) = courses.split_at_mut(particles * LANES);
        join(
            || follow(first, &states[..half], these, surroundings, dt),
            || follow(second, &states[half..], those, surroundings, dt),
        );
        return;
    }
    let mut left = courses;
    for (batch, state) in batches.iter().zip(states) {
        let (own, others) = left.split_at_mut(batch.count() * LANES);
        left = others;
        let (root, _) = roots(batch, surroundings);
        for (k, courses) in own.chunks_exact_mut(LANES).enumerate() {
            let (before, now) = (state.root + state.y[k], root + state.y[k] + state.v[k] * dt);
            for (lane, course) in courses.iter_mut().enumerate() {
                let (before, now) = (before.get(lane), now.get(lane));
                // A root without a pose is the strand's own fault, not its neighbours'.
                let now = if now.is_finite() { now } else { before };
                *course = Course { before, now };
            }
        }
    }
}

/// Everything that decides the strands' future, to the bit. It is of a solver for the same strands and parameters.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct State {
    /// Where each strand's numbers are: [`layout`].
    layout: u64,
    /// Of the time and the wind since the start.
    blown: Blown,
    /// The length of the last step in s; 0 before the first.
    last_dt: f64,
    /// What acted in the last step: where it stays the same, strands can come to rest.
    last: u64,
    batches: Vec<BatchState>,
}

impl State {
    /// Seconds since the start.
    #[must_use]
    pub fn time(&self) -> f64 {
        self.blown.time
    }
}

impl Solver {
    /// A solver for strands at rest, all of one kind, and their state.
    ///
    /// # Errors
    ///
    /// When a parameter is out of its range.
    pub fn new(rest: &Strands, params: &Params) -> Result<(Self, State), DynamicsError> {
        Self::with(rest, |_| *params)
    }

    /// A solver for strands of which each has its own parameters, by its index in `rest`.
    ///
    /// Strands that cannot move are set aside: see [`Self::faults`].
    ///
    /// # Errors
    ///
    /// When a parameter is out of its range, or two strands of which some keep out of each other have one id.
    pub fn with(
        rest: &Strands,
        params: impl Fn(usize) -> Params,
    ) -> Result<(Self, State), DynamicsError> {
        let mut strands = Vec::with_capacity(rest.len());
        for (index, points) in rest.iter().enumerate() {
            let id = rest.id(index);
            let params = params(index);
            if let Some((name, value, least, most)) = params.out_of_range() {
                return Err(DynamicsError::Parameter {
                    id,
                    name,
                    value,
                    least,
                    most,
                });
            }
            let (strand, fault) = match RestStrand::new(points, &params) {
                Ok(strand) => (strand, None),
                Err(reason) => (RestStrand::rigid(points), Some(reason)),
            };
            strands.push((strand, params, fault));
        }

        let meets = strands.iter().any(|strand| strand.1.lock_radius > 0.0);
        let ids: Vec<u32> = (0..rest.len()).map(|i| rest.id(i)).collect();
        if meets {
            check_ids(&ids)?;
        }
        // Strands of one kind and like length together; the order is fixed by the strands alone.
        let kind = |i: usize| strands[i].0.is_straight(&strands[i].1);
        let mut order: Vec<usize> = (0..strands.len()).collect();
        order.sort_by_key(|&i| (kind(i), strands[i].0.links.len(), i));
        let mut solver = Self {
            batches: Vec::new(),
            scratch: Vec::new(),
            group: 1,
            places: vec![(0, 0); strands.len()],
            points: rest.iter().map(<[Vec3]>::len).collect(),
            first_points: (0..rest.len()).map(|i| rest.point_range(i).start).collect(),
            ids,
            have_links: rest.iter().all(|points| points.len() > 1),
            interaction: None,
            locks: None,
            guards: Vec::new(),
            sleepers: Sleepers::default(),
            anchored: Vec::new(),
            instructions: Instructions::best(),
        };
        let mut states = Vec::new();
        let kinds = order.chunk_by(|&a, &b| kind(a) == kind(b));
        for members in kinds.flat_map(|of_kind| of_kind.chunks(LANES)) {
            let described: Vec<_> = members
                .iter()
                .map(|&i| (i, &strands[i].0, &strands[i].1))
                .collect();
            let mut batch = Batch::new(&described);
            batch.planes = batch.count() * if meets { 2 } else { 1 };
            let mut rests = [None; LANES];
            for (lane, &i) in members.iter().enumerate() {
                rests[lane] = Some(&strands[i].0);
                solver.places[i] = (solver.batches.len(), lane);
            }
            let mut state = BatchState::new(&batch, &rests);
            for (lane, &i) in members.iter().enumerate() {
                state.set_aside[lane] = strands[i].2;
            }
            states.push(state);
            solver.batches.push(batch);
        }
        solver.group = solver.batches.len().div_ceil(MOST_GROUPS).max(1);
        let locks = Locks::new(&solver.batches, &states, &solver.ids);
        solver.scratch = (solver.batches.chunks(solver.group))
            .map(|group| {
                let count = group.iter().map(Batch::count).max().unwrap_or(0);
                let planes = group.iter().map(|batch| batch.planes).max().unwrap_or(0);
                Scratch::new(count, planes)
            })
            .collect();
        solver.locks = locks.map(|locks| (locks, Islands::one(solver.batches.len())));
        let state = State {
            layout: layout(&solver.places),
            blown: Blown::default(),
            last_dt: 0.0,
            last: 0,
            batches: states,
        };
        Ok((solver, state))
    }

    /// The strands that are set aside, and why.
    #[must_use]
    pub fn faults(&self, state: &State) -> Vec<Fault> {
        let places = self.ids.iter().zip(&self.places);
        places
            .filter_map(|(&id, &(batch, lane))| {
                let reason = state.batches[batch].set_aside[lane]?;
                Some(Fault { id, reason })
            })
            .collect()
    }

    /// Lets strands act on each other from now on, as they lie in `state`: at best at the start, at rest.
    ///
    /// # Errors
    ///
    /// When a number is out of its range, two strands have one id, or the state is not of these strands. What was so before stays so then.
    pub fn interact(&mut self, state: &mut State, mutual: &Mutual) -> Result<(), DynamicsError> {
        // Of a state from before what another interaction broke doesn't count.
        self.check_places(state)?;
        check_ids(&self.ids)?;
        if let Some((name, value, least, most)) = mutual.out_of_range() {
            return Err(DynamicsError::Mutual {
                name,
                value,
                least,
                most,
            });
        }
        let (pairs, islands) = neighbours::pairs(&self.batches, &state.batches, &self.ids, mutual);
        for (pairs, state) in pairs.iter().zip(&mut state.batches) {
            state.broken = vec![[false; LANES]; pairs.len()];
        }
        let total: usize = self.batches.iter().map(|b| b.count() * LANES).sum();
        self.interaction = Some(Interaction {
            mutual: *mutual,
            pairs,
            courses: vec![Course::default(); total],
            islands,
        });
        // What sleeps is pulled otherwise now.
        state.last = 0;
        Ok(())
    }

    /// The number of strands.
    #[must_use]
    pub fn len(&self) -> usize {
        self.places.len()
    }

    /// Whether there are no strands.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.places.is_empty()
    }

    /// Advances the strands by `dt` seconds.
    ///
    /// # Errors
    ///
    /// When the length of the step, the scene or the state is invalid. The state is unchanged then.
    pub fn step(
        &mut self,
        state: &mut State,
        surroundings: &Surroundings,
        dt: f64,
    ) -> Result<Stats, DynamicsError> {
        self.check(state, surroundings, dt)?;
        let instructions = self.instructions;
        let acting = surroundings.fingerprint();
        let calm = acting == state.last && surroundings.is_calm();
        state.last = acting;
        let islands = match &self.locks {
            Some((_, one)) => Some(one),
            None => self.interaction.as_ref().map(|all| &all.islands),
        };
        let (batches, states) = (&self.batches, &state.batches);
        (self.sleepers).find(batches, states, surroundings, calm, islands);
        if calm && self.have_links && self.sleepers.are_all(batches) {
            state.blown = surroundings.blown(1.0, state.blown, dt);
            state.last_dt = dt;
            return Ok(Stats {
                asleep: self.len(),
                ..Stats::default()
            });
        }
        let gusts = [
            surroundings.air_at(GAMMA, state.blown, dt),
            surroundings.air_at(1.0, state.blown, dt),
        ];
        self.guards.clear();
        self.guards
            .extend(surroundings.colliders.iter().map(Guard::new));
        self.take_on(surroundings.anchors);
        if let Some(interaction) = &mut self.interaction {
            follow(
                &self.batches,
                &state.batches,
                &mut interaction.courses,
                surroundings,
                dt,
            );
        }
        if let Some((locks, _)) = &mut self.locks {
            let (batches, states) = (&self.batches, &state.batches);
            match instructions {
                Instructions::Compiled => locks.find::<Lane>(batches, states, surroundings, dt),
                #[cfg(target_arch = "x86_64")]
                Instructions::Avx2 => locks.find::<Avx2>(batches, states, surroundings, dt),
            }
        }
        let interaction = self.interaction.as_ref();
        let locks = self.locks.as_ref().map(|(locks, _)| locks);
        let (first_points, guards) = (&self.first_points, &self.guards);
        let anchored = &self.anchored[..];
        let of_batch = |index: usize| {
            let range = [index, index + 1].map(|i| anchored.partition_point(|own| own.batch < i));
            &anchored[range[0]..range[1]]
        };
        let sleepers = &self.sleepers;
        let last_dt = if state.last_dt > 0.0 {
            state.last_dt
        } else {
            dt
        };
        let step = |index: usize, batch: &Batch, state: &mut BatchState, scratch: &mut Scratch| {
            let (root, base) = roots(batch, surroundings);
            let drive = Drive {
                dt,
                last_dt,
                surroundings,
                guards,
                gusts: &gusts,
                first_points,
                root,
                base,
                accelerations: accelerations(batch, surroundings),
                calm,
                are_roots_still: sleepers.are_roots_still,
                asleep: sleepers.of[index],
                others: interaction.map(|all| Others {
                    mutual: &all.mutual,
                    pairs: &all.pairs[index],
                    courses: &all.courses,
                }),
                locks: locks.map(|locks| (index, locks)),
                anchors: of_batch(index),
            };
            match instructions {
                Instructions::Compiled => advance::<Lane>(batch, state, scratch, &drive),
                #[cfg(target_arch = "x86_64")]
                Instructions::Avx2 => advance::<Avx2>(batch, state, scratch, &drive),
            }
        };
        let sum = step_all(
            &self.batches,
            &mut state.batches,
            &mut self.scratch,
            (0, self.group),
            &step,
        );
        state.blown = surroundings.blown(1.0, state.blown, dt);
        state.last_dt = dt;
        Ok(sum)
    }

    /// Takes on which particles anchors pull at.
    fn take_on(&mut self, anchors: &[Anchor]) {
        let (places, points) = (&self.places, &self.points);
        let known = |(order, anchor): (usize, &Anchor)| {
            let &(batch, lane) = places.get(anchor.strand)?;
            let is_there = (1..points[anchor.strand]).contains(&anchor.point);
            is_there.then(|| Anchored {
                batch,
                lane,
                particle: anchor.point - 1,
                order,
                anchor: *anchor,
            })
        };
        self.anchored.clear();
        self.anchored
            .extend(anchors.iter().enumerate().filter_map(known));
        self.anchored
            .sort_unstable_by_key(|own| (own.batch, own.lane, own.particle, own.order));
    }

    /// Takes note of how deep strands are in bodies as they lie in `state`: so deep they may stay there. The first
    /// `of_one_figure` are [parts of one figure](Surroundings::of_one_figure). Where it isn't asked for, that is as deep
    /// as they are when the first step with bodies begins, wherever roots and bodies have gone until then.
    ///
    /// # Errors
    ///
    /// When a body or the state is invalid. The state is unchanged then.
    pub fn settle(
        &self,
        state: &mut State,
        colliders: &[Collider],
        of_one_figure: usize,
    ) -> Result<(), DynamicsError> {
        let surroundings = Surroundings {
            colliders,
            ..Surroundings::default()
        };
        surroundings.check(1.0, self.len(), self.points.iter().sum())?;
        self.check_places(state)?;
        for (batch, state) in self.batches.iter().zip(&mut state.batches) {
            settle_in(batch, state, colliders, of_one_figure);
            state.skin_known = true;
        }
        Ok(())
    }

    /// Puts the roots elsewhere at once: shape and motion are carried along, as if nothing had happened.
    ///
    /// # Errors
    ///
    /// When the poses or the state are invalid. The state is unchanged then.
    pub fn teleport(&self, state: &mut State, to: Roots) -> Result<(), DynamicsError> {
        let surroundings = Surroundings {
            roots: to,
            ..Surroundings::default()
        };
        self.check(state, &surroundings, 1.0)?;
        for (batch, batch_state) in self.batches.iter().zip(&mut state.batches) {
            let (root, base) = roots(batch, &surroundings);
            let (root, base) = whole_poses(batch_state, root, base);
            batch_state.teleport(root, base);
        }
        // Roots that were elsewhere in the last step have moved.
        state.last = 0;
        Ok(())
    }

    fn check(
        &self,
        state: &State,
        surroundings: &Surroundings,
        dt: f64,
    ) -> Result<(), DynamicsError> {
        surroundings.check(dt, self.len(), self.points.iter().sum())?;
        self.check_places(state)?;
        let fits = self.interaction.as_ref().is_none_or(|all| {
            (all.pairs.iter().zip(&state.batches)).all(|(p, s)| s.broken.len() == p.len())
        });
        match fits {
            true => Ok(()),
            false => Err(DynamicsError::State),
        }
    }

    /// Whether a state is of these strands, however they act on each other.
    fn check_places(&self, state: &State) -> Result<(), DynamicsError> {
        let fits = state.layout == layout(&self.places)
            && state.batches.len() == self.batches.len()
            && (self.batches.iter().zip(&state.batches))
                .all(|(b, s)| s.has_lengths(b) && b.does_with(s.frames.len()));
        match fits {
            true => Ok(()),
            false => Err(DynamicsError::State),
        }
    }

    /// The energy of a strand over its mass per length, in m^3/s^2: of its motion and its weight against the root, and of
    /// bending and twisting.
    ///
    /// # Panics
    ///
    /// As [`Self::points`].
    #[must_use]
    pub fn energy(&self, state: &State, strand: usize, gravity: DVec3) -> f64 {
        let (batch, lane) = self.places[strand];
        let pull = LaneVec3::splat(gravity);
        whole_energy::<Lane>(&self.batches[batch], &state.batches[batch], &pull)[lane]
    }

    /// The points of a strand in the world, root first, in m.
    ///
    /// # Panics
    ///
    /// When `strand` is not below [`Self::len`], or the state is not of these strands.
    pub fn points<'a>(
        &self,
        state: &'a State,
        strand: usize,
    ) -> impl ExactSizeIterator<Item = DVec3> + use<'a> {
        self.root_and_particles(state, strand, |batch| (batch.root, &batch.y))
    }

    /// The velocities of a strand's points in the world, root first, in m/s. The root's is that of its last step.
    ///
    /// # Panics
    ///
    /// As [`Self::points`].
    pub fn velocities<'a>(
        &self,
        state: &'a State,
        strand: usize,
    ) -> impl ExactSizeIterator<Item = DVec3> + use<'a> {
        self.root_and_particles(state, strand, |batch| (batch.root_velocity, &batch.v))
    }

    /// A vector of a strand's root, then its sums with those of the particles, which are against the root.
    fn root_and_particles<'a>(
        &self,
        state: &'a State,
        strand: usize,
        of: fn(&BatchState) -> (LaneVec3, &[LaneVec3]),
    ) -> impl ExactSizeIterator<Item = DVec3> + use<'a> {
        let (batch, lane) = self.places[strand];
        let (root, particles) = of(&state.batches[batch]);
        let root = root.get(lane);
        (0..self.points[strand]).map(move |i| match i {
            0 => root,
            _ => root + particles[i - 1].get(lane),
        })
    }

    /// The material frames of a strand's links in the world, root first: the third axis points along the link.
    ///
    /// # Panics
    ///
    /// As [`Self::points`].
    pub fn frames(&self, state: &State, strand: usize) -> impl ExactSizeIterator<Item = DQuat> {
        let (batch, lane) = self.places[strand];
        let mut frames = Rods::frames_one_by_one(&self.batches[batch], &state.batches[batch]);
        (1..self.points[strand]).map(move |_| frames().get(lane))
    }
}

/// Whether every strand has an id of its own: where strands meet, ids decide in place of their order.
fn check_ids(ids: &[u32]) -> Result<(), DynamicsError> {
    let mut sorted = ids.to_vec();
    sorted.sort_unstable();
    match sorted.windows(2).find(|pair| pair[0] == pair[1]) {
        Some(pair) => Err(DynamicsError::SameId(pair[0])),
        None => Ok(()),
    }
}

/// A hash of the places of strands in batches (FNV-1a): straight strands stand apart, and what is straight is said by the parameters
/// as well as by the strands.
fn layout(places: &[(usize, usize)]) -> u64 {
    places
        .iter()
        .fold(0xcbf2_9ce4_8422_2325, |hash, (batch, lane)| {
            (hash ^ (batch * LANES + lane) as u64).wrapping_mul(0x0100_0000_01b3)
        })
}

/// The accelerations of every lane's root at both ends of the step, where they are known.
fn accelerations(batch: &Batch, surroundings: &Surroundings) -> Option<[LaneVec3; 2]> {
    let (Roots::Head(_), Some(ends)) = (surroundings.roots, surroundings.acceleration) else {
        return None;
    };
    let of_roots = |end: Acceleration| {
        let mut roots = batch.root;
        for lane in 0..LANES {
            roots.set(lane, end.of(batch.root.get(lane)));
        }
        roots
    };
    Some(ends.map(of_roots))
}
