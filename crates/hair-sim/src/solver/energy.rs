//! No energy from nowhere.
//!
//! Where nothing drives a strand, its energy may not rise above the least that it has had. What errors of a step add to its
//! motion is taken out of its velocities. A step whose shape alone has more fails: the safe integrator's has not, since
//! its potential starts at the strand's energy and only goes down.

use crate::lanes::{Lane, Mask, Number, Vec3};

use super::{
    batch::{Batch, BatchState, NO_PULL},
    chain::ShapeEnergy,
    drive::{Drive, RootMotion},
    load::Loads,
    rods::Rods,
};

/// A shape may have this much more energy, over that of bending and twisting and what lifts it by its length:
/// what rounding and unfinished iterations leave.
const SLACK: f64 = 1e-4;

/// A strand that nothing takes energy from may have this much more than its least, over the same and its motion's: the
/// error of a good step goes to and fro, and a strand that is held to the least would lose by it.
const PLAY: f64 = 5e-4;

impl ShapeEnergy {
    /// What bends and twists the strand, and what lifts it by its length.
    #[inline(always)]
    fn scale(&self, batch: &Batch, pull: Vec3) -> Lane {
        self.elastic + batch.lever * pull.length_squared().sqrt()
    }

    /// The strands of `watched` whose shape has more energy than they may have.
    #[inline(always)]
    pub(crate) fn is_out_of_reach(
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

/// Energy of motion against the root over mass per length, in m^3/s^2.
fn kinetic<T: Number>(batch: &Batch, state: &BatchState) -> Lane {
    T::run(
        #[inline(always)]
        move || {
            let mut sum = T::splat(0.0);
            for (particle, v) in batch.particles.iter().zip(&state.v) {
                let v: Vec3<T> = v.load();
                sum = sum + particle.mass.load::<T>() * v.length_squared() * T::splat(0.5);
            }
            sum.store()
        },
    )
}

/// Energy of every strand over its mass per length, in m^3/s^2.
pub(crate) fn whole_energy<T: Number>(batch: &Batch, state: &BatchState, pull: &Vec3) -> Lane {
    let shape = Rods::of(batch).energy_of::<T>(batch, state, &state.base, pull);
    kinetic::<T>(batch, state) + shape.sum()
}

/// Finds the strands of `active` that nothing drives in this step, and the most energy that they may have. Called before the
/// state moves on.
#[inline(always)]
pub(crate) fn watch<T: Number>(
    batch: &Batch,
    state: &mut BatchState,
    loads: &Loads,
    drive: &Drive,
    root: &RootMotion,
    active: Mask,
) -> Mask {
    let watched = active.and(undriven(batch, state, loads, drive, root));
    // Another pull is another weight, and what drove the strand gave it what it has now.
    let is_new = (root.pull - state.pull).length_squared().gt(Lane::ZERO);
    let is_new = watched.and(is_new);
    if is_new.any() {
        state.ceiling = is_new.pick(whole_energy::<T>(batch, state, &root.pull), state.ceiling);
    }
    // What sleeps keeps what it has, as where a whole batch sleeps.
    let pull = Vec3::pick(watched, root.pull, NO_PULL);
    state.pull = Vec3::pick(active, pull, state.pull);
    watched
}

/// Strands whose roots rest, in still air, without goals, anchors and contacts, that no other hair pulls or pushes.
#[inline(always)]
fn undriven(
    batch: &Batch,
    state: &BatchState,
    loads: &Loads,
    drive: &Drive,
    root: &RootMotion,
) -> Mask {
    let is_driven = batch.has_goal.or(loads.driven_by_others);
    if !batch.used.and(is_driven.not()).any() {
        return Mask::NONE;
    }
    // A root at rest may be about to move.
    let gravity = Vec3::splat(drive.surroundings.gravity);
    let moves = root.turn_end.v.length_squared()
        + root.velocity.length_squared()
        + state.root_velocity.length_squared()
        + (root.pull_mid - gravity).length_squared()
        + (root.pull - gravity).length_squared();
    let mut free = moves.gt(Lane::splat(1e-24)).or(is_driven).not();
    if drive.gusts.iter().any(|gusts| gusts.blows) {
        free = free.and(batch.has_drag.not());
    }
    for &plane in &loads.touched {
        free = free.and(loads.contacts[plane].on.lt(Lane::splat(0.5)));
    }
    for own in drive.anchors {
        free.set(own.lane, false);
    }
    free
}

/// Takes the energy that a strand may not have out of its velocities.
#[inline(always)]
pub(crate) fn take_gain<T: Number>(
    batch: &Batch,
    state: &mut BatchState,
    root: &RootMotion,
    shape: &ShapeEnergy,
    watched: Mask,
) {
    let motion = kinetic::<T>(batch, state);
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
