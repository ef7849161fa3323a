//! Cameras, stroke paths and the exact geometry of swept strokes.
//!
//! A [`Camera`] projects the particles of strands to [`Paths`]: joints with what stroke effects need
//! to know of them (thesis 4.2, 5.1 and 5.3). [`sweep`] is the geometry of the strokes that brushes
//! leave along them.
//!
//! This crate takes slices of points and knows no simulation. Its results have the same bits for any
//! number of threads, any order of strands and any instruction set.

mod camera;
mod cuts;
mod path;
mod resample;
pub mod sweep;

pub use camera::{Camera, CameraError, OrbitView, direction_from_angles};
pub use cuts::{Cut, cuts};
pub use path::{PathRun, Paths};
pub use portable_math::sin_cos_degrees;
pub use resample::{MAX_SUBDIVISION, PathError, PathKind};
pub use sweep::Brush;
