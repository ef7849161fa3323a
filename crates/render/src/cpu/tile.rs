//! A tile: the samples of a few pixels, as planes of numbers that vector instructions walk along.
//!
//! Eight samples one below the other are a *stack* ([`Stack`]): eight of a pixel's samples, or those of two, four or eight
//! pixels where a pixel has fewer. A tile is [`ROWS`] rows of [`WIDTH`] stacks, one pixel wide each; where
//! a pixel has more than eight samples, it is drawn eight at a time. A *cell* is two stacks beside each other: sixteen
//! numbers of a plane, and every loop over a cell's lanes compiles to vector instructions, one of AVX-512 or two of AVX2. With four samples a pixel a cell is
//! two pixels by two, as strokes are thin: more of its lanes have something to do than of four pixels beside each other.

use super::stroke::Depths;
use glam::Vec2;
use std::ops::{Deref, DerefMut, Range};

/// Width of a tile in pixels.
pub(super) const WIDTH: usize = 32;
/// Height of a tile in stacks.
pub(super) const ROWS: usize = 8;
/// Samples of a stack.
pub(crate) const STACK: usize = 8;
/// Numbers of a cell.
pub(super) const LANES: usize = 16;

/// Cells of a row.
pub(super) const CELLS_ACROSS: usize = WIDTH * STACK / LANES;
pub(super) const CELLS: usize = ROWS * CELLS_ACROSS;

/// Pixels that a cell is wide.
pub(super) const CELL_WIDTH: usize = LANES / STACK;

/// One number of each sample of a cell: of the left stack from its first sample on, then of the right one.
pub(super) type Lanes = [f32; LANES];

/// Colours of all samples of a tile, channel by channel.
pub(super) type Colors = [[Lanes; CELLS]; 3];

/// Black ones.
#[inline]
pub(super) fn no_colors() -> Colors {
    [[[0.0; LANES]; CELLS]; 3]
}

/// Which samples of a tile show anything: a bit for each lane of each cell.
#[derive(Clone)]
pub(super) struct Shows([u16; CELLS]);

impl Default for Shows {
    fn default() -> Self {
        Self([0; CELLS])
    }
}

impl Shows {
    pub(super) fn has(&self, cell: usize, lane: usize) -> bool {
        self.0[cell] >> lane & 1 != 0
    }
}

/// Some of a cell's samples: all bits or none.
pub(super) type LaneMask = [u32; LANES];

/// Marks the depth of a sample where there is nothing.
pub(super) const NOTHING: f32 = f32::NEG_INFINITY;

/// Both values are worked out and one is taken. Never `if`: where a condition is used twice it becomes
/// a branch, and a loop with a branch is no vector instruction.
#[inline(always)]
pub(super) fn select<T>(condition: bool, then: T, otherwise: T) -> T {
    std::hint::select_unpredictable(condition, then, otherwise)
}

/// The lesser of two numbers, neither NaN.
#[inline(always)]
pub(super) fn lesser(a: f32, b: f32) -> f32 {
    select(a < b, a, b)
}

/// The greater of two numbers, neither NaN.
#[inline(always)]
pub(super) fn greater(a: f32, b: f32) -> f32 {
    select(a > b, a, b)
}

/// Numbers below 32, a bit each, from the least on: in place of a range around loops over lanes, or compilers would go along the
/// range in vector instructions, and pick their numbers together, in place of along the lanes.
pub(super) struct OneByOne(u32);

impl OneByOne {
    /// Those of a range.
    #[inline(always)]
    pub(super) fn of(range: &Range<usize>) -> Self {
        Self((1_u32 << range.end) - (1 << range.start))
    }

    /// Those whose bits are set.
    #[inline(always)]
    pub(super) fn of_bits(bits: u32) -> Self {
        Self(bits)
    }
}

impl Iterator for OneByOne {
    type Item = usize;

    #[inline(always)]
    fn next(&mut self) -> Option<usize> {
        if self.0 == 0 {
            return None;
        }
        let number = self.0.trailing_zeros() as usize;
        self.0 &= self.0 - 1;
        Some(number)
    }
}

/// What begins with a line of the cache. Lists of cells that lie anywhere have half of these in two lines; and processors take what two such
/// lists have at one place for the same memory, where these begin a multiple of 4096 bytes apart but for less than a cell.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(align(64))]
pub(super) struct Aligned<T>(pub(super) T);

impl<T> Deref for Aligned<T> {
    type Target = T;

    #[inline(always)]
    fn deref(&self) -> &T {
        &self.0
    }
}

impl<T> DerefMut for Aligned<T> {
    #[inline(always)]
    fn deref_mut(&mut self) -> &mut T {
        &mut self.0
    }
}

/// A number for each sample of a tile that stands for something.
pub(super) type IdPlane = Box<Aligned<[[u32; LANES]; CELLS]>>;

pub(super) fn id_plane() -> IdPlane {
    Box::new(Aligned([[0; LANES]; CELLS]))
}

/// Takes on the new values where `mask` is set.
#[inline(always)]
pub(super) fn overwrite(old: &mut Lanes, new: &Lanes, mask: &LaneMask) {
    let mut lanes = *old; // a store for each lane might become a branch
    for k in 0..LANES {
        lanes[k] = select(mask[k] != 0, new[k], old[k]);
    }
    *old = lanes;
}

/// The same for numbers that stand for something.
#[inline(always)]
pub(super) fn put(old: &mut [u32; LANES], new: &[u32; LANES], mask: &LaneMask) {
    let mut lanes = *old;
    for k in 0..LANES {
        lanes[k] = select(mask[k] != 0, new[k], old[k]);
    }
    *old = lanes;
}

/// Samples that lie one below the other, in one pixel or in several.
#[derive(Clone, Debug)]
pub(super) struct Stack {
    /// The samples' places for each lane of a cell, from the cell's upper left corner, in pixels.
    pub(super) x: Lanes,
    pub(super) y: Lanes,
    /// The least and the greatest of the places across, and of those down.
    pub(super) ends: [[f32; 2]; 2],
    /// For each lane the middle of those of its pixel's samples that look pictures up together.
    pub(super) middle: [Lanes; 2],
    /// How many samples of its pixels come before its own.
    pub(super) first: usize,
    /// Pixels one below the other that it holds samples of: 1, 2, 4 or 8.
    pub(super) height: usize,
    /// How many lanes one after the other are a pixel's.
    pub(super) of_pixel: usize,
    /// How many of a pixel's lanes count. Those behind are the pixel's first one again, so that they hide and are hidden as it is.
    pub(super) samples: usize,
}

impl Stack {
    /// The stacks that make up a pixel's samples, given from the pixel's corner, or those of several pixels.
    pub(super) fn of_pixel(samples: &[Vec2]) -> Vec<Self> {
        let of_pixel = samples.len().next_power_of_two().min(STACK);
        let height = STACK / of_pixel;
        let stack = |(number, samples): (usize, &[Vec2])| {
            let pixel = |k: usize| Vec2::new((k / STACK) as f32, (k % STACK / of_pixel) as f32);
            let middle = |k: usize| {
                let together = together(of_pixel);
                let number = k % of_pixel / together;
                let own = samples
                    .chunks(together)
                    .nth(number)
                    .unwrap_or(&samples[..1]);
                own.iter().sum::<Vec2>() / own.len() as f32 + pixel(k)
            };
            let place = |k: usize| *samples.get(k % of_pixel).unwrap_or(&samples[0]) + pixel(k);
            let x: Lanes = std::array::from_fn(|k| place(k).x);
            let y: Lanes = std::array::from_fn(|k| place(k).y);
            let ends = |places: Lanes| {
                let greatest = places.into_iter().fold(f32::NEG_INFINITY, f32::max);
                [places.into_iter().fold(f32::INFINITY, f32::min), greatest]
            };
            Self {
                x,
                y,
                ends: [ends(x), ends(y)],
                middle: [
                    std::array::from_fn(|k| middle(k).x),
                    std::array::from_fn(|k| middle(k).y),
                ],
                first: number * STACK,
                height,
                of_pixel,
                samples: samples.len(),
            }
        };
        samples.chunks(of_pixel).enumerate().map(stack).collect()
    }

    /// How many lanes one after the other look pictures up together.
    #[inline(always)]
    pub(super) fn together(&self) -> usize {
        together(self.of_pixel)
    }

    /// The rows of stacks that hold some rows of pixels.
    #[inline(always)]
    pub(super) fn rows(&self, pixels: Range<usize>) -> Range<usize> {
        let shift = self.height.trailing_zeros(); // of a power of 2
        pixels.start >> shift..(pixels.end + self.height - 1) >> shift
    }
}

/// How many samples, of so many of a pixel, look pictures up together: four at most, as on graphics cards.
#[inline(always)]
fn together(of_pixel: usize) -> usize {
    of_pixel.min(4)
}

/// Height of a tile in pixels, made of such stacks.
pub(super) fn height(stacks: &[Stack]) -> usize {
    ROWS * stacks[0].height
}

/// One number of each sample. Of fixed length, so that a cell's index is checked once for all planes.
pub(super) type Plane = Box<Aligned<[Lanes; CELLS]>>;

pub(super) fn plane() -> Plane {
    Box::new(Aligned([[0.0; LANES]; CELLS]))
}

/// Samples of a tile.
pub(super) const SAMPLES: usize = CELLS * LANES;

/// Rows of samples in a tile: for each row of stacks those of a stack's samples.
const SAMPLE_ROWS: usize = ROWS * STACK;

/// Some of a tile's samples: a word for each row of samples, in it a bit for each column.
pub(super) type Mask = Aligned<[u32; SAMPLE_ROWS]>;

const _: () = assert!(WIDTH == u32::BITS as usize);

/// No samples at all.
pub(super) const NO_SAMPLES: Mask = Aligned([0; SAMPLE_ROWS]);

/// The bits of a row's first cell.
const CELL_BITS: u32 = (1 << CELL_WIDTH) - 1;

/// The samples of both.
#[inline(always)]
pub(super) fn both(a: &Mask, b: &Mask) -> Mask {
    let mut both = *a;
    for row in 0..SAMPLE_ROWS {
        both[row] &= b[row];
    }
    both
}

/// Those of `a` that `b` doesn't have.
#[inline(always)]
pub(super) fn without(a: &Mask, b: &Mask) -> Mask {
    let mut rest = *a;
    for row in 0..SAMPLE_ROWS {
        rest[row] &= !b[row];
    }
    rest
}

/// Adds samples to some.
#[inline(always)]
pub(super) fn add(samples: &mut Mask, others: &Mask) {
    for row in 0..SAMPLE_ROWS {
        samples[row] |= others[row];
    }
}

#[inline(always)]
pub(super) fn is_empty(mask: &Mask) -> bool {
    let mut any = 0;
    for row in 0..SAMPLE_ROWS {
        any |= mask[row];
    }
    any == 0
}

/// The columns of a row of stacks in which a sample is set.
#[inline(always)]
pub(super) fn columns(mask: &Mask, row: usize) -> u32 {
    let words = words(mask, row);
    let mut columns = 0;
    for k in 0..STACK {
        columns |= words[k];
    }
    columns
}

/// The words of a row of stacks.
#[inline(always)]
fn words(mask: &Mask, row: usize) -> [u32; STACK] {
    let mut words = [0; STACK];
    words.copy_from_slice(&mask[row * STACK..][..STACK]);
    words
}

/// Two stacks of a row.
#[derive(Clone, Copy)]
pub(super) struct Cell {
    /// Its index in every plane.
    pub(super) index: usize,
    /// Row of stacks.
    pub(super) row: usize,
    /// Column of its left stack.
    pub(super) column: usize,
}

impl Cell {
    #[inline(always)]
    pub(super) fn new(row: usize, column: usize) -> Self {
        Self {
            index: row * CELLS_ACROSS + column / CELL_WIDTH,
            row,
            column,
        }
    }

    /// The cell of that index.
    #[inline(always)]
    pub(super) fn of_index(index: usize) -> Self {
        Self::in_row(index / CELLS_ACROSS, index % CELLS_ACROSS)
    }

    /// The cell of that number in a row.
    #[inline(always)]
    pub(super) fn in_row(row: usize, number: usize) -> Self {
        Self {
            index: row * CELLS_ACROSS + number,
            row,
            column: number * CELL_WIDTH,
        }
    }

    /// Its columns, a bit for each.
    #[inline(always)]
    pub(super) fn columns(&self) -> u32 {
        CELL_BITS << self.column
    }

    /// Its samples of a mask.
    #[inline(always)]
    pub(super) fn lanes(&self, mask: &Mask) -> LaneMask {
        let words = words(mask, self.row);
        let mut lanes = [0; LANES];
        for k in 0..LANES {
            // The sign bit is the column's.
            let bit = words[k % STACK] << (WIDTH - 1 - self.column - k / STACK);
            lanes[k] = ((bit as i32) >> (WIDTH - 1)) as u32;
        }
        lanes
    }

    /// Takes some of its samples from a mask.
    #[inline(always)]
    pub(super) fn take_from(&self, mask: &mut Mask, lanes: &LaneMask) {
        let words = &mut mask[self.row * STACK..][..STACK];
        for k in 0..STACK {
            words[k] &= !(columns_of(lanes, k) << self.column);
        }
    }

    /// Takes one of its samples from a mask.
    #[inline(always)]
    pub(super) fn take_lane_from(&self, mask: &mut Mask, lane: usize) {
        let column = self.column + lane / STACK;
        mask[self.row * STACK + lane % STACK] &= !(1 << column);
    }

    /// Adds some of its samples to a mask.
    #[inline(always)]
    pub(super) fn add_to(&self, mask: &mut Mask, lanes: &LaneMask) {
        let words = &mut mask[self.row * STACK..][..STACK];
        for k in 0..STACK {
            words[k] |= columns_of(lanes, k) << self.column;
        }
    }
}

/// The columns of a cell in which samples of that number in their stack are set, from its left one on.
#[inline(always)]
fn columns_of(lanes: &LaneMask, sample: usize) -> u32 {
    let mut columns = 0;
    for k in 0..CELL_WIDTH {
        columns |= lanes[sample + k * STACK] & 1 << k;
    }
    columns
}

/// The columns of those cells of a row whose bits are all set.
#[inline(always)]
pub(super) fn columns_of_cells(cells: &[u32; CELLS_ACROSS]) -> u32 {
    let mut columns = 0;
    for k in 0..CELLS_ACROSS {
        columns |= cells[k] & CELL_BITS << (k * CELL_WIDTH);
    }
    columns
}

/// The cells of a row of stacks that hold one of some columns.
///
/// An iterator of its own, because closures are not sure to be compiled for their caller's
/// instruction set.
pub(super) struct Cells {
    row: usize,
    left: u32,
}

#[inline(always)]
pub(super) fn cells(row: usize, columns: u32) -> Cells {
    Cells { row, left: columns }
}

impl Iterator for Cells {
    type Item = Cell;

    #[inline(always)]
    fn next(&mut self) -> Option<Cell> {
        if self.left == 0 {
            return None;
        }
        let column = self.left.trailing_zeros() as usize / CELL_WIDTH * CELL_WIDTH;
        self.left &= !(CELL_BITS << column);
        Some(Cell::new(self.row, column))
    }
}

/// What each sample shows so far.
pub(super) struct Target {
    /// Nearest surface, 1/m.
    pub(super) surface: Plane,
    /// That surface's [`margin_m`](crate::Surface::margin_m).
    pub(super) margin: Plane,
    /// Nearest strand that no surface hides, 1/m.
    pub(super) strand: Plane,
    /// What decides there among equals: the higher one lies on top.
    priority: IdPlane,
    pub(super) color: [Plane; 3],
    /// For each cell the farthest of `strand`.
    farthest_strand: Box<Aligned<[f32; CELLS]>>,
    /// For each cell the farthest of `surface`; once these are finished [`NOTHING`] beside surfaces of their own margin,
    /// which don't count then.
    pub(super) farthest_surface: Box<Aligned<[f32; CELLS]>>,
    /// Whether any of `margin` may be other than 0.
    pub(super) has_margins: bool,
    /// The samples that show outlines, strokes of negative rank, where somebody asks.
    pub(super) outlines: Option<Box<Mask>>,
}

impl Target {
    pub(super) fn new() -> Self {
        Self {
            surface: plane(),
            margin: plane(),
            strand: plane(),
            priority: id_plane(),
            color: [plane(), plane(), plane()],
            farthest_strand: Box::new(Aligned([NOTHING; CELLS])),
            farthest_surface: Box::new(Aligned([NOTHING; CELLS])),
            has_margins: false,
            outlines: None,
        }
    }

    /// Keeps from now on which samples show outlines, or no more.
    pub(super) fn keep_outlines(&mut self, keeps: bool) {
        if keeps != self.outlines.is_some() {
            self.outlines = keeps.then(|| Box::new(NO_SAMPLES));
        }
    }

    #[inline(always)]
    pub(super) fn clear(&mut self, background: Option<[f32; 3]>) {
        let background = background.unwrap_or_default();
        if self.has_margins {
            self.margin.fill([0.0; LANES]);
            self.has_margins = false;
        }
        for cell in 0..CELLS {
            self.surface[cell] = [NOTHING; LANES];
            self.strand[cell] = [NOTHING; LANES];
            self.priority[cell] = [0; LANES];
            for (plane, value) in self.color.iter_mut().zip(background) {
                plane[cell] = [value; LANES];
            }
        }
        self.farthest_strand.fill(NOTHING);
        self.farthest_surface.fill(NOTHING);
        if let Some(outlines) = &mut self.outlines {
            **outlines = NO_SAMPLES;
        }
    }

    /// Some samples show a stroke: an outline or another. Nobody may ask.
    #[inline(always)]
    pub(super) fn show_stroke(&mut self, samples: &Mask, is_outline: bool) {
        if let Some(outlines) = &mut self.outlines {
            if is_outline {
                add(outlines, samples);
            } else {
                **outlines = without(outlines, samples);
            }
        }
    }

    /// The farthest surface that any sample shows, 1/m, while surfaces are drawn.
    #[inline(always)]
    pub(super) fn farthest_surface(&self) -> f32 {
        let mut farthest = [f32::INFINITY; LANES];
        for cells in self.farthest_surface.chunks_exact(LANES) {
            for k in 0..LANES {
                farthest[k] = lesser(cells[k], farthest[k]);
            }
        }
        least(&farthest)
    }

    /// To be called when all surfaces have been drawn.
    #[inline(always)]
    pub(super) fn finish_surfaces(&mut self) {
        if !self.has_margins {
            return; // they are as they shall be
        }
        for (cell, farthest) in self.farthest_surface.iter_mut().enumerate() {
            let (surface, margin) = (self.surface[cell], self.margin[cell]);
            let mut solid = surface;
            for k in 0..LANES {
                solid[k] = select(margin[k] != 0.0, NOTHING, surface[k]);
            }
            *farthest = least(&solid);
        }
    }

    /// The strand that samples of a cell show which show hair, where strokes aren't [`Shifted`](crate::Order::Shifted).
    #[inline(always)]
    pub(super) fn strands(&self, cell: usize) -> [u32; LANES] {
        let mut strands = self.priority[cell];
        for k in 0..LANES {
            strands[k] = u32::MAX - strands[k];
        }
        strands
    }

    /// Makes of colours what a sample adds to a pixel's light, and of the surfaces' depths what it adds to its alpha.
    /// Loops of their own, as one with the sums would be no vector instructions.
    #[inline(always)]
    fn finish(&mut self, stack: &Stack, is_opaque: bool) {
        for plane in &mut self.color {
            for value in plane.as_flattened_mut() {
                *value = lesser(greater(*value, 0.0), 1.0);
            }
        }
        let surface = self.surface.as_flattened_mut();
        for (surface, strand) in surface.iter_mut().zip(self.strand.as_flattened()) {
            let shows = is_opaque | (greater(*surface, *strand) > NOTHING);
            *surface = select(shows, 1.0, 0.0);
        }
        if stack.samples < stack.of_pixel {
            for plane in self.color.iter_mut().chain([&mut self.surface]) {
                for lanes in plane.iter_mut() {
                    for k in 0..LANES {
                        lanes[k] = select(k % stack.of_pixel < stack.samples, lanes[k], 0.0);
                    }
                }
            }
        }
    }

    /// Copies what its samples add to light, once they are [summed up](Sums::add).
    pub(super) fn copy_colors(&self, colors: &mut Colors) {
        for (copy, plane) in colors.iter_mut().zip(&self.color) {
            copy.copy_from_slice(&plane[..]);
        }
    }

    /// Notes which samples show anything, once they are summed up.
    pub(super) fn copy_shows(&self, shows: &mut Shows) {
        for (bits, alpha) in shows.0.iter_mut().zip(self.surface.iter()) {
            *bits = 0;
            for (k, alpha) in alpha.iter().enumerate() {
                *bits |= u16::from(*alpha != 0.0) << k;
            }
        }
    }

    /// The columns of a row of stacks whose cells don't hide all that is as far as the given inverse depths.
    #[inline(always)]
    pub(super) fn open(&self, row: usize, inv_depth: f32, biased: f32) -> u32 {
        let mut strand = [0.0; CELLS_ACROSS];
        strand.copy_from_slice(&self.farthest_strand[row * CELLS_ACROSS..][..CELLS_ACROSS]);
        let mut surface = [0.0; CELLS_ACROSS];
        surface.copy_from_slice(&self.farthest_surface[row * CELLS_ACROSS..][..CELLS_ACROSS]);
        let mut open = [0; CELLS_ACROSS];
        for k in 0..CELLS_ACROSS {
            let is_hidden = (strand[k] > inv_depth) | (surface[k] > biased);
            open[k] = select(is_hidden, 0, u32::MAX);
        }
        columns_of_cells(&open)
    }

    /// Takes from the open columns of all rows those whose cells hide all that is as far as the given inverse depths.
    #[inline(always)]
    pub(super) fn close(&self, open: &mut [u32; ROWS], [inv_depth, biased]: [f32; 2]) {
        for row in 0..ROWS {
            if open[row] != 0 {
                open[row] &= self.open(row, inv_depth, biased);
            }
        }
    }

    /// Those of the samples of a cell where a strand may show that is no nearer than this.
    #[inline(always)]
    pub(super) fn may_show(
        &self,
        cell: Cell,
        samples: &LaneMask,
        depth: f32,
        biased: f32,
    ) -> LaneMask {
        let (surface, margin) = (&self.surface[cell.index], &self.margin[cell.index]);
        let nearest = &self.strand[cell.index];
        let mut may = *samples;
        for k in 0..LANES {
            // A margin counts from the depth, which may yet change either way.
            let is_before = (margin[k] != 0.0) | (surface[k] <= biased);
            may[k] &= select(is_before & (depth >= nearest[k]), u32::MAX, 0);
        }
        may
    }

    /// Offers a strand to some samples of a cell: it shows where it lies behind no surface, and is
    /// nearer than the strands before it, or as near but of higher priority. Returns the
    /// samples where it does; their colour is the caller's to set.
    #[inline(always)]
    pub(super) fn offer(
        &mut self,
        cell: Cell,
        samples: &LaneMask,
        depths: &Depths,
        priority: u32,
    ) -> LaneMask {
        let Depths {
            inv_depth: depth,
            biased,
        } = depths;
        let (surface, margin) = (self.surface[cell.index], self.margin[cell.index]);
        let mut nearest = self.strand[cell.index];
        let mut top = self.priority[cell.index];
        let mut wins = *samples;
        for k in 0..LANES {
            let before_wall = depth[k] / (1.0 + margin[k] * depth[k]);
            let against = select(margin[k] != 0.0, before_wall, biased[k]);
            let is_better =
                (depth[k] > nearest[k]) | ((depth[k] == nearest[k]) & (priority > top[k]));
            let is_shown = (samples[k] != 0) & (surface[k] <= against) & is_better;
            nearest[k] = select(is_shown, depth[k], nearest[k]);
            top[k] = select(is_shown, priority, top[k]);
            wins[k] = select(is_shown, u32::MAX, 0);
        }
        self.strand[cell.index] = nearest;
        self.priority[cell.index] = top;
        self.farthest_strand[cell.index] = least(&nearest);
        wins
    }
}

/// Whether a lane is set.
#[inline(always)]
pub(super) fn any(lanes: &LaneMask) -> bool {
    let mut any = 0;
    for k in 0..LANES {
        any |= lanes[k];
    }
    any != 0
}

/// A bit for each lane that is set.
#[inline(always)]
pub(super) fn bits(lanes: &LaneMask) -> u32 {
    let mut bits = 0;
    for k in 0..LANES {
        bits |= lanes[k] & 1 << k;
    }
    bits
}

/// The lanes whose bits are set.
#[inline(always)]
pub(super) fn lanes(bits: u32) -> LaneMask {
    let mut lanes = [0; LANES];
    for k in 0..LANES {
        lanes[k] = select(bits >> k & 1 != 0, u32::MAX, 0);
    }
    lanes
}

/// The least of a cell's numbers.
#[inline(always)]
pub(super) fn least(lanes: &Lanes) -> f32 {
    let mut least = *lanes;
    let mut half = LANES / 2;
    while half > 0 {
        for k in 0..half {
            least[k] = select(least[k] < least[k + half], least[k], least[k + half]);
        }
        half /= 2;
    }
    least[0]
}

/// A pixel of so many samples that nothing covers.
pub(super) fn empty_pixel(background: Option<[f32; 3]>, samples: usize) -> [f32; 4] {
    let Some([red, green, blue]) = background else {
        return [0.0; 4];
    };
    // As in `Sums`, so that a pixel is the same beside strokes and far from them.
    [red, green, blue, 1.0].map(|value| {
        let value = value.clamp(0.0, 1.0);
        (0..samples).fold(0.0, |sum, _| sum + value) / samples as f32
    })
}

/// The sums over the samples of a tile's pixels, row by row: of red, green, blue and alpha.
pub(super) struct Sums([Vec<[f32; WIDTH]>; 4]);

impl Sums {
    pub(super) fn new() -> Self {
        Self([const { Vec::new() }; 4])
    }

    /// Forgets them; a tile is then so many pixels high.
    #[inline(always)]
    pub(super) fn clear(&mut self, height: usize) {
        for rows in &mut self.0 {
            rows.clear();
            rows.resize(height, [0.0; WIDTH]);
        }
    }

    /// Adds the samples of the target, which are such stacks. Light beyond 0..1 counts as 0 or 1.
    #[inline(always)]
    pub(super) fn add(&mut self, target: &mut Target, stack: &Stack, is_opaque: bool) {
        target.finish(stack, is_opaque);
        match stack.height {
            1 => self.add_pixels::<1>(target),
            2 => self.add_pixels::<2>(target),
            4 => self.add_pixels::<4>(target),
            _ => self.add_pixels::<8>(target),
        }
    }

    /// The same, of finished stacks of that many pixels.
    #[inline(always)]
    fn add_pixels<const HEIGHT: usize>(&mut self, target: &Target) {
        let of_pixel = STACK / HEIGHT;
        let [red, green, blue] = &target.color;
        for (rows, light) in self.0.iter_mut().zip([red, green, blue, &target.surface]) {
            let (light, _) = light.as_flattened().as_chunks::<{ WIDTH * STACK }>();
            for (sums, light) in rows.chunks_exact_mut(HEIGHT).zip(light) {
                for (below, sums) in sums.iter_mut().enumerate() {
                    for column in 0..WIDTH {
                        let first = column * STACK + below * of_pixel;
                        let mut sum = sums[column];
                        for k in 0..of_pixel {
                            sum += light[first + k];
                        }
                        sums[column] = sum;
                    }
                }
            }
        }
    }

    /// The means, as the pixels of one row.
    #[inline(always)]
    pub(super) fn write(&self, row: usize, samples: usize, pixels: &mut [[f32; 4]]) {
        let count = samples as f32;
        let [red, green, blue, alpha] = self.0.each_ref().map(|rows| &rows[row]);
        for (column, pixel) in pixels.iter_mut().enumerate().take(WIDTH) {
            let sums = [red[column], green[column], blue[column], alpha[column]];
            for channel in 0..4 {
                pixel[channel] = sums[channel] / count;
            }
        }
    }
}

/// A value that runs linearly over the screen, seen from a tile.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Slope {
    /// At the tile's upper left corner.
    pub(super) corner: f32,
    pub(super) per_x: f32,
    pub(super) per_y: f32,
}

/// A [`Slope`] at a tile's samples.
#[derive(Clone, Copy)]
#[repr(align(32))] // as [`Aligned`] cells are
pub(super) struct Samples {
    /// At the lanes of the tile's first cell.
    first: Lanes,
    per_column: f32,
    per_row: f32,
}

impl Slope {
    #[inline(always)]
    pub(super) fn at_samples(&self, stack: &Stack) -> Samples {
        let (x, y) = (&stack.x, &stack.y);
        let mut first = [self.corner; LANES];
        for k in 0..LANES {
            first[k] += x[k] * self.per_x + y[k] * self.per_y;
        }
        Samples {
            first,
            per_column: self.per_x,
            per_row: self.per_y * stack.height as f32,
        }
    }
}

impl Samples {
    /// At the samples of a cell.
    #[inline(always)]
    pub(super) fn of(&self, cell: Cell) -> Lanes {
        let step = number(cell.column) * self.per_column + number(cell.row) * self.per_row;
        self.and(step)
    }

    /// At some lanes of cells that are so far from the tile's first one.
    #[inline(always)]
    pub(super) fn at(&self, lanes: &[u32; LANES], across: &Lanes, down: &Lanes) -> Lanes {
        let mut own = [0.0; LANES];
        for k in 0..LANES {
            let step = across[k] * self.per_column + down[k] * self.per_row;
            own[k] = self.first[lanes[k] as usize % LANES] + step;
        }
        own
    }

    /// At those of a cell where it is so much more than in the tile's first one.
    #[inline(always)]
    pub(super) fn and(&self, step: f32) -> Lanes {
        let mut lanes = self.first;
        for k in 0..LANES {
            lanes[k] += step;
        }
        lanes
    }
}

/// A row or a column. By way of small numbers, as those of 64 bits take a branch.
#[inline(always)]
pub(super) fn number(place: usize) -> f32 {
    f32::from(place as u16)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::samples::sample_positions;

    #[test]
    fn stacks_hold_every_sample_of_their_pixels_once() {
        for samples in [1, 2, 3, 4, 5, 8, 9, 16, 64] {
            let positions = sample_positions(samples).unwrap();
            let stacks = Stack::of_pixel(&positions);
            let Stack {
                height, of_pixel, ..
            } = stacks[0];
            assert_eq!(height * of_pixel, STACK);
            let mut held = Vec::new();
            for stack in &stacks {
                assert_eq!([stack.height, stack.of_pixel], [height, of_pixel]);
                let place = |lane: usize| Vec2::new(stack.x[lane], stack.y[lane]);
                assert_eq!(stack.first, held.len());
                held.extend((0..stack.samples).map(place));
                for k in 0..LANES {
                    let pixel = Vec2::new((k / STACK) as f32, (k % STACK / of_pixel) as f32);
                    // Those that don't count are the pixel's first one.
                    let sample = Some(k % of_pixel).filter(|sample| *sample < stack.samples);
                    assert_eq!(
                        place(k),
                        place(sample.unwrap_or(0)) + pixel,
                        "{samples}, {k}"
                    );
                }
            }
            assert_eq!(held, positions, "{samples} samples");
        }
    }

    #[test]
    fn pictures_are_looked_up_in_the_middle_of_four_samples_at_most() {
        for samples in [1, 3, 4, 5, 8, 16] {
            let positions = sample_positions(samples).unwrap();
            for stack in Stack::of_pixel(&positions) {
                let own = &positions[stack.first..][..stack.samples];
                for (number, four) in own.chunks(4).enumerate() {
                    let middle = four.iter().sum::<Vec2>() / four.len() as f32;
                    let below = Vec2::new(1.0, (stack.height - 1) as f32);
                    let last = LANES - stack.of_pixel + 4 * number;
                    let found = Vec2::new(stack.middle[0][last], stack.middle[1][last]);
                    assert_eq!(found, middle + below, "{samples} samples");
                }
            }
        }
    }

    #[test]
    fn a_cell_has_the_samples_of_two_columns() {
        let mut mask = NO_SAMPLES;
        mask[3 * STACK] = 1 << 6;
        mask[3 * STACK + 5] = 1 << 7 | 1 << 31;
        let found: Vec<Cell> = cells(3, columns(&mask, 3)).collect();
        assert_eq!(found.iter().map(|c| c.column).collect::<Vec<_>>(), [6, 30]);
        // The left column's samples, and the right one's.
        assert_eq!(found[0].lanes(&mask), lanes(1 | 1 << (STACK + 5)));
        assert_eq!(found[1].lanes(&mask), lanes(1 << (STACK + 5)));
        assert_eq!(lanes(1 << 3)[3], u32::MAX);
        let mut copy = NO_SAMPLES;
        for cell in found {
            cell.add_to(&mut copy, &cell.lanes(&mask));
        }
        assert_eq!(copy, mask);
    }
}
