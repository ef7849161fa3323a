//! Textures: what a painted sample may look up. A gradient as text, or the texels of a picture.

mod image;
mod ramp;

pub use image::{Image, ImageError};
pub use ramp::{Ramp, Row};

use crate::wgsl::{Lookup, Vec4};
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
        let [x, y] = [lookup.at.x, lookup.at.y].map(|x| if x.is_finite() { x } else { 0.0 });
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
