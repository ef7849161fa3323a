//! inputs: arc_length, head_height, rest_position, rest_forward, light_direction, view_direction, forward, normal, across, clump_radius, clump_color, unit, seed

struct Params {
    /// Where the band lies: at one height around the head, or at one distance from the roots, as on tails from their ties.
    /// @choices height length @default height
    along: u32,
    /// The band's middle: its height above the middle of the head while nothing moves, or its distance from the root.
    /// @unit head heights @range -4..4 @default 0.27
    place: f32,
    /// How thick the band is, along the hair.
    /// @unit head heights @range 0..4 @default 0.12
    thickness: f32,
    /// Teeth side by side across each clump.
    /// @range 1..32 @default 4
    teeth: u32,
    /// How much deeper every other tooth reaches at both edges of the band: 0 is a smooth edge.
    /// @unit 1 is the band's thickness @range 0..1 @default 0.35
    zigzag: f32,
    /// How much the teeth's ends differ, in or out.
    /// @unit 1 is the band's thickness @range 0..1 @default 0.2
    tooth_variation: f32,
    /// Over how much of its length a tooth narrows to its points: 1 is a spindle, 0 is blunt.
    /// @range 0..1 @default 0.7
    taper: f32,
    /// How much the band's place differs from strand to strand, up or down.
    /// @unit head heights @range 0..1 @default 0.015
    strand_variation: f32,
    /// Share of the strands on which the band goes on: the others break it.
    /// @range 0..1 @default 0.85
    strand_share: f32,
    /// No band nearer to the roots than this: it breaks at partings.
    /// @unit head heights @range 0..4 @default 0.06
    start: f32,
    /// Where hair is darker than this, it has no band: a little more than the shadow's `threshold` keeps light out of the shadow.
    /// @unit gray, 0 dark to 1 lit @range -1..1 @default 0.4
    shade: f32,
    /// Over how many grays above `shade` a tooth grows to its width. Little makes it end at once.
    /// @unit gray @range 0.01..2 @default 0.4
    shade_fade: f32,
    /// How much a clump is shaded as a round lock: as much as the shadow's, so that both agree on where it is dark.
    /// @range 0..2 @default 0.4
    roundness: f32,
    /// Whose shadow that is: `strokes` of `hair.cel`, or that of hair that is painted by `hair.toon`, whose round locks face the eye in their middle.
    /// @choices strokes toon @default strokes
    shadow: u32,
    /// Height: how far of the way to where a ball would mirror the light the band goes: 0 stays where it is drawn, 1 follows the light.
    /// @range 0..1 @default 0.15
    slide: f32,
    /// How much of the clump's width the teeth take.
    /// @range 0..1 @default 0.8
    spread: f32,
    /// Factor on the width of each tooth: at 1 neighbours just touch, less leaves gaps.
    /// @range 0..4 @default 1.1
    fullness: f32,
    /// Width below which a narrowing tooth ends: no hairlines.
    /// @unit the layer's unit: 1/300 head height, or pixels @range 0..100 @default 0.8
    thinnest: f32,
    /// How wide a rim of another colour is around the band, at most half the clump's radius: 0 is none.
    /// @unit the layer's unit: 1/300 head height, or pixels @constant @range 0..100 @default 0
    rim: f32,
    /// Colour of the band.
    /// @default "FFFFFF"
    color: vec3<f32>,
    /// Colour of its rim, or none for one half way between the hair's and the band's.
    /// @default none
    rim_color: vec4<f32>,
}

/// A ball that mirrors as hair on a head does: its radius in head heights.
const BALL: f32 = 0.5;

/// Over how many head heights behind `start` the band comes to its width.
const ROOT_FADE: f32 = 0.04;

/// How steep hair must be at rest to have a ring at one height, and to have all of it, 0 level to 1 upright: along hair that lies level, as on the side of a bun, a tooth would go on
/// and on.
const LEVEL: f32 = 0.2;
const STEEP: f32 = 0.45;

/// Where a joint lies along the hair: what `place` counts.
fn measure(joint: Inputs, params: Params) -> f32 {
    if (params.along == 1u) {
        return joint.arc_length / joint.head_height;
    }
    let half_way = unit_or(joint.light_direction + joint.view_direction, joint.light_direction);
    return joint.rest_position.y - params.slide * (BALL * half_way.y - params.place);
}

fn stroke(joint: Inputs, instance: u32, params: Params) -> Stroke {
    // Those of the rim come first, so that the others lie on them.
    let is_rim = params.rim > 0.0 && instance < params.teeth;
    let tooth = instance % max(params.teeth, 1u);
    let place = params.spread * feather_place(tooth, params.teeth);
    let of_rim = color_or(params.rim_color, mix(joint.clump_color, params.color, vec3<f32>(0.5)));
    let color = select(params.color, of_rim, vec3<bool>(is_rim));
    let offset = place * joint.clump_radius * joint.across;
    let nothing = Stroke(offset, 0.0, 0.0, color);
    let from_root = joint.arc_length / joint.head_height - params.start;
    let is_there = params.thickness > 0.0 && params.spread * params.fullness > 0.0 && random(joint.seed, 0u) < params.strand_share;
    if (!is_there || from_root <= 0.0) {
        return nothing;
    }

    // Half the tooth's length, in head heights: every other one is deeper.
    let deeper = select(-0.5, 0.5, (tooth & 1u) == 1u) * params.zigzag;
    let longer = params.tooth_variation * random_signed(joint.seed, 2u * tooth + 2u);
    let rim = select(0.0, min(params.rim * joint.unit, 0.5 * joint.clump_radius), is_rim);
    let half = 0.5 * params.thickness * max(1.0 + deeper + longer, 0.0) + rim / 300.0;
    let middle = params.place + params.strand_variation * random_signed(joint.seed, 1u)
        + 0.25 * params.tooth_variation * params.thickness * random_signed(joint.seed, 2u * tooth + 3u);
    let away = abs(measure(joint, params) - middle);
    if (away >= half) {
        return nothing;
    }

    // The gray of the shadow's strokes beside it, or of what is painted there.
    let side = cross(joint.forward, joint.view_direction);
    let beside = params.roundness * place * side;
    var normal = unit_or(joint.normal + beside, joint.normal);
    if (params.shadow == 1u) {
        let to_eye = joint.view_direction - dot(joint.view_direction, joint.forward) * joint.forward;
        let tube = place * side + sqrt(max(1.0 - place * place, 0.0)) * to_eye;
        normal = rounded(joint.normal, unit_or(tube, joint.normal), params.roundness);
    }
    let gray = dot(joint.light_direction, normal);
    let lit = saturate((gray - params.shade) / params.shade_fade);
    let along = saturate((half - away) / max(params.taper * half, 1e-6));
    let basic = params.spread * joint.clump_radius / f32(params.teeth);
    let size = params.fullness * basic;
    let steep = select(smoothstep(LEVEL, STEEP, abs(joint.rest_forward.y)), 1.0, params.along == 1u);
    let whole = along * lit * steep * saturate(from_root / ROOT_FADE);
    let share = without_hairlines(whole, size, 0.5 * params.thinnest * joint.unit);
    // A rim is as wide beside the tooth as before its ends, and gone where that is.
    return Stroke(offset, share * (size + rim), 0.0, color);
}
