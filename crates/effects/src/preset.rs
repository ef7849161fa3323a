//! Presets: reading RON so that every mistake is named at its place, all of a file's at once.
//!
//! Each section of a preset belongs to a crate. [`Reader`] holds the file's text; sections are read
//! from the text's own slices, so that every error has the file's line and column.

mod brackets;
pub mod edit;
mod error;
mod layers;
mod reader;
mod set;
mod syntax;
mod value;

pub use error::{Place, PresetError, PresetErrors, nearest, suggestion};
pub use layers::{LAYER, LayerSpec, OF_THE_EFFECT, may_say};
pub use reader::{Field, Reader};
pub use set::{SetError, set_text};
pub use value::read_value;
