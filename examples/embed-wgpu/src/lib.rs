//! inkstrand's hair inside a wgpu program that has its own camera, meshes and render pass.
//!
//! [`hair`] is all that the program has to do with inkstrand; [`Demo::draw`] shows where in a frame it goes. The rest is what
//! every wgpu program has: [`view`] the camera, [`world`] meshes, [`device`] a device, [`picture`] a texture in place of a
//! window.

pub mod device;
pub mod hair;
pub mod picture;
pub mod view;
pub mod world;

use hair::Hair;
use render::gpu::PassFormat;
use std::path::{Path, PathBuf};
use view::{DEPTH_FORMAT, DepthRange, Orbit, View};
use world::World;

/// A result, or a sentence for the user.
pub type Outcome<T = ()> = Result<T, Box<dyn std::error::Error>>;

/// What the program's render pass is like.
#[derive(Clone, Copy, Debug)]
pub struct PassSettings {
    /// Format of what is drawn into.
    pub color: wgpu::TextureFormat,
    /// Samples a pixel: 1, or [`hair::SAMPLES`].
    pub samples: u32,
    /// How depths are stored.
    pub depth: DepthRange,
}

/// What is drawn: for tests, which look at the parts by themselves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shown {
    /// The program's own meshes.
    pub world: bool,
    /// inkstrand's hair and head.
    pub hair: bool,
}

impl Shown {
    /// Both.
    pub const ALL: Self = Self {
        world: true,
        hair: true,
    };
}

/// The whole scene, on a device.
pub struct Demo {
    gpu: render::gpu::Gpu,
    settings: PassSettings,
    world: World,
    hair: Hair,
    attachments: Option<Attachments>,
}

/// The render pass's textures, of the size of what is drawn into.
struct Attachments {
    size_px: [u32; 2],
    /// Where the pass has several samples, which it then resolves.
    color: Option<wgpu::TextureView>,
    depth: wgpu::TextureView,
}

impl Demo {
    /// Reads the preset, and makes all that is drawn.
    ///
    /// # Errors
    ///
    /// Says what is wrong with the files, or what the device lacks.
    pub fn open(
        gpu: render::gpu::Gpu,
        settings: PassSettings,
        preset: &Path,
        motion: Option<PathBuf>,
    ) -> Outcome<Self> {
        let hair = Hair::open(&gpu.device, &gpu.queue, preset, motion)?;
        let world = World::new(&gpu.device, hair.head(), settings);
        gpu.check()?;
        Ok(Self {
            gpu,
            settings,
            world,
            hair,
            attachments: None,
        })
    }

    /// The device, and what went wrong on it.
    #[must_use]
    pub fn gpu(&self) -> &render::gpu::Gpu {
        &self.gpu
    }

    /// The program's own meshes.
    #[must_use]
    pub fn world(&self) -> &World {
        &self.world
    }

    /// The view from a place on the way around the head.
    #[must_use]
    pub fn view(&self, orbit: Orbit, size_px: [u32; 2]) -> View {
        View::of(self.hair.head(), orbit, size_px, self.settings.depth)
    }

    /// Draws the scene at `time` (seconds) into a texture of [`PassSettings::color`], and submits it.
    ///
    /// # Errors
    ///
    /// When the hair can't be drawn, or the device is lost.
    pub fn draw(
        &mut self,
        target: &wgpu::Texture,
        time: f32,
        view: &View,
        shown: Shown,
    ) -> Outcome {
        let into = target.create_view(&wgpu::TextureViewDescriptor::default());
        let mut encoder = self.gpu.device.create_command_encoder(&Default::default());

        // First the hair's own passes, in the same encoder.
        let format = PassFormat {
            color: self.settings.color,
            depth: Some(view.pass_depth()),
            samples: self.settings.samples,
        };
        let light = self.hair.prepare(&mut encoder, time, view, format)?;
        self.world.prepare(&self.gpu.queue, time, view, light);

        // Then the program's render pass: solid meshes, the hair, and what can be looked through.
        let mut pass = self.begin_pass(&mut encoder, &into, view);
        if shown.world {
            self.world.render_solid(&mut pass);
        }
        if shown.hair {
            self.hair.render(&mut pass);
        }
        if shown.world {
            self.world.render_glass(&mut pass);
        }
        drop(pass);

        self.gpu.queue.submit([encoder.finish()]);
        Ok(self.gpu.check()?)
    }

    fn begin_pass<'e>(
        &mut self,
        encoder: &'e mut wgpu::CommandEncoder,
        into: &wgpu::TextureView,
        view: &View,
    ) -> wgpu::RenderPass<'e> {
        const SKY: wgpu::Color = wgpu::Color {
            r: 0.78,
            g: 0.82,
            b: 0.86,
            a: 1.0,
        };
        if self
            .attachments
            .as_ref()
            .is_none_or(|attachments| attachments.size_px != view.size_px)
        {
            self.attachments = None; // before the new ones take its place in memory
        }
        let settings = self.settings;
        let device = &self.gpu.device;
        let attachments = self
            .attachments
            .get_or_insert_with(|| Attachments::new(device, settings, view.size_px));
        let (texture, resolve_target) = match &attachments.color {
            Some(samples) => (samples, Some(into)),
            None => (into, None),
        };
        encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("scene"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: texture,
                depth_slice: None,
                resolve_target,
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(SKY),
                    store: wgpu::StoreOp::Store,
                },
            })],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &attachments.depth,
                depth_ops: Some(wgpu::Operations {
                    load: wgpu::LoadOp::Clear(settings.depth.farthest()),
                    store: wgpu::StoreOp::Discard,
                }),
                stencil_ops: None,
            }),
            ..Default::default()
        })
    }
}

impl Attachments {
    fn new(device: &wgpu::Device, settings: PassSettings, size_px: [u32; 2]) -> Self {
        let texture = |format| {
            let texture = device.create_texture(&wgpu::TextureDescriptor {
                label: Some("scene"),
                size: wgpu::Extent3d {
                    width: size_px[0],
                    height: size_px[1],
                    depth_or_array_layers: 1,
                },
                mip_level_count: 1,
                sample_count: settings.samples,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: wgpu::TextureUsages::RENDER_ATTACHMENT,
                view_formats: &[],
            });
            texture.create_view(&wgpu::TextureViewDescriptor::default())
        };
        Self {
            size_px,
            color: (settings.samples > 1).then(|| texture(settings.color)),
            depth: texture(DEPTH_FORMAT),
        }
    }
}

/// The README's code, compiled.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
