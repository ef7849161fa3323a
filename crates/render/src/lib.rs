//! Frames of strokes to pictures. This crate never sees files, presets or simulation.
//!
//! A [`Frame`] is hair as the camera sees it, with the effects that make strokes of it; a [`Drawing`] is those strokes
//! as discs in pixels. [`cpu`] makes the one from the other and draws it without a driver, `gpu` does both on a graphics
//! card. Whoever has strokes of his own needs a [`Drawing`] alone:
//!
//! ```
//! use glam::Vec2;
//! use render::cpu::Rasterizer;
//! use render::{Disc, Drawing, LayerStrokes, Run, Stretches};
//!
//! // One strand of two joints, 2 m away, in red.
//! let disc = |y| Disc {
//!     center: Vec2::new(32.0, y),
//!     radius: 6.0,
//!     inv_depth: 0.5,
//!     inv_depth_biased: 0.5,
//! };
//! let drawing = Drawing {
//!     size: [64, 64],
//!     runs: vec![Run { strand: 0, joints: 0..2 }],
//!     clump: vec![disc(10.0), disc(54.0)],
//!     layers: vec![LayerStrokes {
//!         name: "hair".to_owned(),
//!         joints: 0..2,
//!         rank: 0,
//!         instances: 1,
//!         stretches: Stretches::Everywhere,
//!         discs: vec![disc(10.0), disc(54.0)],
//!         colors: vec![[1.0, 0.0, 0.0]; 2],
//!     }],
//!     ..Drawing::default()
//! };
//! let picture = Rasterizer::new(4, None)?.draw(&drawing)?;
//! assert_eq!(picture.pixels[32 * 64 + 32], [1.0, 0.0, 0.0, 1.0]);
//! assert_eq!(picture.pixels[0], [0.0; 4]); // nothing there
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Features
//!
//! - `gpu`, on by default: the module `gpu`, and wgpu for it.

mod brushwork;
mod check;
pub mod cpu;
mod drawing;
mod edges;
mod features;
mod frame;
#[cfg(feature = "gpu")]
pub mod gpu;
mod mesh_paint;
mod painting;
mod picture;
mod planes;
mod samples;

pub use brushwork::{AlongStrand, BrushedLayer, Brushwork};
pub use check::{DrawError, MAX_COORDINATE, MAX_SIZE};
pub use drawing::{
    Brush, Coverage, Decal, Disc, Drawing, LayerStrokes, Order, Run, Stretch, Stretches, Surface,
    SurfaceTexture, SurfaceVertex, scatter, shown_reach,
};
pub use edges::{EdgeChannel, Edges};
pub use features::{
    DrawnFeatures, Feature, Features, NO_ID, RunInfo, object_of_hair, object_of_mesh,
};
pub use frame::{
    Ball, CLUMP_REACH, Frame, FrameError, Head, Light, NO_COLOR, NO_TAPER, ON_SURFACES, Object,
    StrandInfo, from_ends, reach_of,
};
pub use mesh_paint::{MeshLayer, MeshPainting, PaintedMeshes, Seen, SurfacePaint};
pub use painting::{PaintedLayer, Painting};
pub use picture::Picture;
pub use planes::{Sample, SamplePlanes};
pub use samples::{MAX_SAMPLES, SampleCountError, sample_positions};
