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

/// WGSL's `smoothstep`, compiled into its callers, which the runtime's isn't.
pub trait SmoothStep {
    /// As the runtime's `smoothstep`.
    #[must_use]
    fn smooth_step(self, low: Self, high: Self) -> Self;
}

/// WGSL's `f32()` and the like, compiled into their callers, which the runtime's aren't.
pub trait AsFloat {
    /// Of the same shape.
    type Floats;
    /// As the runtime's `cast_elem_as_f32`.
    #[must_use]
    fn as_f32(self) -> Self::Floats;
}

macro_rules! smooth_step {
    ($($vector:ident),*) => {$(
        impl SmoothStep for $vector<f32> {
            #[inline]
            fn smooth_step(self, low: Self, high: Self) -> Self {
                let t = ((self - low) / (high - low)).saturate();
                t * t * (Scalar(3.0) - Scalar(2.0) * t)
            }
        }
    )*};
}

smooth_step!(Scalar, Vec2, Vec3, Vec4);

macro_rules! as_float {
    ($($number:ty),*) => {$(
        impl AsFloat for Scalar<$number> {
            type Floats = Scalar<f32>;
            #[inline]
            fn as_f32(self) -> Scalar<f32> {
                Scalar(self.0 as f32)
            }
        }
        as_float!($number, Vec2 x y);
        as_float!($number, Vec3 x y z);
        as_float!($number, Vec4 x y z w);
    )*};
    ($number:ty, $vector:ident $($component:ident)*) => {
        impl AsFloat for $vector<$number> {
            type Floats = $vector<f32>;
            #[inline]
            fn as_f32(self) -> $vector<f32> {
                $vector { $($component: self.$component as f32),* }
            }
        }
    };
}

as_float!(u32, i32, f32);

macro_rules! bools_as_float {
    ($($vector:ident),*) => {$(
        impl AsFloat for $vector<bool> {
            type Floats = $vector<f32>;
            #[inline]
            fn as_f32(self) -> $vector<f32> {
                self.cast_elem_as_f32()
            }
        }
    )*};
}

bools_as_float!(Scalar, Vec2, Vec3, Vec4);
