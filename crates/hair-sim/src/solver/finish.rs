//! The end of a step: which strands it holds for, what the next one starts from.

use crate::lanes::{Lane, Mask, Number, Quat, Vec3};

use super::{
    batch::{Batch, BatchState, CREEP},
    chain::{Chain, chord},
    contact::Contact,
    drive::RootMotion,
    rods::Rods,
    scratch::Scratch,
};

/// The cosine of the most that a link may turn against the skin in a step of this integrator (2.1 rad): beyond it the
/// differences that it is made of mean nothing.
const LEAST_COSINE: f64 = -0.5;

/// The share of the end velocity's stretch that is taken out. A backward difference of points that run on an arc points
/// inside the arc; half of that is the error of the difference.
const UNSTRETCH: f64 = 0.5;

/// The strands of which the end stage turned a link further than an ordinary motion does.
pub(crate) fn turned_too_far<T: Number>(
    batch: &Batch,
    state: &BatchState,
    end: &Chain,
    root: &RootMotion,
) -> Mask {
    T::run(
        #[inline(always)]
        move || {
            let count = batch.count();
            let (links, y) = (&batch.links[..count], &state.y[..count]);
            let tangents = &end.tangents[..count];
            let (zero, ordinary) = (T::splat(0.0), T::splat(LEAST_COSINE));
            let turn = root.turn_end.load::<T>();
            let mut least = T::splat(1.0);
            for k in 0..count {
                let (length, counts) = (links[k].length.load::<T>(), links[k].counts.load());
                let before = chord(y, k);
                let now = tangents[k].load();
                // Links that only fill the batch have no say.
                let limit = ordinary * length - (T::splat(1.0) - counts);
                // Turned with the skin, or left where it was: either is an ordinary motion.
                let still = before.dot(now) - limit;
                if T::all(zero.less(still)) {
                    continue;
                }
                let carried = turn.rotate(before).dot(now) - limit;
                let more = T::choose(carried.less(still), still, carried);
                // NaN is the least.
                least = T::choose(least.less(more), least, more);
            }
            least.store().gt(Lane::ZERO).not()
        },
    )
}

/// Takes the end stage of the lanes in `which` as the new state, where the stage's length is `d`.
pub(crate) fn finish<T: Number>(
    batch: &Batch,
    state: &mut BatchState,
    scratch: &Scratch,
    which: Mask,
    (rods, d): (Rods, f64),
) {
    T::run(
        #[inline(always)]
        move || {
            let count = batch.count();
            let (end, work) = (&scratch.end, &scratch.work);
            let (v, y, tangents) = (&end.v[..count], &end.y[..count], &end.tangents[..count]);
            let (free_v, past) = (&work.loads.free_v[..count], &work.past[..count]);
            let (rate, damps) = (T::splat(1.0 / d), batch.damping != Lane::ZERO);
            let mut before = Vec3::zero();
            let mut velocity = Vec3::<T>::zero();
            for k in 0..count {
                let v = v[k].load::<T>();
                let t = tangents[k].load();
                let along = v - before;
                before = v;
                velocity += along - t.scale(along.dot(t) * T::splat(UNSTRETCH));
                let a = (v - free_v[k].load()).scale(rate);
                // By bits: of numbers chosen in registers the compiler makes masked stores, which take far longer on some
                // machines.
                state.a[k] = Vec3::pick(which, a.store(), state.a[k]);
                state.v[k] = Vec3::pick(which, velocity.store(), state.v[k]);
                state.y[k] = Vec3::pick(which, y[k], state.y[k]);
                if damps {
                    state.past[k] = Vec3::pick(which, past[k], state.past[k]);
                }
            }
            forget_planes(state, which);
            rods.keep_frames(state, end, which);
            let mut struck = Mask::new(state.restart).and(which.not());
            for &plane in &work.loads.touched {
                let (contact, k) = (&work.loads.contacts[plane], batch.held_by(plane));
                struck = struck.or(settle_contact(state, contact, end.y[k], (plane, k), which));
            }
            state.restart = struck.bools();
        },
    );
}

/// Planes are gone whose pressure isn't remembered after this.
#[inline(always)]
pub(super) fn forget_planes(state: &mut BatchState, which: Mask) {
    for (press, creep) in state.press.iter_mut().zip(&mut state.creep) {
        *press = which.pick(Lane::ZERO, *press);
        *creep = which.pick(Lane::splat(CREEP), *creep);
    }
}

/// Remembers the pressure of a plane on particle `k` at `y`, and takes the blow of a contact out of its acceleration: that is over, and
/// the next step must not start with it. Nor with the speed that a body has pushed it out by. Returns the strands that were struck: they start anew.
#[inline(always)]
fn settle_contact(
    state: &mut BatchState,
    contact: &Contact,
    y: Vec3,
    (plane, k): (usize, usize),
    which: Mask,
) -> Mask {
    let press = contact.pressure(y);
    state.press[plane] = which.pick(press, state.press[plane]);
    let a = state.a[k];
    let out = a.dot(contact.normal).max(Lane::ZERO) * contact.holds;
    state.a[k] = Vec3::pick(which, a - contact.normal * out, a);
    let v = state.v[k];
    state.v[k] = Vec3::pick(which, v - contact.normal * contact.too_fast(v), v);
    let presses = press.gt(Lane::ZERO).and(which);
    let is_new = (contact.press.gt(Lane::ZERO).not()).and(presses);
    let creep = is_new.pick(Lane::ZERO, contact.creep);
    state.creep[plane] = presses.pick(creep, state.creep[plane]);
    is_new
}

/// Carries the lanes in `which` along with the skin, at rest against it.
pub(crate) fn carry(rods: Rods, batch: &Batch, state: &mut BatchState, turn: Quat, which: Mask) {
    rods.carry(batch, state, turn, which);
    for k in 0..batch.count() {
        state.v[k] = Vec3::pick(which, Vec3::ZERO, state.v[k]);
        state.a[k] = Vec3::pick(which, Vec3::ZERO, state.a[k]);
    }
}
