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
    collision::contact::Contact,
    forces::{mutual::Counts, wind::Gusts},
    lanes::{Lane, Mask, Number, Quat, Sym3, Vec3},
};

use super::{
    batch::{Batch, BatchState, Scratch, Stage},
    drive::{Drive, RootMotion, prepare},
    energy::{ShapeEnergy, of_end, of_state, take_gain, watch},
    fallback,
    finish::{asleep, count_quiet, finish, turned_too_far},
    free_motion::{FreeMotion, Sum},
    straight,
    sweep::{Elastic, Node, ascend, descend, half_turn, joints},
};

/// 2 - sqrt 2.
pub(super) const GAMMA: f64 = 0.585_786_437_626_904_9;

/// A Newton step that turns no link by more than this (radians) is the last. What it leaves is of the order of its square. In
/// steps shorter than [`FRAME`] (s) the limit falls with the square of the step, as turns do, so that what is left stays below
/// the integrator's own error.
const SMALL_TURN: f64 = 0.1;
const FRAME: f64 = 1.0 / 60.0;

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
pub(crate) fn advance<T: Number>(
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
    let awake = asleep.not();
    let active = prepare::<T>(batch, state, scratch, drive, &root, awake, &mut stats);

    let d = 0.5 * GAMMA * drive.dt;
    let small_turn = SMALL_TURN * (drive.dt / FRAME).min(1.0).powi(2);
    let mut failed = Mask::NONE;
    stats.strands = active.count();
    for which in [Which::Mid, Which::End] {
        let setup = begin::<T>(batch, state, scratch, drive, &root, which);
        assemble::<T>(batch, scratch, &setup, which);
        stats.iterations += solve::<T>(
            batch,
            scratch,
            &setup,
            small_turn,
            &mut failed,
            (which, active),
        );
    }
    let too_far = turned_too_far::<T>(batch, state, scratch, &root);
    failed = failed.or(too_far).and(active);
    let watched = watch::<T>(batch, state, scratch, drive, &root, active);
    let mut shape = ShapeEnergy::NONE;
    if watched.any() {
        shape = of_end::<T>(batch, scratch, &root);
        failed = failed.or(shape.is_out_of_reach(batch, state, &root, watched));
    }
    stats.fallbacks = failed.count();
    finish::<T>(batch, state, scratch, active.and(failed.not()), d);
    if failed.any() {
        fallback::step::<T>(batch, state, scratch, drive, &root, failed);
    }
    if watched.any() {
        if failed.any() {
            let other = of_state::<T>(batch, state, &root);
            shape = ShapeEnergy::pick(failed, other, shape);
        }
        take_gain::<T>(batch, state, &root, &shape, watched);
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
pub(super) struct StageSetup<'a> {
    /// d, in s.
    pub length: Lane,
    /// Time of damping over the stage's own.
    pub damping: Lane,
    pub base: Quat,
    pub pull: Vec3,
    /// The root, its velocity, and the air.
    pub root: Vec3,
    pub velocity: Vec3,
    pub gusts: &'a Gusts,
}

/// The base of a stage, `free_y` and `free_v`, what damping holds to, mass and weight, and the shape to begin with.
#[inline(always)]
fn begin<'a, T: Number>(
    batch: &Batch,
    state: &BatchState,
    scratch: &mut Scratch,
    drive: &Drive<'a>,
    root: &RootMotion,
    which: Which,
) -> StageSetup<'a> {
    let d = 0.5 * GAMMA * drive.dt;
    let restart = Mask::new(state.restart);
    let Scratch {
        nodes,
        mid,
        end,
        free_y,
        free_v,
        turn_start,
        past,
        ..
    } = scratch;
    let damps = batch.damping != Lane::ZERO;
    if which == Which::Mid {
        if damps {
            if batch.is_straight {
                straight::turns_of::<T>(&state.base, &batch.links, &state.y, turn_start);
            } else {
                turns::<T>(&state.base, &state.frames, turn_start);
            }
            // The trapezoidal rule for rates: twice the mean of the stage less that at its start, which the last step ended with.
            let rate = restart.pick(Lane::ZERO, Lane::splat(drive.dt / drive.last_dt));
            for k in 0..batch.count() {
                let known = Vec3::pick(restart, Vec3::ZERO, turn_start[k] - state.past[k]);
                past[k] = turn_start[k] + known * rate;
            }
        } else if !batch.is_straight {
            // The room was another batch's before: what is left there may be no number, even times 0.
            past.fill(Vec3::ZERO);
        }
        // The trapezoidal stage; backward Euler over the same time where accelerations are unknown.
        let known = restart.pick(Lane::ZERO, Lane::splat(d));
        let length = restart.pick(Lane::splat(2.0 * d), Lane::splat(d));
        let setup = StageSetup {
            length,
            damping: batch.damping * length.recip(),
            base: root.mid,
            pull: root.pull_mid,
            root: root.root_mid,
            velocity: root.velocity_mid,
            gusts: &drive.gusts[0],
        };
        let y_of: Sum = [(&state.y, Lane::ONE), (&state.v, known)];
        let v_of: Sum = [(&state.v, Lane::ONE), (&state.a, known)];
        let free = FreeMotion::new(batch, &setup, (y_of, v_of), (free_y, free_v), nodes);
        if batch.is_straight {
            straight::predict::<T>(&batch.links, free, root.turn_mid, &state.y, mid);
        } else {
            predict::<T>(batch, free, root.turn_mid, &state.frames, mid);
        }
        return setup;
    }
    // The backward difference stage: X = alpha x1 - beta x0.
    let alpha = 1.0 / (GAMMA * (2.0 - GAMMA));
    let beta = (1.0 - GAMMA) * (1.0 - GAMMA) * alpha;
    let (alpha, less) = (Lane::splat(alpha), Lane::splat(-beta));
    if damps {
        if batch.is_straight {
            straight::turns::<T>(
                &root.mid,
                &batch.links,
                #[inline(always)]
                |k| mid.tangents[k].load(),
                past,
            );
        } else {
            turns::<T>(&root.mid, &mid.frames[..batch.count()], past);
        }
        for k in 0..batch.count() {
            past[k] = past[k] * alpha + turn_start[k] * less;
        }
    }
    let setup = StageSetup {
        length: Lane::splat(d),
        damping: batch.damping * (1.0 / d),
        base: root.end,
        pull: root.pull,
        root: root.root,
        velocity: root.velocity_end,
        gusts: &drive.gusts[1],
    };
    let y_of: Sum = [(&mid.y, alpha), (&state.y, less)];
    let v_of: Sum = [(&mid.v, alpha), (&state.v, less)];
    let free = FreeMotion::new(batch, &setup, (y_of, v_of), (free_y, free_v), nodes);
    let onward = root.turn_end.times(root.turn_mid.conjugate());
    if batch.is_straight {
        straight::predict::<T>(&batch.links, free, onward, &mid.y, end);
    } else {
        predict::<T>(batch, free, onward, &mid.frames, end);
    }
    setup
}

/// The turn of every joint, 2 tan(angle / 2) times its axis, in the frame of its link.
#[inline(always)]
fn turns<T: Number>(base: &Quat, frames: &[Quat], out: &mut [Vec3]) {
    for k in 0..frames.len() {
        let before = if k == 0 { base } else { &frames[k - 1] };
        let half = half_turn::<T>(before.load(), frames[k].load());
        out[k] = (half + half).store();
    }
}

/// Turns every link, carried along by `carry` from `frames`, along the free motion, and sets the particles.
#[inline(always)]
fn predict<T: Number>(
    batch: &Batch,
    mut free: FreeMotion,
    carry: Quat,
    frames: &[Quat],
    shape: &mut Stage,
) {
    let count = batch.count();
    let (links, frames) = (&batch.links[..count], &frames[..count]);
    let (ys, next) = (&mut shape.y[..count], &mut shape.frames[..count]);
    let tangents = &mut shape.tangents[..count];
    let (mut before, mut y) = (Vec3::zero(), Vec3::zero());
    // Of the link before, not normalised.
    let mut turn = Quat::identity();
    for k in 0..count {
        let length: T = links[k].length.load();
        let place = free.place::<T>(k);
        let frame = carry.load().times(frames[k].load());
        turn = pointing(frame.tangent(), place - before, length, turn);
        before = place;
        let frame = turn.times(frame).normalize();
        let tangent = frame.tangent();
        y += tangent.scale(length);
        ys[k] = y.store();
        next[k] = frame.store();
        tangents[k] = tangent.store();
    }
}

/// The least rotation (not normalised) that points `tangent` along `chord`; none where they are nearly opposite. A link that has
/// no direction of its own goes with the one before it.
#[inline(always)]
fn pointing<T: Number>(tangent: Vec3<T>, chord: Vec3<T>, length: T, before: Quat<T>) -> Quat<T> {
    let squared = chord.length_squared();
    let size = squared.sqrt();
    let turn = Quat {
        v: tangent.cross(chord),
        w: tangent.dot(chord) + size,
    };
    let is_ahead = (size * T::splat(0.05)).less(turn.w);
    let turn = Quat::choose(is_ahead, turn, Quat::identity());
    // Times the length squared on both sides: a link without any never has a direction, whatever its ends do.
    let own = length * length;
    let is_clear = (own * own * T::splat(0.01)).less(squared * own);
    Quat::choose(is_clear, turn, before)
}

/// Adds forces to mass and weight of every particle for a stage from `free_y`, `free_v`.
#[inline(always)]
pub(super) fn assemble<T: Number>(
    batch: &Batch,
    scratch: &mut Scratch,
    stage: &StageSetup,
    which: Which,
) {
    load::<T>(batch, scratch, stage, which);
    if !scratch.touched.is_empty() {
        for &k in &scratch.touched {
            scratch.contacts[k].holds = Lane::ZERO;
        }
        let expected = |contact: &Contact, y, level| contact.expected(y, level, stage.length);
        hold(batch, scratch, stage.length, which, expected);
    }
}

/// All but the contacts.
#[inline(always)]
fn load<T: Number>(batch: &Batch, scratch: &mut Scratch, stage: &StageSetup, which: Which) {
    if batch.has_drag.any() {
        drag::<T>(batch, scratch, stage, which);
    }
    if scratch.has_springs {
        spring::<T>(batch, scratch, stage.length, which);
    }
}

#[inline(always)]
fn drag<T: Number>(batch: &Batch, scratch: &mut Scratch, stage: &StageSetup, which: Which) {
    let count = batch.count();
    let Scratch {
        nodes,
        free_y,
        mid,
        end,
        trial,
        ..
    } = scratch;
    let shape = match which {
        Which::Mid => mid,
        Which::End => end,
        Which::Trial => trial,
    };
    let (nodes, particles) = (&mut nodes[..count], &batch.particles[..count]);
    let (y, tangents) = (&shape.y[..count], &shape.tangents[..count]);
    let free_y = &free_y[..count];
    for k in 0..count {
        let (particle, d) = (particles[k].load::<T>(), stage.length.load::<T>());
        let rate = particle.mass * particle.drag * d;
        let less = batch.drag_along.load::<T>() - T::splat(1.0);
        let n = Sym3::outer(rate, tangents[k].load(), rate * less);
        let air = stage.gusts.velocity(stage.root.load::<T>() + y[k].load());
        let air = air - stage.velocity.load();
        let carried = free_y[k].load() + air.scale(d);
        let node = nodes[k].load();
        let node = Node {
            n: node.n + n,
            b: node.b + n.apply(carried),
        };
        nodes[k] = node.store();
    }
}

#[inline(always)]
fn spring<T: Number>(batch: &Batch, scratch: &mut Scratch, length: Lane, which: Which) {
    let count = batch.count();
    let Scratch {
        nodes,
        free_y,
        springs,
        ..
    } = scratch;
    let (nodes, particles) = (&mut nodes[..count], &batch.particles[..count]);
    let (free_y, springs) = (&free_y[..count], &springs[..count]);
    for k in 0..count {
        let (mass, d) = (particles[k].mass.load::<T>(), length.load::<T>());
        let spring = springs[k].load();
        let (to, flow) = match which {
            Which::Mid => (spring.mid, spring.flow_mid),
            Which::End | Which::Trial => (spring.end, spring.flow_end),
        };
        let carried = free_y[k].load().scale(spring.rate) + flow.scale(d);
        let stiffness = (spring.stiffness * (d * d) + spring.rate * d) * mass;
        let node = nodes[k].load();
        let node = Node {
            n: node.n + Sym3::diagonal(stiffness),
            b: node.b + (to.scale(d * d) + carried.scale(d)).scale(mass),
        };
        nodes[k] = node.store();
    }
}

/// Lets planes hold particles from now on, in the strands where `holds` says so of a plane, a particle and the plane's
/// level in the stage. Returns the strands where any is new.
#[inline(always)]
pub(super) fn hold(
    batch: &Batch,
    scratch: &mut Scratch,
    d: Lane,
    which: Which,
    holds: impl Fn(&Contact, Vec3, Lane) -> Mask,
) -> Mask {
    let mut new = Mask::NONE;
    for i in 0..scratch.touched.len() {
        let k = scratch.touched[i];
        let contact = &scratch.contacts[k];
        let level = if which == Which::Mid {
            contact.mid
        } else {
            contact.end
        };
        let here = holds(contact, scratch.shape(which).y[k], level);
        if here.any() {
            let mass = batch.particles[k].mass;
            let free = scratch.free_y[k];
            scratch.contacts[k].hold(&mut scratch.nodes[k], here, mass, level, d, free);
            new = new.or(here);
        }
    }
    new
}

/// Newton's method for a stage, starting from its shape, to a last step of `small_turn` (radians). Returns the number
/// of iterations, summed over strands; lanes that did not converge are added to `failed`.
#[inline(always)]
fn solve<T: Number>(
    batch: &Batch,
    scratch: &mut Scratch,
    setup: &StageSetup,
    small_turn: f64,
    failed: &mut Mask,
    (which, active): (Which, Mask),
) -> usize {
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
        let largest = newton::<T>(batch, scratch, setup, &elastic, open, which);
        // Lanes whose numbers are broken stop as well, and fail.
        let small = largest.lt(Lane::splat(small_turn));
        let broken = largest.is_finite().not();
        *failed = failed.or(broken.and(open));
        let done = small.or(broken);
        let among = open.and(broken.not());
        let passed = |contact: &Contact, y, level| contact.passed(y, level).and(among);
        let met = hold(batch, scratch, setup.length, which, passed);
        open = open.and(done.not()).or(met);
    }
    *failed = failed.or(open);
    iterations
}

/// One step of Newton's method for the lanes in `open`. Returns the largest turn of a link that it asks for, in proportion to
/// what the sharpest joint lets pass for small.
#[inline(always)]
fn newton<T: Number>(
    batch: &Batch,
    scratch: &mut Scratch,
    setup: &StageSetup,
    elastic: &Elastic,
    open: Mask,
    which: Which,
) -> Lane {
    let Scratch {
        nodes,
        joints: ready,
        eliminations,
        straight,
        turns,
        past,
        mid,
        end,
        free_y,
        ..
    } = scratch;
    let shape = if which == Which::Mid { mid } else { end };
    let (links, base) = (&batch.links, &setup.base);
    let scale = |largest: Lane| (Lane::splat(LARGEST_TURN) / largest).min(Lane::ONE);
    let (sharpest, largest);
    if batch.is_straight {
        straight::bend_joints::<T>(base, links, shape);
        let damps = batch.damping != Lane::ZERO;
        sharpest = straight::ascend::<T>(links, shape, nodes, past, elastic, damps, straight);
        largest = straight::descend::<T>(links, &shape.across, straight, turns);
        straight::turn_links::<T>(links, shape, turns, scale(largest), open);
    } else {
        let pose = shape.pose(base);
        sharpest = joints::<T>(links, pose, past, elastic, ready);
        ascend::<T>(links, pose, nodes, ready, eliminations);
        largest = descend::<T>(links, &shape.tangents, eliminations, turns);
        turn_links::<T>(batch, shape, turns, scale(largest), open);
    }
    let rate = setup.length.recip();
    let count = batch.count();
    let (v, y, free_y) = (&mut shape.v[..count], &shape.y[..count], &free_y[..count]);
    for k in 0..count {
        v[k] = (y[k] - free_y[k]) * rate;
    }
    largest * sharpest.sqrt()
}

/// Turns the links of the lanes in `which` by `scale` times `turns`, and moves the particles along.
#[inline(always)]
pub(super) fn turn_links<T: Number>(
    batch: &Batch,
    shape: &mut Stage,
    turns: &[Vec3],
    scale: Lane,
    which: Mask,
) {
    let count = batch.count();
    let (links, turns) = (&batch.links[..count], &turns[..count]);
    let (ys, frames) = (&mut shape.y[..count], &mut shape.frames[..count]);
    let tangents = &mut shape.tangents[..count];
    let (scale, which) = (scale.load(), T::condition(&which));
    let mut y = Vec3::zero();
    for k in 0..count {
        let frame = frames[k].load::<T>();
        let turned = frame.turned(turns[k].load().scale(scale));
        let frame = Quat::choose(which, turned, frame);
        let tangent = frame.tangent();
        y += tangent.scale(links[k].length.load());
        ys[k] = y.store();
        frames[k] = frame.store();
        tangents[k] = tangent.store();
    }
}
