//! Samples that know what they show: painted by their layers, told of by planes of features, and drawn on by passes. All of it is made
//! for frames that need it, and for those alone.

use super::buffer::{Buffers, Growing};
use super::edges::EdgePasses;
use super::error::GpuError;
use super::images::Images;
use super::layout::GpuFrame;
use super::pipelines::{self, Binding, layout, mesh_bindings, paint_bindings, pipelines};
use super::program;
use super::programs::{Programs, Tells, one_pipeline};
use super::scene::SceneWords;
use crate::edges::Edges;
use crate::features::{Feature, Features, normal_of_triangle, object_of_mesh};
use crate::frame::Frame;
use crate::planes::Layout;
use rayon::prelude::*;
use wgpu::{
    BindGroup, BindGroupLayout, BindingResource, BufferUsages, ComputePass, ComputePipeline,
    Device, Queue,
};

/// Invocations of a workgroup that has one for each pixel, along a side.
const SIDE: u32 = 8;

/// What is wanted of a frame's samples.
#[derive(Clone, Copy)]
pub(super) struct Wanted {
    pub(super) size: [u32; 2],
    /// In a pixel.
    pub(super) samples: u32,
    /// What planes tell of them; nothing where there are none.
    pub(super) tells: Features,
    /// Whether their means are taken.
    pub(super) means: bool,
    /// Whether surfaces are seen through hair.
    pub(super) under: bool,
}

/// Pipelines, textures and buffers.
pub(super) struct SampleStage {
    shown: Shown,
    /// Surfaces that hair hides; of one texel where none is seen through it.
    under: Shown,
    keeps_under: bool,
    paints: Vec<Paint>,
    /// Those of meshes, with the words of each layer.
    mesh_paints: Vec<Paint>,
    mesh_layers: Vec<MeshLayer>,
    meshes: Growing,
    images: Images,
    /// The painted layers, by their places among all, with what they run.
    layers: Vec<(usize, usize, Vec<wgpu::TextureView>)>,
    tell: Option<Tell>,
    edges: Option<EdgePasses>,
    mean: Option<(BindGroupLayout, ComputePipeline)>,
    tell_words: Growing,
    planes: Growing,
    means: Growing,
    numbers: Growing,
}

/// A layer for meshes: which program paints it, its words, and its pictures.
struct MeshLayer {
    program: usize,
    words: Growing,
    images: Vec<wgpu::TextureView>,
}

/// What each sample shows.
struct Shown {
    /// Width and height in pixels, and samples.
    size: [u32; 3],
    view: wgpu::TextureView,
}

/// A program that paints.
struct Paint {
    made_from: (&'static str, Vec<usize>, String, usize),
    layout: BindGroupLayout,
    pipeline: ComputePipeline,
}

/// What fills planes.
struct Tell {
    features: Features,
    joint_constants: String,
    layout: BindGroupLayout,
    pipeline: ComputePipeline,
}

impl SampleStage {
    /// What keeps samples of that size.
    pub(super) fn new(device: &Device, wanted: Wanted) -> Result<Self, GpuError> {
        let storage = BufferUsages::STORAGE;
        Ok(Self {
            shown: Shown::new(device, shown_size(wanted))?,
            under: Shown::new(device, under_size(wanted))?,
            keeps_under: wanted.under,
            paints: Vec::new(),
            mesh_paints: Vec::new(),
            mesh_layers: Vec::new(),
            meshes: Growing::new("painted surfaces", storage | BufferUsages::COPY_DST),
            images: Images::default(),
            layers: Vec::new(),
            tell: None,
            edges: None,
            mean: None,
            tell_words: Growing::new("layers and triangles", storage | BufferUsages::COPY_DST),
            planes: Growing::new("features", storage | BufferUsages::COPY_SRC),
            means: Growing::new("pixels", storage | BufferUsages::COPY_SRC),
            numbers: Growing::new(
                "sample numbers",
                BufferUsages::UNIFORM | BufferUsages::COPY_DST,
            ),
        })
    }

    /// Makes what a frame needs, and drops what it doesn't. Says how many pipelines, buffers and textures were made.
    pub(super) fn follow(
        &mut self,
        device: &Device,
        queue: &Queue,
        frame: &Frame,
        passes: &[Edges],
        scene: &SceneWords,
        wanted: Wanted,
    ) -> Result<usize, GpuError> {
        let mut made = 0;
        self.keeps_under = wanted.under;
        let sizes = [shown_size(wanted), under_size(wanted)];
        for (texture, size) in [&mut self.shown, &mut self.under].into_iter().zip(sizes) {
            if texture.size != size {
                *texture = Shown::new(device, size)?;
                made += 1;
            }
        }
        self.images.begin();
        made += self.follow_layers(device, queue, frame, scene)?;
        made += self.follow_meshes(device, queue, frame, scene)?;
        self.images.end();
        made += self.follow_features(device, queue, frame, scene, wanted)?;
        if passes.is_empty() {
            self.edges = None;
        } else {
            let drawn = match self.edges.take() {
                Some(drawn) if drawn.fits(wanted.tells) => drawn,
                _ => {
                    made += EdgePasses::PIPELINES;
                    EdgePasses::new(device, wanted.tells)?
                }
            };
            let drawn = self.edges.insert(drawn);
            made += drawn.write(device, queue, passes, wanted.size)?;
        }
        if !wanted.means {
            self.mean = None;
            self.means.drop_buffer();
            return Ok(made);
        }
        if self.mean.is_none() {
            let layout = layout(device, "mean", pipelines::MEAN);
            let text = program::mean();
            let pipeline = pipelines(device, "mean", &text, &layout, &["take_means"])?;
            let pipeline = pipeline.into_iter().next().ok_or(GpuError::Memory)?;
            self.mean = Some((layout, pipeline));
            made += 1;
        }
        let bytes = 16 * pixels(wanted.size);
        Ok(made + usize::from(self.means.reserve(device, bytes)?))
    }

    /// The programs and images of layers that paint.
    fn follow_layers(
        &mut self,
        device: &Device,
        queue: &Queue,
        frame: &Frame,
        scene: &SceneWords,
    ) -> Result<usize, GpuError> {
        let mut before = std::mem::take(&mut self.paints);
        let mut made = 0;
        self.layers.clear();
        let layers = frame.objects.iter().flat_map(|object| object.layers);
        for (index, layer) in layers.enumerate() {
            let source = layer.program.source();
            let Some(paint) = source.paint else {
                continue;
            };
            let textures = paint.textures.len();
            let made_from = (
                source.wgsl,
                source.varying.to_vec(),
                scene.layout.constants(),
                textures,
            );
            let is_it = |paint: &Paint| paint.made_from == made_from;
            let number = match self.paints.iter().position(is_it) {
                Some(number) => number,
                None => {
                    let program = match before.iter().position(is_it) {
                        Some(place) => before.swap_remove(place),
                        None => {
                            made += 1;
                            let text = program::paint(&source, &paint, &scene.layout);
                            let bindings = paint_bindings(textures);
                            Paint::new(device, layer.effect, &text, &bindings, made_from)?
                        }
                    };
                    self.paints.push(program);
                    self.paints.len() - 1
                }
            };
            let mut views = Vec::with_capacity(textures);
            for (texture, _) in paint.textures {
                let (view, is_new) = self.images.view(device, queue, texture)?;
                made += usize::from(is_new);
                views.push(view);
            }
            self.layers.push((index, number, views));
        }
        Ok(made)
    }

    /// The programs, words and images of layers for meshes.
    fn follow_meshes(
        &mut self,
        device: &Device,
        queue: &Queue,
        frame: &Frame,
        scene: &SceneWords,
    ) -> Result<usize, GpuError> {
        let mut before = std::mem::take(&mut self.mesh_paints);
        let mut words = std::mem::take(&mut self.mesh_layers).into_iter();
        let mut made = 0;
        for (layer, own) in frame.mesh_layers.iter().zip(&scene.mesh_layers) {
            let source = layer.layer.program.source();
            let Some(paint) = source.paint else {
                continue;
            };
            let textures = paint.textures.len();
            let made_from = (source.wgsl, Vec::new(), String::new(), textures);
            let is_it = |paint: &Paint| paint.made_from == made_from;
            let program = match self.mesh_paints.iter().position(is_it) {
                Some(number) => number,
                None => {
                    let program = match before.iter().position(is_it) {
                        Some(place) => before.swap_remove(place),
                        None => {
                            made += 1;
                            let text = program::paint_meshes(&source, &paint);
                            let bindings = mesh_bindings(textures);
                            let effect = layer.layer.effect;
                            Paint::new(device, effect, &text, &bindings, made_from)?
                        }
                    };
                    self.mesh_paints.push(program);
                    self.mesh_paints.len() - 1
                }
            };
            let mut images = Vec::with_capacity(textures);
            for (texture, _) in paint.textures {
                let (view, is_new) = self.images.view(device, queue, texture)?;
                made += usize::from(is_new);
                images.push(view);
            }
            let usage = BufferUsages::STORAGE | BufferUsages::COPY_DST;
            let of_before = words.next().map(|layer| layer.words);
            let mut words = of_before.unwrap_or_else(|| Growing::new("parameters", usage));
            made += usize::from(words.write(device, queue, own)?);
            self.mesh_layers.push(MeshLayer {
                program,
                words,
                images,
            });
        }
        if self.mesh_layers.is_empty() {
            self.meshes.drop_buffer();
            return Ok(made);
        }
        Ok(made + usize::from(self.meshes.write(device, queue, &scene.meshes)?))
    }

    /// What fills planes, and their room.
    fn follow_features(
        &mut self,
        device: &Device,
        queue: &Queue,
        frame: &Frame,
        scene: &SceneWords,
        wanted: Wanted,
    ) -> Result<usize, GpuError> {
        if wanted.tells.is_empty() {
            self.tell = None;
            for buffer in [&mut self.tell_words, &mut self.planes, &mut self.numbers] {
                buffer.drop_buffer();
            }
            return Ok(0);
        }
        let mut made = 0;
        let joint_constants = scene.layout.constants();
        let is_it =
            |tell: &Tell| tell.features == wanted.tells && tell.joint_constants == joint_constants;
        if !self.tell.as_ref().is_some_and(is_it) {
            let layout = layout(device, "tell", pipelines::TELL);
            let text = program::tell(wanted.tells, &scene.layout);
            self.tell = Some(Tell {
                features: wanted.tells,
                joint_constants,
                pipeline: one_pipeline(device, "what samples tell", &text, &layout)?,
                layout,
            });
            made += 1;
        }
        let words = tell_words(frame, scene, wanted.tells);
        made += usize::from(self.tell_words.write(device, queue, &words)?);
        let planes: usize = Layout::new(wanted.tells).planes.iter().sum();
        let bytes = 4 * planes as u64 * pixels(wanted.size);
        made += usize::from(self.planes.reserve(device, bytes)?);
        made += usize::from(write_numbers(&mut self.numbers, device, queue, wanted)?);
        Ok(made)
    }

    /// What tiles write.
    pub(super) fn told(&self) -> Vec<wgpu::TextureView> {
        let all = [&self.shown, &self.under];
        let told = all.into_iter().take(self.tells().textures());
        told.map(|texture| texture.view.clone()).collect()
    }

    /// What tiles keep.
    pub(super) fn tells(&self) -> Tells {
        match self.keeps_under {
            true => Tells::Under,
            false => Tells::Shown,
        }
    }

    /// The means, once they are taken.
    pub(super) fn means(&self) -> Option<&wgpu::Buffer> {
        self.means.get()
    }

    /// The planes of the sample that was told last.
    pub(super) fn planes(&self) -> Option<&wgpu::Buffer> {
        self.planes.get()
    }

    /// Pipelines alive.
    pub(super) fn pipelines(&self) -> usize {
        let edges = self.edges.as_ref().map_or(0, |_| EdgePasses::PIPELINES);
        let others = usize::from(self.tell.is_some()) + usize::from(self.mean.is_some());
        self.paints.len() + self.mesh_paints.len() + edges + others
    }

    /// Bytes of buffers and textures alive.
    pub(super) fn bytes(&self) -> Vec<u64> {
        let own = [
            &self.tell_words,
            &self.planes,
            &self.means,
            &self.numbers,
            &self.meshes,
        ];
        let words = self.mesh_layers.iter().map(|layer| &layer.words);
        let edges = self.edges.iter().flat_map(EdgePasses::buffers);
        let buffers = own.into_iter().chain(words).chain(edges);
        let buffers = buffers.map(Growing::size);
        let textures = [self.shown.bytes(), self.under.bytes(), self.images.bytes()];
        let all = buffers.chain(textures);
        all.filter(|bytes| *bytes > 0).collect()
    }

    /// Records what comes behind the tiles: layers paint, passes draw, means are taken.
    pub(super) fn record(
        &self,
        device: &Device,
        pass: &mut ComputePass,
        buffers: &Buffers,
        programs: &Programs,
        frame: &GpuFrame,
    ) -> Result<(), GpuError> {
        let [columns, rows] = frame.size.map(|side| side.div_ceil(SIDE));
        for (layer, number, images) in &self.layers {
            let paint = &self.paints[*number];
            let words = &programs.layers[*layer].words;
            let mut bound = joint_bindings(buffers, words)?;
            bound.push(whole(&buffers.discs)?);
            bound.push(BindingResource::TextureView(&self.shown.view));
            bound.push(whole(&buffers.picture)?);
            bound.extend(images.iter().map(BindingResource::TextureView));
            pass.set_bind_group(0, &group(device, &paint.layout, bound), &[]);
            pass.set_pipeline(&paint.pipeline);
            pass.dispatch_workgroups(columns, rows, frame.samples);
        }
        for layer in &self.mesh_layers {
            let paint = &self.mesh_paints[layer.program];
            let buffers = [
                &buffers.frame,
                &self.meshes,
                &buffers.corners,
                &layer.words,
                &buffers.triangles,
                &buffers.sample_places,
                &buffers.picture,
            ];
            let mut bound = Vec::with_capacity(buffers.len() + 2 + layer.images.len());
            for buffer in buffers {
                bound.push(whole(buffer)?);
            }
            let shown = BindingResource::TextureView(&self.shown.view);
            bound.insert(6, shown);
            bound.push(BindingResource::TextureView(&self.under.view));
            bound.extend(layer.images.iter().map(BindingResource::TextureView));
            pass.set_bind_group(0, &group(device, &paint.layout, bound), &[]);
            pass.set_pipeline(&paint.pipeline);
            pass.dispatch_workgroups(columns, rows, frame.samples);
        }
        if let Some(edges) = &self.edges {
            let tell = self.tell_group(device, buffers)?;
            for edge_pass in 0..edges.count() {
                let drawn = edges.group(device, edge_pass, buffers, &self.planes, &self.numbers)?;
                for sample in 0..frame.samples {
                    self.tell(pass, &tell, frame.size, sample);
                    edges.record(pass, &drawn, frame.size, sample);
                }
            }
        }
        if let (Some((layout, pipeline)), Some(means)) = (&self.mean, self.means.get()) {
            let bound = vec![
                whole(&buffers.frame)?,
                whole(&buffers.picture)?,
                means.as_entire_binding(),
            ];
            pass.set_bind_group(0, &group(device, layout, bound), &[]);
            pass.set_pipeline(pipeline);
            pass.dispatch_workgroups(columns, rows, 1);
        }
        Ok(())
    }

    /// What [`Self::tell`] binds.
    pub(super) fn tell_group(
        &self,
        device: &Device,
        buffers: &Buffers,
    ) -> Result<BindGroup, GpuError> {
        let tell = self.tell.as_ref().ok_or(GpuError::Memory)?;
        let mut bound = joint_bindings(buffers, &self.tell_words)?;
        bound.push(whole(&buffers.picture)?);
        bound.push(BindingResource::TextureView(&self.shown.view));
        bound.push(whole(&self.planes)?);
        bound.push(number(&self.numbers)?);
        Ok(group(device, &tell.layout, bound))
    }

    /// Fills the planes with what one sample of each pixel tells.
    pub(super) fn tell(
        &self,
        pass: &mut ComputePass,
        group: &BindGroup,
        size: [u32; 2],
        sample: u32,
    ) {
        let Some(tell) = &self.tell else {
            return;
        };
        pass.set_bind_group(0, group, &[sample * NUMBER_BYTES]);
        pass.set_pipeline(&tell.pipeline);
        let [columns, rows] = size.map(|side| side.div_ceil(SIDE));
        pass.dispatch_workgroups(columns, rows, 1);
    }
}

/// Nothing is kept of what lies under hair.
const NO_UNDER: [u32; 3] = [1, 1, 1];

fn shown_size(wanted: Wanted) -> [u32; 3] {
    let [width, height] = wanted.size;
    [width, height, wanted.samples]
}

fn under_size(wanted: Wanted) -> [u32; 3] {
    match wanted.under {
        true => shown_size(wanted),
        false => NO_UNDER,
    }
}

impl Shown {
    fn new(device: &Device, [width, height, samples]: [u32; 3]) -> Result<Self, GpuError> {
        let limits = device.limits();
        let needed = [
            (
                "pixels along a side of a texture",
                limits.max_texture_dimension_2d,
                width.max(height),
            ),
            (
                "layers of a texture",
                limits.max_texture_array_layers,
                samples,
            ),
        ];
        for (what, has, needs) in needed {
            if has < needs {
                let [has, needs] = [has, needs].map(u64::from);
                return Err(GpuError::Limit { what, has, needs });
            }
        }
        let memory = device.push_error_scope(wgpu::ErrorFilter::OutOfMemory);
        let texture = device.create_texture(&wgpu::TextureDescriptor {
            label: Some("what samples show"),
            size: wgpu::Extent3d {
                width,
                height,
                depth_or_array_layers: samples,
            },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: wgpu::TextureFormat::Rgba32Uint,
            usage: wgpu::TextureUsages::STORAGE_BINDING | wgpu::TextureUsages::TEXTURE_BINDING,
            view_formats: &[],
        });
        if let Some(error) = pollster::block_on(memory.pop()) {
            return Err(error.into());
        }
        let view = texture.create_view(&wgpu::TextureViewDescriptor {
            dimension: Some(wgpu::TextureViewDimension::D2Array),
            ..Default::default()
        });
        Ok(Self {
            size: [width, height, samples],
            view,
        })
    }

    fn bytes(&self) -> u64 {
        16 * self.size.map(u64::from).iter().product::<u64>()
    }
}

impl Paint {
    fn new(
        device: &Device,
        effect: &str,
        text: &str,
        bindings: &[Binding],
        made_from: (&'static str, Vec<usize>, String, usize),
    ) -> Result<Self, GpuError> {
        let most = device.limits().max_sampled_textures_per_shader_stage;
        let textures = bindings.iter().filter(|binding| binding.is_sampled());
        let needs = textures.count() as u64;
        if needs > u64::from(most) {
            return Err(GpuError::Limit {
                what: "textures in a shader",
                has: most.into(),
                needs,
            });
        }
        let layout = layout(device, effect, bindings);
        Ok(Self {
            made_from,
            pipeline: one_pipeline(device, effect, text, &layout)?,
            layout,
        })
    }
}

/// What `shaders/gpu/tell.wgsl` knows of a frame's layers and triangles.
fn tell_words(frame: &Frame, scene: &SceneWords, tells: Features) -> Vec<u32> {
    const HEADER: usize = 3;
    const LAYER: usize = 6;
    let layers = scene.layers.len();
    let triangles_at = HEADER + LAYER * layers;
    let mut words = vec![
        layers as u32,
        frame.roundness.to_bits(),
        triangles_at as u32,
    ];
    for layer in &scene.layers {
        let [first_disc, discs, first_joint, joints, object] = [
            layer.first_disc,
            layer.joints * layer.instances as usize,
            layer.first_joint,
            layer.joints,
            layer.object,
        ]
        .map(|number| number as u32);
        let head_height = frame.objects[layer.object].head.height_m.to_bits();
        words.extend([first_disc, discs, first_joint, joints, object, head_height]);
    }
    let has_normals = tells.has(Feature::Normal);
    for surface in &frame.surfaces {
        let object = object_of_mesh(surface.mesh);
        let triangles: Vec<[u32; 4]> = (surface.triangles.par_iter().with_min_len(1024))
            .map(|corners| {
                let corners = corners.map(|corner| {
                    let vertex = &surface.vertices[corner as usize];
                    (vertex.position, vertex.inv_depth)
                });
                let normal = match has_normals {
                    true => normal_of_triangle(frame.camera, corners).to_array(),
                    false => [0.0; 3],
                };
                let [x, y, z] = normal.map(f32::to_bits);
                [object, x, y, z]
            })
            .collect();
        words.extend(triangles.as_flattened());
    }
    words
}

/// From one sample's number to the next, as far apart as any device may want parts of a uniform.
pub(super) const NUMBER_BYTES: u32 = 256;

/// The numbers of the samples, from which dispatches know which is theirs.
fn write_numbers(
    numbers: &mut Growing,
    device: &Device,
    queue: &Queue,
    wanted: Wanted,
) -> Result<bool, GpuError> {
    let words = NUMBER_BYTES as usize / 4;
    let mut list = vec![0; words * wanted.samples as usize];
    for (number, place) in (0..).zip(list.iter_mut().step_by(words)) {
        *place = number;
    }
    numbers.write(device, queue, &list)
}

/// Frame, joints, strands, words, clumps.
fn joint_bindings<'a>(
    buffers: &'a Buffers,
    words: &'a Growing,
) -> Result<Vec<BindingResource<'a>>, GpuError> {
    let bound = [
        &buffers.frame,
        &buffers.joints,
        &buffers.strands,
        words,
        &buffers.clumps,
    ];
    bound.into_iter().map(whole).collect()
}

/// All of a buffer.
pub(super) fn whole(buffer: &Growing) -> Result<BindingResource<'_>, GpuError> {
    let buffer = buffer.get().ok_or(GpuError::Memory)?;
    Ok(buffer.as_entire_binding())
}

/// The part of the samples' numbers that a dispatch has.
pub(super) fn number(numbers: &Growing) -> Result<BindingResource<'_>, GpuError> {
    Ok(BindingResource::Buffer(wgpu::BufferBinding {
        buffer: numbers.get().ok_or(GpuError::Memory)?,
        offset: 0,
        size: wgpu::BufferSize::new(16),
    }))
}

/// A group that binds these in their order.
pub(super) fn group(
    device: &Device,
    layout: &BindGroupLayout,
    bound: Vec<BindingResource>,
) -> BindGroup {
    let entries: Vec<_> = (0..)
        .zip(bound)
        .map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource })
        .collect();
    device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: None,
        layout,
        entries: &entries,
    })
}

/// How many pixels there are.
pub(super) fn pixels([width, height]: [u32; 2]) -> u64 {
    u64::from(width) * u64::from(height)
}
