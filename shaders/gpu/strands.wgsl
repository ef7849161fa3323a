// A strand at the samples of a pixel: its segments one after the other, then all of it against what is there. Composed with
// tiles.wgsl; the CPU's is crates/render/src/cpu/strand.rs.

/// A stroke's colour at the samples: the joint's disc that it begins at, and the way to the next.
struct Paint {
    number: vec4<u32>,
    ratio: vec4<f32>,
    disc: vec4<u32>,
    way: vec4<f32>,
    /// Where `SIDED`: 1 to the right of who walks from root to tip, else -1; and the ratio of the segment that says so.
    side: vec4<f32>,
    side_ratio: vec4<f32>,
}

/// A later segment says on which side a sample lies only where its ratio is less by this factor: around a joint, where a stroke
/// turns back, two segments are equally near and may see the sample on other sides, which rounding must not decide.
const NEARER: f32 = 0.999;

/// Whether it is asked on which side of strokes samples lie.
const SIDED: bool = TELLS || BRUSHED;

/// One strand at the samples; in `SHIFTED`, where strokes are on their own, one of its strokes, as `outer`.
struct Strand {
    /// Its clump.
    depth: vec4<f32>,
    biased: vec4<f32>,
    ratio: vec4<f32>,
    /// Where `SIDED`, as those of a `Paint`.
    side: vec4<f32>,
    side_ratio: vec4<f32>,
    /// The highest stroke that shows outside the clump too, with its own depth.
    outer_depth: vec4<f32>,
    outer_biased: vec4<f32>,
    outer: Paint,
    /// The highest stroke that is clipped to the clump.
    inner: Paint,
    /// Where `BRUSHED`: whether a brush left bare what such a stroke reaches.
    bare: vec4<bool>,
}

fn no_paint() -> Paint {
    let far = vec4<f32>(FAR_RATIO);
    return Paint(vec4<u32>(0u), far, vec4<u32>(0u), vec4<f32>(0.0), vec4<f32>(1.0), far);
}

fn no_strand() -> Strand {
    let nothing = vec4<f32>(NOTHING);
    let one = vec4<f32>(1.0);
    return Strand(nothing, nothing, one, one, vec4<f32>(FAR_RATIO), nothing, nothing, no_paint(), no_paint(), vec4<bool>(false));
}

/// The inverse depth of what lies so many metres deeper. There is nothing deeper than 0 or below.
fn deeper(inv_depth: vec4<f32>, metres: vec4<f32>) -> vec4<f32> {
    return inv_depth / (1.0 + metres * max(inv_depth, vec4<f32>(0.0)));
}

/// On which side of a segment points lie, seen from root to tip, whichever end is larger.
fn side_of(s: Segment, p: Local) -> vec4<f32> {
    let side = select(1.0, -1.0, s.way.y < 0.0 && s.sweep.length > 0.0);
    return select(vec4<f32>(side), vec4<f32>(-side), p.y < vec4<f32>(0.0));
}

/// Places across a stroke, -1 to 1.
fn across(side: vec4<f32>, ratio: vec4<f32>) -> vec4<f32> {
    return side * sqrt(min(ratio, vec4<f32>(1.0)));
}

fn paint(p: ptr<function, Paint>, s: Segment, local: Local, at: Nearest, covered: vec4<bool>) -> vec4<bool> {
    let number = vec4<u32>(s.number);
    let is_higher = covered & (number > (*p).number);
    let is_nearer = is_higher | (covered & (number == (*p).number) & (at.ratio < (*p).ratio));
    (*p).number = select((*p).number, number, is_higher);
    (*p).ratio = select((*p).ratio, at.ratio, is_nearer);
    (*p).disc = select((*p).disc, vec4<u32>(s.disc), is_nearer);
    (*p).way = select((*p).way, s.way.x + at.u * s.way.y, is_nearer);
    if (SIDED) {
        let is_same = covered & (number == (*p).number);
        let tells_side = is_higher | (is_same & (at.ratio < (*p).side_ratio * NEARER));
        (*p).side = select((*p).side, side_of(s, local), tells_side);
        (*p).side_ratio = select((*p).side_ratio, at.ratio, tells_side);
    }
    return is_higher;
}

/// Adds one of its segments to a strand.
fn add(strand: ptr<function, Strand>, s: Segment, x: vec4<f32>, y: vec4<f32>) {
    let p = local_of(s.sweep, x, y);
    let covered = covers(s.sweep, p);
    if (!any(covered)) {
        return;
    }
    let at = nearest(s.sweep, p);
    if (s.number == 0u) {
        let part = interval(s.sweep, p);
        let depth = max(s.inv_depth.x + part.low * s.inv_depth.y, s.inv_depth.x + part.high * s.inv_depth.y);
        let biased = max(s.biased.x + part.low * s.biased.y, s.biased.x + part.high * s.biased.y);
        (*strand).depth = select((*strand).depth, max((*strand).depth, depth), covered);
        (*strand).biased = select((*strand).biased, max((*strand).biased, biased), covered);
        if (SIDED) {
            let tells_side = covered & (at.ratio < (*strand).side_ratio * NEARER);
            (*strand).side = select((*strand).side, side_of(s, p), tells_side);
            (*strand).side_ratio = select((*strand).side_ratio, at.ratio, tells_side);
        }
        (*strand).ratio = select((*strand).ratio, min((*strand).ratio, at.ratio), covered);
    } else if (s.is_clipped) {
        // A copy, because a pointer to a part of what a pointer points to is not for every compiler.
        var inner = (*strand).inner;
        paint(&inner, s, p, at, covered);
        (*strand).inner = inner;
    } else {
        let part = interval(s.sweep, p);
        let depth = max(s.inv_depth.x + part.low * s.inv_depth.y, s.inv_depth.x + part.high * s.inv_depth.y);
        let biased = max(s.biased.x + part.low * s.biased.y, s.biased.x + part.high * s.biased.y);
        let is_same = covered & (vec4<u32>(s.number) == (*strand).outer.number);
        var outer_paint = (*strand).outer;
        let is_higher = paint(&outer_paint, s, p, at, covered);
        (*strand).outer = outer_paint;
        let outer = (*strand).outer_depth;
        (*strand).outer_depth = select(select(outer, max(outer, depth), is_same), depth, is_higher);
        let outer_biased = (*strand).outer_biased;
        (*strand).outer_biased = select(select(outer_biased, max(outer_biased, biased), is_same), biased, is_higher);
    }
}

/// Where a strand of that depth shows: before surfaces, and nearer than what is there.
fn shows(samples: Samples, depth: vec4<f32>, biased: vec4<f32>, stroke: vec4<u32>, owner: u32) -> vec4<bool> {
    let before_wall = depth / (1.0 + samples.surface_margin * depth);
    let against = select(biased, before_wall, samples.surface_margin != vec4<f32>(0.0));
    let is_before = (stroke == samples.stroke) & (vec4<u32>(owner) < samples.owner);
    let is_on_top = (depth == samples.strand) & ((stroke > samples.stroke) | is_before);
    return (samples.surface <= against) & ((depth > samples.strand) | is_on_top);
}

fn color_of(disc: u32, way: f32) -> vec3<f32> {
    let start = discs[disc].color;
    if (way == 0.0) {
        return start;
    }
    return start + way * (discs[disc + 1u].color - start);
}

fn set_colors(samples: ptr<function, Samples>, disc: vec4<u32>, way: vec4<f32>, wins: vec4<bool>) {
    for (var k = 0u; k < 4u; k++) {
        if (wins[k]) {
            let color = color_of(disc[k], way[k]);
            (*samples).red[k] = color.x;
            (*samples).green[k] = color.y;
            (*samples).blue[k] = color.z;
        }
    }
}

/// Takes from one stroke of a strand what its brush, with that record, leaves bare.
fn thin(stroke: ptr<function, Strand>, brush: u32, first_sample: u32) {
    if (brush == 0u) {
        return;
    }
    let none = vec4<u32>(0u);
    let outer = (*stroke).outer;
    let is_outer = outer.number > none;
    let outer_covers = brush_covers(brush, is_outer, outer.disc, outer.way, across(outer.side, outer.ratio), first_sample);
    (*stroke).outer.number = select(none, outer.number, outer_covers);
    let inner = (*stroke).inner;
    let is_inner = inner.number > none;
    let inner_covers = brush_covers(brush, is_inner, inner.disc, inner.way, across(inner.side, inner.ratio), first_sample);
    (*stroke).inner.number = select(none, inner.number, inner_covers);
    (*stroke).bare |= is_inner & !inner_covers;
}

fn higher_paint(below: Paint, above: Paint) -> Paint {
    let is_there = above.number > vec4<u32>(0u);
    return Paint(
        select(below.number, above.number, is_there),
        select(below.ratio, above.ratio, is_there),
        select(below.disc, above.disc, is_there),
        select(below.way, above.way, is_there),
        select(below.side, above.side, is_there),
        select(below.side_ratio, above.side_ratio, is_there),
    );
}

/// A strand with one more of its strokes, which is higher than those before; or with its clump.
fn with_stroke(strand: Strand, stroke: Strand) -> Strand {
    let in_clump = stroke.depth > vec4<f32>(NOTHING);
    let is_outer = stroke.outer.number > vec4<u32>(0u);
    return Strand(
        select(strand.depth, stroke.depth, in_clump),
        select(strand.biased, stroke.biased, in_clump),
        select(strand.ratio, stroke.ratio, in_clump),
        select(strand.side, stroke.side, in_clump),
        select(strand.side_ratio, stroke.side_ratio, in_clump),
        select(strand.outer_depth, stroke.outer_depth, is_outer),
        select(strand.outer_biased, stroke.outer_biased, is_outer),
        higher_paint(strand.outer, stroke.outer),
        higher_paint(strand.inner, stroke.inner),
        strand.bare | stroke.bare,
    );
}

/// Puts a finished strand into the picture.
fn compose(samples: ptr<function, Samples>, strand: Strand, number: u32) {
    let nothing = vec4<f32>(NOTHING);
    let in_clump = strand.depth > nothing;
    var is_outer = strand.outer.number > vec4<u32>(0u);
    if (BRUSHED) {
        // Outlines don't show where what they are around is left bare.
        is_outer = is_outer & !(in_clump & strand.bare);
    }
    let is_inner = in_clump & (strand.inner.number > vec4<u32>(0u));
    let is_drawn = is_inner | is_outer;
    if (!any(is_drawn)) {
        return;
    }
    var depth = select(strand.outer_depth, strand.depth, in_clump);
    var biased = select(strand.outer_biased, strand.biased, in_clump);
    if (ORDER == ROUNDED) {
        let ratio = min(select(strand.outer.ratio, strand.ratio, in_clump), vec4<f32>(1.0));
        let squared = ratio * ratio;
        let part = select(squared * squared, ratio, in_clump);
        depth = deeper(depth, gpu_frame.edge_depth_m * part);
        biased = deeper(biased, gpu_frame.edge_depth_m * part);
    }
    let stroke = select(vec4<u32>(0u), strand.outer.number, ORDER == SHIFTED);
    let wins = is_drawn & shows(*samples, depth, biased, stroke, number);
    if (!any(wins)) {
        return;
    }
    (*samples).stroke = select((*samples).stroke, stroke, wins);
    (*samples).owner = select((*samples).owner, vec4<u32>(number), wins);
    (*samples).strand = select((*samples).strand, depth, wins);
    let shown = select(strand.outer.number, strand.inner.number, is_inner);
    (*samples).is_outline = select((*samples).is_outline, shown <= vec4<u32>(gpu_frame.outlines), wins);
    let disc = select(strand.outer.disc, strand.inner.disc, is_inner);
    let way = select(strand.outer.way, strand.inner.way, is_inner);
    set_colors(samples, disc, way, wins);
    if (TELLS) {
        let v = across(
            select(strand.outer.side, strand.inner.side, is_inner),
            select(strand.outer.ratio, strand.inner.ratio, is_inner),
        );
        // Outside of the clump, or where there is none.
        var w = v;
        if (ORDER != SHIFTED) {
            let outside = select(vec4<f32>(1.0), vec4<f32>(-1.0), v < vec4<f32>(0.0));
            w = select(outside, across(strand.side, strand.ratio), in_clump);
        }
        (*samples).disc = select((*samples).disc, disc, wins);
        (*samples).way = select((*samples).way, way, wins);
        (*samples).v = select((*samples).v, v, wins);
        (*samples).w = select((*samples).w, w, wins);
    }
}
