//! Extended position based dynamics of rods, for comparison: particles and a quaternion a link.
//!
//! Rods of Kugelstadt and Schömer 2016, *Position and Orientation Based Cosserat Rods* (their constraints of stretch and
//! shear and of bending and twist), solved as Macklin et al. 2016, *XPBD*, say (algorithm 1): their compliance makes the
//! stiffness physical, and Gauss-Seidel sweeps leave an error that more sweeps or more steps lessen.

use super::rods::{GRAVITY, Rods, Strand, TWIST_RATIO};
use glam::{DQuat, DVec3};
use hair_sim::Pose;

/// The inertia of a link's quaternion against turning, over mass x length^2 of the link. That of the particles is right
/// without it, so it is an error of second order in the length; less of it needs many more sweeps. This one
/// has the least error in equal time on the falling strand, of 1/120 to 1/3.
const INERTIA: f64 = 1.0 / 3.0;

/// One strand.
#[derive(Clone, Debug)]
pub struct Rod {
    /// Sweeps a step.
    iterations: usize,
    /// Of a link, in m.
    length: f64,
    /// 1/s.
    drag: f64,
    /// Stiffness of a whole joint against bending (first and second component) and twist: energy is half of it times
    /// the square of the vector part of the joint's quaternion. Per linear density.
    stiffness: DVec3,
    /// Inverse masses of the particles; 0 for the root.
    lightness: Vec<f64>,
    /// Inverse inertia of the components of a link's quaternion.
    turn_lightness: f64,
    /// Root and frame of the skin in style space.
    root: (DVec3, DQuat),
    points: Vec<DVec3>,
    velocities: Vec<DVec3>,
    /// The frame of the skin, then of each link: the third axis points along the link.
    frames: Vec<DQuat>,
    /// Angular velocities in the world, in rad/s; of the skin too, though it is not read.
    spins: Vec<DVec3>,
    scratch: Scratch,
}

/// What a step begins with, and its Lagrange multipliers.
#[derive(Clone, Debug)]
struct Scratch {
    points: Vec<DVec3>,
    frames: Vec<DQuat>,
    stretch: Vec<DVec3>,
    bend: Vec<DVec3>,
}

impl Rod {
    /// The strand `rods.roots[index]` at rest, solved by `iterations` sweeps a step.
    #[must_use]
    pub fn new(rods: &Rods, index: usize, iterations: usize) -> Self {
        let n = rods.elements;
        let (root, direction) = rods.roots[index];
        let length = rods.element();
        let frame = DQuat::from_rotation_arc(DVec3::Z, direction);
        let mass = |i: usize| if i == n { 0.5 * length } else { length };
        // Half a joint's turn is the vector part, so 4 times EI / length.
        let bend = 4.0 * rods.bending() / length;
        let inertia = INERTIA * length.powi(3);
        Self {
            iterations,
            length,
            drag: rods.drag,
            stiffness: DVec3::new(bend, bend, bend * TWIST_RATIO),
            lightness: (0..=n)
                .map(|i| if i == 0 { 0.0 } else { 1.0 / mass(i) })
                .collect(),
            // Energy 1/2 J |omega|^2 is 1/2 (4 J) |dq/dt|^2.
            turn_lightness: 1.0 / (4.0 * inertia),
            root: (root, frame),
            points: (0..=n)
                .map(|i| root + direction * (length * i as f64))
                .collect(),
            velocities: vec![DVec3::ZERO; n + 1],
            frames: vec![frame; n + 1],
            spins: vec![DVec3::ZERO; n + 1],
            scratch: Scratch {
                points: vec![DVec3::ZERO; n + 1],
                frames: vec![DQuat::IDENTITY; n + 1],
                stretch: vec![DVec3::ZERO; n],
                bend: vec![DVec3::ZERO; n],
            },
        }
    }

    fn links(&self) -> usize {
        self.points.len() - 1
    }

    /// Moves all by its velocity; the root and the skin go where the head takes them.
    fn predict(&mut self, dt: f64, head: Pose) {
        self.scratch.points.copy_from_slice(&self.points);
        self.scratch.frames.copy_from_slice(&self.frames);
        self.scratch.stretch.fill(DVec3::ZERO);
        self.scratch.bend.fill(DVec3::ZERO);
        let slower = 1.0 / (1.0 + self.drag * dt);
        for (point, velocity) in self.points.iter_mut().zip(&mut self.velocities) {
            *velocity = (*velocity - DVec3::Y * (GRAVITY * dt)) * slower;
            *point += *velocity * dt;
        }
        for (frame, spin) in self.frames.iter_mut().zip(&self.spins) {
            *frame = (*frame + pure(*spin) * *frame * (0.5 * dt)).normalize();
        }
        self.points[0] = head.translation + head.rotation * self.root.0;
        self.frames[0] = head.rotation * self.root.1;
    }

    /// Keeps the link `k` at its length and along its frame.
    fn project_stretch(&mut self, k: usize) {
        let along = self.frames[k + 1] * DVec3::Z;
        let error = (self.points[k + 1] - self.points[k]) / self.length - along;
        let (a, b) = (self.lightness[k], self.lightness[k + 1]);
        let weight = (a + b) / (self.length * self.length) + 4.0 * self.turn_lightness;
        // Without compliance: hair doesn't stretch.
        let push = -error / weight;
        self.scratch.stretch[k] += push;
        self.points[k] -= push * (a / self.length);
        self.points[k + 1] += push * (b / self.length);
        let frame = self.frames[k + 1];
        let turn = pure(push) * frame * pure(DVec3::Z) * (2.0 * self.turn_lightness);
        self.frames[k + 1] = (frame + turn).normalize();
    }

    /// Pulls the turn of the joint before link `k` towards straight; before the first link is the skin.
    fn project_bend(&mut self, k: usize, dt: f64) {
        let (before, after) = (self.frames[k], self.frames[k + 1]);
        let joint = before.conjugate() * after;
        // Of the two quaternions of a turn, the shorter way.
        let error = pure_part(joint) * joint.w.signum();
        let (a, b) = match k {
            0 => (0.0, self.turn_lightness),
            _ => (self.turn_lightness, self.turn_lightness),
        };
        // Half a link from the skin to the first link: twice as stiff.
        let stiffness = self.stiffness * if k == 0 { 2.0 } else { 1.0 };
        let compliance = (stiffness * (dt * dt)).recip();
        let multiplier = self.scratch.bend[k];
        let push = -(error + compliance * multiplier) / (DVec3::splat(a + b) + compliance);
        self.scratch.bend[k] += push;
        let push = pure(push * joint.w.signum());
        self.frames[k] = (before + after * push * -a).normalize();
        self.frames[k + 1] = (after + before * push * b).normalize();
    }

    /// Kinetic energy and that of weight and bending, per linear density, in m^3/s^2.
    #[must_use]
    pub fn energy(&self) -> f64 {
        let mut energy = 0.0;
        for i in 1..self.points.len() {
            let mass = 1.0 / self.lightness[i];
            energy +=
                mass * (0.5 * self.velocities[i].length_squared() + GRAVITY * self.points[i].y);
            let inertia = 1.0 / (4.0 * self.turn_lightness);
            energy += 0.5 * inertia * self.spins[i].length_squared();
            let turn = pure_part(self.frames[i - 1].conjugate() * self.frames[i]);
            let half = if i == 1 { 2.0 } else { 1.0 };
            energy += 0.5 * half * (self.stiffness * turn * turn).element_sum();
        }
        energy
    }
}

impl Strand for Rod {
    fn step(&mut self, dt: f64, head: Pose) {
        self.predict(dt, head);
        for iteration in 0..self.iterations {
            // To and fro, so that both ends hear of each other.
            for k in 0..self.links() {
                let k = if iteration % 2 == 0 {
                    k
                } else {
                    self.links() - 1 - k
                };
                self.project_stretch(k);
                self.project_bend(k, dt);
            }
        }
        for (i, velocity) in self.velocities.iter_mut().enumerate() {
            *velocity = (self.points[i] - self.scratch.points[i]) / dt;
            let turn = self.frames[i] * self.scratch.frames[i].conjugate();
            self.spins[i] = pure_part(turn) * (2.0 * turn.w.signum() / dt);
        }
    }

    fn points(&self) -> Vec<DVec3> {
        self.points.clone()
    }
}

fn pure(v: DVec3) -> DQuat {
    DQuat::from_xyzw(v.x, v.y, v.z, 0.0)
}

fn pure_part(q: DQuat) -> DVec3 {
    DVec3::new(q.x, q.y, q.z)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dynamics::reference;

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
