//! What acts on particles: see [`crate::solver`] for how it enters a step.

pub(crate) mod mutual;
pub(crate) mod springs;
pub(crate) mod stream;
pub(crate) mod wind;
