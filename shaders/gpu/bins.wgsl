// Sorts what is drawn into the tiles that it may reach: pieces of runs (chunks), and triangles. First they are
// counted, then the tiles' lists get their places, then they are filled.

/// For each tile the number of chunks, then of triangles; then, where the next goes. Behind them for each chunk the bits of
/// its nearest disc's inverse depth, which order as the numbers do, none being below 0.
@group(0) @binding(6) var<storage, read_write> counters: array<atomic<u32>>;
/// Where each tile's list of chunks begins, and the end of the last; the same for triangles.
@group(0) @binding(7) var<storage, read_write> starts: array<u32>;
/// All lists of chunks, then all of triangles; then, for each entry of a list of chunks, the bits of the inverse depth that
/// nothing of its strand exceeds in this tile.
@group(0) @binding(8) var<storage, read_write> entries: array<u32>;

/// A box on the screen, in tiles: columns and rows, ends excluded.
struct Tiles {
    first: vec2<u32>,
    end: vec2<u32>,
}

/// Room for rounding around everything that is drawn, in pixels.
const MARGIN: f32 = 0.02;

fn tiles_of(low: vec2<f32>, high: vec2<f32>) -> Tiles {
    let size = vec2<f32>(gpu_frame.size);
    // Nothing where the box doesn't touch the picture.
    if (!(low.x <= size.x && low.y <= size.y && high.x >= 0.0 && high.y >= 0.0)) {
        return Tiles(vec2<u32>(0u), vec2<u32>(0u));
    }
    let first = vec2<u32>(clamp(low - MARGIN, vec2<f32>(0.0), size)) / TILE;
    let last = vec2<u32>(clamp(high + MARGIN, vec2<f32>(0.0), size)) / TILE;
    return Tiles(first, min(last + 1u, gpu_frame.tiles));
}

fn tiles_of_chunk(index: u32) -> Tiles {
    let chunk = chunks[index];
    var low = vec2<f32>(1e30);
    var high = vec2<f32>(-1e30);
    let record = LIST_WORDS * chunk.strokes;
    let first = tables[record];
    let count = tables[record + LIST_STROKES] + tables[record + LIST_DECALS];
    for (var s = 0u; s < count; s++) {
        let stroke = tables[first + s];
        if (stroke == NO_STROKE) {
            continue;
        }
        let disc = tables[stroke + STROKE_FIRST_DISC] + chunk.first_joint;
        for (var j = 0u; j <= chunk.segments; j++) {
            let center = discs[disc + j].center;
            let radius = discs[disc + j].radius;
            // A stroke may taper to a point, but two points draw nothing.
            let before = discs[disc + max(j, 1u) - 1u].radius;
            let after = discs[disc + min(j + 1u, chunk.segments)].radius;
            if (max(radius, max(before, after)) > 0.0) {
                low = min(low, center - radius);
                high = max(high, center + radius);
            }
        }
    }
    return tiles_of(low, high);
}

fn nearest_of_chunk(index: u32) -> f32 {
    let chunk = chunks[index];
    let record = LIST_WORDS * chunk.strokes;
    let first = tables[record];
    let count = tables[record + LIST_STROKES] + tables[record + LIST_DECALS];
    var nearest = 0.0;
    for (var s = 0u; s < count; s++) {
        let stroke = tables[first + s];
        if (stroke == NO_STROKE) {
            continue;
        }
        let disc = tables[stroke + STROKE_FIRST_DISC] + chunk.first_joint;
        for (var j = 0u; j <= chunk.segments; j++) {
            nearest = max(nearest, discs[disc + j].inv_depth);
        }
    }
    // Where it is worked out again, rounding may be otherwise.
    return nearest * 1.00001;
}

fn tiles_of_triangle(index: u32) -> Tiles {
    let triangle = triangles[index];
    let a = corners[triangle.corners.x].position;
    let b = corners[triangle.corners.y].position;
    let c = corners[triangle.corners.z].position;
    return tiles_of(min(min(a, b), c), max(max(a, b), c));
}

@compute @workgroup_size(64)
fn count_chunks(@builtin(workgroup_id) group: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    let index = gpu_index(group, groups, local);
    if (index < gpu_frame.chunks) {
        count(tiles_of_chunk(index), 0u);
        atomicStore(&counters[2u * tile_count() + index], bitcast<u32>(nearest_of_chunk(index)));
    }
}

@compute @workgroup_size(64)
fn count_triangles(@builtin(workgroup_id) group: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    let index = gpu_index(group, groups, local);
    if (index < gpu_frame.triangles) {
        count(tiles_of_triangle(index), tile_count());
    }
}

fn tile_count() -> u32 {
    return gpu_frame.tiles.x * gpu_frame.tiles.y;
}

fn count(tiles: Tiles, counter: u32) {
    for (var y = tiles.first.y; y < tiles.end.y; y++) {
        for (var x = tiles.first.x; x < tiles.end.x; x++) {
            atomicAdd(&counters[counter + y * gpu_frame.tiles.x + x], 1u);
        }
    }
}

@compute @workgroup_size(64)
fn fill_chunks(@builtin(workgroup_id) group: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    let index = gpu_index(group, groups, local);
    if (index < gpu_frame.chunks) {
        fill(tiles_of_chunk(index), index, 0u, 0u, gpu_frame.chunk_capacity);
    }
}

@compute @workgroup_size(64)
fn fill_triangles(@builtin(workgroup_id) group: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    let index = gpu_index(group, groups, local);
    if (index < gpu_frame.triangles) {
        fill(tiles_of_triangle(index), index, tile_count(), gpu_frame.chunk_capacity, gpu_frame.triangle_capacity);
    }
}

/// Puts an item into the lists of those tiles, as far as there is room; a tile whose list has none looks at all items.
fn fill(tiles: Tiles, item: u32, counter: u32, first: u32, capacity: u32) {
    for (var y = tiles.first.y; y < tiles.end.y; y++) {
        for (var x = tiles.first.x; x < tiles.end.x; x++) {
            let place = atomicAdd(&counters[counter + y * gpu_frame.tiles.x + x], 1u);
            if (place < capacity) {
                entries[first + place] = item;
            }
        }
    }
}

const SCAN: u32 = 256u;
var<workgroup> sums: array<u32, SCAN>;

/// No list begins farther on than this: a tile without room looks at all items.
const FARTHEST: u32 = 0x7fffffffu;

fn entries_with(before: u32, items: u32) -> u32 {
    return select(before + items, FARTHEST, before > FARTHEST - min(items, FARTHEST));
}

/// Gives every list its place: those before it have so many entries.
@compute @workgroup_size(SCAN)
fn place_lists(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    let tiles = tile_count();
    let counter = group.x * tiles;
    let start = group.x * (tiles + 1u);
    let each = (tiles + SCAN - 1u) / SCAN;
    let first = min(local * each, tiles);
    let end = min(first + each, tiles);
    var sum = 0u;
    for (var tile = first; tile < end; tile++) {
        sum = entries_with(sum, atomicLoad(&counters[counter + tile]));
    }
    sums[local] = sum;
    workgroupBarrier();
    var before = 0u;
    for (var other = 0u; other < local; other++) {
        before = entries_with(before, sums[other]);
    }
    for (var tile = first; tile < end; tile++) {
        let items = atomicLoad(&counters[counter + tile]);
        starts[start + tile] = before;
        atomicStore(&counters[counter + tile], before);
        before = entries_with(before, items);
    }
    if (local == SCAN - 1u) {
        starts[start + tiles] = before;
    }
}

const SORT: u32 = 64u;
var<workgroup> list: vec2<u32>;

/// Sorts a tile's list of chunks, which came in any order. First by their numbers, so that the chunks of a strand come
/// together; then by the nearest that there is of a strand in the tile, so that what lies behind is found to be
/// hidden. All is drawn in one order.
@compute @workgroup_size(SORT)
fn sort_chunks(@builtin(workgroup_id) group: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    let tile = group.y * groups.x + group.x;
    if (local == 0u) {
        list = vec2<u32>(starts[tile], starts[tile + 1u]);
    }
    let place = workgroupUniformLoad(&list);
    if (place.y > gpu_frame.chunk_capacity) { return; }
    sort(place.x, place.y - place.x, false, local);
    let nearest_at = gpu_frame.chunk_capacity + gpu_frame.triangle_capacity;
    for (var item = place.x + local; item < place.y; item += SORT) {
        entries[nearest_at + item] = nearest_of_strand(item, place);
    }
    storageBarrier();
    sort(place.x, place.y - place.x, true, local);
}

/// The nearest of all chunks of an entry's strand in a list.
fn nearest_of_strand(item: u32, place: vec2<u32>) -> u32 {
    let nearest_at = 2u * tile_count();
    let strand = chunks[entries[item]].strand;
    var nearest = atomicLoad(&counters[nearest_at + entries[item]]);
    for (var other = item; other > place.x && chunks[entries[other - 1u]].strand == strand; other--) {
        nearest = max(nearest, atomicLoad(&counters[nearest_at + entries[other - 1u]]));
    }
    for (var other = item + 1u; other < place.y && chunks[entries[other]].strand == strand; other++) {
        nearest = max(nearest, atomicLoad(&counters[nearest_at + entries[other]]));
    }
    return nearest;
}

/// Sorts a list by a bitonic network over the next power of two, whose missing items count as the largest (Batcher,
/// "Sorting networks and their applications", 1968), with every comparison upwards, so that these stay at the end.
fn sort(start: u32, items: u32, is_by_depth: bool, local: u32) {
    let nearest_at = start + gpu_frame.chunk_capacity + gpu_frame.triangle_capacity;
    for (var block = 2u; block < 2u * items; block *= 2u) {
        for (var half = block / 2u; half > 0u; half /= 2u) {
            for (var pair = local; ; pair += SORT) {
                let low = pair / half * 2u * half + pair % half;
                if (low >= items) { break; }
                var high = low + half;
                if (half == block / 2u) {
                    // The first step of a block compares it with its mirror image.
                    high = low / block * block + block - 1u - low % block;
                }
                if (high < items) {
                    let a = entries[start + low];
                    let b = entries[start + high];
                    var is_turned = b < a;
                    if (is_by_depth) {
                        let near_a = entries[nearest_at + low];
                        let near_b = entries[nearest_at + high];
                        is_turned = near_b > near_a || (near_b == near_a && is_turned);
                        entries[nearest_at + low] = max(near_a, near_b);
                        entries[nearest_at + high] = min(near_a, near_b);
                    }
                    if (is_turned) {
                        entries[start + low] = b;
                        entries[start + high] = a;
                    }
                }
            }
            storageBarrier();
        }
    }
}
