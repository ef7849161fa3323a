//! The start: a style does not move by itself.

use glam::{DVec3, Vec3};
use hair_sim::{GRAVITY, Material, Params, Solver, Strands, Surroundings};

/// Curled strands of all kinds of stiffness that grow from a ball.
fn style(n: usize) -> Strands {
    let mut strands = Strands::new();
    for s in 0..24_u32 {
        let angle = s as f32 * 2.4;
        let out = Vec3::new(angle.cos(), 0.6, angle.sin()).normalize();
        let points: Vec<Vec3> = (0..=n)
            .map(|i| {
                let u = i as f32 / n as f32;
                let curl = Vec3::new((9.0 * u + angle).cos(), 0.0, (9.0 * u + angle).sin());
                out * (0.1 + 0.08 * u) + Vec3::NEG_Y * (0.15 * u * u) + curl * (0.01 * u)
            })
            .collect();
        strands.push(s, &points, None).unwrap();
    }
    strands
}

#[test]
fn a_style_starts_without_a_jolt_and_stays() {
    for gamma in [0.1, 1.0, 5.0, 50.0] {
        let params = Params {
            material: Material::from_gamma(gamma, 0.2),
            ..Params::default()
        };
        let (mut solver, mut state) = Solver::new(&style(20), &params).unwrap();
        let start: Vec<Vec<DVec3>> = (0..24)
            .map(|s| solver.points(&state, s).collect())
            .collect();
        let dt = 1.0 / 24.0;
        let moved = |solver: &Solver, state: &_| {
            let mut most = 0.0_f64;
            for (s, before) in start.iter().enumerate() {
                for (a, b) in before.iter().zip(solver.points(state, s)) {
                    most = most.max((b - *a).length());
                }
            }
            most
        };
        solver
            .step(&mut state, &Surroundings::default(), dt)
            .unwrap();
        let acceleration = moved(&solver, &state) * 2.0 / (dt * dt) / GRAVITY;
        assert!(acceleration <= 1e-6, "gamma {gamma}: {acceleration} g");
        // Ten minutes.
        for _ in 0..24 * 600 {
            solver
                .step(&mut state, &Surroundings::default(), dt)
                .unwrap();
        }
        let drift = moved(&solver, &state) / 0.2;
        println!("gamma {gamma}: first acceleration {acceleration:.1e} g, drift {drift:.1e} L");
        assert!(drift <= 1e-9, "gamma {gamma}: {drift}");
    }
}

#[test]
fn links_never_stretch() {
    let rest = style(20);
    let (mut solver, mut state) = Solver::new(&rest, &Params::default()).unwrap();
    for frame in 0..200 {
        let surroundings = Surroundings {
            gravity: DVec3::new(
                f64::from(frame % 7) * 30.0,
                -GRAVITY,
                f64::from(frame % 3) * 50.0,
            ),
            ..Surroundings::default()
        };
        solver.step(&mut state, &surroundings, 1.0 / 24.0).unwrap();
    }
    for s in 0..rest.len() {
        let points: Vec<DVec3> = solver.points(&state, s).collect();
        for (now, styled) in points.windows(2).zip(rest.strand(s).windows(2)) {
            let length = (styled[1].as_dvec3() - styled[0].as_dvec3()).length();
            assert!(((now[1] - now[0]).length() / length - 1.0).abs() < 1e-12);
        }
    }
}
