//! inkstrand with one more effect.

use std::process::ExitCode;

fn main() -> ExitCode {
    let mut registry = inkstrand::builtin_effects();
    if let Err(error) = registry.register::<effect_engraving::Engraving>() {
        inkstrand::fail(&error);
        return ExitCode::FAILURE;
    }
    inkstrand::run(&registry)
}
