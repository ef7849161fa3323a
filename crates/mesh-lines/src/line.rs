//! What a line on a mesh is.

use crate::{MeshError, Place, Surface, View};
use glam::DVec3;

/// What a line is a line of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Kind {
    /// Where the surface turns away from the eye.
    Contour,
    /// Where the surface has an edge.
    Crease,
    /// Where the surface ends.
    Border,
}

/// A line on a mesh: a chain of straight segments, each of them in one triangle or on one edge.
#[derive(Clone, Debug, PartialEq)]
pub struct Line {
    /// What it is a line of.
    pub kind: Kind,
    /// True if the last segment leads from the last point to the first.
    pub closed: bool,
    /// Its joints, in order. Neighbours may coincide, where a contour passes through a vertex.
    pub points: Vec<LinePoint>,
    /// Its segments: as many as points if it is closed, else one fewer. Segment `i` begins at point `i`.
    pub segments: Vec<Segment>,
}

/// A joint of a line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinePoint {
    /// Where it is.
    pub position: DVec3,
    /// On what it lies.
    pub place: Place,
}

/// A piece of a line between two joints.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Segment {
    /// The triangle through which it runs; of an edge the lowest one of those beside it.
    pub triangle: u32,
    /// True if the surface bends towards the line of sight, seen from the front: then only an eye behind the surface could see it. Of contours alone.
    pub folded: bool,
}

impl Segment {
    /// True if it is within what is closed: nobody sees it.
    #[must_use]
    pub fn is_inside(&self, surface: &Surface) -> bool {
        self.folded && surface.topology().is_closed(self.triangle)
    }
}

impl Line {
    /// The two joints of a segment.
    #[must_use]
    pub fn ends(&self, segment: usize) -> [&LinePoint; 2] {
        [
            &self.points[segment],
            &self.points[(segment + 1) % self.points.len()],
        ]
    }

    /// The point at a place along the line: the segment's index and the share of the way along it, as one number.
    ///
    /// Beyond the end of a closed line it goes on from its beginning.
    ///
    /// # Panics
    ///
    /// When the line has no segments.
    #[must_use]
    pub fn position(&self, along: f64) -> DVec3 {
        let (segment, share) = self.segment(along);
        let [from, to] = self.ends(segment);
        from.position.lerp(to.position, share)
    }

    /// On what a place along the line lies, within the triangle of its segment.
    ///
    /// # Panics
    ///
    /// When the line has no segments.
    #[must_use]
    pub fn place(&self, surface: &Surface, along: f64) -> Place {
        let (segment, share) = self.segment(along);
        let triangle = self.segments[segment].triangle;
        let [from, to] = self
            .ends(segment)
            .map(|end| within(surface, end.place, triangle));
        from.mix(to, share)
    }

    /// The segment at a place along the line, and the share of the way along it.
    pub(crate) fn segment(&self, along: f64) -> (usize, f64) {
        let count = self.segments.len();
        let whole = along.max(0.0).floor();
        if self.closed {
            (whole as usize % count, along.max(0.0) - whole)
        } else {
            let segment = (whole as usize).min(count - 1);
            (segment, (along - segment as f64).clamp(0.0, 1.0))
        }
    }

    /// How long each segment is in the image ([`View`]).
    #[must_use]
    pub fn image_lengths(&self, view: &View) -> Vec<f64> {
        let images: Vec<DVec3> = self.points.iter().map(|p| view.image(p.position)).collect();
        (0..self.segments.len())
            .map(|i| images[i].distance(images[(i + 1) % images.len()]))
            .collect()
    }
}

/// Refuses lines of another mesh, as far as they can be told.
pub(crate) fn check_lines(surface: &Surface, lines: &[Line]) -> Result<(), MeshError> {
    let triangles = surface.topology().triangles().len();
    let is_of_it = |line: &Line| {
        let of_segments = line.segments.iter().map(|segment| segment.triangle);
        let of_points = line.points.iter().map(|point| point.place.triangle);
        let joints = line.segments.len() + usize::from(!line.closed);
        (line.points.len() == joints || line.segments.is_empty())
            && of_segments
                .chain(of_points)
                .all(|t| (t as usize) < triangles)
    };
    for (number, line) in lines.iter().enumerate() {
        if !is_of_it(line) {
            return Err(MeshError::OtherLine { line: number });
        }
        if !line.points.iter().all(|point| point.position.is_finite()) {
            return Err(MeshError::NotFinite {
                what: "a position of line",
                index: number,
            });
        }
    }
    Ok(())
}

/// A place on the edge of a triangle, said of the triangle beside it: of which `place` must be.
fn within(surface: &Surface, place: Place, triangle: u32) -> Place {
    if place.triangle == triangle {
        return place;
    }
    let topology = surface.topology();
    let from = topology.triangles()[place.triangle as usize];
    let to = topology.triangles()[triangle as usize];
    let mut weights = DVec3::ZERO;
    for (corner, vertex) in to.iter().enumerate() {
        if let Some(other) = from.iter().position(|same| same == vertex) {
            weights[corner] = place.weights[other];
        }
    }
    Place { triangle, weights }
}
