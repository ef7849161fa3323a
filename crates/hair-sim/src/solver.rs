//! The strand solver: strands in batches, each stepped by itself.

pub(crate) mod batch;
mod drive;
mod fallback;
mod instructions;
mod integrate;
mod neighbours;
pub(crate) mod sweep;

use glam::{DQuat, DVec3, Vec3};
use rayon::prelude::*;

use crate::{
    Strands,
    collision::Collider,
    forces::{
        mutual::{Course, Mutual, Pair},
        wind::Wind,
    },
    lanes::{LANES, Quat, Vec3 as LaneVec3},
    params::{GRAVITY, Params},
    rest::RestStrand,
};

pub use batch::Reason;
use batch::{Batch, BatchState, Scratch};
use drive::{Drive, Hair};
use instructions::Instructions;
use integrate::BatchStats;

/// A rigid motion from style space to the world: where a head is.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Pose {
    /// A unit quaternion.
    pub rotation: DQuat,
    /// In m.
    pub translation: DVec3,
}

impl Pose {
    /// Style space is the world.
    pub const IDENTITY: Self = Self {
        rotation: DQuat::IDENTITY,
        translation: DVec3::ZERO,
    };

    pub(crate) fn to_world(self, at: DVec3) -> DVec3 {
        self.rotation * at + self.translation
    }

    pub(crate) fn to_local(self, at: DVec3) -> DVec3 {
        self.rotation.conjugate() * (at - self.translation)
    }

    pub(crate) fn is_finite(&self) -> bool {
        self.rotation.is_finite() && self.translation.is_finite()
    }
}

/// Where the roots are at the end of a step.
#[derive(Clone, Copy, Debug)]
pub enum Roots<'a> {
    /// All on one head.
    Head(Pose),
    /// One pose per strand.
    Each(&'a [Pose]),
}

/// What acts on the strands in a step.
#[derive(Clone, Copy, Debug)]
pub struct Scene<'a> {
    /// Where the roots are at the end of the step.
    pub roots: Roots<'a>,
    /// In m/s^2.
    pub gravity: DVec3,
    /// The motion of the air.
    pub wind: Wind,
    /// What hair cannot enter.
    pub colliders: &'a [Collider<'a>],
    /// Places in style space for the points of all strands, in their order, to which [`Params::goal`] pulls; none
    /// is the style itself.
    pub goal: Option<&'a [Vec3]>,
}

impl Default for Scene<'_> {
    fn default() -> Self {
        Self {
            roots: Roots::Head(Pose::IDENTITY),
            gravity: DVec3::new(0.0, -GRAVITY, 0.0),
            wind: Wind::default(),
            colliders: &[],
            goal: None,
        }
    }
}

impl Scene<'_> {
    /// Whether nothing in it moves but, perhaps, the roots.
    fn is_calm(&self) -> bool {
        let still = |c: &Collider| c.before == c.now;
        self.wind.gust == 0.0 && self.goal.is_none() && self.colliders.iter().all(still)
    }

    /// A hash of what acts on strands at rest.
    fn fingerprint(&self) -> u64 {
        let mut hash = 0xcbf2_9ce4_8422_2325_u64; // FNV-1a, by words
        let mut add = |v: DVec3| {
            for bits in v.to_array().map(f64::to_bits) {
                hash = (hash ^ bits).wrapping_mul(0x0100_0000_01b3);
            }
        };
        add(self.gravity);
        add(self.wind.steady);
        for collider in self.colliders {
            add(collider.now.translation);
            add(collider.now.rotation * DVec3::X);
            add(collider.now.rotation * DVec3::Y);
            for v in collider.shape.numbers() {
                add(v);
            }
        }
        hash
    }
}

/// What happened in a step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Stats {
    /// Strands that were stepped.
    pub strands: usize,
    /// Newton iterations of all strands; two a strand is the least.
    pub iterations: usize,
    /// Strands that took the safe integrator in this step.
    pub fallbacks: usize,
    /// Strands that are set aside: see [`Solver::faults`].
    pub set_aside: usize,
    /// Particles that were near a body or touched it.
    pub contacts: usize,
    /// Particles that felt wind.
    pub wind: usize,
    /// Links between strands that held.
    pub links: usize,
    /// Particles that another strand pushed away.
    pub repulsions: usize,
    /// Strands that rest, and cost nothing.
    pub asleep: usize,
}

impl Stats {
    fn plus(self, other: Self) -> Self {
        Self {
            strands: self.strands + other.strands,
            iterations: self.iterations + other.iterations,
            fallbacks: self.fallbacks + other.fallbacks,
            set_aside: self.set_aside + other.set_aside,
            contacts: self.contacts + other.contacts,
            wind: self.wind + other.wind,
            links: self.links + other.links,
            repulsions: self.repulsions + other.repulsions,
            asleep: self.asleep + other.asleep,
        }
    }
}

impl From<BatchStats> for Stats {
    fn from(batch: BatchStats) -> Self {
        Self {
            strands: batch.strands,
            iterations: batch.iterations,
            fallbacks: batch.fallbacks,
            set_aside: batch.set_aside,
            contacts: batch.contacts,
            wind: batch.wind,
            links: batch.hair.links,
            repulsions: batch.hair.repulsions,
            asleep: batch.asleep,
        }
    }
}

impl HairHair {
    /// Where every particle is, and where its own motion takes it.
    fn follow(&mut self, batches: &[Batch], states: &[BatchState], scene: &Scene, dt: f64) {
        for ((batch, state), &first) in batches.iter().zip(states).zip(&self.first) {
            let (root, _) = roots(batch, scene);
            for k in 0..batch.count() {
                let (before, now) = (state.root + state.y[k], root + state.y[k] + state.v[k] * dt);
                let courses = &mut self.courses[first + k * LANES..][..LANES];
                for (lane, course) in courses.iter_mut().enumerate() {
                    let (before, now) = (before.get(lane), now.get(lane));
                    // A root without a pose is the strand's own fault, not its neighbours'.
                    let now = if now.is_finite() { now } else { before };
                    *course = Course { before, now };
                }
            }
        }
    }
}

/// Why strands make no solver.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum DynamicsError {
    /// A parameter has a range.
    #[error("strand {id}: {name} is {value}, and must be from {least} to {most}")]
    Parameter {
        /// The strand's id.
        id: u32,
        /// The parameter.
        name: &'static str,
        /// As it was given.
        value: f64,
        /// The least.
        least: f64,
        /// The most.
        most: f64,
    },
    /// A step takes time.
    #[error("a step of {0} s: it must be more than 0 and at most 10 s")]
    Step(f64),
    /// Numbers of the scene are finite.
    #[error("the scene's {0} is not finite")]
    Scene(&'static str),
    /// A number of [`Mutual`] has a range.
    #[error("{name} is {value}, and must be from {least} to {most}")]
    Mutual {
        /// Its name.
        name: &'static str,
        /// As it was given.
        value: f64,
        /// The least.
        least: f64,
        /// The most.
        most: f64,
    },
    /// There is one pose for every strand.
    #[error("{found} poses for {expected} strands")]
    Poses {
        /// How many there are.
        found: usize,
        /// How many strands there are.
        expected: usize,
    },
    /// There is one goal for every point.
    #[error("goals for {found} points; the strands have {expected}")]
    Goal {
        /// How many there are.
        found: usize,
        /// How many points there are.
        expected: usize,
    },
    /// A state belongs to the strands that it was made with.
    #[error("the state is not of these strands")]
    State,
}

/// A strand that is set aside: it follows its root without a motion of its own.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("strand {id} is set aside: {reason}")]
pub struct Fault {
    /// The strand's id.
    pub id: u32,
    /// Why.
    pub reason: Reason,
}

/// The constants of some strands, and room to work in. The strands' motion is in [`State`].
#[derive(Clone, Debug)]
pub struct Solver {
    batches: Vec<Batch>,
    scratch: Vec<Scratch>,
    /// Batch and lane of every strand.
    places: Vec<(usize, usize)>,
    /// The number of points of every strand, and the index of the first in the list of all.
    points: Vec<usize>,
    first_points: Vec<usize>,
    ids: Vec<u32>,
    hair: Option<HairHair>,
    instructions: Instructions,
}

/// How the strands act on each other.
#[derive(Clone, Debug)]
struct HairHair {
    mutual: Mutual,
    /// Of every batch.
    pairs: Vec<Vec<Pair>>,
    /// The index of every batch's first particle, and the courses of all: batch by batch, particle by particle, lane
    /// by lane.
    first: Vec<usize>,
    courses: Vec<Course>,
}

/// Everything that decides the strands' future, to the bit.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct State {
    /// Seconds since the start.
    time: f64,
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

        // Strands of like length together; the order is fixed by the strands alone.
        let mut order: Vec<usize> = (0..strands.len()).collect();
        order.sort_by_key(|&i| (strands[i].0.links.len(), i));
        let mut solver = Self {
            batches: Vec::new(),
            scratch: Vec::new(),
            places: vec![(0, 0); strands.len()],
            points: rest.iter().map(<[Vec3]>::len).collect(),
            first_points: (0..rest.len()).map(|i| rest.point_range(i).start).collect(),
            ids: (0..rest.len()).map(|i| rest.id(i)).collect(),
            hair: None,
            instructions: best_instructions(),
        };
        let mut states = Vec::new();
        for members in order.chunks(LANES) {
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
            solver.scratch.push(Scratch::new(batch.count()));
            states.push(state);
            solver.batches.push(batch);
        }
        let state = State {
            time: 0.0,
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
        let (pairs, first) = neighbours::pairs(&self.batches, &state.batches, &self.ids, mutual);
        for (pairs, state) in pairs.iter().zip(&mut state.batches) {
            state.broken = vec![[false; LANES]; pairs.len()];
        }
        let total: usize = self.batches.iter().map(|b| b.count() * LANES).sum();
        self.hair = Some(HairHair {
            mutual: *mutual,
            pairs,
            first,
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
        // In the middle of the step.
        let gusts = scene.wind.at(state.time + 0.5 * dt);
        let acting = scene.fingerprint();
        let calm = acting == state.last && self.hair.is_none() && scene.is_calm();
        state.last = acting;
        if let Some(hair) = &mut self.hair {
            hair.follow(&self.batches, &state.batches, scene, dt);
        }
        let hair = self.hair.as_ref();
        let first_points = &self.first_points;
        let sum = (self.batches.par_iter().enumerate())
            .zip(state.batches.par_iter_mut())
            .zip(self.scratch.par_iter_mut())
            .map(|(((index, batch), state), scratch)| {
                let (root, base) = roots(batch, scene);
                let drive = Drive {
                    dt,
                    scene,
                    gusts: &gusts,
                    first_points,
                    root,
                    base,
                    calm,
                    hair: hair.map(|h| Hair {
                        mutual: &h.mutual,
                        pairs: &h.pairs[index],
                        courses: &h.courses,
                    }),
                };
                Stats::from(instructions.step(batch, state, scratch, &drive))
            })
            .reduce(Stats::default, Stats::plus);
        state.time += dt;
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
            state.teleport(root, base);
        }
        Ok(())
    }

    fn check(&self, state: &State, scene: &Scene, dt: f64) -> Result<(), DynamicsError> {
        if !(dt > 0.0 && dt <= 10.0) {
            return Err(DynamicsError::Step(dt));
        }
        if !scene.gravity.is_finite() {
            return Err(DynamicsError::Scene("gravity"));
        }
        if !scene.wind.is_finite() {
            return Err(DynamicsError::Scene("wind"));
        }
        if !scene.colliders.iter().all(Collider::is_finite) {
            return Err(DynamicsError::Scene("collider"));
        }
        let points: usize = self.points.iter().sum();
        if let Some(found) = scene.goal.map(<[Vec3]>::len).filter(|&n| n != points) {
            return Err(DynamicsError::Goal {
                found,
                expected: points,
            });
        }
        match scene.roots {
            Roots::Head(pose)
                if !pose.is_finite() || (pose.rotation.length_squared() - 1.0).abs() > 1e-3 =>
            {
                return Err(DynamicsError::Scene("head"));
            }
            Roots::Each(poses) if poses.len() != self.len() => {
                return Err(DynamicsError::Poses {
                    found: poses.len(),
                    expected: self.len(),
                });
            }
            _ => {}
        }
        let fits = state.batches.len() == self.batches.len()
            && (self.batches.iter().zip(&state.batches)).all(|(b, s)| s.y.len() == b.count())
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
        state.batches[batch].energy(&self.batches[batch], LaneVec3::splat(gravity))[lane]
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
        let (batch, lane) = self.places[strand];
        let state = &state.batches[batch];
        let root = state.root.get(lane);
        (0..self.points[strand]).map(move |i| match i {
            0 => root,
            _ => root + state.y[i - 1].get(lane),
        })
    }

    /// The material frames of a strand's links in the world, root first: the third axis points along the link.
    ///
    /// # Panics
    ///
    /// As [`Self::points`].
    pub fn frames<'a>(
        &self,
        state: &'a State,
        strand: usize,
    ) -> impl ExactSizeIterator<Item = DQuat> + use<'a> {
        let (batch, lane) = self.places[strand];
        let state = &state.batches[batch];
        (0..self.points[strand] - 1).map(move |i| state.frames[i].get(lane))
    }
}

fn best_instructions() -> Instructions {
    *Instructions::available()
        .last()
        .unwrap_or(&Instructions::Compiled)
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
