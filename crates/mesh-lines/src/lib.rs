//! Lines.
mod bvh;
mod contour;
mod crossings;
mod curvature;
mod edges;
mod error;
mod junctions;
mod line;
mod surface;
mod topology;
mod tree;
mod view;
mod visibility;

pub use bvh::{Bvh, Hit, Ray};
pub use contour::{contours, facing, zero_set};
pub use curvature::{Curvature, curvatures};
pub use edges::{CREASE_COSINE, TURN_COSINE, borders, creases};
pub use error::MeshError;
pub use line::{Kind, Line, LinePoint, Segment};
pub use surface::{Place, Surface};
pub use topology::{Beside, Topology};
pub use view::View;
pub use visibility::{Cut, Span, is_seen, visible};
