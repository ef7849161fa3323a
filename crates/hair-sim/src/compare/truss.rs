//! A zigzag of particles with springs, as one linear system.

use super::{
    altitudes::{Altitude, altitudes},
    banded::Banded,
};
use crate::{params::GRAVITY, rest::from_axis};
use glam::{DMat3, DQuat, DVec3};

/// The zigzag's particles that the head holds: one before the root, one aside, the root.
pub(super) const HELD: usize = 3;
/// Distance of the particles aside of the strand, in mean lengths of its links.
const ASIDE: f64 = 0.5;
/// The part of its length at rest below which an altitude's spring acts. Were it to act always, it would change how the
/// strand bends, and each time another altitude becomes the shortest.
const COLLAPSED: f64 = 0.7;
/// Unknowns of four particles in a row, of which any two are in a spring.
const BAND: usize = 12;
/// Of the strand's weight: the force that would double the length of an edge.
const STRETCH: f64 = 1000.0;

/// The zigzag of a strand: one particle of it and one aside before the root, the root, one aside of the first link, its end, and
/// so on. `frames` are the skin's, then of each link: the third axis points along it.
pub(super) fn zigzag(root: DVec3, frames: &[DQuat], lengths: &[f64]) -> Vec<DVec3> {
    let mean = lengths.iter().sum::<f64>() / lengths.len().max(1) as f64;
    let aside = |link: usize| {
        // A quarter turn from each to the next, so that no tetrahedron is flat.
        let sign = if link % 4 < 2 { 1.0 } else { -1.0 };
        side(frames[link], link) * (ASIDE * mean * sign)
    };
    let tangent = frames[0] * DVec3::Z;
    let mut points = vec![root - tangent * mean];
    points.push(root - tangent * (0.5 * mean) + aside(0));
    points.push(root);
    let mut at = root;
    for (link, length) in (1..).zip(lengths) {
        let along = frames[link] * DVec3::Z * *length;
        points.push(at + along * 0.5 + aside(link));
        at += along;
        points.push(at);
    }
    points
}

/// The direction in which the particle aside of a link stands, but for its sign; 0 is before the root.
fn side(frame: DQuat, link: usize) -> DVec3 {
    if link.is_multiple_of(2) {
        frame * DVec3::Y
    } else {
        frame * DVec3::NEG_X
    }
}

/// The frame of link `link`, 1 for the first, of a zigzag: as [`zigzag`] was given it, and as it has moved since.
pub(super) fn frame(points: &[DVec3], link: usize) -> DQuat {
    let [start, aside, end] = [2 * link, 2 * link + 1, 2 * link + 2].map(|i| points[i]);
    let tangent = (end - start).normalize_or(DVec3::Z);
    let sign = if link % 4 < 2 { 1.0 } else { -1.0 };
    let out = (aside - (start + end) * 0.5).reject_from(tangent) * sign;
    let out = out.normalize_or_zero();
    if out == DVec3::ZERO {
        return from_axis(tangent);
    }
    let first = if link.is_multiple_of(2) {
        out.cross(tangent)
    } else {
        -out
    };
    let frame = DMat3::from_cols(first, tangent.cross(first), tangent);
    DQuat::from_mat3(&frame).normalize()
}

/// Springs between the particles of a zigzag, their masses, and scratch for the system that a step solves.
#[derive(Clone, Debug)]
pub(super) struct Truss {
    springs: Vec<Spring>,
    tetrahedra: Vec<Tetrahedron>,
    /// Per linear density: a metre of strand has mass 1.
    pub masses: Vec<f64>,
    matrix: Banded<BAND>,
    /// Three numbers for each particle that is not held.
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

/// Four particles in a row.
#[derive(Clone, Copy, Debug)]
struct Tetrahedron {
    /// Of the altitudes at rest, in m.
    lengths: [f64; 7],
    /// A force at double length.
    stiffness: f64,
}

impl Truss {
    /// The truss of which `rest` are the particles without force. `bending` is EI / (rho S) in m^4/s^2 at a share of the strand's
    /// length, `share` the force of a bending or torsion spring at double length over EI / link^2: see [`bending_share`].
    pub fn new(rest: &[DVec3], lengths: &[f64], bending: impl Fn(f64) -> f64, share: f64) -> Self {
        let total: f64 = lengths.iter().sum();
        let element = total / lengths.len().max(1) as f64;
        let count = rest.len();
        let stiff: Vec<f64> = places(lengths)
            .into_iter()
            .map(|u| bending(u) / (element * element))
            .collect();
        let mut springs = Vec::new();
        for reach in 1..=3 {
            for a in 0..count - reach {
                let b = a + reach;
                if b < HELD {
                    continue;
                }
                let length = (rest[b] - rest[a]).length();
                let bending = 0.5 * (stiff[a] + stiff[b]);
                let is_edge = reach == 1 || reach == 2 && a % 2 == 0;
                let force = if is_edge {
                    STRETCH * GRAVITY * total + 100.0 * bending
                } else {
                    share * bending
                };
                springs.push(Spring {
                    a,
                    b,
                    length,
                    stiffness: force / length,
                });
            }
        }
        let tetrahedron = |k: usize| Tetrahedron {
            lengths: altitudes(&rest[k..k + 4]).map(|altitude| altitude.length),
            stiffness: share * 0.5 * (stiff[k] + stiff[k + 3]),
        };
        Self {
            springs,
            tetrahedra: (0..count - 3).map(tetrahedron).collect(),
            masses: masses(lengths),
            matrix: Banded::new(3 * (count - HELD)),
            right: vec![0.0; 3 * (count - HELD)],
        }
    }

    /// Makes the springs such that gravity holds the particles where they are. From the tip on every particle hangs by three springs,
    /// so their forces are known; what a spring is longer by is taken out of its length.
    pub fn balance(&mut self, points: &[DVec3], gravity: DVec3) {
        let mut loads: Vec<DVec3> = self.masses.iter().map(|mass| gravity * *mass).collect();
        for i in (HELD..points.len()).rev() {
            let mut own = self.springs.iter_mut().filter(|spring| spring.b == i);
            let Some([x, y, z]) = next_three(&mut own) else {
                continue;
            };
            let ways = [&x, &y, &z].map(|spring| points[spring.a] - points[i]);
            let [along_x, along_y, along_z] = ways.map(DVec3::normalize_or_zero);
            let directions = DMat3::from_cols(along_x, along_y, along_z);
            let tensions = directions.inverse() * -loads[i];
            if !tensions.is_finite() {
                continue;
            }
            for ((spring, way), tension) in [x, y, z].into_iter().zip(ways).zip(tensions.to_array())
            {
                spring.length -= tension / spring.stiffness;
                loads[spring.a] -= way.normalize_or_zero() * tension;
            }
        }
    }

    /// Begins a system: `inertia` of each particle that is not held, by its index and mass, on the diagonal, and `push` on the right
    /// side.
    pub fn begin(
        &mut self,
        inertia: impl Fn(usize, f64) -> f64,
        push: impl Fn(usize, f64) -> DVec3,
    ) {
        self.matrix.clear();
        for i in HELD..self.masses.len() {
            let mass = self.masses[i];
            let (inertia, push) = (inertia(i, mass), push(i, mass));
            for axis in 0..3 {
                let row = 3 * (i - HELD) + axis;
                *self.matrix.at(row, row) = inertia;
                self.right[row] = push[axis];
            }
        }
    }

    /// Adds all springs as they are now: `factor` x their stiffness to the matrix and `push` x their force to the right side.
    pub fn add_springs(&mut self, points: &[DVec3], velocities: &[DVec3], scale: [f64; 2]) {
        for index in 0..self.springs.len() {
            let spring = self.springs[index];
            let way = points[spring.b] - points[spring.a];
            let mut weights = [0.0; 4];
            weights[0] = -1.0;
            weights[spring.b - spring.a] = 1.0;
            let length = way.length();
            let line = Altitude {
                weights,
                length,
                direction: way / length,
            };
            self.add(
                spring.a,
                &line,
                [spring.length, spring.stiffness],
                velocities,
                scale,
            );
        }
        for k in 0..self.tetrahedra.len() {
            let now = altitudes(&points[k..k + 4]);
            // The shortest alone.
            let Some(least) = (0..7).min_by(|a, b| now[*a].length.total_cmp(&now[*b].length))
            else {
                continue;
            };
            let Tetrahedron { lengths, stiffness } = self.tetrahedra[k];
            let rest = lengths[least] * COLLAPSED;
            if now[least].length >= rest {
                continue;
            }
            self.add(k, &now[least], [rest, stiffness / rest], velocities, scale);
        }
    }

    /// Adds a spring between weighted sums of four particles in a row.
    fn add(
        &mut self,
        first: usize,
        spring: &Altitude,
        [rest, stiffness]: [f64; 2],
        velocities: &[DVec3],
        [factor, push]: [f64; 2],
    ) {
        // The force now, and what the head's motion adds to it within the step.
        let held = spring.weights.iter().zip(&velocities[first..]);
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

    /// Solves the system: a vector for each particle that is not held, or nothing where the system has no solution.
    pub fn solve(&mut self) -> Option<impl Iterator<Item = DVec3> + '_> {
        let is_solved = self.matrix.solve(&mut self.right);
        is_solved.then(|| self.right.chunks_exact(3).map(DVec3::from_slice))
    }

    /// Energy of springs without altitudes, per linear density, in m^3/s^2.
    pub fn energy(&self, points: &[DVec3]) -> f64 {
        let energy = |spring: &Spring| {
            let longer = (points[spring.b] - points[spring.a]).length() - spring.length;
            0.5 * spring.stiffness * longer * longer
        };
        self.springs.iter().map(energy).sum()
    }
}

fn next_three<T>(items: &mut impl Iterator<Item = T>) -> Option<[T; 3]> {
    Some([items.next()?, items.next()?, items.next()?])
}

/// The place of every particle between root and tip, by length, 0 to 1.
fn places(lengths: &[f64]) -> Vec<f64> {
    let total: f64 = lengths.iter().sum();
    let mut places = vec![0.0; HELD];
    let mut along = 0.0;
    for length in lengths {
        places.push((along + 0.5 * length) / total);
        along += length;
        places.push(along / total);
    }
    places
}

/// A link's mass is half aside of it, and a quarter at each end.
fn masses(lengths: &[f64]) -> Vec<f64> {
    let mut masses = vec![0.0; HELD];
    for (k, length) in lengths.iter().enumerate() {
        let next = lengths.get(k + 1).copied().unwrap_or(0.0);
        masses.extend([0.5 * length, 0.25 * (length + next)]);
    }
    masses
}

/// The stiffness of bending and torsion springs at which a straight strand of `links` and this length (m) and stiffness, EI / (rho S) in
/// m^4/s^2, clamped level and lightly loaded, hangs by w L^4 / 8 EI at its tip.
pub(super) fn bending_share(links: usize, length: f64, bending: f64) -> f64 {
    let expected = length.powi(4) / (8.0 * bending);
    let mut share = 4.0;
    for _ in 0..60 {
        // Aside particles stand in two directions: what they hold is the mean of loads along both.
        let sides =
            [DVec3::Y, DVec3::Z].map(|load| deflection(links, length, bending, share, load));
        let ratio = 0.5 * (sides[0] + sides[1]) / expected;
        // A strand of few links cannot bend as a rod, however soft or stiff.
        if !(1e-3..=1e3).contains(&(share * ratio)) {
            break;
        }
        share *= ratio;
        if (ratio - 1.0).abs() < 1e-9 {
            break;
        }
    }
    share
}

/// How far a load of 1 a metre moves the tip, of a strand along +X with springs of this stiffness, at rest.
fn deflection(links: usize, length: f64, bending: f64, share: f64, load: DVec3) -> f64 {
    let lengths = vec![length / links as f64; links];
    let frames = vec![from_axis(DVec3::X); links + 1];
    let points = zigzag(DVec3::ZERO, &frames, &lengths);
    let mut truss = Truss::new(&points, &lengths, |_| bending, share);
    truss.begin(|_, _| 0.0, |_, mass| load * mass);
    truss.add_springs(&points, &vec![DVec3::ZERO; points.len()], [1.0, 0.0]);
    let tip = truss.solve().and_then(Iterator::last);
    tip.map_or(f64::NAN, |tip| tip.dot(load))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_light_load_bends_it_as_a_rod() {
        let (length, bending) = (0.3_f64, GRAVITY * 0.027);
        for links in [10, 20, 40] {
            let share = bending_share(links, length, bending);
            let expected = length.powi(4) / (8.0 * bending);
            for load in [DVec3::Y, DVec3::Z] {
                let ratio = deflection(links, length, bending, share, load) / expected;
                assert!((ratio - 1.0).abs() < 0.02, "{links}: {ratio}");
            }
        }
    }

    #[test]
    fn a_zigzag_keeps_the_frames_that_made_it() {
        let turn = DQuat::from_scaled_axis(DVec3::new(0.1, -0.2, 0.3));
        let frames: Vec<DQuat> = (0..=8)
            .scan(DQuat::IDENTITY, |frame, _| {
                *frame = (*frame * turn).normalize();
                Some(*frame)
            })
            .collect();
        let points = zigzag(DVec3::ONE, &frames, &[0.01; 8]);
        for link in 1..=8 {
            let apart = frame(&points, link).dot(frames[link]).abs();
            assert!((apart - 1.0).abs() < 1e-12, "{link}: {apart}");
        }
    }
}
