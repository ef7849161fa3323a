//! `--stats`: one line of JSON a frame.

use crate::say;
use hair_io::{named, try_to_write};
use render::{Drawing, LayerStrokes};
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
#[cfg(feature = "gpu")]
pub(crate) fn frame_counts(frame: &render::Frame) -> BTreeMap<String, LayerCounts> {
    let runs: Vec<&Range<usize>> = frame.paths.runs.iter().map(|run| &run.joints).collect();
    let layers = frame.objects.iter().flat_map(|object| {
        let layers = object.layers.iter().zip(object.layer_joints);
        layers.map(|(layer, joints)| {
            let instances = layer.program.instances() as usize;
            (&layer.name, counts(&runs, joints, instances))
        })
    });
    by_name(layers)
}

/// Joints and segments of each layer of a drawing; layers of one name together.
pub(crate) fn drawing_counts(drawing: &Drawing) -> BTreeMap<String, LayerCounts> {
    let runs: Vec<&Range<usize>> = drawing.runs.iter().map(|run| &run.joints).collect();
    let of_layer = |layer: &LayerStrokes| counts(&runs, &layer.joints, layer.instances);
    by_name(
        drawing
            .layers
            .iter()
            .map(|layer| (&layer.name, of_layer(layer))),
    )
}

/// What so many strokes have on those of the runs that are in `joints`.
fn counts(runs: &[&Range<usize>], joints: &Range<usize>, instances: usize) -> LayerCounts {
    let drawn = runs
        .iter()
        .filter(|run| joints.start <= run.start && run.end <= joints.end);
    let segments: usize = drawn.map(|run| run.len() - 1).sum();
    LayerCounts {
        joints: joints.len() * instances,
        segments: segments * instances,
    }
}

fn by_name<'a>(
    layers: impl Iterator<Item = (&'a String, LayerCounts)>,
) -> BTreeMap<String, LayerCounts> {
    let mut all: BTreeMap<String, LayerCounts> = BTreeMap::new();
    for (name, counts) in layers {
        let sum = all.entry(name.clone()).or_default();
        sum.joints += counts.joints;
        sum.segments += counts.segments;
    }
    all
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
