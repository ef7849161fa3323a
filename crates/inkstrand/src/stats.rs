//! `--stats`: one line of JSON a frame.

use crate::say;
use hair_io::{named, try_to_write};
use render::{Drawing, Frame};
use serde::Serialize;
use std::collections::BTreeMap;
use std::fs::File;
use std::io::{self, Write as _};
use std::ops::Range;
use std::path::{Path, PathBuf};

/// Where the lines go.
pub(crate) enum Lines {
    Output,
    File(PathBuf, File),
}

impl Lines {
    /// Tells before the work whether lines can be written to that file. It stays as it is.
    pub fn try_path(path: &Path) -> io::Result<()> {
        if path.is_file() {
            let opened = File::options().append(true).open(path);
            return opened.map(drop).map_err(|e| named(path, &e));
        }
        try_to_write(path)
    }

    /// Lines to a new file, or to the standard output where `path` is `-`.
    pub fn create(path: &Path) -> io::Result<Self> {
        if path == Path::new("-") {
            return Ok(Self::Output);
        }
        let file = File::create(path).map_err(|e| named(path, &e))?;
        Ok(Self::File(path.to_owned(), file))
    }

    /// Adds a frame's line, whole, for whoever watches the file grow.
    pub fn push(&mut self, frame: &FrameStats) -> io::Result<()> {
        let line = serde_json::to_string(frame)? + "\n";
        match self {
            Self::Output => say::print(&line),
            Self::File(path, file) => file.write_all(line.as_bytes()).map_err(|e| named(path, &e)),
        }
    }
}

#[derive(Default, Serialize)]
pub(crate) struct FrameStats {
    pub frame: u32,
    pub backend: &'static str,
    pub size: [u32; 2],
    pub samples: u32,
    pub milliseconds: Milliseconds,
    pub strands: StrandCounts,
    /// Of a painter that counts.
    pub layers: BTreeMap<String, LayerCounts>,
    pub bytes: Bytes,
    /// Whether the picture is the last one, as nothing changed since: nothing was drawn, and no layer has joints.
    pub reused: bool,
}

#[derive(Default, Serialize)]
pub(crate) struct Milliseconds {
    pub simulate: f64,
    pub paths: f64,
    pub effects: f64,
    pub raster: f64,
    /// On a graphics card that keeps time: strokes, sorting into tiles, tiles. Parts of `effects` and `raster`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub card: Option<[f64; 3]>,
    /// The whole frame, without encoding the file.
    pub total: f64,
}

#[derive(Default, Serialize)]
pub(crate) struct StrandCounts {
    pub total: usize,
    pub culled: usize,
    pub asleep: usize,
}

#[derive(Default, Serialize)]
pub(crate) struct LayerCounts {
    pub joints: usize,
    pub segments: usize,
}

#[derive(Clone, Copy, Default, Serialize)]
pub(crate) struct Bytes {
    /// What the drawing's lists hold, or the graphics card's buffers.
    pub buffers: usize,
}

/// Joints and segments of each layer of a frame; layers of one name together.
pub(crate) fn layer_counts(frame: &Frame) -> BTreeMap<String, LayerCounts> {
    let runs: Vec<&Range<usize>> = frame.paths.runs.iter().map(|run| &run.joints).collect();
    let mut all: BTreeMap<String, LayerCounts> = BTreeMap::new();
    for object in &frame.objects {
        for (layer, joints) in object.layers.iter().zip(object.layer_joints) {
            let counts = counts(&runs, joints, layer.program.instances() as usize);
            let sum = all.entry(layer.name.clone()).or_default();
            sum.joints += counts.joints;
            sum.segments += counts.segments;
        }
    }
    all
}

/// What so many strokes have on those of the runs that are in `joints`. Runs lie one behind the other.
fn counts(runs: &[&Range<usize>], joints: &Range<usize>, instances: usize) -> LayerCounts {
    let first = runs.partition_point(|run| run.start < joints.start);
    let end = runs.partition_point(|run| run.end <= joints.end);
    let drawn = runs[first..end.max(first)].iter();
    let segments: usize = drawn.map(|run| run.len() - 1).sum();
    LayerCounts {
        joints: joints.len() * instances,
        segments: segments * instances,
    }
}

/// Bytes that the drawing's lists hold.
pub(crate) fn buffer_bytes(drawing: &Drawing) -> usize {
    let surfaces: usize = drawing
        .surfaces
        .iter()
        .map(|s| size_of_val(s.vertices.as_slice()) + size_of_val(s.triangles.as_slice()))
        .sum();
    let layers: usize = drawing
        .layers
        .iter()
        .map(|l| size_of_val(l.discs.as_slice()) + size_of_val(l.colors.as_slice()))
        .sum();
    let clumps = size_of_val(drawing.clump.as_slice()) + size_of_val(drawing.sides.as_slice());
    surfaces + layers + size_of_val(drawing.runs.as_slice()) + clumps
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_whole_runs_are_counted() {
        let runs = [0..4, 4..5, 5..9, 9..12];
        let runs: Vec<&Range<usize>> = runs.iter().collect();
        for (joints, segments) in [
            (0..12, 3 + 3 + 2),
            (4..9, 3),
            (4..5, 0),
            (0..0, 0),
            (12..12, 0),
            (1..9, 3),
            (6..8, 0),
            (5..11, 3),
        ] {
            let found = counts(&runs, &joints, 2);
            assert_eq!(found.segments, 2 * segments, "{joints:?}");
            assert_eq!(found.joints, 2 * joints.len());
        }
    }
}
