//! Strands that bend and twist: the rotations of their links are all there is to find, three numbers each.

pub(crate) mod sweep;

use crate::{
    lanes::{Lane, Mask, Number, Quat, Vec3},
    solver::{
        batch::{Batch, BatchState},
        chain::{Chain, ShapeEnergy},
        link::Link,
        stage::{FreeMotion, Model},
    },
};

use sweep::{Elimination, JointMoment, ascend, descend, half_turn, joints};

/// Scratch of a Newton step.
#[derive(Clone, Debug)]
pub(crate) struct Scratch {
    joints: Vec<JointMoment>,
    eliminations: Vec<Elimination>,
    /// How the links are to turn.
    pub turns: Vec<Vec3>,
}

impl Scratch {
    pub(crate) fn new(count: usize) -> Self {
        Self {
            joints: vec![JointMoment::<Lane>::zero(); count],
            eliminations: vec![Elimination::<Lane>::zero(); count],
            turns: vec![Vec3::ZERO; count],
        }
    }
}

/// The turn of every joint, 2 tan(angle / 2) times its axis, in the frame of its link.
pub(crate) fn turns<T: Number>(base: &Quat, frames: &[Quat], out: &mut [Vec3]) {
    T::run(
        #[inline(always)]
        move || {
            for k in 0..frames.len() {
                let before = if k == 0 { base } else { &frames[k - 1] };
                let half = half_turn::<T>(before.load(), frames[k].load());
                out[k] = (half + half).store();
            }
        },
    );
}

/// Turns every link, carried along by `carry` from `frames`, along the free motion, and sets the particles.
pub(crate) fn predict<T: Number>(
    batch: &Batch,
    mut free: FreeMotion,
    carry: Quat,
    frames: &[Quat],
    chain: &mut Chain,
) {
    T::run(
        #[inline(always)]
        move || {
            let count = batch.count();
            let (links, frames) = (&batch.links[..count], &frames[..count]);
            let (ys, next) = (&mut chain.y[..count], &mut chain.frames[..count]);
            let tangents = &mut chain.tangents[..count];
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
        },
    );
}

/// The least rotation (not normalised) that points `tangent` along `chord`; the identity where they are nearly opposite. A link that has
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

/// One Newton step: finds how every link is to turn. Returns the largest turn of a link, and the square of 1 / cos(angle / 2) of the
/// sharpest joint.
pub(crate) fn find_turns<T: Number>(
    links: &[Link],
    model: &Model,
    chain: &Chain,
    scratch: &mut Scratch,
) -> (Lane, Lane) {
    T::run(
        #[inline(always)]
        move || {
            let Scratch {
                joints: ready,
                eliminations,
                turns,
            } = scratch;
            let sharpest = joints::<T>(links, model, chain, ready);
            ascend::<T>(links, model.nodes, chain, ready, eliminations);
            let largest = descend::<T>(links, &chain.tangents, eliminations, turns);
            (largest, sharpest)
        },
    )
}

/// Turns the links of the lanes in `which` by `scale` times `turns`, and moves the particles along.
pub(crate) fn turn_links<T: Number>(
    links: &[Link],
    chain: &mut Chain,
    turns: &[Vec3],
    scale: Lane,
    which: Mask,
) {
    T::run(
        #[inline(always)]
        move || {
            let count = links.len();
            let turns = &turns[..count];
            let (ys, frames) = (&mut chain.y[..count], &mut chain.frames[..count]);
            let tangents = &mut chain.tangents[..count];
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
        },
    );
}

/// Of chains with these frames and particles.
pub(crate) fn energy<T: Number>(
    batch: &Batch,
    base: &Quat,
    frames: &[Quat],
    y: &[Vec3],
    pull: &Vec3,
) -> ShapeEnergy {
    T::run(
        #[inline(always)]
        move || {
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
            ShapeEnergy {
                elastic: elastic.store(),
                weight: weight.store(),
            }
        },
    )
}

/// Carries the lanes in `which` along with the skin.
pub(crate) fn carry(batch: &Batch, state: &mut BatchState, turn: Quat, which: Mask) {
    let mut y = Vec3::ZERO;
    for k in 0..batch.count() {
        let carried = turn.times(state.frames[k]).normalize();
        y += carried.tangent() * batch.links[k].length;
        state.frames[k] = Quat::pick(which, carried, state.frames[k]);
        state.y[k] = Vec3::pick(which, y, state.y[k]);
    }
}
