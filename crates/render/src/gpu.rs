//! The GPU backend, on wgpu: strokes are made on the graphics card from the joints of a frame, by the same WGSL that
//! the CPU runs as Rust, sorted into tiles and drawn there, all in compute shaders. No stroke and no disc goes through
//! the CPU.
//!
//! A [`Renderer`] works on a device that belongs to somebody else, in command encoders and passes that they own:
//! [`Renderer::prepare`] draws the hair into its own memory, [`Renderer::render`] puts it into a render pass, over what
//! that pass has drawn and behind what is nearer there. An [`Offscreen`] owns a device ([`Gpu`]) and gives
//! [`Picture`](crate::Picture)s.
//!
//! The passes, whose WGSL is in `shaders/gpu`, and what each reads and writes:
//!
//! 1. `clump_main`: joints to clumps; `stroke_main`, once a layer, with the effect's own text: joints and clumps to
//!    discs; `smooth`, where a layer has a shortest stroke.
//! 2. `bins`: pieces of strands (chunks), and triangles, to the lists of the tiles that they may reach.
//! 3. `tiles`: a workgroup a tile: what of its list reaches the tile, then each pixel's samples by
//!    [`Order`](crate::Order), with the formulae of `stroke_path::sweep`.
//!
//! 4. Where a layer paints or a frame has passes, `tiles` keeps what each sample shows (`told`), and after it come `paint_main`, once for
//!    such a layer, with the effect's own text; for each pass and sample `tell`, which fills planes of features, and `edges`, which draws
//!    lines by them; and `mean`.
//!
//! Whatever the samples, the order or the surfaces, the rules are those of the CPU's rasteriser, and so is the
//! picture but for rounding. Pipelines and buffers exist for the layers that are on, and stay from frame to
//! frame; buffers only ever grow.

mod adapter;
mod atlas;
mod buffer;
mod compose;
mod edges;
mod error;
mod images;
mod inputs;
mod layout;
mod offscreen;
mod pipelines;
mod program;
mod programs;
mod renderer;
mod report;
mod samples;
mod scene;

pub use adapter::{AdapterKind, Gpu};
pub use compose::{PassDepth, PassFormat};
pub use error::GpuError;
pub use offscreen::Offscreen;
pub use renderer::{GpuStats, Renderer};
