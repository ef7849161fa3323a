//! A stroke in a tile against what is there: where it shows, and in which colours.

use super::context::TileContext;
use super::reached::Reached;
use super::stroke::{Depths, Nearest, Placed, Places, Ratios, Shaded, Unasked};
use super::tile::{
    Cell, LANES, LaneMask, Lanes, Mask, ROWS, StoreMask, Target, any, cells, columns, greater,
    lesser,
};

/// How much deeper than its middle a stroke lies towards its edge.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Roundness {
    Flat,
    /// By the square of distance over radius.
    Clump,
    /// By its eighth power.
    Outline,
}

/// Nobody asks where samples that show lie.
pub(super) fn unasked(_: &mut Target, _: usize, _: &Places<false>, _: &LaneMask) {}

/// A stroke that is held against what the samples show.
pub(super) struct Offer<'a> {
    pub(super) scene: &'a TileContext<'a>,
    /// Its segments.
    pub(super) placed: &'a [Placed],
    pub(super) roundness: Roundness,
    /// Decides among equal depths.
    pub(super) priority: u32,
}

impl Offer<'_> {
    /// Puts the samples, which the segments cover, into the picture; those that show are added to `shown`. Where it `TELLS`, gives the axis
    /// points of these, where they are `COLORED` with the colours there.
    #[inline(always)]
    pub(super) fn make<const TELLS: bool, const COLORED: bool>(
        &self,
        samples: &Mask,
        segments: &mut Reached,
        target: &mut Target,
        shown: &mut Mask,
        mut give: impl FnMut(&mut Target, usize, &Places<COLORED>, &LaneMask),
    ) {
        let (mut nearest, mut biased) = (f32::NEG_INFINITY, f32::NEG_INFINITY);
        for placed in self.placed {
            nearest = greater(placed.shape.inv_depth.greatest(), nearest);
            biased = greater(placed.shape.inv_depth_biased.greatest(), biased);
        }
        for row in 0..ROWS {
            let wanted = columns(samples, row);
            if wanted == 0 {
                continue;
            }
            segments.find(self.placed, row, wanted);
            for cell in cells(row, wanted) {
                let taken = target.may_show(cell, &cell.lanes(samples), nearest, biased);
                if !any(&taken) {
                    continue;
                }
                if TELLS {
                    let mut places = Places::new();
                    let depths = self.depths(segments, cell, &taken, &mut places);
                    let wins = target.offer(cell, &taken, &depths, self.priority);
                    cell.add_to(shown, &wins);
                    give(target, cell.index, &places, &wins);
                    continue;
                }
                let depths = match self.roundness {
                    Roundness::Flat => self.depths(segments, cell, &taken, &mut Unasked),
                    _ => self.depths(segments, cell, &taken, &mut Ratios::new()),
                };
                let wins = target.offer(cell, &taken, &depths, self.priority);
                cell.add_to(shown, &wins);
            }
        }
    }

    /// The depths of some samples of a cell, by how far they are from the stroke's middle.
    #[inline(always)]
    fn depths(
        &self,
        segments: &mut Reached,
        cell: Cell,
        samples: &LaneMask,
        nearest: &mut impl Nearest,
    ) -> Depths {
        let mut depths = Depths::new();
        segments.measure(self.placed, cell, samples, &mut depths, nearest);
        if self.roundness == Roundness::Flat {
            return depths;
        }
        let mut part = *nearest.ratios();
        for k in 0..LANES {
            part[k] = lesser(part[k], 1.0);
        }
        if self.roundness == Roundness::Outline {
            for k in 0..LANES {
                let square = part[k] * part[k];
                part[k] = square * square;
            }
        }
        for k in 0..LANES {
            let deeper_m = self.scene.drawing.edge_depth_m * part[k];
            depths.inv_depth[k] = deeper(depths.inv_depth[k], deeper_m);
            depths.biased[k] = deeper(depths.biased[k], deeper_m);
        }
        depths
    }
}

/// The inverse depth of what lies so many metres deeper. There is nothing deeper than 0 or below.
#[inline(always)]
pub(super) fn deeper(inv_depth: f32, metres: f32) -> f32 {
    inv_depth / (1.0 + metres * greater(inv_depth, 0.0))
}

/// Gives the samples, which the stroke covers, its colour.
#[inline(always)]
pub(super) fn shade(
    placed: &[Placed],
    samples: &Mask,
    segments: &mut Reached,
    target: &mut Target,
) {
    let first = &placed[0].shape;
    let is_one_color = placed
        .iter()
        .all(|Placed { shape, .. }| shape.is_one_color() && shape.color == first.color);
    let color = first.color.map(|channel| [channel.start; LANES]);
    for row in 0..ROWS {
        let wanted = columns(samples, row);
        if wanted == 0 {
            continue;
        }
        if is_one_color {
            for cell in cells(row, wanted) {
                paint(target, cell.index, &color, &cell.lanes(samples));
            }
            continue;
        }
        segments.find(placed, row, wanted);
        for cell in cells(row, wanted) {
            let (mut stroke, lanes) = (Shaded::new(), cell.lanes(samples));
            segments.find_nearest(placed, cell, &lanes, &mut stroke);
            paint(target, cell.index, &stroke.color, &lanes);
        }
    }
}

/// Finds the axis points of the samples, which the segments cover, and gives them cell by cell. Where they are `COLORED`, with the colours
/// there.
#[inline(always)]
pub(super) fn tell<const COLORED: bool>(
    placed: &[Placed],
    samples: &Mask,
    segments: &mut Reached,
    mut give: impl FnMut(usize, &Places<COLORED>, &LaneMask),
) {
    for row in 0..ROWS {
        let wanted = columns(samples, row);
        if wanted == 0 {
            continue;
        }
        segments.find(placed, row, wanted);
        for cell in cells(row, wanted) {
            let (mut places, lanes) = (Places::new(), cell.lanes(samples));
            segments.find_nearest(placed, cell, &lanes, &mut places);
            give(cell.index, &places, &lanes);
        }
    }
}

#[inline(always)]
pub(super) fn paint(target: &mut Target, cell: usize, color: &[Lanes; 3], samples: &LaneMask) {
    let samples = StoreMask::new(samples);
    for (plane, color) in target.color.iter_mut().zip(color) {
        samples.store(color, &mut plane[cell]);
    }
}
