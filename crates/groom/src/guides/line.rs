//! A strand resampled by arc length.

use std::array;

use glam::{DVec3, Vec3};

/// A strand as eight segments of equal length: enough for its shape at the size of a clump.
pub(super) struct Line([DVec3; 9]);

impl Line {
    /// The line of a strand of one point or more.
    pub(super) fn new(points: &[Vec3]) -> Self {
        Self(resample(points, array::from_fn(|k| k as f64 / 8.0)).0)
    }

    /// Its points, root first.
    pub(super) fn points(&self) -> &[DVec3] {
        &self.0
    }

    /// The squared distance of a point from the line.
    pub(super) fn distance_squared(&self, point: DVec3) -> f64 {
        let segment = |ends: &[DVec3]| {
            let (start, along) = (ends[0], ends[1] - ends[0]);
            let length_squared = along.length_squared().max(f64::MIN_POSITIVE);
            let share = ((point - start).dot(along) / length_squared).clamp(0.0, 1.0);
            (start + along * share).distance_squared(point)
        };
        self.0.windows(2).map(segment).fold(f64::INFINITY, f64::min)
    }
}

/// The points at these shares of a strand's length (ascending, 0 to 1), and the length, in the
/// strand's units. A strand without length is all root.
pub(super) fn resample<const N: usize>(points: &[Vec3], fractions: [f64; N]) -> ([DVec3; N], f64) {
    let ends = |k: usize| (points[k].as_dvec3(), points[k + 1].as_dvec3());
    let length_of = |(start, end): (DVec3, DVec3)| start.distance(end);
    let length: f64 = (0..points.len() - 1).map(|k| length_of(ends(k))).sum();
    // The segment that is looked at, and the length before it.
    let (mut k, mut before) = (0, 0.0);
    let samples = fractions.map(|fraction| {
        let target = fraction * length;
        while k + 1 < points.len() {
            let (start, end) = ends(k);
            let here = start.distance(end);
            if before + here >= target && here > 0.0 {
                return start.lerp(end, ((target - before) / here).clamp(0.0, 1.0));
            }
            before += here;
            k += 1;
        }
        points[points.len() - 1].as_dvec3()
    });
    (samples, length)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn samples_lie_at_their_share_of_the_length() {
        let bent = [Vec3::ZERO, Vec3::X, Vec3::X, Vec3::new(1.0, 3.0, 0.0)];
        let (samples, length) = resample(&bent, [0.0, 0.125, 0.25, 0.5, 1.0]);
        assert_eq!(length, 4.0);
        let expected = [(0.0, 0.0), (0.5, 0.0), (1.0, 0.0), (1.0, 1.0), (1.0, 3.0)];
        assert_eq!(samples, expected.map(|(x, y)| DVec3::new(x, y, 0.0)));
        for still in [&[Vec3::Y][..], &[Vec3::Y; 3]] {
            assert_eq!(resample(still, [0.0, 0.5, 1.0]), ([DVec3::Y; 3], 0.0));
        }
    }

    proptest! {
        #[test]
        fn the_distance_is_that_of_the_nearest_of_many_points(
            points in prop::collection::vec(prop::array::uniform3(-1.0f32..1.0), 1..5),
            from in prop::array::uniform3(-2.0f64..2.0),
        ) {
            let points: Vec<Vec3> = points.into_iter().map(Vec3::from).collect();
            let (line, from) = (Line::new(&points), DVec3::from(from));
            let ends = line.points().windows(2);
            let many = ends.flat_map(|e| (0..=200).map(|k| e[0].lerp(e[1], f64::from(k) / 200.0)));
            let nearest = many.map(|p| p.distance(from)).fold(f64::INFINITY, f64::min);
            prop_assert!((line.distance_squared(from).sqrt() - nearest).abs() < 0.01);
        }
    }
}
