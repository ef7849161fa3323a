// Puts a prepared frame into somebody else's render pass: one triangle over all of it. Composed behind frame.wgsl,
// with compose_samples.wgsl or compose_mean.wgsl.

struct Pass {
    /// A view depth d has the depth `depth.x + depth.y / d` in the pass.
    depth: vec2<f32>,
    /// 1 where the pass's colours are stored as they are written, and meant as sRGB.
    encodes: u32,
    spare: u32,
}

@group(0) @binding(0) var<uniform> gpu_frame: GpuFrame;
/// Every sample: its colour and its inverse depth, 0 where nothing is.
@group(0) @binding(1) var<storage, read> samples: array<vec4<f32>>;
@group(0) @binding(2) var<uniform> target_pass: Pass;

@vertex
fn cover_all(@builtin(vertex_index) index: u32) -> @builtin(position) vec4<f32> {
    let x = select(-1.0, 3.0, index == 1u);
    let y = select(-1.0, 3.0, index == 2u);
    return vec4<f32>(x, y, 0.0, 1.0);
}

struct Shown {
    /// Alpha is multiplied in.
    @location(0) color: vec4<f32>,
    @builtin(frag_depth) depth: f32,
}

fn first_sample(position: vec4<f32>) -> u32 {
    let pixel = vec2<u32>(position.xy);
    return (pixel.y * gpu_frame.size.x + pixel.x) * gpu_frame.samples;
}

fn is_outside(position: vec4<f32>) -> bool {
    return any(vec2<u32>(position.xy) >= gpu_frame.size);
}

fn encoded(color: vec3<f32>) -> vec3<f32> {
    if (target_pass.encodes == 0u) {
        return color;
    }
    // IEC 61966-2-1.
    let high = 1.055 * pow(max(color, vec3<f32>(0.0031308)), vec3<f32>(1.0 / 2.4)) - 0.055;
    return select(high, 12.92 * color, color <= vec3<f32>(0.0031308));
}

/// Nearer than what a pass without anything is cleared to, by what a depth of 24 bits can tell: all that is drawn, lines over nothing, too, is seen before
/// that whatever the comparison.
fn depth_in_pass(inv_depth: f32) -> f32 {
    const LEAST: f32 = 1.0 / 16777216.0;
    let nearer_is_greater = target_pass.depth.y > 0.0;
    let ends = select(vec2<f32>(0.0, 1.0 - LEAST), vec2<f32>(LEAST, 1.0), nearer_is_greater);
    return clamp(target_pass.depth.x + target_pass.depth.y * inv_depth, ends.x, ends.y);
}
