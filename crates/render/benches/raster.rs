//! Time to draw three kinds of hair at 960 x 720, at 1, 4 and 16 samples a pixel, on two threads.

use criterion::{Criterion, criterion_group, criterion_main};
use glam::Vec2;
use render::cpu::Rasterizer;
use render::{Disc, Drawing, LayerStrokes, Order, Run, Stretches};
use std::hint::black_box;
use std::time::Duration;

const SIZE: [u32; 2] = [960, 720];
const THREADS: usize = 2;

/// A number from 0 to 1 that looks random.
fn hash(a: usize, b: usize) -> f32 {
    let mut bits = (a as u32).wrapping_mul(0x9e37_79b9) ^ (b as u32).wrapping_mul(0x85eb_ca6b);
    for _ in 0..3 {
        bits = (bits ^ (bits >> 15) ^ 0x2545_f491).wrapping_mul(0x2c1b_3c6d);
    }
    (bits >> 8) as f32 / (1 << 24) as f32
}

/// How the strands of a scene look.
struct Hair {
    strands: usize,
    joints: usize,
    /// From joint to joint, in pixels.
    step: f32,
    /// Of the clump where it is thickest, in pixels.
    radius: fn(usize) -> f32,
    /// Where strands begin: the corners of a box.
    roots: [Vec2; 2],
    /// Radius of the outline over the clump's, in pixels.
    outline: f32,
}

impl Hair {
    /// The clumps, one disc a joint, strand after strand: they fall, sway, and end in points.
    fn clump(&self) -> Vec<Disc> {
        let mut discs = Vec::new();
        for strand in 0..self.strands {
            let [low, high] = self.roots;
            let mut center = low + (high - low) * Vec2::new(hash(strand, 1), hash(strand, 2));
            let (tilt, sway) = (hash(strand, 3) - 0.5, hash(strand, 4) - 0.5);
            let (depth, towards) = (0.9 + 0.1 * hash(strand, 5), 0.1 * (hash(strand, 6) - 0.5));
            for joint in 0..self.joints {
                let u = joint as f32 / (self.joints - 1) as f32;
                let thickness = (4.0 * (1.0 - u)).min(1.0);
                let depth = depth + towards * u + 0.02 * (7.0 * u).sin();
                discs.push(Disc {
                    center,
                    radius: (self.radius)(strand) * thickness,
                    inv_depth: 1.0 / depth,
                    inv_depth_biased: 1.0 / (depth - 0.01 * thickness),
                });
                let angle = 1.2 * tilt + 1.6 * sway * (5.0 * u).sin();
                center += self.step * Vec2::new(angle.sin(), angle.cos());
            }
        }
        discs
    }

    /// The clumps with an outline (rank -1) and a base (rank 0).
    fn drawing(&self, base: impl Fn(usize) -> [f32; 3]) -> Drawing {
        let clump = self.clump();
        let outline = clump.iter().map(|disc| Disc {
            radius: disc.radius + self.outline.min(0.2 * disc.radius),
            inv_depth: 1.0 / (1.0 / disc.inv_depth + 0.01),
            ..*disc
        });
        Drawing {
            size: SIZE,
            sides: Vec::new(),
            side_stretches: Stretches::Everywhere,
            runs: (0..self.strands)
                .map(|strand| Run {
                    strand: strand as u32,
                    joints: strand * self.joints..(strand + 1) * self.joints,
                })
                .collect(),
            layers: vec![
                LayerStrokes {
                    name: "outline".into(),
                    joints: 0..clump.len(),
                    rank: -1,
                    instances: 1,
                    stretches: Stretches::Everywhere,
                    discs: outline.collect(),
                    colors: vec![[0.02, 0.0, 0.01]; clump.len()],
                },
                LayerStrokes {
                    name: "base".into(),
                    joints: 0..clump.len(),
                    rank: 0,
                    instances: 1,
                    stretches: Stretches::Everywhere,
                    discs: clump.clone(),
                    colors: (0..clump.len()).map(base).collect(),
                },
            ],
            clump,
            surfaces: Vec::new(),
            background: Some([1.0; 3]),
            order: Order::Rounded,
            edge_depth_m: 0.005,
            brush: render::Brush::Circle,
            ..Drawing::default()
        }
    }
}

const PONYTAIL: Hair = Hair {
    strands: 84,
    joints: 70,
    step: 4.0,
    radius: |strand| 12.0 + 8.0 * hash(strand, 7),
    roots: [Vec2::new(300.0, 60.0), Vec2::new(660.0, 300.0)],
    outline: 2.0,
};

const THIN: Hair = Hair {
    strands: 10_000,
    joints: 16,
    step: 12.0,
    radius: |strand| 0.8 + 0.6 * hash(strand, 7),
    roots: [Vec2::new(100.0, 20.0), Vec2::new(860.0, 500.0)],
    outline: 1.0,
};

/// 84 clumps of 69 segments, each in one colour.
fn flat() -> Drawing {
    PONYTAIL.drawing(|joint| {
        let strand = joint / PONYTAIL.joints;
        [hash(strand, 8), hash(strand, 9), hash(strand, 10)]
    })
}

/// The same, shaded along the strands, with 8 feathers of light.
fn shaded() -> Drawing {
    let mut drawing = PONYTAIL.drawing(|joint| [hash(joint, 8), 0.3, 0.2]);
    let discs = (0..8).flat_map(|feather| {
        let clump = drawing.clump.iter().enumerate();
        clump.map(move |(joint, disc)| {
            let wave = (0.3 * joint as f32 + feather as f32).sin();
            Disc {
                center: disc.center + Vec2::new((feather as f32 - 3.5) * 0.2 * disc.radius, 0.0),
                radius: (0.25 * disc.radius * wave).max(0.0),
                ..*disc
            }
        })
    });
    let feathers = LayerStrokes {
        name: "feathers".into(),
        joints: 0..drawing.clump.len(),
        rank: 100,
        instances: 8,
        stretches: Stretches::Everywhere,
        discs: discs.collect(),
        colors: vec![[1.0, 0.9, 0.8]; 8 * drawing.clump.len()],
    };
    drawing.layers.push(feathers);
    drawing
}

/// 10,000 strands of 15 segments.
fn thin() -> Drawing {
    THIN.drawing(|joint| {
        let strand = joint / THIN.joints;
        [hash(strand, 8), hash(strand, 9), hash(strand, 10)]
    })
}

fn raster(criterion: &mut Criterion) {
    let scenes = [("flat", flat()), ("shaded", shaded()), ("thin", thin())];
    for (name, drawing) in scenes {
        let mut group = criterion.benchmark_group(name);
        group
            .sample_size(10)
            .warm_up_time(Duration::from_millis(500));
        group.measurement_time(Duration::from_secs(2));
        for samples in [1, 4, 16] {
            let mut rasterizer = Rasterizer::new(samples, Some(THREADS)).unwrap();
            group.bench_function(format!("{samples}"), |bencher| {
                bencher.iter(|| black_box(rasterizer.draw(&drawing).unwrap()));
            });
        }
    }
}

criterion_group!(benches, raster);
criterion_main!(benches);
