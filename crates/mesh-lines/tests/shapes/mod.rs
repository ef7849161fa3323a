//! Surfaces known exactly, as triangles.
#![allow(dead_code, reason = "each test uses some of them")]

use glam::{DVec3, Vec3};
use mesh_lines::{
    Bvh, CREASE_COSINE, Line, Surface, TURN_COSINE, Topology, View, borders, contours, creases,
    facing,
};
use std::f64::consts::TAU;

/// A mesh with everything that its lines need.
pub struct Shape {
    pub topology: Topology,
    pub positions: Vec<Vec3>,
    /// Those of the exact surface.
    pub normals: Option<Vec<Vec3>>,
}

impl Shape {
    pub fn new(positions: Vec<Vec3>, triangles: &[[u32; 3]]) -> Self {
        Self {
            topology: Topology::new(&positions, triangles).unwrap(),
            positions,
            normals: None,
        }
    }

    pub fn surface(&self) -> Surface<'_> {
        match &self.normals {
            Some(normals) => Surface::with_normals(&self.topology, &self.positions, normals),
            None => Surface::new(&self.topology, &self.positions),
        }
        .unwrap()
    }

    /// With sharp edges where a cube has them.
    pub fn sharp(mut self) -> Self {
        self.topology = self
            .topology
            .with_creases(&self.positions, CREASE_COSINE)
            .unwrap();
        self.normals = None;
        self
    }

    /// Everything moved and turned by a function, without normals of its own.
    pub fn moved(mut self, motion: impl Fn(Vec3) -> Vec3) -> Self {
        self.positions.iter_mut().for_each(|p| *p = motion(*p));
        Self::new(self.positions, self.topology.triangles())
    }

    /// Both in one mesh.
    pub fn and(self, other: Self) -> Self {
        let shift = self.positions.len() as u32;
        let mut triangles = self.topology.triangles().to_vec();
        triangles.extend(
            other
                .topology
                .triangles()
                .iter()
                .map(|t| t.map(|v| v + shift)),
        );
        let mut positions = self.positions;
        positions.extend(other.positions);
        let normals = self.normals.zip(other.normals).map(|(mut a, b)| {
            a.extend(b);
            a
        });
        Self {
            normals,
            ..Self::new(positions, &triangles)
        }
    }

    /// All lines that an eye could see.
    pub fn lines(&self, view: &View) -> Vec<Line> {
        let surface = self.surface();
        let mut lines = contours(&surface, view, &facing(&surface, view)).unwrap();
        lines.extend(creases(&surface, TURN_COSINE));
        lines.extend(borders(&surface, TURN_COSINE));
        lines
    }

    pub fn bvh(&self) -> Bvh {
        Bvh::new(&self.surface())
    }
}

/// A grid that closes in the first direction if `around`, and in the second if `across`. `at(u, v)` gives the place at shares of both.
pub fn grid(
    [columns, rows]: [u32; 2],
    [around, across]: [bool; 2],
    at: impl Fn(f64, f64) -> DVec3,
) -> Shape {
    let wide = if around { columns } else { columns + 1 };
    let high = if across { rows } else { rows + 1 };
    let mut positions = Vec::new();
    for j in 0..high {
        for i in 0..wide {
            positions.push(
                at(
                    f64::from(i) / f64::from(columns),
                    f64::from(j) / f64::from(rows),
                )
                .as_vec3(),
            );
        }
    }
    let mut triangles = Vec::new();
    for j in 0..rows {
        for i in 0..columns {
            let vertex = |i: u32, j: u32| j % high * wide + i % wide;
            let [a, b, c, d] = [
                vertex(i, j),
                vertex(i + 1, j),
                vertex(i + 1, j + 1),
                vertex(i, j + 1),
            ];
            // Diagonals in both directions, so that no direction is preferred.
            if (i + j) % 2 == 0 {
                triangles.extend([[a, b, c], [a, c, d]]);
            } else {
                triangles.extend([[a, b, d], [b, c, d]]);
            }
        }
    }
    Shape::new(positions, &triangles)
}

/// A sphere of `count`^2 * 12 triangles: a cube's faces blown up.
pub fn sphere(count: u32, center: DVec3, radius: f64) -> Shape {
    ellipsoid(count, center, DVec3::splat(radius))
}

/// An ellipsoid with these half axes along x, y and z.
pub fn ellipsoid(count: u32, center: DVec3, axes: DVec3) -> Shape {
    let mut numbers = std::collections::HashMap::new();
    let mut positions = Vec::new();
    let mut normals = Vec::new();
    let mut triangles = Vec::new();
    let n = count as i32;
    for axis in 0..3 {
        for side in [-n, n] {
            let mut vertex = |i: i32, j: i32| {
                let mut corner = [0; 3];
                corner[axis] = side;
                corner[(axis + 1) % 3] = 2 * i - n;
                corner[(axis + 2) % 3] = 2 * j - n;
                *numbers.entry(corner).or_insert_with(|| {
                    // Even angles in place of even lengths.
                    let tan = |c: i32| (f64::from(c) / f64::from(n) * TAU / 8.0).tan();
                    let unit = DVec3::from(corner.map(tan)).normalize();
                    positions.push((center + unit * axes).as_vec3());
                    normals.push((unit / axes).normalize().as_vec3());
                    positions.len() as u32 - 1
                })
            };
            for i in 0..n {
                for j in 0..n {
                    let [a, b, c, d] = [
                        vertex(i, j),
                        vertex(i + 1, j),
                        vertex(i + 1, j + 1),
                        vertex(i, j + 1),
                    ];
                    if side > 0 {
                        triangles.extend([[a, b, c], [a, c, d]]);
                    } else {
                        triangles.extend([[a, c, b], [a, d, c]]);
                    }
                }
            }
        }
    }
    Shape {
        normals: Some(normals),
        ..Shape::new(positions, &triangles)
    }
}

/// A torus around the z axis.
pub fn torus([columns, rows]: [u32; 2], large: f64, small: f64) -> Shape {
    let normal = |u: f64, v: f64| {
        let [u, v] = [u * TAU, v * TAU];
        DVec3::new(u.cos() * v.cos(), u.sin() * v.cos(), v.sin())
    };
    let mut shape = grid([columns, rows], [true, true], |u, v| {
        DVec3::new((u * TAU).cos(), (u * TAU).sin(), 0.0) * large + normal(u, v) * small
    });
    let normals = (0..rows).flat_map(|j| {
        (0..columns).map(move |i| {
            normal(
                f64::from(i) / f64::from(columns),
                f64::from(j) / f64::from(rows),
            )
            .as_vec3()
        })
    });
    shape.normals = Some(normals.collect());
    shape
}

/// A cup without a lid, of one sheet: its rim is a border.
pub fn cup(columns: u32, rows: u32) -> Shape {
    grid([columns, rows], [true, false], |u, v| {
        let radius = 0.02 + 0.75 * v.sqrt() - 0.2 * v * v;
        let (sin, cos) = (-u * TAU).sin_cos();
        DVec3::new(radius * cos, 1.4 * v - 0.7, radius * sin)
    })
}

/// A ball with dents and horns, which has cusps and hides much of itself.
pub fn bumpy(count: u32) -> Shape {
    let shape = sphere(count, DVec3::ZERO, 1.0);
    shape.moved(|p| {
        let [x, y, z] = p.to_array();
        p * (1.0
            + 0.22 * (4.0 * x + 1.0).sin() * (3.5 * y).cos()
            + 0.15 * (5.0 * z - 2.0 * x).sin())
    })
}

/// An axis-aligned box, of 12 triangles.
pub fn cube(low: Vec3, high: Vec3) -> Shape {
    let positions = (0..8).map(|i| {
        let pick = |axis: usize| {
            if i >> axis & 1 == 1 {
                high[axis]
            } else {
                low[axis]
            }
        };
        Vec3::new(pick(0), pick(1), pick(2))
    });
    let faces = [
        [0, 4, 6, 2],
        [1, 3, 7, 5],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 2, 3, 1],
        [4, 5, 7, 6],
    ];
    let triangles: Vec<[u32; 3]> = faces
        .iter()
        .flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]])
        .collect();
    Shape::new(positions.collect(), &triangles)
}

/// Eyes spread over all directions (a golden spiral), at distances from `near` to `far`.
pub fn eyes(count: usize, near: f64, far: f64) -> impl Iterator<Item = DVec3> {
    let golden = (5.0_f64.sqrt() - 1.0) / 2.0;
    (0..count).map(move |i| {
        let height = 1.0 - (2 * i + 1) as f64 / count as f64;
        let (sin, cos) = (i as f64 * golden * TAU).sin_cos();
        let across = (1.0 - height * height).sqrt();
        let distance = near + (far - near) * (i as f64 * 0.754_877_666).fract();
        DVec3::new(across * cos, across * sin, height) * distance
    })
}
