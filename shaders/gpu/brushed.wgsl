// Strokes leave bare what their brushes do, as told at render::Brushwork. Composed with tiles.wgsl, behind atlas.wgsl; the CPU's is
// crates/render/src/cpu/brush.rs, and crates/effects/src/brush.rs.

const BRUSHED: bool = true;

/// A brush's record in the tables: the layer's seed; its first disc, the first joint that it draws on, and how many; where the joints' records
/// begin; head heights along the strand of a copy or a whole mark, 0 where a copy is stretched; how many whole marks a copy is made of, 0 where they may be cut; whether
/// it shows outside of its clump alone; whether its pictures tell how far within a shape a place lies; then how many pictures there are, and where each one's record begins.
const BRUSH_SEED: u32 = 0u;
const BRUSH_FIRST_DISC: u32 = 1u;
const BRUSH_FIRST_JOINT: u32 = 2u;
const BRUSH_JOINTS: u32 = 3u;
const BRUSH_ALONG: u32 = 4u;
const BRUSH_LENGTH: u32 = 5u;
const BRUSH_PARTS: u32 = 6u;
const BRUSH_IS_OUTLINE: u32 = 7u;
const BRUSH_IS_SHAPE: u32 = 8u;
const BRUSH_MARKS: u32 = 9u;

/// Where along its strand a joint is: the length up to there and the whole length (head heights), pixels of a head's height, the strand's id.
const ALONG_WORDS: u32 = 4u;
const ALONG_STRAND: u32 = 3u;

const MOST_LOOKUPS: f32 = 4.0;
const TINY_LENGTH: f32 = 1e-6;

/// Which of four samples a brush covers, beside a stroke of its layer that reaches these: by the place of the first of them, on the way from a disc to the next.
fn brush_covers(brush: u32, reached: vec4<bool>, discs_of: vec4<u32>, ways: vec4<f32>, vs: vec4<f32>, first_sample: u32) -> vec4<bool> {
    if (!any(reached)) {
        return vec4<bool>(false);
    }
    var k = 3u;
    if (reached.x) {
        k = 0u;
    } else if (reached.y) {
        k = 1u;
    } else if (reached.z) {
        k = 2u;
    }
    let disc = discs_of[k];
    let way = ways[k];
    let v = vs[k];

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
    let coverage = brush_coverage(brush, seed, along, across.x, across.y);
    if (gpu_frame.samples == 1u) {
        return vec4<bool>(coverage > 0.5);
    }
    let parts = vec4<f32>(scatter(seed, first_sample), scatter(seed, first_sample + 1u), scatter(seed, first_sample + 2u), scatter(seed, first_sample + 3u));
    return vec4<f32>(coverage) > parts;
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
    let told = marked(brush, seed, along_strand, v, radius);
    if (tables[brush + BRUSH_IS_SHAPE] == 0u) {
        return told;
    }
    // The edge is a pixel broad.
    return saturate(0.5 + (told - 0.5) * 2.0 * radius);
}

/// What a brush's marks tell of the place.
fn marked(brush: u32, seed: u32, along_strand: vec3<f32>, v: f32, radius: f32) -> f32 {
    let mixed = hash(seed);
    let mark = tables[brush + BRUSH_MARKS + 1u + mixed % tables[brush + BRUSH_MARKS]];
    let y = 0.5 + 0.5 * select(-1.0, 1.0, (mixed & 0x100u) == 0u) * v;
    let start = f32(mixed >> 9u) / 8388608.0;
    let own = table(brush + BRUSH_LENGTH);
    let parts = f32(tables[brush + BRUSH_PARTS]);
    let whole = max(along_strand.y, TINY_LENGTH);
    if (own <= 0.0) {
        return laid(mark, vec2<f32>(along_strand.x / whole, y), whole, along_strand.z, radius, false);
    }
    if (parts == 0.0) {
        return laid(mark, vec2<f32>(along_strand.x / own + start, y), own, along_strand.z, radius, true);
    }
    let first = floor(start * parts);
    let fitting = clamp(along_strand.y / own, 1.0, 1e6);
    let count = floor(fitting);
    let t = clamp((fitting - count - 0.4) / 0.2, 0.0, 1.0);
    let more = t * t * (3.0 - 2.0 * t);
    var covered = vec2<f32>(0.0);
    for (var i = 0u; i < 2u; i += 1u) {
        if (select((more < 1.0), (more > 0.0), i == 1u)) {
            let length = whole / (count + f32(i));
            covered[i] = laid(mark, vec2<f32>((first + along_strand.x / length) / parts, y), length * parts, along_strand.z, radius, true);
        }
    }
    return covered.x * (1.0 - more) + covered.y * more;
}

/// The same where the mark's texture lies so that the place is at `at` of it, and a copy is `length` long (head heights).
fn laid(mark: u32, at: vec2<f32>, length: f32, pixels: f32, radius: f32, repeats: bool) -> f32 {
    let size = vec2<f32>(gpu_image_size(mark, 0u));
    // Texels of a pixel along the stroke and across it.
    let along = min(size.x / max(pixels * length, TINY_LENGTH), size.x);
    let across = min(size.y / max(2.0 * radius, TINY_LENGTH), size.y);
    let longer = max(along, across);
    let texels = max(max(min(along, across), longer / MOST_LOOKUPS), 1.0);
    let parts = clamp(longer / texels, 1.0, MOST_LOOKUPS);
    let level = min(log_to_two(texels), f32(gpu_image_levels(mark) - 1u));
    var sum = 0.0;
    for (var done = 0.0; done < parts; done += 1.0) {
        let part = min(parts - done, 1.0);
        let shift = (done + 0.5 * part - 0.5 * parts) * texels;
        let place = at + select(vec2<f32>(0.0, shift / size.y), vec2<f32>(shift / size.x, 0.0), along > across);
        sum += part * mark_at(mark, level, place, repeats);
    }
    return sum / parts;
}

/// A mark's coverage at a place, between two of its copies.
fn mark_at(mark: u32, level: f32, place: vec2<f32>, repeats: bool) -> f32 {
    let finer = floor(level);
    let covered = mark_copy_at(mark, u32(finer), place, repeats);
    if (level <= finer) {
        return covered;
    }
    return covered + (mark_copy_at(mark, u32(finer) + 1u, place, repeats) - covered) * (level - finer);
}

/// That of one copy. What repeats does so along the stroke alone.
fn mark_copy_at(mark: u32, level: u32, place: vec2<f32>, repeats: bool) -> f32 {
    let size = gpu_image_size(mark, level);
    let across = gpu_nearest(place.x, size.x, repeats);
    let down = gpu_nearest(place.y, size.y, false);
    let a = gpu_image_texel(mark, level, vec2<u32>(across.first, down.first)).w;
    let b = gpu_image_texel(mark, level, vec2<u32>(across.second, down.first)).w;
    let c = gpu_image_texel(mark, level, vec2<u32>(across.first, down.second)).w;
    let d = gpu_image_texel(mark, level, vec2<u32>(across.second, down.second)).w;
    let above = a + (b - a) * across.share;
    let below = c + (d - c) * across.share;
    return above + (below - above) * down.share;
}
