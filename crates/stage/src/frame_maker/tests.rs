//! What is left out of a frame changes no picture, and what a frame is made of is known.

use super::*;
use crate::{Files, HairModel, Hand, HeadModel, Preset, Sections};
use effects::Registry;
use hair_sim::Strands;
use proptest::prelude::*;
use render::Drawing;
use render::cpu::{Evaluator, Rasterizer};
use std::path::Path;

/// A yardstick's scene, in a small picture.
fn yardstick(name: &str) -> Scene {
    yardstick_of(name, [96, 72])
}

/// A yardstick's scene, in a picture of that size in pixels.
fn yardstick_of(name: &str, size: [u32; 2]) -> Scene {
    with_yardstick(name, size, |preset, files| {
        Scene::load(preset, files).unwrap()
    })
}

fn with_yardstick(
    name: &str,
    size: [u32; 2],
    make: impl FnOnce(&mut Preset, &Files) -> Scene,
) -> Scene {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/yardsticks");
    let text = std::fs::read_to_string(folder.join(name).with_extension("ron")).unwrap();
    let mut registry = Registry::new();
    effects_builtin::register(&mut registry).unwrap();
    let mut preset = Preset::parse(name, &text, &registry).unwrap();
    preset.sections.scene.size = size;
    let files = Files {
        preset_folder: folder,
        ..Files::default()
    };
    make(&mut preset, &files)
}

/// Fine hairs of no width have no paths, and leave the picture its bits.
#[test]
fn layers_of_no_width_are_left_out() {
    let with_fine = |width: Option<&str>| {
        with_yardstick("blond-fantasy", [96, 72], |preset, files| {
            let fine = |layer: &effects::preset::LayerSpec| layer.name == "hair.fine";
            match width {
                Some(width) => {
                    let mut layers = preset.layers.iter_mut();
                    let layer = layers.find(|layer| fine(layer)).unwrap();
                    layer.set("width", width).unwrap();
                }
                None => preset.layers.retain(|layer| !fine(layer)),
            }
            Scene::load(preset, files).unwrap()
        })
    };
    let of = |width| {
        let mut frames = FrameMaker::new();
        let frame = frames
            .frame(&with_fine(width), &Motion::new())
            .map(|frame| {
                let joints = frame.paths.len();
                (joints, picture(&frame, Evaluator::default()))
            });
        frame.unwrap()
    };
    let without = of(None);
    assert!(of(Some("1")).0 > without.0);
    assert!(of(Some("0")) == without);
}

/// The pixels' bits, and how many strands have joints.
fn picture(frame: &Frame, evaluator: Evaluator) -> (Vec<[u32; 4]>, usize) {
    picture_of(frame, evaluator, 2)
}

/// The same with so many samples in each pixel.
fn picture_of(frame: &Frame, mut evaluator: Evaluator, samples: u32) -> (Vec<[u32; 4]>, usize) {
    let mut drawing = Drawing::default();
    evaluator.evaluate(frame, &mut drawing).unwrap();
    let mut rasterizer = Rasterizer::new(samples, None).unwrap();
    let picture = rasterizer.draw(&drawing).unwrap();
    let bits = picture.pixels.iter().map(|pixel| pixel.map(f32::to_bits));
    let strands = frame.paths.runs.chunk_by(|a, b| a.strand == b.strand);
    (bits.collect(), strands.count())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]

    /// From near the hair and from far away, beside it and within it.
    #[test]
    fn strands_that_nobody_sees_leave_no_trace(
        look in prop::sample::select(vec!["twin-tails", "blond-fantasy", "flat-tails-red"]),
        yaw in -180.0_f32..180.0, pitch in -60.0_f32..60.0, distance in 0.1_f32..4.0,
        x in -1.5_f32..1.5, y in -1.5_f32..1.5, fov in 15.0_f32..120.0,
    ) {
        let mut scene = yardstick(look);
        let camera = &mut scene.camera;
        (camera.yaw, camera.pitch, camera.distance, camera.fov) = (yaw, pitch, distance, fov);
        (camera.target[0], camera.target[1]) = (x, y);
        let motion = Motion::new();
        let mut all = FrameMaker { keeps_unseen: true, ..FrameMaker::new() };
        let mut seen = FrameMaker::new();
        let (expected, every) = picture(&all.frame(&scene, &motion).unwrap(), Evaluator::everywhere());
        let (found, some) = picture(&seen.frame(&scene, &motion).unwrap(), Evaluator::default());
        prop_assert!(some <= every);
        prop_assert!(found == expected);
        prop_assert_eq!(all.culled(), seen.culled());
    }
}

/// A strand whose root the head hides passes before the face, and over its own root there: what a sample shows of a strand is of both.
#[test]
fn roots_behind_the_head_show_in_what_hangs_before_them() {
    let mut scene = yardstick("flat-tails-red");
    let camera = &mut scene.camera;
    (camera.yaw, camera.pitch, camera.distance) = (63.41607, -56.696106, 2.7440948);
    (camera.target[0], camera.target[1]) = (-0.6836571, 0.37310672);
    let motion = Motion::new();
    let mut frames = FrameMaker::new();
    let frame = frames.frame(&scene, &motion).unwrap();
    assert!(frame.objects[0].solid.is_some());
    let (expected, _) = picture(&frame, Evaluator::everywhere());
    let (found, _) = picture(&frame, Evaluator::default());
    assert!(found == expected);
}

#[test]
fn strokes_behind_the_head_are_not_worked_out() {
    let mut scene = yardstick_of("short-ash", [480, 360]);
    let motion = Motion::new();
    let discs = |scene: &Scene, mut evaluator: Evaluator| {
        let mut frames = FrameMaker::new();
        let frame = frames.frame(scene, &motion).unwrap();
        assert!(frame.objects[0].solid.is_some());
        let mut drawing = Drawing::default();
        evaluator.evaluate(&frame, &mut drawing).unwrap();
        let layers = drawing.layers.iter().map(|layer| layer.discs.len());
        layers.sum::<usize>()
    };
    for yaw in [0.0, 90.0] {
        scene.camera.yaw = yaw;
        let (some, all) = (
            discs(&scene, Evaluator::default()),
            discs(&scene, Evaluator::everywhere()),
        );
        assert!(10 * some < 9 * all, "{yaw}: {some} of {all}");
    }
}

/// Waves in front of a face, many one behind the other; where they `dive`, they wind through those before and behind them.
fn dense(preset: &Preset, files: &Files, size: f32, dive: f32) -> Scene {
    let head = HeadModel::bust();
    let mut strands = Strands::new();
    for id in 0..1200_u32 {
        let (column, row) = (id % 40, id / 40);
        let [x, z] = [0.005 * (column as f32 - 19.5), 0.15 + 0.006 * row as f32];
        let point = |i: usize| {
            let (sine, cosine) = (1.3 * i as f32 + id as f32).sin_cos();
            let wave = (0.004 + 0.2 * dive) * sine;
            Vec3::new(x + wave, 1.62 - 0.02 * i as f32, z + dive * cosine)
        };
        let points: Vec<Vec3> = (0..12).map(point).collect();
        strands.push(id, &points, Some(1.0)).unwrap();
    }
    let mut hair = HairModel::new(strands, Some(&head)).unwrap();
    (hair.infos.iter_mut()).for_each(|info| info.size = size);
    Scene::of_one(hair, Some(head), Look::new(preset, files).unwrap()).unwrap()
}

/// A frame's picture, and how many discs of strokes it takes.
fn with_discs(frame: &Frame, mut evaluator: Evaluator) -> (Vec<[u32; 4]>, usize) {
    let mut drawing = Drawing::default();
    evaluator.evaluate(frame, &mut drawing).unwrap();
    let layers = drawing.layers.iter().map(|layer| layer.discs.len());
    (picture(frame, evaluator).0, layers.sum())
}

#[test]
fn hair_behind_hair_is_not_worked_out() {
    let motion = Motion::new();
    for (look, size, yaw) in [
        ("twin-tails", 30.0, 0.0),
        ("twin-tails", 40.0, 25.0),
        ("short-ash", 30.0, -15.0),
        ("flat-tails-red", 12.0, 10.0),
        ("manga-ink", 16.0, 35.0),
        ("outlined", 16.0, 0.0),
    ] {
        let mut scene = with_yardstick(look, [320, 240], |preset, files| {
            dense(preset, files, size, 0.0)
        });
        (scene.camera.target, scene.camera.distance) = ([0.0; 3], 2.5);
        (scene.camera.yaw, scene.camera.pitch) = (yaw, 5.0);
        let mut frames = FrameMaker::new();
        let frame = frames.frame(&scene, &motion).unwrap();
        let [(picture_of_some, some), (picture_of_all, all)] =
            [Evaluator::default(), Evaluator::everywhere()]
                .map(|evaluator| with_discs(&frame, evaluator));
        assert!(picture_of_some == picture_of_all, "{look}, {size}");
        assert!(some <= all);
        // Half discs hide nothing for sure where links meet, which is at one height here; outlines of others reach farther.
        if ["twin-tails", "short-ash"].contains(&look) {
            assert!(3 * some < 2 * all, "{look}, {size}: {some} discs of {all}");
        }
    }
}

/// What shows of a strand that other hair hides in part is what all of it makes, also where it goes under and comes up again.
#[test]
fn hair_that_winds_through_hair_looks_the_same() {
    let motion = Motion::new();
    for (look, size, dive, yaw) in [
        ("twin-tails", 30.0, 0.03, 0.0),
        ("twin-tails", 24.0, 0.06, 40.0),
        ("short-ash", 40.0, 0.02, -15.0),
        ("long-pink", 30.0, 0.09, 70.0),
    ] {
        let mut scene = with_yardstick(look, [320, 240], |preset, files| {
            dense(preset, files, size, dive)
        });
        (scene.camera.target, scene.camera.distance) = ([0.0; 3], 2.5);
        (scene.camera.yaw, scene.camera.pitch) = (yaw, 5.0);
        let mut frames = FrameMaker::new();
        let frame = frames.frame(&scene, &motion).unwrap();
        let [some, all] = [Evaluator::default(), Evaluator::everywhere()]
            .map(|evaluator| with_discs(&frame, evaluator));
        assert!(some.0 == all.0, "{look}, {size}, {dive}");
        assert!(some.1 < all.1, "{look}: {} of {}", some.1, all.1);
    }
}

/// What is hidden is found sample by sample where hair is thin, by heads too, and leaves no trace in pictures of these samples.
#[test]
fn thin_hair_behind_hair_and_heads_is_not_worked_out() {
    let motion = Motion::new();
    for (look, size, dive, yaw, samples) in [
        ("twin-tails", 8.0, 0.0, 0.0, 4),
        ("twin-tails", 8.0, 0.03, 150.0, 4),
        ("short-ash", 6.0, 0.05, 30.0, 1),
        ("blond-fantasy", 7.0, 0.02, -60.0, 2),
        ("manga-ink", 9.0, 0.04, 100.0, 8),
        ("flat-tails-red", 8.0, 0.02, 10.0, 4),
        ("outlined", 6.0, 0.01, 75.0, 16),
        ("twin-tails", 8.0, 0.03, 150.0, 8),
        ("twin-tails", 6.0, 0.03, 150.0, 16),
    ] {
        let mut scene = with_yardstick(look, [320, 240], |preset, files| {
            dense(preset, files, size, dive)
        });
        (scene.camera.target, scene.camera.distance) = ([0.0; 3], 2.5);
        (scene.camera.yaw, scene.camera.pitch) = (yaw, 5.0);
        let mut frames = FrameMaker::new();
        let frame = frames.frame(&scene, &motion).unwrap();
        let evaluators = [Evaluator::of_samples(samples), Evaluator::everywhere()];
        let [some, all] = evaluators.map(|mut evaluator| {
            let mut drawing = Drawing::default();
            evaluator.evaluate(&frame, &mut drawing).unwrap();
            let discs: usize = drawing.layers.iter().map(|layer| layer.discs.len()).sum();
            (picture_of(&frame, evaluator, samples).0, discs)
        });
        assert!(some.0 == all.0, "{look}, {size}, {dive}, {yaw}");
        assert!(some.1 < all.1, "{look}: {} of {}", some.1, all.1);
    }
}

#[test]
fn hair_of_any_size_is_drawn_or_refused() {
    // What no file says, hair may have whose roots lie as far apart.
    for size in [1e3, Strands::LARGEST_SIZE, 1e9, 1e30, 3e38] {
        let scene = with_yardstick("twin-tails", [64, 48], |preset, files| {
            dense(preset, files, size, 0.0)
        });
        let mut frames = FrameMaker::new();
        if let Ok(frame) = frames.frame(&scene, &Motion::new()) {
            let mut drawing = Drawing::default();
            let _ = Evaluator::default().evaluate(&frame, &mut drawing);
        }
    }
}

#[test]
fn hair_far_off_the_picture_is_not_looked_at() {
    let mut scene = yardstick("twin-tails");
    let motion = Motion::new();
    let mut frames = FrameMaker::new();
    assert!(frames.frame(&scene, &motion).unwrap().paths.len() > 1000);
    let near = scene.camera.target;
    scene.camera.target[0] = 12.0;
    let frame = frames.frame(&scene, &motion).unwrap();
    assert_eq!((frame.paths.len(), frame.surfaces.len()), (0, 0));
    assert_eq!(frames.culled(), scene.strand_count());
    // Half of it: some strands are worked out, others are not.
    scene.camera.target = near;
    scene.camera.distance = 0.4;
    let (_, some) = picture(
        &frames.frame(&scene, &motion).unwrap(),
        Evaluator::default(),
    );
    let mut all = FrameMaker {
        keeps_unseen: true,
        ..FrameMaker::new()
    };
    let (_, every) = picture(
        &all.frame(&scene, &motion).unwrap(),
        Evaluator::everywhere(),
    );
    assert!(some > 0 && some < every, "{some} of {every}");
}

#[test]
fn a_small_picture_takes_fewer_joints() {
    let motion = Motion::new();
    let joints = |size| {
        let (scene, mut frames) = (yardstick_of("blond-fantasy", size), FrameMaker::new());
        frames.frame(&scene, &motion).unwrap().paths.len()
    };
    let sizes = [[96, 72], [960, 720], [3840, 2880]].map(joints);
    assert!(3 * sizes[0] < sizes[2] && sizes[1] < sizes[2], "{sizes:?}");
}

/// Three strands on the bust.
fn small() -> Scene {
    let head = HeadModel::bust();
    let mut strands = Strands::new();
    for id in 0..3 {
        let x = 0.02 * (id as f32 - 1.0);
        let points = [[x, 1.68, 0.06], [x, 1.66, 0.11], [x, 1.58, 0.13]].map(Vec3::from);
        strands.push(id, &points, Some(9.0)).unwrap();
    }
    let hair = HairModel::new(strands, Some(&head)).unwrap();
    Scene::of_one(hair, Some(head), look(&Sections::default())).unwrap()
}

fn look(sections: &Sections) -> Look {
    Look::new(
        &Preset::new(1, sections.clone(), Vec::new()),
        &Files::default(),
    )
    .unwrap()
}

#[test]
fn a_head_that_is_gone_hides_nothing() {
    let (motion, mut frames) = (Motion::new(), FrameMaker::new());
    let scene = yardstick("short-ash");
    assert!(
        frames.frame(&scene, &motion).unwrap().objects[0]
            .solid
            .is_some()
    );
    let mut strands = Strands::new();
    let points = [[0.0, 1.68, 0.06], [0.0, 1.66, 0.11], [0.0, 1.58, 0.13]].map(Vec3::from);
    strands.push(0, &points, Some(9.0)).unwrap();
    let hair = HairModel::new(strands, None).unwrap();
    let bald = Scene::of_one(hair, None, look(&Sections::default())).unwrap();
    assert_eq!(frames.frame(&bald, &motion).unwrap().objects[0].solid, None);
}

#[test]
fn a_frame_is_as_before_until_something_changes() {
    let mut scene = small();
    let (mut motion, mut frames) = (Motion::new(), FrameMaker::new());
    let camera = scene.own_camera().unwrap();
    assert!(
        !frames.is_as_before(&scene, &motion, &camera),
        "there is no frame yet"
    );
    let make = |frames: &mut FrameMaker, scene: &Scene, motion: &Motion| {
        frames.frame(scene, motion).unwrap();
        let camera = scene.own_camera().unwrap();
        assert!(frames.is_as_before(scene, motion, &camera));
    };
    make(&mut frames, &scene, &motion);
    // Time passes, and nothing moves.
    motion.advance_to(&scene, 1.5).unwrap();
    assert!(frames.is_as_before(&scene, &motion, &camera));

    // Another camera, look, place; a look of the same words, too, as only its own parts are known.
    scene.camera.yaw += 1.0;
    let turned = scene.own_camera().unwrap();
    assert!(!frames.is_as_before(&scene, &motion, &turned));
    make(&mut frames, &scene, &motion);
    let mut sections = Sections::default();
    sections.head.light = [0.2, 0.1, 0.05];
    let tanned = scene.with_look(look(&sections)).unwrap();
    assert!(!frames.is_as_before(&tanned, &motion, &turned));
    let moved = scene.objects()[0].placed(0.0, Vec3::new(0.0, 0.0, 1e-3));
    let moved = scene.with_object(0, moved).unwrap();
    assert!(!frames.is_as_before(&moved, &motion, &turned));
    assert!(frames.is_as_before(&scene, &motion, &turned));
}

#[test]
fn moving_hair_is_never_as_before() {
    let scene = small();
    let (mut motion, mut frames) = (Motion::new(), FrameMaker::new());
    let mut hand = Hand::new();
    for step in 0..4 {
        let time = step as f32 / 24.0;
        hand.hold(time, Vec3::ZERO, Vec3::ZERO, Vec3::new(2.0, 0.0, 0.0));
        motion.advance_by_hand(&scene, time, &hand).unwrap();
        let camera = scene.own_camera().unwrap();
        assert!(!frames.is_as_before(&scene, &motion, &camera), "{step}");
        frames.frame(&scene, &motion).unwrap();
    }
}
