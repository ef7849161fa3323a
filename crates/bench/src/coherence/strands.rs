//! A few strands without a head, made by code: those that pass each other, and those that the measure
//! is tried on.

use super::animation::{Animation, Kind, TICKS, Tick, seconds};
use crate::BenchError;
use effects::{Layer, Registry, Varied, clump};
use glam::{DVec3, Vec3};
use render::{Brush, Frame, Head, Light, NO_COLOR, NO_TAPER, Object, Order, StrandInfo};
use stage::Preset;
use stroke_path::{Camera, Cut, OrbitView, PathKind, Paths, sin_cos_degrees};

/// Particles of a strand.
const PARTICLES: u32 = 16;
/// 1/300 of the head's height, as all sizes.
const SIZE: f32 = 14.0;
/// How much deeper than its middle a round clump's edge lies, in head heights: as in presets.
const EDGE_DEPTH: f32 = 0.02;
const PATH: PathKind = PathKind::CatmullRom { subdivision: 5 };
const HEAD: Head = Head {
    center: Vec3::new(0.0, 0.0, -0.3),
    height_m: 0.24,
};
const VIEW: OrbitView = OrbitView {
    target: Vec3::ZERO,
    yaw_degrees: 0.0,
    pitch_degrees: 0.0,
    distance_m: 1.0,
    vertical_fov_degrees: 30.0,
};

/// Outlined strokes with shade and light.
const STYLE: &str = r#"(
    version: 1,
    clump: (mix: 0.8, size_variation: 0, mix_variation: 0, color: "3FC1C0"),
    layers: [
        (effect: "hair.silhouette", depth_offset: 0.018, params: (width: 2.0, ratio: 0.5, color: "124A57")),
        (effect: "hair.base"),
        (effect: "hair.cel", params: (color: "2A8F9D")),
    ],
)"#;

/// The same in other colours.
const OTHER_STYLE: &str = r#"(
    version: 1,
    clump: (mix: 0.8, size_variation: 0, mix_variation: 0, color: "E8476A"),
    layers: [
        (effect: "hair.silhouette", depth_offset: 0.018, params: (width: 2.0, ratio: 0.5, color: "400010")),
        (effect: "hair.base"),
    ],
)"#;

/// Where a strand's particles are: of the strand's number, u and the time in seconds, in metres.
type Motion = fn(usize, f64, f64) -> DVec3;

/// Strands that move as code says.
pub struct Strands {
    motion: Motion,
    style: Style,
    /// A style that they change to, and when.
    change: Option<(Tick, Style)>,
    camera: Camera,
    /// Where each strand is cut.
    cuts: Vec<Vec<Cut>>,
    infos: Vec<StrandInfo>,
    paths: Paths,
    layer_joints: Vec<std::ops::Range<usize>>,
}

struct Style {
    clump: Varied<clump::Program>,
    layers: Vec<Layer>,
}

/// Opens a scene of strands.
type Open = fn() -> Result<Strands, BenchError>;

/// A strand at a time.
fn particles(motion: Motion, strand: usize, time: f64) -> Vec<Vec3> {
    let u = (0..PARTICLES).map(|p| f64::from(p) / f64::from(PARTICLES - 1));
    u.map(|u| motion(strand, u, time).as_vec3()).collect()
}

impl Strands {
    /// Name, purpose and maker of every scene.
    pub const ALL: [(&str, Kind, Open); 5] = [
        ("control-continuous", Kind::Continuous, || {
            Self::new(1, lone, None)
        }),
        ("control-fast", Kind::Continuous, || {
            Self::new(1, fast, None)
        }),
        ("control-jumping", Kind::Jumping, || {
            Self::new(1, lone, Some(TICKS / 11))
        }),
        ("passing", Kind::Hair, || Self::new(7, passing, None)),
        ("curl", Kind::Hair, || Self::new(1, curl, None)),
    ];

    fn new(count: u32, motion: Motion, change: Option<Tick>) -> Result<Self, BenchError> {
        let change = change.map(|tick| Ok::<_, BenchError>((tick, Style::parse(OTHER_STYLE)?)));
        let camera = Camera::orbit(VIEW, [480, 360], 0.01).map_err(|error| error.to_string())?;
        let info = |id| StrandInfo {
            id,
            mean: Vec3::ZERO,
            size: SIZE,
            taper: NO_TAPER,
            colors: [NO_COLOR; 2],
            level: 0,
            lift: 0.0,
            left_out_by: 0,
        };
        let cuts = (0..count as usize).map(|i| {
            let overlap_m = 3.0 * SIZE * HEAD.unit_m();
            stroke_path::cuts(&particles(motion, i, 0.0), PATH, overlap_m)
        });
        let cuts = cuts.collect::<Result<_, _>>();
        Ok(Self {
            motion,
            cuts: cuts.map_err(|error| error.to_string())?,
            style: Style::parse(STYLE)?,
            change: change.transpose()?,
            camera,
            infos: (0..count).map(info).collect(),
            paths: Paths::new(),
            layer_joints: Vec::new(),
        })
    }
}

impl Style {
    fn parse(text: &str) -> Result<Self, BenchError> {
        let mut registry = Registry::new();
        effects_builtin::register(&mut registry).map_err(|error| error.to_string())?;
        let preset =
            Preset::parse("strands", text, &registry).map_err(|errors| errors.to_string())?;
        Ok(Self {
            clump: Varied::new(&preset.sections.clump.0),
            layers: preset.layers.iter().map(|layer| layer.build()).collect(),
        })
    }
}

impl Animation for Strands {
    fn at(&mut self, tick: Tick) -> Result<Frame<'_>, BenchError> {
        let time = seconds(tick);
        self.paths.clear();
        for (i, info) in self.infos.iter_mut().enumerate() {
            let particles = particles(self.motion, i, time);
            info.mean = particles.iter().sum::<Vec3>() / particles.len() as f32;
            let pushed =
                self.paths
                    .push_pieces(i, &particles, &self.cuts[i], None, PATH, &self.camera);
            pushed.map_err(|error| error.to_string())?;
        }
        let style = match &self.change {
            Some((change, style)) if tick >= *change => style,
            _ => &self.style,
        };
        self.layer_joints.clear();
        let joints = 0..self.paths.len();
        self.layer_joints.resize(style.layers.len(), joints);
        Ok(Frame {
            camera: &self.camera,
            paths: &self.paths,
            strands: &self.infos,
            objects: vec![Object {
                joints: 0..self.paths.len(),
                head: HEAD,
                solid: None,
                surface_bias_m: 0.0,
                clump: &style.clump,
                seed: 1,
                layers: &style.layers,
                layer_joints: &self.layer_joints,
            }],
            light: Light::Direction(Vec3::new(0.5, 0.6, 0.62).normalize()),
            time_s: time as f32,
            material_normals: &[],
            rest_positions: &[],
            rest_forwards: &[],
            from_ends: &[],
            path_weights: &[],
            marks: &[],
            surfaces: Vec::new(),
            mesh_layers: Vec::new(),
            decals: Vec::new(),
            background: Some([1.0; 3]),
            order: Order::default(),
            edge_depth_m: EDGE_DEPTH * HEAD.height_m,
            brush: Brush::Circle,
            features: render::Features::NONE,
            roundness: 1.0,
            passes: Vec::new(),
        })
    }
}

/// Sine of a number of turns.
fn sine(turns: f64) -> f64 {
    sin_cos_degrees(360.0 * turns).0
}

/// From the top down.
fn height(u: f64) -> f64 {
    0.2 - 0.38 * u
}

/// A strand that moves across the picture and turns.
fn lone(_: usize, u: f64, time: f64) -> DVec3 {
    let x = -0.1 + 0.1 * time + (0.1 * time - 0.1) * u;
    DVec3::new(x, height(u), 0.0)
}

/// The same as fast as the fastest hair of a look: a line's width in 1/384 s.
fn fast(_: usize, u: f64, time: f64) -> DVec3 {
    let x = -0.2 + 0.48 * time + (0.1 * time - 0.1) * u;
    DVec3::new(x, height(u), 0.0)
}

/// Strands that pass each other: a tenth of a second from the start, and again twice a second.
fn passing(strand: usize, u: f64, time: f64) -> DVec3 {
    let swing = sine(time - 0.1);
    let at = |x, z| DVec3::new(x, height(u), z);
    match strand {
        // Side by side, all along at once.
        0 => at(-0.2, 0.03 * swing),
        1 => at(-0.185, -0.03 * swing),
        // Crossing on the screen.
        2 => at(-0.05 + 0.1 * u, 0.03 * swing),
        3 => at(0.05 - 0.1 * u, -0.03 * swing),
        // Aslant in depth: the place where they meet runs along them.
        4 => at(0.15, 0.02 * (u - 0.4) + 0.03 * swing),
        5 => at(0.162, -0.02 * (u - 0.4) - 0.03 * swing),
        // In front of all others.
        _ => at(-0.1 + 0.1 * time, 0.08),
    }
}

/// A strand with two loops, whose ends change places in depth.
fn curl(_: usize, u: f64, time: f64) -> DVec3 {
    let (sin, cos) = sin_cos_degrees(720.0 * u);
    let deep = 0.04 * sine(time - 0.1) * sine(u + 0.5 * time);
    DVec3::new(0.08 * sin + 0.05 * time, 0.1 - 0.2 * u + 0.06 * cos, deep)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_scene_has_its_strands_in_the_picture() {
        for (name, _, open) in Strands::ALL {
            let mut strands = open().unwrap();
            let frame = strands.at(TICKS / 3).unwrap();
            let [width, height] = frame.camera.size_px().map(|side| side as f32);
            for run in &frame.paths.runs {
                let mut joints = frame.paths.center[run.joints.clone()].iter();
                let is_seen =
                    joints.any(|at| (0.0..width).contains(&at.x) && (0.0..height).contains(&at.y));
                assert!(is_seen, "{name}: strand {}", run.strand);
            }
            let runs = frame.paths.runs.chunk_by(|a, b| a.strand == b.strand);
            assert_eq!(runs.count(), frame.strands.len(), "{name}");
            let is_cut = frame.paths.runs.len() > frame.strands.len();
            assert_eq!(is_cut, name == "curl", "{name}");
        }
    }

    /// Between two ticks nothing moves by more than a millimetre, so that what jumps is the drawing.
    #[test]
    fn strands_move_steadily() {
        for (name, _, open) in Strands::ALL {
            let mut strands = open().unwrap();
            let before = strands.at(500).unwrap().paths.position.clone();
            let after = &strands.at(501).unwrap().paths.position;
            let farthest = before.iter().zip(after).map(|(a, b)| a.distance(*b));
            let farthest = farthest.fold(0.0, f32::max);
            assert!(farthest > 0.0 && farthest < 1e-3, "{name}: {farthest} m");
        }
    }
}
