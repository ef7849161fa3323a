//! What is seen of lines, as strands.

use super::marks::Marks;
use crate::preset::LineKinds;
use glam::{DVec3, Vec3};
use mesh_lines::{Cut, Kind, Line, Span, Surface, View};
use std::rc::Rc;

/// Points of a strand are no nearer to each other in the picture, pixels: what is between them lies on a smooth curve.
const APART_PX: f64 = 1.5;

/// Where points are farther apart, as along the edges of a box, there are points between them, so that a stroke may swell, taper and stray there: pixels.
const FARTHEST_PX: f64 = 10.0;

/// How far a line without ends goes on beyond its beginning, pixels and as a share of its length: so that where it is tapered it has been drawn before.
const OVERLAP_PX: f64 = 60.0;
const OVERLAP_SHARE: f64 = 0.5;

/// Lines of a mesh that an eye sees.
pub(super) struct Seen<'m> {
    pub surface: Surface<'m>,
    /// Which form each mesh of numbered files has: with others it is another mesh.
    pub forms: &'m [usize],
    /// Where its vertices are at rest.
    pub rest: &'m [Vec3],
    /// How far it faces the eye.
    pub facing: Vec<f64>,
    pub lines: Vec<Line>,
    pub spans: Vec<Span>,
    pub view: View,
    /// How long a pixel is in the image.
    pub pixel: f64,
}

/// A strand on a surface, of which nothing hides any.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct LineStrand {
    /// Metres, at least two.
    pub points: Vec<Vec3>,
    /// The surface's unit normals there.
    pub normals: Vec<Vec3>,
    /// Where the surface is there at rest, head heights from the head's centre; of a contour that is followed, which is at rest nowhere, how far along it it is in x.
    pub rest: Vec<Vec3>,
    /// How far along a brush's marks it is there, head heights; empty where no brush leaves any.
    pub marks: Vec<f32>,
}

/// A piece of a line, and why it begins and ends.
struct Piece {
    /// Places along it ([`Line::position`]).
    along: Vec<f64>,
    cuts: [Cut; 2],
}

impl Seen<'_> {
    /// The strands of lines of these kinds on triangles that are meant. Where something hides the rest of a line, it ends `halo_m` before; what
    /// is seen to be shorter than `shortest_m` is left out. Brushes leave `marks`, if any.
    pub fn strands(
        &self,
        kinds: LineKinds,
        is_meant: &dyn Fn(u32) -> bool,
        halo_m: f64,
        shortest_m: f64,
        marks: Option<&Marks>,
    ) -> Vec<LineStrand> {
        let is_wanted = |(_, span): &(usize, &Span)| kinds.have(self.lines[span.line].kind);
        let mut strands = Vec::new();
        // Spans come line by line.
        let mut measured = (usize::MAX, Rc::default());
        for (number, span) in self.spans.iter().enumerate().filter(is_wanted) {
            let line = &self.lines[span.line];
            let of_span = marks.map(|marks| {
                if measured.0 != span.line {
                    measured = (span.line, Marks::lengths(line, self.rest, &self.surface));
                }
                marks.of_span(number, line, &measured.1)
            });
            let shown = match &of_span {
                Some(of_span) => of_span.shown(span),
                None => vec![*span],
            };
            let shown = shown.iter();
            for mut piece in shown.flat_map(|span| pieces(line, span, is_meant)) {
                self.cut_halo(line, &mut piece, halo_m);
                if self.length_m(line, &piece) < shortest_m {
                    continue;
                }
                if piece.cuts == [Cut::None; 2] {
                    self.go_on(line, &mut piece);
                }
                self.thin_out(line, &mut piece);
                self.fill_in(line, &mut piece);
                if piece.along.len() > 1 {
                    let mut strand = self.strand(line, &piece.along);
                    if let Some(of_span) = &of_span {
                        let at = piece.along.iter().map(|along| of_span.at(*along));
                        strand.marks = at.collect();
                        if line.kind == Kind::Contour {
                            let places = strand.marks.iter().map(|mark| Vec3::X * *mark);
                            strand.rest = places.collect();
                        }
                    }
                    strands.push(strand);
                }
            }
        }
        strands
    }

    /// How far two places of a line are from each other in the image, pixels.
    fn apart_px(&self, line: &Line, a: f64, b: f64) -> f64 {
        let [a, b] = [a, b].map(|along| line.position(along));
        self.view.image_distance(a, b) / self.pixel
    }

    /// How long a piece is as it is seen, metres at its depth.
    fn length_m(&self, line: &Line, piece: &Piece) -> f64 {
        let length = |step: &[f64]| {
            let [a, b] = [step[0], step[1]].map(|along| line.position(along));
            self.view.image_distance(a, b) / self.view.image_scale(a).max(f64::MIN_POSITIVE)
        };
        piece.along.windows(2).map(length).sum()
    }

    /// Shortens a piece where something hides the rest.
    fn cut_halo(&self, line: &Line, piece: &mut Piece, halo_m: f64) {
        if halo_m <= 0.0 {
            return;
        }
        for end in [1, 0] {
            if piece.cuts[end] != Cut::Hidden {
                continue;
            }
            if end == 0 {
                piece.along.reverse();
            }
            let Some(&last) = piece.along.last() else {
                return;
            };
            let mut left = halo_m * self.view.image_scale(line.position(last)) / self.pixel;
            while let [.., before, last] = piece.along[..] {
                let length = self.apart_px(line, before, last);
                piece.along.pop();
                if length > left {
                    piece.along.push(last + (before - last) * left / length);
                    break;
                }
                left -= length;
            }
            if end == 0 {
                piece.along.reverse();
            }
        }
    }

    /// Lets a line without ends go on beyond its beginning.
    fn go_on(&self, line: &Line, piece: &mut Piece) {
        let around = line.segments.len() as f64;
        let steps = piece.along.windows(2);
        let whole: f64 = steps
            .map(|step| self.apart_px(line, step[0], step[1]))
            .sum();
        let mut left = OVERLAP_PX.min(OVERLAP_SHARE * whole);
        for index in 1..piece.along.len() {
            let Some(&last) = piece.along.last() else {
                return;
            };
            let next = piece.along[index] + around;
            piece.along.push(next);
            left -= self.apart_px(line, last, next);
            if left <= 0.0 {
                return;
            }
        }
    }

    /// Leaves out places that are next to each other in the picture, but for the ends.
    fn thin_out(&self, line: &Line, piece: &mut Piece) {
        let Some((&first, rest)) = piece.along.split_first() else {
            return;
        };
        let mut kept = vec![first];
        let mut before = first;
        for (index, &place) in rest.iter().enumerate() {
            let is_last = index + 1 == rest.len();
            let is_far = self.apart_px(line, before, place) >= APART_PX;
            if is_last && !is_far && kept.len() > 1 {
                kept.pop();
            }
            if is_last || is_far {
                kept.push(place);
                before = place;
            }
        }
        piece.along = kept;
    }

    /// Puts places between those that are far apart in the picture.
    fn fill_in(&self, line: &Line, piece: &mut Piece) {
        let mut filled = Vec::with_capacity(piece.along.len());
        for step in piece.along.windows(2) {
            let [from, to] = [step[0], step[1]];
            let parts = (self.apart_px(line, from, to) / FARTHEST_PX).ceil();
            // Before and behind the eye lengths in the picture may be anything.
            let parts = if parts.is_finite() {
                parts.clamp(1.0, 1000.0) as usize
            } else {
                1
            };
            let place = |part: usize| from + (to - from) * part as f64 / parts as f64;
            filled.extend((0..parts).map(place));
        }
        filled.extend(piece.along.last());
        piece.along = filled;
    }

    fn strand(&self, line: &Line, along: &[f64]) -> LineStrand {
        let mut strand = LineStrand::default();
        for &along in along {
            let place = line.place(&self.surface, along);
            let corners = self.surface.topology().triangles()[place.triangle as usize];
            let corners = corners.map(|vertex| self.rest[vertex as usize].as_dvec3());
            let weights = place.weights.to_array();
            let at_rest: DVec3 = corners.iter().zip(weights).map(|(p, w)| *p * w).sum();
            strand.points.push(line.position(along).as_vec3());
            strand.normals.push(self.surface.normal(place).as_vec3());
            strand.rest.push(at_rest.as_vec3());
        }
        strand
    }
}

/// The pieces of a span on triangles that are meant.
fn pieces(line: &Line, span: &Span, is_meant: &dyn Fn(u32) -> bool) -> Vec<Piece> {
    let mut along = vec![span.start];
    let whole = span.start.floor() as usize + 1..span.end.ceil() as usize;
    along.extend(whole.map(|place| place as f64));
    along.push(span.end);
    let mut pieces: Vec<Piece> = Vec::new();
    let mut is_open = false;
    for step in along.windows(2) {
        let segment = (0.5 * (step[0] + step[1])) as usize % line.segments.len();
        if !is_meant(line.segments[segment].triangle) {
            is_open = false;
            continue;
        }
        match pieces.last_mut() {
            Some(piece) if is_open => piece.along.push(step[1]),
            _ => pieces.push(Piece {
                along: vec![step[0], step[1]],
                cuts: [Cut::End; 2],
            }),
        }
        is_open = true;
    }
    for piece in &mut pieces {
        if piece.along.first() == Some(&span.start) {
            piece.cuts[0] = span.cuts[0];
        }
        if piece.along.last() == Some(&span.end) {
            piece.cuts[1] = span.cuts[1];
        }
    }
    pieces
}
