// Segments of strokes as a tile sees them: what of a chunk reaches it, and how that is kept in the batch. Composed with
// tiles.wgsl.

/// A segment's ends as they are seen from the tile: the larger disc first.
struct Segment {
    sweep: Sweep,
    /// At u = 0 and its rise to u = 1.
    inv_depth: vec2<f32>,
    biased: vec2<f32>,
    /// The way from the stroke's joint to the next at u = 0, and its rise.
    way: vec2<f32>,
    disc: u32,
    /// Stroke number, 0 for the clump; whether it is clipped; the strand.
    number: u32,
    is_clipped: bool,
    strand: u32,
    /// The record of a decal, or of a brush; 0 of others.
    record: u32,
}

fn store(slot: u32, s: Segment) {
    let at = 6u * slot;
    let end = s.sweep.origin + s.sweep.axis * s.sweep.length;
    boxes[slot] = vec4<f32>(
        min(s.sweep.origin - s.sweep.radius, end - s.sweep.smaller_radius) - 0.01,
        max(s.sweep.origin + s.sweep.radius, end + s.sweep.smaller_radius) + 0.01,
    );
    batch[at] = vec4<f32>(s.sweep.origin, s.sweep.axis);
    batch[at + 1u] = vec4<f32>(s.sweep.length, s.sweep.inv_length, s.sweep.radius, s.sweep.smaller_radius);
    batch[at + 2u] = vec4<f32>(s.sweep.shrink, s.sweep.a, s.sweep.inv_a, s.sweep.beyond_apex);
    batch[at + 3u] = vec4<f32>(s.sweep.body_end, s.sweep.flat_end, s.way);
    batch[at + 4u] = vec4<f32>(s.inv_depth, s.biased);
    let number = 2u * s.number + select(0u, 1u, s.is_clipped);
    batch[at + 5u] = bitcast<vec4<f32>>(vec4<u32>(s.disc, number, s.strand, s.record) + KEEPS_BITS);
}

/// Added to whole numbers that pass as floating point ones: as such they are normal numbers, whose bits no processor
/// changes. Less than 2^30 of them are told apart.
const KEEPS_BITS: vec4<u32> = vec4<u32>(0x20000000u);

fn segment_in(slot: u32) -> Segment {
    let at = 6u * slot;
    let v0 = batch[at];
    let v1 = batch[at + 1u];
    let v2 = batch[at + 2u];
    let v3 = batch[at + 3u];
    let v4 = batch[at + 4u];
    let v5 = bitcast<vec4<u32>>(batch[at + 5u]) - KEEPS_BITS;
    let swept = Sweep(v0.xy, v0.zw, v1.x, v1.y, v1.z, v1.w, v2.x, v2.y, v2.z, v2.w, v3.x, v3.y);
    return Segment(swept, v4.xy, v4.zw, v3.zw, v5.x, v5.y >> 1u, (v5.y & 1u) != 0u, v5.z, v5.w);
}

/// The part of a segment between two discs whose discs can touch the picture, seen from the tile; nothing where `z` is
/// above `w`. So strokes may reach far outside the screen.
fn visible_part(a: vec3<f32>, b: vec3<f32>, tile: vec2<f32>) -> vec2<f32> {
    let low = -tile - 1.0;
    let high = vec2<f32>(gpu_frame.size) - tile + 1.0;
    let at_a = vec4<f32>(a.xy - low, high - a.xy) + a.z;
    let at_b = vec4<f32>(b.xy - low, high - b.xy) + b.z;
    var part = vec2<f32>(0.0, 1.0);
    for (var k = 0u; k < 4u; k++) {
        if (at_a[k] < 0.0 && at_b[k] < 0.0) {
            return vec2<f32>(1.0, 0.0);
        } else if (at_a[k] < 0.0) {
            part.x = max(part.x, at_a[k] / (at_a[k] - at_b[k]));
        } else if (at_b[k] < 0.0) {
            part.y = min(part.y, at_a[k] / (at_a[k] - at_b[k]));
        }
    }
    return part;
}

/// Whether the box around two discs touches the tile.
fn touches(a: vec3<f32>, b: vec3<f32>) -> bool {
    let low = min(a.xy - a.z, b.xy - b.z);
    let high = max(a.xy + a.z, b.xy + b.z);
    return all(low <= vec2<f32>(f32(TILE) + 0.02)) && all(high >= vec2<f32>(-0.02));
}

struct Found {
    is_there: bool,
    segment: Segment,
}

/// Looks at one of a chunk's segments, of the stroke at that place in its list.
fn look_at(chunk: Chunk, in_list: u32, place: u32, tile: vec2<f32>) -> Found {
    var found: Found;
    let stroke = tables[tables[LIST_WORDS * chunk.strokes] + in_list];
    if (stroke == NO_STROKE) {
        return found;
    }
    let number = tables[stroke + STROKE_NUMBER];
    if (ORDER == SHIFTED && number == 0u) {
        return found;
    }
    let first = tables[stroke + STROKE_FIRST_DISC] + chunk.first_joint + place;
    // One joint alone is a segment from itself to itself.
    let next = first + min(chunk.segments, 1u);
    let a = discs[first];
    let b = discs[next];
    if (max(a.radius, b.radius) <= 0.0) {
        return found;
    }
    let first_disc = vec3<f32>(a.center - tile, a.radius);
    let second_disc = vec3<f32>(b.center - tile, b.radius);
    if (!touches(first_disc, second_disc)) {
        return found;
    }
    let part = visible_part(first_disc, second_disc, tile);
    if (part.x > part.y) {
        return found;
    }
    var start = first_disc;
    var end = second_disc;
    if (part.x > 0.0) { start = mix(first_disc, second_disc, part.x); }
    if (part.y < 1.0) { end = mix(first_disc, second_disc, part.y); }
    let runs_to_smaller = a.radius >= b.radius;
    var way = part;
    if (!runs_to_smaller) {
        way = part.yx;
        let other = start;
        start = end;
        end = other;
    }
    if (start.z <= 0.0) {
        return found;
    }
    let flat_end = select(0.0, select(2.0, 1.0, runs_to_smaller), gpu_frame.is_semicircle != 0u);
    let depths = a.inv_depth + way * (b.inv_depth - a.inv_depth);
    let biased = a.biased + way * (b.biased - a.biased);
    found.is_there = true;
    found.segment = Segment(
        sweep(start, max(end.z, 0.0), (way.y - way.x) * (b.center - a.center), flat_end),
        vec2<f32>(depths.x, depths.y - depths.x),
        vec2<f32>(biased.x, biased.y - biased.x),
        vec2<f32>(way.x, way.y - way.x),
        first,
        number,
        ORDER != SHIFTED && tables[stroke + STROKE_IS_CLIPPED] != 0u,
        chunk.strand,
        tables[stroke + STROKE_RECORD],
    );
    return found;
}
