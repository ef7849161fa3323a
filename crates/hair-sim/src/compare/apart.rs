//! What solvers of strands that don't meet have in common: each strand is solved by itself.

use crate::{
    collision::shape::Collider,
    error::DynamicsError,
    forces::wind::Gusts,
    lanes,
    params::Params,
    pose::Pose,
    stats::Stats,
    strands::Strands,
    surroundings::{Roots, Surroundings},
    threads::join,
};
use glam::{DVec3, Vec3};

/// A strand of a solver for comparison, constants and motion.
pub(super) trait Strand: Send {
    /// The strand through these points (style space, m) at rest, of which the first has this index in the list of all strands'.
    fn new(points: &[Vec3], params: &Params, first_point: usize) -> Self;

    /// Carries shape and motion along to another pose of the head.
    fn teleport(&mut self, to: Pose);
}

/// The strands at rest, each with its own parameters.
pub(super) fn strands<S: Strand>(
    rest: &Strands,
    params: impl Fn(usize) -> Params,
) -> Result<Vec<S>, DynamicsError> {
    let strand = |(index, points)| {
        let params: Params = params(index);
        match params.out_of_range() {
            Some((name, value, least, most)) => Err(DynamicsError::Parameter {
                id: rest.id(index),
                name,
                value,
                least,
                most,
            }),
            None => Ok(S::new(points, &params, rest.point_range(index).start)),
        }
    };
    rest.iter().enumerate().map(strand).collect()
}

/// Steps every strand, each with the pose of its head at the end. `points` are those of all strands.
pub(super) fn step<S: Strand>(
    state: &mut [S],
    surroundings: &Surroundings,
    points: usize,
    dt: f64,
    step: impl Fn(&mut S, Pose) -> Stats + Sync,
) -> Result<Stats, DynamicsError> {
    surroundings.check(dt, state.len(), points)?;
    let one = |index: usize, strand: &mut S| step(strand, surroundings.roots.of(index));
    Ok(step_all(state, 0, &one))
}

/// Steps strands, of which the first is number `first` of all.
fn step_all<S: Strand>(
    state: &mut [S],
    first: usize,
    step: &(impl Fn(usize, &mut S) -> Stats + Sync),
) -> Stats {
    // A task for fewer of them costs more than they do.
    if state.len() > 4 {
        let half = state.len() / 2;
        let (one, two) = state.split_at_mut(half);
        let (sum, more) = join(
            || step_all(one, first, step),
            || step_all(two, first + half, step),
        );
        return sum.plus(more);
    }
    (state.iter_mut().enumerate())
        .map(|(i, strand)| step(first + i, strand))
        .fold(Stats::default(), Stats::plus)
}

/// Puts the roots elsewhere at once.
pub(super) fn teleport<S: Strand>(
    state: &mut [S],
    to: Roots,
    points: usize,
) -> Result<(), DynamicsError> {
    let surroundings = Surroundings {
        roots: to,
        ..Surroundings::default()
    };
    surroundings.check(1.0, state.len(), points)?;
    for (index, strand) in state.iter_mut().enumerate() {
        strand.teleport(to.of(index));
    }
    Ok(())
}

/// What acts on all particles in a substep.
pub(super) struct Acting<'a> {
    pub gravity: DVec3,
    pub gusts: Option<&'a Gusts<'a>>,
    pub colliders: &'a [Collider<'a>],
    /// The share of the step that is done at the end of the substep.
    pub share: f64,
}

impl Acting<'_> {
    /// The air's velocity at a place.
    pub fn air(&self, at: DVec3) -> DVec3 {
        self.gusts.map_or(DVec3::ZERO, |gusts| {
            gusts.velocity(lanes::Vec3::splat(at)).get(0)
        })
    }

    /// Puts a particle that was at `before` and is in a body on its skin, and holds it there by friction. Returns of how many
    /// bodies.
    pub fn keep_out(
        &self,
        point: &mut DVec3,
        before: DVec3,
        thickness: f64,
        friction: f64,
    ) -> usize {
        let mut found = 0;
        for collider in self.colliders {
            let pose = on_the_way(collider.before, collider.now, self.share);
            let place = pose.to_local(*point);
            let mut distance = collider.shape.distance(place);
            if let Some(was) = &collider.was {
                distance = was.distance(place) * (1.0 - self.share) + distance * self.share;
            }
            let depth = thickness - distance;
            if depth <= 0.0 || !depth.is_finite() {
                continue;
            }
            found += 1;
            let normal = pose.rotation * collider.shape.normal(place);
            let pushed = *point + normal * depth;
            let slid = pushed - before;
            let slid = slid - normal * slid.dot(normal);
            let held = (friction * depth / slid.length().max(1e-12)).min(1.0);
            *point = pushed - slid * held;
        }
        found
    }
}

/// The pose at `share` of the way from one to another, 0 to 1: along the chord, which needs no sine.
pub(super) fn on_the_way(from: Pose, to: Pose, share: f64) -> Pose {
    let short = if from.rotation.dot(to.rotation) < 0.0 {
        -to.rotation
    } else {
        to.rotation
    };
    Pose {
        rotation: (from.rotation * (1.0 - share) + short * share).normalize(),
        translation: from.translation.lerp(to.translation, share),
    }
}

/// A pull to a place, damped critically, per mass.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pull {
    /// In 1/s^2, and of the damping in 1/s.
    pub stiffness: f64,
    pub rate: f64,
    /// Where to, at the end of a substep, and how fast that moves.
    pub goal: DVec3,
    pub drift: DVec3,
}

impl Pull {
    /// To a goal that moves evenly from `before` to `now` within a step of `dt` seconds, of which `share` is done at the end
    /// of the substep.
    pub fn new(stiffness: f64, before: DVec3, now: DVec3, share: f64, dt: f64) -> Self {
        Self {
            stiffness,
            rate: 2.0 * stiffness.sqrt(),
            goal: before.lerp(now, share),
            drift: (now - before) / dt,
        }
    }

    /// The acceleration of a particle that rests at `point`.
    pub fn push(&self, point: DVec3) -> DVec3 {
        (self.goal - point) * self.stiffness + self.drift * self.rate
    }

    /// What divides the velocity at the end of a substep of `dt` seconds, beyond 1.
    pub fn slowing(&self, dt: f64) -> f64 {
        dt * (self.rate + dt * self.stiffness)
    }
}
