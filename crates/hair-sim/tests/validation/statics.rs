//! Shapes at rest.

use glam::{DMat3, DQuat, DVec3, Vec3};
use hair_sim::{GRAVITY, Material, Natural, Params, Pose, Roots, Solver, Surroundings};

use crate::{LENGTH, NEARLY_STRAIGHT, along, bare, level, settle, tip};

fn slow(gamma: f64) -> Params {
    Params {
        damping: 0.5,
        drag: 20.0,
        ..bare(gamma)
    }
}

/// Drag alone slows it: nothing twists a strand that is straight by nature then.
fn cantilever(gamma: f64, natural: Natural, n: usize) -> DVec3 {
    let params = Params {
        natural,
        damping: 0.0,
        drag: 40.0,
        ..bare(gamma)
    };
    let (mut solver, mut state) = Solver::new(&level(n), &params).unwrap();
    settle(&mut solver, &mut state, &Surroundings::default());
    tip(&solver, &state)
}

#[test]
fn cantilevers_follow_the_master_curve() {
    for line in include_str!("../data/cantilever.csv").lines().skip(1) {
        let v: Vec<f64> = line.split(',').map(|v| v.parse().unwrap()).collect();
        let (gamma, truth) = (v[0], DVec3::new(v[1], -v[2], 0.0));
        let [straight, bent] = NEARLY_STRAIGHT;
        let errors = [10, 20, 40].map(|n| (cantilever(gamma, straight, n) - truth).length());
        let twisting = (cantilever(gamma, bent, 20) - truth).length();
        assert!((twisting - errors[1]).abs() < 1e-6, "{twisting} {errors:?}");
        let slope = (errors[0] / errors[2]).log2() / 2.0;
        println!("gamma {gamma}: 10, 20, 40 links {errors:.5?}, slope {slope:.2}");
        // Beyond 100 the boundary layer at the root is an element thick.
        let most = match gamma {
            ..=10.0 => 0.001,
            ..=100.0 => 0.005,
            _ => 0.008,
        };
        assert!(errors[1] <= most, "gamma {gamma}: {errors:?}");
        assert!(gamma > 10.0 || slope >= 1.7, "gamma {gamma}: slope {slope}");
    }
}

#[test]
fn the_boundary_layer_converges_once_it_is_resolved() {
    let truth = DVec3::new(0.159_223_383, -0.937_523_935, 0.0);
    let errors = [80, 160].map(|n| (cantilever(100.0, Natural::Styled, n) - truth).length());
    let slope = (errors[0] / errors[1]).log2();
    println!("gamma 100: 80, 160 links {errors:.6?}, slope {slope:.2}");
    assert!(slope >= 1.7, "{slope} {errors:?}");
}

#[test]
fn a_curved_strand_leaves_its_plane_where_theory_says() {
    for line in include_str!("../data/bend_twist.csv").lines().skip(1) {
        let v: Vec<f64> = (line.split(','))
            .map(|v| v.parse().unwrap_or(f64::NAN))
            .collect();
        let (phi, threshold) = (v[1] * std::f64::consts::PI, v[3]);
        if threshold.is_nan() {
            let away = out_of_plane(phi, 30.0, 600);
            assert!(away < 1e-6, "phi {phi}: {away}");
            continue;
        }
        let below = out_of_plane(phi, 0.97 * threshold, 2500);
        assert!(below < 1e-6, "phi {phi}: {below}");
        let above = out_of_plane(phi, 1.03 * threshold, 2500);
        assert!(above > 1e-2, "phi {phi}: {above}");
    }
}

/// The largest distance from the plane of a strand that is clamped downwards and curls by `phi`, in lengths.
fn out_of_plane(phi: f64, gamma: f64, steps: usize) -> f64 {
    let params = Params {
        material: Material {
            twist_ratio: 1.0,
            ..Material::from_gamma(gamma, LENGTH)
        },
        natural: Natural::Curl {
            curvature: phi / LENGTH,
            torsion: 0.0,
        },
        damping: 0.05,
        drag: 5.0,
        ..bare(gamma)
    };
    let n = 100;
    // The planar shape first, then a push.
    let (mut solver, mut state) = Solver::new(&along(n, Vec3::NEG_Y), &params).unwrap();
    let mut surroundings = Surroundings::default();
    for _ in 0..400 {
        solver.step(&mut state, &surroundings, 0.1).unwrap();
    }
    let frame = solver.frames(&state, 0).next().unwrap();
    let across = frame * DVec3::X;
    surroundings.gravity += across * 1e-3 * GRAVITY;
    for _ in 0..10 {
        solver.step(&mut state, &surroundings, 0.05).unwrap();
    }
    surroundings = Surroundings::default();
    for _ in 0..steps {
        solver.step(&mut state, &surroundings, 0.1).unwrap();
    }
    (solver.points(&state, 0))
        .map(|p| (p.dot(across) / LENGTH).abs())
        .fold(0.0, f64::max)
}

#[test]
fn a_helix_hangs_as_the_reference() {
    let (kappa, tau) = (12.322_340_188 / LENGTH, 2.464_468_038 / LENGTH);
    let rows: Vec<Vec<f64>> = include_str!("../data/helix.csv")
        .lines()
        .skip(2)
        .map(|l| l.split(',').map(|v| v.parse().unwrap()).collect())
        .collect();
    // The reference bends about the second axis of its frame, towards the first; gravity is along -Z.
    let (sin, cos) = (0.2 / 1.04_f64.sqrt(), 1.0 / 1.04_f64.sqrt());
    let root = DMat3::from_cols(
        DVec3::new(0.0, -sin, -cos),
        -DVec3::X,
        DVec3::new(0.0, cos, -sin),
    );
    for gamma in [2.5, 5.0, 10.0, 20.0, 30.0, 40.0] {
        let params = Params {
            natural: Natural::Curl {
                curvature: kappa,
                torsion: tau,
            },
            ..slow(gamma)
        };
        let n = 40;
        let (mut solver, mut state) = Solver::new(&along(n, Vec3::Y), &params).unwrap();
        let base = solver.frames(&state, 0).next().unwrap();
        let pose = Pose {
            rotation: DQuat::from_mat3(&root) * base.inverse(),
            translation: DVec3::ZERO,
        };
        solver.teleport(&mut state, Roots::Head(pose)).unwrap();
        let surroundings = Surroundings {
            roots: Roots::Head(pose),
            gravity: DVec3::new(0.0, 0.0, -GRAVITY),
            ..Surroundings::default()
        };
        settle(&mut solver, &mut state, &surroundings);
        let points: Vec<DVec3> = solver.points(&state, 0).map(|p| p / LENGTH).collect();
        let worst = rows
            .iter()
            .filter(|r| r[0] == gamma)
            .map(|r| {
                let at = (r[1] * n as f64).round() as usize;
                (points[at] - DVec3::new(r[2], r[3], r[4])).length()
            })
            .fold(0.0, f64::max);
        println!("gamma {gamma}: helix within {worst:.5} L");
        assert!(worst <= 0.01, "gamma {gamma}: {worst}");
    }
}
