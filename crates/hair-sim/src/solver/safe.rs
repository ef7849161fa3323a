//! The safe integrator: backward Euler as an energy that only goes down.
//!
//! Where TR-BDF2 does not converge, or turns a link so far that its differences mean nothing, the step is taken again
//! from the shape that the skin carries along, by damped Newton on the incremental potential of backward Euler
//! (Kane et al. 2000; Martin et al. 2011). Every accepted step lowers it, so the shape is always finite and
//! the motion loses energy.

use crate::{
    error::Reason,
    lanes::{LANES, Lane, Mask, Number, Quat, Vec3},
};

use super::{
    batch::{Batch, BatchState},
    chain::Chain,
    contact::Due,
    drive::{Drive, RootMotion},
    finish::forget_planes,
    rods::{
        Rods,
        curled::{find_turns, sweep::potential, turn_links},
    },
    scratch::{Scratch, Work},
    stage::{Model, Stage, Sum},
};

const MOST_ITERATIONS: usize = 40;
const MOST_HALVINGS: usize = 10;
const SMALL_TURN: f64 = 1e-3;
const LARGEST_TURN: f64 = 0.7;

/// Steps the lanes in `which`. Those that have no finite answer here either are set aside.
pub(crate) fn step<T: Number>(
    rods: Rods,
    batch: &Batch,
    state: &mut BatchState,
    scratch: &mut Scratch,
    (drive, root): (&Drive, &RootMotion),
    which: Mask,
) {
    let h = Lane::splat(drive.dt);
    let damps = batch.damping != Lane::ZERO;
    let Scratch {
        trial,
        end,
        turn_start,
        work,
        ..
    } = scratch;
    let held = (&state.base, &state.y[..], &state.frames[..]);
    let frames = rods.frames::<T>(batch, held, &mut end.frames);
    let mut y = Vec3::ZERO;
    for k in 0..batch.count() {
        // The scratch was another batch's before: what is left there may be NaN, even times 0.
        work.past[k] = if damps { turn_start[k] } else { Vec3::ZERO };
        let frame = root.turn_end.times(frames[k]).normalize();
        let tangent = frame.tangent();
        y += tangent * batch.links[k].length;
        trial.frames[k] = frame;
        trial.tangents[k] = tangent;
        trial.y[k] = y;
    }
    let stage = Stage {
        length: h,
        damping: batch.damping * (1.0 / drive.dt),
        base: root.end,
        pull: root.pull,
        root: root.root,
        velocity: root.velocity_end,
        gusts: &drive.gusts[1],
        is_mid: false,
    };
    let y_of: Sum = [(&state.y, Lane::ONE), (&state.v, Lane::ZERO)];
    let v_of: Sum = [(&state.v, Lane::ONE), (&state.a, Lane::ZERO)];
    let mut free = work.loads.free_motion(batch, &stage, y_of, v_of);
    for k in 0..batch.count() {
        free.place::<Lane>(k);
    }
    work.loads.add::<T>(batch, &stage, trial);
    minimise::<T>(batch, &stage, trial, end, work, which);
    if !work.loads.touched.is_empty() {
        // Planes that the strand met on the way.
        let met = work
            .loads
            .hold::<T>(batch, &stage, trial, Due::Passed, which);
        minimise::<T>(batch, &stage, trial, end, work, met);
    }
    take(rods, batch, state, scratch, which, drive.dt);
}

/// Damped Newton on `chain`; `trial` is what is tried.
fn minimise<T: Number>(
    batch: &Batch,
    stage: &Stage,
    chain: &mut Chain,
    trial: &mut Chain,
    work: &mut Work,
    which: Mask,
) {
    let (links, scratch) = (&batch.links, &mut work.newton.curled);
    let model = Model {
        base: &stage.base,
        nodes: &work.loads.nodes,
        past: &work.past,
        elastic: stage.elastic(),
    };
    let mut open = which;
    let mut energy = potential(links, &model, chain);
    for _ in 0..MOST_ITERATIONS {
        if !open.any() {
            return;
        }
        let (largest, sharpest) = find_turns::<T>(links, &model, chain, scratch);
        let mut scale = (Lane::splat(LARGEST_TURN) / largest).min(Lane::ONE);
        let mut untried = open.and(largest.is_finite());
        let mut moved = Mask::NONE;
        for _ in 0..MOST_HALVINGS {
            if !untried.any() {
                break;
            }
            for k in 0..batch.count() {
                trial.frames[k] = chain.frames[k];
                trial.y[k] = chain.y[k];
            }
            turn_links::<T>(links, trial, &scratch.turns, scale, untried);
            let tried = potential(links, &model, trial);
            let better = untried.and(energy.lt(tried).not()).and(tried.is_finite());
            for k in 0..batch.count() {
                chain.frames[k] = Quat::pick(better, trial.frames[k], chain.frames[k]);
                chain.y[k] = Vec3::pick(better, trial.y[k], chain.y[k]);
                chain.tangents[k] = Vec3::pick(better, trial.tangents[k], chain.tangents[k]);
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

fn take(
    rods: Rods,
    batch: &Batch,
    state: &mut BatchState,
    scratch: &Scratch,
    which: Mask,
    dt: f64,
) {
    let (trial, loads) = (&scratch.trial, &scratch.work.loads);
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
        state.a[k] = Vec3::pick(good, a, state.a[k]);
        state.v[k] = Vec3::pick(good, v, state.v[k]);
        state.y[k] = Vec3::pick(good, trial.y[k], state.y[k]);
    }
    forget_planes(state, good);
    for &plane in &loads.touched {
        let press = loads.contacts[plane].pressure(trial.y[batch.held_by(plane)]);
        state.press[plane] = good.pick(press, state.press[plane]);
    }
    rods.keep_frames(state, trial, good);
    let bad = which.and(good.not());
    for lane in 0..LANES {
        if which.get(lane) {
            state.restart[lane] = true;
        }
        if bad.get(lane) {
            state.set_aside[lane] = Some(Reason::PointCache);
        }
    }
}
