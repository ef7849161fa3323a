//! Lines of passes, drawn into the samples by `shaders/gpu/edges.wgsl`.

use super::buffer::{Buffers, Growing};
use super::error::GpuError;
use super::pipelines::{self, layout, pipelines};
use super::program;
use super::samples::{NUMBER_BYTES, group, number, pixels, whole};
use crate::edges::{EdgeChannel, Edges};
use crate::features::Features;
use wgpu::{BindGroup, BindGroupLayout, BufferUsages, ComputePass, ComputePipeline, Device, Queue};

/// What draws the lines of a frame's passes.
pub(super) struct EdgePasses {
    features: Features,
    layout: BindGroupLayout,
    pipelines: Vec<ComputePipeline>,
    discs: Growing,
    rows: Growing,
    /// Of each pass.
    settings: Vec<Growing>,
}

/// Invocations of a workgroup along a side.
const SIDE: u32 = 8;

impl EdgePasses {
    /// How many pipelines there are.
    pub(super) const PIPELINES: usize = 3;

    pub(super) fn new(device: &Device, features: Features) -> Result<Self, GpuError> {
        let layout = layout(device, "edges", pipelines::EDGES);
        let text = program::edges(features);
        let entry_points = ["find", "grow_along_rows", "draw_along_columns"];
        Ok(Self {
            features,
            pipelines: pipelines(device, "edges", &text, &layout, &entry_points)?,
            layout,
            discs: Growing::new("lines", BufferUsages::STORAGE),
            rows: Growing::new("lines' rows", BufferUsages::STORAGE),
            settings: Vec::new(),
        })
    }

    /// Whether it reads planes of those features.
    pub(super) fn fits(&self, features: Features) -> bool {
        self.features == features
    }

    /// How many passes there are.
    pub(super) fn count(&self) -> usize {
        self.settings.len()
    }

    pub(super) fn buffers(&self) -> impl Iterator<Item = &Growing> {
        [&self.discs, &self.rows].into_iter().chain(&self.settings)
    }

    /// Writes the settings of passes, and makes room. Says how many buffers were made.
    pub(super) fn write(
        &mut self,
        device: &Device,
        queue: &Queue,
        passes: &[Edges],
        size: [u32; 2],
    ) -> Result<usize, GpuError> {
        let usage = BufferUsages::STORAGE | BufferUsages::COPY_DST;
        self.settings
            .resize_with(passes.len(), || Growing::new("a pass", usage));
        let mut made = 0;
        for (edges, buffer) in passes.iter().zip(&mut self.settings) {
            made += usize::from(buffer.write(device, queue, &words(edges))?);
        }
        let bytes = 4 * pixels(size);
        for buffer in [&mut self.discs, &mut self.rows] {
            made += usize::from(buffer.reserve(device, bytes)?);
        }
        Ok(made)
    }

    /// What one of the passes binds.
    pub(super) fn group(
        &self,
        device: &Device,
        pass: usize,
        buffers: &Buffers,
        planes: &Growing,
        numbers: &Growing,
    ) -> Result<BindGroup, GpuError> {
        let mut bound = vec![whole(&buffers.frame)?];
        for buffer in [planes, &self.discs, &self.rows, &buffers.picture] {
            bound.push(whole(buffer)?);
        }
        bound.push(whole(&self.settings[pass])?);
        bound.push(number(numbers)?);
        Ok(group(device, &self.layout, bound))
    }

    /// Draws lines into one sample of each pixel, whose planes are filled.
    pub(super) fn record(
        &self,
        pass: &mut ComputePass,
        group: &BindGroup,
        size: [u32; 2],
        sample: u32,
    ) {
        let [columns, rows] = size.map(|side| side.div_ceil(SIDE));
        pass.set_bind_group(0, group, &[sample * NUMBER_BYTES]);
        for pipeline in &self.pipelines {
            pass.set_pipeline(pipeline);
            pass.dispatch_workgroups(columns, rows, 1);
        }
    }
}

/// `struct Edges` of the shader.
fn words(edges: &Edges) -> Vec<u32> {
    let channel = match edges.channel {
        EdgeChannel::Level => 0,
        EdgeChannel::Strand => 1,
        EdgeChannel::Object => 2,
        EdgeChannel::Normal => 3,
        EdgeChannel::Depth => 4,
        EdgeChannel::Color => 5,
    };
    let [red, green, blue] = edges.color.map(f32::to_bits);
    let mut words = vec![red, green, blue, channel];
    words.extend([edges.threshold, edges.step_m, edges.fade_to].map(f32::to_bits));
    words.extend([edges.reach_px(), edges.seed]);
    words.extend([edges.width_px.vary, edges.widest()].map(f32::to_bits));
    words.push(edges.width_px.curve.len() as u32);
    for (place, width) in &edges.width_px.curve {
        words.extend([place, width].map(|x| x.to_bits()));
    }
    words
}
