//! inputs: u, arc_length, head_height, normal, light_direction, clump_radius, clump_color, clump_shift, unit, seed

struct Params {
    /// How far the line reaches past the clump where it is whole, in shadow.
    /// @unit the layer's unit: 1/300 head height, or pixels @range 0..50 @default 3.2
    width: f32,
    /// The line is never wider than this share of the clump's radius, so that tips stay points.
    /// @range 0..10 @default 0.7
    ratio: f32,
    /// Factor on the width on the side to the light: below 1 lines are bold in shadow and thin in light.
    /// @range 0..1.5 @default 0.45
    light_width: f32,
    /// Over how much of the strand the line swells from nothing at the root.
    /// @unit 0 root to 1 tip @range 0..1 @default 0.25
    root_fade: f32,
    /// Over how much of the strand it thins out to nothing at the tip.
    /// @unit 0 root to 1 tip @range 0..1 @default 0.3
    tip_fade: f32,
    /// How much the width trembles along the strand, as a hand's does, up or down.
    /// @range 0..1 @default 0.3
    wobble: f32,
    /// How far it is along the strand from one tremble to the next.
    /// @unit head heights @range 0.01..10 @default 0.18
    wobble_length: f32,
    /// How much of the line the brush is off the paper, in places of its own on each strand: 1 is all of it.
    /// @range 0..1 @default 0
    gaps: f32,
    /// No stretch of the line between two gaps is shorter than this along the strand, and no gap, but that half as long ones may be left at the tip: no
    /// crumbs. 0 is twice as long as trembles.
    /// @unit head heights @range 0..10 @default 0
    shortest: f32,
    /// Factor on the width where what lies behind the line is farther away than `gap`: above 1 lines around a mass are bolder than those in it.
    /// @constant @range 1..8 @default 1
    gap_width: f32,
    /// How far behind the line things must be for it to have all of that.
    /// @unit head heights @range 0..4 @default 0.1
    gap: f32,
    /// Colour of the line, or none for a dark shade of the hair's own.
    /// @default none
    color: vec4<f32>,
    /// Its colour where the hair is in shadow, or none for the same: lines within a shadow are lighter or coloured. Where one is light and the other
    /// dark, as white and black are, the line doesn't fade from one to the other: it ends in a point, and begins again.
    /// @default none
    shadow_color: vec4<f32>,
    /// How dark hair is where lines have the shadow's colour: as the shadow's `threshold`.
    /// @unit gray, 0 dark to 1 lit @range 0..1 @default 0.4
    shade: f32,
}

/// In how many steps the width grows with the gap, up to which factor a few do: then none is wider than the line itself. Each is a line of its own, wider and
/// farther away than the next one, which lies on it: within a strand no depth decides.
const FEW_GAP_STEPS: u32 = 3u;
const GAP_STEPS: u32 = 5u;
const FEW_UP_TO: f32 = 3.0;

/// The widest line, in the layer's unit: the effect's reach.
const WIDEST: f32 = 150.0;

/// Over how many grays one colour becomes the other.
const BLEND: f32 = 0.1;

/// Over how many grays, to each side, a line thins out to where it takes a colour far lighter or darker than its own.
const THINNED: f32 = 0.15;

/// How much faster its colour changes there, where it is thin.
const STEEPER: f32 = 4.0;

/// How bright a line is against the hair whose colour it takes.
const DARK: f32 = 0.13;

/// A steady number from -1 to 1 that runs smoothly from random one to random one, at whole places.
fn tremble(place: f32, seed: u32) -> f32 {
    let before = floor(place);
    let way = place - before;
    let index = u32(before);
    let smooth_way = way * way * (3.0 - 2.0 * way);
    return mix(random_signed(seed, index), random_signed(seed, index + 1u), smooth_way);
}

/// How far apart two colours are for ink, which can't fade from light to dark: 0 for shades of one and for hues as light, 1 for black and white.
fn unlike(a: vec3<f32>, b: vec3<f32>) -> f32 {
    return smoothstep(0.3, 0.7, abs(dot(a - b, vec3<f32>(0.2126, 0.7152, 0.0722))));
}

/// At each end of a stretch of the line that share of the shortest one is its point.
const POINT: f32 = 0.3;

/// Whether the brush is on the paper in a stretch of a strand: 1 or 0.
fn is_on(seed: u32, stretch: f32, gaps: f32) -> f32 {
    return select(0.0, 1.0, random(seed, u32(stretch)) >= gaps);
}

/// The same where the strand ends in the stretch `last`, and so much of it is left: what is shorter than half of one goes on as the one before.
fn is_on_of(seed: u32, stretch: f32, gaps: f32, last: f32, left: f32) -> f32 {
    let own = is_on(seed, stretch, gaps);
    if (stretch < last || stretch <= 0.0) {
        return own;
    }
    return mix(is_on(seed, stretch - 1.0, gaps), own, smoothstep(0.5, 1.0, left));
}

/// How much of the line's width there is, so many shortest stretches from the root of a strand of `whole` ones. It is on the paper or off it in each
/// stretch as a whole.
fn on_paper(along: f32, whole: f32, seed: u32, gaps: f32) -> f32 {
    if (gaps <= 0.0) {
        return 1.0;
    }
    let last = floor(whole);
    let left = whole - last;
    let own = min(floor(along), last);
    let before = select(is_on_of(seed, max(own - 1.0, 0.0), gaps, last, left), 1.0, own <= 0.0);
    let after = select(is_on_of(seed, own + 1.0, gaps, last, left), 1.0, own >= last);
    let begun = max(before, saturate((along - own) / POINT));
    let to_come = max(after, saturate((own + 1.0 - along) / POINT));
    return is_on_of(seed, own, gaps, last, left) * min(begun, to_come);
}

fn stroke(joint: Inputs, instance: u32, params: Params) -> Stroke {
    let steps = select(GAP_STEPS, FEW_GAP_STEPS, params.gap_width <= FEW_UP_TO);
    let step = select(0.0, 1.0 - f32(instance / 3u) / f32(steps - 1u), params.gap_width > 1.0);
    let disc = clump_disc(instance % 3u, joint.clump_radius, joint.clump_shift);
    let gray = saturate(dot(joint.light_direction, joint.normal));
    let own = color_or(params.color, DARK * joint.clump_color);
    let in_shadow = color_or(params.shadow_color, own);
    let apart = unlike(own, in_shadow);
    let lighter = gray - params.shade;
    let color = mix(in_shadow, own, vec3<f32>(saturate(lighter / BLEND * mix(1.0, STEEPER, apart) + 0.5)));
    let by_color = mix(1.0, min(abs(lighter) / THINNED, 1.0), apart);

    // A strand 1000 km long trembles no more.
    let along = min(joint.arc_length / (joint.head_height * params.wobble_length), 1e6);
    let by_hand = 1.0 + params.wobble * tremble(along, hash(joint.seed));
    let shortest = select(2.0 * params.wobble_length, params.shortest, params.shortest > 0.0);
    let stretches = min(joint.arc_length / (joint.head_height * shortest), 1e6);
    let on = on_paper(stretches, stretches / max(joint.u, 1e-6), hash(joint.seed + 1u), params.gaps);
    let by_light = mix(1.0, params.light_width, gray);
    let from_root = select(1.0, smoothstep(0.0, params.root_fade, joint.u), joint.u < params.root_fade);
    let to_tip = select(1.0, smoothstep(0.0, params.tip_fade, 1.0 - joint.u), 1.0 - joint.u < params.tip_fade);
    let share = by_hand * by_light * from_root * to_tip * on * by_color;
    let by_gap = 1.0 + (params.gap_width - 1.0) * step;
    let whole = min(min(params.width * joint.unit * share * by_gap, WIDEST * joint.unit), params.ratio * joint.clump_radius);
    // A side that is not there has no line.
    let width = whole * saturate(4.0 * disc.z / max(joint.clump_radius, 1e-6));
    return Stroke(vec2<f32>(disc.x, disc.y), disc.z + width, params.gap * step, color);
}
