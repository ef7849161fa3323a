//! The bust: its skin as a mesh, and what is drawn on it.

use crate::face::{self, Patch};
use crate::shape::distance;
use crate::solid::gradient;
use crate::surface_nets::{relax, surface_net};
use glam::Vec3;

/// Side of the grid's cells, metres.
const CELL: f32 = 0.0085;

/// A head with neck and shoulders, and what is drawn on its face.
#[derive(Clone, Debug)]
pub struct Bust {
    /// Positions in metres.
    pub positions: Vec<Vec3>,
    /// Unit normals, one a position.
    pub normals: Vec<Vec3>,
    /// Indices, counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
    /// Eyes, brows, nose and mouth, lying on the skin; later ones over earlier ones.
    pub face: Vec<Patch>,
}

/// Makes the bust.
#[must_use]
pub fn bust() -> Bust {
    let (low, high) = (Vec3::new(-0.2, 1.10, -0.17), Vec3::new(0.2, 1.66, 0.16));
    let mut net = surface_net(distance, low, high, CELL);
    relax(&mut net, distance, 12);
    let normals = net
        .positions
        .iter()
        .map(|p| gradient(distance, *p).normalize_or(Vec3::Y));
    Bust {
        normals: normals.collect(),
        positions: net.positions,
        triangles: net.triangles,
        face: face::patches(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_head_is_as_high_as_it_says_and_faces_forward() {
        let bust = bust();
        let top = bust.positions.iter().map(|p| p.y).fold(f32::MIN, f32::max);
        assert!((top - 1.62).abs() < 0.004, "{top}");
        let chin = (0..200).map(|i| 1.36 + i as f32 * 2e-4);
        let chin = chin
            .into_iter()
            .find(|y| distance(Vec3::new(0.0, *y, 0.062)) < 0.0)
            .unwrap();
        assert!((chin - 1.38).abs() < 0.006, "{chin}");
        let nose = bust
            .positions
            .iter()
            .max_by(|a, b| a.z.total_cmp(&b.z))
            .unwrap();
        assert!(
            nose.x.abs() < 0.01 && (1.44..1.47).contains(&nose.y),
            "{nose}"
        );
    }

    #[test]
    fn it_is_closed_mirrored_and_evenly_shaded() {
        let bust = bust();
        let mut edges = std::collections::HashMap::new();
        for [a, b, c] in &bust.triangles {
            for edge in [(a, b), (b, c), (c, a)] {
                *edges.entry(edge).or_insert(0) += 1;
            }
        }
        for ((a, b), count) in &edges {
            assert_eq!(edges.get(&(*b, *a)), Some(count), "each edge has two sides");
        }
        for (triangle, normals) in bust.triangles.iter().map(|t| {
            let corners = t.map(|i| bust.positions[i as usize]);
            (corners, t.map(|i| bust.normals[i as usize]))
        }) {
            let [a, b, c] = triangle;
            let facing = (b - a).cross(c - a);
            // Elsewhere ears are thin, and the plane that cuts the shoulders has a sharp rim.
            if triangle.iter().all(|p| p.z > 0.03 && p.y > 1.37) {
                let cosine = normals
                    .iter()
                    .map(|n| n.dot(facing.normalize()))
                    .fold(1.0, f32::min);
                assert!(cosine > 0.8, "{triangle:?}: {cosine}");
            }
        }
        let p = Vec3::new(0.05, 1.5, 0.03);
        assert_eq!(distance(p), distance(p.with_x(-0.05)));
    }
}
