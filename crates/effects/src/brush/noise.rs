//! Noise for the marks of tools: the same bits on every machine, and without a seam where a copy follows the other.

use crate::wgsl::hash;

/// Gradient noise on a grid (Perlin, "An image synthesizer", 1985).
#[derive(Clone, Copy)]
pub(super) struct Noise {
    seed: u32,
    /// Columns of the grid, after which it begins anew.
    columns: u32,
    /// Rows of the grid, from one edge of the stroke to the other.
    rows: f32,
}

impl Noise {
    /// One whose cells are about so large, as shares of a copy's length and of the stroke's width.
    pub(super) fn new(seed: u32, number: u32, cell: [f32; 2]) -> Self {
        Self {
            seed: hash(seed ^ hash(number)),
            columns: (1.0 / cell[0]).round().max(1.0) as u32,
            rows: 1.0 / cell[1],
        }
    }

    /// The noise at a place, which is 0 to 1 each way: 0 to 1, spread so far that it is low and high as often as in between.
    pub(super) fn at(&self, [x, y]: [f32; 2]) -> f32 {
        // Off the grid's lines, on which the noise is always one half.
        let (column, across) = cell_of(x * self.columns as f32 + 0.37);
        let (row, down) = cell_of(y * self.rows + 0.43);
        let slope = |i: u32, j: u32| {
            let place =
                (column.wrapping_add(i) % self.columns).wrapping_add(row.wrapping_add(j) << 16);
            let mixed = hash(self.seed ^ hash(place));
            let signed = |bits: u32| (bits & 0xffff) as f32 / 32_768.0 - 1.0;
            signed(mixed) * (across - i as f32) + signed(mixed >> 16) * (down - j as f32)
        };
        let mix = |a: f32, b: f32, share: f32| a + (b - a) * share;
        let (to_right, to_below) = (ease(across), ease(down));
        let above = mix(slope(0, 0), slope(1, 0), to_right);
        let below = mix(slope(0, 1), slope(1, 1), to_right);
        smooth(-0.55, 0.55, mix(above, below, to_below))
    }
}

/// The cell of a number from 0 on, and how far it is to the next.
fn cell_of(place: f32) -> (u32, f32) {
    let cell = place.floor();
    (cell as u32, place - cell)
}

/// From 0 to 1 without a kink, nor one in its slope.
fn ease(x: f32) -> f32 {
    x * x * x * (x * (6.0 * x - 15.0) + 10.0)
}

/// 0 up to `low`, 1 from `high` on, and smooth in between.
pub(super) fn smooth(low: f32, high: f32, x: f32) -> f32 {
    let share = ((x - low) / (high - low)).clamp(0.0, 1.0);
    share * share * (3.0 - 2.0 * share)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn noise_has_no_seam_and_keeps_its_mean() {
        let noise = Noise::new(7, 1, [0.05, 0.2]);
        let mut sum = 0.0;
        for i in 0..4000 {
            let place = [(i % 200) as f32 / 200.0, (i / 200) as f32 / 20.0];
            let value = noise.at(place);
            assert!((0.0..=1.0).contains(&value));
            sum += value;
        }
        assert!((sum / 4000.0 - 0.5).abs() < 0.06, "{}", sum / 4000.0);
        for i in 0..20 {
            let y = i as f32 / 20.0;
            assert!((noise.at([0.0, y]) - noise.at([0.99999, y])).abs() < 1e-2);
        }
    }
}
