//! What an author does, from the first to the last step, on a viewer without a window.

#[path = "../common/mod.rs"]
mod common;

mod engine;
mod export;
mod files;
mod hands;
mod picture;
mod texts;
mod window;
