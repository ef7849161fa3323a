//! Row 8: no energy from nowhere, however hard a strand was driven before.

use glam::{DQuat, DVec3, Vec3};
use hair_sim::{
    Collider, GRAVITY, Material, Mutual, Natural, Params, Pose, Roots, Shape, Solver, Strands,
    Surroundings,
};

use crate::{check, step, strand};

/// Strands of one to twelve links.
fn short(count: u32) -> Strands {
    let mut strands = Strands::new();
    for s in 0..count {
        strands
            .push(s, &strand(s, 1 + s as usize % 12, 0.2), None)
            .unwrap();
    }
    strands
}

/// Lets strands come to rest from `state` on, in steps of very different lengths. Panics where the energy of one rises above the
/// least that it had, by more than a thousandth of what it then has and what lifts it by its length. Returns what is left at
/// the end of the energy of bending, twisting and motion, of the worst.
fn rests(
    solver: &mut Solver,
    mut state: hair_sim::State,
    rest: &Strands,
    head: Pose,
    what: &str,
) -> f64 {
    let surroundings = Surroundings {
        roots: Roots::Head(head),
        ..Surroundings::default()
    };
    // A root that stops is braked in the step after.
    for dt in [0.005, 0.005] {
        step(solver, &mut state, &surroundings, dt);
    }
    let energy =
        |state: &_, solver: &Solver, s: usize| solver.energy(state, s, surroundings.gravity);
    let mut least: Vec<(f64, f64)> = vec![(f64::INFINITY, 0.0); rest.len()];
    for i in 0..48 {
        for (s, least) in least.iter_mut().enumerate() {
            let length: f32 = rest.strand(s).windows(2).map(|w| w[0].distance(w[1])).sum();
            let now = energy(&state, solver, s);
            let own = solver.energy(&state, s, DVec3::ZERO);
            let limit = least.0 + 1e-3 * least.1;
            assert!(
                now <= limit,
                "{what}, strand {s}, step {i}: {now} above {limit}"
            );
            if now < least.0 {
                *least = (now, own + GRAVITY * f64::from(length * length));
            }
        }
        step(
            solver,
            &mut state,
            &surroundings,
            [0.005, 0.09, 0.04, 0.85, 0.02][i % 5],
        );
        check(solver, &state, rest, what);
    }
    (0..rest.len())
        .map(|s| solver.energy(&state, s, DVec3::ZERO))
        .fold(0.0, f64::max)
}

#[test]
fn strands_that_are_driven_no_more_gain_no_energy() {
    let rest = short(24);
    let spun = |i: usize| Pose {
        rotation: DQuat::from_axis_angle(DVec3::new(0.6, 0.0, 0.8), 2.1 * i as f64),
        translation: DVec3::ZERO,
    };
    for gamma in [1.0, 100.0, 1e4] {
        for (damping, drag) in [(0.0, 0.0), (0.1, 0.0), (2.0, 1e3), (0.005, 1e4)] {
            let params = Params {
                material: Material::from_gamma(gamma, 0.2),
                damping,
                drag,
                ..Params::default()
            };
            let what = format!("gamma {gamma}, damping {damping}, drag {drag}");
            let (mut solver, mut state) = Solver::new(&rest, &params).unwrap();
            for i in 0..12 {
                let ball = Shape::Sphere {
                    center: DVec3::new(0.1 * i as f64 - 0.6, 0.0, 0.1),
                    radius: 0.1,
                };
                let surroundings = Surroundings {
                    roots: Roots::Head(spun(i)),
                    colliders: &[Collider::fixed(ball, Pose::IDENTITY)],
                    ..Surroundings::default()
                };
                step(&mut solver, &mut state, &surroundings, 1.0 / 24.0);
            }
            rests(&mut solver, state, &rest, spun(11), &what);
        }
    }
}

/// A joint's turn, 2 tan(angle / 2), has no bound at half a turn: there a small error of the angle is a large one of the
/// turn. Links that stand on a soft root are pulled over by a hundred times the weight, and must come to rest so.
#[test]
fn a_joint_near_half_a_turn_comes_to_rest() {
    let mut rest = Strands::new();
    for (s, links) in [1, 2, 3].into_iter().enumerate() {
        let points: Vec<Vec3> = (0..=links)
            .map(|i| Vec3::new(0.1, 1.0, 0.05 * i as f32) * (0.012 * i as f32 / links as f32))
            .collect();
        rest.push(s as u32, &points, None).unwrap();
    }
    for gamma in [1e3, 1e4, 1e5] {
        let params = Params {
            material: Material::from_gamma(gamma, 0.012),
            drag: 0.0,
            ..Params::default()
        };
        let (mut solver, mut state) = Solver::new(&rest, &params).unwrap();
        let surroundings = Surroundings {
            gravity: DVec3::NEG_Y * (100.0 * GRAVITY),
            ..Surroundings::default()
        };
        let energies = |solver: &Solver, state: &_| -> Vec<f64> {
            (0..3)
                .map(|s| solver.energy(state, s, surroundings.gravity))
                .collect()
        };
        for _ in 0..480 {
            step(&mut solver, &mut state, &surroundings, 1.0 / 24.0);
        }
        let before = energies(&solver, &state);
        for dt in [0.01, 0.99, 0.005, 0.2, 0.99, 0.01] {
            step(&mut solver, &mut state, &surroundings, dt);
            let after = energies(&solver, &state);
            for (s, (before, after)) in before.iter().zip(&after).enumerate() {
                let change = (before - after).abs();
                // What lifts a strand by its length is 0.14.
                assert!(change < 1e-6, "gamma {gamma}, strand {s}: {change}");
            }
        }
    }
}

/// Of a strand that partners could act on but don't, its energy is looked after, too: steps of a frame would make some of it.
#[test]
fn a_strand_whose_partners_do_not_act_gains_no_energy() {
    let shapes = [(0.3, -2.0), (1.0, 1.0), (1.6, 0.0), (2.5, 3.0)];
    for ((start, bend), rate) in shapes
        .into_iter()
        .flat_map(|shape| [(shape, 60.0), (shape, 120.0)])
    {
        let mut rest = Strands::new();
        for (id, beside) in [(0, 0.0), (1, 5.0)] {
            let mut points = vec![beside * Vec3::X];
            for k in 0..20 {
                let angle = start + bend * k as f32 / 20.0;
                let along = Vec3::new(angle.sin(), -angle.cos(), 0.3 * (1.3 * angle).sin());
                points.push(points[k] + 0.0125 * along.normalize());
            }
            rest.push(id, &points, None).unwrap();
        }
        let params = Params {
            material: Material::from_gamma(1000.0, 0.25),
            natural: Natural::Styled,
            damping: 0.0,
            drag: 0.0,
            ..Params::default()
        };
        let (mut solver, mut state) = Solver::new(&rest, &params).unwrap();
        solver.interact(&mut state, &Mutual::default()).unwrap();
        let surroundings = Surroundings::default();
        // Over that of a strand that hangs straight.
        let energy = |solver: &Solver, state: &_| {
            solver.energy(state, 0, surroundings.gravity) + 0.5 * GRAVITY * 0.25 * 0.25
        };
        let first = energy(&solver, &state);
        for i in 0..20 * rate as u32 {
            step(&mut solver, &mut state, &surroundings, 1.0 / rate);
            let now = energy(&solver, &state);
            assert!(
                now < 1.02 * first,
                "{start}, {bend}, step {i} of 1/{rate} s: {now} of {first}"
            );
        }
    }
}
