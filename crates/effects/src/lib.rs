//! The boundary for stroke effects: what an effect is, the registry of effects, and presets.
//!
//! An effect is a WGSL function of one stroke joint, translated to Rust at build time by
//! `effects-build`, so that the same text runs on both backends. See [`StrokeEffect`] for how one is
//! written, and [`Input`] for what a joint offers; `docs/an-effect-in-30-lines.md` makes one from an
//! empty crate to a picture. `effects-testkit` tells whether it is a good one.
//!
//! A program has a table of its parameters, made from its WGSL; a section of a preset sets their values. That of the clump,
//! which all effects share:
//!
//! ```
//! use effects::{Input, Parameters, Section, Value, Values, Variation, Varied, clump};
//!
//! let table = clump::Program::PARAMS;
//! let index = |name| table.iter().position(|param| param.name == name).unwrap();
//! let mut values = Values::defaults(table);
//! values.set(index("normal"), Value::Choice(clump::Params::NORMAL_MATERIAL));
//! // Half of its size at the tip.
//! let shrinks = Variation { curve: vec![(0.0, 1.0), (1.0, 0.5)], vary: 0.0 };
//! values.set(index("size"), Value::Varying(shrinks));
//!
//! let clump = Varied::<clump::Program>::new(&values);
//! assert_eq!(clump.base().normal, clump::Params::NORMAL_MATERIAL);
//! // What is worked out of each joint is what the program reads.
//! assert!(clump.inputs().has(Input::MaterialNormal));
//! assert!(!clump.inputs().has(Input::ArcLength));
//! ```
//!
//! Modules, each made of those before it alone: [`wgsl`] (the prelude), `color`, [`smooth`], `light`, `paths`, `grid` (which strands are neighbours), `joints` (what a joint
//! offers), `samples` (what one that is painted offers), `lanes`, `texture`, `seed`, `variation`; `param` (tables and values),
//! [`mod@section`] (typed ones), `program` (what translated code implements), `source` (the same for a
//! graphics card), `varied` (a program with its values), [`clump`], `brush` (what tools leave of strokes); `effect`, `layer`, `registry`; [`preset`].

// The translated WGSL names this crate by its name, here as everywhere.
extern crate self as effects;

// `for_each_input!` and `for_each_sample_input!`: the tables of `crates/effects-build/src/inputs.rs`.
include!(concat!(env!("OUT_DIR"), "/inputs.rs"));

#[macro_use]
mod set;

mod brush;
pub mod clump;
mod color;
mod effect;
mod grid;
mod joints;
mod lanes;
mod layer;
mod light;
mod mesh_effect;
mod param;
mod paths;
pub mod preset;
mod program;
mod registry;
mod samples;
pub mod section;
mod seed;
pub mod smooth;
mod source;
mod strokes;
mod texture;
mod variation;
mod varied;
pub mod wgsl;

pub use brush::{BrushPlace, BrushPlaces, BrushSection, BrushTexture, Fit, StrandBrush, Tool};
pub use color::{linear_from_srgb, parse_hex, to_hex};
pub use effect::{AnyEffect, CLUMP_DISCS, LayerProgram, Reach, StrandJoints, StrokeEffect};
pub use grid::Grid;
pub use joints::{Input, InputSet, Joints, LANES, block, block_or};
pub use layer::{Layer, Units};
pub use light::Light;
pub use mesh_effect::MeshEffect;
pub use param::{Param, ParamKind, Value, Values};
pub use paths::{Hair, HairStrand, MOST_PATHS, MadePath, MadePaths};
pub use program::{Parameters, Program};
pub use registry::{Registry, RegistryError};
pub use samples::{BLOCK, SampleBlock, SampleInput, SampleSet, Samples, Vectors};
pub use section::Section;
pub use seed::{layer_seed, strand_seed};
pub use source::{PaintSource, ProgramSource};
pub use strokes::Strokes;
pub use texture::{Blurred, Image, ImageError, Ramp, Row, Texture};
pub use variation::Variation;
pub use varied::Varied;

/// The vectors of paths that effects make, for crates that don't depend on glam themselves.
pub use glam;
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
