//! Bodies as they are drawn.

use crate::painted::{MeshPaint, PaintedMesh};
use glam::{DVec3, Vec3};
use stroke_path::sin_cos_degrees;

/// Rings and corners around of a ball.
const RINGS: u32 = 24;
const AROUND: u32 = 48;
/// How bright the side away from the light is.
const SHADE: f32 = 0.8;

/// Positions, normals and triangles.
pub(super) type Surface = (Vec<Vec3>, Vec<Vec3>, Vec<[u32; 3]>);

/// All within `radius` of the line from `-half` to `half`; a ball where that is nothing.
pub(super) fn capsule(half: DVec3, radius: f64) -> Surface {
    let axis = half.try_normalize().unwrap_or(DVec3::Y);
    let u = axis.any_orthonormal_vector();
    let v = axis.cross(u);
    let (mut positions, mut normals, mut triangles) = (Vec::new(), Vec::new(), Vec::new());
    // The ring in the middle is there twice: once for each half.
    let rows = 2 * (RINGS / 2 + 1);
    for row in 0..rows {
        let is_upper = row < rows / 2;
        let ring = if is_upper { row } else { row - 1 };
        let (level, along) = sin_cos_degrees(180.0 * f64::from(ring) / f64::from(RINGS));
        for corner in 0..AROUND {
            let (sin, cos) = sin_cos_degrees(360.0 * f64::from(corner) / f64::from(AROUND));
            let normal = (u * cos + v * sin) * level + axis * along;
            let end = if is_upper { half } else { -half };
            positions.push((end + normal * radius).as_vec3());
            normals.push(normal.as_vec3());
        }
    }
    for row in 0..rows - 1 {
        for corner in 0..AROUND {
            let next = (corner + 1) % AROUND;
            let [a, b] = [corner, next].map(|corner| row * AROUND + corner);
            triangles.extend([[a, a + AROUND, b], [b, a + AROUND, b + AROUND]]);
        }
    }
    (positions, normals, triangles)
}

/// A surface in one colour.
pub(super) fn painted(
    positions: Vec<Vec3>,
    normals: Vec<Vec3>,
    triangles: Vec<[u32; 3]>,
    color: [f32; 3],
) -> PaintedMesh {
    PaintedMesh {
        positions,
        normals,
        triangles,
        places: Vec::new(),
        paint: MeshPaint {
            color: Some(color),
            shade: Some(color.map(|light| light * SHADE)),
            picture: None,
            both_sides: false,
        },
        names: Vec::new(),
        section: None,
        index: 0,
        kept: Vec::new(),
        is_turned: false,
        is_shell: false,
        is_cap: false,
        moving: None,
        form: 0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_capsule_is_as_large_as_it_says_and_faces_outwards() {
        for half in [DVec3::ZERO, DVec3::new(0.1, 0.2, -0.1)] {
            let (positions, normals, triangles) = capsule(half, 0.05);
            for (position, normal) in positions.iter().zip(&normals) {
                let p = position.as_dvec3();
                let along = p.dot(half) / half.length_squared().max(1e-300);
                let away = (p - half * along.clamp(-1.0, 1.0)).length();
                assert!((away - 0.05).abs() < 1e-6, "{away}");
                assert!((normal.length() - 1.0).abs() < 1e-6);
            }
            let volume: f64 = triangles
                .iter()
                .map(|t| {
                    let [a, b, c] = t.map(|i| positions[i as usize].as_dvec3());
                    a.dot(b.cross(c)) / 6.0
                })
                .sum();
            let pi = std::f64::consts::PI;
            let exact = pi * 0.05_f64.powi(2) * (2.0 * half.length() + 4.0 / 3.0 * 0.05);
            assert!(
                (0.97..1.0).contains(&(volume / exact)),
                "{}",
                volume / exact
            );
        }
    }
}
