//! Surfaces that layers paint, also seen through hair.

use crate::agree::{on_cpu, share_beyond};
use crate::scene::{Scene, driver, layers, noop, registry};
use effects::{Image, Variation};
use glam::{Vec2, Vec3};
use render::gpu::Offscreen;
use render::{Coverage, EdgeChannel, Edges, Feature, Features, SurfacePaint, SurfaceTexture};
use std::sync::Arc;

/// Layers for meshes with the same effect and parameters, the second of them seen through hair.
pub fn two(effect: &str, params: &str, through: f32) -> String {
    format!(
        "[(effect: \"{effect}\", on: \"a\", params: ({params})),
          (effect: \"{effect}\", name: \"second\", on: \"b\", through_hair: {through}, params: ({params}))]"
    )
}

/// Ways to paint: every detail and mode, soft edges, rims.
pub const WAYS: [(&str, &str); 6] = [
    ("mesh.flat", "threshold: 0.2"),
    ("mesh.flat", "softness: 0.5, shade: \"203060\""),
    ("mesh.toon", "rim: \"FFE0B0\""),
    (
        "mesh.toon",
        "mode: multiply, detail: blinn, tones: [(v: 0, steps: [(0, \"805060\"), (0.4, \"C0B0B0\")]), (v: 1, stops: [(0, \"FFFFFF\")])]",
    ),
    (
        "mesh.toon",
        "mode: add, detail: facing, exponent: 2, tones: [(v: 0, stops: [(0, \"000000\"), (1, \"404040\")]), (v: 1, stops: [(0, \"202000\")])]",
    ),
    (
        "mesh.toon",
        "mode: replace, detail: depth, depth_from: eye, near: 2, far: 8, tones: [(v: 0, stops: [(0, \"A03020\"), (1, \"20A0A0\")]), (v: 1, stops: [(0, \"FFFFFF\")])]",
    ),
];

/// Paints both surfaces of a scene, one with a picture.
pub fn paint(scene: &mut Scene, text: &str) {
    scene.mesh_layers = layers(text, &registry());
    let ways = [(0.3, 0.2), (-0.4, 0.9), (0.8, -0.2), (0.0, 1.0)];
    for (number, surface) in scene.surfaces.iter_mut().enumerate() {
        surface.paint = Some(SurfacePaint {
            layer: number as u32,
            normals: ways
                .map(|(x, y): (f32, f32)| Vec3::new(x, y, 0.7).normalize())
                .to_vec(),
            occlusion: match number {
                0 => vec![0.0, 0.3, 0.6, 1.0],
                _ => Vec::new(),
            },
        });
    }
    let texels: Vec<u16> = (0..8 * 8 * 4)
        .map(|i| {
            if i % 4 == 3 {
                65535
            } else {
                (i * 7919 % 251 * 261) as u16
            }
        })
        .collect();
    scene.surfaces[1].texture = Some(SurfaceTexture {
        image: Arc::new(Image::from_srgb([8, 8], &texels).unwrap()),
        repeats: true,
        places: [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]
            .map(Vec2::from)
            .to_vec(),
        coverage: Coverage::Ignored,
    });
}

#[test]
fn painted_meshes_agree() {
    let Some(mut card) = driver() else { return };
    let mut changed = 0;
    for (number, (effect, params)) in WAYS.into_iter().enumerate() {
        let mut scene = Scene::random(number as u32);
        let plain = on_cpu(&scene, 4);
        let through = [0.0, 0.6][number % 2];
        paint(&mut scene, &two(effect, params, through));
        for samples in [1, 4, 8] {
            let cpu = on_cpu(&scene, samples);
            let gpu = card.draw(&scene.frame(), samples).unwrap();
            let wrong = share_beyond(&cpu, &gpu, 2.0 / 255.0);
            // A sample that flips is all of a pixel with one of them.
            assert!(
                wrong <= 0.004,
                "{effect}, {params}, {samples} samples: {:.2} %",
                100.0 * wrong
            );
        }
        changed += usize::from(share_beyond(&on_cpu(&scene, 4), &plain, 0.02) > 0.05);
    }
    assert_eq!(changed, WAYS.len());
}

fn lines() -> Edges {
    Edges {
        channel: EdgeChannel::Object,
        threshold: 0.5,
        step_m: 0.05,
        width_px: Variation::constant(2.0),
        seed: 1,
        fade_to: 0.0,
        color: [0.1, 0.0, 0.2],
    }
}

/// With features and lines beside them, and without in the next frame.
#[test]
fn painted_meshes_come_and_go() {
    let Some(mut card) = driver() else { return };
    let mut scene = Scene::random(5);
    let before = card.draw(&scene.frame(), 4).unwrap();
    let (effect, params) = WAYS[2];
    for through in [0.0, 0.5, 0.0] {
        paint(&mut scene, &two(effect, params, through));
        for passes in [Vec::new(), vec![lines()]] {
            scene.passes = passes;
            scene.features = Features::of(&[Feature::Object, Feature::Color]);
            let gpu = card.draw(&scene.frame(), 4).unwrap();
            assert!(share_beyond(&on_cpu(&scene, 4), &gpu, 2.0 / 255.0) <= 0.004);
        }
    }
    let flat = Scene::random(5);
    assert!(card.draw(&flat.frame(), 4).unwrap() == before);
}

#[test]
fn once_warm_nothing_is_made_again() {
    let mut card = Offscreen::on(noop(wgpu::Limits::default())).unwrap();
    for (effect, params) in WAYS {
        let mut scene = Scene::random(3);
        paint(&mut scene, &two(effect, params, 0.5));
        card.draw(&scene.frame(), 4).unwrap();
        assert!(card.stats().made > 0);
        card.draw(&scene.frame(), 4).unwrap();
        assert_eq!(card.stats().made, 0);
    }
}
