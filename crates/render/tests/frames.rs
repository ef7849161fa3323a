//! Frames that a program made itself, and made wrong, are refused in words.

use effects::preset::Reader;
use effects::{Layer, Parameters, Registry, Values, Varied, clump};
use glam::{Vec2, Vec3};
use render::cpu::Evaluator;
use render::{
    Brush, Drawing, Frame, FrameError, Head, Light, NO_COLOR, NO_TAPER, Object, Order, StrandInfo,
};
use std::ops::Range;
use stroke_path::{Camera, OrbitView, PathKind, Paths};

/// Two heads with two strands each, of two joints.
struct Scene {
    camera: Camera,
    paths: Paths,
    strands: Vec<StrandInfo>,
    clump: Varied<clump::Program>,
    layers: Vec<Layer>,
    /// Of each object all of its joints, and those of each layer.
    joints: [(Range<usize>, Vec<Range<usize>>); 2],
    heads: [Head; 2],
    light: Light,
    time_s: f32,
    normals: Vec<Vec3>,
    rest_positions: Vec<Vec3>,
    rest_forwards: Vec<Vec3>,
    from_ends: Vec<Vec2>,
    path_weights: Vec<f32>,
    surface_bias_m: f32,
}

impl Scene {
    fn new() -> Self {
        let view = OrbitView {
            target: Vec3::ZERO,
            yaw_degrees: 0.0,
            pitch_degrees: 0.0,
            distance_m: 2.0,
            vertical_fov_degrees: 30.0,
        };
        let camera = Camera::orbit(view, [80, 60], 0.01).unwrap();
        let mut paths = Paths::new();
        for strand in 0..4 {
            let x = 0.1 * strand as f32 - 0.15;
            let points = [Vec3::new(x, 0.1, 0.0), Vec3::new(x, -0.1, 0.0)];
            let kind = PathKind::Linear { subdivision: 1 };
            paths.push_strand(strand, &points, kind, &camera).unwrap();
        }
        let strand = |id| StrandInfo {
            id,
            mean: Vec3::ZERO,
            size: 10.0,
            taper: NO_TAPER,
            colors: [NO_COLOR; 2],
            level: 0,
            lift: 0.0,
            left_out_by: 0,
        };
        let mut registry = Registry::new();
        effects_builtin::register(&mut registry).unwrap();
        let text = "[(effect: \"hair.silhouette\"), (effect: \"hair.base\")]";
        let mut reader = Reader::new("test", text);
        let specs = reader.layers(text, &registry, &[]);
        reader.report().unwrap();
        let head = |x| Head {
            center: Vec3::new(x, 0.0, -0.1),
            height_m: 0.3,
        };
        let of_object = |joints: Range<usize>| (joints.clone(), vec![joints; 2]);
        Self {
            camera,
            paths,
            strands: (0..4).map(strand).collect(),
            clump: Varied::new(&Values::defaults(clump::Program::PARAMS)),
            layers: specs.iter().map(|spec| spec.build()).collect(),
            joints: [of_object(0..4), of_object(4..8)],
            heads: [head(-0.1), head(0.1)],
            light: Light::Direction(Vec3::Z),
            time_s: 0.0,
            normals: Vec::new(),
            rest_positions: Vec::new(),
            rest_forwards: Vec::new(),
            from_ends: Vec::new(),
            path_weights: Vec::new(),
            surface_bias_m: 0.0,
        }
    }

    fn frame(&self) -> Frame<'_> {
        let object = |index: usize| Object {
            joints: self.joints[index].0.clone(),
            head: self.heads[index],
            solid: None,
            surface_bias_m: self.surface_bias_m,
            clump: &self.clump,
            seed: 1,
            layers: &self.layers,
            layer_joints: &self.joints[index].1,
        };
        Frame {
            camera: &self.camera,
            paths: &self.paths,
            strands: &self.strands,
            objects: vec![object(0), object(1)],
            light: self.light,
            time_s: self.time_s,
            material_normals: &self.normals,
            rest_positions: &self.rest_positions,
            rest_forwards: &self.rest_forwards,
            from_ends: &self.from_ends,
            path_weights: &self.path_weights,
            marks: &[],
            surfaces: Vec::new(),
            mesh_layers: Vec::new(),
            decals: Vec::new(),
            background: None,
            order: Order::Rounded,
            edge_depth_m: 0.005,
            brush: Brush::Circle,
            features: render::Features::NONE,
            roundness: 1.0,
            passes: Vec::new(),
        }
    }
}

/// What is said of the scene after a change; the drawing stays what it was.
fn refused(change: impl FnOnce(&mut Scene)) -> FrameError {
    let mut scene = Scene::new();
    change(&mut scene);
    let mut drawing = Drawing::default();
    let error = Evaluator::default().evaluate(&scene.frame(), &mut drawing);
    assert_eq!(drawing, Drawing::default());
    error.unwrap_err()
}

#[test]
fn each_object_is_drawn_on_its_own_joints() {
    let scene = Scene::new();
    let mut drawing = Drawing::default();
    Evaluator::default()
        .evaluate(&scene.frame(), &mut drawing)
        .unwrap();
    let joints: Vec<Range<usize>> = drawing.layers.iter().map(|l| l.joints.clone()).collect();
    assert_eq!(joints, [0..4, 0..4, 4..8, 4..8]);
    assert_eq!(drawing.layers[1].discs[..4], drawing.clump[..4]);
    assert_eq!(drawing.layers[3].discs[..4], drawing.clump[4..]);
}

#[test]
fn a_layer_draws_nothing_on_strands_that_it_leaves_out() {
    let mut scene = Scene::new();
    let drawings = [0b00, 0b10].map(|left_out_by| {
        scene.strands[1].left_out_by = left_out_by;
        let mut drawing = Drawing::default();
        let mut evaluator = Evaluator::default();
        evaluator.evaluate(&scene.frame(), &mut drawing).unwrap();
        drawing
    });
    let [all, some] = drawings;
    assert_eq!(some.clump, all.clump, "its clump is there for the others");
    for (layer, (all, some)) in all.layers.iter().zip(&some.layers).enumerate() {
        let (all, some) = (all.on(0, &all.joints), some.on(0, &some.joints));
        let drawn: Vec<Range<usize>> = some.map(|stretch| stretch.joints).collect();
        // Strand 1 has the joints 2 and 3; layer 1 is the first object's second.
        let mut expected: Vec<Range<usize>> = all.map(|stretch| stretch.joints).collect();
        if layer == 1 {
            expected[0] = 0..2;
        }
        assert_eq!(drawn, expected, "layer {layer}");
    }
}

#[test]
fn a_head_measures_its_own_hair_alone() {
    let mut scene = Scene::new();
    let mut drawings = [Drawing::default(), Drawing::default()];
    for drawing in &mut drawings {
        let mut evaluator = Evaluator::default();
        evaluator.evaluate(&scene.frame(), drawing).unwrap();
        scene.heads[1].height_m = 0.6;
    }
    let [small, large] = drawings;
    assert_eq!(small.clump[..4], large.clump[..4]);
    for (a, b) in small.clump[4..].iter().zip(&large.clump[4..]) {
        assert!(
            (b.radius - 2.0 * a.radius).abs() <= 1e-4 * b.radius,
            "{a:?} {b:?}"
        );
    }
}

#[test]
fn joints_belong_to_one_object() {
    let split = |first: Range<usize>, second: Range<usize>| {
        refused(|scene| {
            for (object, joints) in scene.joints.iter_mut().zip([first, second]) {
                object.1.fill(joints.clone());
                object.0 = joints;
            }
        })
    };
    for (first, second) in [
        (0..4, 5..8),
        (0..3, 3..8),
        (0..4, 4..6),
        (0..4, 4..10),
        (2..4, 4..8),
    ] {
        let error = split(first, second);
        assert!(matches!(error, FrameError::ObjectJoints { .. }), "{error}");
    }
    let error = refused(|scene| scene.joints[1].1[0] = 2..8);
    assert!(matches!(error, FrameError::LayerJoints { object: 1, .. }));
    assert!(error.to_string().contains("hair.silhouette"), "{error}");
    let error = refused(|scene| scene.joints[0].1[1] = 0..1);
    assert!(matches!(error, FrameError::LayerJoints { object: 0, .. }));
    let error = refused(|scene| scene.joints[0].1.truncate(1));
    assert!(matches!(
        error,
        FrameError::Layers {
            layers: 2,
            ranges: 1,
            ..
        }
    ));
}

#[test]
fn strands_and_paths_are_whole() {
    let error = refused(|scene| scene.strands.truncate(3));
    assert!(matches!(
        error,
        FrameError::Strand {
            run: 3,
            strand: 3,
            strands: 3
        }
    ));
    for size in [f32::NAN, f32::INFINITY, -1.0] {
        let error = refused(|scene| scene.strands[2].size = size);
        assert!(matches!(error, FrameError::StrandNumbers { strand: 2, .. }));
    }
    let error = refused(|scene| scene.strands[0].mean.x = f32::NAN);
    assert!(matches!(error, FrameError::StrandNumbers { strand: 0, .. }));
    let error = refused(|scene| scene.paths.depth.truncate(7));
    assert_eq!(
        error.to_string(),
        "the paths have 8 joints, but 7 in the list `depth`"
    );
    for joints in [1..4, 2..2, 2..99] {
        let error = refused(|scene| scene.paths.runs[1].joints = joints);
        assert!(matches!(error, FrameError::Run { run: 1, .. }), "{error}");
    }
    let error = refused(|scene| scene.paths.runs[1].overlap = 3);
    assert!(matches!(error, FrameError::Run { run: 1, .. }));
    // A joint behind the last run, pieces out of order.
    let error = refused(|scene| scene.paths.runs.truncate(3));
    assert_eq!(
        error.to_string(),
        "the paths have 8 joints, but 6 in the list `runs`"
    );
    let error = refused(|scene| scene.paths.runs[1].piece = 9);
    assert!(matches!(error, FrameError::Piece { run: 2, .. }), "{error}");
    let error = refused(|scene| scene.normals = vec![Vec3::Y; 7]);
    assert!(matches!(
        error,
        FrameError::MaterialNormals { normals: 7, .. }
    ));
    let error = refused(|scene| scene.from_ends = vec![Vec2::ZERO; 9]);
    assert!(matches!(error, FrameError::FromEnds { ends: 9, .. }));
    let error = refused(|scene| scene.path_weights = vec![1.0; 3]);
    assert!(matches!(error, FrameError::PathWeights { weights: 3, .. }));
    for bias_m in [-1.0, f32::NAN, f32::INFINITY] {
        let error = refused(|scene| scene.surface_bias_m = bias_m);
        assert!(matches!(error, FrameError::SurfaceBias { object: 0, .. }));
    }
    let error = refused(|scene| scene.rest_positions = vec![Vec3::Y; 7]);
    assert!(matches!(
        error,
        FrameError::RestPositions { positions: 7, .. }
    ));
    let error = refused(|scene| scene.rest_forwards = vec![Vec3::Y; 7]);
    assert!(matches!(
        error,
        FrameError::RestForwards { forwards: 7, .. }
    ));
}

#[test]
fn strands_are_whole_in_their_ranges() {
    // The second object would begin with a strand's second piece.
    let error = refused(|scene| scene.paths.runs[2].overlap = 1);
    assert!(matches!(error, FrameError::ObjectJoints { .. }), "{error}");
    let error = refused(|scene| {
        scene.paths.runs[1].overlap = 1;
        scene.joints[0].1[0] = 2..4;
    });
    assert!(matches!(error, FrameError::LayerJoints { .. }), "{error}");
    // No object has these joints.
    let mut scene = Scene::new();
    scene.joints[1].0 = 4..4;
    scene.joints[1].1.fill(4..4);
    let mut evaluator = Evaluator::default();
    let error = evaluator.evaluate(&scene.frame(), &mut Drawing::default());
    assert!(matches!(error, Err(FrameError::ObjectJoints { .. })));
    let scene = Scene::new();
    let nobody = Frame {
        objects: Vec::new(),
        ..scene.frame()
    };
    let error = evaluator.evaluate(&nobody, &mut Drawing::default());
    assert!(matches!(
        error,
        Err(FrameError::ObjectJoints { object: 0, .. })
    ));
}

#[test]
fn heads_and_light_are_somewhere() {
    for height_m in [0.0, -0.2, f32::NAN, f32::INFINITY] {
        let error = refused(|scene| scene.heads[1].height_m = height_m);
        assert!(matches!(error, FrameError::Head { object: 1, .. }));
    }
    let error = refused(|scene| scene.heads[0].center.y = f32::INFINITY);
    assert!(matches!(error, FrameError::Head { object: 0, .. }));
    let error = refused(|scene| scene.light = Light::Point(Vec3::NAN));
    assert_eq!(error, FrameError::Light);
    let error = refused(|scene| scene.time_s = f32::INFINITY);
    assert_eq!(error, FrameError::Time(f32::INFINITY));
}
