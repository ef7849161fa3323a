//! The panes of parameters. Each shows a document's text, and adds what its user changes to a list of edits; the document
//! belongs to the caller, which shows its new text in the next frame.
//!
//! Edits are meant to be done one after the other, in their order: those that change what is at a place come before those
//! that give places other numbers.

mod fold;
mod items;
mod layers;
mod look;
mod motion_script;
mod parts;
mod places;
mod style;

pub use layers::layers;
pub use look::{PRESET, look, objects, section};
pub use motion_script::motion_script;
pub use style::style;
