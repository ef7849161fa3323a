// Strokes cover all that they reach. Composed with tiles.wgsl.

const BRUSHED: bool = false;

fn brush_covers(brush: u32, reached: vec4<bool>, discs_of: vec4<u32>, ways: vec4<f32>, vs: vec4<f32>, first_sample: u32) -> vec4<bool> {
    return reached;
}
