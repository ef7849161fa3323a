//! Whatever instructions a machine has, strands move by the same bits.

use super::*;
use crate::{GRAVITY, Material, Natural, Pose, Profile, Shape, Wind};
use std::time::{Duration, Instant};

/// 72 strands on a ball, of different lengths, so that batches mix them.
fn style() -> Strands {
    let mut rest = Strands::new();
    for s in 0..72_u32 {
        let turn = s as f32 * 0.6;
        let links = 18 + s % 3;
        let points: Vec<Vec3> = (0..=links)
            .map(|i| {
                let u = i as f32 / links as f32;
                Vec3::new(turn.cos() + u, 0.3 * u * u, turn.sin() + (3.0 * u).sin()) * 0.1
            })
            .collect();
        rest.push(s, &points, None).unwrap();
    }
    rest
}

/// The state after 96 steps in which a head shakes; with everything that can act on strands, or with wind alone. And the time of
/// the shortest step.
fn shaken(params: &Params, everything: bool, instructions: Instructions) -> (State, Duration) {
    let rest = style();
    let goal = rest.points().to_vec();
    let (mut solver, mut state) = Solver::new(&rest, params).unwrap();
    solver.instructions = instructions;
    if everything {
        let mutual = Mutual {
            reach: 0.05,
            ..Mutual::default()
        };
        solver.interact(&mut state, &mutual).unwrap();
    }
    let head = |step: i32| Pose {
        // At times faster than the integrator can follow: the safe one is needed.
        rotation: DQuat::from_rotation_x(if everything {
            f64::from(step % 24)
        } else {
            0.0
        }),
        translation: DVec3::ZERO,
    };
    let (mut shortest, mut sum) = (Duration::MAX, Stats::default());
    for i in 0..96 {
        let colliders = [Collider {
            shape: Shape::Sphere {
                center: DVec3::ZERO,
                radius: 0.1,
            },
            before: head(i),
            now: head(i + 1),
            was: None,
        }];
        let surroundings = Surroundings {
            roots: Roots::Head(head(i + 1)),
            gravity: DVec3::new(f64::from(i % 5), -GRAVITY, 0.0),
            wind: Wind {
                gust: 3.0,
                ..Wind::default()
            },
            colliders: if everything { &colliders } else { &[] },
            goal: everything.then_some(&goal[..]),
            ..Surroundings::default()
        };
        let start = Instant::now();
        let stats = solver.step(&mut state, &surroundings, 1.0 / 60.0).unwrap();
        shortest = shortest.min(start.elapsed());
        sum = sum.plus(stats);
    }
    let acted = [sum.contacts, sum.links, sum.repulsions, sum.fallbacks].map(|n| n > 0);
    assert!(!everything || acted == [true; 4], "{sum:?}");
    (state, shortest)
}

/// Prints what a step takes in each as well.
#[test]
#[allow(
    clippy::print_stdout,
    reason = "it shows what vector instructions are worth"
)]
fn every_instruction_set_gives_the_same_bits() {
    let curled = Params {
        material: Material::from_gamma(30.0, 0.2),
        natural: Natural::Styled,
        ..Params::default()
    };
    let straight = Params {
        natural: Natural::Curl {
            curvature: 0.0,
            torsion: 0.0,
        },
        ..curled
    };
    for (name, params) in [("curled", curled), ("straight", straight)] {
        for everything in [false, true] {
            let params = Params {
                goal: Profile::constant(if everything { 20.0 } else { 0.0 }),
                ..params
            };
            let sets = [Instructions::Compiled, Instructions::best()];
            let states = sets.map(|instructions| {
                let (state, shortest) = shaken(&params, everything, instructions);
                let what = if everything { "everything" } else { "wind" };
                println!(
                    "{instructions:?}: {shortest:?} for a step of 72 {name} strands of 20 points in {what}"
                );
                state
            });
            assert!(states[0] == states[1], "{name}, everything: {everything}");
        }
    }
}
