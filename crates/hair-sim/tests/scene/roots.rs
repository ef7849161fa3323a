use glam::{DQuat, DVec3, Vec3};
use hair_sim::{Acceleration, GRAVITY, Params, Pose, Profile, Roots, Solver, Surroundings};

use crate::{LENGTH, farthest, params, run, shape, straight};

fn at(rotation: DQuat, translation: DVec3) -> Pose {
    Pose {
        rotation,
        translation,
    }
}

#[test]
fn an_even_acceleration_is_as_another_gravity() {
    let p = Params {
        drag: 0.0,
        damping: 0.3,
        ..params(30.0)
    };
    let rest = straight(Vec3::ZERO, Vec3::X);
    let (mut solver, start) = Solver::new(&rest, &p).unwrap();
    let push = DVec3::new(3.0, 0.0, -2.0);
    let mut still = start.clone();
    let surroundings = Surroundings {
        gravity: DVec3::new(0.0, -GRAVITY, 0.0) - push,
        ..Surroundings::default()
    };
    run(&mut solver, &mut still, &surroundings, 0.02, 2000);
    // In even steps, and in long and short ones by turns.
    for steps in [[0.02, 0.02], [0.03, 0.01]] {
        let mut moving = start.clone();
        let (mut t, mut place) = (0.0, DVec3::ZERO);
        for i in 0..2000 {
            let dt = steps[i % 2];
            t += dt;
            place = push * (0.5 * t * t);
            let surroundings = Surroundings {
                roots: Roots::Head(at(DQuat::IDENTITY, place)),
                ..Surroundings::default()
            };
            solver.step(&mut moving, &surroundings, dt).unwrap();
        }
        let moved: Vec<DVec3> = shape(&solver, &moving).iter().map(|p| *p - place).collect();
        let error = farthest(&moved, &shape(&solver, &still));
        assert!(error < 1e-6, "{steps:?}: {error}");
    }
}

#[test]
fn a_stiff_strand_turns_with_the_head() {
    let rest = straight(Vec3::new(0.1, 0.0, 0.0), Vec3::new(0.6, 0.8, 0.0));
    let (mut solver, mut state) = Solver::new(&rest, &params(1e-4)).unwrap();
    let mut rotation = DQuat::IDENTITY;
    for i in 0..48 {
        let angle = f64::from(i + 1) * 0.08;
        rotation = DQuat::from_rotation_y(angle) * DQuat::from_rotation_x(0.3 * angle);
        let surroundings = Surroundings {
            roots: Roots::Head(at(rotation, DVec3::ZERO)),
            ..Surroundings::default()
        };
        let stats = solver.step(&mut state, &surroundings, 1.0 / 24.0).unwrap();
        assert_eq!(stats.fallbacks, 0, "frame {i}");
    }
    let expected: Vec<DVec3> = (rest.strand(0).iter())
        .map(|p| rotation * p.as_dvec3())
        .collect();
    let error = farthest(&shape(&solver, &state), &expected);
    assert!(error < 1e-3, "{error}");
}

#[test]
fn a_teleport_changes_nothing_but_the_place() {
    let rest = straight(Vec3::ZERO, Vec3::X);
    let (mut solver, mut here) = Solver::new(&rest, &params(50.0)).unwrap();
    run(
        &mut solver,
        &mut here,
        &Surroundings::default(),
        1.0 / 24.0,
        5,
    );
    let mut there = here.clone();
    let pose = at(DQuat::IDENTITY, DVec3::new(100.0, -20.0, 3.0));
    solver.teleport(&mut there, Roots::Head(pose)).unwrap();
    run(
        &mut solver,
        &mut here,
        &Surroundings::default(),
        1.0 / 24.0,
        20,
    );
    let surroundings = Surroundings {
        roots: Roots::Head(pose),
        ..Surroundings::default()
    };
    run(&mut solver, &mut there, &surroundings, 1.0 / 24.0, 20);
    let moved: Vec<DVec3> = shape(&solver, &here)
        .iter()
        .map(|p| *p + pose.translation)
        .collect();
    let error = farthest(&moved, &shape(&solver, &there));
    assert!(error < 1e-12, "{error}");
}

#[test]
fn a_turned_world_is_the_same_world() {
    let rest = straight(Vec3::ZERO, Vec3::X);
    let (mut solver, mut here) = Solver::new(&rest, &params(50.0)).unwrap();
    let mut there = here.clone();
    let pose = at(
        DQuat::from_rotation_z(1.0) * DQuat::from_rotation_y(2.0),
        DVec3::ONE,
    );
    solver.teleport(&mut there, Roots::Head(pose)).unwrap();
    let turned = Surroundings {
        roots: Roots::Head(pose),
        gravity: pose.rotation * Surroundings::default().gravity,
        ..Surroundings::default()
    };
    for _ in 0..48 {
        solver
            .step(&mut here, &Surroundings::default(), 1.0 / 24.0)
            .unwrap();
        solver.step(&mut there, &turned, 1.0 / 24.0).unwrap();
    }
    let moved: Vec<DVec3> = shape(&solver, &here)
        .iter()
        .map(|p| pose.rotation * *p + pose.translation)
        .collect();
    let error = farthest(&moved, &shape(&solver, &there));
    assert!(error < 1e-9, "{error}");
}

/// The shapes of a strand on a head that turns to and fro, in steps of 1 / `rate` seconds.
fn spun(params: &Params, rate: u32, known: bool) -> Vec<DVec3> {
    let rest = straight(Vec3::new(0.1, 0.0, 0.0), Vec3::new(0.6, -0.8, 0.0));
    let (mut solver, mut state) = Solver::new(&rest, params).unwrap();
    let dt = 1.0 / f64::from(rate);
    // It starts at rest: angle and velocity grow with the square of time at first.
    let pose = |step: i32| {
        let t = (dt * f64::from(step)).max(0.0);
        let angle = 1.5 * (1.0 - (6.0 * t).cos()) * (t * t / (0.1 + t * t));
        at(
            DQuat::from_rotation_y(angle),
            DVec3::new(0.0, 0.03 * angle, 0.0),
        )
    };
    let mut shapes = Vec::new();
    for step in 0..rate as i32 {
        let ends = [step, step + 1];
        let accelerations = ends.map(|s| Acceleration::between([s - 1, s, s + 1].map(pose), dt));
        let surroundings = Surroundings {
            roots: Roots::Head(pose(step + 1)),
            acceleration: known.then_some(accelerations),
            ..Surroundings::default()
        };
        solver.step(&mut state, &surroundings, dt).unwrap();
        if (step + 1) % (rate as i32 / 24) == 0 {
            shapes.extend(shape(&solver, &state));
        }
    }
    shapes
}

/// Asserts that errors fall with the square of the step where the root's acceleration is known, and are less than where it isn't.
fn is_of_second_order(name: &str, params: &Params) {
    let truth = spun(params, 24 * 64, true);
    // Both come to the same.
    assert!(farthest(&spun(params, 24 * 64, false), &truth) < 0.02 * LENGTH);
    let error = |rate, known| {
        let shapes = spun(params, rate, known);
        let apart = shapes
            .iter()
            .zip(&truth)
            .map(|(a, b)| (*a - *b).length_squared());
        (apart.sum::<f64>() / shapes.len() as f64).sqrt() / LENGTH
    };
    let mut ratios = Vec::new();
    for rate in [24, 48, 96, 192] {
        let (measured, known) = (error(rate, false), error(rate, true));
        println!("{name}, steps of 1/{rate} s: measured {measured:.5}, known {known:.5}");
        ratios.push(measured / known);
    }
    assert!(
        ratios.iter().all(|ratio| *ratio > 1.2),
        "{name}: {ratios:?}"
    );
    let slope = (error(48, true) / error(192, true)).log2() / 2.0;
    assert!(slope > 1.5, "{name}: {slope}");
}

#[test]
fn a_known_acceleration_is_of_second_order() {
    is_of_second_order("spun", &params(20.0));
}

#[test]
fn drag_and_goals_are_of_second_order_on_a_head_that_turns() {
    let drag = Params {
        drag: 30.0,
        ..params(20.0)
    };
    is_of_second_order("in thick air", &drag);
    let goal = Params {
        goal: Profile::constant(200.0),
        ..params(20.0)
    };
    is_of_second_order("held", &goal);
}

#[test]
fn roots_may_move_one_by_one() {
    let mut rest = straight(Vec3::ZERO, Vec3::X);
    rest.push(8, &[Vec3::Z, Vec3::Z + Vec3::X * 0.1], None)
        .unwrap();
    let (mut solver, mut state) = Solver::new(&rest, &params(1.0)).unwrap();
    let poses = [Pose::IDENTITY, at(DQuat::IDENTITY, DVec3::Y)];
    let surroundings = Surroundings {
        roots: Roots::Each(&poses),
        ..Surroundings::default()
    };
    solver.step(&mut state, &surroundings, 1.0 / 24.0).unwrap();
    assert_eq!(
        solver.points(&state, 1).next().unwrap(),
        DVec3::new(0.0, 1.0, 1.0)
    );
    assert_eq!(solver.points(&state, 0).next().unwrap(), DVec3::ZERO);
    let surroundings = Surroundings {
        roots: Roots::Each(&poses[..1]),
        ..Surroundings::default()
    };
    let error = solver
        .step(&mut state, &surroundings, 1.0 / 24.0)
        .unwrap_err();
    assert_eq!(error.to_string(), "1 poses for 2 strands");
}
