//! Hair of masses and springs, for comparison: Selle, Lentine and Fedkiw 2008, *A Mass Spring Model for Hair
//! Simulation*.
//!
//! A straight strand has no triangles, so half way between its particles stand others aside of it. Of the
//! zigzag of both, each particle has a spring to the next (edge), to the one after it (bending) and to the third
//! (torsion): every four particles in a row are a tetrahedron, and its shortest altitude has a spring too, that keeps
//! it from collapsing. Springs are linear along the direction that they have when the step begins, so that a
//! step solves one linear system; here it is a band matrix, solved exactly. The step is Euler's implicit one:
//! the paper's middle point was tried here, and diverges on the falling strand at steps of 1/1536 s and longer.
//!
//! The paper's stiffnesses are free. Here the edges hold the strand's length and the others are set so
//! that the strand at rest, lightly loaded, bends as a rod of the given stiffness does.

use super::altitudes::{Altitude, altitudes};
use super::banded::Banded;
use super::rods::{GRAVITY, Rods, Strand};
use glam::{DMat3, DVec3};
use hair_sim::Pose;

/// Distance of the particles aside of the strand, in elements.
const ASIDE: f64 = 0.5;
/// The part of its length at rest below which an altitude's spring acts. Were it to act always, it would change how the
/// strand bends, and each time another altitude becomes the shortest.
const COLLAPSED: f64 = 0.7;
/// The zigzag's particles that the head holds: one before the root, one aside, the root.
const HELD: usize = 3;
/// Unknowns of four particles in a row, of which any two are in a spring.
const BAND: usize = 12;
/// Of the strand's weight: the force that would double the length of an edge.
const STRETCH: f64 = 1000.0;

/// One strand.
#[derive(Clone, Debug)]
pub struct Truss {
    /// 1/s.
    drag: f64,
    springs: Vec<Spring>,
    tetrahedra: Vec<[f64; 7]>,
    /// Stiffness of altitudes, a force at double length.
    altitude: f64,
    masses: Vec<f64>,
    /// The held particles in style space.
    held: [DVec3; HELD],
    points: Vec<DVec3>,
    velocities: Vec<DVec3>,
    matrix: Banded<BAND>,
    right: Vec<f64>,
}

/// A spring between two particles.
#[derive(Clone, Copy, Debug)]
struct Spring {
    a: usize,
    b: usize,
    /// In m.
    length: f64,
    /// Force a metre, per linear density, in m/s^2 (m of strand for mass).
    stiffness: f64,
}

impl Truss {
    /// The strand `rods.roots[index]` at rest.
    #[must_use]
    pub fn new(rods: &Rods, index: usize) -> Self {
        // All strands bend alike: the loaded one may be any.
        Self::with(rods, index, bending_share(rods))
    }

    /// `share`: the force of a bending or torsion spring at double length over EI / element^2.
    fn with(rods: &Rods, index: usize, share: f64) -> Self {
        let (root, direction) = rods.roots[index];
        let element = rods.element();
        let across = Rods::across(direction);
        let sides = [across, direction.cross(across)];
        // Before the root: a particle of the strand and one aside. Then the root, aside, the strand's next, ...
        let count = 2 * rods.elements + HELD;
        let points: Vec<DVec3> = (0..count)
            .map(|i| {
                let along = root + direction * (0.5 * element * (i as f64 - 2.0));
                match i % 2 {
                    0 => along,
                    // A quarter turn from each to the next, so that no tetrahedron is flat.
                    _ => {
                        along
                            + sides[i / 2 % 2]
                                * (ASIDE * element * if i / 4 % 2 == 0 { 1.0 } else { -1.0 })
                    }
                }
            })
            .collect();
        let bending = rods.bending() / (element * element);
        let stretch = STRETCH * GRAVITY * rods.length + 100.0 * bending;
        let mut springs = Vec::new();
        for reach in 1..=3 {
            for a in 0..count - reach {
                let b = a + reach;
                if b < HELD {
                    continue;
                }
                let length = (points[b] - points[a]).length();
                let is_edge = reach == 1 || reach == 2 && a % 2 == 0;
                let force = if is_edge { stretch } else { share * bending };
                springs.push(Spring {
                    a,
                    b,
                    length,
                    stiffness: force / length,
                });
            }
        }
        let tetrahedra = (0..count - 3)
            .map(|k| altitudes(&points[k..k + 4]).map(|altitude| altitude.length))
            .collect();
        let mass = |i: usize| {
            if i + 1 == count {
                0.25 * element
            } else {
                0.5 * element
            }
        };
        Self {
            drag: rods.drag,
            springs,
            tetrahedra,
            altitude: share * bending,
            masses: (0..count).map(mass).collect(),
            held: [points[0], points[1], points[2]],
            velocities: vec![DVec3::ZERO; count],
            matrix: Banded::new(3 * (count - HELD)),
            right: vec![0.0; 3 * (count - HELD)],
            points,
        }
    }

    /// Begins a system: `inertia` of each free particle on the diagonal, `right` side zero.
    fn begin(&mut self, inertia: impl Fn(f64) -> f64) {
        self.matrix.clear();
        self.right.fill(0.0);
        for i in HELD..self.points.len() {
            for axis in 0..3 {
                let row = 3 * (i - HELD) + axis;
                *self.matrix.at(row, row) = inertia(self.masses[i]);
            }
        }
    }

    /// Adds a spring between weighted sums of four particles in a row: `factor` x its stiffness to the matrix and
    /// `push` x its force to the right side.
    fn add(
        &mut self,
        first: usize,
        spring: &Altitude,
        rest: f64,
        stiffness: f64,
        [factor, push]: [f64; 2],
    ) {
        // The force now, and what the head's motion adds to it within the step.
        let held = spring.weights.iter().zip(&self.velocities[first..]);
        let held: DVec3 = held
            .take(HELD.saturating_sub(first))
            .map(|(weight, velocity)| *velocity * *weight)
            .sum();
        let force =
            stiffness * (push * (spring.length - rest) + factor * spring.direction.dot(held));
        let block = DMat3::from_cols(
            spring.direction * spring.direction.x,
            spring.direction * spring.direction.y,
            spring.direction * spring.direction.z,
        ) * (factor * stiffness);
        for (k, weight) in spring.weights.iter().enumerate() {
            if first + k < HELD || *weight == 0.0 {
                continue;
            }
            let row = 3 * (first + k - HELD);
            for axis in 0..3 {
                self.right[row + axis] -= force * weight * spring.direction[axis];
            }
            for (j, other) in spring.weights.iter().enumerate().take(k + 1) {
                if first + j < HELD || *other == 0.0 {
                    continue;
                }
                let column = 3 * (first + j - HELD);
                for r in 0..3 {
                    for c in 0..3 {
                        if column + c <= row + r {
                            *self.matrix.at(row + r, column + c) +=
                                weight * other * block.col(c)[r];
                        }
                    }
                }
            }
        }
    }

    /// Adds all springs as they are now.
    fn add_springs(&mut self, scale: [f64; 2]) {
        for index in 0..self.springs.len() {
            let spring = self.springs[index];
            let way = self.points[spring.b] - self.points[spring.a];
            let mut weights = [0.0; 4];
            weights[0] = -1.0;
            weights[spring.b - spring.a] = 1.0;
            let length = way.length();
            let line = Altitude {
                weights,
                length,
                direction: way / length,
            };
            self.add(spring.a, &line, spring.length, spring.stiffness, scale);
        }
        for k in 0..self.tetrahedra.len() {
            let now = altitudes(&self.points[k..k + 4]);
            // The shortest alone.
            let Some(least) = (0..7).min_by(|a, b| now[*a].length.total_cmp(&now[*b].length))
            else {
                continue;
            };
            let rest = self.tetrahedra[k][least] * COLLAPSED;
            if now[least].length >= rest {
                continue;
            }
            self.add(k, &now[least], rest, self.altitude / rest, scale);
        }
    }

    /// Kinetic energy and that of weight and springs without altitudes, per linear density, in m^3/s^2.
    #[must_use]
    pub fn energy(&self) -> f64 {
        let mut energy = 0.0;
        for i in HELD..self.points.len() {
            let moving = 0.5 * self.velocities[i].length_squared();
            energy += self.masses[i] * (moving + GRAVITY * self.points[i].y);
        }
        for spring in &self.springs {
            let longer = (self.points[spring.b] - self.points[spring.a]).length() - spring.length;
            energy += 0.5 * spring.stiffness * longer * longer;
        }
        energy
    }
}

impl Strand for Truss {
    fn step(&mut self, dt: f64, head: Pose) {
        let held = self
            .held
            .map(|held| head.translation + head.rotation * held);
        for (i, to) in held.iter().enumerate() {
            self.velocities[i] = (*to - self.points[i]) / dt;
        }
        let slow = 1.0 + self.drag * dt;
        self.begin(|mass| mass * slow);
        self.add_springs([dt * dt, dt]);
        for i in HELD..self.points.len() {
            let momentum = (self.velocities[i] - DVec3::Y * (GRAVITY * dt)) * self.masses[i];
            for axis in 0..3 {
                self.right[3 * (i - HELD) + axis] += momentum[axis];
            }
        }
        let is_solved = self.matrix.solve(&mut self.right);
        self.points[..HELD].copy_from_slice(&held);
        for i in HELD..self.points.len() {
            let row = 3 * (i - HELD);
            let solution = DVec3::from_slice(&self.right[row..row + 3]);
            self.velocities[i] = if is_solved { solution } else { DVec3::NAN };
            self.points[i] += self.velocities[i] * dt;
        }
    }

    fn points(&self) -> Vec<DVec3> {
        let free = self.points.iter().skip(HELD - 1);
        free.step_by(2).copied().collect()
    }
}

/// The stiffness of bending and torsion springs at which a strand, clamped level and lightly loaded, hangs by w L^4 / 8 EI
/// at its tip.
fn bending_share(rods: &Rods) -> f64 {
    let rod = Rods {
        roots: vec![(DVec3::ZERO, DVec3::X)],
        ..rods.clone()
    };
    let expected = rods.length.powi(4) / (8.0 * rods.bending());
    let mut share = 4.0;
    for _ in 0..60 {
        // Aside particles stand in two directions: what they hold is the mean of loads along both.
        let sides = [DVec3::Y, DVec3::Z].map(|load| deflection(&rod, share, load));
        let ratio = 0.5 * (sides[0] + sides[1]) / expected;
        share *= ratio;
        if (ratio - 1.0).abs() < 1e-9 {
            break;
        }
    }
    share
}

/// How far a load of 1 a metre moves the tip, of a strand along +X with springs of this stiffness, at rest.
fn deflection(rod: &Rods, share: f64, load: DVec3) -> f64 {
    let mut truss = Truss::with(rod, 0, share);
    truss.begin(|_| 0.0);
    truss.add_springs([1.0, 0.0]);
    for i in HELD..truss.points.len() {
        for axis in 0..3 {
            truss.right[3 * (i - HELD) + axis] += truss.masses[i] * load[axis];
        }
    }
    if !truss.matrix.solve(&mut truss.right) {
        return f64::NAN;
    }
    let tip = DVec3::from_slice(&truss.right[truss.right.len() - 3..]);
    tip.dot(load)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dynamics::reference;

    fn step(truss: &mut Truss, seconds: f64, dt: f64) {
        for _ in 0..(seconds / dt).round() as usize {
            truss.step(dt, Pose::IDENTITY);
        }
    }

    #[test]
    fn a_light_load_bends_it_as_a_rod() {
        for n in [10, 20, 40] {
            let rods = Rods::level(1, n, 1.0);
            let share = bending_share(&rods);
            let expected = rods.length.powi(4) / (8.0 * rods.bending());
            for load in [DVec3::Y, DVec3::Z] {
                let ratio = deflection(&rods, share, load) / expected;
                assert!((ratio - 1.0).abs() < 0.02, "{n}: {ratio}");
            }
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
        for _ in 0..10 {
            // The held particles fall too.
            let fallen = truss.velocities[HELD].y - GRAVITY * 0.01;
            let head = truss.points[0] - truss.held[0] + DVec3::Y * (fallen * 0.01);
            truss.step(
                0.01,
                Pose {
                    translation: head,
                    ..Pose::IDENTITY
                },
            );
        }
        // Euler's implicit step falls g t (t + dt) / 2.
        let fall = 0.5 * GRAVITY * 0.1 * 0.11;
        for (a, b) in start.iter().zip(truss.points()) {
            assert!((b - *a + DVec3::Y * fall).length() < 1e-12, "{a} {b}");
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
