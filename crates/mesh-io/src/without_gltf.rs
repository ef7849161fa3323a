//! Stands for the module `gltf` in builds without glTF: a motion that no file can give.

use std::path::{Path, PathBuf};

use glam::{DQuat, DVec3};

use crate::file::MeshError;

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

impl BoneMotion {
    /// Refused in builds without the feature `gltf`.
    ///
    /// # Errors
    ///
    /// Always.
    pub fn read(path: &Path, _bone: &str, _animation: Option<&str>) -> Result<Self, MeshError> {
        Err(MeshError::WithoutGltf(path.into()))
    }

    /// Refused in builds without the feature `gltf`.
    ///
    /// # Errors
    ///
    /// Always.
    pub fn files(path: &Path) -> Result<Vec<PathBuf>, MeshError> {
        Err(MeshError::WithoutGltf(path.into()))
    }
}
