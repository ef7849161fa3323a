// Lines where one sample of neighbouring pixels shows something else: crates/render/src/edges.rs tells what they are. Composed behind
// the prelude and frame.wgsl, with the places of the planes that tell.wgsl has filled.
//
// A line is the union of discs around the pixels where it begins. A pixel lies in one of them where the greatest radius squared less distance
// squared is 0 or more, and that is found along rows first, then along columns.

struct Edges {
    /// Linear.
    color: vec3<f32>,
    channel: u32,
    threshold: f32,
    step_m: f32,
    fade_to: f32,
    /// No disc reaches further, in pixels.
    reach: u32,
    seed: u32,
    /// The share by which strands' widths differ.
    vary: f32,
    /// Pixels, of what is no hair.
    widest: f32,
    /// How many widths there are.
    count: u32,
    /// Places along the strand, 0 to 1, with widths in pixels.
    widths: array<vec2<f32>>,
}

@group(0) @binding(0) var<uniform> gpu_frame: GpuFrame;
@group(0) @binding(1) var<storage, read> gpu_planes: array<u32>;
/// Radii squared of the discs around pixels, below 0 where there is none.
@group(0) @binding(2) var<storage, read_write> discs: array<f32>;
/// The greatest radius squared of a row's discs less the distance squared along it.
@group(0) @binding(3) var<storage, read_write> rows: array<f32>;
/// The samples' colours, and their inverse depths, 0 where nothing is.
@group(0) @binding(4) var<storage, read_write> samples: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read> edges: Edges;
/// Which sample.
@group(0) @binding(6) var<uniform> gpu_sample: vec4<u32>;

const LEVEL: u32 = 0u;
const STRAND: u32 = 1u;
const OBJECT: u32 = 2u;
const NORMAL: u32 = 3u;
const DEPTH: u32 = 4u;
const COLOR: u32 = 5u;

const LARGEST: f32 = 1024.0;
/// Steps of a radius in a pixel.
const STEPS: f32 = 4.0;
const NO_DISC: f32 = -1.0;

fn pixel_at(place: vec2<u32>) -> u32 {
    return place.y * gpu_frame.size.x + place.x;
}

fn id_in(plane: u32, place: vec2<u32>) -> u32 {
    return gpu_planes[plane * gpu_frame.size.x * gpu_frame.size.y + pixel_at(place)];
}

fn number_in(plane: u32, place: vec2<u32>) -> f32 {
    return bitcast<f32>(id_in(plane, place));
}

fn is_hair(object: u32) -> bool {
    return object % 2u == 1u;
}

/// What two samples are compared by.
struct Key {
    depth: f32,
    object: u32,
    id: u32,
}

fn key_at(place: vec2<u32>) -> Key {
    let object = id_in(GPU_PLANE_OBJECT, place);
    var id = object;
    if (edges.channel == LEVEL && GPU_PLANE_LEVEL != GPU_NO_PLANE) {
        id = id_in(GPU_PLANE_LEVEL, place);
    } else if (edges.channel == STRAND && GPU_PLANE_STRAND != GPU_NO_PLANE) {
        id = id_in(GPU_PLANE_STRAND, place);
    }
    return Key(number_in(GPU_PLANE_INV_DEPTH, place), object, id);
}

/// Whether a sample lies before another one of another id. What is equally near belongs to the greater id.
fn is_line(own: Key, other: Key) -> bool {
    if (own.object == other.object && own.id == other.id) {
        return false;
    }
    let is_drawn = edges.channel == OBJECT || is_hair(own.object) || is_hair(other.object);
    let is_greater = own.object > other.object || (own.object == other.object && own.id > other.id);
    return is_drawn && (own.depth > other.depth || (own.depth == other.depth && is_greater));
}

/// Whether what lies behind is more than the step farther.
fn is_step(own: f32, other: f32) -> bool {
    return other * (1.0 + own * edges.step_m) < own;
}

fn is_beside_another(place: vec2<u32>) -> bool {
    let low = max(place, vec2<u32>(1u)) - 1u;
    let high = min(place + 1u, gpu_frame.size - 1u);
    let own = key_at(place);
    for (var y = low.y; y <= high.y; y++) {
        for (var x = low.x; x <= high.x; x++) {
            let other = key_at(vec2<u32>(x, y));
            if (edges.channel == DEPTH) {
                if (is_step(own.depth, other.depth)) {
                    return true;
                }
            } else if (is_line(own, other)) {
                return true;
            }
        }
    }
    return false;
}

fn channels_at(place: vec2<u32>) -> vec3<f32> {
    if (edges.channel == COLOR) {
        return samples[pixel_at(place) * gpu_frame.samples + gpu_sample.x].xyz;
    }
    if (GPU_PLANE_NORMAL == GPU_NO_PLANE) {
        return vec3<f32>(0.0);
    }
    return vec3<f32>(
        number_in(GPU_PLANE_NORMAL, place),
        number_in(GPU_PLANE_NORMAL + 1u, place),
        number_in(GPU_PLANE_NORMAL + 2u, place),
    );
}

fn exceeds_threshold(place: vec2<u32>) -> bool {
    let low = max(place, vec2<u32>(1u)) - 1u;
    let high = min(place + 1u, gpu_frame.size - 1u);
    let a = channels_at(low);
    let b = channels_at(vec2<u32>(place.x, low.y));
    let c = channels_at(vec2<u32>(high.x, low.y));
    let d = channels_at(vec2<u32>(low.x, place.y));
    let e = channels_at(vec2<u32>(high.x, place.y));
    let f = channels_at(vec2<u32>(low.x, high.y));
    let g = channels_at(vec2<u32>(place.x, high.y));
    let h = channels_at(high);
    let across = (c - a) + 2.0 * (e - d) + (h - f);
    let down = (f - a) + 2.0 * (g - b) + (h - c);
    return dot(across, across) + dot(down, down) > edges.threshold * edges.threshold;
}

/// The width of a line on hair, pixels.
fn width_of_hair(u: f32, strand: u32) -> f32 {
    let count = edges.count;
    var next = 0u;
    while (next < count && edges.widths[next].x <= u) {
        next++;
    }
    var width = edges.widths[max(next, 1u) - 1u].y;
    if (next > 0u && next < count) {
        let before = edges.widths[next - 1u];
        width += (edges.widths[next].y - width) * (u - before.x) / (edges.widths[next].x - before.x);
    }
    width *= 1.0 + edges.vary * random_signed(hash(edges.seed ^ hash(strand)), 0u);
    if (edges.fade_to > 0.0) {
        width *= 0.5 * (1.0 - cos(PI * clamp(u / edges.fade_to, 0.0, 1.0)));
    }
    return width;
}

/// The radius squared that a line has there, below 0 where the sample has none.
fn disc_at(place: vec2<u32>) -> f32 {
    var width = edges.widest;
    if (is_hair(id_in(GPU_PLANE_OBJECT, place))) {
        // Not there where no width needs them.
        var u = 0.0;
        var strand = 0u;
        if (GPU_PLANE_U != GPU_NO_PLANE) {
            u = number_in(GPU_PLANE_U, place);
        }
        if (GPU_PLANE_STRAND != GPU_NO_PLANE) {
            strand = id_in(GPU_PLANE_STRAND, place);
        }
        width = width_of_hair(u, strand);
    }
    let share = (f32(gpu_sample.x) + 0.499) / f32(gpu_frame.samples);
    if (width < 1.0) {
        return select(NO_DISC, 0.0, share < width);
    }
    let radius = floor(min(0.5 * (width - 1.0) + share, LARGEST) * STEPS) / STEPS;
    return radius * radius;
}

@compute @workgroup_size(8, 8)
fn find(@builtin(global_invocation_id) id: vec3<u32>) {
    if (any(id.xy >= gpu_frame.size)) {
        return;
    }
    var is_found = false;
    if (edges.channel == NORMAL || edges.channel == COLOR) {
        is_found = exceeds_threshold(id.xy);
    } else {
        is_found = is_beside_another(id.xy);
    }
    var disc = NO_DISC;
    if (is_found) {
        disc = disc_at(id.xy);
    }
    discs[pixel_at(id.xy)] = disc;
}

@compute @workgroup_size(8, 8)
fn grow_along_rows(@builtin(global_invocation_id) id: vec3<u32>) {
    if (any(id.xy >= gpu_frame.size)) {
        return;
    }
    let low = max(id.x, edges.reach) - edges.reach;
    let high = min(id.x + edges.reach, gpu_frame.size.x - 1u);
    let row = id.y * gpu_frame.size.x;
    var greatest = NO_DISC;
    for (var x = low; x <= high; x++) {
        let distance = f32(x) - f32(id.x);
        greatest = max(greatest, discs[row + x] - distance * distance);
    }
    rows[row + id.x] = greatest;
}

@compute @workgroup_size(8, 8)
fn draw_along_columns(@builtin(global_invocation_id) id: vec3<u32>) {
    if (any(id.xy >= gpu_frame.size)) {
        return;
    }
    let low = max(id.y, edges.reach) - edges.reach;
    let high = min(id.y + edges.reach, gpu_frame.size.y - 1u);
    for (var y = low; y <= high; y++) {
        let distance = f32(y) - f32(id.y);
        if (rows[y * gpu_frame.size.x + id.x] >= distance * distance) {
            let at = pixel_at(id.xy) * gpu_frame.samples + gpu_sample.x;
            // A line over nothing is infinitely far.
            samples[at] = vec4<f32>(edges.color, max(samples[at].w, 1e-30));
            return;
        }
    }
}
