//! Played-back motion: positions of the same points at given times.

pub(crate) mod spline;

use glam::{DVec3, Vec3};

use spline::key_weights;

/// Positions of all points of some [`Strands`](crate::Strands) at increasing times.
#[derive(Clone, Debug, PartialEq)]
pub struct PointCache {
    times: Vec<f32>,
    samples: Vec<Vec<Vec3>>,
}

/// Why time samples make no motion.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PointCacheError {
    /// There must be at least one sample.
    #[error("the motion has no time samples")]
    Empty,
    /// Times increase.
    #[error("sample {sample}: the time {time} s is not after the sample before it")]
    Order {
        /// The sample's index.
        sample: usize,
        /// Its time in seconds.
        time: f32,
    },
    /// Every sample has the same number of points.
    #[error("sample {sample} has {found} points in place of {expected}")]
    Count {
        /// The sample's index.
        sample: usize,
        /// The points of the first sample.
        expected: usize,
        /// The points of this sample.
        found: usize,
    },
    /// Positions are finite.
    #[error("sample {sample}, point {point}: the position is not finite")]
    NotFinite {
        /// The sample's index.
        sample: usize,
        /// The point's index in the sample.
        point: usize,
    },
}

impl PointCache {
    /// A motion from `(time in seconds, positions in metres)`.
    ///
    /// # Errors
    ///
    /// When there are no samples, times do not increase, or points are missing or not finite.
    pub fn new(samples: Vec<(f32, Vec<Vec3>)>) -> Result<Self, PointCacheError> {
        let expected = samples.first().ok_or(PointCacheError::Empty)?.1.len();
        let mut last = f32::NEG_INFINITY;
        for (i, (time, points)) in samples.iter().enumerate() {
            if !time.is_finite() || *time <= last {
                return Err(PointCacheError::Order {
                    sample: i,
                    time: *time,
                });
            }
            last = *time;
            if points.len() != expected {
                return Err(PointCacheError::Count {
                    sample: i,
                    expected,
                    found: points.len(),
                });
            }
            if let Some(point) = points.iter().position(|p| !p.is_finite()) {
                return Err(PointCacheError::NotFinite { sample: i, point });
            }
        }
        let (times, samples) = samples.into_iter().unzip();
        Ok(Self { times, samples })
    }

    /// The times of the samples, in seconds, increasing.
    #[must_use]
    pub fn times(&self) -> &[f32] {
        &self.times
    }

    /// Writes the positions at `time` (seconds) into `points`: linear between samples, held before
    /// the first and after the last.
    ///
    /// # Panics
    ///
    /// When `points` does not have the motion's number of points.
    pub fn sample(&self, time: f32, points: &mut [Vec3]) {
        let next = self.times.partition_point(|t| *t <= time);
        if next == 0 {
            points.copy_from_slice(&self.samples[0]);
        } else if next == self.times.len() {
            points.copy_from_slice(&self.samples[next - 1]);
        } else {
            let (before, after) = (&self.samples[next - 1], &self.samples[next]);
            let t0 = self.times[next - 1];
            let blend = (time - t0) / (self.times[next] - t0);
            for ((point, a), b) in points.iter_mut().zip(before).zip(after) {
                *point = a.lerp(*b, blend);
            }
        }
    }

    /// Writes the positions at `time` (seconds) into `points`: on a spline through the samples, as [`key_weights`]
    /// has it.
    ///
    /// # Panics
    ///
    /// As [`Self::sample`].
    pub fn sample_smooth(&self, time: f64, points: &mut [Vec3]) {
        let time_of = |key: usize| f64::from(self.times[key]);
        let keys = key_weights(self.times.len(), time_of, |_| false, time);
        assert_eq!(points.len(), self.samples[0].len());
        for (i, point) in points.iter_mut().enumerate() {
            let weighted = keys.map(|(key, weight)| self.samples[key][i].as_dvec3() * weight);
            *point = weighted.into_iter().sum::<DVec3>().as_vec3();
        }
    }

    /// The motion of the points at these indices of the list, in this order.
    #[must_use]
    pub fn select(&self, indices: &[usize]) -> Self {
        let pick = |points: &Vec<Vec3>| indices.iter().map(|&i| points[i]).collect();
        Self {
            times: self.times.clone(),
            samples: self.samples.iter().map(pick).collect(),
        }
    }

    /// Applies `map` to every position (for axes and units).
    pub fn map_points(&mut self, map: impl Fn(Vec3) -> Vec3) {
        for point in self.samples.iter_mut().flatten() {
            *point = map(*point);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn motion() -> PointCache {
        PointCache::new(vec![
            (0.0, vec![Vec3::ZERO, Vec3::X]),
            (2.0, vec![Vec3::Y, Vec3::X * 3.0]),
        ])
        .unwrap()
    }

    #[test]
    fn samples_are_joined_linearly_and_held_at_the_ends() {
        let mut points = [Vec3::ZERO; 2];
        motion().sample(0.5, &mut points);
        assert_eq!(points, [Vec3::Y * 0.25, Vec3::X * 1.5]);
        motion().sample(-1.0, &mut points);
        assert_eq!(points, [Vec3::ZERO, Vec3::X]);
        motion().sample(9.0, &mut points);
        assert_eq!(points, [Vec3::Y, Vec3::X * 3.0]);
    }

    #[test]
    fn broken_samples_are_refused() {
        assert_eq!(PointCache::new(vec![]), Err(PointCacheError::Empty));
        let twice = vec![(1.0, vec![Vec3::ZERO]), (1.0, vec![Vec3::ZERO])];
        assert!(matches!(
            PointCache::new(twice),
            Err(PointCacheError::Order { sample: 1, .. })
        ));
        let short = vec![(0.0, vec![Vec3::ZERO]), (1.0, vec![])];
        assert!(matches!(
            PointCache::new(short),
            Err(PointCacheError::Count { sample: 1, .. })
        ));
        let nan = vec![(0.0, vec![Vec3::NAN])];
        assert!(matches!(
            PointCache::new(nan),
            Err(PointCacheError::NotFinite { .. })
        ));
        assert!(PointCache::new(vec![(f32::NAN, vec![])]).is_err());
    }

    #[test]
    fn shapes_are_joined_smoothly() {
        let shape = |x: f32| vec![Vec3::ZERO, Vec3::new(x, -1.0, 0.0)];
        let motion = PointCache::new(vec![(0.0, shape(0.0)), (1.0, shape(1.0))]).unwrap();
        let mut points = [Vec3::ZERO; 2];
        motion.sample_smooth(0.25, &mut points);
        // It starts slowly: 3 t^2 - 2 t^3.
        assert_eq!(points, [Vec3::ZERO, Vec3::new(0.15625, -1.0, 0.0)]);
        motion.sample_smooth(7.0, &mut points);
        assert_eq!(points[1].x, 1.0);
        let still = PointCache::new(vec![(5.0, shape(3.0))]).unwrap();
        still.sample_smooth(0.0, &mut points);
        assert_eq!(points[1].x, 3.0);
    }
}
