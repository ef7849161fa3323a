//! Sine and cosine with the same bits on every platform.
//!
//! The standard library's come from the platform's mathematics library, whose last bits differ.

/// Sine and cosine of a finite angle in degrees, to within 1e-12.
///
/// Multiples of 90 degrees are exact, and so is the reduction of large angles.
#[must_use]
pub fn sin_cos_degrees(degrees: f64) -> (f64, f64) {
    let turned = degrees % 360.0;
    let quadrant = (turned / 90.0).round();
    let radians = (turned - 90.0 * quadrant).to_radians();
    let sin = radians * series(radians * radians, 1.0);
    let cos = series(radians * radians, 0.0);
    match (quadrant as i32).rem_euclid(4) {
        0 => (sin, cos),
        1 => (cos, -sin),
        2 => (-sin, -cos),
        _ => (-cos, sin),
    }
}

/// The same in single precision, to within 1e-7, by a shorter series: its bits are not those of [`sin_cos_degrees`] rounded.
#[must_use]
pub fn sin_cos_degrees_f32(degrees: f32) -> (f32, f32) {
    // Fold to [-45, 45] degrees, where short Taylor series are good to 2e-9.
    let quarter = (f64::from(degrees) / 90.0).round();
    let x = (f64::from(degrees) - quarter * 90.0) * (std::f64::consts::PI / 180.0);
    let z = x * x;
    let sin =
        x * (1.0 + z * (-1.0 / 6.0 + z * (1.0 / 120.0 + z * (-1.0 / 5040.0 + z / 362_880.0))));
    let cos = 1.0 + z * (-0.5 + z * (1.0 / 24.0 + z * (-1.0 / 720.0 + z / 40_320.0)));
    let (sin, cos) = (sin as f32, cos as f32);
    match quarter.rem_euclid(4.0) as u32 {
        0 => (sin, cos),
        1 => (cos, -sin),
        2 => (-sin, -cos),
        _ => (-cos, sin),
    }
}

/// Taylor's series of cos x (`odd` = 0) or sin x / x (`odd` = 1) for |x| <= pi / 4, where what is
/// left out is below 1e-16.
fn series(x_squared: f64, odd: f64) -> f64 {
    (1..=8).rev().fold(1.0, |sum, k| {
        let n = 2.0 * f64::from(k) + odd;
        1.0 - x_squared / (n * (n - 1.0)) * sum
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn quarter_turns_are_exact() {
        for turns in [-4001.0, -4.0, 0.0, 1.0, 1000.0] {
            let degrees = turns * 360.0;
            assert_eq!(sin_cos_degrees(degrees), (0.0, 1.0));
            assert_eq!(sin_cos_degrees(degrees + 90.0), (1.0, 0.0));
            assert_eq!(sin_cos_degrees(degrees + 180.0), (0.0, -1.0));
            assert_eq!(sin_cos_degrees(degrees - 90.0), (-1.0, 0.0));
        }
    }

    #[test]
    fn known_bits() {
        // The exact values, rounded.
        let (sin, cos) = sin_cos_degrees(37.0);
        assert_eq!(sin.to_bits(), 0x3fe3_4211_9455_beb6);
        assert_eq!(cos.to_bits(), 0x3fe9_8e6c_0ea2_7a14);
    }

    #[test]
    fn single_precision_is_good_to_its_last_bits() {
        for degrees in -800..800 {
            let (sin, cos) = sin_cos_degrees_f32(degrees as f32);
            let radians = f64::from(degrees).to_radians();
            assert!((f64::from(sin) - radians.sin()).abs() < 1e-7, "{degrees}");
            assert!((f64::from(cos) - radians.cos()).abs() < 1e-7, "{degrees}");
        }
    }

    proptest! {
        #[test]
        fn agrees_with_the_standard_library(degrees in -720.0..720.0_f64) {
            let (sin, cos) = sin_cos_degrees(degrees);
            prop_assert!((sin - degrees.to_radians().sin()).abs() < 1e-12);
            prop_assert!((cos - degrees.to_radians().cos()).abs() < 1e-12);
        }

        #[test]
        fn any_finite_angle_gives_a_unit_vector(degrees in proptest::num::f64::NORMAL) {
            let (sin, cos) = sin_cos_degrees(degrees);
            prop_assert!((sin * sin + cos * cos - 1.0).abs() < 1e-12);
        }
    }
}
