//! inputs: clump_radius, unit

struct Params {
    /// How far the line reaches past the clump.
    /// @unit the layer's unit: 1/300 head height, or pixels @range 0..100 @default 2.2
    width: f32,
    /// The line is never wider than this share of the clump's radius, so that tips stay points.
    /// @range 0..10 @default 0.6
    ratio: f32,
    /// Colour of the line.
    /// @default "124A57"
    color: vec3<f32>,
}

fn stroke(joint: Inputs, instance: u32, params: Params) -> Stroke {
    let width = min(params.width * joint.unit, params.ratio * joint.clump_radius);
    return Stroke(vec2<f32>(0.0), joint.clump_radius + width, 0.0, params.color);
}
