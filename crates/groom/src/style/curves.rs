//! Curves from 0 to 1 that shapes follow.

/// 0 at both ends, 1 in the middle.
pub(super) fn arch(t: f32) -> f32 {
    4.0 * t * (1.0 - t)
}

/// From 0 to 1, level at both ends.
pub(super) fn smooth(t: f32) -> f32 {
    let t = t.clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// Slow at both ends.
pub(super) fn eased(t: f32) -> f32 {
    0.5 * (smooth(t) + t)
}
