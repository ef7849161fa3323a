//! Symmetric positive definite systems whose unknowns know only near neighbours.

/// A band matrix, lower half: `WIDTH` entries a row, of which the last is the diagonal.
#[derive(Clone, Debug)]
pub(super) struct Banded<const WIDTH: usize> {
    rows: Vec<[f64; WIDTH]>,
}

impl<const WIDTH: usize> Banded<WIDTH> {
    /// All zero, `size` unknowns.
    pub fn new(size: usize) -> Self {
        Self {
            rows: vec![[0.0; WIDTH]; size],
        }
    }

    /// Sets all entries to zero.
    pub fn clear(&mut self) {
        self.rows.fill([0.0; WIDTH]);
    }

    /// The entry at `row` and `column` of the lower half: `column` <= `row` < `column` + `WIDTH`.
    pub fn at(&mut self, row: usize, column: usize) -> &mut f64 {
        &mut self.rows[row][WIDTH - 1 + column - row]
    }

    /// Replaces the matrix by its factor (Cholesky) and `right` by the solution.
    ///
    /// False if the matrix is not positive definite; then neither has a meaning.
    pub fn solve(&mut self, right: &mut [f64]) -> bool {
        let size = self.rows.len();
        for i in 0..size {
            let first = (i + 1).saturating_sub(WIDTH);
            for j in first..=i {
                let mut sum = self.rows[i][WIDTH - 1 + j - i];
                // Both rows have entries from the later of their first columns.
                for k in first.max((j + 1).saturating_sub(WIDTH))..j {
                    sum -= self.rows[i][WIDTH - 1 + k - i] * self.rows[j][WIDTH - 1 + k - j];
                }
                self.rows[i][WIDTH - 1 + j - i] = if j < i {
                    sum / self.rows[j][WIDTH - 1]
                } else if sum > 0.0 {
                    sum.sqrt()
                } else {
                    return false;
                };
            }
        }
        for i in 0..size {
            for k in (i + 1).saturating_sub(WIDTH)..i {
                right[i] -= self.rows[i][WIDTH - 1 + k - i] * right[k];
            }
            right[i] /= self.rows[i][WIDTH - 1];
        }
        for i in (0..size).rev() {
            right[i] /= self.rows[i][WIDTH - 1];
            for k in (i + 1).saturating_sub(WIDTH)..i {
                right[k] -= self.rows[i][WIDTH - 1 + k - i] * right[i];
            }
        }
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn solves_what_it_is_given() {
        // A = B B^T + I with B of half the band, all entries different.
        let (size, width) = (17, 5);
        let entry = |i: usize, j: usize| ((3 * i + 7 * j) % 11) as f64 - 4.0;
        let full = |i: usize, j: usize| {
            let shared = (0..size).filter(|k| i.abs_diff(*k) < 3 && j.abs_diff(*k) < 3);
            let sum: f64 = shared.map(|k| entry(i, k) * entry(j, k)).sum();
            sum + if i == j { 1.0 } else { 0.0 }
        };
        let mut matrix = Banded::<5>::new(size);
        for i in 0..size {
            for j in (i + 1).saturating_sub(width)..=i {
                *matrix.at(i, j) = full(i, j);
            }
        }
        let truth: Vec<f64> = (0..size).map(|i| (i as f64).sin()).collect();
        let mut right: Vec<f64> = (0..size)
            .map(|i| (0..size).map(|j| full(i, j) * truth[j]).sum())
            .collect();
        assert!(matrix.solve(&mut right));
        for (found, truth) in right.iter().zip(truth) {
            assert!((found - truth).abs() < 1e-9, "{found} {truth}");
        }
    }

    #[test]
    fn what_is_not_positive_definite_is_refused() {
        let mut matrix = Banded::<2>::new(2);
        *matrix.at(0, 0) = 1.0;
        *matrix.at(1, 0) = 2.0;
        *matrix.at(1, 1) = 1.0;
        assert!(!matrix.solve(&mut [1.0, 1.0]));
    }
}
