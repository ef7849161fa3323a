//! Metres in a unit of a file, told by the size of something known.

/// The usual units: name, metres, and how unlikely it is: a factor of e^x in size weighs as much.
pub(super) const UNITS: [(&str, f64, f64); 6] = [
    ("metres", 1.0, 0.0),
    ("centimetres", 0.01, 0.0),
    ("millimetres", 0.001, 0.0),
    ("decimetres", 0.1, 0.3),
    ("inches", 0.0254, 0.6),
    ("feet", 0.3048, 0.8),
];

/// The scale that brings `size` units near `metres`: that of the likeliest usual unit, else of none.
/// `weight`: how much a size that is e times too large or small speaks against a unit.
pub(super) fn scale_to(size: f64, metres: f64, weight: f64) -> f32 {
    if size <= 0.0 {
        return 1.0;
    }
    let off = |unit: f64| (size * unit / metres).ln().abs();
    let unlikely = |unit: &(&str, f64, f64)| weight * off(unit.1) + unit.2;
    let best = UNITS
        .iter()
        .min_by(|a, b| unlikely(a).total_cmp(&unlikely(b)));
    let scale = best
        .map(|unit| unit.1)
        .filter(|unit| weight * off(*unit) < 1.1);
    as_scale(scale.unwrap_or(metres / size))
}

pub(super) fn as_scale(scale: f64) -> f32 {
    scale.clamp(f64::from(f32::MIN_POSITIVE), f64::from(f32::MAX)) as f32
}

pub(super) fn name(scale: f32) -> String {
    let unit = UNITS.iter().find(|unit| unit.1 as f32 == scale);
    unit.map_or_else(
        || format!("{scale:.4e} m a unit"),
        |unit| unit.0.to_string(),
    )
}
