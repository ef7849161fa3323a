//! inputs: path_weight, unit

struct Params {
    /// Where a strand shines: `weighted` where the light falls on it, moved along the strand by `weight`; `blinn` where it mirrors the light
    /// to the eye.
    /// @choices weighted blinn @default weighted
    kind: u32,
    /// Weighted: 1 shines where hair faces the light, less moves it up to the root.
    /// @constant @range 0..1 @default 0.65
    weight: f32,
    /// How sharp the light is: larger makes a narrower highlight.
    /// @constant @range 1..1000 @default 6
    exponent: f32,
    /// How bright a strand must be for the highlight to begin on it: it grows from nothing there.
    /// @unit gray, 0 dark to 1 lit @constant @range 0..1 @default 0.5
    threshold: f32,
    /// How bright a strand must be for the highlight to be whole.
    /// @unit gray, 0 dark to 1 lit @constant @range 0..1 @default 0.85
    full: f32,
    /// Highlights on each strand at most: with 2 those above and below `split` are drawn apart.
    /// @range 1..2 @default 1
    groups: u32,
    /// Where along the strand the lower highlight takes over from the upper one.
    /// @unit 0 root to 1 tip @constant @range 0..1 @default 0.5
    split: f32,
    /// No highlight nearer to the root than this.
    /// @unit 0 root to 1 tip @constant @range 0..1 @default 0.06
    start: f32,
    /// Strands that shine farther apart than this are not joined: the highlight breaks at partings.
    /// @unit head heights @constant @range 0..4 @default 0.3
    longest: f32,
    /// Highlights of strands nearer to each other than this are drawn to one line: dense hair shines at many heights. 0 leaves each where it is.
    /// @unit head heights @constant @range 0..4 @default 0
    merge: f32,
    /// Strips of light shorter than this are left out: no spots. They grow from nothing as they become longer.
    /// @unit head heights @constant @range 0..4 @default 0
    shortest: f32,
    /// How wide the highlight is, along the hair.
    /// @unit the layer's unit: 1/300 head height, or pixels @range 0..300 @default 26
    width: f32,
    /// How far above its strands the highlight is laid, so that it lies on clumps and not in them.
    /// @unit 1 is half the radius of the strand's clump at its full size, without the section `clump` @constant @range 0..4 @default 1
    lift: f32,
    /// Width below which a narrowing highlight ends: no hairlines.
    /// @unit the layer's unit: 1/300 head height, or pixels @range 0..100 @default 1
    thinnest: f32,
    /// Colour of the highlight.
    /// @default "FFFFFF"
    color: vec3<f32>,
}

fn stroke(joint: Inputs, instance: u32, params: Params) -> Stroke {
    let size = 0.5 * params.width * joint.unit;
    let share = without_hairlines(saturate(joint.path_weight), max(size, 1e-6), 0.5 * params.thinnest * joint.unit);
    return Stroke(vec2<f32>(0.0), share * size, 0.0, params.color);
}
