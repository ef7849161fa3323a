//! Stamping held against the reference: a stamped stroke is a drawing of many discs.

use crate::portrait::{portrait, strokes_alone};
use glam::DVec2;
use render::cpu::{Rasterizer, Stamper};
use render::{Brush, Disc, Drawing, LayerStrokes, Order, Run, Stretches};

/// The stamps of a drawing as a drawing: each is a strand of one joint, so that the disc in front
/// gives the colour. A stamp stands at each joint, the others at equal steps between two.
fn stamped(drawing: &Drawing, per_interval: usize) -> Drawing {
    let per_interval = per_interval.max(1);
    // Pairs of joints, and how far from the first to the second.
    let mut places = Vec::new();
    for run in &drawing.runs {
        for joint in run.joints.start..run.joints.end - 1 {
            let steps = 0..per_interval;
            places.extend(steps.map(|step| (joint, step as f32 / per_interval as f32)));
        }
        places.push((run.joints.end - 1, 0.0));
    }
    let joints = drawing.clump.len();
    let disc = |discs: &[Disc], (joint, way): (usize, f32)| {
        let (a, b) = (discs[joint], discs[(joint + 1).min(joints - 1)]);
        let mix = |a: f32, b: f32| a + way * (b - a);
        Disc {
            center: a.center + way * (b.center - a.center),
            radius: mix(a.radius, b.radius).max(0.0),
            inv_depth: mix(a.inv_depth, b.inv_depth),
            inv_depth_biased: mix(a.inv_depth_biased, b.inv_depth_biased),
        }
    };
    let color = |colors: &[[f32; 3]], (joint, way): (usize, f32)| {
        let (a, b) = (colors[joint], colors[(joint + 1).min(joints - 1)]);
        [0, 1, 2].map(|i| a[i] + way * (b[i] - a[i]))
    };
    let layers = drawing.layers.iter().map(|layer| {
        let instances = || (0..layer.instances).map(|i| i * joints..(i + 1) * joints);
        let discs = instances().flat_map(|of| {
            let discs = &layer.discs[of];
            places.iter().map(move |place| disc(discs, *place))
        });
        let colors = instances().flat_map(|of| {
            let colors = &layer.colors[of];
            places.iter().map(move |place| color(colors, *place))
        });
        LayerStrokes {
            name: layer.name.clone(),
            joints: 0..places.len(),
            rank: layer.rank,
            instances: layer.instances,
            stretches: Stretches::Everywhere,
            discs: discs.collect(),
            colors: colors.collect(),
        }
    });
    Drawing {
        size: drawing.size,
        layers: layers.collect(),
        runs: (0..places.len())
            .map(|stamp| Run {
                strand: stamp as u32,
                joints: stamp..stamp + 1,
            })
            .collect(),
        clump: places
            .iter()
            .map(|place| disc(&drawing.clump, *place))
            .collect(),
        surfaces: drawing.surfaces.clone(),
        background: drawing.background,
        order: Order::Shifted,
        edge_depth_m: 0.0,
        brush: Brush::Circle,
        ..Drawing::default()
    }
}

/// Sample for sample but for rounding at the very borders of discs.
#[test]
fn stamping_draws_the_union_of_its_stamps() {
    for (samples, per_interval) in [(1, 1), (4, 3), (8, 1)] {
        let drawing = Drawing {
            background: Some([0.2, 0.4, 0.8]),
            ..strokes_alone(&portrait([150, 110], Order::Shifted))
        };
        let picture = Stamper::new(samples, Some(2))
            .unwrap()
            .draw(&drawing, per_interval)
            .unwrap();
        let positions = render::sample_positions(samples).unwrap();
        let positions: Vec<DVec2> = positions.iter().map(|p| p.as_dvec2()).collect();
        let reference = reference::picture_at(&stamped(&drawing, per_interval), &positions);
        let pixels = picture.pixels.iter().zip(&reference.pixels);
        let different = pixels.filter(|(a, b)| (0..4).any(|i| (a[i] - b[i]).abs() > 4e-3));
        let different = different.count();
        assert!(
            different <= 3,
            "{different} pixels differ at {samples} samples"
        );
    }
}

/// Half discs, stamped ever more densely, tend to what the exact rasteriser draws between them.
#[test]
fn stamps_of_half_discs_fill_the_half_discs_stroke() {
    let mut drawing = Drawing {
        brush: Brush::Semicircle,
        ..strokes_alone(&portrait([150, 110], Order::Shifted))
    };
    // Ends that are no points.
    let discs = drawing.layers.iter_mut().flat_map(|layer| &mut layer.discs);
    discs.for_each(|disc| disc.radius += 2.0);
    let exact = Rasterizer::new(4, Some(2)).unwrap().draw(&drawing).unwrap();
    let error = |brush, per_interval| {
        let drawing = Drawing {
            brush,
            ..drawing.clone()
        };
        let stamped = Stamper::new(4, Some(2))
            .unwrap()
            .draw(&drawing, per_interval)
            .unwrap();
        let pixels = stamped.pixels.iter().zip(&exact.pixels);
        let alpha: f32 = pixels.map(|(a, b)| (a[3] - b[3]).abs()).sum();
        alpha / exact.pixels.iter().map(|pixel| pixel[3]).sum::<f32>()
    };
    let [coarse, fine] = [2, 64].map(|stamps| error(Brush::Semicircle, stamps));
    assert!(fine < 0.25 * coarse && fine < 0.003, "{coarse} {fine}");
    let whole = error(Brush::Circle, 64);
    assert!(whole > 4.0 * fine, "whole discs: {whole}");
}

#[test]
fn threads_do_not_change_a_bit() {
    let drawing = strokes_alone(&portrait([150, 110], Order::Shifted));
    let draw = |threads| {
        Stamper::new(4, Some(threads))
            .unwrap()
            .draw(&drawing, 5)
            .unwrap()
    };
    let one = draw(1);
    assert!(one.pixels.iter().any(|pixel| pixel[3] > 0.0));
    assert_eq!(one.pixels, draw(3).pixels);
}
