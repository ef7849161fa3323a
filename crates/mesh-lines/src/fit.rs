//! The smooth function that goes near to given points, with a slope near to a given one.

use std::ops::Range;

/// How many basis functions there are at any place.
const AT_ONCE: usize = 4;
/// Weights of E(T): of points, of the slope, of bending (Kalnins et al., *Coherent stylized silhouettes*, 2003, section 5; W as the specification has it).
const POINTS: f64 = 1.0;
const SLOPE: f64 = 1.0;
const BENDING: f64 = 1.0;
/// How long a function is that may bend, in pixels. The points of a shorter one say next to nothing about its slope (it counts for length / 12 of the slope that is
/// asked for), and bending it costs so much that points are lost in rounding; of one that is longer than any picture shows it is the slope that is lost.
const BENT_PX: Range<f64> = 0.01..1e9;

/// A function of length: a uniform cubic B-spline.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Spline {
    start: f64,
    /// Between knots.
    step: f64,
    /// One more than there are pieces, and two.
    coefficients: Vec<f64>,
}

impl Spline {
    /// The T over `range` (px) for which E(T) = 1/n sum (T(s_i) - t_i)^2 + int (T' - slope)^2 ds + int T''^2 ds is least. Knots are about `knot` (px) apart.
    ///
    /// At least one point, and a range with a length. Where that is beyond [`BENT_PX`] T is straight, with that slope.
    pub(crate) fn fit(range: Range<f64>, knot: f64, points: &[(f64, f64)], slope: f64) -> Self {
        let length = range.end - range.start;
        if !BENT_PX.contains(&length) {
            let straight = Self::straight(range, slope);
            let above: f64 = points.iter().map(|&(s, t)| t - straight.at(s)).sum();
            return straight.raised(above / points.len() as f64);
        }
        // However long a line, no more than a picture could show.
        let pieces = (length / knot).round().clamp(1.0, 4096.0) as usize;
        let mut spline = Self {
            start: range.start,
            step: length / pieces as f64,
            coefficients: vec![0.0; pieces + 3],
        };
        let mut system = Banded::new(pieces + 3);
        for &(s, t) in points {
            let (first, basis) = spline.basis(s);
            system.add(first, basis[0], t, POINTS / points.len() as f64);
        }
        // Three points of Gauss and Legendre are exact for the squares of cubics' slopes.
        let gauss = [
            (0.5 - 0.15_f64.sqrt(), 5.0 / 18.0),
            (0.5, 8.0 / 18.0),
            (0.5 + 0.15_f64.sqrt(), 5.0 / 18.0),
        ];
        for piece in 0..pieces {
            for (at, weight) in gauss {
                let (_, [_, first_derivative, second_derivative]) =
                    spline.basis(spline.start + (piece as f64 + at) * spline.step);
                let weight = weight * spline.step;
                system.add(piece, first_derivative, slope, SLOPE * weight);
                system.add(piece, second_derivative, 0.0, BENDING * weight);
            }
        }
        spline.coefficients = system.solve();
        spline
    }

    /// The straight function with this slope that begins at 0.
    pub(crate) fn straight(range: Range<f64>, slope: f64) -> Self {
        let step = range.end - range.start;
        Self {
            start: range.start,
            step,
            coefficients: (0..AT_ONCE)
                .map(|i| (i as f64 - 1.0) * step * slope)
                .collect(),
        }
    }

    fn raised(mut self, by: f64) -> Self {
        self.coefficients.iter_mut().for_each(|c| *c += by);
        self
    }

    /// Its value; beyond the ends the last pieces go on.
    pub(crate) fn at(&self, s: f64) -> f64 {
        let (first, [basis, ..]) = self.basis(s);
        (0..AT_ONCE)
            .map(|i| basis[i] * self.coefficients[first + i])
            .sum()
    }

    #[cfg(test)]
    fn slope_at(&self, s: f64) -> f64 {
        let (first, [_, basis, _]) = self.basis(s);
        (0..AT_ONCE)
            .map(|i| basis[i] * self.coefficients[first + i])
            .sum()
    }

    /// The first coefficient that counts at a place, and the basis functions there with their first and second derivatives.
    fn basis(&self, s: f64) -> (usize, [[f64; AT_ONCE]; 3]) {
        let pieces = self.coefficients.len() - 3;
        let x = (s - self.start) / self.step;
        let first = (x.max(0.0) as usize).min(pieces - 1);
        let x = x - first as f64;
        let y = 1.0 - x;
        let h = self.step;
        let values = [
            y * y * y,
            3.0 * x * x * x - 6.0 * x * x + 4.0,
            3.0 * y * y * y - 6.0 * y * y + 4.0,
            x * x * x,
        ];
        let slopes = [-y * y, 3.0 * x * x - 4.0 * x, -3.0 * y * y + 4.0 * y, x * x];
        let bends = [y, 3.0 * x - 2.0, 3.0 * y - 2.0, x];
        (
            first,
            [
                values.map(|v| v / 6.0),
                slopes.map(|v| v / (2.0 * h)),
                bends.map(|v| v / (h * h)),
            ],
        )
    }
}

/// Normal equations of least squares, of which each row has four neighbouring unknowns.
struct Banded {
    /// Of each unknown the matrix' entries from the diagonal to the right.
    rows: Vec<[f64; AT_ONCE]>,
    right: Vec<f64>,
}

impl Banded {
    fn new(unknowns: usize) -> Self {
        Self {
            rows: vec![[0.0; AT_ONCE]; unknowns],
            right: vec![0.0; unknowns],
        }
    }

    /// Adds `weight (factors . unknowns - value)^2`.
    fn add(&mut self, first: usize, factors: [f64; AT_ONCE], value: f64, weight: f64) {
        for i in 0..AT_ONCE {
            for j in i..AT_ONCE {
                self.rows[first + i][j - i] += weight * factors[i] * factors[j];
            }
            self.right[first + i] += weight * factors[i] * value;
        }
    }

    /// Gauss' elimination, which needs no pivots: the matrix is positive, since a spline without slope is a constant, and points hold that.
    fn solve(self) -> Vec<f64> {
        let Self {
            mut rows,
            mut right,
        } = self;
        let count = rows.len();
        for i in 0..count {
            let row = rows[i];
            for j in 1..AT_ONCE.min(count - i) {
                let factor = row[j] / row[0];
                for k in j..AT_ONCE {
                    rows[i + j][k - j] -= factor * row[k];
                }
                right[i + j] -= factor * right[i];
            }
        }
        for i in (0..count).rev() {
            let known: f64 = (1..AT_ONCE.min(count - i))
                .map(|j| rows[i][j] * right[i + j])
                .sum();
            right[i] = (right[i] - known) / rows[i][0];
        }
        right
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// E(T) by its definition, in small steps.
    fn energy(spline: &Spline, range: Range<f64>, points: &[(f64, f64)], slope: f64) -> f64 {
        let off: f64 = points
            .iter()
            .map(|&(s, t)| (spline.at(s) - t).powi(2))
            .sum();
        let steps = 4000;
        let ds = (range.end - range.start) / f64::from(steps);
        let smooth: f64 = (0..steps)
            .map(|i| {
                let s = range.start + (f64::from(i) + 0.5) * ds;
                let bend = (spline.slope_at(s + 0.01) - spline.slope_at(s - 0.01)) / 0.02;
                ((spline.slope_at(s) - slope).powi(2) + bend * bend) * ds
            })
            .sum();
        off / points.len() as f64 + smooth
    }

    proptest! {
        #[test]
        fn what_is_fitted_has_the_least_energy(
            points in prop::collection::vec((0.0..300.0f64, -50.0..50.0f64), 1..30),
            shake in prop::collection::vec(-0.5..0.5f64, 9),
        ) {
            let points: Vec<(f64, f64)> = points.iter().map(|&(s, d)| (s + 20.0, s + d)).collect();
            let spline = Spline::fit(20.0..320.0, 48.0, &points, 1.0);
            prop_assert_eq!(spline.coefficients.len(), 9);
            let least = energy(&spline, 20.0..320.0, &points, 1.0);
            let mut other = spline.clone();
            other.coefficients.iter_mut().zip(&shake).for_each(|(c, d)| *c += d);
            prop_assert!(energy(&other, 20.0..320.0, &points, 1.0) >= least * (1.0 - 1e-6));
        }

        #[test]
        fn however_short_or_long_it_is_finite_and_near_its_points(
            magnitude in -300..300i32,
            points in prop::collection::vec((0.0..1.0f64, -50.0..50.0f64), 1..9),
        ) {
            let length = 10_f64.powi(magnitude);
            let slope = 0.01;
            let points: Vec<(f64, f64)> = points.iter().map(|&(s, d)| (s * length, s * length * slope + d)).collect();
            let spline = Spline::fit(0.0..length, 48.0, &points, slope);
            // What rounding leaves of values so large.
            let slack = 1e-6 + length * slope * 1e-14;
            for share in [0.0, 0.3, 1.0] {
                let off = spline.at(length * share) - length * share * slope;
                prop_assert!(off.abs() < 200.0 + slack, "{} {}", length, off);
            }
            if length < 1.0 {
                let above: f64 = points.iter().map(|&(s, t)| t - spline.at(s)).sum();
                prop_assert!((above / points.len() as f64).abs() < slack, "{} {}", length, above);
            }
        }

        #[test]
        fn a_straight_line_is_fitted_exactly(length in 1.0..5000.0f64, slope in 0.01..3.0f64, shift in -1e4..1e4f64) {
            let points: Vec<(f64, f64)> = (0..9).map(|i| length * f64::from(i) / 8.0).map(|s| (s, shift + slope * s)).collect();
            let spline = Spline::fit(0.0..length, 48.0, &points, slope);
            let straight = Spline::straight(0.0..length, slope);
            for (s, t) in points {
                prop_assert!((spline.at(s) - t).abs() < 1e-6, "{} {}", spline.at(s), t);
                prop_assert!((straight.at(s) + shift - t).abs() < 1e-6);
                prop_assert!((spline.slope_at(s) - slope).abs() < 1e-6);
            }
        }
    }
}
