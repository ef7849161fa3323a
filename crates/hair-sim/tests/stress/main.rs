//! What breaks hair solvers. Everything stays finite and unstretched, nothing gains energy that nothing drives, and what is
//! impossible is named.

#![allow(clippy::print_stdout, reason = "tests show the figures that they hold")]

mod bits;
mod bodies;
mod broken;
mod energy;
mod extremes;
mod rest;
mod roots;
mod winds;

use glam::{DVec3, Vec3};
use hair_sim::{Solver, State, Strands, Surroundings};

/// Strands that grow from a ball, with curls.
fn style(count: u32, links: usize, length: f32) -> Strands {
    let mut strands = Strands::new();
    for s in 0..count {
        strands.push(s, &strand(s, links, length), None).unwrap();
    }
    strands
}

/// One of them.
fn strand(s: u32, links: usize, length: f32) -> Vec<Vec3> {
    let angle = s as f32 * 2.4;
    let out = Vec3::new(angle.cos(), 0.3, angle.sin()).normalize();
    (0..=links)
        .map(|i| {
            let u = i as f32 / links as f32;
            let curl = Vec3::new((5.0 * u).cos() - 1.0, 0.0, (5.0 * u).sin()) * 0.05;
            out * 0.1 + (out * 0.5 + curl + Vec3::NEG_Y * (0.7 * u)) * (u * length)
        })
        .collect()
}

/// Asserts that every strand is finite and as long as at rest, link by link.
fn check(solver: &Solver, state: &State, rest: &Strands, what: &str) {
    for s in 0..rest.len() {
        let points: Vec<DVec3> = solver.points(state, s).collect();
        assert!(points.iter().all(|p| p.is_finite()), "{what}: strand {s}");
        let total: f64 = points.windows(2).map(|w| (w[1] - w[0]).length()).sum();
        for (now, styled) in points.windows(2).zip(rest.strand(s).windows(2)) {
            let length = (styled[1].as_dvec3() - styled[0].as_dvec3()).length();
            let error = ((now[1] - now[0]).length() - length).abs();
            let far = points[0].length();
            assert!(
                error <= 1e-4 * length + 1e-13 * (total + far),
                "{what}: strand {s} stretches"
            );
        }
        assert!(
            solver
                .frames(state, s)
                .all(|f| (f.length() - 1.0).abs() < 1e-9),
            "{what}"
        );
    }
}

/// Steps, and asserts that nothing is set aside.
fn step(solver: &mut Solver, state: &mut State, surroundings: &Surroundings, dt: f64) -> usize {
    let stats = solver.step(state, surroundings, dt).unwrap();
    assert_eq!(stats.set_aside, 0, "{:?}", solver.faults(state));
    stats.fallbacks
}
