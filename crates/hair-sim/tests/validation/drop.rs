//! A level strand that is let go: accuracy in time and space.

use glam::{DVec3, Vec3};
use hair_sim::{Acceleration, Natural, Params, Pose, Roots, Solver, Surroundings};

use crate::{NEARLY_STRAIGHT, along, bare, level, tip};

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

/// A strand that hangs down from a root that is moved to and fro, from rest on: the tip at every 1/24 s of a second, in lengths.
fn swing(natural: Natural, n: usize, steps: usize) -> Vec<DVec3> {
    let params = Params {
        natural,
        ..bare(10.0)
    };
    let (mut solver, mut state) = Solver::new(&along(n, Vec3::NEG_Y), &params).unwrap();
    // With this place all derivatives but the fifth and later ones begin at 0.
    let place = |t: f64| 0.1 * t.powi(5) / (0.02 + t.powi(4)) * (4.0 * t).cos();
    let dt = 1.0 / (24 * steps) as f64;
    let pose = |t: f64| Pose {
        translation: DVec3::X * place(t.max(0.0)),
        ..Pose::IDENTITY
    };
    let acceleration = |t: f64| {
        let h = 1e-4;
        Acceleration::between([t - h, t, t + h].map(pose), h)
    };
    let mut path = Vec::new();
    for frame in 0..24 {
        for step in 0..steps {
            let t = (frame * steps + step) as f64 * dt;
            let surroundings = Surroundings {
                roots: Roots::Head(pose(t + dt)),
                acceleration: Some([t, t + dt].map(acceleration)),
                ..Surroundings::default()
            };
            let stats = solver.step(&mut state, &surroundings, dt).unwrap();
            assert_eq!(stats.fallbacks, 0);
        }
        path.push(tip(&solver, &state));
    }
    path
}

/// The slope of the error in the step, from each step to half of it, printed. A strand that is let go from a bent shape at once moves in all
/// its modes, also in those that no step resolves; one that is moved smoothly in those alone that have time to.
#[test]
fn the_order_in_time_hangs_on_the_motion() {
    let steps = [1, 2, 4, 8, 16];
    for natural in NEARLY_STRAIGHT {
        for (name, path) in [
            (
                "let go",
                &drop as &dyn Fn(f64, Natural, usize, usize) -> Vec<DVec3>,
            ),
            ("swung", &|_, natural, n, steps| swing(natural, n, steps)),
        ] {
            let fine = path(10.0, natural, 20, 256);
            let errors = steps.map(|steps| error(&path(10.0, natural, 20, steps), &fine));
            let slopes: Vec<f64> = errors.windows(2).map(|e| (e[0] / e[1]).log2()).collect();
            println!(
                "{name}, {natural:?}: errors in steps of 1/24 to 1/384 s {errors:.6?}, slopes {slopes:.2?}"
            );
            if name == "swung" {
                let slope = (errors[1] / errors[3]).log2() / 2.0;
                assert!(slope >= 1.8, "{slope}");
            }
        }
    }
}
