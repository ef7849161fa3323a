//! Compute pipelines, and what they bind.

use super::error::GpuError;
use super::programs::Tells;
use wgpu::{BindGroupLayout, BufferBindingType, ComputePipeline, Device};

/// What a binding of group 0 is; its number is its place in the list.
#[derive(Clone, Copy)]
pub(super) enum Binding {
    Uniform,
    Read,
    Write,
    /// A uniform of which each dispatch has another part.
    Part,
    /// What samples show, as it is written.
    Told,
    /// The same, as it is read.
    Shown,
    /// Texels of a picture.
    Image,
}

use Binding::{Image, Part, Read, Shown, Told, Uniform, Write};

/// `clump_main`: frame, joints, strands, words, clumps, discs.
pub(super) const CLUMP: &[Binding] = &[Uniform, Read, Read, Read, Write, Write];
/// `stroke_main`: frame, joints, strands, words, clumps, discs.
pub(super) const STROKES: &[Binding] = &[Uniform, Read, Read, Read, Read, Write];
/// `smooth`: the same, and windows.
pub(super) const SMOOTH: &[Binding] = &[Uniform, Read, Read, Read, Read, Write, Write];
/// `bins`: frame, chunks, tables, discs, corners, triangles, counters, starts, entries.
pub(super) const BINS: &[Binding] = &[Uniform, Read, Read, Read, Read, Read, Write, Write, Write];
/// `tiles`: frame, chunks, tables, discs, corners, triangles, starts, entries, picture, sample places.
const TILES: &[Binding] = &[
    Uniform, Read, Read, Read, Read, Read, Read, Read, Write, Uniform,
];
/// `paint_main`: frame, joints, strands, words, clumps, discs, what samples show, samples; then images.
pub(super) const PAINT: &[Binding] = &[Uniform, Read, Read, Read, Read, Read, Shown, Write];
/// `tell`: frame, joints, strands, words, clumps, samples, what they show, planes, which sample.
pub(super) const TELL: &[Binding] = &[Uniform, Read, Read, Read, Read, Read, Shown, Write, Part];
/// `edges`: frame, planes, discs, rows, samples, settings, which sample.
pub(super) const EDGES: &[Binding] = &[Uniform, Read, Write, Write, Write, Read, Part];
/// `mean`: frame, samples, means.
pub(super) const MEAN: &[Binding] = &[Uniform, Read, Write];

/// `mesh_main`: frame, surfaces, corners, words, triangles, sample places, what samples show, samples, what lies under hair; then images.
const PAINT_MESHES: &[Binding] = &[
    Uniform, Read, Read, Read, Read, Uniform, Shown, Write, Shown,
];

/// The bindings of what draws tiles: what samples tell, and pictures where there are some.
pub(super) fn tiles_bindings(tells: Tells, pictures: bool) -> Vec<Binding> {
    let told = std::iter::repeat_n(Told, tells.textures());
    let pictures = pictures.then_some(Image);
    TILES.iter().copied().chain(told).chain(pictures).collect()
}

/// The bindings of a program that paints meshes with so many textures.
pub(super) fn mesh_bindings(textures: usize) -> Vec<Binding> {
    let images = std::iter::repeat_n(Image, textures);
    PAINT_MESHES.iter().copied().chain(images).collect()
}

/// The bindings of a program that paints with so many textures.
pub(super) fn paint_bindings(textures: usize) -> Vec<Binding> {
    let images = std::iter::repeat_n(Image, textures);
    PAINT.iter().copied().chain(images).collect()
}

impl Binding {
    /// Whether it is a texture that is read.
    pub(super) fn is_sampled(self) -> bool {
        matches!(self, Shown | Image)
    }

    fn in_wgpu(self) -> wgpu::BindingType {
        let buffer = |ty, has_dynamic_offset| wgpu::BindingType::Buffer {
            ty,
            has_dynamic_offset,
            min_binding_size: None,
        };
        let texture = |sample_type, view_dimension| wgpu::BindingType::Texture {
            sample_type,
            view_dimension,
            multisampled: false,
        };
        match self {
            Uniform => buffer(BufferBindingType::Uniform, false),
            Part => buffer(BufferBindingType::Uniform, true),
            Read => buffer(BufferBindingType::Storage { read_only: true }, false),
            Write => buffer(BufferBindingType::Storage { read_only: false }, false),
            Told => wgpu::BindingType::StorageTexture {
                access: wgpu::StorageTextureAccess::WriteOnly,
                format: wgpu::TextureFormat::Rgba32Uint,
                view_dimension: wgpu::TextureViewDimension::D2Array,
            },
            Shown => texture(
                wgpu::TextureSampleType::Uint,
                wgpu::TextureViewDimension::D2Array,
            ),
            Image => texture(
                wgpu::TextureSampleType::Float { filterable: false },
                wgpu::TextureViewDimension::D2,
            ),
        }
    }
}

/// A group of that many bindings, for compute shaders.
pub(super) fn layout(device: &Device, name: &str, bindings: &[Binding]) -> BindGroupLayout {
    let entries: Vec<_> = (bindings.iter().zip(0..))
        .map(|(kind, binding)| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: wgpu::ShaderStages::COMPUTE,
            ty: kind.in_wgpu(),
            count: None,
        })
        .collect();
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some(name),
        entries: &entries,
    })
}

/// The pipelines of a shader's entry points, in their order.
///
/// # Errors
///
/// When the shader or a pipeline is refused; `name` says whose it is.
pub(super) fn pipelines(
    device: &Device,
    name: &str,
    text: &str,
    layout: &BindGroupLayout,
    entry_points: &[&str],
) -> Result<Vec<ComputePipeline>, GpuError> {
    let refused = |error: wgpu::Error| GpuError::Shader {
        name: name.to_owned(),
        message: error.to_string(),
    };
    let invalid = device.push_error_scope(wgpu::ErrorFilter::Validation);
    let internal = device.push_error_scope(wgpu::ErrorFilter::Internal);
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some(name),
        source: wgpu::ShaderSource::Wgsl(text.into()),
    });
    let pipeline_layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some(name),
        bind_group_layouts: &[Some(layout)],
        immediate_size: 0,
    });
    let made = entry_points
        .iter()
        .map(|entry_point| {
            device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                label: Some(entry_point),
                layout: Some(&pipeline_layout),
                module: &module,
                entry_point: Some(entry_point),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                cache: None,
            })
        })
        .collect();
    let errors = [
        pollster::block_on(internal.pop()),
        pollster::block_on(invalid.pop()),
    ];
    match errors.into_iter().flatten().next() {
        Some(error) => Err(refused(error)),
        None => Ok(made),
    }
}
