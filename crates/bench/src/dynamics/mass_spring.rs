//! The springs of `hair_sim::compare` behind this suite's trait.

use super::rods::{Rods, Strand};
use glam::DVec3;
use hair_sim::{Pose, Surroundings, compare};

/// One strand.
#[derive(Clone, Debug)]
pub struct Truss(compare::Zigzag);

impl Truss {
    /// The strand `rods.roots[index]` at rest.
    #[must_use]
    pub fn new(rods: &Rods, index: usize) -> Self {
        Self(compare::Zigzag::new(&rods.points(index), &rods.params()))
    }

    /// Kinetic energy and that of weight and springs without altitudes, per linear density, in m^3/s^2.
    #[must_use]
    pub fn energy(&self) -> f64 {
        self.0.energy(Surroundings::default().gravity)
    }
}

impl Strand for Truss {
    fn step(&mut self, dt: f64, head: Pose) {
        self.0.step(&Surroundings::default(), head, dt, 1);
    }

    fn points(&self) -> Vec<DVec3> {
        self.0.points().collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dynamics::{reference, rods::GRAVITY};

    fn step(truss: &mut Truss, seconds: f64, dt: f64) {
        for _ in 0..(seconds / dt).round() as usize {
            truss.step(dt, Pose::IDENTITY);
        }
    }

    #[test]
    fn a_cantilever_hangs_nearly_as_the_elastica() {
        for (gamma, most) in [(1.0, 0.001), (10.0, 0.04)] {
            let mut rods = Rods::level(1, 20, gamma);
            rods.drag = 20.0;
            let mut truss = Truss::new(&rods, 0);
            step(&mut truss, 10.0, 1.0 / 384.0);
            let tip = truss.points()[20] / rods.length;
            let error = (tip.truncate() - reference::cantilever(gamma)).length();
            assert!(error < most, "gamma {gamma}: {error}");
        }
    }

    #[test]
    fn without_a_head_it_falls_freely() {
        let mut truss = Truss::new(&Rods::level(1, 20, 10.0), 0);
        let start = truss.points();
        let mut fallen = 0.0;
        for k in 1..=10 {
            // Euler's implicit step falls by the velocity at its end; the head falls with it.
            fallen -= GRAVITY * 1e-4 * f64::from(k);
            let translation = DVec3::Y * fallen;
            let head = Pose {
                translation,
                ..Pose::IDENTITY
            };
            truss.step(0.01, head);
        }
        for (a, b) in start.iter().zip(truss.points()) {
            assert!((b - *a - DVec3::Y * fallen).length() < 1e-12, "{a} {b}");
        }
    }

    #[test]
    fn energy_does_not_rise() {
        let weight = GRAVITY * 0.3 * 0.3;
        // Springs of fixed direction make some of it in long steps: much of it at 1/24 s.
        for (dt, most) in [(1.0 / 384.0, 1e-3), (1.0 / 6144.0, 1e-4)] {
            let mut truss = Truss::new(&Rods::level(1, 20, 10.0), 0);
            let start = truss.energy();
            let mut highest = start;
            for _ in 0..24 {
                step(&mut truss, 1.0 / 24.0, dt);
                highest = highest.max(truss.energy());
            }
            let rise = (highest - start) / weight;
            assert!(rise < most, "{dt}: {rise}");
        }
    }

    #[test]
    fn finer_steps_come_nearer_to_the_finest() {
        let tip = |steps: usize| {
            let mut truss = Truss::new(&Rods::level(1, 10, 10.0), 0);
            step(&mut truss, 0.25, 1.0 / (24 * steps) as f64);
            truss.points()[10]
        };
        let finest = tip(1024);
        let errors = [8, 32, 128].map(|steps| (tip(steps) - finest).length());
        let slope = (errors[0] / errors[2]).log2() / 4.0;
        assert!(slope > 0.8, "{slope} {errors:?}");
    }
}
