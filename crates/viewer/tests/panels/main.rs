//! Panes of parameters without a window: their user is the accessibility tree's.

mod controls;
mod layers;
mod lists;
mod monkey;
mod pane;
mod rendered;
