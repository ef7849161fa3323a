//! Strokes that leave what they reach bare in part.

use crate::agree::{on_cpu, share_beyond};
use crate::scene::{Scene, driver, noop};
use effects::preset::Reader;
use effects::{BrushSection, BrushTexture};
use render::gpu::Offscreen;
use std::sync::Arc;

const BRUSHES: [&str; 6] = [
    "(kind: pencil)",
    "(kind: charcoal, grain: 2)",
    "(kind: dry_ink)",
    "(kind: watercolour, length: 0.2)",
    "(kind: crayon, dry: 0.8)",
    "(kind: crayon, fit: stretch)",
];

fn brush(text: &str) -> Option<Arc<BrushTexture>> {
    let mut reader = Reader::new("test", text);
    let section: BrushSection = reader.section(text, "brush");
    reader.report().unwrap();
    BrushTexture::of_tool(&section).map(Arc::new)
}

const DECALS: &str = "[
    (effect: \"hair.cast\", reach: 0.01, params: (distance: 0.15, feathers: 3, color: \"205030\")),
    (effect: \"hair.cel\", name: \"marks\", clip: \"hair, wall\", reach: 0.1, params: (feathers: 2, color: \"F0E020\")),
]";

/// A random frame of which every second layer has a brush.
fn with_brushes(seed: u32) -> Scene {
    let mut scene = Scene::random(seed);
    if seed % 4 == 3 {
        scene.add_layers(DECALS);
    }
    let odd = seed as usize % 2;
    for (i, layer) in scene
        .layers
        .iter_mut()
        .enumerate()
        .filter(|(i, _)| i % 2 == odd)
    {
        layer.brush = brush(BRUSHES[(seed as usize + i) % BRUSHES.len()]);
    }
    scene
}

#[test]
fn random_frames_with_brushes_agree() {
    let Some(mut card) = driver() else { return };
    let mut changed = 0;
    for seed in 0..24 {
        let (scene, without) = (with_brushes(seed), Scene::random(seed));
        let samples = [4, 1, 8][seed as usize % 3];
        let cpu = on_cpu(&scene, samples);
        let gpu = card.draw(&scene.frame(), samples).unwrap();
        let wrong = share_beyond(&cpu, &gpu, 2.0 / 255.0);
        assert!(
            wrong <= 0.005,
            "seed {seed}, {:?}, {samples} samples: {:.2} %",
            scene.order,
            100.0 * wrong
        );
        changed += usize::from(share_beyond(&cpu, &on_cpu(&without, samples), 0.02) > 0.01);
    }
    assert!(changed > 16, "brushes are seen in {changed} of 24 frames");
}

#[test]
fn brushes_come_and_go() {
    let Some(mut card) = driver() else { return };
    let without = Scene::random(4);
    let before = card.draw(&without.frame(), 4).unwrap();
    let first = card.draw(&with_brushes(4).frame(), 4).unwrap();
    assert!(card.draw(&without.frame(), 4).unwrap() == before);
    assert!(card.draw(&with_brushes(4).frame(), 4).unwrap() == first);
}

#[test]
fn once_warm_nothing_is_made_again() {
    let mut card = Offscreen::on(noop(wgpu::Limits::default())).unwrap();
    let scene = with_brushes(3);
    card.draw(&scene.frame(), 4).unwrap();
    assert!(card.stats().made > 0);
    card.draw(&scene.frame(), 4).unwrap();
    assert_eq!(card.stats().made, 0);
}
