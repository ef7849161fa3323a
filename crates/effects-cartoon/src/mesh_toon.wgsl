//! mesh: color, shade_color, normal, occlusion, depth, head_depth, light_direction, view_direction

struct Params {
    /// The tones, from dark at 0 to lit at 1: steps, a gradient, or a PNG from left to right. Rows, or a picture from top to bottom, go by
    /// `detail`.
    /// @texture @default (steps: [(0, "000000"), (0.25, "FFFFFF")])
    tones: u32,
    /// What the tones do to the mesh's own colours: black takes its colour in the shade, white that in the light; or its colour in the light is
    /// multiplied by them, they are added, or are there alone.
    /// @choices between multiply add replace @default between
    mode: u32,
    /// What chooses the row, from 0 to 1: nothing, how near the mesh is, how much it faces the eye, or a highlight.
    /// @choices none depth facing blinn @default none
    detail: u32,
    /// Of `facing` and `blinn`: the power of the cosine. Large makes highlights small.
    /// @range 0..1000 @default 8
    exponent: f32,
    /// Of `depth`: what is so near or nearer is in the row at 1.
    /// @unit head heights @range -1000..1000 @default -0.5
    near: f32,
    /// Of `depth`: what is so far or farther is in the row at 0.
    /// @unit head heights @range -1000..1000 @default 0.5
    far: f32,
    /// Of `depth`: whether `near` and `far` are from the eye, or behind (before, below 0) the middle of the head.
    /// @choices eye head @default head
    depth_from: u32,
    /// Colour of a rim where the mesh turns away from the eye at the side of the light, or none.
    /// @default none
    rim: vec4<f32>,
    /// Width of the rim: the cosine between surface and eye below which it is.
    /// @range 0..1 @default 0.3
    rim_width: f32,
}

/// How near the mesh is, 1 at `near` and 0 at `far`, in equal steps for equal ratios of distance: as `hair.toon` has it ("X-Toon", 2006, 3.2).
fn nearness(at: Sample, params: Params) -> f32 {
    let origin = select(at.head_depth, 0.0, params.depth_from == 0u);
    let near = max(origin + params.near, 0.001);
    let far = max(origin + params.far, 0.001);
    if (far <= near) {
        return select(0.0, 1.0, at.depth <= near);
    }
    return 1.0 - saturate(log_to_two(max(at.depth, 0.001) / near) / log_to_two(far / near));
}

/// A highlight where the normal lies between light and eye (Blinn's).
fn blinn(at: Sample, exponent: f32) -> f32 {
    let half_way = unit_or(at.light_direction + at.view_direction, vec3<f32>(0.0));
    return raised(max(dot(at.normal, half_way), 0.0), exponent);
}

/// `power`, but that all to the power of 0 is 1.
fn raised(x: f32, exponent: f32) -> f32 {
    return select(power(x, exponent), 1.0, exponent <= 0.0);
}

fn place(at: Sample, params: Params) -> Lookup {
    var row = 0.0;
    switch params.detail {
        case 1u: { row = nearness(at, params); }
        case 2u: { row = raised(abs(dot(at.normal, at.view_direction)), params.exponent); }
        case 3u: { row = blinn(at, params.exponent); }
        default: {}
    }
    let lit = max(dot(at.normal, at.light_direction) - at.occlusion, 0.0);
    return Lookup(params.tones, vec2<f32>(lit, row), 0.0);
}

fn paint(at: Sample, texel: vec4<f32>, params: Params) -> vec3<f32> {
    let is_rim = params.rim.w > 0.0 && abs(dot(at.normal, at.view_direction)) < params.rim_width
        && dot(at.normal, at.light_direction) - at.occlusion > 0.0;
    if (is_rim) {
        return vec3<f32>(params.rim.x, params.rim.y, params.rim.z);
    }
    let tone = vec3<f32>(texel.x, texel.y, texel.z);
    var color = mix(at.shade_color, at.color, tone);
    if (params.mode == 1u) {
        color = at.color * tone;
    } else if (params.mode == 2u) {
        color = at.color + tone;
    } else if (params.mode == 3u) {
        color = tone;
    }
    return mix(at.color, color, vec3<f32>(texel.w));
}
