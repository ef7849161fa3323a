//! How far pieces of strands keep from each other that are near each other at rest.

use glam::Vec4;

use super::boxes::FOUR;

/// No pair of fours.
const FREE: [u32; 2] = [u32::MAX; 2];

/// Pieces of four and of four others, by their numbers there, and how far they keep, in m.
pub(super) type Near = Vec<([usize; 2], f32)>;

/// Of pairs of four pieces of a strand.
#[derive(Clone, Debug)]
pub(super) struct Keeps {
    /// Of all that are near, by their numbers. The first is of all others.
    all: Vec<([u32; 2], Apart)>,
    /// A table of those, in which a pair lies at the place that its numbers are hashed to, or at the first free one after that.
    table: Vec<([u32; 2], u32)>,
    /// Bits of a hash that aren't of a place.
    shift: u32,
}

/// How far four pieces keep from four others.
#[derive(Clone, Copy, Debug)]
pub(super) struct Apart {
    /// For every one of the first those of the others, in m: 0, not at all; infinite, as far as any.
    pub keeps: [Vec4; FOUR],
    /// Those that keep apart at all, as bits.
    pub kept: u32,
}

impl Apart {
    /// Of pieces that aren't near each other at rest.
    const FREE: Self = Self {
        keeps: [Vec4::INFINITY; FOUR],
        kept: !0,
    };
}

impl Keeps {
    /// Of pairs of fours, each once.
    pub(super) fn new(near: &[([u32; 2], Near)]) -> Self {
        let mut all = vec![(FREE, Apart::FREE)];
        for (pair, near) in near {
            let mut apart = Apart::FREE;
            for &([own, its], keep) in near {
                apart.keeps[own][its] = keep;
                if keep == 0.0 {
                    apart.kept &= !(1 << (FOUR * own + its));
                }
            }
            all.push((*pair, apart));
        }
        // Half of it is free at least, so that few places are looked at.
        let bits = (2 * all.len()).next_power_of_two().ilog2();
        let mut keeps = Self {
            table: vec![(FREE, 0); 1 << bits],
            shift: u64::BITS - bits,
            all,
        };
        for (i, &(pair, _)) in (0..).zip(&keeps.all).skip(1) {
            let place = keeps.place(pair);
            keeps.table[place] = (pair, i);
        }
        keeps
    }

    /// Where a pair of fours lies in the table, or would.
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

    /// Those of a pair of fours, the earlier first.
    #[inline(always)]
    pub(super) fn between(&self, pair: [u32; 2]) -> &Apart {
        &self.all[self.table[self.place(pair)].1 as usize].1
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pairs_of_fours_are_found_again_and_no_others() {
        for count in [0, 1, 2, 300] {
            let pair = |i: u32| [i % 37, 100 + i];
            let near: Vec<_> = (0..count)
                .map(|i| (pair(i), vec![([3, 1], i as f32)]))
                .collect();
            let keeps = Keeps::new(&near);
            for i in 0..count {
                let apart = keeps.between(pair(i));
                assert_eq!(apart.keeps[3], Vec4::INFINITY.with_y(i as f32));
                assert_eq!(apart.keeps[2], Vec4::INFINITY);
                let kept = if i > 0 { 0xffff } else { 0xdfff };
                assert_eq!(apart.kept & 0xffff, kept);
                let [one, other] = pair(i);
                let apart = keeps.between([one + 40, other]);
                assert_eq!(apart.keeps, [Vec4::INFINITY; 4]);
                assert_eq!(apart.kept & 0xffff, 0xffff);
            }
        }
    }
}
