//! What a solver refuses, and that it changes nothing then.

use glam::{DQuat, DVec3, Vec3};
use hair_sim::{
    Collider, DynamicsError, Flow, Mutual, Params, Pose, Shape, Solver, State, Strands, Stream,
    Surroundings,
};

use crate::line;

/// A body whose rotation isn't a unit quaternion is refused, as a head is.
#[test]
fn a_body_has_a_rotation() {
    let mut rest = Strands::new();
    rest.push(0, &line(Vec3::Y, 4, 0.2), None).unwrap();
    let (mut solver, mut state) = Solver::new(&rest, &Params::default()).unwrap();
    for w in [0.0, 0.9, 1.1, 2.0] {
        let pose = Pose {
            rotation: DQuat::from_xyzw(0.0, 0.0, 0.0, w),
            translation: DVec3::ZERO,
        };
        let ball = Shape::Sphere {
            center: DVec3::X,
            radius: 0.1,
        };
        let colliders = &[Collider::fixed(ball, pose)];
        let surroundings = Surroundings {
            colliders,
            ..Default::default()
        };
        assert!(
            solver.step(&mut state, &surroundings, 0.01).is_err(),
            "|q| = {w} is taken"
        );
    }
}

/// What is refused changes nothing.
#[test]
fn an_interaction_that_is_refused_leaves_the_one_before() {
    let mut rest = Strands::new();
    for i in 0..2 {
        rest.push(i, &line(Vec3::X * 0.005 * i as f32, 12, 0.25), None)
            .unwrap();
    }
    let (mut solver, mut state) = Solver::new(&rest, &Params::default()).unwrap();
    solver.interact(&mut state, &Mutual::default()).unwrap();
    let before = solver
        .step(&mut state, &Surroundings::default(), 0.01)
        .unwrap()
        .links;
    let bad = Mutual {
        link: -1.0,
        ..Mutual::default()
    };
    assert!(solver.interact(&mut state, &bad).is_err());
    let after = solver
        .step(&mut state, &Surroundings::default(), 0.01)
        .unwrap()
        .links;
    assert_eq!(before, after);
}

/// Where strands meet their ids decide, not their order.
#[test]
fn strands_that_act_on_each_other_have_ids_of_their_own() {
    let mut rest = Strands::new();
    for (id, x) in [(3, 0.0), (5, 0.01), (3, 0.02)] {
        rest.push(id, &line(Vec3::X * x, 8, 0.2), None).unwrap();
    }
    let locks = Params {
        lock_radius: 0.004,
        ..Params::default()
    };
    assert_eq!(
        Solver::new(&rest, &locks).err(),
        Some(DynamicsError::SameId(3))
    );
    let (mut solver, mut state) = Solver::new(&rest, &Params::default()).unwrap();
    let refused = solver.interact(&mut state, &Mutual::default());
    assert_eq!(refused, Err(DynamicsError::SameId(3)));
}

#[test]
fn strands_settle_in_a_state_of_their_own_among_bodies_that_are_valid() {
    let of = |links| {
        let mut rest = Strands::new();
        rest.push(0, &line(Vec3::Y, links, 0.2), None).unwrap();
        Solver::new(&rest, &Params::default()).unwrap()
    };
    let ((solver, mut own), (_, mut other)) = (of(12), of(3));
    let ball = |radius| {
        let center = DVec3::ZERO;
        [Collider::fixed(
            Shape::Sphere { center, radius },
            Pose::IDENTITY,
        )]
    };
    let before: State = own.clone();
    assert_eq!(
        solver.settle(&mut other, &ball(0.1), 0),
        Err(DynamicsError::State)
    );
    assert!(solver.settle(&mut own, &ball(f64::NAN), 0).is_err());
    assert_eq!(own, before);
    solver.settle(&mut own, &ball(0.1), 0).unwrap();
    assert_ne!(own, before);
}

#[test]
fn a_stream_has_an_axis_of_length_1() {
    let mut rest = Strands::new();
    rest.push(0, &line(Vec3::Y, 4, 0.2), None).unwrap();
    let (mut solver, mut state) = Solver::new(&rest, &Params::default()).unwrap();
    let mut step = |axis: DVec3| {
        let vortex = Stream {
            flow: Flow::Vortex { radius: 0.1 },
            speed: [1.0; 2],
            center: [DVec3::ZERO; 2],
            axis,
        };
        let surroundings = Surroundings {
            streams: &[vortex],
            ..Surroundings::default()
        };
        solver.step(&mut state, &surroundings, 0.01).is_ok()
    };
    let taken = [DVec3::Y, DVec3::Y * 10.0, DVec3::ZERO].map(&mut step);
    assert_eq!(taken, [true, false, false]);
}
