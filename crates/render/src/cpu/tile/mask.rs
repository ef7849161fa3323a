//! Some of a tile's samples, and the cells that these are in.

use super::{Aligned, CELL_WIDTH, CELLS_ACROSS, LANES, LaneMask, ROWS, STACK, WIDTH};

/// Rows of samples in a tile: for each row of stacks those of a stack's samples.
const SAMPLE_ROWS: usize = ROWS * STACK;

/// Some of a tile's samples: a word for each row of samples, in it a bit for each column.
pub(in crate::cpu) type Mask = Aligned<[u32; SAMPLE_ROWS]>;

const _: () = assert!(WIDTH == u32::BITS as usize);

/// No samples at all.
pub(in crate::cpu) const NO_SAMPLES: Mask = Aligned([0; SAMPLE_ROWS]);

/// The bits of a row's first cell.
const CELL_BITS: u32 = (1 << CELL_WIDTH) - 1;

/// The samples of both.
#[inline(always)]
pub(in crate::cpu) fn both(a: &Mask, b: &Mask) -> Mask {
    let mut both = *a;
    for row in 0..SAMPLE_ROWS {
        both[row] &= b[row];
    }
    both
}

/// Those of `a` that `b` doesn't have.
#[inline(always)]
pub(in crate::cpu) fn without(a: &Mask, b: &Mask) -> Mask {
    let mut rest = *a;
    for row in 0..SAMPLE_ROWS {
        rest[row] &= !b[row];
    }
    rest
}

/// Adds samples to some.
#[inline(always)]
pub(in crate::cpu) fn add(samples: &mut Mask, others: &Mask) {
    for row in 0..SAMPLE_ROWS {
        samples[row] |= others[row];
    }
}

#[inline(always)]
pub(in crate::cpu) fn is_empty(mask: &Mask) -> bool {
    let mut any = 0;
    for row in 0..SAMPLE_ROWS {
        any |= mask[row];
    }
    any == 0
}

/// The columns of a row of stacks in which a sample is set.
#[inline(always)]
pub(in crate::cpu) fn columns(mask: &Mask, row: usize) -> u32 {
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
pub(in crate::cpu) struct Cell {
    /// Its index in every plane.
    pub(in crate::cpu) index: usize,
    /// Row of stacks.
    pub(in crate::cpu) row: usize,
    /// Column of its left stack.
    pub(in crate::cpu) column: usize,
}

impl Cell {
    #[inline(always)]
    pub(in crate::cpu) fn new(row: usize, column: usize) -> Self {
        Self {
            index: row * CELLS_ACROSS + column / CELL_WIDTH,
            row,
            column,
        }
    }

    /// The cell of that index.
    #[inline(always)]
    pub(in crate::cpu) fn of_index(index: usize) -> Self {
        Self::in_row(index / CELLS_ACROSS, index % CELLS_ACROSS)
    }

    /// The cell of that number in a row.
    #[inline(always)]
    pub(in crate::cpu) fn in_row(row: usize, number: usize) -> Self {
        Self {
            index: row * CELLS_ACROSS + number,
            row,
            column: number * CELL_WIDTH,
        }
    }

    /// Its columns, a bit for each.
    #[inline(always)]
    pub(in crate::cpu) fn columns(&self) -> u32 {
        CELL_BITS << self.column
    }

    /// Its samples of a mask.
    #[inline(always)]
    pub(in crate::cpu) fn lanes(&self, mask: &Mask) -> LaneMask {
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
    pub(in crate::cpu) fn take_from(&self, mask: &mut Mask, lanes: &LaneMask) {
        let words = &mut mask[self.row * STACK..][..STACK];
        for k in 0..STACK {
            words[k] &= !(columns_of(lanes, k) << self.column);
        }
    }

    /// Adds some of its samples to a mask.
    #[inline(always)]
    pub(in crate::cpu) fn add_to(&self, mask: &mut Mask, lanes: &LaneMask) {
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
pub(in crate::cpu) fn columns_of_cells(cells: &[u32; CELLS_ACROSS]) -> u32 {
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
pub(in crate::cpu) struct Cells {
    row: usize,
    left: u32,
}

#[inline(always)]
pub(in crate::cpu) fn cells(row: usize, columns: u32) -> Cells {
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

#[cfg(test)]
mod tests {
    use super::*;

    /// The lanes whose bits are set.
    fn lanes(bits: u32) -> LaneMask {
        std::array::from_fn(|k| if bits >> k & 1 != 0 { u32::MAX } else { 0 })
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
        let mut copy = NO_SAMPLES;
        for cell in found {
            cell.add_to(&mut copy, &cell.lanes(&mask));
        }
        assert_eq!(copy, mask);
    }
}
