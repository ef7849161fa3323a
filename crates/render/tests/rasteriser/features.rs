//! What samples tell, held against the reference sample for sample.

use crate::agreement::{nudged, positions};
use crate::drawings::drawing;
use crate::portrait::portrait;
use glam::{DVec2, Vec3};
use proptest::prelude::*;
use render::cpu::Rasterizer;
use render::{
    Brush, Drawing, DrawnFeatures, Feature, Features, Order, Picture, RunInfo, Sample, SamplePlanes,
};
use stroke_path::{Camera, OrbitView};

fn all() -> Features {
    Features::of(Feature::ALL)
}

/// Numbers from -1 to 1 that are the same in every run.
fn numbers(count: usize, seed: u32) -> impl Iterator<Item = f32> {
    (0..count as u32).map(move |i| 2.0 * effects::wgsl::random(i, seed) - 1.0)
}

fn vectors(count: usize, seed: u32) -> Vec<Vec3> {
    let axes = [0, 1, 2].map(|axis| numbers(count, 3 * seed + axis).collect::<Vec<_>>());
    (0..count)
        .map(|i| Vec3::from([0, 1, 2].map(|axis: usize| axes[axis][i])))
        .collect()
}

/// The drawing with something to tell of everything.
fn telling(drawing: Drawing, declared: Features) -> Drawing {
    let joints = drawing.clump.len();
    let view = OrbitView {
        target: Vec3::ZERO,
        yaw_degrees: 25.0,
        pitch_degrees: -8.0,
        distance_m: 2.0,
        vertical_fov_degrees: 30.0,
    };
    let unit = |v: Vec3| v.normalize_or(Vec3::Y);
    let runs = (0..drawing.runs.len() as u32).map(|run| RunInfo {
        object: run % 2,
        strand: 70_000 + 3 * run,
        level: run % 3,
    });
    let features = DrawnFeatures {
        declared,
        runs: runs.collect(),
        u: numbers(joints, 50).map(f32::abs).collect(),
        s: numbers(joints, 51).map(|s| 2.0 + s).collect(),
        pixels: numbers(joints, 52).map(|p| 400.0 + 50.0 * p).collect(),
        position: vectors(joints, 20),
        forward: vectors(joints, 21).into_iter().map(unit).collect(),
        normal: vectors(joints, 22).into_iter().map(unit).collect(),
        roundness: 0.6,
        camera: Camera::orbit(view, drawing.size, 0.05).ok(),
    };
    Drawing {
        features,
        ..drawing
    }
}

/// All samples of the drawing, those of one place in their pixels after the other.
fn samples(drawing: &Drawing, count: u32, threads: usize) -> Vec<Vec<Sample>> {
    let [width, height] = drawing.size.map(|side| side as usize);
    let mut told = Vec::new();
    Rasterizer::new(count, Some(threads))
        .unwrap()
        .draw_samples(drawing, &mut SamplePlanes::default(), |planes| {
            assert_eq!(planes.samples().start, told.len());
            for picture in 0..planes.samples().len() {
                let of_row = |y| (0..width).map(move |x| (x, y));
                let places = (0..height).flat_map(of_row);
                told.push(places.map(|(x, y)| planes.sample(picture, x, y)).collect());
            }
        })
        .unwrap();
    assert_eq!(told.len(), count as usize);
    told
}

/// How strictly samples are compared.
#[derive(Clone, Copy, PartialEq)]
enum Sides {
    /// Places across count with their signs.
    Count,
    /// Without them, and without normals: where a strand turns back in one joint, both its segments are as near to what lies beyond, which
    /// is to the left of the one and to the right of the other.
    AreOpen,
}

/// Whether both tell the same but for single precision.
fn agree(a: &Sample, b: &Sample, sides: Sides) -> bool {
    let is_near = |feature: Feature, component: usize| {
        let (a, b) = (a.number(feature, component), b.number(feature, component));
        let reach = match feature {
            Feature::Pixels => 1.0,
            Feature::Normal if sides == Sides::AreOpen => return true,
            Feature::V | Feature::W if sides == Sides::AreOpen => {
                return (a.abs() - b.abs()).abs() <= 0.01;
            }
            _ => 0.01,
        };
        (a - b).abs() <= reach
    };
    Feature::ALL.iter().all(|&feature| match feature.is_id() {
        true => a.id(feature) == b.id(feature),
        false => (0..feature.components()).all(|component| is_near(feature, component)),
    })
}

/// How many samples tell something else than the reference where single precision is no reason, and the first of them. A sample whose
/// reference is another one some thousandths of a pixel away lies at a border.
fn wrong(drawing: &Drawing, count: u32, sides: Sides) -> (usize, Option<(Sample, Sample)>) {
    let told = samples(drawing, count, 2);
    let mut wrong = Vec::new();
    for (sample, (told, position)) in (0..).zip(told.iter().zip(positions(count))) {
        let reach = render::shown_reach(sample, count);
        let reference = reference::samples_at(drawing, position, reach);
        let differs = |i: &usize| !agree(&told[*i], &reference[*i], sides);
        let mut different: Vec<usize> = (0..told.len()).filter(differs).collect();
        if !different.is_empty() {
            let moved = [DVec2::X, DVec2::Y, -DVec2::X, -DVec2::Y]
                .map(|way| reference::samples_at(drawing, position + way * 4e-3, reach));
            let nudged = [1e-6, -1e-6]
                .map(|by| reference::samples_at(&nudged(drawing, by), position, reach));
            for other in moved.iter().chain(&nudged) {
                different.retain(|i| agree(&other[*i], &reference[*i], sides));
            }
        }
        wrong.extend(different.iter().map(|i| (told[*i], reference[*i])));
    }
    (wrong.len(), wrong.first().copied())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 120, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn small_drawings_tell_what_they_show(drawing in drawing(), count in prop::sample::select(vec![1, 2, 3, 4, 5])) {
        let (number, first) = wrong(&telling(drawing, all()), count, Sides::AreOpen);
        prop_assert!(number <= 6, "{number} samples differ, first {first:?}");
    }
}

#[test]
fn portraits_tell_what_they_show() {
    for order in Order::ALL {
        for brush in [Brush::Circle, Brush::Semicircle] {
            let drawing = telling(portrait([100, 75], order), all());
            let drawing = Drawing { brush, ..drawing };
            let (number, first) = wrong(&drawing, 1, Sides::Count);
            assert!(
                number <= 8,
                "{order:?}, {brush:?}: {number}, first {first:?}"
            );
        }
    }
}

/// The means of the samples are the picture, to the bit.
#[test]
fn samples_are_those_of_the_picture() {
    for count in [1, 2, 4, 7] {
        let drawing = telling(
            portrait([100, 77], Order::Rounded),
            Features::of(&[Feature::Color]),
        );
        let told = samples(&drawing, count, 2);
        let pixels = (0..100 * 77).map(|i| {
            let colors = told.iter().map(|samples| samples[i].color);
            let sum = colors.fold([0.0; 4], |sum: [f32; 4], color| {
                [0, 1, 2, 3].map(|channel| sum[channel] + color[channel])
            });
            sum.map(|sum| sum / count as f32)
        });
        let mean = Picture {
            width: 100,
            height: 77,
            pixels: pixels.collect(),
        };
        let picture = Rasterizer::new(count, Some(1)).unwrap().draw(&drawing);
        assert!(picture.unwrap() == mean, "{count} samples");
    }
}

#[test]
fn what_is_not_declared_is_not_told() {
    let declared = Features::of(&[Feature::Strand, Feature::V]);
    let drawing = telling(portrait([64, 48], Order::Rounded), declared);
    let all = telling(portrait([64, 48], Order::Rounded), all());
    let (some, all) = (samples(&drawing, 1, 1), samples(&all, 1, 1));
    let mut hair = 0;
    for (some, all) in some[0].iter().zip(&all[0]) {
        let expected = Sample {
            object: all.object,
            strand: all.strand,
            inv_depth: all.inv_depth,
            v: all.v,
            ..Sample::NOTHING
        };
        assert_eq!(*some, expected);
        hair += usize::from(all.v != 0.0);
    }
    assert!(hair > 200, "{hair}");
}

#[test]
fn lists_of_another_length_are_refused() {
    let mut drawing = telling(portrait([64, 48], Order::Rounded), all());
    drawing.features.u.pop();
    let draw = |drawing: &Drawing| {
        let mut rasterizer = Rasterizer::new(1, Some(1)).unwrap();
        rasterizer.draw_samples(drawing, &mut SamplePlanes::default(), |_| {})
    };
    let error = draw(&drawing).unwrap_err().to_string();
    assert!(error.contains("the list `u`"), "{error}");
    drawing.features.declared = Features::of(&[Feature::S]);
    draw(&drawing).unwrap();
    drawing.features.runs.pop();
    let error = draw(&drawing).unwrap_err().to_string();
    assert!(error.contains("the list `runs`"), "{error}");
}
