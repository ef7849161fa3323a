// Draws the tiles: a workgroup a tile, an invocation a pixel, four samples of it at a time. What each sample shows is
// told at render::Order; ORDER is written before this text, and so is told.wgsl or untold.wgsl, which say whether samples
// are kept with what they show, textured.wgsl or untextured.wgsl, brushed.wgsl or unbrushed.wgsl, and decals.wgsl or no_decals.wgsl.
//
// All invocations together look at a batch of a tile's triangles or segments, each at one, and keep what
// reaches the tile, ready to be drawn, in the memory that they share. Then each draws them all into its own samples.

@group(0) @binding(6) var<storage, read> starts: array<u32>;
@group(0) @binding(7) var<storage, read> entries: array<u32>;
/// Means of the pixels, or all their samples: see `write_samples`.
@group(0) @binding(8) var<storage, read_write> picture: array<vec4<f32>>;
/// Where samples lie in their pixel: two in each.
@group(0) @binding(9) var<uniform> sample_places: array<vec4<f32>, 128>;

const ROUNDED: u32 = 0u;
const STRAND_FIRST: u32 = 1u;
const SHIFTED: u32 = 2u;

/// Things that are looked at in one go.
const BATCH: u32 = 64u;
/// Stands for the inverse depth of nothing.
const NOTHING: f32 = -3e38;
const FAR_RATIO: f32 = 3e38;

/// What a decal does to a sample.
const DECAL_COLORS: u32 = 1u;
const DECAL_SHADES: u32 = 2u;

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
    /// In `SHIFTED` the number of its stroke, else 0; and its own. Of what is as near the higher stroke lies on top, then the
    /// lower strand.
    stroke: vec4<u32>,
    owner: vec4<u32>,
    /// Whether that stroke is an outline, of negative rank, on which no shadows fall.
    is_outline: vec4<bool>,
    red: vec4<f32>,
    green: vec4<f32>,
    blue: vec4<f32>,
    /// Whether a decal gives its colour, or puts the surface in shadow.
    decal: vec4<u32>,
    /// Where `TELLS`: the disc that its stroke's segment begins at, the way to the next, and the places across stroke and clump.
    disc: vec4<u32>,
    way: vec4<f32>,
    v: vec4<f32>,
    w: vec4<f32>,
}

/// Whether a pixel of the tile is outside of a kept thing's box: most are, and that is all they need to know.
fn is_beside(slot: u32, pixel: vec2<f32>) -> bool {
    let box = boxes[slot];
    return pixel.x > box.z || pixel.y > box.w || pixel.x + 1.0 < box.x || pixel.y + 1.0 < box.y;
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
    var surface_red: vec4<f32>;
    var surface_green: vec4<f32>;
    var surface_blue: vec4<f32>;
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
        draw_surfaces(tile, tile_count + 1u + tile_index, local, vec2<f32>(pixel.xy), x, y, first_sample, &samples);
        if (KEEPS_UNDER) {
            surface_red = samples.red;
            surface_green = samples.green;
            surface_blue = samples.blue;
        }
        draw_strands(tile, tile_index, local, vec2<f32>(pixel.xy), x, y, first_sample, &samples);
        draw_decals(tile, tile_index, local, vec2<f32>(pixel.xy), x, y, first_sample, &samples);
        if (KEEPS_UNDER) {
            write_under(corner + pixel.xy, first_sample, samples, surface_red, surface_green, surface_blue);
        }
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
        if (TELLS && all(at < gpu_frame.size)) {
            tell(at, first_sample + k, what_shows(samples, k));
        }
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

/// Keeps the surfaces behind the hair that samples show.
fn write_under(at: vec2<u32>, first_sample: u32, samples: Samples, red: vec4<f32>, green: vec4<f32>, blue: vec4<f32>) {
    if (any(at >= gpu_frame.size)) {
        return;
    }
    for (var k = 0u; k < min(4u, gpu_frame.samples - first_sample); k++) {
        var what = vec4<u32>(SHOWS_NOTHING, 0u, 0u, 0u);
        if (samples.strand[k] > NOTHING && samples.surface[k] > NOTHING) {
            let colors = vec2<u32>(pack2x16float(vec2<f32>(red[k], green[k])), pack2x16float(vec2<f32>(blue[k], 0.0)));
            what = vec4<u32>(SHOWS_TRIANGLE | samples.triangle[k], colors, bitcast<u32>(samples.surface[k]));
        }
        keep_under(at, first_sample + k, what);
    }
}

/// What a sample shows, as shown.wgsl reads it.
fn what_shows(samples: Samples, k: u32) -> vec4<u32> {
    if (samples.strand[k] > NOTHING) {
        let places = pack2x16snorm(vec2<f32>(samples.v[k], samples.w[k]));
        // The way's sign is free to say that the sample isn't to be painted.
        let decal = select(0u, 0x80000000u, samples.decal[k] == DECAL_COLORS);
        let way = bitcast<u32>(max(samples.way[k], 0.0)) | decal;
        return vec4<u32>(samples.disc[k], way, places, bitcast<u32>(samples.strand[k]));
    }
    if (samples.surface[k] > NOTHING) {
        return vec4<u32>(SHOWS_TRIANGLE | samples.triangle[k], samples.decal[k], 0u, bitcast<u32>(samples.surface[k]));
    }
    return vec4<u32>(SHOWS_NOTHING, 0u, 0u, 0u);
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

/// The inverse depth that nothing of an entry's strand exceeds in this tile; an invalid list knows nothing.
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

fn draw_surfaces(
    tile: vec2<f32>,
    at: u32,
    local: u32,
    pixel: vec2<f32>,
    x: vec4<f32>,
    y: vec4<f32>,
    first_sample: u32,
    samples: ptr<function, Samples>,
) {
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
            draw_triangle(slot, tile, x, y, first_sample, samples);
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

/// A way through a tile's list: segment by segment of an entry, counted on through its strokes, or through its decals. `by_stroke`, where strokes are
/// finished one after the other, the entries of a strand come once for each of its strokes, and have the segments of that one.
struct Walk {
    decals: bool,
    by_stroke: bool,
    /// The next thing to look at: an entry, and a segment of it.
    next: u32,
    item: u32,
    first_entry: u32,
    in_list: u32,
    entries: EntriesOfStrand,
}

/// What an invocation looks at, and how near its strand is in the tile.
struct Looked {
    seen: Found,
    nearest: f32,
}

const NO_ENTRY: u32 = 0xffffffffu;

fn begin_walk(found: vec3<u32>, by_stroke: bool, decals: bool) -> Walk {
    return Walk(decals, by_stroke, 0u, 0u, 0u, 0u, strand_at(found, 0u, by_stroke, decals));
}

/// The strokes of a chunk, or its decals: where they begin in its list, and how many there are.
fn strokes_of(chunk: Chunk, decals: bool) -> vec2<u32> {
    let record = LIST_WORDS * chunk.strokes;
    let strokes = tables[record + LIST_STROKES];
    if (decals) {
        return vec2<u32>(strokes, tables[record + LIST_DECALS]);
    }
    return vec2<u32>(0u, strokes);
}

/// The strand whose entries begin there, for walks stroke by stroke.
fn strand_at(found: vec3<u32>, first: u32, by_stroke: bool, decals: bool) -> EntriesOfStrand {
    var whole = EntriesOfStrand(first, 0u);
    if (!by_stroke) {
        return whole;
    }
    while (whole.end < found.y) {
        let chunk = chunks[entry(found, whole.end)];
        if (chunk.strand != chunks[entry(found, first)].strand) {
            break;
        }
        whole.strokes = max(whole.strokes, strokes_of(chunk, decals).y);
        whole.end++;
    }
    return whole;
}

/// All walk along the segments of the next batch; each looks at the one that is its own, all of them together: in the walk one entry's would wait for
/// memory after the other's.
fn walk_batch(walk: ptr<function, Walk>, found: vec3<u32>, local: u32, tile: vec2<f32>) -> Looked {
    var looked: Looked;
    var own_entry = NO_ENTRY;
    var own_stroke = 0u;
    var own_place = 0u;
    var offset = 0u;
    while ((*walk).next < found.y && offset < BATCH) {
        let chunk = chunks[entry(found, (*walk).next)];
        let places = max(chunk.segments, 1u);
        let strokes = strokes_of(chunk, (*walk).decals);
        var items = places * strokes.y;
        if ((*walk).by_stroke) {
            items = select(0u, places, (*walk).in_list < strokes.y);
        }
        let taken = min(items - (*walk).item, BATCH - offset);
        if (local >= offset && local < offset + taken) {
            let own = (*walk).item + local - offset;
            own_entry = (*walk).next;
            own_stroke = strokes.x + (*walk).in_list + own / places;
            own_place = own % places;
        }
        offset += taken;
        (*walk).item += taken;
        if ((*walk).item < items) {
            continue;
        }
        (*walk).item = 0u;
        (*walk).next++;
        if ((*walk).by_stroke && (*walk).next == (*walk).entries.end) {
            (*walk).in_list++;
            if ((*walk).in_list < (*walk).entries.strokes) {
                (*walk).next = (*walk).first_entry;
            } else {
                (*walk).in_list = 0u;
                (*walk).first_entry = (*walk).next;
                (*walk).entries = strand_at(found, (*walk).next, true, (*walk).decals);
            }
        }
    }
    if (own_entry != NO_ENTRY) {
        looked.seen = look_at(chunks[entry(found, own_entry)], own_stroke, own_place, tile);
        looked.nearest = nearest_in(found, own_entry);
    }
    return looked;
}

fn draw_strands(
    tile: vec2<f32>,
    at: u32,
    local: u32,
    pixel: vec2<f32>,
    x: vec4<f32>,
    y: vec4<f32>,
    first_sample: u32,
    samples: ptr<function, Samples>,
) {
    let found = find_list(at, 0u, gpu_frame.chunk_capacity, gpu_frame.chunks, local);
    var walk = begin_walk(found, ORDER == SHIFTED || BRUSHED, false);
    // What has come of a strand; where strokes are finished one after the other, of one of its strokes.
    var strand = no_strand();
    // The strand's number, and the stroke's where there is one at a time; and its brush.
    var key = vec2<u32>(0u);
    var brush = 0u;
    // Where `BRUSHED` the strand's strokes before.
    var whole = no_strand();
    while (walk.next < found.y) {
        if (local < BATCH / 32u) {
            atomicStore(&reaching[local], 0u);
        }
        if (local == 0u) {
            atomicStore(&open_pixels, 0u);
        }
        workgroupBarrier();
        // From the nearest on: where all samples show something nearer, so they do to the end. A strand that
        // has begun is not yet among what they show.
        if (farthest(samples) <= nearest_in(found, walk.next)) {
            atomicOr(&open_pixels, 1u);
        }
        workgroupBarrier();
        if (local == 0u) {
            is_open = atomicLoad(&open_pixels);
        }
        if (workgroupUniformLoad(&is_open) == 0u) {
            break;
        }
        let looked = walk_batch(&walk, found, local, tile);
        if (looked.seen.is_there) {
            atomicOr(&reaching[local / 32u], 1u << (local % 32u));
        }
        workgroupBarrier();
        if (looked.seen.is_there) {
            let slot = slot_of(local);
            store(slot, looked.seen.segment);
            nearest_of[slot] = looked.nearest;
        }
        workgroupBarrier();
        let count = reaching_count();
        for (var slot = 0u; slot < count; slot++) {
            if (nearest_of[slot] < farthest(samples) || is_beside(slot, pixel)) {
                continue;
            }
            let segment = segment_in(slot);
            let next_key = vec2<u32>(segment.strand, select(0u, segment.number, walk.by_stroke));
            if (any(next_key != key)) {
                if (BRUSHED) {
                    thin(&strand, brush, first_sample);
                    whole = with_stroke(whole, strand);
                    if (ORDER == SHIFTED || next_key.x != key.x) {
                        compose(samples, whole, key.x);
                        whole = no_strand();
                    }
                } else {
                    compose(samples, strand, key.x);
                }
                strand = no_strand();
                key = next_key;
                brush = segment.record;
            }
            add(&strand, segment, x, y);
        }
        workgroupBarrier();
    }
    if (BRUSHED) {
        thin(&strand, brush, first_sample);
        strand = with_stroke(whole, strand);
    }
    compose(samples, strand, key.x);
}
