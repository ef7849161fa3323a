//! Panes of parameters without a window: their user is the accessibility tree's.

mod base;
mod controls;
mod layers;
mod lists;
mod monkey;
mod pane;
mod rendered;
