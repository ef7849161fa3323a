//! Lengths along a part of a line.

use std::ops::Range;

/// How long a part of a line is from its beginning to each of its joints.
#[derive(Clone, Debug)]
pub(crate) struct Ruler {
    /// The part's ends and the line's joints between them ([`crate::Line::position`]), with the length up to each.
    marks: Vec<(f64, f64)>,
}

impl Ruler {
    /// Of a part of a line whose segments have these lengths; the part may go on beyond the end of a closed line.
    pub(crate) fn new(lengths: &[f64], part: Range<f64>) -> Self {
        let mut marks = vec![(part.start, 0.0)];
        let (mut at, mut length) = (part.start, 0.0);
        while at < part.end {
            let segment = at.floor();
            let next = (segment + 1.0).min(part.end);
            length += lengths[segment as usize % lengths.len()] * (next - at);
            marks.push((next, length));
            at = next;
        }
        Self { marks }
    }

    pub(crate) fn length(&self) -> f64 {
        self.marks[self.marks.len() - 1].1
    }

    /// The length up to a place on the line.
    pub(crate) fn length_at(&self, along: f64) -> f64 {
        self.between(along, |mark| mark.0, |mark| mark.1)
    }

    /// The place on the line up to which it is so long.
    pub(crate) fn along(&self, length: f64) -> f64 {
        self.between(length, |mark| mark.1, |mark| mark.0)
    }

    /// Two lengths, and all joints between: their places on the line, and the lengths up to them.
    pub(crate) fn joints(&self, lengths: &Range<f64>) -> Vec<(f64, f64)> {
        let inside = |mark: &&(f64, f64)| mark.1 > lengths.start && mark.1 < lengths.end;
        let mut joints = vec![(self.along(lengths.start), lengths.start)];
        joints.extend(self.marks.iter().filter(inside));
        joints.push((self.along(lengths.end), lengths.end));
        joints
    }

    fn between(
        &self,
        x: f64,
        key: impl Fn(&(f64, f64)) -> f64,
        value: impl Fn(&(f64, f64)) -> f64,
    ) -> f64 {
        let after = self.marks.partition_point(|mark| key(mark) <= x);
        if after == 0 {
            return value(&self.marks[0]);
        }
        let Some(to) = self.marks.get(after) else {
            return value(&self.marks[after - 1]);
        };
        let from = &self.marks[after - 1];
        let share = (x - key(from)) / (key(to) - key(from));
        value(from) + (value(to) - value(from)) * share
    }
}
