//! A small change of what goes in makes a small change of the picture: nothing appears, vanishes or
//! changes places at once.
//!
//! Of a series of pictures the largest change of two steps is held against the largest of one. It is twice as large
//! where all change is continuous, and the same where something jumps.

use effects::Registry;
use render::cpu::{Evaluator, Rasterizer};
use render::{Drawing, Picture};
use stage::{Files, Preset, Stage};
use std::fmt::Write as _;
use std::fs;
use std::path::Path;

const WIDTH: usize = 96;
const HEIGHT: usize = 96;
/// Many, so that no edge crosses a large part of a pixel's at once.
const SAMPLES: u32 = 128;
/// Sides of a tile, in pixels, whose mean change counts.
const TILE: usize = 8;
/// Steps of a series.
const STEPS: usize = 16;

const LAYERS: &str = r#"[
    (effect: "hair.silhouette", depth_offset: 0.02, params: (width: 3, color: "402010")),
    (effect: "hair.base"),
    (effect: "hair.cel", params: (color: "2A8F9D", threshold: 0.6, full: 0.3, roundness: 1)),
    (effect: "hair.highlight", params: (kind: specular, exponent: 2, threshold: 0.2, full: 0.6)),
    (effect: "hair.band", params: (along: length, place: 0.5, thickness: 0.3, shade: 0, strand_share: 1)),
    (effect: "hair.fine", params: (per_strand: 2, width: 2, color: "FFF0C0")),
]"#;

/// Ink that lifts off the paper.
const INK: &str = r#"[
    (effect: "hair.ink", params: (width: 4, gaps: 0.5, shortest: 0.1, wobble_length: 0.03, color: "203050")),
    (effect: "hair.base"),
]"#;

/// Wavy strands side by side, some nearer than others, and a ringlet.
fn strands() -> String {
    let mut text = String::from("(version: 1, strands: [\n");
    let mut strand = |size: f32, at: &dyn Fn(f32) -> [f32; 3]| {
        let points = (0..=30).map(|i| at(i as f32 / 30.0));
        let points: Vec<String> = points.map(|[x, y, z]| format!("({x}, {y}, {z})")).collect();
        let _ = writeln!(text, "(size: {size}, points: [{}]),", points.join(", "));
    };
    for i in 0..6 {
        let (sin, cos) = (0.4 * (i as f32 - 3.0)).sin_cos();
        let top = 0.12 - 0.02 * (i % 3) as f32;
        strand(20.0, &|u| {
            let wave = (7.0 * u + i as f32).sin();
            let out = 0.09 + 0.02 * wave;
            [out * sin, top - 0.22 * u, out * cos]
        });
    }
    strand(10.0, &|u| {
        let (sin, cos) = (18.0 * u).sin_cos();
        [0.1 + 0.025 * cos, 0.1 - 0.2 * u, 0.025 * sin]
    });
    text + "])"
}

/// The scene with these layers, and these numbers set.
fn stage_of(layers: &str, folder: &Path, values: &[(&str, f32)]) -> Stage {
    let mut registry = Registry::new();
    effects_builtin::register(&mut registry).unwrap();
    let text = format!(
        "(version: 1, hair: (file: \"a.strands.ron\"), scene: (size: ({WIDTH}, {HEIGHT}), background: \"FFFFFF\"), \
         camera: (yaw: 20, pitch: 10, distance: 2.8, target: (0, -0.4, 0)), light: (yaw: 40, pitch: 45), \
         path: (kind: catmull_rom, subdivision: 4), clump: (color: \"3FC1C0\"), layers: {layers})"
    );
    let mut preset = Preset::parse("look.ron", &text, &registry).unwrap();
    for (name, value) in values {
        preset.set(name, &value.to_string()).unwrap();
    }
    let files = Files {
        preset_folder: folder.to_owned(),
        ..Files::default()
    };
    Stage::new(&preset, &files).unwrap()
}

fn picture(stage: &mut Stage) -> Picture {
    let mut drawing = Drawing::default();
    Evaluator::default()
        .evaluate(&stage.frame().unwrap(), &mut drawing)
        .unwrap();
    let mut rasterizer = Rasterizer::new(SAMPLES, Some(2)).unwrap();
    rasterizer.draw(&drawing).unwrap()
}

/// The largest mean change of a tile.
fn change(a: &Picture, b: &Picture) -> f32 {
    let mut largest = 0.0_f32;
    for tile in 0..(WIDTH / TILE) * (HEIGHT / TILE) {
        let (left, top) = (tile % (WIDTH / TILE) * TILE, tile / (WIDTH / TILE) * TILE);
        let places = (0..TILE * TILE).map(|i| (top + i / TILE) * WIDTH + left + i % TILE);
        let changes = places.flat_map(|i| (0..3).map(move |c| (i, c)));
        let sum: f32 = changes
            .map(|(i, c)| (a.pixels[i][c] - b.pixels[i][c]).abs())
            .sum();
        largest = largest.max(sum / (3 * TILE * TILE) as f32);
    }
    largest
}

/// The scene at each step while numbers run from one end of a range to the other.
fn stages(layers: &str, ranges: &[(&str, [f32; 2])]) -> Vec<Stage> {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("a.strands.ron"), strands()).unwrap();
    let at = |step: usize| {
        let t = step as f32 / STEPS as f32;
        let values = ranges
            .iter()
            .map(|(name, [from, to])| (*name, from + (to - from) * t));
        stage_of(layers, folder.path(), &values.collect::<Vec<_>>())
    };
    (0..=STEPS).map(at).collect()
}

/// The largest change of two steps over that of one.
fn ratio(stages: &mut [Stage]) -> f32 {
    let pictures: Vec<Picture> = stages.iter_mut().map(picture).collect();
    let largest = |length: usize| {
        let pairs = pictures
            .windows(length + 1)
            .map(|part| change(&part[0], &part[length]));
        pairs.fold(0.0, f32::max)
    };
    assert!(largest(1) > 1e-3, "nothing changes");
    largest(2) / largest(1)
}

#[track_caller]
fn assert_continuous(ranges: &[(&str, [f32; 2])]) {
    assert_continuous_in(LAYERS, ranges);
}

#[track_caller]
fn assert_continuous_in(layers: &str, ranges: &[(&str, [f32; 2])]) {
    let ratio = ratio(&mut stages(layers, ranges));
    assert!(ratio > 1.7, "{ranges:?} jumps: {ratio}");
}

#[test]
fn strokes_grow_and_shrink_with_the_light() {
    assert_continuous(&[("light.yaw", [0.0, 24.0])]);
    assert_continuous(&[("light.pitch", [80.0, 60.0])]);
}

#[test]
fn hair_turns_with_the_eye() {
    assert_continuous(&[("camera.yaw", [20.0, 28.0])]);
    assert_continuous_in(INK, &[("camera.yaw", [20.0, 28.0])]);
    // Strands come to point at the eye, and turn to the other side of the picture.
    assert_continuous(&[("camera.pitch", [75.0, 82.0])]);
}

#[test]
fn strokes_follow_their_limits() {
    assert_continuous(&[("hair.cel.threshold", [0.4, 0.6])]);
    assert_continuous(&[("hair.highlight.threshold", [0.1, 0.3])]);
    // Short ones are smoothed away.
    assert_continuous(&[("hair.highlight.shortest", [0.1, 0.14])]);
    assert_continuous(&[("hair.cel.shortest", [0.1, 0.14])]);
}

#[test]
fn bands_wander_along_the_hair() {
    assert_continuous(&[("hair.band.place", [0.5, 0.6])]);
    assert_continuous(&[("hair.band.thickness", [0.2, 0.4])]);
    assert_continuous(&[("hair.band.shade", [0.0, 0.6])]);
}

#[test]
fn fine_hairs_wander() {
    assert_continuous(&[("hair.fine.lift", [0.0, 0.06])]);
    assert_continuous(&[("hair.fine.crossing", [0.2, 0.3])]);
    assert_continuous(&[("hair.fine.width", [0.0, 2.0])]);
}

#[test]
fn clumps_come_from_nothing() {
    assert_continuous(&[("clump.size", [0.0, 0.4])]);
}

#[test]
fn the_near_plane_cuts_without_a_jump() {
    // The nearest strand, all along at once.
    let range = [
        ("camera.distance", [0.49, 0.4825]),
        ("clump.size", [0.5, 0.5]),
    ];
    let mut stages = stages(LAYERS, &range);
    // It is reached: joints are lost on the way.
    let mut joints = stages
        .iter_mut()
        .map(|stage| stage.frame().unwrap().paths.len());
    let (first, last) = (joints.next().unwrap(), joints.next_back().unwrap());
    assert!(last < first, "{first} joints, then {last}");
    assert_continuous(&range);
}

/// The measure is measured: a strand has a highlight or it has none.
#[test]
fn what_jumps_is_found() {
    let ratio = ratio(&mut stages(
        LAYERS,
        &[("hair.highlight.strand_share", [0.1, 0.9])],
    ));
    assert!(ratio < 1.2, "{ratio}");
}
