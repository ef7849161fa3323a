//! Highlights don't flash: what shows them on a head that turns is nearly the same from frame to frame, seen by who turns with it.
//! And bands of light don't lie on shadow.

use effects::Registry;
use glam::{Mat3, Quat, Vec3};
use render::cpu::{Evaluator, Rasterizer};
use render::{Drawing, Feature, Features, Frame, NO_ID, SamplePlanes};
use stage::{Files, Preset, Stage};
use std::collections::HashMap;
use std::fs;
use std::path::{Path, PathBuf};
use stroke_path::Camera;

/// How much of what shows a highlight in either of two frames, 1/24 s apart, may show it in one of them alone.
const MOST: f64 = 0.35;
/// Frames of the motion that are compared: the head turns in both directions.
const FRAMES: u32 = 48;
const FPS: f32 = 24.0;

fn presets() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../presets")
}

fn text(look: &str) -> String {
    fs::read_to_string(presets().join(look)).unwrap()
}

fn stage(look: &str, text: &str, set: &[(&str, &str)]) -> Stage {
    let mut registry = Registry::new();
    effects_builtin::register(&mut registry).unwrap();
    effects_cartoon::register(&mut registry).unwrap();
    let mut preset = Preset::parse(look, text, &registry).unwrap();
    for (name, value) in set {
        preset.set(name, value).unwrap();
    }
    preset.set("scene.size", "(320, 240)").unwrap();
    // The head fills the picture.
    preset.set("camera.distance", "2.4").unwrap();
    preset.set("camera.target", "(0, 0, 0)").unwrap();
    preset.set("camera.pitch", "5").unwrap();
    let files = Files {
        preset_folder: presets(),
        motion: Some(presets().join("motions/head-turn.motion.ron")),
        ..Files::default()
    };
    Stage::new(&preset, &files).unwrap()
}

/// Where strands begin, by their ids.
fn roots(frame: &Frame) -> HashMap<u32, Vec3> {
    let runs = frame
        .paths
        .runs
        .iter()
        .filter(|run| frame.paths.u[run.joints.start] == 0.0);
    runs.map(|run| {
        (
            frame.strands[run.strand].id,
            frame.paths.position[run.joints.start],
        )
    })
    .collect()
}

/// How the head has turned, and where it has its middle: from roots, which move with it.
fn turn(rest: &HashMap<u32, Vec3>, now: &HashMap<u32, Vec3>) -> (Quat, Vec3, Vec3) {
    let mut ids: Vec<u32> = rest
        .keys()
        .copied()
        .filter(|id| now.contains_key(id))
        .collect();
    ids.sort_unstable();
    assert!(ids.len() > 10);
    // Three roots far from each other.
    let a = ids[0];
    let far = |from: &dyn Fn(u32) -> f32| {
        ids.iter()
            .copied()
            .max_by(|x, y| from(*x).total_cmp(&from(*y)))
            .unwrap()
    };
    let b = far(&|id| rest[&id].distance(rest[&a]));
    let c = far(&|id| (rest[&id] - rest[&a]).cross(rest[&b] - rest[&a]).length());
    let axes = |of: &HashMap<u32, Vec3>| {
        let x = (of[&b] - of[&a]).normalize();
        let z = x.cross(of[&c] - of[&a]).normalize();
        Mat3::from_cols(x, z.cross(x), z)
    };
    let rotation = Quat::from_mat3(&(axes(now) * axes(rest).transpose())).normalize();
    (rotation, rest[&a], now[&a])
}

/// Which samples show a layer of one of these effects.
fn showing(frame: &mut Frame, effects: &[&str], rasterizer: &mut Rasterizer) -> Vec<bool> {
    frame.features = Features::of(&[Feature::Layer]);
    let layers = frame.objects[0].layers.iter();
    let meant: Vec<bool> = layers
        .map(|layer| effects.contains(&layer.effect))
        .collect();
    let mut drawing = Drawing::default();
    Evaluator::default().evaluate(frame, &mut drawing).unwrap();
    let [width, height] = drawing.size.map(|side| side as usize);
    let mut shows = Vec::new();
    rasterizer
        .draw_samples(&drawing, &mut SamplePlanes::default(), |planes| {
            for picture in planes.samples() {
                for y in 0..height {
                    let layers = &planes.ids(picture, Feature::Layer, y)[..width];
                    shows.extend(
                        layers
                            .iter()
                            .map(|&layer| layer != NO_ID && meant[layer as usize]),
                    );
                }
            }
        })
        .unwrap();
    shows
}

/// The largest share of samples that show a highlight in one of two frames alone, and how many show one on the mean.
fn flash(look: &str) -> (f64, f64) {
    let mut stage = stage(look, &text(look), &[]);
    let mut rasterizer = Rasterizer::new(4, Some(2)).unwrap();
    stage.advance_to(0.0).unwrap();
    let frame = stage.frame().unwrap();
    let (rest, camera) = (roots(&frame), *frame.camera);
    let mut largest = 0.0_f64;
    let mut count = 0;
    let mut before: Option<Vec<bool>> = None;
    for number in 0..=FRAMES {
        stage.advance_to(number as f32 / FPS).unwrap();
        let now = roots(&stage.frame().unwrap());
        let (rotation, from, to) = turn(&rest, &now);
        // It sees each place of the head as at rest.
        let back = rotation.inverse();
        let with_head: Camera = camera.seen_from(back, from - back * to);
        let mut frame = stage.frame_seen_by(with_head).unwrap();
        let shows = showing(
            &mut frame,
            &["hair.highlight", "hair.band"],
            &mut rasterizer,
        );
        count += shows.iter().filter(|shows| **shows).count();
        if let Some(before) = before {
            let pairs = || before.iter().zip(&shows);
            let either = pairs().filter(|(a, b)| **a || **b).count();
            let one = pairs().filter(|(a, b)| a != b).count();
            largest = largest.max(one as f64 / either.max(1) as f64);
        }
        before = Some(shows);
    }
    (largest, count as f64 / f64::from(FRAMES + 1))
}

/// Bands of broad teeth. Of thin ones, a pixel or two wide, more differs: hair swings by more than their width.
#[test]
fn bands_stay_where_they_are_while_a_head_turns() {
    for look in ["twin-tails.ron", "long-pink.ron", "manga-ink.ron"] {
        let (flash, count) = flash(look);
        assert!(count > 2000.0, "{look}: {count} samples show a highlight");
        assert!(flash < MOST, "{look}: {flash}");
    }
}

/// The measure is measured: a ring of mirrored light runs over the hair.
#[test]
fn what_runs_over_the_hair_is_found() {
    let (flash, count) = flash("short-ash.ron");
    assert!(
        flash > 2.0 * MOST && count > 1500.0,
        "{flash}, {count} samples"
    );
}

/// How much of the samples that show a band would show shadow without it, and how many show one.
fn on_shadow(look: &str, light_yaw: &str) -> (f64, usize) {
    // A preset has each layer in a line of its own. Glows that are made for shadow say so by a `shade` below 0.
    let is_band = |line: &&str| line.contains("\"hair.band\"") && !line.contains("shade: -");
    let text = text(look);
    assert!(text.lines().any(|line| is_band(&line)), "{look}");
    let without: Vec<&str> = text.lines().filter(|line| !is_band(line)).collect();
    let mut rasterizer = Rasterizer::new(4, Some(2)).unwrap();
    let mut showing_in = |text: &str, effects: &[&str]| {
        let set = [("light.yaw", light_yaw), ("light.pitch", "35")];
        let mut stage = stage(look, text, &set);
        stage.advance_to(0.0).unwrap();
        showing(&mut stage.frame().unwrap(), effects, &mut rasterizer)
    };
    let band = showing_in(&text, &["hair.band"]);
    // What a dim glow shows in both is no band's.
    let glow = showing_in(&without.join("\n"), &["hair.band"]);
    let shadow = showing_in(&without.join("\n"), &["hair.cel", "hair.cast"]);
    let band: Vec<bool> = band
        .iter()
        .zip(glow)
        .map(|(band, glow)| *band && !glow)
        .collect();
    let both = band
        .iter()
        .zip(&shadow)
        .filter(|(band, shadow)| **band && **shadow);
    let count = band.iter().filter(|band| **band).count();
    (both.count() as f64 / count.max(1) as f64, count)
}

/// Wherever the light is.
#[test]
fn bands_lie_where_hair_is_lit() {
    for look in [
        "blond-fantasy",
        "flat-tails-black",
        "flat-tails-red",
        "long-pink",
        "short-ash",
        "twin-tails",
    ] {
        for light_yaw in ["-40", "60"] {
            let (share, count) = on_shadow(&format!("{look}.ron"), light_yaw);
            assert!(
                count > 200,
                "{look}, {light_yaw}: {count} samples show a band"
            );
            assert!(
                share < 0.02,
                "{look}, {light_yaw}: {share} of {count} samples"
            );
        }
    }
}
