//! How long the lines of a large mesh take: a sphere with bumps, of about 100,000 and 1,000,000 triangles.
//!
//! `cargo run --release -p mesh-lines --example throughput`
#![allow(clippy::print_stdout, reason = "an example prints")]

use glam::Vec3;
use mesh_lines::{
    Bvh, Frame, MeshError, Surface, TURN_COSINE, Topology, Tracker, View, borders, contours,
    facing, visible,
};
use std::time::{Duration, Instant};

/// Medians are of so many frames.
const FRAMES: usize = 31;
/// 720 lines of 30 degrees.
const PIXEL: f64 = 1.0 / 1344.0;

fn main() -> Result<(), MeshError> {
    for bumps in [0.0, 0.2] {
        for triangles in [10_000, 100_000, 1_000_000] {
            measure(triangles, bumps)?;
        }
    }
    Ok(())
}

fn measure(triangles: u32, bumps: f32) -> Result<(), MeshError> {
    let rows = (f64::from(triangles) / 4.0).sqrt() as u32;
    let (positions, triangles) = sphere(rows * 2, rows, bumps);
    let start = Instant::now();
    let topology = Topology::new(&positions, &triangles)?;
    let topology_time = start.elapsed();
    let surface = Surface::new(&topology, &positions)?;
    let start = Instant::now();
    let mut bvh = Bvh::new(&surface);
    let bvh_time = start.elapsed();
    println!(
        "{} triangles, bumps {bumps}: half-edges {}, tree {}, once",
        triangles.len(),
        ms(topology_time),
        ms(bvh_time)
    );
    let mut tracker = Tracker::default();
    let names = [
        "normals", "refit", "facing", "contours", "visible", "tracking",
    ];
    let mut times = vec![Vec::new(); names.len()];
    let mut counts = String::new();
    for frame in 0..FRAMES {
        let (sin, cos) = (frame as f32 * 0.01).sin_cos();
        let view = View::perspective(Vec3::new(5.0 * sin, 1.0, 5.0 * cos))?;
        let mut clock = Instant::now();
        let mut lap = |at: usize| {
            times[at].push(clock.elapsed());
            clock = Instant::now();
        };
        let surface = Surface::new(&topology, &positions)?;
        lap(0);
        bvh.refit(&surface);
        lap(1);
        let facing = facing(&surface, &view);
        lap(2);
        let mut lines = contours(&surface, &view, &facing)?;
        lines.extend(borders(&surface, TURN_COSINE));
        lap(3);
        let spans = visible(&surface, &bvh, &view, &lines, PIXEL)?;
        lap(4);
        let paths = tracker.step(&Frame {
            surface: &surface,
            view: &view,
            facing: &facing,
            lines: &lines,
            spans: &spans,
            pixel: PIXEL,
            period_px: 100.0,
        })?;
        let segments: usize = lines.iter().map(|line| line.segments.len()).sum();
        counts = format!(
            "{} lines, {segments} segments, {} spans, {} paths",
            lines.len(),
            spans.len(),
            paths.len()
        );
        lap(5);
    }
    let median = |times: &mut Vec<Duration>| {
        times.sort_unstable();
        times[times.len() / 2]
    };
    let medians: Vec<Duration> = times.iter_mut().map(median).collect();
    let each: Vec<String> = names
        .iter()
        .zip(&medians)
        .map(|(name, time)| format!("{name} {}", ms(*time)))
        .collect();
    println!("  {counts}\n  a frame: {}", each.join(", "));
    println!(
        "  {} where only the eye moves, {} where the mesh moves",
        ms(medians[2..].iter().sum()),
        ms(medians.iter().sum())
    );
    Ok(())
}

fn ms(time: Duration) -> String {
    format!("{:.2} ms", time.as_secs_f64() * 1e3)
}

/// A sphere of radius 1 with its poles closed; `bumps` high.
fn sphere(columns: u32, rows: u32, bumps: f32) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let place = |i: u32, j: u32| {
        let (sin, cos) = (i as f32 / columns as f32 * std::f32::consts::TAU).sin_cos();
        let (across, up) = (j as f32 / rows as f32 * std::f32::consts::PI).sin_cos();
        let unit = Vec3::new(across * cos, up, -across * sin);
        unit * (1.0
            + bumps * (5.0 * unit.x).sin() * (4.0 * unit.y + 1.0).sin() * (4.5 * unit.z).cos())
    };
    let mut positions = vec![place(0, 0), place(0, rows)];
    positions.extend(
        (1..rows)
            .flat_map(|j| (0..columns).map(move |i| (i, j)))
            .map(|(i, j)| place(i, j)),
    );
    let vertex = |i: u32, j: u32| match j {
        0 => 0,
        _ if j == rows => 1,
        _ => 2 + (j - 1) * columns + i % columns,
    };
    let cells = (0..rows).flat_map(|j| (0..columns).map(move |i| (i, j)));
    let triangles = cells.flat_map(|(i, j)| {
        let [a, b, c, d] = [
            vertex(i, j),
            vertex(i, j + 1),
            vertex(i + 1, j + 1),
            vertex(i + 1, j),
        ];
        [[a, b, c], [a, c, d]]
    });
    (
        positions,
        triangles
            .filter(|[a, b, c]| a != b && b != c && c != a)
            .collect(),
    )
}
