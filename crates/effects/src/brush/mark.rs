//! A picture whose coverage alone counts, as numbers that are quick to look up at several places at once.

use crate::texture::{Image, index, least, log_to_two_from_one, nearest};
use std::sync::Arc;

/// What a tool leaves.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Mark {
    /// As graphics cards have it.
    pub(super) image: Arc<Image>,
    copies: Vec<Copy>,
    /// That of all copies' texels, one copy behind the other, row by row from the top.
    coverage: Vec<f32>,
}

/// One of the picture's copies.
#[derive(Clone, Debug, PartialEq)]
struct Copy {
    /// Where its texels begin.
    first: u32,
    /// Texels of a row.
    stride: u32,
    /// Width and height in texels.
    size: [f32; 2],
}

/// A picture blurred over some texels at each of `N` places.
pub(super) struct Blurred<'a, const N: usize> {
    mark: &'a Mark,
    finer: Copies<N>,
    /// With what comes of it; nothing where that is nothing at all places.
    coarser: Option<(Copies<N>, [f32; N])>,
}

/// A copy for each place.
struct Copies<const N: usize> {
    first: [u32; N],
    stride: [u32; N],
    width: [f32; N],
    height: [f32; N],
}

impl Mark {
    pub(super) fn new(image: Image) -> Self {
        let (mut copies, mut coverage) = (Vec::new(), Vec::new());
        for level in 0..image.levels() {
            let (size, texels) = image.level(level);
            copies.push(Copy {
                // An image has less than 2^25 texels with all copies.
                first: coverage.len() as u32,
                stride: size[0] as u32,
                size: size.map(|side| side as f32),
            });
            coverage.extend(texels.iter().map(|texel| texel[3].to_f32()));
        }
        Self {
            copies,
            coverage,
            image: Arc::new(image),
        }
    }

    /// Width and height in texels.
    #[inline(always)]
    pub(super) fn size(&self) -> [f32; 2] {
        self.copies[0].size
    }

    /// The picture blurred over so many texels, at least 1, as [`Image::at`] has it.
    #[inline(always)]
    pub(super) fn blurred<const N: usize>(&self, texels: &[f32; N]) -> Blurred<'_, N> {
        let last = (self.copies.len() - 1) as f32;
        let (mut finer, mut coarser, mut share) = ([0; N], [0; N], [0.0; N]);
        let mut is_mixed = false;
        for k in 0..N {
            let level = least(log_to_two_from_one(texels[k]), last);
            let whole = level.floor();
            finer[k] = index(whole);
            coarser[k] = index(least(whole + 1.0, last));
            share[k] = level - whole;
            is_mixed |= share[k] > 0.0;
        }
        Blurred {
            mark: self,
            finer: self.copies(&finer),
            coarser: is_mixed.then(|| (self.copies(&coarser), share)),
        }
    }

    #[inline(always)]
    fn copies<const N: usize>(&self, levels: &[u32; N]) -> Copies<N> {
        let mut copies = Copies {
            first: [0; N],
            stride: [0; N],
            width: [0.0; N],
            height: [0.0; N],
        };
        for k in 0..N {
            let copy = &self.copies[levels[k] as usize];
            copies.first[k] = copy.first;
            copies.stride[k] = copy.stride;
            [copies.width[k], copies.height[k]] = copy.size;
        }
        copies
    }

    /// Between the middles of the four nearest texels of each copy. What repeats does so along the stroke alone.
    #[inline(always)]
    fn between<const N: usize>(
        &self,
        copies: &Copies<N>,
        [x, y]: [&[f32; N]; 2],
        repeats: bool,
    ) -> [f32; N] {
        let (mut across, mut down) = ([0.0; N], [0.0; N]);
        let mut places = [[0; N]; 4];
        for k in 0..N {
            let [left, right, share] = nearest(x[k], copies.width[k], repeats);
            let [upper, lower, below] = nearest(y[k], copies.height[k], false);
            across[k] = share;
            down[k] = below;
            let row = |row: f32| {
                let texels = index(row).wrapping_mul(copies.stride[k]);
                copies.first[k].wrapping_add(texels)
            };
            let (upper, lower) = (row(upper), row(lower));
            let (left, right) = (index(left), index(right));
            places[0][k] = upper.wrapping_add(left);
            places[1][k] = upper.wrapping_add(right);
            places[2][k] = lower.wrapping_add(left);
            places[3][k] = lower.wrapping_add(right);
        }
        let mut texels = [[0.0; N]; 4];
        for (texels, places) in texels.iter_mut().zip(&places) {
            for k in 0..N {
                texels[k] = self.coverage[places[k] as usize];
            }
        }
        let mut coverage = [0.0; N];
        for k in 0..N {
            let upper = mix(texels[0][k], texels[1][k], across[k]);
            let lower = mix(texels[2][k], texels[3][k], across[k]);
            coverage[k] = mix(upper, lower, down[k]);
        }
        coverage
    }
}

impl<const N: usize> Blurred<'_, N> {
    /// The coverage at each place, 0 to 1 from left to right and from top to bottom.
    #[inline(always)]
    pub(super) fn at(&self, places: [&[f32; N]; 2], repeats: bool) -> [f32; N] {
        let mut coverage = self.mark.between(&self.finer, places, repeats);
        if let Some((coarser, share)) = &self.coarser {
            let other = self.mark.between(coarser, places, repeats);
            for k in 0..N {
                coverage[k] = mix(coverage[k], other[k], share[k]);
            }
        }
        coverage
    }
}

#[inline(always)]
fn mix(from: f32, to: f32, share: f32) -> f32 {
    from + (to - from) * share
}
