//! The looks that come with inkstrand, as an artist would check them: few clumps, none of them in the head or the body, the eyes
//! free.

use effects::Registry;
use glam::DVec3;
use groom::{Dress, Face};
use hair_sim::SignedDistance;
use rayon::prelude::*;
use render::cpu::{Evaluator, Rasterizer};
use render::{Drawing, Frame};
use stage::{DressChoice, Files, HeadSection, HeadShape, Preset, Stage};
use std::fs;
use std::path::{Path, PathBuf};

/// Most clumps of a look: 1.5 times those of Table 6.1, and of the two of chapter 7.
const MOST_CLUMPS: [(&str, usize); 4] = [
    ("twin-tails", 126),
    ("flat-tails-black", 150),
    ("flat-tails-red", 150),
    ("", 108),
];
/// Most clumps of looks that are not in the source.
const MOST_OF_OTHERS: usize = 126;
const SOURCE_LOOKS: [&str; 7] = [
    "twin-tails",
    "long-pink",
    "blond-fantasy",
    "short-ash",
    "manga-ink",
    "flat-tails-black",
    "flat-tails-red",
];
/// How deep the middle of a stroke may lie below the skin, metres.
const DEEPEST_M: f64 = 0.001;
/// Ids of styles' clumps are below this.
const MOST_IDS: u32 = 1_000_000;
/// Share of the eyes that hair may hide, seen from the front.
const HIDDEN: f64 = 0.01;
/// Looks whose hair hides an eye, as their first lines say.
const OVER_AN_EYE: [&str; 1] = ["long-fringe"];

fn presets() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../presets")
}

fn registry() -> Registry {
    let mut registry = Registry::new();
    effects_builtin::register(&mut registry).unwrap();
    effects_cartoon::register(&mut registry).unwrap();
    effects_surface::register(&mut registry).unwrap();
    registry
}

/// The looks of one figure with hair: names and texts.
fn looks() -> Vec<(String, String)> {
    let mut looks: Vec<(String, String)> = fs::read_dir(presets())
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|e| e == "ron"))
        .map(|path| {
            let name = path.file_stem().unwrap().to_string_lossy().into_owned();
            (name, fs::read_to_string(&path).unwrap())
        })
        // Others are of several heads, of the bust, or of things.
        .filter(|(_, text)| text.contains("hair: (file") && text.contains("shape: figure"))
        .collect();
    looks.sort();
    assert!(looks.len() >= 8);
    looks
}

fn stage(preset: &Preset) -> Stage {
    let files = Files {
        preset_folder: presets(),
        ..Files::default()
    };
    Stage::new(preset, &files).unwrap()
}

#[test]
fn looks_are_drawn_with_few_clumps() {
    let registry = registry();
    for (name, text) in looks() {
        let preset = Preset::parse(&name, &text, &registry).unwrap();
        let is_of_source = SOURCE_LOOKS.contains(&name.as_str());
        let limit = MOST_CLUMPS.iter().find(|(look, _)| *look == name);
        let most = match limit {
            Some((_, most)) => *most,
            None if is_of_source => MOST_CLUMPS[3].1,
            None => MOST_OF_OTHERS,
        };
        let count = stage(&preset).strand_count();
        assert!(count <= most, "{name}: {count} clumps, at most {most}");
    }
}

/// How deep strokes' middle lines lie below the skin at most, metres, and the strand that does: from where each strand has first
/// left the skin, as roots are in it. The coat under all zones, whose ids are below `first`, doesn't count.
fn deepest(frame: &Frame, skin: &SignedDistance, first: u32) -> (f64, u32) {
    let mut deepest = (f64::MIN, 0);
    for strand in frame.paths.runs.chunk_by(|a, b| a.strand == b.strand) {
        let id = frame.strands[strand[0].strand].id;
        // Loose hairs go their own way, and have numbers of their own.
        if !(first..MOST_IDS).contains(&id) {
            continue;
        }
        let joints = strand.iter().flat_map(|run| run.joints.clone());
        let mut has_left = false;
        for joint in joints {
            let place: DVec3 = frame.paths.position[joint].as_dvec3();
            let depth = -skin.distance(place);
            has_left |= depth < 0.0;
            if has_left && depth > deepest.0 {
                deepest = (depth, id);
            }
        }
    }
    deepest
}

/// Distances from the skin and the clothes of a look's figure.
fn skin(head: &HeadSection) -> SignedDistance {
    assert_eq!(head.shape, HeadShape::Figure);
    let figure = groom::Figure {
        crop_m: head.crop * 0.24,
        dress: match head.dress {
            DressChoice::None => Dress::None,
            DressChoice::Choker => Dress::Choker,
            DressChoice::Turtleneck => Dress::Turtleneck,
            DressChoice::Collar => Dress::Collar,
            DressChoice::Jacket => Dress::Jacket,
            DressChoice::Sailor => Dress::Sailor,
        },
        face: Face::default(),
    };
    let figure = figure.build();
    SignedDistance::new(&figure.positions, &figure.triangles, 0.004).unwrap()
}

/// A look, and where its hair is in the body, if it is.
fn fault(name: &str, preset: &Preset, skin: &SignedDistance) -> Option<String> {
    const FIRST_ZONE: u32 = 10_000;
    let mut stage = stage(preset);
    let (depth_m, strand) = deepest(&stage.frame().unwrap(), skin, FIRST_ZONE);
    // Ids begin anew with each zone; those of clumps drawn by hand come before all zones.
    let place = match strand / FIRST_ZONE {
        1 => "drawn by hand".to_owned(),
        zone => format!("of zone {}", zone - 2),
    };
    let clump = strand % FIRST_ZONE;
    let depth_mm = 1e3 * depth_m;
    (depth_m > DEEPEST_M).then(|| format!("{name}: {depth_mm:.1} mm, clump {clump} {place}"))
}

#[test]
fn no_hair_runs_through_the_body() {
    let (registry, looks) = (registry(), looks());
    // By their bodies: distances from one take longer than all else, so looks that share one are checked together.
    let mut bodies: Vec<Vec<(&str, Preset)>> = Vec::new();
    for (name, text) in &looks {
        let preset = Preset::parse(name, text, &registry).unwrap();
        let shape = |preset: &Preset| (preset.sections.head.crop, preset.sections.head.dress);
        let own = shape(&preset);
        match bodies.iter_mut().find(|body| shape(&body[0].1) == own) {
            Some(body) => body.push((name, preset)),
            None => bodies.push(vec![(name, preset)]),
        }
    }
    let faults = |body: &Vec<(&str, Preset)>| {
        let skin = skin(&body[0].1.sections.head);
        let faults = body
            .iter()
            .filter_map(|(name, preset)| fault(name, preset, &skin));
        faults.collect::<Vec<String>>()
    };
    let faults: Vec<String> = bodies.par_iter().flat_map_iter(faults).collect();
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// Pixels of the eyes from the front, with the hair and without.
fn eye_pixels(name: &str, text: &str) -> [usize; 2] {
    let registry = registry();
    let set = [
        ("head.iris", "FF00FF"),
        ("head.iris_shadow", "FF00FF"),
        ("head.iris_light", "FF00FF"),
        ("head.expression", "neutral"),
        ("scene.size", "(480, 480)"),
        ("scene.background", "000000"),
        ("camera.yaw", "0"),
        ("camera.pitch", "0"),
        ("camera.distance", "2.6"),
        ("camera.target", "(0, 0, 0)"),
    ];
    ["1", "0"].map(|size| {
        let mut preset = Preset::parse(name, text, &registry).unwrap();
        for (name, value) in set {
            preset.set(name, value).unwrap();
        }
        // Eyes in their own colours, whatever light is painted on them.
        preset.layers.retain(|layer| !layer.effect.is_for_meshes());
        preset.set("clump.size", size).unwrap();
        if size == "0" {
            let is_hair = |name: &&str| ["hair.base", "hair.toon"].contains(name);
            let layers = preset.layers.iter().map(|layer| layer.name.as_str());
            let hair = layers.filter(is_hair).map(str::to_owned);
            let hair: Vec<String> = hair.collect();
            preset.keep_only(&hair).unwrap();
        }
        let mut stage = stage(&preset);
        let mut drawing = Drawing::default();
        let frame = stage.frame().unwrap();
        Evaluator::default().evaluate(&frame, &mut drawing).unwrap();
        let picture = Rasterizer::new(1, Some(1)).unwrap().draw(&drawing).unwrap();
        let is_eye = |pixel: &&[f32; 4]| pixel[..3] == [1.0, 0.0, 1.0];
        picture.pixels.iter().filter(is_eye).count()
    })
}

#[test]
fn eyes_are_free() {
    looks().par_iter().for_each(|(name, text)| {
        if OVER_AN_EYE.contains(&name.as_str()) {
            return;
        }
        let [seen, all] = eye_pixels(name, text);
        assert!(all > 500, "{name}: eyes of {all} pixels");
        let hidden = 1.0 - seen as f64 / all as f64;
        assert!(
            hidden <= HIDDEN,
            "{name}: hair hides {:.1} % of the eyes",
            100.0 * hidden
        );
    });
}
