//! Lines that are fixed on a mesh: creases and borders, chains of its edges.

use crate::{Beside, Kind, Line, LinePoint, Place, Segment, Surface};

/// Cosine of 40 degrees, the angle between two triangles' normals from which on their edge is a crease in many programs.
pub const CREASE_COSINE: f64 = 0.766_044_443_118_978;

/// Cosine of 60 degrees, by which a chain of edges turns less.
pub const TURN_COSINE: f64 = 0.5;

/// The sharp edges of a mesh ([`crate::Topology::with_creases`]), and those of three triangles or more. Each edge is in one line, once.
///
/// Edges are chained where they go on most nearly straight, and by an angle whose cosine is above `turn_cosine` ([`TURN_COSINE`]). What is NaN is no cosine: there are no chains.
#[must_use]
pub fn creases(surface: &Surface, turn_cosine: f64) -> Vec<Line> {
    let topology = surface.topology();
    let is_first = |half_edge: &u32| match topology.beside(*half_edge) {
        Beside::Twin(twin) => *half_edge < twin,
        _ => false,
    };
    let mut edges: Vec<u32> = topology.sharp().iter().copied().filter(is_first).collect();
    edges.extend(topology.non_manifold_edges().iter().map(|edge| edge[0]));
    edges.sort_unstable();
    chains(surface, &edges, Kind::Crease, turn_cosine)
}

/// The edges of one triangle alone, chained as those of [`creases`].
#[must_use]
pub fn borders(surface: &Surface, turn_cosine: f64) -> Vec<Line> {
    let topology = surface.topology();
    let edges: Vec<u32> = (0..topology.triangles().len() as u32 * 3)
        .filter(|&half_edge| topology.beside(half_edge) == Beside::Border)
        .collect();
    chains(surface, &edges, Kind::Border, turn_cosine)
}

/// One end of an edge: the edge's place in the list, and 0 for where its half-edge begins, 1 for where it ends.
type End = (usize, usize);

/// Chains edges, each given by a half-edge of it.
fn chains(surface: &Surface, edges: &[u32], kind: Kind, turn_cosine: f64) -> Vec<Line> {
    let next = joins(surface, edges, turn_cosine);
    let mut used = vec![false; edges.len()];
    let mut lines = Vec::new();
    for first in 0..edges.len() {
        if used[first] {
            continue;
        }
        used[first] = true;
        // Back to where the chain begins, then along it.
        let mut begin: End = (first, 0);
        while let Some((edge, end)) = next[begin.0][begin.1] {
            begin = (edge, 1 - end);
            if edge == first {
                break;
            }
        }
        let closed = next[begin.0][begin.1].is_some();
        if closed {
            begin = (first, 0);
        }
        lines.push(chain(surface, edges, &next, begin, closed, kind, &mut used));
    }
    lines
}

/// The chain from one end of an edge on.
fn chain(
    surface: &Surface,
    edges: &[u32],
    next: &[[Option<End>; 2]],
    begin: End,
    closed: bool,
    kind: Kind,
    used: &mut [bool],
) -> Line {
    let point = |(edge, end): End| {
        let place = Place::on_edge(edges[edge], end as f64);
        let vertex = surface.topology().ends(edges[edge])[end];
        LinePoint {
            position: surface.position(vertex),
            place,
        }
    };
    let mut points = vec![point(begin)];
    let mut segments = Vec::new();
    let mut at = begin;
    loop {
        used[at.0] = true;
        segments.push(Segment {
            triangle: edges[at.0] / 3,
            folded: false,
        });
        let far = (at.0, 1 - at.1);
        match next[far.0][far.1] {
            Some(end) if end.0 != begin.0 => {
                points.push(point(far));
                at = end;
            }
            _ => {
                if !closed {
                    points.push(point(far));
                }
                break;
            }
        }
    }
    Line {
        kind,
        closed,
        points,
        segments,
    }
}

/// Of each edge's two ends the end of another edge with which it goes on.
fn joins(surface: &Surface, edges: &[u32], turn_cosine: f64) -> Vec<[Option<End>; 2]> {
    let topology = surface.topology();
    // All ends, those at one vertex together.
    let mut ends: Vec<(u32, End)> = (0..edges.len())
        .flat_map(|edge| [0, 1].map(|end| (topology.ends(edges[edge])[end], (edge, end))))
        .collect();
    ends.sort_unstable();
    let leaving = |(edge, end): End| {
        let [from, to] = topology
            .ends(edges[edge])
            .map(|vertex| surface.position(vertex));
        let direction = (to - from).normalize_or_zero();
        if end == 0 { direction } else { -direction }
    };
    let mut next = vec![[None; 2]; edges.len()];
    for at_vertex in ends.chunk_by(|a, b| a.0 == b.0) {
        // Where many edges meet, as in the middle of a star, all pairs would take long.
        let ends: Vec<End> = at_vertex.iter().map(|&(_, end)| end).collect();
        let mut pairs = Vec::new();
        for (i, &a) in ends.iter().enumerate() {
            let partners = ends[i + 1..].iter().take(MOST_PARTNERS);
            pairs.extend(partners.map(|&b| (-leaving(a).dot(leaving(b)), a, b)));
        }
        pairs.retain(|(cosine, ..)| *cosine > turn_cosine);
        pairs.sort_by(|a, b| b.0.total_cmp(&a.0).then((a.1, a.2).cmp(&(b.1, b.2))));
        for (_, a, b) in pairs {
            let both_free = next[a.0][a.1].is_none() && next[b.0][b.1].is_none();
            if a.0 != b.0 && both_free {
                next[a.0][a.1] = Some(b);
                next[b.0][b.1] = Some(a);
            }
        }
    }
    next
}

/// With how many of the edges at a vertex each is compared: of more, no picture shows which goes on as which.
const MOST_PARTNERS: usize = 64;
