//! Cameras, stroke paths and the exact geometry of swept strokes.
//!
//! A [`Camera`] projects the particles of strands to [`Paths`]: joints with what stroke effects need
//! to know of them (thesis 4.2, 5.1 and 5.3). [`sweep`] is the geometry of the strokes that brushes
//! leave along them.
//!
//! This crate takes slices of points and knows no simulation. Its results have the same bits for any
//! number of threads, any order of strands and any instruction set.
//!
//! ```
//! use glam::{Vec2, Vec3};
//! use stroke_path::{Camera, OrbitView, PathKind, Paths};
//!
//! // 2 m in front of the origin, for a picture of 400 x 300 pixels.
//! let view = OrbitView {
//!     target: Vec3::ZERO,
//!     yaw_degrees: 0.0,
//!     pitch_degrees: 0.0,
//!     distance_m: 2.0,
//!     vertical_fov_degrees: 30.0,
//! };
//! let camera = Camera::orbit(view, [400, 300], 0.01)?;
//!
//! let mut paths = Paths::new();
//! let strand = [Vec3::ZERO, Vec3::new(0.0, -0.1, 0.0), Vec3::new(0.0, -0.2, 0.05)];
//! paths.push_strand(0, &strand, PathKind::Linear { subdivision: 1 }, &camera)?;
//! assert_eq!(paths.runs[0].joints, 0..3);
//! assert_eq!(paths.center[0], Vec2::new(200.0, 150.0)); // the middle of the picture
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod camera;
mod cuts;
mod detail;
mod path;
mod resample;
pub mod sweep;

pub use camera::{Camera, CameraError, OrbitView, direction_from_angles};
pub use cuts::{Cut, cuts};
pub use detail::{Coarseness, Detail};
pub use path::{PathRun, Paths};
pub use portable_math::sin_cos_degrees;
pub use resample::{MAX_SUBDIVISION, PathError, PathKind};
pub use sweep::Brush;
