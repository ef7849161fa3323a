// Surfaces that hair hides are kept, as some are seen through it. Composed with tiles.wgsl, behind told.wgsl.

const KEEPS_UNDER: bool = true;

/// For each sample that shows hair the triangle behind it, its colour, and its inverse depth: mesh_main.wgsl reads them.
@group(0) @binding(11) var under: texture_storage_2d_array<rgba32uint, write>;

fn keep_under(at: vec2<u32>, sample: u32, what: vec4<u32>) {
    textureStore(under, at, sample, what);
}
