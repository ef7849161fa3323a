//! A hand that moves head and wind beside the script: what a live program adds while it is watched.

use crate::script::{HeadPose, MotionScript};
use glam::{DVec3, Vec3};
use std::collections::VecDeque;

/// So many moments are kept: steps look back one or two, and an hour of play takes no more memory than a minute.
const KEPT: usize = 256;

/// Where a hand has held the head, and from where it has blown, at the times it said so.
///
/// ```
/// use glam::Vec3;
/// let mut hand = stage::Hand::new();
/// assert!(hand.is_idle());
/// // Turned to its left within a quarter of a second, in a breeze from the character's left.
/// for step in 0..=6 {
///     let turn = Vec3::new(10.0 * step as f32, 0.0, 0.0);
///     hand.hold(step as f32 / 24.0, turn, Vec3::ZERO, Vec3::new(-5.0, 0.0, 0.0));
/// }
/// assert!(!hand.is_idle());
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Hand {
    /// Times ascending.
    track: VecDeque<Moment>,
}

#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Moment {
    time: f64,
    turn: DVec3,
    shift: DVec3,
    wind: DVec3,
}

impl Hand {
    /// One that has not moved anything.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            track: VecDeque::new(),
        }
    }

    /// Whether it has never held anything: then a scene moves as without it.
    #[must_use]
    pub fn is_idle(&self) -> bool {
        self.track.is_empty()
    }

    /// From `time` (seconds) on the head is turned by `turn` (degrees: towards the character's left, up, towards the left shoulder) and
    /// moved by `shift` (head heights) on top of the script, and `wind` (m/s, where it blows to) blows on top of its winds. What it said
    /// of that time and later before is forgotten. Numbers that are not finite are taken for none.
    pub fn hold(&mut self, time: f32, turn: Vec3, shift: Vec3, wind: Vec3) {
        let finite = |vector: Vec3| {
            if vector.is_finite() {
                vector.as_dvec3()
            } else {
                DVec3::ZERO
            }
        };
        if !time.is_finite() {
            return;
        }
        let time = f64::from(time);
        while self.track.back().is_some_and(|last| last.time >= time) {
            self.track.pop_back();
        }
        if self.track.len() == KEPT {
            self.track.pop_front();
        }
        self.track.push_back(Moment {
            time,
            turn: finite(turn),
            shift: finite(shift),
            wind: finite(wind),
        });
    }

    /// What it does at `time`. Before its first moment it holds still as there, without wind; after its last it goes on as it moved for as long as it has moved
    /// so, and then holds still: a step that looks ahead would take a sudden stop for a blow.
    fn at(&self, time: f64) -> Moment {
        let after = self.track.partition_point(|moment| moment.time <= time);
        let Some(before) = after.checked_sub(1) else {
            let first = self.track.front().copied().unwrap_or_default();
            return Moment {
                wind: DVec3::ZERO,
                ..first
            };
        };
        let now = self.track[before];
        let Some(next) = self.track.get(after) else {
            let Some(earlier) = before.checked_sub(1).map(|index| self.track[index]) else {
                return now;
            };
            let on = ((time - now.time) / (now.time - earlier.time)).min(1.0);
            return Moment {
                wind: now.wind,
                ..earlier.towards(now, 1.0 + on)
            };
        };
        now.towards(*next, (time - now.time) / (next.time - now.time))
    }
}

impl Moment {
    fn towards(self, other: Self, share: f64) -> Self {
        Self {
            time: self.time,
            turn: self.turn.lerp(other.turn, share),
            shift: self.shift.lerp(other.shift, share),
            wind: self.wind.lerp(other.wind, share),
        }
    }
}

/// All that moves an object's head and the wind about it: its script, and a hand where there is one.
#[derive(Clone, Copy)]
pub(crate) struct Driver<'a> {
    pub script: &'a MotionScript,
    pub hand: Option<&'a Hand>,
}

impl Driver<'_> {
    /// Whether nothing moves.
    pub fn is_still(&self) -> bool {
        self.script.is_still() && self.hand.is_none_or(Hand::is_idle)
    }

    /// The head's pose at `time` (seconds).
    pub fn head_at(&self, time: f64) -> HeadPose {
        let mut pose = self.script.head_at(time);
        if let Some(hand) = self.hand {
            let held = hand.at(time);
            pose.turn += held.turn;
            pose.shift += held.shift;
        }
        pose
    }

    /// The steady wind and the speed of gusts at `time`: m/s.
    pub fn wind_at(&self, time: f64) -> (DVec3, f64) {
        let (steady, gusts) = self.script.wind_at(time);
        let blown = self.hand.map_or(DVec3::ZERO, |hand| hand.at(time).wind);
        (steady + blown, gusts)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn turned(moments: &[(f32, f32)]) -> Hand {
        let mut hand = Hand::new();
        for &(time, turn) in moments {
            hand.hold(time, Vec3::X * turn, Vec3::ZERO, Vec3::ZERO);
        }
        hand
    }

    #[test]
    fn it_moves_evenly_between_moments_and_goes_on_for_one() {
        let hand = turned(&[(1.0, 3.0), (2.0, 10.0), (2.5, 15.0)]);
        let at = |time| hand.at(time).turn.x;
        assert_eq!([at(0.0), at(1.0), at(1.5), at(2.0)], [3.0, 3.0, 6.5, 10.0]);
        assert_eq!(
            [at(2.5), at(2.75), at(3.0), at(9.0)],
            [15.0, 17.5, 20.0, 20.0]
        );
    }

    #[test]
    fn what_is_said_again_takes_the_place_of_what_was() {
        let mut hand = turned(&[(1.0, 1.0), (2.0, 2.0), (3.0, 3.0)]);
        hand.hold(2.0, Vec3::X * 7.0, Vec3::ZERO, Vec3::ZERO);
        assert_eq!(hand, turned(&[(1.0, 1.0), (2.0, 7.0)]));
        hand.hold(f32::NAN, Vec3::X, Vec3::ZERO, Vec3::ZERO);
        hand.hold(4.0, Vec3::NAN, Vec3::ZERO, Vec3::ZERO);
        assert_eq!(hand, turned(&[(1.0, 1.0), (2.0, 7.0), (4.0, 0.0)]));
    }

    #[test]
    fn an_hour_takes_no_more_memory_than_a_minute() {
        let mut hand = Hand::new();
        for step in 0..60 * 60 * 24 {
            hand.hold(step as f32 / 24.0, Vec3::ZERO, Vec3::ZERO, Vec3::ONE);
        }
        assert_eq!(hand.track.len(), KEPT);
        assert_eq!(hand.at(3599.0).wind, DVec3::ONE);
    }
}
