//! Particle-steps a second.

#![allow(clippy::print_stdout, reason = "tests show the figures that they hold")]

use std::time::Instant;

use glam::{DVec3, Vec3};
use hair_sim::{
    Collider, Mutual, Params, Pose, Shape, SignedDistance, Solver, Strands, Surroundings, Wind,
};

fn strands(count: u32, n: usize) -> Strands {
    let mut strands = Strands::new();
    for s in 0..count {
        let angle = s as f32 * 2.399_963;
        let up = 1.0 - 1.2 * (s as f32 + 0.5) / count as f32;
        let level = (1.0 - up * up).sqrt();
        let out = Vec3::new(level * angle.cos(), up, level * angle.sin());
        let points: Vec<Vec3> = (0..n)
            .map(|i| {
                let u = i as f32 / (n - 1) as f32;
                out * (0.1 + 0.1 * u) + Vec3::NEG_Y * (0.2 * u * u)
            })
            .collect();
        strands.push(s, &points, None).unwrap();
    }
    strands
}

const RUNS: usize = 80;

/// A ball of triangles.
fn head() -> SignedDistance {
    let (rings, around) = (40_u32, 80_u32);
    let mut points = Vec::new();
    let mut triangles = Vec::new();
    for i in 0..=rings {
        let polar = std::f32::consts::PI * i as f32 / rings as f32;
        for j in 0..around {
            let angle = std::f32::consts::TAU * j as f32 / around as f32;
            let level = polar.sin();
            points.push(Vec3::new(level * angle.cos(), polar.cos(), level * angle.sin()) * 0.1);
            if i < rings {
                let (a, b) = (i * around + j, i * around + (j + 1) % around);
                triangles.push([a, b, b + around]);
                triangles.push([a, b + around, a + around]);
            }
        }
    }
    SignedDistance::new(&points, &triangles, 0.005).unwrap()
}

/// The best of many short runs, so that other work on the machine does not count. All of head, wind and the other hair must have acted in every run.
fn measure(
    (count, n): (u32, usize),
    dt: f64,
    steps: usize,
    everything: bool,
    lock_radius: f64,
) -> f64 {
    let rest = strands(count, n);
    let params = Params {
        lock_radius,
        ..Params::default()
    };
    let head = head();
    let (mut solver, mut state) = Solver::new(&rest, &params).unwrap();
    if everything {
        let mutual = Mutual {
            neighbours: 2,
            reach: 0.05,
            distance: 0.05,
            ..Mutual::default()
        };
        solver.interact(&mut state, &mutual).unwrap();
    }
    let colliders = [Collider::fixed(Shape::Grid(&head), Pose::IDENTITY)];
    let mut best = f64::MAX;
    let (mut iterations, mut fallbacks, mut meetings) = (0, 0, 0);
    for _ in 0..RUNS {
        let (mut contacts, mut wind, mut links, mut repulsions) = (0, 0, 0, 0);
        let start = Instant::now();
        for _ in 0..steps {
            let mut surroundings = Surroundings {
                wind: Wind {
                    steady: DVec3::new(1.0, 0.0, 0.5),
                    gust: 1.5,
                    ..Wind::default()
                },
                ..Surroundings::default()
            };
            if everything {
                surroundings.colliders = &colliders;
            }
            let s = solver.step(&mut state, &surroundings, dt).unwrap();
            iterations += s.iterations;
            fallbacks += s.fallbacks;
            meetings += s.meetings;
            contacts += s.contacts;
            wind += s.wind;
            links += s.links;
            repulsions += s.repulsions;
        }
        best = best.min(start.elapsed().as_secs_f64() / steps as f64);
        assert!(wind > 0);
        if everything && steps > 1 {
            assert!(contacts > 0 && links > 0 && repulsions > 0);
        }
    }
    let rate = count as f64 * n as f64 / best;
    let strand_steps = (RUNS * steps * count as usize) as f64;
    assert_eq!(meetings > 0, lock_radius > 0.0);
    println!(
        "{count} x {n}, {}{}: {:.1} us a step, {:.2} M particle-steps a second, {:.2} iterations a stage, {:.3} % fallbacks",
        if everything {
            "head, wind and hair"
        } else {
            "wind"
        },
        if lock_radius > 0.0 { ", locks" } else { "" },
        best * 1e6,
        rate * 1e-6,
        iterations as f64 / (2.0 * strand_steps),
        fallbacks as f64 / strand_steps * 100.0,
    );
    assert!(fallbacks as f64 <= 0.01 * strand_steps);
    rate
}

#[test]
fn particle_steps_a_second() {
    println!("{} threads", rayon::current_num_threads());
    // One strand alone fills an eighth of a batch.
    measure((1, 20), 1.0 / 24.0, 10, false, 0.0);
    for everything in [false, true] {
        // Far below what is measured on an idle machine: this one may be busy.
        assert!(measure((72, 20), 1.0 / 60.0, 10, everything, 0.0) > 2e5);
        assert!(measure((10_000, 16), 1.0 / 120.0, 1, everything, 0.0) > 2e5);
    }
}

/// What it costs that locks don't pass through each other, shown.
#[test]
fn locks_cost() {
    for lock_radius in [0.0, 0.003, 0.006] {
        assert!(measure((72, 20), 1.0 / 60.0, 10, true, lock_radius) > 5e4);
    }
}
