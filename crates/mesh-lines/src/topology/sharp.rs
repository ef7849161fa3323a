//! Edges across which normals aren't smooth, and the vertices that they part.

use super::{Beside, Topology};
use crate::{MeshError, surface::check_positions};
use glam::{DVec3, Vec3};

impl Topology {
    /// The same mesh with sharp edges: those at which the angle between the two triangles' normals has a cosine below `cosine`
    /// ([`crate::CREASE_COSINE`]), in these positions. Normals are not smooth across them: a vertex there is several *smooth vertices*, and contours end at them.
    ///
    /// Normals are not smooth across edges of three triangles or more either, nor between triangles that meet in a vertex alone. What is NaN is no cosine: nothing else is sharp.
    ///
    /// # Errors
    ///
    /// When there is not one position for each vertex, or one isn't finite.
    pub fn with_creases(mut self, positions: &[Vec3], cosine: f64) -> Result<Self, MeshError> {
        if positions.len() != self.vertices {
            return Err(MeshError::Count {
                what: "positions",
                found: positions.len(),
                vertices: self.vertices,
            });
        }
        check_positions(positions)?;
        let normal = |half_edge: u32| {
            let [a, b, c] =
                self.triangles[half_edge as usize / 3].map(|v| positions[v as usize].as_dvec3());
            (b - a).cross(c - a).normalize_or_zero()
        };
        let is_sharp = |half_edge: u32| {
            let Beside::Twin(twin) = self.beside(half_edge) else {
                return false;
            };
            // Neighbours that are wound against each other (on a Möbius strip) have the angle of one turned; triangles without area have none.
            let alike = self.ends(half_edge)[0] != self.ends(twin)[0];
            let [a, b] = [normal(half_edge), normal(twin)];
            let angle = if alike { a.dot(b) } else { -a.dot(b) };
            a != DVec3::ZERO && b != DVec3::ZERO && angle < cosine
        };
        self.sharp = (0..self.beside.len() as u32)
            .filter(|&h| is_sharp(h))
            .collect();
        self.split_corners();
        Ok(self)
    }

    /// True if normals are not smooth across a half-edge that has a twin.
    #[must_use]
    pub fn is_sharp(&self, half_edge: u32) -> bool {
        self.sharp.binary_search(&half_edge).is_ok()
    }

    /// The half-edges of sharp edges between two triangles, both of each, in order.
    #[must_use]
    pub fn sharp(&self) -> &[u32] {
        &self.sharp
    }

    /// How many smooth vertices there are: one for each vertex, the first ones, then those that [`Self::with_creases`] makes besides.
    #[must_use]
    pub fn smooth_vertices(&self) -> usize {
        self.vertices.max(self.smooth_vertices.len())
    }

    /// The vertex of a smooth vertex.
    #[inline]
    #[must_use]
    pub fn vertex(&self, smooth_vertex: usize) -> usize {
        match self.smooth_vertices.get(smooth_vertex) {
            Some(&vertex) => vertex as usize,
            None => smooth_vertex,
        }
    }

    /// Of each triangle the smooth vertices of its corners.
    #[inline]
    #[must_use]
    pub fn smooth_corners(&self) -> &[[u32; 3]] {
        if self.smooth_corners.is_empty() {
            &self.triangles
        } else {
            &self.smooth_corners
        }
    }

    /// Gives the corners at a vertex that no smooth edges join smooth vertices of their own.
    fn split_corners(&mut self) {
        (self.smooth_corners, self.smooth_vertices) = (Vec::new(), Vec::new());
        let mut corners = self.triangles.clone();
        let mut vertices: Vec<u32> = (0..self.vertices as u32).collect();
        for vertex in 0..self.vertices as u32 {
            let around = self.around(vertex);
            let mut reached = vec![false; around.len()];
            let mut groups = 0;
            for first in 0..around.len() {
                if reached[first] {
                    continue;
                }
                let smooth_vertex = if groups == 0 {
                    vertex
                } else {
                    vertices.len() as u32
                };
                if groups > 0 {
                    vertices.push(vertex);
                }
                groups += 1;
                let mut open = vec![first];
                while let Some(at) = open.pop() {
                    if std::mem::replace(&mut reached[at], true) {
                        continue;
                    }
                    let leaving = around[at];
                    corners[leaving as usize / 3][leaving as usize % 3] = smooth_vertex;
                    let arriving = leaving / 3 * 3 + (leaving % 3 + 2) % 3;
                    for side in [leaving, arriving] {
                        let Beside::Twin(twin) = self.beside(side) else {
                            continue;
                        };
                        if !self.is_sharp(side) {
                            let beside = (twin / 3 * 3..twin / 3 * 3 + 3)
                                .find_map(|h| around.binary_search(&h).ok());
                            open.extend(beside);
                        }
                    }
                }
            }
        }
        if vertices.len() > self.vertices {
            (self.smooth_corners, self.smooth_vertices) = (corners, vertices);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Surface;

    const TETRAHEDRON: [Vec3; 4] = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z];

    #[test]
    fn sharp_edges_part_normals() {
        let right = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
        let topology = Topology::new(&TETRAHEDRON, &right).unwrap();
        let sharp = topology.clone().with_creases(&TETRAHEDRON, 0.5).unwrap();
        assert_eq!(sharp.sharp().len(), 12);
        assert_eq!(sharp.smooth_vertices(), 12, "each corner has one");
        assert_eq!(sharp.vertex(3), 3);
        let smooth = topology.with_creases(&TETRAHEDRON, -1.1).unwrap();
        assert_eq!((smooth.sharp().len(), smooth.smooth_vertices()), (0, 4));
        // A roof that is sharp along its ridge alone.
        let roof = [
            Vec3::ZERO,
            Vec3::X,
            Vec3::new(0.0, 1.0, -1.0),
            Vec3::new(0.0, -1.0, -1.0),
        ];
        let topology = Topology::new(&roof, &[[0, 1, 2], [1, 0, 3]])
            .unwrap()
            .with_creases(&roof, 0.5)
            .unwrap();
        assert_eq!(topology.sharp(), [0, 3]);
        assert_eq!(topology.smooth_corners(), [[0, 1, 2], [5, 4, 3]]);
        assert_eq!([topology.vertex(4), topology.vertex(5)], [0, 1]);
    }

    #[test]
    fn edges_of_three_triangles_part_normals() {
        // A book that stands open: its spine along z, and three pages.
        let book = [
            Vec3::ZERO,
            Vec3::Z,
            Vec3::X,
            Vec3::new(-0.5, 0.8, 0.0),
            Vec3::new(-0.5, -0.8, 0.0),
        ];
        let topology = Topology::new(&book, &[[0, 1, 2], [0, 1, 3], [0, 1, 4]]).unwrap();
        // Whatever the angle.
        let topology = topology.with_creases(&book, -1.1).unwrap();
        let mut at_ends = [0, 1].map(|end| {
            let pages = topology.smooth_corners().iter();
            pages.map(|corners| corners[end]).collect::<Vec<u32>>()
        });
        for (vertex, smooth) in at_ends.iter_mut().enumerate() {
            assert!(
                smooth
                    .iter()
                    .all(|&s| topology.vertex(s as usize) == vertex)
            );
            smooth.sort_unstable();
            smooth.dedup();
            assert_eq!(smooth.len(), 3);
        }
        assert_eq!(topology.smooth_vertices(), 5 + 4);
        let surface = Surface::new(&topology, &book).unwrap();
        for page in 0..3 {
            let upright = surface.area_normal(page).normalize();
            let normals = surface.corner_normals(page);
            assert!(normals.iter().all(|n| n.distance(upright) < 1e-6));
        }
    }

    #[test]
    fn a_common_vertex_alone_parts_normals() {
        // An hourglass of two tetrahedra.
        let glass = [
            Vec3::ZERO,
            Vec3::new(1.0, 0.0, 1.0),
            Vec3::new(-1.0, 1.0, 1.0),
            Vec3::new(-1.0, -1.0, 1.0),
            Vec3::new(1.0, 0.0, -1.0),
            Vec3::new(-1.0, 1.0, -1.0),
            Vec3::new(-1.0, -1.0, -1.0),
        ];
        let half = [[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]];
        let triangles: Vec<[u32; 3]> = half
            .into_iter()
            .chain(half.map(|t| t.map(|v| if v == 0 { 0 } else { v + 3 })))
            .collect();
        let topology = Topology::new(&glass, &triangles).unwrap();
        assert_eq!(topology.smooth_vertices(), 7);
        let topology = topology.with_creases(&glass, -1.1).unwrap();
        assert_eq!(topology.smooth_vertices(), 8);
        let surface = Surface::new(&topology, &glass).unwrap();
        let [upper, lower] = [surface.normals()[0], surface.normals()[7]];
        assert!(upper.z < -0.5 && lower.z > 0.5, "{upper} {lower}");
    }
}
