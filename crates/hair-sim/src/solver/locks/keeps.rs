//! How far pieces of strands keep from each other that are near each other at rest.

use super::pairs::FOUR;

/// Of pairs of pieces.
#[derive(Clone, Debug, Default)]
pub(super) struct Keeps {
    /// Pairs of strands with pieces that are near, in order, and where those begin in the list of all.
    pairs: Vec<([u32; 2], usize)>,
    /// Where the pairs of every strand with later ones begin; one more at the end.
    first: Vec<usize>,
    /// Of such a pair, for every piece of the one those of the other, by fours, in m; infinite where they aren't near.
    keeps: Vec<f32>,
    /// Of every four of these, those that keep apart at all, as bits.
    kept: Vec<u32>,
}

impl Keeps {
    /// Adds those of a pair of strands: pieces, and how far they keep, in m. `strands` are the first pieces of each.
    pub(super) fn add(&mut self, pair: [u32; 2], near: &[([usize; 2], f32)], strands: &[usize]) {
        if near.is_empty() {
            return;
        }
        let from = self.keeps.len();
        let [one, other] = pair.map(|strand| strand as usize);
        let count = (strands[other + 1] - strands[other]).next_multiple_of(FOUR);
        let all = (strands[one + 1] - strands[one]) * count;
        self.pairs.push((pair, from));
        self.keeps.resize(from + all, f32::INFINITY);
        for &([own, its], keep) in near {
            self.keeps[from + (own - strands[one]) * count + its - strands[other]] = keep;
        }
        let kept =
            |keeps: &[f32]| (0..FOUR).fold(0, |bits, i| bits | u32::from(keeps[i] > 0.0) << i);
        self.kept.extend(self.keeps[from..].chunks(FOUR).map(kept));
    }

    /// Makes ready to be asked about so many strands.
    pub(super) fn sort(&mut self, strands: u32) {
        self.pairs.sort_unstable_by_key(|&(pair, _)| pair);
        let first = |strand: u32| self.pairs.partition_point(|(pair, _)| pair[0] < strand);
        self.first = (0..=strands).map(first).collect();
    }

    /// Those of a pair of strands, the earlier first.
    #[inline(always)]
    pub(super) fn between(&self, pair: &[u32; 2], strands: &[usize]) -> Between<'_> {
        let [one, other] = pair.map(|strand| strand as usize);
        let pairs = &self.pairs[self.first[one]..self.first[one + 1]];
        let found = pairs.binary_search_by_key(&pair[1], |(pair, _)| pair[1]);
        let from = found.map_or(self.keeps.len(), |found| pairs[found].1);
        Between {
            keeps: &self.keeps[from..],
            kept: &self.kept[from / FOUR..],
            first: [strands[one], strands[other]],
            count: (strands[other + 1] - strands[other]).next_multiple_of(FOUR),
        }
    }
}

/// Those of a pair of strands.
pub(super) struct Between<'a> {
    keeps: &'a [f32],
    kept: &'a [u32],
    first: [usize; 2],
    count: usize,
}

impl Between<'_> {
    /// How far two pieces keep from each other, in m: 0, not at all; infinite, as far as any.
    #[inline(always)]
    pub(super) fn of(&self, own: usize, other: usize) -> f64 {
        let place = (own - self.first[0]) * self.count + other - self.first[1];
        self.keeps
            .get(place)
            .map_or(f64::INFINITY, |&keep| f64::from(keep))
    }

    /// Which of four pieces, the first of which is the other's number `from`, a multiple of four, a piece keeps apart from, as bits.
    #[inline(always)]
    pub(super) fn kept(&self, own: usize, from: usize) -> u32 {
        let place = (own - self.first[0]) * self.count + from;
        self.kept.get(place / FOUR).map_or(!0, |&kept| kept)
    }
}
