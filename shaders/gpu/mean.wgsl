// The means of all samples. Composed behind frame.wgsl.

@group(0) @binding(0) var<uniform> gpu_frame: GpuFrame;
/// Their colours, and their inverse depths, 0 where nothing is.
@group(0) @binding(1) var<storage, read> samples: array<vec4<f32>>;
@group(0) @binding(2) var<storage, read_write> means: array<vec4<f32>>;

@compute @workgroup_size(8, 8)
fn take_means(@builtin(global_invocation_id) id: vec3<u32>) {
    if (any(id.xy >= gpu_frame.size)) {
        return;
    }
    let at = id.y * gpu_frame.size.x + id.x;
    var sum = vec4<f32>(0.0);
    for (var k = 0u; k < gpu_frame.samples; k++) {
        let shown = samples[at * gpu_frame.samples + k];
        sum += vec4<f32>(shown.xyz, select(gpu_frame.background.w, 1.0, shown.w > 0.0));
    }
    means[at] = sum / f32(gpu_frame.samples);
}
