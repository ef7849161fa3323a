//! inputs: u, light_on_screen, across, clump_radius, clump_color, seed

struct Params {
    /// How far the shadow is moved along the light, from the hair that casts it.
    /// @unit head heights @range 0..0.4 @default 0.07
    distance: f32,
    /// Strokes side by side across each clump: 1 is the clump's own shape, more end one by one, as feathers.
    /// @range 1..32 @default 1
    feathers: u32,
    /// Of feathers: how much of the strand they may end before its tip.
    /// @unit 0 root to 1 tip @range 0..1 @default 0.25
    raggedness: f32,
    /// Factor on the width of the shadow: 1 is as wide as the clump.
    /// @range 0..4 @default 1
    fullness: f32,
    /// Over how much of the strand the shadow grows from nothing at the root: hair lies on the scalp there.
    /// @unit 0 root to 1 tip @range 0..1 @default 0.2
    root_fade: f32,
    /// Brightness as a factor of the basic colour, on hair, where no colour is given.
    /// @range 0..4 @default 0.6
    factor: f32,
    /// Colour on hair, or none for a factor of the basic colour. Meshes have their own colour in shadow.
    /// @default none
    color: vec4<f32>,
}

/// Where light comes from behind the eye's plane, or nearly, what is seen lies in shadow already: from there to here the shadow grows.
const WHOLE: f32 = 0.25;

/// Over how much of the strand a feather ends.
const TAPER: f32 = 0.15;

fn stroke(joint: Inputs, instance: u32, params: Params) -> Stroke {
    let light = joint.light_on_screen;
    let place = feather_place(instance, params.feathers);
    let basic = params.fullness * joint.clump_radius / f32(params.feathers);
    var share = smoothstep(0.0, WHOLE, light.z);
    if (joint.u < params.root_fade) {
        share = share * smoothstep(0.0, params.root_fade, joint.u);
    }
    if (params.feathers > 1u) {
        let end = 1.0 - params.raggedness * random(joint.seed, instance);
        share = share * saturate((end - joint.u) / TAPER);
    }
    let moved = 300.0 * params.distance * vec2<f32>(light.x, light.y);
    let row = params.fullness * joint.clump_radius * place * joint.across;
    let color = color_or(params.color, params.factor * joint.clump_color);
    return Stroke(row - moved, share * basic, params.distance * max(light.z, 0.0), color);
}
