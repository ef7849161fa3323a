//! The rasteriser held against the reference: sample for sample at its own sample positions, and
//! at many samples against the regular grid.

#![allow(clippy::print_stderr, reason = "what is skipped is said")]

mod scenes;

use bench::{compare, oracle};
use glam::{DVec2, Vec2};
use proptest::collection::vec;
use proptest::prelude::*;
use proptest::test_runner::TestRunner;
use render::cpu::Rasterizer;
use render::gpu::{AdapterKind, GpuError, Offscreen};
use render::{Brush, Disc, Drawing, LayerStrokes, Order, Picture, Run, Surface, SurfaceVertex};
use std::cell::RefCell;

/// The rasteriser works in f32: a colour may differ by this much. Positions of some hundred pixels
/// have 3e-5 px, which is some thousandths of the radius of a thin stroke.
const COLOR_TOLERANCE: f32 = 4e-3;

fn rasterise(drawing: &Drawing, samples: u32, threads: usize) -> Picture {
    Rasterizer::new(samples, Some(threads))
        .unwrap()
        .draw(drawing)
        .unwrap()
}

fn positions(samples: u32) -> Vec<DVec2> {
    let positions = render::sample_positions(samples).unwrap();
    positions.iter().map(|p| p.as_dvec2()).collect()
}

/// The pixels that differ, which needs a sample that shows something else.
fn different(picture: &Picture, reference: &Picture) -> Vec<usize> {
    assert_eq!(
        (picture.width, picture.height),
        (reference.width, reference.height)
    );
    assert_eq!(picture.pixels.len(), reference.pixels.len());
    let differs = |index: &usize| {
        let channels = picture.pixels[*index].iter().zip(&reference.pixels[*index]);
        !channels
            .into_iter()
            .all(|(a, b)| (a - b).abs() <= COLOR_TOLERANCE)
    };
    (0..picture.pixels.len()).filter(differs).collect()
}

/// The number of pixels of a drawing that differ from the reference, and the first, where single precision is no reason: a pixel whose reference
/// is another one for samples a few thousandths of a pixel away, or for strands that are nearer and farther by a
/// millionth, lies at a border, or where depths are equal.
fn wrong(picture: &Picture, drawing: &Drawing, samples: u32) -> (usize, Option<[usize; 2]>) {
    let positions = positions(samples);
    let reference = oracle::picture_at(drawing, &positions);
    let mut wrong = different(picture, &reference);
    if !wrong.is_empty() {
        let moved = [DVec2::X, DVec2::Y, -DVec2::X, -DVec2::Y].map(|way| {
            let positions: Vec<DVec2> = positions.iter().map(|p| *p + way * 4e-3).collect();
            oracle::picture_at(drawing, &positions)
        });
        let nudged = [1e-6, -1e-6].map(|by| oracle::picture_at(&nudged(drawing, by), &positions));
        for other in moved.iter().chain(&nudged) {
            let unsure = different(other, &reference);
            wrong.retain(|index| unsure.binary_search(index).is_err());
        }
    }
    let width = picture.width as usize;
    let first = wrong.first().map(|index| [index % width, index / width]);
    (wrong.len(), first)
}

/// Every run's strokes nearer than the run's before by a share of their depth, so that no two are at the same.
fn nudged(drawing: &Drawing, by: f32) -> Drawing {
    let mut nudged = drawing.clone();
    let joints = nudged.clump.len();
    for (i, run) in drawing.runs.iter().enumerate() {
        let nearer = 1.0 + by * (i + 1) as f32;
        for joint in run.joints.clone() {
            let lists = std::iter::once(&mut nudged.clump)
                .chain(std::iter::once(&mut nudged.sides))
                .chain(nudged.layers.iter_mut().map(|layer| &mut layer.discs));
            for list in lists {
                for disc in list.iter_mut().skip(joint).step_by(joints) {
                    disc.inv_depth *= nearer;
                    disc.inv_depth_biased *= nearer;
                }
            }
        }
    }
    nudged
}

fn disc_around(extent: f32) -> impl Strategy<Value = Disc> {
    let coordinate =
        move || prop_oneof![8 => -6.0..extent + 6.0, 1 => -300.0..300.0f32, 1 => -3e4..3e4f32];
    let radius =
        prop_oneof![2 => Just(0.0f32), 4 => 0.0..1.0f32, 4 => 1.0..12.0f32, 1 => 12.0..80.0f32];
    let depth = || prop_oneof![Just(1.0f32), Just(2.0f32), 0.5..3.0f32];
    (coordinate(), coordinate(), radius, depth(), depth()).prop_map(
        |(x, y, radius, inv_depth, inv_depth_biased)| Disc {
            center: Vec2::new(x, y),
            radius,
            inv_depth,
            inv_depth_biased,
        },
    )
}

/// Discs of consecutive joints: unrelated, at one place (a strand that points at the eye), or in
/// small steps.
fn path(extent: f32, joints: usize) -> impl Strategy<Value = Vec<Disc>> {
    let step = prop_oneof![
        2 => Just(f32::NAN),
        1 => Just(0.0f32),
        1 => Just(0.02f32),
        2 => Just(0.2f32),
    ];
    (vec(disc_around(extent), joints), step).prop_map(|(mut discs, step)| {
        if !step.is_nan() {
            for joint in 1..discs.len() {
                let before = discs[joint - 1].center;
                discs[joint].center = before + step * (discs[joint].center - before);
            }
        }
        discs
    })
}

fn color() -> impl Strategy<Value = [f32; 3]> {
    prop::array::uniform3(0.0..1.0f32)
}

fn surface(extent: f32) -> impl Strategy<Value = Surface> {
    let coordinate = || -10.0..extent + 10.0;
    let vertex = (coordinate(), coordinate(), 0.5..3.0f32, -1.0..1.0f32).prop_map(
        |(x, y, inv_depth, tone)| SurfaceVertex {
            position: Vec2::new(x, y),
            inv_depth,
            tone,
        },
    );
    (
        vec(vertex, 4),
        vec(prop::array::uniform3(0..4u32), 0..4),
        prop_oneof![Just(0.0), 0.01..0.5f32, -0.2..-0.01f32],
        color(),
        color(),
    )
        .prop_map(|(vertices, triangles, margin_m, light, shadow)| Surface {
            margin_m,
            vertices,
            triangles,
            light,
            shadow,
        })
}

/// A layer over `clump`: its discs follow the clump's, or are anywhere.
fn layer(extent: f32, clump: Vec<Disc>) -> impl Strategy<Value = LayerStrokes> {
    (-2..3i32, 0..3usize, any::<bool>()).prop_flat_map(move |(rank, instances, follows)| {
        let clump = clump.clone();
        let number = clump.len() * instances;
        (
            path(extent, number),
            vec(color(), number),
            prop::array::uniform3(-1.0..1.0f32),
        )
            .prop_map(move |(mut discs, colors, [x, y, z])| {
                if follows {
                    for (index, disc) in discs.iter_mut().enumerate() {
                        let joint = clump[index % clump.len()];
                        disc.center = joint.center + Vec2::new(x, y);
                        disc.radius = joint.radius * (1.0 + 0.5 * z);
                        disc.inv_depth = joint.inv_depth - 0.1 * z;
                        disc.inv_depth_biased = joint.inv_depth_biased - 0.1 * z;
                    }
                }
                LayerStrokes {
                    name: String::new(),
                    rank,
                    instances,
                    discs,
                    colors,
                }
            })
    })
}

/// Everything a drawing may hold, small.
fn drawing() -> impl Strategy<Value = Drawing> {
    let extent = 40.0;
    // For each strand the numbers of joints of its runs.
    let strands = vec(vec(1..5usize, 1..3), 1..5);
    let clump = strands.prop_flat_map(move |strands| {
        let joints = strands.iter().flatten().sum();
        (Just(strands), path(extent, joints))
    });
    let strokes = clump.prop_flat_map(move |(strands, clump)| {
        (
            Just(strands),
            Just(clump.clone()),
            vec(layer(extent, clump), 1..5),
        )
    });
    let order = prop_oneof![
        (0.0..0.5f32).prop_map(|depth_m| (Order::Rounded, depth_m)),
        (0.0..0.5f32).prop_map(|depth_m| (Order::Scattered, depth_m)),
        Just((Order::StrandFirst, 0.0)),
        Just((Order::Shifted, 0.0)),
    ];
    let brush = prop_oneof![Just(Brush::Circle), Just(Brush::Semicircle)];
    let background = prop::option::of(color());
    (
        strokes,
        vec(surface(extent), 0..3),
        (order, brush, any::<bool>()),
        background,
        30..40u32,
        30..40u32,
    )
        .prop_map(
            |(
                (strands, mut clump, mut layers),
                surfaces,
                ((order, edge_depth_m), brush, has_sides),
                background,
                width,
                height,
            )| {
                let mut runs = Vec::new();
                let mut start = 0;
                for (index, pieces) in (0..).zip(strands) {
                    for joints in pieces {
                        runs.push(Run {
                            strand: 3 * index,
                            joints: start..start + joints,
                        });
                        start += joints;
                    }
                }
                for (index, layer) in layers.iter_mut().enumerate() {
                    layer.name = format!("layer {index}");
                }
                if order == Order::Rounded {
                    // Strands of equal depth are told apart by r^8 alone, which f32 takes for 0 near
                    // their middles.
                    let joints = clump.len();
                    let strand_of = |joint: usize| {
                        let run = runs.iter().find(|run: &&Run| run.joints.contains(&joint));
                        run.map_or(0, |run| run.strand)
                    };
                    let discs = layers.iter_mut().flat_map(|layer| &mut layer.discs);
                    for (index, disc) in clump.iter_mut().enumerate().chain(discs.enumerate()) {
                        disc.inv_depth += 1e-3 * strand_of(index % joints) as f32;
                    }
                }
                let beside = |side: f32| {
                    clump.iter().map(move |disc| Disc {
                        center: disc.center + side * Vec2::new(4.0, 3.0),
                        radius: 0.6 * disc.radius,
                        ..*disc
                    })
                };
                let sides = if has_sides {
                    beside(-1.0).chain(beside(1.0)).collect()
                } else {
                    Vec::new()
                };
                Drawing {
                    size: [width, height],
                    runs,
                    clump,
                    sides,
                    layers,
                    surfaces,
                    background,
                    order,
                    edge_depth_m,
                    brush,
                }
            },
        )
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    /// A sample may differ only where it lies within rounding of a border of a stroke, or where two depths are equal.
    #[test]
    fn small_drawings_agree_sample_for_sample(drawing in drawing(), samples in prop_oneof![Just(1u32), Just(4), Just(16)]) {
        let picture = rasterise(&drawing, samples, 2);
        let (number, first) = wrong(&picture, &drawing, samples);
        prop_assert!(number <= 3, "{number} pixels differ, {first:?} first");
    }
}

/// The same on a graphics card, whose single precision sees a segment from its tile, and far discs from farther away.
#[test]
fn small_drawings_agree_on_a_graphics_card() {
    let card = match Offscreen::open(AdapterKind::Any) {
        Ok(card) => RefCell::new(card),
        Err(GpuError::NoAdapter { .. }) if std::env::var_os("CI").is_none_or(|ci| ci != "true") => {
            eprintln!("SKIPPED: no driver for a graphics card; `cargo xtask setup` installs one");
            return;
        }
        Err(error) => panic!("{error}"),
    };
    let config = ProptestConfig {
        cases: 150,
        failure_persistence: None,
        ..ProptestConfig::default()
    };
    let samples = prop_oneof![Just(1u32), Just(4)];
    let found = TestRunner::new(config).run(&(drawing(), samples), |(drawing, samples)| {
        let picture = card.borrow_mut().draw_strokes(&drawing, samples).unwrap();
        let (number, first) = wrong(&picture, &drawing, samples);
        prop_assert!(number <= 3, "{number} pixels differ, {first:?} first");
        Ok(())
    });
    if let Err(error) = found {
        panic!("{error}");
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
            rank: 0,
            instances: 1,
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
            ..scenes::portrait([480, 360], order)
        };
        for samples in [1, 4, 16] {
            let picture = rasterise(&drawing, samples, 2);
            let reference = oracle::picture_at(&drawing, &positions(samples));
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
    let mut drawing = scenes::portrait([240, 180], Order::Rounded);
    let reference = oracle::picture(&drawing, 16);
    let alone = scenes::strokes_alone(&drawing);
    let ink = oracle::picture(&alone, 16);
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
    let error = compare::error(&picture, &oracle::picture(&drawing, 16), &mask).unwrap();
    assert!(error.mean < 0.0035, "{error:?}");
    // And a picture that should fail does.
    let error = compare::error(&picture, &reference, &mask).unwrap();
    assert!(error.mean > 0.005, "{error:?}");
}
