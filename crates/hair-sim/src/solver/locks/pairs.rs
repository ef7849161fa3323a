//! Strands that come near each other, by boxes around what they sweep: along one axis in order, then one by one.

use glam::Vec4;

use super::ways::{Bounds, Sweep};

/// Pieces whose boxes are looked at together.
pub(super) const FOUR: usize = 4;

/// The boxes of four pieces of a strand, coordinate by coordinate.
#[derive(Clone, Copy, Debug)]
struct Four {
    low: [Vec4; 3],
    high: [Vec4; 3],
}

impl Four {
    fn new(sweeps: &[Sweep]) -> Self {
        let mut four = Self {
            low: [Vec4::INFINITY; 3],
            high: [Vec4::NEG_INFINITY; 3],
        };
        for (i, Sweep { bounds, .. }) in sweeps.iter().enumerate() {
            for axis in 0..3 {
                four.low[axis][i] = bounds.low[axis];
                four.high[axis][i] = bounds.high[axis];
            }
        }
        four
    }

    /// Which of them a box meets, as bits.
    #[inline(always)]
    fn meet(&self, bounds: &Bounds) -> u32 {
        let gap = |axis: usize| {
            let (low, high) = (self.low[axis], self.high[axis]);
            (low - bounds.high[axis]).max(Vec4::splat(bounds.low[axis]) - high)
        };
        let gaps = gap(0).max(gap(1)).max(gap(2));
        gaps.cmple(Vec4::ZERO).bitmask()
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

    /// Tells of all pieces of a pair of strands whose boxes meet, in order; `strands` are the first pieces of each. `among` says which of four of the
    /// other's it is about, as bits, by the first's piece and where they begin on the other.
    #[inline(always)]
    pub(super) fn pieces(
        &self,
        pair: &[u32; 2],
        sweeps: &[Sweep],
        strands: &[usize],
        among: impl Fn(usize, usize) -> u32,
        mut tell: impl FnMut(usize, usize),
    ) {
        let [one, other] = pair.map(|strand| strand as usize);
        let fours = &self.fours[self.first[other]..self.first[other + 1]];
        for own in strands[one]..strands[one + 1] {
            for (number, four) in fours.iter().enumerate() {
                let among = among(own, number * FOUR);
                if among == 0 {
                    continue;
                }
                let mut meet = four.meet(&sweeps[own].bounds) & among;
                while meet != 0 {
                    let its = number * FOUR + meet.trailing_zeros() as usize;
                    tell(own, strands[other] + its);
                    meet &= meet - 1;
                }
            }
        }
    }
}
