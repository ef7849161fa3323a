//! A prepared frame in somebody else's render pass.

use super::buffer::Growing;
use super::error::GpuError;
use super::program;
use glam::Mat4;
use wgpu::{BindGroup, BufferUsages, Device, Queue, RenderPipeline};

/// A render pass that hair is put into.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PassFormat {
    /// Format of its colour attachment. sRGB and floating point formats get linear light; others get sRGB values, as the
    /// pass's own colours must be there to look right on a screen.
    pub color: wgpu::TextureFormat,
    /// Its depth attachment, if it has one.
    pub depth: Option<PassDepth>,
    /// Its samples a pixel: as many as are prepared, or 1, where the hair's samples become one value with an
    /// alpha.
    pub samples: u32,
}

impl PassFormat {
    /// Whether there can be such a pass on a device of these features.
    pub(super) fn check(&self, features: wgpu::Features) -> Result<(), GpuError> {
        let refused = |message: String| Err(GpuError::PassFormat { message });
        if !matches!(self.samples, 1 | 2 | 4 | 8 | 16) {
            let message = format!(
                "{} samples: there are passes of 1, 2, 4, 8 and 16",
                self.samples
            );
            return refused(message);
        }
        let can = self.color.guaranteed_format_features(features);
        let is_drawn_on = can
            .allowed_usages
            .contains(wgpu::TextureUsages::RENDER_ATTACHMENT);
        let sample_type = self.color.sample_type(None, None);
        let is_float = matches!(sample_type, Some(wgpu::TextureSampleType::Float { .. }));
        if !is_float || !is_drawn_on {
            let message = format!("colours in {:?}, which no pass draws on", self.color);
            return refused(message);
        }
        let blends = can
            .flags
            .contains(wgpu::TextureFormatFeatureFlags::BLENDABLE);
        if self.samples == 1 && !blends {
            let message = format!("one sample in {:?}, which can't be blended", self.color);
            return refused(message);
        }
        let Some(depth) = self.depth else {
            return Ok(());
        };
        if !depth.format.has_depth_aspect() {
            return refused(format!("depths in {:?}, which holds none", depth.format));
        }
        use wgpu::CompareFunction::{Greater, GreaterEqual, Less, LessEqual};
        if !matches!(depth.compare, Less | LessEqual | Greater | GreaterEqual) {
            let message = format!(
                "depths are compared by {:?}: what is nearer needs Less, LessEqual, Greater or GreaterEqual",
                depth.compare
            );
            return refused(message);
        }
        match depth.mapping.iter().all(|number| number.is_finite()) {
            true => Ok(()),
            false => refused(format!("depths are mapped by {:?}", depth.mapping)),
        }
    }
}

/// Depths in a render pass.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PassDepth {
    /// Format of the depth attachment.
    pub format: wgpu::TextureFormat,
    /// When something is drawn: `Less` or `LessEqual`, or for reversed depths `Greater` or `GreaterEqual`.
    pub compare: wgpu::CompareFunction,
    /// What lies at view depth d (metres) has the depth `mapping[0] + mapping[1] / d` there.
    pub mapping: [f32; 2],
}

impl PassDepth {
    /// Depths as a perspective projection makes them (any: left- or right-handed, reversed, without a far
    /// plane), such as glam's `camera::rh::proj::directx::perspective`.
    #[must_use]
    pub fn of_projection(
        projection: Mat4,
        format: wgpu::TextureFormat,
        compare: wgpu::CompareFunction,
    ) -> Self {
        // Clip space is (.., z_axis.z z + w_axis.z, z_axis.w z), and the latter is the view depth.
        let (z, w) = (projection.z_axis, projection.w_axis);
        Self {
            format,
            compare,
            mapping: [z.z / z.w, w.z],
        }
    }
}

/// Settings in `shaders/gpu/compose.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct Settings {
    depth: [f32; 2],
    encodes: u32,
    spare: u32,
}

/// What puts frames into passes of one format.
pub(super) struct Composer {
    format: PassFormat,
    pipeline: RenderPipeline,
    settings: Growing,
    group: Option<BindGroup>,
}

impl Composer {
    /// Whether passes of that format are what it is for. Other depths alone are no other format.
    pub(super) fn fits(&self, format: &PassFormat) -> bool {
        let kind = |f: &PassFormat| (f.color, f.depth.map(|d| (d.format, d.compare)), f.samples);
        kind(&self.format) == kind(format)
    }

    pub(super) fn new(device: &Device, format: PassFormat) -> Result<Self, GpuError> {
        let refused = |error: wgpu::Error| GpuError::Shader {
            name: "compose".to_owned(),
            message: error.to_string(),
        };
        let invalid = device.push_error_scope(wgpu::ErrorFilter::Validation);
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some("compose"),
            source: wgpu::ShaderSource::Wgsl(program::compose(format.samples).into()),
        });
        let is_whole = format.samples > 1;
        let pipeline = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some("compose"),
            layout: None,
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some("cover_all"),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                buffers: &[],
            },
            primitive: wgpu::PrimitiveState::default(),
            depth_stencil: format.depth.map(|depth| wgpu::DepthStencilState {
                format: depth.format,
                depth_write_enabled: Some(true),
                depth_compare: Some(depth.compare),
                stencil: wgpu::StencilState::default(),
                bias: wgpu::DepthBiasState::default(),
            }),
            multisample: wgpu::MultisampleState {
                count: format.samples,
                ..Default::default()
            },
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: Some(if format.depth.is_some() {
                    "show"
                } else {
                    "show_color"
                }),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                targets: &[Some(wgpu::ColorTargetState {
                    format: format.color,
                    blend: (!is_whole).then_some(wgpu::BlendState::PREMULTIPLIED_ALPHA_BLENDING),
                    write_mask: wgpu::ColorWrites::ALL,
                })],
            }),
            multiview_mask: None,
            cache: None,
        });
        if let Some(error) = pollster::block_on(invalid.pop()) {
            return Err(refused(error));
        }
        Ok(Self {
            format,
            pipeline,
            settings: Growing::new("pass", BufferUsages::UNIFORM | BufferUsages::COPY_DST),
            group: None,
        })
    }

    /// Takes on what is to be put into the next pass. `is_new` says that the buffers are others than before.
    pub(super) fn prepare(
        &mut self,
        device: &Device,
        queue: &Queue,
        format: PassFormat,
        [frame, samples]: [&wgpu::Buffer; 2],
        is_new: bool,
    ) -> Result<(), GpuError> {
        self.format = format;
        let settings = Settings {
            depth: format.depth.map_or([0.0; 2], |depth| depth.mapping),
            encodes: u32::from(!holds_linear_light(format.color)),
            spare: 0,
        };
        let words = bytemuck::cast_slice(std::slice::from_ref(&settings));
        let is_made = self.settings.write(device, queue, words)?;
        if is_new || is_made || self.group.is_none() {
            let settings = self.settings.get().ok_or(GpuError::Memory)?;
            let entries = [frame, samples, settings].into_iter().zip(0..);
            let entries: Vec<_> = entries
                .map(|(buffer, binding)| wgpu::BindGroupEntry {
                    binding,
                    resource: buffer.as_entire_binding(),
                })
                .collect();
            self.group = Some(device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some("compose"),
                layout: &self.pipeline.get_bind_group_layout(0),
                entries: &entries,
            }));
        }
        Ok(())
    }

    /// Puts the prepared frame into a pass.
    pub(super) fn render(&self, pass: &mut wgpu::RenderPass<'_>) {
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, self.group.as_ref(), &[]);
        pass.draw(0..3, 0..1);
    }
}

fn holds_linear_light(format: wgpu::TextureFormat) -> bool {
    use wgpu::TextureFormat::{
        R16Float, R32Float, Rg11b10Ufloat, Rg16Float, Rg32Float, Rgb9e5Ufloat, Rgba16Float,
        Rgba32Float,
    };
    let is_float = matches!(
        format,
        R16Float
            | R32Float
            | Rg11b10Ufloat
            | Rg16Float
            | Rg32Float
            | Rgb9e5Ufloat
            | Rgba16Float
            | Rgba32Float
    );
    format.is_srgb() || is_float
}
