//! What contours are called from frame to frame, and what runs along them.

use crate::{
    Cut, Kind, Line, MeshError, Place, Span, Surface, Topology, View, fit::Spline,
    line::check_lines, ruler::Ruler, walk_to_zero,
};
use glam::DVec3;
use std::{collections::HashMap, ops::Range};

/// How far the samples are apart by which paths remember where they were, in pixels.
const SAMPLE_PX: f64 = 4.0;
/// More samples no path has: it would be longer than any picture shows.
const MOST_SAMPLES: f64 = 16_384.0;
/// How far a sample goes at most to the contour of the next frame.
const REACH_PX: f64 = 6.0;
/// How far the knots of T are apart.
const KNOT_PX: f64 = 48.0;
/// A group of votes has at least so many, and is so long: in pixels, and as a share of its line.
const LEAST_VOTES: usize = 2;
const LEAST_PX: f64 = 5.0;
const LEAST_SHARE: f64 = 0.05;
/// Neighbouring votes that are farther apart in T than on the line by more than this many pixels are of two groups.
const JUMP_PX: f64 = 24.0;

/// Follows contours from frame to frame, so that strokes along them keep their names, and patterns on them their places.
///
/// Each path has a coordinate T along it, which counts periods of a pattern. Paths are remembered by samples on the surface. In the next frame these ride the
/// surface, walk to the new contour, and vote there for their path and their T; through the votes goes the smooth T that has nearly the
/// pattern's period everywhere (Kalnins et al., *Coherent stylized silhouettes*, 2003; limits by W and its authors' program). No random numbers, and the same for any number of threads.
///
/// Creases and borders are fixed on the mesh and need no tracker.
#[derive(Clone, Debug, Default)]
pub struct Tracker {
    paths: Vec<Path>,
    memories: Vec<Memory>,
    next_id: u64,
    /// How many triangles and smooth vertices the mesh has, from the first frame on.
    mesh: Option<[usize; 2]>,
}

/// What the tracker needs to know of a frame.
#[derive(Clone, Copy, Debug)]
pub struct Frame<'a> {
    /// The mesh: of one topology in all frames of a tracker.
    pub surface: &'a Surface<'a>,
    /// The eye.
    pub view: &'a View,
    /// What [`crate::facing`] says of it.
    pub facing: &'a [f64],
    /// The lines of the frame.
    pub lines: &'a [Line],
    /// What of them is seen, as [`crate::visible`] says it: those of one line do not overlap.
    pub spans: &'a [Span],
    /// How long a pixel is in the image ([`View`]).
    pub pixel: f64,
    /// How many pixels a period of T is to be long.
    pub period_px: f64,
}

/// A part of a contour that is one stroke.
#[derive(Clone, Debug, PartialEq)]
pub struct Path {
    /// Its name. Where a path is split all parts keep it: then several paths have one name.
    pub id: u64,
    /// True in the frame in which the name is given.
    pub is_new: bool,
    /// The index of the span on which it lies.
    pub span: usize,
    /// Its joints, at least two: those of the line, and its ends.
    pub joints: Vec<PathJoint>,
}

/// A joint of a path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathJoint {
    /// Where on the line it is ([`Line::position`]).
    pub along: f64,
    /// Where it is.
    pub position: DVec3,
    /// How many pixels of the span come before it.
    pub length_px: f64,
    /// T, in periods.
    pub t: f64,
}

/// A sample of a path.
#[derive(Clone, Copy, Debug)]
struct Memory {
    id: u64,
    place: Place,
    t: f64,
}

#[derive(Clone, Copy, Debug)]
struct Vote {
    id: u64,
    /// Where on the line, and how many pixels along its span.
    along: f64,
    s: f64,
    t: f64,
}

impl Tracker {
    /// Goes on to a frame, and returns its paths, in the order of its spans and along each of them.
    ///
    /// # Errors
    ///
    /// When `pixel` or `period_px` isn't a positive number, there is not one value of `facing` for each smooth vertex, the mesh hasn't as many triangles and smooth
    /// vertices as in the frames before, a line isn't one of it, a span isn't one of the lines, or a span's length in pixels or periods is beyond all numbers. The tracker
    /// is then as it was.
    pub fn step(&mut self, frame: &Frame) -> Result<&[Path], MeshError> {
        for (what, length) in [
            ("a pixel's length", frame.pixel),
            ("the period", frame.period_px),
        ] {
            if !(length.is_finite() && length > 0.0) {
                return Err(MeshError::NotPositive { what });
            }
        }
        let vertices = frame.surface.topology().smooth_vertices();
        if frame.facing.len() != vertices {
            return Err(MeshError::Count {
                what: "values",
                found: frame.facing.len(),
                vertices,
            });
        }
        let mesh = self.check_mesh(frame.surface.topology())?;
        check_lines(frame.surface, frame.lines)?;
        check_spans(frame)?;
        let mut votes = self.votes(frame);
        let mut rulers = Vec::new();
        for (number, span) in frame.spans.iter().enumerate() {
            let line = &frame.lines[span.line];
            if line.kind != Kind::Contour {
                continue;
            }
            let ruler = ruler(frame, line, span, &mut votes[number]);
            if !(ruler.length().is_finite() && (ruler.length() / frame.period_px).is_finite()) {
                return Err(MeshError::NotFinite {
                    what: "the length of span",
                    index: number,
                });
            }
            if ruler.length() > 0.0 {
                rulers.push((number, ruler));
            }
        }
        self.mesh = Some(mesh);
        self.paths.clear();
        self.memories.clear();
        for (number, ruler) in rulers {
            let line = &frame.lines[frame.spans[number].line];
            self.name(frame, number, line, &ruler, &votes[number]);
        }
        Ok(&self.paths)
    }

    /// The paths of the last frame.
    #[must_use]
    pub fn paths(&self) -> &[Path] {
        &self.paths
    }

    /// The numbers by which a mesh is known, unless they aren't those of the frames before.
    fn check_mesh(&self, topology: &Topology) -> Result<[usize; 2], MeshError> {
        let mesh = [topology.triangles().len(), topology.smooth_vertices()];
        match self.mesh {
            Some(before) if before != mesh => Err(MeshError::OtherMesh {
                triangles: mesh[0],
                triangles_before: before[0],
                vertices: mesh[1],
                vertices_before: before[1],
            }),
            _ => Ok(mesh),
        }
    }

    /// Where the samples of the last frame's paths are now, by span.
    fn votes(&self, frame: &Frame) -> Vec<Vec<Vote>> {
        let mut segments: HashMap<u32, Vec<(usize, usize)>> = HashMap::new();
        for (number, line) in frame
            .lines
            .iter()
            .enumerate()
            .filter(|(_, line)| line.kind == Kind::Contour)
        {
            for (segment, at) in line.segments.iter().enumerate() {
                segments
                    .entry(at.triangle)
                    .or_default()
                    .push((number, segment));
            }
        }
        let mut spans = vec![Vec::new(); frame.lines.len()];
        for (number, span) in frame.spans.iter().enumerate() {
            spans[span.line].push(number);
        }
        for spans in &mut spans {
            let start = |span: &usize| frame.spans[*span].start;
            spans.sort_by(|a, b| start(a).total_cmp(&start(b)));
        }
        let mut votes = vec![Vec::new(); frame.spans.len()];
        let reach = REACH_PX * frame.pixel;
        for memory in &self.memories {
            let place = walk_to_zero(frame.surface, frame.facing, frame.view, memory.place, reach);
            let Some(place) = place else {
                continue;
            };
            let point = frame.surface.point(place);
            // A triangle has one segment, or two with a cusp between.
            let found =
                segments
                    .get(&place.triangle)
                    .into_iter()
                    .flatten()
                    .map(|&(line, segment)| {
                        let (share, off) = nearest_on(&frame.lines[line], segment, point);
                        (line, segment as f64 + share, off)
                    });
            let Some((line, along, _)) = found.min_by(|a, b| a.2.total_cmp(&b.2)) else {
                continue;
            };
            let count = frame.lines[line].segments.len() as f64;
            if let Some(span) = span_at(frame.spans, &spans[line], along, count) {
                votes[span].push(Vote {
                    id: memory.id,
                    along,
                    s: 0.0,
                    t: memory.t,
                });
            }
        }
        votes
    }

    /// Divides a span among those who are voted for, or gives it a new name.
    fn name(&mut self, frame: &Frame, span: usize, line: &Line, ruler: &Ruler, votes: &[Vote]) {
        let slope = frame.period_px.recip();
        let shares = shares(groups(votes, frame.period_px), ruler.length());
        if shares.is_empty() {
            let id = self.next_id;
            self.next_id += 1;
            let whole = 0.0..ruler.length();
            let spline = Spline::straight(whole.clone(), slope);
            self.add(frame, span, line, ruler, whole, &spline, id, true);
        }
        for (range, group) in shares {
            let points: Vec<(f64, f64)> = group.iter().map(|vote| (vote.s, vote.t)).collect();
            let spline = Spline::fit(range.clone(), KNOT_PX, &points, slope);
            self.add(frame, span, line, ruler, range, &spline, group[0].id, false);
        }
    }

    #[expect(
        clippy::too_many_arguments,
        reason = "all that a path is made of, once"
    )]
    fn add(
        &mut self,
        frame: &Frame,
        span: usize,
        line: &Line,
        ruler: &Ruler,
        range: Range<f64>,
        spline: &Spline,
        id: u64,
        is_new: bool,
    ) {
        let joint = |(along, s): (f64, f64)| PathJoint {
            along,
            position: line.position(along),
            length_px: s,
            t: spline.at(s),
        };
        self.paths.push(Path {
            id,
            is_new,
            span,
            joints: ruler.joints(&range).into_iter().map(joint).collect(),
        });
        let length = range.end - range.start;
        let samples = (length / SAMPLE_PX).ceil().clamp(1.0, MOST_SAMPLES) as usize;
        self.memories.extend((0..=samples).map(|i| {
            let s = range.start + length * i as f64 / samples as f64;
            Memory {
                id,
                place: line.place(frame.surface, ruler.along(s)),
                t: spline.at(s),
            }
        }));
    }
}

/// How long a span is where. Of one that goes all around the beginning is where that of its path was; votes get their lengths.
fn ruler(frame: &Frame, line: &Line, span: &Span, votes: &mut [Vote]) -> Ruler {
    let count = line.segments.len() as f64;
    let mut whole = *span;
    if span.cuts == [Cut::None; 2] {
        let first = most_voted(votes).and_then(|id| {
            let of_it = votes.iter().filter(|vote| vote.id == id);
            of_it.min_by(|a, b| a.t.total_cmp(&b.t))
        });
        if let Some(first) = first {
            (whole.start, whole.end) = (first.along, first.along + count);
        }
    }
    let lengths: Vec<f64> = line
        .image_lengths(frame.view)
        .iter()
        .map(|l| l / frame.pixel)
        .collect();
    let ruler = Ruler::new(&lengths, whole.start..whole.end);
    for vote in votes {
        vote.along = on_span(&whole, vote.along, count).unwrap_or(whole.start);
        vote.s = ruler.length_at(vote.along);
    }
    ruler
}

/// Refuses spans of other lines, as far as they can be told.
fn check_spans(frame: &Frame) -> Result<(), MeshError> {
    let is_of_them = |span: &Span| {
        frame.lines.get(span.line).is_some_and(|line| {
            let count = line.segments.len() as f64;
            let most = if line.closed {
                span.start + count
            } else {
                count
            };
            (0.0..=count).contains(&span.start) && (span.start..=most).contains(&span.end)
        })
    };
    match frame.spans.iter().position(|span| !is_of_them(span)) {
        Some(span) => Err(MeshError::OtherSpan { span }),
        None => Ok(()),
    }
}

/// The span in which a place on a line lies: of those of the line, by where they begin, since none overlaps another.
fn span_at(spans: &[Span], of_line: &[usize], along: f64, count: f64) -> Option<usize> {
    [along, along + count].into_iter().find_map(|at| {
        let after = of_line.partition_point(|&span| spans[span].start <= at);
        let last = of_line[..after].last().copied();
        last.filter(|&span| at <= spans[span].end)
    })
}

/// A place on a line as one between the ends of a span, which may go through the line's first point.
fn on_span(span: &Span, along: f64, count: f64) -> Option<f64> {
    [along, along + count]
        .into_iter()
        .find(|at| (span.start..=span.end).contains(at))
}

/// The share of the way along a segment that is nearest to a point, and how far that is, squared.
fn nearest_on(line: &Line, segment: usize, point: DVec3) -> (f64, f64) {
    let [from, to] = line.ends(segment).map(|end| end.position);
    let way = to - from;
    let squared = way.length_squared();
    let share = if squared > 0.0 {
        ((point - from).dot(way) / squared).clamp(0.0, 1.0)
    } else {
        0.0
    };
    (share, from.lerp(to, share).distance_squared(point))
}

/// The name with most votes, the older of two.
fn most_voted(votes: &[Vote]) -> Option<u64> {
    let mut ids: Vec<u64> = votes.iter().map(|vote| vote.id).collect();
    ids.sort_unstable();
    let runs = ids.chunk_by(|a, b| a == b);
    runs.max_by(|a, b| a.len().cmp(&b.len()).then(b[0].cmp(&a[0])))
        .map(|run| run[0])
}

/// Votes for one name that follow each other along the line as they did, each group in order along the line.
fn groups(votes: &[Vote], period_px: f64) -> Vec<Vec<Vote>> {
    let mut sorted = votes.to_vec();
    sorted.sort_by(|a, b| {
        a.id.cmp(&b.id)
            .then(a.s.total_cmp(&b.s))
            .then(a.t.total_cmp(&b.t))
    });
    let together = |a: &Vote, b: &Vote| {
        a.id == b.id && ((b.t - a.t) * period_px - (b.s - a.s)).abs() < JUMP_PX
    };
    sorted.chunk_by(together).map(<[Vote]>::to_vec).collect()
}

/// Which part of a span of this length (px) each group gets, in order along it: the largest group all that it covers, and each after it the longest part that is left to it;
/// what lies between two is halved.
fn shares(mut groups: Vec<Vec<Vote>>, length: f64) -> Vec<(Range<f64>, Vec<Vote>)> {
    let least = LEAST_PX.min(length / 2.0).max(LEAST_SHARE * length);
    groups.sort_by(|a, b| {
        b.len()
            .cmp(&a.len())
            .then(a[0].id.cmp(&b[0].id))
            .then(a[0].s.total_cmp(&b[0].s))
    });
    let mut taken: Vec<(Range<f64>, Vec<Vote>)> = Vec::new();
    for group in groups {
        // What is taken is in order, and doesn't overlap. Between two of them lies a gap, known by how many are before it.
        let gap = |vote: &Vote| {
            let before = taken.partition_point(|(range, _)| range.start <= vote.s);
            let is_free = before == 0 || taken[before - 1].0.end < vote.s;
            is_free.then_some(before)
        };
        // A part is left where votes follow each other in one gap.
        let same_gap = |a: &Vote, b: &Vote| gap(a).is_some() && gap(a) == gap(b);
        let extent = |part: &[Vote]| part[part.len() - 1].s - part[0].s;
        let longest = group
            .chunk_by(same_gap)
            .max_by(|a, b| extent(a).total_cmp(&extent(b)));
        let longest = longest.filter(|part| part.len() >= LEAST_VOTES && extent(part) >= least);
        if let Some((part, before)) = longest.and_then(|part| Some((part, gap(&part[0])?))) {
            let range = part[0].s..part[part.len() - 1].s;
            taken.insert(before, (range, part.to_vec()));
        }
    }
    let borders: Vec<f64> = taken
        .windows(2)
        .map(|two| (two[0].0.end + two[1].0.start) / 2.0)
        .collect();
    let count = taken.len();
    for (i, (range, _)) in taken.iter_mut().enumerate() {
        range.start = if i == 0 { 0.0 } else { borders[i - 1] };
        range.end = if i + 1 == count { length } else { borders[i] };
    }
    taken
}
