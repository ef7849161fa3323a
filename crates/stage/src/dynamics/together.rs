//! What the looks' hair keeps of its style in quick motions: a braid is one, and a bob's cut has no lock that flies alone.

#![allow(
    clippy::print_stdout,
    reason = "a test shows the figures that it holds"
)]

use crate::hair::HairModel;
use crate::motion::Motion;
use crate::scene::Scene;
use crate::{Files, Preset};
use effects::Registry;
use glam::Vec3;
use std::fs;
use std::path::Path;

/// Frames a second, and of a motion.
const FPS: f32 = 24.0;
const FRAMES: u32 = 72;

/// A look of the presets in one of their motions.
pub(crate) fn scene(look: &str, motion: &str) -> Scene {
    let presets = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../presets");
    let mut registry = Registry::new();
    effects_builtin::register(&mut registry).unwrap();
    let text = fs::read_to_string(presets.join(format!("{look}.ron"))).unwrap();
    let preset = Preset::parse(look, &text, &registry).unwrap();
    let files = Files {
        motion: Some(presets.join(format!("motions/{motion}.motion.ron"))),
        preset_folder: presets,
        ..Files::default()
    };
    Scene::load(&preset, &files).unwrap()
}

/// The strands of zones of which `is_own` says so, as they stand among these points.
fn strands<'p>(
    hair: &HairModel,
    points: &'p [Vec3],
    is_own: impl Fn(&str) -> bool,
) -> Vec<&'p [Vec3]> {
    let all = hair.infos.iter().enumerate();
    let own = all.filter(|(_, info)| hair.zone_name(info.id).is_some_and(&is_own));
    own.map(|(strand, _)| &points[hair.file.strands.point_range(strand)])
        .collect()
}

/// What `measure` finds in strands of the zones, in head heights: at rest, and the most in a motion.
fn at_rest_and_most(
    scene: &Scene,
    is_own: impl Fn(&str) -> bool,
    measure: impl Fn(&[&[Vec3]]) -> f32,
) -> [f32; 2] {
    let hair = scene.objects()[0].hair();
    let height_m = scene.head().height_m;
    let mut motion = Motion::new();
    let mut measured = (0..FRAMES).map(|frame| {
        motion.advance_to(scene, frame as f32 / FPS).unwrap();
        measure(&strands(hair, motion.points(scene, 0), &is_own)) / height_m
    });
    let rest = measured.next().unwrap();
    [rest, measured.fold(0.0, f32::max)]
}

/// How far clumps are from their middle at most, behind the first third.
fn width(clumps: &[&[Vec3]]) -> f32 {
    let count = clumps[0].len();
    let across = |level: usize| {
        let middle = clumps.iter().map(|clump| clump[level]).sum::<Vec3>() / clumps.len() as f32;
        let apart = clumps.iter().map(|clump| clump[level].distance(middle));
        apart.fold(0.0, f32::max)
    };
    (count / 3..count).map(across).fold(0.0, f32::max)
}

/// How far the tip that is loneliest is from the next.
fn loneliest(clumps: &[&[Vec3]]) -> f32 {
    let tips: Vec<Vec3> = clumps.iter().map(|clump| clump[clump.len() - 1]).collect();
    let nearest = |i: usize| {
        let others = (0..tips.len()).filter(|other| *other != i);
        let apart = others.map(|other| tips[i].distance(tips[other]));
        apart.fold(f32::INFINITY, f32::min)
    };
    (0..tips.len()).map(nearest).fold(0.0, f32::max)
}

#[test]
fn a_braid_stays_one_as_she_spins() {
    let scene = scene("side-braid", "spin");
    let [rest, most] = at_rest_and_most(&scene, |zone| zone == "braid", width);
    println!(
        "a braid's clumps are within {rest:.3} head heights of its middle, {most:.3} as she spins"
    );
    assert!(most < 1.5 * rest, "{most}");
}

#[test]
fn no_lock_of_a_bob_flies_alone() {
    for motion in ["spin", "head-turn", "gust"] {
        let scene = scene("flat-tails-red", motion);
        let [rest, most] = at_rest_and_most(&scene, |_| true, loneliest);
        println!(
            "{motion}: a bob's tips are within {most:.3} head heights of the next, {rest:.3} at rest"
        );
        assert!(most < 0.16, "{most}");
    }
}
