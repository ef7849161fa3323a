//! The pieces of a body's mesh that overlap or lie in each other, told apart.

use glam::Vec3;
use mesh_io::Welded;
use mesh_lines::{Beside, Topology};
use std::collections::HashSet;

/// Into how many meshes one is parted at most, as each takes as long as all of them together would: what is left goes into the last.
const MOST_PARTS: usize = 16;
/// Of more pieces than this each would be held against too many others: they stay one part, as do those of a mail's rings.
const MOST_PIECES: usize = 1000;

type Triangle = [u32; 3];

/// The triangles of a mesh in parts, the pieces of each of which have room between them: what is within any part is within the mesh. A ray
/// through all of them at once goes in and out of what overlaps as if there were a hollow.
///
/// What is not closed by itself, as it has a hole or edges of more than two triangles, is one part.
pub(super) fn parted(mesh: &Welded) -> Vec<Vec<Triangle>> {
    let (mut closed, mut rest) = closed_pieces(mesh);
    if closed.len() > MOST_PIECES {
        (closed, rest) = (Vec::new(), mesh.triangles.clone());
    }
    let mut parts: Vec<(Vec<Triangle>, Vec<[Vec3; 2]>)> = Vec::new();
    for piece in closed {
        let bounds = bounds(&mesh.positions, &piece);
        let has_room = |boxes: &[[Vec3; 2]]| !boxes.iter().any(|other| meet(*other, bounds));
        let mut place = parts.iter().position(|(_, boxes)| has_room(boxes));
        if place.is_none() && parts.len() == MOST_PARTS {
            place = Some(MOST_PARTS - 1);
        }
        match place {
            Some(place) => {
                parts[place].0.extend(piece);
                parts[place].1.push(bounds);
            }
            None => parts.push((piece, vec![bounds])),
        }
    }
    let mut parts: Vec<Vec<Triangle>> = parts.into_iter().map(|(part, _)| part).collect();
    if !rest.is_empty() {
        parts.push(single_sided(&rest).unwrap_or(rest));
    }
    parts
}

/// The pieces that are closed, and all triangles that are in none.
fn closed_pieces(mesh: &Welded) -> (Vec<Vec<Triangle>>, Vec<Triangle>) {
    let triangles = &mesh.triangles;
    let Ok(topology) = Topology::new(&mesh.positions, triangles) else {
        return (Vec::new(), triangles.clone());
    };
    let is_of_piece = |t: u32| topology.is_kept(t) && topology.is_closed(t);
    let mut pieces = Vec::new();
    let mut reached = vec![false; triangles.len()];
    for first in (0..triangles.len() as u32).filter(|t| is_of_piece(*t)) {
        if std::mem::replace(&mut reached[first as usize], true) {
            continue;
        }
        let mut piece = vec![first];
        let mut next = 0;
        while let Some(&triangle) = piece.get(next) {
            next += 1;
            for edge in 3 * triangle..3 * triangle + 3 {
                if let Beside::Twin(twin) = topology.beside(edge)
                    && !std::mem::replace(&mut reached[twin as usize / 3], true)
                {
                    piece.push(twin / 3);
                }
            }
        }
        // In the mesh's order, in which distances of what is as near from two triangles are found.
        piece.sort_unstable();
        pieces.push(piece.iter().map(|t| triangles[*t as usize]).collect());
    }
    // Without the other sides of pieces that are there twice.
    let of_pieces: HashSet<Triangle> = pieces.iter().flatten().map(sorted).collect();
    let is_left = |t: &&Triangle| !of_pieces.contains(&sorted(t));
    let rest = triangles.iter().filter(is_left).copied().collect();
    (pieces, rest)
}

/// Where each triangle is there twice, as programs write what is to be seen from both sides: each of them once. What goes through such a surface
/// would come out of it at once.
fn single_sided(triangles: &[Triangle]) -> Option<Vec<Triangle>> {
    let mut known = HashSet::new();
    let is_new = |t: &&Triangle| known.insert(sorted(t));
    let once: Vec<Triangle> = triangles.iter().filter(is_new).copied().collect();
    (2 * once.len() == triangles.len()).then_some(once)
}

fn sorted(triangle: &Triangle) -> Triangle {
    let mut corners = *triangle;
    corners.sort_unstable();
    corners
}

/// The corners of the box around triangles.
fn bounds(positions: &[Vec3], triangles: &[Triangle]) -> [Vec3; 2] {
    let places = || triangles.iter().flatten().map(|i| positions[*i as usize]);
    [
        places().fold(Vec3::INFINITY, Vec3::min),
        places().fold(Vec3::NEG_INFINITY, Vec3::max),
    ]
}

/// Whether two boxes have a place in common.
fn meet([low, high]: [Vec3; 2], [other_low, other_high]: [Vec3; 2]) -> bool {
    low.cmple(other_high).all() && other_low.cmple(high).all()
}
