//! The strand solver: strands in batches, each stepped by itself.

pub(crate) mod batch;
mod drive;
mod energy;
mod fallback;
mod finish;
#[cfg(test)]
mod free_flight;
mod free_motion;
pub(crate) mod instructions;
mod integrate;
mod neighbours;
#[cfg(test)]
mod ring;
mod scene;
mod straight;
pub(crate) mod sweep;

use glam::{DQuat, DVec3, Vec3};
use rayon::prelude::*;

use crate::{
    Strands,
    collision::contact::Guard,
    forces::mutual::{Course, Mutual, Pair},
    lanes::{LANES, Lane, Quat, Vec3 as LaneVec3},
    params::Params,
    rest::RestStrand,
};

pub use batch::Reason;
use batch::{Batch, BatchState, Scratch};
use drive::{Drive, Hair, whole_poses};
use instructions::{Instructions, run};
use integrate::{GAMMA, advance};
pub use scene::{Acceleration, DynamicsError, Fault, Pose, Roots, Scene, Stats};

/// The most groups of batches, so of tasks in a step.
const MOST_GROUPS: usize = 64;

/// The constants of some strands, and room to work in. The strands' motion is in [`State`].
#[derive(Clone, Debug)]
pub struct Solver {
    batches: Vec<Batch>,
    /// One for every group of batches.
    scratch: Vec<Scratch>,
    /// Batches in a group: a task steps them one after the other in the same room, which stays in the processor's cache.
    group: usize,
    /// Batch and lane of every strand.
    places: Vec<(usize, usize)>,
    /// The number of points of every strand, and the index of the first in the list of all.
    points: Vec<usize>,
    first_points: Vec<usize>,
    ids: Vec<u32>,
    hair: Option<HairHair>,
    /// Of the bodies in the step at hand.
    guards: Vec<Guard>,
    instructions: Instructions,
}

/// How the strands act on each other.
#[derive(Clone, Debug)]
struct HairHair {
    mutual: Mutual,
    /// Of every batch.
    pairs: Vec<Vec<Pair>>,
    /// Of every particle: batch by batch, particle by particle, lane by lane.
    courses: Vec<Course>,
}

/// Where every particle is, and where its own motion takes it.
fn follow(
    batches: &[Batch],
    states: &[BatchState],
    courses: &mut [Course],
    scene: &Scene,
    dt: f64,
) {
    // A task for fewer of them costs more than they do.
    if batches.len() > 64 {
        let half = batches.len() / 2;
        let (first, second) = batches.split_at(half);
        let particles: usize = first.iter().map(Batch::count).sum();
        let (these, those) = courses.split_at_mut(particles * LANES);
        rayon::join(
            || follow(first, &states[..half], these, scene, dt),
            || follow(second, &states[half..], those, scene, dt),
        );
        return;
    }
    let mut left = courses;
    for (batch, state) in batches.iter().zip(states) {
        let (own, others) = left.split_at_mut(batch.count() * LANES);
        left = others;
        let (root, _) = roots(batch, scene);
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
    /// Seconds since the start.
    time: f64,
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
        self.time
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
    /// When a parameter is out of its range.
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
            ids: (0..rest.len()).map(|i| rest.id(i)).collect(),
            hair: None,
            guards: Vec::new(),
            instructions: Instructions::best(),
        };
        let mut states = Vec::new();
        let kinds = order.chunk_by(|&a, &b| kind(a) == kind(b));
        for members in kinds.flat_map(|of_kind| of_kind.chunks(LANES)) {
            let described: Vec<_> = members
                .iter()
                .map(|&i| (i, &strands[i].0, &strands[i].1))
                .collect();
            let batch = Batch::new(&described);
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
        solver.scratch = (solver.batches.chunks(solver.group))
            .map(|group| Scratch::new(group.iter().map(Batch::count).max().unwrap_or(0)))
            .collect();
        let state = State {
            layout: layout(&solver.places),
            time: 0.0,
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
    /// When a number is out of its range, or the state is not of these strands.
    pub fn interact(&mut self, state: &mut State, mutual: &Mutual) -> Result<(), DynamicsError> {
        self.hair = None;
        self.check(state, &Scene::default(), 1.0)?;
        if let Some((name, value, least, most)) = mutual.out_of_range() {
            return Err(DynamicsError::Mutual {
                name,
                value,
                least,
                most,
            });
        }
        let pairs = neighbours::pairs(&self.batches, &state.batches, &self.ids, mutual);
        for (pairs, state) in pairs.iter().zip(&mut state.batches) {
            state.broken = vec![[false; LANES]; pairs.len()];
        }
        let total: usize = self.batches.iter().map(|b| b.count() * LANES).sum();
        self.hair = Some(HairHair {
            mutual: *mutual,
            pairs,
            courses: vec![Course::default(); total],
        });
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
    /// When the step, the state or the scene is none. The state is untouched then.
    pub fn step(
        &mut self,
        state: &mut State,
        scene: &Scene,
        dt: f64,
    ) -> Result<Stats, DynamicsError> {
        self.check(state, scene, dt)?;
        let instructions = self.instructions;
        let gusts = [GAMMA, 1.0].map(|share| scene.wind_at(share).at(state.time + share * dt));
        let acting = scene.fingerprint();
        let calm = acting == state.last && self.hair.is_none() && scene.is_calm();
        state.last = acting;
        self.guards.clear();
        self.guards.extend(scene.colliders.iter().map(Guard::new));
        if let Some(hair) = &mut self.hair {
            follow(&self.batches, &state.batches, &mut hair.courses, scene, dt);
        }
        let hair = self.hair.as_ref();
        let (first_points, guards) = (&self.first_points, &self.guards);
        let last_dt = if state.last_dt > 0.0 {
            state.last_dt
        } else {
            dt
        };
        let step = |index: usize, batch: &Batch, state: &mut BatchState, scratch: &mut Scratch| {
            let (root, base) = roots(batch, scene);
            let drive = Drive {
                dt,
                last_dt,
                scene,
                guards,
                gusts: &gusts,
                first_points,
                root,
                base,
                accelerations: accelerations(batch, scene),
                calm,
                hair: hair.map(|h| Hair {
                    mutual: &h.mutual,
                    pairs: &h.pairs[index],
                    courses: &h.courses,
                }),
            };
            Stats::from(run!(instructions, advance(batch, state, scratch, &drive)))
        };
        let group = self.group;
        let one_group =
            |index: usize, batches: &[Batch], states: &mut [BatchState], scratch: &mut Scratch| {
                (batches.iter().zip(states).enumerate())
                    .map(|(i, (batch, state))| step(index * group + i, batch, state, scratch))
                    .fold(Stats::default(), Stats::plus)
            };
        let sum = if let [scratch] = &mut self.scratch[..] {
            // A task for the only one would take longer than the strand.
            one_group(0, &self.batches, &mut state.batches, scratch)
        } else {
            (self.batches.par_chunks(group).enumerate())
                .zip(state.batches.par_chunks_mut(group))
                .zip(self.scratch.par_iter_mut())
                .map(|(((index, batches), states), scratch)| {
                    one_group(index, batches, states, scratch)
                })
                .reduce(Stats::default, Stats::plus)
        };
        state.time += dt;
        state.last_dt = dt;
        Ok(sum)
    }

    /// Puts the roots elsewhere at once: shape and motion are carried along, as if nothing had happened.
    ///
    /// # Errors
    ///
    /// When the poses or the state are none.
    pub fn teleport(&self, state: &mut State, to: Roots) -> Result<(), DynamicsError> {
        let scene = Scene {
            roots: to,
            ..Scene::default()
        };
        self.check(state, &scene, 1.0)?;
        for (batch, state) in self.batches.iter().zip(&mut state.batches) {
            let (root, base) = roots(batch, &scene);
            let (root, base) = whole_poses(state, root, base);
            state.teleport(root, base);
        }
        Ok(())
    }

    fn check(&self, state: &State, scene: &Scene, dt: f64) -> Result<(), DynamicsError> {
        scene.check(dt, self.len(), self.points.iter().sum())?;
        let fits = state.layout == layout(&self.places)
            && state.batches.len() == self.batches.len()
            && (self.batches.iter().zip(&state.batches)).all(|(b, s)| {
                s.y.len() == b.count() && (b.is_straight || s.frames.len() == b.count())
            })
            && self.hair.as_ref().is_none_or(|h| {
                (h.pairs.iter().zip(&state.batches)).all(|(p, s)| s.broken.len() == p.len())
            });
        if fits {
            Ok(())
        } else {
            Err(DynamicsError::State)
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
        state.batches[batch].energy::<Lane>(&self.batches[batch], pull)[lane]
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
    pub fn frames(
        &self,
        state: &State,
        strand: usize,
    ) -> impl ExactSizeIterator<Item = DQuat> + use<> {
        let (batch, lane) = self.places[strand];
        let mut frames = state.batches[batch].link_frames(&self.batches[batch]);
        frames.truncate(self.points[strand] - 1);
        frames.into_iter().map(move |frame| frame.get(lane))
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

/// Root and frame of the skin of every lane in the world.
fn roots(batch: &Batch, scene: &Scene) -> (LaneVec3, Quat) {
    let (mut root, mut base) = (batch.root, batch.base);
    for lane in 0..LANES {
        let Some(strand) = batch.strands[lane] else {
            continue;
        };
        let pose = match scene.roots {
            Roots::Head(pose) => pose,
            Roots::Each(poses) => poses[strand],
        };
        root.set(
            lane,
            pose.translation + pose.rotation * batch.root.get(lane),
        );
        base.set(lane, pose.rotation * batch.base.get(lane));
    }
    (root, base)
}

/// The accelerations of every lane's root at both ends of the step, where they are known.
fn accelerations(batch: &Batch, scene: &Scene) -> Option<[LaneVec3; 2]> {
    let (Roots::Head(_), Some(ends)) = (scene.roots, scene.acceleration) else {
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{GRAVITY, Wind};
    use std::time::{Duration, Instant};

    /// Prints what a step takes in each as well.
    #[test]
    #[allow(
        clippy::print_stdout,
        reason = "it shows what vector instructions are worth"
    )]
    fn every_instruction_set_gives_the_same_bits() {
        let mut rest = Strands::new();
        for s in 0..72_u32 {
            let turn = s as f32 * 0.6;
            // Of different lengths, so that batches mix them.
            let links = 18 + s % 3;
            let points: Vec<Vec3> = (0..=links)
                .map(|i| {
                    let u = i as f32 / links as f32;
                    Vec3::new(turn.cos() + u, 0.3 * u * u, turn.sin() + (3.0 * u).sin()) * 0.1
                })
                .collect();
            rest.push(s, &points, None).unwrap();
        }
        let states = [Instructions::Compiled, Instructions::best()].map(|instructions| {
            let (mut solver, mut state) = Solver::new(&rest, &Params::default()).unwrap();
            solver.instructions = instructions;
            let mut shortest = Duration::MAX;
            for i in 0..96 {
                let scene = Scene {
                    gravity: DVec3::new(f64::from(i % 5), -GRAVITY, 0.0),
                    wind: Wind {
                        gust: 3.0,
                        ..Wind::default()
                    },
                    ..Scene::default()
                };
                let start = Instant::now();
                solver.step(&mut state, &scene, 1.0 / 60.0).unwrap();
                shortest = shortest.min(start.elapsed());
            }
            println!("{instructions:?}: {shortest:?} for a step of 72 strands of 20 points");
            state
        });
        assert!(states[0] == states[1]);
    }
}
