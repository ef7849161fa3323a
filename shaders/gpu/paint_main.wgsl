// The colours of the samples that show a layer that paints: composed with the effect's own text, behind shown.wgsl
// and lookup.wgsl.

@group(0) @binding(5) var<storage, read> gpu_discs: array<GpuDisc>;
/// The samples' colours, and their inverse depths.
@group(0) @binding(7) var<storage, read_write> gpu_samples: array<vec4<f32>>;

/// Unit vector of a sample's stroke as a round tube.
fn gpu_tube(p: GpuPoint) -> vec3<f32> {
    let to_eye = gpu_between3(p, gpu_view_direction(p.joint), gpu_view_direction(p.next));
    let otherwise = unit_or(to_eye, vec3<f32>(0.0, 0.0, 1.0));
    return gpu_tube_normal(gpu_vec3_at(p, GPU_AT_FORWARD), to_eye, p.w, otherwise);
}

@compute @workgroup_size(8, 8)
fn gpu_main(@builtin(global_invocation_id) id: vec3<u32>) {
    if (any(id.xy >= gpu_frame.size)) {
        return;
    }
    let shown = gpu_shown_at(id.xy, id.z);
    let in_layer = shown.what - (gpu_words[GPU_FIRST_DISC] + gpu_words[GPU_FIRST_JOINT]);
    if ((shown.what & GPU_SHOWS_TRIANGLE) != 0u || in_layer >= gpu_paint_word(GPU_DISC_COUNT) || shown.is_decal) {
        return;
    }
    let p = gpu_point(gpu_words[GPU_FIRST_JOINT] + in_layer % gpu_words[GPU_JOINT_COUNT], shown);
    var color = gpu_discs[shown.what].color;
    if (p.way != 0.0) {
        color += p.way * (gpu_discs[shown.what + 1u].color - color);
    }
    let painted = gpu_painted(gpu_sample(p, color), gpu_params(p.joint, gpu_scalar_at(p, GPU_AT_U)));
    // What isn't finite stays as it was.
    if (gpu_is_finite(painted.x) && gpu_is_finite(painted.y) && gpu_is_finite(painted.z)) {
        let at = (id.y * gpu_frame.size.x + id.x) * gpu_frame.samples + id.z;
        let light = clamp(painted, vec3<f32>(0.0), vec3<f32>(1.0));
        gpu_samples[at] = vec4<f32>(light, gpu_samples[at].w);
    }
}
