//! One frame without a window: the same scene and render pass, in a texture that is read back.

use crate::view::Orbit;
use crate::{Demo, Outcome, Shown};
use std::path::Path;

/// The texture's format.
pub const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8UnormSrgb;

/// Pixels, row after row from above: red, green, blue and alpha, sRGB.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture {
    /// Width and height.
    pub size_px: [u32; 2],
    /// As many as that.
    pub pixels: Vec<[u8; 4]>,
}

/// Draws the scene at `time` (seconds), and waits for it.
///
/// # Errors
///
/// When the size is none, or as [`Demo::draw`].
pub fn draw(
    demo: &mut Demo,
    size_px: [u32; 2],
    time: f32,
    orbit: Orbit,
    shown: Shown,
) -> Outcome<Picture> {
    let most = demo.gpu().device.limits().max_texture_dimension_2d;
    if size_px.iter().any(|side| !(1..=most).contains(side)) {
        let [width, height] = size_px;
        return Err(format!(
            "a picture of {width}x{height} pixels: each side is 1 to {most} on this graphics card"
        )
        .into());
    }
    let size = wgpu::Extent3d {
        width: size_px[0],
        height: size_px[1],
        depth_or_array_layers: 1,
    };
    let texture = demo.gpu().device.create_texture(&wgpu::TextureDescriptor {
        label: Some("picture"),
        size,
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: FORMAT,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
        view_formats: &[],
    });
    let view = demo.view(orbit, size_px);
    demo.draw(&texture, time, &view, shown)?;
    let pixels = read_back(demo.gpu(), &texture, size)?;
    Ok(Picture { size_px, pixels })
}

fn read_back(
    gpu: &render::gpu::Gpu,
    texture: &wgpu::Texture,
    size: wgpu::Extent3d,
) -> Outcome<Vec<[u8; 4]>> {
    // wgpu wants rows that begin at multiples of 256 bytes.
    let row = 4 * size.width as usize;
    let stride = row.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT as usize);
    let buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("picture"),
        size: stride as u64 * u64::from(size.height),
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
        mapped_at_creation: false,
    });
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    encoder.copy_texture_to_buffer(
        texture.as_image_copy(),
        wgpu::TexelCopyBufferInfo {
            buffer: &buffer,
            layout: wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(stride as u32),
                rows_per_image: None,
            },
        },
        size,
    );
    gpu.queue.submit([encoder.finish()]);
    buffer.map_async(wgpu::MapMode::Read, .., |_| {});
    gpu.device.poll(wgpu::PollType::wait_indefinitely())?;
    gpu.check()?;
    let bytes = buffer.get_mapped_range(..)?;
    let rows = bytes.chunks_exact(stride);
    Ok(rows
        .flat_map(|padded| bytemuck::cast_slice(&padded[..row]).to_vec())
        .collect())
}

impl Picture {
    /// Writes it as PNG.
    ///
    /// # Errors
    ///
    /// When the file can't be written.
    pub fn write(&self, path: &Path) -> Outcome {
        let mut bytes = Vec::new();
        let mut png = png::Encoder::new(&mut bytes, self.size_px[0], self.size_px[1]);
        png.set_color(png::ColorType::Rgba);
        png.set_depth(png::BitDepth::Eight);
        png.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
        let mut writer = png.write_header()?;
        writer.write_image_data(self.pixels.as_flattened())?;
        writer.finish()?;
        std::fs::write(path, bytes).map_err(|error| format!("{}: {error}", path.display()))?;
        Ok(())
    }
}
