// What all passes on a GPU know of a frame, and the strokes' discs.
// The Rust side of these structs is crates/render/src/gpu/layout.rs.

struct GpuFrame {
    /// Width and height in pixels.
    size: vec2<u32>,
    /// Columns and rows of tiles.
    tiles: vec2<u32>,
    joints: u32,
    chunks: u32,
    triangles: u32,
    /// Samples in a pixel.
    samples: u32,
    /// Place of the eye, metres.
    eye: vec3<f32>,
    near_m: f32,
    /// The unit vector to the light, or its place.
    light: vec3<f32>,
    light_is_point: u32,
    /// Linear colour; the last is 0 for a transparent picture.
    background: vec4<f32>,
    /// The camera's axis to the picture's right, a unit vector.
    right: vec3<f32>,
    /// A pixel at 720 lines, in pixels.
    pixel_px: f32,
    /// The camera's axis to the picture's upper edge, a unit vector.
    up: vec3<f32>,
    edge_depth_m: f32,
    /// Entries that the tiles' lists of chunks and of triangles have room for.
    chunk_capacity: u32,
    triangle_capacity: u32,
    is_semicircle: u32,
    /// Where the surfaces' records begin among the tables.
    surfaces_at: u32,
    /// 0 to write the mean of each pixel, 1 every sample.
    writes_samples: u32,
    time_s: f32,
    /// Where the tables say which pieces are one strand: how many pieces, then a number for each; 0 where each is its own.
    same_strands_at: u32,
    /// The strokes with numbers from 1 to this have a negative rank.
    outlines: u32,
}

/// One disc of a stroke on the screen.
struct GpuDisc {
    /// Pixels.
    center: vec2<f32>,
    /// Pixels.
    radius: f32,
    /// 1/m, the order among strands.
    inv_depth: f32,
    /// Linear.
    color: vec3<f32>,
    /// 1/m, the order against surfaces.
    biased: f32,
}

/// The clump of a joint.
struct GpuClump {
    normal: vec3<f32>,
    radius: f32,
    color: vec3<f32>,
    gray: f32,
    /// On the screen (x right, y down), in units of size.
    shift: vec2<f32>,
}

fn gpu_is_finite(value: f32) -> bool {
    return (bitcast<u32>(value) & 0x7f800000u) != 0x7f800000u;
}

/// Which invocation of a grid this is: workgroups are counted row after row, as one row is too short for many.
fn gpu_index(group: vec3<u32>, groups: vec3<u32>, local: u32) -> u32 {
    return (group.y * groups.x + group.x) * 64u + local;
}
