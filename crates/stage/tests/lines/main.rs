//! Lines of meshes, drawn as strokes: which there are, where they lie, what hides them, and mistakes.

#![allow(
    clippy::print_stdout,
    reason = "a test shows the figures that it holds"
)]

mod kinds;
mod marks;
mod numbered;
mod things;

use effects::Registry;
use glam::{Vec2, Vec3};
use render::cpu::{Evaluator, Rasterizer};
use render::{Drawing, Frame, Picture};
use stage::{Files, Preset, Stage};
use std::fmt::Write as _;
use std::fs;
use std::ops::Range;
use stroke_path::{Camera, OrbitView};
use tempfile::TempDir;

const RADIUS_M: f32 = 0.05;
/// Before the bust's face, and beside it.
const BALL: Vec3 = Vec3::new(0.0, 1.52, 0.3);
const BOX: Vec3 = Vec3::new(0.2, 1.52, 0.1);

/// One strand of hair behind the head, a ball and a box.
fn folder() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
    write(
        "a.strands.ron",
        "(version: 1, strands: [(points: [(0, 1.63, -0.06), (0, 1.6, -0.13), (0, 1.5, -0.14)])])",
    );
    write(
        "curtain.strands.ron",
        "(version: 1, strands: [(points: [(0, 1.63, 0.06), (0, 1.6, 0.4), (0, 1.4, 0.4)])])",
    );
    write("ball.obj", &ball(24, 48));
    write("box.obj", &cube());
    folder
}

fn ball(rows: usize, columns: usize) -> String {
    let mut text = String::new();
    for row in 0..=rows {
        for column in 0..columns {
            let down = std::f32::consts::PI * row as f32 / rows as f32;
            // At both poles all is one point.
            let width = if row % rows == 0 { 0.0 } else { down.sin() };
            let around = std::f32::consts::TAU * column as f32 / columns as f32;
            let way = Vec3::new(width * around.sin(), down.cos(), width * around.cos());
            let Vec3 { x, y, z } = BALL + RADIUS_M * way;
            let _ = writeln!(text, "v {x} {y} {z}");
        }
    }
    for row in 0..rows {
        for column in 0..columns {
            let at = |row: usize, column: usize| row * columns + column % columns + 1;
            let [a, b] = [at(row, column), at(row, column + 1)];
            let [c, d] = [at(row + 1, column + 1), at(row + 1, column)];
            let _ = writeln!(text, "f {d} {c} {b} {a}");
        }
    }
    text
}

fn cube() -> String {
    let mut text = String::new();
    for corner in 0..8 {
        let at = |bit: usize| if corner >> bit & 1 == 1 { 0.03 } else { -0.03 };
        let Vec3 { x, y, z } = BOX + Vec3::new(at(0), at(1), at(2));
        let _ = writeln!(text, "v {x} {y} {z}");
    }
    text + "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n"
}

fn text(hair: &str, lines: &str, layers: &str) -> String {
    format!(
        "(version: 1, hair: (file: \"{hair}.strands.ron\"), head: (shape: bust, width: 0, light: \"FFFFFF\", shadow: \"FFFFFF\"),\n \
         meshes: [(file: \"ball.obj\"), (file: \"box.obj\")],\n \
         scene: (size: (240, 240), samples: 4, background: \"FFFFFF\"), clump: (size: 0.5, color: \"C04020\"),\n \
         camera: (distance: 6), light: (yaw: 0, pitch: 10),\n lines: [{lines}],\n layers: [(effect: \"hair.base\"), {layers}])"
    )
}

fn registry() -> Registry {
    let mut registry = Registry::new();
    effects_builtin::register(&mut registry).unwrap();
    effects_cartoon::register(&mut registry).unwrap();
    effects_surface::register(&mut registry).unwrap();
    registry
}

fn stage(hair: &str, lines: &str, layers: &str) -> Result<Stage, String> {
    let (folder, text, registry) = (folder(), text(hair, lines, layers), registry());
    let preset = Preset::parse("look.ron", &text, &registry).map_err(|error| error.to_string())?;
    let files = Files {
        preset_folder: folder.path().to_owned(),
        ..Files::default()
    };
    preset
        .check_scene("look.ron", &text, &files)
        .map_err(|error| error.to_string())?;
    Stage::new(&preset, &files).map_err(|error| error.to_string())
}

const INK: &str =
    "(effect: \"line.ink\", on: \"rim\", params: (wobble: 0, light_width: 1, color: \"000000\"))";

fn drawn(frame: &Frame) -> Picture {
    let mut drawing = Drawing::default();
    Evaluator::default().evaluate(frame, &mut drawing).unwrap();
    Rasterizer::new(4, Some(1)).unwrap().draw(&drawing).unwrap()
}

fn picture(hair: &str, lines: &str, layers: &str) -> Picture {
    drawn(&stage(hair, lines, layers).unwrap().frame().unwrap())
}

/// How many pixels are dark, all of a black one.
fn ink(picture: &Picture) -> f32 {
    picture.pixels.iter().map(|[red, ..]| 1.0 - red).sum()
}

/// The joints of each line of the last list.
fn strands(frame: &Frame) -> Vec<Range<usize>> {
    let own = frame.objects.last().unwrap().joints.clone();
    let runs = frame.paths.runs.iter().map(|run| run.joints.clone());
    runs.filter(|joints| joints.start >= own.start).collect()
}

/// A preset of things alone, without a file.
fn things(meshes: &str, lines: &str, layers: &str) -> Result<Stage, String> {
    things_of(meshes, lines, layers, &Files::default())
}

/// The same with files that are given.
fn things_of(meshes: &str, lines: &str, layers: &str, files: &Files) -> Result<Stage, String> {
    let text = format!(
        "(version: 1, head: (shape: none), meshes: [{meshes}],\n \
         scene: (size: (240, 240), samples: 4, background: \"FFFFFF\"), camera: (distance: 3, pitch: 20),\n \
         lines: [{lines}],\n layers: [{layers}])"
    );
    let registry = registry();
    let preset = Preset::parse("look.ron", &text, &registry).map_err(|error| error.to_string())?;
    let checked = preset.check_scene("look.ron", &text, files);
    checked.map_err(|error| error.to_string())?;
    Stage::new(&preset, files).map_err(|error| error.to_string())
}

const CHALK: &str =
    "(effect: \"line.chalk\", on: \"rim\", brush: (kind: charcoal), params: (color: \"000000\"))";
