use glam::{DQuat, DVec3, Vec3};
use hair_sim::{
    Collider, GRAVITY, Material, Mutual, Params, Pose, Profile, Roots, Shape, Solver, State, Stats,
    Strands, Surroundings,
};

use crate::{among, farthest, params, run, shape, straight};

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

/// 72 strands of 20 links on a ball, that hold and push each other as those of styles do.
fn hair() -> (Solver, State, Strands) {
    let mut strands = Strands::new();
    for s in 0..72_u32 {
        let angle = f64::from(s) * 2.399_963_229_728_653;
        let up = 1.0 - 1.2 * (f64::from(s) + 0.5) / 72.0;
        let level = (1.0 - up * up).sqrt();
        let out = DVec3::new(level * angle.cos(), up, level * angle.sin());
        let points: Vec<Vec3> = (0..=20)
            .map(|i| {
                let u = f64::from(i) / 20.0;
                (out * (HEAD + 0.002 + 0.1 * u) + DVec3::NEG_Y * (0.2 * u * u)).as_vec3()
            })
            .collect();
        strands.push(s, &points, None).unwrap();
    }
    let params = Params {
        material: Material::from_gamma(25.0, 0.25),
        damping: 0.02,
        drag: 1.6,
        goal: Profile {
            root: 40.0,
            middle: 4.0,
            tip: 0.0,
        },
        ..Params::default()
    };
    let (mut solver, mut state) = Solver::new(&strands, &params).unwrap();
    let mutual = Mutual {
        reach: 0.03,
        break_at: 0.024,
        repulsion: 200.0,
        distance: 0.015,
        ..Mutual::default()
    };
    solver.interact(&mut state, &mutual).unwrap();
    (solver, state, strands)
}

/// In m.
const HEAD: f64 = 0.1;
const DT: f64 = 1.0 / 60.0;

fn turned(angle: f64) -> Pose {
    Pose {
        rotation: DQuat::from_rotation_y(angle),
        translation: DVec3::ZERO,
    }
}

/// A step in which the head turns to `now`, where gravity from the side is `side`.
fn turn(solver: &mut Solver, state: &mut State, [before, now]: [f64; 2], side: f64) -> Stats {
    let [before, now] = [turned(before), turned(now)];
    let colliders = [Collider {
        shape: Shape::Sphere {
            center: DVec3::ZERO,
            radius: HEAD,
        },
        before,
        now,
    }];
    let surroundings = Surroundings {
        roots: Roots::Head(now),
        gravity: DVec3::new(side, -GRAVITY, 0.0),
        ..among(&colliders)
    };
    solver.step(state, &surroundings, DT).unwrap()
}

#[test]
fn hair_that_acts_on_each_other_sleeps_and_nobody_sees_it() {
    let (mut solver, mut state, _) = hair();
    // The same, but what acts is never the same, so that nobody sleeps.
    let (mut restless, mut other) = (solver.clone(), state.clone());
    let mut fell_asleep = None;
    let mut most = 0.0_f64;
    let angle = |i: i32| 0.8 * (f64::from(i) / 20.0).min(1.0);
    for i in 0..3600 {
        let way = [i, i + 1].map(angle);
        let stats = turn(&mut solver, &mut state, way, 0.0);
        if stats.asleep > 0 {
            // All of an island at once.
            assert_eq!((stats.asleep, stats.strands), (72, 0), "{i}");
            fell_asleep.get_or_insert(f64::from(i) * DT);
        }
        let side = if i % 2 == 0 { 1e-300 } else { 0.0 };
        assert_eq!(turn(&mut restless, &mut other, way, side).asleep, 0);
        for s in 0..72 {
            let pairs = solver.points(&state, s).zip(restless.points(&other, s));
            most = pairs.fold(most, |most, (a, b)| most.max((a - b).length()));
        }
    }
    println!("asleep after {fell_asleep:?} s; {most:.1e} m from where it would be awake");
    assert!(fell_asleep.is_some());
    assert!(most < 2e-6, "{most}");
}
