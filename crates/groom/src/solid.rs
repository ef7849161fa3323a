//! Solids as signed distances (metres, below 0 inside), and how they melt into each other.

use glam::Vec3;

/// About the distance to an ellipsoid with these half axes (exact at its surface).
pub(crate) fn ellipsoid(p: Vec3, center: Vec3, half_axes: Vec3) -> f32 {
    let q = (p - center) / half_axes;
    let (near, steep) = (q.length(), (q / half_axes).length());
    if steep > 0.0 {
        near * (near - 1.0) / steep
    } else {
        -half_axes.min_element()
    }
}

/// The distance to a round cone from `a` to `b`, its radius linear between.
pub(crate) fn cone(p: Vec3, a: Vec3, b: Vec3, radius_a: f32, radius_b: f32) -> f32 {
    let axis = b - a;
    let t = ((p - a).dot(axis) / axis.length_squared()).clamp(0.0, 1.0);
    (p - a - axis * t).length() - (radius_a + (radius_b - radius_a) * t)
}

/// Both solids, with a fillet about `fillet` wide where they meet (the polynomial smooth minimum).
pub(crate) fn melt(a: f32, b: f32, fillet: f32) -> f32 {
    let h = (0.5 + 0.5 * (b - a) / fillet).clamp(0.0, 1.0);
    b + (a - b) * h - fillet * h * (1.0 - h)
}

/// What is in both solids, with edges rounded about `fillet` wide.
pub(crate) fn common(a: f32, b: f32, fillet: f32) -> f32 {
    -melt(-a, -b, fillet)
}

/// A bump of height 1 that ends in a circle of radius 1 around the origin, by the square of the
/// distance to it.
pub(crate) fn bump(squared: f32) -> f32 {
    let left = (1.0 - squared).max(0.0);
    left * left
}

/// The gradient of a distance, by central differences `step` to each side: details smaller than that
/// do not count.
pub(crate) fn gradient(distance: impl Fn(Vec3) -> f32, p: Vec3, step: f32) -> Vec3 {
    let along = |axis: Vec3| (distance(p + axis * step) - distance(p - axis * step)) / (2.0 * step);
    Vec3::new(along(Vec3::X), along(Vec3::Y), along(Vec3::Z))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances_are_zero_on_surfaces_and_signed_inside() {
        let half = Vec3::new(1.0, 2.0, 3.0);
        for surface in [Vec3::X, Vec3::Y * 2.0, Vec3::Z * -3.0] {
            assert!(ellipsoid(surface, Vec3::ZERO, half).abs() < 1e-6);
            assert!(ellipsoid(surface * 0.9, Vec3::ZERO, half) < 0.0);
            assert!(ellipsoid(surface * 1.1, Vec3::ZERO, half) > 0.0);
        }
        assert!(ellipsoid(Vec3::ZERO, Vec3::ZERO, half) < 0.0);
        assert!((cone(Vec3::X * 2.0, Vec3::ZERO, Vec3::Y, 0.5, 0.5) - 1.5).abs() < 1e-6);
        assert!((cone(Vec3::Y * 3.0, Vec3::ZERO, Vec3::Y, 0.5, 0.25) - 1.75).abs() < 1e-6);
    }

    #[test]
    fn melting_only_adds() {
        for (a, b) in [(0.0, 1.0), (0.3, 0.3), (-0.2, 0.1), (5.0, -1.0)] {
            assert!(melt(a, b, 0.1) <= f32::min(a, b) + 1e-6);
            assert!((melt(a, b, 0.1) - melt(b, a, 0.1)).abs() < 1e-6);
        }
        assert_eq!(melt(0.0, 1.0, 0.1), 0.0, "far apart nothing changes");
        assert_eq!(common(0.0, 1.0, 0.1), 1.0);
        assert!(common(0.3, 0.3, 0.1) > 0.3, "edges are taken off");
    }

    #[test]
    fn gradients_point_outwards() {
        let sphere = |p: Vec3| ellipsoid(p, Vec3::ZERO, Vec3::ONE);
        let at = Vec3::new(0.6, 0.8, 0.0);
        assert!((gradient(sphere, at, 1e-4) - at).length() < 1e-2);
    }
}
