//! Sorting what is drawn into the parts of the picture that it reaches.

use super::tile::{self, Stack};
use glam::{Vec2, Vec4};
use std::ops::Range;

/// A margin for rounding around everything that is drawn, in pixels.
pub(super) const MARGIN: f32 = 0.01;

/// The pixels that something may reach: a range of columns and one of rows. By default none.
///
/// In 16 bits, as pictures have at most [`MAX_SIZE`](super::MAX_SIZE) of them: what is drawn is long lists of these.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Bounds {
    /// Where it ends to the right and below, behind where it begins, all bits the other way round: what holds two has the greater ones of all four,
    /// which is an instruction.
    ends: [u16; 4],
}

impl Default for Bounds {
    fn default() -> Self {
        Self::NOWHERE
    }
}

impl Bounds {
    /// No pixels.
    pub(super) const NOWHERE: Self = Self::new([0, 0], [0, 0]);

    #[inline(always)]
    const fn new([left, right]: [u16; 2], [top, bottom]: [u16; 2]) -> Self {
        Self {
            ends: [!left, !top, right, bottom],
        }
    }

    /// Columns.
    #[inline(always)]
    pub(super) fn x(&self) -> [u16; 2] {
        [!self.ends[0], self.ends[2]]
    }

    /// Rows.
    #[inline(always)]
    pub(super) fn y(&self) -> [u16; 2] {
        [!self.ends[1], self.ends[3]]
    }

    /// The pixels of a picture of the given size that the box from `min` to `max` touches, if any.
    #[inline(always)] // into kernels that are compiled for several instruction sets
    pub(super) fn of_box(min: Vec2, max: Vec2, size: [u32; 2]) -> Option<Self> {
        let [width, height] = size.map(|side| side as f32);
        // All four ends at once, outwards: from the greater ones with the other sign. Single precision is finer than the margin wherever a
        // picture is.
        const SIGNS: Vec4 = Vec4::new(1.0, 1.0, -1.0, -1.0);
        let ends = (Vec4::new(min.x, min.y, -max.x, -max.y) - MARGIN - 0.5) * SIGNS;
        let ends = ends.max(Vec4::ZERO);
        let ends = ends.min(Vec4::new(width, height, width, height));
        let [left, top, right, bottom] = ends.to_array().map(|end| nearest(end) as u16);
        (left < right && top < bottom).then_some(Self::new([left, right], [top, bottom]))
    }

    /// What holds these and others.
    #[inline(always)] // into kernels that are compiled for several instruction sets
    pub(super) fn around(&self, others: &Self) -> Self {
        let mut ends = self.ends;
        for k in 0..4 {
            ends[k] = ends[k].max(others.ends[k]);
        }
        Self { ends }
    }

    /// The rows of stacks in the tile whose first pixel is `top`.
    #[inline(always)]
    pub(super) fn rows_in(&self, top: usize, stack: &Stack) -> Range<usize> {
        stack.rows(clip(self.y(), top, tile::ROWS * stack.height))
    }

    /// The columns in the tile whose first one is `left`, a bit for each.
    #[inline(always)]
    pub(super) fn columns_in(&self, left: usize) -> u32 {
        let columns = clip(self.x(), left, tile::WIDTH);
        u32::MAX << columns.start & u32::MAX >> (tile::WIDTH - columns.end)
    }
}

/// The nearest whole number of one from -1 to some millions. By the sum with a number whose last bit is 1, which takes an
/// instruction where a cast takes ten.
#[inline(always)]
fn nearest(value: f32) -> i32 {
    const WHOLE: f32 = 8_388_608.0 + 64.0;
    (value + WHOLE).to_bits() as i32 - WHOLE.to_bits() as i32
}

/// Which cells of `size` pixels, a power of 2, a range of pixels reaches.
#[inline]
pub(super) fn cells([start, end]: [u16; 2], size: usize) -> Range<usize> {
    let shift = size.trailing_zeros();
    usize::from(start) >> shift..(usize::from(end) + size - 1) >> shift
}

/// The part of a range of pixels that lies in the `size` pixels from `origin` on, seen from there.
#[inline(always)] // into kernels that are compiled for several instruction sets
pub(super) fn clip([start, end]: [u16; 2], origin: usize, size: usize) -> Range<usize> {
    usize::from(start).max(origin) - origin..usize::from(end).min(origin + size) - origin
}

/// Items sorted into bins by counting. An item lies in each bin of a range; a bin keeps the order in
/// which its items came.
#[derive(Debug, Default)]
pub(super) struct Bins<T = u32> {
    /// `first[bin]..first[bin + 1]` are the bin's items.
    first: Vec<usize>,
    items: Vec<T>,
}

impl<T: Copy + Default> Bins<T> {
    /// Sorts items, each with its range of bins, into `bins` bins in place of what was there.
    pub(super) fn fill(
        &mut self,
        bins: usize,
        items: impl Iterator<Item = (T, Range<usize>)> + Clone,
    ) {
        // Counted two places ahead: after the sums `first[bin + 1]` is where the bin starts, and the
        // second pass moves it to where it ends.
        self.first.clear();
        self.first.resize(bins + 2, 0);
        let ahead = &mut self.first[2..];
        // By `for_each`, which chained iterators do in loops of their own.
        (items.clone()).for_each(|(_, range)| {
            ahead[range].iter_mut().for_each(|count| *count += 1);
        });
        self.sum_up();
        let places = &mut self.first[1..];
        let sorted = &mut self.items[..];
        items.for_each(|(item, range)| {
            for place in &mut places[range] {
                sorted[*place] = item;
                *place += 1;
            }
        });
    }

    /// Makes sums of the counts, and room for the items.
    fn sum_up(&mut self) {
        let mut sum = 0;
        for first in &mut self.first[2..] {
            sum += *first;
            *first = sum;
        }
        self.items.clear();
        self.items.resize(sum, T::default());
    }

    /// The items of a bin.
    pub(super) fn bin(&self, bin: usize) -> &[T] {
        &self.items[self.first[bin]..self.first[bin + 1]]
    }
}

impl Bins {
    /// [`Self::fill`] of bins in rows of so many: the items' columns and rows of bins in place of their ranges.
    pub(super) fn fill_rows(
        &mut self,
        [across, rows]: [usize; 2],
        items: impl Iterator<Item = [Range<usize>; 2]> + Clone,
    ) {
        self.first.clear();
        self.first.resize(across * rows + 2, 0);
        let ahead = &mut self.first[2..];
        items.clone().for_each(|[columns, rows]| {
            let mut first = rows.start * across;
            for _ in rows {
                for bin in first + columns.start..first + columns.end {
                    ahead[bin] += 1;
                }
                first += across;
            }
        });
        self.sum_up();
        let places = &mut self.first[1..];
        let sorted = &mut self.items[..];
        let mut item = 0;
        items.for_each(|[columns, rows]| {
            let mut first = rows.start * across;
            for _ in rows {
                for bin in first + columns.start..first + columns.end {
                    sorted[places[bin]] = item;
                    places[bin] += 1;
                }
                first += across;
            }
            item += 1;
        });
    }
}

/// The same where a thread sorts few items into few bins again and again: lists of their own, which are filled in one go.
#[derive(Debug, Default)]
pub(super) struct Lists(Vec<Vec<u32>>);

impl Lists {
    /// As [`Bins::fill`].
    pub(super) fn fill(&mut self, bins: usize, items: impl Iterator<Item = (u32, Range<usize>)>) {
        self.0.resize_with(bins, Vec::new);
        self.0.iter_mut().for_each(Vec::clear);
        items.for_each(|(item, range)| {
            let lists = self.0[range].iter_mut();
            lists.for_each(|list| list.push(item));
        });
    }

    /// The items of a bin.
    pub(super) fn bin(&self, bin: usize) -> &[u32] {
        &self.0[bin]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bins_keep_the_order_of_items() {
        let (mut bins, mut lists) = (Bins::default(), Lists::default());
        for _ in 0..2 {
            let items = [(7, 0..2), (3, 1..4), (5, 1..2), (9, 3..4)];
            bins.fill(4, items.clone().into_iter());
            lists.fill(4, items.into_iter());
            for (bin, expected) in [&[7][..], &[7, 3, 5], &[3], &[3, 9]].iter().enumerate() {
                assert_eq!(bins.bin(bin), *expected);
                assert_eq!(lists.bin(bin), *expected);
            }
        }
        // Three columns and two rows.
        let items = [[0..2, 0..1], [1..3, 0..2], [0..0, 0..2], [2..3, 1..2]];
        bins.fill_rows([3, 2], items.into_iter());
        let expected = [&[0][..], &[0, 1], &[1], &[], &[1], &[1, 3]];
        for (bin, expected) in expected.iter().enumerate() {
            assert_eq!(bins.bin(bin), *expected);
        }
        bins.fill(1, std::iter::empty());
        lists.fill(1, std::iter::empty());
        assert!(bins.bin(0).is_empty());
        assert!(lists.bin(0).is_empty());
    }

    #[test]
    fn bounds_hold_the_box_and_stay_in_the_picture() {
        let of = |x0, y0, x1, y1| {
            Bounds::of_box(Vec2::new(x0, y0), Vec2::new(x1, y1), [100, 50]).map(|b| (b.x(), b.y()))
        };
        assert_eq!(of(1.5, 2.5, 3.5, 3.5), Some(([1, 4], [2, 4])));
        assert_eq!(of(-9.0, -9.0, 999.0, 999.0), Some(([0, 100], [0, 50])));
        assert_eq!(of(-9.0, 0.0, -1.0, 5.0), None);
        assert_eq!(of(0.0, 50.5, 5.0, 60.0), None);
        // A box that ends at a pixel's edge reaches the next pixel: edges belong to strokes.
        assert_eq!(of(1.0, 1.0, 2.0, 2.0), Some(([0, 3], [0, 3])));
    }
}
