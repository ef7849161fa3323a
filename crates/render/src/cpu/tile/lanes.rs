//! The numbers of a cell: loops over them compile to vector instructions.

use super::{LANES, LaneMask, Lanes};
use std::ops::Range;

/// Both values are worked out and one is taken. Never `if`: where a condition is used twice it becomes
/// a branch, and a loop with a branch is no vector instruction.
#[inline(always)]
pub(in crate::cpu) fn select<T>(condition: bool, then: T, otherwise: T) -> T {
    std::hint::select_unpredictable(condition, then, otherwise)
}

/// The lesser of two numbers, neither NaN.
#[inline(always)]
pub(in crate::cpu) fn lesser(a: f32, b: f32) -> f32 {
    select(a < b, a, b)
}

/// The greater of two numbers, neither NaN.
#[inline(always)]
pub(in crate::cpu) fn greater(a: f32, b: f32) -> f32 {
    select(a > b, a, b)
}

/// Numbers below 32, a bit each, from the least on: in place of a range around loops over lanes, or compilers would go along the
/// range in vector instructions, and pick their numbers together, in place of along the lanes.
pub(in crate::cpu) struct OneByOne(u32);

impl OneByOne {
    /// Those of a range.
    #[inline(always)]
    pub(in crate::cpu) fn of(range: &Range<usize>) -> Self {
        Self((1_u32 << range.end) - (1 << range.start))
    }

    /// Those whose bits are set.
    #[inline(always)]
    pub(in crate::cpu) fn of_bits(bits: u32) -> Self {
        Self(bits)
    }
}

impl Iterator for OneByOne {
    type Item = usize;

    #[inline(always)]
    fn next(&mut self) -> Option<usize> {
        if self.0 == 0 {
            return None;
        }
        let number = self.0.trailing_zeros() as usize;
        self.0 &= self.0 - 1;
        Some(number)
    }
}

/// Takes on the new values where `mask` is set: of numbers that are in no plane, for which there is [`StoreMask`].
#[inline(always)]
pub(in crate::cpu) fn overwrite(old: &mut Lanes, new: &Lanes, mask: &LaneMask) {
    let mut lanes = *old; // a store for each lane might become a branch
    for k in 0..LANES {
        lanes[k] = select(mask[k] != 0, new[k], old[k]);
    }
    *old = lanes;
}

/// A mask by which cells of planes, which are in memory, take on new values.
///
/// Where a compiler knows that all bits of a lane are alike it makes masked stores, which take far longer on some machines (`docs/performance-log.md`): so it is kept
/// from knowing, and loads the old values, mixes bits and stores all of them.
#[derive(Clone, Copy)]
pub(in crate::cpu) struct StoreMask(LaneMask);

impl StoreMask {
    #[inline(always)]
    pub(in crate::cpu) fn new(mask: &LaneMask) -> Self {
        Self(std::hint::black_box(*mask))
    }

    /// Puts new values where it is set.
    #[inline(always)]
    pub(in crate::cpu) fn store(&self, new: &Lanes, cell: &mut Lanes) {
        let mut lanes = *cell;
        for k in 0..LANES {
            let (new, old) = (new[k].to_bits(), cell[k].to_bits());
            lanes[k] = f32::from_bits(self.mixed(k, new, old));
        }
        *cell = lanes;
    }

    /// The same of numbers that stand for something.
    #[inline(always)]
    pub(in crate::cpu) fn store_ids(&self, new: &[u32; LANES], cell: &mut [u32; LANES]) {
        let mut lanes = *cell;
        for k in 0..LANES {
            lanes[k] = self.mixed(k, new[k], cell[k]);
        }
        *cell = lanes;
    }

    /// Adds it to another.
    #[inline(always)]
    pub(in crate::cpu) fn add_to(&self, mask: &mut LaneMask) {
        for k in 0..LANES {
            mask[k] |= self.0[k];
        }
    }

    #[inline(always)]
    fn mixed(&self, lane: usize, new: u32, old: u32) -> u32 {
        new & self.0[lane] | old & !self.0[lane]
    }
}

/// Whether a lane is set.
#[inline(always)]
pub(in crate::cpu) fn any(lanes: &LaneMask) -> bool {
    let mut any = 0;
    for k in 0..LANES {
        any |= lanes[k];
    }
    any != 0
}

/// A bit for each lane that is set.
#[inline(always)]
pub(in crate::cpu) fn bits(lanes: &LaneMask) -> u32 {
    let mut bits = 0;
    for k in 0..LANES {
        bits |= lanes[k] & 1 << k;
    }
    bits
}

/// The least of a cell's numbers.
#[inline(always)]
pub(in crate::cpu) fn least(lanes: &Lanes) -> f32 {
    let mut least = *lanes;
    let mut half = LANES / 2;
    while half > 0 {
        for k in 0..half {
            least[k] = select(least[k] < least[k + half], least[k], least[k + half]);
        }
        half /= 2;
    }
    least[0]
}

#[cfg(test)]
mod tests {
    use super::{LANES, StoreMask, select};
    use proptest::prelude::{any, prop, proptest};
    use proptest::prop_assert_eq;

    proptest! {
        #[test]
        fn cells_take_on_what_masks_say(
            old in prop::array::uniform16(any::<u32>()),
            new in prop::array::uniform16(any::<u32>()),
            set in prop::array::uniform16(any::<bool>()),
            more in prop::array::uniform16(any::<bool>()),
        ) {
            let all_or_none = |set: [bool; LANES]| set.map(|set| select(set, u32::MAX, 0));
            let mask = StoreMask::new(&all_or_none(set));
            let expected: [u32; LANES] = std::array::from_fn(|k| if set[k] { new[k] } else { old[k] });
            let mut ids = old;
            mask.store_ids(&new, &mut ids);
            prop_assert_eq!(ids, expected);
            let mut numbers = old.map(f32::from_bits);
            mask.store(&new.map(f32::from_bits), &mut numbers);
            prop_assert_eq!(numbers.map(f32::to_bits), expected);
            let mut both = all_or_none(more);
            mask.add_to(&mut both);
            prop_assert_eq!(both, std::array::from_fn(|k| select(set[k] | more[k], u32::MAX, 0)));
        }
    }
}
