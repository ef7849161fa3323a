//! Material normals: a vector across each link of a strand that turns with the hair.
//!
//! At rest a strand has no twist: its normals are carried from link to link by the least turn (parallel
//! transport; Bergou et al. 2008, *Discrete Elastic Rods*, 4.2), turned about it all together so that they
//! point away from the head as well as they can. In motion they are what the solver's frames make of
//! them. Where there are only points, as in a bake, they are carried anew from the root's link: twist is lost.

use glam::{DQuat, Vec3};
use std::ops::Range;
use stroke_path::Paths;

/// Normals of all links of a scene's strands, in the list of their points: that of a link at its first point,
/// and at the tip that of the last link.
#[derive(Default)]
pub(crate) struct Material {
    /// Unit vectors across the links at rest; empty until something reads them.
    rest: Vec<Vec3>,
    now: Vec<Vec3>,
}

/// Shorter links have no direction (m).
const SHORTEST: f32 = 1e-9;

impl Material {
    /// The normals of hair at rest on a head that has turned since.
    pub fn turn(
        &mut self,
        points: &[Vec3],
        strands: impl Iterator<Item = Range<usize>>,
        head_center: Vec3,
        rotation: DQuat,
    ) {
        if self.rest.len() != points.len() {
            self.rest = vec![Vec3::ZERO; points.len()];
            for strand in strands {
                outwards(&points[strand.clone()], head_center, &mut self.rest[strand]);
            }
        }
        let rotation = rotation.as_quat();
        self.now.clear();
        self.now
            .extend(self.rest.iter().map(|normal| rotation * *normal));
    }

    /// The normals at rest, and those of now, to be changed.
    pub fn rest_and_now(&mut self) -> (&[Vec3], &mut [Vec3]) {
        (&self.rest, &mut self.now)
    }

    /// Carries the normals of strands anew along their points: their first link has turned with the head, and then
    /// by the least turn from its direction at rest.
    pub fn follow(
        &mut self,
        rest: &[Vec3],
        points: &[Vec3],
        strands: impl Iterator<Item = Range<usize>>,
        rotation: DQuat,
    ) {
        let rotation = rotation.as_quat();
        for strand in strands {
            let Some(first) = direction(&rest[strand.clone()]) else {
                continue;
            };
            let normal = self.now[strand.start];
            carry(
                &points[strand.clone()],
                rotation * first,
                normal,
                &mut self.now[strand],
            );
        }
    }

    /// Appends the normals at joints of paths, across the path there; `of_path` gives the points of the strand that a
    /// run follows.
    pub fn push_at_joints(
        &self,
        paths: &Paths,
        joints: Range<usize>,
        of_path: impl Fn(usize) -> Range<usize>,
        normals_at_joints: &mut Vec<Vec3>,
    ) {
        let first = paths
            .runs
            .partition_point(|run| run.joints.end <= joints.start);
        for run in &paths.runs[first..] {
            let normals = &self.now[of_path(run.strand)];
            for joint in run.joints.clone() {
                let tangent = (paths.forward[joint] - paths.backward[joint])
                    .normalize_or(paths.forward[joint]);
                let normal = between(normals, paths.u[joint]);
                normals_at_joints
                    .push(across(normal, tangent).normalize_or(tangent.any_orthonormal_vector()));
            }
        }
    }
}

/// The part of `v` across the unit vector `tangent`.
fn across(v: Vec3, tangent: Vec3) -> Vec3 {
    v - tangent * v.dot(tangent)
}

/// The direction of the first link that has one.
fn direction(points: &[Vec3]) -> Option<Vec3> {
    let mut edges = points.windows(2).map(|link| link[1] - link[0]);
    let edge = edges.find(|edge| edge.length() > SHORTEST)?;
    Some(edge.normalize())
}

/// The normal of particles at share `u` of a strand, by number: each is the mean of its links'.
fn between(normals: &[Vec3], u: f32) -> Vec3 {
    let last = normals.len() - 1;
    // The tip's own entry repeats that of the last link.
    let of_particle =
        |i: usize| normals[i.saturating_sub(1)] + normals[i.min(last.saturating_sub(1))];
    let place = u * last as f32;
    let first = (place as usize).min(last);
    of_particle(first).lerp(of_particle((first + 1).min(last)), place - first as f32)
}

/// Carries the normal of a link of this direction along the points' links.
fn carry(points: &[Vec3], mut before: Vec3, mut normal: Vec3, normals: &mut [Vec3]) {
    for k in 0..points.len() {
        let link = points.get(k + 1).map(|next| *next - points[k]);
        if let Some(edge) = link.filter(|edge| edge.length() > SHORTEST) {
            let tangent = edge.normalize();
            normal = least_turn(before, tangent, normal);
            before = tangent;
        }
        normals[k] = normal;
    }
}

/// A vector across `from`, turned as `from` turns to `to` by the shortest way; both are unit vectors.
fn least_turn(from: Vec3, to: Vec3, v: Vec3) -> Vec3 {
    let sum = from + to;
    let size = sum.length_squared();
    if size < 1e-6 {
        // There and back: half a turn about any axis across, such as the vector itself.
        return across(v, to).normalize_or(to.any_orthonormal_vector());
    }
    // Two mirrors, `from` and the middle of both, of which the first leaves what is across it as it is.
    let turned = v - sum * (2.0 * v.dot(sum) / size);
    across(turned, to).normalize_or(to.any_orthonormal_vector())
}

/// The untwisted normals of a strand that point away from the head as well as they can.
fn outwards(points: &[Vec3], head_center: Vec3, normals: &mut [Vec3]) {
    let Some(first) = direction(points) else {
        normals.fill(Vec3::Z);
        return;
    };
    carry(points, first, first.any_orthonormal_vector(), normals);
    // Turned by an angle about their links they are cos n + sin t x n: how far that points outwards in all is
    // largest where (cos, sin) is along these sums.
    let (mut along, mut aside) = (0.0, 0.0);
    for k in 0..points.len().saturating_sub(1) {
        let Some(tangent) = direction(&points[k..k + 2]) else {
            continue;
        };
        let out = (0.5 * (points[k] + points[k + 1]) - head_center).normalize_or(Vec3::Y);
        along += out.dot(normals[k]);
        aside += out.dot(tangent.cross(normals[k]));
    }
    let size = (along * along + aside * aside).sqrt();
    if size < 1e-6 {
        return;
    }
    let mut tangent = first;
    for k in 0..normals.len() {
        tangent = direction(&points[k..]).unwrap_or(tangent);
        let n = normals[k];
        normals[k] = n * (along / size) + tangent.cross(n) * (aside / size);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A strand that leaves the head sideways, arches and hangs, with a curl at its end.
    fn styled() -> Vec<Vec3> {
        (0..30)
            .map(|i| {
                let t = i as f32 / 29.0;
                let curl = 0.02 * (t - 0.5).max(0.0);
                let (sin, cos) = (20.0 * t).sin_cos();
                Vec3::new(
                    0.1 + 0.1 * t + curl * cos,
                    0.1 * t - 0.4 * t * t,
                    curl * sin,
                )
            })
            .collect()
    }

    fn at_rest(points: &[Vec3]) -> Material {
        let mut material = Material::default();
        let all = std::iter::once(0..points.len());
        material.turn(points, all, Vec3::ZERO, DQuat::IDENTITY);
        material
    }

    #[test]
    fn normals_are_across_their_links_without_twist_and_point_outwards() {
        let points = styled();
        let material = at_rest(&points);
        let tangents: Vec<Vec3> = points
            .windows(2)
            .map(|p| (p[1] - p[0]).normalize())
            .collect();
        let mut out = 0.0;
        for (k, tangent) in tangents.iter().enumerate() {
            let normal = material.now[k];
            assert!((normal.length() - 1.0).abs() < 1e-5 && normal.dot(*tangent).abs() < 1e-5);
            out += normal.dot(points[k]);
            if k > 0 {
                let carried = least_turn(tangents[k - 1], *tangent, material.now[k - 1]);
                assert!(carried.distance(normal) < 1e-4, "link {k} is twisted");
            }
        }
        // No other roll of all of them together points farther out.
        for angle in [0.3_f32, 1.0, 2.0, 3.1, -1.0, -0.3] {
            let (sin, cos) = angle.sin_cos();
            let rolled = |k: usize| {
                let n = material.now[k];
                n * cos + tangents[k].cross(n) * sin
            };
            let other: f32 = (0..tangents.len())
                .map(|k| rolled(k).dot((0.5 * (points[k] + points[k + 1])).normalize()))
                .sum();
            let own: f32 = (0..tangents.len())
                .map(|k| material.now[k].dot((0.5 * (points[k] + points[k + 1])).normalize()))
                .sum();
            assert!(own > other, "{angle}");
        }
        assert!(out > 0.0);
    }

    #[test]
    fn what_only_turns_with_the_head_is_followed_exactly() {
        let points = styled();
        let rotation = DQuat::from_rotation_y(1.2) * DQuat::from_rotation_x(0.4);
        let moved: Vec<Vec3> = points
            .iter()
            .map(|p| rotation.as_quat() * *p + Vec3::Y)
            .collect();
        let mut material = at_rest(&points);
        let all = || std::iter::once(0..points.len());
        material.turn(&points, all(), Vec3::ZERO, rotation);
        let turned = material.now.clone();
        material.follow(&points, &moved, all(), rotation);
        for (a, b) in turned.iter().zip(&material.now) {
            assert!(a.distance(*b) < 1e-4);
        }
    }

    #[test]
    fn the_least_turn_is_a_turn() {
        let (from, to) = (Vec3::new(0.6, 0.0, 0.8), Vec3::new(0.0, -0.8, 0.6));
        let turn = glam::Quat::from_rotation_arc(from, to);
        let v = across(Vec3::new(1.0, 2.0, 3.0), from).normalize();
        assert!(least_turn(from, to, v).distance(turn * v) < 1e-6);
        assert!(least_turn(Vec3::X, Vec3::NEG_X, Vec3::Y).is_normalized());
    }

    #[test]
    fn strands_without_length_have_some_normal() {
        for points in [vec![Vec3::ONE], vec![Vec3::ONE; 3]] {
            let material = at_rest(&points);
            assert!(material.now.iter().all(|normal| normal.is_normalized()));
            assert!(between(&material.now, 0.7).length() > 0.5);
        }
    }
}
