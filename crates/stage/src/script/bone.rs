//! The head's bone of a skeleton's animation.

use glam::{DQuat, DVec3};
use hair_io::BoneMotion;

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
