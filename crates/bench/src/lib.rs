//! The reference picture, how far other pictures are from it, and the suites that measure time
//! against that error.

pub mod backends;
pub mod cartoon;
pub mod character;
pub mod coherence;
pub mod compare;
pub mod dynamics;
mod error;
pub mod frame;
pub mod lines;
pub mod page;
pub mod plot;
pub mod python;
pub mod ratios;
pub mod rest;
pub mod results;
pub mod scale;
pub mod skip;
pub mod stress;
pub mod strokes;
pub mod targets;
pub mod timing;

pub use error::BenchError;
