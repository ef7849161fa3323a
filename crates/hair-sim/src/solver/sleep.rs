//! Strands that rest, and cost nothing.
//!
//! A strand is quiet that has hardly moved for a while, in which what acts stayed the same. On bodies and among other hair that is a few
//! micrometres: no picture shows more, and what rests there may tremble by less for ever. A free strand may be about to leave a shape that it
//! can't keep, and must be quieter. Strands that act on each other, themselves or
//! by way of others, are an island: they sleep as soon as all of them are quiet, and wake together.

use crate::{
    lanes::{LANES, Lane, Mask, Quat, Vec3},
    surroundings::{Roots, Surroundings},
};

use super::{
    batch::{Batch, BatchState},
    drive::{Drive, roots},
};

/// Strands of which no particle leaves a ball of this radius (m; the second of free ones), or of this part of their length where that is less, for so long (s) are
/// quiet.
const QUIET_WAY: f64 = 4e-6;
const FREE_WAY: f64 = 1e-7;
const QUIET_SHARE: f64 = 2e-5;
const QUIET_TIME: f64 = 1.0;

/// What touches bodies or other hair may tremble for ever, as what friction holds slips now and then: it is quiet as well where it does so within
/// this ball for so long, in m and s. That bounds the speed of what goes somewhere nearly as the others do. The ball grows with the square of the time for which
/// nothing that acts has moved, from this time on and up to that of what jams: what still creeps after half a minute, a pixel in some seconds, may do so
/// for minutes. What leaves a ball only after twice that time goes on being quiet: where many slip now and then they would hardly ever be quiet at once.
const TREMBLING_WAY: f64 = 2.4e-5;
const TREMBLING_TIME: f64 = 4.0;
/// What has been restless, or has rocked on a body, for longer than the second of these, in s, is quiet within a ball of the first, in m, for as long as what trembles: where locks jam
/// they shove each other about by some micrometres a step.
const JAMMED_WAY: f64 = 2e-3;
const JAMMED_TIME: f64 = 0.5;

/// Which strands act on each other: the island of every lane of every batch, by a number below `count`.
#[derive(Clone, Debug, Default)]
pub(super) struct Islands {
    of: Vec<[u32; LANES]>,
    count: usize,
}

impl Islands {
    /// All strands of so many batches in one.
    pub(super) fn one(batches: usize) -> Self {
        Self {
            of: vec![[0; LANES]; batches],
            count: 1,
        }
    }

    /// Of so many batches with the pairs of places (batch, lane) that act on each other.
    pub(super) fn new(batches: usize, pairs: impl Iterator<Item = [(usize, usize); 2]>) -> Self {
        let mut parents: Vec<usize> = (0..batches * LANES).collect();
        for [one, other] in pairs.map(|pair| pair.map(|(batch, lane)| batch * LANES + lane)) {
            let (one, other) = (first_of(&mut parents, one), first_of(&mut parents, other));
            parents[one.max(other)] = one.min(other);
        }
        let mut of = vec![[0; LANES]; batches];
        for place in 0..parents.len() {
            of[place / LANES][place % LANES] = first_of(&mut parents, place) as u32;
        }
        Self {
            of,
            count: parents.len(),
        }
    }
}

/// The first place of an island; those on the way there come nearer to it.
fn first_of(parents: &mut [usize], mut place: usize) -> usize {
    while parents[place] != place {
        parents[place] = parents[parents[place]];
        place = parents[place];
    }
    place
}

/// The strands of every batch that sleep in a step.
#[derive(Clone, Debug, Default)]
pub(super) struct Sleepers {
    pub(super) of: Vec<Mask>,
    /// The islands in which a strand is awake.
    awake: Vec<bool>,
    /// Whether no root moves, where what acts doesn't.
    pub(super) are_roots_still: bool,
}

impl Sleepers {
    /// Finds them; none unless the step is `calm`: what acts is the same as in the last step, and does not move.
    pub(super) fn find(
        &mut self,
        batches: &[Batch],
        states: &[BatchState],
        surroundings: &Surroundings,
        calm: bool,
        islands: Option<&Islands>,
    ) {
        self.of.clear();
        self.are_roots_still = true;
        if !calm {
            self.of.resize(batches.len(), Mask::NONE);
            return;
        }
        let places = batches.iter().zip(states);
        let Some(islands) = islands else {
            for (batch, state) in places {
                let rests = rest(batch, state, surroundings);
                self.are_roots_still &= rests == batch.used;
                self.of.push(state.quiet().and(rests));
            }
            return;
        };
        self.awake.clear();
        self.awake.resize(islands.count, false);
        for ((batch, state), islands) in places.clone().zip(&islands.of) {
            // What is set aside is at rest where its root is.
            let quiet = state.quiet().or(state.aside());
            let rests = rest(batch, state, surroundings);
            self.are_roots_still &= rests == batch.used;
            let wakes = (quiet.and(rests).not()).and(batch.used);
            for lane in 0..LANES {
                self.awake[islands[lane] as usize] |= wakes.get(lane);
            }
        }
        let awake = &self.awake;
        self.of
            .extend(places.zip(&islands.of).map(|((batch, state), islands)| {
                let asleep = Mask::new(islands.map(|island| !awake[island as usize]));
                asleep.and(batch.used).and(state.aside().not())
            }));
    }

    /// Whether all strands that have links sleep.
    pub(super) fn are_all(&self, batches: &[Batch]) -> bool {
        (self.of.iter().zip(batches)).all(|(asleep, batch)| *asleep == batch.used)
    }
}

impl BatchState {
    /// The strands that have hardly moved for a while.
    fn quiet(&self) -> Mask {
        let trembles = self.trembling.gt(Lane::splat(TREMBLING_TIME));
        self.quiet.gt(Lane::splat(QUIET_TIME)).or(trembles)
    }
}

/// The strands whose roots stay where they are in a step in which what acts is the same as in the last.
fn rest(batch: &Batch, state: &BatchState, surroundings: &Surroundings) -> Mask {
    if let Roots::Head(_) = surroundings.roots {
        return batch.used;
    }
    let (root, base): (Vec3, Quat) = roots(batch, surroundings);
    let moves = (root - state.root).length_squared()
        + (base.v - state.base.v).length_squared()
        + state.root_velocity.length_squared();
    // A strand whose root has no pose stays where it is, and is set aside.
    let lost = moves.is_finite().not().and(state.aside());
    moves.lt(Lane::splat(1e-26)).or(lost).and(batch.used)
}

/// Measures for how long the strands of `active` have hardly moved while their roots didn't.
#[inline(always)]
pub(super) fn count_quiet(batch: &Batch, state: &mut BatchState, drive: &Drive, active: Mask) {
    if !drive.calm {
        state.quiet = active.pick(Lane::ZERO, state.quiet);
        state.trembling = active.pick(Lane::ZERO, state.trembling);
        state.calm = active.pick(Lane::ZERO, state.calm);
        return;
    }
    let mut press = Lane::ZERO;
    for of_plane in &state.press {
        press = press.max(*of_plane);
    }
    // What is recalled is pulled to where it may not get.
    for share in &state.recalled {
        press = press.max(*share);
    }
    let is_free = press
        .gt(Lane::ZERO)
        .not()
        .and(Mask::new([drive.others.is_none(); LANES]));
    let (most, dt) = (batch.length * QUIET_SHARE, Lane::splat(drive.dt));
    let way = is_free.pick(Lane::splat(FREE_WAY), Lane::splat(QUIET_WAY));
    let way = way.min(most);
    let gone = farthest(&state.y, &state.quiet_at);
    let stays = gone.lt(way * way);
    keep(&mut state.quiet_at, &state.y, active.and(stays.not()));
    let is_still = state.root_velocity.length_squared().gt(Lane::ZERO).not();
    let quiet = stays.and(is_still).pick(state.quiet + dt, Lane::ZERO);
    state.quiet = active.pick(quiet, state.quiet);

    let is_calm = Mask::new([drive.are_roots_still; LANES]);
    let calm = is_calm.pick(state.calm + dt, Lane::ZERO);
    state.calm = active.pick(calm, state.calm);
    let held = (state.calm * (1.0 / TREMBLING_TIME)).max(Lane::ONE);
    let most = most * (TREMBLING_WAY / QUIET_WAY);
    let way = most.min(Lane::splat(TREMBLING_WAY)) * held * held;
    let way = is_free.pick(Lane::ZERO, way.min(Lane::splat(JAMMED_WAY)));
    let longest = state.restless.max(state.rocking);
    let jams = longest.gt(Lane::splat(JAMMED_TIME));
    let way = jams.pick(Lane::splat(JAMMED_WAY), way);
    // What went farther than all across the ball has left it: what is under way costs no more than this.
    let slow = active.and(gone.lt(way * way * 4.0));
    let mut stays = slow.and(state.trembling.gt(Lane::ZERO));
    if stays.any() {
        stays = stays.and(farthest(&state.y, &state.trembling_at).lt(way * way));
    }
    keep(&mut state.trembling_at, &state.y, slow.and(stays.not()));
    let slipped = state.trembling.gt(Lane::splat(TREMBLING_TIME * 2.0));
    let from = slipped.pick(Lane::splat(TREMBLING_TIME), Lane::ZERO);
    let time = stays.pick(state.trembling, from) + dt;
    let time = slow.and(is_still).pick(time, Lane::ZERO);
    state.trembling = active.pick(time, state.trembling);
}

/// The square of how far the particle of every strand that went farthest is from where it was, in m^2.
#[inline(always)]
fn farthest(y: &[Vec3], from: &[Vec3]) -> Lane {
    let mut farthest = Lane::ZERO;
    for (y, from) in y.iter().zip(from) {
        farthest = farthest.max((*y - *from).length_squared());
    }
    farthest
}

/// Remembers where the strands of `which` are.
#[inline(always)]
fn keep(at: &mut [Vec3], y: &[Vec3], which: Mask) {
    if which.any() {
        for (at, y) in at.iter_mut().zip(y) {
            *at = Vec3::pick(which, *y, *at);
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::solver::Solver;
    use crate::{Params, Pose, Roots, Strands, Surroundings};
    use glam::Vec3;

    #[test]
    fn nobody_has_been_calm_since_a_root_moved() {
        const DT: f64 = 1.0 / 60.0;
        let mut strands = Strands::new();
        for s in 0..2 {
            let points = [0.0, 0.1, 0.2].map(|y| Vec3::new(s as f32, -y, 0.0));
            strands.push(s, &points, None).unwrap();
        }
        let (mut solver, mut state) = Solver::new(&strands, &Params::default()).unwrap();
        let mut poses = [Pose::IDENTITY; 2];
        let mut times = Vec::new();
        for moves in [false, true, false] {
            for _ in 0..20 {
                if moves {
                    poses[0].translation.x += 1e-9; // hair keeps up with that
                }
                let roots = Roots::Each(&poses);
                let scene = Surroundings {
                    roots,
                    ..Default::default()
                };
                solver.step(&mut state, &scene, DT).unwrap();
            }
            let of = |strand: usize| {
                let (batch, lane) = solver.places[strand];
                let batch = &state.batches[batch];
                [batch.calm[lane], batch.quiet[lane]]
            };
            times.push([of(0), of(1)]);
        }
        // In the first step after it has moved the root comes to rest.
        let [[first, second], moving, after] = [times[0], times[1], times[2]];
        assert!(first[0] > 17.0 * DT && second[0] > 17.0 * DT, "{times:?}");
        assert_eq!(moving.map(|[calm, _]| calm), [0.0; 2]);
        assert_eq!(moving[0][1], 0.0);
        let quiet = moving[1][1] - second[1];
        assert!(quiet > 19.5 * DT, "the other has hardly moved: {times:?}");
        assert!(
            after[0][0] > 17.0 * DT && after[0][0] < 20.5 * DT,
            "{times:?}"
        );
        assert_eq!(after[0][0], after[1][0]);
    }
}
