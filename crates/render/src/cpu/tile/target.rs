//! What the samples of a tile show while it is drawn.

use super::{
    Aligned, CELLS, CELLS_ACROSS, Cell, IdPlane, LANES, LaneMask, Mask, NO_SAMPLES, NOTHING, Plane,
    ROWS, Stack, StoreMask, add, columns_of_cells, greater, id_plane, least, lesser, plane, select,
    without,
};
use crate::cpu::stroke::Depths;

/// Which samples of a tile show anything: a bit for each lane of each cell.
#[derive(Clone)]
pub(in crate::cpu) struct Shows([u16; CELLS]);

impl Default for Shows {
    fn default() -> Self {
        Self([0; CELLS])
    }
}

impl Shows {
    pub(in crate::cpu) fn has(&self, cell: usize, lane: usize) -> bool {
        self.0[cell] >> lane & 1 != 0
    }
}

/// What each sample shows so far.
pub(in crate::cpu) struct Target {
    /// Nearest surface, 1/m.
    pub(in crate::cpu) surface: Plane,
    /// That surface's [`margin_m`](crate::Surface::margin_m).
    pub(in crate::cpu) margin: Plane,
    /// Nearest strand that no surface hides, 1/m.
    pub(in crate::cpu) strand: Plane,
    /// What decides there among equals: the higher one lies on top.
    priority: IdPlane,
    pub(in crate::cpu) color: [Plane; 3],
    /// For each cell the farthest of `strand`.
    farthest_strand: Box<Aligned<[f32; CELLS]>>,
    /// For each cell the farthest of `surface`; once these are finished [`NOTHING`] beside surfaces of their own margin,
    /// which don't count then.
    pub(in crate::cpu) farthest_surface: Box<Aligned<[f32; CELLS]>>,
    /// Whether any of `margin` may be other than 0.
    pub(in crate::cpu) has_margins: bool,
    /// The samples that show outlines, strokes of negative rank, where somebody asks.
    pub(in crate::cpu) outlines: Option<Box<Mask>>,
}

impl Target {
    pub(in crate::cpu) fn new() -> Self {
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
    pub(in crate::cpu) fn keep_outlines(&mut self, keeps: bool) {
        if keeps != self.outlines.is_some() {
            self.outlines = keeps.then(|| Box::new(NO_SAMPLES));
        }
    }

    #[inline(always)]
    pub(in crate::cpu) fn clear(&mut self, background: Option<[f32; 3]>) {
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
    pub(in crate::cpu) fn show_stroke(&mut self, samples: &Mask, is_outline: bool) {
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
    pub(in crate::cpu) fn farthest_surface(&self) -> f32 {
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
    pub(in crate::cpu) fn finish_surfaces(&mut self) {
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
    pub(in crate::cpu) fn strands(&self, cell: usize) -> [u32; LANES] {
        let mut strands = self.priority[cell];
        for k in 0..LANES {
            strands[k] = u32::MAX - strands[k];
        }
        strands
    }

    /// Makes of colours what a sample adds to a pixel's light, and of the surfaces' depths what it adds to its alpha.
    /// Loops of their own, as one with the sums would be no vector instructions.
    #[inline(always)]
    pub(super) fn finish(&mut self, stack: &Stack, is_opaque: bool) {
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

    /// Notes which samples show anything, once they are summed up.
    pub(in crate::cpu) fn copy_shows(&self, shows: &mut Shows) {
        for (bits, alpha) in shows.0.iter_mut().zip(self.surface.iter()) {
            *bits = 0;
            for (k, alpha) in alpha.iter().enumerate() {
                *bits |= u16::from(*alpha != 0.0) << k;
            }
        }
    }

    /// The columns of a row of stacks whose cells don't hide all that is as far as the given inverse depths.
    #[inline(always)]
    pub(in crate::cpu) fn open(&self, row: usize, inv_depth: f32, biased: f32) -> u32 {
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
    pub(in crate::cpu) fn close(&self, open: &mut [u32; ROWS], [inv_depth, biased]: [f32; 2]) {
        for row in 0..ROWS {
            if open[row] != 0 {
                open[row] &= self.open(row, inv_depth, biased);
            }
        }
    }

    /// Those of the samples of a cell where a strand may show that is no nearer than this.
    #[inline(always)]
    pub(in crate::cpu) fn may_show(
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
    pub(in crate::cpu) fn offer(
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
        let (nearest, top) = (self.strand[cell.index], self.priority[cell.index]);
        let mut wins = *samples;
        for k in 0..LANES {
            let before_wall = depth[k] / (1.0 + margin[k] * depth[k]);
            let against = select(margin[k] != 0.0, before_wall, biased[k]);
            let is_better =
                (depth[k] > nearest[k]) | ((depth[k] == nearest[k]) & (priority > top[k]));
            let is_shown = (samples[k] != 0) & (surface[k] <= against) & is_better;
            wins[k] = select(is_shown, u32::MAX, 0);
        }
        let (strand, stored) = (&mut self.strand[cell.index], StoreMask::new(&wins));
        stored.store(depth, strand);
        stored.store_ids(&[priority; LANES], &mut self.priority[cell.index]);
        self.farthest_strand[cell.index] = least(strand);
        wins
    }
}
