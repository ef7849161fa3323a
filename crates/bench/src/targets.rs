//! What measured figures are held to, and curves of time against error.

use crate::results::Row;
use std::fmt::Write as _;

/// A figure, and what it should be.
#[derive(Clone, Debug, PartialEq)]
pub struct Target {
    /// Of what, on which scene.
    pub text: String,
    /// Measured; an infinite ratio of times if our method never gets there, nothing if a row is missing.
    pub found: Option<Found>,
    /// What it should be.
    pub limit: Limit,
}

/// A measured figure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Found {
    /// As measured.
    Is(f64),
    /// The other method didn't get there within its knob, so its time is longer than its longest, and the ratio
    /// below this.
    Below(f64),
}

/// What a figure should be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Limit {
    /// At most this.
    AtMost(f64),
    /// At least this.
    AtLeast(f64),
}

impl Target {
    /// True if it was measured and reached.
    #[must_use]
    pub fn is_met(&self) -> bool {
        match (self.found, self.limit) {
            (Some(Found::Is(found) | Found::Below(found)), Limit::AtMost(limit)) => found <= limit,
            (Some(Found::Is(found)), Limit::AtLeast(limit)) => found >= limit,
            (Some(Found::Below(_)) | None, _) => false,
        }
    }
}

/// A point of a method's curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// Its time.
    pub seconds: f64,
    /// Its error.
    pub error: f64,
}

/// A method's times and errors by rising knob.
#[must_use]
pub fn curve(rows: &[&Row], method: &str) -> Vec<Point> {
    let mut rows: Vec<&&Row> = rows.iter().filter(|row| row.method == method).collect();
    rows.sort_by_key(|row| row.knob);
    rows.iter()
        .filter_map(|row| {
            Some(Point {
                seconds: row.seconds,
                error: row.error?,
            })
        })
        .collect()
}

/// The time at which a curve first comes down to `error`, between two points along a straight line
/// in logarithms; the first point's time where that is good enough already.
#[must_use]
pub fn time_at(curve: &[Point], error: f64) -> Option<f64> {
    let place = curve.iter().position(|point| point.error <= error)?;
    let after = curve[place];
    let Some(before) = place.checked_sub(1).map(|place| curve[place]) else {
        return Some(after.seconds);
    };
    if after.error <= 0.0 || error <= 0.0 {
        return Some(after.seconds); // zero has no logarithm
    }
    let way = (error / before.error).ln() / (after.error / before.error).ln();
    Some(before.seconds * (after.seconds / before.seconds).powf(way))
}

/// The table of all targets, a line each.
#[must_use]
pub fn report(targets: &[Target]) -> String {
    let width = targets.iter().map(|t| t.text.chars().count()).max();
    let width = width.unwrap_or(0);
    let mut text = format!("{:width$}  measured    to reach\n", "");
    for target in targets {
        let found = match target.found {
            Some(Found::Is(found)) if found.is_infinite() => "  never".to_owned(),
            Some(Found::Is(found)) => format!("  {}", figure(found)),
            Some(Found::Below(found)) => format!("< {}", figure(found)),
            None => "  not measured".to_owned(),
        };
        let limit = match target.limit {
            Limit::AtMost(limit) => format!("<= {}", figure(limit)),
            Limit::AtLeast(limit) => format!(">= {}", figure(limit)),
        };
        let verdict = if target.is_met() { "met" } else { "MISSED" };
        let _ = writeln!(
            text,
            "{:width$} {found:>10}  {limit:9}   {verdict}",
            target.text
        );
    }
    text
}

/// Three digits behind the point, or what a small or large number needs.
fn figure(value: f64) -> String {
    match value.abs() {
        size if size >= 100.0 => format!("{value:.0}"),
        size if size > 0.0 && size < 0.01 => format!("{value:.1e}"),
        _ => format!("{value:.3}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn target(found: Option<Found>, limit: Limit) -> Target {
        Target {
            text: "a figure".to_owned(),
            found,
            limit,
        }
    }

    #[test]
    fn figures_are_met_or_missed() {
        let is = |value| Some(Found::Is(value));
        for (found, limit, met) in [
            (is(0.2), Limit::AtMost(0.2), true),
            (is(0.21), Limit::AtMost(0.2), false),
            (is(f64::NAN), Limit::AtMost(0.2), false),
            (is(f64::INFINITY), Limit::AtMost(0.2), false),
            (Some(Found::Below(0.1)), Limit::AtMost(0.2), true),
            (is(1.9), Limit::AtLeast(1.8), true),
            (is(1.7), Limit::AtLeast(1.8), false),
            (Some(Found::Below(9.0)), Limit::AtLeast(1.8), false),
            (None, Limit::AtMost(0.2), false),
        ] {
            let target = target(found, limit);
            assert_eq!(target.is_met(), met, "{target:?}");
        }
    }

    #[test]
    fn the_table_shows_figures_of_any_size() {
        let targets = [
            target(Some(Found::Is(2.5e7)), Limit::AtLeast(2e7)),
            target(Some(Found::Is(1.2e-4)), Limit::AtMost(0.5)),
            target(Some(Found::Is(f64::INFINITY)), Limit::AtMost(1.0)),
            target(None, Limit::AtMost(1.0)),
        ];
        let table = report(&targets);
        for text in ["25000000", "1.2e-4", "<= 0.500", "never", "not measured"] {
            assert!(table.contains(text), "{table}");
        }
        assert_eq!(table.matches("MISSED").count(), 2);
    }

    #[test]
    fn between_points_times_are_on_straight_lines_in_logarithms() {
        let curve = [(1.0, 0.16), (4.0, 0.01)].map(|(seconds, error)| Point { seconds, error });
        assert!((time_at(&curve, 0.04).unwrap() - 2.0).abs() < 1e-12);
        assert_eq!(time_at(&curve, 0.5), Some(1.0));
        assert_eq!(time_at(&curve, 0.001), None);
    }
}
