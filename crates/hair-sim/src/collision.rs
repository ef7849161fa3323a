//! Collision of strands with bodies.

pub(crate) mod contact;
mod grid;
mod shape;

pub use grid::{GridError, SignedDistance};
pub use shape::{Collider, Shape};

#[cfg(test)]
mod properties;
