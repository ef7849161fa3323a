//! inputs: clump_radius, clump_color, across, u

struct Params {
    /// Whether strokes lie on both sides.
    /// @default true
    both: bool,
    /// How far the row of strokes is moved, in strokes.
    /// @range -3..3 @default 0
    shift: i32,
    /// Radii at root and tip, in the clump's.
    /// @range 0..2 @default 1 0.5
    radii: vec2<f32>,
    /// What colours are multiplied by.
    /// @range 0..4 @default 1 0.5 2
    tint: vec3<f32>,
}

fn stroke(joint: Inputs, instance: u32, params: Params) -> Stroke {
    let radius = mix(params.radii.x, params.radii.y, joint.u) * joint.clump_radius / 3.0;
    let place = f32(i32(instance) - 1 + params.shift) / 3.0;
    let is_drawn = params.both || instance == 0u;
    return Stroke(place * joint.clump_radius * joint.across, select(0.0, radius, is_drawn), 0.0, params.tint * joint.clump_color);
}
