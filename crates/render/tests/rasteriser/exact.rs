//! The CPU's exact rasteriser: sample for sample at its own sample positions, and at many samples against the regular
//! grid.

use crate::agreement::{different, positions, wrong};
use crate::drawings::drawing;
use crate::portrait::{portrait, strokes_alone};
use glam::{DVec2, Vec2};
use proptest::prelude::*;
use reference::compare;
use render::cpu::Rasterizer;
use render::{Brush, Disc, Drawing, LayerStrokes, Order, Picture, Run, Stretches};

fn rasterise(drawing: &Drawing, samples: u32, threads: usize) -> Picture {
    Rasterizer::new(samples, Some(threads))
        .unwrap()
        .draw(drawing)
        .unwrap()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    /// A sample may differ only where it lies within rounding of a border of a stroke, or where two depths are equal.
    #[test]
    fn small_drawings_agree_sample_for_sample(drawing in drawing(), samples in prop::sample::select(vec![1, 2, 3, 4, 5, 16])) {
        let picture = rasterise(&drawing, samples, 2);
        let (number, first) = wrong(&picture, &drawing, samples);
        prop_assert!(number <= 3, "{number} pixels differ, {first:?} first");
    }
}

#[test]
fn radius_zero_draws_nothing_even_at_a_sample() {
    let joint = |x| Disc {
        center: Vec2::new(x, 4.5),
        radius: 0.0,
        inv_depth: 1.0,
        inv_depth_biased: 1.0,
    };
    let discs = vec![joint(1.5), joint(4.5), joint(4.5)];
    let drawing = Drawing {
        size: [8, 8],
        runs: vec![
            Run {
                strand: 0,
                joints: 0..2,
            },
            Run {
                strand: 0,
                joints: 2..3,
            },
        ],
        clump: discs
            .iter()
            .map(|disc| Disc {
                radius: 3.0,
                ..*disc
            })
            .collect(),
        layers: vec![LayerStrokes {
            name: "thread".to_owned(),
            joints: 0..discs.len(),
            rank: 0,
            instances: 1,
            stretches: Stretches::Everywhere,
            colors: vec![[1.0; 3]; discs.len()],
            discs,
        }],
        ..Drawing::default()
    };
    assert_eq!(positions(1), [DVec2::splat(0.5)]);
    assert!(
        rasterise(&drawing, 1, 1)
            .pixels
            .iter()
            .all(|pixel| *pixel == [0.0; 4])
    );
}

#[test]
fn portraits_agree_sample_for_sample() {
    let orders = Order::ALL;
    let brushes = [Brush::Circle, Brush::Semicircle];
    for (order, brush) in orders
        .into_iter()
        .flat_map(|order| brushes.map(|brush| (order, brush)))
    {
        let drawing = Drawing {
            brush,
            ..portrait([320, 240], order)
        };
        for samples in [1, 4, 16] {
            let picture = rasterise(&drawing, samples, 2);
            let reference = reference::picture_at(&drawing, &positions(samples));
            let wrong = different(&picture, &reference);
            // None did; two leave room for another order of the same f32 arithmetic.
            assert!(
                wrong.len() <= 2,
                "{order:?}, {brush:?}, {samples} samples: {wrong:?}"
            );
        }
    }
}

#[test]
fn many_samples_come_to_the_regular_grid() {
    let mut drawing = portrait([240, 180], Order::Rounded);
    let reference = reference::picture(&drawing, 16);
    let alone = strokes_alone(&drawing);
    let ink = reference::picture(&alone, 16);
    let mask = compare::mask(&ink);
    let error = compare::error(&rasterise(&alone, 256, 2), &ink, &mask).unwrap();
    assert!(
        error.mean < 0.005 && (error.ink_ratio - 1.0).abs() < 1e-3,
        "{error:?}"
    );
    let mut before = f64::INFINITY;
    for (samples, limit) in [(4, 0.05), (16, 0.018), (64, 0.008), (256, 0.0035)] {
        let error = compare::error(&rasterise(&drawing, samples, 2), &reference, &mask).unwrap();
        assert!(
            error.mean < limit && error.mean < before,
            "{samples} samples: {error:?}"
        );
        before = error.mean;
    }
    drawing.order = Order::Shifted;
    let picture = rasterise(&drawing, 256, 2);
    let error = compare::error(&picture, &reference::picture(&drawing, 16), &mask).unwrap();
    assert!(error.mean < 0.0035, "{error:?}");
    // And a picture that should fail does.
    let error = compare::error(&picture, &reference, &mask).unwrap();
    assert!(error.mean > 0.005, "{error:?}");
}
