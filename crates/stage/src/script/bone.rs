//! The head's bone of a skeleton's animation.

use crate::hair::HairModel;
use crate::skeleton::Skeleton;
use glam::{DQuat, DVec3};
use hair_io::BoneMotion;
use render::Head;
use std::sync::Arc;

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
