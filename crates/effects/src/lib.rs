//! The boundary for stroke effects: what an effect is, the registry of effects, and presets.
//!
//! An effect is a WGSL function of one stroke joint, translated to Rust at build time by
//! `effects-build`, so that the same text runs on both backends. See [`StrokeEffect`] for how one is
//! written, and [`Joints`] for what a joint offers; `docs/an-effect-in-30-lines.md` makes one from an
//! empty crate to a picture. `effects-testkit` tells whether it is a good one.

// The translated WGSL names this crate by its name, here as everywhere.
extern crate self as effects;

pub mod clump;
mod color;
mod effect;
mod joints;
mod layer;
mod param;
mod paths;
pub mod preset;
mod registry;
pub mod section;
pub mod smooth;
mod source;
mod varied;
pub mod wgsl;

pub use color::{linear_from_srgb, parse_hex};
pub use effect::{AnyEffect, CLUMP_DISCS, LayerProgram, Parameters, Program, StrokeEffect};
pub use joints::{InputSet, Joints, strand_seed};
pub use layer::{Layer, Units, layer_seed};
pub use param::{Param, ParamKind, Value, Values};
pub use paths::{Hair, HairStrand, MOST_PATHS, MadePaths};
pub use registry::{Registry, RegistryError};
pub use section::Section;
pub use source::ProgramSource;
pub use varied::{Variation, Varied};

/// The runtime of the translated WGSL.
pub use naga_rust_rt as rt;

/// Includes the effect that `effects_build::effect("src/NAME.wgsl")` translated: `Params`, `Inputs`
/// and `Program`.
#[macro_export]
macro_rules! effect {
    ($name:literal) => {
        include!(concat!(env!("OUT_DIR"), "/", $name, ".rs"));
    };
}
