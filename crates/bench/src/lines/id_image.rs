//! An image of the numbers of triangles, by which systems before this one tell what is seen of a line (W, row W8): drawn for each eye, and looked up along it.

use glam::{DVec3, Vec3};
use mesh_lines::{Line, Surface};

/// The field of view, up and across: 30 degrees, whose half has this tangent.
const TANGENT: f64 = 0.267_949_192_431_122_7;

/// Triangles as an eye sees them.
pub struct IdImage {
    side: usize,
    /// The number of the nearest triangle, from 1 on; 0 is none.
    ids: Vec<u32>,
    inverse_depths: Vec<f32>,
    eye: DVec3,
    axes: [DVec3; 3],
}

impl IdImage {
    /// Of so many pixels up and across, seen by an eye that looks at a point.
    #[must_use]
    pub fn new(side: usize, eye: DVec3, at: DVec3) -> Self {
        let back = (eye - at).normalize();
        let right = DVec3::Y.cross(back).normalize_or(DVec3::X);
        Self {
            side,
            ids: vec![0; side * side],
            inverse_depths: vec![0.0; side * side],
            eye,
            axes: [right, back.cross(right), back],
        }
    }

    /// Pixels to the right and down, and the view depth.
    fn place(&self, point: DVec3) -> (f64, f64, f64) {
        let from_eye = point - self.eye;
        let [x, y, z] = self.axes.map(|axis| axis.dot(from_eye));
        let (depth, half) = (-z, 0.5 * self.side as f64);
        let scale = half / (depth * TANGENT);
        (half + x * scale, half - y * scale, depth)
    }

    /// Draws all triangles, the nearest on top. All must be in front of the eye.
    pub fn draw(&mut self, positions: &[Vec3], triangles: &[[u32; 3]]) {
        let placed: Vec<(f64, f64, f64)> =
            positions.iter().map(|p| self.place(p.as_dvec3())).collect();
        for (number, triangle) in (1..).zip(triangles) {
            let [a, b, c] = triangle.map(|i| placed[i as usize]);
            let area = (b.0 - a.0) * (c.1 - a.1) - (c.0 - a.0) * (b.1 - a.1);
            if area == 0.0 {
                continue;
            }
            let low = |of: fn(&(f64, f64, f64)) -> f64| of(&a).min(of(&b)).min(of(&c)).max(0.0);
            let high = |of: fn(&(f64, f64, f64)) -> f64| {
                of(&a).max(of(&b)).max(of(&c)).min(self.side as f64)
            };
            let (left, right) = (low(|p| p.0) as usize, high(|p| p.0).ceil() as usize);
            let (top, bottom) = (low(|p| p.1) as usize, high(|p| p.1).ceil() as usize);
            let depths = [a.2, b.2, c.2].map(f64::recip);
            for y in top..bottom {
                for x in left..right {
                    let (px, py) = (x as f64 + 0.5, y as f64 + 0.5);
                    let edge = |p: (f64, f64, f64), q: (f64, f64, f64)| {
                        ((q.0 - p.0) * (py - p.1) - (px - p.0) * (q.1 - p.1)) / area
                    };
                    let weights = [edge(b, c), edge(c, a), edge(a, b)];
                    if weights.iter().any(|weight| *weight < 0.0) {
                        continue;
                    }
                    let inverse: f64 = weights.iter().zip(depths).map(|(w, d)| w * d).sum();
                    let at = y * self.side + x;
                    if inverse as f32 > self.inverse_depths[at] {
                        self.inverse_depths[at] = inverse as f32;
                        self.ids[at] = number;
                    }
                }
            }
        }
    }

    /// Whether a place along a line is seen: its own triangle, or one that touches it, is in one of the nine pixels around it.
    #[must_use]
    pub fn sees(&self, surface: &Surface, line: &Line, along: f64) -> bool {
        let triangles = surface.topology().triangles();
        let segment = along as usize % line.segments.len();
        let own = triangles[line.segments[segment].triangle as usize];
        let (x, y, _) = self.place(line.position(along));
        let (x, y) = (x.floor() as i64, y.floor() as i64);
        let around = (-1..=1).flat_map(|down| (-1..=1).map(move |right| (x + right, y + down)));
        let inside = 0..self.side as i64;
        around
            .filter(|(x, y)| inside.contains(x) && inside.contains(y))
            .filter_map(|(x, y)| self.ids[y as usize * self.side + x as usize].checked_sub(1))
            .any(|id| {
                triangles[id as usize]
                    .iter()
                    .any(|corner| own.contains(corner))
            })
    }
}
