//! A frame's joints become discs of the right place, size and depth.

use effects::preset::Reader;
use effects::{Layer, Parameters, Registry, Values, Varied, clump};
use glam::{Vec2, Vec3};
use render::cpu::Evaluator;
use render::{Brush, Drawing, Frame, Head, Light, NO_COLOR, NO_TAPER, Object, Order, StrandInfo};
use stroke_path::{Camera, OrbitView, PathKind, Paths};

/// The picture is 200 x 360, the eye 2 m in front of the origin, a 0.3 m head: a unit is 1 mm.
fn camera() -> Camera {
    let view = OrbitView {
        target: Vec3::ZERO,
        yaw_degrees: 0.0,
        pitch_degrees: 0.0,
        distance_m: 2.0,
        vertical_fov_degrees: 30.0,
    };
    Camera::orbit(view, [200, 360], 0.01).unwrap()
}

fn layers(text: &str) -> Vec<Layer> {
    let mut registry = Registry::new();
    effects_builtin::register(&mut registry).unwrap();
    let mut reader = Reader::new("test", text);
    let specs = reader.layers(text, &registry, &[]);
    reader.report().unwrap();
    specs.iter().map(|spec| spec.build()).collect()
}

/// The drawing of two strands that hang at x = 0 and x = 0.1, of size 20, drawn by these layers.
fn drawing(list: &str, clump: &[(&str, &str)], seed: u32) -> (Drawing, Camera) {
    drawing_with(list, clump, seed, Brush::Circle)
}

fn drawing_with(list: &str, clump: &[(&str, &str)], seed: u32, brush: Brush) -> (Drawing, Camera) {
    let layers = layers(list).len();
    drawing_on(list, clump, seed, brush, &vec![0..4; layers])
}

fn drawing_on(
    list: &str,
    clump: &[(&str, &str)],
    seed: u32,
    brush: Brush,
    layer_joints: &[std::ops::Range<usize>],
) -> (Drawing, Camera) {
    let colors = [[NO_COLOR; 2]; 2];
    drawing_of(list, clump, seed, brush, layer_joints, colors)
}

/// `layer_joints` are the joints that each layer draws on, `colors` the strands' own.
fn drawing_of(
    list: &str,
    clump: &[(&str, &str)],
    seed: u32,
    brush: Brush,
    layer_joints: &[std::ops::Range<usize>],
    colors: [[Vec3; 2]; 2],
) -> (Drawing, Camera) {
    let camera = camera();
    let mut paths = Paths::new();
    let kind = PathKind::Linear { subdivision: 1 };
    for (i, x) in [0.0, 0.1].into_iter().enumerate() {
        let points = [Vec3::new(x, 0.1, 0.0), Vec3::new(x, 0.0, 0.5)];
        paths.push_strand(i, &points, kind, &camera).unwrap();
    }
    let strand = |id, colors| StrandInfo {
        id,
        mean: Vec3::ZERO,
        size: 20.0,
        taper: NO_TAPER,
        colors,
        level: 0,
        lift: 0.0,
        left_out_by: 0,
    };
    let mut values = Values::defaults(clump::Program::PARAMS);
    let plain = [
        ("size_variation", "0"),
        ("mix", "1"),
        ("mix_variation", "0"),
        ("shrink_start", "1"),
        ("flatness", "0"),
    ];
    for (name, text) in plain.iter().chain(clump) {
        values.set_text("clump", name, text).unwrap();
    }
    let layers = layers(list);
    let clump = Varied::new(&values);
    let frame = Frame {
        camera: &camera,
        paths: &paths,
        strands: &[strand(3, colors[0]), strand(8, colors[1])],
        objects: vec![Object {
            joints: 0..4,
            head: Head {
                center: Vec3::ZERO,
                height_m: 0.3,
            },
            solid: None,
            surface_bias_m: 0.0,
            clump: &clump,
            seed,
            layers: &layers,
            layer_joints,
        }],
        light: Light::Direction(Vec3::Z),
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
        background: None,
        order: Order::Rounded,
        edge_depth_m: 0.005,
        brush,
        features: render::Features::NONE,
        roundness: 1.0,
        passes: Vec::new(),
    };
    let mut drawing = Drawing::default();
    Evaluator::default().evaluate(&frame, &mut drawing).unwrap();
    (drawing, camera)
}

#[track_caller]
fn assert_near(a: f32, b: f32) {
    assert!((a - b).abs() <= 1e-4 * b.abs().max(1e-3), "{a} is not {b}");
}

#[test]
fn discs_lie_where_the_joints_are_seen() {
    let (drawing, camera) = drawing("[(effect: \"hair.base\")]", &[], 1);
    assert_eq!(drawing.size, [200, 360]);
    let numbers: Vec<u32> = drawing.runs.iter().map(|run| run.strand).collect();
    assert_eq!(numbers, [0, 1]);
    let root = drawing.layers[0].discs[0];
    let place = camera.project(camera.view_from_world(Vec3::new(0.0, 0.1, 0.0)));
    assert_eq!(root.center, place);
    // 20 units of 1 mm, 2 m away.
    assert_near(root.radius, 0.020 * camera.focal_px() / 2.0);
    assert_near(root.inv_depth, 1.0 / 2.0);
    // Against surfaces it stands nearer by the clump's radius.
    assert_near(root.inv_depth_biased, 1.0 / (2.0 - 0.020));
    let tip = drawing.layers[0].discs[1];
    assert_near(tip.radius, 0.020 * camera.focal_px() / 1.5);
    assert_eq!(drawing.clump[1], tip, "the base is the clump");
}

#[test]
fn depth_offsets_count_among_strands_and_not_against_the_head() {
    let list = "[(effect: \"hair.silhouette\", depth_offset: 0.1)]";
    let (drawing, _) = drawing(list, &[], 1);
    let root = drawing.layers[0].discs[0];
    assert_near(root.inv_depth, 1.0 / (2.0 + 0.1 * 0.3));
    assert_near(root.inv_depth_biased, 1.0 / (2.0 - 0.020));
    assert_eq!(drawing.layers[0].rank, -100);
}

#[test]
fn widths_are_units_of_the_head_or_pixels_at_720_lines() {
    let radii = |units: &str, joint: usize| {
        let list = format!(
            "[(effect: \"hair.silhouette\", units: {units}, params: (width: 4, ratio: 10, root_fade: 0))]"
        );
        let (drawing, _) = drawing(&list, &[], 1);
        let discs = &drawing.layers[0].discs;
        (discs[joint].radius, drawing.clump[joint].radius)
    };
    for joint in [0, 1] {
        let (with_line, clump) = radii("world", joint);
        assert_near(with_line - clump, 4.0 / 20.0 * clump);
        let (with_line, clump) = radii("pixels", joint);
        assert_near(with_line - clump, 4.0 * 360.0 / 720.0);
    }
}

#[test]
fn lines_are_never_wider_than_their_share_of_the_clump() {
    let list = "[(effect: \"hair.silhouette\", params: (width: 100, ratio: 0.5, root_fade: 0))]";
    let (drawing, _) = drawing(list, &[], 1);
    let line = drawing.layers[0].discs[0].radius;
    assert_near(line, 1.5 * drawing.clump[0].radius);
}

#[test]
fn variations_hang_on_seed_and_strand() {
    let radii = |seed: u32| {
        let varied = [("size_variation", "0.5")];
        let (drawing, _) = drawing("[(effect: \"hair.base\")]", &varied, seed);
        [0, 2].map(|joint| drawing.clump[joint].radius)
    };
    let [first, second] = radii(1);
    assert_ne!(first, second, "strands differ");
    assert_eq!(radii(1), [first, second], "and stay the same");
    assert_ne!(radii(2), [first, second], "but for another seed");
}

#[test]
fn what_faces_the_light_is_bright() {
    let diffuse = [
        ("shading", "diffuse"),
        ("ambient", "0"),
        ("color", "FFFFFF"),
        ("center_shift", "0"),
    ];
    let list = "[(effect: \"hair.base\", params: (brightness: 0.5))]";
    let (drawing, _) = drawing(list, &diffuse, 1);
    // At the tip O points forward, and so does B's reverse, a little down: what is left of O across
    // the strand points up, and forward by the sine of the slope.
    let sine = Vec2::new(0.5, 0.1).normalize().y;
    let [red, green, blue] = drawing.layers[0].colors[1];
    assert_near(red, 0.5 * sine);
    assert_eq!([green, blue], [red; 2]);
    assert_eq!(
        drawing.layers[0].colors.len(),
        4,
        "round clumps have no sides"
    );
}

#[test]
fn outlines_go_around_flat_ends() {
    let list = "[(effect: \"hair.silhouette\", params: (width: 4, ratio: 10, root_fade: 0)), (effect: \"hair.base\")]";
    let (round, _) = drawing(list, &[], 1);
    let (flat, _) = drawing_with(list, &[], 1, Brush::Semicircle);
    let [outline, base] = [0, 1].map(|layer| &flat.layers[layer].discs);
    assert_eq!(
        *base, round.layers[1].discs,
        "the base is as wide as its clump"
    );
    assert_eq!(outline[0], round.layers[0].discs[0], "only tips move");
    // The strand comes towards the eye and down, so ahead of its tip is below.
    let wider = outline[1].radius - base[1].radius;
    let moved = outline[1].center - base[1].center;
    assert_near(moved.length(), wider);
    let way = base[1].center - base[0].center;
    assert_near(moved.dot(way.normalize()), wider);
}

#[test]
fn a_layer_draws_on_its_own_paths_alone() {
    let list = "[(effect: \"hair.base\"), (effect: \"hair.fine\", params: (width: 4, width_variation: 0, taper: 0))]";
    // As if the second strand were a path that the second layer made.
    let (drawing, _) = drawing_on(list, &[], 1, Brush::Circle, &[0..2, 2..4]);
    let [base, fine] = [0, 1].map(|layer| &drawing.layers[layer]);
    assert_eq!([&base.joints, &fine.joints], [&(0..2), &(2..4)]);
    let is_drawn = |disc: &render::Disc| disc.radius > 0.0;
    assert!(base.discs[..2].iter().all(is_drawn));
    assert!(
        !base.discs[2..].iter().any(is_drawn),
        "no sides of round clumps"
    );
    assert!(fine.discs.iter().all(is_drawn));
    assert_eq!(drawing.clump[..2], base.discs[..2]);
    assert_eq!(drawing.clump[2..], fine.discs[..]);
    // 4 mm wide, 2 m and 1.5 m away.
    assert_near(
        drawing.clump[2].radius / drawing.clump[0].radius,
        2.0 / 20.0,
    );
}

#[test]
fn numbers_vary_along_the_strand_and_from_strand_to_strand() {
    let list = "[(effect: \"hair.silhouette\", params: (ratio: 10, root_fade: 0, width: (curve: [(0, 2), (1, 6)])))]";
    let (drawing, _) = drawing(list, &[("size", "(value: 1, vary: 0.5)")], 1);
    let (outline, clump) = (&drawing.layers[0].discs, &drawing.clump);
    // The clump's sizes differ by strand alone; lines are 2 units at the root and 6 at the tip.
    let sizes = [0, 2].map(|joint| clump[joint].radius);
    assert_ne!(sizes[0], sizes[1]);
    let plain = drawing_with(list, &[], 1, Brush::Circle).0;
    for joint in 0..4 {
        let full = plain.clump[joint].radius;
        let part = clump[joint].radius / full;
        assert!((0.5..=1.5).contains(&part));
        assert_near(
            part,
            clump[joint / 2 * 2].radius / plain.clump[joint / 2 * 2].radius,
        );
        let width = [2.0, 6.0][joint % 2] / 20.0 * full;
        assert_near(outline[joint].radius - clump[joint].radius, width);
    }
}

#[test]
fn strands_have_colors_of_their_own_from_root_to_tip() {
    let [red, blue] = [Vec3::new(1.0, 0.0, 0.0), Vec3::new(0.0, 0.0, 1.0)];
    let colors = |clump: &[(&str, &str)], own: [[Vec3; 2]; 2]| {
        let clump = [&[("color", "000000")], clump].concat();
        let layer = "[(effect: \"hair.base\")]";
        let (drawing, _) = drawing_of(
            layer,
            &clump,
            1,
            Brush::Circle,
            std::slice::from_ref(&(0..4)),
            own,
        );
        drawing.layers[0].colors[..4].to_vec()
    };
    let [black, r, b] = [[0.0; 3], red.to_array(), blue.to_array()];
    let none = [NO_COLOR; 2];
    assert_eq!(colors(&[], [none; 2]), [black; 4]);
    assert_eq!(colors(&[], [none, [red, NO_COLOR]]), [black, black, r, r]);
    // Roots and tips: there are no other joints.
    let dyed = [("tip_color", "0000FF")];
    assert_eq!(colors(&dyed, [none, [red, NO_COLOR]]), [black, b, r, b]);
    assert_eq!(colors(&dyed, [[NO_COLOR, red], [red; 2]]), [black, r, r, r]);
    assert_eq!(
        colors(&[("tip_color", "0000FF"), ("tip_length", "0")], [none; 2]),
        [black; 4]
    );
}
