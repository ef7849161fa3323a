// The colours of the samples that show what a layer for meshes paints, or hair that it is seen through: composed with the effect's own text,
// behind words.wgsl and lookup.wgsl. The CPU's is crates/render/src/cpu/paint_mesh.rs.

@group(0) @binding(0) var<uniform> gpu_frame: GpuFrame;
/// A record for each surface, then four words for each corner of the painted ones: its unit normal, and how much it lies in shadow.
@group(0) @binding(1) var<storage, read> gpu_meshes: array<u32>;
@group(0) @binding(2) var<storage, read> gpu_corners: array<GpuCorner>;
@group(0) @binding(4) var<storage, read> gpu_triangles: array<vec4<u32>>;
/// Where samples lie in their pixel: two in each.
@group(0) @binding(5) var<uniform> gpu_sample_places: array<vec4<f32>, 128>;
/// As told.wgsl writes it.
@group(0) @binding(6) var gpu_shown: texture_2d_array<u32>;
/// The samples' colours, and their inverse depths.
@group(0) @binding(7) var<storage, read_write> gpu_samples: array<vec4<f32>>;
/// As under.wgsl writes it; of one texel where nothing is seen through hair.
@group(0) @binding(8) var gpu_under: texture_2d_array<u32>;

/// As drawn.wgsl has it.
struct GpuCorner {
    position: vec2<f32>,
    inv_depth: f32,
    tone: f32,
}

/// In place of what layers of strokes have there: the layer's number from 1 on, how much is seen through hair, pixels in a metre one metre away.
const GPU_MESH_NUMBER: u32 = 1u;
const GPU_MESH_THROUGH: u32 = 2u;
const GPU_MESH_FOCAL: u32 = 3u;

/// A surface's record: the number of the layer that paints it, 0 for none; its own colours in light and away from it; where its first corner's
/// words would be, if the frame's first corner had some.
const GPU_MESH_WORDS: u32 = 8u;
const GPU_MESH_LIGHT: u32 = 1u;
const GPU_MESH_SHADOW: u32 = 4u;
const GPU_MESH_CORNERS: u32 = 7u;

const GPU_SHOWS_TRIANGLE: u32 = 0x80000000u;
const GPU_SHOWS_NOTHING: u32 = 0xffffffffu;

/// What a decal does to a sample of a mesh: as tiles.wgsl has it.
const GPU_DECAL_COLORS: u32 = 1u;
const GPU_DECAL_SHADES: u32 = 2u;
/// How much a mesh lies in shadow where hair casts one: whatever the light, and wherever it turns to shade.
const GPU_IN_SHADOW: f32 = 3.0;

/// What is seen of a mesh.
struct GpuSeen {
    color: vec3<f32>,
    shade_color: vec3<f32>,
    position: vec3<f32>,
    depth_m: f32,
    normal: vec3<f32>,
    occlusion: f32,
}

fn gpu_mesh_light_direction(p: GpuSeen) -> vec3<f32> {
    if (gpu_frame.light_is_point == 0u) {
        return gpu_frame.light;
    }
    let to_light = gpu_frame.light - p.position;
    let distance = length(to_light);
    return select(vec3<f32>(0.0, 1.0, 0.0), to_light / max(distance, 1e-30), distance > 0.0);
}

/// Head heights; far away where the light has no place.
fn gpu_mesh_light_distance(p: GpuSeen) -> f32 {
    let distance = length(gpu_frame.light - p.position) / gpu_word(GPU_HEAD_HEIGHT);
    return select(1e6, distance, gpu_frame.light_is_point != 0u);
}

fn gpu_mesh_word(at: u32) -> f32 {
    return bitcast<f32>(gpu_meshes[at]);
}

fn gpu_mesh_color(at: u32) -> vec3<f32> {
    return vec3<f32>(gpu_mesh_word(at), gpu_mesh_word(at + 1u), gpu_mesh_word(at + 2u));
}

/// A corner's words times its inverse depth, which run linearly on the screen.
fn gpu_mesh_corner(first: u32, corner: u32) -> vec4<f32> {
    let at = first + 4u * corner;
    return vec4<f32>(gpu_mesh_color(at), gpu_mesh_word(at + 3u)) * gpu_corners[corner].inv_depth;
}

/// What is seen of a triangle at a place of the picture, with that texel.
fn gpu_seen(what: u32, place: vec2<f32>, inv_depth: f32, texel: vec3<f32>) -> GpuSeen {
    let ids = gpu_triangles[what & ~GPU_SHOWS_TRIANGLE];
    let surface = GPU_MESH_WORDS * ids.w;
    let first = gpu_meshes[surface + GPU_MESH_CORNERS];
    let origin = gpu_corners[ids.x].position;
    let ab = gpu_corners[ids.y].position - origin;
    let ac = gpu_corners[ids.z].position - origin;
    let offset = place - origin;
    let area = ab.x * ac.y - ab.y * ac.x;
    let b_share = (offset.x * ac.y - offset.y * ac.x) / area;
    let c_share = (ab.x * offset.y - ab.y * offset.x) / area;
    let a = gpu_mesh_corner(first, ids.x);
    let b = gpu_mesh_corner(first, ids.y);
    let c = gpu_mesh_corner(first, ids.z);
    let mixed = clamp(a + b_share * (b - a) + c_share * (c - a), min(min(a, b), c), max(max(a, b), c));
    let depth_m = 1.0 / inv_depth;
    let from_middle = (place - 0.5 * vec2<f32>(gpu_frame.size)) * (depth_m / gpu_word(GPU_MESH_FOCAL));
    let ahead = cross(gpu_frame.up, gpu_frame.right);
    let away = gpu_frame.right * from_middle.x - gpu_frame.up * from_middle.y + ahead * depth_m;
    return GpuSeen(
        texel * gpu_mesh_color(surface + GPU_MESH_LIGHT),
        texel * gpu_mesh_color(surface + GPU_MESH_SHADOW),
        gpu_frame.eye + away,
        depth_m,
        unit_or(mixed.xyz, vec3<f32>(0.0)),
        mixed.w * depth_m,
    );
}

/// The colour of what is seen, which is the mesh's own where nothing finite is painted.
fn gpu_mesh_painted(seen: GpuSeen) -> vec3<f32> {
    let painted = gpu_painted(gpu_sample(seen, seen.color), gpu_params(0u, 0.0));
    let is_whole = gpu_is_finite(painted.x) && gpu_is_finite(painted.y) && gpu_is_finite(painted.z);
    return clamp(select(seen.color, painted, vec3<bool>(is_whole)), vec3<f32>(0.0), vec3<f32>(1.0));
}

/// Whether the layer paints a triangle.
fn gpu_is_painted(what: u32) -> bool {
    if ((what & GPU_SHOWS_TRIANGLE) == 0u || what == GPU_SHOWS_NOTHING) {
        return false;
    }
    let surface = gpu_triangles[what & ~GPU_SHOWS_TRIANGLE].w;
    return gpu_meshes[GPU_MESH_WORDS * surface] == gpu_words[GPU_MESH_NUMBER];
}

@compute @workgroup_size(8, 8)
fn gpu_main(@builtin(global_invocation_id) id: vec3<u32>) {
    if (any(id.xy >= gpu_frame.size)) {
        return;
    }
    let at = (id.y * gpu_frame.size.x + id.x) * gpu_frame.samples + id.z;
    let pair = gpu_sample_places[id.z / 2u];
    let place = vec2<f32>(id.xy) + select(pair.xy, pair.zw, vec2<bool>((id.z & 1u) != 0u));
    let shown = textureLoad(gpu_shown, id.xy, id.z, 0);
    if (gpu_is_painted(shown.x)) {
        if (shown.y == GPU_DECAL_COLORS) {
            return;
        }
        var seen = gpu_seen(shown.x, place, bitcast<f32>(shown.w), gpu_samples[at].xyz);
        seen.occlusion = select(seen.occlusion, GPU_IN_SHADOW, shown.y == GPU_DECAL_SHADES);
        gpu_samples[at] = vec4<f32>(gpu_mesh_painted(seen), gpu_samples[at].w);
        return;
    }
    let through = gpu_word(GPU_MESH_THROUGH);
    if (through <= 0.0) {
        return;
    }
    let under = textureLoad(gpu_under, id.xy, id.z, 0);
    if (gpu_is_painted(under.x)) {
        let texel = vec3<f32>(unpack2x16float(under.y), unpack2x16float(under.z).x);
        let painted = gpu_mesh_painted(gpu_seen(under.x, place, bitcast<f32>(under.w), texel));
        let hair = gpu_samples[at].xyz;
        gpu_samples[at] = vec4<f32>(hair + (painted - hair) * through, gpu_samples[at].w);
    }
}
