//! A mesh at one moment: where its vertices are, and what stands upright on it.

use crate::{MeshError, Topology};
use glam::{DVec3, Vec3};
use std::borrow::Cow;

/// A mesh at one moment: topology, positions and normals, of which the first two are borrowed.
#[derive(Clone, Debug)]
pub struct Surface<'a> {
    topology: &'a Topology,
    positions: &'a [Vec3],
    normals: Cow<'a, [Vec3]>,
}

/// A place on a mesh: a triangle, and the weights of its three corners, which sum up to 1. What moves with the mesh keeps its place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// The triangle's index.
    pub triangle: u32,
    /// Barycentric: of its corners in their order in [`Topology::triangles`], from 0 to 1. An exact 0 is the edge opposite, an exact 1 the vertex.
    pub weights: DVec3,
}

impl Place {
    /// The place of a share (0 to 1) of the way along a half-edge.
    #[must_use]
    pub fn on_edge(half_edge: u32, share: f64) -> Self {
        let corner = half_edge as usize % 3;
        let mut weights = DVec3::ZERO;
        weights[corner] = 1.0 - share;
        weights[(corner + 1) % 3] = share;
        Self {
            triangle: half_edge / 3,
            weights,
        }
    }

    /// The vertex on which it lies, or the nearest by weight.
    #[must_use]
    pub fn vertex(self, surface: &Surface) -> u32 {
        surface.topology().triangles()[self.triangle as usize][self.weights.max_position()]
    }

    /// The place a share (0 to 1) of the way to another one in the same triangle.
    #[must_use]
    pub fn mix(self, other: Self, share: f64) -> Self {
        Self {
            triangle: self.triangle,
            weights: self.weights + (other.weights - self.weights) * share,
        }
    }
}

impl<'a> Surface<'a> {
    /// A mesh whose normals are made of those of the triangles around each smooth vertex, with the weights of Max (*Weights for computing vertex normals from
    /// facet normals*, 1999): exact for vertices on a sphere. A vertex without a triangle that has an area has the normal 0.
    ///
    /// # Errors
    ///
    /// When there is not one position for each vertex, or one isn't finite.
    pub fn new(topology: &'a Topology, positions: &'a [Vec3]) -> Result<Self, MeshError> {
        check_count("positions", positions.len(), topology.vertices())?;
        check_positions(positions)?;
        let normals = Cow::Owned(normals(topology, positions));
        Ok(Self {
            topology,
            positions,
            normals,
        })
    }

    /// A mesh with normals of its own (of length 1, one a smooth vertex; 0 where there is none), as of a surface known exactly. They point to the side from
    /// which the triangles of [`Topology::triangles`] are counter-clockwise.
    ///
    /// # Errors
    ///
    /// When there is not one position for each vertex and one normal for each smooth one, or one isn't finite.
    pub fn with_normals(
        topology: &'a Topology,
        positions: &'a [Vec3],
        normals: &'a [Vec3],
    ) -> Result<Self, MeshError> {
        check_count("positions", positions.len(), topology.vertices())?;
        check_count("normals", normals.len(), topology.smooth_vertices())?;
        check_positions(positions)?;
        check_finite("normal", normals)?;
        Ok(Self {
            topology,
            positions,
            normals: Cow::Borrowed(normals),
        })
    }

    /// Which triangles are beside each other.
    #[must_use]
    pub fn topology(&self) -> &'a Topology {
        self.topology
    }

    /// The positions of the vertices.
    #[must_use]
    pub fn positions(&self) -> &'a [Vec3] {
        self.positions
    }

    /// The normals of the smooth vertices: unit vectors, or 0.
    #[must_use]
    pub fn normals(&self) -> &[Vec3] {
        &self.normals
    }

    /// Where a vertex is.
    #[inline]
    #[must_use]
    pub fn position(&self, vertex: u32) -> DVec3 {
        self.positions[vertex as usize].as_dvec3()
    }

    /// Where a triangle's corners are.
    #[inline]
    #[must_use]
    pub fn corners(&self, triangle: u32) -> [DVec3; 3] {
        self.topology.triangles()[triangle as usize].map(|vertex| self.position(vertex))
    }

    /// The normals at a triangle's corners.
    #[must_use]
    pub fn corner_normals(&self, triangle: u32) -> [DVec3; 3] {
        let smooth = self.topology.smooth_corners()[triangle as usize];
        smooth.map(|vertex| self.normals[vertex as usize].as_dvec3())
    }

    /// Where a place is.
    #[must_use]
    pub fn point(&self, place: Place) -> DVec3 {
        let [a, b, c] = self.corners(place.triangle);
        a * place.weights.x + b * place.weights.y + c * place.weights.z
    }

    /// The normal at a place: between those of the corners; of length 1, or 0.
    #[must_use]
    pub fn normal(&self, place: Place) -> DVec3 {
        let [a, b, c] = self.corner_normals(place.triangle);
        (a * place.weights.x + b * place.weights.y + c * place.weights.z).normalize_or_zero()
    }

    /// A triangle's normal, twice its area long.
    #[inline]
    #[must_use]
    pub fn area_normal(&self, triangle: u32) -> DVec3 {
        let [a, b, c] = self.corners(triangle);
        (b - a).cross(c - a)
    }

    /// The gradient within a triangle of what is linear in it, given at its corners; 0 where it has no area.
    #[must_use]
    pub fn gradient(&self, triangle: u32, at_corners: [f64; 3]) -> DVec3 {
        let [a, b, c] = self.corners(triangle);
        let normal = (b - a).cross(c - a);
        let squared = normal.length_squared();
        if squared == 0.0 {
            return DVec3::ZERO;
        }
        let [fa, fb, fc] = at_corners;
        // Each corner's own function has the height's direction, across the edge opposite.
        normal.cross((c - b) * fa + (a - c) * fb + (b - a) * fc) / squared
    }

    /// How far the smooth surface stands off a triangle, about: the largest sagitta of its edges, of arcs that turn as its normals do.
    #[must_use]
    pub fn sagitta(&self, triangle: u32) -> f64 {
        let corners = self.corners(triangle);
        let normals = self.corner_normals(triangle);
        [(0, 1), (1, 2), (2, 0)]
            .map(|(i, j)| ((normals[j] - normals[i]).dot(corners[j] - corners[i]) / 8.0).abs())
            .into_iter()
            .fold(0.0, f64::max)
    }
}

fn check_count(what: &'static str, found: usize, vertices: usize) -> Result<(), MeshError> {
    if found == vertices {
        Ok(())
    } else {
        Err(MeshError::Count {
            what,
            found,
            vertices,
        })
    }
}

pub(crate) fn check_positions(positions: &[Vec3]) -> Result<(), MeshError> {
    check_finite("position", positions)
}

fn check_finite(what: &'static str, list: &[Vec3]) -> Result<(), MeshError> {
    match list.iter().position(|place| !place.is_finite()) {
        Some(index) => Err(MeshError::NotFinite { what, index }),
        None => Ok(()),
    }
}

fn normals(topology: &Topology, positions: &[Vec3]) -> Vec<Vec3> {
    let mut sums = vec![DVec3::ZERO; topology.smooth_vertices()];
    for (corners, smooth) in topology.triangles().iter().zip(topology.smooth_corners()) {
        let [a, b, c] = corners.map(|vertex| positions[vertex as usize].as_dvec3());
        let edges = [b - a, c - b, a - c];
        let squared = edges.map(DVec3::length_squared);
        let normal = edges[0].cross(edges[1]);
        if normal == DVec3::ZERO || squared.contains(&0.0) {
            continue;
        }
        for corner in 0..3 {
            // The corner lies between the edge that leaves it and the one before.
            let weight = 1.0 / squared[corner] / squared[(corner + 2) % 3];
            sums[smooth[corner] as usize] += normal * weight;
        }
    }
    sums.into_iter()
        .map(|sum| sum.normalize_or_zero().as_vec3())
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn normals_are_exact_on_a_sphere_whatever_the_triangles() {
        // An irregular tetrahedron's corners, on a sphere around a centre that isn't the origin.
        let center = Vec3::new(3.0, -2.0, 1.0);
        let directions = [
            Vec3::new(0.1, 0.9, 0.2),
            Vec3::new(0.9, -0.3, 0.1),
            Vec3::new(-0.4, -0.5, 0.8),
            Vec3::new(-0.3, -0.2, -0.9),
        ]
        .map(Vec3::normalize);
        let positions = directions.map(|direction| center + direction * 2.5);
        let triangles = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
        let topology = Topology::new(&positions, &triangles).unwrap();
        let surface = Surface::new(&topology, &positions).unwrap();
        for (normal, direction) in surface.normals().iter().zip(directions) {
            // What is closed is turned outwards.
            assert!(normal.distance(direction) < 1e-5);
        }
    }

    #[test]
    fn gradients_are_those_of_linear_functions() {
        let positions = [
            Vec3::new(0.3, 0.1, 2.0),
            Vec3::new(1.3, -0.4, 2.5),
            Vec3::new(0.2, 0.9, 1.0),
        ];
        let topology = Topology::new(&positions, &[[0, 1, 2]]).unwrap();
        let surface = Surface::new(&topology, &positions).unwrap();
        let slope = DVec3::new(1.0, -2.0, 0.5);
        let gradient = surface.gradient(0, surface.corners(0).map(|corner| corner.dot(slope)));
        // What of the slope lies in the triangle.
        let normal = surface.area_normal(0).normalize();
        assert!(gradient.distance(slope - normal * normal.dot(slope)) < 1e-12);
        assert!(surface.gradient(0, [1.0; 3]).length() < 1e-12);
    }

    #[test]
    fn bad_lists_are_refused() {
        let topology = Topology::new(&[Vec3::ZERO; 2], &[]).unwrap();
        let bad = [Vec3::ZERO, Vec3::new(0.0, f32::NAN, 0.0)];
        let error = Surface::new(&topology, &bad).unwrap_err();
        assert_eq!(error.to_string(), "position 1 is NaN or infinite");
        let error = Surface::new(&topology, &bad[..1]).unwrap_err();
        assert_eq!(
            error.to_string(),
            "there are 1 positions for 2 vertices: there must be one each"
        );
        assert!(Surface::with_normals(&topology, &[Vec3::X; 2], &bad).is_err());
    }

    #[test]
    fn tiny_and_huge_meshes_have_normals() {
        for size in [1e-38, 1e37] {
            let positions = [Vec3::ZERO, Vec3::X * size, Vec3::Y * size];
            let topology = Topology::new(&positions, &[[0, 1, 2]]).unwrap();
            let surface = Surface::new(&topology, &positions).unwrap();
            assert!(surface.normals().iter().all(|normal| *normal == Vec3::Z));
        }
    }
}
