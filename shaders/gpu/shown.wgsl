// What samples show, and what joints tell of the points that they lie beside. Composed behind joint.wgsl; drawn.wgsl has the numbers
// that stand for triangles and nothing.

@group(0) @binding(4) var<storage, read> gpu_clumps: array<GpuClump>;
/// As told.wgsl writes it, sample by sample.
@group(0) @binding(6) var gpu_shown: texture_2d_array<u32>;

/// In place of a disc where a sample shows no stroke: set in the number of a triangle; or nothing.
const GPU_SHOWS_TRIANGLE: u32 = 0x80000000u;
const GPU_SHOWS_NOTHING: u32 = 0xffffffffu;

struct GpuShown {
    /// The disc that the segment begins at, a triangle, or nothing.
    what: u32,
    /// The way to the next disc.
    way: f32,
    /// Whether a decal gives it its colour.
    is_decal: bool,
    /// Places across stroke and clump, -1 to 1.
    across: vec2<f32>,
    /// 1/m, as the sample was ordered; 0 where nothing is.
    inv_depth: f32,
}

fn gpu_shown_at(pixel: vec2<u32>, sample: u32) -> GpuShown {
    let words = textureLoad(gpu_shown, pixel, sample, 0);
    let way = bitcast<f32>(words.y & 0x7fffffffu);
    return GpuShown(words.x, way, (words.y >> 31u) != 0u, unpack2x16snorm(words.z), bitcast<f32>(words.w));
}

/// A point between two joints, and where a sample lies beside it.
struct GpuPoint {
    joint: u32,
    next: u32,
    /// The way from the first to the second.
    way: f32,
    v: f32,
    w: f32,
}

/// The point on a stroke that begins at a joint there. A stroke of one joint has none that follows.
fn gpu_point(joint: u32, shown: GpuShown) -> GpuPoint {
    let next = select(joint + 1u, joint, shown.way == 0.0);
    return GpuPoint(joint, next, shown.way, shown.across.x, shown.across.y);
}

fn gpu_between(p: GpuPoint, a: f32, b: f32) -> f32 {
    return a + p.way * (b - a);
}

fn gpu_between3(p: GpuPoint, a: vec3<f32>, b: vec3<f32>) -> vec3<f32> {
    return a + p.way * (b - a);
}

fn gpu_unit_between(p: GpuPoint, a: vec3<f32>, b: vec3<f32>) -> vec3<f32> {
    return unit_or(gpu_between3(p, a, b), a);
}

fn gpu_scalar_at(p: GpuPoint, at: u32) -> f32 {
    return gpu_between(p, gpu_scalar(p.joint, at), gpu_scalar(p.next, at));
}

fn gpu_vec3_at(p: GpuPoint, at: u32) -> vec3<f32> {
    return gpu_between3(p, gpu_vec3(p.joint, at), gpu_vec3(p.next, at));
}

/// The unit normal of a round tube at `w` across it; `otherwise` where it is seen along its axis.
fn gpu_tube_normal(forward: vec3<f32>, to_eye: vec3<f32>, w: f32, otherwise: vec3<f32>) -> vec3<f32> {
    let across = unit_or(cross(forward, to_eye), vec3<f32>(0.0));
    let facing = unit_or(cross(across, forward), vec3<f32>(0.0));
    return select(otherwise, w * across + sqrt(max(1.0 - w * w, 0.0)) * facing, any(facing != vec3<f32>(0.0)));
}
