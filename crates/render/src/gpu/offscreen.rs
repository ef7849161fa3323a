//! Pictures from a graphics card, without a window.

use super::adapter::{AdapterKind, Gpu};
use super::error::GpuError;
use super::renderer::{GpuStats, Renderer, Source};
use crate::check::DrawError;
use crate::drawing::Drawing;
use crate::frame::Frame;
use crate::picture::Picture;
use crate::planes::SamplePlanes;

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

    /// Whether there is no graphics card, but a driver that runs its programs on the CPU. Such drivers break off loops that go on for too long, which spoils
    /// tiles where hair is dense.
    #[must_use]
    pub fn is_software(&self) -> bool {
        self.info().device_type == wgpu::DeviceType::Cpu
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
        let mut encoder = self.encoder();
        self.renderer.draw_picture(&mut encoder, source, samples)?;
        let bytes = u64::from(width) * u64::from(height) * size_of::<[f32; 4]>() as u64;
        let Some(drawn) = self.renderer.picture() else {
            return Err(GpuError::Memory);
        };
        let drawn = drawn.clone();
        let pixels = self.read(encoder, &drawn, bytes)?;
        Ok(Picture {
            width,
            height,
            pixels,
        })
    }

    /// Draws the samples of a picture, each with the features that the frame declares, as
    /// [`cpu::Rasterizer::draw_samples`](crate::cpu::Rasterizer::draw_samples) does: up to four of every pixel at a time, which `take` is
    /// given, from the first to the last. `planes` is working memory.
    ///
    /// # Errors
    ///
    /// As [`Self::draw`]; or when there isn't enough memory.
    pub fn draw_samples(
        &mut self,
        frame: &Frame,
        samples: u32,
        planes: &mut SamplePlanes,
        take: impl FnMut(&mut SamplePlanes),
    ) -> Result<(), GpuError> {
        let drawn = self.try_draw_samples(frame, samples, planes, take);
        self.gpu.check()?;
        drawn
    }

    fn try_draw_samples(
        &mut self,
        frame: &Frame,
        samples: u32,
        planes: &mut SamplePlanes,
        mut take: impl FnMut(&mut SamplePlanes),
    ) -> Result<(), GpuError> {
        const AT_ONCE: usize = 4;
        let mut encoder = self.encoder();
        self.renderer.draw_samples(&mut encoder, frame, samples)?;
        self.gpu.queue.submit([encoder.finish()]);
        let size = frame.camera.size_px();
        let [width, height] = size;
        let samples = samples as usize;
        for first in (0..samples).step_by(AT_ONCE) {
            let count = AT_ONCE.min(samples - first);
            planes
                .begin(size, frame.all_features(), [first, count])
                .ok_or(DrawError::Memory(width, height))?;
            for sample in first..first + count {
                let mut encoder = self.encoder();
                let told = self.renderer.tell(&mut encoder, size, sample as u32)?;
                let told = told.clone();
                let bytes = planes.words_of_sample() as u64 * size_of::<u32>() as u64;
                let words: Vec<u32> = self.read(encoder, &told, bytes)?;
                planes.push_sample(&words);
            }
            take(planes);
        }
        Ok(())
    }

    fn encoder(&self) -> wgpu::CommandEncoder {
        let device = &self.gpu.device;
        device.create_command_encoder(&wgpu::CommandEncoderDescriptor {
            label: Some("picture"),
        })
    }

    /// Submits what is recorded, waits for it, and reads the first `bytes` of a buffer that it fills.
    fn read<T: bytemuck::AnyBitPattern>(
        &mut self,
        mut encoder: wgpu::CommandEncoder,
        filled: &wgpu::Buffer,
        bytes: u64,
    ) -> Result<Vec<T>, GpuError> {
        let is_enough = |buffer: &wgpu::Buffer| buffer.size() >= bytes;
        let read_back = match self.read_back.take().filter(is_enough) {
            Some(buffer) => buffer,
            None => self.gpu.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("picture"),
                size: bytes,
                usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
                mapped_at_creation: false,
            }),
        };
        let read_back = self.read_back.insert(read_back);
        encoder.copy_buffer_to_buffer(filled, 0, read_back, 0, bytes);
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
        let read = {
            let view = read_back
                .get_mapped_range(..bytes)
                .map_err(|error| GpuError::Refused(error.to_string()))?;
            bytemuck::cast_slice::<u8, T>(&view).to_vec()
        };
        read_back.unmap();
        Ok(read)
    }
}
