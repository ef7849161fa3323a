//! How deep drawn hair is in head, shoulders and bodies: of every look of `presets` in every motion there.

#![allow(
    clippy::print_stdout,
    reason = "a test shows the figures that it holds"
)]

use super::bodies::cut;
use crate::motion::Motion;
use crate::posture::Posture;
use crate::scene::Scene;
use crate::{Files, Preset};
use effects::Registry;
use glam::{DVec3, Vec3};
use hair_io::Mesh;
use hair_sim::{Collider, Shape, SignedDistance};
use render::Head;
use std::fs;
use std::path::{Path, PathBuf};

/// How deep a drawn strand may be, m.
const DEEPEST_M: f64 = 1e-3;
/// Places on the drawn path of a link.
const PLACES: usize = 4;
/// One motion in so many is tried of each look.
const SOME: usize = 13;
/// And those that were deepest, which are always tried.
const WORST: [(&str, &str); 2] = [("side-braid", "run"), ("side-braid", "head-turn")];

fn presets() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../presets")
}

fn names(folder: &str, ending: &str) -> Vec<String> {
    let entries = fs::read_dir(presets().join(folder)).unwrap();
    let names = entries.map(|entry| entry.unwrap().file_name().to_string_lossy().into_owned());
    let mut names: Vec<String> = names
        .filter_map(|name| Some(name.strip_suffix(ending)?.to_owned()))
        .filter(|name| !name.contains('.'))
        .collect();
    names.sort();
    names
}

fn registry() -> Registry {
    let mut registry = Registry::new();
    effects_builtin::register(&mut registry).unwrap();
    effects_cartoon::register(&mut registry).unwrap();
    effects_surface::register(&mut registry).unwrap();
    registry
}

/// Head and shoulders of a mesh, finer than the simulation has them.
pub(super) struct Truth {
    mesh: Mesh,
    head: SignedDistance,
    shoulders: SignedDistance,
}

impl Truth {
    fn new(mesh: &Mesh, head: Head) -> Self {
        let grid = |below: f32, keeps_above: bool, cell: f64| {
            let level = head.center.y + below * head.height_m;
            let end = Vec3::new(head.center.x, level, head.center.z - 0.12 * head.height_m);
            let (points, triangles) = cut(mesh, |p| (p.y > level) == keeps_above, end);
            SignedDistance::new(&points, &triangles, cell * f64::from(head.height_m)).unwrap()
        };
        Self {
            mesh: mesh.clone(),
            head: grid(super::bodies::HEAD_ENDS, true, 1.0 / 56.0),
            shoulders: grid(super::bodies::SHOULDERS_END, false, 1.0 / 48.0),
        }
    }
}

/// A place on Catmull and Rom's spline through points, between one and the next.
fn on_path(points: &[Vec3], link: usize, t: f32) -> Vec3 {
    let [b, c] = [points[link], points[link + 1]];
    let a = link.checked_sub(1).map_or(b * 2.0 - c, |i| points[i]);
    let d = points.get(link + 2).copied().unwrap_or(c * 2.0 - b);
    let (from, to, way) = ((c - a) * 0.5, (d - b) * 0.5, c - b);
    b + (from + (way * 3.0 - from * 2.0 - to + (from + to - way * 2.0) * t) * t) * t
}

/// Where hair is deepest in something.
#[derive(Clone, Debug, Default)]
pub(super) struct Deepest {
    pub depth_m: f64,
    pub what: String,
}

/// The deepest place of the drawn free hair of a scene's first object in its bodies.
pub(super) fn deepest(scene: &Scene, motion: &Motion, truth: &Truth) -> Deepest {
    let object = &scene.objects()[0];
    let (hair, script) = (object.hair(), object.script());
    let own = motion.of(0, object);
    let time = own.posed_s();
    let posture = Posture::of(own.head_pose(), (hair.head, object.pivot()), script, time);
    let grids = [
        (&truth.head, posture.head, "head"),
        (&truth.shoulders, posture.shoulders, "shoulders"),
    ];
    let mut colliders: Vec<(Collider, &str)> = grids
        .map(|(grid, pose, name)| (Collider::fixed(Shape::Grid(grid), pose), name))
        .to_vec();
    for body in &script.bodies {
        colliders.push((body.collider([time; 2], [&posture; 2]), "body"));
    }
    let points = own.points(object);
    let mut deepest = Deepest::default();
    for strand in 0..hair.infos.len() {
        let points = &points[hair.file.strands.point_range(strand)];
        for link in hair.held(strand).max(1) - 1..points.len() - 1 {
            for place in 1..=PLACES {
                let at: DVec3 = on_path(points, link, place as f32 / PLACES as f32).as_dvec3();
                for (collider, name) in &colliders {
                    let depth_m = -collider.distance(at);
                    if depth_m > deepest.depth_m {
                        let zone = hair.zone_name(hair.infos[strand].id).unwrap_or("");
                        deepest = Deepest {
                            depth_m,
                            what: format!(
                                "{at:.3?} {name}: strand {} of `{zone}`, link {link} of {}, held {}",
                                hair.infos[strand].id,
                                points.len() - 1,
                                hair.held(strand)
                            ),
                        };
                    }
                }
            }
        }
    }
    deepest
}

/// Some motions of each look, and the worst; with `INKSTRAND_KEPT_OUT=all` all of them, and with a look's name all of that one.
#[test]
fn hair_is_kept_out_of_head_and_shoulders_in_looks_and_motions() {
    let registry = registry();
    let mut truths: Vec<Truth> = Vec::new();
    let (mut failed, mut tried, mut deepest_m) = (Vec::new(), 0, 0.0_f64);
    let wanted = std::env::var("INKSTRAND_KEPT_OUT").ok();
    let looks = names("", ".ron");
    for look in &looks {
        // Which motions are tried hangs on the look's name alone, not on what other looks there are.
        let own: usize = look.bytes().map(usize::from).sum();
        if (wanted.as_ref()).is_some_and(|wanted| wanted != "all" && wanted != look) {
            continue;
        }
        let text = fs::read_to_string(presets().join(format!("{look}.ron"))).unwrap();
        let preset = Preset::parse(look, &text, &registry).unwrap();
        if !preset.objects.is_empty() {
            continue;
        }
        let scripts = names("motions", ".motion.ron");
        for (turn, script) in scripts.iter().enumerate() {
            let is_tried = (turn + own).is_multiple_of(SOME)
                || WORST.contains(&(look.as_str(), script.as_str()));
            if wanted.is_none() && !is_tried {
                continue;
            }
            let files = Files {
                preset_folder: presets(),
                motion: Some(presets().join(format!("motions/{script}.motion.ron"))),
                ..Files::default()
            };
            let Ok(scene) = Scene::load(&preset, &files) else {
                // Hair that acts has clumps of its own.
                assert_eq!(script, "take-off");
                continue;
            };
            if scene.strand_count() == 0 {
                continue;
            }
            let object = &scene.objects()[0];
            let mesh = object.bare_head().unwrap().body_mesh().mesh;
            let truth = match truths.iter().position(|truth| truth.mesh == *mesh) {
                Some(known) => &truths[known],
                None => {
                    truths.push(Truth::new(mesh, object.hair().head));
                    truths.last().unwrap()
                }
            };
            let mut motion = Motion::new();
            let rest = deepest(&scene, &motion, truth);
            let mut worst = (0, Deepest::default());
            for frame in (0..60).step_by(3) {
                motion.advance_to(&scene, frame as f32 / 24.0).unwrap();
                let now = deepest(&scene, &motion, truth);
                if now.depth_m > worst.1.depth_m {
                    worst = (frame, now);
                }
            }
            let (frame, worst) = worst;
            println!(
                "{look}, {script}: at rest {:.2} mm ({}), deepest {:.2} mm at frame {frame} ({})",
                1e3 * rest.depth_m,
                rest.what,
                1e3 * worst.depth_m,
                worst.what
            );
            tried += 1;
            deepest_m = deepest_m.max(worst.depth_m);
            if worst.depth_m > DEEPEST_M {
                failed.push(format!("{look}, {script}: {:.2} mm", 1e3 * worst.depth_m));
            }
        }
    }
    println!(
        "{} of {tried} looks in motions have hair deeper than {:.1} mm in a body, the deepest {:.2} mm",
        failed.len(),
        1e3 * DEEPEST_M,
        1e3 * deepest_m
    );
    assert!(failed.is_empty(), "{}", failed.join("\n"));
}
