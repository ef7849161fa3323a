//! A picture whose coverage alone counts, as numbers that are quick to look up.

use crate::texture::{Image, nearest};
use crate::wgsl::log_to_two;
use std::sync::Arc;

/// What a tool leaves.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Mark {
    /// As graphics cards have it.
    pub(super) image: Arc<Image>,
    /// Its copies' coverage.
    copies: Vec<Plane>,
}

/// The coverage of one of the picture's copies.
#[derive(Clone, Debug, PartialEq)]
struct Plane {
    size: [usize; 2],
    /// Row by row from the top.
    coverage: Vec<f32>,
}

/// A picture blurred over some texels.
pub(super) struct Blurred<'a> {
    finer: &'a Plane,
    coarser: &'a Plane,
    /// What comes of the coarser one.
    share: f32,
}

impl Mark {
    pub(super) fn new(image: Image) -> Self {
        let copy = |level| {
            let (size, texels) = image.level(level);
            let coverage = texels.iter().map(|texel| texel[3].to_f32());
            Plane {
                size,
                coverage: coverage.collect(),
            }
        };
        Self {
            copies: (0..image.levels()).map(copy).collect(),
            image: Arc::new(image),
        }
    }

    /// Width and height in texels.
    pub(super) fn size(&self) -> [f32; 2] {
        self.copies[0].size.map(|side| side as f32)
    }

    /// The picture blurred over so many texels, at least 1, as [`Image::at`] has it.
    pub(super) fn blurred(&self, texels: f32) -> Blurred<'_> {
        let last = self.copies.len() - 1;
        let level = log_to_two(texels).min(last as f32);
        let finer = level as usize;
        Blurred {
            finer: &self.copies[finer],
            coarser: &self.copies[(finer + 1).min(last)],
            share: level - finer as f32,
        }
    }
}

impl Blurred<'_> {
    /// The coverage at a place, 0 to 1 from left to right and from top to bottom.
    pub(super) fn at(&self, place: [f32; 2], repeats: bool) -> f32 {
        let coverage = self.finer.at(place, repeats);
        match self.share > 0.0 {
            true => mix(coverage, self.coarser.at(place, repeats), self.share),
            false => coverage,
        }
    }
}

impl Plane {
    /// Between the middles of the four nearest texels. What repeats does so along the stroke alone.
    fn at(&self, [x, y]: [f32; 2], repeats: bool) -> f32 {
        let [width, height] = self.size;
        let (left, right, across) = nearest(x, width, repeats);
        let (upper, lower, down) = nearest(y, height, false);
        let row = |row: usize| {
            let texels = &self.coverage[row * width..][..width];
            mix(texels[left], texels[right], across)
        };
        mix(row(upper), row(lower), down)
    }
}

fn mix(from: f32, to: f32, share: f32) -> f32 {
    from + (to - from) * share
}
