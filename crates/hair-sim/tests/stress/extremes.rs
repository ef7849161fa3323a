//! Rows 1 and 3: any step, any stiffness, any length, any number of particles.

use glam::{DVec3, Vec3};
use hair_sim::{GRAVITY, Material, Natural, Params, Profile, Solver, Strands, Surroundings};

use crate::{check, step, strand};

#[test]
fn any_step_with_any_stiffness_and_drag() {
    let mut rest = Strands::new();
    for s in 0..3 {
        rest.push(s, &strand(s, 19, 0.25), None).unwrap();
    }
    let level: Vec<Vec3> = (0..20).map(|i| Vec3::X * (0.3 * i as f32 / 19.0)).collect();
    rest.push(3, &level, None).unwrap();
    let (mut worst_gain, mut fallbacks, mut steps_taken) = (0.0_f64, 0, 0);
    for exponent in -4..=6 {
        let gamma = 10.0_f64.powi(exponent);
        for dt in [1.0 / 240.0, 1.0 / 60.0, 1.0 / 24.0, 0.2, 1.0] {
            for drag in [0.0, 2.0, 1000.0] {
                let params = Params {
                    material: Material::from_gamma(gamma, 0.3),
                    natural: Natural::Styled,
                    damping: 0.0,
                    drag,
                    ..Params::default()
                };
                let what = format!("gamma 1e{exponent}, step {dt:.4}, drag {drag}");
                let (mut solver, mut state) = Solver::new(&rest, &params).unwrap();
                let surroundings = Surroundings::default();
                let start: Vec<f64> = (0..4)
                    .map(|s| solver.energy(&state, s, surroundings.gravity))
                    .collect();
                let scale = GRAVITY * 0.3 * 0.3;
                let steps = ((2.0 / dt) as usize).clamp(40, 240);
                let mut worst = 0.0_f64;
                for _ in 0..steps {
                    fallbacks += step(&mut solver, &mut state, &surroundings, dt);
                    steps_taken += 4;
                    check(&solver, &state, &rest, &what);
                    for (s, start) in start.iter().enumerate() {
                        let gain = (solver.energy(&state, s, surroundings.gravity) - start) / scale;
                        if gain > worst {
                            worst = gain;
                        }
                        worst_gain = worst_gain.max(gain);
                    }
                }
                if worst > 1e-4 {
                    println!("{what}: gains {worst:.2e} m g L");
                }
            }
        }
    }
    println!(
        "largest gain of energy {worst_gain:.1e} m g L, {fallbacks} fallbacks in {steps_taken} steps"
    );
    assert!(worst_gain < 1e-3, "{worst_gain}");
}

#[test]
fn stiffness_that_varies_a_million_times_along_a_strand() {
    for profile in [
        Profile {
            root: 1.0,
            middle: 1e-3,
            tip: 1e-6,
        },
        Profile {
            root: 1e-6,
            middle: 1e-3,
            tip: 1.0,
        },
        Profile {
            root: 1e3,
            middle: 1e-3,
            tip: 1e3,
        },
    ] {
        let mut rest = Strands::new();
        rest.push(0, &strand(0, 19, 0.25), None).unwrap();
        for natural in [Natural::Balanced, Natural::Styled] {
            let params = Params {
                material: Material::from_gamma(1.0, 0.25),
                stiffness: profile,
                natural,
                ..Params::default()
            };
            let (mut solver, mut state) = Solver::new(&rest, &params).unwrap();
            for _ in 0..240 {
                step(
                    &mut solver,
                    &mut state,
                    &Surroundings::default(),
                    1.0 / 24.0,
                );
                check(&solver, &state, &rest, "varied");
            }
        }
    }
}

#[test]
fn a_micrometre_and_a_metre_in_one_scene() {
    let mut rest = Strands::new();
    for (s, length) in [1e-6_f32, 1e-3, 0.1, 1.0].into_iter().enumerate() {
        let points: Vec<Vec3> = (0..12)
            .map(|i| {
                let u = i as f32 / 11.0;
                Vec3::new(u, 0.3 * u * u, 0.0) * length
            })
            .collect();
        rest.push(s as u32, &points, None).unwrap();
    }
    for natural in [Natural::Balanced, Natural::Styled] {
        let params = Params {
            natural,
            ..Params::default()
        };
        let (mut solver, mut state) = Solver::new(&rest, &params).unwrap();
        for i in 0..120 {
            let surroundings = Surroundings {
                gravity: DVec3::new(5.0 * f64::from(i % 24), -GRAVITY, 0.0),
                ..Surroundings::default()
            };
            step(&mut solver, &mut state, &surroundings, 1.0 / 24.0);
            check(&solver, &state, &rest, "lengths");
        }
    }
}

#[test]
fn any_number_of_particles() {
    let mut rest = Strands::new();
    for (s, links) in [0_usize, 1, 2, 499].into_iter().enumerate() {
        let points: Vec<Vec3> = (0..=links)
            .map(|i| Vec3::new(0.0, -0.3, 0.1) * (i as f32 / links.max(1) as f32))
            .collect();
        rest.push(s as u32, &points, None).unwrap();
    }
    let (mut solver, mut state) = Solver::new(&rest, &Params::default()).unwrap();
    for i in 0..96 {
        let surroundings = Surroundings {
            gravity: DVec3::new(10.0 * f64::from(i % 5), -GRAVITY, 0.0),
            ..Surroundings::default()
        };
        step(&mut solver, &mut state, &surroundings, 1.0 / 24.0);
        check(&solver, &state, &rest, "counts");
    }
    assert_eq!(solver.points(&state, 0).len(), 1);
    assert_eq!(solver.points(&state, 3).len(), 500);

    let (mut none, mut state) = Solver::new(&Strands::new(), &Params::default()).unwrap();
    assert_eq!(
        none.step(&mut state, &Surroundings::default(), 0.1)
            .unwrap()
            .strands,
        0
    );
}
