//! A tile: the samples of a few pixels, as planes of numbers that vector instructions walk along.
//!
//! A plane holds one number of each sample of the tile: for each sample of a pixel a block of rows,
//! for each row its pixels in chunks of [`LANES`] neighbours. So a chunk is one sample position in
//! eight neighbouring pixels, and every loop over a chunk's lanes compiles to vector instructions.

use glam::Vec2;

/// Width of a tile in pixels.
pub(super) const WIDTH: usize = 32;
/// Height of a tile in pixels.
pub(super) const HEIGHT: usize = 16;
/// Pixels in a chunk.
pub(super) const LANES: usize = 8;
/// Most samples of a pixel that are worked on at once: keeps a tile in a core's own cache.
pub(super) const GROUP: usize = 4;

const CHUNKS: usize = WIDTH / LANES;
const CELLS: usize = GROUP * HEIGHT * CHUNKS;

/// One number of each pixel of a chunk.
pub(super) type Lanes = [f32; LANES];

/// 0, 1, 2 .. : the places of a chunk's lanes.
pub(super) const LANE: Lanes = {
    let mut lanes = [0.0; LANES];
    let mut k = 0;
    while k < LANES {
        lanes[k] = k as f32;
        k += 1;
    }
    lanes
};

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

/// Takes on the new values where `mask` is not 0.
#[inline(always)]
pub(super) fn overwrite(old: &mut Lanes, new: &Lanes, mask: &Lanes) {
    for k in 0..LANES {
        old[k] = select(mask[k] != 0.0, new[k], old[k]);
    }
}

/// One number of each sample.
pub(super) type Plane = Vec<Lanes>;

pub(super) fn plane() -> Plane {
    vec![[0.0; LANES]; CELLS]
}

/// Rows of samples in a tile: for each sample of a pixel the tile's rows.
pub(super) const ROWS: usize = GROUP * HEIGHT;

/// Some of a tile's samples: a word for each row of samples, in it a bit for each column.
pub(super) type Mask = [u32; ROWS];

const _: () = assert!(WIDTH == u32::BITS as usize);

/// No samples at all.
pub(super) const NO_SAMPLES: Mask = [0; ROWS];

/// The bits of the first chunk of a row.
const CHUNK: u32 = (1 << LANES) - 1;

/// Whether a lane's bit is set.
#[inline(always)]
pub(super) fn has(bits: u32, lane: usize) -> bool {
    bits & (1 << lane) != 0
}

/// Where the chunks of a row of samples lie in a plane.
#[inline(always)]
pub(super) fn row_start(row: usize) -> usize {
    row * CHUNKS
}

/// The samples of both.
#[inline(always)]
pub(super) fn both(a: &Mask, b: &Mask) -> Mask {
    let mut both = *a;
    for row in 0..ROWS {
        both[row] &= b[row];
    }
    both
}

/// Those of `a` that `b` doesn't have.
#[inline(always)]
pub(super) fn without(a: &Mask, b: &Mask) -> Mask {
    let mut rest = *a;
    for row in 0..ROWS {
        rest[row] &= !b[row];
    }
    rest
}

#[inline(always)]
pub(super) fn is_empty(mask: &Mask) -> bool {
    let mut any = 0;
    for row in 0..ROWS {
        any |= mask[row];
    }
    any == 0
}

/// A chunk of a row of samples, and some of its samples.
#[derive(Clone, Copy)]
pub(super) struct Cell {
    /// Index of the chunk in every plane.
    pub(super) index: usize,
    /// Row of samples.
    pub(super) row: usize,
    /// Column of its first lane.
    pub(super) column: usize,
    /// A bit for each lane.
    pub(super) bits: u32,
}

/// All chunks that hold one of some samples.
///
/// An iterator of its own, because closures are not sure to be compiled for their caller's
/// instruction set.
pub(super) struct Cells<'a> {
    mask: &'a Mask,
    row: usize,
    left: u32,
}

#[inline(always)]
pub(super) fn cells(mask: &Mask) -> Cells<'_> {
    Cells {
        mask,
        row: 0,
        left: mask[0],
    }
}

impl Iterator for Cells<'_> {
    type Item = Cell;

    #[inline(always)]
    fn next(&mut self) -> Option<Cell> {
        while self.left == 0 {
            self.row += 1;
            // Eight rows without samples are left behind at once.
            while self.row.is_multiple_of(LANES) {
                let rows = self.mask.get(self.row..self.row + LANES)?;
                let mut any = 0;
                for k in 0..LANES {
                    any |= rows[k];
                }
                if any != 0 {
                    break;
                }
                self.row += LANES;
            }
            self.left = self.mask[self.row];
        }
        let chunk = self.left.trailing_zeros() as usize / LANES;
        let column = chunk * LANES;
        let bits = self.left >> column & CHUNK;
        self.left &= !(CHUNK << column);
        Some(Cell {
            index: row_start(self.row) + chunk,
            row: self.row,
            column,
            bits,
        })
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
    pub(super) priority: Vec<[u32; LANES]>,
    pub(super) color: [Plane; 3],
    /// For each cell the farthest of `strand`.
    farthest_strand: Box<[f32; CELLS]>,
    /// For each cell the farthest of `surface`; once these are finished [`NOTHING`] beside surfaces of their own margin,
    /// which don't count then.
    pub(super) farthest_surface: Box<[f32; CELLS]>,
}

impl Target {
    pub(super) fn new() -> Self {
        Self {
            surface: plane(),
            margin: plane(),
            strand: plane(),
            priority: vec![[0; LANES]; CELLS],
            color: [plane(), plane(), plane()],
            farthest_strand: Box::new([NOTHING; CELLS]),
            farthest_surface: Box::new([NOTHING; CELLS]),
        }
    }

    /// Forgets the first `samples` samples of each pixel.
    #[inline(always)]
    pub(super) fn clear(&mut self, samples: usize, background: Option<[f32; 3]>) {
        let cells = ..row_start(samples * HEIGHT);
        self.surface[cells].fill([NOTHING; LANES]);
        self.margin[cells].fill([0.0; LANES]);
        self.strand[cells].fill([NOTHING; LANES]);
        self.priority[cells].fill([0; LANES]);
        for (plane, value) in self.color.iter_mut().zip(background.unwrap_or_default()) {
            plane[cells].fill([value; LANES]);
        }
        self.farthest_strand[cells].fill(NOTHING);
        self.farthest_surface[cells].fill(NOTHING);
    }

    /// To be called when all surfaces have been drawn.
    #[inline(always)]
    pub(super) fn finish_surfaces(&mut self) {
        for (cell, farthest) in self.farthest_surface.iter_mut().enumerate() {
            let (surface, margin) = (self.surface[cell], self.margin[cell]);
            let mut solid = surface;
            for k in 0..LANES {
                solid[k] = select(margin[k] != 0.0, NOTHING, surface[k]);
            }
            *farthest = least(&solid);
        }
    }

    /// The chunks of a row of samples that don't hide all that is as far as the given inverse depths,
    /// with all their bits.
    #[inline(always)]
    pub(super) fn open(&self, row: usize, inv_depth: f32, biased: f32) -> u32 {
        let chunks = row_start(row)..row_start(row + 1);
        let strand = &self.farthest_strand[chunks.clone()];
        let surface = &self.farthest_surface[chunks];
        let mut open = 0;
        for (chunk, (strand, surface)) in strand.iter().zip(surface).enumerate() {
            let is_hidden = (*strand > inv_depth) | (*surface > biased);
            open |= select(is_hidden, 0, CHUNK << (chunk * LANES));
        }
        open
    }

    /// Those of the samples where a strand may show that is no nearer than what is given for their cell.
    #[inline(always)]
    pub(super) fn before(&self, samples: &Mask, nearest: impl Fn(Cell) -> (Lanes, Lanes)) -> Mask {
        let mut before = NO_SAMPLES;
        for cell in cells(samples) {
            let (depth, biased) = nearest(cell);
            before[cell.row] |= self.may_show(cell, &depth, &biased) << cell.column;
        }
        before
    }

    /// The bits of those samples of a cell where a strand may show that is no nearer than this.
    #[inline(always)]
    pub(super) fn may_show(&self, cell: Cell, depth: &Lanes, biased: &Lanes) -> u32 {
        let (surface, margin) = (&self.surface[cell.index], &self.margin[cell.index]);
        let nearest = &self.strand[cell.index];
        let mut may = [0_u32; LANES];
        for k in 0..LANES {
            // A margin counts from the depth, which may yet change either way.
            let is_before = (margin[k] != 0.0) | (surface[k] <= biased[k]);
            let is_near = has(cell.bits, k) & is_before & (depth[k] >= nearest[k]);
            may[k] = select(is_near, 1 << k, 0);
        }
        let mut bits = 0;
        for bit in may {
            bits |= bit;
        }
        bits
    }

    /// Offers a strand to some samples of a cell: it shows where it lies behind no surface, and is
    /// nearer than the strands before it, or as near but of higher priority. Returns the bits of the
    /// samples where it does; their colour is the caller's to set.
    #[inline(always)]
    pub(super) fn offer(
        &mut self,
        cell: Cell,
        depth: &Lanes,
        biased: &Lanes,
        priority: u32,
    ) -> u32 {
        let (surface, margin) = (self.surface[cell.index], self.margin[cell.index]);
        let mut nearest = self.strand[cell.index];
        let mut top = self.priority[cell.index];
        let mut wins = [0_u32; LANES];
        for k in 0..LANES {
            let before_wall = depth[k] / (1.0 + margin[k] * depth[k]);
            let against = select(margin[k] != 0.0, before_wall, biased[k]);
            let is_better =
                (depth[k] > nearest[k]) | ((depth[k] == nearest[k]) & (priority > top[k]));
            let is_shown = has(cell.bits, k) & (surface[k] <= against) & is_better;
            nearest[k] = select(is_shown, depth[k], nearest[k]);
            top[k] = select(is_shown, priority, top[k]);
            wins[k] = select(is_shown, 1 << k, 0);
        }
        self.strand[cell.index] = nearest;
        self.priority[cell.index] = top;
        self.farthest_strand[cell.index] = least(&nearest);
        let mut bits = 0;
        for win in wins {
            bits |= win;
        }
        bits
    }
}

/// Whether a lane is not 0.
#[inline(always)]
pub(super) fn any(lanes: &[u32; LANES]) -> bool {
    let mut any = 0;
    for k in 0..LANES {
        any |= lanes[k];
    }
    any != 0
}

/// The least of a chunk's numbers.
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

/// The sums over the samples of a tile's pixels: red, green, blue and alpha.
pub(super) struct Sums([Vec<Lanes>; 4]);

impl Sums {
    pub(super) fn new() -> Self {
        Self([(); 4].map(|()| vec![[0.0; LANES]; HEIGHT * CHUNKS]))
    }

    #[inline(always)]
    pub(super) fn clear(&mut self) {
        for plane in &mut self.0 {
            plane.fill([0.0; LANES]);
        }
    }

    /// Adds the first `samples` samples of the target. Light beyond 0..1 counts as 0 or 1.
    #[inline(always)]
    pub(super) fn add(&mut self, target: &Target, samples: usize, is_opaque: bool) {
        let [sums @ .., alpha_sum] = &mut self.0;
        for sample in 0..samples {
            let start = row_start(sample * HEIGHT);
            for (i, cell) in (start..start + HEIGHT * CHUNKS).enumerate() {
                for (sum, color) in sums.iter_mut().zip(&target.color) {
                    let (sum, color) = (&mut sum[i], color[cell]);
                    for k in 0..LANES {
                        let value = select(color[k] > 0.0, color[k], 0.0);
                        sum[k] += select(value < 1.0, value, 1.0);
                    }
                }
                let (surface, strand) = (target.surface[cell], target.strand[cell]);
                let sum = &mut alpha_sum[i];
                for k in 0..LANES {
                    let shows = is_opaque | (surface[k] > NOTHING) | (strand[k] > NOTHING);
                    sum[k] += select(shows, 1.0, 0.0);
                }
            }
        }
    }

    /// The means, as the pixels of one row.
    #[inline(always)]
    pub(super) fn write(&self, row: usize, samples: usize, pixels: &mut [[f32; 4]]) {
        let count = samples as f32;
        for (x, pixel) in pixels.iter_mut().enumerate() {
            let cell = row * CHUNKS + x / LANES;
            *pixel = [0, 1, 2, 3].map(|channel| self.0[channel][cell][x % LANES] / count);
        }
    }
}

/// A value that runs linearly over the screen, seen from a tile.
#[derive(Clone, Copy, Debug)]
pub(super) struct Slope {
    /// At the tile's upper left corner.
    pub(super) corner: f32,
    pub(super) per_x: f32,
    pub(super) per_y: f32,
}

/// A [`Slope`] at the columns of a chunk, whatever the row.
#[derive(Clone, Copy)]
pub(super) struct Columns {
    at_top: Lanes,
    per_y: f32,
}

impl Columns {
    #[inline(always)]
    pub(super) fn at(&self, lane: usize, y: f32) -> f32 {
        self.at_top[lane] + y * self.per_y
    }
}

impl Slope {
    #[inline(always)]
    pub(super) fn along(&self, x: &Lanes) -> Columns {
        let mut at_top = [self.corner; LANES];
        for k in 0..LANES {
            at_top[k] += x[k] * self.per_x;
        }
        Columns {
            at_top,
            per_y: self.per_y,
        }
    }

    /// At the first lane of a chunk that begins at `position`; the others follow in steps of `per_x`.
    #[inline(always)]
    pub(super) fn at(&self, position: Vec2) -> f32 {
        self.corner + position.x * self.per_x + position.y * self.per_y
    }
}
