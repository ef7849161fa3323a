//! inputs: u, normal, light_direction, light_distance, view_direction, forward, across, clump_radius, unit, seed

struct Params {
    /// What the strokes follow: Phong's specular light (5.4), the distance to a light that has a place
    /// (5.4), or a ring across the flow of the hair where it mirrors the light.
    /// @choices specular distance ring @default specular
    kind: u32,
    /// Strokes side by side across each clump (N_feather in 5.5).
    /// @range 1..32 @default 4
    feathers: u32,
    /// Strokes that share the clump's width, or thin lines of one width.
    /// @choices feathers lines @default feathers
    shape: u32,
    /// Specular and ring: how sharp the light is, Phong's exponent. A ring takes four times as much, as
    /// its angle is half as large.
    /// @range 1..1000 @default 6
    exponent: f32,
    /// Specular and ring: brightness where the strokes end; they lie where it is brighter.
    /// @unit gray, 0 dark to 1 mirrored @range 0..1 @default 0.5
    threshold: f32,
    /// Specular and ring: brightness from which on they have their full size. A hard step where it is not
    /// above the threshold.
    /// @unit gray, 0 dark to 1 mirrored @range 0..1 @default 0.85
    full: f32,
    /// Distance: from the light, where the strokes have their full size.
    /// @unit head heights @range 0..1000 @default 2.6
    near: f32,
    /// Distance: from the light, where the strokes end. A hard step where it is not above `near`.
    /// @unit head heights @range 0..1000 @default 3
    far: f32,
    /// Ring: moves it along the hair, up towards the root or, below 0, down to the tip.
    /// @range -2..2 @default 0
    shift: f32,
    /// How much both limits differ from strand to strand, up or down.
    /// @unit that of the limits @range 0..10 @default 0.05
    strand_variation: f32,
    /// How much both limits differ from stroke to stroke of a strand, up or down.
    /// @unit that of the limits @range 0..10 @default 0.1
    feather_variation: f32,
    /// Share of the strands that have a highlight.
    /// @range 0..1 @default 1
    strand_share: f32,
    /// Share of its strokes that a strand has.
    /// @range 0..1 @default 1
    feather_share: f32,
    /// How much of the clump's width the strokes take.
    /// @range 0..1 @default 0.7
    spread: f32,
    /// How far strokes are moved out of their even places, in parts of their distance.
    /// @range 0..1 @default 0.2
    scatter: f32,
    /// How much a clump shines as a round lock: 0 is one brightness across it, 1 and more draws the light
    /// together where the lock bulges towards it.
    /// @range 0..4 @default 0.5
    roundness: f32,
    /// Where along the strand strokes may begin: roots lie under other hair, and would show through its
    /// gaps as specks. From there on they fade in over a tenth of the strand.
    /// @unit 0 root to 1 tip @range -0.1..1 @default 0.12
    start: f32,
    /// Feathers: factor on the size of each stroke: 1 is the source's, at which neighbours just touch,
    /// less leaves gaps.
    /// @range 0..4 @default 1
    fullness: f32,
    /// Lines: their width.
    /// @unit the layer's unit: 1/300 head height, or pixels @range 0..100 @default 1.6
    width: f32,
    /// Width below which a tapering stroke ends: no hairlines.
    /// @unit the layer's unit: 1/300 head height, or pixels @range 0..100 @default 0.8
    thinnest: f32,
    /// Shortest stroke and shortest gap between two of them, as they are seen: what is shorter is smoothed
    /// away, or it would be speckle.
    /// @unit head heights @constant @range 0..10 @default 0.12
    shortest: f32,
    /// Colour of the strokes.
    /// @default "FFFFFF"
    color: vec3<f32>,
}

/// Phong's specular term: the cosine of mirrored light and eye, to the power of the exponent.
fn specular(joint: Inputs, normal: vec3<f32>, exponent: f32) -> f32 {
    let facing = dot(joint.light_direction, normal);
    let mirrored = 2.0 * facing * normal - joint.light_direction;
    // No light comes through from behind; it fades in, as a step would pop.
    let lit = smoothstep(0.0, 0.1, facing);
    return lit * power(max(dot(mirrored, joint.view_direction), 0.0), exponent);
}

/// The light that a thin fibre mirrors: the sine of the angle between it and the half way vector, to the
/// power of the exponent (Kajiya and Kay, "Rendering Fur with Three Dimensional Textures", 1989; the
/// shifted tangent is Scheuermann's, "Practical Real-Time Hair Rendering and Shading", 2004).
fn ring(joint: Inputs, normal: vec3<f32>, exponent: f32, shift: f32) -> f32 {
    let tangent = unit_or(joint.forward - shift * normal, joint.forward);
    let half_way = unit_or(joint.light_direction + joint.view_direction, normal);
    let cosine = dot(tangent, half_way);
    let sine = sqrt(max(1.0 - cosine * cosine, 0.0));
    return smoothstep(0.0, 0.5, dot(half_way, normal)) * power(sine, 4.0 * exponent);
}

/// Size of a stroke where so much light is mirrored, as a share of its full size.
fn share_of_light(light: f32, shift: f32, params: Params) -> f32 {
    return feather_share(-light, -max(params.full + shift, 0.01), -max(params.threshold + shift, 0.01));
}

fn stroke(joint: Inputs, instance: u32, params: Params) -> Stroke {
    let gap = 2.0 / f32(params.feathers);
    let scatter = 0.5 * params.scatter * gap * random_signed(joint.seed, 3u * instance + 4u);
    let place = params.spread * (feather_place(instance, params.feathers) + scatter);
    let shift = params.strand_variation * random_signed(joint.seed, 0u)
        + params.feather_variation * random_signed(joint.seed, 3u * instance + 2u);

    // Most strokes have no size on most joints: what is cheap to know comes first.
    let nothing = Stroke(place * joint.clump_radius * joint.across, 0.0, 0.0, params.color);
    let is_there = random(joint.seed, 1u) < params.strand_share
        && random(joint.seed, 3u * instance + 3u) < params.feather_share;
    if (!is_there || joint.u <= params.start) {
        return nothing;
    }

    let basic = params.spread * joint.clump_radius / f32(params.feathers);
    let size = select(params.fullness * basic, min(0.5 * params.width * joint.unit, basic), params.shape == 1u);
    let across = params.roundness * place * cross(joint.forward, joint.view_direction);
    let normal = unit_or(joint.normal + across, joint.normal);

    var whole = 0.0;
    switch (params.kind) {
        case 1u: {
            whole = feather_share(joint.light_distance, max(params.near + shift, 0.0), max(params.far + shift, 0.0));
        }
        case 0u: {
            whole = share_of_light(specular(joint, normal, params.exponent), shift, params);
        }
        default: {
            let light = ring(joint, normal, params.exponent, params.shift) * (1.0 - 0.5 * min(params.roundness, 2.0) * place * place);
            whole = share_of_light(light, shift, params);
        }
    }
    whole = whole * smoothstep(0.0, 0.1, joint.u - params.start);
    let share = without_hairlines(whole, size, 0.5 * params.thinnest * joint.unit);
    return Stroke(place * joint.clump_radius * joint.across, share * size, 0.0, params.color);
}
