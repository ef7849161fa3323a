//! A level strand that is let go: accuracy in time and space.

use glam::DVec3;
use hair_sim::{Natural, Params, Solver, Surroundings};

use crate::{NEARLY_STRAIGHT, bare, level, tip};

/// Tip positions at 1/24 s, from a spectral solution (Gamma 10) and from 160 links in 64 steps a frame of a planar code in
/// angles (Gamma 100).
fn reference(text: &str) -> Vec<DVec3> {
    text.lines()
        .skip(1)
        .map(|line| {
            let v: Vec<f64> = line.split(',').map(|v| v.parse().unwrap()).collect();
            DVec3::new(v[1], -v[2], 0.0)
        })
        .collect()
}

/// The tip at every 1/24 s of a second, in lengths.
fn drop(gamma: f64, natural: Natural, n: usize, steps: usize) -> Vec<DVec3> {
    damped_drop(gamma, natural, 0.0, n, steps)
}

fn damped_drop(gamma: f64, natural: Natural, damping: f64, n: usize, steps: usize) -> Vec<DVec3> {
    let params = Params {
        natural,
        damping,
        ..bare(gamma)
    };
    let (mut solver, mut state) = Solver::new(&level(n), &params).unwrap();
    let mut path = vec![tip(&solver, &state)];
    for _ in 0..24 {
        for _ in 0..steps {
            let stats = solver
                .step(
                    &mut state,
                    &Surroundings::default(),
                    1.0 / (24 * steps) as f64,
                )
                .unwrap();
            assert_eq!(stats.fallbacks, 0);
        }
        path.push(tip(&solver, &state));
    }
    path
}

/// Root mean square of the distances, without the first.
fn error(path: &[DVec3], reference: &[DVec3]) -> f64 {
    let squares = path.iter().zip(reference).skip(1);
    let sum: f64 = squares.map(|(a, b)| (*a - *b).length_squared()).sum();
    (sum / (path.len() - 1) as f64).sqrt()
}

#[test]
fn a_strand_of_gamma_10_falls_as_the_reference() {
    let truth = reference(include_str!("../data/drop_gamma_10.csv"));
    for natural in NEARLY_STRAIGHT {
        let errors = [1, 2, 4].map(|steps| error(&drop(10.0, natural, 20, steps), &truth));
        println!("gamma 10, {natural:?}, steps of 1/24, 1/48, 1/96: {errors:.4?}");
        // At the last, the error of 20 links itself.
        for (error, most) in errors.into_iter().zip([0.04, 0.009, 0.005]) {
            assert!(error <= most, "{errors:?}");
        }
    }
}

#[test]
fn the_order_in_time_is_two() {
    for natural in NEARLY_STRAIGHT {
        let fine = drop(10.0, natural, 20, 64);
        let errors = [1, 2, 4].map(|steps| error(&drop(10.0, natural, 20, steps), &fine));
        let slope = (errors[0] / errors[2]).log2() / 2.0;
        println!("{natural:?}: slope in dt {slope:.2}");
        assert!(slope >= 1.8, "{slope} {errors:?}");
    }
}

#[test]
fn damping_is_of_second_order() {
    let [straight, bent] = NEARLY_STRAIGHT;
    for (gamma, damping, natural) in [
        (10.0, 0.005, straight),
        (10.0, 0.005, bent),
        (10.0, 0.05, bent),
        (10.0, 0.5, bent),
        (1.0, 0.05, bent),
    ] {
        let drop = |steps| damped_drop(gamma, natural, damping, 20, steps);
        let fine = drop(64);
        let errors = [1, 2, 4, 8].map(|steps| error(&drop(steps), &fine));
        let slope = (errors[1] / errors[3]).log2() / 2.0;
        println!("gamma {gamma}, {natural:?}, damping {damping} s: {errors:.6?}, slope {slope:.2}");
        assert!(slope > 1.5, "{gamma}, {damping}: {slope}");
    }
}

#[test]
fn a_strand_of_gamma_100_falls_as_the_reference() {
    let truth = reference(include_str!("../data/drop_gamma_100.csv"));
    for natural in NEARLY_STRAIGHT {
        let errors = [1, 2, 4].map(|steps| error(&drop(100.0, natural, 20, steps), &truth));
        println!("gamma 100, {natural:?}, steps of 1/24, 1/48, 1/96: {errors:.4?}");
        for (error, most) in errors.into_iter().zip([0.15, 0.08, 0.08]) {
            assert!(error <= most, "{errors:?}");
        }
    }
}
