//! A scene of which one part changes is the scene that would have been made so, and its other parts are not made again.

use effects::Registry;
use glam::Vec3;
use hair_sim::Strands;
use render::Frame;
use stage::{
    Files, FrameMaker, HairModel, Hand, HeadModel, Look, Motion, Preset, Scene, Sections, Stage,
    StageError,
};
use std::path::Path;

const PRESET: &str = "(
    version: 1,
    hair: (file: \"presets/styles/bob.style.ron\"), head: (shape: bust),
    motion: (file: \"presets/motions/head-turn.motion.ron\"),
    scene: (size: (64, 48)),
    layers: [(effect: \"hair.base\"), (effect: \"hair.fine\")],
)";

fn registry() -> Registry {
    let mut registry = Registry::new();
    effects_builtin::register(&mut registry).unwrap();
    registry
}

fn preset<'r>(registry: &'r Registry, settings: &[(&str, &str)]) -> Preset<'r> {
    let mut preset = Preset::parse("look.ron", PRESET, registry).unwrap();
    for (name, value) in settings {
        preset.set(name, value).unwrap();
    }
    preset
}

fn files() -> Files {
    Files {
        preset_folder: Path::new(env!("CARGO_MANIFEST_DIR")).join("../.."),
        ..Files::default()
    }
}

/// All that a frame's strokes and surfaces are made of.
fn content(frame: &Frame) -> (Vec<Vec3>, Vec<u32>, String) {
    let numbers = [
        frame.edge_depth_m,
        frame.objects[0].head.height_m,
        frame.objects[0].clump.base().size,
    ];
    let bits = numbers.map(f32::to_bits).to_vec();
    let rest = format!(
        "{:?} {:?} {:?} {:?} {:?}",
        frame.surfaces, frame.light, frame.strands, frame.objects[0].layer_joints, frame.brush
    );
    (frame.paths.position.clone(), bits, rest)
}

/// The frame of a scene at a time, made by what has made other frames before.
fn shown(
    scene: &Scene,
    motion: &mut Motion,
    frames: &mut FrameMaker,
    time: f32,
) -> (Vec<Vec3>, Vec<u32>, String) {
    motion.advance_to(scene, time).unwrap();
    content(&frames.frame(scene, motion).unwrap())
}

#[test]
fn another_look_is_as_if_it_had_been_there_from_the_start() {
    let registry = registry();
    let scene = Scene::load(&preset(&registry, &[]), &files()).unwrap();
    let (mut motion, mut frames) = (Motion::new(), FrameMaker::new());
    shown(&scene, &mut motion, &mut frames, 0.3);
    let steps = motion.steps_taken();
    assert!(steps > 0);
    let changes: [&[(&str, &str)]; 4] = [
        &[
            ("head.width", "4"),
            ("clump.size", "2"),
            ("path.brush", "semicircle"),
        ],
        &[("path.kind", "linear"), ("path.subdivision", "2")],
        &[("clump.normal", "material"), ("light.kind", "point")],
        &[("camera.yaw", "90"), ("scene.edge_depth", "0.1")],
    ];
    for change in changes {
        let preset = preset(&registry, change);
        let changed = scene
            .with_look(Look::new(&preset, &Files::default()).unwrap())
            .unwrap();
        assert!(std::ptr::eq(
            changed.objects()[0].hair(),
            scene.objects()[0].hair()
        ));
        let found = shown(&changed, &mut motion, &mut frames, 0.3);
        let mut fresh = Stage::new(&preset, &files()).unwrap();
        fresh.advance_to(0.3).unwrap();
        assert!(found == content(&fresh.frame().unwrap()), "{change:?}");
    }
    // None of these moves hair in another way, so nothing was simulated again.
    assert_eq!(motion.steps_taken(), steps);
}

#[test]
fn hair_that_moves_in_another_way_begins_anew() {
    let registry = registry();
    let scene = Scene::load(&preset(&registry, &[]), &files()).unwrap();
    let (mut motion, mut frames) = (Motion::new(), FrameMaker::new());
    let before = shown(&scene, &mut motion, &mut frames, 0.3);
    for change in [("dynamics.feel", "gel"), ("scene.fps", "48"), ("seed", "7")] {
        let preset = preset(&registry, &[change]);
        let changed = scene
            .with_look(Look::new(&preset, &Files::default()).unwrap())
            .unwrap();
        let found = shown(&changed, &mut motion, &mut frames, 0.3);
        let mut fresh = Stage::new(&preset, &files()).unwrap();
        fresh.advance_to(0.3).unwrap();
        assert!(found == content(&fresh.frame().unwrap()), "{change:?}");
    }
    assert!(shown(&scene, &mut motion, &mut frames, 0.3) == before);
}

#[test]
fn other_hair_on_the_same_head() {
    let registry = registry();
    let scene = Scene::load(&preset(&registry, &[("motion.bone", "head")]), &files()).unwrap();
    let (mut motion, mut frames) = (Motion::new(), FrameMaker::new());
    let before = shown(&scene, &mut motion, &mut frames, 0.2);
    let mut strands = Strands::new();
    for id in [3, 1] {
        let x = 0.03 * (id as f32 - 2.0);
        let points = [[x, 1.68, 0.06], [x, 1.66, 0.11], [x, 1.58, 0.13]].map(Vec3::from);
        strands.push(id, &points, None).unwrap();
    }
    let hair = HairModel::new(strands, Some(&HeadModel::bust())).unwrap();
    let other = scene.objects()[0].with_hair(hair).unwrap();
    let other = scene.with_object(0, other).unwrap();
    motion.advance_to(&other, 0.2).unwrap();
    let frame = frames.frame(&other, &motion).unwrap();
    let ids: Vec<u32> = frame
        .strands
        .iter()
        .map(|strand| strand.id)
        .take(2)
        .collect();
    assert_eq!(ids, [1, 3]);
    assert!(frame.strands[0].size > 0.0);
    assert!(shown(&scene, &mut motion, &mut frames, 0.2) == before);
}

#[test]
fn what_cannot_be_a_scene_is_refused() {
    let mut twins = Strands::new();
    let points = [Vec3::ZERO, Vec3::Y];
    twins.push(5, &points, None).unwrap();
    twins.push(5, &points, None).unwrap();
    let error = HairModel::new(twins, None).err().unwrap();
    assert!(matches!(error, StageError::SameId(5)), "{error}");
    assert!(HairModel::new(Strands::new(), None).is_err());

    let mut sections = Sections::default();
    sections.camera.fov = f32::NAN;
    let error = Look::new(&Preset::new(1, sections, Vec::new()), &Files::default())
        .err()
        .unwrap();
    assert_eq!(
        error.to_string(),
        "camera.fov: expected a number from 1 to 150"
    );
}

#[test]
fn a_hand_moves_head_and_hair_beside_the_script() {
    let registry = registry();
    let still = PRESET.replace(
        "motion: (file: \"presets/motions/head-turn.motion.ron\"),",
        "",
    );
    for text in [PRESET, &still] {
        let preset = Preset::parse("look.ron", text, &registry).unwrap();
        let scene = Scene::load(&preset, &files()).unwrap();
        let at = |hand: &Hand, times: &[f32]| {
            let (mut motion, mut frames) = (Motion::new(), FrameMaker::new());
            for time in times {
                motion.advance_by_hand(&scene, *time, hand).unwrap();
            }
            content(&frames.frame(&scene, &motion).unwrap())
        };
        let without = shown(&scene, &mut Motion::new(), &mut FrameMaker::new(), 0.5);
        assert!(at(&Hand::new(), &[0.5]) == without);

        let mut hand = Hand::new();
        for step in 0..=8 {
            let turn = Vec3::new(5.0 * step as f32, 0.0, 0.0);
            hand.hold(step as f32 / 24.0, turn, Vec3::ZERO, Vec3::ZERO);
        }
        let held = at(&hand, &[0.5]);
        let apart = |(points, ..): &(Vec<Vec3>, _, _), others: &[Vec3]| {
            let pairs = points.iter().zip(others);
            pairs.map(|(a, b)| a.distance(*b)).fold(0.0, f32::max)
        };
        assert!(apart(&held, &without.0) > 0.02, "hair follows the head");
        assert!(
            apart(&held, &at(&hand, &[0.1, 0.2, 0.3, 0.4, 0.5]).0) == 0.0,
            "times looked at change nothing"
        );

        // A wind alone moves hair, and the head stays.
        let mut blow = Hand::new();
        blow.hold(0.0, Vec3::ZERO, Vec3::ZERO, Vec3::new(-9.0, 0.0, 0.0));
        let calm = shown(&scene, &mut Motion::new(), &mut FrameMaker::new(), 1.0);
        assert!(apart(&at(&blow, &[1.0]), &calm.0) > 0.005, "hair blows");
    }
}
