use glam::{DQuat, DVec3, Vec3};
use hair_sim::{Pose, Roots, Solver, Surroundings};

use crate::{farthest, params, run, shape, straight};

#[test]
fn strands_at_rest_sleep_and_wake() {
    let (mut solver, mut state) =
        Solver::new(&straight(Vec3::ZERO, Vec3::X), &params(5.0)).unwrap();
    let surroundings = Surroundings::default();
    assert_eq!(
        solver
            .step(&mut state, &surroundings, 1.0 / 24.0)
            .unwrap()
            .asleep,
        0
    );
    run(&mut solver, &mut state, &surroundings, 1.0 / 24.0, 2400);
    let stats = solver.step(&mut state, &surroundings, 1.0 / 24.0).unwrap();
    assert_eq!((stats.asleep, stats.strands), (1, 0));
    let before = shape(&solver, &state);
    run(&mut solver, &mut state, &surroundings, 1.0 / 24.0, 100);
    assert_eq!(before, shape(&solver, &state));
    // Another gravity wakes it.
    let mut side = surroundings;
    side.gravity.z = 1.0;
    let stats = solver.step(&mut state, &side, 1.0 / 24.0).unwrap();
    assert_eq!((stats.asleep, stats.strands), (0, 1));
    assert!(farthest(&before, &shape(&solver, &state)) > 1e-5);
    // So does a head that turns.
    run(&mut solver, &mut state, &side, 1.0 / 24.0, 2400);
    assert_eq!(
        solver.step(&mut state, &side, 1.0 / 24.0).unwrap().asleep,
        1
    );
    let turned = Surroundings {
        roots: Roots::Head(Pose {
            rotation: DQuat::from_rotation_y(0.1),
            translation: DVec3::ZERO,
        }),
        ..side
    };
    assert_eq!(
        solver.step(&mut state, &turned, 1.0 / 24.0).unwrap().asleep,
        0
    );
    assert_eq!(
        solver.step(&mut state, &turned, 1.0 / 24.0).unwrap().asleep,
        0
    );
}
