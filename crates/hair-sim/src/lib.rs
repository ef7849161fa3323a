//! Strands of hair and their motion. This crate never sees pixels.
//!
//! Space is right-handed, Y up, metres; the character faces +Z. Time is in seconds.

mod motion;
mod strands;

pub use motion::{Motion, MotionError};
pub use strands::{StrandError, Strands};
