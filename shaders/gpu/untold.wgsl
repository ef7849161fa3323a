// Samples are forgotten once they are drawn. Composed with tiles.wgsl.

const TELLS: bool = false;

fn tell(at: vec2<u32>, sample: u32, what: vec4<u32>) {}
