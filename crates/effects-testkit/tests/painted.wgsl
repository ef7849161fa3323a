//! inputs: clump_radius, clump_color
//! sample: color, normal, tube, light_direction, u, w, seed, level

struct Params {
    /// Colours by light, from dark to lit, and by place along the strand.
    /// @texture @default [(v: 0, steps: [(0, "806040"), (0.5, "FFFFFF")]), (v: 1, stops: [(0, "404080"), (1, "FFFFFF")])]
    tones: u32,
    /// A pattern laid along the strand, or none.
    /// @texture repeat @default none
    pattern: u32,
    /// How round strokes look.
    /// @range 0..1 @default 0.5
    roundness: f32,
}

fn stroke(joint: Inputs, instance: u32, params: Params) -> Stroke {
    return Stroke(vec2<f32>(0.0), joint.clump_radius, 0.0, joint.clump_color);
}

fn place(at: Sample, params: Params) -> Lookup {
    let lit = saturate(dot(rounded(at.normal, at.tube, params.roundness), at.light_direction));
    if (at.level == 1u) {
        return Lookup(params.pattern, vec2<f32>(at.u * 7.0, 0.5 + 0.5 * at.w), 0.1);
    }
    return Lookup(params.tones, vec2<f32>(lit, at.u), 0.0);
}

fn paint(at: Sample, texel: vec4<f32>, params: Params) -> vec3<f32> {
    let tone = vec3<f32>(texel.x, texel.y, texel.z);
    let whole = mix(at.color, at.color * tone, vec3<f32>(texel.w));
    return whole * (0.95 + 0.05 * random(at.seed, 7u));
}
