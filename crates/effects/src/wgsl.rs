//! The prelude of `shaders/prelude.wgsl` in Rust, with the vector types of the translated WGSL.

#![allow(
    missing_docs,
    unused,
    unused_qualifications,
    clippy::all,
    reason = "translated from WGSL"
)]

pub use naga_rust_rt::{Scalar, Vec2, Vec3};

include!(concat!(env!("OUT_DIR"), "/prelude.rs"));

/// A vector of two.
#[must_use]
pub fn vec2([x, y]: [f32; 2]) -> Vec2<f32> {
    Vec2 { x, y }
}

/// A vector of three.
#[must_use]
pub fn vec3([x, y, z]: [f32; 3]) -> Vec3<f32> {
    Vec3 { x, y, z }
}

/// Builtins that the runtime lacks. Translated code calls them as methods.
pub trait ScalarBuiltins {
    /// WGSL's `sqrt`.
    #[must_use]
    fn sqrt(self) -> Self;
}

impl ScalarBuiltins for Scalar<f32> {
    fn sqrt(self) -> Self {
        Self(self.0.sqrt())
    }
}
