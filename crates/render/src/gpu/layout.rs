//! What the shaders' structs look like from Rust: `shaders/gpu/frame.wgsl`, `drawn.wgsl`, `joint.wgsl`.

use super::inputs::InputSource;
use crate::drawing::{Brush, Drawing};
use crate::frame::{Frame, Light};
use effects::{CLUMP_DISCS, Input, InputSet};
use glam::Vec3;
use rayon::prelude::*;
use std::fmt::Write as _;
use stroke_path::PathRun;

/// `GpuFrame`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, bytemuck::Pod, bytemuck::Zeroable)]
pub(super) struct GpuFrame {
    pub(super) size: [u32; 2],
    pub(super) tiles: [u32; 2],
    pub(super) joints: u32,
    pub(super) chunks: u32,
    pub(super) triangles: u32,
    pub(super) samples: u32,
    pub(super) eye: [f32; 3],
    pub(super) near_m: f32,
    pub(super) light: [f32; 3],
    pub(super) light_is_point: u32,
    pub(super) background: [f32; 4],
    pub(super) right: [f32; 3],
    pub(super) pixel_px: f32,
    pub(super) up: [f32; 3],
    pub(super) edge_depth_m: f32,
    pub(super) chunk_capacity: u32,
    pub(super) triangle_capacity: u32,
    pub(super) is_semicircle: u32,
    pub(super) surfaces_at: u32,
    pub(super) writes_samples: u32,
    pub(super) time_s: f32,
    pub(super) same_strands_at: u32,
    /// The shader's struct ends at a multiple of 16 bytes, as it does here.
    pub(super) outlines: u32,
}

impl GpuFrame {
    /// What a drawing says; the rest is the renderer's.
    pub(super) fn of_drawing(drawing: &Drawing) -> Self {
        let [red, green, blue] = drawing.background.unwrap_or_default();
        let opaque = if drawing.background.is_some() {
            1.0
        } else {
            0.0
        };
        GpuFrame {
            background: [red, green, blue, opaque],
            edge_depth_m: drawing.edge_depth_m,
            is_semicircle: u32::from(drawing.brush == Brush::Semicircle),
            ..GpuFrame::default()
        }
    }

    /// What a frame says; the rest is the renderer's.
    pub(super) fn of_frame(frame: &Frame) -> Self {
        let (light, is_point) = match frame.light {
            Light::Direction(direction) => (direction, 0),
            Light::Point(place) => (place, 1),
        };
        let [red, green, blue] = frame.background.unwrap_or_default();
        GpuFrame {
            joints: frame.paths.len() as u32,
            eye: frame.camera.eye().to_array(),
            near_m: frame.camera.near_m(),
            light: light.to_array(),
            light_is_point: is_point,
            background: [
                red,
                green,
                blue,
                if frame.background.is_some() { 1.0 } else { 0.0 },
            ],
            right: frame.camera.world_from_view_direction(Vec3::X).to_array(),
            up: frame.camera.world_from_view_direction(Vec3::Y).to_array(),
            time_s: frame.time_s,
            pixel_px: frame.camera.size_px()[1] as f32 / 720.0,
            edge_depth_m: frame.edge_depth_m,
            is_semicircle: u32::from(frame.brush == Brush::Semicircle),
            ..GpuFrame::default()
        }
    }
}

/// Bytes of a `GpuDisc`, and of a `GpuClump`.
pub(super) const DISC_BYTES: u64 = 32;
pub(super) const CLUMP_BYTES: u64 = 48;
/// Width and height of a tile, pixels.
pub(super) const TILE: u32 = 8;
/// Most segments of a chunk. With eight, tiles look at many that don't reach them; with two, lists are long.
pub(super) const CHUNK: usize = 4;
/// Invocations of a workgroup, but for the tiles'.
pub(super) const WORKGROUP: u32 = 64;

/// Something of a joint in its record.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Field {
    Center,
    Depth,
    PxPerMetre,
    Strand,
    /// What is ordered as one strand.
    Piece,
    /// First and last joint of its strand's pieces together, and how they follow each other: `neighbours`.
    Run,
    SeenLength,
    /// A list of the frame: [`InputSource::of`] the input.
    Input(Input),
}

use Field::{Center, Depth, Piece, PxPerMetre, Run, SeenLength, Strand};

impl Field {
    /// All fields that there are, in the order in which a record has them.
    fn all() -> impl Iterator<Item = Self> {
        let inputs = Input::ALL.iter().copied().map(Self::Input);
        [Center, Depth, PxPerMetre, Strand, Piece, Run, SeenLength]
            .into_iter()
            .chain(inputs.filter(|field| field.words() > 0))
    }

    fn words(self) -> u32 {
        match self {
            Center => 2,
            Depth | PxPerMetre | Strand | Piece | SeenLength => 1,
            Run => 5,
            Self::Input(input) => InputSource::of(input).words(),
        }
    }

    /// The constant in WGSL that says where in the record it is.
    fn place(self) -> String {
        let name = match self {
            Center => "center",
            Depth => "depth",
            PxPerMetre => "px_per_metre",
            Strand => "strand",
            Piece => "piece",
            Run => "run",
            SeenLength => "seen_length",
            Self::Input(input) => input.name(),
        };
        format!("GPU_AT_{}", name.to_uppercase())
    }
}

/// A joint's record: what somebody reads of it, and nothing else.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct JointLayout {
    fields: Vec<Field>,
    words: u32,
}

/// What is read of joints beside the effects' inputs.
#[derive(Clone, Copy)]
pub(super) struct Needs {
    pub(super) inputs: InputSet,
    pub(super) has_material_normals: bool,
    pub(super) is_smoothed: bool,
    pub(super) is_semicircle: bool,
    /// Whether samples tell which piece they show.
    pub(super) has_pieces: bool,
}

impl JointLayout {
    pub(super) fn new(needs: Needs) -> Self {
        let Needs {
            inputs,
            has_material_normals,
            is_smoothed,
            is_semicircle,
            has_pieces,
        } = needs;
        let is_needed = |field: &Field| match *field {
            Center | Depth | PxPerMetre | Strand => true,
            Piece => has_pieces,
            Run => is_smoothed || is_semicircle,
            SeenLength => is_smoothed,
            // Other inputs are made of it.
            Field::Input(Input::Position) => true,
            Field::Input(input @ (Input::U | Input::Across)) => inputs.has(input) || is_semicircle,
            Field::Input(input @ Input::MaterialNormal) => {
                inputs.has(input) && has_material_normals
            }
            Field::Input(input) => inputs.has(input),
        };
        let fields: Vec<Field> = Field::all().filter(is_needed).collect();
        Self {
            words: fields.iter().map(|field| field.words()).sum(),
            fields,
        }
    }

    /// An input at joint `joint`, as an expression of WGSL.
    pub(super) fn input(&self, input: Input) -> String {
        let field = Field::Input(input);
        let place = self.fields.contains(&field).then(|| field.place());
        InputSource::of(input).in_wgsl(place.as_deref())
    }

    /// The places in the record as WGSL constants. Of what isn't there the place is 0, which nobody reads.
    pub(super) fn constants(&self) -> String {
        let mut text = format!(
            "const GPU_CLUMP_DISCS: u32 = {CLUMP_DISCS}u;\nconst GPU_JOINT_WORDS: u32 = {}u;\n",
            self.words
        );
        let mut next = 0;
        for field in Field::all() {
            let is_there = self.fields.contains(&field);
            let place = if is_there { next } else { 0 };
            let _ = writeln!(text, "const {}: u32 = {place}u;", field.place());
            next += if is_there { field.words() } else { 0 };
        }
        text
    }

    /// The records of all joints of a frame, in place of what was there. `seen_length` is empty where it isn't needed.
    pub(super) fn fill(&self, frame: &Frame, seen_length: &[f32], records: &mut Vec<u32>) {
        const JOINTS: usize = 1024;
        let each = self.words as usize;
        let runs = &frame.paths.runs;
        records.clear();
        records.resize(frame.paths.len() * each, 0);
        records
            .par_chunks_mut(JOINTS * each)
            .enumerate()
            .for_each(|(part, records)| {
                let first = part * JOINTS;
                let mut run = runs.partition_point(|run| run.joints.end <= first);
                for (joint, record) in (first..).zip(records.chunks_exact_mut(each)) {
                    while runs[run].joints.end <= joint {
                        run += 1;
                    }
                    self.write(frame, run, joint, seen_length, record);
                }
            });
    }

    fn write(
        &self,
        frame: &Frame,
        number: usize,
        joint: usize,
        seen_length: &[f32],
        record: &mut [u32],
    ) {
        let (paths, run) = (frame.paths, &frame.paths.runs[number]);
        let mut places = record.iter_mut();
        let mut push = |words: &[u32]| {
            for (place, word) in places.by_ref().take(words.len()).zip(words) {
                *place = *word;
            }
        };
        for field in &self.fields {
            match *field {
                Center => push(&paths.center[joint].to_array().map(f32::to_bits)),
                Depth => push(&[paths.depth[joint].to_bits()]),
                PxPerMetre => push(&[paths.px_per_metre[joint].to_bits()]),
                Strand => push(&[run.strand as u32]),
                Piece => push(&[run.piece as u32]),
                Run => push(&neighbours(&paths.runs, number, joint)),
                SeenLength => push(&[seen_length[joint].to_bits()]),
                Field::Input(input) => InputSource::of(input).push(frame, joint, &mut push),
            }
        }
    }
}

/// A joint's place among the pieces of its strand that follow each other, each joint once: the first and the last of all,
/// the steps to the one before and the one after, and how far back the same joint of the piece before is, or 0.
fn neighbours(runs: &[PathRun], number: usize, joint: usize) -> [u32; 5] {
    let run = &runs[number];
    let first = runs[..=number].iter().rposition(|run| run.overlap == 0);
    let after = runs[number + 1..].iter().take_while(|run| run.overlap > 0);
    let (first, last) = (&runs[first.unwrap_or(number)], after.last().unwrap_or(run));
    let is_first = joint == run.joints.start + run.overlap;
    let is_last = joint + 1 == run.joints.end;
    let back = if is_first { run.overlap } else { 0 };
    let ahead = runs.get(number + 1).map_or(0, |run| run.overlap);
    let ahead = if is_last { ahead } else { 0 };
    let is_shared = joint < run.joints.start + run.overlap;
    let twin = if is_shared { run.overlap } else { 0 };
    [
        first.joints.start,
        last.joints.end - 1,
        1 + back,
        1 + ahead,
        twin,
    ]
    .map(|word| word as u32)
}
