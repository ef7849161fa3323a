//! What the samples of a picture tell: for each feature a plane of numbers.

use crate::cpu::STACK;
use crate::edges::Covered;
use crate::features::{Feature, Features, NO_ID};
use glam::Vec3;
use rayon::prelude::*;
use std::ops::Range;

/// Up to eight samples of each pixel of a picture, with the features that are declared.
///
/// Sample k of all pixels is a picture of its own, shifted by less than a pixel: neighbours are a pixel away. Planes are kept row by
/// row, in bands of rows that are drawn beside each other.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SamplePlanes {
    pub(crate) size: [u32; 2],
    pub(crate) layout: Layout,
    /// The number of the first sample, and how many there are.
    pub(crate) first: usize,
    pub(crate) count: usize,
    /// Rows of a band.
    pub(crate) band: usize,
    /// Band after band; in each sample after sample, in that plane after plane, in that row after row.
    pub(crate) ids: Vec<u32>,
    pub(crate) numbers: Vec<f32>,
}

/// One sample. What isn't declared is as where nothing is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// [`Feature::Object`].
    pub object: u32,
    /// [`Feature::Strand`].
    pub strand: u32,
    /// [`Feature::Piece`].
    pub piece: u32,
    /// [`Feature::Layer`].
    pub layer: u32,
    /// [`Feature::Level`].
    pub level: u32,
    /// [`Feature::InvDepth`], 1/m.
    pub inv_depth: f32,
    /// [`Feature::U`].
    pub u: f32,
    /// [`Feature::S`], head heights.
    pub s: f32,
    /// [`Feature::V`].
    pub v: f32,
    /// [`Feature::W`].
    pub w: f32,
    /// [`Feature::Pixels`].
    pub pixels: f32,
    /// [`Feature::Normal`].
    pub normal: Vec3,
    /// [`Feature::Color`]: red, green, blue, and whether anything is there.
    pub color: [f32; 4],
}

impl Sample {
    /// What a sample tells that shows nothing.
    pub const NOTHING: Self = Self {
        object: 0,
        strand: NO_ID,
        piece: NO_ID,
        layer: NO_ID,
        level: NO_ID,
        inv_depth: 0.0,
        u: 0.0,
        s: 0.0,
        v: 0.0,
        w: 0.0,
        pixels: 0.0,
        normal: Vec3::ZERO,
        color: [0.0; 4],
    };

    /// An id.
    #[must_use]
    pub fn id(&self, feature: Feature) -> u32 {
        match feature {
            Feature::Object => self.object,
            Feature::Strand => self.strand,
            Feature::Piece => self.piece,
            Feature::Layer => self.layer,
            Feature::Level => self.level,
            _ => NO_ID,
        }
    }

    /// A component of a feature that is no id.
    #[must_use]
    pub fn number(&self, feature: Feature, component: usize) -> f32 {
        match feature {
            Feature::InvDepth => self.inv_depth,
            Feature::U => self.u,
            Feature::S => self.s,
            Feature::V => self.v,
            Feature::W => self.w,
            Feature::Pixels => self.pixels,
            Feature::Normal => self
                .normal
                .to_array()
                .get(component)
                .copied()
                .unwrap_or(0.0),
            Feature::Color => self.color.get(component).copied().unwrap_or(0.0),
            _ => 0.0,
        }
    }
}

/// What is there of every picture: whether anything is shown, and how near.
pub(crate) const ALWAYS: Features = Features::of(&[Feature::Object, Feature::InvDepth]);

/// Where the planes of features are among those of their kind, in a sample's.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Layout {
    pub(crate) declared: Features,
    /// The first one of each feature that is declared, by its number.
    first: [u8; Feature::ALL.len()],
    /// How many there are: of ids, and of numbers.
    pub(crate) planes: [usize; 2],
}

impl Layout {
    /// That of what is declared, and of what is [there always](ALWAYS).
    pub(crate) fn new(declared: Features) -> Self {
        let mut layout = Self {
            declared: declared.union(ALWAYS),
            ..Self::default()
        };
        for feature in layout.declared.iter() {
            let planes = &mut layout.planes[usize::from(!feature.is_id())];
            layout.first[feature as usize] = *planes as u8;
            *planes += feature.components();
        }
        layout
    }

    /// Where a feature's planes begin; none where it isn't declared.
    #[inline(always)] // compiled for the rasteriser's instructions
    pub(crate) fn first(&self, feature: Feature) -> Option<usize> {
        let first = usize::from(self.first[feature as usize]);
        self.declared.has(feature).then_some(first)
    }

    /// How many planes of its kind there are.
    #[inline(always)]
    fn beside(&self, feature: Feature) -> usize {
        self.planes[usize::from(!feature.is_id())]
    }
}

impl SamplePlanes {
    /// Makes room for samples, all of which are then to be put in; `None` where there isn't enough memory.
    /// [`Feature::Object`] and [`Feature::InvDepth`] are always there.
    pub(crate) fn make_room(
        &mut self,
        size: [u32; 2],
        declared: Features,
        [first, count]: [usize; 2],
        band: usize,
    ) -> Option<()> {
        (self.size, self.layout) = (size, Layout::new(declared));
        (self.first, self.count, self.band) = (first, count, band);
        let bands = (size[1] as usize).div_ceil(band);
        let [ids, numbers] = self.of_band().map(|of_band| bands * of_band);
        // What is there already isn't written over twice.
        self.ids.truncate(ids);
        self.ids.try_reserve_exact(ids - self.ids.len()).ok()?;
        self.ids.resize(ids, 0);
        self.numbers.truncate(numbers);
        let more = numbers - self.numbers.len();
        self.numbers.try_reserve_exact(more).ok()?;
        self.numbers.resize(numbers, 0.0);
        Some(())
    }

    /// Begins anew with no samples, in one band, for as many as [`Self::push_sample`] adds; `None` where there isn't enough memory.
    #[cfg(feature = "gpu")]
    pub(crate) fn begin(
        &mut self,
        size: [u32; 2],
        declared: Features,
        [first, count]: [usize; 2],
    ) -> Option<()> {
        (self.size, self.layout) = (size, Layout::new(declared));
        (self.first, self.count, self.band) = (first, count, size[1] as usize);
        let [ids, numbers] = self.of_band();
        self.ids.clear();
        self.ids.try_reserve_exact(ids).ok()?;
        self.numbers.clear();
        self.numbers.try_reserve_exact(numbers).ok()
    }

    /// Words of a sample: plane after plane of ids, then of numbers.
    #[cfg(feature = "gpu")]
    pub(crate) fn words_of_sample(&self) -> usize {
        self.of_band().iter().sum::<usize>() / self.count
    }

    /// Adds the next sample by its words.
    #[cfg(feature = "gpu")]
    pub(crate) fn push_sample(&mut self, words: &[u32]) {
        let [ids, _] = self.of_band().map(|words| words / self.count);
        let (ids, numbers) = words.split_at(ids);
        self.ids.extend_from_slice(ids);
        self.numbers
            .extend(numbers.iter().map(|word| f32::from_bits(*word)));
    }

    /// Ids and numbers of a band.
    pub(crate) fn of_band(&self) -> [usize; 2] {
        let plane = self.size[0] as usize * self.band;
        (self.layout.planes).map(|planes| planes * plane * self.count)
    }

    /// Gives the samples that lines cover a colour.
    pub(crate) fn set_color(&mut self, set: &[Covered], color: [f32; 3]) {
        let [_, planes] = self.layout.planes;
        let Some(first) = self.layout.first(Feature::Color) else {
            return;
        };
        let [red, green, blue] = color;
        let [width, height] = self.size.map(|side| side as usize);
        let (count, band) = (self.count, self.band);
        let [_, of_band] = self.of_band();
        let bands = self.numbers.par_chunks_mut(of_band).enumerate();
        bands.for_each(|(number, numbers)| {
            for (picture, rows) in set.iter().enumerate().take(count) {
                for y in number * band..((number + 1) * band).min(height) {
                    for (component, value) in [red, green, blue, 1.0].into_iter().enumerate() {
                        let plane = picture * planes + first + component;
                        let start = (plane * band + y % band) * width;
                        let row = &mut numbers[start..start + width];
                        for (bits, pixels) in rows.row(y).iter().zip(row.chunks_mut(64)) {
                            let mut left = *bits;
                            while left != 0 {
                                let x = left.trailing_zeros() as usize;
                                if let Some(pixel) = pixels.get_mut(x) {
                                    *pixel = value;
                                }
                                left &= left - 1;
                            }
                        }
                    }
                }
            }
        });
    }

    /// Adds the colours of these samples, of so many, to the pixels of a picture of that size; the first ones in place of what was there.
    /// With the last ones the sums become means.
    pub(crate) fn add_to(&self, pixels: &mut [[f32; 4]], samples: usize) {
        let width = self.size[0] as usize;
        // Colour by colour, and then pixel by pixel: these loops are vector instructions.
        let share = match self.samples().end == samples {
            true => samples as f32,
            false => 1.0,
        };
        let rows = pixels.par_chunks_mut(width).enumerate();
        rows.for_each_init(
            || vec![0.0; 4 * width],
            |sums, (y, pixels)| {
                for (component, sums) in sums.chunks_exact_mut(width).enumerate() {
                    match self.first {
                        0 => sums.fill(0.0),
                        _ => {
                            let before = pixels.iter().map(|pixel| pixel[component]);
                            sums.iter_mut().zip(before).for_each(|(sum, it)| *sum = it);
                        }
                    }
                    for picture in 0..self.count {
                        let row = self.numbers(picture, Feature::Color, component, y);
                        sums.iter_mut().zip(row).for_each(|(sum, it)| *sum += it);
                    }
                }
                let [red, green, blue, alpha] = [0, 1, 2, 3].map(|i| &sums[i * width..][..width]);
                let pixels = &mut pixels[..width];
                for x in 0..width {
                    let sums = [red[x], green[x], blue[x], alpha[x]];
                    pixels[x] = sums.map(|sum| sum / share);
                }
            },
        );
    }

    /// Width and height, pixels.
    #[must_use]
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// What is declared, [`Feature::Object`] and [`Feature::InvDepth`] always.
    #[must_use]
    pub fn declared(&self) -> Features {
        self.layout.declared
    }

    /// The numbers of its samples, as [`sample_positions`](crate::sample_positions) counts them; of a render pass with several as the card does.
    #[must_use]
    pub fn samples(&self) -> Range<usize> {
        self.first..self.first + self.count
    }

    /// Where a row of a plane is.
    fn row(&self, picture: usize, plane: usize, planes: usize, y: usize) -> Range<usize> {
        let width = self.size[0] as usize;
        let band = y / self.band;
        let of_sample = (band * self.count + picture) * planes + plane;
        let start = (of_sample * self.band + y % self.band) * width;
        start..start + width
    }

    /// Row `y` of an id, of the `picture`th of its samples; empty where it isn't declared.
    ///
    /// # Panics
    ///
    /// Where there is no such row or sample.
    #[must_use]
    pub fn ids(&self, picture: usize, feature: Feature, y: usize) -> &[u32] {
        assert!(picture < self.count && y < self.size[1] as usize);
        let planes = self.layout.beside(feature);
        match self.layout.first(feature).filter(|_| feature.is_id()) {
            Some(plane) => &self.ids[self.row(picture, plane, planes, y)],
            None => &[],
        }
    }

    /// Row `y` of a component of a feature that is no id, of the `picture`th of its samples; empty where it isn't declared.
    ///
    /// # Panics
    ///
    /// Where there is no such row, sample or component.
    #[must_use]
    pub fn numbers(&self, picture: usize, feature: Feature, component: usize, y: usize) -> &[f32] {
        assert!(picture < self.count && y < self.size[1] as usize);
        assert!(component < feature.components());
        let planes = self.layout.beside(feature);
        match self.layout.first(feature).filter(|_| !feature.is_id()) {
            Some(plane) => &self.numbers[self.row(picture, plane + component, planes, y)],
            None => &[],
        }
    }

    /// A sample, by its place among those that are kept.
    ///
    /// # Panics
    ///
    /// Where there is no such sample.
    #[must_use]
    pub fn sample(&self, picture: usize, x: usize, y: usize) -> Sample {
        let id = |feature| {
            self.ids(picture, feature, y)
                .get(x)
                .copied()
                .unwrap_or(NO_ID)
        };
        let number = |feature, component| {
            let row = self.numbers(picture, feature, component, y);
            row.get(x).copied().unwrap_or(0.0)
        };
        let of = |feature| number(feature, 0);
        Sample {
            object: id(Feature::Object),
            strand: id(Feature::Strand),
            piece: id(Feature::Piece),
            layer: id(Feature::Layer),
            level: id(Feature::Level),
            inv_depth: of(Feature::InvDepth),
            u: of(Feature::U),
            s: of(Feature::S),
            v: of(Feature::V),
            w: of(Feature::W),
            pixels: of(Feature::Pixels),
            normal: Vec3::from_array([0, 1, 2].map(|i| number(Feature::Normal, i))),
            color: [0, 1, 2, 3].map(|i| number(Feature::Color, i)),
        }
    }
}

/// The samples of a band as they are drawn.
pub(crate) struct BandPlanes<'a> {
    pub(crate) width: usize,
    pub(crate) layout: Layout,
    /// Rows of the band, and samples of each pixel.
    pub(crate) band: usize,
    pub(crate) count: usize,
    pub(crate) ids: &'a mut [u32],
    pub(crate) numbers: &'a mut [f32],
}

/// Stacks of samples beside each other: those of so many columns, from one on; each has `of_pixel` samples of each of so many pixels,
/// one below the other, from a row of the band on, and the first `count` of a pixel's count.
pub(crate) struct Stacks {
    pub(crate) column: usize,
    pub(crate) columns: usize,
    pub(crate) row: usize,
    pub(crate) rows: usize,
    pub(crate) of_pixel: usize,
    pub(crate) count: usize,
}

impl Stacks {
    /// Puts their values into the planes that begin at `plane`, one of so many of each sample, of so many numbers.
    #[inline(always)] // compiled for the rasteriser's instructions
    fn put<T: Copy>(&self, list: &mut [T], width: usize, planes: PlanePlace, values: &[T]) {
        let (values, _) = values.as_chunks::<STACK>();
        let values = &values[..self.columns];
        let start = |picture: usize, below: usize| {
            let plane = (picture * planes.of_sample + planes.number) * planes.length;
            plane + (self.row + below) * width + self.column
        };
        if [self.of_pixel, self.count] == [4; 2] {
            for below in 0..self.rows {
                let rows = [0, 1, 2, 3].map(|picture| {
                    let start = start(picture, below);
                    start..start + self.columns
                });
                if let Ok([a, b, c, d]) = list.get_disjoint_mut(rows) {
                    for i in 0..values.len() {
                        let (pixels, _) = values[i].as_chunks::<4>();
                        [a[i], b[i], c[i], d[i]] = pixels[below];
                    }
                }
            }
            return;
        }
        for below in 0..self.rows {
            for picture in 0..self.count {
                let row = &mut list[start(picture, below)..][..self.columns];
                for i in 0..values.len() {
                    row[i] = values[i][below * self.of_pixel + picture];
                }
            }
        }
    }
}

/// Which plane of a sample: its number, of so many, and how many numbers it has in a band.
#[derive(Clone, Copy)]
struct PlanePlace {
    number: usize,
    of_sample: usize,
    length: usize,
}

impl BandPlanes<'_> {
    #[inline(always)]
    fn place(&self, feature: Feature, component: usize) -> PlanePlace {
        PlanePlace {
            number: self.layout.first(feature).unwrap_or_default() + component,
            of_sample: self.layout.beside(feature),
            length: self.band * self.width,
        }
    }

    /// Puts in a declared id of the samples of some stacks.
    #[inline(always)]
    pub(crate) fn put_ids(&mut self, feature: Feature, stacks: &Stacks, ids: &[u32]) {
        let place = self.place(feature, 0);
        stacks.put(self.ids, self.width, place, ids);
    }

    /// Puts in a component of a declared feature of the samples of some stacks.
    #[inline(always)]
    pub(crate) fn put_numbers(
        &mut self,
        feature: Feature,
        component: usize,
        stacks: &Stacks,
        numbers: &[f32],
    ) {
        let place = self.place(feature, component);
        stacks.put(self.numbers, self.width, place, numbers);
    }

    /// Puts in samples that show nothing but a background, in some columns of so many rows.
    pub(crate) fn clear(
        &mut self,
        columns: Range<usize>,
        rows: usize,
        background: Option<[f32; 3]>,
    ) {
        if columns.is_empty() {
            return;
        }
        let color = background.map_or([0.0; 4], |light| {
            let [red, green, blue] = light.map(|light| light.clamp(0.0, 1.0));
            [red, green, blue, 1.0]
        });
        let nothing = Sample {
            color,
            ..Sample::NOTHING
        };
        let rows = rows.min(self.band);
        for feature in self.layout.declared.iter() {
            for component in 0..feature.components() {
                let place = self.place(feature, component);
                for picture in 0..self.count {
                    let plane = (picture * place.of_sample + place.number) * place.length;
                    let starts = (0..rows).map(|row| plane + row * self.width + columns.start);
                    if feature.is_id() {
                        let id = nothing.id(feature);
                        starts.for_each(|start| self.ids[start..][..columns.len()].fill(id));
                    } else {
                        let number = nothing.number(feature, component);
                        starts
                            .for_each(|start| self.numbers[start..][..columns.len()].fill(number));
                    }
                }
            }
        }
    }
}
