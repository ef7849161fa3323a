//! Lines of triangle meshes, as an artist would draw them: where a surface turns away from the eye (*contours*), where it has an edge (*creases*) and where it ends
//! (*borders*); what of them the eye sees; and what they are called from frame to frame.
//!
//! Triangles and positions come in as slices, lines come out as polylines whose every joint knows on which triangle it lies. Nothing here reads files or draws pictures.
//!
//! ```
//! use glam::Vec3;
//! use mesh_lines::{
//!     Bvh, CREASE_COSINE, Frame, Kind, Surface, TURN_COSINE, Topology, Tracker, View, borders, contours, creases, facing, visible,
//! };
//!
//! // A roof without a house: two squares that meet at a ridge.
//! let positions = [
//!     Vec3::new(0.0, 1.0, -1.0), Vec3::new(0.0, 1.0, 1.0), // the ridge
//!     Vec3::new(-1.0, 0.0, -1.0), Vec3::new(-1.0, 0.0, 1.0), // the eaves
//!     Vec3::new(1.0, 0.0, -1.0), Vec3::new(1.0, 0.0, 1.0),
//! ];
//! let triangles = [[0, 2, 1], [1, 2, 3], [0, 1, 4], [1, 5, 4]];
//!
//! // Once for all frames of a mesh.
//! let topology = Topology::new(&positions, &triangles)?.with_creases(&positions, CREASE_COSINE)?;
//! let mut bvh = Bvh::new(&Surface::new(&topology, &positions)?);
//! let mut tracker = Tracker::default();
//!
//! // In each frame.
//! let surface = Surface::new(&topology, &positions)?;
//! bvh.refit(&surface);
//! let view = View::perspective(Vec3::new(5.0, 0.5, 0.5))?;
//! let facing = facing(&surface, &view);
//! let mut lines = contours(&surface, &view, &facing)?;
//! lines.extend(creases(&surface, TURN_COSINE));
//! lines.extend(borders(&surface, TURN_COSINE));
//! let pixel = 1.0 / 1344.0; // of 720 lines and a field of view of 30 degrees
//! let spans = visible(&surface, &bvh, &view, &lines, pixel)?;
//!
//! // The ridge, and the right half's other three edges; the left half is behind them.
//! let seen = |kind| spans.iter().filter(|span| lines[span.line].kind == kind).count();
//! assert_eq!([seen(Kind::Contour), seen(Kind::Crease), seen(Kind::Border)], [0, 1, 3]);
//!
//! // Of contours: names, and a coordinate for patterns.
//! let paths = tracker.step(&Frame {
//!     surface: &surface, view: &view, facing: &facing, lines: &lines, spans: &spans, pixel, period_px: 100.0,
//! })?;
//! assert!(paths.is_empty());
//! # Ok::<(), mesh_lines::MeshError>(())
//! ```
//!
//! # Which lines
//!
//! Contours are the zero set of n . (eye - p) with smooth normals, not edges of triangles between a front and a back one: they don't zigzag. They lie as far off
//! the triangles' own horizon as the smooth surface does, and [`visible`] knows that. Across sharp edges ([`Topology::with_creases`]) normals aren't smooth: contours end there, and the edge itself,
//! a crease, is the outline. What isn't a clean surface is read by the rules at [`Topology`]: nothing is refused but wrong indices and numbers that aren't finite.
//!
//! # Exactness and cost
//!
//! Positions and normals are f32, all that is worked out is f64. Results hang on nothing but the input: no random numbers, the same bits with any number of threads, and no functions but roots. Of a
//! frame all but the sign of f at each vertex, which is one pass over them, is near to linear in the lines' lengths; `cargo run --release -p mesh-lines --example throughput` says how long
//! each part takes, and `--example drawing` draws.
//!
//! # Features
//!
//! - `threads`, not on by default: what is seen of lines is found line by line in the threads of the rayon pool that it is asked for in. Without it, in the caller's thread.

mod bvh;
mod contour;
mod crossings;
mod curvature;
mod edges;
mod error;
mod fit;
mod junctions;
mod line;
mod ruler;
mod surface;
mod threads;
mod topology;
mod track;
mod tree;
mod view;
mod visibility;
mod walk;

pub use bvh::{Bvh, Hit, Ray};
pub use contour::{contours, facing, zero_set};
pub use curvature::{Curvature, curvatures};
pub use edges::{CREASE_COSINE, TURN_COSINE, borders, creases};
pub use error::MeshError;
pub use line::{Kind, Line, LinePoint, Segment};
pub use surface::{Place, Surface};
pub use topology::{Beside, Topology};
pub use track::{Frame, Path, PathJoint, REACH_PX, Tracker};
pub use view::View;
pub use visibility::{Cut, Span, is_seen, visible, visible_of};
pub use walk::walk_to_zero;
