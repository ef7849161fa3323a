//! Strands that come near each other, by boxes around what they sweep: along one axis in order, then one by one.

use glam::Vec4;

use super::{
    meeting::SLOW,
    ways::{Bounds, ROUNDED, Sweep},
};

/// Pieces whose boxes are looked at together.
pub(super) const FOUR: usize = 4;

/// Four boxes, coordinate by coordinate.
#[derive(Clone, Copy, Debug)]
struct Boxes {
    low: [Vec4; 3],
    high: [Vec4; 3],
}

impl Boxes {
    const NONE: Self = Self {
        low: [Vec4::INFINITY; 3],
        high: [Vec4::NEG_INFINITY; 3],
    };

    fn set(&mut self, i: usize, bounds: &Bounds) {
        for axis in 0..3 {
            self.low[axis][i] = bounds.low[axis];
            self.high[axis][i] = bounds.high[axis];
        }
    }

    /// How far they are from a box along the axis where that is most.
    #[inline(always)]
    fn gaps(&self, bounds: &Bounds) -> Vec4 {
        let gap = |axis: usize| {
            let (low, high) = (self.low[axis], self.high[axis]);
            (low - bounds.high[axis]).max(Vec4::splat(bounds.low[axis]) - high)
        };
        gap(0).max(gap(1)).max(gap(2))
    }
}

/// Four pieces of a strand, as [`Sweep`] has them.
#[derive(Clone, Copy, Debug)]
pub(super) struct Four {
    bounds: Boxes,
    mid: Boxes,
    way: [Vec4; 3],
    spread: Vec4,
    own: Vec4,
    radius: Vec4,
}

impl Four {
    fn new(sweeps: &[Sweep]) -> Self {
        let mut four = Self {
            bounds: Boxes::NONE,
            mid: Boxes::NONE,
            way: [Vec4::ZERO; 3],
            spread: Vec4::ZERO,
            own: Vec4::ZERO,
            radius: Vec4::ZERO,
        };
        for (i, sweep) in sweeps.iter().enumerate() {
            four.bounds.set(i, &sweep.bounds);
            four.mid.set(i, &sweep.mid);
            for axis in 0..3 {
                four.way[axis][i] = sweep.way[axis];
            }
            four.spread[i] = sweep.spread;
            four.own[i] = sweep.own;
            four.radius[i] = sweep.radius;
        }
        four
    }

    /// Which of them a piece may meet, as bits, where it keeps `keep` metres from each, or as many as both radii; and how much farther they may meet
    /// than half way through the step, besides their radii.
    #[inline(always)]
    pub(super) fn near(&self, sweep: &Sweep, keep: Vec4) -> (u32, Vec4) {
        let square = |axis: usize| {
            let against = self.way[axis] - sweep.way[axis];
            against * against
        };
        let against = (square(0) + square(1) + square(2)).sqrt() * ROUNDED;
        let against = against + self.spread + sweep.spread;
        let radii = self.radius + sweep.radius;
        let keep = keep.min(radii);
        let acts = against.min(self.own + sweep.own);
        let acts = Vec4::select(acts.cmpgt(keep * SLOW as f32), acts, Vec4::ZERO);
        let farther = keep - radii + against * 0.5 + acts;
        let near = self.mid.gaps(&sweep.mid).cmple(farther);
        (near.bitmask(), farther)
    }
}

/// Pairs of strands whose boxes meet in a step.
#[derive(Clone, Debug)]
pub(super) struct Pairs {
    /// The boxes of strands, in order along the first axis.
    sorted: Vec<(u32, Bounds)>,
    /// The pieces' boxes, strand by strand, and where those of every strand begin; one more at the end.
    fours: Vec<Four>,
    first: Vec<usize>,
    pairs: Vec<[u32; 2]>,
}

impl Pairs {
    /// For strands, of which `strands` are the first pieces; one more at the end.
    pub(super) fn new(strands: &[usize]) -> Self {
        let mut first = vec![0];
        for ends in strands.windows(2) {
            first.push(first[first.len() - 1] + (ends[1] - ends[0]).div_ceil(FOUR));
        }
        Self {
            sorted: Vec::with_capacity(strands.len()),
            fours: Vec::with_capacity(first[first.len() - 1]),
            first,
            pairs: Vec::new(),
        }
    }

    /// Finds them.
    pub(super) fn find(&mut self, sweeps: &[Sweep], strands: &[usize]) {
        self.fours.clear();
        self.sorted.clear();
        for (strand, ends) in (0..).zip(strands.windows(2)) {
            let pieces = &sweeps[ends[0]..ends[1]];
            self.fours.extend(pieces.chunks(FOUR).map(Four::new));
            let bounds = pieces.iter().map(|sweep| sweep.bounds);
            let whole = bounds.fold(Bounds::NONE, |all, bounds| all.and(&bounds));
            self.sorted.push((strand, whole));
        }
        (self.sorted).sort_unstable_by(|one, other| one.1.low[0].total_cmp(&other.1.low[0]));
        self.pairs.clear();
        for (place, (one, own)) in self.sorted.iter().enumerate() {
            for (other, its) in &self.sorted[place + 1..] {
                if its.low[0] > own.high[0] {
                    break;
                }
                if own.meets(its) {
                    self.pairs.push([*one.min(other), *one.max(other)]);
                }
            }
        }
    }

    /// The pairs, each once, the earlier strand first.
    pub(super) fn all(&self) -> &[[u32; 2]] {
        &self.pairs
    }

    /// Tells of all pieces of a pair of strands whose boxes meet, in order: of the first's piece, and four of the other's by their number, where
    /// they begin, which of them it is about, as bits, and what else is known of them. `strands` are the first pieces of each; `among` says which of
    /// four of the other's it may be about.
    #[inline(always)]
    pub(super) fn pieces(
        &self,
        pair: &[u32; 2],
        sweeps: &[Sweep],
        strands: &[usize],
        among: impl Fn(usize, usize) -> u32,
        mut tell: impl FnMut(usize, (usize, usize), u32, &Four),
    ) {
        let [one, other] = pair.map(|strand| strand as usize);
        let fours = &self.fours[self.first[other]..self.first[other + 1]];
        for own in strands[one]..strands[one + 1] {
            for (number, four) in fours.iter().enumerate() {
                let among = among(own, number);
                if among == 0 {
                    continue;
                }
                let gaps = four.bounds.gaps(&sweeps[own].bounds);
                let meet = gaps.cmple(Vec4::ZERO).bitmask() & among;
                if meet != 0 {
                    tell(own, (number, strands[other] + number * FOUR), meet, four);
                }
            }
        }
    }
}

/// The numbers of bits.
#[inline(always)]
pub(super) fn ones(mut bits: u32) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let next = (bits != 0).then(|| bits.trailing_zeros() as usize);
        bits &= bits.wrapping_sub(1);
        next
    })
}
