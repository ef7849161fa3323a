// Strokes leave bare what their brushes do, as told at render::Brushwork. Composed with tiles.wgsl, behind atlas.wgsl; the CPU's is
// crates/render/src/cpu/brush.rs, and crates/effects/src/brush.rs.

const BRUSHED: bool = true;

/// A brush's record in the tables: the layer's seed; its first disc, the first joint that it draws on, and how many; where the joints' records
/// begin; head heights along the strand, 0 where it is stretched; whether it shows outside of its clump alone; then how many pictures there are, and where each one's record begins.
const BRUSH_SEED: u32 = 0u;
const BRUSH_FIRST_DISC: u32 = 1u;
const BRUSH_FIRST_JOINT: u32 = 2u;
const BRUSH_JOINTS: u32 = 3u;
const BRUSH_ALONG: u32 = 4u;
const BRUSH_LENGTH: u32 = 5u;
const BRUSH_IS_OUTLINE: u32 = 6u;
const BRUSH_MARKS: u32 = 7u;

/// Where along its strand a joint is: the length up to there and the whole length (head heights), pixels of a head's height, the strand's id.
const ALONG_WORDS: u32 = 4u;
const ALONG_STRAND: u32 = 3u;

const MOST_LOOKUPS: f32 = 4.0;
const TINY_LENGTH: f32 = 1e-6;

/// Whether a brush covers a sample beside a stroke of its layer, on the way from a disc to the next.
fn brush_covers(brush: u32, disc: u32, way: f32, v: f32, sample: u32) -> bool {
    let in_layer = disc - tables[brush + BRUSH_FIRST_DISC];
    let joints = max(tables[brush + BRUSH_JOINTS], 1u);
    let joint = tables[brush + BRUSH_FIRST_JOINT] + in_layer % joints;
    // A stroke of one joint has none that follows.
    let step = select(1u, 0u, way == 0.0);
    let first = tables[brush + BRUSH_ALONG] + ALONG_WORDS * joint;
    let second = first + ALONG_WORDS * step;
    let start = vec3<f32>(table(first), table(first + 1u), table(first + 2u));
    let along = start + way * (vec3<f32>(table(second), table(second + 1u), table(second + 2u)) - start);
    let radius = discs[disc].radius + way * (discs[disc + step].radius - discs[disc].radius);
    var across = vec2<f32>(v, radius);
    if (tables[brush + BRUSH_IS_OUTLINE] != 0u) {
        // The clump's discs are the first, one a joint.
        across = on_outline(v, radius, discs[joint].radius + way * (discs[joint + step].radius - discs[joint].radius));
    }
    let seed = hash((tables[brush + BRUSH_SEED] + in_layer / joints) ^ hash(tables[first + ALONG_STRAND]));
    let part = select(scatter(seed, sample), 0.5, gpu_frame.samples == 1u);
    return brush_coverage(brush, seed, along, across.x, across.y) > part;
}

/// The place across an outline, whose stroke shows outside of a clump of this radius alone, and half the outline's width.
fn on_outline(v: f32, radius: f32, clump: f32) -> vec2<f32> {
    let width = radius - clump;
    if (clump <= 0.0 || width <= 0.0) {
        return vec2<f32>(v, radius);
    }
    let from_middle = 2.0 * (abs(v) * radius - clump) / width - 1.0;
    return vec2<f32>(select(1.0, -1.0, v < 0.0) * clamp(from_middle, -1.0, 1.0), 0.5 * width);
}

/// How much of a pixel a brush covers there, 0 to 1.
fn brush_coverage(brush: u32, seed: u32, along_strand: vec3<f32>, v: f32, radius: f32) -> f32 {
    let mixed = hash(seed);
    let mark = tables[brush + BRUSH_MARKS + 1u + mixed % tables[brush + BRUSH_MARKS]];
    let side = select(-1.0, 1.0, (mixed & 0x100u) == 0u);
    let own = table(brush + BRUSH_LENGTH);
    let repeats = own > 0.0;
    let size = vec2<f32>(gpu_image_size(mark, 0u));
    let length = max(select(along_strand.y, own, repeats), TINY_LENGTH);
    let at = vec2<f32>(
        along_strand.x / length + select(0.0, f32(mixed >> 9u) / 8388608.0, repeats),
        0.5 + 0.5 * side * v,
    );
    // Texels of a pixel along the stroke and across it.
    let along = min(size.x / max(along_strand.z * length, TINY_LENGTH), size.x);
    let across = min(size.y / max(2.0 * radius, TINY_LENGTH), size.y);
    let longer = max(along, across);
    let texels = max(max(min(along, across), longer / MOST_LOOKUPS), 1.0);
    let count = clamp(ceil(longer / texels), 1.0, MOST_LOOKUPS);
    let level = u32(log_to_two(texels)) + 1u;
    let edge = 0.5 / f32(gpu_image_size(mark, min(level, gpu_image_levels(mark) - 1u)).y);
    var sum = 0.0;
    for (var i = 0.0; i < count; i += 1.0) {
        let shift = ((i + 0.5) / count - 0.5) * longer;
        let place = at + select(vec2<f32>(0.0, shift / size.y), vec2<f32>(shift / size.x, 0.0), along > across);
        let inside = vec2<f32>(place.x, clamp(place.y, edge, 1.0 - edge));
        sum += gpu_image_at(mark, inside, texels / size.x, repeats).w;
    }
    return sum / count;
}
