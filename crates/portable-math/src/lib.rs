//! Sine, cosine, a hash and sRGB's light with the same bits on every machine: what pictures and motion are made of uses these, and no
//! function of the platform, whose last bits differ.
//!
//! ```
//! use portable_math::{hash, sin_cos_degrees};
//!
//! assert_eq!(sin_cos_degrees(90.0), (1.0, 0.0));
//! // Numbers that look random hang on names and numbers, never on a place in a list.
//! let seed = hash(7 ^ hash(3));
//! assert_eq!(seed, hash(7 ^ hash(3)));
//! ```
//!
//! What shaders need too is WGSL, in `shaders/prelude.wgsl`: its `hash` is the same as this one, and its `sin_pi` the sine of
//! effects.

mod angle;
mod color;
mod hash;

pub use angle::{sin_cos_degrees, sin_cos_degrees_f32};
pub use color::linear_from_srgb;
pub use hash::hash;
