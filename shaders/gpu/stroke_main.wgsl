// The strokes of a layer at every joint: composed with the effect's own text.

@group(0) @binding(4) var<storage, read> gpu_clumps: array<GpuClump>;
@group(0) @binding(5) var<storage, read_write> gpu_discs: array<GpuDisc>;

@compute @workgroup_size(64)
fn gpu_main(@builtin(workgroup_id) group: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    let index = gpu_index(group, groups, local);
    if (index >= gpu_words[GPU_JOINT_COUNT]) { return; }
    let joint = gpu_words[GPU_FIRST_JOINT] + index;
    let at = gpu_first_disc(group.z) + joint;
    var made = stroke(gpu_inputs(joint), group.z, gpu_params(joint, gpu_scalar(joint, GPU_AT_U)));
    let is_left_out = (gpu_of_strand(joint, GPU_STRAND_LEFT_OUT_BY) & gpu_words[GPU_LAYER_BIT]) != 0u;
    if (is_left_out || !gpu_is_whole(made)) {
        // A stroke of another zone's hair, or one that an effect failed to work out, is not drawn.
        made = Stroke(vec2<f32>(0.0), 0.0, 0.0, vec3<f32>(0.0));
    }
    let clump_radius = gpu_clumps[joint].radius;
    let depth_offset = gpu_word(GPU_DEPTH_OFFSET) + made.depth_offset;
    // What is to be smoothed stays in units of size.
    let is_smoothed = gpu_word(GPU_SHORTEST) > 0.0;
    let scale = select(gpu_unit_px(joint), 1.0, is_smoothed);
    let offset = gpu_clumps[joint].shift + made.offset;
    var disc = gpu_disc(joint, offset, made.radius, scale, clump_radius, depth_offset);
    disc.color = made.color;
    if (!is_smoothed) {
        let is_tip = joint == gpu_joints[joint * GPU_JOINT_WORDS + GPU_AT_RUN + 1u];
        if (gpu_frame.is_semicircle != 0u && is_tip && gpu_scalar(joint, GPU_AT_U) == 1.0) {
            disc.center += gpu_ahead(joint, made.radius, clump_radius);
        }
        if (gpu_words[GPU_HAS_OWN_PATHS] != 0u && group.z == 0u) {
            // No strand's clump holds them: they are their own.
            gpu_discs[joint] = disc;
            for (var k = 1u; k < GPU_CLUMP_DISCS; k++) {
                gpu_discs[k * gpu_frame.joints + joint].radius = 0.0;
            }
        }
    }
    gpu_discs[at] = disc;
}
