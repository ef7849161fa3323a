//! The pictures on a frame's surfaces, and those of its brushes: all texels of all their copies, one behind the other in the rows of one texture.

use super::error::GpuError;
use super::images::{TEXEL, VIEW, create, write_rows};
use crate::brushwork::Brushwork;
use crate::drawing::Surface;
use effects::Image;
use std::sync::Arc;
use wgpu::{Device, Queue, TextureView};

/// Texels in a row, as `shaders/gpu/textured.wgsl` has it.
const WIDTH: usize = 4096;

/// The texture. It stays while frames have the same pictures.
#[derive(Default)]
pub(super) struct Atlas {
    images: Vec<Arc<Image>>,
    view: Option<TextureView>,
    rows: usize,
}

/// The pictures of some surfaces and brushes, each once, in the order of their first surfaces, then of their first layers.
pub(super) fn images_of<'a>(
    surfaces: &'a [Surface],
    brushwork: &'a Brushwork,
) -> Vec<&'a Arc<Image>> {
    let textures = surfaces.iter().filter_map(|s| s.texture.as_ref());
    let layers = brushwork.layers.iter();
    let all = textures
        .map(|texture| &texture.image)
        .chain(layers.flat_map(|layer| layer.brush.marks()));
    let mut images: Vec<&Arc<Image>> = Vec::new();
    for image in all {
        if !images.iter().any(|known| Arc::ptr_eq(known, image)) {
            images.push(image);
        }
    }
    images
}

/// Texels of a picture and its copies.
pub(super) fn texels(image: &Image) -> usize {
    (0..image.levels())
        .map(|level| image.level(level).1.len())
        .sum()
}

impl Atlas {
    /// Holds the pictures of these surfaces and brushes, and no others. Whether they are others than before.
    pub(super) fn follow(
        &mut self,
        device: &Device,
        queue: &Queue,
        surfaces: &[Surface],
        brushwork: &Brushwork,
    ) -> Result<bool, GpuError> {
        let images = images_of(surfaces, brushwork);
        let is_same = |(old, new): (&Arc<Image>, &&Arc<Image>)| Arc::ptr_eq(old, new);
        if images.len() == self.images.len() && self.images.iter().zip(&images).all(is_same) {
            return Ok(false);
        }
        *self = Self::default();
        if images.is_empty() {
            return Ok(true);
        }
        let count: usize = images.iter().map(|image| texels(image)).sum();
        let rows = count.div_ceil(WIDTH);
        let texture = create(device, [WIDTH as u32, rows as u32], 1)?;
        let mut words = Vec::with_capacity(4 * WIDTH * rows);
        for image in &images {
            for level in 0..image.levels() {
                let (_, texels) = image.level(level);
                words.extend(texels.iter().flatten().map(|x| x.to_bits()));
            }
        }
        words.resize(4 * WIDTH * rows, 0);
        write_rows(queue, &texture, 0, [WIDTH as u32, rows as u32], &words);
        self.view = Some(texture.create_view(&VIEW));
        self.images = images.into_iter().cloned().collect();
        self.rows = rows;
        Ok(true)
    }

    /// What is bound; nothing where there are no pictures.
    pub(super) fn view(&self) -> Option<&TextureView> {
        self.view.as_ref()
    }

    /// Its size.
    pub(super) fn bytes(&self) -> u64 {
        (self.rows * WIDTH) as u64 * u64::from(TEXEL)
    }
}
