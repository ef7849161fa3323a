//! Other people's solvers, for comparison: slower at equal error, and with less in them.

mod altitudes;
mod apart;
mod banded;
mod mass_spring;
mod truss;
mod xpbd;

pub use mass_spring::{MassSpring, Zigzag};
pub use xpbd::{Rod, Xpbd};
