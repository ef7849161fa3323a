//! Translates the effect.

fn main() {
    effects_build::effect("src/backlight.wgsl");
}
