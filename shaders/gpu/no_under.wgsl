// What hair hides is forgotten. Composed with tiles.wgsl.

const KEEPS_UNDER: bool = false;

fn keep_under(at: vec2<u32>, sample: u32, what: vec4<u32>) {}
