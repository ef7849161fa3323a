//! inputs: clump_radius, clump_color, clump_shift

struct Params {
    /// Factor on the clump's brightness; 1 leaves the basic colour as it is.
    /// @range 0..4 @default 1
    brightness: f32,
}

fn stroke(joint: Inputs, instance: u32, params: Params) -> Stroke {
    let disc = clump_disc(instance, joint.clump_radius, joint.clump_shift);
    return Stroke(vec2<f32>(disc.x, disc.y), disc.z, 0.0, joint.clump_color * params.brightness);
}
