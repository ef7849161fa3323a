/// In a pass with one sample: their mean over what is there, at the depth of the nearest.
fn mean_at(position: vec4<f32>) -> Shown {
    if (is_outside(position)) {
        discard;
    }
    let first = first_sample(position);
    var color = vec3<f32>(0.0);
    var count = 0.0;
    var nearest = 0.0;
    for (var k = 0u; k < gpu_frame.samples; k++) {
        let shown = samples[first + k];
        if (shown.w > 0.0) {
            color += shown.xyz;
            count += 1.0;
            nearest = max(nearest, shown.w);
        }
    }
    if (count == 0.0) {
        discard;
    }
    let alpha = count / f32(gpu_frame.samples);
    return Shown(vec4<f32>(encoded(color / count) * alpha, alpha), depth_in_pass(nearest));
}

@fragment
fn show(@builtin(position) position: vec4<f32>) -> Shown {
    return mean_at(position);
}

/// For a pass without depths.
@fragment
fn show_color(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    return mean_at(position).color;
}
