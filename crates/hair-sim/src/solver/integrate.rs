//! A step of a batch: TR-BDF2 on the manifold of inextensible shapes.
//!
//! Bank et al. 1985, in the form of Hosea and Shampine 1996 with gamma = 2 - sqrt 2: a trapezoidal stage over gamma h
//! and a stage of the second backward difference formula over the whole step. Each is an implicit step of length
//! d = gamma h / 2 from a base (yb, vb) that the past gives:
//!
//! ```text
//! y = yb + d v        v = vb + d a        a = (forces + tension along the links) / mass
//! ```
//!
//! so that y minimises an energy over all inextensible shapes (see [`super::sweep`]), and v and a follow from y. Both
//! stages are L-stable together. Newton starts from the links turned along the free motion yb + d vb, and
//! one iteration is almost always enough.

use glam::DVec3;

use crate::lanes::{LANES, Lane, Mask, Quat, Sym3, Vec3};

use super::{
    batch::{Batch, BatchState, Scratch, Stage},
    fallback,
    sweep::{Elastic, Node, Pose, ascend, descend, half_turn},
};

/// 2 - sqrt 2.
const GAMMA: f64 = 0.585_786_437_626_904_9;

/// A Newton step that turns no link by more than this (radians) is the last.
const SMALL_TURN: f64 = 0.03;

/// A Newton step turns no link by more than this (radians).
const LARGEST_TURN: f64 = 1.0;

/// Newton steps in a stage before it counts as failed.
const MOST_ITERATIONS: usize = 6;

/// The cosine of the most that a link may turn against the skin in a step of this integrator (2.1 rad): beyond it the
/// differences that it is made of mean nothing.
const LEAST_COSINE: f64 = -0.5;

/// The share of the end velocity's stretch that is taken out. A backward difference of points that run on an arc points
/// inside the arc; half of that is the error of the difference.
const UNSTRETCH: f64 = 0.5;

/// What drives a batch in a step.
pub(crate) struct Drive {
    pub dt: f64,
    pub gravity: DVec3,
    /// Root and frame of the skin in the world at the end of the step.
    pub root: Vec3,
    pub base: Quat,
}

/// What happened to a batch in a step.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct BatchStats {
    /// Strands that stepped; Newton iterations of all strands; strands that took the safe integrator.
    pub strands: usize,
    pub iterations: usize,
    pub fallbacks: usize,
    pub set_aside: usize,
}

/// The motion of the roots within a step, and what it does to the strands.
pub(super) struct RootMotion {
    /// The frame of the skin at the stages.
    pub mid: Quat,
    pub end: Quat,
    /// From its start.
    pub turn_mid: Quat,
    pub turn_end: Quat,
    /// Gravity less the acceleration of the root.
    pub pull: Vec3,
    pub velocity: Vec3,
}

impl RootMotion {
    fn new(state: &BatchState, drive: &Drive) -> Self {
        let velocity = (drive.root - state.root) * (1.0 / drive.dt);
        let acceleration = (velocity - state.root_velocity) * (1.0 / drive.dt);
        let turn_end = drive.base.times(state.base.conjugate());
        let sign = turn_end.w.lt(Lane::ZERO).pick(Lane::splat(-1.0), Lane::ONE);
        // Along the chord: second order in the angle, and no sine.
        let turn_mid = Quat {
            v: turn_end.v * (sign * GAMMA),
            w: turn_end.w * sign * GAMMA + (1.0 - GAMMA),
        }
        .normalize();
        Self {
            mid: turn_mid.times(state.base),
            end: drive.base,
            turn_mid,
            turn_end,
            pull: Vec3::splat(drive.gravity) - acceleration,
            velocity,
        }
    }
}

/// Advances a batch by `drive.dt`.
pub(crate) fn step(
    batch: &Batch,
    state: &mut BatchState,
    scratch: &mut Scratch,
    drive: &Drive,
) -> BatchStats {
    let root = RootMotion::new(state, drive);
    let active = batch.used.and(Mask(state.set_aside).not());
    remember_turns(batch, state, scratch);

    let h = drive.dt;
    let d = 0.5 * GAMMA * h;
    let mut failed = Mask::NONE;
    let mut iterations = 0;

    // The trapezoidal stage; backward Euler over the same time where accelerations are unknown.
    let restart = Mask(state.restart);
    let first = restart.pick(Lane::splat(2.0 * d), Lane::splat(d));
    let known = restart.pick(Lane::ZERO, Lane::splat(d));
    for k in 0..batch.count() {
        scratch.free_v[k] = state.v[k] + state.a[k] * known;
        scratch.free_y[k] = state.y[k] + state.v[k] * known;
        scratch.past[k] = scratch.turn_start[k];
    }
    let Scratch { mid, .. } = scratch;
    for k in 0..batch.count() {
        mid.frames[k] = root.turn_mid.times(state.frames[k]);
    }
    let stage = StageSetup {
        length: first,
        damping: batch.damping * (1.0 / (2.0 * d)),
        base: root.mid,
        pull: root.pull,
    };
    iterations += solve(batch, scratch, &stage, active, &mut failed, Which::Mid);

    // The backward difference stage: X = alpha x1 - beta x0.
    let alpha = 1.0 / (GAMMA * (2.0 - GAMMA));
    let beta = (1.0 - GAMMA) * (1.0 - GAMMA) * alpha;
    for k in 0..batch.count() {
        let mid = &scratch.mid;
        scratch.free_v[k] = mid.v[k] * alpha - state.v[k] * beta;
        scratch.free_y[k] = mid.y[k] * alpha - state.y[k] * beta;
    }
    if batch.damping != Lane::ZERO {
        let mut before = root.mid;
        for k in 0..batch.count() {
            let after = scratch.mid.frames[k];
            scratch.past[k] =
                half_turn(before, after) * (2.0 * alpha) - scratch.turn_start[k] * beta;
            before = after;
        }
    }
    let onward = root.turn_end.times(root.turn_mid.conjugate());
    for k in 0..batch.count() {
        scratch.end.frames[k] = onward.times(scratch.mid.frames[k]);
    }
    let stage = StageSetup {
        length: Lane::splat(d),
        damping: batch.damping * (1.0 / d),
        base: root.end,
        pull: root.pull,
    };
    iterations += solve(batch, scratch, &stage, active, &mut failed, Which::End);

    failed = failed
        .or(turned_too_far(batch, state, scratch, &root))
        .and(active);
    finish(batch, state, scratch, active.and(failed.not()), d);
    let mut stats = BatchStats {
        strands: active.count(),
        iterations,
        fallbacks: failed.count(),
        set_aside: 0,
    };
    if failed.any() {
        stats.set_aside = fallback::step(batch, state, scratch, drive, &root, failed);
    }
    state.root = drive.root;
    state.root_velocity = root.velocity;
    state.base = drive.base;
    stats
}

fn remember_turns(batch: &Batch, state: &BatchState, scratch: &mut Scratch) {
    if batch.damping == Lane::ZERO {
        return;
    }
    let mut before = state.base;
    for k in 0..batch.count() {
        let c = half_turn(before, state.frames[k]);
        scratch.turn_start[k] = c + c;
        before = state.frames[k];
    }
}

/// Which stage's shape [`solve`] works on.
#[derive(Clone, Copy, PartialEq)]
enum Which {
    Mid,
    End,
}

/// What a stage is made of.
pub(super) struct StageSetup {
    /// d, in s.
    pub length: Lane,
    /// Time of damping over the stage's own.
    pub damping: Lane,
    pub base: Quat,
    pub pull: Vec3,
}

/// Mass and forces on every particle for a stage from `free_y`, `free_v`.
pub(super) fn assemble(batch: &Batch, scratch: &mut Scratch, stage: &StageSetup, frames: Which2) {
    let d = stage.length;
    let d2 = d * d;
    for k in 0..batch.count() {
        let mass = batch.particles[k].mass;
        let target = scratch.free_y[k] + scratch.free_v[k] * d + stage.pull * d2;
        scratch.nodes[k] = Node {
            n: Sym3::diagonal(mass),
            b: target * mass,
        };
    }
    if batch.has_drag {
        let frames = match frames {
            Which2::Mid => &scratch.mid.frames,
            Which2::End => &scratch.end.frames,
            Which2::Trial => &scratch.trial.frames,
        };
        let less = batch.drag_along - Lane::ONE;
        for k in 0..batch.count() {
            let particle = &batch.particles[k];
            let rate = particle.mass * particle.drag * d;
            let n = Sym3::diagonal(rate) + Sym3::outer(frames[k].tangent(), rate * less);
            let node = &mut scratch.nodes[k];
            node.n += n;
            node.b += n.apply(scratch.free_y[k] + scratch.wind[k] * d);
        }
    }
}

/// As [`Which`], and the fallback's own.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Which2 {
    Mid,
    End,
    Trial,
}

/// Newton's method for a stage, starting from frames that were carried along with the skin. Returns the number
/// of iterations, summed over strands; lanes that did not converge are added to `failed`.
fn solve(
    batch: &Batch,
    scratch: &mut Scratch,
    setup: &StageSetup,
    active: Mask,
    failed: &mut Mask,
    which: Which,
) -> usize {
    predict(batch, scratch, setup, which);
    let frames = if which == Which::Mid {
        Which2::Mid
    } else {
        Which2::End
    };
    assemble(batch, scratch, setup, frames);
    let elastic = Elastic {
        h2: setup.length * setup.length,
        damping: setup.damping,
    };
    let Scratch {
        nodes,
        eliminations,
        turns,
        past,
        mid,
        end,
        free_y,
        ..
    } = scratch;
    let shape = if which == Which::Mid { mid } else { end };
    let mut open = active;
    let mut iterations = 0;
    for _ in 0..MOST_ITERATIONS {
        if !open.any() {
            break;
        }
        iterations += open.count();
        let pose = Pose {
            base: setup.base,
            y: &shape.y,
            frames: &shape.frames,
        };
        ascend(&batch.links, pose, nodes, past, &elastic, eliminations);
        let largest = descend(&batch.links, &shape.frames, eliminations, turns).sqrt();
        let scale = (Lane::splat(LARGEST_TURN) / largest).min(Lane::ONE);
        turn_links(batch, shape, turns, scale, open);
        // Lanes whose numbers are broken stop as well, and fail.
        let small = largest.lt(Lane::splat(SMALL_TURN));
        let broken = largest.is_finite().not();
        *failed = failed.or(broken.and(open));
        open = open.and(small.or(broken).not());
    }
    *failed = failed.or(open);
    let rate = setup.length.recip();
    for k in 0..batch.count() {
        shape.v[k] = (shape.y[k] - free_y[k]) * rate;
    }
    iterations
}

/// Turns every link along the free motion and sets the particles.
fn predict(batch: &Batch, scratch: &mut Scratch, setup: &StageSetup, which: Which) {
    let Scratch {
        mid,
        end,
        free_y,
        free_v,
        ..
    } = scratch;
    let shape = if which == Which::Mid { mid } else { end };
    let mut before = Vec3::ZERO;
    let mut y = Vec3::ZERO;
    for k in 0..batch.count() {
        let length = batch.links[k].length;
        let free = free_y[k] + free_v[k] * setup.length;
        let chord = free - before;
        before = free;
        let squared = chord.length_squared();
        let frame = shape.frames[k];
        let clear = squared.gt(length * length * 0.01);
        let to = chord * squared.sqrt().recip();
        let frame = Quat::pick(clear, frame.pointed(to), frame);
        shape.frames[k] = frame;
        y += frame.tangent() * length;
        shape.y[k] = y;
    }
}

/// Turns the links of the lanes in `which` by `scale` times `turns`, and moves the particles along.
pub(super) fn turn_links(
    batch: &Batch,
    shape: &mut Stage,
    turns: &[Vec3],
    scale: Lane,
    which: Mask,
) {
    let mut y = Vec3::ZERO;
    for k in 0..batch.count() {
        let frame = shape.frames[k];
        let frame = Quat::pick(which, frame.turned(turns[k] * scale), frame);
        shape.frames[k] = frame;
        y += frame.tangent() * batch.links[k].length;
        shape.y[k] = y;
    }
}

fn turned_too_far(batch: &Batch, state: &BatchState, scratch: &Scratch, root: &RootMotion) -> Mask {
    let mut least = Lane::ONE;
    for k in 0..batch.count() {
        let carried = root.turn_end.times(state.frames[k]).tangent();
        let still = state.frames[k].tangent();
        let now = scratch.end.frames[k].tangent();
        // Turned with the skin, or left where it was: either is an ordinary motion.
        least = least.min(carried.dot(now).max(still.dot(now)));
    }
    least.gt(Lane::splat(LEAST_COSINE)).not()
}

/// Takes the end stage of the lanes in `which` as the new state.
fn finish(batch: &Batch, state: &mut BatchState, scratch: &Scratch, which: Mask, d: f64) {
    let end = &scratch.end;
    let rate = 1.0 / d;
    let mut before = Vec3::ZERO;
    let mut velocity = Vec3::ZERO;
    for k in 0..batch.count() {
        let a = (end.v[k] - scratch.free_v[k]) * rate;
        let t = end.frames[k].tangent();
        let along = end.v[k] - before;
        before = end.v[k];
        velocity += along - t * (along.dot(t) * UNSTRETCH);
        state.a[k] = Vec3::pick(which, a, state.a[k]);
        state.v[k] = Vec3::pick(which, velocity, state.v[k]);
        state.y[k] = Vec3::pick(which, end.y[k], state.y[k]);
        state.frames[k] = Quat::pick(which, end.frames[k], state.frames[k]);
    }
    for lane in 0..LANES {
        state.restart[lane] &= !which.0[lane];
    }
}
