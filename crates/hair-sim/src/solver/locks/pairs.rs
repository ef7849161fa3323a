//! Strands that come near each other, by boxes around what they sweep: along one axis in order, then one by one.

use super::ways::{Bounds, Sweep};

/// Pairs of strands whose boxes meet in a step.
#[derive(Clone, Debug)]
pub(super) struct Pairs {
    /// The boxes of strands, in order along the first axis.
    sorted: Vec<(u32, Bounds)>,
    /// Of every strand.
    boxes: Vec<Bounds>,
    pairs: Vec<[u32; 2]>,
}

impl Pairs {
    /// For so many strands.
    pub(super) fn new(strands: usize) -> Self {
        Self {
            sorted: Vec::with_capacity(strands),
            boxes: Vec::with_capacity(strands),
            pairs: Vec::new(),
        }
    }

    /// Finds them; `strands` are the first pieces of each.
    pub(super) fn find(&mut self, sweeps: &[Sweep], strands: &[usize]) {
        self.boxes.clear();
        self.boxes.extend(strands.windows(2).map(|ends| {
            let pieces = sweeps[ends[0]..ends[1]].iter();
            pieces.fold(Bounds::NONE, |all, sweep| all.and(&sweep.bounds))
        }));
        self.sorted.clear();
        self.sorted.extend((0..).zip(self.boxes.iter().copied()));
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

    /// Tells of all pieces of a pair of strands whose boxes meet, in order.
    #[inline]
    pub(super) fn pieces(
        &self,
        pair: &[u32; 2],
        sweeps: &[Sweep],
        strands: &[usize],
        mut tell: impl FnMut(usize, usize),
    ) {
        let [one, other] = pair.map(|strand| strand as usize);
        let whole = &self.boxes[other];
        for own in strands[one]..strands[one + 1] {
            let bounds = &sweeps[own].bounds;
            if !bounds.meets(whole) {
                continue;
            }
            for its in strands[other]..strands[other + 1] {
                if bounds.meets(&sweeps[its].bounds) {
                    tell(own, its);
                }
            }
        }
    }
}
