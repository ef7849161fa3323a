//! inputs: normal, view_direction, light_direction, forward, across, clump_radius, clump_color, unit, seed

struct Params {
    /// Strokes side by side across each clump.
    /// @range 1..32 @default 7
    feathers: u32,
    /// How fast the rim darkens towards the middle: r in |N . V|^r. Below 1 the light stays at the very
    /// rim, above 1 it reaches far in.
    /// @range 0..16 @default 1
    exponent: f32,
    /// |N . V|^r up to which the light is full.
    /// @unit 0 grazing to 1 facing the eye @range 0..1 @default 0.25
    full: f32,
    /// |N . V|^r where the light ends. A hard step where it is not above `full`.
    /// @unit 0 grazing to 1 facing the eye @range 0..1 @default 0.6
    edge: f32,
    /// How much both differ from strand to strand, up or down.
    /// @range 0..1 @default 0.05
    strand_variation: f32,
    /// How much both differ from stroke to stroke of a strand, up or down.
    /// @range 0..1 @default 0.1
    feather_variation: f32,
    /// How much a clump shines as a round lock: 0 takes the head's rim alone, more takes each lock's.
    /// @range 0..4 @default 0.6
    roundness: f32,
    /// How much the light comes from its own side: 0 is a rim all around, 1 leaves what is turned away
    /// from the light dark.
    /// @range 0..1 @default 0.5
    one_sided: f32,
    /// Factor on the size of each stroke: at 1 neighbours just touch.
    /// @range 0..4 @default 1.2
    fullness: f32,
    /// Width below which a tapering stroke ends: no hairlines.
    /// @unit the layer's unit: 1/300 head height, or pixels @range 0..100 @default 0.8
    thinnest: f32,
    /// Shortest stroke and shortest gap between two of them, as they are seen: what is shorter is smoothed
    /// away, or it would be speckle.
    /// @unit head heights @constant @range 0..10 @default 0.1
    shortest: f32,
    /// Colour of the light at the very rim.
    /// @default "FFF3D6"
    color: vec3<f32>,
    /// Colour of the light where it ends.
    /// @default "E8743B"
    inner_color: vec3<f32>,
    /// How much the hair's own colour is added to the light's, as light that comes through it.
    /// @range 0..4 @default 0.5
    through: f32,
}

// Contre-jour by |N . V|^r into a ramp that is bright at grazing angles: "Back Lighting" (4.3.5) of the
// cartoon hair of an undergraduate thesis that follows Barla, Thollot and Markosian, "X-Toon" (2006). There the
// ramp is a texture; here it is how wide the strokes are, and their colour.
fn stroke(joint: Inputs, instance: u32, params: Params) -> Stroke {
    let place = feather_place(instance, params.feathers);
    let basic = joint.clump_radius / f32(params.feathers);

    let across = params.roundness * place * cross(joint.forward, joint.view_direction);
    let normal = unit_or(joint.normal + across, joint.normal);
    let facing = power(abs(dot(normal, joint.view_direction)), params.exponent);

    let shift = params.strand_variation * random_signed(joint.seed, 0u)
        + params.feather_variation * random_signed(joint.seed, instance + 1u);
    let full = max(params.full + shift, 0.0);
    let edge = max(params.edge + shift, 0.0);
    let lit = smoothstep(-0.5, 0.5, dot(joint.light_direction, normal));
    let rim = feather_share(facing, full, edge) * mix(1.0, lit, params.one_sided);
    // Tips too thin for their strokes catch no light: it would glitter.
    let thinnest = 0.5 * params.thinnest * joint.unit;
    let wide = saturate((basic - thinnest) / max(thinnest, 0.001));
    let share = without_hairlines(rim * wide, basic, thinnest);

    let light = mix(params.inner_color, params.color, rim);
    let offset = place * joint.clump_radius * joint.across;
    return Stroke(offset, share * basic * params.fullness, 0.0, light + params.through * joint.clump_color);
}
