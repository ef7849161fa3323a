//! The prelude of `shaders/prelude.wgsl` in Rust, with the vector types of the translated WGSL.

#![allow(
    missing_docs,
    unused,
    unused_qualifications,
    clippy::all,
    reason = "translated from WGSL"
)]

pub use naga_rust_rt::{Scalar, Vec2, Vec3, Vec4};

include!(concat!(env!("OUT_DIR"), "/prelude.rs"));

/// A vector of two.
#[must_use]
#[inline]
pub fn vec2([x, y]: [f32; 2]) -> Vec2<f32> {
    Vec2 { x, y }
}

/// A vector of three.
#[must_use]
#[inline]
pub fn vec3([x, y, z]: [f32; 3]) -> Vec3<f32> {
    Vec3 { x, y, z }
}

/// A colour, or none, as WGSL has it: the last component is 1 where there is one, else all are 0.
#[must_use]
#[inline]
pub fn color_or_none(color: Option<[f32; 3]>) -> Vec4<f32> {
    let ([x, y, z], w) = color.map_or(([0.0; 3], 0.0), |color| (color, 1.0));
    Vec4 { x, y, z, w }
}

/// Builtins that the runtime lacks. Translated code calls them as methods.
pub trait ScalarBuiltins {
    /// WGSL's `sqrt`.
    #[must_use]
    fn sqrt(self) -> Self;
}

impl ScalarBuiltins for Scalar<f32> {
    #[inline]
    fn sqrt(self) -> Self {
        Self(self.0.sqrt())
    }
}
