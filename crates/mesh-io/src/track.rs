//! One property in time, sampled as the glTF 2.0 specification has it (appendix C), without the platform's sine.

use glam::{DQuat, DVec3};
use std::ops::{Add, Mul};

/// How a property goes from key to key.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "gltf", derive(serde::Deserialize))]
#[cfg_attr(feature = "gltf", serde(rename_all = "UPPERCASE"))]
pub(crate) enum Interpolation {
    #[default]
    Linear,
    Step,
    CubicSpline,
}

/// A step is taken so much before its key, in s: the time of a frame, in single precision or come round in a loop, can be a little less than
/// that of the key that it was made from, and would show what was a frame before.
const EARLY: f64 = 1e-4;

/// A property in time.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Track<T> {
    /// In s, increasing; one or more.
    times: Vec<f64>,
    /// One a key; where it is cubic three: slope before, value, slope after.
    values: Vec<T>,
    kind: Interpolation,
}

/// What a track is of.
pub(crate) trait Value: Copy + Add<Output = Self> + Mul<f64, Output = Self> {
    /// At share `t` of the way from `a` to `b`.
    fn between(a: Self, b: Self, t: f64) -> Self;
    /// After sums.
    fn whole(self) -> Self;
}

impl Value for f64 {
    fn between(a: Self, b: Self, t: f64) -> Self {
        a + (b - a) * t
    }

    fn whole(self) -> Self {
        self
    }
}

impl Value for DVec3 {
    fn between(a: Self, b: Self, t: f64) -> Self {
        a + (b - a) * t
    }

    fn whole(self) -> Self {
        self
    }
}

impl Value for DQuat {
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

impl Interpolation {
    /// Values a key.
    pub fn values(self) -> usize {
        match self {
            Self::CubicSpline => 3,
            Self::Linear | Self::Step => 1,
        }
    }
}

impl<T: Value> Track<T> {
    /// A track of these keys; `None` where there is none, or there are not as many values, or times don't increase.
    pub fn new(times: Vec<f64>, values: Vec<T>, kind: Interpolation) -> Option<Self> {
        let increase = times.windows(2).all(|pair| pair[0] < pair[1]);
        let fit = !times.is_empty() && values.len() == times.len() * kind.values();
        (fit && increase).then_some(Self {
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
        let early = match self.kind {
            Interpolation::Step => EARLY,
            _ => 0.0,
        };
        let next = self.times.partition_point(|key| *key <= time + early);
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

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn lines_and_cubics_give_back_what_they_were_made_of(
            gaps in prop::collection::vec(0.01f64..2.0, 1..8), factors in prop::array::uniform4(-3.0f64..3.0), share in 0.0f64..1.0,
        ) {
            let mut times = vec![-0.5];
            for gap in &gaps {
                times.push(times[times.len() - 1] + gap);
            }
            let [a, b, c, d] = factors;
            let line = |t: f64| a + b * t;
            let cubic = |t: f64| a + t * (b + t * (c + t * d));
            let slope = |t: f64| b + t * (2.0 * c + t * 3.0 * d);
            let lines = Track::new(times.clone(), times.iter().map(|t| line(*t)).collect(), Interpolation::Linear).unwrap();
            let values = times.iter().flat_map(|&t| [slope(t), cubic(t), slope(t)]).collect();
            let cubics = Track::new(times.clone(), values, Interpolation::CubicSpline).unwrap();
            let steps = Track::new(times.clone(), times.clone(), Interpolation::Step).unwrap();
            let (first, last) = (times[0], lines.length());
            let time = first + (last - first) * share;
            prop_assert!((lines.at(time) - line(time)).abs() < 1e-9);
            prop_assert!((cubics.at(time) - cubic(time)).abs() < 1e-9 * (1.0 + cubic(time).abs() + 1e3));
            prop_assert!(steps.at(time) <= time + EARLY && times.contains(&steps.at(time)));
            for outside in [first - 1.0, f64::NEG_INFINITY] {
                prop_assert_eq!(lines.at(outside), line(first));
            }
            prop_assert_eq!(cubics.at(f64::INFINITY), cubic(last));
            prop_assert!(lines.at(f64::NAN).is_finite());
        }

        /// Whatever rounding and rounds of a loop make of the time of a frame.
        #[test]
        fn each_frame_has_its_own_step(frame in 0u32..=48, round in 0u32..100, fps in prop::sample::select(vec![12.0f32, 24.0, 25.0, 30.0, 60.0])) {
            let time_of = |frame: u32| f64::from(frame as f32 / fps);
            let times: Vec<f64> = (0..=48).map(time_of).collect();
            let steps = Track::new(times.clone(), times.clone(), Interpolation::Step).unwrap();
            let length = steps.length();
            let time = time_of(frame + 48 * round) - f64::from(round) * length;
            prop_assert_eq!(steps.at(time), times[frame as usize]);
        }

        #[test]
        fn turns_go_evenly_along_the_great_circle(axis in prop::array::uniform3(-1.0f64..1.0), angle in 0.0f64..3.0, share in 0.0f64..1.0) {
            let axis = DVec3::from(axis).normalize_or(DVec3::Y);
            let [from, to] = [0.3, 0.3 + angle].map(|angle| DQuat::from_axis_angle(axis, angle));
            let expected = DQuat::from_axis_angle(axis, 0.3 + angle * share);
            for to in [to, -to] {
                let track = Track::new(vec![0.0, 2.0], vec![from, to], Interpolation::Linear).unwrap();
                prop_assert!(track.at(2.0 * share).dot(expected).abs() > 1.0 - 1e-12);
            }
        }
    }
}
