//! Where the marks of brushes lie along lines, so that they stay on the surface from frame to frame.

use super::strand::Seen;
use effects::wgsl::hash;
use glam::{DVec3, Vec3};
use mesh_lines::{Cut, Frame, Kind, Line, MeshError, Path, Span, Surface, Tracker};
use std::rc::Rc;

/// Marks begin so far along, head heights: contours are followed in both directions from where they began, and brushes know no places below 0.
const FIRST: f64 = 64.0;
/// Lines begin in marks of their own, up to so many head heights apart.
const SPREAD: f64 = 16.0;

/// The contours of a mesh, followed from frame to frame (W, row W7 and section 3).
#[derive(Clone, Default)]
pub(super) struct Followed {
    tracker: Tracker,
    /// Which form each mesh of numbered files had.
    forms: Vec<usize>,
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
    paths: &'t [Path],
    /// As many as a closed line has segments, else 0.
    around: f64,
    /// Of lines that are fixed to the mesh, how long the line is up to each joint at rest, head heights.
    lengths: Rc<[f64]>,
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
        if self.forms != seen.forms {
            // Another mesh: places on the one before say nothing of it.
            self.tracker = Tracker::default();
            self.forms = seen.forms.to_vec();
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

    /// Whether some contours that came from nowhere aren't drawn whole yet.
    pub fn is_growing(&self) -> bool {
        self.tracker.is_growing()
    }

    /// Has all of them drawn whole.
    pub fn finish(&mut self) {
        self.tracker.finish();
    }

    /// Those of the frame that it last went to.
    pub fn marks(&self) -> Marks<'_> {
        Marks {
            paths: self.tracker.paths(),
        }
    }
}

impl<'t> Marks<'t> {
    /// How long a line that is fixed to the mesh is up to each joint at rest, head heights; nothing of a contour. All its spans have these.
    pub fn lengths(line: &Line, rest: &[Vec3], surface: &Surface) -> Rc<[f64]> {
        if line.kind == Kind::Contour {
            return Rc::default();
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
        lengths.into()
    }

    /// Those of the span of that number, on a line of the mesh with these lengths.
    pub fn of_span(&self, number: usize, line: &Line, lengths: &Rc<[f64]>) -> SpanMarks<'t> {
        let around = if line.closed {
            line.segments.len() as f64
        } else {
            0.0
        };
        let spread = |id: u32| FIRST + SPREAD * f64::from(hash(id)) / f64::from(u32::MAX);
        let (paths, first) = if line.kind == Kind::Contour {
            // Paths come in the order of their spans.
            let start = self.paths.partition_point(|path| path.span < number);
            let end = self.paths.partition_point(|path| path.span <= number);
            (&self.paths[start..end], FIRST)
        } else {
            let triangle = line.points.first().map_or(0, |point| point.place.triangle);
            (&[][..], spread(triangle))
        };
        SpanMarks {
            paths,
            around,
            lengths: Rc::clone(lengths),
            first,
        }
    }
}

impl SpanMarks<'_> {
    /// What is drawn of the span: where it goes all around as its path begins it, and of contours that came from nowhere what they have grown to.
    pub fn shown(&self, span: &Span) -> Vec<Span> {
        let [Some(first), Some(last)] = [self.paths.first(), self.paths.last()] else {
            return vec![*span];
        };
        let (Some(start), Some(end)) = (first.joints.first(), last.joints.last()) else {
            return vec![*span];
        };
        let whole = [start.along, end.along];
        let mut shown: Vec<[f64; 2]> = Vec::new();
        for path in self.paths {
            match shown.last_mut() {
                Some(before) if before[1] == path.shown[0] => before[1] = path.shown[1],
                _ => shown.push(path.shown),
            }
        }
        let is_around = span.cuts == [Cut::None; 2];
        if shown[..] == [whole] && !(is_around && self.paths.len() == 1) {
            return vec![*span];
        }
        let part = |part: &[f64; 2]| {
            let cut = |side: usize| match part[side] == whole[side] {
                true if !is_around || *part == whole => span.cuts[side],
                _ => Cut::End,
            };
            Span {
                start: part[0],
                end: part[1],
                cuts: [cut(0), cut(1)],
                ..*span
            }
        };
        shown.iter().map(part).collect()
    }

    /// How far along its marks a place of the line is, head heights, 0 or more.
    pub fn at(&self, along: f64) -> f32 {
        let at = match self.paths.is_empty() {
            // What has no length in the picture has no marks, either.
            true if self.lengths.is_empty() => self.first,
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
        for path in self.paths {
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
