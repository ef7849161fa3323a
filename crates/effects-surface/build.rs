//! Translates the effects.

fn main() {
    effects_build::effect_with("src/line_chalk.wgsl", "src/hand.wgsl");
    effects_build::effect_with("src/line_ink.wgsl", "src/hand.wgsl");
}
