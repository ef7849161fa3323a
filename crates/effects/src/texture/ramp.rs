//! Gradients as text: `[(0, "2A8F9D"), (0.5, "3FC1C0")]`.

use crate::color::parse_hex;
use crate::samples::{BLOCK, Vectors};
use crate::wgsl::vec3;
use serde::Deserialize;

/// A gradient, or several of which one turns into the next.
#[derive(Clone, Debug, PartialEq)]
pub struct Ramp {
    rows: Vec<Row>,
}

/// One gradient.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// Its place among the rows: the colour between two rows is between theirs.
    pub v: f32,
    /// Whether each colour goes on up to the next, in place of turning into it.
    pub steps: bool,
    /// Places with their colours, linear. At least one, never falling. Constant before the first and after the last.
    pub stops: Vec<(f32, [f32; 3])>,
}

/// A row as it is written in a preset.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Written {
    v: Option<f32>,
    stops: Option<Vec<(f32, String)>>,
    steps: Option<Vec<(f32, String)>>,
}

/// Rows of one gradient, and stops of one row, at most.
const MOST: usize = 256;

impl Ramp {
    /// A gradient of these rows.
    ///
    /// # Errors
    ///
    /// When there are no rows, or more than 256; a row has no stops, or more than 256; or places fall, or aren't finite. Says which.
    pub fn new(rows: Vec<Row>) -> Result<Self, String> {
        within("rows", rows.len())?;
        rising("the rows' `v`", rows.iter().map(|row| row.v))?;
        for row in &rows {
            within("stops", row.stops.len())?;
            rising("the stops' places", row.stops.iter().map(|stop| stop.0))?;
        }
        Ok(Self { rows })
    }

    /// Reads `[(0, "2A8F9D"), (0.5, "3FC1C0")]`, `(steps: [..])` or `[(v: 0, stops: [..]), (v: 1, steps: [..])]`.
    pub(crate) fn parse(text: &str) -> Result<Self, String> {
        let options = ron::Options::default()
            .with_default_extension(ron::extensions::Extensions::IMPLICIT_SOME);
        let written = if text.starts_with('(') {
            vec![
                options
                    .from_str::<Written>(text)
                    .map_err(|error| fault(&error.code))?,
            ]
        } else if let Ok(stops) = options.from_str::<Vec<(f32, String)>>(text) {
            vec![Written {
                v: None,
                stops: Some(stops),
                steps: None,
            }]
        } else {
            let rows = options.from_str::<Vec<Written>>(text);
            rows.map_err(|error| fault(&error.code))?
        };
        let several = written.len() > 1;
        let rows = written.into_iter().map(|row| {
            if several && row.v.is_none() {
                return Err("each of several rows has its place: (v: 0.5, stops: [..])".to_owned());
            }
            row.read()
        });
        Self::new(rows.collect::<Result<_, _>>()?)
    }

    /// Its rows, at least one.
    #[must_use]
    pub fn rows(&self) -> &[Row] {
        &self.rows
    }

    /// The linear colour at place `x` of the rows at `y`.
    #[must_use]
    pub fn at(&self, x: f32, y: f32) -> [f32; 3] {
        let next = self.rows.partition_point(|row| row.v <= y);
        let before = &self.rows[next.saturating_sub(1)];
        match self.rows.get(next) {
            Some(after) if next > 0 => {
                let share = (y - before.v) / (after.v - before.v);
                mix(before.at(x), after.at(x), share)
            }
            _ => before.at(x),
        }
    }

    /// Whether it has so few stops that it takes less to go through all of them for many samples at once than to find each sample's.
    pub(crate) fn is_short(&self) -> bool {
        let stops = self.rows.iter().map(|row| row.stops.len());
        stops.sum::<usize>() <= SHORT
    }

    /// [`Self::at`] the places of a block; one that isn't finite is 0.
    #[inline(always)] // compiled for its caller's instructions
    pub(crate) fn of_block(&self, x: &[f32; BLOCK], y: &[f32; BLOCK], colors: &mut Vectors) {
        let (x, y) = (finite(x), finite(y));
        // Rows that none of them reaches are left out.
        let (mut lowest, mut highest) = (y[0], y[0]);
        for y in y {
            lowest = if y < lowest { y } else { lowest };
            highest = if y > highest { y } else { highest };
        }
        let first = self.rows.partition_point(|row| row.v <= lowest);
        let rows = &self.rows[first.saturating_sub(1)..];
        let mut before = &rows[0];
        before.of_block(&x, colors);
        let (mut from, mut to) = (colors.clone(), Vectors::NOTHING);
        for row in &rows[1..] {
            if before.v > highest {
                break;
            }
            row.of_block(&x, &mut to);
            let width = row.v - before.v;
            for i in 0..BLOCK {
                let share = (y[i] - before.v) / width;
                let pair = [from.at(i), to.at(i)].map(|color| color.to_array());
                let between = mix(pair[0], pair[1], share);
                let color = choose(y[i] >= before.v, between, colors.at(i).to_array());
                let color = choose(y[i] >= row.v, pair[1], color);
                colors.set(i, vec3(color));
            }
            std::mem::swap(&mut from, &mut to);
            before = row;
        }
    }

    /// As a preset has it.
    #[must_use]
    pub fn written(&self) -> String {
        let row = |row: &Row| {
            let stops = row.stops.iter().map(|(place, color)| {
                let hex = crate::color::to_hex(*color);
                format!("({place}, \"{hex}\")")
            });
            format!("[{}]", stops.collect::<Vec<_>>().join(", "))
        };
        let kind = |row: &Row| if row.steps { "steps" } else { "stops" };
        match &self.rows[..] {
            [one] if !one.steps => row(one),
            [one] => format!("(steps: {})", row(one)),
            rows => {
                let rows = rows
                    .iter()
                    .map(|r| format!("(v: {}, {}: {})", r.v, kind(r), row(r)));
                format!("[{}]", rows.collect::<Vec<_>>().join(", "))
            }
        }
    }

    /// Its words for a graphics card: the number of rows; for each its `v`, 1 where it has steps, and where its stops begin among
    /// these words and end; then the stops, a place and three of colour each.
    #[must_use]
    pub fn words(&self) -> Vec<u32> {
        let mut words = vec![self.rows.len() as u32];
        let mut start = 1 + 4 * self.rows.len();
        for row in &self.rows {
            let end = start + 4 * row.stops.len();
            words.extend([row.v.to_bits(), row.steps.into(), start as u32, end as u32]);
            start = end;
        }
        for (place, color) in self.rows.iter().flat_map(|row| &row.stops) {
            words.push(place.to_bits());
            words.extend(color.map(f32::to_bits));
        }
        words
    }
}

/// Stops of a short gradient at most.
const SHORT: usize = 32;

/// The numbers, 0 for those that aren't finite.
#[inline(always)]
fn finite(numbers: &[f32; BLOCK]) -> [f32; BLOCK] {
    let mut finite = *numbers;
    for number in &mut finite {
        *number = if number.is_finite() { *number } else { 0.0 };
    }
    finite
}

#[inline(always)]
fn choose(condition: bool, then: [f32; 3], otherwise: [f32; 3]) -> [f32; 3] {
    let [a, b, c] = then;
    let [d, e, f] = otherwise;
    if condition { [a, b, c] } else { [d, e, f] }
}

impl Row {
    /// [`Self::at`] the places of a block.
    #[inline(always)]
    fn of_block(&self, x: &[f32; BLOCK], colors: &mut Vectors) {
        let (mut start, mut from) = self.stops[0];
        for i in 0..BLOCK {
            colors.set(i, vec3(from));
        }
        for &(end, to) in &self.stops[1..] {
            let width = end - start;
            for i in 0..BLOCK {
                let before = colors.at(i).to_array();
                let between = match self.steps {
                    true => from,
                    false => mix(from, to, (x[i] - start) / width),
                };
                let color = choose(x[i] >= start, between, before);
                colors.set(i, vec3(choose(x[i] >= end, to, color)));
            }
            (start, from) = (end, to);
        }
    }

    fn at(&self, x: f32) -> [f32; 3] {
        let next = self.stops.partition_point(|(place, _)| *place <= x);
        let (start, from) = self.stops[next.saturating_sub(1)];
        match self.stops.get(next) {
            Some(&(end, to)) if next > 0 && !self.steps => {
                mix(from, to, (x - start) / (end - start))
            }
            _ => from,
        }
    }
}

impl Written {
    fn read(self) -> Result<Row, String> {
        let (steps, stops) = match (self.stops, self.steps) {
            (Some(stops), None) => (false, stops),
            (None, Some(steps)) => (true, steps),
            (Some(_), Some(_)) => return Err("it has `stops` and `steps`".to_owned()),
            (None, None) => return Err("it has neither `stops` nor `steps`".to_owned()),
        };
        let stops = stops.into_iter().map(|(place, hex)| {
            let color = parse_hex(&hex);
            let color = color.ok_or_else(|| format!("\"{hex:.20}\" is no colour \"RRGGBB\""))?;
            Ok((place, color))
        });
        Ok(Row {
            v: self.v.unwrap_or(0.0),
            steps,
            stops: stops.collect::<Result<_, String>>()?,
        })
    }
}

fn fault(error: &ron::Error) -> String {
    match error {
        ron::Error::NoSuchStructField { found, .. } => format!("there is no `{found:.40}` in it"),
        _ => "it is no gradient".to_owned(),
    }
}

fn within(what: &str, count: usize) -> Result<(), String> {
    match count {
        0 => Err(format!("it has no {what}")),
        1..=MOST => Ok(()),
        _ => Err(format!("it has {count} {what}, more than {MOST}")),
    }
}

fn rising(what: &str, places: impl Iterator<Item = f32>) -> Result<(), String> {
    let mut before = f32::MIN;
    for place in places {
        if !place.is_finite() {
            return Err(format!("{what} are finite numbers"));
        }
        if place < before {
            return Err(format!("{what} must not fall: {place} after {before}"));
        }
        before = place;
    }
    Ok(())
}

#[inline(always)]
fn mix(from: [f32; 3], to: [f32; 3], share: f32) -> [f32; 3] {
    std::array::from_fn(|i| from[i] + (to[i] - from[i]) * share)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ramp(text: &str) -> Ramp {
        Ramp::parse(text).unwrap()
    }

    #[test]
    fn colours_turn_into_the_next_or_step() {
        let (black, white) = ([0.0; 3], [1.0; 3]);
        let smooth = ramp(r#"[(0.25, "000000"), (0.75, "FFFFFF")]"#);
        for (x, light) in [
            (-1.0, 0.0),
            (0.25, 0.0),
            (0.375, 0.25),
            (0.75, 1.0),
            (9.0, 1.0),
        ] {
            assert_eq!(smooth.at(x, 0.3), [light; 3], "{x}");
        }
        let hard = ramp(r#"(steps: [(0, "000000"), (0.5, "FFFFFF")])"#);
        assert_eq!((hard.at(0.499, 0.0), hard.at(0.5, 0.0)), (black, white));
        // Two stops at one place are a step, too.
        let mixed = ramp(r#"[(0, "000000"), (0.5, "000000"), (0.5, "FFFFFF")]"#);
        assert_eq!((mixed.at(0.499, 0.0), mixed.at(0.5, 0.0)), (black, white));
        assert_eq!(ramp(r#"[(0.5, "FFFFFF")]"#).at(0.1, 0.0), white);
    }

    #[test]
    fn rows_turn_into_the_next() {
        let rows = ramp(r#"[(v: 0, steps: [(0, "000000")]), (v: 2, stops: [(0, "FFFFFF")])]"#);
        for (y, light) in [(-1.0, 0.0), (0.5, 0.25), (2.0, 1.0), (3.0, 1.0)] {
            assert_eq!(rows.at(0.7, y), [light; 3], "{y}");
        }
    }

    #[test]
    fn a_block_has_the_same_colours() {
        let places = [-1.0, 0.0, 0.2, 0.25, 0.5, 0.6, 1.0, f32::NAN];
        let x = std::array::from_fn(|i| places[i % 8]);
        let y = std::array::from_fn(|i| places[i / 8]);
        for text in [
            r#"[(0.5, "3FC1C0")]"#,
            r#"(steps: [(0, "2A8F9D"), (0.25, "3FC1C0"), (0.25, "FFFFFF"), (0.6, "102030")])"#,
            r#"[(0, "2A8F9D"), (0.5, "3FC1C0"), (0.5, "FFFFFF"), (1, "102030")]"#,
            r#"[(v: 0, stops: [(0, "2A8F9D"), (1, "FFFFFF")]), (v: 0.5, steps: [(0.2, "3FC1C0"), (1, "000000")]), (v: 0.5, stops: [(0, "102030")])]"#,
            r#"[(v: 0, stops: [(0, "2A8F9D")]), (v: 0.5, stops: [(0, "FFFFFF")]), (v: 1, stops: [(0, "3FC1C0")]), (v: 2, stops: [(0, "102030")])]"#,
        ] {
            let ramp = ramp(text);
            let mut colors = Vectors::NOTHING;
            // Blocks that reach all rows, and some that reach few.
            for (low, width) in [(0.0, 1.0), (0.6, 0.2), (1.2, 0.1), (-3.0, 0.5), (5.0, 1.0)] {
                let y = y.map(|y: f32| low + width * y);
                ramp.of_block(&x, &y, &mut colors);
                for i in 0..BLOCK {
                    let [x, y] = [x[i], y[i]].map(|x| if x.is_finite() { x } else { 0.0 });
                    let color: [f32; 3] = colors.at(i).to_array();
                    assert_eq!(color, ramp.at(x, y), "{text} at {x}, {y}");
                }
            }
        }
    }

    #[test]
    fn what_is_written_is_read_again() {
        for text in [
            r#"[(0, "2A8F9D"), (0.5, "3FC1C0")]"#,
            r#"(steps: [(0, "000000"), (1, "FFFFFF")])"#,
            r#"[(v: 0, stops: [(0, "2A8F9D")]), (v: 1.5, steps: [(-1, "3FC1C0"), (1, "FFFFFF")])]"#,
        ] {
            assert_eq!(ramp(text).written(), text);
        }
    }

    #[test]
    fn mistakes_are_told() {
        for (text, expected) in [
            ("[]", "no stops"),
            ("()", "neither"),
            (
                r#"(stops: [(0, "FFFFFF")], steps: [(0, "FFFFFF")])"#,
                "`stops` and `steps`",
            ),
            (r#"[(0.5, "FFFFFF"), (0.2, "FFFFFF")]"#, "0.2 after 0.5"),
            (r#"[(NaN, "FFFFFF")]"#, "finite"),
            (r#"[(inf, "FFFFFF")]"#, "finite"),
            (r#"[(0, "FFF")]"#, "\"FFF\" is no colour"),
            (r#"(step: [(0, "FFFFFF")])"#, "no `step`"),
            (
                r#"[(stops: [(0, "FFFFFF")]), (stops: [(0, "FFFFFF")])]"#,
                "its place",
            ),
            ("[3]", "no gradient"),
        ] {
            let message = Ramp::parse(text).unwrap_err();
            assert!(message.contains(expected), "{text}: {message}");
        }
        let many = format!("[{}]", r#"(0, "FFFFFF"),"#.repeat(257));
        assert!(Ramp::parse(&many).unwrap_err().contains("257 stops"));
    }

    #[test]
    fn words_lead_to_the_stops() {
        let words = ramp(
            r#"[(v: 0, stops: [(0, "000000"), (1, "FFFFFF")]), (v: 1, steps: [(0.5, "FFFFFF")])]"#,
        )
        .words();
        assert_eq!(words[0], 2);
        let row = |i: usize| &words[1 + 4 * i..5 + 4 * i];
        assert_eq!(row(1)[..2], [1.0_f32.to_bits(), 1]);
        let [start, end] = [row(1)[2], row(1)[3]].map(|x| x as usize);
        assert_eq!((end - start, end), (4, words.len()));
        assert_eq!(words[start], 0.5_f32.to_bits());
    }
}
