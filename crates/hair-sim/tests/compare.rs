//! The solvers for comparison, against the own one.

use glam::{DQuat, DVec3, Vec3};
use hair_sim::compare::{Rod, Xpbd};
use hair_sim::{
    Collider, Material, Natural, Params, Pose, Profile, Roots, Scene, Shape, Solver, StrandSolver,
    Strands, Wind,
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

fn run<S: StrandSolver>(
    solver: &mut S,
    state: &mut S::State,
    scene: &Scene,
    steps: usize,
) -> Vec<DVec3> {
    for _ in 0..steps {
        solver.step(state, scene, 1.0 / 24.0).unwrap();
    }
    solver.points(state, 0)
}

fn farthest(a: &[DVec3], b: &[DVec3]) -> f64 {
    let apart = a.iter().zip(b).map(|(a, b)| (*a - *b).length());
    apart.fold(0.0, f64::max)
}

#[test]
fn without_gravity_a_style_stays_as_it_is() {
    let scene = Scene {
        gravity: DVec3::ZERO,
        ..Scene::default()
    };
    let styled = Params {
        natural: Natural::Styled,
        ..params()
    };
    let (mut solver, mut rods) = xpbd(&styled, 8);
    let start = solver.points(&rods, 0);
    let error = farthest(&run(&mut solver, &mut rods, &scene, 48), &start);
    assert!(error < 1e-12, "{error}");
}

#[test]
fn more_substeps_come_nearer_to_the_own_solver() {
    // Let go from a style that weighs nothing.
    let styled = Params {
        natural: Natural::Styled,
        ..params()
    };
    let scene = Scene::default();
    let (mut own, mut state) = Solver::new(&arch(), &styled).unwrap();
    let mut truth = Vec::new();
    for _ in 0..24 * 16 {
        own.step(&mut state, &scene, 1.0 / 384.0).unwrap();
        truth = StrandSolver::points(&own, &state, 0);
    }
    let errors = [16, 64, 512].map(|substeps| {
        let (mut solver, mut rods) = xpbd(&styled, substeps);
        farthest(&run(&mut solver, &mut rods, &scene, 24), &truth) / LENGTH
    });
    assert!(errors[1] < errors[0] && errors[2] < errors[1], "{errors:?}");
    assert!(errors[2] < 0.05, "{errors:?}");
}

#[test]
fn a_balanced_style_hangs_nearly_as_it_was_styled() {
    // One sweep a substep leaves some sag, and more substeps less.
    let errors = [64, 256].map(|substeps| {
        let (mut solver, mut rods) = xpbd(&params(), substeps);
        let start = solver.points(&rods, 0);
        farthest(&run(&mut solver, &mut rods, &Scene::default(), 48), &start) / LENGTH
    });
    assert!(errors[1] < errors[0] && errors[1] < 0.04, "{errors:?}");
}

#[test]
fn goals_wind_and_bodies_act() {
    let goal: Vec<Vec3> = arch()
        .points()
        .iter()
        .map(|p| Vec3::new(p.y, p.x, p.z))
        .collect();
    let pulled = Params {
        goal: Profile::constant(1e6),
        ..params()
    };
    let scene = Scene {
        goal: Some(&goal),
        ..Scene::default()
    };
    let (mut solver, mut rods) = xpbd(&pulled, 32);
    let at: Vec<DVec3> = goal[..17].iter().map(|p| p.as_dvec3()).collect();
    let error = farthest(&run(&mut solver, &mut rods, &scene, 24), &at);
    assert!(error < 0.005, "{error}");

    let blown = Scene {
        wind: Wind {
            steady: DVec3::Z * 4.0,
            ..Wind::default()
        },
        ..Scene::default()
    };
    let (mut solver, mut rods) = xpbd(&params(), 32);
    let start = solver.points(&rods, 0);
    let tip = run(&mut solver, &mut rods, &blown, 24)[16];
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
    let scene = Scene {
        colliders: &[ball],
        ..Scene::default()
    };
    let (mut solver, mut rods) = xpbd(&limp, 64);
    let mut touched = 0;
    for _ in 0..48 {
        touched += solver.step(&mut rods, &scene, 1.0 / 24.0).unwrap().contacts;
        for point in solver.points(&rods, 0) {
            let depth = 0.061 - (point - DVec3::new(0.1, -0.05, 0.0)).length();
            assert!(depth < 2e-3, "{depth}");
        }
    }
    assert!(touched > 0);
}

#[test]
fn links_keep_their_length_nearly_and_frames_follow_them() {
    let (mut solver, mut rods) = xpbd(&params(), 128);
    let scene = Scene {
        gravity: DVec3::new(9.0, 3.0, -4.0),
        ..Scene::default()
    };
    let points = run(&mut solver, &mut rods, &scene, 12);
    let frames = solver.frames(&rods, 0);
    for (link, frame) in points.windows(2).zip(frames) {
        let edge = link[1] - link[0];
        assert!(
            (edge.length() / (LENGTH / 16.0) - 1.0).abs() < 0.05,
            "{}",
            edge.length()
        );
        assert!((frame * DVec3::Z).dot(edge.normalize()) > 0.99);
    }
}

#[test]
fn a_teleport_carries_all_along_and_bad_scenes_are_refused() {
    let (mut solver, mut here) = xpbd(&params(), 16);
    run(&mut solver, &mut here, &Scene::default(), 3);
    let mut there = here.clone();
    let pose = Pose {
        rotation: DQuat::from_rotation_y(2.0),
        translation: DVec3::new(5.0, 0.0, -3.0),
    };
    solver.teleport(&mut there, Roots::Head(pose)).unwrap();
    let moved = Scene {
        roots: Roots::Head(pose),
        ..Scene::default()
    };
    let here = run(&mut solver, &mut here, &Scene::default(), 12);
    let there = run(&mut solver, &mut there, &moved, 12);
    let carried: Vec<DVec3> = here
        .iter()
        .map(|p| pose.rotation * *p + pose.translation)
        .collect();
    let error = farthest(&carried, &there);
    assert!(error < 1e-9, "{error}");

    let (mut solver, mut rods) = xpbd(&params(), 16);
    let mut refused = |scene: Scene, expected: &str| {
        let error = solver.step(&mut rods, &scene, 0.1).unwrap_err().to_string();
        assert!(error.contains(expected), "{error}");
    };
    let goal = Some(&[Vec3::ZERO][..]);
    refused(
        Scene {
            goal,
            ..Scene::default()
        },
        "goals for 1 points; the strands have 34",
    );
    refused(
        Scene {
            roots: Roots::Each(&[pose]),
            ..Scene::default()
        },
        "1 poses for 2 strands",
    );
    let gravity = DVec3::NAN;
    refused(
        Scene {
            gravity,
            ..Scene::default()
        },
        "gravity is not finite",
    );
    let wrong = Params {
        drag: -1.0,
        ..params()
    };
    let error = Xpbd::with(&arch(), |_| wrong, 1, 1)
        .unwrap_err()
        .to_string();
    assert!(error.starts_with("strand 3: drag is -1"), "{error}");
}

#[test]
fn strands_that_cannot_move_follow_their_roots() {
    let mut strands = Strands::new();
    for (id, points) in [vec![Vec3::ONE], vec![Vec3::ONE; 4]].iter().enumerate() {
        strands.push(id as u32, points, None).unwrap();
    }
    let (mut solver, mut rods) = Xpbd::with(&strands, |_| params(), 4, 1).unwrap();
    let scene = Scene {
        roots: Roots::Head(Pose {
            rotation: DQuat::IDENTITY,
            translation: DVec3::Y,
        }),
        ..Scene::default()
    };
    solver.step(&mut rods, &scene, 0.1).unwrap();
    for strand in 0..2 {
        let points = solver.points(&rods, strand);
        let at = DVec3::new(1.0, 2.0, 1.0);
        assert!(
            points.iter().all(|p| (*p - at).length() < 1e-6),
            "{points:?}"
        );
    }
}
