//! Pictures from a graphics card, without a window.

use super::adapter::{AdapterKind, Gpu};
use super::error::GpuError;
use super::renderer::{GpuStats, Renderer, Source};
use crate::drawing::Drawing;
use crate::frame::Frame;
use crate::picture::Picture;

/// Draws [`Frame`]s into [`Picture`]s on a device of its own.
pub struct Offscreen {
    gpu: Gpu,
    renderer: Renderer,
    read_back: Option<wgpu::Buffer>,
}

impl Offscreen {
    /// On the best graphics card of the kind.
    ///
    /// # Errors
    ///
    /// When there is none, or it can't do what is needed.
    pub fn open(kind: AdapterKind) -> Result<Self, GpuError> {
        Self::on(Gpu::open(kind)?)
    }

    /// On that device.
    ///
    /// # Errors
    ///
    /// When it can't do what is needed.
    pub fn on(gpu: Gpu) -> Result<Self, GpuError> {
        let renderer = Renderer::new(&gpu.device, &gpu.queue)?;
        gpu.check()?;
        Ok(Self {
            gpu,
            renderer,
            read_back: None,
        })
    }

    /// Name, driver and kind of the graphics card.
    #[must_use]
    pub fn info(&self) -> &wgpu::AdapterInfo {
        &self.gpu.info
    }

    /// What the renderer has, and what the last frame took.
    #[must_use]
    pub fn stats(&self) -> GpuStats {
        self.renderer.stats()
    }

    /// Draws a picture with that many samples a pixel, and waits for it.
    ///
    /// # Errors
    ///
    /// When the frame can't be drawn on this graphics card. What comes after [`GpuError::Lost`] fails too.
    pub fn draw(&mut self, frame: &Frame, samples: u32) -> Result<Picture, GpuError> {
        self.draw_source(Source::Frame(frame), frame.camera.size_px(), samples)
    }

    /// Draws strokes that are made already, as [`cpu::Rasterizer`](crate::cpu::Rasterizer) does.
    ///
    /// # Errors
    ///
    /// As [`Self::draw`].
    pub fn draw_strokes(&mut self, drawing: &Drawing, samples: u32) -> Result<Picture, GpuError> {
        self.draw_source(Source::Drawing(drawing), drawing.size, samples)
    }

    fn draw_source(
        &mut self,
        source: Source,
        size: [u32; 2],
        samples: u32,
    ) -> Result<Picture, GpuError> {
        let drawn = self.try_draw(source, size, samples);
        // A fault that was reported beside the calls tells more than what came of it.
        self.gpu.check()?;
        drawn
    }

    fn try_draw(
        &mut self,
        source: Source,
        [width, height]: [u32; 2],
        samples: u32,
    ) -> Result<Picture, GpuError> {
        let device = &self.gpu.device;
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor {
            label: Some("picture"),
        });
        self.renderer.draw_picture(&mut encoder, source, samples)?;
        let bytes = u64::from(width) * u64::from(height) * size_of::<[f32; 4]>() as u64;
        let is_enough = |buffer: &wgpu::Buffer| buffer.size() >= bytes;
        if !self.read_back.as_ref().is_some_and(is_enough) {
            self.read_back = Some(device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("picture"),
                size: bytes,
                usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
                mapped_at_creation: false,
            }));
        }
        let (Some(drawn), Some(read_back)) = (self.renderer.picture(), &self.read_back) else {
            return Err(GpuError::Memory);
        };
        encoder.copy_buffer_to_buffer(drawn, 0, read_back, 0, bytes);
        self.gpu.queue.submit([encoder.finish()]);

        let (sender, receiver) = std::sync::mpsc::channel();
        read_back.map_async(wgpu::MapMode::Read, ..bytes, move |result| {
            // Nobody listens any more where an error came before.
            let _ = sender.send(result);
        });
        self.renderer.wait_for_report()?;
        match receiver.try_recv() {
            Ok(Ok(())) => {}
            Ok(Err(error)) => return Err(GpuError::Lost(error.to_string())),
            Err(_) => return Err(GpuError::Lost("it gives no answer".to_owned())),
        }
        let pixels = {
            let view = read_back
                .get_mapped_range(..bytes)
                .map_err(|error| GpuError::Refused(error.to_string()))?;
            bytemuck::cast_slice::<u8, [f32; 4]>(&view).to_vec()
        };
        read_back.unmap();
        Ok(Picture {
            width,
            height,
            pixels,
        })
    }
}
