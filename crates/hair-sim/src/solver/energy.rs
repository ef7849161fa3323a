//! No energy from nowhere.
//!
//! Where nothing drives a strand, its energy may not rise above the least that it has had. What errors of a step add to its
//! motion is taken out of its velocities. A step whose shape alone has more fails: the safe integrator's has not, since
//! its potential starts at the strand's energy and only goes down.

use crate::lanes::{Lane, Mask, Number, Quat, Vec3};

use super::{
    batch::{Batch, BatchState, NO_PULL, Scratch},
    drive::{Drive, RootMotion},
    straight::chord,
    sweep::half_turn,
};

/// A shape may have this much more energy, over that of bending and twisting and what lifts it by its length:
/// what rounding and unfinished iterations leave.
const SLACK: f64 = 1e-4;

/// A strand that nothing takes energy from may have this much more than its least, over the same and its motion's: the
/// error of a good step goes to and fro, and a strand that is held to the least would lose by it.
const PLAY: f64 = 5e-4;

/// The energy of every strand's shape over its mass per length, in m^3/s^2: of bending and twisting, and of weight from the root.
pub(super) struct ShapeEnergy {
    elastic: Lane,
    weight: Lane,
}

impl ShapeEnergy {
    pub(super) const NONE: Self = Self {
        elastic: Lane::ZERO,
        weight: Lane::ZERO,
    };

    pub(super) fn pick(mask: Mask, yes: Self, no: Self) -> Self {
        Self {
            elastic: mask.pick(yes.elastic, no.elastic),
            weight: mask.pick(yes.weight, no.weight),
        }
    }

    /// Of straight strands.
    #[inline(always)]
    fn of_straight<T: Number>(
        batch: &Batch,
        base: Quat,
        y: &[Vec3],
        tangent: impl Fn(usize) -> Vec3<T>,
        pull: Vec3,
    ) -> Self {
        let (mut elastic, mut weight) = (T::splat(0.0), T::splat(0.0));
        let (mut before, pull) = (base.load::<T>().tangent(), pull.load::<T>());
        for (k, link) in batch.links.iter().enumerate() {
            let mass: T = batch.particles[k].mass.load();
            weight = weight - mass * y[k].load().dot(pull);
            // Of an angle between two unit vectors: the tangent of its half is their difference over their sum.
            let length = link.length.load::<T>();
            let t = Vec3::choose(T::splat(0.0).less(length), tangent(k), before);
            let (difference, sum) = (t - before, t + before);
            let tangent_squared = difference.length_squared() / sum.length_squared();
            elastic = elastic + link.bend.load::<T>() * tangent_squared * T::splat(2.0);
            before = t;
        }
        Self {
            elastic: elastic.store(),
            weight: weight.store(),
        }
    }

    #[inline(always)]
    fn new<T: Number>(batch: &Batch, base: Quat, frames: &[Quat], y: &[Vec3], pull: Vec3) -> Self {
        let (mut elastic, mut weight) = (T::splat(0.0), T::splat(0.0));
        let (mut before, pull) = (base.load::<T>(), pull.load::<T>());
        for (k, link) in batch.links.iter().enumerate() {
            let (link, frame) = (link.load::<T>(), frames[k].load());
            let mass: T = batch.particles[k].mass.load();
            weight = weight - mass * y[k].load().dot(pull);
            let c = half_turn(before, frame);
            let e = c + c - link.natural;
            let bends = (e.x * e.x + e.y * e.y) * link.bend;
            elastic = elastic + (bends + e.z * e.z * link.twist) * T::splat(0.5);
            before = frame;
        }
        Self {
            elastic: elastic.store(),
            weight: weight.store(),
        }
    }

    fn sum(&self) -> Lane {
        self.elastic + self.weight
    }

    /// What bends and twists the strand, and what lifts it by its length.
    fn scale(&self, batch: &Batch, pull: Vec3) -> Lane {
        self.elastic + batch.lever * pull.length_squared().sqrt()
    }
}

impl BatchState {
    /// Of motion against the root, in m^3/s^2.
    #[inline(always)]
    fn kinetic<T: Number>(&self, batch: &Batch) -> Lane {
        let mut sum = T::splat(0.0);
        for (particle, v) in batch.particles.iter().zip(&self.v) {
            let v: Vec3<T> = v.load();
            sum = sum + particle.mass.load::<T>() * v.length_squared() * T::splat(0.5);
        }
        sum.store()
    }

    /// Energy of every strand over its mass per length, in m^3/s^2.
    #[inline(always)]
    pub(super) fn energy<T: Number>(&self, batch: &Batch, pull: Vec3) -> Lane {
        self.kinetic::<T>(batch) + self.shape_energy::<T>(batch, self.base, pull).sum()
    }

    /// With the skin's frame at `base`.
    #[inline(always)]
    fn shape_energy<T: Number>(&self, batch: &Batch, base: Quat, pull: Vec3) -> ShapeEnergy {
        if batch.is_straight {
            ShapeEnergy::of_straight::<T>(
                batch,
                base,
                &self.y,
                #[inline(always)]
                |k| chord(&self.y, k).scale(T::splat(1.0) / batch.links[k].length.load()),
                pull,
            )
        } else {
            ShapeEnergy::new::<T>(batch, base, &self.frames, &self.y, pull)
        }
    }
}

/// Finds the strands of `active` that nothing drives in this step, and the most energy that they may have. Called before the
/// state moves on.
#[inline(always)]
pub(super) fn watch<T: Number>(
    batch: &Batch,
    state: &mut BatchState,
    scratch: &Scratch,
    drive: &Drive,
    root: &RootMotion,
    active: Mask,
) -> Mask {
    let watched = active.and(undriven(batch, state, scratch, drive, root));
    // Another pull is another weight, and what drove the strand gave it what it has now.
    let is_new = (root.pull - state.pull).length_squared().gt(Lane::ZERO);
    let is_new = watched.and(is_new);
    if is_new.any() {
        state.ceiling = is_new.pick(state.energy::<T>(batch, root.pull), state.ceiling);
    }
    state.pull = Vec3::pick(watched, root.pull, NO_PULL);
    watched
}

/// Strands whose roots rest, in still air, without goals, contacts and other hair.
#[inline(always)]
fn undriven(
    batch: &Batch,
    state: &BatchState,
    scratch: &Scratch,
    drive: &Drive,
    root: &RootMotion,
) -> Mask {
    if drive.hair.is_some() {
        return Mask::NONE;
    }
    // A root at rest may be about to move.
    let gravity = Vec3::splat(drive.scene.gravity);
    let moves = root.turn_end.v.length_squared()
        + root.velocity.length_squared()
        + state.root_velocity.length_squared()
        + (root.pull_mid - gravity).length_squared()
        + (root.pull - gravity).length_squared();
    let mut free = moves.gt(Lane::splat(1e-24)).not().and(batch.has_goal.not());
    if drive.gusts.iter().any(|gusts| gusts.blows) {
        free = free.and(batch.has_drag.not());
    }
    for &k in &scratch.touched {
        free = free.and(scratch.contacts[k].on.lt(Lane::splat(0.5)));
    }
    free
}

impl ShapeEnergy {
    /// The strands of `watched` whose shape has more energy than they may have.
    pub(super) fn is_out_of_reach(
        &self,
        batch: &Batch,
        state: &BatchState,
        root: &RootMotion,
        watched: Mask,
    ) -> Mask {
        let slack = self.scale(batch, root.pull) * SLACK;
        watched.and(self.sum().gt(state.ceiling + slack))
    }
}

/// Of the shapes at the end of the step.
#[inline(always)]
pub(super) fn of_end<T: Number>(
    batch: &Batch,
    scratch: &Scratch,
    root: &RootMotion,
) -> ShapeEnergy {
    let end = &scratch.end;
    if batch.is_straight {
        ShapeEnergy::of_straight::<T>(
            batch,
            root.end,
            &end.y,
            #[inline(always)]
            |k| end.tangents[k].load(),
            root.pull,
        )
    } else {
        ShapeEnergy::new::<T>(batch, root.end, &end.frames, &end.y, root.pull)
    }
}

/// Of the shapes that the strands have.
#[inline(always)]
pub(super) fn of_state<T: Number>(
    batch: &Batch,
    state: &BatchState,
    root: &RootMotion,
) -> ShapeEnergy {
    state.shape_energy::<T>(batch, root.end, root.pull)
}

/// Takes the energy that a strand may not have out of its velocities.
#[inline(always)]
pub(super) fn take_gain<T: Number>(
    batch: &Batch,
    state: &mut BatchState,
    root: &RootMotion,
    shape: &ShapeEnergy,
    watched: Mask,
) {
    let motion = state.kinetic::<T>(batch);
    let gain = (motion + shape.sum() - state.ceiling).max(Lane::ZERO);
    let left = (motion - gain).max(Lane::ZERO) / motion.max(Lane::splat(1e-300));
    let scale = (watched.and(gain.gt(Lane::ZERO))).pick(left.sqrt(), Lane::ONE);
    let motion = motion * scale * scale;
    let loses = batch.has_drag.or(batch.damping.gt(Lane::ZERO));
    let play = (motion + shape.scale(batch, root.pull)) * PLAY;
    let most = motion + shape.sum() + loses.pick(Lane::ZERO, play);
    state.ceiling = watched.pick(state.ceiling.min(most), state.ceiling);
    if scale != Lane::ONE {
        for v in &mut state.v {
            *v = *v * scale;
        }
    }
}
