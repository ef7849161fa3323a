//! Arithmetic on [`LANES`] strands at once.
//!
//! What is kept of a batch is an array of numbers in place of one, a [`Lane`]. The loops that take the time are generic in the
//! [`Number`] that they work with: they load lanes, work in registers of the machine's instruction set, and store
//! lanes. For a machine without one of these the number is the array itself.
//!
//! Every operation works lane by lane, so that a strand's numbers never depend on its neighbours in
//! a batch, and there is no fused multiply-add, so that they are the same on every processor.

#[cfg(target_arch = "x86_64")]
pub(crate) mod avx2;
pub(crate) mod instructions;
pub(crate) mod lane;
mod linear;
pub(crate) mod number;
pub(crate) mod plane;

pub(crate) use lane::{LANES, Lane, Mask};
pub(crate) use linear::{Mat3, Quat, Sym3, Vec3};
pub(crate) use number::{Number, stored};

#[cfg(test)]
mod properties;
