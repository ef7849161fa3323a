// Triangles as a tile sees them, in two tones, flat or with a picture. Composed with tiles.wgsl; the CPU's is crates/render/src/cpu/surface.rs.

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

/// The value at the tile's corner, and the slopes, of what is linear between the corners. From the first corner's value on: sums of whole
/// values would lose in needles what tells a surface's outside from its inside, which meet where it turns away.
fn linear(values: vec3<f32>, edges: array<vec3<f32>, 3>, area: f32) -> vec3<f32> {
    let rise = (values.y - values.x) * edges[1] + (values.z - values.x) * edges[2];
    return vec3<f32>(values.x, 0.0, 0.0) + rise / area;
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
    placed.depth = linear(vec3<f32>(a.inv_depth, b.inv_depth, c.inv_depth), edges, area);
    placed.tone = linear(vec3<f32>(a.tone, b.tone, c.tone), edges, area);
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

fn draw_triangle(slot: u32, tile: vec2<f32>, x: vec4<f32>, y: vec4<f32>, first_sample: u32, samples: ptr<function, Samples>) {
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
    var wins = is_inside & ((depth > (*samples).surface) | is_first);
    let surface = gpu_frame.surfaces_at + SURFACE_WORDS * v5.y;
    var light = vec3<f32>(table(surface), table(surface + 1u), table(surface + 2u));
    var shadow = vec3<f32>(table(surface + 3u), table(surface + 4u), table(surface + 5u));
    if (TEXTURED) {
        if (!any(wins)) {
            return;
        }
        let texel = texel_of(surface, v5.x, tile, middle_of(x, y, first_sample), v3.xyz, vec2<f32>(v0.w, v1.w));
        wins &= is_covered(surface, v5.y, texel.w, first_sample);
        light *= texel.xyz;
        shadow *= texel.xyz;
    }
    let is_lit = tone >= zero;
    (*samples).surface = select((*samples).surface, depth, wins);
    (*samples).triangle = select((*samples).triangle, vec4<u32>(v5.x), wins);
    (*samples).surface_margin = select((*samples).surface_margin, vec4<f32>(table(surface + 6u)), wins);
    (*samples).red = select((*samples).red, select(vec4<f32>(shadow.x), vec4<f32>(light.x), is_lit), wins);
    (*samples).green = select((*samples).green, select(vec4<f32>(shadow.y), vec4<f32>(light.y), is_lit), wins);
    (*samples).blue = select((*samples).blue, select(vec4<f32>(shadow.z), vec4<f32>(light.z), is_lit), wins);
}

/// The middle of a pixel's samples, of four at most.
fn middle_of(x: vec4<f32>, y: vec4<f32>, first_sample: u32) -> vec2<f32> {
    let count = min(gpu_frame.samples - first_sample, 4u);
    var sum = vec2<f32>(0.0);
    for (var k = 0u; k < count; k++) {
        sum += vec2<f32>(x[k], y[k]);
    }
    return sum / f32(count);
}

fn table(at: u32) -> f32 {
    return bitcast<f32>(tables[at]);
}
