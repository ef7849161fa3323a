//! Sines and cosines with the same bits on every platform.

/// Sine and cosine of an angle in degrees.
pub(crate) fn sin_cos_degrees(degrees: f32) -> (f32, f32) {
    // Fold to [-45, 45] degrees, where short Taylor series are exact to f32.
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

/// Sine and cosine of an angle in turns.
pub(crate) fn sin_cos_turns(turns: f32) -> (f32, f32) {
    sin_cos_degrees(turns * 360.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn they_are_sines_and_cosines() {
        for degrees in -800..800 {
            let (sin, cos) = sin_cos_degrees(degrees as f32);
            let radians = f64::from(degrees).to_radians();
            assert!((f64::from(sin) - radians.sin()).abs() < 1e-7, "{degrees}");
            assert!((f64::from(cos) - radians.cos()).abs() < 1e-7, "{degrees}");
        }
    }
}
