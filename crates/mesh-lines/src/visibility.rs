//! What of each line the eye sees.
//!
//! A line goes from seen to hidden, or back, only where it crosses a nearer contour or border in the image, where it meets another line on the surface, where it goes through a surface, and at a contour's cusps (Bénard and Hertzmann, *Line
//! drawings from 3D models*, 2019, chapter on visibility). Between two such events three rays decide for the whole piece: what single rays get wrong
//! near the horizon, where triangles stand before and behind the smooth surface, makes no gaps. Where rays say that it changes once between two events, it is cut there.
//!
//! Events are where lines cross, and what hides are triangles, whose own horizon is up to a sagitta beside the smooth contour: at a shallow angle it hides a line many pixels before
//! or behind the crossing. So borders between what is seen and what isn't are moved to where rays change.

use crate::{
    Bvh, Kind, Line, MeshError, Ray, Surface, View,
    crossings::crossings,
    junctions::junctions,
    line::check_lines,
    threads::{join as both, map},
};
use glam::DVec3;
use std::ops::ControlFlow;

/// Where rays are shot in a piece between two events, as shares of its length in the image.
const RAYS: [f64; 3] = [0.25, 0.75, 0.5];
/// Where the first two of them disagree so many are shot, to find whether there is one place from which on the eye sees the rest.
const MORE_RAYS: usize = 9;
/// That place is known to the piece's length over 2 to the power of this.
const HALVINGS: usize = 16;
/// Rays beside a border begin so near to it: as a share of the shortest piece, or of their own if there is no such.
const BESIDE_SHORTEST: f64 = 0.05;
const BESIDE: f64 = 1e-3;
/// A border is moved through no more than this share of a piece, in steps that double, and then to one of them over 2 to the power of this.
const MOST_MOVED: f64 = 0.5;
const SETTLINGS: usize = 8;
/// By how many sagittas a ray starts before the triangles: the corner of one is up to 4/3 of an edge's below the smooth surface. Less where something else is nearer.
const CLEARANCE: f64 = 2.0;
/// Within so many of the last digits of f32 two places are one.
const SAME_PLACE: f64 = 8.0 * f32::EPSILON as f64;

/// A piece of a line that the eye sees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Span {
    /// The line's index.
    pub line: usize,
    /// Where it begins, as a segment's index and the share of the way along it ([`Line::position`]).
    pub start: f64,
    /// Where it ends. On a closed line it may be beyond the number of segments: then the span goes through the line's first point.
    pub end: f64,
    /// Why it begins there and ends there.
    pub cuts: [Cut; 2],
}

/// Why what is seen of a line ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Cut {
    /// It doesn't: the line is closed, and seen all around.
    None,
    /// The line itself ends.
    End,
    /// A contour runs along the line of sight and on behind the fold.
    Cusp,
    /// Something nearer to the eye hides the rest.
    Hidden,
}

/// What the eye sees of lines, by line and in order along each.
///
/// `lines` are all that there are, since they hide each other: contours of this view, borders, and creases where the mesh has sharp edges. `bvh` is that of `surface`. Pieces that are
/// shorter than `shortest` in the image ([`View`]; a pixel, or 0) become as the longer one of their neighbours. Everything counts that lies between a line and
/// the eye, also near to it, but for what is nearer than a millionth of the mesh's farthest coordinate: a floor of 100 km has 0.1 m of it. Of what is to hide each
/// other, make one mesh.
///
/// The cost is near to `n log n` in the lines' segments and crossings, two rays for each piece, up to 28 where they disagree, and two for each border between what is seen and what isn't,
/// some 20 where it is moved. A contour's ray has a second, short one before it.
///
/// # Errors
///
/// When `shortest` is NaN, infinite or below 0, or a line isn't one of `surface`.
pub fn visible(
    surface: &Surface,
    bvh: &Bvh,
    view: &View,
    lines: &[Line],
    shortest: f64,
) -> Result<Vec<Span>, MeshError> {
    visible_of(surface, bvh, view, lines, |_| true, shortest)
}

/// The same of the lines that are `wanted` alone: those that nobody draws hide others, and what of them is seen need not be found.
///
/// # Errors
///
/// As of [`visible`].
pub fn visible_of(
    surface: &Surface,
    bvh: &Bvh,
    view: &View,
    lines: &[Line],
    wanted: impl Fn(&Line) -> bool,
    shortest: f64,
) -> Result<Vec<Span>, MeshError> {
    if !(shortest.is_finite() && shortest >= 0.0) {
        return Err(MeshError::Negative {
            what: "the shortest piece's length",
        });
    }
    check_lines(surface, lines)?;
    // Of what is shrunk to a point, as files of characters hide parts, nothing is seen.
    let has_length = |line: &Line| {
        let first = line.points.first().map(|first| first.position);
        let mut places = line.points.iter().map(|point| point.position);
        places.any(|place| Some(place) != first)
    };
    let wanted = |line: &Line| wanted(line) && has_length(line);
    let wanted: Vec<bool> = lines.iter().map(wanted).collect();
    let meetings = || {
        let mut events = crossings(surface, lines, &wanted, view);
        for (events, junctions) in events.iter_mut().zip(junctions(surface, lines)) {
            events.extend(junctions);
        }
        events
    };
    let piercings = || {
        map(lines, |number, line| match wanted[number] {
            true => pierced(surface, bvh, line),
            false => Vec::new(),
        })
    };
    let (mut events, pierced) = both(meetings, piercings);
    for (events, pierced) in events.iter_mut().zip(pierced) {
        events.extend(pierced);
    }
    let rays = Rays::new(surface, bvh, view);
    let of_lines = map(lines, |number, line| {
        if line.segments.is_empty() || !wanted[number] {
            return Vec::new();
        }
        let lengths = line.image_lengths(view);
        let pieces = pieces(surface, line, &events[number], &lengths);
        let mut pieces = rays.decide(line, pieces, &lengths);
        join(&mut pieces, line);
        rays.settle(line, &mut pieces, &lengths, shortest);
        join_short(&mut pieces, line, shortest);
        seen_spans(line, number, &pieces)
    });
    Ok(of_lines.concat())
}

/// True if nothing lies between the eye and a place along a line: one ray, as [`visible`] shoots three for each piece. The inside of what is closed is never seen.
///
/// # Panics
///
/// When the line has no segments.
#[must_use]
pub fn is_seen(surface: &Surface, bvh: &Bvh, view: &View, line: &Line, along: f64) -> bool {
    let inside = line.segments[line.segment(along).0].is_inside(surface);
    !inside && Rays::new(surface, bvh, view).see(line, along)
}

/// A piece of a line between two events.
#[derive(Clone, Copy, Debug)]
struct Piece {
    start: f64,
    /// Of the last piece of a closed line it may be beyond the number of segments, as that of a [`Span`].
    end: f64,
    /// In the image.
    length: f64,
    inside: bool,
    seen: bool,
}

/// The places along a line where it goes through a triangle that isn't beside it: meshes that are in each other.
fn pierced(surface: &Surface, bvh: &Bvh, line: &Line) -> Vec<f64> {
    let triangles = surface.topology().triangles();
    let mut places = Vec::new();
    for (number, segment) in line
        .segments
        .iter()
        .enumerate()
        .filter(|(_, s)| !s.is_inside(surface))
    {
        let [from, to] = line.ends(number).map(|end| end.position);
        let ray = Ray {
            origin: from,
            direction: to - from,
            from: 0.0,
            to: 1.0,
        };
        let corners = triangles[segment.triangle as usize];
        bvh.hits(surface, &ray, |hit| {
            let is_beside = triangles[hit.triangle as usize]
                .iter()
                .any(|v| corners.contains(v));
            if !is_beside {
                places.push(number as f64 + hit.distance);
            }
            ControlFlow::Continue(())
        });
    }
    places
}

/// Cuts a line at events: where it crosses or meets others or goes through a triangle, and at its cusps. The first point of a closed line is no event.
fn pieces(surface: &Surface, line: &Line, events: &[f64], lengths: &[f64]) -> Vec<Piece> {
    let count = line.segments.len();
    let end = count as f64;
    let mut cuts = events.to_vec();
    cuts.extend(
        (usize::from(!line.closed)..count)
            .filter(|&i| line.segments[(i + count - 1) % count].folded != line.segments[i].folded)
            .map(|i| i as f64),
    );
    if line.closed {
        cuts.iter_mut().for_each(|cut| *cut %= end);
    } else {
        cuts.extend([0.0, end]);
    }
    cuts.sort_by(f64::total_cmp);
    cuts.dedup();
    if line.closed {
        // Around from the first event to itself; where there is none, from the first point.
        if cuts.is_empty() {
            cuts.push(0.0);
        }
        cuts.push(end + cuts[0]);
    }
    cuts.windows(2)
        .map(|ends| Piece {
            start: ends[0],
            end: ends[1],
            length: length_between(lengths, ends[0], ends[1]),
            inside: line.segments[ends[0] as usize].is_inside(surface),
            seen: false,
        })
        .collect()
}

/// How long a part of a line is, by the lengths of its segments.
fn length_between(lengths: &[f64], start: f64, end: f64) -> f64 {
    (start as usize..end.ceil() as usize)
        .map(|i| lengths[i % lengths.len()] * (end.min(i as f64 + 1.0) - start.max(i as f64)))
        .sum()
}

/// The place at a share of a piece's length.
fn place_at(piece: &Piece, lengths: &[f64], share: f64) -> f64 {
    let mut left = piece.length * share;
    let mut at = piece.start;
    while at < piece.end {
        let segment = at as usize;
        let next = (segment as f64 + 1.0).min(piece.end);
        let length = lengths[segment % lengths.len()] * (next - at);
        if left < length {
            return at + (next - at) * left / length;
        }
        left -= length;
        at = next;
    }
    // All of it has no length.
    piece.start + (piece.end - piece.start) * share
}

/// Has the pieces of a closed line of that many segments begin on it again, the first of them first: their borders may have moved over its first point.
fn begin_on_line(pieces: &mut [Piece], around: f64) {
    for piece in &mut *pieces {
        let turns = (piece.start / around).floor() * around;
        piece.start -= turns;
        piece.end -= turns;
    }
    pieces.sort_by(|a, b| a.start.total_cmp(&b.start));
}

/// The index of the piece before or after one, if it isn't the same: of a closed line the first comes after the last.
fn neighbour(pieces: &[Piece], line: &Line, at: usize, forward: bool) -> Option<usize> {
    let count = pieces.len();
    match (forward, line.closed) {
        (_, true) if count == 1 => None,
        (true, true) => Some((at + 1) % count),
        (false, true) => Some((at + count - 1) % count),
        (true, false) => Some(at + 1).filter(|&next| next < count),
        (false, false) => at.checked_sub(1),
    }
}

/// Joins neighbours that are alike.
fn join(pieces: &mut Vec<Piece>, line: &Line) {
    let joined = |before: &mut Piece, next: &Piece, end: f64| {
        let alike = (next.seen, next.inside) == (before.seen, before.inside);
        if alike {
            before.end = end;
            before.length += next.length;
        }
        alike
    };
    pieces.dedup_by(|next, before| joined(before, next, next.end));
    if let [first, .., last] = pieces.as_mut_slice()
        && line.closed
        && joined(last, first, line.segments.len() as f64 + first.end)
    {
        pieces.remove(0);
    }
}

/// Gives pieces shorter than `shortest` the answer of the longer neighbour, the shortest piece first.
fn join_short(pieces: &mut Vec<Piece>, line: &Line, shortest: f64) {
    join(pieces, line);
    // A fold stays what it is, however short: the line ends at its cusps.
    let mut short: Vec<usize> = (0..pieces.len())
        .filter(|&i| pieces[i].length < shortest && !pieces[i].inside)
        .collect();
    short.sort_by(|&a, &b| pieces[a].length.total_cmp(&pieces[b].length));
    for i in short {
        let longer = [false, true]
            .into_iter()
            .filter_map(|forward| Some(pieces[neighbour(pieces, line, i, forward)?]))
            .max_by(|a, b| a.length.total_cmp(&b.length));
        // A speck between two others has no side to take where it is the line itself.
        if let Some(longer) = longer.filter(|longer| longer.length >= pieces[i].length) {
            pieces[i].seen = longer.seen;
        }
    }
    join(pieces, line);
}

/// The pieces that are seen, which don't meet each other.
fn seen_spans(line: &Line, number: usize, pieces: &[Piece]) -> Vec<Span> {
    if let [Piece { seen: true, .. }] = pieces
        && line.closed
    {
        return vec![Span {
            line: number,
            start: 0.0,
            end: line.segments.len() as f64,
            cuts: [Cut::None; 2],
        }];
    }
    let cut = |at: usize, forward: bool| match neighbour(pieces, line, at, forward) {
        None => Cut::End,
        Some(beyond) if pieces[beyond].inside => Cut::Cusp,
        Some(_) => Cut::Hidden,
    };
    (0..pieces.len())
        .filter(|&at| pieces[at].seen)
        .map(|at| Span {
            line: number,
            start: pieces[at].start,
            end: pieces[at].end,
            cuts: [cut(at, false), cut(at, true)],
        })
        .collect()
}

/// Rays from lines to the eye.
struct Rays<'a> {
    surface: &'a Surface<'a>,
    bvh: &'a Bvh,
    view: &'a View,
    /// Places nearer to each other are one.
    same_place: f64,
}

impl<'a> Rays<'a> {
    fn new(surface: &'a Surface, bvh: &'a Bvh, view: &'a View) -> Self {
        let farthest = bvh.farthest_coordinate();
        Self {
            surface,
            bvh,
            view,
            same_place: farthest * SAME_PLACE,
        }
    }

    /// Finds which pieces of a line are seen, and cuts those that are in part.
    fn decide(&self, line: &Line, pieces: Vec<Piece>, lengths: &[f64]) -> Vec<Piece> {
        let is_around = line.closed && pieces.len() == 1;
        let mut decided = Vec::with_capacity(pieces.len());
        for piece in pieces {
            let (seen, change) = match piece.inside {
                true => (false, None),
                false => self.look(line, &piece, lengths),
            };
            let Some(share) = change.filter(|_| !is_around) else {
                decided.push(Piece { seen, ..piece });
                continue;
            };
            // Most of it is seen, or hidden: the other side of the middle isn't.
            let place = place_at(&piece, lengths, share);
            let is_first = share > 0.5;
            decided.push(Piece {
                end: place,
                length: piece.length * share,
                seen: seen == is_first,
                ..piece
            });
            let rest = Piece {
                start: place,
                length: piece.length * (1.0 - share),
                seen: seen != is_first,
                ..piece
            };
            let around = line.segments.len() as f64;
            if place < around {
                decided.push(rest);
            } else {
                // Beyond a closed line's first point: there it comes before all others.
                let [start, end] = [rest.start, rest.end].map(|at| at - around);
                decided.insert(0, Piece { start, end, ..rest });
            }
        }
        decided
    }

    /// Whether most of three rays from a piece reach the eye; and where they change from one place on, as a share of the piece's length, unless they agree or
    /// change more than once.
    fn look(&self, line: &Line, piece: &Piece, lengths: &[f64]) -> (bool, Option<f64>) {
        let see = |share: f64| self.see(line, place_at(piece, lengths, share));
        let [first, last, middle] = RAYS;
        let seen = see(first);
        // Two that agree need no third.
        if seen == see(last) {
            return (seen, None);
        }
        let shares = (0..MORE_RAYS).map(|i| (i as f64 + 0.5) / MORE_RAYS as f64);
        let answers: Vec<(f64, bool)> = shares.map(|share| (share, see(share))).collect();
        let mut changes = answers.windows(2).filter(|pair| pair[0].1 != pair[1].1);
        let (Some(pair), None) = (changes.next(), changes.next()) else {
            return (see(middle), None);
        };
        let (mut before, mut after) = (pair[0].0, pair[1].0);
        for _ in 0..HALVINGS {
            let half = 0.5 * (before + after);
            if see(half) == seen {
                before = half;
            } else {
                after = half;
            }
        }
        let share = 0.5 * (before + after);
        (if share > 0.5 { seen } else { !seen }, Some(share))
    }

    /// Moves the borders between what is seen and what isn't to where rays change.
    fn settle(&self, line: &Line, pieces: &mut [Piece], lengths: &[f64], shortest: f64) {
        let around = line.segments.len() as f64;
        let moves = |(number, before): (usize, &Piece)| {
            let next = neighbour(pieces, line, number, true)?;
            let after = &pieces[next];
            if before.inside || after.inside || before.seen == after.seen {
                return None;
            }
            let forth = self.other_side(line, after, lengths, shortest, |share| share);
            if forth > 0.0 {
                let length = forth * after.length;
                return Some((number, next, place_at(after, lengths, forth), length));
            }
            let back = self.other_side(line, before, lengths, shortest, |share| 1.0 - share);
            let place = place_at(before, lengths, 1.0 - back);
            (back > 0.0).then_some((number, next, place, -back * before.length))
        };
        // All by the pieces as they were, so that it makes no difference where a closed line begins.
        let moves: Vec<_> = pieces.iter().enumerate().filter_map(moves).collect();
        for (before, after, place, length) in moves {
            pieces[before].length += length;
            pieces[after].length -= length;
            // The last piece of a closed line is followed by the first, a turn later.
            let turn = match after > before {
                true => 0.0,
                false if length > 0.0 => around,
                false => -around,
            };
            let (end, start) = match length > 0.0 {
                true => (place + turn, place),
                false => (place, place + turn),
            };
            (pieces[before].end, pieces[after].start) = (end, start);
        }
        if line.closed {
            begin_on_line(pieces, around);
        }
    }

    /// How far into a piece rays see what they see on the other side of one of its ends, as a share of its length; `from_end` gives the place of
    /// such a share.
    fn other_side(
        &self,
        line: &Line,
        piece: &Piece,
        lengths: &[f64],
        shortest: f64,
        from_end: impl Fn(f64) -> f64,
    ) -> f64 {
        let agrees = |share: f64| {
            let place = place_at(piece, lengths, from_end(share));
            self.see(line, place) == piece.seen
        };
        let (mut other, mut own) = (0.0, (BESIDE_SHORTEST * shortest / piece.length).max(BESIDE));
        // Not so where a piece is a speck, or has no length.
        while own < MOST_MOVED {
            if agrees(own) {
                if other > 0.0 {
                    for _ in 0..SETTLINGS {
                        let half = 0.5 * (other + own);
                        match agrees(half) {
                            true => own = half,
                            false => other = half,
                        }
                    }
                }
                return other;
            }
            (other, own) = (own, 2.0 * own);
        }
        other
    }

    fn see(&self, line: &Line, along: f64) -> bool {
        let (segment, _) = line.segment(along);
        let triangle = line.segments[segment].triangle;
        let triangles = self.surface.topology().triangles();
        let corners = triangles[triangle as usize];
        let point = line.position(along);
        match line.kind {
            Kind::Contour => {
                // The triangles there are as often before the smooth surface's horizon as behind it.
                let normal = self.surface.normal(line.place(self.surface, along));
                let side = if line.segments[segment].folded {
                    -1.0
                } else {
                    1.0
                };
                let way = normal * (side * CLEARANCE * self.surface.sagitta(triangle));
                let is_around = |t: u32| triangles[t as usize].iter().any(|v| corners.contains(v));
                let origin = point + way * self.free_share(point, way, is_around);
                !self
                    .bvh
                    .is_blocked(self.surface, &self.ray(origin), is_around)
            }
            Kind::Crease | Kind::Border => {
                let ends = line.ends(segment).map(|end| end.place.vertex(self.surface));
                let has_edge = |t: u32| ends.iter().all(|v| triangles[t as usize].contains(v));
                !self
                    .bvh
                    .is_blocked(self.surface, &self.ray(point), has_edge)
            }
        }
    }

    /// How much of a way from a line a ray may start along: all of it, or half of that to the first triangle that isn't around. Beyond one it would start on
    /// the other side of what hides the line, where coarse triangles lie in or near to others.
    fn free_share(&self, point: DVec3, way: DVec3, is_around: impl Fn(u32) -> bool) -> f64 {
        let ray = Ray {
            origin: point,
            direction: way,
            from: 0.0,
            to: 1.0,
        };
        let mut first = 2.0_f64;
        self.bvh.hits(self.surface, &ray, |hit| {
            if hit.distance < first && !is_around(hit.triangle) {
                first = hit.distance;
            }
            ControlFlow::Continue(())
        });
        0.5 * first
    }

    fn ray(&self, origin: DVec3) -> Ray {
        let ray = Ray::to_eye(origin, self.view);
        Ray {
            from: self.same_place / ray.direction.length(),
            ..ray
        }
    }
}
