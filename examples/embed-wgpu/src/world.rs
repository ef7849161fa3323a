//! The program's own meshes: a floor and a pedestal, two cubes and a ring of glass that go round the head.

use crate::PassSettings;
use crate::view::{DEPTH_FORMAT, View};
use bytemuck::{Pod, Zeroable};
use glam::{Mat4, Quat, Vec3};
use std::f32::consts::{SQRT_2, TAU};
use std::ops::Range;
use wgpu::util::{BufferInitDescriptor, DeviceExt};
use wgpu::{BufferUsages, RenderPass, RenderPipeline, vertex_attr_array};

/// All that is drawn beside the hair.
pub struct World {
    head: render::Head,
    /// Corners of all meshes, three a triangle.
    corners: wgpu::Buffer,
    column: Range<u32>,
    cube: Range<u32>,
    ring: Range<u32>,
    instances: wgpu::Buffer,
    camera: wgpu::Buffer,
    bindings: wgpu::BindGroup,
    solid: RenderPipeline,
    glass: RenderPipeline,
}

/// `World` in world.wgsl.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct CameraWords {
    clip_from_world: [[f32; 4]; 4],
    eye: [f32; 4],
    to_light: [f32; 4],
}

/// A mesh in its place.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct Instance {
    world_from_mesh: [[f32; 4]; 4],
    /// Linear, alpha last.
    color: [f32; 4],
}

/// Where the instances of each mesh are in their buffer: floor and pedestal, two cubes, a ring.
const COLUMNS: Range<u32> = 0..2;
const CUBES: Range<u32> = 2..4;
const RINGS: Range<u32> = 4..5;

const FLOOR_COLOR: [f32; 4] = [0.62, 0.66, 0.70, 1.0];
const PEDESTAL_COLOR: [f32; 4] = [0.86, 0.84, 0.80, 1.0];
const CUBE_COLORS: [[f32; 4]; 2] = [[0.90, 0.30, 0.05, 1.0], [0.85, 0.55, 0.02, 1.0]];
const GLASS_COLOR: [f32; 4] = [0.75, 0.05, 0.30, 0.55];

impl World {
    /// The meshes around that head, for render passes of that kind.
    #[must_use]
    pub fn new(device: &wgpu::Device, head: render::Head, pass: PassSettings) -> Self {
        let mut corners = Vec::new();
        let mut add = |mesh: Vec<Vec3>| {
            let first = corners.len() as u32;
            corners.extend(mesh.iter().map(Vec3::to_array));
            first..corners.len() as u32
        };
        // A column has radius 1 and height 1; a cube is one of four sides.
        let column = [[0.0, 0.5], [1.0, 0.5], [1.0, -0.5], [0.0, -0.5]];
        let circle: Vec<[f32; 2]> = (0..=16)
            .map(|i| TAU * i as f32 / 16.0)
            .map(|angle| [1.0 + 0.05 * angle.cos(), -0.05 * angle.sin()])
            .collect();
        let (column, cube, ring) = (
            add(revolved(&column, 64)),
            add(revolved(&column, 4)),
            add(revolved(&circle, 128)),
        );
        let corners = device.create_buffer_init(&BufferInitDescriptor {
            label: Some("corners"),
            contents: bytemuck::cast_slice(&corners),
            usage: BufferUsages::VERTEX,
        });
        let written = |label, bytes: usize, usage| {
            device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(label),
                size: bytes as u64,
                usage: usage | BufferUsages::COPY_DST,
                mapped_at_creation: false,
            })
        };
        let instances = RINGS.end as usize * size_of::<Instance>();
        let instances = written("instances", instances, BufferUsages::VERTEX);
        let camera = written("camera", size_of::<CameraWords>(), BufferUsages::UNIFORM);
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("world"),
            entries: &[wgpu::BindGroupLayoutEntry {
                binding: 0,
                visibility: wgpu::ShaderStages::VERTEX_FRAGMENT,
                ty: wgpu::BindingType::Buffer {
                    ty: wgpu::BufferBindingType::Uniform,
                    has_dynamic_offset: false,
                    min_binding_size: None,
                },
                count: None,
            }],
        });
        let bindings = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("world"),
            layout: &layout,
            entries: &[wgpu::BindGroupEntry {
                binding: 0,
                resource: camera.as_entire_binding(),
            }],
        });
        Self {
            head,
            corners,
            column,
            cube,
            ring,
            instances,
            camera,
            bindings,
            solid: pipeline(device, &layout, pass, None),
            glass: pipeline(
                device,
                &layout,
                pass,
                Some(wgpu::BlendState::ALPHA_BLENDING),
            ),
        }
    }

    /// Where the cubes' middles are at `time` (seconds), on opposite sides of the head, and half their edge; metres.
    #[must_use]
    pub fn cubes(&self, time: f32) -> ([Vec3; 2], f32) {
        let height = self.head.height_m;
        let middle = self.head.center - 0.45 * height * Vec3::Y;
        let out = Quat::from_rotation_y(1.0 + 0.9 * time) * Vec3::Z * 1.4 * height;
        ([middle + out, middle - out], 0.2 * height)
    }

    /// Everything to its place at `time` (seconds), and the camera.
    pub fn prepare(&self, queue: &wgpu::Queue, time: f32, view: &View, light: render::Light) {
        let height = self.head.height_m;
        let at = |heads: f32| self.head.center + heads * height * Vec3::Y;
        let upright = |size: Vec3, middle: Vec3| {
            Mat4::from_scale_rotation_translation(size * height, Quat::IDENTITY, middle)
        };
        let (cubes, half) = self.cubes(time);
        let cube = |middle: Vec3| {
            let turned = Quat::from_rotation_y(0.9 + 1.3 * time) * Quat::from_rotation_x(0.5);
            let size = half * Vec3::new(SQRT_2, 2.0, SQRT_2);
            Mat4::from_scale_rotation_translation(size, turned, middle)
        };
        // It sways, so that it goes through the hair in other places all the time.
        let tilt = Quat::from_rotation_y(0.5 * time) * Quat::from_rotation_x(0.3);
        let placed = [
            (upright(Vec3::new(3.6, 0.1, 3.6), at(-2.65)), FLOOR_COLOR),
            (
                upright(Vec3::new(0.42, 1.2, 0.42), at(-2.0)),
                PEDESTAL_COLOR,
            ),
            (cube(cubes[0]), CUBE_COLORS[0]),
            (cube(cubes[1]), CUBE_COLORS[1]),
            (
                Mat4::from_scale_rotation_translation(Vec3::splat(1.05 * height), tilt, at(-0.65)),
                GLASS_COLOR,
            ),
        ];
        let instances = placed.map(|(world_from_mesh, color)| Instance {
            world_from_mesh: world_from_mesh.to_cols_array_2d(),
            color,
        });
        queue.write_buffer(&self.instances, 0, bytemuck::cast_slice(&instances));

        let clip_from_world = view.clip_from_view * view.view_from_world;
        let eye = view.view_from_world.inverse().w_axis;
        let (to_light, _) = light.seen_from(self.head.center);
        let camera = CameraWords {
            clip_from_world: clip_from_world.to_cols_array_2d(),
            eye: eye.to_array(),
            to_light: to_light.extend(0.0).to_array(),
        };
        queue.write_buffer(&self.camera, 0, bytemuck::bytes_of(&camera));
    }

    /// Draws what hides all that is behind it.
    pub fn render_solid(&self, pass: &mut RenderPass<'_>) {
        self.set(pass, &self.solid);
        pass.draw(self.column.clone(), COLUMNS);
        pass.draw(self.cube.clone(), CUBES);
    }

    /// Draws what can be looked through: it goes over all the rest.
    pub fn render_glass(&self, pass: &mut RenderPass<'_>) {
        self.set(pass, &self.glass);
        pass.draw(self.ring.clone(), RINGS);
    }

    fn set(&self, pass: &mut RenderPass<'_>, pipeline: &RenderPipeline) {
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, &self.bindings, &[]);
        pass.set_vertex_buffer(0, self.corners.slice(..));
        pass.set_vertex_buffer(1, self.instances.slice(..));
    }
}

/// The triangles of a line (distance from the y axis, height; from above outside round to below) that goes round the
/// y axis. They turn counterclockwise where they face the eye.
fn revolved(line: &[[f32; 2]], sides: u32) -> Vec<Vec3> {
    let at = |side: u32, [radius, height]: [f32; 2]| {
        let angle = TAU * (side % sides) as f32 / sides as f32;
        Vec3::new(radius * angle.sin(), height, radius * angle.cos())
    };
    let mut corners = Vec::new();
    for side in 0..sides {
        for ends in line.windows(2) {
            let [a, b] = [at(side, ends[0]), at(side, ends[1])];
            let [c, d] = [at(side + 1, ends[1]), at(side + 1, ends[0])];
            corners.extend([a, b, c, a, c, d]);
        }
    }
    corners
}

/// The pipeline of solid meshes, or where there is a `blend` that of meshes that leave no depth.
fn pipeline(
    device: &wgpu::Device,
    bindings: &wgpu::BindGroupLayout,
    pass: PassSettings,
    blend: Option<wgpu::BlendState>,
) -> RenderPipeline {
    let module = device.create_shader_module(wgpu::include_wgsl!("world.wgsl"));
    let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some("world"),
        bind_group_layouts: &[Some(bindings)],
        ..Default::default()
    });
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("world"),
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: None,
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            buffers: &[
                Some(wgpu::VertexBufferLayout {
                    array_stride: size_of::<[f32; 3]>() as u64,
                    step_mode: wgpu::VertexStepMode::Vertex,
                    attributes: &vertex_attr_array![0 => Float32x3],
                }),
                Some(wgpu::VertexBufferLayout {
                    array_stride: size_of::<Instance>() as u64,
                    step_mode: wgpu::VertexStepMode::Instance,
                    attributes: &vertex_attr_array![1 => Float32x4, 2 => Float32x4, 3 => Float32x4, 4 => Float32x4, 5 => Float32x4],
                }),
            ],
        },
        primitive: wgpu::PrimitiveState {
            cull_mode: Some(wgpu::Face::Back),
            ..Default::default()
        },
        depth_stencil: Some(wgpu::DepthStencilState {
            format: DEPTH_FORMAT,
            depth_write_enabled: Some(blend.is_none()),
            depth_compare: Some(pass.depth.compare()),
            stencil: wgpu::StencilState::default(),
            bias: wgpu::DepthBiasState::default(),
        }),
        multisample: wgpu::MultisampleState {
            count: pass.samples,
            ..Default::default()
        },
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: None,
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            targets: &[Some(wgpu::ColorTargetState {
                format: pass.color,
                blend,
                write_mask: wgpu::ColorWrites::ALL,
            })],
        }),
        multiview_mask: None,
        cache: None,
    })
}
