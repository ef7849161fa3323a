//! The inkstrand program: its own effects, and one line.

use std::process::ExitCode;

fn main() -> ExitCode {
    let mut registry = effects::Registry::new();
    if let Err(error) = effects_builtin::register(&mut registry) {
        inkstrand::fail(&error);
        return ExitCode::FAILURE;
    }
    inkstrand::run(&registry)
}
