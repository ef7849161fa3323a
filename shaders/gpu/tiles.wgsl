// Draws the tiles: a workgroup a tile, an invocation a pixel, four samples of it at a time. What each sample shows is
// told at render::Order; ORDER is written before this text.
//
// All invocations together look at a batch of a tile's triangles or segments, each at one, and keep what
// reaches the tile, ready to be drawn, in the memory that they share. Then each draws them all into its own samples.

struct Surface {
    light: vec3<f32>,
    shadow: vec3<f32>,
    margin: f32,
}

@group(0) @binding(6) var<storage, read> starts: array<u32>;
@group(0) @binding(7) var<storage, read> entries: array<u32>;
/// Means of the pixels, or all their samples: see `write_pixel`.
@group(0) @binding(8) var<storage, read_write> picture: array<vec4<f32>>;
/// Where samples lie in their pixel: two in each.
@group(0) @binding(9) var<uniform> sample_places: array<vec4<f32>, 128>;

const ROUNDED: u32 = 0u;
const SCATTERED: u32 = 1u;
const STRAND_FIRST: u32 = 2u;
const SHIFTED: u32 = 3u;

/// Segments between two joints that a chunk has at most.
const CHUNK: u32 = 8u;
/// Things that are looked at in one go.
const BATCH: u32 = 64u;
/// Stands for the inverse depth of nothing.
const NOTHING: f32 = -3e38;
const FAR_RATIO: f32 = 3e38;

/// A batch's things that reach the tile: for each its box, then six vectors.
var<workgroup> boxes: array<vec4<f32>, BATCH>;
var<workgroup> batch: array<vec4<f32>, 6u * BATCH>;
/// Nothing of a segment's strand is nearer in this tile, 1/m.
var<workgroup> nearest_of: array<f32, BATCH>;
/// A bit for each thing of the batch: whether it reaches the tile.
var<workgroup> reaching: array<atomic<u32>, BATCH / 32u>;
/// Whether anything that is still to come may show somewhere.
var<workgroup> open_pixels: atomic<u32>;
var<workgroup> is_open: u32;
/// The tile's list: its first entry and its length; all there is, where the list has no room.
var<workgroup> list: vec3<u32>;

/// What each sample shows so far.
struct Samples {
    /// Nearest surface, 1/m.
    surface: vec4<f32>,
    surface_margin: vec4<f32>,
    /// Which triangle it is.
    triangle: vec4<u32>,
    /// Nearest strand that no surface hides, 1/m.
    strand: vec4<f32>,
    /// In `SHIFTED` the number of its stroke: the higher lies on top of what is as near.
    number: vec4<u32>,
    red: vec4<f32>,
    green: vec4<f32>,
    blue: vec4<f32>,
}

/// A stroke's colour at the samples: the joint's disc that it begins at, and the way to the next.
struct Paint {
    number: vec4<u32>,
    ratio: vec4<f32>,
    disc: vec4<u32>,
    way: vec4<f32>,
}

/// One strand at the samples; in `SHIFTED`, where strokes are on their own, one of its strokes, as `outer`.
struct Strand {
    /// Its clump.
    depth: vec4<f32>,
    biased: vec4<f32>,
    ratio: vec4<f32>,
    /// The highest stroke that shows outside the clump too, with its own depth.
    outer_depth: vec4<f32>,
    outer_biased: vec4<f32>,
    outer: Paint,
    /// The highest stroke that is clipped to the clump.
    inner: Paint,
}

fn no_paint() -> Paint {
    return Paint(vec4<u32>(0u), vec4<f32>(FAR_RATIO), vec4<u32>(0u), vec4<f32>(0.0));
}

fn no_strand() -> Strand {
    let nothing = vec4<f32>(NOTHING);
    return Strand(nothing, nothing, vec4<f32>(1.0), nothing, nothing, no_paint(), no_paint());
}

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
    batch[at + 5u] = bitcast<vec4<f32>>(vec4<u32>(s.disc, number, s.strand, 0u) + KEEPS_BITS);
}

/// Added to whole numbers that pass as floating point ones: as such they are normal numbers, whose bits no processor
/// changes. Less than 2^30 of them are told apart.
const KEEPS_BITS: vec4<u32> = vec4<u32>(0x20000000u);

/// Whether a pixel of the tile is outside of a kept thing's box: most are, and that is all they need to know.
fn is_beside(slot: u32, pixel: vec2<f32>) -> bool {
    let box = boxes[slot];
    return pixel.x > box.z || pixel.y > box.w || pixel.x + 1.0 < box.x || pixel.y + 1.0 < box.y;
}

fn segment_in(slot: u32) -> Segment {
    let at = 6u * slot;
    let v0 = batch[at];
    let v1 = batch[at + 1u];
    let v2 = batch[at + 2u];
    let v3 = batch[at + 3u];
    let v4 = batch[at + 4u];
    let v5 = bitcast<vec4<u32>>(batch[at + 5u]) - KEEPS_BITS;
    let swept = Sweep(v0.xy, v0.zw, v1.x, v1.y, v1.z, v1.w, v2.x, v2.y, v2.z, v2.w, v3.x, v3.y);
    return Segment(swept, v4.xy, v4.zw, v3.zw, v5.x, v5.y >> 1u, (v5.y & 1u) != 0u, v5.z);
}

/// The inverse depth of what lies so many metres deeper. There is nothing deeper than 0 or below.
fn deeper(inv_depth: vec4<f32>, metres: vec4<f32>) -> vec4<f32> {
    return inv_depth / (1.0 + metres * max(inv_depth, vec4<f32>(0.0)));
}

/// render::scatter
fn scatter(strand: u32, sample: u32) -> f32 {
    var mixed = (strand ^ (strand >> 16u)) * 0x45d9f3b5u;
    mixed = (mixed ^ (mixed >> 15u)) * 0x2c1b3c6du;
    return f32((mixed + sample * 0x9e3779b9u) >> 8u) / 16777216.0;
}

// ---- What reaches the tile

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
    let stroke = tables[tables[2u * chunk.strokes] + in_list];
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
        sweep(start, vec3<f32>(end.xy, max(end.z, 0.0)), flat_end),
        vec2<f32>(depths.x, depths.y - depths.x),
        vec2<f32>(biased.x, biased.y - biased.x),
        vec2<f32>(way.x, way.y - way.x),
        first,
        number,
        ORDER != SHIFTED && tables[stroke + STROKE_IS_CLIPPED] != 0u,
        chunk.strand,
    );
    return found;
}

/// Where a thing of the batch that reaches the tile is kept: those before it come first.
fn slot_of(local: u32) -> u32 {
    var slot = countOneBits(atomicLoad(&reaching[local / 32u]) & ((1u << (local % 32u)) - 1u));
    for (var word = 0u; word < local / 32u; word++) {
        slot += countOneBits(atomicLoad(&reaching[word]));
    }
    return slot;
}

fn reaching_count() -> u32 {
    var sum = 0u;
    for (var word = 0u; word < BATCH / 32u; word++) {
        sum += countOneBits(atomicLoad(&reaching[word]));
    }
    return sum;
}

// ---- Surfaces

/// A triangle seen from the tile: for each edge its value at the corner and its slopes, then depth and tone.
struct Placed {
    is_there: bool,
    box: vec4<f32>,
    edges: array<vec3<f32>, 3>,
    depth: vec3<f32>,
    depth_range: vec2<f32>,
    tone: vec3<f32>,
    tone_range: vec2<f32>,
    surface: u32,
}

/// The signed, doubled area between an edge and a point, worked out from the same end for both triangles at an edge, so that
/// their values are exactly opposite, and no sample between them is lost.
fn edge(start: vec2<f32>, end: vec2<f32>) -> vec3<f32> {
    let is_turned = end.x < start.x || (end.x == start.x && end.y < start.y);
    let low = select(start, end, is_turned);
    let along = select(end, start, is_turned) - low;
    let area = vec3<f32>(along.y * low.x - along.x * low.y, -along.y, along.x);
    return select(area, -area, is_turned);
}

fn place(index: u32, tile: vec2<f32>) -> Placed {
    var placed: Placed;
    let triangle = triangles[index];
    let a = corners[triangle.corners.x];
    let b = corners[triangle.corners.y];
    let c = corners[triangle.corners.z];
    let pa = a.position - tile;
    let pb = b.position - tile;
    let pc = c.position - tile;
    let low = min(min(pa, pb), pc);
    let high = max(max(pa, pb), pc);
    if (!(all(low <= vec2<f32>(f32(TILE))) && all(high >= vec2<f32>(0.0)))) {
        return placed;
    }
    let ab = pb - pa;
    let ac = pc - pa;
    let area = ab.x * ac.y - ab.y * ac.x;
    if (area == 0.0) {
        return placed;
    }
    let edges = array<vec3<f32>, 3>(edge(pb, pc), edge(pc, pa), edge(pa, pb));
    placed.is_there = true;
    placed.box = vec4<f32>(low, high);
    placed.depth = (a.inv_depth * edges[0] + b.inv_depth * edges[1] + c.inv_depth * edges[2]) / area;
    placed.tone = (a.tone * edges[0] + b.tone * edges[1] + c.tone * edges[2]) / area;
    let side = sign(area);
    placed.edges = array<vec3<f32>, 3>(side * edges[0], side * edges[1], side * edges[2]);
    placed.depth_range = vec2<f32>(min(min(a.inv_depth, b.inv_depth), c.inv_depth), max(max(a.inv_depth, b.inv_depth), c.inv_depth));
    placed.tone_range = vec2<f32>(min(min(a.tone, b.tone), c.tone), max(max(a.tone, b.tone), c.tone));
    placed.surface = triangle.surface;
    return placed;
}

fn store_triangle(slot: u32, t: Placed, index: u32) {
    let at = 6u * slot;
    boxes[slot] = t.box;
    batch[at] = vec4<f32>(t.edges[0], t.depth_range.x);
    batch[at + 1u] = vec4<f32>(t.edges[1], t.depth_range.y);
    batch[at + 2u] = vec4<f32>(t.edges[2], t.tone_range.x);
    batch[at + 3u] = vec4<f32>(t.depth, t.tone_range.y);
    batch[at + 4u] = vec4<f32>(t.tone, 0.0);
    batch[at + 5u] = bitcast<vec4<f32>>(vec4<u32>(index, t.surface, 0u, 0u) + KEEPS_BITS);
}

fn on_slope(slope: vec3<f32>, x: vec4<f32>, y: vec4<f32>) -> vec4<f32> {
    return slope.x + x * slope.y + y * slope.z;
}

fn draw_triangle(slot: u32, x: vec4<f32>, y: vec4<f32>, samples: ptr<function, Samples>) {
    let at = 6u * slot;
    let v0 = batch[at];
    let v1 = batch[at + 1u];
    let v2 = batch[at + 2u];
    let zero = vec4<f32>(0.0);
    let is_inside = (on_slope(v0.xyz, x, y) >= zero) & (on_slope(v1.xyz, x, y) >= zero) & (on_slope(v2.xyz, x, y) >= zero);
    if (!any(is_inside)) {
        return;
    }
    let v3 = batch[at + 3u];
    let v4 = batch[at + 4u];
    let v5 = bitcast<vec4<u32>>(batch[at + 5u]) - KEEPS_BITS;
    let depth = clamp(on_slope(v3.xyz, x, y), vec4<f32>(v0.w), vec4<f32>(v1.w));
    let tone = clamp(on_slope(v4.xyz, x, y), vec4<f32>(v2.w), vec4<f32>(v3.w));
    // Of two that are as near the first wins, in whatever order they come.
    let is_first = (depth == (*samples).surface) & (vec4<u32>(v5.x) < (*samples).triangle);
    let wins = is_inside & ((depth > (*samples).surface) | is_first);
    let surface = gpu_frame.surfaces_at + SURFACE_WORDS * v5.y;
    let is_lit = tone >= zero;
    (*samples).surface = select((*samples).surface, depth, wins);
    (*samples).triangle = select((*samples).triangle, vec4<u32>(v5.x), wins);
    (*samples).surface_margin = select((*samples).surface_margin, vec4<f32>(table(surface + 6u)), wins);
    (*samples).red = select((*samples).red, select(vec4<f32>(table(surface + 3u)), vec4<f32>(table(surface)), is_lit), wins);
    (*samples).green = select((*samples).green, select(vec4<f32>(table(surface + 4u)), vec4<f32>(table(surface + 1u)), is_lit), wins);
    (*samples).blue = select((*samples).blue, select(vec4<f32>(table(surface + 5u)), vec4<f32>(table(surface + 2u)), is_lit), wins);
}

fn table(at: u32) -> f32 {
    return bitcast<f32>(tables[at]);
}

// ---- Strands

fn paint(p: ptr<function, Paint>, s: Segment, at: Nearest, covered: vec4<bool>) -> vec4<bool> {
    let number = vec4<u32>(s.number);
    let is_higher = covered & (number > (*p).number);
    let is_nearer = is_higher | (covered & (number == (*p).number) & (at.ratio < (*p).ratio));
    (*p).number = select((*p).number, number, is_higher);
    (*p).ratio = select((*p).ratio, at.ratio, is_nearer);
    (*p).disc = select((*p).disc, vec4<u32>(s.disc), is_nearer);
    (*p).way = select((*p).way, s.way.x + at.u * s.way.y, is_nearer);
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
        (*strand).ratio = select((*strand).ratio, min((*strand).ratio, at.ratio), covered);
    } else if (s.is_clipped) {
        // A copy, because a pointer to a part of what a pointer points to is not for every compiler.
        var inner = (*strand).inner;
        paint(&inner, s, at, covered);
        (*strand).inner = inner;
    } else {
        let part = interval(s.sweep, p);
        let depth = max(s.inv_depth.x + part.low * s.inv_depth.y, s.inv_depth.x + part.high * s.inv_depth.y);
        let biased = max(s.biased.x + part.low * s.biased.y, s.biased.x + part.high * s.biased.y);
        let is_same = covered & (vec4<u32>(s.number) == (*strand).outer.number);
        var outer_paint = (*strand).outer;
        let is_higher = paint(&outer_paint, s, at, covered);
        (*strand).outer = outer_paint;
        let outer = (*strand).outer_depth;
        (*strand).outer_depth = select(select(outer, max(outer, depth), is_same), depth, is_higher);
        let outer_biased = (*strand).outer_biased;
        (*strand).outer_biased = select(select(outer_biased, max(outer_biased, biased), is_same), biased, is_higher);
    }
}

/// Where a strand of that depth shows: before surfaces, and nearer than what is there.
fn shows(samples: Samples, depth: vec4<f32>, biased: vec4<f32>, number: vec4<u32>) -> vec4<bool> {
    let before_wall = depth / (1.0 + samples.surface_margin * depth);
    let against = select(biased, before_wall, samples.surface_margin != vec4<f32>(0.0));
    let is_on_top = (depth == samples.strand) & (number > samples.number);
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

/// Puts a finished strand into the picture.
fn compose(samples: ptr<function, Samples>, strand: Strand, number: u32, first_sample: u32) {
    let nothing = vec4<f32>(NOTHING);
    let in_clump = strand.depth > nothing;
    let is_outer = strand.outer.number > vec4<u32>(0u);
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
    } else if (ORDER == SCATTERED) {
        let parts = vec4<f32>(
            scatter(number, first_sample),
            scatter(number, first_sample + 1u),
            scatter(number, first_sample + 2u),
            scatter(number, first_sample + 3u),
        );
        depth = deeper(depth, gpu_frame.edge_depth_m * parts);
        biased = deeper(biased, gpu_frame.edge_depth_m * parts);
    }
    // Strands that are as near stay in the order in which they come; strokes in `SHIFTED` have their own.
    let on_top = select(vec4<u32>(0u), strand.outer.number, ORDER == SHIFTED);
    let wins = is_drawn & shows(*samples, depth, biased, on_top);
    if (!any(wins)) {
        return;
    }
    (*samples).number = select((*samples).number, on_top, wins);
    (*samples).strand = select((*samples).strand, depth, wins);
    set_colors(
        samples,
        select(strand.outer.disc, strand.inner.disc, is_inner),
        select(strand.outer.way, strand.inner.way, is_inner),
        wins,
    );
}

// ---- The tile

@compute @workgroup_size(TILE, TILE)
fn draw_tile(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(local_invocation_id) pixel: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let corner = group.xy * TILE;
    let tile = vec2<f32>(corner);
    let tile_index = group.y * gpu_frame.tiles.x + group.x;
    let tile_count = gpu_frame.tiles.x * gpu_frame.tiles.y;
    var sum = vec4<f32>(0.0);
    for (var first_sample = 0u; first_sample < gpu_frame.samples; first_sample += 4u) {
        let places = array<vec4<f32>, 2>(sample_places[first_sample / 2u], sample_places[first_sample / 2u + 1u]);
        let x = vec4<f32>(places[0].x, places[0].z, places[1].x, places[1].z) + f32(pixel.x);
        let y = vec4<f32>(places[0].y, places[0].w, places[1].y, places[1].w) + f32(pixel.y);
        var samples: Samples;
        samples.surface = vec4<f32>(NOTHING);
        samples.triangle = vec4<u32>(0xffffffffu);
        samples.strand = vec4<f32>(NOTHING);
        samples.red = vec4<f32>(gpu_frame.background.x);
        samples.green = vec4<f32>(gpu_frame.background.y);
        samples.blue = vec4<f32>(gpu_frame.background.z);
        draw_surfaces(tile, tile_count + 1u + tile_index, local, vec2<f32>(pixel.xy), x, y, &samples);
        draw_strands(tile, tile_index, local, vec2<f32>(pixel.xy), x, y, first_sample, &samples);
        sum += write_samples(corner + pixel.xy, first_sample, samples);
    }
    let at = corner + pixel.xy;
    if (gpu_frame.writes_samples == 0u && all(at < gpu_frame.size)) {
        picture[at.y * gpu_frame.size.x + at.x] = sum / f32(gpu_frame.samples);
    }
}

/// The sums of the samples' colours and alphas. In the layout for another's pass every sample is kept: its
/// colour, and its inverse depth in place of alpha, 0 where nothing is.
fn write_samples(at: vec2<u32>, first_sample: u32, samples: Samples) -> vec4<f32> {
    var sum = vec4<f32>(0.0);
    let is_drawn = (samples.strand > vec4<f32>(NOTHING)) | (samples.surface > vec4<f32>(NOTHING));
    for (var k = 0u; k < min(4u, gpu_frame.samples - first_sample); k++) {
        let color = clamp(vec3<f32>(samples.red[k], samples.green[k], samples.blue[k]), vec3<f32>(0.0), vec3<f32>(1.0));
        sum += vec4<f32>(color, select(gpu_frame.background.w, 1.0, is_drawn[k]));
        if (gpu_frame.writes_samples != 0u && all(at < gpu_frame.size)) {
            let depth = select(0.0, max(samples.strand[k], samples.surface[k]), is_drawn[k]);
            let pixel = at.y * gpu_frame.size.x + at.x;
            picture[pixel * gpu_frame.samples + first_sample + k] = vec4<f32>(color, depth);
        }
    }
    return sum;
}

/// The tile's list: where it begins, its length, and whether it is a list at all.
fn find_list(at: u32, first: u32, capacity: u32, all_items: u32, local: u32) -> vec3<u32> {
    if (local == 0u) {
        let start = starts[at];
        let end = starts[at + 1u];
        list = select(vec3<u32>(first + start, end - start, 1u), vec3<u32>(0u, all_items, 0u), end > capacity);
    }
    return workgroupUniformLoad(&list);
}

fn entry(found: vec3<u32>, index: u32) -> u32 {
    if (found.z == 0u) {
        return index;
    }
    return entries[found.x + index];
}

/// The inverse depth that nothing of an entry's strand exceeds in this tile; a list that is none knows nothing.
fn nearest_in(found: vec3<u32>, index: u32) -> f32 {
    if (found.z == 0u) {
        return 3e38;
    }
    return bitcast<f32>(entries[gpu_frame.chunk_capacity + gpu_frame.triangle_capacity + found.x + index]);
}

/// The farthest of what the samples show.
fn farthest(samples: ptr<function, Samples>) -> f32 {
    let strand = (*samples).strand;
    return min(min(strand.x, strand.y), min(strand.z, strand.w));
}

fn draw_surfaces(tile: vec2<f32>, at: u32, local: u32, pixel: vec2<f32>, x: vec4<f32>, y: vec4<f32>, samples: ptr<function, Samples>) {
    let found = find_list(at, gpu_frame.chunk_capacity, gpu_frame.triangle_capacity, gpu_frame.triangles, local);
    for (var first = 0u; first < found.y; first += BATCH) {
        if (local < BATCH / 32u) {
            atomicStore(&reaching[local], 0u);
        }
        workgroupBarrier();
        var placed: Placed;
        var index = 0u;
        if (local < BATCH && first + local < found.y) {
            index = entry(found, first + local);
            placed = place(index, tile);
            if (placed.is_there) {
                atomicOr(&reaching[local / 32u], 1u << (local % 32u));
            }
        }
        workgroupBarrier();
        if (placed.is_there) {
            store_triangle(slot_of(local), placed, index);
        }
        workgroupBarrier();
        let count = reaching_count();
        for (var slot = 0u; slot < count; slot++) {
            if (is_beside(slot, pixel)) {
                continue;
            }
            draw_triangle(slot, x, y, samples);
        }
        workgroupBarrier();
    }
}

/// The entries of one strand.
struct EntriesOfStrand {
    /// Of a list, excluded.
    end: u32,
    /// The most strokes that one of its chunks has.
    strokes: u32,
}

/// The strand whose entries begin there, for `SHIFTED`.
fn strand_at(found: vec3<u32>, first: u32) -> EntriesOfStrand {
    var whole = EntriesOfStrand(first, 0u);
    if (ORDER != SHIFTED) {
        return whole;
    }
    while (whole.end < found.y) {
        let chunk = chunks[entry(found, whole.end)];
        if (chunk.strand != chunks[entry(found, first)].strand) {
            break;
        }
        whole.strokes = max(whole.strokes, tables[2u * chunk.strokes + 1u]);
        whole.end++;
    }
    return whole;
}

fn draw_strands(tile: vec2<f32>, at: u32, local: u32, pixel: vec2<f32>, x: vec4<f32>, y: vec4<f32>, first_sample: u32, samples: ptr<function, Samples>) {
    let found = find_list(at, 0u, gpu_frame.chunk_capacity, gpu_frame.chunks, local);
    var strand = no_strand();
    // What `strand` is: the strand's number, and in `SHIFTED` the stroke's.
    var key = vec2<u32>(0u);
    // The next thing to look at: an entry, and a segment of it, counted on through its strokes. In `SHIFTED` the entries of a
    // strand come once for each stroke.
    var next = 0u;
    var item = 0u;
    var first_entry = 0u;
    var in_list = 0u;
    var entries_of_strand = strand_at(found, 0u);
    while (next < found.y) {
        if (local < BATCH / 32u) {
            atomicStore(&reaching[local], 0u);
        }
        if (local == 0u) {
            atomicStore(&open_pixels, 0u);
        }
        workgroupBarrier();
        // From the nearest on: where all samples show something nearer, so they do to the end. A strand that
        // has begun is not yet among what they show.
        if (farthest(samples) <= nearest_in(found, next)) {
            atomicOr(&open_pixels, 1u);
        }
        workgroupBarrier();
        if (local == 0u) {
            is_open = atomicLoad(&open_pixels);
        }
        if (workgroupUniformLoad(&is_open) == 0u) {
            break;
        }
        var seen: Found;
        var nearest_seen = 0.0;
        // All walk along the segments of the batch; each looks at the one that is its own.
        var offset = 0u;
        while (next < found.y && offset < BATCH) {
            let chunk = chunks[entry(found, next)];
            let places = max(chunk.segments, 1u);
            let strokes = tables[2u * chunk.strokes + 1u];
            var items = places * strokes;
            if (ORDER == SHIFTED) {
                items = select(0u, places, in_list < strokes);
            }
            let taken = min(items - item, BATCH - offset);
            if (local >= offset && local < offset + taken) {
                let own = item + local - offset;
                seen = look_at(chunk, in_list + own / places, own % places, tile);
                nearest_seen = nearest_in(found, next);
            }
            offset += taken;
            item += taken;
            if (item < items) {
                continue;
            }
            item = 0u;
            next++;
            if (ORDER == SHIFTED && next == entries_of_strand.end) {
                in_list++;
                if (in_list < entries_of_strand.strokes) {
                    next = first_entry;
                } else {
                    in_list = 0u;
                    first_entry = next;
                    entries_of_strand = strand_at(found, next);
                }
            }
        }
        if (seen.is_there) {
            atomicOr(&reaching[local / 32u], 1u << (local % 32u));
        }
        workgroupBarrier();
        if (seen.is_there) {
            let slot = slot_of(local);
            store(slot, seen.segment);
            nearest_of[slot] = nearest_seen;
        }
        workgroupBarrier();
        let count = reaching_count();
        for (var slot = 0u; slot < count; slot++) {
            if (nearest_of[slot] < farthest(samples) || is_beside(slot, pixel)) {
                continue;
            }
            let segment = segment_in(slot);
            let next_key = vec2<u32>(segment.strand, select(0u, segment.number, ORDER == SHIFTED));
            if (any(next_key != key)) {
                compose(samples, strand, key.x, first_sample);
                strand = no_strand();
                key = next_key;
            }
            add(&strand, segment, x, y);
        }
        workgroupBarrier();
    }
    compose(samples, strand, key.x, first_sample);
}
