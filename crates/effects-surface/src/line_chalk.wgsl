//! inputs: from_ends, rest_position, material_normal, light_direction, head_height, unit, across

struct Params {
    /// Width of the line where the hand presses.
    /// @unit the layer's unit: 1/300 head height, or pixels @range 0..50 @default 7
    width: f32,
    /// How much the hand's pressure varies along the line: where it presses less the line is narrower, and of the pale colour.
    /// @range 0..1 @default 0.5
    pressure: f32,
    /// How far it is from where the hand presses to where it presses less. Both stay where they are: of edges on the surface, of outlines along them.
    /// @unit head heights @range 0.01..10 @default 0.3
    pressure_length: f32,
    /// How much less the hand presses where the surface faces the light.
    /// @range 0..1 @default 0.4
    light: f32,
    /// How far the line strays to both sides, as a hand's does.
    /// @unit the layer's unit @range 0..30 @default 1.2
    wobble: f32,
    /// How far it is from one stray to the next.
    /// @unit head heights @range 0.01..10 @default 0.25
    wobble_length: f32,
    /// How far the line goes on beyond both its ends: what is sketched crosses at corners.
    /// @unit the layer's unit @range 0..60 @default 5
    overshoot: f32,
    /// Colour of the line.
    /// @default "4A4038"
    color: vec3<f32>,
    /// Its colour where the hand presses least, or none for the same.
    /// @default none
    pale_color: vec4<f32>,
}

/// Over so many times the overshoot a line is drawn out, so that its joints keep their order.
const DRAWN_OUT: f32 = 3.0;
/// The part of the width and of the colour that is there where the hand presses least.
const LEAST_WIDTH: f32 = 0.35;
/// An end is blunt: narrower by this much over half a width.
const BLUNT: f32 = 0.3;

fn stroke(joint: Inputs, instance: u32, params: Params) -> Stroke {
    let lit = saturate(dot(joint.light_direction, joint.material_normal));
    // Another place of the same noise, so that a line doesn't stray where it is pressed.
    let by_hand = 0.5 + 0.5 * tremble(joint.rest_position / params.pressure_length + vec3<f32>(37.5, 11.25, 5.75));
    let less = saturate(params.pressure * by_hand + params.light * lit);
    let width = params.width * mix(1.0, LEAST_WIDTH, less);
    // Both ends, in units of the layer.
    let unit_m = joint.unit * joint.head_height / 300.0;
    let ends = joint.from_ends / unit_m;
    let end = min(ends.x, ends.y);
    let blunt = mix(1.0 - BLUNT, 1.0, saturate(2.0 * end / max(width, 1e-6)));
    // What is near an end is moved towards it, all the more the nearer. Short lines go on by less.
    let long = max(min(DRAWN_OUT * params.overshoot, 0.5 * (ends.x + ends.y)), 1e-6);
    let near = saturate(vec2<f32>(1.0) - ends / long);
    let out = (near.y * near.y - near.x * near.x) * long / DRAWN_OUT;
    let ahead = vec2<f32>(joint.across.y, -joint.across.x);
    let astray = params.wobble * tremble(joint.rest_position / params.wobble_length);
    let offset = joint.unit * (out * ahead + astray * joint.across);
    let own = params.color;
    let color = mix(own, color_or(params.pale_color, own), vec3<f32>(less));
    return Stroke(offset, 0.5 * width * joint.unit * blunt, 0.0, color);
}
