//! Numbers that look random and never change: hashes of where they are used.

/// A seeded stream of numbers for one clump.
pub(crate) struct Random(u32);

impl Random {
    /// The stream of clump `index` of a zone.
    pub fn new(seed: u32, zone: &str, index: u32) -> Self {
        let zone = zone
            .bytes()
            .fold(mix(seed), |state, byte| mix(state ^ u32::from(byte)));
        Self(mix(zone ^ mix(index)))
    }

    /// The next number, from 0 (included) to 1 (excluded).
    pub fn unit(&mut self) -> f32 {
        self.0 = self.0.wrapping_add(0x9e37_79b9);
        (mix(self.0) >> 8) as f32 / 16_777_216.0
    }

    /// The next number from -1 to 1, more often near 0 (the mean of two).
    pub fn around_zero(&mut self) -> f32 {
        self.unit() + self.unit() - 1.0
    }
}

/// A 32-bit finaliser in the family of Murmur's.
fn mix(mut h: u32) -> u32 {
    h = (h ^ (h >> 16)).wrapping_mul(0x7feb_352d);
    h = (h ^ (h >> 15)).wrapping_mul(0x846c_a68b);
    h ^ (h >> 16)
}
