//! Characters: their own hair as strands, and their own motion.
#![expect(clippy::print_stderr, reason = "skipped tests say so")]

mod hair;
mod lines;
mod made;
mod motion;
mod paint;
