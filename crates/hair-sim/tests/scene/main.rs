//! What acts on hair: roots that move, wind, bodies, goals.

#![allow(clippy::print_stdout, reason = "tests show the figures that they hold")]

mod anchors;
mod bodies;
mod goals;
mod locks;
mod mutual;
mod rate;
mod refused;
mod ridges;
mod roots;
mod sleep;
mod swings;
mod wedged;
mod wind;

use glam::{DVec3, Vec3};
use hair_sim::{
    Collider, Material, Natural, Params, Pose, Roots, Solver, State, Strands, Surroundings, Wind,
};

/// Metres.
const LENGTH: f64 = 0.2;

/// A straight strand of 20 links from `root`.
fn straight(root: Vec3, direction: Vec3) -> Strands {
    let points: Vec<Vec3> = (0..=20)
        .map(|i| root + direction * (LENGTH as f32 * i as f32 / 20.0))
        .collect();
    let mut strands = Strands::new();
    strands.push(7, &points, None).unwrap();
    strands
}

/// A strand of `links` links that hangs by `root`, `length` metres long.
fn line(root: Vec3, links: usize, length: f32) -> Vec<Vec3> {
    let point = |i: usize| root - Vec3::Y * (length * i as f32 / links as f32);
    (0..=links).map(point).collect()
}

/// A step with roots on a head that is there, where nothing else acts but gravity.
fn step_on(head: Pose, solver: &mut Solver, state: &mut State, dt: f64) {
    let surroundings = Surroundings {
        roots: Roots::Head(head),
        ..Surroundings::default()
    };
    solver.step(state, &surroundings, dt).unwrap();
}

fn params(gamma: f64) -> Params {
    Params {
        material: Material::from_gamma(gamma, LENGTH),
        natural: Natural::Styled,
        ..Params::default()
    }
}

fn shape(solver: &Solver, state: &State) -> Vec<DVec3> {
    solver.points(state, 0).collect()
}

fn run(solver: &mut Solver, state: &mut State, surroundings: &Surroundings, dt: f64, steps: usize) {
    for _ in 0..steps {
        let stats = solver.step(state, surroundings, dt).unwrap();
        assert_eq!(stats.set_aside, 0);
    }
}

/// The shape of the first of `strands` after `steps` in a scene.
fn after(
    strands: &Strands,
    params: &Params,
    surroundings: &Surroundings,
    dt: f64,
    steps: usize,
) -> Vec<DVec3> {
    let (mut solver, mut state) = Solver::new(strands, params).unwrap();
    run(&mut solver, &mut state, surroundings, dt, steps);
    shape(&solver, &state)
}

/// These bodies, and nothing else that is out of the ordinary.
fn among<'a>(colliders: &'a [Collider<'a>]) -> Surroundings<'a> {
    Surroundings {
        colliders,
        ..Surroundings::default()
    }
}

/// This wind, and nothing else that is out of the ordinary.
fn in_wind(wind: Wind) -> Surroundings<'static> {
    Surroundings {
        wind,
        ..Surroundings::default()
    }
}

fn farthest(a: &[DVec3], b: &[DVec3]) -> f64 {
    (a.iter().zip(b))
        .map(|(a, b)| (*a - *b).length())
        .fold(0.0, f64::max)
}
