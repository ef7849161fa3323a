//! x
pub mod controls;
pub mod edit;
pub mod layers_shown;
pub mod panels;
