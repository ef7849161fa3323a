//! Numbers that look random and never change: hashes of where they are used.

use portable_math::hash;

/// A seeded stream of numbers for one clump.
pub(crate) struct Random(u32);

impl Random {
    /// The stream of clump `index` of a zone.
    pub fn new(seed: u32, zone: &str, index: u32) -> Self {
        let zone = zone
            .bytes()
            .fold(hash(seed), |state, byte| hash(state ^ u32::from(byte)));
        Self(hash(zone ^ hash(index)))
    }

    /// The next number, from 0 (included) to 1 (excluded).
    pub fn unit(&mut self) -> f32 {
        self.0 = self.0.wrapping_add(0x9e37_79b9);
        (hash(self.0) >> 8) as f32 / 16_777_216.0
    }

    /// The next number from -1 to 1, more often near 0 (the mean of two).
    pub fn around_zero(&mut self) -> f32 {
        self.unit() + self.unit() - 1.0
    }
}
