//! Hashes that tell whether something has changed.

use glam::{DQuat, DVec3, Vec3};

/// A hash by words: FNV-1a's, turned after each, as a product alone never brings a high bit down, and two signs that change would
/// leave it as it was.
pub(crate) struct Hash(u64);

impl Hash {
    const TURN: u32 = 29;

    pub(crate) fn new() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }

    /// That of a list of numbers.
    pub(crate) fn of(numbers: &[f32]) -> u64 {
        let mut hash = Self::new();
        for number in numbers {
            hash.add_word(u64::from(number.to_bits()));
        }
        hash.0
    }

    fn add_word(&mut self, word: u64) {
        self.0 = (self.0 ^ word)
            .wrapping_mul(0x0100_0000_01b3)
            .rotate_left(Self::TURN);
    }

    pub(crate) fn add(&mut self, v: DVec3) {
        for number in v.to_array() {
            self.add_word(number.to_bits());
        }
    }

    pub(crate) fn add_number(&mut self, number: f64) {
        self.add_word(number.to_bits());
    }

    pub(crate) fn add_turn(&mut self, turn: DQuat) {
        for number in turn.to_array() {
            self.add_word(number.to_bits());
        }
    }

    /// Adds many points, by four hashes that do not wait for each other.
    pub(crate) fn add_all(&mut self, points: &[Vec3]) {
        let mut parts: [Self; 4] = std::array::from_fn(|_| Self::new());
        for points in points.chunks(parts.len()) {
            for (part, point) in parts.iter_mut().zip(points) {
                let [x, y, z] = point.to_array().map(|v| u64::from(v.to_bits()));
                part.add_word(x | y << 32);
                part.add_word(z);
            }
        }
        for part in parts {
            self.add_word(part.0);
        }
        self.add_word(points.len() as u64);
    }

    pub(crate) fn sum(&self) -> u64 {
        self.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn signs_and_places_count() {
        let of = |v: DVec3| {
            let mut hash = Hash::new();
            hash.add(v);
            hash.sum()
        };
        let one = of(DVec3::new(1.0, 2.0, 3.0));
        for other in [[-1.0, -2.0, 3.0], [2.0, 1.0, 3.0], [1.0, 2.0, -3.0]] {
            assert_ne!(one, of(DVec3::from_array(other)), "{other:?}");
        }
        let all = |points: &[Vec3]| {
            let mut hash = Hash::new();
            hash.add_all(points);
            hash.sum()
        };
        let points: Vec<Vec3> = (0..9_u8).map(|i| Vec3::splat(f32::from(i))).collect();
        for i in 0..9 {
            let mut others = points.clone();
            others[i].z += 1e-6;
            assert_ne!(all(&points), all(&others), "{i}");
        }
        assert_ne!(all(&points), all(&points[..8]));
    }
}
