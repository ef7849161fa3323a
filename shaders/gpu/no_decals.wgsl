// Nothing is drawn on what is seen. Composed with tiles.wgsl.

fn draw_decals(
    tile: vec2<f32>,
    at: u32,
    local: u32,
    pixel: vec2<f32>,
    x: vec4<f32>,
    y: vec4<f32>,
    first_sample: u32,
    samples: ptr<function, Samples>,
) {}
