//! Rows 4 and 7: invalid strands, and numbers that are not finite.

use glam::{DQuat, DVec3, Vec3};
use hair_sim::{
    Collider, DynamicsError, Mutual, Params, Pose, Profile, Reason, Roots, Shape, Solver, State,
    Strands, Surroundings, Wind,
};

use crate::{check, strand, style};

#[test]
fn broken_segments_are_repaired_or_named() {
    let doubled = |i: usize| {
        let mut points = strand(1, 10, 0.2);
        points[i] = points[i - 1];
        points
    };
    let mut rest = Strands::new();
    rest.push(10, &doubled(1), None).unwrap();
    rest.push(11, &doubled(5), None).unwrap();
    rest.push(12, &doubled(10), None).unwrap();
    let mut tripled = strand(1, 10, 0.2);
    (tripled[4], tripled[5], tripled[6]) = (tripled[3], tripled[3], tripled[3]);
    rest.push(13, &tripled, None).unwrap();
    let mut folded = strand(1, 10, 0.2);
    folded[6] = folded[4];
    rest.push(14, &folded, None).unwrap();
    rest.push(15, &[Vec3::ONE; 7], None).unwrap();
    let (mut solver, mut state) = Solver::new(&rest, &Params::default()).unwrap();
    let named: Vec<(u32, Reason)> = (solver.faults(&state).iter())
        .map(|f| (f.id, f.reason))
        .collect();
    assert_eq!(named, [(14, Reason::Folded(5)), (15, Reason::NoLength)]);
    assert_eq!(
        solver.faults(&state)[0].to_string(),
        "strand 14 is set aside: it folds back on itself at point 5"
    );
    for i in 0..96 {
        let surroundings = Surroundings {
            gravity: DVec3::new(f64::from(i % 7) * 5.0, -9.81, 0.0),
            roots: Roots::Head(Pose {
                rotation: DQuat::from_rotation_y(f64::from(i) * 0.1),
                translation: DVec3::ZERO,
            }),
            ..Surroundings::default()
        };
        let stats = solver.step(&mut state, &surroundings, 1.0 / 24.0).unwrap();
        assert_eq!(stats.set_aside, 2);
        check(&solver, &state, &rest, "segments");
    }
}

/// All strands but `without`, to the bit.
fn bits(solver: &Solver, state: &State, without: usize) -> Vec<[u64; 3]> {
    (0..solver.len())
        .filter(|&s| s != without)
        .flat_map(|s| solver.points(state, s))
        .map(|p| [p.x.to_bits(), p.y.to_bits(), p.z.to_bits()])
        .collect()
}

#[test]
fn a_rest_shape_without_numbers_is_named_and_disturbs_no_other() {
    let good = style(20, 15, 0.2);
    let mut bad = good.clone();
    let range = bad.point_range(6);
    bad.points_mut()[range.start + 3].y = f32::NAN;
    let run = |rest: &Strands| {
        let (mut solver, mut state) = Solver::new(rest, &Params::default()).unwrap();
        let surroundings = Surroundings {
            gravity: DVec3::new(3.0, -9.81, 0.0),
            ..Surroundings::default()
        };
        for _ in 0..48 {
            solver.step(&mut state, &surroundings, 1.0 / 24.0).unwrap();
        }
        (bits(&solver, &state, 6), solver.faults(&state))
    };
    let ((good, none), (bad, one)) = (run(&good), run(&bad));
    assert_eq!(none, []);
    assert_eq!(
        one[0].to_string(),
        "strand 6 is set aside: point 3 at rest is not finite"
    );
    assert_eq!(good, bad);
}

#[test]
fn strands_that_act_on_a_broken_one_come_to_no_harm() {
    let mut rest = style(20, 15, 0.2);
    let range = rest.point_range(6);
    rest.points_mut()[range.start + 3].y = f32::INFINITY;
    let (mut solver, mut state) = Solver::new(&rest, &Params::default()).unwrap();
    let mutual = Mutual {
        reach: 0.5,
        distance: 0.05,
        ..Mutual::default()
    };
    solver.interact(&mut state, &mutual).unwrap();
    for i in 0..48 {
        let mut poses = [Pose::IDENTITY; 20];
        if i > 10 {
            poses[9].rotation = DQuat::from_xyzw(0.0, f64::NAN, 0.0, 1.0);
            poses[12].rotation = DQuat::from_xyzw(0.0, 0.0, 0.0, 0.0);
        }
        let surroundings = Surroundings {
            roots: Roots::Each(&poses),
            gravity: DVec3::new(3.0, -9.81, 0.0),
            ..Surroundings::default()
        };
        let stats = solver.step(&mut state, &surroundings, 1.0 / 24.0).unwrap();
        assert!(stats.links > 0);
        for s in 0..20 {
            assert!(solver.points(&state, s).all(|p| p.is_finite()), "{s}");
        }
    }
    let named: Vec<(u32, Reason)> = (solver.faults(&state).iter())
        .map(|f| (f.id, f.reason))
        .collect();
    assert_eq!(
        named,
        [(6, Reason::Rest(3)), (9, Reason::Root), (12, Reason::Root)]
    );
}

#[test]
fn what_holds_for_one_strand_is_not_asked_of_its_neighbours() {
    // A goal is broken that pulls on nothing; the strands beside it do have goals.
    let rest = style(8, 10, 0.2);
    let params = |s| Params {
        goal: Profile::constant(if s == 3 { 0.0 } else { 5.0 }),
        ..Params::default()
    };
    let (mut solver, mut state) = Solver::with(&rest, params).unwrap();
    let mut goals = rest.points().to_vec();
    goals[rest.point_range(3).start + 2].z = f32::NAN;
    let surroundings = Surroundings {
        goal: Some(&goals),
        ..Surroundings::default()
    };
    solver.step(&mut state, &surroundings, 1.0 / 24.0).unwrap();
    assert_eq!(solver.faults(&state), []);
    // A strand of one point alone follows its root.
    let mut rest = Strands::new();
    rest.push(4, &[Vec3::X], None).unwrap();
    let (mut solver, mut state) = Solver::new(&rest, &Params::default()).unwrap();
    let surroundings = Surroundings {
        roots: Roots::Head(Pose {
            rotation: DQuat::IDENTITY,
            translation: DVec3::Y,
        }),
        ..Surroundings::default()
    };
    solver.step(&mut state, &surroundings, 1.0 / 24.0).unwrap();
    assert_eq!(
        solver.points(&state, 0).next(),
        Some(DVec3::new(1.0, 1.0, 0.0))
    );
}

#[test]
fn a_root_or_goal_without_numbers_is_named_and_disturbs_no_other() {
    let rest = style(20, 15, 0.2);
    let params = Params {
        goal: Profile::constant(5.0),
        ..Params::default()
    };
    let run = |root: f64, goal: f32| {
        let (mut solver, mut state) = Solver::new(&rest, &params).unwrap();
        for i in 0..48 {
            let mut poses = [Pose::IDENTITY; 20];
            let mut goals = rest.points().to_vec();
            if i == 10 {
                poses[6].translation.x = root;
                goals[rest.point_range(6).start + 2].z = goal;
            }
            let surroundings = Surroundings {
                roots: Roots::Each(&poses),
                goal: Some(&goals),
                gravity: DVec3::new(3.0, -9.81, 0.0),
                ..Surroundings::default()
            };
            solver.step(&mut state, &surroundings, 1.0 / 24.0).unwrap();
        }
        check(&solver, &state, &rest, "others");
        let reasons: Vec<Reason> = solver.faults(&state).iter().map(|f| f.reason).collect();
        (bits(&solver, &state, 6), reasons)
    };
    let whole = run(0.0, 0.0).0;
    assert_eq!(run(f64::NAN, 0.0), (whole.clone(), vec![Reason::Root]));
    assert_eq!(run(f64::INFINITY, 0.0), (whole.clone(), vec![Reason::Root]));
    assert_eq!(run(0.0, f32::NAN), (whole, vec![Reason::Goal]));
}

#[test]
fn a_scene_without_numbers_is_refused_and_changes_nothing() {
    let rest = style(3, 5, 0.2);
    let (mut solver, mut state) = Solver::new(&rest, &Params::default()).unwrap();
    let before = state.clone();
    let nan = DVec3::splat(f64::NAN);
    let head = |rotation, translation| Surroundings {
        roots: Roots::Head(Pose {
            rotation,
            translation,
        }),
        ..Surroundings::default()
    };
    let ball = [Collider::fixed(
        Shape::Sphere {
            center: nan,
            radius: 1.0,
        },
        Pose::IDENTITY,
    )];
    let scenes = [
        (
            Surroundings {
                gravity: nan,
                ..Surroundings::default()
            },
            "gravity",
        ),
        (
            Surroundings {
                wind: Wind {
                    steady: nan,
                    ..Wind::default()
                },
                ..Surroundings::default()
            },
            "wind",
        ),
        (head(DQuat::IDENTITY, nan), "head"),
        (
            head(DQuat::from_xyzw(0.0, 0.0, 0.0, 2.0), DVec3::ZERO),
            "head",
        ),
        (
            Surroundings {
                colliders: &ball,
                ..Surroundings::default()
            },
            "collider",
        ),
    ];
    for (surroundings, name) in scenes {
        let error = solver.step(&mut state, &surroundings, 0.1).unwrap_err();
        assert_eq!(error, DynamicsError::Surroundings(name));
    }
    for dt in [0.0, 1e-20, -1.0, f64::NAN, f64::INFINITY] {
        let error = solver
            .step(&mut state, &Surroundings::default(), dt)
            .unwrap_err();
        assert!(matches!(error, DynamicsError::Step(_)));
    }
    assert_eq!(state, before);
    let bad = Params {
        drag: -1.0,
        ..Params::default()
    };
    let error = Solver::new(&rest, &bad).unwrap_err().to_string();
    assert_eq!(error, "strand 0: drag is -1, and must be from 0 to 10000");
    let (_, mut other) = Solver::new(&style(2, 6, 0.2), &Params::default()).unwrap();
    let error = solver
        .step(&mut other, &Surroundings::default(), 0.1)
        .unwrap_err();
    assert_eq!(error, DynamicsError::State);
}

/// Through text and back.
fn restored(state: &State) -> State {
    serde_json::from_str(&serde_json::to_string(state).unwrap()).unwrap()
}

#[test]
fn a_state_can_be_saved_whatever_is_set_aside() {
    // No drag and no damping, so that the energies of the strands are in the state; of a folded one it is NaN.
    let params = Params {
        drag: 0.0,
        damping: 0.0,
        ..Params::default()
    };
    let mut rest = style(7, 10, 0.2);
    let at = |s: usize| s * 11;
    let points = rest.points_mut();
    points[at(0) + 6] = points[at(0) + 4];
    points[at(1)..at(2)].fill(Vec3::ONE);
    points[at(2) + 3].x = f32::NAN;
    points[at(3)].y = f32::INFINITY;
    let (mut solver, mut state) = Solver::with(&rest, |_| params).unwrap();
    let turned = Roots::Head(Pose {
        rotation: DQuat::from_rotation_y(0.7),
        translation: DVec3::ONE,
    });
    solver.teleport(&mut state, turned).unwrap();
    assert_eq!(restored(&state), state, "before the first step");
    let mut poses = [Pose::IDENTITY; 7];
    for i in 0..10 {
        poses[4].translation.x = if i == 3 { f64::NAN } else { 0.0 };
        let surroundings = Surroundings {
            roots: Roots::Each(&poses),
            gravity: DVec3::new(3.0, -9.81, f64::from(i / 4)),
            ..Surroundings::default()
        };
        if i == 6 {
            poses[5].rotation = DQuat::from_xyzw(0.0, f64::NAN, 0.0, 1.0);
            solver.teleport(&mut state, Roots::Each(&poses)).unwrap();
            poses[5] = Pose::IDENTITY;
            assert_eq!(restored(&state), state, "after a teleport");
            continue;
        }
        solver.step(&mut state, &surroundings, 1.0 / 24.0).unwrap();
        assert_eq!(restored(&state), state, "step {i}");
    }
    let named: Vec<u32> = solver.faults(&state).iter().map(|f| f.id).collect();
    assert_eq!(named, [0, 1, 2, 3, 4, 5]);
}

#[test]
fn a_state_whose_lists_are_too_short_is_refused() {
    let rest = style(3, 10, 0.2);
    let (mut solver, state) = Solver::new(&rest, &Params::default()).unwrap();
    let whole = serde_json::to_value(&state).unwrap();
    for list in [
        "y", "v", "a", "past", "skin", "press", "creep", "quiet_at", "frames",
    ] {
        let mut saved = whole.clone();
        let numbers = saved["batches"][0][list].as_array_mut().unwrap();
        if numbers.pop().is_none() {
            // Straight strands have no frames.
            continue;
        }
        let mut cut: State = serde_json::from_value(saved).unwrap();
        let step = solver.step(&mut cut, &Surroundings::default(), 1.0 / 24.0);
        assert_eq!(step.unwrap_err(), DynamicsError::State, "{list}");
    }
}
