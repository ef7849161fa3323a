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
            time.rem_euclid(length)
        } else {
            time
        };
        let (rotation, moved) = self.motion.at(time);
        (rotation, moved / self.head_height_m)
    }
}
