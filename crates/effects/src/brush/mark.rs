//! A picture whose coverage alone counts, as numbers that are quick to look up at several places at once.

use crate::texture::{Image, choose, index, least, most, of_half};
use crate::wgsl;
use std::sync::Arc;

/// What a tool leaves.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Mark {
    /// As graphics cards have it.
    pub(super) image: Arc<Image>,
    /// Whether its right edge goes on at its left one; else, and at the other edges, it goes on as it is there.
    repeats: bool,
    copies: Vec<Copy>,
    /// Between which texels places lie: those of all copies, one copy behind the other, row by row from above the upper edge, each from left of the left one.
    quads: Vec<Quad>,
}

/// Four texels around a corner: two of a row, and those below them. Of each two, the left one's half lies in the lower bits.
type Quad = [u32; 2];

/// One of the picture's copies.
#[derive(Clone, Debug, PartialEq)]
struct Copy {
    /// Where its quads begin.
    first: u32,
    /// Quads of a row.
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
    /// That of a picture, which repeats along the stroke or not.
    pub(super) fn new(image: Image, repeats: bool) -> Self {
        let (mut copies, mut quads) = (Vec::new(), Vec::new());
        for level in 0..image.levels() {
            let ([width, height], texels) = image.level(level);
            copies.push(Copy {
                // An image has less than 2^25 texels with all copies.
                first: quads.len() as u32,
                stride: width as u32 + 1,
                size: [width, height].map(|side| side as f32),
            });
            let half =
                |column: usize, row: usize| u32::from(texels[row * width + column][3].to_bits());
            let (before, behind) = match repeats {
                true => (width - 1, 0),
                false => (0, width - 1),
            };
            for below in 0..=height {
                let rows = [below.saturating_sub(1), below.min(height - 1)];
                quads.extend((0..=width).map(|right| {
                    let left = right.checked_sub(1).unwrap_or(before);
                    let right = if right < width { right } else { behind };
                    rows.map(|row| half(left, row) | half(right, row) << 16)
                }));
            }
        }
        Self {
            repeats,
            copies,
            quads,
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
            let level = least(wgsl::log_to_two(texels[k]), last);
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

    /// Between the middles of the four nearest texels of each copy.
    #[inline(always)]
    fn between<const N: usize>(&self, copies: &Copies<N>, [x, y]: [&[f32; N]; 2]) -> [f32; N] {
        let (mut across, mut down, mut places) = ([0.0; N], [0.0; N], [0; N]);
        for k in 0..N {
            let x = choose(self.repeats, x[k] - x[k].floor(), x[k]);
            let (column, share) = nearest(x, copies.width[k]);
            let (row, below) = nearest(y[k], copies.height[k]);
            across[k] = share;
            down[k] = below;
            let first = index(row).wrapping_mul(copies.stride[k]);
            places[k] = copies.first[k]
                .wrapping_add(first)
                .wrapping_add(index(column));
        }
        let (mut upper, mut lower) = ([0; N], [0; N]);
        for k in 0..N {
            [upper[k], lower[k]] = self.quads[places[k] as usize];
        }
        let mut coverage = [0.0; N];
        for k in 0..N {
            let of = |pair: u32| mix(of_half(pair & 0xffff), of_half(pair >> 16), across[k]);
            coverage[k] = mix(of(upper[k]), of(lower[k]), down[k]);
        }
        coverage
    }
}

/// Which quad of a row a place along a side of so many texels lies in, or which row of quads, and how far it is from the first texels' middles to the
/// second ones'. A place that is NaN is 0.
#[inline(always)]
fn nearest(place: f32, side: f32) -> (f32, f32) {
    let texel = least(most(place, 0.0), 1.0) * side - 0.5;
    let before = texel.floor();
    (before + 1.0, texel - before)
}

impl<const N: usize> Blurred<'_, N> {
    /// The coverage at each place, 0 to 1 from left to right and from top to bottom.
    #[inline(always)]
    pub(super) fn at(&self, places: [&[f32; N]; 2]) -> [f32; N] {
        let mut coverage = self.mark.between(&self.finer, places);
        if let Some((coarser, share)) = &self.coarser {
            let other = self.mark.between(coarser, places);
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

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// A picture of other numbers at every texel, whose sides are no powers of 2.
    fn picture() -> Image {
        let coverage: Vec<f32> = (0..37 * 21).map(|i| (i * 29 % 97) as f32 / 96.0).collect();
        Image::of_coverage([37, 21], &coverage).unwrap()
    }

    proptest! {
        /// Texels in fours are what the picture shows where it is looked up texel by texel.
        #[test]
        fn marks_are_the_coverage_of_their_picture(
            x in -0.2..1.2_f32,
            y in 0.5_f32..20.5,
            texels in 1.0..60.0_f32,
            repeats: bool,
        ) {
            let mark = Mark::new(picture(), repeats);
            // Pictures that repeat do so across the stroke, too: no nearer to its edges than the middle of the coarsest texel.
            let y = if repeats { 0.5 } else { y / 21.0 };
            let [own] = mark.blurred(&[texels]).at([&[x], &[y]]);
            let [.., expected] = mark.image.at([x, y], texels / 37.0, repeats);
            prop_assert!((own - expected).abs() < 1e-6, "{own}, {expected}");
        }
    }
}
