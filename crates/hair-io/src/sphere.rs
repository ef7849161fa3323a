//! The sphere that fits a cloud of roots.

use glam::{DMat3, DVec3, Vec3};

/// A sphere in the units of the points it was fitted to; the radius is above 0 and finite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Sphere {
    pub(crate) center: DVec3,
    pub(crate) radius: f64,
}

/// Below this determinant of their normalised covariance the points are too flat to say how their
/// surface curves. A hemisphere has 0.01, a cap of 20 degrees 2e-5.
const FLAT: f64 = 1e-5;

/// The least-squares sphere through finite points, without those far from the others.
///
/// Points that lie in a plane, or fewer than 4, have no such sphere: then it is centred on them
/// and reaches the farthest. `None` without two different points.
pub(crate) fn fit(points: &[Vec3]) -> Option<Sphere> {
    let points: Vec<DVec3> = points.iter().map(|p| p.as_dvec3()).collect();
    let mut kept = without_outliers(&points);
    let around = around(&kept)?;
    let mut sphere = None;
    for _ in 0..4 {
        let Some(fitted) = least_squares(&kept).filter(|s| s.radius < 3.0 * around.radius) else {
            break;
        };
        let residual = |p: &DVec3| (p.distance(fitted.center) - fitted.radius).abs();
        let limit = 4.0 * median(kept.iter().map(residual)) + 1e-9 * fitted.radius;
        kept.retain(|p| residual(p) <= limit);
        sphere = Some(fitted);
    }
    Some(sphere.unwrap_or(around))
}

/// The points within three times the median distance from the median point.
pub(crate) fn without_outliers(points: &[DVec3]) -> Vec<DVec3> {
    if points.is_empty() {
        return Vec::new();
    }
    let middle = DVec3::from([0, 1, 2].map(|axis| median(points.iter().map(|p| p[axis]))));
    let limit = 3.0 * median(points.iter().map(|p| p.distance(middle)));
    let kept: Vec<_> = points
        .iter()
        .copied()
        .filter(|p| p.distance(middle) <= limit)
        .collect();
    // More than half of the points coincide: no scale to call the others far by.
    if limit > 0.0 { kept } else { points.to_vec() }
}

/// The sphere about the points' mean that reaches the farthest of them.
fn around(points: &[DVec3]) -> Option<Sphere> {
    let center = points.iter().sum::<DVec3>() / points.len().max(1) as f64;
    let radius = points
        .iter()
        .map(|p| p.distance(center))
        .fold(0.0, f64::max);
    (radius > 0.0).then_some(Sphere { center, radius })
}

/// The algebraic fit: minimises the sum of (|p - c|^2 - r^2)^2, which is linear in c and r^2 - |c|^2.
///
/// About the mean of the points that is 2 C c = mean(p |p|^2), with C their covariance.
fn least_squares(points: &[DVec3]) -> Option<Sphere> {
    let count = points.len().max(1) as f64;
    let mean = points.iter().sum::<DVec3>() / count;
    let spread = (points.iter().map(|p| p.distance_squared(mean)).sum::<f64>() / count).sqrt();
    let mut covariance = DMat3::ZERO;
    let mut moment = DVec3::ZERO;
    for p in points {
        let q = (*p - mean) / spread;
        covariance += DMat3::from_cols(q * q.x, q * q.y, q * q.z) / count;
        moment += q * q.length_squared() / count;
    }
    let determinant = covariance.determinant();
    if determinant.is_nan() || determinant <= FLAT {
        return None; // NaN: all points coincide
    }
    let center = covariance.inverse() * moment * 0.5;
    let radius = (1.0 + center.length_squared()).sqrt();
    Some(Sphere {
        center: mean + center * spread,
        radius: radius * spread,
    })
}

/// The middle value (the upper one of two), 0 of none.
pub(crate) fn median(values: impl Iterator<Item = f64>) -> f64 {
    let mut values: Vec<f64> = values.collect();
    if values.is_empty() {
        return 0.0;
    }
    let middle = values.len() / 2;
    *values.select_nth_unstable_by(middle, f64::total_cmp).1
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Points of a cap about +Y that ends at height `lowest` (-1 to 1 radii), spread evenly.
    fn cap(center: Vec3, radius: f32, lowest: f32, count: u32) -> Vec<Vec3> {
        (0..count)
            .map(|i| {
                let y = 1.0 - (1.0 - lowest) * (i as f32 + 0.5) / count as f32;
                let angle = i as f32 * 2.399_963;
                let ring = (1.0 - y * y).sqrt();
                center + radius * Vec3::new(ring * angle.cos(), y, ring * angle.sin())
            })
            .collect()
    }

    proptest! {
        #[test]
        fn a_cap_gives_its_sphere(
            center in prop::array::uniform3(-5.0f32..5.0), radius in 0.05f32..50.0, lowest in -0.9f32..0.6,
        ) {
            let center = Vec3::from(center);
            let mut points = cap(center, radius, lowest, 200);
            points.extend([Vec3::splat(1e6), Vec3::new(-9e5, 3.0, 0.0)]);
            let sphere = fit(&points).unwrap();
            prop_assert!((sphere.radius - f64::from(radius)).abs() < 0.01 * f64::from(radius));
            prop_assert!(sphere.center.distance(center.as_dvec3()) < 0.01 * f64::from(radius));
        }

        #[test]
        fn any_points_give_a_sphere_of_finite_size_or_none(
            points in prop::collection::vec(prop::array::uniform3(prop_oneof![
                Just(0.0f32), -1.0f32..1.0, any::<f32>().prop_filter("finite", |x| x.is_finite())
            ]), 0..12),
        ) {
            let points: Vec<Vec3> = points.into_iter().map(Vec3::from).collect();
            if let Some(sphere) = fit(&points) {
                prop_assert!(sphere.radius > 0.0 && sphere.radius.is_finite());
                prop_assert!(sphere.center.is_finite());
            } else {
                prop_assert!(points.windows(2).all(|p| p[0].distance(p[1]) < 1e-6 || !p[0].distance(p[1]).is_finite()));
            }
        }
    }

    #[test]
    fn points_that_have_no_sphere_get_one_around_them() {
        assert_eq!(fit(&[]), None);
        assert_eq!(fit(&[Vec3::ONE; 5]), None);
        let flat: Vec<Vec3> = (0..100)
            .map(|i| Vec3::new((i % 10) as f32, 0.0, (i / 10) as f32))
            .collect();
        let sphere = fit(&flat).unwrap();
        assert!(sphere.center.distance(DVec3::new(4.5, 0.0, 4.5)) < 1e-6);
        assert!((sphere.radius - 4.5 * 2.0f64.sqrt()).abs() < 1e-6);
        assert!((fit(&[Vec3::ZERO, Vec3::X]).unwrap().radius - 0.5).abs() < 1e-6);
    }
}
