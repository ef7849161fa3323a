//! inputs: clump_radius, clump_color, clump_shift, unit, u

struct Params {
    /// How far the line reaches past the clump.
    /// @unit the layer's unit: 1/300 head height, or pixels @range 0..100 @default 2.2
    width: f32,
    /// The line is never wider than this share of the clump's radius, so that tips stay points.
    /// @range 0..10 @default 0.6
    ratio: f32,
    /// Over how much of the strand the line grows from nothing at the root: roots crowd together, and their
    /// lines would make a mess of the crown. 0 is full lines from the root on.
    /// @unit 0 root to 1 tip @range 0..1 @default 0.15
    root_fade: f32,
    /// Colour of the line, or none for a dark shade of the hair's own.
    /// @default none
    color: vec4<f32>,
}

/// How bright a line is against the hair whose colour it takes.
const DARK: f32 = 0.13;

fn stroke(joint: Inputs, instance: u32, params: Params) -> Stroke {
    let whole = min(params.width * joint.unit, params.ratio * joint.clump_radius);
    let fade = select(1.0, smoothstep(0.0, params.root_fade, joint.u), joint.u < params.root_fade);
    let disc = clump_disc(instance, joint.clump_radius, joint.clump_shift);
    // A side that is not there has no line.
    let width = whole * fade * saturate(4.0 * disc.z / max(joint.clump_radius, 1e-6));
    let color = color_or(params.color, DARK * joint.clump_color);
    return Stroke(vec2<f32>(disc.x, disc.y), disc.z + width, 0.0, color);
}
