// The clump of every joint of an object, once for all layers: composed with shaders/clump.wgsl.

@group(0) @binding(4) var<storage, read_write> gpu_clumps: array<GpuClump>;
@group(0) @binding(5) var<storage, read_write> gpu_discs: array<GpuDisc>;

@compute @workgroup_size(64)
fn gpu_main(@builtin(workgroup_id) group: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    let index = gpu_index(group, groups, local);
    if (index >= gpu_words[GPU_JOINT_COUNT]) { return; }
    let joint = gpu_words[GPU_FIRST_JOINT] + index;
    let made = clump(gpu_inputs(joint), gpu_params(joint, gpu_scalar(joint, GPU_AT_U)));
    let gray = max(dot(made.normal, gpu_light_direction(joint)), 0.0);
    let shift = vec2<f32>(dot(gpu_frame.right, made.shift), -dot(gpu_frame.up, made.shift));
    gpu_clumps[joint] = GpuClump(made.normal, made.radius, made.color, gray, shift);
    for (var k = 0u; k < GPU_CLUMP_DISCS; k++) {
        let part = clump_disc(k, made.radius, shift);
        gpu_discs[k * gpu_frame.joints + joint] =
            gpu_disc(joint, shift + vec2<f32>(part.x, part.y), part.z, gpu_unit_px(joint), made.radius, 0.0);
    }
}
