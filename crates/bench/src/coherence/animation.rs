//! Something in motion, moment by moment.
//!
//! Times are whole [`Tick`]s, the shortest time between two pictures. Hair is simulated in steps of
//! one tick, so that every picture shows a moment of one continuous motion: what jumps then jumps in
//! the drawing.

use crate::BenchError;
use render::Frame;

/// Number of a moment; moments are 1/[`TICKS`] s apart.
pub type Tick = u32;

/// Ticks of a second.
pub const TICKS: Tick = 1536;

/// Something that moves.
pub trait Animation {
    /// It at a moment. Later moments are cheaper than earlier ones.
    ///
    /// # Errors
    ///
    /// When there is no such frame.
    fn at(&mut self, tick: Tick) -> Result<Frame<'_>, BenchError>;
}

/// A moment in seconds.
#[must_use]
pub fn seconds(tick: Tick) -> f64 {
    f64::from(tick) / f64::from(TICKS)
}

/// What a scene is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// The drawing of hair.
    Hair,
    /// What is done with the picture afterwards, which is told and held to nothing: lines that come and go whole.
    Passes,
    /// The measure itself: all change is continuous.
    Continuous,
    /// The measure itself: something jumps.
    Jumping,
}
