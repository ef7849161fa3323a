//! Strokes that are drawn on what is seen, and shadows.

use crate::agree::{on_cpu, share_beyond};
use crate::meshes::{WAYS, paint, two};
use crate::scene::{Scene, driver, noop};
use render::gpu::Offscreen;
use render::{Feature, Features};

/// On hair, on one surface, on all; of several strokes, smoothed and not; shadows of feathers and of whole clumps.
const DECALS: &str = "[
    (effect: \"hair.cast\", reach: 0.01, params: (distance: 0.15, feathers: 3, color: \"205030\")),
    (effect: \"hair.cast\", name: \"whole\", clip: \"head\", reach: 0.3, params: (distance: 0.2)),
    (effect: \"hair.cel\", name: \"marks\", clip: \"hair, wall\", reach: 0.1, params: (feathers: 2, color: \"F0E020\")),
    (effect: \"hair.silhouette\", name: \"line\", clip: \"head\", reach: 0.5, params: (color: \"2040F0\")),
]";

fn with_decals(seed: u32) -> Scene {
    let mut scene = Scene::random(seed);
    scene.add_layers(DECALS);
    scene
}

#[test]
fn random_frames_with_decals_agree() {
    let Some(mut card) = driver() else { return };
    let mut changed = 0;
    for seed in 0..24 {
        let (scene, without) = (with_decals(seed), Scene::random(seed));
        let samples = [1, 4, 8][seed as usize % 3];
        let cpu = on_cpu(&scene, samples);
        let gpu = card.draw(&scene.frame(), samples).unwrap();
        let wrong = share_beyond(&cpu, &gpu, 2.0 / 255.0);
        assert!(
            wrong <= 0.004,
            "seed {seed}, {:?}, {samples} samples: {:.2} %",
            scene.order,
            100.0 * wrong
        );
        changed += usize::from(share_beyond(&cpu, &on_cpu(&without, samples), 0.02) > 0.01);
    }
    assert!(changed > 16, "decals are seen in {changed} of 24 frames");
}

#[test]
fn decals_on_what_is_painted_agree() {
    let Some(mut card) = driver() else { return };
    for (number, (effect, params)) in WAYS.into_iter().enumerate() {
        let mut scene = with_decals(number as u32);
        paint(&mut scene, &two(effect, params, [0.0, 0.6][number % 2]));
        // Painted hair.
        scene.add_layers("[(effect: \"hair.toon\", params: (mode: replace, tones: (stops: [(0, \"402010\"), (1, \"F0A060\")])))]");
        scene.features = Features::of(&[Feature::Object, Feature::U]);
        let cpu = on_cpu(&scene, 4);
        let gpu = card.draw(&scene.frame(), 4).unwrap();
        let wrong = share_beyond(&cpu, &gpu, 2.0 / 255.0);
        assert!(wrong <= 0.005, "{effect}, {params}: {:.2} %", 100.0 * wrong);
    }
}

#[test]
fn decals_come_and_go() {
    let Some(mut card) = driver() else { return };
    let without = Scene::random(4);
    let before = card.draw(&without.frame(), 4).unwrap();
    let first = card.draw(&with_decals(4).frame(), 4).unwrap();
    assert!(card.draw(&without.frame(), 4).unwrap() == before);
    assert!(card.draw(&with_decals(4).frame(), 4).unwrap() == first);
}

#[test]
fn once_warm_nothing_is_made_again() {
    let mut card = Offscreen::on(noop(wgpu::Limits::default())).unwrap();
    let scene = with_decals(3);
    card.draw(&scene.frame(), 4).unwrap();
    assert!(card.stats().made > 0);
    card.draw(&scene.frame(), 4).unwrap();
    assert_eq!(card.stats().made, 0);
}
