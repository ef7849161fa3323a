//! Particle-steps a second.

use std::time::Instant;

use glam::Vec3;
use hair_sim::{Params, Scene, Solver, Strands};

fn strands(count: u32, n: usize) -> Strands {
    let mut strands = Strands::new();
    for s in 0..count {
        let angle = s as f32 * 2.399_963;
        let up = 1.0 - 1.2 * s as f32 / count as f32;
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

fn measure(count: u32, n: usize, dt: f64, steps: usize) -> f64 {
    let rest = strands(count, n);
    let (mut solver, mut state) = Solver::new(&rest, &Params::default()).unwrap();
    let mut best = f64::MAX;
    let mut iterations = 0;
    for round in 0..5 {
        let start = Instant::now();
        for i in 0..steps {
            let mut scene = Scene::default();
            scene.gravity.x = 3.0 * ((round * steps + i) as f64 * dt * 3.0).sin();
            let s = solver.step(&mut state, &scene, dt).unwrap();
            iterations += s.iterations;
        }
        best = best.min(start.elapsed().as_secs_f64() / steps as f64);
    }
    let rate = count as f64 * n as f64 / best;
    println!(
        "{count} x {n}: {:.1} us a step, {:.2} M particle-steps a second, {:.2} iterations a stage",
        best * 1e6,
        rate * 1e-6,
        iterations as f64 / (5 * steps * 2 * count as usize) as f64
    );
    rate
}

#[test]
fn particle_steps_a_second() {
    let threads = rayon::current_num_threads();
    println!("{threads} threads");
    measure(72, 20, 1.0 / 60.0, 300);
    measure(10_000, 16, 1.0 / 60.0, 5);
}
