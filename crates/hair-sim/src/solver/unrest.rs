//! Strands that jam come to rest.
//!
//! Where locks that keep out of each other are pressed together there may be no place in which all of them do. Each step holds a particle by the
//! plane that is most urgent, the next by another, and what is shoved to and fro would tremble for ever. So would strands that a tie gathers over a
//! body. A strand that others press on, or a body where anchors hold it, and that has moved by itself for some seconds gives in: its locks part no more
//! ([`super::locks::PATIENCE`]), and it sticks where it is on the head, the faster the longer it goes on, as hair does that has felted. What swings out
//! has come to rest before that. Roots, air, bodies and anchors that move make it forget.

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
const MOVES: f64 = 1e-3;

/// The drag in 1/s of what has been restless for a second more than [`PATIENCE`]. It grows with the fourth power of that time: what moves slows down within half
/// a second, and what is driven on hardly creeps after two.
const STICKS: f64 = 5e3;

/// Takes note of for how long the strands of `active` have been restless, and adds to the loads of a step what makes them stick.
#[inline(always)]
pub(super) fn calm_down(
    batch: &Batch,
    state: &mut BatchState,
    loads: &mut Loads,
    (drive, root): (&Drive, &RootMotion),
    active: Mask,
) {
    let counts = active.pick(moved(batch, state, drive), Lane::ZERO);
    if counts == Lane::ZERO && state.restless == Lane::ZERO {
        return;
    }
    let stirs = stirred(batch, state, (drive, root)) * (drive.dt / STIRS);
    let restless = state.restless * (Lane::ONE + stirs).recip() + counts;
    state.restless = active.pick(restless, state.restless);
    let over = (state.restless - Lane::splat(PATIENCE[0])).max(Lane::ZERO);
    if over.gt(Lane::ZERO).any() {
        let rate = over * over * over * over * STICKS;
        stick(batch, state, loads, (rate, root.turn_end.axes()), drive.dt);
    }
}

/// What counts of the step before as moved, in s, where others press on strands, or a body on those that are tied.
#[inline(always)]
fn moved(batch: &Batch, state: &BatchState, drive: &Drive) -> Lane {
    let (bodies, others) = state.press.split_at(batch.count());
    let mut tied = Lane::ZERO;
    for own in drive.anchors {
        tied[own.lane] = 1.0;
    }
    let mut held = Lane::ZERO;
    for press in bodies {
        held = press.gt(Lane::ZERO).pick(tied, held);
    }
    for press in others {
        held = press.gt(Lane::ZERO).pick(Lane::ONE, held);
    }
    // Goals that go through key shapes move strands themselves.
    if held == Lane::ZERO || drive.surroundings.goal.is_some() {
        return Lane::ZERO;
    }
    let mut fastest = Lane::ZERO;
    for v in &state.v[..batch.count()] {
        fastest = fastest.max(v.length_squared());
    }
    let speed = fastest.sqrt();
    held * speed * (speed + Lane::splat(MOVES)).recip() * drive.dt
}

/// How fast the roots, the air at the tip, bodies and anchors go, together, in m/s.
#[inline(always)]
fn stirred(batch: &Batch, state: &BatchState, (drive, root): (&Drive, &RootMotion)) -> Lane {
    let bodies = drive.speed_of_bodies();
    let mut squares = root.velocity.length_squared() + Lane::splat(bodies * bodies);
    let air = &drive.gusts[1];
    if let (true, Some(tip)) = (air.blows, state.y.last()) {
        let wind = batch.particles[batch.count() - 1].wind;
        squares += (air.velocity(state.root + *tip) * wind).length_squared();
    }
    for own in drive.anchors {
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
    use crate::{Anchor, Params, Pose, Roots, Solver, State, Strands, Surroundings};
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

    /// Steps it at 60 frames a second with the head here, and its tip held where it is, by nearly nothing.
    fn step((solver, state): &mut (Solver, State), head: Pose) {
        let tip = DVec3::NEG_Y * 0.2;
        let anchors = [Anchor {
            strand: 0,
            point: 10,
            stiffness: 1e-9,
            places: [tip; 2],
        }];
        let surroundings = Surroundings {
            roots: Roots::Head(head),
            anchors: &anchors,
            ..Surroundings::default()
        };
        solver.step(state, &surroundings, 1.0 / 60.0).unwrap();
    }

    /// How fast the tip still goes after a quarter of a second, of 1 m/s.
    fn speed_after(restless: f64) -> f64 {
        let mut hair = hanging(restless);
        for (k, v) in hair.1.batches[0].v.iter_mut().enumerate() {
            v.x[0] = 0.1 * (k + 1) as f64;
        }
        (0..15).for_each(|_| step(&mut hair, Pose::IDENTITY));
        hair.1.batches[0].v[9].get(0).length()
    }

    #[test]
    fn only_what_has_been_restless_for_long_sticks() {
        let [free, patient, stuck] = [0.0, 1.5, 4.0].map(speed_after);
        assert!(free > 0.01 && patient == free, "{free}, {patient}");
        assert!(stuck < 1e-3, "{stuck}");
    }

    #[test]
    fn a_head_that_moves_makes_it_forget() {
        let mut hair = hanging(6.0);
        // There and back by 0.1 m, and round by a third of a turn.
        for frame in 1..=24_i32 {
            let way = f64::from(12 - (frame - 12).abs()) * 0.1 / 12.0;
            let head = Pose {
                rotation: DQuat::from_rotation_y(0.1 * f64::from(frame)),
                translation: DVec3::X * way,
            };
            step(&mut hair, head);
        }
        let restless = hair.1.batches[0].restless[0];
        assert!(restless > 0.5 && restless < 2.0, "{restless}");
        let mut still = hanging(6.0);
        (0..24).for_each(|_| step(&mut still, Pose::IDENTITY));
        let rests = still.1.batches[0].restless[0];
        assert!((rests - 6.0).abs() < 1e-9, "{rests}");
    }
}
