//! Strands of hair and their motion. This crate never sees pixels.
//!
//! Space is right-handed, Y up, metres; the character faces +Z. Time is in seconds.

mod collision;
mod forces;
mod lanes;
mod math;
mod motion;
mod params;
mod rest;
mod solver;
mod strands;

pub use collision::{Collider, GridError, Shape, SignedDistance};
pub use forces::{mutual::Mutual, wind::Wind};
pub use motion::{Motion, MotionError};
pub use params::{GRAVITY, Material, Natural, Params, Profile};
pub use solver::{DynamicsError, Fault, Pose, Reason, Roots, Scene, Solver, State, Stats};
pub use strands::{StrandError, Strands};
