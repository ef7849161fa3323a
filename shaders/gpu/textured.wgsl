// Pictures on surfaces. Composed with tiles.wgsl, behind atlas.wgsl; the CPU's is crates/render/src/cpu/texels.rs.

const TEXTURED: bool = true;

/// In a surface's record: where its image's record begins (0 is none), and the place of the frame's first corner, if it had one; whether the
/// picture repeats; what coverage means, and where it is cut.
const SURFACE_IMAGE: u32 = 7u;
const SURFACE_PLACES: u32 = 8u;
const SURFACE_REPEATS: u32 = 9u;
const SURFACE_COVERAGE: u32 = 10u;
const SURFACE_CUT: u32 = 11u;
const COVERAGE_CUTS: u32 = 1u;
const COVERAGE_SHARES: u32 = 2u;

fn place_of(surface: u32, corner: u32) -> vec2<f32> {
    let words = tables[surface + SURFACE_PLACES] + 2u * corner;
    return vec2<f32>(table(words), table(words + 1u));
}

/// The texel of a triangle in the middle of a pixel's samples; white without a picture. `depth` is its inverse depth.
fn texel_of(surface: u32, index: u32, tile: vec2<f32>, middle: vec2<f32>, depth: vec3<f32>, depth_range: vec2<f32>) -> vec4<f32> {
    let image = tables[surface + SURFACE_IMAGE];
    if (image == 0u) {
        return vec4<f32>(1.0);
    }
    let ids = triangles[index].corners;
    let a = corners[ids.x];
    let b = corners[ids.y];
    let c = corners[ids.z];
    let pa = a.position - tile;
    let pb = b.position - tile;
    let pc = c.position - tile;
    let ab = pb - pa;
    let ac = pc - pa;
    let area = ab.x * ac.y - ab.y * ac.x;
    let edges = array<vec3<f32>, 3>(edge(pb, pc), edge(pc, pa), edge(pa, pb));
    let ua = place_of(surface, ids.x);
    let ub = place_of(surface, ids.y);
    let uc = place_of(surface, ids.z);
    let inv_depths = vec3<f32>(a.inv_depth, b.inv_depth, c.inv_depth);
    let across = linear(vec3<f32>(ua.x, ub.x, uc.x) * inv_depths, edges, area);
    let down = linear(vec3<f32>(ua.y, ub.y, uc.y) * inv_depths, edges, area);
    let here = vec3<f32>(1.0, middle);
    let inv_depth = clamp(dot(depth, here), depth_range.x, depth_range.y);
    let place = clamp(vec2<f32>(dot(across, here), dot(down, here)) / inv_depth, min(min(ua, ub), uc), max(max(ua, ub), uc));
    let size = vec2<f32>(gpu_image_size(image, 0u));
    let along = ub - ua;
    let beside = uc - ua;
    let twice_area = abs(along.x * beside.y - along.y * beside.x) * (size.y / size.x);
    return gpu_image_at(image, place, sqrt(twice_area / abs(area)), tables[surface + SURFACE_REPEATS] != 0u);
}

/// Which of four samples of a pixel show the surface of that number where its picture has that coverage.
fn is_covered(surface: u32, number: u32, coverage: f32, first_sample: u32) -> vec4<bool> {
    let means = tables[surface + SURFACE_COVERAGE];
    if (tables[surface + SURFACE_IMAGE] == 0u || means == 0u) {
        return vec4<bool>(true);
    }
    if (means == COVERAGE_CUTS) {
        return vec4<bool>(coverage >= table(surface + SURFACE_CUT));
    }
    if (gpu_frame.samples == 1u) {
        return vec4<bool>(coverage > 0.5);
    }
    let parts = vec4<f32>(
        scatter(number, first_sample),
        scatter(number, first_sample + 1u),
        scatter(number, first_sample + 2u),
        scatter(number, first_sample + 3u),
    );
    return vec4<f32>(coverage) > parts;
}
