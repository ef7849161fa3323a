//! Bodies that hair cannot enter.

pub(crate) mod grid;
pub(crate) mod shape;

#[cfg(test)]
pub(crate) mod blocks;
#[cfg(test)]
mod properties;
