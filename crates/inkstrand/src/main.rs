//! The inkstrand program: its own effects, and one line.

use std::process::ExitCode;

fn main() -> ExitCode {
    inkstrand::run(&inkstrand::builtin_effects())
}
