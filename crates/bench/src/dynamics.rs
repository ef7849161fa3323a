//! Suite `dynamics`: time against error of our strands, of two other ways to simulate them, and of other programs.

pub mod banded;
pub mod mass_spring;
pub mod own;
pub mod reference;
pub mod rods;
pub mod xpbd;
