//! inputs: position, forward, backward, u, strand_mean, head_center, head_height, strand_size, strand_taper, strand_color, strand_tip_color, light_direction, view_direction, seed, material_normal
// The clump: what all layers share of a strand. Size 5.1 to 5.3, normal 5.4, basic colour.

struct Params {
    /// Factor on every strand's own size.
    /// @range 0..20 @default 1
    size: f32,
    /// How much sizes differ from strand to strand: 0.3 makes them 30 % smaller to 30 % larger.
    /// @range 0..1 @default 0.2
    size_variation: f32,
    /// Where along the strand the first size function begins to shrink (x in 5.1).
    /// @unit 0 root to 1 tip @range 0..1 @default 0.35
    shrink_start: f32,
    /// Where in the half turn of a sine the second size function begins (offset in 5.2); 0 is a point.
    /// @range 0..1 @default 0.25
    swell_offset: f32,
    /// Size at the root, as a share of what the functions give there: below 1 a clump leaves the scalp
    /// narrow, hidden by its neighbours (not in the source, whose strokes begin blunt).
    /// @range 0..1 @default 1
    root_size: f32,
    /// How far along the strand the root's size has grown to the functions' own.
    /// @unit 0 root to 1 tip @range 0..1 @default 0.2
    root_length: f32,
    /// How much of the first function there is in the mix (weight in 5.3); the rest is the second.
    /// @range 0..1 @default 0.5
    mix: f32,
    /// How much the mix differs from strand to strand.
    /// @range 0..1 @default 0.15
    mix_variation: f32,
    /// How far the centre that normals point away from moves from the head towards the strand's mean
    /// (Fig 5.4a).
    /// @range 0..1 @default 0.4
    center_shift: f32,
    /// How far the normal is turned to be across the strand (K in 5.4); 1 is exactly across.
    /// @range 0..1 @default 1
    normal_correction: f32,
    /// How flat a clump lies on the head: 0 is as thick as wide, as the source's, 1 a ribbon. It shows where
    /// hair runs along the line of sight: round clumps make a row of bumps of the head's outline. Curls are best
    /// round.
    /// @range 0..1 @default 0.8
    flatness: f32,
    /// What lights a strand: outward points away from the head, across the strand (5.4); material turns as
    /// the strand twists.
    /// @choices outward material @default outward
    normal: u32,
    /// How many levels strands lie in, one over the other, as cartoonists draw hair; 1 orders them by depth alone.
    /// @range 1..8 @default 1
    levels: u32,
    /// How much nearer than the level below each level is taken to be, against other hair alone.
    /// @unit head heights @range 0..10 @default 0.1
    level_depth: f32,
    /// Which strand is in which level: any, or another one than the strands beside it.
    /// @choices random apart @default random
    level_choice: u32,
    /// Basic colour.
    /// @default "3FC1C0"
    color: vec3<f32>,
    /// Colour at the tips, which the basic colour runs into, or none.
    /// @default none
    tip_color: vec4<f32>,
    /// Over how much of the strand, from its tip, the colours run into each other.
    /// @unit share of the strand @range 0..1 @default 0.6
    tip_length: f32,
    /// One colour everywhere, or Phong's diffuse light on it.
    /// @choices pure diffuse @default pure
    shading: u32,
    /// Brightness where no light falls, as a share of the colour; diffuse only.
    /// @range 0..1 @default 0.45
    ambient: f32,
}

/// Normal from 5.4, of unit length (the source leaves it as it falls).
fn corrected_normal(joint: Inputs, params: Params) -> vec3<f32> {
    let center = joint.head_center + params.center_shift * (joint.strand_mean - joint.head_center);
    let outward = unit_or(joint.position - center, vec3<f32>(0.0, 1.0, 0.0));
    let across = outward - params.normal_correction * dot(outward, joint.backward) * joint.backward;
    // Where the strand runs straight outwards nothing is left of it: fade to a perpendicular.
    let lost = max(0.01 - length(across), 0.0);
    return unit_or(across + lost * perpendicular(joint.backward), perpendicular(joint.backward));
}

/// Seen along the strand a flat clump is an ellipse: as wide as the clump, and along the normal `flatness` less thick. Its disc
/// is moved towards the head, to lie to its outer end as the ellipse does; `clump_disc` adds the ellipse's sides. Seen
/// from beside nothing is changed, so that hair loses no volume.
fn flat_shift(joint: Inputs, radius: f32, normal: vec3<f32>, flatness: f32) -> vec3<f32> {
    let along = dot(joint.forward, joint.view_direction);
    return -radius * flatness * along * along * normal;
}

/// Between these distances from the head's centre, in head heights, clumps become round: hair lies flat on the head, and hangs
/// free farther out.
const FLAT_TO: f32 = 0.6;
const ROUND_FROM: f32 = 0.8;

fn lies_flat(joint: Inputs) -> f32 {
    let away = length(joint.position - joint.head_center) / joint.head_height;
    return 1.0 - smoothstep(FLAT_TO, ROUND_FROM, away);
}

/// The hair's colour, without light: from root to tip, the strand's own where it has one.
fn own_color(joint: Inputs, params: Params) -> vec3<f32> {
    var color = params.color;
    if (joint.strand_color.x >= 0.0) {
        color = joint.strand_color;
    }
    var tip = params.tip_color;
    if (joint.strand_tip_color.x >= 0.0) {
        let own = joint.strand_tip_color;
        tip = vec4<f32>(own.x, own.y, own.z, 1.0);
    }
    let start = 1.0 - params.tip_length;
    if (tip.w > 0.0 && joint.u > start) {
        let share = smoothstep(start, 1.0, joint.u);
        color = mix(color, vec3<f32>(tip.x, tip.y, tip.z), vec3<f32>(share));
    }
    return color;
}

fn clump(joint: Inputs, params: Params) -> Clump {
    let weight = saturate(params.mix + params.mix_variation * random_signed(joint.seed, 0u));
    let taper = vec2<f32>(params.root_size, params.shrink_start);
    let own = select(taper, joint.strand_taper, joint.strand_taper >= vec2<f32>(0.0));
    let profile = weight * shrink_to_tail(joint.u, own.y)
        + (1.0 - weight) * swell(joint.u, params.swell_offset);
    // Where root_length is 0 not even the root is narrow.
    let from_root = select(1.0, smoothstep(0.0, params.root_length, joint.u), joint.u < params.root_length);
    let root = mix(own.x, 1.0, from_root);
    let variation = 1.0 + params.size_variation * random_signed(joint.seed, 1u);
    let radius = joint.strand_size * params.size * variation * profile * root;

    var normal = corrected_normal(joint, params);
    // Zero where nobody has worked it out.
    if (params.normal == 1u && dot(joint.material_normal, joint.material_normal) > 0.0) {
        normal = joint.material_normal;
    }
    var color = own_color(joint, params);
    if (params.shading == 1u) {
        let gray = max(dot(joint.light_direction, normal), 0.0);
        color = color * (params.ambient + (1.0 - params.ambient) * gray);
    }
    // A root stands up from the scalp: moved, it would leave a gap.
    let flatness = params.flatness * from_root * lies_flat(joint);
    let shift = flat_shift(joint, max(radius, 0.0), normal, flatness);
    return Clump(normal, max(radius, 0.0), color, shift);
}
