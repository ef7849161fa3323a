// Pictures, looked up as effects::Image does: between texels, and between copies of half the size each. Composed behind prelude.wgsl, and with
// functions that tell an image's copies, their sizes and their texels.

/// The two texels nearest to a place along a side, and how far it is from the first's middle to the second's.
struct GpuNearest {
    first: u32,
    second: u32,
    share: f32,
}

fn gpu_nearest(place: f32, side: u32, repeats: bool) -> GpuNearest {
    let inside = select(clamp(place, 0.0, 1.0), place - floor(place), repeats);
    let texel = inside * f32(side) - 0.5;
    let first = floor(texel);
    return GpuNearest(
        gpu_texel_index(i32(first), side, repeats),
        gpu_texel_index(i32(first) + 1, side, repeats),
        texel - first,
    );
}

fn gpu_texel_index(index: i32, side: u32, repeats: bool) -> u32 {
    let count = i32(side);
    if (repeats) {
        return u32(((index % count) + count) % count);
    }
    return u32(clamp(index, 0, count - 1));
}

/// One of an image's copies, between the middles of the four nearest texels.
fn gpu_copy_at(texture: u32, level: u32, place: vec2<f32>, repeats: bool) -> vec4<f32> {
    let size = gpu_image_size(texture, level);
    let across = gpu_nearest(place.x, size.x, repeats);
    let down = gpu_nearest(place.y, size.y, repeats);
    let a = gpu_image_texel(texture, level, vec2<u32>(across.first, down.first));
    let b = gpu_image_texel(texture, level, vec2<u32>(across.second, down.first));
    let c = gpu_image_texel(texture, level, vec2<u32>(across.first, down.second));
    let d = gpu_image_texel(texture, level, vec2<u32>(across.second, down.second));
    let above = a + (b - a) * across.share;
    let below = c + (d - c) * across.share;
    return above + (below - above) * down.share;
}

/// The texel of an image, blurred over `size` of its width; a size that is no number blurs nothing.
fn gpu_image_at(texture: u32, place: vec2<f32>, size: f32, repeats: bool) -> vec4<f32> {
    let last = gpu_image_levels(texture) - 1u;
    var level = 0.0;
    if (gpu_is_finite(size)) {
        let texels = max(size, 0.0) * f32(gpu_image_size(texture, 0u).x);
        if (texels > 1.0) {
            level = min(log_to_two(min(texels, 1e6)), f32(last));
        }
    } else if (bitcast<u32>(size) == 0x7f800000u) {
        level = f32(last);
    }
    let finer = floor(level);
    let share = level - finer;
    var texel = gpu_copy_at(texture, u32(finer), place, repeats);
    if (share > 0.0) {
        let coarser = gpu_copy_at(texture, min(u32(finer) + 1u, last), place, repeats);
        texel += (coarser - texel) * share;
    }
    if (texel.w <= 0.0) {
        return vec4<f32>(0.0);
    }
    return vec4<f32>(texel.xyz / texel.w, texel.w);
}
