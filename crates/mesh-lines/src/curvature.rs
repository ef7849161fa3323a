//! How a surface bends at each vertex.

use crate::Surface;
use glam::{DMat3, DQuat, DVec3};

/// How a surface bends at a vertex: positive where it bends away from its normal, as a sphere does, whose curvatures are 1 / radius.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Curvature {
    /// The larger and the smaller principal curvature, in 1 / length.
    pub principal: [f64; 2],
    /// Their directions: unit vectors, square to each other and to the normal; 0 where the vertex has no triangle with an area.
    pub directions: [DVec3; 2],
}

impl Curvature {
    /// The normal curvature in a direction of the surface (any length), times its squared length.
    #[must_use]
    pub fn second_form(&self, direction: DVec3) -> f64 {
        (0..2)
            .map(|i| self.principal[i] * self.directions[i].dot(direction).powi(2))
            .sum()
    }
}

/// The principal curvatures at each smooth vertex, by the differences of normals along the edges of the triangles around it.
///
/// Rusinkiewicz, *Estimating curvatures and their derivatives on triangle meshes* (2004), section 3: of each triangle the second fundamental form that fits best, turned
/// into the tangent plane of each corner, and there the mean by area.
#[must_use]
pub fn curvatures(surface: &Surface) -> Vec<Curvature> {
    let mut sums = vec![(DMat3::ZERO, 0.0); surface.normals().len()];
    for (triangle, corners) in (0..).zip(surface.topology().smooth_corners()) {
        let Some((form, normal, area)) = form_of_triangle(surface, triangle) else {
            continue;
        };
        for &vertex in corners {
            let at_vertex = surface.normals()[vertex as usize].as_dvec3();
            let turn =
                DMat3::from_quat(DQuat::from_rotation_arc(normal, unit_or(at_vertex, normal)));
            let (sum, weight) = &mut sums[vertex as usize];
            *sum += turn * form * turn.transpose() * area;
            *weight += area;
        }
    }
    sums.into_iter()
        .zip(surface.normals())
        .map(|((sum, weight), normal)| {
            if weight > 0.0 {
                principal(sum * (1.0 / weight), normal.as_dvec3())
            } else {
                Curvature::default()
            }
        })
        .collect()
}

/// The second fundamental form of a triangle as a matrix of space, its normal, and its area.
fn form_of_triangle(surface: &Surface, triangle: u32) -> Option<(DMat3, DVec3, f64)> {
    let area_normal = surface.area_normal(triangle);
    let normal = area_normal.try_normalize()?;
    let corners = surface.corners(triangle);
    let normals = surface.corner_normals(triangle);
    let u = (corners[1] - corners[0]).try_normalize()?;
    let v = normal.cross(u);
    // Least squares for a, b, c of ((a, b), (b, c)) (x, y) = (p, q), edge by edge, in units of the longest one.
    let edges = [(0, 1), (1, 2), (2, 0)];
    let unit = edges
        .map(|(i, j)| corners[i].distance(corners[j]))
        .into_iter()
        .fold(0.0, f64::max);
    let mut matrix = DMat3::ZERO;
    let mut right = DVec3::ZERO;
    for (i, j) in edges {
        let edge = (corners[j] - corners[i]) / unit;
        let turn = normals[j] - normals[i];
        let [x, y, p, q] = [edge.dot(u), edge.dot(v), turn.dot(u), turn.dot(v)];
        matrix += DMat3::from_cols(
            DVec3::new(x * x, x * y, 0.0),
            DVec3::new(x * y, x * x + y * y, x * y),
            DVec3::new(0.0, x * y, y * y),
        );
        right += DVec3::new(x * p, y * p + x * q, y * q);
    }
    // Of a needle nothing can be told across it.
    if matrix.determinant() < 1e-12 {
        return None;
    }
    let fit = matrix.inverse() * right / unit;
    let outer = |a: DVec3, b: DVec3| DMat3::from_cols(a * b.x, a * b.y, a * b.z);
    let form = outer(u, u) * fit.x + (outer(u, v) + outer(v, u)) * fit.y + outer(v, v) * fit.z;
    Some((form, normal, area_normal.length() / 2.0))
}

/// The principal curvatures of a form: the eigenvalues of what of it lies square to the normal.
fn principal(form: DMat3, normal: DVec3) -> Curvature {
    let normal = unit_or(normal, DVec3::Z);
    let u = normal.any_orthonormal_vector();
    let v = normal.cross(u);
    let [a, b, c] = [u.dot(form * u), u.dot(form * v), v.dot(form * v)];
    let mean = (a + c) / 2.0;
    let half = ((a - c) / 2.0).hypot(b);
    // An eigenvector of the larger one, taken from the row that loses no digits.
    let along = if a >= c {
        u * ((a - c) / 2.0 + half) + v * b
    } else {
        u * b + v * ((c - a) / 2.0 + half)
    };
    let first = unit_or(along, u);
    Curvature {
        principal: [mean + half, mean - half],
        directions: [first, normal.cross(first)],
    }
}

fn unit_or(vector: DVec3, other: DVec3) -> DVec3 {
    vector.try_normalize().unwrap_or(other)
}
