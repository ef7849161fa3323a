//! Translates the effect.

fn main() {
    effects_build::effect("src/engraving.wgsl");
}
