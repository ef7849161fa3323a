//! The solver against closed forms and reference solutions: the tests of Romero et al. 2021, *Physical validation
//! of simulators in computer graphics*, and more.

#![allow(clippy::print_stdout, reason = "tests show the figures that they hold")]

mod drop;
mod start;
mod statics;
mod vibration;

use glam::{DVec3, Vec3};
use hair_sim::{Material, Natural, Params, Solver, State, Strands, Surroundings};

/// Metres: the length of the strands of these tests.
const LENGTH: f64 = 0.3;

/// A straight strand of `n` links along +X from the origin.
fn level(n: usize) -> Strands {
    along(n, Vec3::X)
}

/// A straight strand of `n` links along `direction` from the origin.
fn along(n: usize, direction: Vec3) -> Strands {
    let points: Vec<Vec3> = (0..=n)
        .map(|i| direction * (LENGTH as f32 * i as f32 / n as f32))
        .collect();
    let mut strands = Strands::new();
    strands.push(0, &points, None).unwrap();
    strands
}

/// Straight, and so little bent that nothing shows but that it is solved as all that is not straight.
const NEARLY_STRAIGHT: [Natural; 2] = [
    Natural::Styled,
    Natural::Curl {
        curvature: 1e-6,
        torsion: 0.0,
    },
];

/// Undamped, without air, straight by nature.
fn bare(gamma: f64) -> Params {
    Params {
        material: Material::from_gamma(gamma, LENGTH),
        natural: Natural::Styled,
        damping: 0.0,
        drag: 0.0,
        ..Params::default()
    }
}

/// The tip of the first strand, in lengths.
fn tip(solver: &Solver, state: &State) -> DVec3 {
    solver.points(state, 0).last().unwrap() / LENGTH
}

/// Steps until nothing moves any more, by heavy damping; fails if that takes too long.
fn settle(solver: &mut Solver, state: &mut State, surroundings: &Surroundings) {
    let mut before: Vec<DVec3> = solver.points(state, 0).collect();
    for _ in 0..4000 {
        solver.step(state, surroundings, 0.25).unwrap();
        let now: Vec<DVec3> = solver.points(state, 0).collect();
        let moved = (before.iter().zip(&now)).map(|(a, b)| (*a - *b).length());
        if moved.fold(0.0, f64::max) < 1e-9 * LENGTH {
            return;
        }
        before = now;
    }
    panic!("the strand does not come to rest");
}
