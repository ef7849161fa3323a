//! One property of a node in time, sampled as the glTF 2.0 specification has it (appendix C), without the
//! platform's sine.

use super::document::{Interpolation, Sampler};
use super::error::TrackError;
use super::numbers::Buffers;
use glam::{DQuat, DVec3};
use std::ops::{Add, Mul};

/// A property in time.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Track<T> {
    /// In s, increasing; one or more.
    times: Vec<f64>,
    /// One a key; where it is cubic three: slope before, value, slope after.
    values: Vec<T>,
    kind: Interpolation,
}

/// What a track is of.
pub(super) trait Value: Copy + Add<Output = Self> + Mul<f64, Output = Self> {
    fn read(sampler: &Sampler, buffers: &mut Buffers) -> Result<Vec<Self>, TrackError>;
    /// At share `t` of the way from `a` to `b`.
    fn between(a: Self, b: Self, t: f64) -> Self;
    /// After sums.
    fn whole(self) -> Self;
}

impl Value for DVec3 {
    fn read(sampler: &Sampler, buffers: &mut Buffers) -> Result<Vec<Self>, TrackError> {
        let numbers = buffers.numbers::<3>(sampler.output)?;
        Ok(numbers.into_iter().map(Self::from).collect())
    }

    fn between(a: Self, b: Self, t: f64) -> Self {
        a + (b - a) * t
    }

    fn whole(self) -> Self {
        self
    }
}

impl Value for DQuat {
    fn read(sampler: &Sampler, buffers: &mut Buffers) -> Result<Vec<Self>, TrackError> {
        let numbers = buffers.numbers::<4>(sampler.output)?;
        Ok(numbers.into_iter().map(Self::from_array).collect())
    }

    /// Along the great circle, by halving: no sine.
    fn between(a: Self, b: Self, t: f64) -> Self {
        let (mut from, mut to) = (a.whole(), b.whole());
        if from.dot(to) < 0.0 {
            to = -to;
        }
        let mut share = t;
        for _ in 0..50 {
            let middle = (from + to).normalize();
            share *= 2.0;
            if share < 1.0 {
                to = middle;
            } else {
                from = middle;
                share -= 1.0;
            }
        }
        from
    }

    fn whole(self) -> Self {
        let length = self.length();
        if length > 0.0 {
            self * (1.0 / length)
        } else {
            Self::IDENTITY
        }
    }
}

impl<T: Value> Track<T> {
    pub fn read(sampler: &Sampler, buffers: &mut Buffers) -> Result<Self, TrackError> {
        let times = buffers.numbers::<1>(sampler.input)?;
        let times: Vec<f64> = times.into_iter().map(|[time]| time).collect();
        let values = T::read(sampler, buffers)?;
        let kind = sampler.interpolation;
        let of_a_key = if kind == Interpolation::CubicSpline {
            3
        } else {
            1
        };
        let increase = times.windows(2).all(|pair| pair[0] < pair[1]);
        if times.is_empty() || values.len() != times.len() * of_a_key || !increase {
            return Err(TrackError::Keys {
                keys: times.len(),
                values: values.len(),
            });
        }
        Ok(Self {
            times,
            values,
            kind,
        })
    }

    /// When its last key is, in s.
    pub fn length(&self) -> f64 {
        self.times[self.times.len() - 1]
    }

    /// The value at `time` (s), that of the first or the last key outside them.
    pub fn at(&self, time: f64) -> T {
        let next = self.times.partition_point(|key| *key <= time);
        let value = |key: usize| match self.kind {
            Interpolation::CubicSpline => self.values[3 * key + 1].whole(),
            _ => self.values[key].whole(),
        };
        if next == 0 || next == self.times.len() {
            return value(next.saturating_sub(1));
        }
        let (a, b) = (next - 1, next);
        let seconds = self.times[b] - self.times[a];
        let t = (time - self.times[a]) / seconds;
        match self.kind {
            Interpolation::Step => value(a),
            Interpolation::Linear => T::between(value(a), value(b), t),
            Interpolation::CubicSpline => {
                let (t2, t3) = (t * t, t * t * t);
                let leaving = self.values[3 * a + 2] * (seconds * (t3 - 2.0 * t2 + t));
                let coming = self.values[3 * b] * (seconds * (t3 - t2));
                let from = self.values[3 * a + 1] * (2.0 * t3 - 3.0 * t2 + 1.0);
                let to = self.values[3 * b + 1] * (3.0 * t2 - 2.0 * t3);
                (from + leaving + to + coming).whole()
            }
        }
    }
}
