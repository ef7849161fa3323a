//! Triangle meshes as shapes: what lies at one place is one.

use std::collections::HashMap;

use glam::{DVec3, Vec3};

/// A shape of triangles: every position is used by one of them, and no two are equal.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Welded {
    /// Positions, in metres once oriented.
    pub positions: Vec<Vec3>,
    /// Unit normals, one a position: those of the triangles around it, weighted by area.
    pub normals: Vec<Vec3>,
    /// Three different indices into `positions`, counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
}

impl Welded {
    /// A shape from the corners of triangles (finite, below 2^32 of them). Corners at exactly the same
    /// place become one; triangles without area are left out.
    #[must_use]
    pub fn from_corners(corners: impl IntoIterator<Item = [Vec3; 3]>) -> Self {
        let mut mesh = Self::default();
        let mut places = HashMap::new();
        let mut sums = Vec::new();
        for triangle in corners {
            let [a, b, c] = triangle.map(|corner| corner.as_dvec3());
            // Twice the area long.
            let normal = (b - a).cross(c - a);
            if normal == DVec3::ZERO {
                continue;
            }
            let indices = triangle.map(|corner| {
                // + 0.0 makes one zero of two.
                let corner = corner + Vec3::ZERO;
                *places
                    .entry(corner.to_array().map(f32::to_bits))
                    .or_insert_with(|| {
                        mesh.positions.push(corner);
                        sums.push(DVec3::ZERO);
                        mesh.positions.len() as u32 - 1
                    })
            });
            for index in indices {
                sums[index as usize] += normal;
            }
            mesh.triangles.push(indices);
        }
        mesh.normals = sums
            .iter()
            .map(|sum| sum.normalize_or_zero().as_vec3())
            .collect();
        mesh.mend_cancelled_normals();
        mesh
    }

    /// Tells the normal at a place, where there is a triangle with an area.
    pub(crate) fn normals_at(self) -> impl Fn(&Vec3) -> Option<Vec3> {
        let key = |place: Vec3| (place + Vec3::ZERO).to_array().map(f32::to_bits);
        let places = self.positions.into_iter().map(key);
        let normals: HashMap<_, _> = places.zip(self.normals).collect();
        move |place| normals.get(&key(*place)).copied()
    }

    /// Where triangles face each other (both sides of a sheet) their normals can cancel out: such a
    /// corner takes the normal of its first triangle.
    fn mend_cancelled_normals(&mut self) {
        for triangle in &self.triangles {
            let [a, b, c] = triangle.map(|index| self.positions[index as usize].as_dvec3());
            for index in triangle.map(|index| index as usize) {
                if self.normals[index] == Vec3::ZERO {
                    self.normals[index] = (b - a).cross(c - a).normalize().as_vec3();
                }
            }
        }
    }

    /// The corners of every triangle.
    pub fn corners(&self) -> impl Iterator<Item = [Vec3; 3]> {
        self.triangles
            .iter()
            .map(|t| t.map(|index| self.positions[index as usize]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn corners_at_the_same_place_are_one_with_a_smooth_normal() {
        let [o, x, y, z] = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z * 2.0];
        let mesh = Welded::from_corners([[o, x, y], [-o, y, z], [o, o, x], [x, x * 2.0, x * 3.0]]);
        assert_eq!(mesh.positions, [o, x, y, z]);
        assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3]]);
        // Areas of 1/2 facing +Z and 1 facing +X.
        assert!(mesh.normals[0].distance(Vec3::new(2.0, 0.0, 1.0).normalize()) < 1e-6);
        assert_eq!(mesh.normals[1], Vec3::Z);
    }

    proptest! {
        #[test]
        fn normals_are_unit_and_positions_used(
            corners in prop::collection::vec(prop::array::uniform3(prop::array::uniform3(-2i8..2)), 0..20), scale in prop_oneof![Just(1.0f32), Just(1e-38), Just(1e37)],
        ) {
            let corner = |c: &[i8; 3]| Vec3::from(c.map(f32::from)) * scale;
            let mesh = Welded::from_corners(corners.iter().map(|t| [0, 1, 2].map(|i| corner(&t[i]))));
            prop_assert_eq!(mesh.normals.len(), mesh.positions.len());
            prop_assert!(mesh.normals.iter().all(|n| (n.length() - 1.0).abs() < 1e-5));
            let mut used = vec![false; mesh.positions.len()];
            mesh.triangles.iter().flatten().for_each(|&i| used[i as usize] = true);
            prop_assert!(used.iter().all(|u| *u));
        }
    }
}
