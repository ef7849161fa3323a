//! What a ponytail of twenty clumps shows when head or figure turn fast: a few groups, which keep its volume.

#![allow(
    clippy::print_stdout,
    reason = "a test shows the figures that it holds"
)]

use crate::motion::Motion;
use crate::scene::Scene;
use crate::{Files, Preset};
use effects::Registry;
use glam::{DVec2, Vec3};
use std::fs;
use std::path::Path;

const CLUMPS: usize = 20;
/// Frames a second.
const FPS: f32 = 60.0;
/// Places along the tail, as shares of its mean clump: where it hangs freely.
const PLACES: [f32; 3] = [0.5, 0.65, 0.8];
/// How much of its volume it keeps in all of a motion. As the head turns, half of it comes to lie on a shoulder, which doesn't turn, and stays there
/// unless it is recalled.
const LEAST_VOLUME: f64 = 0.89;
const LEAST_VOLUME_ON_SHOULDER: f64 = 0.75;

/// A place on a clump at a share of it.
fn at(points: &[Vec3], share: f32) -> Vec3 {
    let place = share * (points.len() - 1) as f32;
    let first = (place as usize).min(points.len() - 2);
    points[first].lerp(points[first + 1], place - first as f32)
}

/// Clumps with their radii where the tail is cut across.
struct Section {
    /// In the plane across, m.
    at: Vec<DVec2>,
    radius_m: Vec<f64>,
}

impl Section {
    /// Where a plane at a right angle to the tail cuts its clumps, at a share of the mean one.
    fn new(clumps: &[(&[Vec3], f32)], share: f32) -> Self {
        let mean = |share: f32| {
            let places = clumps.iter().map(|(points, _)| at(points, share));
            places.sum::<Vec3>() / clumps.len() as f32
        };
        let (middle, way) = (
            mean(share),
            (mean(share + 0.02) - mean(share - 0.02)).normalize(),
        );
        let side = way.any_orthonormal_vector();
        let other = way.cross(side);
        let mut section = Self {
            at: Vec::new(),
            radius_m: Vec::new(),
        };
        for (points, radius) in clumps {
            let cuts = points.windows(2).filter_map(|ends| {
                let [before, after] = [0, 1].map(|i| (ends[i] - middle).dot(way));
                (before < 0.0 && after >= 0.0)
                    .then(|| ends[0].lerp(ends[1], before / (before - after)) - middle)
            });
            let Some(cut) = cuts.min_by(|a, b| a.length().total_cmp(&b.length())) else {
                continue;
            };
            let place = DVec2::new(f64::from(cut.dot(side)), f64::from(cut.dot(other)));
            section.at.push(place);
            section.radius_m.push(f64::from(*radius));
        }
        section
    }

    /// How many groups there are: in one are clumps that are no farther apart than half a clump's width.
    fn groups(&self) -> Vec<usize> {
        let mut of: Vec<usize> = (0..self.at.len()).collect();
        for one in 0..of.len() {
            for other in 0..one {
                let apart = self.at[one].distance(self.at[other]);
                let (r, s) = (self.radius_m[one], self.radius_m[other]);
                if apart - r - s <= 0.5 * (r + s) && of[one] != of[other] {
                    let (keep, gone) = (of[one].min(of[other]), of[one].max(of[other]));
                    for group in &mut of {
                        if *group == gone {
                            *group = keep;
                        }
                    }
                }
            }
        }
        let mut sizes = vec![0; of.len()];
        for group in of {
            sizes[group] += 1;
        }
        sizes.retain(|size| *size > 0);
        sizes.sort_unstable();
        sizes.reverse();
        sizes
    }

    /// The area of all that lies between clumps, m^2: of the least convex shape around them.
    fn area(&self) -> f64 {
        let mut around: Vec<DVec2> = Vec::new();
        for (at, radius) in self.at.iter().zip(&self.radius_m) {
            around.extend((0..24).map(|i| {
                let angle = std::f64::consts::TAU * f64::from(i) / 24.0;
                *at + DVec2::from_angle(angle) * *radius
            }));
        }
        around.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
        let half = |places: &mut dyn Iterator<Item = &DVec2>| {
            let mut chain: Vec<DVec2> = Vec::new();
            for place in places {
                while let [.., a, b] = chain[..]
                    && (b - a).perp_dot(*place - b) <= 0.0
                {
                    chain.pop();
                }
                chain.push(*place);
            }
            chain.pop();
            chain
        };
        let mut hull = half(&mut around.iter());
        hull.extend(half(&mut around.iter().rev()));
        let next = hull.iter().cycle().skip(1);
        0.5 * (hull.iter().zip(next))
            .map(|(a, b)| a.perp_dot(*b))
            .sum::<f64>()
    }
}

/// A scene of a ponytail in a move by 60 degrees, in a look with these settings.
fn scene(kind: &str, settings: &[(&str, &str)]) -> Scene {
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str, text: &str| {
        let path = folder.path().join(name);
        fs::write(&path, text).unwrap();
        path
    };
    let motion = file(
        "turn.motion.ron",
        &format!("(version: 1, moves: [(move: {kind}, start: 0.1, length: 0.3, angle: 60)])"),
    );
    let hair = file(
        "ponytail.style.ron",
        r#"(version: 1, zones: [
            (name: "cap", roots: whorl, tips: hairline(-180, 180), count: 30, hang: 0.05, lift: 0.03, locks: 0),
            (name: "tail", form: tail, roots: [(180, 40)], hang: 1.6, count: 20, tie: 0.07),
        ])"#,
    );
    let mut registry = Registry::new();
    effects_builtin::register(&mut registry).unwrap();
    let presets = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../presets");
    let text = fs::read_to_string(presets.join("outlined.ron")).unwrap();
    let mut preset = Preset::parse("look.ron", &text, &registry).unwrap();
    preset.set("scene.fps", &FPS.to_string()).unwrap();
    for (name, value) in settings {
        preset.set(name, value).unwrap();
    }
    let files = Files {
        preset_folder: presets,
        hair: Some(hair),
        motion: Some(motion),
        ..Files::default()
    };
    Scene::load(&preset, &files).unwrap()
}

/// What a motion leaves of a ponytail.
struct Kept {
    /// How many groups there are at each of the places, where it is fastest.
    groups: Vec<usize>,
    /// Its volume there, at the least of all frames and in the last, for that at rest.
    fastest: f64,
    least: f64,
    last: f64,
}

impl Kept {
    fn holds(&self, least_volume: f64) {
        let Self { groups, .. } = self;
        assert!(groups.iter().all(|n| (3..=5).contains(n)), "{groups:?}");
        let (fastest, least) = (self.fastest, self.least);
        assert!(fastest > 0.9 && least > least_volume, "{fastest} {least}");
    }
}

/// Moves a ponytail.
fn moved(kind: &str, settings: &[(&str, &str)], frames: usize) -> Kept {
    let scene = scene(kind, settings);
    let object = &scene.objects()[0];
    let hair = object.hair();
    let is_tail = |strand: &usize| hair.zone_name(hair.infos[*strand].id) == Some("tail");
    let tail: Vec<usize> = (0..hair.infos.len()).filter(is_tail).collect();
    assert_eq!(tail.len(), CLUMPS);
    let mut motion = Motion::new();
    let mut before: Vec<Vec3> = Vec::new();
    let (mut rest_m2, mut least, mut last) = (0.0, f64::INFINITY, 1.0);
    let mut fastest = (0.0, 0.0, Vec::new());
    for frame in 0..=frames {
        motion.advance_to(&scene, frame as f32 / FPS).unwrap();
        let points = motion.of(0, object).points(object);
        let clump = |&strand: &usize| {
            let own = &points[hair.file.strands.point_range(strand)];
            (own, hair.infos[strand].size * hair.head.unit_m())
        };
        let clumps: Vec<(&[Vec3], f32)> = tail.iter().map(clump).collect();
        let sections = PLACES.map(|share| Section::new(&clumps, share));
        let area_m2: f64 = sections.iter().map(Section::area).sum();
        if frame == 0 {
            rest_m2 = area_m2;
        }
        last = area_m2 / rest_m2;
        least = least.min(last);
        let now: Vec<Vec3> = clumps.iter().map(|(points, _)| at(points, 0.8)).collect();
        let ways = now.iter().zip(&before).map(|(a, b)| a.distance(*b));
        let speed = ways.sum::<f32>() * FPS / CLUMPS as f32;
        if speed > fastest.0 {
            let groups: Vec<Vec<usize>> = sections.iter().map(Section::groups).collect();
            fastest = (speed, last, groups);
        }
        before = now;
    }
    let (speed, fastest, groups) = fastest;
    println!(
        "{kind} {settings:?}: at {speed:.2} m/s {fastest:.3} of its volume, clumps of groups at {PLACES:?} of its length {groups:?}; {least:.3} of its volume at least, {last:.3} at the end"
    );
    Kept {
        groups: groups.iter().map(Vec::len).collect(),
        fastest,
        least,
        last,
    }
}

#[test]
fn a_ponytail_parts_into_a_few_groups() {
    moved("turn", &[], 240).holds(LEAST_VOLUME_ON_SHOULDER);
}

/// Recalled from the shoulder it has its volume once it hangs still; recalled from nearby it keeps it, and hardly swings.
#[test]
fn a_ponytail_that_is_recalled_comes_back_to_its_volume() {
    let swings = moved("turn", &[("dynamics.recall", "4")], 240);
    assert!(swings.last > 0.9, "{}", swings.last);
    for (recall, least) in [("5", 0.88), ("6", 0.9)] {
        let nearby = [
            ("dynamics.recall", recall),
            ("dynamics.recall_from", "0.05"),
        ];
        moved("turn", &nearby, 240).holds(least);
    }
}

/// The shoulders turn along: nothing but the swing can take volume.
#[test]
fn a_ponytail_that_swings_keeps_its_volume() {
    moved("spin", &[], 240).holds(LEAST_VOLUME);
}
