//! inkstrand's viewer with one more effect: its panel comes from its WGSL.

use std::process::ExitCode;

fn main() -> ExitCode {
    let mut registry = inkstrand::builtin_effects();
    if let Err(error) = registry.register::<effect_backlight::Backlight>() {
        inkstrand::fail(&error);
        return ExitCode::FAILURE;
    }
    viewer::run(registry)
}
