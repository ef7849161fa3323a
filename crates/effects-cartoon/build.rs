//! Translates the effects.

fn main() {
    effects_build::effect("src/toon.wgsl");
}
