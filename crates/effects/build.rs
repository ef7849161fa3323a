//! Translates the WGSL that all effects share.

fn main() {
    effects_build::prelude();
    effects_build::inputs();
    effects_build::clump("../../shaders/clump.wgsl");
    // For `tests/wgsl.rs`, which holds the translation against WGSL's definitions.
    effects_build::effect("tests/builtins.wgsl");
}
