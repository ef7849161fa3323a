//! What the suite draws: strokes alone, on nothing, in 960 x 720 pixels.

use crate::BenchError;
use effects::Registry;
use glam::{DVec3, Vec2};
use render::cpu::Evaluator;
use render::{Brush, Disc, Drawing, LayerStrokes, Order, Run, Stretches};
use stage::{Files, Preset, Stage};
use std::f64::consts::{PI, TAU};
use std::path::Path;

const SIZE: [u32; 2] = [960, 720];
/// From the eye to the middle of a made scene, in metres.
const DISTANCE: f64 = 1.5;
/// How much deeper than its middle a stroke's edge lies, metres: as in the presets.
const EDGE_DEPTH_M: f32 = 0.005;
/// Pixels of a metre there.
const SCALE: f64 = 720.0;

/// The source stamps about this many discs between two particles: 160,000 for the 15,960 segments of
/// its Fig. 6.2 (table 6.1).
const SOURCE_STAMPS: usize = 10;

/// A drawing and what the suite must know of it.
pub struct TestDrawing {
    /// In the table.
    pub name: &'static str,
    /// Strokes without surfaces and background, in the order by strands.
    pub drawing: Drawing,
    /// The source's number of stamps between two joints.
    pub source_stamps: usize,
    /// No two strands touch, and each stroke has one colour: one outline a stroke draws it rightly.
    pub is_apart: bool,
}

impl TestDrawing {
    /// Segments of all strokes that are listed, empty ones too, and those that cover anything.
    #[must_use]
    pub fn segments(&self) -> [usize; 2] {
        let mut count = [0, 0];
        for layer in &self.drawing.layers {
            for instance in 0..layer.instances {
                let runs = self.drawing.runs.iter();
                let stretches = runs.flat_map(|run| layer.on(instance, &run.joints));
                for discs in stretches.map(|stretch| &layer.discs[stretch.places()]) {
                    let pairs = || discs.windows(2);
                    count[0] += pairs().count();
                    count[1] += pairs()
                        .filter(|p| p[0].radius.max(p[1].radius) > 0.0)
                        .count();
                }
            }
        }
        count
    }
}

/// All scenes; `root` is the project's folder, for its yardsticks.
///
/// # Errors
///
/// When the preset cannot be read; all that is wrong with it.
pub fn all(root: &Path) -> Result<Vec<TestDrawing>, BenchError> {
    Ok(vec![
        ponytails(),
        twin_tails(root)?,
        curtain(),
        fine_hairs(),
    ])
}

/// The strokes of `tests/yardsticks/twin-tails.ron` without the head.
///
/// # Errors
///
/// When the preset or a file of it cannot be read.
pub fn twin_tails(root: &Path) -> Result<TestDrawing, BenchError> {
    let folder = root.join("tests/yardsticks");
    let path = folder.join("twin-tails.ron");
    let name = path.display().to_string();
    let text = std::fs::read_to_string(&path).map_err(|error| format!("{name}: {error}"))?;
    let mut registry = Registry::new();
    effects_builtin::register(&mut registry).map_err(|error| error.to_string())?;
    let preset = Preset::parse(&name, &text, &registry).map_err(|errors| errors.to_string())?;
    let files = Files {
        preset_folder: folder,
        ..Files::default()
    };
    let mut stage = Stage::new(&preset, &files).map_err(|error| error.to_string())?;
    let frame = stage.frame().map_err(|error| error.to_string())?;
    let mut drawing = Drawing::default();
    Evaluator::default()
        .evaluate(&frame, &mut drawing)
        .map_err(|error| error.to_string())?;
    drawing.surfaces.clear();
    drawing.background = None;
    // Resampled between particles: the source's stamps are shared out among more joints.
    let subdivision = preset.sections.path.subdivision as usize;
    Ok(TestDrawing {
        name: "twin-tails",
        drawing,
        source_stamps: SOURCE_STAMPS.div_ceil(subdivision.max(1)),
        is_apart: false,
    })
}

/// Like Fig. 6.2: two long tails of 42 strands each, 20 joints a strand; a silhouette, a base, two
/// bands of shade and one of light in four feathers each. 15,960 segments, some of them empty;
/// colours run along them.
#[must_use]
pub fn ponytails() -> TestDrawing {
    let strand = |id: u32| -> Vec<ClumpPoint> {
        let side = if id.is_multiple_of(2) { -1.0 } else { 1.0 };
        let spread = [hash(id, 0) - 0.5, hash(id, 1) - 0.5, hash(id, 2) - 0.5];
        let swing = TAU * hash(id, 3);
        let length = 0.65 + 0.25 * hash(id, 4);
        (0..20)
            .map(|joint| {
                let u = f64::from(joint) / 19.0;
                let out = 0.09 + 0.32 * (1.0 - (-3.0 * u).exp()) + 0.3 * u * spread[0];
                let wave = 0.02 * (7.0 * u + swing).sin() * u;
                let point = DVec3::new(
                    side * (out + wave),
                    0.4 + 0.14 * u * (1.0 - u) + 0.03 * spread[1] - length * u * u.sqrt(),
                    0.1 * spread[2] + 0.12 * u * spread[1] + wave,
                );
                ClumpPoint::new(point, 0.011 * profile(u), u)
            })
            .collect()
    };
    let diffuse = |joint: &ClumpPoint, color: [f32; 3]| {
        let gray = 0.7 + 0.3 * (5.0 * joint.u).sin() as f32;
        color.map(|channel| gray * channel)
    };
    let layers: [LayerOf; 4] = [
        LayerOf {
            name: "silhouette",
            rank: -1,
            instances: 1,
            disc: &|joint, _| {
                let line = (0.5 * joint.radius).min(0.0018);
                joint.disc(joint.radius + line, 0.0, 0.012)
            },
            color: &|_| [0.01, 0.06, 0.09],
        },
        LayerOf {
            name: "base",
            rank: 0,
            instances: 1,
            disc: &|joint, _| joint.disc(joint.radius, 0.0, 0.0),
            color: &|joint| diffuse(joint, [0.05, 0.53, 0.52]),
        },
        LayerOf {
            name: "shade",
            rank: 1,
            instances: 4,
            disc: &|joint, feather| {
                let share = band(joint.u, 0.1, 0.25).max(band(joint.u, 0.72, 0.15));
                joint.feather(feather, -0.002, share)
            },
            color: &|joint| diffuse(joint, [0.02, 0.25, 0.3]),
        },
        LayerOf {
            name: "light",
            rank: 2,
            instances: 4,
            disc: &|joint, feather| joint.feather(feather, -0.004, band(joint.u, 0.45, 0.2)),
            color: &|_| [0.9, 1.0, 1.0],
        },
    ];
    TestDrawing {
        name: "ponytails",
        drawing: drawing((0..84).map(|id| (id, strand(id))), &layers),
        source_stamps: SOURCE_STAMPS,
        is_apart: false,
    }
}

/// Strands side by side that don't touch: silhouette, base and a light on it, one colour a stroke.
#[must_use]
pub fn curtain() -> TestDrawing {
    const STRANDS: u32 = 60;
    let strand = |id: u32| -> Vec<ClumpPoint> {
        let x = 1.24 * ((f64::from(id) + 0.5) / f64::from(STRANDS) - 0.5);
        (0..24)
            .map(|joint| {
                let u = f64::from(joint) / 23.0;
                let wave = 0.03 * (4.0 * u).sin();
                let point = DVec3::new(x + wave, 0.46 - 0.92 * u, 0.0);
                ClumpPoint::new(point, 0.007 * profile(u), u)
            })
            .collect()
    };
    let layers: [LayerOf; 3] = [
        LayerOf {
            name: "silhouette",
            rank: -1,
            instances: 1,
            disc: &|joint, _| joint.disc(1.25 * joint.radius, 0.0, 0.012),
            color: &|_| [0.03, 0.01, 0.02],
        },
        LayerOf {
            name: "base",
            rank: 0,
            instances: 1,
            disc: &|joint, _| joint.disc(joint.radius, 0.0, 0.0),
            color: &|_| [0.6, 0.25, 0.1],
        },
        LayerOf {
            name: "light",
            rank: 1,
            instances: 1,
            disc: &|joint, _| joint.disc(0.3 * joint.radius, -0.3, -0.002),
            color: &|_| [1.0, 0.9, 0.8],
        },
    ];
    TestDrawing {
        name: "curtain",
        drawing: drawing((0..STRANDS).map(|id| (id, strand(id))), &layers),
        source_stamps: SOURCE_STAMPS,
        is_apart: true,
    }
}

/// 600 hairs that cross, 1.5 pixels wide at the root and nothing at the tip.
#[must_use]
pub fn fine_hairs() -> TestDrawing {
    let strand = |id: u32| -> Vec<ClumpPoint> {
        let [x, lean, z] = [hash(id, 0) - 0.5, hash(id, 1) - 0.5, hash(id, 2) - 0.5];
        let swing = TAU * hash(id, 3);
        (0..16)
            .map(|joint| {
                let u = f64::from(joint) / 15.0;
                let wave = 0.04 * (6.0 * u + swing).sin() * u;
                let point = DVec3::new(
                    0.8 * x + 0.9 * lean * u + wave,
                    0.42 - 0.8 * u * (0.7 + 0.3 * hash(id, 4)),
                    0.3 * z + wave,
                );
                ClumpPoint::new(point, 0.001 * (1.0 - u), u)
            })
            .collect()
    };
    let layers: [LayerOf; 1] = [LayerOf {
        name: "hair",
        rank: 0,
        instances: 1,
        disc: &|joint, _| joint.disc(joint.radius, 0.0, 0.0),
        color: &|joint| [0.8, 0.5, 0.1].map(|channel: f32| channel * (1.0 - 0.6 * joint.u as f32)),
    }];
    TestDrawing {
        name: "fine-hairs",
        drawing: drawing((0..600).map(|id| (id, strand(id))), &layers),
        source_stamps: SOURCE_STAMPS,
        is_apart: false,
    }
}

/// The size of a strand along its length: sine (5.2), thin at the root, pointed at the tip.
fn profile(u: f64) -> f64 {
    ((0.25 + 0.75 * u) * PI).sin().max(0.0)
}

/// 1 at `middle`, falling to 0 at `reach` from it.
fn band(u: f64, middle: f64, reach: f64) -> f64 {
    (1.4 * (1.0 - (u - middle).abs() / reach)).clamp(0.0, 1.0)
}

/// A number from 0 to 1 that looks random.
fn hash(a: u32, b: u32) -> f64 {
    let mut bits = a.wrapping_mul(0x9e37_79b9) ^ b.wrapping_mul(0x85eb_ca6b) ^ 0x2545_f491;
    for _ in 0..3 {
        bits = (bits ^ (bits >> 15)).wrapping_mul(0x2c1b_3c6d);
    }
    f64::from(bits ^ (bits >> 16)) / 4_294_967_296.0
}

/// A joint of a made strand; metres, y up, z to the eye.
struct ClumpPoint {
    point: DVec3,
    /// Of the clump.
    radius: f64,
    /// 0 at the root, 1 at the tip.
    u: f64,
}

/// A layer of a made scene; `disc` and `color` of a joint, for one of its instances.
struct LayerOf<'a> {
    name: &'static str,
    rank: i32,
    instances: usize,
    disc: &'a dyn Fn(&ClumpPoint, usize) -> Disc,
    color: &'a dyn Fn(&ClumpPoint) -> [f32; 3],
}

impl ClumpPoint {
    fn new(point: DVec3, radius: f64, u: f64) -> Self {
        Self { point, radius, u }
    }

    /// A disc moved sideways by a share of the clump's radius, and `behind` metres back.
    fn disc(&self, radius: f64, aside: f64, behind: f64) -> Disc {
        let depth = DISTANCE - self.point.z;
        let scale = SCALE * DISTANCE / depth;
        let x = 0.5 * f64::from(SIZE[0]) + scale * (self.point.x + aside * self.radius);
        let y = 0.5 * f64::from(SIZE[1]) - scale * self.point.y;
        Disc {
            center: Vec2::new(x as f32, y as f32),
            radius: (scale * radius) as f32,
            inv_depth: (1.0 / (depth + behind)) as f32,
            inv_depth_biased: (1.0 / (depth - self.radius)) as f32,
        }
    }

    /// One of four strokes across the clump, the given share of their full width.
    fn feather(&self, feather: usize, behind: f64, share: f64) -> Disc {
        let aside = (feather as f64 - 1.5) / 2.0;
        self.disc(0.25 * share * self.radius, aside, behind)
    }
}

fn drawing(strands: impl Iterator<Item = (u32, Vec<ClumpPoint>)>, layers: &[LayerOf]) -> Drawing {
    let mut runs = Vec::new();
    let mut joints = Vec::new();
    for (strand, of_strand) in strands {
        let start = joints.len();
        joints.extend(of_strand);
        runs.push(Run {
            strand,
            joints: start..joints.len(),
        });
    }
    let layers = layers.iter().map(|layer| {
        let discs_of = |instance| {
            joints
                .iter()
                .map(move |joint| (layer.disc)(joint, instance))
        };
        let colors: Vec<[f32; 3]> = joints.iter().map(layer.color).collect();
        LayerStrokes {
            name: layer.name.to_owned(),
            joints: 0..joints.len(),
            rank: layer.rank,
            instances: layer.instances,
            stretches: Stretches::Everywhere,
            discs: (0..layer.instances).flat_map(discs_of).collect(),
            colors: colors.repeat(layer.instances),
        }
    });
    Drawing {
        size: SIZE,
        layers: layers.collect(),
        clump: joints
            .iter()
            .map(|joint| joint.disc(joint.radius, 0.0, 0.0))
            .collect(),
        sides: Vec::new(),
        side_stretches: Stretches::Everywhere,
        runs,
        surfaces: Vec::new(),
        background: None,
        order: Order::Rounded,
        edge_depth_m: EDGE_DEPTH_M,
        brush: Brush::Circle,
        ..Drawing::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ponytails_have_the_work_of_figure_6_2() {
        let scene = ponytails();
        assert_eq!(scene.drawing.runs.len(), 84);
        let [all, inked] = scene.segments();
        assert_eq!(all, 15_960);
        assert!(inked > 8_000, "{inked}");
    }

    /// Half the distance between two strands, less the widest stroke's reach, for every height.
    #[test]
    fn the_strands_of_the_curtain_do_not_touch() {
        let drawing = curtain().drawing;
        let outline = &drawing.layers[0].discs;
        for pair in drawing.runs.windows(2) {
            for (a, b) in pair[0].joints.clone().zip(pair[1].joints.clone()) {
                let gap = outline[a].center.distance(outline[b].center);
                assert!(outline[a].radius + outline[b].radius < 0.9 * gap);
            }
        }
    }

    #[test]
    fn scenes_can_be_drawn_and_show_strokes_all_over() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
        for scene in all(&root).unwrap() {
            let picture = render::cpu::Rasterizer::new(1, Some(1))
                .unwrap()
                .draw(&scene.drawing)
                .unwrap();
            let inked = picture.pixels.iter().filter(|pixel| pixel[3] > 0.0).count();
            let share = inked as f64 / picture.pixels.len() as f64;
            assert!((0.04..0.9).contains(&share), "{}: {share}", scene.name);
            assert!(scene.segments()[1] > 1000, "{}", scene.name);
        }
    }
}
