//! A tube with 64 sides around a strand, by rays in double precision: what the other way to draw a strand would show.

use glam::{DVec2, DVec3};
use stroke_path::Camera;

/// Sides of the tube.
const SIDES: usize = 64;

/// What rays through the middles of a picture's pixels meet.
pub struct Tube {
    pub width: usize,
    /// Of each pixel, row by row: the unit normal where the ray meets the tube from outside.
    pub normals: Vec<Option<DVec3>>,
}

/// A corner of the tube: in the picture (px), one over its depth (1/m), and the normal over its depth.
#[derive(Clone, Copy)]
struct Corner {
    place: DVec2,
    inv_depth: f64,
    normal: DVec3,
}

impl Tube {
    /// One of that radius (m) around these points, open at both ends.
    pub fn cast(points: &[DVec3], radius_m: f64, camera: &Camera) -> Self {
        let [width, height] = camera.size_px().map(|side| side as usize);
        let mut nearest = vec![0.0; width * height];
        let mut normals = vec![None; width * height];
        let rings = rings(points, radius_m, camera);
        for pair in rings.windows(2) {
            for side in 0..SIDES {
                let next = (side + 1) % SIDES;
                let [a, b, c, d] = [pair[0][side], pair[0][next], pair[1][side], pair[1][next]];
                for triangle in [[a, b, c], [b, d, c]] {
                    cast(&triangle, width, &mut nearest, &mut normals);
                }
            }
        }
        Self { width, normals }
    }
}

/// The tube's corners around each point: in the middle between the two links, and turned along with the curve.
fn rings(points: &[DVec3], radius_m: f64, camera: &Camera) -> Vec<[Corner; SIDES]> {
    let last = points.len() - 1;
    let mut aside = DVec3::ZERO;
    let ring = |i: usize| {
        let along = (points[(i + 1).min(last)] - points[i.max(1) - 1]).normalize();
        if i == 0 {
            aside = along.any_orthonormal_vector();
        }
        aside = (aside - aside.dot(along) * along).normalize();
        let up = along.cross(aside);
        std::array::from_fn(|side| {
            let angle = std::f64::consts::TAU * side as f64 / SIDES as f64;
            let normal = angle.cos() * aside + angle.sin() * up;
            corner(points[i] + radius_m * normal, normal, camera)
        })
    };
    (0..points.len()).map(ring).collect()
}

fn corner(point: DVec3, normal: DVec3, camera: &Camera) -> Corner {
    let [right, up, back] = [glam::Vec3::X, glam::Vec3::Y, glam::Vec3::Z]
        .map(|axis| camera.world_from_view_direction(axis).as_dvec3());
    let from_eye = point - camera.eye().as_dvec3();
    let depth = from_eye.dot(back);
    let [width, height] = camera.size_px().map(f64::from);
    let focal = f64::from(camera.focal_px());
    let place = DVec2::new(from_eye.dot(right), -from_eye.dot(up)) * focal / depth;
    Corner {
        place: place + 0.5 * DVec2::new(width, height),
        inv_depth: 1.0 / depth,
        normal: normal / depth,
    }
}

/// What the rays through a triangle's pixels meet of it, where it is nearer than what they met.
fn cast(triangle: &[Corner; 3], width: usize, nearest: &mut [f64], normals: &mut [Option<DVec3>]) {
    let [a, b, c] = triangle.map(|corner| corner.place);
    let area = (b - a).perp_dot(c - a);
    if area == 0.0 {
        return;
    }
    let height = nearest.len() / width;
    let pixels = |low: f64, high: f64, count: usize| {
        let [first, end] = [low - 0.5, high + 0.5].map(|end| end.clamp(0.0, count as f64));
        first as usize..end.ceil() as usize
    };
    let (low, high) = (a.min(b).min(c), a.max(b).max(c));
    for row in pixels(low.y, high.y, height) {
        for column in pixels(low.x, high.x, width) {
            let point = DVec2::new(column as f64, row as f64) + 0.5;
            let shares = [
                (c - b).perp_dot(point - b) / area,
                (a - c).perp_dot(point - c) / area,
                (b - a).perp_dot(point - a) / area,
            ];
            if shares.iter().any(|share| *share < 0.0) {
                continue;
            }
            let corners = triangle.iter().zip(shares);
            let inv_depth: f64 = corners.clone().map(|(c, share)| share * c.inv_depth).sum();
            let normal: DVec3 = corners.map(|(c, share)| share * c.normal).sum();
            let pixel = row * width + column;
            if inv_depth > nearest[pixel] {
                nearest[pixel] = inv_depth;
                normals[pixel] = Some(normal.normalize());
            }
        }
    }
}
