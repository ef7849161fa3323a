//! What the specification asks of painted hair, of levels and of lines by image filters, on whole heads of hair. Each test names the row that it
//! proves; `docs/figures.md` has the list.

#![allow(
    clippy::print_stdout,
    reason = "a test shows the figures that it holds"
)]

mod levels;
mod light;
mod lines;
mod marks;
mod shown;
mod strands;
mod tube;
