/// In a pass with as many samples as were prepared: each by itself.
fn sample_at(position: vec4<f32>, index: u32) -> Shown {
    if (is_outside(position)) {
        discard;
    }
    let shown = samples[first_sample(position) + index];
    if (shown.w <= 0.0) {
        discard;
    }
    return Shown(vec4<f32>(encoded(shown.xyz), 1.0), depth_in_pass(shown.w));
}

@fragment
fn show(@builtin(position) position: vec4<f32>, @builtin(sample_index) index: u32) -> Shown {
    return sample_at(position, index);
}

/// For a pass without depths.
@fragment
fn show_color(@builtin(position) position: vec4<f32>, @builtin(sample_index) index: u32) -> @location(0) vec4<f32> {
    return sample_at(position, index).color;
}
