//! Stands for the module `skeleton` in builds without glTF: a motion that no file can give.

use glam::{DQuat, DVec3};

/// The motion of a bone against its rest, which only builds with the feature `gltf` can read.
#[derive(Clone, Debug, PartialEq)]
pub enum BoneMotion {}

impl BoneMotion {
    /// When the last key of all that moves the bone is, in s.
    #[must_use]
    pub fn length(&self) -> f64 {
        match *self {}
    }

    /// How far the bone has turned at `time` (seconds) from its rest, and how far its place has moved (m).
    #[must_use]
    pub fn at(&self, _time: f64) -> (DQuat, DVec3) {
        match *self {}
    }
}
