//! A tile: the samples of a few pixels, as planes of numbers that vector instructions walk along.
//!
//! A plane holds one number of each sample of the tile: for each sample of a pixel a block of rows,
//! for each row its pixels in chunks of [`LANES`] neighbours. So a chunk is one sample position in
//! eight neighbouring pixels, and every loop over a chunk's lanes compiles to vector instructions.

use super::bin::Bounds;
use glam::Vec2;
use std::ops::Range;

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

/// Both values are worked out and one is taken: unlike `if` with a place in memory in a branch, this
/// always compiles to vector instructions.
#[inline]
pub(super) fn select<T>(condition: bool, then: T, otherwise: T) -> T {
    if condition { then } else { otherwise }
}

/// Takes on the new values where `mask` is not 0.
#[inline]
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

/// Where the chunks of a sample's row lie in a plane.
#[inline]
pub(super) fn row_start(sample: usize, row: usize) -> usize {
    (sample * HEIGHT + row) * CHUNKS
}

/// A rectangle of a tile: some rows of some chunks, of each of `samples` samples.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Region {
    samples: usize,
    rows: Range<usize>,
    chunks: Range<usize>,
}

impl Region {
    /// The smallest that holds all of some bounds within a tile.
    pub(super) fn around(bounds: impl Iterator<Item = Bounds>, samples: usize) -> Self {
        let around = bounds.reduce(|a, b| Bounds {
            x: a.x.start.min(b.x.start)..a.x.end.max(b.x.end),
            y: a.y.start.min(b.y.start)..a.y.end.max(b.y.end),
        });
        let Bounds { x, y } = around.unwrap_or(Bounds { x: 0..0, y: 0..0 });
        Self {
            samples,
            rows: y,
            chunks: x.start / LANES..x.end.div_ceil(LANES),
        }
    }

    /// The indices of the region's chunks in every plane, as runs of neighbours.
    pub(super) fn spans(&self) -> impl Iterator<Item = Range<usize>> {
        (0..self.samples).flat_map(move |sample| {
            self.rows.clone().map(move |row| {
                let start = row_start(sample, row);
                start + self.chunks.start..start + self.chunks.end
            })
        })
    }

    pub(super) fn fill(&self, plane: &mut Plane, value: f32) {
        for span in self.spans() {
            plane[span].fill([value; LANES]);
        }
    }
}

/// What each sample shows so far.
pub(super) struct Target {
    /// Nearest surface, 1/m.
    pub(super) surface: Plane,
    /// That surface's [`hollow_m`](crate::Surface::hollow_m).
    pub(super) hollow: Plane,
    /// Nearest strand that no surface hides, 1/m.
    pub(super) strand: Plane,
    /// The stroke there, by its place in the order of strokes.
    pub(super) stroke: Vec<[i32; LANES]>,
    pub(super) color: [Plane; 3],
}

impl Target {
    pub(super) fn new() -> Self {
        Self {
            surface: plane(),
            hollow: plane(),
            strand: plane(),
            stroke: vec![[0; LANES]; CELLS],
            color: [plane(), plane(), plane()],
        }
    }

    pub(super) fn clear(&mut self, background: Option<[f32; 3]>) {
        self.surface.fill([NOTHING; LANES]);
        self.hollow.fill([0.0; LANES]);
        self.strand.fill([NOTHING; LANES]);
        self.stroke.fill([0; LANES]);
        for (plane, value) in self.color.iter_mut().zip(background.unwrap_or_default()) {
            plane.fill([value; LANES]);
        }
    }
}

/// The sums over the samples of a tile's pixels: red, green, blue and alpha.
pub(super) struct Sums([Vec<Lanes>; 4]);

impl Sums {
    pub(super) fn new() -> Self {
        Self([(); 4].map(|()| vec![[0.0; LANES]; HEIGHT * CHUNKS]))
    }

    pub(super) fn clear(&mut self) {
        for plane in &mut self.0 {
            plane.fill([0.0; LANES]);
        }
    }

    /// Adds the first `samples` samples of the target. Light beyond 0..1 counts as 0 or 1.
    pub(super) fn add(&mut self, target: &Target, samples: usize, is_opaque: bool) {
        let [sums @ .., alpha_sum] = &mut self.0;
        for sample in 0..samples {
            let start = row_start(sample, 0);
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

impl Slope {
    /// At the first lane of a chunk that begins at `position`; the others follow in steps of `per_x`.
    #[inline]
    pub(super) fn at(&self, position: Vec2) -> f32 {
        self.corner + position.x * self.per_x + position.y * self.per_y
    }
}
