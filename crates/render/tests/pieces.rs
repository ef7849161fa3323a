//! A strand that is cut into pieces looks as the whole strand does, but where it crosses itself.

use effects::preset::Reader;
use effects::{Layer, Parameters, Registry, Values, Varied, clump};
use glam::Vec3;
use render::cpu::{Evaluator, Rasterizer};
use render::{
    Brush, Disc, Drawing, Frame, Head, LayerStrokes, Light, NO_COLOR, NO_TAPER, Object, Order,
    Picture, StrandInfo,
};
use stroke_path::{Camera, OrbitView, PathKind, Paths, cuts};

const SPLINE: PathKind = PathKind::CatmullRom { subdivision: 5 };
/// 1/300 of the head's height of 0.3 m: millimetres.
const SIZE: f32 = 8.0;
const LAYERS: &str = r#"[
    (effect: "hair.silhouette", depth_offset: 0.02, params: (width: 2, color: "000000")),
    (effect: "hair.base"),
    (effect: "hair.cel", params: (color: "2A8F9D", threshold: 0.5, full: 0.3)),
    (effect: "hair.highlight", params: (kind: specular, exponent: 2, threshold: 0.2, full: 0.5, color: "FFFFFF")),
]"#;

fn camera(pitch_degrees: f32) -> Camera {
    let view = OrbitView {
        target: Vec3::ZERO,
        yaw_degrees: 0.0,
        pitch_degrees,
        distance_m: 0.8,
        vertical_fov_degrees: 30.0,
    };
    Camera::orbit(view, [360, 480], 0.01).unwrap()
}

fn layers() -> Vec<Layer> {
    let mut registry = Registry::new();
    effects_builtin::register(&mut registry).unwrap();
    let mut reader = Reader::new("test", LAYERS);
    let specs = reader.layers(LAYERS, &registry, &[]);
    reader.report().unwrap();
    specs.iter().map(|spec| spec.build()).collect()
}

/// Four turns around an upright line.
fn ringlet() -> Vec<Vec3> {
    let at = |i: i32| {
        let (sin, cos) = (std::f32::consts::TAU * i as f32 / 16.0).sin_cos();
        Vec3::new(0.04 * cos, 0.16 - 0.32 * i as f32 / 64.0, 0.04 * sin)
    };
    (0..=64).map(at).collect()
}

/// The strand's paths, and its drawing; cut or whole.
fn drawing(strand: &[Vec3], camera: &Camera, is_cut: bool, order: Order) -> (Paths, Drawing) {
    let overlap_m = 3.0 * SIZE * 1e-3;
    let cuts = if is_cut {
        cuts(strand, SPLINE, overlap_m).unwrap()
    } else {
        Vec::new()
    };
    assert!(!is_cut || cuts.len() >= 2);
    let mut paths = Paths::new();
    paths
        .push_pieces(0, strand, &cuts, None, SPLINE, camera)
        .unwrap();
    let mut values = Values::defaults(clump::Program::PARAMS);
    let plain = [
        ("size_variation", "0"),
        ("mix", "1"),
        ("color", "\"3FC1C0\""),
    ];
    for (name, text) in plain {
        values.set_text("clump", name, text).unwrap();
    }
    let layers = layers();
    let joints = 0..paths.len();
    let layer_joints = vec![joints.clone(); layers.len()];
    let clump = Varied::new(&values);
    let frame = Frame {
        camera,
        paths: &paths,
        strands: &[StrandInfo {
            id: 5,
            mean: Vec3::ZERO,
            size: SIZE,
            taper: NO_TAPER,
            colors: [NO_COLOR; 2],
            level: 0,
            lift: 0.0,
            left_out_by: 0,
        }],
        objects: vec![Object {
            joints,
            head: Head {
                center: Vec3::new(0.0, 0.0, -0.3),
                height_m: 0.3,
            },
            solid: None,
            surface_bias_m: 0.0,
            clump: &clump,
            seed: 1,
            layers: &layers,
            layer_joints: &layer_joints,
        }],
        light: Light::Direction(Vec3::new(0.6, 0.6, 0.53).normalize()),
        time_s: 0.0,
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
        order,
        edge_depth_m: 0.006,
        brush: Brush::Circle,
        features: render::Features::NONE,
        roundness: 1.0,
        passes: Vec::new(),
    };
    let mut drawing = Drawing::default();
    Evaluator::default().evaluate(&frame, &mut drawing).unwrap();
    (paths, drawing)
}

fn picture(strand: &[Vec3], camera: &Camera, is_cut: bool, order: Order) -> Picture {
    let (_, drawing) = drawing(strand, camera, is_cut, order);
    let mut rasterizer = Rasterizer::new(4, Some(2)).unwrap();
    rasterizer.draw(&drawing).unwrap()
}

/// Pixels that differ by more than a tenth in a channel.
fn differing(a: &Picture, b: &Picture) -> usize {
    let differ =
        |(a, b): &(&[f32; 4], &[f32; 4])| a.iter().zip(*b).any(|(a, b)| (a - b).abs() > 0.1);
    a.pixels.iter().zip(&b.pixels).filter(differ).count()
}

/// Pixels that are mostly line.
fn lines(picture: &Picture) -> usize {
    picture.pixels.iter().filter(|pixel| pixel[1] < 0.1).count()
}

/// What a stroke is at a joint, if anything.
fn at(layer: &LayerStrokes, instance: usize, joint: usize) -> Option<(Disc, [f32; 3])> {
    let stretch = layer.on(instance, &(joint..joint + 1)).next()?;
    Some((layer.discs[stretch.first], layer.colors[stretch.first]))
}

#[test]
fn pieces_have_the_strokes_of_the_strand() {
    let (strand, camera) = (ringlet(), camera(20.0));
    let (whole_paths, whole) = drawing(&strand, &camera, false, Order::Rounded);
    let (paths, pieces) = drawing(&strand, &camera, true, Order::Rounded);
    assert!(paths.len() > whole_paths.len());
    for (of_pieces, of_whole) in pieces.layers.iter().zip(&whole.layers) {
        assert!(of_whole.discs.iter().any(|disc| disc.radius > 0.0));
        for instance in 0..of_whole.instances {
            for i in 0..paths.len() {
                let j = whole_paths.u.partition_point(|u| *u < paths.u[i]);
                let (a, b) = (at(of_pieces, instance, i), at(of_whole, instance, j));
                // Lengths add up from different joints on.
                let radius = |place: &Option<(Disc, _)>| place.map_or(0.0, |(disc, _)| disc.radius);
                let name = &of_whole.name;
                assert!((radius(&a) - radius(&b)).abs() < 1e-3, "{name}");
                if let (Some((a, a_color)), Some((b, b_color))) = (a, b) {
                    assert_eq!(a.center, b.center, "{name}");
                    assert_eq!(a_color, b_color);
                }
            }
        }
    }
}

#[test]
fn no_cut_shows_where_a_strand_does_not_cross_itself() {
    // From the side the windings lie one below the other; only where they turn at the sides do they overlap.
    let camera = camera(0.0);
    for order in Order::ALL {
        let whole = picture(&ringlet(), &camera, false, order);
        let pieces = picture(&ringlet(), &camera, true, order);
        let inked = whole.pixels.iter().filter(|pixel| pixel[0] < 0.9).count();
        let differing = differing(&whole, &pieces);
        assert!(
            differing * 100 < inked,
            "{order:?}: {differing} of {inked} pixels"
        );
    }
}

#[test]
fn windings_outline_each_other() {
    let camera = camera(35.0);
    for order in [Order::Rounded, Order::StrandFirst] {
        let whole = picture(&ringlet(), &camera, false, order);
        let pieces = picture(&ringlet(), &camera, true, order);
        assert!(lines(&pieces) > lines(&whole) + 100);
    }
}
