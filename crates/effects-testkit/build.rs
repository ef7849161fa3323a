//! Translates the effects of the kit's own tests.

fn main() {
    effects_build::effect("tests/good.wgsl");
    effects_build::effect("tests/kinds.wgsl");
    effects_build::effect("tests/painted.wgsl");
}
