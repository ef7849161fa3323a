//! Translates the effects.

fn main() {
    effects_build::effect("src/band.wgsl");
    effects_build::effect("src/base.wgsl");
    effects_build::effect("src/cast.wgsl");
    effects_build::effect("src/cel.wgsl");
    effects_build::effect("src/fine.wgsl");
    effects_build::effect("src/highlight.wgsl");
    effects_build::effect("src/ink.wgsl");
    effects_build::effect("src/silhouette.wgsl");
}
