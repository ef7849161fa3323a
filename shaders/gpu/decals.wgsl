// Decals: strokes that are drawn on what is seen without them, as told at render::Decal. Composed with tiles.wgsl; the CPU's is
// crates/render/src/cpu/decals.rs.

/// A decal's record in the tables: what it is, its reach (m), the marks of the surfaces that it is drawn on.
const DECAL_REACH: u32 = 1u;
const DECAL_MARKS: u32 = 2u;
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
}

fn draw_decals(tile: vec2<f32>, at: u32, local: u32, pixel: vec2<f32>, x: vec4<f32>, y: vec4<f32>, samples: ptr<function, Samples>) {
    let marks = marks_of(*samples);
    let none = vec4<u32>(0u);
    var decals = Decals(none, none, vec4<f32>(FAR_RATIO), none, vec4<f32>(0.0), vec4<bool>(false));
    let found = find_list(at, 0u, gpu_frame.chunk_capacity, gpu_frame.chunks, local);
    // The next thing to look at: an entry, and a segment of it, counted on through its strokes.
    var next = 0u;
    var item = 0u;
    while (next < found.y) {
        if (local < BATCH / 32u) {
            atomicStore(&reaching[local], 0u);
        }
        workgroupBarrier();
        var seen: Found;
        var offset = 0u;
        while (next < found.y && offset < BATCH) {
            let chunk = chunks[entry(found, next)];
            let places = max(chunk.segments, 1u);
            let items = places * tables[2u * chunk.strokes + 1u];
            let taken = min(items - item, BATCH - offset);
            if (local >= offset && local < offset + taken) {
                let own = item + local - offset;
                seen = look_at(chunk, own / places, own % places, tile, true);
            }
            offset += taken;
            item += taken;
            if (item < items) {
                continue;
            }
            item = 0u;
            next++;
        }
        if (seen.is_there) {
            atomicOr(&reaching[local / 32u], 1u << (local % 32u));
        }
        workgroupBarrier();
        if (seen.is_there) {
            store(slot_of(local), seen.segment);
        }
        workgroupBarrier();
        let count = reaching_count();
        for (var slot = 0u; slot < count; slot++) {
            if (!is_beside(slot, pixel)) {
                add_decal(&decals, *samples, marks, segment_in(slot), x, y);
            }
        }
        workgroupBarrier();
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

/// Adds a segment to the decals.
fn add_decal(decals: ptr<function, Decals>, samples: Samples, marks: vec4<u32>, s: Segment, x: vec4<f32>, y: vec4<f32>) {
    let p = local_of(s.sweep, x, y);
    let covered = covers(s.sweep, p);
    if (!any(covered)) {
        return;
    }
    let at = nearest(s.sweep, p);
    let means = tables[s.decal];
    let is_shadow = (means & DECAL_IS_SHADOW) != 0u;
    let on_surface = (marks & vec4<u32>(tables[s.decal + DECAL_MARKS])) != vec4<u32>(0u);
    let is_hair = samples.strand > vec4<f32>(NOTHING);
    let is_target = select(on_surface, vec4<bool>((means & DECAL_ON_HAIR) != 0u), is_hair);
    let depth = s.inv_depth.x + at.u * s.inv_depth.y;
    let seen = select(samples.surface, samples.strand, is_hair);
    // How far the seen lies behind, and the reach, both times the inverse depths.
    let behind = depth - seen;
    let reach = table(s.decal + DECAL_REACH) * (depth * seen);
    let is_near = (behind <= reach) & (behind >= -reach);
    let is_in_shadow = select(behind >= -reach, behind > reach, is_hair);
    var fits = covered & is_target & select(is_near, is_in_shadow, vec4<bool>(is_shadow)) & (depth > vec4<f32>(0.0));
    if (!any(fits)) {
        return;
    }
    if (is_shadow) {
        let own = whole_strand(s.strand);
        for (var k = 0u; k < 4u; k++) {
            fits[k] = fits[k] && !(is_hair[k] && whole_strand(samples.owner[k]) == own);
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
