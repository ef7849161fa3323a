//! The head's bone of a skeleton's animation.

use crate::hair::HairModel;
use crate::skeleton::Skeleton;
use glam::{DQuat, DVec3};
use hair_io::BoneMotion;
use render::Head;
use std::sync::Arc;

/// From this way on, in head heights, or this turn, a head that is elsewhere at once is told of.
const JUMP_HEADS: f64 = 0.25;
const JUMP_DEGREES: f64 = 15.0;
/// The end of an animation that repeats is so much before its start comes again, as a share of its length.
const BEFORE_END: f64 = 1e-6;

/// What moves the head below its script.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Below {
    /// A bone of any character.
    Bone(Bone),
    /// The skeleton of the character that it is.
    Skeleton {
        /// With its bodies.
        skeleton: Arc<Skeleton>,
        /// At rest.
        head: Head,
    },
}

/// How the head jumps where an animation starts again.
pub(crate) struct Jump {
    /// The length of the animation, seconds.
    pub length_s: f64,
    /// How far, in head heights.
    way_heads: f64,
    turn_degrees: f64,
}

impl Below {
    /// A character's skeleton under its hair: which of its bodies count hangs on where that is.
    pub fn skeleton(skeleton: &Skeleton, hair: &HairModel) -> Self {
        let points = hair.file.strands.points();
        Self::Skeleton {
            skeleton: Arc::new(skeleton.clone().with_bodies(points)),
            head: hair.head,
        }
    }

    /// How far it has turned from its rest, moved in head heights, and the time that a skeleton is at, at `time` (seconds).
    pub fn at(&self, time: f64) -> (DQuat, DVec3, Option<f64>) {
        match self {
            Self::Bone(bone) => {
                let (rotation, moved) = bone.at(time);
                (rotation, moved, None)
            }
            Self::Skeleton { skeleton, head } => {
                let (rotation, moved_m) = skeleton.head_at(time, *head);
                let time = skeleton.within(time);
                (rotation, moved_m / f64::from(head.height_m), Some(time))
            }
        }
    }

    /// The length of its animation, seconds.
    pub fn length_s(&self) -> f64 {
        match self {
            Self::Bone(bone) => bone.motion.length(),
            Self::Skeleton { skeleton, .. } => skeleton.length(),
        }
    }

    /// How the head jumps where it starts again; None where it doesn't repeat, or comes back to its start.
    pub fn jump(&self) -> Option<Jump> {
        let repeats = match self {
            Self::Bone(bone) => bone.repeats,
            Self::Skeleton { skeleton, .. } => skeleton.repeats(),
        };
        if !repeats {
            return None;
        }
        let length_s = self.length_s();
        let [(turn, moved, _), (last_turn, last_moved, _)] =
            [0.0, length_s * (1.0 - BEFORE_END)].map(|time| self.at(time));
        let jump = Jump {
            length_s,
            way_heads: moved.distance(last_moved),
            turn_degrees: turn.angle_between(last_turn).to_degrees(),
        };
        (jump.turn_degrees > JUMP_DEGREES || jump.way_heads > JUMP_HEADS).then_some(jump)
    }

    /// What is to be told of that jump.
    pub fn jump_note(&self) -> Option<String> {
        let Jump {
            way_heads,
            turn_degrees,
            ..
        } = self.jump()?;
        Some(format!(
            "motion: where the animation starts again (`repeat`) the head jumps by {way_heads:.2} head heights and {turn_degrees:.0} degrees; hair goes along as if the head went on. One that is to repeat without a jump comes back to its start"
        ))
    }

    /// Whether all that it moves is, at one time (seconds), where it is at another.
    pub fn is_alike(&self, one: f64, other: f64) -> bool {
        match self {
            Self::Bone(bone) => {
                let [(turn, moved), (other_turn, other_moved)] =
                    [one, other].map(|time| bone.at(time));
                turn.angle_between(other_turn) < 2e-4 && moved.abs_diff_eq(other_moved, 1e-4)
            }
            Self::Skeleton { skeleton, .. } => skeleton.at(one).is_alike(&skeleton.at(other)),
        }
    }
}

/// The time (seconds) within an animation of this length that starts again at its end. What single precision can't tell from its end is its start.
pub(crate) fn come_round(time: f64, length: f64) -> f64 {
    let slack = time.abs() * f64::from(f32::EPSILON);
    let within = time.rem_euclid(length);
    if length - within <= slack {
        0.0
    } else {
        within
    }
}

/// A bone as it moves the head.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Bone {
    pub motion: BoneMotion,
    /// Whether it starts again at its end.
    pub repeats: bool,
    /// In m.
    pub head_height_m: f64,
}

impl Bone {
    /// How far it has turned from its rest, and moved in head heights, at `time` (seconds).
    pub fn at(&self, time: f64) -> (DQuat, DVec3) {
        let length = self.motion.length();
        let time = if self.repeats && length > 0.0 {
            come_round(time, length)
        } else {
            time
        };
        let (rotation, moved) = self.motion.at(time);
        (rotation, moved / self.head_height_m)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_round_of_an_animation_begins_at_its_start() {
        for fps in [12.0f32, 24.0, 30.0, 60.0] {
            for frames in 1..80u32 {
                let length = f64::from(frames as f32 / fps);
                for round in 0..40 {
                    let time = f64::from((round * frames) as f32 / fps);
                    let within = come_round(time, length);
                    assert!(within < 1e-4, "{fps} {frames} {round}: {within}");
                }
            }
        }
        assert_eq!(come_round(-0.25, 1.0), 0.75);
        assert_eq!(come_round(1.5, 1.0), 0.5);
    }
}
