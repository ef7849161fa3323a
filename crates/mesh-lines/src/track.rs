//! What contours are called from frame to frame, and what runs along them.

use crate::{
    Cut, Kind, Line, MeshError, Place, Span, Surface, Topology, View, fit::Spline,
    line::check_lines, ruler::Ruler, walk_to_zero,
};
use glam::DVec3;
use std::{
    collections::{BTreeSet, HashMap},
    ops::Range,
};

/// How far the samples are apart by which paths remember where they were, in pixels.
const SAMPLE_PX: f64 = 4.0;
/// More samples no path has: it would be longer than any picture shows.
const MOST_SAMPLES: f64 = 16_384.0;
/// How far a sample goes at most to the contour of the next frame, in pixels: a place on a line that is farther from where it was isn't where the line has come to.
pub const REACH_PX: f64 = 6.0;
/// How far the knots of T are apart.
const KNOT_PX: f64 = 48.0;
/// A group of votes has at least so many, and is so long: in pixels, and as a share of its line.
const LEAST_VOTES: usize = 2;
const LEAST_PX: f64 = 5.0;
const LEAST_SHARE: f64 = 0.05;
/// What is drawn of a line that comes from nowhere: so long in its first frame, in pixels, and so many times as long in each frame after.
const BORN_PX: f64 = 2.0;
const GROWTH: f64 = 2.0;
/// A new path of which at least this share was there before, but hidden, doesn't come from nowhere.
const REVEALED_SHARE: f64 = 0.5;
/// Neighbouring votes that are farther apart in T than on the line by more than this many pixels are of two groups.
const JUMP_PX: f64 = 24.0;

/// Follows contours from frame to frame, so that strokes along them keep their names, and patterns on them their places.
///
/// Each path has a coordinate T along it, which counts periods of a pattern. Paths are remembered by samples on the surface. In the next frame these ride the
/// surface, walk to the new contour, and vote there for their path and their T; through the votes goes the smooth T that has nearly the
/// pattern's period everywhere (Kalnins et al., *Coherent stylized silhouettes*, 2003; limits by W and its authors' program). No random numbers, and the same for any number of threads.
///
/// A path gets a new name where nothing votes. Either it was there before, but behind something that has moved away: then it is as long as what uncovered it has gone,
/// and is drawn whole. Or it comes from nowhere, as where a surface begins to turn away from the eye: then [`Path::shown`] grows from 2 pixels on, twice as
/// long in each frame, whatever the length of the line that there is. In the first frame all is drawn whole.
///
/// Creases and borders are fixed on the mesh and need no tracker.
#[derive(Clone, Debug, Default)]
pub struct Tracker {
    paths: Vec<Path>,
    memories: Vec<Memory>,
    /// Where contours were that something hid.
    hidden: Vec<Place>,
    /// How much is drawn, in pixels, of paths that aren't whole yet.
    growing: HashMap<u64, f64>,
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
    /// Of a new path whether it was there in the frame before, hidden.
    pub is_revealed: bool,
    /// From where to where it is drawn ([`Line::position`]): all of it, but of one that came from nowhere a while ago.
    pub shown: [f64; 2],
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
        let contours = Contours::new(frame);
        let mut votes = self.votes(&contours);
        let uncovered = self.uncovered(&contours);
        let is_first = self.mesh.is_none();
        let mut rulers = Vec::new();
        // In pixels, of each line once, whatever its spans.
        let mut lengths: Vec<Option<Vec<f64>>> = vec![None; frame.lines.len()];
        for (number, span) in frame.spans.iter().enumerate() {
            let line = &frame.lines[span.line];
            if line.kind != Kind::Contour {
                continue;
            }
            let lengths = lengths[span.line].get_or_insert_with(|| {
                let lengths = line.image_lengths(frame.view);
                lengths.iter().map(|length| length / frame.pixel).collect()
            });
            let ruler = ruler(lengths, span, &mut votes[number]);
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
        self.growing.values_mut().for_each(|px| *px *= GROWTH);
        self.paths.clear();
        self.memories.clear();
        for (number, ruler) in rulers {
            let line = &frame.lines[frame.spans[number].line];
            let uncovered_px = uncovered[number] as f64 * SAMPLE_PX;
            let is_revealed = uncovered_px >= REVEALED_SHARE * ruler.length();
            self.name(frame, number, line, &ruler, &votes[number], is_revealed);
        }
        if is_first {
            self.finish();
        }
        let unfinished = self.paths.iter().filter(|path| path.shown != path.whole());
        let unfinished: BTreeSet<_> = unfinished.map(|path| path.id).collect();
        self.growing.retain(|id, _| unfinished.contains(id));
        self.remember_hidden(&contours);
        Ok(&self.paths)
    }

    /// Whether some paths aren't drawn whole yet: then the next frame shows more of them, even where nothing moves.
    #[must_use]
    pub fn is_growing(&self) -> bool {
        !self.growing.is_empty()
    }

    /// Has all paths drawn whole at once, as where no time has gone by since the frame before.
    pub fn finish(&mut self) {
        self.growing.clear();
        for path in &mut self.paths {
            path.shown = path.whole();
        }
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
    fn votes(&self, contours: &Contours) -> Vec<Vec<Vote>> {
        let mut votes = vec![Vec::new(); contours.frame.spans.len()];
        for memory in &self.memories {
            if let Some((span, along)) = contours.now(memory.place) {
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

    /// How many samples of what was hidden in the last frame are now seen, by span.
    fn uncovered(&self, contours: &Contours) -> Vec<usize> {
        let mut uncovered = vec![0; contours.frame.spans.len()];
        for place in &self.hidden {
            if let Some((span, _)) = contours.now(*place) {
                uncovered[span] += 1;
            }
        }
        uncovered
    }

    /// Notes where contours are that something hides.
    fn remember_hidden(&mut self, contours: &Contours) {
        self.hidden.clear();
        let frame = contours.frame;
        for (line, spans) in frame.lines.iter().zip(&contours.spans) {
            if line.kind != Kind::Contour || line.segments.is_empty() {
                continue;
            }
            let seen = |along: f64| {
                let count = line.segments.len() as f64;
                span_at(frame.spans, spans, along, count).is_some()
            };
            // As far apart as those of what is seen.
            let (mut left, mut room) = (0.5 * SAMPLE_PX, MOST_SAMPLES);
            let lengths = line.image_lengths(frame.view);
            for (segment, length) in lengths.iter().enumerate() {
                let px = length / frame.pixel;
                if line.segments[segment].is_inside(frame.surface) || !px.is_finite() {
                    continue;
                }
                let samples = ((px - left) / SAMPLE_PX + 1.0).clamp(0.0, room).floor();
                room -= samples;
                for sample in 0..samples as usize {
                    let along = segment as f64 + (left + sample as f64 * SAMPLE_PX) / px;
                    if !seen(along) {
                        self.hidden.push(line.place(frame.surface, along));
                    }
                }
                left += samples * SAMPLE_PX - px;
            }
        }
    }

    /// Divides a span among those who are voted for, or gives it a new name.
    fn name(
        &mut self,
        frame: &Frame,
        span: usize,
        line: &Line,
        ruler: &Ruler,
        votes: &[Vote],
        is_revealed: bool,
    ) {
        let slope = frame.period_px.recip();
        let shares = shares(groups(votes, frame.period_px), ruler.length());
        if shares.is_empty() {
            let id = self.next_id;
            self.next_id += 1;
            let whole = 0.0..ruler.length();
            let spline = Spline::straight(whole.clone(), slope);
            self.add(frame, span, line, ruler, whole, &spline, id);
            if let Some(path) = self.paths.last_mut() {
                (path.is_new, path.is_revealed) = (true, is_revealed);
            }
            if !is_revealed {
                self.growing.insert(id, BORN_PX);
                self.trim(ruler);
            }
        }
        for (range, group) in shares {
            let points: Vec<(f64, f64)> = group.iter().map(|vote| (vote.s, vote.t)).collect();
            let spline = Spline::fit(range.clone(), KNOT_PX, &points, slope);
            self.add(frame, span, line, ruler, range, &spline, group[0].id);
            self.trim(ruler);
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
    ) {
        let joint = |(along, s): (f64, f64)| PathJoint {
            along,
            position: line.position(along),
            length_px: s,
            t: spline.at(s),
        };
        let joints: Vec<PathJoint> = ruler.joints(&range).into_iter().map(joint).collect();
        self.paths.push(Path {
            id,
            is_new: false,
            is_revealed: false,
            shown: [joints[0].along, joints[joints.len() - 1].along],
            span,
            joints,
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

    /// Shows of the last path what it has grown to, about its middle.
    fn trim(&mut self, ruler: &Ruler) {
        let Some(path) = self.paths.last_mut() else {
            return;
        };
        let (Some(most), [first, .., last]) = (self.growing.get(&path.id), &path.joints[..]) else {
            return;
        };
        let [from, to] = [first.length_px, last.length_px];
        let cut = 0.5 * (to - from - most);
        if cut > 0.0 {
            path.shown = [from + cut, to - cut].map(|length| ruler.along(length));
        }
    }
}

impl Path {
    /// How many pixels of it are drawn.
    #[must_use]
    pub fn shown_px(&self) -> f64 {
        let length_at = |along: f64| {
            let after = self.joints.partition_point(|joint| joint.along < along);
            let after = after.clamp(1, self.joints.len() - 1);
            let [a, b] = [self.joints[after - 1], self.joints[after]];
            let share = (along - a.along) / (b.along - a.along).max(f64::MIN_POSITIVE);
            a.length_px + (b.length_px - a.length_px) * share.clamp(0.0, 1.0)
        };
        length_at(self.shown[1]) - length_at(self.shown[0])
    }

    /// From where to where it goes.
    fn whole(&self) -> [f64; 2] {
        match self.joints[..] {
            [first, .., last] => [first.along, last.along],
            _ => self.shown,
        }
    }
}

/// The contours of a frame, to be found from places on the surface.
struct Contours<'f> {
    frame: &'f Frame<'f>,
    /// The segments in each triangle that has some, as line and segment.
    segments: HashMap<u32, Vec<(usize, usize)>>,
    /// Of each line its spans, in order.
    spans: Vec<Vec<usize>>,
}

impl<'f> Contours<'f> {
    fn new(frame: &'f Frame) -> Self {
        let mut segments: HashMap<u32, Vec<(usize, usize)>> = HashMap::new();
        let contours = frame.lines.iter().enumerate();
        for (number, line) in contours.filter(|(_, line)| line.kind == Kind::Contour) {
            for (segment, at) in line.segments.iter().enumerate() {
                let in_triangle = segments.entry(at.triangle).or_default();
                in_triangle.push((number, segment));
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
        Self {
            frame,
            segments,
            spans,
        }
    }

    /// The span to which a place of the last frame's contours has come, and where on its line.
    fn now(&self, before: Place) -> Option<(usize, f64)> {
        let frame = self.frame;
        let reach = REACH_PX * frame.pixel;
        let place = walk_to_zero(frame.surface, frame.facing, frame.view, before, reach)?;
        let point = frame.surface.point(place);
        // A triangle has one segment, or two with a cusp between.
        let here = self.segments.get(&place.triangle)?.iter();
        let found = here.map(|&(line, segment)| {
            let (share, off) = nearest_on(&frame.lines[line], segment, point);
            (line, segment as f64 + share, off)
        });
        let (line, along, _) = found.min_by(|a, b| a.2.total_cmp(&b.2))?;
        let count = frame.lines[line].segments.len() as f64;
        let span = span_at(frame.spans, &self.spans[line], along, count)?;
        Some((span, along))
    }
}

/// How long a span of a line with such segments is where. Of one that goes all around the beginning is where that of its path was; votes get their lengths.
fn ruler(lengths: &[f64], span: &Span, votes: &mut [Vote]) -> Ruler {
    let count = lengths.len() as f64;
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
    let ruler = Ruler::new(lengths, whole.start..whole.end);
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
