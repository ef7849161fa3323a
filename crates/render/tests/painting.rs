//! Layers that paint: each sample that they show has the colour that the effect says, and no other sample changes.

use effects::preset::Reader;
use effects::{Layer, Parameters, Registry, Values, Varied, clump};
use glam::Vec3;
use render::cpu::{Evaluator, Rasterizer};
use render::{
    Brush, Drawing, EdgeChannel, Edges, Feature, Features, Frame, Head, Light, NO_COLOR, NO_TAPER,
    Object, Order, Picture, Sample, SamplePlanes, StrandInfo,
};
use stroke_path::{Camera, OrbitView, PathKind, Paths};

const STRANDS: usize = 24;
const SIZE: [u32; 2] = [120, 160];

fn layers(text: &str) -> Vec<Layer> {
    let mut registry = Registry::new();
    effects_builtin::register(&mut registry).unwrap();
    effects_cartoon::register(&mut registry).unwrap();
    let mut reader = Reader::new("test", text);
    let specs = reader.layers(text, &registry, &[]);
    reader.report().unwrap();
    specs.iter().map(|spec| spec.build()).collect()
}

/// Strands that hang from a circle around the head's top and curl, drawn by these layers.
fn drawing(list: &str, features: Features) -> Drawing {
    drawing_of(STRANDS, list, features)
}

/// So many of them.
fn drawing_of(count: usize, list: &str, features: Features) -> Drawing {
    let view = OrbitView {
        target: Vec3::ZERO,
        yaw_degrees: 20.0,
        pitch_degrees: 10.0,
        distance_m: 1.6,
        vertical_fov_degrees: 20.0,
    };
    let camera = Camera::orbit(view, SIZE, 0.01).unwrap();
    let mut paths = Paths::new();
    let kind = PathKind::CatmullRom { subdivision: 4 };
    for strand in 0..count {
        let (sine, cosine) = (0.3 * strand as f32).sin_cos();
        let out = Vec3::new(sine, 0.0, cosine);
        let point = |i: usize| {
            let down = 0.05 * i as f32;
            0.1 * out * (1.0 + 0.2 * (8.0 * down).sin()) + Vec3::Y * (0.15 - down)
        };
        let points: Vec<Vec3> = (0..6).map(point).collect();
        paths.push_strand(strand, &points, kind, &camera).unwrap();
    }
    let strands: Vec<StrandInfo> = (0..count as u32)
        .map(|id| StrandInfo {
            id,
            mean: Vec3::ZERO,
            size: 14.0,
            taper: NO_TAPER,
            colors: [NO_COLOR; 2],
            level: 0,
            lift: 0.0,
            left_out_by: 0,
        })
        .collect();
    let clump = Varied::new(&Values::defaults(clump::Program::PARAMS));
    let layers = layers(list);
    let all = vec![0..paths.len(); layers.len()];
    let frame = Frame {
        camera: &camera,
        paths: &paths,
        strands: &strands,
        objects: vec![Object {
            joints: 0..paths.len(),
            head: Head {
                center: Vec3::ZERO,
                height_m: 0.24,
            },
            solid: None,
            surface_bias_m: 0.0,
            clump: &clump,
            seed: 1,
            layers: &layers,
            layer_joints: &all,
        }],
        light: Light::Direction(Vec3::new(0.4, 0.6, 0.7).normalize()),
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
        background: Some([0.5; 3]),
        order: Order::Rounded,
        edge_depth_m: 0.005,
        brush: Brush::Circle,
        features,
        roundness: 1.0,
        passes: Vec::new(),
    };
    let mut drawing = Drawing::default();
    Evaluator::default().evaluate(&frame, &mut drawing).unwrap();
    drawing
}

fn draw(drawing: &Drawing, samples: u32, threads: usize) -> Picture {
    let mut rasterizer = Rasterizer::new(samples, Some(threads)).unwrap();
    rasterizer.draw(drawing).unwrap()
}

/// All samples of a drawing.
fn samples(drawing: &Drawing) -> Vec<Sample> {
    let mut told = Vec::new();
    let mut rasterizer = Rasterizer::new(4, Some(1)).unwrap();
    let mut planes = SamplePlanes::default();
    let take = |planes: &mut SamplePlanes| {
        for picture in 0..planes.samples().len() {
            for y in 0..SIZE[1] as usize {
                told.extend((0..SIZE[0] as usize).map(|x| planes.sample(picture, x, y)));
            }
        }
    };
    rasterizer.draw_samples(drawing, &mut planes, take).unwrap();
    told
}

const LINE: &str = "(effect: \"hair.silhouette\", params: (color: \"0000FF\"))";

/// A layer that paints with these parameters.
fn toon(params: &str) -> String {
    format!("(effect: \"hair.toon\", params: (root_fade: 0, rim_width: 0, {params}))")
}

#[test]
fn paint_that_changes_nothing_is_the_same_picture_bit_for_bit() {
    let plain = drawing(
        &format!("[{LINE}, (effect: \"hair.base\")]"),
        Features::NONE,
    );
    let painted = drawing(
        &format!("[{LINE}, {}]", toon("tones: none")),
        Features::NONE,
    );
    assert!(plain.painting.is_empty() && !painted.painting.is_empty());
    for count in [1, 2, 3, 4, 16] {
        assert_eq!(
            draw(&plain, count, 1),
            draw(&painted, count, 1),
            "{count} samples"
        );
    }
}

#[test]
fn a_sample_is_painted_by_what_it_shows() {
    let told = Features::of(&[Feature::Layer, Feature::Color, Feature::U, Feature::W]);
    for (detail, place) in [
        ("along", (|sample| sample.u) as fn(&Sample) -> f32),
        ("across", |sample| 0.5 + 0.5 * sample.w),
    ] {
        let rows = "[(v: 0, stops: [(0, \"000000\")]), (v: 1, stops: [(0, \"FFFFFF\")])]";
        let layer = toon(&format!("mode: replace, detail: {detail}, tones: {rows}"));
        let samples = samples(&drawing(&format!("[{LINE}, {layer}]"), told));
        let (painted, others): (Vec<&Sample>, Vec<&Sample>) =
            samples.iter().partition(|sample| sample.layer == 1);
        assert!(painted.len() > 3000 && others.len() > 3000);
        for sample in painted {
            let expected = place(sample);
            for light in &sample.color[..3] {
                assert!((light - expected).abs() < 1e-5, "{detail}: {sample:?}");
            }
        }
        for sample in others {
            let line = [0.0, 0.0, 1.0, 1.0];
            assert!(
                [line, [0.5, 0.5, 0.5, 1.0]].contains(&sample.color),
                "{sample:?}"
            );
        }
    }
}

/// What a thread keeps of one drawing says nothing of the next, which may have fewer joints.
#[test]
fn a_rasteriser_paints_any_drawing_after_any_other() {
    let list = format!("[{LINE}, {}]", toon("roundness: (value: 0.5, vary: 0.5)"));
    let drawings = [24, 1, 3].map(|count| drawing_of(count, &list, Features::NONE));
    let mut kept = Rasterizer::new(4, Some(1)).unwrap();
    for drawing in &drawings {
        assert_eq!(kept.draw(drawing).unwrap(), draw(drawing, 4, 1));
    }
}

#[test]
fn threads_change_no_bit() {
    let layer = toon(
        "detail: blinn, exponent: 20, mode: add, tones: [(v: 0, stops: [(0, \"000000\")]), (v: 1, stops: [(0, \"FFFFFF\")])]",
    );
    let drawing = drawing(&format!("[{LINE}, {layer}]"), Features::NONE);
    let one = draw(&drawing, 4, 1);
    for threads in [2, 5] {
        assert_eq!(draw(&drawing, 4, threads), one);
    }
    // Light from the front has highlights: something is painted.
    let dark = toon("tones: [(0, \"000000\")]");
    assert_ne!(
        draw(
            &self::drawing(&format!("[{LINE}, {dark}]"), Features::NONE),
            4,
            1
        ),
        one
    );
}

#[test]
fn lists_that_do_not_fit_are_refused() {
    let mut drawing = drawing(
        &format!("[{LINE}, {}]", toon("detail: along")),
        Features::NONE,
    );
    let mut rasterizer = Rasterizer::new(1, Some(1)).unwrap();
    drawing.painting.joints.u.pop();
    let error = rasterizer.draw(&drawing).unwrap_err().to_string();
    assert!(error.contains("painting: the list `u` has"), "{error}");
    drawing.painting.layers[0].layer = 2;
    let error = rasterizer.draw(&drawing).unwrap_err().to_string();
    assert!(error.contains("layer 2 is not there"), "{error}");
}

/// Lines of that width in a colour between strands.
fn lines(width_px: f32, color: [f32; 3]) -> Edges {
    Edges {
        channel: EdgeChannel::Strand,
        threshold: 0.5,
        step_m: 0.01,
        width_px: effects::Variation::constant(width_px),
        seed: 1,
        fade_to: 0.4,
        color,
    }
}

#[test]
fn lines_are_the_same_whether_or_not_a_pass_asks_for_colours() {
    let thick = lines(9.5, [0.0, 0.5, 1.0]);
    let of = |channel, width_px, color| Edges {
        channel,
        threshold: 0.7,
        ..lines(width_px, color)
    };
    let along = Edges {
        width_px: effects::Variation {
            curve: vec![(0.0, 4.0), (1.0, 1.0)],
            vary: 0.5,
        },
        fade_to: 0.0,
        ..of(EdgeChannel::Level, 1.0, [0.3, 0.6, 0.9])
    };
    let shapes = of(EdgeChannel::Object, 3.0, [1.0, 0.0, 0.0]);
    let folds = of(EdgeChannel::Normal, 1.0, [0.0, 1.0, 0.0]);
    let steps = of(EdgeChannel::Depth, 2.0, [0.0, 0.0, 1.0]);
    // Lines of colours, of which there are none: for them all samples tell their colours.
    let none = Edges {
        channel: EdgeChannel::Color,
        threshold: 1e9,
        ..thick.clone()
    };
    let list = format!("[{LINE}, {}]", toon(""));
    for passes in [
        vec![thick, lines(1.5, [1.0, 0.25, 0.0])],
        vec![along],
        vec![shapes],
        vec![folds, steps.clone()],
        vec![steps],
    ] {
        let features = passes.iter().chain([&none]).map(Edges::features);
        let features = features.fold(Features::NONE, Features::union);
        for (heads, background) in [(1, None), (1, Some([0.5, 0.25, 2.0])), (2, None)] {
            let (mut drawing, mut other) =
                (drawing(&list, features), drawing_of(3, &list, features));
            // Hair of several heads has strands and levels of one number.
            for (run, i) in drawing.features.runs.iter_mut().zip(0..) {
                (run.object, run.strand, run.level) = (i % heads, i / heads, i / heads % 2);
            }
            drawing.background = background;
            other.background = background;
            let plain = draw(&drawing, 4, 1);
            for samples in [1, 2, 3, 4, 5] {
                drawing.passes = [&passes[..], std::slice::from_ref(&none)].concat();
                let expected = draw(&drawing, samples, 1);
                assert_ne!(expected, plain);
                drawing.passes = passes.clone();
                let mut rasterizer = Rasterizer::new(samples, Some(2)).unwrap();
                let found = rasterizer.draw(&drawing).unwrap();
                let what =
                    format!("{samples} samples on {background:?}, {heads} heads: {passes:?}");
                assert!(found == expected, "{what}");
                // In the memory of a picture of less.
                other.passes = passes.clone();
                rasterizer.give_back(found);
                let found = rasterizer.draw(&other).unwrap();
                rasterizer.give_back(found);
                let found = rasterizer.draw(&drawing).unwrap();
                assert!(found == expected, "{what}");
            }
        }
    }
}
