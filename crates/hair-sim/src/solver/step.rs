//! A step of a batch.

use crate::{
    lanes::{LANES, Number, Quat, Vec3},
    stats::Stats,
};

use super::{
    batch::{Batch, BatchState},
    chain::ShapeEnergy,
    contact::keep_out::keep_out,
    drive::{Drive, RootMotion, prepare},
    energy::{take_gain, watch},
    finish::{carry, finish, turned_too_far},
    rods::Rods,
    safe,
    scratch::Scratch,
    sleep::count_quiet,
    tr_bdf2,
    unrest::calm_down,
};

/// A step that is so many times as long as the one before starts anew. What particles' accelerations were at the end of a very short step says little about
/// the strands: it took the rest of a link's stretch away at once, which a long step would go on with.
const LONGER: f64 = 64.0;

/// Advances a batch by `drive.dt`.
pub(crate) fn advance<T: Number>(
    batch: &Batch,
    state: &mut BatchState,
    scratch: &mut Scratch,
    drive: &Drive,
) -> Stats {
    T::run(
        #[inline(always)]
        move || {
            if drive.dt > LONGER * drive.last_dt {
                state.restart = [true; LANES];
            }
            let root = RootMotion::new(state, drive);
            let asleep = drive.asleep;
            let mut stats = Stats {
                asleep: asleep.count(),
                ..Stats::default()
            };
            if asleep == batch.used && !state.aside().and(batch.used).any() {
                // Strands of a root alone have nothing that could sleep.
                state.root = Vec3::pick(batch.used, state.root, root.root);
                state.root_velocity = Vec3::pick(batch.used, state.root_velocity, root.velocity);
                return stats;
            }
            let rods = Rods::of(batch);
            let drives = (drive, &root);
            let awake = asleep.not();
            let active = prepare::<T>(rods, batch, state, scratch, drives, awake, &mut stats);
            stats.strands = active.count();
            state.tied = [false; LANES];
            for own in drive.anchors {
                state.tied[own.lane] = true;
            }
            let has_bodies = !drive.surroundings.colliders.is_empty();
            if drive.locks.is_some() || has_bodies || !drive.anchors.is_empty() {
                calm_down(batch, state, &mut scratch.work.loads, drives, active);
            }

            let found = tr_bdf2::step::<T>(rods, batch, state, scratch, drives, active);
            stats.iterations = found.iterations;
            let too_far = turned_too_far::<T>(batch, state, &scratch.end, &root);
            let mut failed = found.failed.or(too_far).and(active);
            let watched = watch::<T>(batch, state, &scratch.work.loads, drive, &root, active);
            let mut shape = ShapeEnergy::NONE;
            if watched.any() {
                shape = rods.energy::<T>(batch, &scratch.end, &root.end, &root.pull);
                failed = failed.or(shape.is_out_of_reach(batch, state, &root, watched));
            }
            stats.fallbacks = failed.count();
            let d = tr_bdf2::stage_length(drive.dt);
            finish::<T>(batch, state, scratch, active.and(failed.not()), (rods, d));
            if failed.any() {
                safe::step::<T>(rods, batch, state, scratch, drives, failed);
            }
            let bodies = drive.bodies(state.root, root.root);
            let mut watched = watched;
            if bodies.have_links() {
                let ways = &mut scratch.work.loads.ways;
                let turned = keep_out::<T>(batch, state, &bodies, ways, active);
                if turned.any() {
                    state.turned_out(turned);
                    watched = watched.and(turned.not());
                }
            }
            if watched.any() {
                if failed.any() {
                    let other = rods.energy_of::<T>(batch, state, &root.end, &root.pull);
                    shape = ShapeEnergy::pick(failed, other, shape);
                }
                take_gain::<T>(batch, state, &root, &shape, watched);
            }
            let aside = state.aside().and(batch.used);
            if aside.any() {
                stats.set_aside = aside.count();
                carry(rods, batch, state, root.turn_end, aside);
            }
            count_quiet(batch, state, drive, active);
            // As where a whole batch sleeps: which strands share one decides nothing.
            state.root = Vec3::pick(asleep, state.root, root.root);
            state.root_velocity = Vec3::pick(asleep, state.root_velocity, root.velocity);
            state.base = Quat::pick(asleep, state.base, root.end);
            stats
        },
    )
}
