//! A graphics card draws what the CPU draws.

use crate::scene::{Numbers, Scene, driver};
use glam::Vec2;
use render::cpu::{Evaluator, Rasterizer};
use render::{Drawing, Picture, Surface, SurfaceVertex};

pub fn on_cpu(scene: &Scene, samples: u32) -> Picture {
    let mut drawing = Drawing::default();
    Evaluator::default()
        .evaluate(&scene.frame(), &mut drawing)
        .unwrap();
    Rasterizer::new(samples, Some(1))
        .unwrap()
        .draw(&drawing)
        .unwrap()
}

/// The share of pixels of which a channel differs by more than that.
pub fn share_beyond(a: &Picture, b: &Picture, step: f32) -> f64 {
    assert_eq!((a.width, a.height), (b.width, b.height));
    let differs = |(a, b): (&[f32; 4], &[f32; 4])| (0..4).any(|i| (a[i] - b[i]).abs() > step);
    let count = a
        .pixels
        .iter()
        .zip(&b.pixels)
        .filter(|pair| differs(*pair))
        .count();
    count as f64 / a.pixels.len() as f64
}

/// All orders, both brushes, both kinds of light, strands through the near plane and of one particle, surfaces with and
/// without a margin. A sample may flip where rounding decides, and shows as a quarter of a pixel.
#[test]
fn random_frames_agree() {
    let Some(mut card) = driver() else { return };
    let mut drawn = 0;
    for seed in 0..24 {
        let scene = Scene::random(seed);
        let (cpu, gpu) = (on_cpu(&scene, 4), card.draw(&scene.frame(), 4).unwrap());
        let wrong = share_beyond(&cpu, &gpu, 2.0 / 255.0);
        assert!(
            wrong <= 0.003,
            "seed {seed}, {:?}: {:.2} %",
            scene.order,
            100.0 * wrong
        );
        drawn += usize::from(share_beyond(&cpu, &on_cpu(&without_hair(seed), 4), 0.01) > 0.02);
    }
    assert!(drawn > 18, "hair is seen in {drawn} of 24 frames");
}

#[test]
fn two_objects_agree() {
    let Some(mut card) = driver() else { return };
    for seed in 0..12 {
        let scene = Scene::random_pair(seed);
        let (cpu, gpu) = (on_cpu(&scene, 4), card.draw(&scene.frame(), 4).unwrap());
        let wrong = share_beyond(&cpu, &gpu, 2.0 / 255.0);
        assert!(wrong <= 0.003, "seed {seed}: {:.2} %", 100.0 * wrong);
        // Another head makes another picture.
        let alone = on_cpu(&Scene::random(seed), 4);
        assert!(share_beyond(&cpu, &alone, 0.01) > 0.01, "seed {seed}");
    }
}

/// A head seen along its skin: triangles of its outside and of its inside meet at an edge, where they are as deep, and those of the inside
/// are needles.
#[test]
fn surfaces_that_meet_agree() {
    let Some(mut card) = driver() else { return };
    let mut scene = without_hair(2);
    let corner = |x: f32, y: f32, inv_depth: f32| SurfaceVertex {
        position: Vec2::new(x, y),
        inv_depth,
        tone: inv_depth,
    };
    let mut sides = [0, 1].map(|side| Surface {
        light: [side as f32, 0.5, 0.0],
        ..Surface::default()
    });
    let mut numbers = Numbers::new(1);
    for row in 0..70 {
        for column in 0..5 {
            let (x, y) = (
                18.0 * column as f32 + numbers.next(),
                row as f32 + numbers.next(),
            );
            let (from, to) = (
                corner(x, y, 0.67),
                corner(x + 17.0, y + 0.7 * numbers.next(), 0.672),
            );
            let beyond = |up: f32, nearer: f32| corner(x + 9.0, y + up, 0.671 + nearer);
            // Both lie above their edge, the inside by next to nothing, and deeper.
            let thirds = [beyond(1.2, 1e-4), beyond(0.4, -1e-5)];
            for (side, third) in sides.iter_mut().zip(thirds) {
                let first = side.vertices.len() as u32;
                side.vertices.extend([from, to, third]);
                side.triangles.push([first, first + 1, first + 2]);
            }
        }
    }
    scene.surfaces = sides.to_vec();
    let (cpu, gpu) = (on_cpu(&scene, 4), card.draw(&scene.frame(), 4).unwrap());
    let wrong = share_beyond(&cpu, &gpu, 2.0 / 255.0);
    assert!(wrong <= 0.0005, "{:.3} %", 100.0 * wrong);
}

/// The measure itself: the frame without hair doesn't agree.
fn without_hair(seed: u32) -> Scene {
    let mut scene = Scene::random(seed);
    scene.layers.clear();
    scene.layer_joints.clear();
    scene
}

#[test]
fn any_number_of_samples_agrees() {
    let Some(mut card) = driver() else { return };
    let scene = Scene::random(4);
    for samples in [1, 3, 8] {
        let (cpu, gpu) = (
            on_cpu(&scene, samples),
            card.draw(&scene.frame(), samples).unwrap(),
        );
        let wrong = share_beyond(&cpu, &gpu, 2.0 / 255.0);
        assert!(wrong <= 0.003, "{samples} samples: {:.2} %", 100.0 * wrong);
    }
}

#[test]
fn the_same_frame_is_the_same_picture() {
    let Some(mut card) = driver() else { return };
    let (one, other) = (Scene::random(1), Scene::random(2));
    let first = card.draw(&one.frame(), 4).unwrap();
    card.draw(&other.frame(), 4).unwrap();
    assert!(first == card.draw(&one.frame(), 4).unwrap());
}

#[test]
fn a_frame_of_nothing_is_its_background() {
    let Some(mut card) = driver() else { return };
    let mut scene = without_hair(1);
    scene.surfaces.clear();
    let picture = card.draw(&scene.frame(), 4).unwrap();
    let [red, green, blue] = scene.background.unwrap();
    assert!(
        picture
            .pixels
            .iter()
            .all(|pixel| *pixel == [red, green, blue, 1.0])
    );
    scene.background = None;
    let picture = card.draw(&scene.frame(), 4).unwrap();
    assert!(picture.pixels.iter().all(|pixel| *pixel == [0.0; 4]));
}

/// A few strands that each reach nearly every tile need longer lists than is guessed; the picture is the same with short ones.
#[test]
fn lists_without_room_draw_the_same() {
    let Some(mut card) = driver() else { return };
    let mut scene = Scene::random(4);
    let view = stroke_path::OrbitView {
        target: glam::Vec3::ZERO,
        yaw_degrees: 0.0,
        pitch_degrees: 0.0,
        distance_m: 3.0,
        vertical_fov_degrees: 20.0,
    };
    scene.camera = stroke_path::Camera::orbit(view, [160, 120], 0.05).unwrap();
    scene.layers.truncate(2);
    scene.layer_joints.truncate(2);
    scene
        .strands
        .iter_mut()
        .for_each(|strand| strand.size = 2000.0);
    let first = card.draw(&scene.frame(), 1).unwrap();
    assert!(card.stats().lists_were_short);
    let second = card.draw(&scene.frame(), 1).unwrap();
    assert!(!card.stats().lists_were_short);
    assert!(first == second);
    assert!(share_beyond(&on_cpu(&scene, 1), &first, 2.0 / 255.0) <= 0.003);
}
