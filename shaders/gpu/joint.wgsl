// A joint's inputs to an effect, and its discs on the screen. Composed behind an effect's own text, the prelude and words.wgsl, with
// constants that crates/render/src/gpu/program.rs writes: JOINT_WORDS, the AT_ places in a joint's record, and the parameters.

@group(0) @binding(0) var<uniform> gpu_frame: GpuFrame;
@group(0) @binding(1) var<storage, read> gpu_joints: array<u32>;
/// Id, mean of the particles, size, taper, how much nearer it is ordered, level.
@group(0) @binding(2) var<storage, read> gpu_strands: array<u32>;

/// A strand: its id, mean place, size, taper, lift, colours at root and tip, level, the layers that leave it out.
const GPU_STRAND_WORDS: u32 = 16u;
const GPU_STRAND_LEVEL: u32 = 14u;
const GPU_STRAND_LEFT_OUT_BY: u32 = 15u;

/// Where the discs of one of the layer's strokes would begin, if the frame's first joint had one.
fn gpu_first_disc(instance: u32) -> u32 {
    return gpu_words[GPU_FIRST_DISC] + instance * gpu_words[GPU_JOINT_COUNT];
}

fn gpu_scalar(joint: u32, at: u32) -> f32 {
    return bitcast<f32>(gpu_joints[joint * GPU_JOINT_WORDS + at]);
}

fn gpu_vec2(joint: u32, at: u32) -> vec2<f32> {
    return vec2<f32>(gpu_scalar(joint, at), gpu_scalar(joint, at + 1u));
}

fn gpu_vec3(joint: u32, at: u32) -> vec3<f32> {
    return vec3<f32>(gpu_scalar(joint, at), gpu_scalar(joint, at + 1u), gpu_scalar(joint, at + 2u));
}

/// A word of the strand's record.
fn gpu_of_strand(joint: u32, word: u32) -> u32 {
    return gpu_strands[gpu_joints[joint * GPU_JOINT_WORDS + GPU_AT_STRAND] * GPU_STRAND_WORDS + word];
}

fn gpu_strand_mean(joint: u32) -> vec3<f32> {
    return vec3<f32>(
        bitcast<f32>(gpu_of_strand(joint, 1u)),
        bitcast<f32>(gpu_of_strand(joint, 2u)),
        bitcast<f32>(gpu_of_strand(joint, 3u)),
    );
}

fn gpu_strand_taper(joint: u32) -> vec2<f32> {
    return vec2<f32>(bitcast<f32>(gpu_of_strand(joint, 5u)), bitcast<f32>(gpu_of_strand(joint, 6u)));
}

/// A colour that begins at that word of the strand's record.
fn gpu_strand_color(joint: u32, word: u32) -> vec3<f32> {
    return vec3<f32>(
        bitcast<f32>(gpu_of_strand(joint, word)),
        bitcast<f32>(gpu_of_strand(joint, word + 1u)),
        bitcast<f32>(gpu_of_strand(joint, word + 2u)),
    );
}

/// The seed of the joint's strand in this layer, whose own seed comes first among the words.
fn gpu_seed(joint: u32) -> u32 {
    return hash(gpu_words[GPU_LAYER_SEED] ^ hash(gpu_of_strand(joint, 0u)));
}

fn gpu_head_center() -> vec3<f32> {
    return vec3<f32>(gpu_word(GPU_HEAD_CENTER), gpu_word(GPU_HEAD_CENTER + 1u), gpu_word(GPU_HEAD_CENTER + 2u));
}

fn gpu_light_direction(joint: u32) -> vec3<f32> {
    if (gpu_frame.light_is_point == 0u) {
        return gpu_frame.light;
    }
    let to_light = gpu_frame.light - gpu_vec3(joint, GPU_AT_POSITION);
    let distance = length(to_light);
    return select(vec3<f32>(0.0, 1.0, 0.0), to_light / max(distance, 1e-30), distance > 0.0);
}

/// Head heights; far away where the light has no place.
fn gpu_light_distance(joint: u32) -> f32 {
    let distance = length(gpu_frame.light - gpu_vec3(joint, GPU_AT_POSITION)) / gpu_word(GPU_HEAD_HEIGHT);
    return select(1e6, distance, gpu_frame.light_is_point != 0u);
}

/// To the right, down and to the eye.
fn gpu_light_on_screen(joint: u32) -> vec3<f32> {
    let light = gpu_light_direction(joint);
    let to_eye = cross(gpu_frame.right, gpu_frame.up);
    return vec3<f32>(dot(light, gpu_frame.right), -dot(light, gpu_frame.up), dot(light, to_eye));
}

/// Head heights; of the joint's place, as `GPU_AT_DEPTH` is deeper where a piece goes on beyond its cut.
fn gpu_depth(joint: u32) -> f32 {
    let ahead = cross(gpu_frame.up, gpu_frame.right);
    return dot(gpu_vec3(joint, GPU_AT_POSITION) - gpu_frame.eye, ahead) / gpu_word(GPU_HEAD_HEIGHT);
}

fn gpu_view_direction(joint: u32) -> vec3<f32> {
    return unit_or(gpu_frame.eye - gpu_vec3(joint, GPU_AT_POSITION), vec3<f32>(0.0, 0.0, 1.0));
}

/// One unit of the layer's widths in 1/300 of the head's height.
fn gpu_unit(joint: u32) -> f32 {
    return select(1.0, gpu_frame.pixel_px / gpu_unit_px(joint), gpu_words[GPU_IS_IN_PIXELS] != 0u);
}

/// Pixels in a unit of size.
fn gpu_unit_px(joint: u32) -> f32 {
    return gpu_word(GPU_UNIT) * gpu_scalar(joint, GPU_AT_PX_PER_METRE);
}

/// The value of a number that varies. Its table begins at `table`: seed, share by which strands differ, least and
/// greatest value, number of places; then the places along the strand with their values.
fn gpu_varied(table: u32, u: f32, strand: u32) -> f32 {
    let places = gpu_words[table + 4u];
    let first = table + 5u;
    var value = gpu_word(first + 1u);
    for (var k = 0u; k < places; k++) {
        let place = gpu_word(first + 2u * k);
        if (place > u) {
            break;
        }
        value = gpu_word(first + 2u * k + 1u);
        if (k + 1u < places) {
            let next = gpu_word(first + 2u * k + 2u);
            if (next > u) {
                value += (gpu_word(first + 2u * k + 3u) - value) * (u - place) / (next - place);
            }
        }
    }
    let factor = 1.0 + gpu_word(table + 1u) * random_signed(strand ^ gpu_words[table], 0u);
    return clamp(value * factor, gpu_word(table + 2u), gpu_word(table + 3u));
}

/// Whether a number is neither infinite nor NaN, by its bits: compilers may assume that all numbers are finite.
fn gpu_is_whole(stroke: Stroke) -> bool {
    return gpu_is_finite(stroke.offset.x) && gpu_is_finite(stroke.offset.y) && gpu_is_finite(stroke.radius)
        && gpu_is_finite(stroke.depth_offset) && gpu_is_finite(stroke.color.x)
        && gpu_is_finite(stroke.color.y) && gpu_is_finite(stroke.color.z);
}

/// No disc is larger, in pixels: it already covers any picture.
const GPU_LARGEST_PX: f32 = 1e8;

/// A disc on the screen of a clump with that radius. `radius` is in pixels or still in units, as `scale` says.
fn gpu_disc(joint: u32, offset: vec2<f32>, radius: f32, scale: f32, clump_radius: f32, depth_offset: f32) -> GpuDisc {
    let depth = gpu_scalar(joint, GPU_AT_DEPTH);
    // No depth is nearer than the near plane, whatever is taken from it.
    let lift = bitcast<f32>(gpu_of_strand(joint, 7u));
    let shifted = max(depth + (depth_offset - lift) * gpu_word(GPU_HEAD_HEIGHT), gpu_frame.near_m);
    let biased = max(depth - clump_radius * gpu_word(GPU_UNIT) - gpu_word(GPU_SURFACE_BIAS), gpu_frame.near_m);
    return GpuDisc(
        gpu_vec2(joint, GPU_AT_CENTER) + offset * gpu_unit_px(joint),
        min(max(radius, 0.0) * scale, GPU_LARGEST_PX),
        1.0 / shifted,
        vec3<f32>(0.0),
        1.0 / biased,
    );
}

/// How far the tip of a stroke that is wider than its clump is moved on, or an outline would end where its clump
/// does: half discs leave it flat.
fn gpu_ahead(joint: u32, radius: f32, clump_radius: f32) -> vec2<f32> {
    let wider = max(radius - clump_radius, 0.0);
    let across = gpu_vec2(joint, GPU_AT_ACROSS);
    // The path on the screen, of which `across` is a right angle to the right.
    return vec2<f32>(across.y, -across.x) * min(wider * gpu_unit_px(joint), GPU_LARGEST_PX);
}
