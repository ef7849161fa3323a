// The textures of a layer that paints, looked up. Composed behind words.wgsl and image.wgsl.

/// What a layer that paints has among its words, from where `GPU_PAINT` says: how many discs it has, how far the head's middle is from
/// the eye (head heights), then of each texture its kind, where its gradient begins, and 1 where it repeats.
const GPU_DISC_COUNT: u32 = 0u;
const GPU_HEAD_DEPTH: u32 = 1u;
const GPU_TEXTURES: u32 = 2u;
const GPU_TEXTURE_WORDS: u32 = 3u;

const GPU_IS_GRADIENT: u32 = 1u;
const GPU_IS_IMAGE: u32 = 2u;

fn gpu_paint_word(place: u32) -> u32 {
    return gpu_words[gpu_words[GPU_PAINT] + place];
}

/// The colour at place `x` of a gradient's row.
fn gpu_row_at(gradient: u32, row: u32, x: f32) -> vec3<f32> {
    let words = gradient + 1u + 4u * row;
    let first = gradient + gpu_words[words + 2u];
    let end = gradient + gpu_words[words + 3u];
    var next = first;
    while (next < end && gpu_word(next) <= x) {
        next += 4u;
    }
    let before = max(next, first + 4u) - 4u;
    let start = vec3<f32>(gpu_word(before + 1u), gpu_word(before + 2u), gpu_word(before + 3u));
    if (next == end || next == first || gpu_words[words + 1u] != 0u) {
        return start;
    }
    let share = (x - gpu_word(before)) / (gpu_word(next) - gpu_word(before));
    return start + (vec3<f32>(gpu_word(next + 1u), gpu_word(next + 2u), gpu_word(next + 3u)) - start) * share;
}

/// The colour of a gradient's rows.
fn gpu_gradient_at(gradient: u32, at: vec2<f32>) -> vec3<f32> {
    let count = gpu_words[gradient];
    var next = 0u;
    while (next < count && gpu_word(gradient + 1u + 4u * next) <= at.y) {
        next++;
    }
    let before = max(next, 1u) - 1u;
    let color = gpu_row_at(gradient, before, at.x);
    if (next == count || next == 0u) {
        return color;
    }
    let start = gpu_word(gradient + 1u + 4u * before);
    let share = (at.y - start) / (gpu_word(gradient + 1u + 4u * next) - start);
    return color + (gpu_row_at(gradient, next, at.x) - color) * share;
}

fn gpu_texel(lookup: Lookup) -> vec4<f32> {
    if (lookup.texture >= GPU_TEXTURE_COUNT) {
        return vec4<f32>(0.0);
    }
    var at = lookup.at;
    if (!gpu_is_finite(at.x)) { at.x = 0.0; }
    if (!gpu_is_finite(at.y)) { at.y = 0.0; }
    let texture = GPU_TEXTURES + GPU_TEXTURE_WORDS * lookup.texture;
    let kind = gpu_paint_word(texture);
    if (kind == GPU_IS_GRADIENT) {
        return vec4<f32>(gpu_gradient_at(gpu_paint_word(texture + 1u), at), 1.0);
    }
    if (kind == GPU_IS_IMAGE) {
        return gpu_image_at(lookup.texture, at, lookup.size, gpu_paint_word(texture + 2u) != 0u);
    }
    return vec4<f32>(0.0);
}
