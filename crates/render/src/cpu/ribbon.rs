//! Where lines of the whole picture begin, found in each band of tiles while what its samples tell is in the cache.
//!
//! A ribbon is a band of pixels, row by row, all samples of a pixel one after the other. A sample's neighbours to the left and the right are a pixel's samples
//! away, and those above and below at the same place of the next rows: so rows are compared as they are, by vector instructions, all samples at once. Of a picture
//! nothing is kept but where lines begin, and of each band its two highest and two lowest rows, its *rims*: what lies between two bands is found when all are
//! drawn.

use super::tile::{STACK, Stack};
use crate::edges::find::{Around, Rows, SOME, Scratch, marked};
use crate::edges::{Beginning, Beginnings, Edges, Place, share};
use crate::features::{Feature, Features};
use crate::planes::{Layout, Sample};
use std::ops::Range;

/// Columns beside what is drawn that must be known: lines begin in the first, whose neighbours are asked for too.
const BESIDE: usize = 2;
/// Rows of a rim.
const RIM: usize = 2;

/// What samples of some rows of pixels tell.
#[derive(Default)]
pub(super) struct Ribbon {
    layout: Layout,
    /// Of the picture, pixels.
    width: usize,
    rows: usize,
    /// Samples of a pixel that are one after the other, those included that don't count.
    of_pixel: usize,
    /// Plane after plane, ids and then the bits of numbers; in each row after row.
    words: Vec<u32>,
    /// Columns of the picture that something may be in. Beside them is nothing, and more than [`BESIDE`] from them anything.
    drawn: Range<usize>,
}

/// What passes ask samples for, colours aside.
pub(super) fn asked(passes: &[Edges]) -> Features {
    let all = passes.iter().map(Edges::features);
    let all = all.fold(Features::NONE, Features::union);
    all.without(Features::of(&[Feature::Color]))
}

impl Ribbon {
    /// Makes room for rows of pixels, in which nothing is drawn.
    pub(super) fn begin(&mut self, asked: Features, width: usize, rows: usize, of_pixel: usize) {
        self.layout = Layout::new(asked);
        (self.width, self.rows, self.of_pixel) = (width, rows, of_pixel);
        self.drawn = 0..0;
        self.words
            .resize(self.planes() * rows * self.row_length(), 0);
    }

    /// What it tells.
    pub(super) fn asked(&self) -> Features {
        self.layout.declared
    }

    pub(super) fn rows(&self) -> usize {
        self.rows
    }

    fn planes(&self) -> usize {
        self.layout.planes.iter().sum()
    }

    /// A column on either side of the picture, and as many numbers more as are looked at at once.
    fn row_length(&self) -> usize {
        (self.width + 2) * self.of_pixel + SOME
    }

    fn plane(&self, feature: Feature, component: usize) -> Option<usize> {
        let is_id = feature.is_id();
        let before = if is_id { 0 } else { self.layout.planes[0] };
        let first = self.layout.first(feature)?;
        Some(before + first + component)
    }

    /// Where a row of a plane begins.
    fn start(&self, plane: usize, row: usize) -> usize {
        (plane * self.rows + row) * self.row_length()
    }

    /// Some columns of a row of a plane, counted from the one before the picture.
    fn place(&self, plane: usize, row: usize, columns: &Range<usize>) -> Range<usize> {
        let start = self.start(plane, row);
        start + columns.start * self.of_pixel..start + columns.end * self.of_pixel
    }

    /// Puts a component of some stacks of a row of stacks into their columns.
    #[inline(always)] // compiled for the rasteriser's instructions
    pub(super) fn put(
        &mut self,
        (feature, component): (Feature, usize),
        row: usize,
        columns: &Range<usize>,
        words: &[u32],
    ) {
        let Some(plane) = self.plane(feature, component) else {
            return;
        };
        let (stacks, _) = words.as_chunks();
        let stacks = &stacks[..columns.len()];
        let height = STACK / self.of_pixel;
        for below in 0..height {
            let row = row * height + below;
            if row >= self.rows {
                return; // below the picture
            }
            let place = self.place(plane, row, &(columns.start + 1..columns.end + 1));
            let to = &mut self.words[place];
            match self.of_pixel {
                1 => put_pixels::<1>(to, stacks, below),
                2 => put_pixels::<2>(to, stacks, below),
                4 => put_pixels::<4>(to, stacks, below),
                _ => put_pixels::<STACK>(to, stacks, below),
            }
        }
    }

    /// Says which columns are put in next, to the right of all before.
    pub(super) fn draw(&mut self, columns: &Range<usize>) {
        let start = columns.start + 1;
        if self.drawn.is_empty() {
            self.clear(start.saturating_sub(BESIDE)..start);
            self.drawn = columns.clone();
        } else {
            self.clear(self.drawn.end + 1..start);
            self.drawn.end = columns.end;
        }
    }

    /// Puts nothing into some columns, counted from the one before the picture.
    fn clear(&mut self, columns: Range<usize>) {
        if columns.is_empty() {
            return;
        }
        for feature in self.layout.declared.iter() {
            for component in 0..feature.components() {
                let word = match feature.is_id() {
                    true => Sample::NOTHING.id(feature),
                    false => Sample::NOTHING.number(feature, component).to_bits(),
                };
                let Some(plane) = self.plane(feature, component) else {
                    continue;
                };
                for row in 0..self.rows {
                    let place = self.place(plane, row, &columns);
                    self.words[place].fill(word);
                }
            }
        }
    }

    /// The columns that are known, counted from the one before the picture.
    fn known(&self) -> Range<usize> {
        let Range { start, end } = self.drawn;
        (start + 1).saturating_sub(BESIDE)..(end + 1 + BESIDE).min(self.width + 2)
    }

    /// To be called when all is put in.
    pub(super) fn finish(&mut self) {
        if self.drawn.is_empty() {
            return;
        }
        self.clear(self.drawn.end + 1..self.known().end);
        // What lies at the picture's border has no neighbour there but itself.
        let (length, of_pixel) = (self.row_length(), self.of_pixel);
        let (first, last) = (of_pixel, self.width * of_pixel);
        let is_first = self.drawn.start == 0;
        let is_last = self.drawn.end == self.width;
        for row in self.words.chunks_exact_mut(length) {
            if is_first {
                row.copy_within(first..first + of_pixel, 0);
            }
            if is_last {
                row.copy_within(last..last + of_pixel, last + of_pixel);
            }
        }
    }

    /// Copies the highest and the lowest rows, all columns of them.
    pub(super) fn copy_rims(&self, rims: &mut Self) {
        rims.begin(self.layout.declared, self.width, 2 * RIM, self.of_pixel);
        rims.drawn = self.drawn.clone();
        let all = 0..self.width + 2;
        if self.drawn.is_empty() {
            rims.clear(all);
            return;
        }
        let known = self.known();
        rims.clear(all.start..known.start);
        rims.clear(known.end..all.end);
        let highest = 0..RIM.min(self.rows);
        let lowest = self.rows.saturating_sub(RIM)..self.rows;
        for plane in 0..self.planes() {
            for (rim, row) in (0..)
                .zip(highest.clone())
                .chain((RIM..).zip(lowest.clone()))
            {
                let to = rims.place(plane, rim, &known);
                let from = self.place(plane, row, &known);
                rims.words[to].copy_from_slice(&self.words[from]);
            }
        }
    }
}

/// The samples of the pixels of stacks that are so many pixels below the highest.
#[inline(always)]
fn put_pixels<const OF_PIXEL: usize>(to: &mut [u32], stacks: &[[u32; STACK]], below: usize) {
    let (pixels, _) = to.as_chunks_mut::<OF_PIXEL>();
    for i in 0..pixels.len() {
        let (of_stack, _) = stacks[i].as_chunks();
        pixels[i] = of_stack[below];
    }
}

/// A row of pixels of a ribbon.
#[derive(Clone, Copy)]
struct RowOf<'a> {
    ribbon: &'a Ribbon,
    row: usize,
}

impl<'a> RowOf<'a> {
    /// The numbers of a plane, from a column on, counted from the one before the picture.
    #[inline(always)]
    fn words(self, plane: usize, column: usize, count: usize) -> &'a [u32] {
        let start = self.ribbon.start(plane, self.row) + column * self.ribbon.of_pixel;
        &self.ribbon.words[start..start + count]
    }
}

/// A row of pixels, `y` in the picture, with those above and below it, or itself at the picture's border.
struct Looked<'a> {
    above: RowOf<'a>,
    own: RowOf<'a>,
    below: RowOf<'a>,
    y: usize,
}

/// Finds where lines begin. Keeps its memory.
#[derive(Default)]
pub(super) struct Finder {
    marks: Vec<u32>,
    scratch: Scratch,
    /// What begins in each of a pixel's samples.
    samples: [Vec<Beginning>; STACK],
}

/// A picture whose lines are looked for.
pub(super) struct Search<'a> {
    pub(super) passes: &'a [Edges],
    pub(super) stack: &'a Stack,
    /// Samples of a pixel.
    pub(super) samples: usize,
    /// Rows of pixels.
    pub(super) height: usize,
    /// Rows of pixels of a band.
    pub(super) band: usize,
    /// Whether all hair is one object's: else two may have strands and levels of one number.
    pub(super) has_one_hair: bool,
}

impl Finder {
    /// Finds the lines of a band, but for those of its outermost rows that hang on its neighbours, and adds them to those of each pass.
    #[inline(always)] // compiled for the rasteriser's instructions
    pub(super) fn find_in(
        &mut self,
        search: &Search,
        ribbon: &Ribbon,
        band: usize,
        found: &mut [Beginnings],
    ) {
        let top = band * search.band;
        let row_of = |row: usize| RowOf { ribbon, row };
        let columns = columns(&ribbon.drawn, ribbon.width);
        let last = ribbon.rows - 1;
        for row in 0..ribbon.rows {
            let y = top + row;
            if row == 0 && y > 0 || row == last && y + 1 < search.height {
                continue;
            }
            let looked = Looked {
                above: row_of(row.saturating_sub(1)),
                own: row_of(row),
                below: row_of((row + 1).min(last)),
                y,
            };
            self.look(search, &looked, &columns, found);
        }
    }

    /// Finds the lines of the last row of a band and of the first of the next, by the rims of both.
    #[inline(always)]
    pub(super) fn find_between(
        &mut self,
        search: &Search,
        [upper, lower]: [&Ribbon; 2],
        band: usize,
        found: &mut [Beginnings],
    ) {
        let drawn = [upper, lower].map(|rims| columns(&rims.drawn, rims.width));
        let columns = match &drawn {
            [one, none] | [none, one] if none.is_empty() => one.clone(),
            [a, b] => a.start.min(b.start)..a.end.max(b.end),
        };
        let y = (band + 1) * search.band;
        let row_of = |ribbon, row| RowOf { ribbon, row };
        let [before, last] = [RIM, RIM + 1].map(|row| row_of(upper, row));
        let first = row_of(lower, 0);
        let next = row_of(lower, usize::from(y + 1 < search.height));
        let of_upper = Looked {
            above: before,
            own: last,
            below: first,
            y: y - 1,
        };
        self.look(search, &of_upper, &columns, found);
        let of_lower = Looked {
            above: last,
            own: first,
            below: next,
            y,
        };
        self.look(search, &of_lower, &columns, found);
    }

    #[inline(always)]
    fn look(
        &mut self,
        search: &Search,
        looked: &Looked,
        columns: &Range<usize>,
        found: &mut [Beginnings],
    ) {
        if columns.is_empty() {
            return;
        }
        match search.stack.of_pixel {
            1 => self.look_at::<1>(search, looked, columns, found),
            2 => self.look_at::<2>(search, looked, columns, found),
            4 => self.look_at::<4>(search, looked, columns, found),
            _ => self.look_at::<STACK>(search, looked, columns, found),
        }
    }

    #[inline(always)]
    fn look_at<const OF_PIXEL: usize>(
        &mut self,
        search: &Search,
        looked: &Looked,
        columns: &Range<usize>,
        found: &mut [Beginnings],
    ) {
        let Self {
            marks,
            scratch,
            samples,
        } = self;
        let ribbon = looked.own.ribbon;
        marks.resize((columns.len() * OF_PIXEL).next_multiple_of(SOME), 0);
        let count = marks.len() + 2 * OF_PIXEL;
        let rows = |feature, component| match ribbon.plane(feature, component) {
            Some(plane) => Rows {
                above: looked.above.words(plane, columns.start, count),
                own: looked.own.words(plane, columns.start, count),
                below: looked.below.words(plane, columns.start, count),
            },
            None => Rows::NONE,
        };
        let objects = rows(Feature::Object, 0);
        let inv_depths = rows(Feature::InvDepth, 0);
        // None where no width needs them.
        let along = rows(Feature::U, 0).own;
        let strands = rows(Feature::Strand, 0).own;
        for (pass, found) in search.passes.iter().zip(found) {
            let filtered = pass.filtered();
            let around = Around {
                objects,
                ids: pass.ids().map_or(Rows::NONE, |ids| rows(ids, 0)),
                inv_depths,
                components: [0, 1, 2].map(|i| filtered.map_or(Rows::NONE, |it| rows(it, i))),
            };
            match search.has_one_hair {
                true => pass.mark::<OF_PIXEL, true>(&around, scratch, marks),
                false => pass.mark::<OF_PIXEL, false>(&around, scratch, marks),
            }
            for mark in marked(marks) {
                let (column, sample) = (columns.start + mark / OF_PIXEL, mark % OF_PIXEL);
                if column >= columns.end || sample >= search.stack.samples {
                    continue; // beyond what is drawn, or doesn't count
                }
                let here = mark + OF_PIXEL;
                let place = Place {
                    object: objects.own[here],
                    u: f32::from_bits(along.get(here).copied().unwrap_or_default()),
                    strand: strands.get(here).copied().unwrap_or_default(),
                    share: share(search.stack.first + sample, search.samples),
                };
                samples[sample].extend(pass.beginning(column, &place));
            }
            for (sample, row) in samples.iter_mut().enumerate() {
                found.push(sample, looked.y, row);
                row.clear();
            }
        }
    }
}

/// The columns in which lines may begin, where something is drawn in these.
fn columns(drawn: &Range<usize>, width: usize) -> Range<usize> {
    match drawn.is_empty() {
        true => 0..0,
        false => drawn.start.saturating_sub(1)..(drawn.end + 1).min(width),
    }
}
