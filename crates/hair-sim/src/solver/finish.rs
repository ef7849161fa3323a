//! The end of a step: which strands it holds for, what the next one starts from, and which strands sleep.

use crate::lanes::{LANES, Lane, Mask, Number, Quat, Vec3};

use super::{
    batch::{Batch, BatchState, Scratch},
    drive::{Drive, RootMotion},
    straight,
};

/// The cosine of the most that a link may turn against the skin in a step of this integrator (2.1 rad): beyond it the
/// differences that it is made of mean nothing.
const LEAST_COSINE: f64 = -0.5;

/// The share of the end velocity's stretch that is taken out. A backward difference of points that run on an arc points
/// inside the arc; half of that is the error of the difference.
const UNSTRETCH: f64 = 0.5;

/// Strands that are slower than this (m/s) for so many steps sleep.
const QUIET_SPEED: f64 = 1e-7;
const QUIET_STEPS: u32 = 24;

/// Strands that have not moved for [`QUIET_STEPS`], on roots that do not move, where what acts stays as it is.
#[inline(always)]
pub(super) fn asleep(state: &BatchState, drive: &Drive, used: Mask) -> Mask {
    if !drive.calm {
        return Mask::NONE;
    }
    let still = (drive.root - state.root).length_squared()
        + (drive.base.v - state.base.v).length_squared()
        + state.root_velocity.length_squared();
    let quiet = Mask::new(state.quiet.map(|steps| steps >= QUIET_STEPS));
    quiet.and(still.lt(Lane::splat(1e-26))).and(used)
}

#[inline(always)]
pub(super) fn count_quiet(batch: &Batch, state: &mut BatchState, drive: &Drive, active: Mask) {
    let mut fastest = Lane::ZERO;
    for k in 0..batch.count() {
        fastest = fastest.max(state.v[k].length_squared());
    }
    let limit = Lane::splat(QUIET_SPEED * QUIET_SPEED);
    let quiet = fastest.lt(limit).and(Mask::new([drive.calm; LANES]));
    for lane in 0..LANES {
        if active.get(lane) {
            let steps = state.quiet[lane].saturating_add(1);
            state.quiet[lane] = if quiet.get(lane) { steps } else { 0 };
        }
    }
}

#[inline(always)]
pub(super) fn turned_too_far<T: Number>(
    batch: &Batch,
    state: &BatchState,
    scratch: &Scratch,
    root: &RootMotion,
) -> Mask {
    let mut least = T::splat(1.0);
    let turn = root.turn_end.load::<T>();
    for k in 0..batch.count() {
        let before = state.frames[k].load().tangent();
        let now = scratch.end.tangents[k].load();
        // Turned with the skin, or left where it was: either is an ordinary motion.
        let (carried, still) = (turn.rotate(before).dot(now), before.dot(now));
        let cosine = T::choose(carried.less(still), still, carried);
        // Links that only fill the batch have no say; what is no number is the least.
        let counts = batch.links[k].counts.load();
        let cosine = cosine * counts + (T::splat(1.0) - counts);
        least = T::choose(least.less(cosine), least, cosine);
    }
    least.store().gt(Lane::splat(LEAST_COSINE)).not()
}

/// Takes the end stage of the lanes in `which` as the new state.
#[inline(always)]
pub(super) fn finish<T: Number>(
    batch: &Batch,
    state: &mut BatchState,
    scratch: &mut Scratch,
    root: &RootMotion,
    which: Mask,
    d: f64,
) {
    if batch.is_straight {
        straight::frame_links::<T>(batch, &root.end, &mut scratch.end);
    }
    let mut struck = Mask::new(state.restart).and(which.not());
    let end = &scratch.end;
    let rate = 1.0 / d;
    let mut before = Vec3::zero();
    let mut velocity = Vec3::<T>::zero();
    for k in 0..batch.count() {
        let v = end.v[k].load::<T>();
        let a = ((v - scratch.free_v[k].load()) * rate).store();
        let t = end.tangents[k].load();
        let along = v - before;
        before = v;
        velocity += along - t.scale(along.dot(t) * T::splat(UNSTRETCH));
        let a = if !scratch.touched.is_empty() {
            settle_contact(state, scratch, k, a, which, &mut struck)
        } else {
            state.press[k] = which.pick(Lane::ZERO, state.press[k]);
            a
        };
        state.a[k] = Vec3::pick(which, a, state.a[k]);
        state.v[k] = Vec3::pick(which, velocity.store(), state.v[k]);
        state.y[k] = Vec3::pick(which, end.y[k], state.y[k]);
        state.frames[k] = Quat::pick(which, end.frames[k], state.frames[k]);
        state.past[k] = Vec3::pick(which, scratch.past[k], state.past[k]);
    }
    state.restart = struck.bools();
}

/// Remembers the pressure on particle `k`, and returns its acceleration without the blow of a contact: that is over, and
/// the next step must not start with it. A strand that was struck starts anew.
#[inline(always)]
fn settle_contact(
    state: &mut BatchState,
    scratch: &Scratch,
    k: usize,
    a: Vec3,
    which: Mask,
    struck: &mut Mask,
) -> Vec3 {
    let contact = &scratch.contacts[k];
    let press = contact.pressure(scratch.end.y[k]);
    let before = state.press[k];
    let new = (before.gt(Lane::ZERO).not()).and(press.gt(Lane::ZERO));
    *struck = struck.or(new.and(which));
    state.press[k] = which.pick(press, before);
    let out = a.dot(contact.normal).max(Lane::ZERO) * contact.holds;
    a - contact.normal * out
}
