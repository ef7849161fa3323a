// Surfaces without pictures. Composed with tiles.wgsl.

const TEXTURED: bool = false;

fn texel_of(surface: u32, index: u32, tile: vec2<f32>, middle: vec2<f32>, depth: vec3<f32>, depth_range: vec2<f32>) -> vec4<f32> {
    return vec4<f32>(1.0);
}

fn is_covered(surface: u32, number: u32, coverage: f32, first_sample: u32) -> vec4<bool> {
    return vec4<bool>(true);
}
