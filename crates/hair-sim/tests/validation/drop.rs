//! A level strand that is let go: accuracy in time and space.

use std::fmt::Write;

use glam::DVec3;
use hair_sim::{Scene, Solver};

use crate::{bare, level, tip};

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

/// The tip at every 1/24 s of a second, in lengths, and Newton iterations a stage.
fn drop(gamma: f64, n: usize, steps: usize) -> (Vec<DVec3>, f64) {
    let (mut solver, mut state) = Solver::new(&level(n), &bare(gamma)).unwrap();
    let mut path = vec![tip(&solver, &state)];
    let mut iterations = 0;
    for _ in 0..24 {
        for _ in 0..steps {
            let stats = solver
                .step(&mut state, &Scene::default(), 1.0 / (24 * steps) as f64)
                .unwrap();
            iterations += stats.iterations;
            assert_eq!(stats.fallbacks, 0);
        }
        path.push(tip(&solver, &state));
    }
    (path, iterations as f64 / (48 * steps) as f64)
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
    let fine = drop(10.0, 20, 64).0;
    let mut text = String::new();
    let mut own = Vec::new();
    for steps in [1, 2, 4, 8, 16] {
        let (path, iterations) = drop(10.0, 20, steps);
        own.push(error(&path, &fine));
        write!(text, "1/{}: {:.4} {:.5} {iterations:.2}; ", 24 * steps, error(&path, &truth), error(&path, &fine)).unwrap();
    }
    println!("{text}");
}

#[test]
fn a_strand_of_gamma_100_falls_as_the_reference() {
    let truth = reference(include_str!("../data/drop_gamma_100.csv"));
    let fine = drop(100.0, 20, 64).0;
    let mut text = String::new();
    for steps in [1, 2, 4, 8, 16] {
        let (path, iterations) = drop(100.0, 20, steps);
        write!(text, "1/{}: {:.4} {:.5} {iterations:.2}; ", 24 * steps, error(&path, &truth), error(&path, &fine)).unwrap();
    }
    println!("{text}");
}
