//! Pictures that layers look up, as textures with their smaller copies.

use super::error::GpuError;
use effects::{Image, Texture};
use std::sync::Arc;
use wgpu::{Device, Queue, TextureView};

/// The pictures of the layers that paint. They stay from frame to frame.
#[derive(Default)]
pub(super) struct Images {
    uploaded: Vec<Uploaded>,
    /// Bound where a texture is no picture.
    blank: Option<TextureView>,
}

/// A picture on the card.
struct Uploaded {
    image: Arc<Image>,
    view: TextureView,
    bytes: u64,
    is_used: bool,
}

impl Images {
    /// Before the textures of a frame are asked for.
    pub(super) fn begin(&mut self) {
        for image in &mut self.uploaded {
            image.is_used = false;
        }
    }

    /// Drops what the frame did not ask for.
    pub(super) fn end(&mut self) {
        self.uploaded.retain(|image| image.is_used);
    }

    /// What is bound for a texture, and whether it had to be made.
    pub(super) fn view(
        &mut self,
        device: &Device,
        queue: &Queue,
        texture: &Texture,
    ) -> Result<(TextureView, bool), GpuError> {
        let Texture::Image { image, .. } = texture else {
            let is_new = self.blank.is_none();
            let blank = || create(device, [1, 1], 1).map(|texture| texture.create_view(&VIEW));
            let view = match self.blank.take() {
                Some(view) => view,
                None => blank()?,
            };
            return Ok((self.blank.insert(view).clone(), is_new));
        };
        let is_it = |uploaded: &&mut Uploaded| Arc::ptr_eq(&uploaded.image, image);
        if let Some(uploaded) = self.uploaded.iter_mut().find(is_it) {
            uploaded.is_used = true;
            return Ok((uploaded.view.clone(), false));
        }
        let uploaded = Uploaded::new(device, queue, image)?;
        let view = uploaded.view.clone();
        self.uploaded.push(uploaded);
        Ok((view, true))
    }

    /// Bytes of all pictures.
    pub(super) fn bytes(&self) -> u64 {
        self.uploaded.iter().map(|image| image.bytes).sum()
    }
}

/// All of a texture.
pub(super) const VIEW: wgpu::TextureViewDescriptor = wgpu::TextureViewDescriptor {
    label: None,
    format: None,
    dimension: None,
    usage: None,
    aspect: wgpu::TextureAspect::All,
    base_mip_level: 0,
    mip_level_count: None,
    base_array_layer: 0,
    array_layer_count: None,
};

/// Bytes of a texel.
pub(super) const TEXEL: u32 = 8;

impl Uploaded {
    fn new(device: &Device, queue: &Queue, image: &Arc<Image>) -> Result<Self, GpuError> {
        let levels = image.levels() as u32;
        let texture = create(device, image.size().map(|side| side as u32), levels)?;
        let mut bytes = 0;
        for level in 0..levels {
            let ([width, height], texels) = image.level(level as usize);
            let words: Vec<u16> = texels.iter().flatten().map(|x| x.to_bits()).collect();
            let [width, height] = [width, height].map(|side| side as u32);
            bytes += words.len() as u64 * 2;
            write_rows(queue, &texture, level, [width, height], &words);
        }
        Ok(Self {
            image: Arc::clone(image),
            view: texture.create_view(&VIEW),
            bytes,
            is_used: true,
        })
    }
}

/// Writes all rows of one of a texture's copies, as half precision numbers.
pub(super) fn write_rows(
    queue: &Queue,
    texture: &wgpu::Texture,
    level: u32,
    [width, height]: [u32; 2],
    words: &[u16],
) {
    queue.write_texture(
        wgpu::TexelCopyTextureInfo {
            texture,
            mip_level: level,
            origin: wgpu::Origin3d::ZERO,
            aspect: wgpu::TextureAspect::All,
        },
        bytemuck::cast_slice(words),
        wgpu::TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some(TEXEL * width),
            rows_per_image: Some(height),
        },
        wgpu::Extent3d {
            width,
            height,
            depth_or_array_layers: 1,
        },
    );
}

/// A texture of half precision numbers, with copies.
pub(super) fn create(
    device: &Device,
    [width, height]: [u32; 2],
    levels: u32,
) -> Result<wgpu::Texture, GpuError> {
    let most = device.limits().max_texture_dimension_2d;
    if width.max(height) > most {
        return Err(GpuError::Limit {
            what: "texels along a side of a texture",
            has: most.into(),
            needs: width.max(height).into(),
        });
    }
    let memory = device.push_error_scope(wgpu::ErrorFilter::OutOfMemory);
    let texture = device.create_texture(&wgpu::TextureDescriptor {
        label: Some("pictures"),
        size: wgpu::Extent3d {
            width,
            height,
            depth_or_array_layers: 1,
        },
        mip_level_count: levels,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::Rgba16Float,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    });
    match pollster::block_on(memory.pop()) {
        Some(error) => Err(error.into()),
        None => Ok(texture),
    }
}
