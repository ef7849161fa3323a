//! The bust: a stylised head with neck and shoulders, made by code, with a drawn face.
//!
//! Metres, Y up, the face towards +Z: the head is 0.24 m high, from the chin at 1.38 m to the top at
//! 1.62 m, a person's 1.62 m above the ground.

mod bust;
mod face;
mod ribbon;
mod solid;
mod surface_nets;

pub use bust::{Bust, bust};
pub use face::{Ink, Patch};
