//! Colours as screens have them.

/// The linear value of an sRGB one, both from 0 to 1 (IEC 61966-2-1). No `powf`: it has different bits
/// on different machines.
#[must_use]
pub fn linear_from_srgb(encoded: f64) -> f64 {
    if encoded <= 0.04045 {
        return encoded / 12.92;
    }
    // b^2.4 = b^2 (b^2)^(1/5)
    let square = ((encoded + 0.055) / 1.055) * ((encoded + 0.055) / 1.055);
    square * fifth_root(square)
}

/// By Newton's method from above, for values from 0.005 to 1; 16 steps are twice what those need.
fn fifth_root(value: f64) -> f64 {
    (0..16).fold(1.0, |y: f64, _| (4.0 * y + value / (y * y * y * y)) / 5.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn fifth_root_is_exact(value in 0.005..=1.0_f64) {
            let root = fifth_root(value);
            prop_assert!((root.powi(5) - value).abs() < 1e-14);
        }
    }
}
