//! What drives a batch in a step: roots, air, bodies and goals, made ready for the stages.

use glam::Vec3 as Point;

use crate::{
    error::Reason,
    forces::{
        mutual::{self, Course, Mutual, Own, Pair},
        springs::Spring,
        wind::Gusts,
    },
    lanes::{LANES, Lane, Mask, Number, Quat, Vec3},
    pose::Pose,
    stats::Stats,
    surroundings::{Anchor, Surroundings},
};

use super::{
    batch::{Batch, BatchState},
    contact::{
        Contact,
        find::{self, Bodies, Planes},
        guard::Guard,
    },
    load::Loads,
    locks::Locks,
    rods::Rods,
    scratch::Scratch,
    stage::GAMMA,
};

/// The speed in m/s, of a particle or of the air that reaches it, at which half of what recalls it is left.
const CALM: f64 = 0.5;

/// A recalled particle is pulled to so much higher than its place as it is beside that: up and over what lies between.
const OVER: f64 = 2.0;

/// The pull in m/s^2 with which a particle that is recalled in full slides without friction. What is pulled by less keeps some of it, and what is pulled
/// by more as well: that gets over what it lies on by itself, and friction lets it come to rest.
const SLIDES: f64 = 30.0;

/// A particle is recalled in full until it has moved by itself for the first of these times, in s, while its goal, the air and all bodies hardly did, and no
/// more after the second: what goes up and over a shoulder has arrived by then. What can't arrive and doesn't come to rest either, as that pull can drive hair
/// round, does so without it.
const PATIENCE: [f64; 2] = [1.5, 4.0];

/// At this speed, in m/s, half of a time counts as moved.
const MOVES: f64 = 0.02;

/// A way of the goal, of the air or of a body's surface, in m, that leaves 0.37 of the time for which a particle has moved by itself, half of it where it is one
/// step's.
pub(super) const STIRS: f64 = 0.1;

/// Nearer than this, in m, to where it is pulled to a particle isn't.
const LEAST_WAY: f64 = 1e-6;

/// What drives a batch in a step.
pub(crate) struct Drive<'a> {
    pub dt: f64,
    /// The length of the last step, or this one's before there was any, in s.
    pub last_dt: f64,
    pub surroundings: &'a Surroundings<'a>,
    /// Of its colliders.
    pub guards: &'a [Guard],
    /// The air at the middle stage and at the end.
    pub gusts: &'a [Gusts<'a>; 2],
    /// The index of every strand's first point in the list of all.
    pub first_points: &'a [usize],
    /// Root and frame of the skin in the world at the end of the step.
    pub root: Vec3,
    pub base: Quat,
    /// The root's acceleration at the start and at the end, where it is known.
    pub accelerations: Option<[Vec3; 2]>,
    /// Whether what acts is the same as in the last step, and does not move.
    pub calm: bool,
    /// Whether no root moves either.
    pub are_roots_still: bool,
    /// The strands that sleep.
    pub asleep: Mask,
    /// The other strands, where they act on each other.
    pub others: Option<Others<'a>>,
    /// The batch's number, and what its strands can't pass through.
    pub locks: Option<(usize, &'a Locks)>,
    /// What pulls at single particles of the batch, each with its lane.
    pub anchors: &'a [Anchored],
}

impl<'a> Drive<'a> {
    /// What hair can't enter, where roots go from one place to another.
    pub(crate) fn bodies(&self, before: Vec3, now: Vec3) -> Bodies<'a> {
        Bodies {
            colliders: self.surroundings.colliders,
            of_one_figure: self.surroundings.of_one_figure,
            guards: self.guards,
            before,
            now,
            dt: self.dt,
        }
    }

    /// How fast the surface of the fastest body goes, in m/s.
    pub(crate) fn speed_of_bodies(&self) -> f64 {
        self.guards.iter().map(Guard::way).fold(0.0, f64::max) / self.dt
    }
}

/// An anchor with the batch, the lane and the particle that it pulls at.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Anchored {
    pub batch: usize,
    pub lane: usize,
    pub particle: usize,
    /// Its place in the list of all.
    pub order: usize,
    pub anchor: Anchor,
}

/// The pairs of a batch with other strands, and where all particles are.
pub(crate) struct Others<'a> {
    pub mutual: &'a Mutual,
    pub pairs: &'a [Pair],
    pub courses: &'a [Course],
}

/// The motion of the roots within a step, and what it does to the strands.
pub(crate) struct RootMotion {
    /// The root at the end.
    pub root: Vec3,
    /// The frame of the skin at the stages.
    pub mid: Quat,
    pub end: Quat,
    /// From its start.
    pub turn_mid: Quat,
    pub turn_end: Quat,
    /// Gravity less the acceleration of the root, at the middle stage and at the end.
    pub pull_mid: Vec3,
    pub pull: Vec3,
    /// The root at the middle stage.
    pub root_mid: Vec3,
    /// The root's mean velocity, and that at the middle stage and at the end, as far as its acceleration is known.
    pub velocity: Vec3,
    pub velocity_mid: Vec3,
    pub velocity_end: Vec3,
}

impl RootMotion {
    #[inline(always)]
    pub(crate) fn new(state: &mut BatchState, drive: &Drive) -> Self {
        let (root, base) = whole_poses(state, drive.root, drive.base);
        let velocity = (root - state.root) * (1.0 / drive.dt);
        let [start, end] = drive
            .accelerations
            .unwrap_or([(velocity - state.root_velocity) * (2.0 / (drive.dt + drive.last_dt)); 2]);
        // Of an acceleration that changes evenly within the step. Where it is only measured, it may be a blow that is over.
        let (velocity_mid, velocity_end) = match drive.accelerations {
            Some([start, end]) => {
                let mid = start * (GAMMA - 1.0 / 3.0) - end * (1.0 / 6.0)
                    + (end - start) * (0.5 * GAMMA * GAMMA);
                let last = start * (1.0 / 6.0) + end * (1.0 / 3.0);
                (velocity + mid * drive.dt, velocity + last * drive.dt)
            }
            None => (velocity, velocity),
        };
        let gravity = Vec3::splat(drive.surroundings.gravity);
        let turn_end = base.times(state.base.conjugate());
        let sign = (turn_end.w.lt(Lane::ZERO)).pick(Lane::splat(-1.0), Lane::ONE);
        // Along the chord: second order in the angle, and no sine.
        let turn_mid = Quat {
            v: turn_end.v * (sign * GAMMA),
            w: turn_end.w * sign * GAMMA + (1.0 - GAMMA),
        }
        .normalize();
        Self {
            root,
            mid: turn_mid.times(state.base),
            end: base,
            turn_mid,
            turn_end,
            pull_mid: gravity - (start + (end - start) * GAMMA),
            pull: gravity - end,
            root_mid: state.root + (root - state.root) * GAMMA,
            velocity,
            velocity_mid,
            velocity_end,
        }
    }
}

/// Root and frame of the skin of every lane in the world.
pub(crate) fn roots(batch: &Batch, surroundings: &Surroundings) -> (Vec3, Quat) {
    let (mut root, mut base) = (batch.root, batch.base);
    for lane in 0..LANES {
        let Some(strand) = batch.strands[lane] else {
            continue;
        };
        let pose = surroundings.roots.of(strand);
        root.set(
            lane,
            pose.translation + pose.rotation * batch.root.get(lane),
        );
        base.set(lane, pose.rotation * batch.base.get(lane));
    }
    (root, base)
}

/// The poses that roots are to have; where one is invalid, the one before, and its strand is set aside.
#[inline(always)]
pub(crate) fn whole_poses(state: &mut BatchState, root: Vec3, base: Quat) -> (Vec3, Quat) {
    let size = base.v.length_squared() + base.w * base.w;
    let place = root.length_squared();
    let whole = (place.is_finite())
        .and(size.lt(Lane::splat(1.001)))
        .and(size.gt(Lane::splat(0.999)));
    for lane in 0..LANES {
        if !whole.get(lane) {
            state.set_aside[lane].get_or_insert(Reason::Root);
        }
    }
    let base = Quat::pick(whole, base, state.base).normalize();
    (Vec3::pick(whole, root, state.root), base)
}

/// Finds contacts, and the springs of the step. Returns the strands that step.
#[inline(always)]
pub(crate) fn prepare<T: Number>(
    rods: Rods,
    batch: &Batch,
    state: &mut BatchState,
    scratch: &mut Scratch,
    (drive, root): (&Drive, &RootMotion),
    awake: Mask,
    stats: &mut Stats,
) -> Mask {
    let loads = &mut scratch.work.loads;
    loads.driven_by_others = Mask::NONE;
    loads.has_springs = batch.has_goal.any() || drive.others.is_some() || !drive.anchors.is_empty();
    if loads.has_springs {
        loads.springs.fill(Spring::NONE);
    }
    let recalls = batch.recall.gt(Lane::ZERO).any();
    if batch.has_goal.any() {
        // As two functions, so that who recalls nothing pays nothing.
        if recalls {
            pull_to_goals::<T, true>(batch, state, loads, (drive, root));
        } else {
            pull_to_goals::<T, false>(batch, state, loads, (drive, root));
        }
    }
    for own in drive.anchors {
        pull_to_anchor(own, state, root.root, loads, drive.dt);
    }
    if let Some(others) = &drive.others {
        let held = (&state.base, &state.y[..], &state.frames[..]);
        let own = Own {
            y: &state.y,
            a: &state.a,
            known: Mask::new(state.restart).not(),
            frames: rods.frames::<T>(batch, held, &mut scratch.mid.frames),
            root_before: state.root,
            root_now: root.root,
            gamma: GAMMA,
            dt: drive.dt,
        };
        let (springs, broken) = (&mut loads.springs, &mut state.broken);
        let pairs = (others.pairs, others.courses);
        let counts = mutual::act::<T>(others.mutual, pairs, &own, broken, springs);
        (stats.links, stats.repulsions) = (counts.links, counts.repulsions);
        loads.driven_by_others = counts.acts_on;
    }
    let active = batch.used.and(state.aside().not()).and(awake);
    if batch.has_drag.any() && drive.gusts[1].blows {
        stats.wind = active.count() * batch.count();
    }
    loads.touched.clear();
    loads.between = Mask::NONE;
    loads.on_exact = Mask::NONE;
    loads.have_exact = Mask::NONE;
    if !drive.surroundings.colliders.is_empty() {
        let bodies = drive.bodies(state.root, root.root);
        if !state.skin_known {
            let of_figure = bodies.of_one_figure;
            find::settle_in(batch, state, bodies.colliders, of_figure);
            state.skin_known = true;
        }
        let room = if bodies.may_wedge() {
            batch.planes_with_second()
        } else {
            batch.planes
        };
        state.hold_planes(room);
        if loads.contacts.len() < room {
            loads.contacts.resize(room, Contact::NONE);
            loads.touched.reserve(room);
        }
        let planes = Planes {
            contacts: &mut loads.contacts,
            touched: &mut loads.touched,
            ways: &mut loads.ways,
        };
        let mut lifts = std::mem::take(&mut state.lifts);
        let (found, [between, on_exact]) =
            find::detect::<T>((batch, &*state), &bodies, active, planes, &mut lifts);
        stats.contacts = found;
        loads.between = Mask::new(between);
        loads.on_exact = Mask::new(on_exact);
        loads.have_exact = Mask::new([bodies.have_links(); LANES]);
        state.lifts = lifts;
    }
    if let Some((index, locks)) = drive.locks {
        let planes = (&mut loads.contacts[..], &mut loads.touched);
        stats.meetings = locks.part((index, batch, &*state), root.root, active, planes);
    }
    if recalls {
        loads.loosen(batch);
    }
    active
}

/// Adds the spring of an anchor, in its lane alone.
fn pull_to_anchor(own: &Anchored, state: &BatchState, root: Vec3, loads: &mut Loads, dt: f64) {
    let (mut stiffness, mut places) = (Lane::ZERO, [Vec3::ZERO; 2]);
    stiffness[own.lane] = own.anchor.stiffness;
    for ((place, root), at) in (places.iter_mut().zip([state.root, root])).zip(own.anchor.places) {
        place.set(own.lane, at - root.get(own.lane));
    }
    let [before, now] = places;
    let spring = &mut loads.springs[own.particle];
    spring.pull(stiffness, before, now, Vec3::ZERO, GAMMA, dt);
}

/// The rotations of a batch's roots: they turn vectors to the bits that [`DQuat`](glam::DQuat) turns them to.
struct Turned<T> {
    axis: Vec3<T>,
    w: T,
}

impl<T: Number> Turned<T> {
    #[inline(always)]
    fn by(poses: &[Pose; LANES]) -> Self {
        let mut turned = Quat::IDENTITY;
        for (lane, pose) in poses.iter().enumerate() {
            turned.set(lane, pose.rotation);
        }
        Self {
            axis: turned.v.load(),
            w: turned.w.load(),
        }
    }

    #[inline(always)]
    fn of(&self, v: Vec3<T>) -> Vec3<T> {
        let Self { axis, w } = *self;
        v.scale(w * w - axis.dot(axis))
            + axis.scale(v.dot(axis) * T::splat(2.0))
            + axis.cross(v).scale(w * T::splat(2.0))
    }
}

/// What pulls particles back that lie far from their goals. See [`Params::recall`](crate::Params::recall).
struct Recall<T> {
    /// In 1/s^2, and how far above the goal it pulls to.
    stiffness: T,
    lift: Vec3<T>,
    /// By how much the pull grows with the distance, in 1/s^2.
    steepness: T,
    /// The share of its friction that is left to the particle.
    grip: T,
    /// How much of what it could be pulled by in all it is pulled by, 0 to 1.
    share: T,
}

impl<T: Number> Recall<T> {
    /// For the ways to the goals, in m, at the start of the step and in its middle, where the sum of the squares of the particles' speed against these
    /// and of that of the air is `restless`, in m^2/s^2, `up` is against gravity, and they have moved by themselves for `alone`, in s.
    #[inline(always)]
    fn new(
        batch: &Batch,
        [way, middle]: [Vec3<T>; 2],
        (restless, alone): (T, T),
        up: Vec3<T>,
    ) -> Self {
        let (zero, one) = (T::splat(0.0), T::splat(1.0));
        let from = batch.recall_from.load::<T>();
        let share = way.length_squared().sqrt() / from - one;
        let part = share.less(one);
        let aside = middle - up.scale(middle.dot(up));
        let lift = up.scale(aside.length_squared().sqrt() * T::splat(OVER));
        let whole = (middle + lift).length_squared().sqrt();
        let calm = one + restless * T::splat(1.0 / (CALM * CALM));
        let [tires, given_up] = PATIENCE;
        let left = (T::splat(given_up) - alone) * T::splat(1.0 / (given_up - tires));
        let left = T::choose(left.less(zero), zero, T::choose(left.less(one), left, one));
        let strength = left / calm;
        let most = batch.recall.load::<T>() * strength;
        let pull = batch.recall.load::<T>() * T::splat(1.0 / SLIDES);
        let slides = T::choose(pull.less(one), pull, one / (pull * pull));
        let recalls = |of: T| T::choose(zero.less(share), of, zero);
        let pulls = T::splat(LEAST_WAY).less(whole);
        let stiffness = T::choose(pulls, most * T::choose(part, share, one) / whole, zero);
        Self {
            stiffness: recalls(stiffness),
            lift,
            steepness: recalls(T::choose(part, most / from, zero)),
            grip: one - recalls(T::choose(part, share, one) * slides * strength),
            share: recalls(T::choose(part, share, one) * strength),
        }
    }
}

#[inline(always)]
fn pull_to_goals<T: Number, const RECALLS: bool>(
    batch: &Batch,
    state: &mut BatchState,
    loads: &mut Loads,
    (drive, root): (&Drive, &RootMotion),
) {
    let known = !state.goal.is_empty();
    let turn = (drive.surroundings.acceleration)
        .map(|ends| (ends[0].turn + ends[1].turn) * 0.5)
        .filter(|_| known);
    if !known {
        state.goal.resize(batch.count(), Vec3::ZERO);
    }
    if RECALLS && state.alone.is_empty() {
        state.alone.resize(batch.count(), Lane::ZERO);
        state.recalled.resize(batch.count(), Lane::ZERO);
    }
    let pose = |strand: Option<usize>| {
        strand.map_or(Pose::IDENTITY, |strand| drive.surroundings.roots.of(strand))
    };
    let poses = batch.strands.map(pose);
    let gravity = drive.surroundings.gravity;
    let up = Vec3::<T>::all(gravity.normalize_or_zero() * -1.0);
    let turned = Turned::<T>::by(&poses);
    let has_strand = Mask::new(batch.strands.map(|strand| strand.is_some()));
    let air = &drive.gusts[1];
    let root_velocity = root.velocity.load::<T>();
    let bodies = if RECALLS {
        drive.speed_of_bodies()
    } else {
        0.0
    };
    let here = T::condition(&has_strand);
    for k in 0..batch.count() {
        let styled = batch.styled[k];
        let mut goal = styled;
        if let Some(goals) = drive.surroundings.goal {
            for lane in (0..LANES).filter(|&lane| k < batch.counts[lane]) {
                if let Some(strand) = batch.strands[lane] {
                    let at: Point = goals[drive.first_points[strand] + k + 1];
                    goal.set(lane, at.as_dvec3() - batch.root.get(lane));
                }
            }
        }
        let there = turned.of(goal.load());
        let [x, y, z] = [there.x.store(), there.y.store(), there.z.store()];
        let is_there = x.is_finite().and(y.is_finite()).and(z.is_finite());
        if is_there != Mask::NONE.not() {
            // Where nothing pulls, an invalid goal changes nothing.
            let pulls = (batch.particles[k].goal + batch.recall).gt(Lane::ZERO);
            for lane in 0..LANES {
                if poses[lane].is_finite() && pulls.get(lane) && !is_there.get(lane) {
                    state.set_aside[lane].get_or_insert(Reason::Goal);
                }
            }
        }
        let now = Vec3::choose(
            T::condition(&is_there.and(has_strand)),
            there,
            styled.load(),
        );
        let acceleration = turn.map_or(Vec3::zero(), |turn| {
            let goal = goal.load::<T>();
            let all = Vec3::all(turn.x_axis).scale(goal.x)
                + Vec3::all(turn.y_axis).scale(goal.y)
                + Vec3::all(turn.z_axis).scale(goal.z);
            Vec3::choose(here, all, Vec3::zero())
        });
        let before = if known { state.goal[k].load() } else { now };
        let spring = &mut loads.springs[k];
        let stiffness = batch.particles[k].goal.load::<T>();
        spring.pull(stiffness, before, now, acceleration, GAMMA, drive.dt);
        if RECALLS {
            let way = before - state.y[k].load();
            let goal_velocity = (now - before) * (1.0 / drive.dt);
            let speed = state.v[k].load::<T>() - goal_velocity;
            let mut restless = speed.length_squared();
            let mut stirred =
                (root_velocity + goal_velocity).length_squared() + T::splat(bodies * bodies);
            if air.blows {
                let place = state.root.load::<T>() + state.y[k].load();
                let air = air.velocity(place).scale(batch.particles[k].wind.load());
                restless = restless + air.length_squared();
                stirred = stirred + air.length_squared();
            }
            let alone = state.alone[k].load::<T>();
            let stirs = stirred.sqrt() * T::splat(drive.dt / STIRS);
            let moves = speed.length_squared().sqrt();
            let counts = T::splat(drive.dt) * moves / (moves + T::splat(MOVES));
            state.alone[k] = (alone / (T::splat(1.0) + stirs) + counts).store();
            let middle = way - speed.scale(T::splat(0.5 * drive.dt));
            let recall = Recall::new(batch, [way, middle], (restless, alone), up);
            spring.pull(
                recall.stiffness,
                before + recall.lift,
                now + recall.lift,
                acceleration,
                GAMMA,
                drive.dt,
            );
            loads.grips[k] = recall.grip.store();
            state.recalled[k] = recall.share.store();
            // What comes nearer within the step is pulled by less already there: a pull that lags behind makes tips tremble.
            let (here, moved) = (state.y[k].load::<T>(), now - before);
            let of = |share: f64| (here + moved.scale(T::splat(share))).scale(recall.steepness);
            spring.add(Spring {
                stiffness: recall.steepness,
                mid: of(GAMMA),
                end: of(1.0),
                rate: T::splat(0.0),
                flow_mid: Vec3::zero(),
                flow_end: Vec3::zero(),
            });
        }
        state.goal[k] = now.store();
    }
}
