//! The solvers for comparison, against the own one.
#![cfg(feature = "compare")]
#![allow(clippy::print_stdout, reason = "tests show the figures that they hold")]

use glam::{DQuat, DVec3, Vec3};
use hair_sim::compare::{MassSpring, Rod, Xpbd, Zigzag};
use hair_sim::{
    Collider, Material, Natural, Params, Pose, Profile, Roots, Shape, Solver, StrandSolver,
    Strands, Surroundings, Wind,
};

const LENGTH: f64 = 0.2;

/// A strand that leaves its root upwards, arches over and hangs.
fn arch() -> Strands {
    let points: Vec<Vec3> = (0..=16)
        .scan(Vec3::ZERO, |at, i| {
            let here = *at;
            let angle = 1.2 - 0.16 * i as f32;
            *at += Vec3::new(angle.cos(), angle.sin(), 0.1) * (LENGTH as f32 / 16.0);
            Some(here)
        })
        .collect();
    let mut strands = Strands::new();
    strands.push(3, &points, None).unwrap();
    strands
        .push(
            4,
            &points.iter().map(|p| *p + Vec3::Z).collect::<Vec<_>>(),
            None,
        )
        .unwrap();
    strands
}

fn params() -> Params {
    Params {
        material: Material::from_gamma(10.0, LENGTH),
        damping: 0.0,
        drag: 3.0,
        drag_along: 1.0,
        ..Params::default()
    }
}

fn xpbd(params: &Params, substeps: u32) -> (Xpbd, Vec<Rod>) {
    Xpbd::with(&arch(), |_| *params, substeps, 1).unwrap()
}

fn mass_spring(params: &Params, substeps: u32) -> (MassSpring, Vec<Zigzag>) {
    MassSpring::with(&arch(), |_| *params, substeps).unwrap()
}

fn run<S: StrandSolver>(
    solver: &mut S,
    state: &mut S::State,
    surroundings: &Surroundings,
    steps: usize,
) -> Vec<DVec3> {
    for _ in 0..steps {
        solver.step(state, surroundings, 1.0 / 24.0).unwrap();
    }
    points(solver, state)
}

/// Of the first strand.
fn points<S: StrandSolver>(solver: &S, state: &S::State) -> Vec<DVec3> {
    solver.points(state, 0).collect()
}

fn farthest(a: &[DVec3], b: &[DVec3]) -> f64 {
    let apart = a.iter().zip(b).map(|(a, b)| (*a - *b).length());
    apart.fold(0.0, f64::max)
}

#[test]
fn without_gravity_a_style_stays_as_it_is() {
    fn stays<S: StrandSolver>((mut solver, mut state): (S, S::State)) {
        let surroundings = Surroundings {
            gravity: DVec3::ZERO,
            ..Surroundings::default()
        };
        let start = points(&solver, &state);
        let error = farthest(&run(&mut solver, &mut state, &surroundings, 48), &start);
        assert!(error < 1e-12, "{error}");
    }
    let styled = Params {
        natural: Natural::Styled,
        ..params()
    };
    stays(xpbd(&styled, 8));
    stays(mass_spring(&styled, 2));
}

#[test]
fn more_substeps_come_nearer_to_the_own_solver() {
    // Let go from a style that weighs nothing.
    let styled = Params {
        natural: Natural::Styled,
        ..params()
    };
    let surroundings = Surroundings::default();
    let (mut own, mut state) = Solver::new(&arch(), &styled).unwrap();
    let mut truth = Vec::new();
    for _ in 0..24 * 16 {
        own.step(&mut state, &surroundings, 1.0 / 384.0).unwrap();
        truth = points(&own, &state);
    }
    let errors = [16, 64, 512].map(|substeps| {
        let (mut solver, mut rods) = xpbd(&styled, substeps);
        farthest(&run(&mut solver, &mut rods, &surroundings, 24), &truth) / LENGTH
    });
    assert!(errors[1] < errors[0] && errors[2] < errors[1], "{errors:?}");
    assert!(errors[2] < 0.05, "{errors:?}");

    // Springs are not rods: an error is left, however fine the steps.
    let errors = [1, 8, 64].map(|substeps| {
        let (mut solver, mut state) = mass_spring(&styled, substeps);
        farthest(&run(&mut solver, &mut state, &surroundings, 24), &truth) / LENGTH
    });
    println!("mass-spring: {errors:.4?}");
    assert!(errors[1] < errors[0] && errors[2] < 0.2, "{errors:?}");
}

#[test]
fn a_balanced_style_hangs_nearly_as_it_was_styled() {
    // One sweep a substep leaves some sag, and more substeps less.
    let errors = [64, 256].map(|substeps| {
        let (mut solver, mut rods) = xpbd(&params(), substeps);
        let start = points(&solver, &rods);
        farthest(
            &run(&mut solver, &mut rods, &Surroundings::default(), 48),
            &start,
        ) / LENGTH
    });
    assert!(errors[1] < errors[0] && errors[1] < 0.04, "{errors:?}");

    let (mut solver, mut state) = mass_spring(&params(), 4);
    let start = points(&solver, &state);
    let hung = run(&mut solver, &mut state, &Surroundings::default(), 240);
    let error = farthest(&hung, &start) / LENGTH;
    println!("mass-spring: {error:.1e}");
    assert!(error < 1e-6, "{error}");
}

#[test]
fn goals_wind_and_bodies_act() {
    all_act(|params| xpbd(params, 64));
    all_act(|params| mass_spring(params, 8));
}

fn all_act<S: StrandSolver>(solver: impl Fn(&Params) -> (S, S::State)) {
    let goal: Vec<Vec3> = arch()
        .points()
        .iter()
        .map(|p| Vec3::new(p.y, p.x, p.z))
        .collect();
    let pulled = Params {
        goal: Profile::constant(1e6),
        ..params()
    };
    let surroundings = Surroundings {
        goal: Some(&goal),
        ..Surroundings::default()
    };
    let (mut simulation, mut state) = solver(&pulled);
    let at: Vec<DVec3> = goal[..17].iter().map(|p| p.as_dvec3()).collect();
    let error = farthest(&run(&mut simulation, &mut state, &surroundings, 24), &at);
    assert!(error < 0.005, "{error}");

    let blown = Surroundings {
        wind: Wind {
            steady: DVec3::Z * 4.0,
            ..Wind::default()
        },
        ..Surroundings::default()
    };
    let (mut simulation, mut state) = solver(&params());
    let start = points(&simulation, &state);
    let tip = run(&mut simulation, &mut state, &blown, 24)[16];
    assert!(tip.z - start[16].z > 0.02, "{tip}");

    let ball = Collider::fixed(
        Shape::Sphere {
            center: DVec3::new(0.1, -0.05, 0.0),
            radius: 0.06,
        },
        Pose::IDENTITY,
    );
    let limp = Params {
        material: Material::from_gamma(1000.0, LENGTH),
        natural: Natural::Styled,
        thickness: 1e-3,
        ..params()
    };
    let surroundings = Surroundings {
        colliders: &[ball],
        ..Surroundings::default()
    };
    let (mut simulation, mut state) = solver(&limp);
    let mut touched = 0;
    for _ in 0..48 {
        touched += simulation
            .step(&mut state, &surroundings, 1.0 / 24.0)
            .unwrap()
            .contacts;
        for point in simulation.points(&state, 0) {
            let depth = 0.061 - (point - DVec3::new(0.1, -0.05, 0.0)).length();
            assert!(depth < 2e-3, "{depth}");
        }
    }
    assert!(touched > 0);
}

#[test]
fn links_keep_their_length_nearly_and_frames_follow_them() {
    links_keep_their_length(xpbd(&params(), 128), 0.05);
    links_keep_their_length(mass_spring(&params(), 4), 0.05);
}

fn links_keep_their_length<S: StrandSolver>((mut solver, mut state): (S, S::State), most: f64) {
    let surroundings = Surroundings {
        gravity: DVec3::new(9.0, 3.0, -4.0),
        ..Surroundings::default()
    };
    let points = run(&mut solver, &mut state, &surroundings, 12);
    let frames = solver.frames(&state, 0);
    for (link, frame) in points.windows(2).zip(frames) {
        let edge = link[1] - link[0];
        assert!(
            (edge.length() / (LENGTH / 16.0) - 1.0).abs() < most,
            "{}",
            edge.length()
        );
        assert!((frame * DVec3::Z).dot(edge.normalize()) > 0.99);
    }
}

#[test]
fn a_teleport_carries_all_along_and_bad_scenes_are_refused() {
    teleports_and_refuses(xpbd(&params(), 16));
    teleports_and_refuses(mass_spring(&params(), 4));
    let wrong = Params {
        drag: -1.0,
        ..params()
    };
    let errors = [
        Xpbd::with(&arch(), |_| wrong, 1, 1).unwrap_err(),
        MassSpring::with(&arch(), |_| wrong, 1).unwrap_err(),
    ];
    for error in errors.map(|error| error.to_string()) {
        assert!(error.starts_with("strand 3: drag is -1"), "{error}");
    }
}

fn teleports_and_refuses<S: StrandSolver + Clone>(start: (S, S::State)) {
    let (mut solver, mut here) = start.clone();
    run(&mut solver, &mut here, &Surroundings::default(), 3);
    let mut there = here.clone();
    let pose = Pose {
        rotation: DQuat::from_rotation_y(2.0),
        translation: DVec3::new(5.0, 0.0, -3.0),
    };
    solver.teleport(&mut there, Roots::Head(pose)).unwrap();
    let moved = Surroundings {
        roots: Roots::Head(pose),
        ..Surroundings::default()
    };
    let here = run(&mut solver, &mut here, &Surroundings::default(), 12);
    let there = run(&mut solver, &mut there, &moved, 12);
    let carried: Vec<DVec3> = here
        .iter()
        .map(|p| pose.rotation * *p + pose.translation)
        .collect();
    let error = farthest(&carried, &there);
    assert!(error < 1e-9, "{error}");

    let (mut solver, mut state) = start;
    let mut refused = |surroundings: Surroundings, expected: &str| {
        let error = solver
            .step(&mut state, &surroundings, 0.1)
            .unwrap_err()
            .to_string();
        assert!(error.contains(expected), "{error}");
    };
    let goal = Some(&[Vec3::ZERO][..]);
    refused(
        Surroundings {
            goal,
            ..Surroundings::default()
        },
        "goals for 1 points; the strands have 34",
    );
    refused(
        Surroundings {
            roots: Roots::Each(&[pose]),
            ..Surroundings::default()
        },
        "1 poses for 2 strands",
    );
    let gravity = DVec3::NAN;
    refused(
        Surroundings {
            gravity,
            ..Surroundings::default()
        },
        "gravity is not finite",
    );
}

#[test]
fn strands_that_cannot_move_follow_their_roots() {
    let mut strands = Strands::new();
    for (id, points) in [vec![Vec3::ONE], vec![Vec3::ONE; 4]].iter().enumerate() {
        strands.push(id as u32, points, None).unwrap();
    }
    follow(Xpbd::with(&strands, |_| params(), 4, 1).unwrap());
    follow(MassSpring::with(&strands, |_| params(), 4).unwrap());
}

fn follow<S: StrandSolver>((mut solver, mut state): (S, S::State)) {
    let pose = Pose {
        rotation: DQuat::IDENTITY,
        translation: DVec3::Y,
    };
    let surroundings = Surroundings {
        roots: Roots::Head(pose),
        ..Surroundings::default()
    };
    let stats = solver.step(&mut state, &surroundings, 0.1).unwrap();
    assert!(stats.set_aside > 0, "{stats:?}");
    for (strand, points) in [1, 4].into_iter().enumerate() {
        let found: Vec<DVec3> = solver.points(&state, strand).collect();
        let at = DVec3::new(1.0, 2.0, 1.0);
        assert_eq!(found.len(), points);
        assert!(found.iter().all(|p| (*p - at).length() < 1e-6), "{found:?}");
        let frames: Vec<DQuat> = solver.frames(&state, strand).collect();
        assert_eq!(frames.len(), points - 1);
        assert!(frames.iter().all(|frame| frame.is_finite()), "{frames:?}");
    }
}

/// Doubled points, one link, one that is far longer than the others, and stiffness that varies by 1e6.
#[test]
fn springs_of_odd_strands_stay_finite() {
    let odd: [&[Vec3]; 4] = [
        &[Vec3::ZERO, Vec3::X * 0.1],
        &[Vec3::ZERO, Vec3::ZERO, Vec3::X * 0.1, Vec3::X * 0.1],
        &[
            Vec3::ZERO,
            Vec3::X * 1e-5,
            Vec3::X,
            Vec3::X + Vec3::Y * 1e-5,
        ],
        &[Vec3::ZERO, Vec3::X, Vec3::new(0.3, 0.1, 0.0), Vec3::X * 1.2],
    ];
    let mut strands = Strands::new();
    for (id, points) in odd.iter().enumerate() {
        strands.push(id as u32, points, None).unwrap();
    }
    for gamma in [1e-4, 10.0, 1e6] {
        let params = Params {
            material: Material::from_gamma(gamma, 0.1),
            stiffness: Profile {
                root: 1e3,
                middle: 1.0,
                tip: 1e-3,
            },
            ..params()
        };
        let (mut solver, mut state) = MassSpring::with(&strands, |_| params, 1).unwrap();
        for i in 0..48 {
            let pose = Pose {
                rotation: DQuat::from_rotation_y(f64::from(i)),
                translation: DVec3::Y * f64::from(i % 5),
            };
            let surroundings = Surroundings {
                roots: Roots::Head(pose),
                wind: Wind {
                    gust: 100.0,
                    ..Wind::default()
                },
                ..Surroundings::default()
            };
            let stats = solver.step(&mut state, &surroundings, 0.1).unwrap();
            for strand in 0..odd.len() {
                let mut points = solver.points(&state, strand);
                assert!(points.all(|p| p.is_finite()), "{gamma}: {stats:?}");
                let mut frames = solver.frames(&state, strand);
                assert!(frames.all(|f| f.is_normalized()), "{gamma}: {stats:?}");
            }
        }
    }
}
