//! Row 8: hours at rest, energy, and a rest that does not hang on the step.

use glam::{DVec3, Vec3};
use hair_sim::{GRAVITY, Material, Natural, Params, Solver, Strands, Surroundings};

use crate::{check, step, style};

#[test]
fn an_hour_at_rest() {
    let rest = style(8, 20, 0.3);
    for gamma in [1.0, 10.0] {
        let params = Params {
            material: Material::from_gamma(gamma, 0.3),
            ..Params::default()
        };
        let (mut solver, mut state) = Solver::new(&rest, &params).unwrap();
        let before: Vec<DVec3> = (0..8).flat_map(|s| solver.points(&state, s)).collect();
        for _ in 0..3600 * 24 {
            solver
                .step(&mut state, &Surroundings::default(), 1.0 / 24.0)
                .unwrap();
        }
        let after = (0..8).flat_map(|s| solver.points(&state, s));
        let drift = before
            .iter()
            .zip(after)
            .map(|(a, b)| (*a - b).length())
            .fold(0.0, f64::max)
            / 0.3;
        println!("gamma {gamma}: drift after an hour {drift:.1e} L");
        assert!(drift <= 1e-5, "{drift}");
    }
}

#[test]
fn the_energy_of_an_undamped_strand_stays() {
    let points: Vec<Vec3> = (0..=20)
        .map(|i| Vec3::X * (0.3 * i as f32 / 20.0))
        .collect();
    let mut rest = Strands::new();
    rest.push(0, &points, None).unwrap();
    for (gamma, steps) in [(1.0, 240), (10.0, 96), (10.0, 240), (100.0, 240)] {
        let params = Params {
            material: Material::from_gamma(gamma, 0.3),
            natural: Natural::Styled,
            damping: 0.0,
            drag: 0.0,
            ..Params::default()
        };
        let (mut solver, mut state) = Solver::new(&rest, &params).unwrap();
        let surroundings = Surroundings::default();
        let scale = GRAVITY * 0.3 * 0.3;
        let (mut least, mut most) = (0.0_f64, 0.0_f64);
        for _ in 0..steps * 30 {
            step(
                &mut solver,
                &mut state,
                &surroundings,
                1.0 / f64::from(steps),
            );
            let energy = solver.energy(&state, 0, surroundings.gravity) / scale;
            (least, most) = (least.min(energy), most.max(energy));
        }
        check(&solver, &state, &rest, "energy");
        println!("gamma {gamma}, 1/{steps}, 30 s: from {least:.4} to {most:.4} m g L");
        assert!(most < 0.01, "{most}");
        assert!(least > -0.5, "{least}");
    }
}

#[test]
fn the_rest_does_not_hang_on_the_step() {
    let rest = style(8, 20, 0.3);
    for gamma in [1.0, 10.0, 100.0] {
        let params = Params {
            material: Material::from_gamma(gamma, 0.3),
            natural: Natural::Styled,
            damping: 0.1,
            drag: 10.0,
            ..Params::default()
        };
        let [coarse, fine] = [24, 120].map(|steps: usize| {
            let (mut solver, mut state) = Solver::new(&rest, &params).unwrap();
            for _ in 0..60 * steps {
                step(
                    &mut solver,
                    &mut state,
                    &Surroundings::default(),
                    1.0 / steps as f64,
                );
            }
            (0..8)
                .flat_map(|s| solver.points(&state, s))
                .collect::<Vec<DVec3>>()
        });
        let error = coarse
            .iter()
            .zip(&fine)
            .map(|(a, b)| (*a - *b).length())
            .fold(0.0, f64::max)
            / 0.3;
        println!("gamma {gamma}: {error:.1e} L");
        assert!(error <= 1e-4, "gamma {gamma}: {error}");
    }
}
