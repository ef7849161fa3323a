//! Squares of four by four cells: as many as a cell has lanes, so that what is asked of each cell is asked of all of them at once. Most triangles lie in one.

use super::tile::{
    Aligned, CELL_WIDTH, CELLS_ACROSS, Cell, LANES, Lanes, ROWS, Slope, Stack, number,
};
use std::ops::Range;

/// Cells of a square's side.
const SIDE: usize = 4;

const _: () = assert!(SIDE * SIDE == LANES && SIDE <= ROWS && SIDE <= CELLS_ACROSS);

/// By where a square begins, the first column of each of its cells. Tables, as compilers would take apart what they know of single cells.
static COLUMNS: [Aligned<Lanes>; CELLS_ACROSS - SIDE + 1] = {
    let mut columns = [Aligned([0.0; LANES]); CELLS_ACROSS - SIDE + 1];
    let mut i = 0;
    while i < LANES * columns.len() {
        let (first, k) = (i / LANES, i % LANES);
        columns[first].0[k] = ((first + k % SIDE) * CELL_WIDTH) as f32;
        i += 1;
    }
    columns
};

/// The same of the rows.
static ROWS_OF_CELLS: [Aligned<Lanes>; ROWS - SIDE + 1] = {
    let mut rows = [Aligned([0.0; LANES]); ROWS - SIDE + 1];
    let mut i = 0;
    while i < LANES * rows.len() {
        let (first, k) = (i / LANES, i % LANES);
        rows[first].0[k] = (first + k / SIDE) as f32;
        i += 1;
    }
    rows
};

/// Places of a table that numbers of three bits find something in.
const TABLE: usize = 8;

/// By where a range of a side begins and ends, a bit for each cell: those in columns of the range, and those in its rows.
const PARTS: [[[u32; TABLE]; TABLE]; 2] = {
    let mut parts = [[[0; TABLE]; TABLE]; 2];
    let mut start = 0;
    while start < SIDE {
        let mut end = start;
        while end <= SIDE {
            let mut k = 0;
            while k < LANES {
                parts[0][start][end] |= ((start <= k % SIDE && k % SIDE < end) as u32) << k;
                parts[1][start][end] |= ((start <= k / SIDE && k / SIDE < end) as u32) << k;
                k += 1;
            }
            end += 1;
        }
        start += 1;
    }
    parts
};

/// Cells of a tile, and which of them count.
#[derive(Clone, Copy)]
pub(super) struct Square {
    /// Row and number in the row of its first cell.
    row: usize,
    first: usize,
    /// A bit for each cell that counts, row by row.
    pub(super) cells: u32,
}

impl Square {
    /// The first one of some rows of cells, from one column of them to another.
    #[inline(always)]
    fn of_range([rows, across]: &[Range<usize>; 2]) -> Self {
        // One that would end beyond the tile begins sooner, and has cells that don't count.
        let row = rows.start.min(ROWS - SIDE);
        let first = across.start.min(CELLS_ACROSS - SIDE);
        Self {
            row,
            first,
            cells: part(0, across, first) & part(1, rows, row),
        }
    }

    /// The numbers of its cells among those of a tile.
    #[inline(always)]
    pub(super) fn of<const CELLS: usize>(&self, numbers: &[f32; CELLS]) -> Lanes {
        let mut own = [0.0; LANES];
        let all =
            &numbers[self.row * CELLS_ACROSS + self.first..][..CELLS_ACROSS * (SIDE - 1) + SIDE];
        for row in 0..SIDE {
            own[row * SIDE..][..SIDE].copy_from_slice(&all[row * CELLS_ACROSS..][..SIDE]);
        }
        own
    }

    /// The first columns of its cells, and their rows.
    #[inline(always)]
    pub(super) fn places(&self) -> [&'static Lanes; 2] {
        [&COLUMNS[self.first], &ROWS_OF_CELLS[self.row]]
    }

    /// One of its cells.
    #[inline(always)]
    pub(super) fn cell(&self, number: usize) -> Cell {
        Cell::in_row(self.row + number / SIDE, self.first + number % SIDE)
    }
}

/// The cells of a square whose columns (axis 0) or rows (axis 1) lie in a range that begins in it.
#[inline(always)]
fn part(axis: usize, range: &Range<usize>, first: usize) -> u32 {
    let (start, end) = (range.start - first, (range.end - first).min(SIDE));
    PARTS[axis][start % TABLE][end % TABLE]
}

/// How much more there is in cells than in the first one of a tile, by their [places](Square::places): to the last bit what
/// [`Samples::of`](super::tile::Samples::of) adds.
#[inline(always)]
pub(super) fn steps([columns, rows]: [&Lanes; 2], slope: &Slope, stack: &Stack) -> Lanes {
    let per_row = slope.per_y * number(stack.height);
    let mut steps = [0.0; LANES];
    for k in 0..LANES {
        steps[k] = columns[k] * slope.per_x + rows[k] * per_row;
    }
    steps
}

/// The squares that hold some rows of cells, each from one column of them to another.
///
/// An iterator of its own, because closures are not sure to be compiled for their caller's instruction set.
pub(super) struct Squares {
    /// What is left of the rows, and of the first of these.
    left: [Range<usize>; 2],
    /// Where rows begin.
    start: usize,
}

#[inline(always)]
pub(super) fn squares([rows, across]: [Range<usize>; 2]) -> Squares {
    Squares {
        start: across.start,
        left: [rows, across],
    }
}

impl Iterator for Squares {
    type Item = Square;

    #[inline(always)]
    fn next(&mut self) -> Option<Square> {
        let [rows, _] = &self.left;
        if rows.start >= rows.end {
            return None;
        }
        let square = Square::of_range(&self.left);
        let [rows, across] = &mut self.left;
        across.start += SIDE;
        if across.start >= across.end {
            across.start = self.start;
            rows.start += SIDE;
        }
        Some(square)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::samples::sample_positions;
    use proptest::prelude::*;

    proptest! {
        /// Every cell is in one square, and no other is.
        #[test]
        fn squares_hold_each_cell_once(
            (top, rows) in (0..ROWS, 1..=ROWS),
            (left, across) in (0..CELLS_ACROSS, 1..=CELLS_ACROSS),
        ) {
            let rows = top..(top + rows).min(ROWS);
            let across = left..(left + across).min(CELLS_ACROSS);
            let mut found = Vec::new();
            let numbers: [f32; ROWS * CELLS_ACROSS] = std::array::from_fn(|i| i as f32);
            for square in squares([rows.clone(), across.clone()]) {
                let own = square.of(&numbers);
                for k in (0..LANES).filter(|k| square.cells >> k & 1 != 0) {
                    let cell = square.cell(k);
                    prop_assert_eq!(own[k], cell.index as f32);
                    found.push((cell.row, cell.column / CELL_WIDTH));
                }
            }
            found.sort_unstable();
            let all: Vec<_> = rows.flat_map(|row| across.clone().map(move |it| (row, it))).collect();
            prop_assert_eq!(found, all);
        }

        /// What cells are asked by is what their samples have.
        #[test]
        fn steps_are_those_of_samples(
            (corner, per_x, per_y) in (-1e4..1e4_f32, -1e3..1e3_f32, -1e3..1e3_f32),
            samples in prop::sample::select(vec![1_u32, 2, 4, 8]),
        ) {
            let stack = &Stack::of_pixel(&sample_positions(samples).unwrap())[0];
            let slope = Slope { corner, per_x, per_y };
            let at = slope.at_samples(stack);
            for square in squares([0..ROWS, 0..CELLS_ACROSS]) {
                let steps = steps(square.places(), &slope, stack);
                for (k, step) in steps.into_iter().enumerate() {
                    prop_assert_eq!(at.and(step), at.of(square.cell(k)));
                }
            }
        }
    }
}
