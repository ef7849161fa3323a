//! The reference picture, and how far other pictures are from it.

pub mod compare;
pub mod oracle;
