//! Strands of hair and their motion. This crate never sees pixels.
//!
//! Space is right-handed, Y up, metres; the character faces +Z. Time is in seconds.
//!
//! # Dynamics
//!
//! [`Solver::new`] takes strands at rest and what they are made of ([`Params`]); [`Solver::step`] advances their
//! [`State`] by the frame's own time, with what acts on them in a [`Scene`]: roots, gravity, wind, bodies, goals. Strands act on
//! each other after [`Solver::interact`]. The state is the caller's and decides all that follows, to the bit; the
//! solver holds constants and room to work in.
//!
//! A strand is a chain of rigid links with springs against bending and twisting (a discrete Cosserat rod), stepped by
//! TR-BDF2 with one sweep from tip to root and back for every Newton step; the safe integrator behind it is
//! backward Euler as an energy that only goes down. Links never stretch. Strands that are straight by nature solve no twist.
//!
//! All is in double precision: it is what a rest that does not drift and a first acceleration of nothing need (in single
//! precision a position of 0.3 m is known to 3e-8 m, which at a step of 1/24 s is already 2e-5 of gravity).

mod collision;
pub mod compare;
mod forces;
mod lanes;
mod math;
mod motion;
mod params;
mod rest;
mod solver;
mod strand_solver;
mod strands;

pub use collision::{Collider, GridError, Shape, SignedDistance};
pub use forces::{mutual::Mutual, wind::Wind};
pub use motion::{Motion, MotionError, key_weights};
pub use params::{GRAVITY, Material, Natural, Params, Profile};
pub use solver::{
    Acceleration, DynamicsError, Fault, Pose, Reason, Roots, Scene, Solver, State, Stats,
};
pub use strand_solver::StrandSolver;
pub use strands::{StrandError, Strands};
