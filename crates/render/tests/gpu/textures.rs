//! Pictures on surfaces.

use crate::agree::{on_cpu, share_beyond};
use crate::scene::{Scene, driver, noop};
use effects::Image;
use glam::Vec2;
use render::gpu::Offscreen;
use render::{Coverage, Feature, Features, SurfaceTexture};
use std::sync::Arc;

/// A picture of patches whose coverage differs, so large that its smaller copies are looked up.
fn patches(width: usize, height: usize) -> Arc<Image> {
    let texel = |i: usize| {
        let (x, y) = (i % width * 8 / width, i / width * 8 / height);
        let channel = |k: usize| ((x * 7919 + y * 104_729 + k * 31) % 251 * 261) as u16;
        let covers = [0, 21_000, 43_000, 65_535][(x + 3 * y) % 4];
        [channel(1), channel(2), channel(3), covers]
    };
    let texels: Vec<_> = (0..width * height).map(texel).collect();
    Arc::new(Image::from_srgb([width, height], texels.as_flattened()).unwrap())
}

/// Two pictures, one on each surface.
fn with_pictures(scene: &mut Scene, coverage: [Coverage; 2]) {
    let images = [patches(300, 200), patches(24, 40)];
    for ((surface, image), coverage) in scene.surfaces.iter_mut().zip(images).zip(coverage) {
        let corners = [(-0.2, 0.1), (1.7, -0.3), (0.9, 1.4), (0.1, 0.8)];
        surface.texture = Some(SurfaceTexture {
            image,
            repeats: coverage == Coverage::Share,
            places: corners.map(Vec2::from).to_vec(),
            coverage,
        });
    }
}

#[test]
fn pictures_on_surfaces_agree() {
    let Some(mut card) = driver() else { return };
    let kinds = [Coverage::Ignored, Coverage::Cut(0.5), Coverage::Share];
    for seed in 0..9 {
        let mut scene = Scene::random(seed);
        let flat = on_cpu(&scene, 4);
        let coverage = [0, 1].map(|i| kinds[(seed as usize + i) % kinds.len()]);
        with_pictures(&mut scene, coverage);
        for samples in [1, 2, 3, 4, 8] {
            let cpu = on_cpu(&scene, samples);
            let gpu = card.draw(&scene.frame(), samples).unwrap();
            let wrong = share_beyond(&cpu, &gpu, 2.0 / 255.0);
            // A sample that flips is all of a pixel with one of them.
            assert!(
                wrong <= 0.004,
                "seed {seed}, {samples} samples, {coverage:?}: {:.2} %",
                100.0 * wrong
            );
            assert!(share_beyond(&cpu, &flat, 0.02) > 0.05, "seed {seed}");
        }
    }
}

/// With what samples show beside it, and another picture in the next frame.
#[test]
fn pictures_come_and_go() {
    let Some(mut card) = driver() else { return };
    let mut scene = Scene::random(2);
    let before = card.draw(&scene.frame(), 4).unwrap();
    let bytes = card.stats().bytes;
    with_pictures(&mut scene, [Coverage::Ignored, Coverage::Cut(0.5)]);
    let features = [Features::NONE, Features::of(&[Feature::Object])];
    for declared in features {
        scene.features = declared;
        let gpu = card.draw(&scene.frame(), 4).unwrap();
        assert!(share_beyond(&on_cpu(&scene, 4), &gpu, 2.0 / 255.0) <= 0.003);
    }
    assert!(card.stats().bytes > bytes + 8 * 300 * 200);
    let mut flat = Scene::random(2);
    flat.features = Features::NONE;
    assert!(card.draw(&flat.frame(), 4).unwrap() == before);
    // Buffers keep some room; the pictures are gone.
    assert!(card.stats().bytes < bytes + 8 * 300);
}

#[test]
fn once_warm_pictures_are_not_written_again() {
    let mut card = Offscreen::on(noop(wgpu::Limits::default())).unwrap();
    for seed in 0..6 {
        let mut scene = Scene::random(seed);
        with_pictures(&mut scene, [Coverage::Ignored, Coverage::Share]);
        card.draw(&scene.frame(), 4).unwrap();
        assert!(card.stats().made > 0);
        card.draw(&scene.frame(), 4).unwrap();
        assert_eq!(card.stats().made, 0);
    }
}
