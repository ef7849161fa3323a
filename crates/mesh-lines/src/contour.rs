//! Where something changes its sign on a surface: zero sets, and contours as those of the angle to the eye.

use crate::threads;
use crate::{Beside, Kind, Line, LinePoint, MeshError, Place, Segment, Surface, Topology, View};

/// f: how far the surface faces the eye at each smooth vertex, `n . c`. Positive towards the eye; 0 at contours (W 5.4, after Hertzmann and Zorin,
/// *Illustrating smooth surfaces*, 2000, section 4.1).
#[must_use]
pub fn facing(surface: &Surface, view: &View) -> Vec<f64> {
    let topology = surface.topology();
    let normals = surface.normals().iter().enumerate();
    normals
        .map(|(smooth, normal)| {
            let position = surface.position(topology.vertex(smooth) as u32);
            normal.as_dvec3().dot(view.towards(position))
        })
        .collect()
}

/// The contours of a surface, as smooth as its normals: all lines on which [`facing`] is 0, whole, hidden or not. `facing` is that of the same surface and view.
///
/// On a closed surface without sharp edges all are closed. Where the surface bends the other way along the line of sight (the far side of
/// a fold) segments are [`Segment::folded`]: grad f . c <= 0, of the mean gradient around each vertex. A joint is where that changes, the *cusp*.
///
/// # Errors
///
/// When `facing` has not one finite number for each smooth vertex.
pub fn contours(surface: &Surface, view: &View, facing: &[f64]) -> Result<Vec<Line>, MeshError> {
    let mut lines = zero_set(surface, facing)?;
    // Each is asked for by all the edges around its vertex.
    let mut bends = vec![f64::NAN; facing.len()];
    let mut asked = Vec::new();
    for point in lines.iter().flat_map(|line| &line.points) {
        for (vertex, _) in beside(point, surface) {
            if bends[vertex as usize].is_nan() {
                bends[vertex as usize] = 0.0;
                asked.push(vertex);
            }
        }
    }
    let found = threads::map(&asked, |_, vertex| bend(*vertex, surface, view, facing));
    for (vertex, bend) in asked.into_iter().zip(found) {
        bends[vertex as usize] = bend;
    }
    for line in &mut lines {
        mark_folds(line, surface, &bends);
    }
    Ok(lines)
}

/// The smooth vertices that have a part in a point of a line, and their weights.
fn beside(point: &LinePoint, surface: &Surface) -> impl Iterator<Item = (u32, f64)> {
    let vertices = surface.topology().smooth_corners()[point.place.triangle as usize];
    let weights = point.place.weights.to_array();
    let all = vertices.into_iter().zip(weights);
    all.filter(|(_, weight)| *weight != 0.0)
}

/// The lines on which a function is 0 that is linear within triangles and given at the smooth vertices, as chains of one segment for each triangle that has both
/// signs. A vertex at which it is exactly 0 counts as positive.
///
/// On a surface whose triangles have neighbours on all sides every line is closed. Others end at borders and at sharp edges.
/// Lines run so that the positive side is on their left, seen from the front.
///
/// # Errors
///
/// When there is not one finite number for each smooth vertex.
pub fn zero_set(surface: &Surface, values: &[f64]) -> Result<Vec<Line>, MeshError> {
    let topology = surface.topology();
    if values.len() != topology.smooth_vertices() {
        return Err(MeshError::Count {
            what: "values",
            found: values.len(),
            vertices: topology.smooth_vertices(),
        });
    }
    if let Some(index) = values.iter().position(|value| !value.is_finite()) {
        return Err(MeshError::NotFinite {
            what: "value",
            index,
        });
    }
    let crossings = Crossings {
        surface,
        topology,
        values,
    };
    let mut traced = vec![0u64; topology.triangles().len().div_ceil(64)];
    let mut lines = Vec::new();
    for (triangle, corners) in (0..).zip(topology.smooth_corners()) {
        let [a, b, c] = corners.map(|vertex| values[vertex as usize] >= 0.0);
        if (a != b || b != c) && !is_set(&traced, triangle) {
            lines.push(crossings.line(triangle, &mut traced));
        }
    }
    Ok(lines)
}

struct Crossings<'a> {
    surface: &'a Surface<'a>,
    topology: &'a Topology,
    values: &'a [f64],
}

impl Crossings<'_> {
    /// The line through a triangle that has both signs.
    fn line(&self, triangle: u32, traced: &mut [u64]) -> Line {
        set(traced, triangle);
        let [entry, exit] = self.sides(triangle);
        let mut points = vec![self.point(entry), self.point(exit)];
        let mut segments = vec![unfolded(triangle)];
        let closed = self.follow(exit, traced, |point, triangle| {
            points.push(point);
            segments.push(unfolded(triangle));
        });
        if closed {
            points.pop();
        } else {
            points.reverse();
            segments.reverse();
            self.follow(entry, traced, |point, triangle| {
                points.push(point);
                segments.push(unfolded(triangle));
            });
            points.reverse();
            segments.reverse();
        }
        Line {
            kind: Kind::Contour,
            closed,
            points,
            segments,
        }
    }

    /// Goes on from a half-edge through which a line leaves its triangle, and says if it came back to a triangle traced before.
    fn follow(
        &self,
        mut exit: u32,
        traced: &mut [u64],
        mut add: impl FnMut(LinePoint, u32),
    ) -> bool {
        while let Beside::Twin(twin) = self.topology.beside(exit) {
            if self.topology.is_sharp(exit) {
                break;
            }
            let triangle = twin / 3;
            if is_set(traced, triangle) {
                return true;
            }
            set(traced, triangle);
            // Of neighbours that are wound against each other the line runs backwards through one.
            let [a, b] = self.sides(triangle);
            exit = if a == twin { b } else { a };
            add(self.point(exit), triangle);
        }
        false
    }

    /// The half-edges of a triangle with both signs through which the line comes in and goes out: from positive to negative, and back.
    fn sides(&self, triangle: u32) -> [u32; 2] {
        let mut sides = [triangle * 3; 2];
        for half_edge in triangle * 3..triangle * 3 + 3 {
            match self.values_at(half_edge).map(|value| value >= 0.0) {
                [true, false] => sides[0] = half_edge,
                [false, true] => sides[1] = half_edge,
                _ => {}
            }
        }
        sides
    }

    /// Where the line crosses an edge: the same point, bit for bit, whichever half of it is asked.
    fn point(&self, half_edge: u32) -> LinePoint {
        let [from, to] = self.topology.ends(half_edge);
        let [value, other] = self.values_at(half_edge);
        let [p, q] = [from, to].map(|vertex| self.surface.position(vertex));
        let share = value / (value - other);
        let from_lower = from < to;
        LinePoint {
            position: if from_lower {
                p + (q - p) * share
            } else {
                q + (p - q) * (other / (other - value))
            },
            place: Place::on_edge(half_edge, share),
        }
    }

    /// The values at the two ends of a half-edge.
    fn values_at(&self, half_edge: u32) -> [f64; 2] {
        let smooth = self.topology.smooth_corners()[half_edge as usize / 3];
        let corner = half_edge as usize % 3;
        [smooth[corner], smooth[(corner + 1) % 3]].map(|vertex| self.values[vertex as usize])
    }
}

fn unfolded(triangle: u32) -> Segment {
    Segment {
        triangle,
        folded: false,
    }
}

/// Finds which segments of a contour are folded, by what [`bend`] is at the smooth vertices beside it, and puts joints at its cusps.
fn mark_folds(line: &mut Line, surface: &Surface, bend_at: &[f64]) {
    let bend = |point: &LinePoint| {
        let bends =
            beside(point, surface).map(|(vertex, weight)| weight * bend_at[vertex as usize]);
        bends.sum()
    };
    let bends: Vec<f64> = line.points.iter().map(bend).collect();
    let points = std::mem::take(&mut line.points);
    let segments = std::mem::take(&mut line.segments);
    for (i, point) in points.iter().enumerate() {
        line.points.push(*point);
        let Some(segment) = segments.get(i) else {
            break;
        };
        let next = (i + 1) % points.len();
        let [before, after] = [bends[i], bends[next]];
        let folded = |bend: f64| Segment {
            folded: bend <= 0.0,
            ..*segment
        };
        line.segments.push(folded(before));
        if (before <= 0.0) != (after <= 0.0) {
            let share = before / (before - after);
            let position = point.position.lerp(points[next].position, share);
            let along = Line {
                kind: line.kind,
                closed: false,
                points: vec![*point, points[next]],
                segments: vec![*segment],
            };
            line.points.push(LinePoint {
                position,
                place: along.place(surface, share),
            });
            line.segments.push(folded(after));
        }
    }
}

/// grad f . c at a smooth vertex, by the mean of the gradients around it, weighted by area: positive where the surface bends away from the line of sight.
fn bend(smooth_vertex: u32, surface: &Surface, view: &View, facing: &[f64]) -> f64 {
    let topology = surface.topology();
    let vertex = topology.vertex(smooth_vertex as usize) as u32;
    let towards = view.towards(surface.position(vertex));
    let mut sum = 0.0;
    let mut weight = 0.0;
    for half_edge in topology.around(vertex) {
        let triangle = half_edge / 3;
        let smooth = topology.smooth_corners()[triangle as usize];
        if smooth.contains(&smooth_vertex) {
            let area = surface.area_normal(triangle).length();
            let at_corners = smooth.map(|v| facing[v as usize]);
            sum += surface.gradient(triangle, at_corners).dot(towards) * area;
            weight += area;
        }
    }
    if weight > 0.0 { sum / weight } else { 0.0 }
}

fn is_set(bits: &[u64], number: u32) -> bool {
    bits[number as usize / 64] >> (number % 64) & 1 == 1
}

fn set(bits: &mut [u64], number: u32) {
    bits[number as usize / 64] |= 1 << (number % 64);
}
