/// A well mixed number from `value` (a 32-bit finaliser in the family of Murmur's).
#[inline]
#[must_use]
pub const fn hash(value: u32) -> u32 {
    let mut h = value;
    h = (h ^ (h >> 16)).wrapping_mul(0x7feb_352d);
    h = (h ^ (h >> 15)).wrapping_mul(0x846c_a68b);
    h ^ (h >> 16)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_bits() {
        assert_eq!(hash(0), 0);
        assert_eq!(hash(1), 0x6889_90c0);
    }

    #[test]
    fn each_bit_of_the_input_changes_half_of_the_output() {
        for bit in 0..32 {
            let changed = |n: u32| (hash(n) ^ hash(n ^ 1 << bit)).count_ones();
            let mean = (0..4096).map(changed).sum::<u32>() as f32 / 4096.0;
            assert!((mean - 16.0).abs() < 0.5, "bit {bit}: {mean}");
        }
    }
}
