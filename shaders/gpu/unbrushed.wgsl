// Strokes cover all that they reach. Composed with tiles.wgsl.

const BRUSHED: bool = false;

fn brush_covers(brush: u32, disc: u32, way: f32, v: f32, sample: u32) -> bool {
    return true;
}
