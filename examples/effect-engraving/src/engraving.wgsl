//! inputs: clump_radius, clump_color, clump_shift
//! sample: color, normal, tube, u, s, w, light_direction, pixels

struct Params {
    /// Lines along a head's height.
    /// @range 1..400 @default 70
    lines: f32,
    /// How far lines bend around a lock: 0 runs straight across, below 0 they bend to the root.
    /// @unit distances of lines @range -20..20 @default 3
    bend: f32,
    /// How much each lock is shaded as a round one: 0 shades the head as a whole, 1 every lock.
    /// @range 0..1 @default 0.6
    roundness: f32,
    /// Light from which on there are no lines: the cosine between normal and light.
    /// @range -1..2 @default 0.85
    bright: f32,
    /// Light up to which lines are so wide that they touch.
    /// @range -2..1 @default -0.6
    dark: f32,
    /// Light below which a second set of lines crosses the first.
    /// @range -2..2 @default 0.1
    cross: f32,
    /// Over how much of the strand light falls on it fully at the root, so that a crown isn't black.
    /// @unit 0 root to 1 tip @range 0..1 @default 0.15
    root_fade: f32,
    /// Colour of the lines.
    /// @default "2A1E18"
    ink: vec3<f32>,
}

fn stroke(joint: Inputs, instance: u32, params: Params) -> Stroke {
    let disc = clump_disc(instance, joint.clump_radius, joint.clump_shift);
    return Stroke(vec2<f32>(disc.x, disc.y), disc.z, 0.0, joint.clump_color);
}

/// How much of a set of lines with this share of ink covers a place; `fine` is how many of them lie in a pixel. Lines too fine to be told
/// apart are the gray that they make.
fn inked(phase: f32, share: f32, fine: f32) -> f32 {
    let away = abs(2.0 * (phase - floor(phase)) - 1.0);
    return mix(select(0.0, 1.0, away < share), share, saturate(4.0 * fine - 1.0));
}

fn paint(at: Sample, params: Params) -> vec3<f32> {
    let normal = rounded(at.normal, at.tube, params.roundness);
    var light = dot(normal, at.light_direction);
    if (at.u < params.root_fade) {
        light = max(light, mix(params.bright, light, at.u / params.root_fade));
    }
    let share = saturate((params.bright - light) / max(params.bright - params.dark, 0.001));
    let along = params.lines * at.s;
    let fine = params.lines / max(at.pixels, 1.0);
    var ink = inked(along + params.bend * at.w * at.w, share, fine);
    if (light < params.cross) {
        ink = max(ink, inked(along + params.bend * at.w, 0.5 * share, fine));
    }
    return mix(at.color, params.ink, vec3<f32>(ink));
}
