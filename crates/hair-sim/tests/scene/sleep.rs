use glam::{DMat3, DQuat, DVec3, Vec3};
use hair_sim::{
    Acceleration, Collider, GRAVITY, Material, Mutual, Params, Pose, Profile, Roots, Shape, Solver,
    State, Stats, Strands, Surroundings, Wind,
};

use std::time::Instant;

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
fn hair() -> (Solver, State) {
    hair_in(&Vec::from_iter(0..72))
}

/// The same in another order.
fn hair_in(order: &[usize]) -> (Solver, State) {
    let mut strands = Strands::new();
    for s in order.iter().map(|&s| s as u32) {
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
    (solver, state)
}

/// In m.
const HEAD: f64 = 0.1;
const DT: f64 = 1.0 / 60.0;
/// What 0.05 pixels are where a head of 0.24 m is 1000 of them high, in m.
const UNSEEN: f64 = 1.2e-5;

fn turned(angle: f64) -> Pose {
    Pose {
        rotation: DQuat::from_rotation_y(angle),
        translation: DVec3::ZERO,
    }
}

fn ball([before, now]: [f64; 2], radius: f64) -> [Collider<'static>; 1] {
    let [before, now] = [before, now].map(turned);
    [Collider {
        shape: Shape::Sphere {
            center: DVec3::ZERO,
            radius,
        },
        before,
        now,
        was: None,
    }]
}

/// A step in which the head turns from one angle to another, where gravity from the side is `side`.
fn turn(solver: &mut Solver, state: &mut State, way: [f64; 2], side: f64) -> Stats {
    let colliders = ball(way, HEAD);
    let surroundings = Surroundings {
        roots: Roots::Head(turned(way[1])),
        gravity: DVec3::new(side, -GRAVITY, 0.0),
        ..among(&colliders)
    };
    solver.step(state, &surroundings, DT).unwrap()
}

/// The angle of a head that turns in a third of a second, after so many steps.
fn angle(step: i32) -> f64 {
    0.8 * (f64::from(step) / 20.0).min(1.0)
}

/// Lets the head turn, and then everything come to rest.
fn come_to_rest(solver: &mut Solver, state: &mut State) {
    let asleep = (0..3600).any(|i| turn(solver, state, [i, i + 1].map(angle), 0.0).asleep == 72);
    assert!(asleep);
}

#[test]
fn hair_that_acts_on_each_other_sleeps_and_nobody_sees_it() {
    let (mut solver, mut state) = hair();
    // The same, but what acts is never the same, so that nobody sleeps.
    let (mut restless, mut other) = (solver.clone(), state.clone());
    let mut fell_asleep = None;
    let mut most = 0.0_f64;
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
    assert!(most < UNSEEN, "{most}");
}

#[test]
fn whatever_changes_wakes_hair_that_sleeps() {
    let (mut solver, mut state) = hair();
    come_to_rest(&mut solver, &mut state);
    let end = angle(20);
    let still = ball([end; 2], HEAD);
    let larger = ball([end; 2], HEAD + 1e-3);
    let moving = ball([end, end + 1e-3], HEAD);
    let head = Roots::Head(turned(end));
    let scene = Surroundings {
        roots: head,
        ..among(&still)
    };
    let breath = |x: f64| Wind {
        steady: DVec3::new(x, 0.0, x),
        ..Wind::default()
    };
    let mut poses = vec![turned(end); 72];
    poses[40].translation.x = 1e-6;
    let goal = vec![Vec3::X; 72 * 21];
    let accelerated = Acceleration {
        turn: DMat3::ZERO,
        shift: DVec3::X,
    };
    let changed = [
        (
            "a breath of wind",
            Surroundings {
                wind: breath(0.01),
                ..scene
            },
        ),
        (
            "gusts",
            Surroundings {
                wind: Wind {
                    gust: 0.01,
                    ..Wind::default()
                },
                ..scene
            },
        ),
        (
            "one root",
            Surroundings {
                roots: Roots::Each(&poses),
                ..scene
            },
        ),
        (
            "what is about to move",
            Surroundings {
                acceleration: Some([accelerated; 2]),
                ..scene
            },
        ),
        (
            "a goal",
            Surroundings {
                goal: Some(&goal),
                ..scene
            },
        ),
        (
            "a larger body",
            Surroundings {
                colliders: &larger,
                ..scene
            },
        ),
        (
            "a body that moves",
            Surroundings {
                colliders: &moving,
                ..scene
            },
        ),
        (
            "no body",
            Surroundings {
                colliders: &[],
                ..scene
            },
        ),
    ];
    for (what, scene) in &changed {
        let mut state = state.clone();
        let stats = solver.step(&mut state, scene, DT).unwrap();
        // The pairs hold them all together.
        assert_eq!((stats.asleep, stats.strands), (0, 72), "{what}");
    }
    assert_eq!(solver.step(&mut state, &scene, DT).unwrap().asleep, 72);

    // In a wind that blows as before they sleep again; as strong from the other side it is another.
    let mut blown = |x: f64| {
        let scene = Surroundings {
            wind: breath(x),
            ..scene
        };
        (0..3600).position(|_| solver.step(&mut state, &scene, DT).unwrap().asleep == 72)
    };
    let (first, again, other) = (blown(0.5), blown(0.5), blown(-0.5));
    assert!(
        first > Some(60) && again == Some(0) && other > Some(60),
        "{first:?} {again:?} {other:?}"
    );
}

#[test]
fn other_links_wake_hair_that_sleeps() {
    let (mut solver, mut state) = hair();
    come_to_rest(&mut solver, &mut state);
    let end = [angle(20); 2];
    assert_eq!(turn(&mut solver, &mut state, end, 0.0).asleep, 72);
    solver.interact(&mut state, &Mutual::default()).unwrap();
    assert_eq!(turn(&mut solver, &mut state, end, 0.0).asleep, 0);
}

#[test]
fn what_is_asleep_is_the_same_for_any_threads_and_order_and_after_it_is_restored() {
    let bits = |solver: &Solver, state: &State, strand: usize| -> Vec<[u64; 3]> {
        let points = solver.points(state, strand);
        points.map(|p| p.to_array().map(f64::to_bits)).collect()
    };
    let awake_again = |solver: &mut Solver, state: &mut State| {
        for i in 0..20 {
            turn(solver, state, [angle(20 + i), angle(20 + i)], 0.1);
        }
    };
    let states = [1, 3].map(|threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        pool.build().unwrap().install(|| {
            let (mut solver, mut state) = hair();
            come_to_rest(&mut solver, &mut state);
            let saved = serde_json::to_string(&state).unwrap();
            awake_again(&mut solver, &mut state);
            let (mut fresh, _) = hair();
            let mut restored: State = serde_json::from_str(&saved).unwrap();
            assert_eq!(
                turn(&mut fresh, &mut restored.clone(), [angle(20); 2], 0.0).asleep,
                72
            );
            awake_again(&mut fresh, &mut restored);
            assert!(state == restored);
            state
        })
    });
    assert!(states[0] == states[1]);
    let order: Vec<usize> = (0..72).map(|i| i * 29 % 72).collect();
    let (solver, _) = hair();
    let (mut other, mut other_state) = hair_in(&order);
    come_to_rest(&mut other, &mut other_state);
    awake_again(&mut other, &mut other_state);
    for (place, &strand) in order.iter().enumerate() {
        assert_eq!(
            bits(&solver, &states[0], strand),
            bits(&other, &other_state, place)
        );
    }
}

#[test]
fn what_sleeps_costs_hardly_anything() {
    let (mut solver, mut state) = hair();
    come_to_rest(&mut solver, &mut state);
    let end = angle(20);
    // The shortest of many runs of some steps, asleep and kept awake.
    let mut shortest = [f64::INFINITY; 2];
    for _ in 0..200 {
        for (is_awake, shortest) in [false, true].into_iter().zip(&mut shortest) {
            let mut state = state.clone();
            let start = Instant::now();
            for i in 0..8 {
                let side = if is_awake {
                    1e-300 * f64::from(i % 2 + 1)
                } else {
                    0.0
                };
                let stats = turn(&mut solver, &mut state, [end; 2], side);
                assert_eq!(stats.asleep, if is_awake { 0 } else { 72 });
            }
            *shortest = shortest.min(start.elapsed().as_secs_f64() / 8.0);
        }
    }
    let [asleep, awake] = shortest.map(|seconds| 1e6 * seconds);
    println!("a step of 72 x 20: {asleep:.1} us asleep, {awake:.0} us awake at rest");
    assert!(asleep < 0.05 * awake, "{asleep} {awake}");
}
