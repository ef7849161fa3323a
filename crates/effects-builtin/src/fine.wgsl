//! inputs: u, clump_color, unit, seed

struct Params {
    /// Fine hairs for each strand, on average.
    /// @constant @range 0..8 @default 0.5
    per_strand: f32,
    /// Width of the line at its thickest.
    /// @unit the layer's unit: 1/300 head height, or pixels @range 0..100 @default 1.4
    width: f32,
    /// How much widths differ from hair to hair: 0.3 makes them 30 % smaller to 30 % larger.
    /// @range 0..1 @default 0.3
    width_variation: f32,
    /// Part of the hair, of both ends together, over which the line swells from a point to its width.
    /// @unit 0 nothing to 1 all @range 0..1 @default 0.5
    taper: f32,
    /// Where along its strand a hair begins: near the root, at 0.1, or at random from there up to here.
    /// @unit 0 root to 1 tip @constant @range 0..1 @default 0.4
    latest_start: f32,
    /// Shortest hair, in lengths of its strand; others are longer, at random.
    /// @unit the strand's length @constant @range 0.05..2 @default 0.35
    shortest_length: f32,
    /// Longest hair, in lengths of its strand; none goes on far beyond its tip.
    /// @unit the strand's length @constant @range 0.05..2 @default 0.9
    longest_length: f32,
    /// How far a hair wanders from its strand to a neighbour: 1 reaches the neighbour, more goes beyond.
    /// @unit the way to the neighbour @constant @range 0..4 @default 0.8
    crossing: f32,
    /// How many of the strands that run beside its own it may wander to, the nearest first.
    /// @range 1..16 @default 4
    neighbours: u32,
    /// How far its tip may stand off the hair: some leave the silhouette.
    /// @unit head heights @constant @range 0..2 @default 0.07
    lift: f32,
    /// How far it swings to its sides.
    /// @unit head heights @constant @range 0..1 @default 0.015
    wave: f32,
    /// Brightness as a factor of the basic colour, where no colour is given.
    /// @range 0..8 @default 1.35
    factor: f32,
    /// Colour of the lines, or none for a factor of the basic colour.
    /// @default none
    color: vec4<f32>,
}

fn stroke(joint: Inputs, instance: u32, params: Params) -> Stroke {
    let varied = 1.0 + params.width_variation * random_signed(joint.seed, 0u);
    let ends = min(joint.u, 1.0 - joint.u);
    // Where nothing tapers the line is as wide at its ends.
    let share = select(1.0, saturate(2.0 * ends / params.taper), 2.0 * ends < params.taper);
    let radius = 0.5 * params.width * joint.unit * varied * share;
    return Stroke(vec2<f32>(0.0), radius, 0.0, color_or(params.color, params.factor * joint.clump_color));
}
