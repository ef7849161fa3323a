//! Frames of strokes to pictures. This crate never sees files, presets or simulation.

mod check;
pub mod cpu;
mod drawing;
mod frame;
pub mod gpu;
mod picture;
mod samples;

pub use check::{DrawError, MAX_COORDINATE, MAX_SIZE};
pub use drawing::{
    Brush, Disc, Drawing, LayerStrokes, Order, Run, Surface, SurfaceVertex, scatter,
};
pub use frame::{Frame, Head, Light, StrandInfo};
pub use picture::Picture;
pub use samples::{MAX_SAMPLES, SampleCountError, sample_positions};
