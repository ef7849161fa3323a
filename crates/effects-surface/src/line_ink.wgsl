//! inputs: from_ends, rest_position, material_normal, light_direction, head_height, unit

struct Params {
    /// Width of the line where it is whole, in shadow.
    /// @unit the layer's unit: 1/300 head height, or pixels @range 0..50 @default 3.2
    width: f32,
    /// Over what length each end thins out to a point; of a line shorter than two of these over half of it. 0 is blunt ends.
    /// @unit the layer's unit @range 0..300 @default 30
    taper: f32,
    /// Factor on the width where the surface faces the light: below 1 lines are bold in shadow and thin in light.
    /// @range 0..1.5 @default 0.6
    light_width: f32,
    /// How much the width trembles, as a hand's does, up or down. Trembles stay where they are: of edges on the surface, of outlines along them.
    /// @range 0..1 @default 0.25
    wobble: f32,
    /// How far it is from one tremble to the next.
    /// @unit head heights @range 0.01..10 @default 0.15
    wobble_length: f32,
    /// Colour of the line.
    /// @default "2E2522"
    color: vec3<f32>,
    /// Its colour where the surface faces the light, or none for the same.
    /// @default none
    light_color: vec4<f32>,
}

fn stroke(joint: Inputs, instance: u32, params: Params) -> Stroke {
    let lit = saturate(dot(joint.light_direction, joint.material_normal));
    let by_light = mix(1.0, params.light_width, lit);
    let by_hand = 1.0 + params.wobble * tremble(joint.rest_position / params.wobble_length);
    // A quarter of an ellipse at each end.
    let unit_m = joint.head_height / 300.0;
    let whole = joint.from_ends.x + joint.from_ends.y;
    let taper = min(params.taper * joint.unit * unit_m, 0.5 * whole);
    let way = saturate(min(joint.from_ends.x, joint.from_ends.y) / max(taper, 1e-9));
    let by_end = select(sqrt(max(1.0 - (1.0 - way) * (1.0 - way), 0.0)), 1.0, params.taper <= 0.0);
    let own = params.color;
    let color = mix(own, color_or(params.light_color, own), vec3<f32>(lit));
    return Stroke(vec2<f32>(0.0), 0.5 * params.width * joint.unit * by_light * by_hand * by_end, 0.0, color);
}
