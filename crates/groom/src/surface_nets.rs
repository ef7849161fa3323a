//! A mesh of a solid: naive surface nets (Gibson 1998, "Constrained Elastic Surface Nets"), one vertex
//! in each cell of a grid that the surface passes through.

use crate::solid::gradient;
use glam::{IVec3, Vec3};
use std::collections::HashMap;

/// Positions, and triangles that wind counter-clockwise seen from outside.
pub(crate) struct Net {
    pub positions: Vec<Vec3>,
    pub triangles: Vec<[u32; 3]>,
}

/// The surface of `distance` between two corners, in cells of `cell` metres. The solid must end
/// within the corners.
pub(crate) fn surface_net(distance: impl Fn(Vec3) -> f32, low: Vec3, high: Vec3, cell: f32) -> Net {
    let size = ((high - low) / cell).ceil().as_ivec3() + 1;
    let at = |i: IVec3| low + i.as_vec3() * cell;
    let index = |i: IVec3| ((i.z * size.y + i.y) * size.x + i.x) as usize;
    let corners = || {
        (0..size.z).flat_map(move |z| {
            (0..size.y).flat_map(move |y| (0..size.x).map(move |x| IVec3::new(x, y, z)))
        })
    };
    let values: Vec<f32> = corners().map(|i| distance(at(i))).collect();
    let is_inside = |i: IVec3| values[index(i)] < 0.0;

    // A vertex for each cell, at the mean of where its edges cross the surface.
    let mut positions = Vec::new();
    let mut vertex_of = HashMap::new();
    for cell_corner in corners().filter(|i| i.cmplt(size - 1).all()) {
        let mut sum = Vec3::ZERO;
        let mut crossings = 0;
        for (a, b) in CELL_EDGES {
            let (a, b) = (cell_corner + IVec3::from(a), cell_corner + IVec3::from(b));
            if is_inside(a) != is_inside(b) {
                let (at_a, at_b) = (values[index(a)], values[index(b)]);
                sum += at(a).lerp(at(b), at_a / (at_a - at_b));
                crossings += 1;
            }
        }
        if crossings > 0 {
            vertex_of.insert(cell_corner, positions.len() as u32);
            positions.push(sum / crossings as f32);
        }
    }

    // Two triangles around each edge of the grid that crosses the surface.
    let mut triangles = Vec::new();
    for corner in corners().filter(|i| i.cmpgt(IVec3::ZERO).all()) {
        for axis in [IVec3::X, IVec3::Y, IVec3::Z] {
            let end = corner + axis;
            if end.cmpge(size).any() || is_inside(corner) == is_inside(end) {
                continue;
            }
            // The two other axes, so that (axis, u, v) is right-handed.
            let (u, v) = (
                IVec3::new(axis.z, axis.x, axis.y),
                IVec3::new(axis.y, axis.z, axis.x),
            );
            let around =
                [corner - u - v, corner - v, corner, corner - u].map(|i| vertex_of.get(&i));
            let [Some(&a), Some(&b), Some(&c), Some(&d)] = around else {
                continue;
            };
            let quad = if is_inside(corner) {
                [a, b, c, d]
            } else {
                [a, d, c, b]
            };
            triangles.push([quad[0], quad[1], quad[2]]);
            triangles.push([quad[0], quad[2], quad[3]]);
        }
    }
    Net {
        positions,
        triangles,
    }
}

/// Evens the triangles out, staying on the surface: even triangles shade evenly.
pub(crate) fn relax(net: &mut Net, distance: impl Fn(Vec3) -> f32, rounds: usize) {
    let mut neighbours = vec![Vec::new(); net.positions.len()];
    for [a, b, c] in &net.triangles {
        for (from, to) in [(a, b), (b, c), (c, a)] {
            neighbours[*from as usize].push(*to);
        }
    }
    for _ in 0..rounds {
        let moved: Vec<Vec3> = net
            .positions
            .iter()
            .zip(&neighbours)
            .map(|(position, around)| {
                let sum: Vec3 = around.iter().map(|&i| net.positions[i as usize]).sum();
                let mean = if around.is_empty() {
                    *position
                } else {
                    sum / around.len() as f32
                };
                onto_surface(&distance, position.lerp(mean, 0.5))
            })
            .collect();
        net.positions = moved;
    }
}

/// The surface near `p`: two steps along the gradient.
fn onto_surface(distance: impl Fn(Vec3) -> f32, mut p: Vec3) -> Vec3 {
    for _ in 0..2 {
        let slope = gradient(&distance, p);
        p -= slope * (distance(p) / slope.length_squared().max(1e-6));
    }
    p
}

const CELL_EDGES: [([i32; 3], [i32; 3]); 12] = [
    ([0, 0, 0], [1, 0, 0]),
    ([0, 1, 0], [1, 1, 0]),
    ([0, 0, 1], [1, 0, 1]),
    ([0, 1, 1], [1, 1, 1]),
    ([0, 0, 0], [0, 1, 0]),
    ([1, 0, 0], [1, 1, 0]),
    ([0, 0, 1], [0, 1, 1]),
    ([1, 0, 1], [1, 1, 1]),
    ([0, 0, 0], [0, 0, 1]),
    ([1, 0, 0], [1, 0, 1]),
    ([0, 1, 0], [0, 1, 1]),
    ([1, 1, 0], [1, 1, 1]),
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sphere_is_closed_round_and_the_right_way_out() {
        let sphere = |p: Vec3| p.length() - 1.0;
        let mut net = surface_net(sphere, Vec3::splat(-1.3), Vec3::splat(1.3), 0.11);
        relax(&mut net, sphere, 4);
        let mut edges = HashMap::new();
        let mut volume = 0.0;
        for [a, b, c] in &net.triangles {
            for edge in [(a, b), (b, c), (c, a)] {
                *edges.entry(edge).or_insert(0) += 1;
            }
            let [a, b, c] = [a, b, c].map(|&i| net.positions[i as usize]);
            volume += a.dot(b.cross(c)) / 6.0;
        }
        for ((a, b), count) in &edges {
            assert_eq!(
                (*count, edges.get(&(*b, *a))),
                (1, Some(&1)),
                "each edge has two sides"
            );
        }
        let exact = 4.0 / 3.0 * std::f32::consts::PI;
        assert!((volume / exact - 1.0).abs() < 0.02, "{volume}");
        assert!(
            net.positions
                .iter()
                .all(|p| (p.length() - 1.0).abs() < 1e-4)
        );
    }
}
