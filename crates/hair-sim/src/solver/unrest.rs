//! Strands that jam come to rest.
//!
//! Where locks that keep out of each other are pressed together there may be no place in which all of them do. Each step holds a particle by the
//! plane that is most urgent, the next by another, and what is shoved to and fro would tremble for ever. So would strands that a tie gathers over a
//! body. A strand that others press on, or a body where anchors hold it or another is as near, and that has gone to and fro by itself for some seconds gives in: its locks part no more
//! ([`super::locks::PATIENCE`]), and it sticks where it is on the head, the faster the longer it goes on, as hair does that has felted. What swings
//! gets on, and doesn't count for some seconds. So does a strand stick that rocks on a body, turning back in every step or every second one, about a particle that
//! friction holds there, or that a ball lifts and lets fall long after all that acts came to rest. Roots, air, bodies and anchors that move make it forget.

use crate::{
    forces::springs::Spring,
    lanes::{Lane, Mask, Vec3},
};

use super::{
    batch::{Batch, BatchState},
    drive::{Drive, RootMotion, STIRS},
    load::Loads,
    locks::PATIENCE,
};

/// At this speed of a strand's fastest particle, in m/s, half of a time counts as moved.
const MOVES: f64 = 2.5e-4;

/// The drag in 1/s of what has been restless for a second more than [`PATIENCE`]. It grows with the fourth power of that time: what moves slows down within half
/// a second, and what is driven on hardly creeps after two.
const STICKS: f64 = 5e3;

/// What jams goes to and fro and gets nowhere: over so many seconds, roughly, it is no farther from where it was than this share of its way. A step in which it gets
/// on takes away so many in which it doesn't, so that what swings with a period of half a second or more never counts.
const LATE: f64 = 0.15;
const SOMEWHERE: f64 = 0.3;
const GETS_ON: f64 = 1.0;
/// What jams may creep as well: a tip that has gone no faster than this, in m/s, gets nowhere either. What swings so fast goes half a millimetre to and fro.
const CREEPS: f64 = 5e-3;
/// Where there are bodies of no figure, what is pressed by more than this, in m/s^2, has no room, or a body goes through it: it jams, however it moves.
const SQUEEZED: f64 = 1e4;
/// Whatever others still press on counts so many seconds after all that acts came to rest, and after so many over its drag: little is left of what swung, and
/// what gets on wanders about in a jam. Without drag none does, as it may swing for ever.
const LONG: f64 = 5.0;
const SWUNG: f64 = 5.0;

/// What rocks on a body turns back in each step or in each second one. A step in which it doesn't takes away this share of one in which it does, and
/// what swings with a period of more than ten steps never counts.
const GOES_ON: f64 = 0.25;

/// Takes note of for how long the strands of `active` have been restless or have rocked, and adds to the loads of a step what makes them stick.
#[inline(always)]
pub(super) fn calm_down(
    batch: &Batch,
    state: &mut BatchState,
    loads: &mut Loads,
    (drive, root): (&Drive, &RootMotion),
    active: Mask,
) {
    let turned_back = turned_back(state, active);
    let goes_nowhere = goes_nowhere(batch, state, active, drive.dt);
    // What links need to keep off a ball hangs on how they turn: that may lift a strand and let it fall for ever, from one touch to the next.
    let touches = loads.on_exact;
    let was_lifted = state.rocking.gt(Lane::ZERO).and(loads.have_exact);
    let is_lifted = has_swung(batch, state).and(touches.or(was_lifted));
    let [jams, rocks] = moved(
        batch,
        state,
        (drive, loads.between),
        [goes_nowhere, turned_back, is_lifted],
    )
    .map(|counts| active.pick(counts, Lane::ZERO));
    if [jams, rocks, state.restless, state.rocking] == [Lane::ZERO; 4] {
        return;
    }
    let stirs = stirred(batch, state, (drive, root)) * (drive.dt / STIRS);
    let left = (Lane::ONE + stirs).recip();
    let restless = (state.restless * left + jams).max(Lane::ZERO);
    state.restless = active.pick(restless, state.restless);
    let rocking = (state.rocking * left + rocks).max(Lane::ZERO);
    state.rocking = active.pick(rocking, state.rocking);
    let longest = state.restless.max(state.rocking);
    let over = (longest - Lane::splat(PATIENCE[0])).max(Lane::ZERO);
    if over.gt(Lane::ZERO).any() {
        let rate = over * over * over * over * STICKS;
        stick(batch, state, loads, (rate, root.turn_end.axes()), drive.dt);
    }
}

/// The strands whose tips went the other way in the step before than in the one before that. Takes note of where tips are.
#[inline(always)]
fn turned_back(state: &mut BatchState, active: Mask) -> Mask {
    let tip = state.y.last().copied().unwrap_or(Vec3::ZERO);
    let way = tip - state.tip_before;
    let turned_back = way.dot(state.tip_way).lt(Lane::ZERO);
    state.tip_before = Vec3::pick(active, tip, state.tip_before);
    state.tip_way = Vec3::pick(active, way, state.tip_way);
    turned_back
}

/// The strands whose tips have gone to and fro of late without getting anywhere, or still go long after all came to rest that acts. Takes note of how they go.
#[inline(always)]
fn goes_nowhere(batch: &Batch, state: &mut BatchState, active: Mask, dt: f64) -> Mask {
    let velocity = state.tip_way * (1.0 / dt);
    let share = dt / (dt + LATE);
    let drift = state.tip_drift + (velocity - state.tip_drift) * share;
    let speed = state.tip_speed + (velocity.length_squared().sqrt() - state.tip_speed) * share;
    state.tip_drift = Vec3::pick(active, drift, state.tip_drift);
    state.tip_speed = active.pick(speed, state.tip_speed);
    let least = speed * SOMEWHERE;
    let creeps = speed.lt(Lane::splat(CREEPS));
    let nowhere = drift.length_squared().lt(least * least).or(creeps);
    nowhere.or(has_swung(batch, state))
}

/// The strands that hardly swing any more, as nothing has acted for so long.
#[inline(always)]
fn has_swung(batch: &Batch, state: &BatchState) -> Mask {
    let is_late = state.calm.gt(Lane::splat(LONG));
    if !is_late.any() {
        return Mask::NONE;
    }
    let mut drag = Lane::ZERO;
    for particle in &batch.particles {
        drag = drag.max(particle.drag);
    }
    is_late.and((state.calm * drag).gt(Lane::splat(SWUNG)))
}

/// What counts of the step before, in s: as moved, where others press on strands, or a body on those that are tied or between two, and they go nowhere; and as rocked, where a
/// body presses on any, and they turn back, or as a ball lifts them. Of both, until they stick, what goes on takes away again. What is [squeezed](SQUEEZED) counts as moved.
#[inline(always)]
fn moved(
    batch: &Batch,
    state: &BatchState,
    (drive, between): (&Drive, Mask),
    [goes_nowhere, turned_back, is_lifted]: [Mask; 3],
) -> [Lane; 2] {
    let (bodies, others) = state.press.split_at(batch.count());
    let (others, second) = others.split_at(batch.planes - batch.count());
    let held_fast = Mask::new(state.tied).or(between);
    let held_fast = held_fast.pick(Lane::ONE, Lane::ZERO);
    let counts = |so_far: Lane, here: Mask, goes_on: f64| {
        let patient = so_far.lt(Lane::splat(PATIENCE[0]));
        here.pick(Lane::ONE, patient.pick(Lane::splat(-goes_on), Lane::ZERO))
    };
    let stays = counts(state.restless, goes_nowhere, GETS_ON);
    let turns = counts(state.rocking, turned_back, GOES_ON);
    let (mut held, mut rocks) = (Lane::ZERO, Lane::ZERO);
    for press in bodies.iter().chain(second) {
        let presses = press.gt(Lane::ZERO);
        held = presses.pick(held_fast * stays, held);
        rocks = presses.pick(turns, rocks);
    }
    for press in others {
        held = press.gt(Lane::ZERO).pick(stays, held);
    }
    let around = drive.surroundings;
    if around.colliders.len() > around.of_one_figure.max(1) {
        for press in bodies.iter().chain(second) {
            held = press.gt(Lane::splat(SQUEEZED)).pick(Lane::ONE, held);
        }
    }
    rocks = is_lifted.pick(Lane::ONE, rocks);
    // Goals that go through key shapes move strands themselves.
    if [held, rocks] == [Lane::ZERO; 2] || drive.surroundings.goal.is_some() {
        return [Lane::ZERO; 2];
    }
    let mut fastest = Lane::ZERO;
    for v in &state.v[..batch.count()] {
        fastest = fastest.max(v.length_squared());
    }
    let speed = fastest.sqrt();
    let share = speed * (speed + Lane::splat(MOVES)).recip();
    [held * share * drive.dt, rocks * share * drive.dt]
}

/// How fast the roots, the air at the tip, bodies and anchors that don't follow hair go, together, in m/s.
#[inline(always)]
fn stirred(batch: &Batch, state: &BatchState, (drive, root): (&Drive, &RootMotion)) -> Lane {
    let bodies = drive.speed_of_bodies();
    let mut squares = root.velocity.length_squared() + Lane::splat(bodies * bodies);
    let air = &drive.gusts[1];
    if let (true, Some(tip)) = (air.blows, state.y.last()) {
        let wind = batch.particles[batch.count() - 1].wind;
        squares += (air.velocity(state.root + *tip) * wind).length_squared();
    }
    for own in drive.anchors.iter().filter(|own| !own.anchor.follows) {
        let [before, now] = own.anchor.places;
        squares[own.lane] += before.distance_squared(now) / (drive.dt * drive.dt);
    }
    squares.sqrt()
}

/// Adds a drag of this rate, in 1/s, against a head that turns by these axes in a step.
#[inline(always)]
fn stick(
    batch: &Batch,
    state: &BatchState,
    loads: &mut Loads,
    (rate, [x, y, z]): (Lane, [Vec3; 3]),
    dt: f64,
) {
    if !loads.has_springs {
        loads.has_springs = true;
        loads.springs.fill(Spring::NONE);
    }
    for (spring, at) in loads.springs.iter_mut().zip(&state.y[..batch.count()]) {
        let turned = x * at.x + y * at.y + z * at.z;
        let flow = (turned - *at) * (rate * (1.0 / dt));
        spring.add(Spring {
            rate,
            flow_mid: flow,
            flow_end: flow,
            ..Spring::NONE
        });
    }
}

#[cfg(test)]
mod tests {
    use crate::{
        Anchor, Collider, Params, Pose, Roots, Shape, Solver, State, Strands, Surroundings, Wind,
    };
    use glam::{DQuat, DVec3, Vec3};

    /// A strand of 20 cm that hangs, and has been restless for so many seconds.
    fn hanging(restless: f64) -> (Solver, State) {
        let points: Vec<Vec3> = (0..=10).map(|i| Vec3::NEG_Y * 0.02 * i as f32).collect();
        let mut strands = Strands::new();
        strands.push(0, &points, None).unwrap();
        let (solver, mut state) = Solver::new(&strands, &Params::default()).unwrap();
        state.batches[0].restless[0] = restless;
        (solver, state)
    }

    /// Nothing acts but gravity and an anchor at the tip that pulls by nearly nothing.
    fn at_rest(anchors: &[Anchor]) -> Surroundings<'_> {
        Surroundings {
            anchors,
            ..Surroundings::default()
        }
    }

    /// An anchor at the tip that goes by this in a step, in m.
    fn anchor(way: f64) -> [Anchor; 1] {
        let tip = DVec3::NEG_Y * 0.2;
        [Anchor {
            strand: 0,
            point: 10,
            stiffness: 1e-9,
            places: [tip, tip + DVec3::X * way],
            follows: false,
        }]
    }

    /// A ball on the left, 1 mm away from the strand.
    const BALL: Collider = Collider {
        shape: round(0.05),
        before: BESIDE,
        now: BESIDE,
        was: None,
    };

    const BESIDE: Pose = Pose {
        translation: DVec3::new(-0.051, -0.1, 0.0),
        rotation: DQuat::IDENTITY,
    };

    const fn round(radius: f64) -> Shape<'static> {
        Shape::Sphere {
            center: DVec3::ZERO,
            radius,
        }
    }

    /// Steps it at 60 frames a second.
    fn step((solver, state): &mut (Solver, State), surroundings: &Surroundings) {
        solver.step(state, surroundings, 1.0 / 60.0).unwrap();
    }

    fn restless((_, state): &(Solver, State)) -> f64 {
        state.batches[0].restless[0]
    }

    /// How fast the tip still goes after a quarter of a second, of 1 m/s.
    fn speed_after(restless: f64) -> f64 {
        let mut hair = hanging(restless);
        for (k, v) in hair.1.batches[0].v.iter_mut().enumerate() {
            v.x[0] = 0.1 * (k + 1) as f64;
        }
        let anchors = anchor(0.0);
        (0..15).for_each(|_| step(&mut hair, &at_rest(&anchors)));
        hair.1.batches[0].v[9].get(0).length()
    }

    #[test]
    fn only_what_has_been_restless_for_long_sticks() {
        let [free, patient, stuck] = [0.0, 1.5, 4.0].map(speed_after);
        assert!(free > 0.01 && patient == free, "{free}, {patient}");
        assert!(stuck < 1e-3, "{stuck}");
    }

    /// For how long a strand counts as restless at the most, in so many sixtieths of a second in each of which gravity pulls it across by so much.
    fn counts(
        frames: u32,
        (colliders, anchors): (&[Collider], &[Anchor]),
        across: impl Fn(u32) -> f64,
    ) -> f64 {
        let mut hair = hanging(0.0);
        let mut longest = 0.0_f64;
        for frame in 0..frames {
            let surroundings = Surroundings {
                // Towards the ball.
                gravity: DVec3::new(-5.0, -8.0, across(frame)),
                colliders,
                ..at_rest(anchors)
            };
            step(&mut hair, &surroundings);
            longest = longest.max(restless(&hair));
        }
        longest
    }

    /// What is tied and trembles on a body counts, and nothing that is free of either.
    #[test]
    fn a_tied_strand_is_restless_where_it_trembles_on_a_body() {
        let (ball, anchors) = ([BALL], anchor(0.0));
        let to_and_fro = |frame| if frame % 2 == 0 { 20.0 } else { -20.0 };
        let trembles = counts(180, (&ball, &anchors), to_and_fro);
        assert!(trembles > 1.0, "{trembles}");
        assert_eq!(counts(180, (&ball, &[]), to_and_fro), 0.0);
        assert_eq!(counts(180, (&[], &anchors), to_and_fro), 0.0);
    }

    /// A tied strand that swings along a body gets on for most of the time, until it is hardly seen to move.
    #[test]
    fn a_tied_strand_that_swings_is_hardly_restless() {
        let swings = |frame: u32| if frame < 6 { 8.0 } else { 0.0 };
        // Its tip is slower than 5 mm/s then.
        let swings = counts(150, (&[BALL], &anchor(0.0)), swings);
        assert!(swings < 0.8, "{swings}");
    }

    /// What swings along a body turns back twice in a period, and goes on for all of the time between.
    #[test]
    fn what_swings_on_a_body_does_not_rock() {
        let mut hair = hanging(0.0);
        for (k, v) in hair.1.batches[0].v.iter_mut().enumerate() {
            v.z[0] = 0.1 * (k + 1) as f64;
        }
        let surroundings = Surroundings {
            gravity: DVec3::new(-5.0, -8.0, 0.0),
            colliders: &[BALL],
            ..Surroundings::default()
        };
        let (mut turns, mut longest) = (0, 0.0_f64);
        for _ in 0..180 {
            let before = hair.1.batches[0].tip_way.get(0);
            step(&mut hair, &surroundings);
            let state = &hair.1.batches[0];
            turns += usize::from(state.tip_way.get(0).dot(before) < 0.0);
            longest = longest.max(state.rocking[0]);
        }
        assert!(turns >= 4, "{turns}");
        assert!(longest < 2.5 / 60.0, "{longest}");
    }

    /// A way of 0.1 m in a second, of whatever acts, leaves less than a half of the time, also where a body turns about its middle or changes its shape.
    #[test]
    fn what_moves_makes_it_forget() {
        fn left<'a>(surroundings: impl Fn(f64) -> Surroundings<'a>) -> f64 {
            let mut hair = hanging(6.0);
            (1..=60).for_each(|frame| step(&mut hair, &surroundings(f64::from(frame))));
            restless(&hair) / 6.0
        }
        let way = 0.1 / 60.0;
        let (still, moved) = (anchor(0.0), anchor(way));
        let goes = Collider {
            now: Pose {
                translation: BESIDE.translation + DVec3::Y * way,
                ..BESIDE
            },
            ..BALL
        };
        let turns = Collider {
            now: Pose {
                rotation: DQuat::from_rotation_y(way / 0.05),
                ..BESIDE
            },
            ..BALL
        };
        let grows = Collider {
            was: Some(round(0.05 - way)),
            ..BALL
        };
        let rests = left(|_| at_rest(&still));
        let by_head = left(|frame| Surroundings {
            roots: Roots::Head(Pose {
                translation: DVec3::X * way * frame,
                rotation: DQuat::IDENTITY,
            }),
            ..at_rest(&still)
        });
        let by_air = left(|_| Surroundings {
            wind: Wind {
                steady: DVec3::X * 0.1,
                ..Wind::default()
            },
            ..at_rest(&still)
        });
        let by_anchor = left(|_| at_rest(&moved));
        let follows = moved.map(|own| Anchor {
            follows: true,
            ..own
        });
        let by_tie = left(|_| at_rest(&follows));
        let [by_body, by_turn, by_growth] = [[goes], [turns], [grows]].map(|bodies| {
            left(|_| Surroundings {
                colliders: &bodies,
                ..at_rest(&still)
            })
        });
        for left in [rests, by_tie] {
            assert!((left - 1.0).abs() < 1e-9, "{left}");
        }
        for left in [by_head, by_air, by_anchor, by_body, by_turn, by_growth] {
            assert!((0.36..0.5).contains(&left), "{left}");
        }
    }
}
