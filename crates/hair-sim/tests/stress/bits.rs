//! Row 9: the same bits for any number of threads, any order of strands, and after save and restore.

use glam::{DQuat, DVec3};
use hair_sim::{
    Collider, Material, Mutual, Params, Pose, Profile, Roots, Shape, Solver, State, Strands,
    Surroundings, Wind,
};

use crate::{strand, style};

/// Strands that differ in what they are made of, act on each other, and don't pass through each other.
fn make(rest: &Strands) -> (Solver, State) {
    let params = |s: usize| {
        let id = rest.id(s);
        Params {
            goal: Profile::constant(if id.is_multiple_of(2) { 3.0 } else { 0.0 }),
            drag: if id.is_multiple_of(3) { 0.0 } else { 2.0 },
            damping: if id % 5 < 2 { 0.0 } else { 0.005 },
            lock_radius: 0.003 + 0.001 * f64::from(id % 4),
            ..Params::default()
        }
    };
    let (mut solver, mut state) = Solver::with(rest, params).unwrap();
    let mutual = Mutual {
        reach: 0.1,
        distance: 0.05,
        break_at: 0.01,
        ..Mutual::default()
    };
    solver.interact(&mut state, &mutual).unwrap();
    (solver, state)
}

/// Half a second of everything at once, from `from` on.
fn run(solver: &mut Solver, state: &mut State, from: usize, frames: usize) {
    let mut meetings = 0;
    let pose = |i: usize| Pose {
        rotation: DQuat::from_rotation_y(0.3 * (i as f64 * 0.5).sin()),
        translation: DVec3::new(0.0, 0.02 * (i as f64).cos(), 0.0),
    };
    for i in from..from + frames {
        let colliders = [Collider {
            shape: Shape::Sphere {
                center: DVec3::ZERO,
                radius: 0.1,
            },
            before: pose(i),
            now: pose(i + 1),
            was: None,
        }];
        let surroundings = Surroundings {
            roots: Roots::Head(pose(i + 1)),
            wind: Wind {
                steady: DVec3::new(2.0, 0.0, 1.0),
                gust: 3.0,
                ..Wind::default()
            },
            colliders: &colliders,
            ..Surroundings::default()
        };
        meetings += solver
            .step(state, &surroundings, 1.0 / 24.0)
            .unwrap()
            .meetings;
    }
    assert!(meetings > 100, "{meetings}");
}

fn bits(solver: &Solver, state: &State, strand: usize) -> Vec<[u64; 3]> {
    (solver.points(state, strand))
        .map(|p| [p.x.to_bits(), p.y.to_bits(), p.z.to_bits()])
        .collect()
}

#[test]
fn threads_do_not_matter() {
    let rest = style(50, 12, 0.2);
    let states = [1, 2, 8].map(|threads| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(|| {
            let (mut solver, mut state) = make(&rest);
            run(&mut solver, &mut state, 0, 24);
            state
        })
    });
    assert!(states[0] == states[1] && states[0] == states[2]);
}

#[test]
fn the_order_of_strands_does_not_matter() {
    // Of different lengths, so that batches mix them.
    let count = 21;
    let mut rest = Strands::new();
    for s in 0..count {
        rest.push(s, &strand(s, 8 + s as usize % 5, 0.2), None)
            .unwrap();
    }
    let order: Vec<usize> = (0..count as usize)
        .map(|i| i * 8 % count as usize)
        .collect();
    let shuffled = rest.select(&order);
    let (mut solver, mut state) = make(&rest);
    run(&mut solver, &mut state, 0, 24);
    let (mut other, mut other_state) = make(&shuffled);
    run(&mut other, &mut other_state, 0, 24);
    for (place, &index) in order.iter().enumerate() {
        assert_eq!(
            bits(&solver, &state, index),
            bits(&other, &other_state, place),
            "{index}"
        );
    }
}

/// Strands of one to five links, that a ball throws about so that many steps are the safe integrator's: what holds for a
/// batch must not reach its strands.
#[test]
fn the_order_of_strands_does_not_matter_where_most_fails() {
    let mut rest = Strands::new();
    for s in 0..29 {
        let points = strand(s, 1 + s as usize * 7 % 5, 0.1);
        rest.push(s, &points, None).unwrap();
    }
    let run = |rest: &Strands| {
        let params = |s: usize| Params {
            material: Material::from_gamma([0.1, 10.0, 1e4][rest.id(s) as usize % 3], 0.1),
            damping: [0.0, 0.005, 2.0][rest.id(s) as usize / 3 % 3],
            drag: [0.0, 1e4][rest.id(s) as usize % 2],
            friction: 5.0,
            ..Params::default()
        };
        let (mut solver, mut state) = Solver::with(rest, params).unwrap();
        let (mut contacts, mut fallbacks) = (0, 0);
        let pose = |i: usize| Pose {
            translation: DVec3::new(0.3 * (i as f64).sin(), 0.05, 0.2 * (0.7 * i as f64).cos()),
            rotation: DQuat::IDENTITY,
        };
        for i in 0..96 {
            let colliders = [Collider {
                shape: Shape::Sphere {
                    center: DVec3::ZERO,
                    radius: 0.08,
                },
                before: pose(i),
                now: pose(i + 1),
                was: None,
            }];
            let surroundings = Surroundings {
                // Now and then it is gone.
                colliders: if i % 7 < 5 { &colliders } else { &[] },
                ..Surroundings::default()
            };
            let dt = [1.0 / 24.0, 0.005, 0.1][i % 3];
            let stats = solver.step(&mut state, &surroundings, dt).unwrap();
            contacts += stats.contacts;
            fallbacks += stats.fallbacks;
        }
        assert!(contacts > 1000 && fallbacks > 100, "{contacts} {fallbacks}");
        (solver, state)
    };
    let order: Vec<usize> = (0..29).map(|i| i * 8 % 29).collect();
    let (solver, state) = run(&rest);
    let (other, other_state) = run(&rest.select(&order));
    for (place, &index) in order.iter().enumerate() {
        assert_eq!(
            bits(&solver, &state, index),
            bits(&other, &other_state, place),
            "{index}"
        );
    }
}

#[test]
fn a_saved_state_goes_on_as_if_nothing_had_happened() {
    let rest = style(20, 12, 0.2);
    let (mut solver, mut state) = make(&rest);
    run(&mut solver, &mut state, 0, 12);
    let saved = serde_json::to_string(&state).unwrap();
    run(&mut solver, &mut state, 12, 24);
    let (mut fresh, _) = make(&rest);
    let mut restored: State = serde_json::from_str(&saved).unwrap();
    run(&mut fresh, &mut restored, 12, 24);
    assert_eq!(state, restored);
}
