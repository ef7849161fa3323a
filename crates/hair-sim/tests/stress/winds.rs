//! Row 6: storms that turn every frame, and gravity gone mad.

use glam::DVec3;
use hair_sim::{GRAVITY, Material, Params, Solver, Surroundings, Wind};

use crate::{check, step, style};

#[test]
fn gusts_of_100_m_a_second_that_turn_every_frame() {
    for gamma in [0.1, 10.0, 1e3, 1e5] {
        let rest = style(16, 20, 0.3);
        let params = Params {
            material: Material::from_gamma(gamma, 0.3),
            ..Params::default()
        };
        let (mut solver, mut state) = Solver::new(&rest, &params).unwrap();
        let mut fallbacks = 0;
        for i in 0..120 {
            let t = f64::from(i) * 2.4;
            let surroundings = Surroundings {
                wind: Wind {
                    steady: DVec3::new(t.cos(), (1.7 * t).sin(), t.sin()) * 100.0,
                    gust: 50.0,
                    ..Wind::default()
                },
                ..Surroundings::default()
            };
            fallbacks += step(&mut solver, &mut state, &surroundings, 1.0 / 24.0);
            check(&solver, &state, &rest, "storm");
        }
        println!("gamma {gamma}: {fallbacks} fallbacks in {} steps", 120 * 16);
    }
}

#[test]
fn gravity_that_flips_stops_and_grows_a_hundred_times() {
    for gamma in [0.1, 10.0, 1e3, 1e5] {
        let rest = style(16, 20, 0.3);
        let params = Params {
            material: Material::from_gamma(gamma, 0.3),
            ..Params::default()
        };
        let (mut solver, mut state) = Solver::new(&rest, &params).unwrap();
        let mut fallbacks = 0;
        for i in 0..144 {
            let factor = match i % 12 {
                0..3 => 1.0,
                3..6 => -1.0,
                6..9 => 0.0,
                _ => 100.0,
            };
            let surroundings = Surroundings {
                gravity: DVec3::new(0.0, -GRAVITY * factor, 0.0),
                ..Surroundings::default()
            };
            fallbacks += step(&mut solver, &mut state, &surroundings, 1.0 / 24.0);
            check(&solver, &state, &rest, "gravity");
        }
        println!("gamma {gamma}: {fallbacks} fallbacks in {} steps", 144 * 16);
    }
}
