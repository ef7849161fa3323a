//! inputs: clump_radius, clump_color, clump_shift
//! sample: color, forward, normal, tube, u, w, depth, head_depth, light_direction, view_direction

struct Params {
    /// The tones, from dark at 0 to lit at 1: steps, a gradient, or a PNG from left to right. Rows, or a picture from top to bottom, go by
    /// `detail`.
    /// @texture @default (steps: [(0, "9C93B8"), (0.35, "FFFFFF")])
    tones: u32,
    /// What the tones do to the hair's own colour.
    /// @choices multiply add replace @default multiply
    mode: u32,
    /// How much each lock is shaded as a round one: 0 shades the head as a whole, 1 every lock.
    /// @range 0..1 @default 0.5
    roundness: f32,
    /// Over how much of the strand light falls on it fully at the root: roots leave the scalp every which way, and would shade the crown in
    /// patches.
    /// @unit 0 root to 1 tip @range 0..1 @default 0.12
    root_fade: f32,
    /// What chooses the row, from 0 to 1: nothing, the place along the strand from its root, the place across the lock, how near the hair is, how
    /// much it faces the eye, or a highlight.
    /// @choices none along across depth facing blinn weighted @default none
    detail: u32,
    /// Of `facing`, `blinn` and `weighted`: the power of the cosine. Large makes highlights small.
    /// @range 0..1000 @default 8
    exponent: f32,
    /// Of `weighted`: 1 is a highlight where the lock faces the light, less moves it along the strand towards the root.
    /// @range 0..1 @default 0.5
    weight: f32,
    /// Of `depth`: what is so near or nearer is in the row at 1.
    /// @unit head heights @range -1000..1000 @default -0.5
    near: f32,
    /// Of `depth`: what is so far or farther is in the row at 0.
    /// @unit head heights @range -1000..1000 @default 0.5
    far: f32,
    /// Of `depth`: whether `near` and `far` are from the eye, or behind (before, below 0) the middle of the head.
    /// @choices eye head @default head
    depth_from: u32,
    /// Colour of a rim at the lit edge of each lock, or none.
    /// @default none
    rim: vec4<f32>,
    /// Width of the rim.
    /// @unit the lock's half width @range 0..1 @default 0.25
    rim_width: f32,
}

fn stroke(joint: Inputs, instance: u32, params: Params) -> Stroke {
    let disc = clump_disc(instance, joint.clump_radius, joint.clump_shift);
    return Stroke(vec2<f32>(disc.x, disc.y), disc.z, 0.0, joint.clump_color);
}

/// How near hair is, 1 at `near` and 0 at `far`, in equal steps for equal ratios of distance: "X-Toon" (2006), 3.2, which
/// keeps detail of the near. From the head, distances are those from the eye of what lies so far behind its middle.
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
fn blinn(at: Sample, normal: vec3<f32>, exponent: f32) -> f32 {
    let half_way = unit_or(at.light_direction + at.view_direction, vec3<f32>(0.0));
    return raised(max(dot(normal, half_way), 0.0), exponent);
}

/// A highlight that lies along the strand by its weight (Shin, Haller and Mukundan, "A Stylized Cartoon Hair Renderer", 2006, 3.4.2): of the
/// normal, and of the tangent to the root. Their sum is no unit vector there; here it is made one.
fn weighted(at: Sample, normal: vec3<f32>, params: Params) -> f32 {
    let middle = unit_or(mix(-at.forward, normal, vec3<f32>(params.weight)), normal);
    return raised(max(dot(at.light_direction, middle), 0.0), params.exponent);
}

/// `power`, but that all to the power of 0 is 1.
fn raised(x: f32, exponent: f32) -> f32 {
    return select(power(x, exponent), 1.0, exponent <= 0.0);
}

/// How light falls on a lock with that normal. A round one that runs towards the eye or away from it shows its end, which faces the eye: its sides lie
/// anywhere there, and would shade a whorl or a curl in quarters.
fn light_on(at: Sample, normal: vec3<f32>, params: Params) -> f32 {
    if (params.roundness == 0.0) {
        return max(dot(normal, at.light_direction), 0.0);
    }
    let along = dot(at.forward, at.view_direction);
    let end_on = along * along * along * along;
    let round = mix(at.tube, at.view_direction, vec3<f32>(end_on));
    return max(dot(rounded(at.normal, round, params.roundness), at.light_direction), 0.0);
}

fn place(at: Sample, params: Params) -> Lookup {
    let normal = rounded(at.normal, at.tube, params.roundness);
    var row = 0.0;
    switch params.detail {
        case 1u: { row = at.u; }
        case 2u: { row = 0.5 + 0.5 * at.w; }
        case 3u: { row = nearness(at, params); }
        case 4u: { row = raised(abs(dot(normal, at.view_direction)), params.exponent); }
        case 5u: { row = blinn(at, normal, params.exponent); }
        case 6u: { row = weighted(at, normal, params); }
        default: {}
    }
    var lit = light_on(at, normal, params);
    if (at.u < params.root_fade) {
        lit = max(lit, 1.0 - at.u / params.root_fade);
    }
    return Lookup(params.tones, vec2<f32>(lit, row), 0.0);
}

fn paint(at: Sample, texel: vec4<f32>, params: Params) -> vec3<f32> {
    let is_rim = params.rim.w > 0.0 && abs(at.w) > 1.0 - params.rim_width
        && dot(at.tube, at.light_direction) > 0.0;
    if (is_rim) {
        return vec3<f32>(params.rim.x, params.rim.y, params.rim.z);
    }
    let tone = vec3<f32>(texel.x, texel.y, texel.z);
    var color = at.color * tone;
    if (params.mode == 1u) {
        color = at.color + tone;
    } else if (params.mode == 2u) {
        color = tone;
    }
    return mix(at.color, color, vec3<f32>(texel.w));
}
