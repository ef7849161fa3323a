//! What a motion script does when, for a timeline: read from its text, where it can be.

use effects::preset::edit::{self, Step};

/// Longer than any sequence: a move or wind without an end.
const FOREVER_S: f32 = 1e5;
/// The latest end of a time line, seconds: hair is simulated from the beginning to wherever it is looked at.
pub const LATEST_END_S: f32 = 600.0;

/// Something that a script does for a while.
#[derive(Clone, Debug, PartialEq)]
pub struct Span {
    /// What: `turn`, `wind`, `key`, `shape`, or the name of a body.
    pub name: String,
    /// The list of the script, and the number in it.
    pub list: &'static str,
    /// Number in that list.
    pub index: usize,
    /// Seconds.
    pub start_s: f32,
    /// Seconds; 0 for a moment.
    pub length_s: f32,
}

/// All that a script does.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MotionTrack {
    /// In the order of the script.
    pub spans: Vec<Span>,
    /// Seconds after which it starts again; 0 where it never does.
    pub period_s: f32,
}

impl MotionTrack {
    /// Of a script's text. What cannot be read is left out: its mistakes are told elsewhere.
    #[must_use]
    pub fn read(text: &str) -> Self {
        let mut spans = Vec::new();
        for (list, start, name) in [
            ("moves", "start", "move"),
            ("winds", "start", "wind"),
            ("keys", "time", "key"),
            ("shapes", "time", "shape"),
            ("body_keys", "time", "body"),
        ] {
            let items = edit::items(text, &[Step::Field(list)]);
            for (index, item) in items.into_iter().enumerate() {
                let number = |field: &str| number(item, field);
                let default_length = if list == "moves" { 1.0 } else { FOREVER_S };
                let said = |field: &str| edit::get(item, &[Step::Field(field)]);
                spans.push(Span {
                    name: match list {
                        "moves" => said("move").unwrap_or("turn").to_owned(),
                        "body_keys" => said("body").unwrap_or(name).trim_matches('"').to_owned(),
                        _ => name.to_owned(),
                    },
                    list,
                    index,
                    start_s: number(start).unwrap_or(0.0),
                    length_s: match start {
                        "start" => number("length").unwrap_or(default_length),
                        _ => 0.0,
                    },
                });
            }
        }
        Self {
            spans,
            period_s: number(text, "period").unwrap_or(0.0),
        }
    }

    /// When all is over, and hair has had so many seconds to settle; 0 where nothing begins or ends. What goes on for ever has its start
    /// alone.
    #[must_use]
    pub fn end_s(&self, settling_s: f32) -> f32 {
        if self.period_s > 0.0 {
            return self.period_s.min(LATEST_END_S);
        }
        let ends = self
            .spans
            .iter()
            .map(|span| match span.length_s < FOREVER_S {
                true => span.start_s + span.length_s,
                false => span.start_s + 1.0,
            });
        match ends.reduce(f32::max) {
            Some(end) => (end + settling_s).min(LATEST_END_S),
            None => 0.0,
        }
    }
}

fn number(section: &str, field: &str) -> Option<f32> {
    let number = edit::get(section, &[Step::Field(field)])?.parse().ok();
    number.filter(|number: &f32| number.is_finite() && *number >= 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_script_is_read_as_far_as_it_can_be() {
        let text = "(version: 1, moves: [(move: shake, start: 0.5, length: 2), (angle: 3)],
            winds: [(start: 1, speed: 5)], keys: [(time: 4), (time: -NaN)])";
        let track = MotionTrack::read(text);
        let shown: Vec<(&str, f32, f32)> = (track.spans.iter())
            .map(|span| (span.name.as_str(), span.start_s, span.length_s))
            .collect();
        assert_eq!(
            shown,
            [
                ("shake", 0.5, 2.0),
                ("turn", 0.0, 1.0),
                ("wind", 1.0, FOREVER_S),
                ("key", 4.0, 0.0),
                ("key", 0.0, 0.0),
            ]
        );
        assert_eq!(track.end_s(2.0), 6.0);
        assert_eq!(MotionTrack::read("(version: 1, period: 3)").end_s(2.0), 3.0);
        assert_eq!(MotionTrack::read("(version: 1").end_s(2.0), 0.0);
        let bodies = MotionTrack::read(
            "(moves: [(length: 2)], body_keys: [(body: \"hand\", time: 1), (body: \"hand\", time: 9)])",
        );
        assert_eq!(bodies.end_s(2.0), 11.0);
        assert_eq!(bodies.spans[2].name, "hand");
        let far = MotionTrack::read("(version: 1, moves: [(start: 600000)])");
        assert_eq!(far.end_s(2.0), LATEST_END_S);
    }
}
