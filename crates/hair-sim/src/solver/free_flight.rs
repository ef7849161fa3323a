//! Momentum of a strand that nothing holds.
//!
//! Roots go where heads take them, so here the strand flies at the end of an arm: two long links, all but without mass, on
//! joints all but without stiffness. Such an arm can hold nothing back. All the rest is the solver as it is.

use super::*;
use crate::{Material, Natural, lanes::Mask};

/// In m.
const LENGTH: f64 = 0.3;
const ARM: f64 = 1.0;
const LINKS: usize = 20;
/// The first link of the strand, behind those of the arm.
const FIRST: usize = 2;
/// The elbow's mass over the strand's: without any it could turn about the line from root to strand as it likes.
const ELBOW: f64 = 1e-9;
/// Stiffness of the arm's joints, and of that between arm and strand, over the strand's.
const SOFT: f64 = 1e-15;

struct Flight {
    solver: Solver,
    state: State,
}

impl Flight {
    /// A level strand that is thrown, spins, and bends as it goes.
    fn new() -> Self {
        let link_m = LENGTH / LINKS as f64;
        let along = DVec3::new(0.0, 0.6, 0.8) * link_m;
        let first = DVec3::new(ARM, ARM, 0.0);
        let mut points = vec![DVec3::ZERO, DVec3::X * ARM];
        points.extend((0..=LINKS).map(|k| first + along * k as f64));
        let points: Vec<Vec3> = points.iter().map(|p| p.as_vec3()).collect();
        let mut strand = Strands::new();
        strand.push(0, &points, None).unwrap();
        let params = Params {
            material: Material::from_gamma(10.0, LENGTH),
            natural: Natural::Styled,
            damping: 0.0,
            drag: 0.0,
            ..Params::default()
        };
        let (mut solver, mut state) = Solver::new(&strand, &params).unwrap();
        let batch = &mut solver.batches[0];
        batch.particles[0].mass[0] = ELBOW * LENGTH;
        batch.particles[1].mass[0] = 0.5 * link_m;
        let stiffness = batch.links[FIRST + 1].bend[0];
        for link in &mut batch.links[..=FIRST] {
            link.bend[0] = SOFT * stiffness;
            link.twist[0] = SOFT * stiffness;
        }
        // The roll of links without inertia is held.
        batch.links[0].twist[0] = stiffness;
        batch.links[1].twist[0] = stiffness;
        // With a goal that doesn't pull: what drives a strand may give it energy, and a goal might.
        batch.has_goal = Mask::NONE.not();

        let batch = &mut state.batches[0];
        let (mut before, mut velocity) = (DVec3::ZERO, DVec3::ZERO);
        for k in 0..batch.y.len() {
            let y = batch.y[k].get(0);
            let spin = match k {
                0 => DVec3::new(0.0, 0.3, -1.0) / ARM,
                1 => DVec3::new(0.5, 0.0, 1.0) / ARM,
                _ => DVec3::new(2.0, 1.0, 2.0 * (0.15 * k as f64).sin()),
            };
            velocity += spin.cross(y - before);
            batch.v[k].set(0, velocity);
            before = y;
        }
        Self { solver, state }
    }

    /// Momentum, and angular momentum about the middle of mass, over the mass per length.
    fn momentum(&self) -> (DVec3, DVec3) {
        let (batch, state) = (&self.solver.batches[0], &self.state.batches[0]);
        let (mut mass, mut first) = (0.0, DVec3::ZERO);
        let (mut linear, mut angular) = (DVec3::ZERO, DVec3::ZERO);
        for k in 0..batch.count() {
            let m = batch.particles[k].mass[0];
            let (y, v) = (state.y[k].get(0), state.v[k].get(0));
            mass += m;
            first += y * m;
            linear += v * m;
            angular += y.cross(v) * m;
        }
        (linear, angular - (first / mass).cross(linear))
    }
}

/// How far momentum and angular momentum have come from what they were after a quarter of a second, of what they were.
fn errors(steps_per_second: u32) -> [f64; 2] {
    let mut flight = Flight::new();
    let surroundings = Surroundings {
        gravity: DVec3::ZERO,
        ..Surroundings::default()
    };
    let (linear, angular) = flight.momentum();
    for _ in 0..steps_per_second / 4 {
        let dt = 1.0 / f64::from(steps_per_second);
        let stats = flight
            .solver
            .step(&mut flight.state, &surroundings, dt)
            .unwrap();
        assert_eq!(stats.fallbacks, 0);
    }
    let (linear_now, angular_now) = flight.momentum();
    [
        (linear_now - linear).length() / linear.length(),
        (angular_now - angular).length() / angular.length(),
    ]
}

#[test]
#[allow(clippy::print_stdout, reason = "documents state its figures")]
fn a_strand_that_flies_freely_keeps_its_momentum_as_steps_get_finer() {
    let errors = [24, 96, 384].map(|steps| {
        let errors = errors(steps);
        let [linear, angular] = errors;
        println!("steps of 1/{steps} s: momentum {linear:.1e}, angular momentum {angular:.1e}");
        errors
    });
    for pair in errors.windows(2) {
        assert!(pair[1][0] < 0.5 * pair[0][0], "{errors:?}");
        assert!(pair[1][1] < 0.1 * pair[0][1], "{errors:?}");
    }
    assert!(errors[2][0] < 1e-4 && errors[2][1] < 1e-5, "{errors:?}");
}
