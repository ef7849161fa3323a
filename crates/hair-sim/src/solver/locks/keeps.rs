//! How far pieces of strands keep from each other that are near each other at rest.

use glam::Vec4;

use super::boxes::FOUR;

/// No pair of strands.
const FREE: [u32; 2] = [u32::MAX; 2];

/// Of pairs of pieces.
#[derive(Clone, Debug, Default)]
pub(super) struct Keeps {
    /// Pairs of strands with pieces that are near, the earlier first, and where those begin in the list of all.
    pairs: Vec<([u32; 2], usize)>,
    /// The same as a table, in which a pair lies at the place that its numbers are hashed to, or at the first free one after that.
    table: Vec<([u32; 2], usize)>,
    /// Bits of a hash that aren't of a place.
    shift: u32,
    /// Of such a pair, for every piece of the one those of the other, by fours, in m; infinite where they aren't near.
    keeps: Vec<Vec4>,
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
        let fours = (strands[other + 1] - strands[other]).div_ceil(FOUR);
        let all = (strands[one + 1] - strands[one]) * fours;
        self.pairs.push((pair, from));
        self.keeps.resize(from + all, Vec4::INFINITY);
        for &([own, its], keep) in near {
            let its = its - strands[other];
            self.keeps[from + (own - strands[one]) * fours + its / FOUR][its % FOUR] = keep;
        }
        let kept = |keeps: &Vec4| keeps.cmpgt(Vec4::ZERO).bitmask();
        self.kept.extend(self.keeps[from..].iter().map(kept));
    }

    /// Makes ready to be asked.
    pub(super) fn index(&mut self) {
        // Half of it is free at least, so that few places are looked at.
        let bits = (2 * self.pairs.len()).max(2).next_power_of_two().ilog2();
        self.shift = u64::BITS - bits;
        self.table = vec![(FREE, self.keeps.len()); 1 << bits];
        for i in 0..self.pairs.len() {
            let place = self.place(self.pairs[i].0);
            self.table[place] = self.pairs[i];
        }
    }

    /// Where a pair of strands lies in the table, or would.
    #[inline(always)]
    fn place(&self, pair: [u32; 2]) -> usize {
        let number = u64::from(pair[0]) << 32 | u64::from(pair[1]);
        // Fibonacci hashing (Knuth, volume 3, 6.4).
        let mut place = (number.wrapping_mul(0x9e37_79b9_7f4a_7c15) >> self.shift) as usize;
        while self.table[place].0 != pair && self.table[place].0 != FREE {
            place = (place + 1) & (self.table.len() - 1);
        }
        place
    }

    /// Those of a pair of strands, the earlier first.
    #[inline(always)]
    pub(super) fn between(&self, pair: &[u32; 2], strands: &[usize]) -> Between<'_> {
        let from = self.table[self.place(*pair)].1;
        let other = pair[1] as usize;
        Between {
            keeps: &self.keeps[from..],
            kept: &self.kept[from..],
            fours: (strands[other + 1] - strands[other]).div_ceil(FOUR),
        }
    }
}

/// Those of a pair of strands.
pub(super) struct Between<'a> {
    keeps: &'a [Vec4],
    kept: &'a [u32],
    fours: usize,
}

impl Between<'_> {
    /// How far a piece, by its number on its strand, keeps from four of the other strand, of the fours the one of this number, in m: 0, not at all;
    /// infinite, as far as any.
    #[inline(always)]
    pub(super) fn of(&self, own: usize, four: usize) -> Vec4 {
        let place = own * self.fours + four;
        self.keeps.get(place).map_or(Vec4::INFINITY, |&keeps| keeps)
    }

    /// Which of these it keeps apart from, as bits.
    #[inline(always)]
    pub(super) fn kept(&self, own: usize, four: usize) -> u32 {
        let place = own * self.fours + four;
        self.kept.get(place).map_or(!0, |&kept| kept)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pairs_of_strands_are_found_again_and_no_others() {
        for count in [0, 1, 2, 300] {
            let strands: Vec<usize> = (0..=1000).map(|strand| strand * 6).collect();
            let mut keeps = Keeps::default();
            let pair = |i: usize| [i % 37, 100 + i];
            for i in 0..count {
                let near = pair(i).map(|strand| strand * 6 + 5);
                let pair = pair(i).map(|strand| strand as u32);
                keeps.add(pair, &[(near, i as f32)], &strands);
            }
            keeps.index();
            for i in 0..count {
                let [one, other] = pair(i);
                let between = keeps.between(&[one as u32, other as u32], &strands);
                let expected = Vec4::INFINITY.with_y(i as f32);
                assert_eq!(between.of(5, 1), expected);
                assert_eq!(between.of(4, 1), Vec4::INFINITY);
                assert_eq!(between.kept(5, 1), if i > 0 { 15 } else { 13 });
                let between = keeps.between(&[one as u32 + 40, other as u32], &strands);
                assert_eq!(between.of(5, 1), Vec4::INFINITY);
                assert_eq!(between.kept(5, 1) & 15, 15);
            }
        }
    }
}
