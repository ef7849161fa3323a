//! Row 5: strands in the same place, and bodies that begin inside, swallow and race.

use glam::{DQuat, DVec3};
use hair_sim::{Collider, Material, Mutual, Params, Pose, Shape, Solver, Strands, Surroundings};

use crate::{check, step, strand, style};

fn ball(center: DVec3, radius: f64) -> Shape<'static> {
    Shape::Sphere { center, radius }
}

#[test]
fn strands_in_the_same_place_move_as_one() {
    let mut rest = Strands::new();
    for s in 0..12 {
        rest.push(s, &strand(1, 20, 0.2), None).unwrap();
    }
    let (mut solver, mut state) = Solver::new(&rest, &Params::default()).unwrap();
    for i in 0..96 {
        let surroundings = Surroundings {
            gravity: DVec3::new(f64::from(i % 7) * 5.0, -9.81, 0.0),
            ..Surroundings::default()
        };
        step(&mut solver, &mut state, &surroundings, 1.0 / 24.0);
        check(&solver, &state, &rest, "coincident");
    }
    let first: Vec<DVec3> = solver.points(&state, 0).collect();
    for s in 1..12 {
        assert!(solver.points(&state, s).eq(first.iter().copied()));
    }
}

#[test]
fn strands_in_the_same_place_that_act_on_each_other_come_to_no_harm() {
    let mut rest = Strands::new();
    for s in 0..12 {
        rest.push(s, &strand(s / 4, 20, 0.2), None).unwrap();
    }
    let (mut solver, mut state) = Solver::new(&rest, &Params::default()).unwrap();
    let mutual = Mutual {
        link: 1e5,
        repulsion: 1e6,
        reach: 0.1,
        distance: 0.1,
        ..Mutual::default()
    };
    solver.interact(&mut state, &mutual).unwrap();
    let mut links = 0;
    for i in 0..96 {
        let surroundings = Surroundings {
            gravity: DVec3::new(f64::from(i % 7) * 5.0, -9.81, 0.0),
            ..Surroundings::default()
        };
        links += solver
            .step(&mut state, &surroundings, 1.0 / 24.0)
            .unwrap()
            .links;
        assert_eq!(solver.faults(&state), []);
        check(&solver, &state, &rest, "coincident, acting");
    }
    assert!(links > 1000, "{links}");
}

#[test]
fn a_body_around_the_roots() {
    for gamma in [0.1, 10.0, 1e3] {
        let rest = style(16, 20, 0.3);
        let params = Params {
            material: Material::from_gamma(gamma, 0.3),
            ..Params::default()
        };
        let (mut solver, mut state) = Solver::new(&rest, &params).unwrap();
        let colliders = [Collider::fixed(ball(DVec3::ZERO, 0.13), Pose::IDENTITY)];
        for i in 0..96 {
            let surroundings = Surroundings {
                colliders: &colliders,
                gravity: DVec3::new(f64::from(i % 7) * 5.0, -9.81, 0.0),
                ..Surroundings::default()
            };
            step(&mut solver, &mut state, &surroundings, 1.0 / 24.0);
            check(&solver, &state, &rest, "roots inside");
        }
    }
}

#[test]
fn a_body_that_swallows_the_strands_lets_them_out() {
    let rest = style(16, 20, 0.3);
    let (mut solver, mut state) = Solver::new(&rest, &Params::default()).unwrap();
    for i in 0..144 {
        // Grows from nothing to half a metre in four frames, stays, and is gone.
        let radius = match i {
            ..48 => 0.0,
            48..96 => 0.125 * f64::from((i - 47).min(4)),
            _ => 0.0,
        };
        let colliders = [Collider::fixed(
            ball(DVec3::new(0.05, 0.0, 0.0), radius),
            Pose::IDENTITY,
        )];
        let surroundings = Surroundings {
            colliders: &colliders,
            ..Surroundings::default()
        };
        step(&mut solver, &mut state, &surroundings, 1.0 / 24.0);
        check(&solver, &state, &rest, "swallowed");
    }
}

#[test]
fn a_body_at_20_m_a_second() {
    for gamma in [0.1, 10.0, 1e3] {
        let rest = style(16, 20, 0.3);
        let params = Params {
            material: Material::from_gamma(gamma, 0.3),
            ..Params::default()
        };
        let (mut solver, mut state) = Solver::new(&rest, &params).unwrap();
        let place = |i: i32| Pose {
            rotation: DQuat::IDENTITY,
            translation: DVec3::new(-5.0 + f64::from(i) * 20.0 / 24.0, -0.2, 0.0),
        };
        let (mut fallbacks, mut contacts) = (0, 0);
        for i in 0..48 {
            let colliders = [Collider {
                shape: ball(DVec3::ZERO, 0.1),
                before: place(i),
                now: place(i + 1),
                was: None,
            }];
            let surroundings = Surroundings {
                colliders: &colliders,
                ..Surroundings::default()
            };
            let stats = solver.step(&mut state, &surroundings, 1.0 / 24.0).unwrap();
            contacts += stats.contacts;
            fallbacks += stats.fallbacks;
            check(&solver, &state, &rest, "fast body");
        }
        println!(
            "gamma {gamma}: {contacts} contacts, {fallbacks} fallbacks in {} steps",
            48 * 16
        );
        assert!(contacts > 10);
        assert!(solver.faults(&state).is_empty());
    }
}
