//! `edges`: lines where neighbouring samples show something else, as image filters draw them, at any width.
//!
//! Each sample of all pixels is a picture of its own, whose neighbours are a pixel away: lines found in each, and the mean of all, are
//! smooth. Lines lie on what is in front. They are grown by discs, whose rows are shifted words of 64 pixels, so that wide lines take
//! hardly longer than thin ones.

use crate::cpu::instructions::Instructions;
use crate::features::{Feature, Features};
use crate::planes::SamplePlanes;
use effects::wgsl::random_signed;
use effects::{Variation, strand_seed};
use portable_math::sin_cos_degrees_f32;
use rayon::prelude::*;

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

/// Some pixels of a row, 64 in a word.
pub(crate) type Bits = Vec<u64>;

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

    /// Draws the lines into samples of a picture that has so many a pixel.
    pub(crate) fn draw(&self, planes: &mut SamplePlanes, samples: usize) {
        let masks = self.covered(planes, samples);
        planes.set_color(&masks, self.color);
    }

    /// The pixels that lines cover, for each row of each of the samples, of which a picture has so many a pixel.
    pub(crate) fn covered(&self, planes: &SamplePlanes, samples: usize) -> Vec<Vec<Bits>> {
        let first = planes.samples().start;
        (0..planes.samples().len())
            .into_par_iter()
            .map(|picture| {
                // A little less than the middle, so that half a pixel is none where there is one sample.
                let share = ((first + picture) as f32 + 0.499) / samples as f32;
                self.lines(planes, picture, share)
            })
            .collect()
    }

    /// The pixels of one sample that lines cover; `share` is the sample's place among all, 0 to 1.
    fn lines(&self, planes: &SamplePlanes, picture: usize, share: f32) -> Vec<Bits> {
        let [width, height] = planes.size().map(|side| side as usize);
        let words = width.div_ceil(64);
        let mut lines = vec![vec![0; words]; height];
        let mut differ = Differences::new(width);
        let mut found = Vec::new();
        let mut classes: Vec<(usize, Bits)> = Vec::new();
        let mut grown = vec![0; words];
        let widest = self.widest();
        for y in 0..height {
            self.find(planes, picture, y, &mut differ, &mut found);
            classes.clear();
            let objects = planes.ids(picture, Feature::Object, y);
            // Empty where no width needs them.
            let along = planes.numbers(picture, Feature::U, 0, y);
            let strands = planes.ids(picture, Feature::Strand, y);
            for &x in &found {
                let width = match objects[x] % 2 == 1 {
                    true => {
                        let of = |strands: &[u32]| strands.get(x).copied().unwrap_or(0);
                        self.width_of_hair(along.get(x).copied().unwrap_or(0.0), of(strands))
                    }
                    false => widest,
                };
                let Some(class) = class(width, share) else {
                    continue;
                };
                let index = classes.iter().position(|(other, _)| *other == class);
                let index = index.unwrap_or_else(|| {
                    classes.push((class, vec![0; words]));
                    classes.len() - 1
                });
                classes[index].1[x / 64] |= 1 << (x % 64);
            }
            for (class, bits) in &classes {
                grown.copy_from_slice(bits);
                grow(&mut grown, *class as f32 / STEPS, y, &mut lines);
            }
        }
        lines
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

    /// Finds the columns of a row where a line begins; rows are asked for one after the other.
    fn find(
        &self,
        planes: &SamplePlanes,
        picture: usize,
        y: usize,
        differ: &mut Differences,
        found: &mut Vec<usize>,
    ) {
        found.clear();
        match self.channel {
            EdgeChannel::Level => find_ids(planes, picture, Feature::Level, y, differ, found),
            EdgeChannel::Strand => find_ids(planes, picture, Feature::Strand, y, differ, found),
            EdgeChannel::Object => find_ids(planes, picture, Feature::Object, y, differ, found),
            EdgeChannel::Depth => self.find_steps(planes, picture, y, differ, found),
            EdgeChannel::Normal => self.find_sobel(planes, picture, Feature::Normal, y, found),
            EdgeChannel::Color => self.find_sobel(planes, picture, Feature::Color, y, found),
        }
    }

    fn find_steps(
        &self,
        planes: &SamplePlanes,
        picture: usize,
        y: usize,
        differ: &mut Differences,
        found: &mut Vec<usize>,
    ) {
        let last = planes.size()[1] as usize - 1;
        let row = |y: usize| planes.numbers(picture, Feature::InvDepth, 0, y);
        let rows = [row(y.saturating_sub(1)), row(y), row((y + 1).min(last))];
        differ.instructions.run(
            #[inline(always)]
            || fill_steps(rows, self.step_m, &mut differ.farthest, &mut differ.all),
        );
        found.extend(nonzero(&differ.all));
    }

    fn find_sobel(
        &self,
        planes: &SamplePlanes,
        picture: usize,
        feature: Feature,
        y: usize,
        found: &mut Vec<usize>,
    ) {
        let [width, height] = planes.size().map(|side| side as usize);
        let rows = [y.saturating_sub(1), y, (y + 1).min(height - 1)];
        let threshold = self.threshold * self.threshold;
        let channels = [0, 1, 2].map(|i| rows.map(|y| planes.numbers(picture, feature, i, y)));
        found.extend((0..width).filter(|&x| {
            let (left, right) = (x.saturating_sub(1), (x + 1).min(width - 1));
            let squares = channels.iter().map(|[above, own, below]| {
                let across = |row: &[f32]| row[right] - row[left];
                let down = |x: usize| below[x] - above[x];
                let h = across(above) + 2.0 * across(own) + across(below);
                let v = down(left) + 2.0 * down(x) + down(right);
                h * h + v * v
            });
            squares.sum::<f32>() > threshold
        }));
    }
}

/// The radius that a line of that width is grown by, in [`STEPS`]; nothing where the sample has no line.
fn class(width: f32, share: f32) -> Option<usize> {
    if width < 1.0 {
        return (share < width).then_some(0);
    }
    let radius = (0.5 * (width - 1.0) + share).min(LARGEST);
    Some((radius * STEPS) as usize)
}

/// The row and those beside it.
fn around(y: usize, planes: &SamplePlanes) -> std::ops::Range<usize> {
    y.saturating_sub(1)..(y + 2).min(planes.size()[1] as usize)
}

/// Marks the pixels of the middle one of three rows of inverse depths that have one around them which is farther by more than a step. `farthest` is
/// scratch, as long as they are.
#[inline(always)] // compiled for the best instructions
fn fill_steps(
    [above, own, below]: [&[f32]; 3],
    step_m: f32,
    farthest: &mut [f32],
    differ: &mut [u32],
) {
    let lesser = |a: f32, b: f32| if b < a { b } else { a };
    let width = differ.len();
    // Of one length, so that no place is checked.
    let (above, own, below) = (&above[..width], &own[..width], &below[..width]);
    let (farthest, differ) = (&mut farthest[..width], &mut differ[..width]);
    for x in 0..width {
        farthest[x] = lesser(lesser(above[x], own[x]), below[x]);
    }
    // Farther than own / (1 + own * step), in inverse depths; nothing is infinitely far. What is grows with the other's inverse depth, also
    // in single precision, so that it is enough to ask of the farthest of nine.
    let mark = |x: usize, farthest: f32| u32::from(farthest * (1.0 + own[x] * step_m) < own[x]);
    let last = width - 1;
    for x in 1..last {
        let of_nine = lesser(lesser(farthest[x - 1], farthest[x]), farthest[x + 1]);
        differ[x] = mark(x, of_nine);
    }
    let next = |x: usize, other: usize| lesser(farthest[x], farthest[other]);
    differ[0] = mark(0, next(0, 1.min(last)));
    differ[last] = mark(last, next(last, last.saturating_sub(1)));
}

/// Numbers that are looked at at once.
const SOME: usize = 16;

/// The columns of what isn't 0, most of which is.
fn nonzero(differ: &[u32]) -> impl Iterator<Item = usize> {
    let some = differ.chunks(SOME).enumerate();
    let some = some.filter(|(_, numbers)| any(numbers) != 0);
    some.flat_map(|(chunk, numbers)| {
        let columns = (chunk * SOME..).zip(numbers);
        columns.filter_map(|(x, number)| (*number != 0).then_some(x))
    })
}

/// All bits of some numbers.
#[inline(always)]
fn any(numbers: &[u32]) -> u32 {
    // Without branches where there are as many as there mostly are.
    match <&[u32; SOME]>::try_from(numbers) {
        Ok(numbers) => {
            let mut all = 0;
            for number in numbers {
                all |= number;
            }
            all
        }
        Err(_) => numbers.iter().fold(0, |all, number| all | number),
    }
}

/// Where ids of a picture differ, as rows of numbers that are 0 where they don't. Of nine pixels all are alike where no two beside each
/// other differ in one of the three rows, nor those of the middle column.
struct Differences {
    /// From a pixel to the next one of its row: of the row before, of this row and of the one behind it.
    across: [Vec<u32>; 3],
    /// From a pixel to the one below it: of the row before, and of this row.
    down: [Vec<u32>; 2],
    /// In the nine pixels around one.
    all: Vec<u32>,
    /// Of depths: the farthest of each pixel and those above and below it.
    farthest: Vec<f32>,
    instructions: Instructions,
}

impl Differences {
    fn new(width: usize) -> Self {
        Self {
            across: [0; 3].map(|_| vec![0; width]),
            down: [0; 2].map(|_| vec![0; width]),
            all: vec![0; width],
            farthest: vec![0.0; width],
            instructions: Instructions::best(),
        }
    }

    /// Works out [`Self::all`] of row `y`, after that of the row before.
    #[inline(always)] // compiled for the best instructions
    fn advance(&mut self, planes: &SamplePlanes, picture: usize, feature: Feature, y: usize) {
        let height = planes.size()[1] as usize;
        let rows = |y: usize| [feature, Feature::Object].map(|id| planes.ids(picture, id, y));
        let width = self.all.len();
        self.across.rotate_left(1);
        self.down.rotate_left(1);
        if y == 0 {
            self.across[0].fill(0);
            self.down[0].fill(0);
            fill_beside(&mut self.across[1], rows(0));
        }
        match y + 1 < height {
            true => {
                let (own, below) = (rows(y), rows(y + 1));
                fill_beside(&mut self.across[2], below);
                fill_differences(&mut self.down[1], own, below);
            }
            false => {
                self.across[2].fill(0);
                self.down[1].fill(0);
            }
        }
        // Of one length, so that no place is checked.
        let all = &mut self.all[..width];
        let [a, b, c] = self.across.each_ref().map(|row| &row[..width]);
        let [d, e] = self.down.each_ref().map(|row| &row[..width]);
        all[0] = a[0] | b[0] | c[0] | d[0] | e[0];
        for x in 1..width {
            let left = a[x - 1] | b[x - 1] | c[x - 1];
            all[x] = left | a[x] | b[x] | c[x] | d[x] | e[x];
        }
    }
}

/// Where the pixels of a row of two ids differ from those to their right.
#[inline(always)]
fn fill_beside(differ: &mut [u32], [a, b]: [&[u32]; 2]) {
    let last = differ.len() - 1;
    fill_differences(&mut differ[..last], [a, b], [&a[1..], &b[1..]]);
}

/// Where one of two rows of ids differs from another.
#[inline(always)]
fn fill_differences(differ: &mut [u32], [a, b]: [&[u32]; 2], [c, d]: [&[u32]; 2]) {
    let width = differ.len();
    let (a, b, c, d) = (&a[..width], &b[..width], &c[..width], &d[..width]);
    for x in 0..width {
        differ[x] = (a[x] ^ c[x]) | (b[x] ^ d[x]);
    }
}

/// Finds pixels beside others of another id that aren't in front of them. What is equally near belongs to the greater id.
fn find_ids(
    planes: &SamplePlanes,
    picture: usize,
    feature: Feature,
    y: usize,
    differ: &mut Differences,
    found: &mut Vec<usize>,
) {
    struct Row<'a> {
        ids: &'a [u32],
        objects: &'a [u32],
        depths: &'a [f32],
    }
    differ.instructions.run(
        #[inline(always)]
        || differ.advance(planes, picture, feature, y),
    );
    let mut candidates = nonzero(&differ.all).peekable();
    if candidates.peek().is_none() {
        return;
    }
    let rows = around(y, planes).map(|y| Row {
        ids: planes.ids(picture, feature, y),
        objects: planes.ids(picture, Feature::Object, y),
        depths: planes.numbers(picture, Feature::InvDepth, 0, y),
    });
    let rows: Vec<Row> = rows.collect();
    let own = &rows[y - around(y, planes).start];
    let has_hair_alone = feature != Feature::Object;
    let is_hair = |object: u32| object % 2 == 1;
    let width = differ.all.len();
    found.extend(candidates.filter(|&x| {
        let key = |row: &Row, x: usize| (row.objects[x], row.ids[x]);
        let (own_key, own_depth) = (key(own, x), own.depths[x]);
        let columns = x.saturating_sub(1)..(x + 2).min(width);
        rows.iter().any(|other| {
            columns.clone().any(|x| {
                let (other_key, other_depth) = (key(other, x), other.depths[x]);
                let is_drawn = !has_hair_alone || is_hair(own_key.0) || is_hair(other_key.0);
                let is_front = (own_depth, own_key) > (other_depth, other_key);
                is_drawn && own_key != other_key && is_front
            })
        })
    }));
}

/// Adds to the lines of all rows what a row becomes when each pixel is a disc of that radius.
fn grow(row: &mut [u64], radius: f32, y: usize, lines: &mut [Bits]) {
    let reach = radius as usize;
    let mut done = 0;
    for down in (0..=reach).rev() {
        let square = radius * radius - (down * down) as f32;
        let wide = square.max(0.0).sqrt() as usize;
        while done < wide {
            widen(row);
            done += 1;
        }
        let above = y.checked_sub(down);
        let below = Some(y + down).filter(|y| down > 0 && *y < lines.len());
        for y in above.into_iter().chain(below) {
            for (line, grown) in lines[y].iter_mut().zip(&*row) {
                *line |= grown;
            }
        }
    }
}

/// Adds the pixels to the left and to the right.
fn widen(row: &mut [u64]) {
    let mut before = 0;
    for i in 0..row.len() {
        let own = row[i];
        let after = row.get(i + 1).copied().unwrap_or(0);
        row[i] = own | own << 1 | own >> 1 | before >> 63 | after << 63;
        before = own;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cpu::STACK;
    use crate::planes::{BandPlanes, Sample, Stacks};

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
    fn steps_are_those_of_pairs() {
        let step_m = 0.1;
        for [width, height] in [[1, 1], [1, 9], [9, 1], [2, 3], [17, 9], [70, 20]] {
            let depth = |x: usize, y: usize| match (x * 7919 + y * 104_729) % 13 {
                0 => 0.0, // nothing there
                n => 1.0 + 0.04 * n as f32,
            };
            let rows: Vec<Vec<f32>> = (0..height)
                .map(|y| (0..width).map(|x| depth(x, y)).collect())
                .collect();
            let (mut farthest, mut differ) = (vec![0.0; width], vec![7; width]);
            let mut marked = 0;
            for y in 0..height {
                let around = [y.saturating_sub(1), y, (y + 1).min(height - 1)];
                let some = around.map(|y| &rows[y][..]);
                fill_steps(some, step_m, &mut farthest, &mut differ);
                for x in 0..width {
                    let own = rows[y][x];
                    let columns = x.saturating_sub(1)..(x + 2).min(width);
                    let is_farther = |other: f32| other * (1.0 + own * step_m) < own;
                    let is_marked = some
                        .iter()
                        .any(|row| row[columns.clone()].iter().any(|&d| is_farther(d)));
                    assert_eq!(
                        differ[x],
                        u32::from(is_marked),
                        "{width} x {height}: {x}, {y}"
                    );
                    marked += usize::from(is_marked);
                }
            }
            // Neither none nor all, where there is room for both.
            assert!(width * height < 20 || (1..width * height).contains(&marked));
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
