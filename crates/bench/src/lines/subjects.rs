//! Meshes whose lines are looked for, and eyes around them.

use glam::{DVec3, Vec3};
use mesh_lines::{
    CREASE_COSINE, Line, MeshError, Surface, TURN_COSINE, Topology, View, borders, contours,
    creases, facing,
};
use stage::{ThingChoice, thing_mesh};

/// A mesh.
pub struct Subject {
    /// Its name in tables.
    pub name: String,
    /// Its edges; sharp ones are creases where it has such.
    pub topology: Topology,
    /// Its corners at rest.
    pub positions: Vec<Vec3>,
    /// Whether creases are drawn.
    pub has_creases: bool,
    /// The middle of the box around it, and half its diagonal.
    pub middle: DVec3,
    /// See `middle`.
    pub radius: f64,
}

impl Subject {
    /// # Errors
    ///
    /// When the mesh isn't one.
    pub fn new(
        name: &str,
        (positions, triangles): (Vec<Vec3>, Vec<[u32; 3]>),
        has_creases: bool,
    ) -> Result<Self, MeshError> {
        let mut topology = Topology::new(&positions, &triangles)?;
        if has_creases {
            topology = topology.with_creases(&positions, CREASE_COSINE)?;
        }
        let low = positions.iter().copied().fold(Vec3::INFINITY, Vec3::min);
        let high = positions
            .iter()
            .copied()
            .fold(Vec3::NEG_INFINITY, Vec3::max);
        Ok(Self {
            name: name.to_owned(),
            topology,
            positions,
            has_creases,
            middle: (0.5 * (low + high)).as_dvec3(),
            radius: 0.5 * f64::from(low.distance(high)),
        })
    }

    /// The bust that comes with inkstrand.
    ///
    /// # Errors
    ///
    /// When the mesh isn't one.
    pub fn bust() -> Result<Self, MeshError> {
        let bust = groom::bust();
        Self::new("bust", (bust.positions, bust.triangles), false)
    }

    /// A thing of a preset, with creases.
    ///
    /// # Errors
    ///
    /// When the mesh isn't one.
    pub fn thing(shape: ThingChoice) -> Result<Self, MeshError> {
        Self::new(shape.name(), thing_mesh(shape, 0.1), true)
    }

    /// The surface where its corners are there.
    ///
    /// # Errors
    ///
    /// When a place isn't finite.
    pub fn surface<'a>(&'a self, positions: &'a [Vec3]) -> Result<Surface<'a>, MeshError> {
        Surface::new(&self.topology, positions)
    }

    /// All lines that are drawn of it, hidden or not, and how far it faces the eye.
    ///
    /// # Errors
    ///
    /// As `mesh_lines::contours`.
    pub fn lines(
        &self,
        surface: &Surface,
        view: &View,
    ) -> Result<(Vec<Line>, Vec<f64>), MeshError> {
        let facing = facing(surface, view);
        let mut lines = contours(surface, view, &facing)?;
        if self.has_creases {
            lines.extend(creases(surface, TURN_COSINE));
        }
        lines.extend(borders(surface, TURN_COSINE));
        Ok((lines, facing))
    }

    /// Eyes all around it, that see all of it within 30 degrees.
    pub fn eyes(&self, count: usize) -> impl Iterator<Item = DVec3> {
        let golden = std::f64::consts::PI * (3.0 - 5.0_f64.sqrt());
        (0..count).map(move |i| {
            // Off the poles, whose axes things have for their own.
            let y = 0.98 * (1.0 - (2.0 * i as f64 + 1.0) / count as f64);
            let (sin, cos) = (golden * i as f64 + 0.3).sin_cos();
            let across = (1.0 - y * y).sqrt();
            self.middle + 4.2 * self.radius * DVec3::new(across * sin, y, across * cos)
        })
    }
}

/// Two rings that go through each other.
pub fn linked() -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let (mut positions, mut triangles) = torus([96, 48], 0.8, 0.25);
    let (others, faces) = torus([96, 48], 0.8, 0.25);
    let first = positions.len() as u32;
    positions.extend(others.iter().map(|p| Vec3::new(p.x + 0.8, p.z, -p.y)));
    triangles.extend(faces.iter().map(|face| face.map(|i| first + i)));
    (positions, triangles)
}

fn torus([around, across]: [u32; 2], large: f32, small: f32) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let place = |i: u32, j: u32| {
        let turn = |i: u32, of: u32| (i as f32 / of as f32 * std::f32::consts::TAU).sin_cos();
        let ((sin, cos), (up, out)) = (turn(i, around), turn(j, across));
        Vec3::new(
            (large + small * out) * cos,
            (large + small * out) * sin,
            small * up,
        )
    };
    let all = || (0..around).flat_map(move |i| (0..across).map(move |j| (i, j)));
    let vertex = |i: u32, j: u32| i % around * across + j % across;
    let faces = all().flat_map(|(i, j)| {
        let [a, b, c, d] = [
            vertex(i, j),
            vertex(i + 1, j),
            vertex(i + 1, j + 1),
            vertex(i, j + 1),
        ];
        [[a, b, c], [a, c, d]]
    });
    (all().map(|(i, j)| place(i, j)).collect(), faces.collect())
}

/// A ball with dents of about so many triangles.
pub fn dented(triangles: u32) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let rows = (f64::from(triangles) / 4.0).sqrt().round() as u32;
    let columns = 2 * rows;
    let place = |i: u32, j: u32| {
        let (sin, cos) = (i as f32 / columns as f32 * std::f32::consts::TAU).sin_cos();
        let (across, up) = (j as f32 / rows as f32 * std::f32::consts::PI).sin_cos();
        let unit = Vec3::new(across * cos, up, -across * sin);
        let dents = (5.0 * unit.x).sin() * (4.0 * unit.y + 1.0).sin() * (4.5 * unit.z).cos();
        unit * (1.0 + 0.2 * dents)
    };
    let mut positions = vec![place(0, 0), place(0, rows)];
    let inner = (1..rows).flat_map(|j| (0..columns).map(move |i| (i, j)));
    positions.extend(inner.map(|(i, j)| place(i, j)));
    let vertex = |i: u32, j: u32| match j {
        0 => 0,
        _ if j == rows => 1,
        _ => 2 + (j - 1) * columns + i % columns,
    };
    let cells = (0..rows).flat_map(|j| (0..columns).map(move |i| (i, j)));
    let faces = cells.flat_map(|(i, j)| {
        let [a, b] = [vertex(i, j), vertex(i, j + 1)];
        let [c, d] = [vertex(i + 1, j + 1), vertex(i + 1, j)];
        [[a, b, c], [a, c, d]]
    });
    let is_whole = |[a, b, c]: &[u32; 3]| a != b && b != c && c != a;
    (positions, faces.filter(is_whole).collect())
}
