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
pub const fn vec2([x, y]: [f32; 2]) -> Vec2<f32> {
    Vec2 { x, y }
}

/// A vector of three.
#[must_use]
#[inline]
pub const fn vec3([x, y, z]: [f32; 3]) -> Vec3<f32> {
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

/// WGSL's `f32()`, `u32()`, `i32()` and the like, compiled into their callers, which the runtime's aren't.
macro_rules! cast_traits {
    ($($trait:ident $method:ident: $cast:literal),*) => {$(
        #[doc = concat!("As the runtime's `", $cast, "`.")]
        pub trait $trait {
            /// Of the same shape.
            type Numbers;
            #[doc = concat!("As the runtime's `", $cast, "`.")]
            #[must_use]
            fn $method(self) -> Self::Numbers;
        }
    )*};
}

cast_traits!(
    AsFloat as_f32: "cast_elem_as_f32",
    AsUnsigned as_u32: "cast_elem_as_u32",
    AsSigned as_i32: "cast_elem_as_i32"
);

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

macro_rules! casts {
    ($($trait:ident $method:ident $to:ident: $($number:ident),*;)*) => {$($(
        impl $trait for Scalar<$number> {
            type Numbers = Scalar<$to>;
            #[inline]
            fn $method(self) -> Scalar<$to> {
                Scalar(self.0 as $to)
            }
        }
        casts!($trait $method $to $number Vec2 x y);
        casts!($trait $method $to $number Vec3 x y z);
        casts!($trait $method $to $number Vec4 x y z w);
    )*)*};
    ($trait:ident $method:ident $to:ident $number:ident $vector:ident $($component:ident)*) => {
        impl $trait for $vector<$number> {
            type Numbers = $vector<$to>;
            #[inline]
            fn $method(self) -> $vector<$to> {
                $vector { $($component: self.$component as $to),* }
            }
        }
    };
}

casts! {
    AsFloat as_f32 f32: u32, i32, f32;
    AsUnsigned as_u32 u32: u32, i32, f32, bool;
    AsSigned as_i32 i32: u32, i32, f32, bool;
}

macro_rules! bools_as_float {
    ($($vector:ident),*) => {$(
        impl AsFloat for $vector<bool> {
            type Numbers = $vector<f32>;
            #[inline]
            fn as_f32(self) -> $vector<f32> {
                self.cast_elem_as_f32()
            }
        }
    )*};
}

bools_as_float!(Scalar, Vec2, Vec3, Vec4);
