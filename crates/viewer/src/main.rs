//! The viewer: inkstrand's own effects, and one line.

use std::process::ExitCode;

fn main() -> ExitCode {
    viewer::run(inkstrand::builtin_effects())
}
