//! A mesh of a solid: naive surface nets (Gibson 1998, "Constrained Elastic Surface Nets"), one vertex
//! in each cell of a grid that the surface passes through.

use glam::{IVec3, Vec3};

/// Positions, and triangles that wind counter-clockwise seen from outside.
pub(crate) struct Net {
    pub positions: Vec<Vec3>,
    pub triangles: Vec<[u32; 3]>,
}

/// The planes of a grid on each axis, metres, ascending; narrower where the solid has more to show.
pub(crate) struct Grid {
    pub x: Vec<f32>,
    pub y: Vec<f32>,
    pub z: Vec<f32>,
}

/// Planes from `low` to `high` or just beyond; `spacing` is how far the next one is, by position.
pub(crate) fn planes(low: f32, high: f32, spacing: impl Fn(f32) -> f32) -> Vec<f32> {
    let mut planes = vec![low];
    let mut last = low;
    while last < high {
        last += spacing(last);
        planes.push(last);
    }
    planes
}

impl Grid {
    fn size(&self) -> IVec3 {
        IVec3::new(
            self.x.len() as i32,
            self.y.len() as i32,
            self.z.len() as i32,
        )
    }

    fn at(&self, i: IVec3) -> Vec3 {
        Vec3::new(
            self.x[i.x as usize],
            self.y[i.y as usize],
            self.z[i.z as usize],
        )
    }

    /// The corners from `low` up to but without `high`, x fastest.
    fn corners(low: IVec3, high: IVec3) -> impl Iterator<Item = IVec3> {
        (low.z..high.z).flat_map(move |z| {
            (low.y..high.y).flat_map(move |y| (low.x..high.x).map(move |x| IVec3::new(x, y, z)))
        })
    }

    fn index(&self, i: IVec3) -> usize {
        let size = self.size();
        ((i.z * size.y + i.y) * size.x + i.x) as usize
    }

    /// The distance at each corner; far from the surface only its sign is right.
    fn values(&self, distance: &impl Fn(Vec3) -> f32) -> Vec<f32> {
        let size = self.size();
        let mut values = vec![0.0; (size.x * size.y * size.z) as usize];
        for block in Self::corners(IVec3::ZERO, (size + BLOCK - 1) / BLOCK) {
            let (low, high) = (block * BLOCK, (block * BLOCK + BLOCK).min(size));
            let (a, b) = (self.at(low), self.at(high - 1));
            let middle = distance((a + b) / 2.0);
            // Twice the block's radius: these distances are not exact.
            let is_near = middle.abs() < (b - a).length();
            for i in Self::corners(low, high) {
                let value = if is_near {
                    distance(self.at(i))
                } else {
                    middle
                };
                values[self.index(i)] = value;
            }
        }
        values
    }
}

/// Corners along a side of the blocks that are tried as a whole.
const BLOCK: i32 = 4;

/// Where a cell has no vertex.
const NONE: u32 = u32::MAX;

/// The surface of `distance` in a grid. Where the solid does not end within the grid the net is open.
pub(crate) fn surface_net(distance: impl Fn(Vec3) -> f32, grid: &Grid) -> Net {
    let size = grid.size();
    let values = grid.values(&distance);
    let is_inside = |i: IVec3| values[grid.index(i)] < 0.0;

    // A vertex for each cell, at the mean of where its edges cross the surface.
    let mut positions = Vec::new();
    let mut vertex_of = vec![NONE; values.len()];
    for cell in Grid::corners(IVec3::ZERO, size - 1) {
        let first = is_inside(cell);
        if Grid::corners(cell, cell + 2).all(|i| is_inside(i) == first) {
            continue;
        }
        let mut sum = Vec3::ZERO;
        let mut crossings = 0;
        for (a, b) in CELL_EDGES {
            let (a, b) = (cell + IVec3::from(a), cell + IVec3::from(b));
            if is_inside(a) != is_inside(b) {
                let (at_a, at_b) = (values[grid.index(a)], values[grid.index(b)]);
                sum += grid.at(a).lerp(grid.at(b), at_a / (at_a - at_b));
                crossings += 1;
            }
        }
        vertex_of[grid.index(cell)] = positions.len() as u32;
        positions.push(sum / crossings as f32);
    }

    // Two triangles around each edge of the grid that crosses the surface.
    let mut triangles = Vec::new();
    for corner in Grid::corners(IVec3::ZERO, size) {
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
            if (corner - u - v).cmplt(IVec3::ZERO).any() {
                continue;
            }
            let [a, b, c, d] =
                [corner - u - v, corner - v, corner, corner - u].map(|i| vertex_of[grid.index(i)]);
            if [a, b, c, d].contains(&NONE) {
                continue;
            }
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

/// Evens the triangles out, staying on the surface: even triangles shade evenly. Vertices at x = 0
/// stay there.
pub(crate) fn relax(net: &mut Net, distance: impl Fn(Vec3) -> f32, rounds: usize) {
    let mut neighbours = vec![Vec::new(); net.positions.len()];
    for [a, b, c] in &net.triangles {
        for (from, to) in [(a, b), (b, c), (c, a)] {
            neighbours[*from as usize].push(*to);
        }
    }
    for round in 1..=rounds {
        let steps = if round == rounds { 3 } else { 1 };
        let moved = net.positions.iter().zip(&neighbours);
        let moved = moved.map(|(position, around)| {
            let sum: Vec3 = around.iter().map(|&i| net.positions[i as usize]).sum();
            let mean = sum / around.len().max(1) as f32;
            let free = if position.x == 0.0 {
                Vec3::new(0.0, 1.0, 1.0)
            } else {
                Vec3::ONE
            };
            onto_surface(&distance, position.lerp(mean, 0.5) * free, free, steps)
        });
        net.positions = moved.collect();
    }
}

/// The surface near `p`: steps along the gradient, where `free` is 1.
fn onto_surface(distance: impl Fn(Vec3) -> f32, mut p: Vec3, free: Vec3, steps: usize) -> Vec3 {
    for _ in 0..steps {
        // One-sided differences do: a step short of the surface is made up for by the next.
        let (step, here) = (1e-4, distance(p));
        let along = |axis: Vec3| (distance(p + axis * step) - here) / step;
        let slope = Vec3::new(along(Vec3::X), along(Vec3::Y), along(Vec3::Z)) * free;
        p -= slope * (here / slope.length_squared().max(1e-6));
    }
    p
}

/// A net of the half of a solid where x is 0 or above, with its image. They share vertices at x = 0.
pub(crate) fn with_image(mut net: Net) -> Net {
    let mut image = Vec::with_capacity(net.positions.len());
    for i in 0..net.positions.len() {
        let position = net.positions[i];
        if position.x == 0.0 {
            image.push(i as u32);
        } else {
            image.push(net.positions.len() as u32);
            net.positions.push(position.with_x(-position.x));
        }
    }
    for i in 0..net.triangles.len() {
        let [a, b, c] = net.triangles[i].map(|corner| image[corner as usize]);
        net.triangles.push([a, c, b]);
    }
    net
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
    use std::collections::HashMap;

    fn sphere(p: Vec3) -> f32 {
        p.length() - 1.0
    }

    fn assert_is_the_unit_sphere(net: &Net) {
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
            let other = edges.get(&(*b, *a));
            assert_eq!((*count, other), (1, Some(&1)), "each edge has two sides");
        }
        let exact = 4.0 / 3.0 * std::f32::consts::PI;
        assert!((volume / exact - 1.0).abs() < 0.02, "{volume}");
        for p in &net.positions {
            assert!((p.length() - 1.0).abs() < 1e-4, "{p}");
        }
    }

    #[test]
    fn a_sphere_is_closed_round_and_the_right_way_out() {
        let grid = Grid {
            x: planes(-1.3, 1.3, |_| 0.11),
            y: planes(-1.3, 1.3, |y| if y > 0.2 { 0.06 } else { 0.12 }),
            z: planes(-1.3, 1.3, |_| 0.11),
        };
        let mut net = surface_net(sphere, &grid);
        relax(&mut net, sphere, 4);
        assert_is_the_unit_sphere(&net);
    }

    #[test]
    fn half_a_sphere_and_its_image_are_a_sphere() {
        let grid = Grid {
            x: planes(-0.05, 1.3, |_| 0.1),
            y: planes(-1.3, 1.3, |_| 0.11),
            z: planes(-1.3, 1.3, |_| 0.11),
        };
        let mut half = surface_net(sphere, &grid);
        relax(&mut half, sphere, 4);
        let seam = half.positions.iter().filter(|p| p.x == 0.0).count();
        assert!(seam > 20, "{seam} vertices at x = 0");
        let half_count = half.positions.len();
        let whole = with_image(half);
        assert_eq!(whole.positions.len(), 2 * half_count - seam);
        assert_is_the_unit_sphere(&whole);
    }
}
