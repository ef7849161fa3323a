//! The bust's shape.

use crate::face::{self, Patch};
use crate::solid::{cone, ellipsoid, gradient, melt};
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

/// The signed distance to the skin, metres. Mirrored across x = 0.
pub(crate) fn distance(p: Vec3) -> f32 {
    let side = p.with_x(p.x.abs());
    let cut = 1.125 - p.y; // the shoulders end in a plane
    melt(head(p, side), shoulders(p, side), 0.035).max(cut)
}

fn head(p: Vec3, side: Vec3) -> f32 {
    let v = Vec3::new;
    let cranium = ellipsoid(p, v(0.0, 1.530, -0.012), v(0.083, 0.090, 0.100));
    let face = ellipsoid(p, v(0.0, 1.482, 0.022), v(0.068, 0.090, 0.072));
    let jaw = ellipsoid(p, v(0.0, 1.431, 0.042), v(0.037, 0.046, 0.046));
    let chin = ellipsoid(p, v(0.0, 1.402, 0.060), v(0.016, 0.016, 0.018));
    let nose = cone(
        side,
        v(0.0, 1.480, 0.090),
        v(0.0, 1.452, 0.1015),
        0.002,
        0.0035,
    );
    let ear = ellipsoid(side, v(0.085, 1.487, -0.014), v(0.008, 0.027, 0.016));
    let skull = melt(cranium, face, 0.03);
    let jawed = melt(melt(skull, jaw, 0.045), chin, 0.03);
    melt(melt(jawed, nose, 0.014), ear, 0.008)
}

fn shoulders(p: Vec3, side: Vec3) -> f32 {
    let v = Vec3::new;
    let neck = cone(p, v(0.0, 1.43, -0.018), v(0.0, 1.28, -0.028), 0.031, 0.038);
    let shoulder = cone(
        side,
        v(0.02, 1.282, -0.03),
        v(0.105, 1.262, -0.035),
        0.043,
        0.038,
    );
    let chest = ellipsoid(p, v(0.0, 1.20, -0.03), v(0.122, 0.125, 0.070));
    melt(melt(shoulder, chest, 0.05), neck, 0.035)
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
