//! A file's axes, unit and place, and what is known of them.

use glam::Vec3;
use serde::{Deserialize, Serialize};

/// Which of a file's axes points up. The systems are right-handed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Axes {
    /// Y up, the character faces +Z: ours, glTF's, Maya's.
    Y,
    /// Z up, the character faces -Y: Blender's.
    Z,
}

impl Axes {
    /// A vector of these axes in ours.
    #[must_use]
    pub fn to_y_up(self, v: Vec3) -> Vec3 {
        match self {
            Self::Y => v,
            Self::Z => Vec3::new(v.x, v.z, -v.y),
        }
    }

    /// The likelier axes: `likes_y` is above 0 for Y up, below for Z up.
    pub(super) fn liked(likes_y: f64) -> Self {
        if likes_y < 0.0 { Self::Z } else { Self::Y }
    }

    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Y => "Y up",
            Self::Z => "Z up",
        }
    }
}

/// What the caller knows; the rest is guessed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Given {
    /// The axis that points up.
    pub up: Option<Axes>,
    /// Metres a unit, above 0.
    pub scale: Option<f32>,
    /// Added to the positions once they are Y up and metres. Zero leaves hair where it is, also where
    /// that is not on the head.
    pub offset: Option<Vec3>,
}

/// From a file's coordinates to ours: turn, scale, move.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Orientation {
    /// The file's axis that points up.
    pub up: Axes,
    /// Metres a unit.
    pub scale: f32,
    /// In metres, Y up.
    pub offset: Vec3,
}

impl Orientation {
    /// Of what lies as ours does.
    pub const OURS: Self = Self {
        up: Axes::Y,
        scale: 1.0,
        offset: Vec3::ZERO,
    };

    /// A position of the file in metres, Y up.
    #[must_use]
    pub fn apply(&self, position: Vec3) -> Vec3 {
        self.up.to_y_up(position) * self.scale + self.offset
    }
}
