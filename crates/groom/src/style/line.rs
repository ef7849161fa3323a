//! Lines on the head.

use crate::shell::Place;

/// A line on the head, from the first clump of a row to the last.
#[derive(Clone, Debug, PartialEq)]
pub enum Line {
    /// Through these places.
    Through(Vec<Place>),
    /// The whorl: one place.
    Whorl,
    /// The parting, from front to back.
    Parting,
    /// The hairline between two longitudes.
    Hairline {
        /// First longitude, degrees.
        from: f32,
        /// Last longitude, degrees.
        to: f32,
    },
}
