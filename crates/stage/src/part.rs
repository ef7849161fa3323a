//! Files beside presets, as `inkstrand effects` shows them.

use effects::Param;

/// A part of a hair style or of a motion script.
#[derive(Clone, Copy, Debug)]
pub struct FilePart {
    /// Its name.
    pub name: &'static str,
    /// What it is about.
    pub doc: &'static str,
    /// How it is written.
    pub example: &'static str,
    /// Its parameters.
    pub table: &'static [Param],
    /// What else it may say: places on the head and lists of them, each with its meaning.
    pub places: &'static [(&'static str, &'static str)],
}
