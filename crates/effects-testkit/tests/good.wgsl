//! inputs: u, gray, clump_radius, clump_color, across, unit, seed

struct Params {
    /// Strokes side by side.
    /// @range 1..8 @default 3
    feathers: u32,
    /// Gray up to which there are strokes.
    /// @unit gray, 0 dark to 1 lit @range 0..1 @default 0.5
    threshold: f32,
    /// Grays over which the strokes taper; 0 is a hard step.
    /// @unit gray @range 0..1 @default 0.3
    taper: f32,
    /// Width of a line around them.
    /// @unit the layer's unit: 1/300 head height, or pixels @range 0..100 @default 2
    width: f32,
    /// Where on the strand they are.
    /// @choices everywhere root tip @default everywhere
    part: u32,
    /// Colour, or none for the clump's.
    /// @default none
    color: vec4<f32>,
    /// Colour of the tip.
    /// @default "FF8800"
    tip_color: vec3<f32>,
}

fn stroke(joint: Inputs, instance: u32, params: Params) -> Stroke {
    let basic = joint.clump_radius / f32(params.feathers);
    let line = min(params.width * joint.unit, 0.5 * basic);
    var place: f32;
    switch params.part {
        case 0u: { place = 1.0; }
        case 1u: { place = 1.0 - joint.u; }
        default: { place = joint.u; }
    }
    // A sum of some random numbers is more even than one.
    var random_gray = 0.0;
    for (var i = 0u; i < 4u; i++) {
        if (i == 2u) { continue; }
        random_gray += 0.03 * random_signed(joint.seed, 4u * instance + i);
    }
    let edge = saturate(params.threshold + random_gray);
    let share = feather_share(joint.gray, edge - params.taper, edge);
    let color = mix(color_or(params.color, joint.clump_color), params.tip_color, joint.u);
    let offset = feather_place(instance, params.feathers) * joint.clump_radius * joint.across;
    return Stroke(offset, share * place * (basic + line), 0.0, color);
}
