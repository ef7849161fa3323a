//! TR-BDF2 on the manifold of inextensible shapes.
//!
//! Bank et al. 1985, in the form of Hosea and Shampine 1996 with gamma = 2 - sqrt 2: a trapezoidal stage over gamma h
//! and a stage of the second backward difference formula over the whole step. Each is an implicit step of length
//! d = gamma h / 2 from a base (yb, vb) that the past gives:
//!
//! ```text
//! y = yb + d v        v = vb + d a        a = (forces + tension along the links) / mass
//! ```
//!
//! so that y minimises an energy over all inextensible shapes (see [`super::rods::curled::sweep`]), and v and a follow from y. Both
//! stages are L-stable together. Newton starts from the links turned along the free motion yb + d vb, and
//! one iteration is almost always enough.

use crate::lanes::{Lane, Mask, Number, Vec3};

use super::{
    batch::{Batch, BatchState},
    chain::Chain,
    contact::Due,
    drive::{Drive, RootMotion},
    rods::Rods,
    scratch::{Scratch, Work},
    stage::{GAMMA, Model, Stage, Sum},
};

/// A Newton step that turns no link by more than this (radians) is the last. What it leaves is of the order of its square. In
/// steps shorter than [`FRAME`] (s) the limit falls with the square of the step, as turns do, so that what is left stays below
/// the integrator's own error.
const SMALL_TURN: f64 = 0.1;
const FRAME: f64 = 1.0 / 60.0;

/// A Newton step turns no link by more than this (radians).
const LARGEST_TURN: f64 = 1.0;

/// Newton steps in a stage before it counts as failed.
const MOST_ITERATIONS: usize = 6;

/// What came of both stages.
#[derive(Clone, Copy)]
pub(crate) struct Outcome {
    /// Newton iterations, summed over strands.
    pub iterations: usize,
    /// The lanes that did not converge.
    pub failed: Mask,
}

/// The length of both stages of a step of `dt` seconds.
#[inline(always)]
pub(crate) fn stage_length(dt: f64) -> f64 {
    0.5 * GAMMA * dt
}

/// Steps the strands of `active`: the answer is in `scratch.end`.
#[inline(always)]
pub(crate) fn step<T: Number>(
    rods: Rods,
    batch: &Batch,
    state: &BatchState,
    scratch: &mut Scratch,
    (drive, root): (&Drive, &RootMotion),
    active: Mask,
) -> Outcome {
    let small_turn = SMALL_TURN * (drive.dt / FRAME).min(1.0).powi(2);
    let stage = begin::<T>(rods, batch, state, scratch, drive, root);
    let (chain, work) = (&mut scratch.mid, &mut scratch.work);
    let mid = solve::<T>(rods, batch, &stage, chain, work, small_turn, active);
    let stage = go_on::<T>(rods, batch, state, scratch, drive, root);
    let (chain, work) = (&mut scratch.end, &mut scratch.work);
    let end = solve::<T>(rods, batch, &stage, chain, work, small_turn, active);
    Outcome {
        iterations: mid.iterations + end.iterations,
        failed: mid.failed.or(end.failed),
    }
}

/// The trapezoidal stage; backward Euler over the same time where accelerations are unknown. Sets what damping holds to, mass and
/// weight, and the shape to begin with.
#[inline(always)]
fn begin<'a, T: Number>(
    rods: Rods,
    batch: &Batch,
    state: &BatchState,
    scratch: &mut Scratch,
    drive: &Drive<'a>,
    root: &RootMotion,
) -> Stage<'a> {
    let d = stage_length(drive.dt);
    let restart = Mask::new(state.restart);
    let (turn_start, work) = (&mut scratch.turn_start, &mut scratch.work);
    if batch.damping != Lane::ZERO {
        rods.turns_of::<T>(batch, state, turn_start);
        // The trapezoidal rule for rates: twice the mean of the stage less that at its start, which the last step ended with.
        let rate = restart.pick(Lane::ZERO, Lane::splat(drive.dt / drive.last_dt));
        for k in 0..batch.count() {
            let known = Vec3::pick(restart, Vec3::ZERO, turn_start[k] - state.past[k]);
            work.past[k] = turn_start[k] + known * rate;
        }
    } else {
        // The scratch was another batch's before: what is left there may be NaN, even times 0.
        work.past[..batch.count()].fill(Vec3::ZERO);
    }
    let known = restart.pick(Lane::ZERO, Lane::splat(d));
    let length = restart.pick(Lane::splat(2.0 * d), Lane::splat(d));
    let stage = Stage {
        length,
        damping: batch.damping * length.recip(),
        base: root.mid,
        pull: root.pull_mid,
        root: root.root_mid,
        velocity: root.velocity_mid,
        gusts: &drive.gusts[0],
        is_mid: true,
    };
    let y_of: Sum = [(&state.y, Lane::ONE), (&state.v, known)];
    let v_of: Sum = [(&state.v, Lane::ONE), (&state.a, known)];
    let free = work.loads.free_motion(batch, &stage, y_of, v_of);
    let from = (&state.y[..], &state.frames[..]);
    rods.predict::<T>(batch, free, root.turn_mid, from, &mut scratch.mid);
    stage
}

/// The backward difference stage, whose base is X = alpha x1 - beta x0.
#[inline(always)]
fn go_on<'a, T: Number>(
    rods: Rods,
    batch: &Batch,
    state: &BatchState,
    scratch: &mut Scratch,
    drive: &Drive<'a>,
    root: &RootMotion,
) -> Stage<'a> {
    let d = stage_length(drive.dt);
    let alpha = 1.0 / (GAMMA * (2.0 - GAMMA));
    let beta = (1.0 - GAMMA) * (1.0 - GAMMA) * alpha;
    let (alpha, less) = (Lane::splat(alpha), Lane::splat(-beta));
    let (mid, turn_start, work) = (&scratch.mid, &scratch.turn_start, &mut scratch.work);
    if batch.damping != Lane::ZERO {
        rods.turns::<T>(batch, &root.mid, mid, &mut work.past);
        for k in 0..batch.count() {
            work.past[k] = work.past[k] * alpha + turn_start[k] * less;
        }
    }
    let stage = Stage {
        length: Lane::splat(d),
        damping: batch.damping * (1.0 / d),
        base: root.end,
        pull: root.pull,
        root: root.root,
        velocity: root.velocity_end,
        gusts: &drive.gusts[1],
        is_mid: false,
    };
    let y_of: Sum = [(&mid.y, alpha), (&state.y, less)];
    let v_of: Sum = [(&mid.v, alpha), (&state.v, less)];
    let free = work.loads.free_motion(batch, &stage, y_of, v_of);
    let onward = root.turn_end.times(root.turn_mid.conjugate());
    let from = (&mid.y[..], &mid.frames[..]);
    rods.predict::<T>(batch, free, onward, from, &mut scratch.end);
    stage
}

/// Newton's method for a stage of the strands in `active`, starting from its chain, to a last step of `small_turn` (radians).
fn solve<T: Number>(
    rods: Rods,
    batch: &Batch,
    stage: &Stage,
    chain: &mut Chain,
    work: &mut Work,
    small_turn: f64,
    active: Mask,
) -> Outcome {
    T::run(
        #[inline(always)]
        move || {
            let Work {
                loads,
                past,
                newton,
            } = work;
            loads.add::<T>(batch, stage, chain);
            let (mut iterations, mut failed) = (0, Mask::NONE);
            let mut open = active;
            for _ in 0..MOST_ITERATIONS {
                if !open.any() {
                    break;
                }
                iterations += open.count();
                let model = Model {
                    base: &stage.base,
                    nodes: &loads.nodes,
                    past,
                    elastic: stage.elastic(),
                };
                let turns = (LARGEST_TURN, open);
                let largest = rods.newton::<T>(batch, &model, chain, newton, turns);
                // Lanes whose numbers are not finite stop as well, and fail.
                let small = largest.lt(Lane::splat(small_turn));
                let broken = largest.is_finite().not();
                failed = failed.or(broken.and(open));
                let done = small.or(broken);
                let among = open.and(broken.not());
                open = open.and(done.not());
                if !loads.touched.is_empty() {
                    open = open.or(loads.rub::<T>(batch, stage, chain, among));
                    open = open.or(loads.hold::<T>(batch, stage, chain, Due::Passed, among));
                }
            }
            let rate = stage.length.recip().load::<T>();
            let count = batch.count();
            let (v, y) = (&mut chain.v[..count], &chain.y[..count]);
            let free_y = &loads.free_y[..count];
            for k in 0..count {
                v[k] = (y[k].load::<T>() - free_y[k].load()).scale(rate).store();
            }
            Outcome {
                iterations,
                failed: failed.or(open),
            }
        },
    )
}
