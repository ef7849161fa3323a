//! Strands of hair and their motion: takes strands at rest and what acts on them, and tells where their points are, step by step.
//! Deterministic to the bit, on any machine and for any number of threads. It never sees pixels.
//!
//! Space is right-handed, Y up, metres; the character faces +Z. Time is in seconds.
//!
//! # Example
//!
//! A head nods once, and its hair follows.
//!
//! ```
//! use glam::{DQuat, DVec3, Vec3};
//! use hair_sim::{DynamicsError, Params, Pose, Roots, Surroundings, Solver, Strands};
//!
//! // Three strands of 20 links and 20 cm, root first.
//! let mut rest = Strands::new();
//! for id in 0..3 {
//!     let root = Vec3::new(0.02 * id as f32, 1.7, 0.0);
//!     let points: Vec<Vec3> = (0..=20).map(|i| root - Vec3::Y * (0.01 * i as f32)).collect();
//!     rest.push(id, &points, None).expect("finite points");
//! }
//! let (mut solver, mut state) = Solver::new(&rest, &Params::default())?;
//! for step in 1..=24 {
//!     let time = f64::from(step) / 60.0;
//!     let nod = Pose {
//!         rotation: DQuat::from_rotation_x(0.3 * (8.0 * time).sin()),
//!         translation: DVec3::ZERO,
//!     };
//!     let surroundings = Surroundings {
//!         roots: Roots::Head(nod),
//!         ..Surroundings::default()
//!     };
//!     solver.step(&mut state, &surroundings, 1.0 / 60.0)?;
//! }
//! for strand in 0..rest.len() {
//!     let points: Vec<DVec3> = solver.points(&state, strand).collect();
//!     assert_eq!(points.len(), 21);
//!     assert!(((points[20] - points[19]).length() - 0.01).abs() < 1e-6);
//! }
//! # Ok::<(), DynamicsError>(())
//! ```
//!
//! # Dynamics
//!
//! [`Solver::new`] takes strands at rest and what they are made of ([`Params`]); [`Solver::step`] advances their
//! [`State`] by the frame's own time, with what acts on them in a [`Surroundings`]: roots, gravity, wind, bodies, goals. Strands act on
//! each other after [`Solver::interact`]. The state is the caller's and decides all that follows, to the bit; the
//! solver holds constants and scratch.
//!
//! A strand is a chain of rigid links with springs against bending and twisting (a discrete Cosserat rod), stepped by
//! TR-BDF2 with one sweep from tip to root and back for every Newton step; the safe integrator behind it is
//! backward Euler as an energy that only goes down. Links never stretch. Strands that are straight by nature solve no twist.
//!
//! All is in double precision: it is what a rest that does not drift and a first acceleration of zero need (in single
//! precision a position of 0.3 m is known to 3e-8 m, which at a step of 1/24 s is already 2e-5 of gravity).
//!
//! # Features
//!
//! Both are on by default.
//!
//! - `threads`: steps run in the threads of the rayon pool that they are called in. Without it, in the caller's thread; the bits
//!   are the same.
//! - `compare`: the module `compare`, other people's solvers to compare with.
//!
//! # Layers
//!
//! No file imports one that imports it, directly or by way of others, but for a module that declares its parts. From
//! the bottom:
//!
//! - `lanes` (arithmetic on several strands at once), `math`, `threads`, `strands`, `motion`, `stats`, `pose`
//! - `params`, `error`; `collision` (shapes of bodies), `forces` (wind, springs, other strands)
//! - `scene` (what acts in a step), `rest` (a strand at rest)
//! - `solver`, which says its own layers
//! - `strand_solver` (what every solver can do), `compare`

mod collision;
#[cfg(feature = "compare")]
pub mod compare;
mod error;
mod forces;
mod hash;
mod lanes;
mod math;
mod params;
mod point_cache;
mod pose;
mod rest;
mod solver;
mod stats;
mod strand_solver;
mod strands;
mod surroundings;
mod threads;

pub use collision::{
    grid::{GridError, SignedDistance},
    shape::{Collider, LEADS_OUT, Placed, Shape},
};
pub use error::{DynamicsError, Fault, Reason};
pub use forces::{
    mutual::Mutual,
    stream::{Flow, Stream, Turbulence},
    wind::Wind,
};
pub use params::{GRAVITY, Material, Natural, Params, Profile};
pub use point_cache::{PointCache, PointCacheError, spline::key_weights};
pub use pose::Pose;
pub use solver::{Solver, State};
pub use stats::Stats;
pub use strand_solver::StrandSolver;
pub use strands::{StrandError, Strands};
pub use surroundings::{Acceleration, Anchor, Roots, Surroundings};
