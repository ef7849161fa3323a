//! Pictures on surfaces against those of the reference, which looks each sample up by itself and shares no code.

use effects::Image;
use glam::Vec2;
use render::cpu::Rasterizer;
use render::{Coverage, Drawing, Surface, SurfaceTexture, SurfaceVertex};
use std::sync::Arc;

/// A number from 0 to 1.
fn random(seed: u32, index: u32) -> f32 {
    effects::wgsl::random(seed, index)
}

/// A picture of random colours, some of its texels half covered.
fn picture(seed: u32, size: [usize; 2]) -> Arc<Image> {
    let count = (4 * size[0] * size[1]) as u32;
    let number = |i: u32| match i % 4 {
        3 if random(seed, i) < 0.7 => u16::MAX,
        _ => (65535.0 * random(seed, i)) as u16,
    };
    let texels: Vec<u16> = (0..count).map(number).collect();
    Arc::new(Image::from_srgb(size, &texels).unwrap())
}

/// A quadrilateral over most of the picture in strong perspective, as two triangles.
fn wall(seed: u32, coverage: Coverage, repeats: bool) -> Drawing {
    let corners = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(Vec2::from);
    let jitter = |i: u32| Vec2::new(random(seed, 3 * i), random(seed, 3 * i + 1)) * 24.0;
    let vertex = |(i, corner): (u32, &Vec2)| SurfaceVertex {
        position: *corner * 200.0 + 16.0 * (Vec2::ONE - 2.0 * *corner) + jitter(i),
        inv_depth: 0.4 + 2.0 * random(seed, 3 * i + 2),
        tone: 1.0,
    };
    Drawing {
        size: [224, 224],
        surfaces: vec![Surface {
            vertices: (0..).zip(&corners).map(vertex).collect(),
            triangles: vec![[0, 1, 2], [0, 2, 3]],
            light: [0.9, 1.0, 0.7],
            texture: Some(SurfaceTexture {
                image: picture(seed, [5, 4]),
                repeats,
                places: corners.map(|corner| 1.3 * corner - 0.1).to_vec(),
                coverage,
            }),
            ..Surface::default()
        }],
        background: Some([0.2, 0.3, 0.4]),
        ..Drawing::default()
    }
}

/// Pixels that differ by more than this much count as wrong: of a pixel's samples the rasteriser looks up the middle alone, and bends between
/// texels are cut short by that.
const BEYOND: f32 = 0.03;

#[test]
fn pictures_are_the_references() {
    for seed in 0..12 {
        let repeats = seed % 2 == 0;
        let coverage = match seed % 3 {
            0 => Coverage::Cut(0.6),
            _ => Coverage::Ignored,
        };
        let drawing = wall(seed, coverage, repeats);
        let exact = reference::picture(&drawing, 8);
        let drawn = Rasterizer::new(16, Some(2))
            .unwrap()
            .draw(&drawing)
            .unwrap();
        let difference = |(a, b): (&[f32; 4], &[f32; 4])| {
            let channels = a.iter().zip(b).map(|(a, b)| (a - b).abs());
            channels.fold(0.0, f32::max)
        };
        let differences: Vec<f32> = (drawn.pixels.iter().zip(&exact.pixels))
            .map(difference)
            .collect();
        let count = differences.len() as f32;
        let mean = differences.iter().sum::<f32>() / count;
        let wrong = differences.iter().filter(|d| **d > BEYOND).count() as f32 / count;
        // Along the outline and cut edges samples lie elsewhere: 16 to a pixel here, 64 there.
        assert!(mean < 0.003, "seed {seed}: {mean} in the mean");
        assert!(
            wrong < 0.02,
            "seed {seed}: {:.2} % of the pixels",
            100.0 * wrong
        );
    }
}
