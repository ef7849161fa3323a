//! `--stats`: one line of JSON a frame.

use render::Drawing;
use serde::Serialize;
use std::collections::BTreeMap;

#[derive(Serialize)]
pub(crate) struct FrameStats {
    pub frame: u32,
    pub backend: &'static str,
    pub size: [u32; 2],
    pub samples: u32,
    pub milliseconds: Milliseconds,
    pub strands: StrandCounts,
    pub layers: BTreeMap<String, LayerCounts>,
    pub bytes: Bytes,
    pub reused: bool,
}

#[derive(Default, Serialize)]
pub(crate) struct Milliseconds {
    pub simulate: f64,
    pub paths: f64,
    pub effects: f64,
    pub raster: f64,
    /// The whole frame, without encoding the file.
    pub total: f64,
}

#[derive(Serialize)]
pub(crate) struct StrandCounts {
    pub total: usize,
    pub culled: usize,
    pub asleep: usize,
}

#[derive(Serialize)]
pub(crate) struct LayerCounts {
    pub joints: usize,
    pub segments: usize,
}

#[derive(Serialize)]
pub(crate) struct Bytes {
    /// What the drawing's lists hold.
    pub buffers: usize,
}

/// Joints and segments of each layer.
pub(crate) fn layer_counts(drawing: &Drawing) -> BTreeMap<String, LayerCounts> {
    let segments: usize = drawing.runs.iter().map(|run| run.joints.len() - 1).sum();
    drawing
        .layers
        .iter()
        .map(|layer| {
            let counts = LayerCounts {
                joints: layer.discs.len(),
                segments: segments * layer.instances,
            };
            (layer.name.clone(), counts)
        })
        .collect()
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
    surfaces + layers + size_of_val(drawing.runs.as_slice()) + size_of_val(drawing.clump.as_slice())
}
