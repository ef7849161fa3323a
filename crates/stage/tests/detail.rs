//! Level of detail: hair thinner than `scene.detail` is drawn as fewer and wider strands, with as much ink and without a jump.

use effects::Registry;
use effects::wgsl::random;
use render::cpu::{Evaluator, Rasterizer};
use render::{Drawing, Picture};
use stage::{Files, FrameMaker, Motion, Preset, Scene};
use std::fmt::Write as _;
use std::fs;

const SIDE: usize = 96;
/// Sides of a tile, in pixels, whose mean change counts.
const TILE: usize = 8;
const STRANDS: u32 = 900;

/// Thin strands that hang around a head, of different lengths.
fn strands() -> String {
    let mut text = String::from("(version: 1, strands: [\n");
    for i in 0..STRANDS {
        let (sin, cos) = (std::f32::consts::TAU * random(i, 0)).sin_cos();
        let (top, length) = (0.12 - 0.1 * random(i, 1), 0.1 + 0.1 * random(i, 2));
        let at = |u: f32| {
            let out = 0.08 + 0.03 * u + 0.005 * (9.0 * u + i as f32).sin();
            format!("({}, {}, {})", out * sin, top - length * u, out * cos)
        };
        let points: Vec<String> = (0..=12).map(|k| at(k as f32 / 12.0)).collect();
        let _ = writeln!(text, "(size: 0.9, points: [{}]),", points.join(", "));
    }
    text + "])"
}

/// The scene with these numbers set.
fn scene(values: &[(&str, f32)]) -> Scene {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("a.strands.ron"), strands()).unwrap();
    let mut registry = Registry::new();
    effects_builtin::register(&mut registry).unwrap();
    let text = format!(
        "(version: 1, hair: (file: \"a.strands.ron\"), scene: (size: ({SIDE}, {SIDE}), background: none), \
         camera: (yaw: 20, pitch: 10, distance: 4, target: (0, -0.2, 0)), light: (yaw: 40, pitch: 45), \
         path: (kind: catmull_rom, subdivision: 2), clump: (color: \"3FC1C0\"), layers: [\
         (effect: \"hair.silhouette\", depth_offset: 0.02, params: (width: 3, color: \"402010\")), (effect: \"hair.base\")])"
    );
    let mut preset = Preset::parse("look.ron", &text, &registry).unwrap();
    for (name, value) in values {
        preset.set(name, &value.to_string()).unwrap();
    }
    let files = Files {
        preset_folder: folder.path().to_owned(),
        ..Files::default()
    };
    Scene::load(&preset, &files).unwrap()
}

/// A picture, and how many strands were not drawn.
fn picture(scene: &Scene, samples: u32) -> (Picture, usize) {
    let (motion, mut frames) = (Motion::new(), FrameMaker::new());
    let mut drawing = Drawing::default();
    let frame = frames.frame(scene, &motion).unwrap();
    Evaluator::default().evaluate(&frame, &mut drawing).unwrap();
    let mut rasterizer = Rasterizer::new(samples, Some(2)).unwrap();
    let merged = frames.merged();
    (rasterizer.draw(&drawing).unwrap(), merged)
}

fn coverage(picture: &Picture) -> f32 {
    picture.pixels.iter().map(|pixel| pixel[3]).sum()
}

#[test]
fn fewer_strands_have_as_much_ink() {
    for (distance, most) in [(4.0, 0.9), (8.0, 0.5), (16.0, 0.25)] {
        let at = |detail| scene(&[("camera.distance", distance), ("scene.detail", detail)]);
        let (all, none) = picture(&at(0.0), 64);
        let (some, merged) = picture(&at(1.0), 64);
        assert_eq!(none, 0);
        let left = 1.0 - merged as f32 / STRANDS as f32;
        assert!(left < most, "{left} of the strands at {distance}");
        let ink = coverage(&some) / coverage(&all);
        assert!((ink - 1.0).abs() < 0.03, "{ink} of the ink at {distance}");
    }
}

#[test]
fn hair_that_is_wide_enough_is_as_it_was() {
    let near = |detail| scene(&[("camera.distance", 1.5), ("scene.detail", detail)]);
    let (all, _) = picture(&near(0.0), 4);
    let (some, merged) = picture(&near(0.4), 4);
    assert_eq!(merged, 0);
    assert!(all.pixels == some.pixels);
}

/// The largest mean change of a tile.
fn change(a: &Picture, b: &Picture) -> f32 {
    let tiles = (0..(SIDE / TILE) * (SIDE / TILE)).map(|tile| {
        let (left, top) = (tile % (SIDE / TILE) * TILE, tile / (SIDE / TILE) * TILE);
        let places = (0..TILE * TILE).map(|i| (top + i / TILE) * SIDE + left + i % TILE);
        let of_pixel = |i: usize| {
            let channels = a.pixels[i].iter().zip(&b.pixels[i]);
            channels.map(|(a, b)| (a - b).abs()).sum::<f32>()
        };
        places.map(of_pixel).sum::<f32>() / (4 * TILE * TILE) as f32
    });
    tiles.fold(0.0, f32::max)
}

/// The largest change of two steps over that of one, while a number runs from one end of a range to the other: 2 where all change is
/// continuous, 1 where something jumps.
fn ratio(name: &str, [from, to]: [f32; 2], others: &[(&str, f32)]) -> f32 {
    const STEPS: usize = 12;
    let at = |step: usize| from + (to - from) * step as f32 / STEPS as f32;
    let of = |step: usize| picture(&scene(&[others, &[(name, at(step))]].concat()), 256).0;
    let pictures: Vec<Picture> = (0..=STEPS).map(of).collect();
    let largest = |length: usize| {
        let pairs = pictures.windows(length + 1);
        pairs
            .map(|part| change(&part[0], &part[length]))
            .fold(0.0, f32::max)
    };
    largest(2) / largest(1)
}

#[test]
fn strands_come_together_without_a_jump() {
    // So thin hair drawn as it is scores less, as samples flip: 1.5 by this distance.
    let by_distance = ratio("camera.distance", [6.0, 6.3], &[]);
    assert!(by_distance > 1.7, "a dolly jumps: {by_distance}");
    let by_detail = ratio("scene.detail", [1.0, 1.3], &[("camera.distance", 6.0)]);
    assert!(by_detail > 1.7, "detail jumps: {by_detail}");
}
