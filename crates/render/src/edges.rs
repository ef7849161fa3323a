//! `edges`: lines where neighbouring samples show something else, as image filters draw them, at any width.
//!
//! Each sample of all pixels is a picture of its own, whose neighbours are a pixel away: lines found in each, and the mean of all, are
//! smooth. Lines lie on what is in front. They are grown by discs, whose rows are bits of words of 64 pixels, so that wide lines take
//! hardly longer than thin ones.

pub(crate) mod find;

use crate::cpu::instructions::Instructions;
use crate::features::{Feature, Features};
use crate::planes::SamplePlanes;
use effects::wgsl::random_signed;
use effects::{Variation, strand_seed};
use find::{Around, Rows, SOME, Scratch, marked};
use portable_math::sin_cos_degrees_f32;
use rayon::prelude::*;
use std::ops::Range;

/// What lines are drawn between.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EdgeChannel {
    /// The clump's levels.
    Level,
    /// Strands, and hair and what else there is.
    Strand,
    /// Hair, heads, clothes, ornaments and the background.
    Object,
    /// Normals: where a Sobel filter of them exceeds [`Edges::threshold`].
    Normal,
    /// Depths: where what lies behind is more than [`Edges::step_m`] farther.
    Depth,
    /// Colours: where a Sobel filter of linear light exceeds [`Edges::threshold`].
    Color,
}

/// Lines where neighbouring samples show something else.
#[derive(Clone, Debug, PartialEq)]
pub struct Edges {
    /// What they are drawn between.
    pub channel: EdgeChannel,
    /// Of normals and colours, by Sobel's kernels (1 2 1): the root of the sum of the squares of all differences.
    pub threshold: f32,
    /// Of depths, metres.
    pub step_m: f32,
    /// Width in pixels along the strand that a line is on, each 0 or more; below 1 some samples have no line. What is no hair has the
    /// curve's largest.
    pub width_px: Variation,
    /// Seed of the widths that vary from strand to strand.
    pub seed: u32,
    /// Place along the strand, 0 root to 1 tip, up to which lines of hair grow to their width, by (1 - cos(t pi)) / 2; 0 has all full.
    pub fade_to: f32,
    /// Linear colour.
    pub color: [f32; 3],
}

/// Widest radius that lines are grown by, pixels.
const LARGEST: f32 = 1024.0;
/// Steps of a radius in a pixel.
const STEPS: f32 = 4.0;

/// The pixels of one sample that lines cover, 64 of a row in a word.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Covered {
    /// Of a row.
    words: usize,
    bits: Vec<u64>,
}

impl Covered {
    fn none([width, height]: [u32; 2]) -> Self {
        let words = width.div_ceil(64) as usize;
        Self {
            words,
            bits: vec![0; words * height as usize],
        }
    }

    /// The words of a row.
    pub(crate) fn row(&self, y: usize) -> &[u64] {
        &self.bits[y * self.words..][..self.words]
    }

    fn row_mut(&mut self, y: usize) -> Option<&mut [u64]> {
        let start = y * self.words;
        self.bits.get_mut(start..start + self.words)
    }
}

/// Where lines begin in some rows of some samples, and how far they reach.
#[derive(Default)]
pub(crate) struct Beginnings {
    rows: Vec<BeginningsOfRow>,
    all: Vec<Beginning>,
}

/// One row of one sample.
struct BeginningsOfRow {
    sample: usize,
    y: usize,
    of_all: Range<usize>,
}

#[derive(Clone, Copy)]
pub(crate) struct Beginning {
    column: u16,
    /// Radius that the line is grown by, in [`STEPS`].
    class: u16,
}

const _: () = assert!(crate::cpu::MAX_SIZE <= u16::MAX as u32 && LARGEST * STEPS <= 65_535.0);

impl Beginnings {
    /// Adds a row of a sample, of the picture's samples that are drawn at once.
    pub(crate) fn push(&mut self, sample: usize, y: usize, row: &[Beginning]) {
        if !row.is_empty() {
            let start = self.all.len();
            self.all.extend_from_slice(row);
            self.rows.push(BeginningsOfRow {
                sample,
                y,
                of_all: start..self.all.len(),
            });
        }
    }
}

/// What one sample shows where a line may begin.
#[derive(Clone, Copy)]
pub(crate) struct Place {
    pub(crate) object: u32,
    /// Of hair: its place along the strand and the strand, where [`Edges::features`] have them, else 0.
    pub(crate) u: f32,
    pub(crate) strand: u32,
    /// The sample's place among all, 0 to 1.
    pub(crate) share: f32,
}

/// A sample's [share](Place::share), by its number. A little less than the middle, so that half a pixel is none where there is one sample.
pub(crate) fn share(sample: usize, samples: usize) -> f32 {
    (sample as f32 + 0.499) / samples as f32
}

impl Edges {
    /// What samples must tell for it.
    #[must_use]
    pub fn features(&self) -> Features {
        let own = match self.channel {
            EdgeChannel::Level => Feature::Level,
            EdgeChannel::Strand => Feature::Strand,
            EdgeChannel::Object => Feature::Object,
            EdgeChannel::Normal => Feature::Normal,
            EdgeChannel::Depth => Feature::InvDepth,
            EdgeChannel::Color => Feature::Color,
        };
        let mut all = Features::of(&[own, Feature::Object, Feature::InvDepth, Feature::Color]);
        if self.fade_to > 0.0 || self.width_px.curve.len() > 1 {
            all = all.union(Features::of(&[Feature::U]));
        }
        if self.width_px.vary > 0.0 {
            all = all.union(Features::of(&[Feature::Strand]));
        }
        all
    }

    /// How far a line reaches from the pixel where it begins, in pixels.
    #[cfg(feature = "gpu")]
    pub(crate) fn reach_px(&self) -> u32 {
        let widest = self.widest() * (1.0 + self.width_px.vary.abs());
        (0.5 * (widest - 1.0).max(0.0) + 1.0).min(LARGEST) as u32
    }

    /// The ids that lines are found between, if it is ids.
    pub(crate) fn ids(&self) -> Option<Feature> {
        match self.channel {
            EdgeChannel::Level => Some(Feature::Level),
            EdgeChannel::Strand => Some(Feature::Strand),
            EdgeChannel::Object => Some(Feature::Object),
            EdgeChannel::Normal | EdgeChannel::Depth | EdgeChannel::Color => None,
        }
    }

    /// What lines are found in by a filter of its components, if it is that.
    pub(crate) fn filtered(&self) -> Option<Feature> {
        match self.channel {
            EdgeChannel::Normal => Some(Feature::Normal),
            EdgeChannel::Color => Some(Feature::Color),
            _ => None,
        }
    }

    /// Marks where lines begin in a row of samples, of which `STEP` lie between one and its neighbour; `SAME` as of [`find::ids`].
    #[inline(always)] // compiled for the best instructions
    pub(crate) fn mark<const STEP: usize, const SAME: bool>(
        &self,
        around: &Around,
        scratch: &mut Scratch,
        marks: &mut [u32],
    ) {
        match self.channel {
            EdgeChannel::Level | EdgeChannel::Strand => {
                find::ids::<STEP, SAME>(around, true, scratch, marks);
            }
            EdgeChannel::Object => find::ids::<STEP, SAME>(around, false, scratch, marks),
            EdgeChannel::Depth => find::steps::<STEP>(around, self.step_m, scratch, marks),
            EdgeChannel::Normal | EdgeChannel::Color => {
                find::sobel::<STEP>(around, self.threshold * self.threshold, marks);
            }
        }
    }

    /// The line that begins at a mark; none where the sample has none.
    pub(crate) fn beginning(&self, column: usize, place: &Place) -> Option<Beginning> {
        let width = match place.object % 2 == 1 {
            true => self.width_of_hair(place.u, place.strand),
            false => self.widest(),
        };
        let class = class(width, place.share)?;
        Some(Beginning {
            column: column as u16,
            class,
        })
    }

    /// Draws the lines into samples of a picture that has so many a pixel.
    pub(crate) fn draw(&self, planes: &mut SamplePlanes, samples: usize) {
        let found = (0..planes.samples().len()).into_par_iter().map(|picture| {
            let mut found = Beginnings::default();
            self.find(planes, picture, samples, &mut found);
            covered([&found], 0, planes.size())
        });
        let found: Vec<Covered> = found.collect();
        planes.set_color(&found, self.color);
    }

    /// Finds where lines begin in one of the samples of a picture that has so many a pixel.
    fn find(&self, planes: &SamplePlanes, picture: usize, samples: usize, found: &mut Beginnings) {
        let [width, height] = planes.size().map(|side| side as usize);
        let share = share(planes.samples().start + picture, samples);
        let instructions = Instructions::best();
        let mut wide = WideRows::default();
        let (mut scratch, mut row) = (Scratch::default(), Vec::new());
        let mut marks = vec![0; width.next_multiple_of(SOME)];
        for y in 0..height {
            let around = wide.around(self, planes, picture, y);
            instructions.run(
                #[inline(always)]
                || self.mark::<1, false>(&around, &mut scratch, &mut marks),
            );
            let objects = planes.ids(picture, Feature::Object, y);
            // Empty where no width needs them.
            let along = planes.numbers(picture, Feature::U, 0, y);
            let strands = planes.ids(picture, Feature::Strand, y);
            row.clear();
            row.extend(marked(&marks).take_while(|x| *x < width).filter_map(|x| {
                let place = Place {
                    object: objects[x],
                    u: along.get(x).copied().unwrap_or_default(),
                    strand: strands.get(x).copied().unwrap_or_default(),
                    share,
                };
                self.beginning(x, &place)
            }));
            found.push(0, y, &row);
        }
    }

    /// The width of a line on hair, pixels.
    fn width_of_hair(&self, u: f32, strand: u32) -> f32 {
        let mut width = self.width_px.at(u);
        if self.width_px.vary > 0.0 {
            let random = random_signed(strand_seed(self.seed, strand), 0);
            width *= 1.0 + self.width_px.vary * random;
        }
        if u < self.fade_to {
            let t = (u / self.fade_to).clamp(0.0, 1.0);
            let (_, cos) = sin_cos_degrees_f32(180.0 * t);
            width *= 0.5 * (1.0 - cos);
        }
        width
    }

    /// The width of lines on what is no hair, pixels.
    pub(crate) fn widest(&self) -> f32 {
        let widths = self.width_px.curve.iter().map(|(_, width)| *width);
        widths.fold(0.0, f32::max)
    }
}

/// The radius that a line of that width is grown by, in [`STEPS`]; nothing where the sample has no line.
fn class(width: f32, share: f32) -> Option<u16> {
    if width < 1.0 {
        return (share < width).then_some(0);
    }
    let radius = (0.5 * (width - 1.0) + share).min(LARGEST);
    Some((radius * STEPS) as u16)
}

/// Rows of a picture with a column more on either side, as [`Rows`] are.
#[derive(Default)]
struct WideRows {
    ids: [[Vec<u32>; 3]; 2],
    numbers: [[Vec<u32>; 3]; 4],
}

impl WideRows {
    /// What lines are found in around a row of a sample.
    fn around(
        &mut self,
        edges: &Edges,
        planes: &SamplePlanes,
        picture: usize,
        y: usize,
    ) -> Around<'_> {
        let last = planes.size()[1] as usize - 1;
        let rows = [y.saturating_sub(1), y, (y + 1).min(last)];
        let [objects, ids] = &mut self.ids;
        let [inv_depths, components @ ..] = &mut self.numbers;
        if let Some(feature) = edges.ids() {
            for (i, y) in rows.into_iter().enumerate() {
                widen_row(
                    planes.ids(picture, Feature::Object, y),
                    u32::from,
                    &mut objects[i],
                );
                widen_row(planes.ids(picture, feature, y), u32::from, &mut ids[i]);
            }
        }
        for (i, y) in rows.into_iter().enumerate() {
            let row = planes.numbers(picture, Feature::InvDepth, 0, y);
            widen_row(row, f32::to_bits, &mut inv_depths[i]);
        }
        if let Some(feature) = edges.filtered() {
            for (component, wide) in components.iter_mut().enumerate() {
                for (i, y) in rows.into_iter().enumerate() {
                    let row = planes.numbers(picture, feature, component, y);
                    widen_row(row, f32::to_bits, &mut wide[i]);
                }
            }
        }
        Around {
            objects: rows_of(objects),
            ids: rows_of(ids),
            inv_depths: rows_of(inv_depths),
            components: components.each_ref().map(rows_of),
        }
    }
}

/// The words of a row with its outermost ones once more on either side, and as many behind as marks are looked at at once.
fn widen_row<T: Copy>(row: &[T], word: impl Fn(T) -> u32, wide: &mut Vec<u32>) {
    wide.clear();
    if let ([first, ..], [.., last]) = (row, row) {
        wide.push(word(*first));
        wide.extend(row.iter().map(|it| word(*it)));
        wide.resize(row.len().next_multiple_of(SOME) + 2, word(*last));
    }
}

fn rows_of([above, own, below]: &[Vec<u32>; 3]) -> Rows<'_> {
    Rows { above, own, below }
}

/// The pixels that lines cover which begin there, of one of the samples of a picture of that size.
pub(crate) fn covered<'a>(
    found: impl IntoIterator<Item = &'a Beginnings>,
    sample: usize,
    size: [u32; 2],
) -> Covered {
    let mut covered = Covered::none(size);
    let mut discs: Vec<Discs> = Vec::new();
    // The classes of a row.
    let mut classes: Vec<usize> = Vec::new();
    for found in found {
        let rows = found.rows.iter().filter(|row| row.sample == sample);
        for BeginningsOfRow { y, of_all, .. } in rows {
            for Beginning { column, class } in &found.all[of_all.clone()] {
                let class = usize::from(*class);
                while class >= discs.len() {
                    discs.push(Discs::new(discs.len()));
                }
                let discs = &mut discs[class];
                if discs.spans.is_empty() {
                    classes.push(class);
                }
                discs.push(i32::from(*column));
            }
            for class in classes.drain(..) {
                discs[class].draw(*y, &mut covered);
            }
        }
    }
    covered
}

/// Discs of one radius around pixels of one row.
struct Discs {
    /// How far a disc reaches to either side, by how far a row is from its middle.
    reach: Vec<i32>,
    /// The first and the last columns of the pixels that lie side by side, from left to right.
    spans: Vec<[i32; 2]>,
}

impl Discs {
    /// None yet, of the radius of a class.
    fn new(class: usize) -> Self {
        let radius = class as f32 / STEPS;
        let reach = (0..=radius as i32).map(|down| {
            let square = radius * radius - (down * down) as f32;
            square.max(0.0).sqrt() as i32
        });
        Self {
            reach: reach.collect(),
            spans: Vec::new(),
        }
    }

    /// Adds one around a pixel to the right of the others.
    fn push(&mut self, column: i32) {
        match self.spans.last_mut() {
            Some([_, last]) if *last + 1 == column => *last = column,
            _ => self.spans.push([column, column]),
        }
    }

    /// Adds them to the lines of all rows, and forgets them.
    fn draw(&mut self, y: usize, lines: &mut Covered) {
        // From where they are narrowest: what touches there does so in all rows that are left.
        for (down, &reach) in self.reach.iter().enumerate().rev() {
            join(&mut self.spans, 2 * reach + 1);
            let above = y.checked_sub(down);
            let below = (down > 0).then_some(y + down);
            for y in above.into_iter().chain(below) {
                let Some(row) = lines.row_mut(y) else {
                    continue;
                };
                for [first, last] in &self.spans {
                    set(row, first - reach, last + reach);
                }
            }
        }
        self.spans.clear();
    }
}

/// Makes one of spans that begin no farther than so many columns behind the last one of the span before.
fn join(spans: &mut Vec<[i32; 2]>, apart: i32) {
    spans.dedup_by(|next, before| {
        let touch = next[0] - before[1] <= apart;
        if touch {
            before[1] = next[1];
        }
        touch
    });
}

/// Sets the bits of a row from one column to another, both with it, as far as they are there.
fn set(row: &mut [u64], first: i32, last: i32) {
    let end = row.len() as i32 * 64 - 1;
    let (first, last) = (first.max(0), last.min(end));
    let word = |column: i32| column as usize / 64;
    let from = u64::MAX << (first % 64);
    let to = u64::MAX >> (63 - last % 64);
    if word(first) == word(last) {
        row[word(first)] |= from & to;
        return;
    }
    row[word(first)] |= from;
    row[word(first) + 1..word(last)].fill(u64::MAX);
    row[word(last)] |= to;
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cpu::STACK;
    use crate::planes::{BandPlanes, Sample, Stacks};
    use proptest::prelude::*;

    fn edges() -> Edges {
        Edges {
            channel: EdgeChannel::Strand,
            threshold: 0.5,
            step_m: 0.1,
            width_px: Variation::constant(1.0),
            seed: 7,
            fade_to: 0.0,
            color: [1.0, 0.0, 0.0],
        }
    }

    /// One sample of each pixel, where `sample` says something; a band has 16 rows.
    fn planes(size: [u32; 2], sample: impl Fn(usize, usize) -> Sample) -> SamplePlanes {
        let declared = Features::of(Feature::ALL);
        let mut planes = SamplePlanes::default();
        planes.make_room(size, declared, [0, 1], 16).unwrap();
        let [ids, numbers] = planes.of_band();
        let bands = planes
            .ids
            .chunks_mut(ids)
            .zip(planes.numbers.chunks_mut(numbers));
        for (band, (ids, numbers)) in bands.enumerate() {
            let mut planes = BandPlanes {
                width: size[0] as usize,
                layout: planes.layout,
                band: 16,
                count: 1,
                ids,
                numbers,
            };
            for row in 0..16.min(size[1] as usize - 16 * band) {
                for x in 0..size[0] as usize {
                    put(&mut planes, x, row, &sample(x, 16 * band + row));
                }
            }
        }
        planes
    }

    /// Puts in a sample at a row of the band.
    fn put(planes: &mut BandPlanes, column: usize, row: usize, sample: &Sample) {
        let at = Stacks {
            column,
            columns: 1,
            row,
            rows: 1,
            of_pixel: 1,
            count: 1,
        };
        for feature in planes.layout.declared.iter() {
            if feature.is_id() {
                planes.put_ids(feature, &at, &[sample.id(feature); STACK]);
                continue;
            }
            for component in 0..feature.components() {
                let number = sample.number(feature, component);
                planes.put_numbers(feature, component, &at, &[number; STACK]);
            }
        }
    }

    fn strand(strand: u32, inv_depth: f32) -> Sample {
        Sample {
            object: 1,
            strand,
            level: strand % 3,
            inv_depth,
            u: 0.5,
            color: [0.0, 0.0, 0.0, 1.0],
            ..Sample::NOTHING
        }
    }

    fn drawn(edges: Edges, planes: &SamplePlanes) -> Vec<(usize, usize)> {
        let mut planes = planes.clone();
        edges.draw(&mut planes, 1);
        let [width, height] = planes.size().map(|side| side as usize);
        let all = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
        all.filter(|&(x, y)| planes.sample(0, x, y).color == [1.0, 0.0, 0.0, 1.0])
            .collect()
    }

    #[test]
    fn lines_lie_on_what_is_in_front() {
        // 65,537 and 1 have the same lower 16 bits.
        for (left, right, column) in [(2.0, 1.0, 4), (1.0, 2.0, 5), (1.0, 1.0, 5)] {
            let planes = planes([10, 20], |x, _| match x {
                0..5 => strand(1, left),
                _ => strand(65_537, right),
            });
            let expected: Vec<_> = (0..20).map(|y| (column, y)).collect();
            assert_eq!(drawn(edges(), &planes), expected);
        }
    }

    #[test]
    fn equal_levels_and_meshes_have_no_line_between_them() {
        let channel = EdgeChannel::Level;
        let equal = planes([8, 8], |x, _| strand(if x < 4 { 0 } else { 3 }, 1.0));
        assert_eq!(drawn(Edges { channel, ..edges() }, &equal), []);
        assert_eq!(drawn(edges(), &equal).len(), 8);
        let mesh = |object| Sample {
            object,
            inv_depth: 1.0,
            ..Sample::NOTHING
        };
        let meshes = planes([8, 8], |x, _| mesh(if x < 4 { 2 } else { 4 }));
        assert_eq!(drawn(edges(), &meshes), []);
        let channel = EdgeChannel::Object;
        assert_eq!(drawn(Edges { channel, ..edges() }, &meshes).len(), 8);
    }

    #[test]
    fn a_picture_without_neighbours_has_no_lines() {
        let one = planes([1, 1], |_, _| strand(3, 1.0));
        for channel in [
            EdgeChannel::Level,
            EdgeChannel::Strand,
            EdgeChannel::Object,
            EdgeChannel::Normal,
            EdgeChannel::Depth,
            EdgeChannel::Color,
        ] {
            let edges = Edges {
                channel,
                width_px: Variation::constant(9.0),
                ..edges()
            };
            assert_eq!(drawn(edges, &one), []);
        }
        let all = planes([9, 9], |_, _| strand(3, 1.0));
        assert_eq!(drawn(edges(), &all), [], "the picture's border is no edge");
    }

    #[test]
    fn lines_grow_by_discs_across_words() {
        let dot = planes([140, 40], |x, y| match (x, y) {
            (66, 20) => strand(1, 2.0),
            _ => strand(2, 1.0),
        });
        for width_px in [1.0, 2.0, 3.0, 5.0, 12.0, 40.0] {
            let edges = Edges {
                width_px: Variation::constant(width_px),
                ..edges()
            };
            let radius = ((0.5 * (width_px - 1.0) + 0.499) * STEPS).floor() / STEPS;
            let is_in = |&(x, y): &(usize, usize)| {
                let (dx, dy) = (x as f32 - 66.0, y as f32 - 20.0);
                dx * dx + dy * dy <= radius * radius
            };
            let all = (0..40).flat_map(|y| (0..140).map(move |x| (x, y)));
            assert_eq!(
                drawn(edges, &dot),
                all.filter(is_in).collect::<Vec<_>>(),
                "{width_px}"
            );
        }
    }

    proptest! {
        /// Discs around any pixels of a row, of any radii, cover what each covers by itself.
        #[test]
        fn lines_cover_each_beginning_with_its_disc(
            beginnings in prop::collection::btree_map((0..12_usize, 0..150_u16), prop_oneof![40 => 0..60_u16, 1 => 600..1000_u16], 0..80),
            is_one_row: bool,
        ) {
            let size = [150, 12];
            let mut found = Beginnings::default();
            for y in 0..12 {
                let own = beginnings.iter().filter(|((row, _), _)| *row == y);
                // In one row, so that none hides what others leave between them.
                let own = own.filter_map(|((_, column), class)| match is_one_row {
                    true => (y == 5).then_some((column / 5, class % 2 * 8)),
                    false => Some((*column, *class)),
                });
                let own: std::collections::BTreeMap<u16, u16> = own.collect();
                let row: Vec<Beginning> =
                    own.into_iter().map(|(column, class)| Beginning { column, class }).collect();
                found.push(1, y, &row);
            }
            let covered = covered([&found], 1, size);
            for (y, x) in (0..12).flat_map(|y| (0..150).map(move |x| (y, x))) {
                let is_in = found.rows.iter().any(|row| {
                    found.all[row.of_all.clone()].iter().any(|beginning| {
                        let radius = f32::from(beginning.class) / STEPS;
                        let (dx, dy) = (x as f32 - f32::from(beginning.column), y as f32 - row.y as f32);
                        dx * dx + dy * dy <= radius * radius
                    })
                });
                prop_assert_eq!(covered.row(y)[x / 64] >> (x % 64) & 1 != 0, is_in, "{} {}", x, y);
            }
        }
    }

    #[test]
    fn depths_normals_and_colors_have_thresholds() {
        let steps = planes([8, 8], |x, _| strand(1, if x < 4 { 1.0 } else { 0.8 }));
        let depth = |step_m| Edges {
            channel: EdgeChannel::Depth,
            step_m,
            ..edges()
        };
        // From 1 m to 1.25 m.
        assert_eq!(drawn(depth(0.24), &steps).len(), 8);
        assert_eq!(drawn(depth(0.26), &steps).len(), 0);
        let tones = planes([8, 8], |x, _| {
            let gray = if x < 4 { 0.2 } else { 0.4 };
            Sample {
                color: [0.0, gray, 0.0, 1.0],
                normal: glam::Vec3::new(gray, 0.0, 0.0),
                ..strand(1, 1.0)
            }
        });
        for channel in [EdgeChannel::Color, EdgeChannel::Normal] {
            // (1 + 2 + 1) times 0.2, on both sides.
            let with = |threshold| Edges {
                channel,
                threshold,
                ..edges()
            };
            assert_eq!(drawn(with(0.79), &tones).len(), 16);
            assert_eq!(drawn(with(0.81), &tones).len(), 0);
        }
    }

    #[test]
    fn lines_fade_towards_the_root() {
        let along = |u| {
            planes([8, 8], move |x, _| Sample {
                u,
                ..strand(u32::from(x < 4), 1.0)
            })
        };
        let faded = |fade_to, u| {
            let edges = Edges {
                width_px: Variation::constant(5.0),
                fade_to,
                ..edges()
            };
            drawn(edges, &along(u)).len()
        };
        assert_eq!(faded(0.0, 0.0), faded(0.5, 0.6));
        assert_eq!(faded(0.5, 0.0), 0);
        assert!(faded(0.5, 0.25) < faded(0.5, 0.4) && faded(0.5, 0.25) > 0);
    }
    #[test]
    fn widths_follow_curves_and_vary_from_strand_to_strand() {
        let pair = |right: u32, u: f32| {
            planes([41, 41], move |x, _| Sample {
                u,
                ..strand(
                    if x < 20 { right } else { 1 },
                    if x < 20 { 2.0 } else { 1.0 },
                )
            })
        };
        let columns = |width_px: Variation, planes: &SamplePlanes| {
            let edges = Edges {
                width_px,
                ..edges()
            };
            let columns: std::collections::BTreeSet<usize> =
                drawn(edges, planes).into_iter().map(|(x, _)| x).collect();
            columns.len()
        };
        let curve = Variation {
            curve: vec![(0.0, 0.0), (0.5, 9.0), (1.0, 3.0)],
            vary: 0.0,
        };
        let widths = [0.0, 0.25, 0.5, 0.75, 1.0].map(|u| columns(curve.clone(), &pair(5, u)));
        // Radii are whole quarters of a pixel, rounded down.
        assert_eq!(widths, [0, 5, 9, 5, 3]);
        let vary = Variation {
            vary: 1.0,
            ..Variation::constant(9.0)
        };
        let widths: std::collections::BTreeSet<usize> = (2..40)
            .map(|id| columns(vary.clone(), &pair(id, 0.5)))
            .collect();
        assert!(*widths.first().unwrap() < 4 && *widths.last().unwrap() > 14);
        // A mesh has the curve's largest.
        let mesh = planes([41, 41], |x, _| match x < 20 {
            true => Sample {
                object: 2,
                inv_depth: 2.0,
                ..Sample::NOTHING
            },
            false => strand(1, 1.0),
        });
        assert_eq!(columns(curve, &mesh), 9);
    }
}
