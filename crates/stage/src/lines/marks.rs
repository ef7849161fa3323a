//! Where the marks of brushes lie along lines, so that they stay on the surface from frame to frame.

use super::strand::Seen;
use effects::wgsl::hash;
use glam::{DVec3, Vec3};
use mesh_lines::{Cut, Frame, Kind, Line, MeshError, Path, Span, Surface, Tracker};

/// Marks begin so far along, head heights: contours are followed in both directions from where they began, and brushes know no places below 0.
const FIRST: f64 = 64.0;
/// Lines begin in marks of their own, up to so many head heights apart.
const SPREAD: f64 = 16.0;

/// The contours of a mesh, followed from frame to frame (W, row W7 and section 3).
#[derive(Clone, Default)]
pub(super) struct Followed {
    tracker: Tracker,
    /// How many frames it has gone through.
    #[cfg(test)]
    pub steps: usize,
}

/// Where marks lie in a frame.
pub(super) struct Marks<'t> {
    paths: &'t [Path],
}

/// Where they lie along one span of a line.
pub(super) struct SpanMarks<'t> {
    /// Of contours.
    paths: Vec<&'t Path>,
    /// As many as a closed line has segments, else 0.
    around: f64,
    /// Of lines that are fixed to the mesh, how long the line is up to each joint at rest, head heights.
    lengths: Vec<f64>,
    /// Where the line's own marks begin.
    first: f64,
}

impl Followed {
    /// Goes on to a frame, in which a head's height is so many pixels.
    pub fn step(&mut self, seen: &Seen, height_px: f64) -> Result<(), MeshError> {
        #[cfg(test)]
        {
            self.steps += 1;
        }
        let frame = Frame {
            surface: &seen.surface,
            view: &seen.view,
            facing: &seen.facing,
            lines: &seen.lines,
            spans: &seen.spans,
            pixel: seen.pixel,
            period_px: height_px,
        };
        self.tracker.step(&frame).map(drop)
    }

    /// Those of the frame that it last went to.
    pub fn marks(&self) -> Marks<'_> {
        Marks {
            paths: self.tracker.paths(),
        }
    }
}

impl Marks<'_> {
    /// Those of the span of that number, on a line of the mesh.
    pub fn of_span(
        &self,
        number: usize,
        line: &Line,
        rest: &[Vec3],
        surface: &Surface,
    ) -> SpanMarks<'_> {
        let around = if line.closed {
            line.segments.len() as f64
        } else {
            0.0
        };
        let spread = |id: u32| FIRST + SPREAD * f64::from(hash(id)) / f64::from(u32::MAX);
        if line.kind == Kind::Contour {
            let paths = self
                .paths
                .iter()
                .filter(|path| path.span == number)
                .collect();
            return SpanMarks {
                paths,
                around,
                lengths: Vec::new(),
                first: FIRST,
            };
        }
        let at_rest = |i: usize| -> DVec3 {
            let place = line.points[i].place;
            let corners = surface.topology().triangles()[place.triangle as usize];
            let corners = corners.map(|vertex| rest[vertex as usize].as_dvec3());
            (corners.iter().zip(place.weights.to_array()))
                .map(|(p, w)| *p * w)
                .sum()
        };
        let count = line.points.len();
        let mut lengths = vec![0.0];
        let mut length = 0.0;
        for segment in 0..line.segments.len() {
            length += at_rest(segment).distance(at_rest((segment + 1) % count));
            lengths.push(length);
        }
        SpanMarks {
            paths: Vec::new(),
            around,
            lengths,
            first: spread(line.points.first().map_or(0, |point| point.place.triangle)),
        }
    }
}

impl SpanMarks<'_> {
    /// The span as its path begins it, where it goes all around.
    pub fn begun(&self, span: &Span) -> Span {
        match self.paths[..] {
            [path] if span.cuts == [Cut::None; 2] => match path.joints[..] {
                [first, .., last] => Span {
                    start: first.along,
                    end: last.along,
                    ..*span
                },
                _ => *span,
            },
            _ => *span,
        }
    }

    /// How far along its marks a place of the line is, head heights, 0 or more.
    pub fn at(&self, along: f64) -> f32 {
        let at = match self.paths.is_empty() {
            true => self.first + self.length_at(along),
            false => self.on_paths(along),
        };
        at.max(0.0) as f32
    }

    fn length_at(&self, along: f64) -> f64 {
        let last = self.lengths.len() - 1;
        let turns = if self.around > 0.0 {
            (along / self.around).floor()
        } else {
            0.0
        };
        let along = along - turns * self.around;
        let before = (along.max(0.0) as usize).min(last.saturating_sub(1));
        let after = (before + 1).min(last);
        let [a, b] = [self.lengths[before], self.lengths[after]];
        turns * self.lengths[last] + a + (b - a) * (along - before as f64)
    }

    fn on_paths(&self, along: f64) -> f64 {
        // The line goes on beyond its beginning; the marks go on, too.
        let turns = [0.0, 1.0, -1.0, 2.0].map(|turns| turns * self.around);
        let mut nearest: Option<(f64, f64)> = None;
        for path in &self.paths {
            let [first, .., last] = path.joints[..] else {
                continue;
            };
            let spread = SPREAD * f64::from(hash(path.id as u32)) / f64::from(u32::MAX);
            for turn in turns {
                let there = along - turn;
                let held = there.clamp(first.along, last.along);
                let off = (there - held).abs();
                if nearest.is_some_and(|(least, _)| least <= off) {
                    continue;
                }
                let after = path.joints.partition_point(|joint| joint.along < held);
                let after = after.clamp(1, path.joints.len() - 1);
                let [a, b] = [path.joints[after - 1], path.joints[after]];
                let way = b.along - a.along;
                let share = if way > 0.0 {
                    (held - a.along) / way
                } else {
                    0.0
                };
                let whole = if turn != 0.0 {
                    (last.t - first.t) * turn / self.around
                } else {
                    0.0
                };
                nearest = Some((off, FIRST + spread + a.t + (b.t - a.t) * share + whole));
            }
        }
        nearest.map_or(self.first, |(_, at)| at)
    }
}
