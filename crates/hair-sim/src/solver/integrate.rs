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

use crate::{
    forces::mutual::Counts,
    lanes::{Lane, Mask, Quat, Sym3, Vec3},
};

use super::{
    batch::{Batch, BatchState, Scratch, Stage},
    drive::{Drive, RootMotion, prepare},
    fallback,
    finish::{asleep, count_quiet, finish, take_gain, turned_too_far},
    sweep::{Elastic, Node, Pose, ascend, descend, half_turn},
};

/// 2 - sqrt 2.
pub(super) const GAMMA: f64 = 0.585_786_437_626_904_9;

/// A Newton step that turns no link by more than this (radians) is the last.
const SMALL_TURN: f64 = 0.05;

/// A Newton step turns no link by more than this (radians).
const LARGEST_TURN: f64 = 1.0;

/// Newton steps in a stage before it counts as failed.
const MOST_ITERATIONS: usize = 6;

/// What happened to a batch in a step.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct BatchStats {
    /// Strands that stepped; Newton iterations of all strands; strands that took the safe integrator.
    pub strands: usize,
    pub iterations: usize,
    pub fallbacks: usize,
    pub set_aside: usize,
    /// Particles.
    pub contacts: usize,
    pub wind: usize,
    pub hair: Counts,
    /// Strands that rest.
    pub asleep: usize,
}

/// Advances a batch by `drive.dt`.
#[inline(always)]
pub(crate) fn step(
    batch: &Batch,
    state: &mut BatchState,
    scratch: &mut Scratch,
    drive: &Drive,
) -> BatchStats {
    let root = RootMotion::new(state, drive);
    let mut stats = BatchStats::default();
    let asleep = asleep(state, drive, batch.used);
    stats.asleep = asleep.count();
    if asleep == batch.used && !state.aside().and(batch.used).any() {
        // Strands of a root alone have nothing that could sleep.
        state.root = Vec3::pick(batch.used, state.root, root.root);
        state.root_velocity = Vec3::pick(batch.used, state.root_velocity, root.velocity);
        return stats;
    }
    let active = prepare(
        batch,
        state,
        scratch,
        drive,
        &root,
        asleep.not(),
        &mut stats,
    );
    remember_turns(batch, state, scratch);

    let h = drive.dt;
    let d = 0.5 * GAMMA * h;
    let mut failed = Mask::NONE;
    let mut iterations = 0;

    // The trapezoidal stage; backward Euler over the same time where accelerations are unknown.
    let restart = Mask::new(state.restart);
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
    let before = if batch.conserves.any() {
        state.energy(batch, root.pull)
    } else {
        Lane::ZERO
    };
    finish(batch, state, scratch, active.and(failed.not()), d);
    stats.strands = active.count();
    stats.iterations = iterations;
    stats.fallbacks = failed.count();
    if failed.any() {
        fallback::step(batch, state, scratch, drive, &root, failed);
    }
    if batch.conserves.any() {
        take_gain(batch, state, &root, before, active.and(batch.conserves));
    }
    let aside = state.aside().and(batch.used);
    if aside.any() {
        stats.set_aside = aside.count();
        fallback::carry(batch, state, root.turn_end, aside);
    }
    count_quiet(batch, state, drive, active);
    state.root = root.root;
    state.root_velocity = root.velocity;
    state.base = root.end;
    stats
}

#[inline(always)]
fn remember_turns(batch: &Batch, state: &BatchState, scratch: &mut Scratch) {
    if batch.damping == Lane::ZERO {
        scratch.turn_start[..batch.count()].fill(Vec3::ZERO);
        return;
    }
    let mut before = state.base;
    for k in 0..batch.count() {
        let c = half_turn(before, state.frames[k]);
        scratch.turn_start[k] = c + c;
        before = state.frames[k];
    }
}

/// Whose shape a stage works on.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Which {
    Mid,
    End,
    /// The fallback's, at the end of the step.
    Trial,
}

impl Scratch {
    #[inline(always)]
    fn shape(&self, which: Which) -> &Stage {
        match which {
            Which::Mid => &self.mid,
            Which::End => &self.end,
            Which::Trial => &self.trial,
        }
    }
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
#[inline(always)]
pub(super) fn assemble(batch: &Batch, scratch: &mut Scratch, stage: &StageSetup, which: Which) {
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
        let less = batch.drag_along - Lane::ONE;
        for k in 0..batch.count() {
            let particle = &batch.particles[k];
            let rate = particle.mass * particle.drag * d;
            let t = scratch.shape(which).frames[k].tangent();
            let n = Sym3::diagonal(rate) + Sym3::outer(t, rate * less);
            let node = &mut scratch.nodes[k];
            node.n += n;
            node.b += n.apply(scratch.free_y[k] + scratch.wind[k] * d);
        }
    }
    if scratch.has_springs {
        for k in 0..batch.count() {
            let mass = batch.particles[k].mass;
            let spring = &scratch.springs[k];
            let to = if which == Which::Mid {
                spring.mid
            } else {
                spring.end
            };
            let node = &mut scratch.nodes[k];
            node.n += Sym3::diagonal((spring.stiffness * d2 + spring.rate * d) * mass);
            let carried = scratch.free_y[k] * spring.rate + spring.flow * d;
            node.b += (to * d2 + carried * d) * mass;
        }
    }
    if scratch.has_contacts {
        for contact in &mut scratch.contacts[..batch.count()] {
            contact.holds = Lane::ZERO;
        }
        hold(batch, scratch, stage.length, which, Mask::ALL);
    }
}

/// Lets the planes hold particles that are behind them, in the strands of `among`. Returns the strands where any is new.
#[inline(always)]
pub(super) fn hold(
    batch: &Batch,
    scratch: &mut Scratch,
    d: Lane,
    which: Which,
    among: Mask,
) -> Mask {
    let mut new = Mask::NONE;
    for k in 0..batch.count() {
        let contact = scratch.contacts[k];
        let level = if which == Which::Mid {
            contact.mid
        } else {
            contact.end
        };
        let below = contact.newly_below(scratch.shape(which).y[k], level, among);
        if below.any() {
            let mass = batch.particles[k].mass;
            let free = scratch.free_y[k];
            scratch.contacts[k].hold(&mut scratch.nodes[k], below, mass, level, d, free);
            new = new.or(below);
        }
    }
    new
}

/// Newton's method for a stage, starting from frames that were carried along with the skin. Returns the number
/// of iterations, summed over strands; lanes that did not converge are added to `failed`.
#[inline(always)]
fn solve(
    batch: &Batch,
    scratch: &mut Scratch,
    setup: &StageSetup,
    active: Mask,
    failed: &mut Mask,
    which: Which,
) -> usize {
    predict(batch, scratch, setup, which);
    assemble(batch, scratch, setup, which);
    let elastic = Elastic {
        h2: setup.length * setup.length,
        damping: setup.damping,
    };
    let mut open = active;
    let mut iterations = 0;
    for _ in 0..MOST_ITERATIONS {
        if !open.any() {
            break;
        }
        iterations += open.count();
        let Scratch {
            nodes,
            eliminations,
            turns,
            past,
            mid,
            end,
            ..
        } = &mut *scratch;
        let shape = if which == Which::Mid { mid } else { end };
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
        let done = small.or(broken);
        let met = if scratch.has_contacts {
            hold(batch, scratch, setup.length, which, open.and(broken.not()))
        } else {
            Mask::NONE
        };
        open = open.and(done.not()).or(met);
    }
    *failed = failed.or(open);
    let rate = setup.length.recip();
    let Scratch {
        mid, end, free_y, ..
    } = scratch;
    let shape = if which == Which::Mid { mid } else { end };
    for k in 0..batch.count() {
        shape.v[k] = (shape.y[k] - free_y[k]) * rate;
    }
    iterations
}

/// Turns every link along the free motion and sets the particles.
#[inline(always)]
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
    let mut turn = Quat::IDENTITY;
    for k in 0..batch.count() {
        let length = batch.links[k].length;
        let free = free_y[k] + free_v[k] * setup.length;
        let chord = free - before;
        before = free;
        let squared = chord.length_squared();
        let frame = shape.frames[k];
        let clear = squared.gt(length * length * 0.01);
        let to = chord * squared.sqrt().recip();
        // A link that has no direction of its own goes with the one before it.
        let next = Quat::pick(clear, frame.pointed(to), turn.times(frame));
        turn = next.times(frame.conjugate());
        shape.frames[k] = next;
        y += next.tangent() * length;
        shape.y[k] = y;
    }
}

/// Turns the links of the lanes in `which` by `scale` times `turns`, and moves the particles along.
#[inline(always)]
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
