//! Sines and cosines of the angles that styles have.

pub(crate) use portable_math::sin_cos_degrees_f32 as sin_cos_degrees;

/// Sine and cosine of an angle in turns.
pub(crate) fn sin_cos_turns(turns: f32) -> (f32, f32) {
    sin_cos_degrees(turns * 360.0)
}
