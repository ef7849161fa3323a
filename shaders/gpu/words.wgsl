// What a layer or a clump is. Composed with what works out joints, and what paints.

/// What the layer or the clump is and on which head (the places below), its parameters, and how they vary.
@group(0) @binding(3) var<storage, read> gpu_words: array<u32>;

const GPU_LAYER_SEED: u32 = 0u;
const GPU_FIRST_DISC: u32 = 1u;
const GPU_FIRST_JOINT: u32 = 2u;
const GPU_JOINT_COUNT: u32 = 3u;
const GPU_SHORTEST: u32 = 4u;
const GPU_DEPTH_OFFSET: u32 = 5u;
const GPU_IS_IN_PIXELS: u32 = 6u;
const GPU_HAS_OWN_PATHS: u32 = 7u;
/// Metres, as are the next two words.
const GPU_HEAD_CENTER: u32 = 8u;
/// Metres.
const GPU_HEAD_HEIGHT: u32 = 11u;
/// Metres in 1/300 of the head's height.
const GPU_UNIT: u32 = 12u;
/// Where the words begin that lookup.wgsl reads.
const GPU_PAINT: u32 = 13u;
/// The layer's bit in `GPU_STRAND_LEFT_OUT_BY`, 0 of a clump.
const GPU_LAYER_BIT: u32 = 14u;
/// How much nearer the object's strands count against surfaces, metres.
const GPU_SURFACE_BIAS: u32 = 15u;

fn gpu_word(at: u32) -> f32 {
    return bitcast<f32>(gpu_words[at]);
}
