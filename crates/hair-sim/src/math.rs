//! Sine and cosine of our own: the platform's differ in the last bits from one machine to the next, and a strand
//! must not.

use std::f64::consts::FRAC_PI_2;

/// The sine of `x` radians, within 3e-16 for |x| < 1e4.
pub(crate) fn sin(x: f64) -> f64 {
    let (quadrant, r) = reduce(x);
    in_quadrant(quadrant, r)
}

/// The cosine of `x` radians.
pub(crate) fn cos(x: f64) -> f64 {
    let (quadrant, r) = reduce(x);
    in_quadrant((quadrant + 1) % 4, r)
}

/// The sine of quadrant pi / 2 + r.
fn in_quadrant(quadrant: i64, r: f64) -> f64 {
    match quadrant {
        0 => sin_core(r),
        1 => cos_core(r),
        2 => -sin_core(r),
        _ => -cos_core(r),
    }
}

/// `x` = quadrant pi / 2 + r with |r| <= pi / 4.
fn reduce(x: f64) -> (i64, f64) {
    // pi / 2 in two parts, the first with zeros at its end (Cody and Waite).
    const HIGH: f64 = 1.570_796_326_734_125_6;
    const LOW: f64 = 6.077_100_506_506_192e-11;
    let k = (x * (1.0 / FRAC_PI_2)).round();
    ((k as i64).rem_euclid(4), (x - k * HIGH) - k * LOW)
}

/// Taylor's polynomial to x^17.
fn sin_core(x: f64) -> f64 {
    let s = x * x;
    let mut sum = 0.0;
    for k in (1..=8).rev() {
        let n = f64::from(2 * k);
        sum = -(s / (n * (n + 1.0))) * (1.0 + sum);
    }
    x + x * sum
}

/// Taylor's polynomial to x^18.
fn cos_core(x: f64) -> f64 {
    let s = x * x;
    let mut sum = 0.0;
    for k in (1..=9).rev() {
        let n = f64::from(2 * k);
        sum = -(s / (n * (n - 1.0))) * (1.0 + sum);
    }
    1.0 + sum
}

#[cfg(test)]
mod properties;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sine_and_cosine_are_those_of_the_platform() {
        for i in -4000..4000 {
            let x = f64::from(i) * 0.037;
            assert!((sin(x) - x.sin()).abs() < 1e-15, "{x}");
            assert!((cos(x) - x.cos()).abs() < 1e-15, "{x}");
        }
        assert!((sin(5e5) - 5e5_f64.sin()).abs() < 1e-9);
    }
}
