use glam::{DQuat, DVec3, Vec3};
use hair_sim::{Params, Pose, Profile, Roots, Solver, Surroundings};

use crate::{after, farthest, params, shape, straight};

fn bent(amount: f32) -> Vec<Vec3> {
    // Links of the same length, turning evenly.
    let mut at = Vec3::ZERO;
    let mut points = vec![at];
    for i in 0..20 {
        let angle = amount * i as f32 / 20.0;
        at += Vec3::new(angle.cos(), angle.sin(), 0.3 * angle.sin()).normalize() * 0.01;
        points.push(at);
    }
    points
}

#[test]
fn stiff_goals_are_keyframes() {
    let p = Params {
        goal: Profile::constant(1e8),
        ..params(20.0)
    };
    let (mut solver, mut state) = Solver::new(&straight(Vec3::ZERO, Vec3::X), &p).unwrap();
    for i in 0..48 {
        let goal = bent(i as f32 * 0.05);
        let pose = Pose {
            rotation: DQuat::from_rotation_y(f64::from(i) * 0.03),
            translation: DVec3::new(0.0, 0.01 * f64::from(i), 0.0),
        };
        let surroundings = Surroundings {
            goal: Some(&goal),
            roots: Roots::Head(pose),
            ..Surroundings::default()
        };
        solver.step(&mut state, &surroundings, 1.0 / 24.0).unwrap();
        let expected: Vec<DVec3> = (goal.iter())
            .map(|p| pose.rotation * p.as_dvec3() + pose.translation)
            .collect();
        let error = farthest(&shape(&solver, &state), &expected);
        assert!(error < 2e-4, "frame {i}: {error}");
    }
    // And they leave the strand with their velocity: about 1 cm in a frame.
    let before = shape(&solver, &state);
    let p = params(20.0);
    let (mut free, _) = Solver::new(&straight(Vec3::ZERO, Vec3::X), &p).unwrap();
    let surroundings = Surroundings {
        roots: Roots::Head(Pose {
            rotation: DQuat::from_rotation_y(1.44),
            translation: DVec3::new(0.0, 0.48, 0.0),
        }),
        ..Surroundings::default()
    };
    free.step(&mut state, &surroundings, 1.0 / 24.0).unwrap();
    let moved = shape(&free, &state)[20] - before[20];
    assert!((0.005..0.05).contains(&moved.length()), "{moved}");
}

#[test]
fn where_goals_hold_the_strand_does_not_hang_on_the_step() {
    let goal = bent(1.0);
    let p = Params {
        goal: Profile {
            root: 4000.0,
            middle: 1500.0,
            tip: 300.0,
        },
        ..params(50.0)
    };
    let surroundings = Surroundings {
        goal: Some(&goal),
        ..Surroundings::default()
    };
    let [coarse, fine] = [1.0 / 24.0, 1.0 / 240.0].map(|dt: f64| {
        let steps = (40.0 / dt) as usize;
        after(&straight(Vec3::ZERO, Vec3::X), &p, &surroundings, dt, steps)
    });
    let error = farthest(&coarse, &fine);
    assert!(error < 1e-6, "{error}");
    let expected: Vec<DVec3> = goal.iter().map(|p| p.as_dvec3()).collect();
    let away = farthest(&coarse, &expected);
    assert!((1e-3..0.1).contains(&away), "{away}");
}

#[test]
fn goals_are_counted() {
    let (mut solver, mut state) =
        Solver::new(&straight(Vec3::ZERO, Vec3::X), &params(1.0)).unwrap();
    let surroundings = Surroundings {
        goal: Some(&[Vec3::ZERO]),
        ..Surroundings::default()
    };
    let error = solver.step(&mut state, &surroundings, 0.1).unwrap_err();
    assert_eq!(error.to_string(), "goals for 1 points; the strands have 21");
}
