//! Where lines meet on the surface.

use crate::{Kind, Line, LinePoint, Surface};
use std::collections::HashMap;

/// Of each crease and border the places along it ([`Line::position`]) where a contour ends on it, or where another such line
/// has a vertex in common with it, in no order. There it may go around the horizon.
pub(crate) fn junctions(surface: &Surface, lines: &[Line]) -> Vec<Vec<f64>> {
    let mut of_edge = HashMap::new();
    let mut at_vertex: HashMap<u32, Vec<(usize, f64)>> = HashMap::new();
    for (number, line) in lines
        .iter()
        .enumerate()
        .filter(|(_, line)| line.kind != Kind::Contour)
    {
        let vertices: Vec<u32> = line
            .points
            .iter()
            .map(|p| p.place.vertex(surface))
            .collect();
        for (i, &vertex) in vertices.iter().enumerate() {
            at_vertex
                .entry(vertex)
                .or_default()
                .push((number, i as f64));
        }
        for segment in 0..line.segments.len() {
            let [from, to] = [segment, (segment + 1) % vertices.len()].map(|i| vertices[i]);
            of_edge.insert([from.min(to), from.max(to)], (number, segment, to));
        }
    }
    let mut junctions = vec![Vec::new(); lines.len()];
    for meeting in at_vertex.values().filter(|meeting| meeting.len() > 1) {
        for &(line, along) in meeting {
            junctions[line].push(along);
        }
    }
    for contour in lines
        .iter()
        .filter(|line| line.kind == Kind::Contour && !line.closed)
    {
        for end in [contour.points.first(), contour.points.last()]
            .into_iter()
            .flatten()
        {
            match *corners(surface, end).as_slice() {
                [(a, _), (b, _)] => {
                    if let Some(&(line, segment, to)) = of_edge.get(&[a.min(b), a.max(b)]) {
                        let share = corners(surface, end)
                            .into_iter()
                            .find(|corner| corner.0 == to);
                        junctions[line].push(segment as f64 + share.map_or(0.0, |corner| corner.1));
                    }
                }
                [(vertex, _)] => {
                    for &(line, along) in at_vertex.get(&vertex).into_iter().flatten() {
                        junctions[line].push(along);
                    }
                }
                _ => {}
            }
        }
    }
    junctions
}

/// The vertices of the edge on which a point lies, with their weights; one if it is on a vertex.
fn corners(surface: &Surface, point: &LinePoint) -> Vec<(u32, f64)> {
    let vertices = surface.topology().triangles()[point.place.triangle as usize];
    (0..3)
        .map(|corner| (vertices[corner], point.place.weights[corner]))
        .filter(|(_, weight)| *weight != 0.0)
        .collect()
}
