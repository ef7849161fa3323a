//! Translates the effect that the kit's own tests spoil.

fn main() {
    effects_build::effect("tests/good.wgsl");
}
