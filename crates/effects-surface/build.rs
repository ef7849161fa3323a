//! Translates the effects.

fn main() {
    effects_build::effect("src/line_chalk.wgsl");
    effects_build::effect("src/line_ink.wgsl");
}
