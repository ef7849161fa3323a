//! Translates the effects.

fn main() {
    effects_build::effect("src/toon.wgsl");
    effects_build::effect("src/zigzag.wgsl");
    effects_build::effect("src/mesh_flat.wgsl");
    effects_build::effect("src/mesh_toon.wgsl");
}
