//! Draws a knot through boxes as SVG: what is seen of their lines, and thinly what is hidden. Each stroke has its colour by its name, and gets thicker along T.
//!
//! `cargo run -p mesh-lines --example drawing -- drawing.svg [degrees around]`

use glam::Vec3;
use mesh_lines::{
    Bvh, CREASE_COSINE, Frame, Line, Surface, TURN_COSINE, Topology, Tracker, View, borders,
    contours, creases, facing, visible,
};
use std::{error::Error, f32::consts::TAU, fmt::Write as _};

const SIZE_PX: f32 = 720.0;
/// Of an eye with a field of view of 30 degrees.
const FOCAL_PX: f32 = 1344.0;
const DISTANCE: f32 = 7.0;

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let file = arguments.next().ok_or("which file is to be written?")?;
    let degrees: f32 = arguments.next().map_or(Ok(25.0), |number| number.parse())?;

    let (mut positions, mut triangles) = knot(240, 24);
    for (low, high) in [(-1.9, -0.5), (0.3, 1.0)] {
        add_box(
            &mut positions,
            &mut triangles,
            Vec3::new(low, -1.2, -0.4),
            Vec3::new(high, 0.9, 0.5),
        );
    }
    let topology =
        Topology::new(&positions, &triangles)?.with_creases(&positions, CREASE_COSINE)?;
    let surface = Surface::new(&topology, &positions)?;

    let (sin, cos) = degrees.to_radians().sin_cos();
    let eye = Vec3::new(sin, 0.35, cos).normalize() * DISTANCE;
    let view = View::perspective(eye)?;
    let facing = facing(&surface, &view);
    let mut lines = contours(&surface, &view, &facing)?;
    lines.extend(creases(&surface, TURN_COSINE));
    lines.extend(borders(&surface, TURN_COSINE));
    let pixel = f64::from(FOCAL_PX.recip());
    let spans = visible(&surface, &Bvh::new(&surface), &view, &lines, pixel)?;
    let mut tracker = Tracker::default();
    let paths = tracker.step(&Frame {
        surface: &surface,
        view: &view,
        facing: &facing,
        lines: &lines,
        spans: &spans,
        pixel,
        period_px: 150.0,
    })?;

    let screen = |point: Vec3| {
        let forward = -eye.normalize();
        let right = forward.cross(Vec3::Y).normalize();
        let to = (point - eye) * (FOCAL_PX / (point - eye).dot(forward));
        [
            SIZE_PX / 2.0 + to.dot(right),
            SIZE_PX / 2.0 - to.dot(right.cross(forward)),
        ]
    };
    let mut svg = format!(
        "<svg xmlns='http://www.w3.org/2000/svg' width='{SIZE_PX}' height='{SIZE_PX}'><rect width='100%' height='100%' fill='white'/>\n"
    );
    let mut stroke = |points: &[Vec3], style: &str| -> std::fmt::Result {
        let places: Vec<String> = points
            .iter()
            .map(|p| screen(*p))
            .map(|[x, y]| format!("{x:.2},{y:.2}"))
            .collect();
        writeln!(
            svg,
            "<polyline points='{}' fill='none' stroke-linecap='round' {style}/>",
            places.join(" ")
        )
    };
    for line in &lines {
        let whole = 0.0..line.segments.len() as f64;
        stroke(
            &points(line, whole.start, whole.end),
            "stroke='#ccc' stroke-width='0.6'",
        )?;
    }
    for span in spans
        .iter()
        .filter(|span| lines[span.line].kind != mesh_lines::Kind::Contour)
    {
        stroke(
            &points(&lines[span.line], span.start, span.end),
            "stroke='black' stroke-width='2'",
        )?;
    }
    for path in paths {
        let hue = path.id * 137 % 360;
        for pair in path.joints.windows(2) {
            let width = 1.5 + 4.0 * pair[0].t.fract();
            let style = format!("stroke='hsl({hue},80%,35%)' stroke-width='{width:.2}'");
            stroke(&[0, 1].map(|i| pair[i].position.as_vec3()), &style)?;
        }
    }
    svg.push_str("</svg>\n");
    Ok(std::fs::write(file, svg)?)
}

/// The joints of a part of a line, and its ends.
fn points(line: &Line, start: f64, end: f64) -> Vec<Vec3> {
    let mut along = vec![start];
    along.extend((start.floor() as usize + 1..end.ceil() as usize).map(|i| i as f64));
    along.push(end);
    along
        .into_iter()
        .map(|along| line.position(along).as_vec3())
        .collect()
}

/// A tube along a trefoil.
fn knot(columns: u32, rows: u32) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let middle = |u: f32| {
        let a = u * TAU;
        Vec3::new(
            a.sin() + 2.0 * (2.0 * a).sin(),
            a.cos() - 2.0 * (2.0 * a).cos(),
            -(3.0 * a).sin(),
        ) * 0.5
    };
    let mut positions = Vec::new();
    let mut triangles = Vec::new();
    for i in 0..columns {
        let u = i as f32 / columns as f32;
        let along = (middle(u + 1e-3) - middle(u - 1e-3)).normalize();
        let side = along.cross(Vec3::Z).normalize();
        for j in 0..rows {
            let (sin, cos) = (j as f32 / rows as f32 * TAU).sin_cos();
            positions.push(middle(u) + (side * cos + side.cross(along) * sin) * 0.27);
            let vertex = |i: u32, j: u32| i % columns * rows + j % rows;
            let [a, b, c, d] = [
                vertex(i, j),
                vertex(i + 1, j),
                vertex(i + 1, j + 1),
                vertex(i, j + 1),
            ];
            triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    (positions, triangles)
}

fn add_box(positions: &mut Vec<Vec3>, triangles: &mut Vec<[u32; 3]>, low: Vec3, high: Vec3) {
    let first = positions.len() as u32;
    let pick = |i: usize, axis: usize| {
        if i >> axis & 1 == 1 {
            high[axis]
        } else {
            low[axis]
        }
    };
    positions.extend((0..8).map(|i| Vec3::new(pick(i, 0), pick(i, 1), pick(i, 2))));
    for [a, b, c, d] in [
        [0, 4, 6, 2],
        [1, 3, 7, 5],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 2, 3, 1],
        [4, 5, 7, 6],
    ] {
        triangles.extend([[a, b, c], [a, c, d]].map(|t| t.map(|corner| corner + first)));
    }
}
