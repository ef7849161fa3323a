//! Pictures as textures: linear light in half precision, with ever smaller copies for what is small on the screen.

use crate::color::linear_from_srgb;
use crate::wgsl;
use half::f16;
use std::hint::black_box;
use std::sync::LazyLock;

/// The texels of a picture, and of copies of half the size each down to one texel. Colours are multiplied by coverage.
#[derive(Clone, Debug, PartialEq)]
pub struct Image {
    levels: Vec<Level>,
}

/// One of the copies.
#[derive(Clone, Debug, PartialEq)]
struct Level {
    size: [usize; 2],
    /// Row by row from the top.
    texels: Vec<[f16; 4]>,
}

/// Why a picture is no texture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum ImageError {
    /// It has no texels, or too many.
    #[error("it is {} x {} texels; a texture has 1 to {MOST_TEXELS} on a side", .0[0], .0[1])]
    Size([usize; 2]),
    /// The list of texels is too long or too short.
    #[error("it has {found} numbers in place of {expected}")]
    Length {
        /// How many there are.
        found: usize,
        /// So many as its texels have.
        expected: usize,
    },
}

/// Texels on a side at most: with its copies such a picture takes 180 MB.
const MOST_TEXELS: usize = 4096;

/// The linear value of each number from 0 to 65535 in sRGB.
static LINEAR: LazyLock<Vec<f32>> = LazyLock::new(|| {
    let values = 0..=u16::MAX;
    values
        .map(|x| linear_from_srgb(f64::from(x) / 65535.0) as f32)
        .collect()
});

impl Image {
    /// Texels on a side at most.
    pub const MOST_TEXELS: usize = MOST_TEXELS;

    /// A picture in sRGB: width and height, and red, green, blue and coverage of each texel, row by row from the top, from 0 to 65535
    /// (eight bits times 257).
    ///
    /// # Errors
    ///
    /// When it has no texels or too many, or the list isn't four numbers each.
    pub fn from_srgb(size: [usize; 2], rgba: &[u16]) -> Result<Self, ImageError> {
        check_length(size, rgba.len(), 4)?;
        let texel = |rgba: &[u16]| {
            let alpha = f32::from(rgba[3]) / 65535.0;
            let color = |i: usize| LINEAR[usize::from(rgba[i])] * alpha;
            [color(0), color(1), color(2), alpha]
        };
        let whole = rgba.chunks_exact(4).map(texel).collect();
        Ok(Self::with_copies(size, whole))
    }

    /// White that covers so much of each texel, 0 to 1, row by row from the top.
    ///
    /// # Errors
    ///
    /// When it has no texels or too many, or the list isn't one number each.
    pub fn of_coverage(size: [usize; 2], coverage: &[f32]) -> Result<Self, ImageError> {
        check_length(size, coverage.len(), 1)?;
        let texel = |coverage: &f32| [coverage.clamp(0.0, 1.0); 4];
        Ok(Self::with_copies(
            size,
            coverage.iter().map(texel).collect(),
        ))
    }

    /// These texels, whose colours are multiplied by coverage, and the smaller copies.
    fn with_copies(mut size: [usize; 2], mut whole: Vec<[f32; 4]>) -> Self {
        let mut levels = vec![Level::of(size, &whole)];
        while size != [1, 1] {
            let half = size.map(|side| (side / 2).max(1));
            whole = smaller(&whole, size, half);
            size = half;
            levels.push(Level::of(size, &whole));
        }
        Self { levels }
    }

    /// The same without its smaller copies: however small it is on the screen, each place has its own texels.
    #[must_use]
    pub fn without_copies(mut self) -> Self {
        self.levels.truncate(1);
        self
    }

    /// Width and height in texels.
    #[must_use]
    pub fn size(&self) -> [usize; 2] {
        self.levels[0].size
    }

    /// How many copies there are, with the whole, the largest first.
    #[must_use]
    pub fn levels(&self) -> usize {
        self.levels.len()
    }

    /// Width, height and texels of a copy, row by row from the top: red, green and blue, linear and multiplied by coverage, and
    /// coverage, in half precision.
    ///
    /// # Panics
    ///
    /// When there is no such copy.
    #[must_use]
    pub fn level(&self, level: usize) -> ([usize; 2], &[[f16; 4]]) {
        let level = &self.levels[level];
        (level.size, &level.texels)
    }

    /// The texel at a place, 0 to 1 from left to right and from top to bottom, blurred over `size` of the width: between the four
    /// nearest of the two copies nearest in size. Colour, and coverage.
    #[inline(always)] // into loops that are compiled for other instructions than their crate
    #[must_use]
    pub fn at(&self, place: [f32; 2], size: f32, repeats: bool) -> [f32; 4] {
        self.blurred(size).at(place, repeats)
    }

    /// [`Self::at`] of several places, blurred over a size each: all but the texels by loops that compile to vector instructions.
    #[inline(always)] // into loops that are compiled for other instructions than their crate
    pub(crate) fn at_all<const N: usize>(
        &self,
        [x, y]: [&[f32; N]; 2],
        size: &[f32; N],
        repeats: bool,
    ) -> [[f32; 4]; N] {
        let last = (self.levels.len() - 1) as f32;
        let whole_width = self.size()[0] as f32;
        let (mut finer, mut share) = ([0; N], [0.0; N]);
        let mut is_mixed = false;
        for k in 0..N {
            let texels = most(size[k], 0.0) * whole_width;
            let level = least(wgsl::log_to_two(most(texels, 1.0)), last);
            let whole = level.floor();
            finer[k] = index(whole);
            share[k] = level - whole;
            is_mixed |= share[k] > 0.0;
        }
        let mut texels = self.between_all(&finer, [x, y], repeats);
        if is_mixed {
            let mut coarser = finer;
            for k in 0..N {
                // Where nothing comes of it that one again, which is there.
                coarser[k] += u32::from(share[k] > 0.0);
            }
            let others = self.between_all(&coarser, [x, y], repeats);
            for (k, (texel, other)) in texels.iter_mut().zip(others).enumerate() {
                for channel in 0..4 {
                    texel[channel] += (other[channel] - texel[channel]) * share[k];
                }
            }
        }
        for texel in &mut texels {
            *texel = straight(*texel);
        }
        texels
    }

    /// Each place between the four nearest texels of one of the copies.
    #[inline(always)]
    fn between_all<const N: usize>(
        &self,
        levels: &[u32; N],
        [x, y]: [&[f32; N]; 2],
        repeats: bool,
    ) -> [[f32; 4]; N] {
        let mut sides = [[0.0; N]; 2];
        for k in 0..N {
            let [width, height] = self.levels[levels[k] as usize].size;
            (sides[0][k], sides[1][k]) = (width as f32, height as f32);
        }
        let (mut first, mut second, mut shares) = ([[0; N]; 2], [[0; N]; 2], [[0.0; N]; 2]);
        for (axis, places) in [x, y].into_iter().enumerate() {
            for k in 0..N {
                let [before, after, part] = nearest(places[k], sides[axis][k], repeats);
                shares[axis][k] = part;
                (first[axis][k], second[axis][k]) = (index(before), index(after));
            }
        }
        for k in 0..N {
            let width = index(sides[0][k]);
            first[1][k] = first[1][k].wrapping_mul(width);
            second[1][k] = second[1][k].wrapping_mul(width);
        }
        // By way of memory: compilers would work out some by themselves where they are needed, in place of all at once.
        let (first, second, shares) = black_box((first, second, shares));
        let mut texels = [[0.0; 4]; N];
        for (k, texel) in texels.iter_mut().enumerate() {
            let [across, down] = [0, 1].map(|axis| [first[axis][k], second[axis][k]]);
            let level = &self.levels[levels[k] as usize];
            *texel = level.between(across, down, [shares[0][k], shares[1][k]]);
        }
        texels
    }

    /// The picture blurred over `size` of its width, for many places.
    #[inline(always)] // into loops that are compiled for other instructions than their crate
    #[must_use]
    pub fn blurred(&self, size: f32) -> Blurred<'_> {
        let last = (self.levels.len() - 1) as f32;
        let texels = size.max(0.0) * self.size()[0] as f32;
        // No size, or one that is no number, is the whole's.
        let level = if texels > 1.0 {
            wgsl::log_to_two(texels).min(last)
        } else {
            0.0
        };
        let finer = level as usize;
        let share = level - finer as f32;
        let coarser = (share > 0.0).then(|| (&self.levels[finer + 1], share));
        let finer = &self.levels[finer];
        let [width, height] = finer.size;
        let [half_width, half_height] = coarser.map_or(finer.size, |(level, _)| level.size);
        Blurred {
            finer,
            coarser,
            sides: [width, half_width, height, half_height].map(|side| side as f32),
            strides: [1, 1, width as u32, half_width as u32],
        }
    }
}

/// That a picture has texels, not too many, and so many numbers of each.
fn check_length(size: [usize; 2], found: usize, of_texel: usize) -> Result<(), ImageError> {
    if !size.iter().all(|side| (1..=MOST_TEXELS).contains(side)) {
        return Err(ImageError::Size(size));
    }
    let expected = of_texel * size[0] * size[1];
    match found == expected {
        true => Ok(()),
        false => Err(ImageError::Length { found, expected }),
    }
}

/// The two copies of a picture nearest in size to what a pixel covers.
#[derive(Clone, Copy, Debug)]
pub struct Blurred<'a> {
    finer: &'a Level,
    /// What comes of the smaller one.
    coarser: Option<(&'a Level, f32)>,
    /// Widths of both, then heights; twice the finer one's where there is no other.
    sides: [f32; NUMBERS],
    /// Texels from one number to the next: 1 across, a row down.
    strides: [u32; NUMBERS],
}

/// Numbers of a place: how far across both copies it is, then how far down.
const NUMBERS: usize = 4;

impl Blurred<'_> {
    /// The texel at a place, 0 to 1 from left to right and from top to bottom: colour, and coverage.
    #[inline(always)] // into loops that are compiled for other instructions than their crate
    #[must_use]
    pub fn at(&self, [x, y]: [f32; 2], repeats: bool) -> [f32; 4] {
        // All four at once.
        let places = [x, x, y, y];
        let mut share = [0.0; NUMBERS];
        let (mut first, mut second) = ([0; NUMBERS], [0; NUMBERS]);
        for k in 0..NUMBERS {
            let [before, after, part] = nearest(places[k], self.sides[k], repeats);
            share[k] = part;
            first[k] = index(before).wrapping_mul(self.strides[k]);
            second[k] = index(after).wrapping_mul(self.strides[k]);
        }
        // By way of memory: compilers would work out some by themselves where they are needed, in place of all at once.
        let (share, first, second) = black_box((share, first, second));
        let [left, half_left, upper, half_upper] = first;
        let [right, half_right, lower, half_lower] = second;
        let mut texel = (self.finer).between([left, right], [upper, lower], [share[0], share[2]]);
        if let Some((coarser, part)) = self.coarser {
            let (across, down) = ([half_left, half_right], [half_upper, half_lower]);
            let other = coarser.between(across, down, [share[1], share[3]]);
            for channel in 0..4 {
                texel[channel] += (other[channel] - texel[channel]) * part;
            }
        }
        straight(texel)
    }
}

/// Colour and coverage of a texel whose colour is multiplied by its coverage.
#[inline(always)]
fn straight(texel: [f32; 4]) -> [f32; 4] {
    let alpha = texel[3];
    if alpha <= 0.0 {
        return [0.0; 4];
    }
    // All four, or they would be worked out as two and one.
    let mut color = [0.0; 4];
    for channel in 0..4 {
        color[channel] = texel[channel] / alpha;
    }
    let [red, green, blue, _] = color;
    [red, green, blue, alpha]
}

/// The one or the other, both worked out: a branch would keep a loop from compiling to vector instructions.
#[inline(always)]
pub(crate) fn choose(condition: bool, then: f32, otherwise: f32) -> f32 {
    std::hint::select_unpredictable(condition, then, otherwise)
}

/// The lesser of two numbers.
#[inline(always)]
pub(crate) fn least(a: f32, b: f32) -> f32 {
    choose(a < b, a, b)
}

/// The greater of two numbers.
#[inline(always)]
pub(crate) fn most(a: f32, b: f32) -> f32 {
    choose(a > b, a, b)
}

/// A whole number from 0 to some millions. By the sum with a number whose last bit is 1, as a cast is no vector instruction.
#[inline(always)]
pub(crate) fn index(whole: f32) -> u32 {
    const WHOLE: f32 = 8_388_608.0;
    (whole + WHOLE).to_bits() - WHOLE.to_bits()
}

impl Level {
    fn of(size: [usize; 2], texels: &[[f32; 4]]) -> Self {
        let texels = texels.iter().map(|texel| texel.map(f16::from_f32));
        Self {
            size,
            texels: texels.collect(),
        }
    }

    /// Between the middles of the four nearest texels: of two columns, and the numbers of the first texels of two rows. And the shares of the
    /// second ones.
    #[inline(always)]
    fn between(&self, across: [u32; 2], down: [u32; 2], [share, below]: [f32; 2]) -> [f32; 4] {
        let [left, right] = across;
        let [upper, lower] = down;
        let [a, b, c, d] = [
            numbers(&self.texels[(upper + left) as usize]),
            numbers(&self.texels[(upper + right) as usize]),
            numbers(&self.texels[(lower + left) as usize]),
            numbers(&self.texels[(lower + right) as usize]),
        ];
        let mut texel = [0.0; 4];
        for i in 0..4 {
            let (upper, lower) = (a[i] + (b[i] - a[i]) * share, c[i] + (d[i] - c[i]) * share);
            texel[i] = upper + (lower - upper) * below;
        }
        texel
    }
}

/// The number that the half of these bits is, exactly, as a texel has it: none is below 0, above 1 or NaN, so that a shift and a product do.
#[inline(always)]
pub(crate) fn of_half(bits: u32) -> f32 {
    const SCALE: f32 = f32::from_bits((127 + 112) << 23);
    f32::from_bits(bits << 13) * SCALE
}

/// Those of a texel.
#[inline(always)]
fn numbers(halves: &[f16; 4]) -> [f32; 4] {
    let mut numbers = [0.0; 4];
    for i in 0..4 {
        numbers[i] = of_half(u32::from(halves[i].to_bits()));
    }
    numbers
}

/// The two texels nearest to a place along a side, and how far it is from the first's middle to the second's. A place that is no number is 0.
#[inline(always)]
fn nearest(place: f32, side: f32, repeats: bool) -> [f32; 3] {
    let place = choose(repeats, place - place.floor(), place);
    let texel = least(most(place, 0.0), 1.0) * side - 0.5;
    let (before, last) = (texel.floor(), side - 1.0);
    let first = choose(before < 0.0, choose(repeats, last, 0.0), before);
    let second = choose(
        before + 1.0 > last,
        choose(repeats, 0.0, last),
        before + 1.0,
    );
    [first, second, texel - before]
}

/// A copy of another size: each texel is the mean of what it covers.
fn smaller(texels: &[[f32; 4]], from: [usize; 2], to: [usize; 2]) -> Vec<[f32; 4]> {
    let columns = shares(from[0], to[0]);
    let rows = shares(from[1], to[1]);
    let mut narrow = Vec::with_capacity(to[0] * from[1]);
    for row in texels.chunks_exact(from[0]) {
        narrow.extend(columns.iter().map(|share| mean(share, |x| row[x])));
    }
    let of_row = |row: &Vec<(usize, f32)>| -> Vec<[f32; 4]> {
        (0..to[0])
            .map(|x| mean(row, |y| narrow[y * to[0] + x]))
            .collect()
    };
    rows.iter().flat_map(of_row).collect()
}

/// Of each texel of a side the texels of the longer one that it covers, with their shares, whose sum is 1.
fn shares(from: usize, to: usize) -> Vec<Vec<(usize, f32)>> {
    let length = from as f64 / to as f64;
    let covered = |i: usize| {
        let (start, end) = (i as f64 * length, (i + 1) as f64 * length);
        let share = |x: usize| {
            let part = end.min((x + 1) as f64) - start.max(x as f64);
            (x, (part / length) as f32)
        };
        let last = (end.ceil() as usize).min(from);
        (start as usize..last)
            .map(share)
            .filter(|(_, share)| *share > 0.0)
            .collect()
    };
    (0..to).map(covered).collect()
}

fn mean(shares: &[(usize, f32)], texel: impl Fn(usize) -> [f32; 4]) -> [f32; 4] {
    let mut sum = [0.0; 4];
    for &(index, share) in shares {
        let texel = texel(index);
        for (sum, x) in sum.iter_mut().zip(texel) {
            *sum += share * x;
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn halves_are_the_numbers_that_they_are() {
        for bits in 0..=f16::ONE.to_bits() {
            let half = f16::from_bits(bits);
            assert_eq!(
                of_half(u32::from(bits)).to_bits(),
                half.to_f32().to_bits(),
                "{bits}"
            );
        }
    }

    const WHITE: [u16; 4] = [65535; 4];
    const BLACK: [u16; 4] = [0, 0, 0, 65535];

    fn image(size: [usize; 2], texels: &[[u16; 4]]) -> Image {
        Image::from_srgb(size, texels.as_flattened()).unwrap()
    }

    #[test]
    fn between_the_middles_of_texels_colour_is_linear() {
        let two = image([2, 1], &[BLACK, WHITE]);
        for (x, light) in [
            (0.0, 0.0),
            (0.25, 0.0),
            (0.5, 0.5),
            (0.625, 0.75),
            (0.75, 1.0),
            (1.0, 1.0),
            (7.0, 1.0),
        ] {
            assert_eq!(
                two.at([x, 0.5], 0.0, false),
                [light, light, light, 1.0],
                "{x}"
            );
        }
        // At the edge of what repeats it is between the last and the first.
        assert_eq!(two.at([1.0, 0.5], 0.0, true), [0.5, 0.5, 0.5, 1.0]);
        assert_eq!(
            two.at([-3.25, 0.5], 0.0, true),
            two.at([0.75, 0.5], 0.0, true)
        );
    }

    #[test]
    fn what_is_not_there_colours_nothing() {
        let two = image([2, 1], &[[0; 4], WHITE]);
        assert_eq!(two.at([0.5, 0.5], 0.0, false), [1.0, 1.0, 1.0, 0.5]);
        assert_eq!(two.at([0.0, 0.5], 0.0, false), [0.0; 4]);
    }

    #[test]
    fn what_is_small_is_blurred() {
        let stripes: Vec<_> = (0..64)
            .map(|x| if x % 2 == 0 { BLACK } else { WHITE })
            .collect();
        let stripes = image([64, 1], &stripes);
        assert_eq!(stripes.levels(), 7);
        for size in [2.0 / 64.0, 0.5, 1.0, 100.0] {
            let [light, .., alpha] = stripes.at([0.3, 0.5], size, true);
            assert!(
                (light - 0.5).abs() < 1e-3 && alpha == 1.0,
                "{size}: {light}"
            );
        }
        for size in [f32::NAN, f32::INFINITY, -1.0] {
            assert!(
                stripes
                    .at([0.3, 0.5], size, true)
                    .iter()
                    .all(|x| x.is_finite())
            );
        }
    }

    #[test]
    fn without_copies_nothing_is_blurred() {
        let texels = [[0, 0, 0, 65535], [65535; 4]].repeat(8);
        let image = image([4, 4], &texels);
        let at = |image: &Image, size: f32| image.at([0.375, 0.5], size, false);
        assert_ne!(at(&image, 1.0), at(&image, 0.0));
        let sharp = image.clone().without_copies();
        assert_eq!((sharp.levels(), sharp.size()), (1, [4, 4]));
        for size in [0.0, 0.3, 1.0, 100.0] {
            assert_eq!(at(&sharp, size), at(&image, 0.0));
        }
    }

    #[test]
    fn sizes_are_limited() {
        let error = |size, length| Image::from_srgb(size, &vec![0; length]).unwrap_err();
        for size in [[0, 1], [1, 0], [30_000, 1]] {
            assert_eq!(error(size, 0), ImageError::Size(size));
        }
        assert!(error([30_000, 1], 0).to_string().contains("1 to 4096"));
        assert_eq!(
            error([2, 1], 4),
            ImageError::Length {
                found: 4,
                expected: 8
            }
        );
    }

    proptest! {
        #[test]
        fn copies_keep_the_mean(width in 1_usize..12, height in 1_usize..12, seed: u64) {
            let count = width * height;
            let texels: Vec<[f32; 4]> = (0..count).map(|i| {
                let hash = seed.wrapping_mul(i as u64 + 1).wrapping_mul(0x9E37_79B9_7F4A_7C15);
                [(hash >> 40) as f32 / 16_777_216.0; 4]
            }).collect();
            let to = [(width / 2).max(1), (height / 2).max(1)];
            let mean = |texels: &[[f32; 4]]| texels.iter().map(|t| t[0]).sum::<f32>() / texels.len() as f32;
            let copy = smaller(&texels, [width, height], to);
            prop_assert_eq!(copy.len(), to[0] * to[1]);
            prop_assert!((mean(&copy) - mean(&texels)).abs() < 1e-5);
        }

        #[test]
        fn any_place_has_a_texel(x: f32, y: f32, size: f32, repeats: bool) {
            let image = image([3, 2], &[WHITE, BLACK, WHITE, BLACK, [0; 4], WHITE]);
            let place = [x, y].map(|x| if x.is_finite() { x } else { 0.0 });
            let texel = image.at(place, size, repeats);
            prop_assert!(texel.iter().all(|x| (0.0..=1.0001).contains(x)), "{:?}", texel);
        }

        #[test]
        fn four_numbers_at_once_are_each_by_itself(
            place in prop::array::uniform2(prop_oneof![
                -1e4..1e4_f32,
                -1.5..1.5_f32,
                prop::sample::select(vec![-1.0, -1e-9, 0.0, 1e-9, 0.5, 1.0, 1.0 - f32::EPSILON / 2.0]),
            ]),
            size in prop_oneof![Just(0.0_f32), 0.0..1.5_f32],
            repeats: bool,
        ) {
            let texels: Vec<[u16; 4]> = (0..35).map(|i| [i * 1800, 60_000 - i * 900, i % 7 * 9000, i % 3 * 32_000]).collect();
            let image = image([7, 5], &texels);
            let blurred = image.blurred(size);
            let of_level = |level: &Level| {
                let [across, down] = [0, 1].map(|i| one_by_one(place[i], level.size[i], repeats));
                let row = |y: usize| {
                    let texel = |x: usize| level.texels[y * level.size[0] + x].map(f32::from);
                    mix(texel(across.0), texel(across.1), across.2)
                };
                mix(row(down.0), row(down.1), down.2)
            };
            let mut texel = of_level(blurred.finer);
            if let Some((coarser, share)) = blurred.coarser {
                texel = mix(texel, of_level(coarser), share);
            }
            let [red, green, blue, alpha] = texel;
            let expected = match alpha > 0.0 {
                true => [red / alpha, green / alpha, blue / alpha, alpha],
                false => [0.0; 4],
            };
            prop_assert_eq!(blurred.at(place, repeats), expected);
        }

        /// Several places are each by itself, to the last bit, whichever copies they are of.
        #[test]
        fn places_of_a_block_are_each_by_itself(
            x in prop::array::uniform16(-1.5..1.5_f32),
            y in prop::array::uniform16(prop_oneof![-1e4..1e4_f32, -0.1..1.1_f32]),
            size in prop::array::uniform16(prop_oneof![Just(0.0_f32), -1.0..2.0_f32, Just(f32::NAN)]),
            repeats: bool,
        ) {
            let texels: Vec<[u16; 4]> = (0..35).map(|i| [i * 1800, 60_000 - i * 900, i % 7 * 9000, i % 3 * 32_000]).collect();
            let image = image([7, 5], &texels);
            let found = image.at_all([&x, &y], &size, repeats);
            for k in 0..16 {
                prop_assert_eq!(found[k], image.at([x[k], y[k]], size[k], repeats));
            }
        }
    }

    /// As [`nearest`] has them, by whole numbers.
    fn one_by_one(place: f32, side: usize, repeats: bool) -> (usize, usize, f32) {
        let place = if repeats {
            place - place.floor()
        } else {
            place.clamp(0.0, 1.0)
        };
        let texel = place * side as f32 - 0.5;
        let first = texel.floor();
        let share = texel - first;
        let last = side as i32 - 1;
        let index = |i: i32| match i {
            _ if (0..=last).contains(&i) => i as usize,
            _ if repeats => i.rem_euclid(side as i32) as usize,
            _ => i.clamp(0, last) as usize,
        };
        (index(first as i32), index(first as i32 + 1), share)
    }

    fn mix(from: [f32; 4], to: [f32; 4], share: f32) -> [f32; 4] {
        std::array::from_fn(|i| from[i] + (to[i] - from[i]) * share)
    }

    #[test]
    fn what_is_no_number_has_a_texel() {
        let image = image([2, 1], &[BLACK, WHITE]);
        for place in [[f32::NAN, 0.5], [f32::INFINITY, f32::NEG_INFINITY]] {
            for repeats in [false, true] {
                let texel = image.at(place, 0.0, repeats);
                assert!(texel.iter().all(|x| (0.0..=1.0).contains(x)), "{texel:?}");
            }
        }
    }
}
