//! What of each line the eye sees.
//!
//! A line goes from seen to hidden, or back, only where it crosses a nearer contour or border in the image, where it meets another line on the surface, where it goes through a surface, and at a contour's cusps (Bénard and Hertzmann, *Line
//! drawings from 3D models*, 2019, chapter on visibility). Between two such events three rays decide for the whole piece: what single rays get wrong
//! near the horizon, where triangles stand before and behind the smooth surface, makes no gaps.

use crate::{
    Bvh, Kind, Line, MeshError, Ray, Surface, View, crossings::crossings, junctions::junctions,
};
use glam::DVec3;
use std::ops::ControlFlow;

/// Where rays are shot in a piece between two events, as shares of its length in the image.
const RAYS: [f64; 3] = [0.25, 0.5, 0.75];
/// By how many sagittas a ray starts before the triangles: the corner of one is up to 4/3 of an edge's below the smooth surface.
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
/// the eye, also near to it; of what is to hide each other, make one mesh.
///
/// The cost is near to `n log n` in the lines' segments and crossings, and three rays for each piece.
///
/// # Errors
///
/// When `shortest` isn't a number, or below 0.
pub fn visible(
    surface: &Surface,
    bvh: &Bvh,
    view: &View,
    lines: &[Line],
    shortest: f64,
) -> Result<Vec<Span>, MeshError> {
    if shortest.is_nan() || shortest < 0.0 {
        return Err(MeshError::NotPositive {
            what: "the shortest piece's length",
        });
    }
    let rays = Rays::new(surface, bvh, view);
    let mut spans = Vec::new();
    let mut events = crossings(surface, lines, view);
    for (events, junctions) in events.iter_mut().zip(junctions(surface, lines)) {
        events.extend(junctions);
    }
    for (number, (line, mut events)) in lines.iter().zip(events).enumerate() {
        if line.segments.is_empty() {
            continue;
        }
        let lengths = line.image_lengths(view);
        events.extend(pierced(surface, bvh, line));
        let mut pieces = pieces(surface, line, &events, &lengths);
        for piece in &mut pieces {
            piece.seen = !piece.inside && rays.see_most(line, piece, &lengths);
        }
        join_short(&mut pieces, shortest);
        spans.extend(seen_spans(line, number, &pieces));
    }
    Ok(spans)
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

/// Cuts a line at events: where it crosses or meets others or goes through a triangle, and at its cusps.
fn pieces(surface: &Surface, line: &Line, events: &[f64], lengths: &[f64]) -> Vec<Piece> {
    let count = line.segments.len();
    let mut cuts = vec![0.0];
    cuts.extend_from_slice(events);
    cuts.extend(
        (1..count)
            .filter(|&i| line.segments[i - 1].folded != line.segments[i].folded)
            .map(|i| i as f64),
    );
    cuts.push(count as f64);
    cuts.sort_by(f64::total_cmp);
    cuts.dedup();
    cuts.windows(2)
        .map(|ends| Piece {
            start: ends[0],
            end: ends[1],
            length: length_between(lengths, ends[0], ends[1]),
            inside: line.segments[(ends[0] as usize).min(count - 1)].is_inside(surface),
            seen: false,
        })
        .collect()
}

/// How long a part of a line is, by the lengths of its segments.
fn length_between(lengths: &[f64], start: f64, end: f64) -> f64 {
    let last = lengths.len() - 1;
    (start as usize..=(end as usize).min(last))
        .map(|i| lengths[i] * (end.min(i as f64 + 1.0) - start.max(i as f64)).max(0.0))
        .sum()
}

/// The place at a share of a piece's length.
fn place_at(piece: &Piece, lengths: &[f64], share: f64) -> f64 {
    let mut left = piece.length * share;
    let mut at = piece.start;
    while at < piece.end {
        let segment = at as usize;
        let next = (segment as f64 + 1.0).min(piece.end);
        let length = lengths[segment] * (next - at);
        if left < length {
            return at + (next - at) * left / length;
        }
        left -= length;
        at = next;
    }
    // All of it has no length.
    piece.start + (piece.end - piece.start) * share
}

/// Gives pieces shorter than `shortest` the answer of the longer neighbour, the shortest piece first.
fn join_short(pieces: &mut Vec<Piece>, shortest: f64) {
    // What is alike is one.
    let join = |pieces: &mut Vec<Piece>| {
        pieces.dedup_by(|next, before| {
            let alike = (next.seen, next.inside) == (before.seen, before.inside);
            if alike {
                before.end = next.end;
                before.length += next.length;
            }
            alike
        });
    };
    join(pieces);
    // A fold stays what it is, however short: the line ends at its cusps.
    let mut short: Vec<usize> = (0..pieces.len())
        .filter(|&i| pieces[i].length < shortest && !pieces[i].inside)
        .collect();
    short.sort_by(|&a, &b| pieces[a].length.total_cmp(&pieces[b].length));
    for i in short {
        let neighbours = [i.checked_sub(1), Some(i + 1)].into_iter().flatten();
        let longer = neighbours
            .filter_map(|n| pieces.get(n))
            .max_by(|a, b| a.length.total_cmp(&b.length));
        // A speck between two others has no side to take where it is the line itself.
        if let Some(longer) = longer.filter(|longer| longer.length >= pieces[i].length) {
            pieces[i].seen = longer.seen;
        }
    }
    join(pieces);
}

/// The pieces that are seen, joined where they meet, also at the first point of a closed line.
fn seen_spans(line: &Line, number: usize, pieces: &[Piece]) -> Vec<Span> {
    let count = line.segments.len() as f64;
    let cut = |beyond: Option<&Piece>| match beyond {
        None => Cut::End,
        Some(piece) if piece.inside => Cut::Cusp,
        Some(_) => Cut::Hidden,
    };
    let neighbour = |at: usize, forward: bool| match (forward, line.closed) {
        (true, true) => pieces.get((at + 1) % pieces.len()),
        (true, false) => pieces.get(at + 1),
        (false, true) => pieces.get((at + pieces.len() - 1) % pieces.len()),
        (false, false) => at.checked_sub(1).and_then(|at| pieces.get(at)),
    };
    let mut spans = Vec::new();
    for (at, piece) in pieces.iter().enumerate().filter(|(_, piece)| piece.seen) {
        spans.push(Span {
            line: number,
            start: piece.start,
            end: piece.end,
            cuts: [cut(neighbour(at, false)), cut(neighbour(at, true))],
        });
    }
    if line.closed && pieces.len() == 1 {
        spans.iter_mut().for_each(|span| span.cuts = [Cut::None; 2]);
    }
    let through_start = line.closed
        && spans.len() > 1
        && spans[0].start == 0.0
        && spans.last().is_some_and(|last| last.end == count);
    if through_start {
        let first = spans.remove(0);
        if let Some(last) = spans.last_mut() {
            last.end = count + first.end;
            last.cuts[1] = first.cuts[1];
        }
    }
    spans
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

    /// True if most rays from a piece reach the eye.
    fn see_most(&self, line: &Line, piece: &Piece, lengths: &[f64]) -> bool {
        let mut seen = 0;
        for (shot, share) in RAYS.into_iter().enumerate() {
            seen += usize::from(self.see(line, place_at(piece, lengths, share)));
            // Two that agree need no third.
            if shot == 1 && seen != 1 {
                break;
            }
        }
        seen >= 2
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
                let origin = point + normal * (side * CLEARANCE * self.surface.sagitta(triangle));
                let is_around = |t: u32| triangles[t as usize].iter().any(|v| corners.contains(v));
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

    fn ray(&self, origin: DVec3) -> Ray {
        let ray = Ray::to_eye(origin, self.view);
        Ray {
            from: self.same_place / ray.direction.length(),
            ..ray
        }
    }
}
