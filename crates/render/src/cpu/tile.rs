//! A tile: the samples of a few pixels, as planes of numbers that vector instructions walk along.
//!
//! Eight samples one below the other are a *stack* ([`Stack`]): eight of a pixel's samples, or those of two, four or eight
//! pixels where a pixel has fewer. A tile is [`ROWS`] rows of [`WIDTH`] stacks, one pixel wide each; where
//! a pixel has more than eight samples, it is drawn eight at a time. A *cell* is two stacks beside each other: sixteen
//! numbers of a plane, and every loop over a cell's lanes compiles to vector instructions, one of AVX-512 or two of AVX2. With four samples a pixel a cell is
//! two pixels by two, as strokes are thin: more of its lanes have something to do than of four pixels beside each other.

mod lanes;
mod mask;
mod stack;
mod sums;
mod target;

pub(super) use self::lanes::*;
pub(super) use self::mask::*;
pub(super) use self::stack::*;
pub(super) use self::sums::*;
pub(super) use self::target::*;

use std::ops::{Deref, DerefMut};

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

/// Some of a cell's samples: all bits or none.
pub(super) type LaneMask = [u32; LANES];

/// Marks the depth of a sample where there is nothing.
pub(super) const NOTHING: f32 = f32::NEG_INFINITY;

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

/// One number of each sample. Of fixed length, so that a cell's index is checked once for all planes.
pub(super) type Plane = Box<Aligned<[Lanes; CELLS]>>;

pub(super) fn plane() -> Plane {
    Box::new(Aligned([[0.0; LANES]; CELLS]))
}
