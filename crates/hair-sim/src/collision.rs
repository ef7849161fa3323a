//! Bodies that hair cannot enter.

pub(crate) mod grid;
pub(crate) mod shape;

#[cfg(test)]
mod properties;
