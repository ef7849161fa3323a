//! inputs: u, normal, light_direction, view_direction, forward, across, clump_radius, clump_color, clump_shift, unit, seed

struct Params {
    /// Strokes side by side across each clump (N_feather in 5.5).
    /// @range 1..32 @default 5
    feathers: u32,
    /// Whether the strokes lie where the gray is small, or where it is large.
    /// @choices darker lighter @default darker
    region: u32,
    /// Gray where the strokes end (eps_cel in 5.6): darker ones reach up to it, lighter ones from it on.
    /// @unit gray, 0 dark to 1 lit @range 0..1 @default 0.5
    threshold: f32,
    /// Gray where they have their full size (eps_full in 5.6). Between both they taper; where it is the
    /// same as the threshold, or beyond it, they end in a hard step.
    /// @unit gray, 0 dark to 1 lit @range 0..1 @default 0.25
    full: f32,
    /// How much both grays differ from strand to strand, up or down.
    /// @unit gray @range 0..1 @default 0.05
    strand_variation: f32,
    /// How much both grays differ from stroke to stroke of a strand, up or down.
    /// @unit gray @range 0..1 @default 0.12
    feather_variation: f32,
    /// How much a clump is shaded as a round lock: 0 is the source's one gray across the clump, 1 lets
    /// the shadow hug its dark side.
    /// @range 0..2 @default 0.4
    roundness: f32,
    /// Factor on the size of each stroke: 1 is the source's, at which neighbours just touch.
    /// @range 0..4 @default 1.2
    fullness: f32,
    /// Over how much of the strand the strokes grow from nothing at the root: roots leave the scalp every which
    /// way, and would shade the crown in patches. 0 is full strokes from the root on.
    /// @unit 0 root to 1 tip @range 0..1 @default 0.1
    root_fade: f32,
    /// Width below which a tapering stroke ends: no hairlines.
    /// @unit the layer's unit: 1/300 head height, or pixels @range 0..100 @default 1.2
    thinnest: f32,
    /// Shortest stroke and shortest gap between two of them, as they are seen: what is shorter is smoothed
    /// away, or it would be speckle.
    /// @unit head heights @constant @range 0..10 @default 0.1
    shortest: f32,
    /// Brightness as a factor of the basic colour, where no colour is given.
    /// @range 0..4 @default 0.6
    factor: f32,
    /// Colour of the strokes, or none for a factor of the basic colour.
    /// @default none
    color: vec4<f32>,
}

fn stroke(joint: Inputs, instance: u32, params: Params) -> Stroke {
    let place = feather_place(instance, params.feathers);
    // Where hair turns away over the head its clump is flat: there the row lies along the clump's outer side, and its strokes are
    // wider, to cover the clump.
    let moved = joint.clump_shift;
    let end = smoothstep(0.2, 0.7, flat_end(joint.clump_radius, moved));
    let narrow = 1.0 / f32(params.feathers);
    let basic = joint.clump_radius * mix(narrow, max(narrow, 0.3), end);

    let across = params.roundness * place * cross(joint.forward, joint.view_direction);
    let normal = unit_or(joint.normal + across, joint.normal);
    let gray = max(dot(joint.light_direction, normal), 0.0);

    let shift = params.strand_variation * random_signed(joint.seed, 0u)
        + params.feather_variation * random_signed(joint.seed, instance + 1u);
    // Perturbed thresholds stay grays, so that what no light reaches is always dark.
    let full = saturate(params.full + shift);
    let edge = saturate(params.threshold + shift);
    let sign = select(1.0, -1.0, params.region == 1u);
    let by_gray = feather_share(sign * gray, sign * full, sign * edge);
    var radius = 0.0;
    if (by_gray > 0.0) {
        var whole = by_gray;
        if (joint.u < params.root_fade) {
            whole = by_gray * smoothstep(0.0, params.root_fade, joint.u);
        }
        let share = without_hairlines(whole, basic, 0.5 * params.thinnest * joint.unit);
        radius = share * basic * params.fullness;
    }

    let color = color_or(params.color, params.factor * joint.clump_color);
    let row = joint.clump_radius * place * joint.across;
    // The path on the screen turns back there, and what is across it turns too: across the clump is across its shift.
    let side = clamp(-4.0 * dot(joint.forward, joint.view_direction), -1.0, 1.0);
    let along_side = side * vec2<f32>(moved.y, -moved.x) / max(length(moved), 1e-6);
    let bend = (1.0 - narrow) * sqrt(max(1.0 - place * place, 0.0));
    var offset = row - bend * moved;
    if (end > 0.0) {
        let at_end = at_flat_end(place, radius, along_side, joint.clump_radius, moved);
        offset = mix(offset, at_end, vec2<f32>(end));
    }
    return Stroke(offset, radius, 0.0, color);
}
