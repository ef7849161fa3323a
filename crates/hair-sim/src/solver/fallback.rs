//! The safe integrator: backward Euler as an energy that only goes down.
//!
//! Where TR-BDF2 does not converge, or turns a link so far that its differences mean nothing, the step is taken again
//! from the shape that the skin carries along, by damped Newton on the incremental potential of backward Euler
//! (Kane et al. 2000; Martin et al. 2011). Every accepted step lowers it, so the shape is always finite and
//! the motion loses energy.

use crate::{
    collision::contact::Contact,
    lanes::{LANES, Lane, Mask, Number, Quat, Vec3},
};

use super::{
    batch::{Batch, BatchState, Reason, Scratch},
    drive::{Drive, RootMotion},
    free_motion::{FreeMotion, Sum},
    integrate::{StageSetup, Which, assemble, hold, turn_links},
    straight,
    sweep::{Elastic, ascend, descend, joints, potential},
};

const MOST_ITERATIONS: usize = 40;
const MOST_HALVINGS: usize = 10;
const SMALL_TURN: f64 = 1e-3;
const LARGEST_TURN: f64 = 0.7;

/// Steps the lanes in `which`. Those that have no finite answer here either are set aside.
#[inline(always)]
pub(super) fn step<T: Number>(
    batch: &Batch,
    state: &mut BatchState,
    scratch: &mut Scratch,
    drive: &Drive,
    root: &RootMotion,
    which: Mask,
) {
    let h = Lane::splat(drive.dt);
    let damps = batch.damping != Lane::ZERO;
    if batch.is_straight {
        let frames = &mut scratch.trial.frames;
        straight::frames::<Lane>(&state.base, &batch.links, &state.y, frames);
    } else {
        scratch.trial.frames[..batch.count()].copy_from_slice(&state.frames);
    }
    let mut y = Vec3::ZERO;
    for k in 0..batch.count() {
        // The room was another batch's before: what is left there may be no number, even times 0.
        scratch.past[k] = if damps {
            scratch.turn_start[k]
        } else {
            Vec3::ZERO
        };
        let frame = root.turn_end.times(scratch.trial.frames[k]).normalize();
        let tangent = frame.tangent();
        y += tangent * batch.links[k].length;
        scratch.trial.frames[k] = frame;
        scratch.trial.tangents[k] = tangent;
        scratch.trial.y[k] = y;
    }
    let setup = StageSetup {
        length: h,
        damping: batch.damping * (1.0 / drive.dt),
        base: root.end,
        pull: root.pull,
        root: root.root,
        velocity: root.velocity_end,
        gusts: &drive.gusts[1],
    };
    let y_of: Sum = [(&state.y, Lane::ONE), (&state.v, Lane::ZERO)];
    let v_of: Sum = [(&state.v, Lane::ONE), (&state.a, Lane::ZERO)];
    let free = (&mut scratch.free_y[..], &mut scratch.free_v[..]);
    let mut free = FreeMotion::new(batch, &setup, (y_of, v_of), free, &mut scratch.nodes);
    for k in 0..batch.count() {
        free.place::<Lane>(k);
    }
    assemble::<T>(batch, scratch, &setup, Which::Trial);
    let elastic = Elastic {
        h2: h * h,
        damping: setup.damping,
    };
    minimise::<T>(batch, scratch, &setup.base, &elastic, which);
    if !scratch.touched.is_empty() {
        // Planes that the strand met on the way.
        let passed = |contact: &Contact, y, level| contact.passed(y, level).and(which);
        let met = hold(batch, scratch, h, Which::Trial, passed);
        minimise::<T>(batch, scratch, &setup.base, &elastic, met);
    }
    take(batch, state, scratch, which, drive.dt);
}

/// Damped Newton on `scratch.trial`.
#[inline(always)]
fn minimise<T: Number>(
    batch: &Batch,
    scratch: &mut Scratch,
    base: &Quat,
    elastic: &Elastic,
    which: Mask,
) {
    let Scratch {
        nodes,
        joints: ready,
        eliminations,
        turns,
        past,
        trial,
        end,
        ..
    } = scratch;
    let links = &batch.links;
    let mut open = which;
    let mut energy = potential(links, trial.pose(base), nodes, past, elastic);
    for _ in 0..MOST_ITERATIONS {
        if !open.any() {
            return;
        }
        let pose = trial.pose(base);
        let sharpest = joints::<T>(links, pose, past, elastic, ready);
        ascend::<T>(links, pose, nodes, ready, eliminations);
        let largest = descend::<T>(links, &trial.tangents, eliminations, turns);
        let mut scale = (Lane::splat(LARGEST_TURN) / largest).min(Lane::ONE);
        let mut untried = open.and(largest.is_finite());
        let mut moved = Mask::NONE;
        for _ in 0..MOST_HALVINGS {
            if !untried.any() {
                break;
            }
            for k in 0..batch.count() {
                end.frames[k] = trial.frames[k];
                end.y[k] = trial.y[k];
            }
            turn_links::<T>(batch, end, turns, scale, untried);
            let tried = potential(links, end.pose(base), nodes, past, elastic);
            let better = untried.and(energy.lt(tried).not()).and(tried.is_finite());
            for k in 0..batch.count() {
                trial.frames[k] = Quat::pick(better, end.frames[k], trial.frames[k]);
                trial.y[k] = Vec3::pick(better, end.y[k], trial.y[k]);
                trial.tangents[k] = Vec3::pick(better, end.tangents[k], trial.tangents[k]);
            }
            energy = better.pick(tried, energy);
            moved = moved.or(better);
            untried = untried.and(better.not());
            scale = scale * 0.5;
        }
        let small = (largest * sharpest.sqrt()).lt(Lane::splat(SMALL_TURN));
        open = open.and(moved).and(small.not());
    }
}

fn take(batch: &Batch, state: &mut BatchState, scratch: &Scratch, which: Mask, dt: f64) {
    let trial = &scratch.trial;
    let mut sum = Lane::ZERO;
    for k in 0..batch.count() {
        sum += trial.y[k].length_squared() + trial.frames[k].v.length_squared();
        sum += state.v[k].length_squared();
    }
    let good = which.and(sum.is_finite());
    let rate = 1.0 / dt;
    for k in 0..batch.count() {
        let v = (trial.y[k] - state.y[k]) * rate;
        let a = (v - state.v[k]) * rate;
        let press = if scratch.touched.is_empty() {
            Lane::ZERO
        } else {
            scratch.contacts[k].pressure(trial.y[k])
        };
        state.press[k] = good.pick(press, state.press[k]);
        state.a[k] = Vec3::pick(good, a, state.a[k]);
        state.v[k] = Vec3::pick(good, v, state.v[k]);
        state.y[k] = Vec3::pick(good, trial.y[k], state.y[k]);
        if !batch.is_straight {
            state.frames[k] = Quat::pick(good, trial.frames[k], state.frames[k]);
        }
    }
    let bad = which.and(good.not());
    for lane in 0..LANES {
        if which.get(lane) {
            state.restart[lane] = true;
        }
        if bad.get(lane) {
            state.set_aside[lane] = Some(Reason::Motion);
        }
    }
}

/// Carries the lanes in `which` along with the skin, at rest against it.
pub(crate) fn carry(batch: &Batch, state: &mut BatchState, turn: Quat, which: Mask) {
    let mut y = Vec3::ZERO;
    for k in 0..batch.count() {
        if batch.is_straight {
            y = turn.rotate(state.y[k]);
        } else {
            let carried = turn.times(state.frames[k]).normalize();
            y += carried.tangent() * batch.links[k].length;
            state.frames[k] = Quat::pick(which, carried, state.frames[k]);
        }
        state.y[k] = Vec3::pick(which, y, state.y[k]);
        state.v[k] = Vec3::pick(which, Vec3::ZERO, state.v[k]);
        state.a[k] = Vec3::pick(which, Vec3::ZERO, state.a[k]);
    }
}
