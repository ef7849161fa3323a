// What is drawn, as the passes that sort it into tiles and the one that draws the tiles see it.

/// Width and height of a tile in pixels.
const TILE: u32 = 8u;

struct Chunk {
    /// The strand's number; numbers never decrease.
    strand: u32,
    first_joint: u32,
    /// Segments between joints; 0 for a single disc.
    segments: u32,
    /// Which list of strokes it has. Chunks of a strand have as many strokes each, and the same one at a place.
    strokes: u32,
}

struct Corner {
    position: vec2<f32>,
    inv_depth: f32,
    tone: f32,
}

struct Triangle {
    corners: vec3<u32>,
    surface: u32,
}

/// A list's record in the tables: where the list begins, how many strokes it has, and how many decals, which follow them.
const LIST_WORDS: u32 = 3u;
const LIST_STROKES: u32 = 1u;
const LIST_DECALS: u32 = 2u;

/// A stroke's record in the tables: where its discs would begin, if the frame's first joint had one; its number in the order
/// of strokes, from 1 (0 is the clump); whether it is clipped to the clump, as ranks from 0 on are.
const STROKE_FIRST_DISC: u32 = 0u;
const STROKE_NUMBER: u32 = 1u;
const STROKE_IS_CLIPPED: u32 = 2u;
/// Of a decal where its record begins; of others where their brush's does, 0 of a stroke that is whole.
const STROKE_RECORD: u32 = 3u;

/// In place of a stroke's record: a stroke that draws on other runs of the strand, and not on this chunk's.
const NO_STROKE: u32 = 0u;

/// In place of a disc where a sample shows no stroke: set in the number of a triangle; or nothing.
const SHOWS_TRIANGLE: u32 = 0x80000000u;
const SHOWS_NOTHING: u32 = 0xffffffffu;

/// A surface's record in the tables: colour where the tone is 0 or more, colour below, margin; then what textured.wgsl knows of its picture, from
/// where its image's record begins on (0 is none); and its marks.
const SURFACE_WORDS: u32 = 13u;
const SURFACE_PICTURE: u32 = 7u;
const SURFACE_MARKS: u32 = 12u;

@group(0) @binding(0) var<uniform> gpu_frame: GpuFrame;
@group(0) @binding(1) var<storage, read> chunks: array<Chunk>;
/// Of each list of strokes its record; the lists, of places in this buffer; the strokes; the surfaces.
@group(0) @binding(2) var<storage, read> tables: array<u32>;
@group(0) @binding(3) var<storage, read> discs: array<GpuDisc>;
@group(0) @binding(4) var<storage, read> corners: array<Corner>;
@group(0) @binding(5) var<storage, read> triangles: array<Triangle>;
