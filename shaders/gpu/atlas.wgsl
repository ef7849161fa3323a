// Pictures in the rows of one texture, and which samples of a pixel show what covers a part of it. Composed with tiles.wgsl, behind image.wgsl.

/// Texels in a row of the texture that holds all pictures, one copy behind the other.
const ATLAS_WIDTH: u32 = 4096u;

/// An image's record: how many copies it has; of each its width, its height and its first texel.
fn gpu_image_levels(image: u32) -> u32 {
    return tables[image];
}

fn gpu_image_size(image: u32, level: u32) -> vec2<u32> {
    let words = image + 1u + 3u * level;
    return vec2<u32>(tables[words], tables[words + 1u]);
}

fn gpu_image_texel(image: u32, level: u32, at: vec2<u32>) -> vec4<f32> {
    let words = image + 1u + 3u * level;
    let texel = tables[words + 2u] + at.y * tables[words] + at.x;
    return textureLoad(atlas, vec2<u32>(texel % ATLAS_WIDTH, texel / ATLAS_WIDTH), 0);
}

/// As crate::drawing::scatter.
fn scatter(strand: u32, sample: u32) -> f32 {
    var mixed = (strand ^ (strand >> 16u)) * 0x45D9F3B5u;
    mixed = (mixed ^ (mixed >> 15u)) * 0x2C1B3C6Du;
    return f32((mixed + sample * 0x9E3779B9u) >> 8u) / 16777216.0;
}
