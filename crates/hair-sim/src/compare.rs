//! Other people's solvers, for comparison: slower at equal error, and with less in them.

mod xpbd;

pub use xpbd::{Rod, Xpbd};
