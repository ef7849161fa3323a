//! How a number varies along a strand, and from strand to strand.

use crate::texture::{choose, least, most};
use crate::wgsl::random_signed;
use serde::Deserialize;

/// How a number varies.
#[derive(Clone, Debug, PartialEq)]
pub struct Variation {
    /// Places along the strand, 0 at the root to 1 at the tip, never falling, with the values there.
    /// Linear between them, constant before the first and after the last. At least one.
    pub curve: Vec<(f32, f32)>,
    /// How much strands differ: 0.2 makes the value up to 20 % smaller or larger. 0 to 1.
    pub vary: f32,
}

/// As it is written in a preset.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Written {
    value: Option<f32>,
    curve: Option<Vec<(f32, f32)>>,
    vary: Option<f32>,
}

impl Variation {
    /// Reads `(value: 2, vary: 0.2)` or `(curve: [(0, 1), (0.5, 2), (1, 0)], vary: 0.2)`, of values
    /// from `min` to `max`.
    pub(crate) fn parse(text: &str, min: f32, max: f32) -> Result<Self, String> {
        let options = ron::Options::default()
            .with_default_extension(ron::extensions::Extensions::IMPLICIT_SOME);
        let written: Written = options.from_str(text).map_err(|error| match error.code {
            ron::Error::NoSuchStructField { found, .. } => {
                format!("there is no `{found:.40}` in it")
            }
            _ => "it is no variation".to_owned(),
        })?;
        let curve = match (written.value, written.curve) {
            (Some(value), None) => vec![(0.0, value)],
            (None, Some(curve)) => curve,
            (Some(_), Some(_)) => return Err("it has a `value` and a `curve`".to_owned()),
            (None, None) => return Err("it has neither `value` nor `curve`".to_owned()),
        };
        if curve.is_empty() {
            return Err("the curve is empty".to_owned());
        }
        let mut before = 0.0;
        for &(place, value) in &curve {
            if !(place >= before && place <= 1.0) {
                return Err(format!(
                    "the curve's places must rise from 0, the root, to 1, the tip: {place} after {before}"
                ));
            }
            if !(value >= min && value <= max) {
                return Err(format!("{value} is not from {min} to {max}"));
            }
            before = place;
        }
        let vary = written.vary.unwrap_or(0.0);
        if !(0.0..=1.0).contains(&vary) {
            return Err(format!("vary is from 0 to 1, found {vary}"));
        }
        Ok(Self { curve, vary })
    }

    /// The same everywhere.
    #[must_use]
    pub fn constant(value: f32) -> Self {
        Self {
            curve: vec![(0.0, value)],
            vary: 0.0,
        }
    }

    /// The value where it is the same everywhere.
    #[must_use]
    pub fn as_constant(&self) -> Option<f32> {
        let (_, first) = self.curve[0];
        let is_same = self.curve.iter().all(|(_, value)| *value == first);
        (is_same && self.vary == 0.0).then_some(first)
    }

    /// The value at `u` along the strand.
    #[must_use]
    pub fn at(&self, u: f32) -> f32 {
        let next = self.curve.partition_point(|(place, _)| *place <= u);
        let Some(&(start, from)) = next.checked_sub(1).and_then(|i| self.curve.get(i)) else {
            return self.curve[0].1;
        };
        match self.curve.get(next) {
            Some(&(end, to)) => from + (to - from) * (u - start) / (end - start),
            None => from,
        }
    }
}

/// A parameter that varies.
#[derive(Clone, Debug)]
pub(crate) struct Varying {
    /// Of the parameter in its table.
    pub(crate) index: usize,
    /// From the parameter's name, so that parameters vary apart from each other.
    pub(crate) seed: u32,
    pub(crate) range: [f32; 2],
    pub(crate) variation: Variation,
}

impl Varying {
    /// The value at `u` along a strand whose seed in the layer is `strand`.
    pub(crate) fn at(&self, u: f32, strand: u32) -> f32 {
        let [min, max] = self.range;
        (self.variation.at(u) * self.factor(strand)).clamp(min, max)
    }

    /// How much larger it is on such a strand.
    #[inline(always)]
    fn factor(&self, strand: u32) -> f32 {
        1.0 + self.variation.vary * random_signed(strand ^ self.seed, 0)
    }

    /// [`Self::at`] of many places at once, by loops that compile to vector instructions.
    #[inline(always)]
    pub(crate) fn at_all<const N: usize>(&self, u: &[f32; N], strand: &[u32; N]) -> [f32; N] {
        let curve = &self.variation.curve;
        let mut values = [curve[0].1; N];
        for (piece, &(start, from)) in curve.iter().enumerate() {
            let (end, to) = curve
                .get(piece + 1)
                .copied()
                .unwrap_or((f32::INFINITY, from));
            for k in 0..N {
                let value = from + (to - from) * (u[k] - start) / (end - start);
                // Of pieces that begin before a place the last one counts.
                values[k] = choose(start <= u[k], value, values[k]);
            }
        }
        let [min, max] = self.range;
        let varies = self.variation.vary > 0.0;
        for k in 0..N {
            let factor = if varies { self.factor(strand[k]) } else { 1.0 };
            values[k] = least(most(values[k] * factor, min), max);
        }
        values
    }

    /// The largest value on any strand.
    pub(crate) fn greatest(&self) -> f32 {
        let Variation { curve, vary } = &self.variation;
        let [min, max] = self.range;
        let values = curve
            .iter()
            .map(|(_, value)| value * (1.0 + vary * value.signum()));
        values.fold(min, f32::max).min(max)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(text: &str) -> Result<Variation, String> {
        Variation::parse(text, 0.0, 10.0)
    }

    #[test]
    fn curves_are_linear_between_their_places() {
        let curve = parse("(curve: [(0.2, 1), (0.4, 3), (0.4, 5), (1, 0)])").unwrap();
        for (u, value) in [
            (0.0, 1.0),
            (0.2, 1.0),
            (0.3, 2.0),
            (0.4, 5.0),
            (0.7, 2.5),
            (1.0, 0.0),
        ] {
            assert!((curve.at(u) - value).abs() < 1e-6, "{u}: {}", curve.at(u));
        }
        let value = parse("(value: 4, vary: 0.5)").unwrap();
        assert_eq!((value.at(0.0), value.at(1.0), value.vary), (4.0, 4.0, 0.5));
    }

    #[test]
    fn many_places_at_once_are_each_by_itself() {
        let curves = [
            "(value: 4, vary: 0.5)",
            "(curve: [(0.2, 1), (0.4, 3), (0.4, 5), (1, 0)])",
            "(curve: [(0, 7), (0, 2), (0.5, 9), (0.9, 9)], vary: 1)",
        ];
        for text in curves {
            let varying = Varying {
                index: 0,
                seed: 5,
                range: [0.0, 8.0],
                variation: parse(text).unwrap(),
            };
            let u: [f32; 101] = std::array::from_fn(|k| k as f32 / 100.0);
            let strand: [u32; 101] = std::array::from_fn(|k| 77 * k as u32);
            let all = varying.at_all(&u, &strand);
            for k in 0..101 {
                let one = varying.at(u[k], strand[k]);
                assert_eq!(all[k].to_bits(), one.to_bits(), "{text} at {}", u[k]);
            }
        }
    }

    #[test]
    fn mistakes_are_told() {
        for (text, expected) in [
            ("()", "neither"),
            ("(value: 1, curve: [(0, 1)])", "a `value` and a `curve`"),
            ("(curve: [])", "empty"),
            ("(curve: [(0.5, 1), (0.2, 1)])", "0.2 after 0.5"),
            ("(curve: [(0, 1), (1.5, 1)])", "1.5 after 0"),
            ("(curve: [(0, 11)])", "11 is not from 0 to 10"),
            ("(value: NaN)", "NaN is not"),
            ("(curve: [(NaN, 1)])", "NaN after 0"),
            ("(value: 1, vary: 2)", "from 0 to 1, found 2"),
            ("(value: 1, vari: 0.2)", "no `vari`"),
            ("(2.4)", "no variation"),
        ] {
            let message = parse(text).unwrap_err();
            assert!(message.contains(expected), "{text}: {message}");
        }
    }
}
