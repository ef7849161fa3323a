// Decals: strokes that are drawn on what is seen without them, as told at render::Decal. Composed with tiles.wgsl; the CPU's is
// crates/render/src/cpu/decals.rs.

/// A decal's record in the tables: what it is, its reach (m), the marks of the surfaces that it is drawn on.
const DECAL_REACH: u32 = 1u;
const DECAL_MARKS: u32 = 2u;
/// Where its brush's record begins, 0 of one that is whole.
const DECAL_BRUSH: u32 = 3u;
const DECAL_ON_HAIR: u32 = 1u;
const DECAL_IS_SHADOW: u32 = 2u;

/// The highest decals that fit the samples so far.
struct Decals {
    /// Of its stroke, 0 where there is none, and of its strand: among equals the lower one lies on top.
    number: vec4<u32>,
    strand: vec4<u32>,
    ratio: vec4<f32>,
    disc: vec4<u32>,
    way: vec4<f32>,
    is_shadow: vec4<bool>,
    /// Where `BRUSHED`, as those of a `Paint`.
    side: vec4<f32>,
    side_ratio: vec4<f32>,
}

fn no_decals() -> Decals {
    let none = vec4<u32>(0u);
    let far = vec4<f32>(FAR_RATIO);
    return Decals(none, none, far, none, vec4<f32>(0.0), vec4<bool>(false), vec4<f32>(1.0), far);
}

/// Takes from one stroke of a decal, with that record, what its brush leaves bare.
fn thin_decals(own: ptr<function, Decals>, record: u32, first_sample: u32) {
    if (record == 0u || tables[record + DECAL_BRUSH] == 0u) {
        return;
    }
    let brush = tables[record + DECAL_BRUSH];
    let at = *own;
    let none = vec4<u32>(0u);
    let covers = brush_covers(brush, at.number > none, at.disc, at.way, across(at.side, at.ratio), first_sample);
    (*own).number = select(none, at.number, covers);
}

/// For each sample the one that lies above.
fn higher_decals(a: Decals, b: Decals) -> Decals {
    let is_higher = (b.number > a.number) | ((b.number == a.number) & (b.strand < a.strand));
    let wins = is_higher & (b.number > vec4<u32>(0u));
    return Decals(
        select(a.number, b.number, wins),
        select(a.strand, b.strand, wins),
        select(a.ratio, b.ratio, wins),
        select(a.disc, b.disc, wins),
        select(a.way, b.way, wins),
        select(a.is_shadow, b.is_shadow, wins),
        select(a.side, b.side, wins),
        select(a.side_ratio, b.side_ratio, wins),
    );
}

fn draw_decals(
    tile: vec2<f32>,
    at: u32,
    local: u32,
    pixel: vec2<f32>,
    x: vec4<f32>,
    y: vec4<f32>,
    first_sample: u32,
    samples: ptr<function, Samples>,
) {
    let marks = marks_of(*samples);
    var decals = no_decals();
    let found = find_list(at, 0u, gpu_frame.chunk_capacity, gpu_frame.chunks, local);
    var walk = begin_walk(found, BRUSHED, true);
    // Where `BRUSHED` one stroke of a strand at a time: its strand, number and record.
    var own = no_decals();
    var key = vec3<u32>(0u);
    while (walk.next < found.y) {
        if (local < BATCH / 32u) {
            atomicStore(&reaching[local], 0u);
        }
        workgroupBarrier();
        let looked = walk_batch(&walk, found, local, tile);
        if (looked.seen.is_there) {
            atomicOr(&reaching[local / 32u], 1u << (local % 32u));
        }
        workgroupBarrier();
        if (looked.seen.is_there) {
            store(slot_of(local), looked.seen.segment);
        }
        workgroupBarrier();
        let count = reaching_count();
        for (var slot = 0u; slot < count; slot++) {
            if (is_beside(slot, pixel)) {
                continue;
            }
            let segment = segment_in(slot);
            if (BRUSHED) {
                let next_key = vec3<u32>(segment.strand, segment.number, segment.record);
                if (any(next_key != key)) {
                    thin_decals(&own, key.z, first_sample);
                    decals = higher_decals(decals, own);
                    own = no_decals();
                    key = next_key;
                }
                add_decal(&own, *samples, marks, segment, x, y, first_sample);
            } else {
                add_decal(&decals, *samples, marks, segment, x, y, first_sample);
            }
        }
        workgroupBarrier();
    }
    if (BRUSHED) {
        thin_decals(&own, key.z, first_sample);
        decals = higher_decals(decals, own);
    }
    for (var k = 0u; k < 4u; k++) {
        if (decals.number[k] == 0u) {
            continue;
        }
        var color = vec3<f32>((*samples).red[k], (*samples).green[k], (*samples).blue[k]);
        if (decals.is_shadow[k] && (*samples).strand[k] <= NOTHING) {
            color = shaded(color, (*samples).triangle[k], tile, vec2<f32>(x[k], y[k]));
            (*samples).decal[k] = DECAL_SHADES;
        } else {
            color = color_of(decals.disc[k], decals.way[k]);
            (*samples).decal[k] = DECAL_COLORS;
        }
        (*samples).red[k] = color.x;
        (*samples).green[k] = color.y;
        (*samples).blue[k] = color.z;
    }
}

/// The marks of the surfaces behind the samples' hair.
fn marks_of(samples: Samples) -> vec4<u32> {
    var marks = vec4<u32>(0u);
    for (var k = 0u; k < 4u; k++) {
        if (samples.surface[k] > NOTHING) {
            let surface = triangles[samples.triangle[k]].surface;
            marks[k] = tables[gpu_frame.surfaces_at + SURFACE_WORDS * surface + SURFACE_MARKS];
        }
    }
    return marks;
}

/// A number that pieces of one strand have in common.
fn whole_strand(strand: u32) -> u32 {
    let at = gpu_frame.same_strands_at;
    if (at == 0u || strand >= tables[at]) {
        return strand;
    }
    return tables[at + 1u + strand];
}

/// The part of a decal's reach within which each of four samples shows it, as crate::drawing::shown_reach.
fn shown_reach(first_sample: u32) -> vec4<f32> {
    let mixed = (vec4<u32>(first_sample) + vec4<u32>(0u, 1u, 2u, 3u)) * 0x9E3779B9u;
    let part = vec4<f32>(mixed >> vec4<u32>(8u)) / 16777216.0;
    return 0.5 + 0.5 * select(part, vec4<f32>(0.5), gpu_frame.samples == 1u);
}

/// Adds a segment to the decals.
fn add_decal(
    decals: ptr<function, Decals>,
    samples: Samples,
    marks: vec4<u32>,
    s: Segment,
    x: vec4<f32>,
    y: vec4<f32>,
    first_sample: u32,
) {
    let p = local_of(s.sweep, x, y);
    let covered = covers(s.sweep, p);
    if (!any(covered)) {
        return;
    }
    let at = nearest(s.sweep, p);
    let means = tables[s.record];
    let is_shadow = (means & DECAL_IS_SHADOW) != 0u;
    let on_surface = (marks & vec4<u32>(tables[s.record + DECAL_MARKS])) != vec4<u32>(0u);
    let is_hair = samples.strand > vec4<f32>(NOTHING);
    let is_target = select(on_surface, vec4<bool>((means & DECAL_ON_HAIR) != 0u), is_hair);
    let depth = s.inv_depth.x + at.u * s.inv_depth.y;
    let seen = select(samples.surface, samples.strand, is_hair);
    // How far the seen lies behind, and the reach, both times the inverse depths.
    let behind = depth - seen;
    let shown = select(shown_reach(first_sample), vec4<f32>(1.0), is_shadow);
    let reach = shown * table(s.record + DECAL_REACH) * (depth * seen);
    let is_near = (behind <= reach) & (behind >= -reach);
    let is_in_shadow = select(behind >= -reach, behind > reach, is_hair);
    var fits = covered & is_target & select(is_near, is_in_shadow, vec4<bool>(is_shadow)) & (depth > vec4<f32>(0.0));
    if (!any(fits)) {
        return;
    }
    if (is_shadow) {
        let own = whole_strand(s.strand);
        for (var k = 0u; k < 4u; k++) {
            fits[k] = fits[k] && !(is_hair[k] && (samples.is_outline[k] || whole_strand(samples.owner[k]) == own));
        }
    }
    let number = vec4<u32>(s.number);
    let strand = vec4<u32>(s.strand);
    let is_as_high = number == (*decals).number;
    let is_higher = (number > (*decals).number) | (is_as_high & (strand < (*decals).strand));
    let is_same = is_as_high & (strand == (*decals).strand);
    let wins = fits & (is_higher | (is_same & (at.ratio < (*decals).ratio)));
    (*decals).number = select((*decals).number, number, wins);
    (*decals).strand = select((*decals).strand, strand, wins);
    (*decals).ratio = select((*decals).ratio, at.ratio, wins);
    (*decals).disc = select((*decals).disc, vec4<u32>(s.disc), wins);
    (*decals).way = select((*decals).way, s.way.x + at.u * s.way.y, wins);
    (*decals).is_shadow = select((*decals).is_shadow, vec4<bool>(is_shadow), wins);
    if (BRUSHED) {
        let tells_side = fits & (is_higher | (is_same & (at.ratio < (*decals).side_ratio * NEARER)));
        (*decals).side = select((*decals).side, side_of(s, p), tells_side);
        (*decals).side_ratio = select((*decals).side_ratio, at.ratio, tells_side);
    }
}

/// The colour that a triangle has in shadow where it is drawn in another.
fn shaded(color: vec3<f32>, index: u32, tile: vec2<f32>, at: vec2<f32>) -> vec3<f32> {
    let surface = gpu_frame.surfaces_at + SURFACE_WORDS * triangles[index].surface;
    let light = vec3<f32>(table(surface), table(surface + 1u), table(surface + 2u));
    let shadow = vec3<f32>(table(surface + 3u), table(surface + 4u), table(surface + 5u));
    if (!TEXTURED || tables[surface + SURFACE_PICTURE] == 0u) {
        return shadow;
    }
    // What is lit is its texel times the colour in light.
    let placed = place(index, tile);
    let tone = clamp(dot(placed.tone, vec3<f32>(1.0, at)), placed.tone_range.x, placed.tone_range.y);
    let factor = select(vec3<f32>(1.0), shadow / max(light, vec3<f32>(1e-30)), light > vec3<f32>(0.0));
    return select(color, color * factor, tone >= 0.0);
}
