// What one sample of each pixel tells, as planes of words: ids, then numbers, of the features that are declared. Composed behind
// shown.wgsl, with the places of the planes that crates/render/src/gpu/program.rs writes.

/// The samples' colours, and their inverse depths, 0 where nothing is.
@group(0) @binding(5) var<storage, read> gpu_samples: array<vec4<f32>>;
@group(0) @binding(7) var<storage, read_write> gpu_planes: array<u32>;
/// Which sample.
@group(0) @binding(8) var<uniform> gpu_sample: vec4<u32>;

/// The words: how many layers there are, how much normals are a round tube's, where the triangles begin; from `GPU_LAYERS` on the
/// layers; object and normal of each triangle.
const GPU_LAYER_COUNT: u32 = 0u;
const GPU_ROUNDNESS: u32 = 1u;
const GPU_TRIANGLES: u32 = 2u;
const GPU_LAYERS: u32 = 3u;
/// A layer: its first disc, how many it has, its first joint, how many it draws on, its object, the head's height.
const GPU_LAYER_WORDS: u32 = 6u;
const GPU_TRIANGLE_WORDS: u32 = 4u;

const GPU_NO_ID: u32 = 0xffffffffu;

fn gpu_put(plane: u32, at: u32, value: u32) {
    if (plane != GPU_NO_PLANE) {
        gpu_planes[plane * gpu_frame.size.x * gpu_frame.size.y + at] = value;
    }
}

fn gpu_put_number(plane: u32, at: u32, value: f32) {
    gpu_put(plane, at, bitcast<u32>(value));
}

fn gpu_put_three(plane: u32, at: u32, value: vec3<f32>) {
    if (plane != GPU_NO_PLANE) {
        gpu_put_number(plane, at, value.x);
        gpu_put_number(plane + 1u, at, value.y);
        gpu_put_number(plane + 2u, at, value.z);
    }
}

/// The layer that a disc is of, or as many as there are.
fn gpu_layer_of(disc: u32) -> u32 {
    let count = gpu_words[GPU_LAYER_COUNT];
    for (var layer = 0u; layer < count; layer++) {
        let words = GPU_LAYERS + layer * GPU_LAYER_WORDS;
        if (disc - gpu_words[words] < gpu_words[words + 1u]) {
            return layer;
        }
    }
    return count;
}

/// The unit vector along a strand at a joint, of those to its neighbours.
fn gpu_tangent(joint: u32) -> vec3<f32> {
    let forward = gpu_vec3(joint, GPU_AT_FORWARD);
    return unit_or(forward - gpu_vec3(joint, GPU_AT_BACKWARD), forward);
}

fn gpu_normal_of_hair(p: GpuPoint) -> vec3<f32> {
    let clump = gpu_between3(p, gpu_clumps[p.joint].normal, gpu_clumps[p.next].normal);
    let to_eye = gpu_frame.eye - gpu_vec3_at(p, GPU_AT_POSITION);
    let tangent = gpu_between3(p, gpu_tangent(p.joint), gpu_tangent(p.next));
    let tube = gpu_tube_normal(tangent, to_eye, p.w, clump);
    return unit_or(mix(clump, tube, vec3<f32>(gpu_word(GPU_ROUNDNESS))), unit_or(tube, vec3<f32>(0.0, 1.0, 0.0)));
}

@compute @workgroup_size(8, 8)
fn gpu_main(@builtin(global_invocation_id) id: vec3<u32>) {
    if (any(id.xy >= gpu_frame.size)) {
        return;
    }
    let at = id.y * gpu_frame.size.x + id.x;
    let shown = gpu_shown_at(id.xy, gpu_sample.x);
    let color = gpu_samples[at * gpu_frame.samples + gpu_sample.x];
    gpu_put_three(GPU_PLANE_COLOR, at, color.xyz);
    if (GPU_PLANE_COLOR != GPU_NO_PLANE) {
        gpu_put_number(GPU_PLANE_COLOR + 3u, at, select(gpu_frame.background.w, 1.0, color.w > 0.0));
    }
    gpu_put_number(GPU_PLANE_INV_DEPTH, at, shown.inv_depth);
    if ((shown.what & GPU_SHOWS_TRIANGLE) != 0u) {
        var object = 0u;
        var normal = vec3<f32>(0.0);
        if (shown.what != GPU_SHOWS_NOTHING) {
            let triangle = gpu_words[GPU_TRIANGLES] + GPU_TRIANGLE_WORDS * (shown.what & ~GPU_SHOWS_TRIANGLE);
            object = gpu_words[triangle];
            normal = vec3<f32>(gpu_word(triangle + 1u), gpu_word(triangle + 2u), gpu_word(triangle + 3u));
        }
        gpu_put(GPU_PLANE_OBJECT, at, object);
        gpu_put(GPU_PLANE_STRAND, at, GPU_NO_ID);
        gpu_put(GPU_PLANE_PIECE, at, GPU_NO_ID);
        gpu_put(GPU_PLANE_LAYER, at, GPU_NO_ID);
        gpu_put(GPU_PLANE_LEVEL, at, GPU_NO_ID);
        gpu_put_number(GPU_PLANE_U, at, 0.0);
        gpu_put_number(GPU_PLANE_S, at, 0.0);
        gpu_put_number(GPU_PLANE_V, at, 0.0);
        gpu_put_number(GPU_PLANE_W, at, 0.0);
        gpu_put_number(GPU_PLANE_PIXELS, at, 0.0);
        gpu_put_three(GPU_PLANE_NORMAL, at, normal);
        return;
    }
    let layer = gpu_layer_of(shown.what);
    let words = GPU_LAYERS + layer * GPU_LAYER_WORDS;
    let in_layer = (shown.what - gpu_words[words]) % max(gpu_words[words + 3u], 1u);
    let p = gpu_point(gpu_words[words + 2u] + in_layer, shown);
    let head_height = gpu_word(words + 5u);
    gpu_put(GPU_PLANE_OBJECT, at, 2u * gpu_words[words + 4u] + 1u);
    gpu_put(GPU_PLANE_STRAND, at, gpu_of_strand(p.joint, 0u));
    gpu_put(GPU_PLANE_PIECE, at, gpu_joints[p.joint * GPU_JOINT_WORDS + GPU_AT_PIECE]);
    gpu_put(GPU_PLANE_LAYER, at, layer);
    gpu_put(GPU_PLANE_LEVEL, at, gpu_of_strand(p.joint, GPU_STRAND_LEVEL));
    gpu_put_number(GPU_PLANE_U, at, gpu_scalar_at(p, GPU_AT_U));
    gpu_put_number(GPU_PLANE_S, at, gpu_scalar_at(p, GPU_AT_ARC_LENGTH) / head_height);
    gpu_put_number(GPU_PLANE_V, at, p.v);
    gpu_put_number(GPU_PLANE_W, at, p.w);
    gpu_put_number(GPU_PLANE_PIXELS, at, gpu_scalar_at(p, GPU_AT_PX_PER_METRE) * head_height);
    if (GPU_PLANE_NORMAL != GPU_NO_PLANE) {
        gpu_put_three(GPU_PLANE_NORMAL, at, gpu_normal_of_hair(p));
    }
}
