//! The position based rods of `hair_sim::compare` behind this suite's trait.

use super::rods::{Rods, Strand};
use glam::DVec3;
use hair_sim::{Pose, Surroundings, compare};

/// One strand.
#[derive(Clone, Debug)]
pub struct Rod {
    rod: compare::Rod,
    /// A step.
    sweeps: u32,
}

impl Rod {
    /// The strand `rods.roots[index]` at rest, solved by `sweeps` a step.
    #[must_use]
    pub fn new(rods: &Rods, index: usize, sweeps: usize) -> Self {
        Self {
            rod: compare::Rod::new(&rods.points(index), &rods.params()),
            sweeps: sweeps as u32,
        }
    }

    /// Kinetic energy and that of weight and bending, per linear density, in m^3/s^2.
    #[must_use]
    pub fn energy(&self) -> f64 {
        self.rod.energy(Surroundings::default().gravity)
    }
}

impl Strand for Rod {
    fn step(&mut self, dt: f64, head: Pose) {
        self.rod
            .step(&Surroundings::default(), head, dt, 1, self.sweeps);
    }

    fn points(&self) -> Vec<DVec3> {
        self.rod.points().to_vec()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dynamics::{reference, rods::GRAVITY};
    use glam::DQuat;

    fn step(rod: &mut Rod, seconds: f64, dt: f64) {
        for _ in 0..(seconds / dt).round() as usize {
            rod.step(dt, Pose::IDENTITY);
        }
    }

    #[test]
    fn a_cantilever_with_enough_sweeps_hangs_as_the_elastica() {
        let truth = reference::cantilever(10.0);
        let error = |iterations| {
            let mut rods = Rods::level(1, 10, 10.0);
            rods.drag = 20.0;
            let mut rod = Rod::new(&rods, 0, iterations);
            step(&mut rod, 5.0, 1.0 / 960.0);
            (rod.points()[10].truncate() / rods.length - truth).length()
        };
        let [few, many] = [2, 40].map(error);
        assert!(many < 0.005, "{many}");
        // What the sweeps leave is an error of the shape at rest.
        assert!(few > 2.0 * many, "{few} {many}");
    }

    #[test]
    fn without_a_head_it_falls_freely() {
        let mut rod = Rod::new(&Rods::level(1, 20, 10.0), 0, 5);
        let start = rod.points();
        let mut fallen = 0.0;
        for k in 1..=10 {
            fallen -= GRAVITY * 1e-4 * f64::from(k);
            let translation = DVec3::Y * fallen;
            rod.step(
                0.01,
                Pose {
                    translation,
                    ..Pose::IDENTITY
                },
            );
        }
        for (a, b) in start.iter().zip(rod.points()) {
            assert!((b - *a - DVec3::Y * fallen).length() < 1e-12, "{a} {b}");
        }
    }

    #[test]
    fn energy_does_not_rise() {
        for dt in [1.0 / 1536.0, 1.0 / 6144.0] {
            let mut rod = Rod::new(&Rods::level(1, 20, 10.0), 0, 10);
            let start = rod.energy();
            for _ in 0..24 {
                step(&mut rod, 1.0 / 24.0, dt);
                assert!(
                    rod.energy() <= start + 1e-6,
                    "{dt}: {} {start}",
                    rod.energy()
                );
            }
        }
    }

    #[test]
    fn finer_steps_come_nearer_to_the_truth() {
        let frame = (9.81_f64 / 0.3).sqrt() / 24.0;
        let truth = reference::drop(10.0, 20, frame, 6)[6];
        let errors = [16, 64, 256].map(|steps: usize| {
            let mut rod = Rod::new(&Rods::level(1, 20, 10.0), 0, 40);
            step(&mut rod, 0.25, 1.0 / (24 * steps) as f64);
            (rod.points()[20].truncate() / 0.3 - truth).length()
        });
        assert!(
            errors[1] < 0.6 * errors[0] && errors[2] < errors[1],
            "{errors:?}"
        );
        // What is left is that of 20 links.
        assert!(errors[2] < 0.01, "{errors:?}");
    }

    #[test]
    fn a_turned_head_turns_the_strand() {
        let mut rod = Rod::new(&Rods::level(1, 10, 0.01), 0, 50);
        let angle = std::f64::consts::FRAC_PI_2;
        for k in 1..=2000 {
            let rotation = DQuat::from_rotation_y(angle * (f64::from(k) / 1000.0).min(1.0));
            rod.step(
                1e-3,
                Pose {
                    rotation,
                    translation: DVec3::ZERO,
                },
            );
        }
        // A bristle follows: +X has become -Z.
        let tip = rod.points()[10] / 0.3;
        assert!((tip - DVec3::NEG_Z).length() < 0.05, "{tip}");
    }
}
