//! Textures: what a painted sample may look up. A gradient as text, or the texels of a picture.

mod image;
mod ramp;

pub use image::{Blurred, Image, ImageError};
pub(crate) use image::{choose, index, least, most, of_half};
pub use ramp::{Ramp, Row};

use crate::lanes::widest;
use crate::samples::{BLOCK, Vectors};
use crate::wgsl::{Lookup, Vec2, Vec4};
use std::sync::Arc;

/// The value of a parameter with `@texture`.
#[derive(Clone, Debug, PartialEq)]
pub enum Texture {
    /// Nothing: its texels are 0, also in coverage.
    None,
    /// A gradient.
    Ramp(Arc<Ramp>),
    /// A PNG file that has not been read yet, by its name in the preset: [`Values::read_textures`](crate::Values::read_textures) puts an
    /// [`Self::Image`] in its place. Until then its texels are those of [`Self::None`].
    File(String),
    /// A picture.
    Image {
        /// Its name in the preset.
        file: String,
        /// What is in it.
        image: Arc<Image>,
    },
}

impl Texture {
    /// The texel at a place: linear light, and coverage from 0 to 1. A place that isn't finite is 0.
    ///
    /// `repeats`: beyond an edge a picture goes on from the other one, in place of going on as at its edge.
    #[must_use]
    pub fn texel(&self, lookup: &Lookup, repeats: bool) -> Vec4<f32> {
        let [x, y] = [lookup.at.x, lookup.at.y].map(finite);
        let [x, y, z, w] = match self {
            Self::None | Self::File(_) => [0.0; 4],
            Self::Ramp(ramp) => {
                let [red, green, blue] = ramp.at(x, y);
                [red, green, blue, 1.0]
            }
            Self::Image { image, .. } => image.at([x, y], lookup.size, repeats),
        };
        Vec4 { x, y, z, w }
    }
}

/// Where each sample of a block looks a texture up.
pub(crate) struct Lookups {
    /// [`Lookup::texture`], [`Lookup::at`] and [`Lookup::size`].
    texture: [u32; BLOCK],
    x: [f32; BLOCK],
    y: [f32; BLOCK],
    size: [f32; BLOCK],
}

/// The texel that each sample of a block found: linear light, and coverage.
pub(crate) struct Texels {
    color: Vectors,
    coverage: [f32; BLOCK],
}

impl Texels {
    /// All 0.
    pub(crate) const NOTHING: Self = Self {
        color: Vectors::NOTHING,
        coverage: [0.0; BLOCK],
    };

    /// That of sample `index`.
    #[inline(always)]
    pub(crate) fn at(&self, index: usize) -> Vec4<f32> {
        Vec4 {
            x: self.color.x[index],
            y: self.color.y[index],
            z: self.color.z[index],
            w: self.coverage[index],
        }
    }

    #[inline(always)]
    fn set(&mut self, index: usize, texel: Vec4<f32>) {
        let Vec4 { x, y, z, w } = texel;
        self.color.set(index, crate::wgsl::Vec3 { x, y, z });
        self.coverage[index] = w;
    }
}

impl Lookups {
    /// All 0.
    pub(crate) const NOTHING: Self = Self {
        texture: [0; BLOCK],
        x: [0.0; BLOCK],
        y: [0.0; BLOCK],
        size: [0.0; BLOCK],
    };

    fn at(&self, index: usize) -> Lookup {
        Lookup {
            texture: self.texture[index],
            at: Vec2 {
                x: self.x[index],
                y: self.y[index],
            },
            size: self.size[index],
        }
    }

    /// Sets that of sample `index`.
    #[inline(always)]
    pub(crate) fn set(&mut self, index: usize, lookup: &Lookup) {
        self.texture[index] = lookup.texture;
        self.x[index] = lookup.at.x;
        self.y[index] = lookup.at.y;
        self.size[index] = lookup.size;
    }

    /// Looks up what each sample finds in these textures, which may repeat; 0 where there is none of that number.
    pub(crate) fn look_up(&self, textures: &[(Texture, bool)], texels: &mut Texels) {
        let first = self.texture[0];
        let is_one = self.texture.iter().all(|texture| *texture == first);
        match textures.get(first as usize).filter(|_| is_one) {
            Some((Texture::Ramp(ramp), _)) if ramp.is_short() => {
                texels.coverage = [1.0; BLOCK];
                widest(
                    #[inline(always)]
                    || ramp.of_block(&self.x, &self.y, &mut texels.color),
                );
                return;
            }
            Some((Texture::Image { image, .. }, repeats)) => {
                widest(
                    #[inline(always)]
                    || self.look_up_in(image, *repeats, texels),
                );
                return;
            }
            _ => {}
        }
        for index in 0..BLOCK {
            let lookup = self.at(index);
            if let Some((texture, repeats)) = textures.get(lookup.texture as usize) {
                texels.set(index, texture.texel(&lookup, *repeats));
            }
        }
    }
    /// Looks up what each sample finds in a picture.
    #[inline(always)]
    fn look_up_in(&self, image: &Image, repeats: bool, texels: &mut Texels) {
        const SOME: usize = 16;
        let (x, _) = self.x.as_chunks::<SOME>();
        let (y, _) = self.y.as_chunks::<SOME>();
        let (size, _) = self.size.as_chunks::<SOME>();
        for (chunk, ((x, y), size)) in x.iter().zip(y).zip(size).enumerate() {
            let (mut x, mut y) = (*x, *y);
            for place in [&mut x, &mut y] {
                for place in place {
                    *place = finite(*place);
                }
            }
            let found = image.at_all([&x, &y], size, repeats);
            for (k, [x, y, z, w]) in found.into_iter().enumerate() {
                texels.set(chunk * SOME + k, Vec4 { x, y, z, w });
            }
        }
    }
}

/// A number of a place; 0 where it isn't finite.
#[inline(always)]
fn finite(x: f32) -> f32 {
    choose(x.is_finite(), x, 0.0)
}
