//! Where a head, or a body, is.

use glam::{DQuat, DVec3};

/// A rigid motion from style space to the world: where a head is.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Pose {
    /// A unit quaternion.
    pub rotation: DQuat,
    /// In m.
    pub translation: DVec3,
}

impl Pose {
    /// Style space is the world.
    pub const IDENTITY: Self = Self {
        rotation: DQuat::IDENTITY,
        translation: DVec3::ZERO,
    };

    pub(crate) fn to_world(self, at: DVec3) -> DVec3 {
        self.rotation * at + self.translation
    }

    pub(crate) fn to_local(self, at: DVec3) -> DVec3 {
        self.rotation.conjugate() * (at - self.translation)
    }

    pub(crate) fn is_finite(&self) -> bool {
        self.rotation.is_finite() && self.translation.is_finite()
    }

    /// Whether it is finite, and its rotation of unit length.
    pub(crate) fn is_rigid(&self) -> bool {
        let off = self.rotation.length_squared() - 1.0;
        off.abs() <= 1e-3 && self.translation.is_finite()
    }
}
