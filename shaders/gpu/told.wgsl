// Samples are kept with what they show. Composed with tiles.wgsl.

const TELLS: bool = true;

/// For each sample what it shows, the way along it, places across, and its inverse depth: shown.wgsl reads them.
@group(0) @binding(10) var shown: texture_storage_2d_array<rgba32uint, write>;

fn tell(at: vec2<u32>, sample: u32, what: vec4<u32>) {
    textureStore(shown, at, sample, what);
}
