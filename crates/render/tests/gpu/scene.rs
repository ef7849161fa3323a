//! Frames to draw, and devices to draw them on.

use effects::preset::Reader;
use effects::{Layer, Parameters, Registry, Values, Varied, clump};
use glam::{Vec2, Vec3, vec2};
use render::gpu::{AdapterKind, Gpu, GpuError, Offscreen};
use render::{
    Brush, Decal, Edges, Features, Frame, Head, Light, MeshLayer, NO_COLOR, NO_TAPER, Object,
    Order, StrandInfo, Surface, SurfaceVertex,
};
use std::iter;
use std::ops::Range;
use stroke_path::{Camera, OrbitView, PathKind, Paths};

/// All that a frame refers to.
pub struct Scene {
    pub camera: Camera,
    pub paths: Paths,
    pub strands: Vec<StrandInfo>,
    pub clump: Varied<clump::Program>,
    pub layers: Vec<Layer>,
    pub layer_joints: Vec<Range<usize>>,
    /// A second object, which has the last joints.
    pub second: Option<Second>,
    pub material_normals: Vec<Vec3>,
    pub rest_positions: Vec<Vec3>,
    pub rest_forwards: Vec<Vec3>,
    pub from_ends: Vec<Vec2>,
    pub path_weights: Vec<f32>,
    pub surfaces: Vec<Surface>,
    pub mesh_layers: Vec<Layer>,
    pub light: Light,
    pub background: Option<[f32; 3]>,
    pub order: Order,
    pub brush: Brush,
    pub features: Features,
    pub passes: Vec<Edges>,
    pub seed: u32,
}

/// An object beside the first, in the same look.
pub struct Second {
    joints: Range<usize>,
    head: Head,
    layer_joints: Vec<Range<usize>>,
}

impl Second {
    /// How many layers it has.
    pub fn layers(&self) -> usize {
        self.layer_joints.len()
    }

    /// Takes a layer away, which the first object has no more.
    pub fn drop_layer(&mut self, layer: usize) {
        self.layer_joints.remove(layer);
    }
}

/// Every effect of inkstrand's own, some of their numbers varying.
pub const ALL_EFFECTS: &str = "[
    (effect: \"hair.silhouette\", units: pixels),
    (effect: \"hair.base\", params: (brightness: (curve: [(0, 0.6), (1, 1.2)], vary: 0.2))),
    (effect: \"hair.cel\", params: (feathers: 3)),
    (effect: \"hair.highlight\", params: (kind: ring, exponent: 2, threshold: 0.2, full: 0.5)),
    (effect: \"hair.band\", params: (place: 0.1, thickness: 0.8, slide: 0.4, shade: -0.5, rim: 2)),
    (effect: \"hair.ink\", params: (gaps: 0.3, shadow_color: \"8090A0\")),
    (effect: \"line.ink\", on: \"rim\", params: (width: 4, light_color: \"8090A0\")),
    (effect: \"hair.fine\", params: (per_strand: 1)),
]";

pub fn registry() -> Registry {
    let mut registry = Registry::new();
    effects_builtin::register(&mut registry).unwrap();
    effects_cartoon::register(&mut registry).unwrap();
    effects_surface::register(&mut registry).unwrap();
    registry
}

/// The layers of a preset's list.
pub fn layers(text: &str, registry: &Registry) -> Vec<Layer> {
    let mut reader = Reader::new("test", text);
    let specs = reader.layers(text, registry, &[]);
    reader.report().unwrap();
    specs.iter().map(|spec| spec.build()).collect()
}

/// Numbers from 0 to 1 that are the same in every run.
pub struct Numbers(u32);

impl Numbers {
    pub fn new(seed: u32) -> Self {
        Self(seed)
    }

    pub fn next(&mut self) -> f32 {
        self.0 = self.0.wrapping_add(1);
        effects::wgsl::random(self.0, 7)
    }

    fn around(&mut self, middle: f32, reach: f32) -> f32 {
        middle + reach * (2.0 * self.next() - 1.0)
    }
}

/// Three windings that fall from there.
fn ringlet(root: Vec3) -> Vec<Vec3> {
    let at = |k: usize| {
        let turn = 0.75 * k as f32;
        root + Vec3::new(0.04 * turn.cos(), -0.006 * k as f32, 0.04 * turn.sin())
    };
    (0..26).map(at).collect()
}

impl Scene {
    /// Curved strands around a head, some through the eye, with a wall behind some of them.
    pub fn random(seed: u32) -> Self {
        let mut numbers = Numbers::new(seed.wrapping_mul(0x9e37_79b9));
        let view = OrbitView {
            target: Vec3::ZERO,
            yaw_degrees: numbers.around(0.0, 180.0),
            pitch_degrees: numbers.around(0.0, 60.0),
            distance_m: numbers.around(0.7, 0.35),
            vertical_fov_degrees: 40.0,
        };
        let camera = Camera::orbit(view, [97, 75], 0.05).unwrap();
        let mut paths = Paths::new();
        let mut strands = Vec::new();
        let kind = PathKind::CatmullRom { subdivision: 3 };
        for i in 0..14 {
            let mut point = Vec3::from_array([(); 3].map(|()| numbers.around(0.0, 0.12)));
            let mut along = Vec3::from_array([(); 3].map(|()| numbers.around(0.0, 0.06)));
            let points: Vec<Vec3> = (0..1 + i % 7)
                .map(|_| {
                    point += along;
                    along += Vec3::from_array([(); 3].map(|()| numbers.around(0.0, 0.03)));
                    point
                })
                .collect();
            // One curls, and is drawn in pieces.
            let points = if i == 7 { ringlet(points[0]) } else { points };
            let cuts = stroke_path::cuts(&points, kind, 0.02).unwrap();
            assert_eq!(cuts.is_empty(), i != 7, "strand {i}: {} cuts", cuts.len());
            let mean = points.iter().sum::<Vec3>() / points.len() as f32;
            paths
                .push_pieces(i, &points, &cuts, None, kind, &camera)
                .unwrap();
            let [red, blue] = [Vec3::new(0.8, 0.1, 0.1), Vec3::new(0.1, 0.2, 0.7)];
            let colors = [
                [NO_COLOR; 2],
                [red, NO_COLOR],
                [NO_COLOR, blue],
                [blue, red],
            ];
            let tapers = [NO_TAPER, vec2(0.3, -1.0), vec2(-1.0, 0.6), vec2(0.2, 0.5)];
            strands.push(StrandInfo {
                id: 3 * i as u32 + 5,
                mean,
                size: numbers.around(9.0, 8.0),
                taper: tapers[i % tapers.len()],
                colors: colors[i % colors.len()],
                level: i as u32 % 3,
                lift: 0.0,
                // Of five strands one has no silhouette, and one neither that nor the second layer.
                left_out_by: [0, 0, 1, 0, 3][i % 5],
            });
        }
        // The last strands are an effect's own.
        let own = paths.runs.iter().find(|run| run.strand >= 11);
        let own = own.map_or(paths.len(), |run| run.joints.start);
        let layers = layers(ALL_EFFECTS, &registry());
        let layer_joints = layers
            .iter()
            .map(|layer| match layer.program.has_own_paths() {
                true => own..paths.len(),
                false => 0..own,
            });
        let mut values = Values::defaults(clump::Program::PARAMS);
        for (name, text) in [
            ("shading", "diffuse"),
            ("normal", "material"),
            (
                "size",
                "(curve: [(0, 0.5), (0.5, 1.5), (1, 0.2)], vary: 0.3)",
            ),
        ] {
            values.set_text("clump", name, text).unwrap();
        }
        let far = 1.0 / view.distance_m;
        let corner = |x, y, nearer: f32, tone| SurfaceVertex {
            position: Vec2::new(x, y),
            inv_depth: far * nearer,
            tone,
        };
        let surface = |margin_m, triangles| Surface {
            texture: None,
            mesh: 0,
            paint: None,
            marks: if margin_m > 0.0 { 3 } else { 2 },
            vertices: vec![
                corner(-20.0, 10.0, 0.8, 1.0),
                corner(80.0, 5.0, 1.1, -1.0),
                corner(60.0, 90.0, 1.0, 0.5),
                corner(10.0, 60.0, 0.9, -0.2),
            ],
            triangles,
            margin_m,
            light: [0.9, 0.7, 0.6],
            shadow: [0.4, 0.3, 0.3],
        };
        Self {
            material_normals: paths
                .forward
                .iter()
                .map(|f| f.any_orthonormal_vector())
                .collect(),
            rest_positions: paths.position.iter().map(|p| *p / 0.24).collect(),
            rest_forwards: paths
                .forward
                .iter()
                .map(|f| Vec3::new(f.y, f.z, f.x))
                .collect(),
            from_ends: ends_of(&paths),
            path_weights: paths.u.iter().map(|u| 0.2 + u).collect(),
            camera,
            strands,
            clump: Varied::new(&values),
            layer_joints: layer_joints.collect(),
            second: None,
            layers,
            paths,
            surfaces: vec![
                surface(0.0, vec![[0, 1, 2]]),
                surface(0.05, vec![[0, 2, 3]]),
            ],
            mesh_layers: Vec::new(),
            light: if seed.is_multiple_of(2) {
                Light::Direction(Vec3::new(0.48, 0.6, 0.64))
            } else {
                Light::Point(Vec3::new(0.3, 0.5, 0.4))
            },
            background: (!seed.is_multiple_of(3)).then_some([0.2, 0.3, 0.9]),
            order: Order::ALL[(seed / 3) as usize % Order::ALL.len()],
            brush: if (seed / 4).is_multiple_of(2) {
                Brush::Circle
            } else {
                Brush::Semicircle
            },
            features: Features::NONE,
            passes: Vec::new(),
            seed,
        }
    }

    /// Adds layers that draw on all strands.
    pub fn add_layers(&mut self, text: &str) {
        let drawn = self.layer_joints[0].clone();
        for layer in layers(text, &registry()) {
            self.layers.push(layer);
            self.layer_joints.push(drawn.clone());
        }
    }

    /// The same with the strands behind the first six on another head, which is smaller and stands elsewhere.
    pub fn random_pair(seed: u32) -> Self {
        let mut scene = Self::random(seed);
        let runs = &scene.paths.runs;
        let first = runs.iter().find(|run| run.strand >= 6);
        let joints = first.map_or(0, |run| run.joints.start)..scene.paths.len();
        let behind =
            |drawn: &Range<usize>| drawn.start.max(joints.start)..drawn.end.max(joints.start);
        let layer_joints = scene.layer_joints.iter().map(behind).collect();
        for drawn in &mut scene.layer_joints {
            *drawn = drawn.start.min(joints.start)..drawn.end.min(joints.start);
        }
        scene.second = Some(Second {
            joints,
            head: Head {
                center: Vec3::new(0.1, -0.05, 0.03),
                height_m: 0.15,
            },
            layer_joints,
        });
        scene
    }

    /// Turns all strands by so many degrees around the head, each on straight paths through the joints it has now.
    pub fn turn_by(&mut self, degrees: f32) {
        let turned = glam::Quat::from_rotation_y(degrees.to_radians());
        let mut paths = Paths::new();
        let kind = PathKind::Linear { subdivision: 1 };
        for run in &self.paths.runs {
            let points = self.paths.position[run.joints.clone()].iter();
            let points: Vec<Vec3> = points.map(|point| turned * *point).collect();
            paths
                .push_strand(run.strand, &points, kind, &self.camera)
                .unwrap();
        }
        let whole = 0..paths.len();
        self.layer_joints.fill(whole);
        self.material_normals.resize(paths.len(), Vec3::Y);
        self.rest_positions.resize(paths.len(), Vec3::ZERO);
        self.rest_forwards.resize(paths.len(), Vec3::ZERO);
        self.from_ends = ends_of(&paths);
        self.path_weights.resize(paths.len(), 1.0);
        self.paths = paths;
    }

    pub fn frame(&self) -> Frame<'_> {
        let head = Head {
            center: Vec3::new(0.0, 0.02, 0.0),
            height_m: 0.24,
        };
        let first = Object {
            joints: 0..self
                .second
                .as_ref()
                .map_or(self.paths.len(), |second| second.joints.start),
            head,
            solid: None,
            surface_bias_m: 0.0,
            clump: &self.clump,
            seed: self.seed,
            layers: &self.layers,
            layer_joints: &self.layer_joints,
        };
        let second = self.second.as_ref().map(|second| Object {
            joints: second.joints.clone(),
            head: second.head,
            seed: self.seed + 1,
            // Every other pair's second object are lines on surfaces.
            surface_bias_m: render::ON_SURFACES * (self.seed % 2) as f32,
            layer_joints: &second.layer_joints,
            ..first.clone()
        });
        let objects: Vec<Object> = iter::once(first).chain(second).collect();
        let layers = objects
            .iter()
            .flat_map(|object| object.layers.iter().map(|layer| (layer, object.head)));
        let decals = layers.enumerate().filter_map(|(index, (layer, head))| {
            let clip = layer.clip.as_deref()?;
            Some(Decal {
                layer: index,
                on_hair: clip.contains("hair"),
                // One of the surfaces, or all.
                marks: u32::from(clip.contains("wall")) | (2 * u32::from(clip.contains("head"))),
                reach_m: layer.reach * head.height_m,
                is_shadow: layer.program.casts(),
            })
        });
        Frame {
            camera: &self.camera,
            paths: &self.paths,
            strands: &self.strands,
            decals: decals.collect(),
            objects,
            light: self.light,
            time_s: 0.3,
            material_normals: &self.material_normals,
            rest_positions: &self.rest_positions,
            rest_forwards: &self.rest_forwards,
            from_ends: &self.from_ends,
            path_weights: &self.path_weights,
            marks: &[],
            surfaces: self.surfaces.clone(),
            mesh_layers: self
                .mesh_layers
                .iter()
                .map(|layer| MeshLayer {
                    layer,
                    head,
                    seed: 7,
                })
                .collect(),
            background: self.background,
            order: self.order,
            edge_depth_m: 0.005,
            brush: self.brush,
            features: self.features,
            roundness: 0.7,
            passes: self.passes.clone(),
        }
    }
}

/// An eye in front of the head that sees so many pixels.
pub fn camera(size: [u32; 2]) -> Camera {
    let view = OrbitView {
        target: Vec3::ZERO,
        yaw_degrees: 0.0,
        pitch_degrees: 0.0,
        distance_m: 0.7,
        vertical_fov_degrees: 40.0,
    };
    Camera::orbit(view, size, 0.05).unwrap()
}

/// A device that validates all and draws nothing.
pub fn noop(limits: wgpu::Limits) -> Gpu {
    let (device, queue) = wgpu::Device::noop(&wgpu::DeviceDescriptor {
        required_limits: limits,
        ..Default::default()
    });
    Gpu::with(device, queue)
}

/// A device that draws. Nothing where there is no driver, which is said, and on CI a failure.
pub fn driver() -> Option<Offscreen> {
    match Offscreen::open(AdapterKind::Any) {
        Ok(card) => Some(card),
        Err(GpuError::NoAdapter { .. }) if std::env::var_os("CI").is_none_or(|ci| ci != "true") => {
            eprintln!("SKIPPED: no driver for a graphics card; `cargo xtask setup` installs one");
            None
        }
        Err(error) => panic!("{error}"),
    }
}

/// The same, bare.
pub fn driver_gpu() -> Option<Gpu> {
    driver()?;
    Gpu::open(AdapterKind::Any).ok()
}

fn ends_of(paths: &Paths) -> Vec<Vec2> {
    let mut ends = Vec::new();
    render::from_ends(paths, &mut ends);
    ends
}
