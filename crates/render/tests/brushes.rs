//! Brushes: what they leave bare is as if the stroke weren't there, and what they cover is as ever.

use effects::preset::Reader;
use effects::{
    BrushSection, BrushTexture, Image, Layer, Parameters, Registry, Values, Varied, clump,
};
use glam::Vec3;
use proptest::prelude::*;
use render::cpu::{Evaluator, Rasterizer};
use render::{
    AlongStrand, Brush, Decal, DrawError, Drawing, Features, Frame, Head, Light, NO_COLOR,
    NO_TAPER, Object, Order, Picture, StrandInfo, scatter,
};
use std::sync::Arc;
use stroke_path::{Camera, OrbitView, PathKind, Paths};

const SIZE: [u32; 2] = [120, 160];

/// A brush that covers everything alike.
fn even(coverage: f32) -> Option<Arc<BrushTexture>> {
    let image = Image::of_coverage([4, 2], &[coverage; 8]).unwrap();
    let section = BrushSection::default();
    let brush = BrushTexture::of_picture(&section, &image).unwrap();
    // Of a picture that is opaque all over what is dark covers.
    let brush = match coverage {
        1.0 => BrushTexture::of_picture(
            &section,
            &Image::from_srgb([1, 1], &[0, 0, 0, u16::MAX]).unwrap(),
        )
        .unwrap(),
        _ => brush,
    };
    Some(Arc::new(brush))
}

fn tool(text: &str) -> Option<Arc<BrushTexture>> {
    let mut reader = Reader::new("test", text);
    let section: BrushSection = reader.section(text, "brush");
    reader.report().unwrap();
    BrushTexture::of_tool(&section).map(Arc::new)
}

/// Layers of a list, of which those of that name have this brush.
fn layers(text: &str, name: &str, brush: Option<Arc<BrushTexture>>) -> Vec<Layer> {
    let mut registry = Registry::new();
    effects_builtin::register(&mut registry).unwrap();
    let mut reader = Reader::new("test", text);
    let specs = reader.layers(text, &registry, &[]);
    reader.report().unwrap();
    let mut layers: Vec<Layer> = specs.iter().map(|spec| spec.build()).collect();
    let is_meant = |layer: &&mut Layer| layer.name == name;
    layers
        .iter_mut()
        .filter(is_meant)
        .for_each(|layer| layer.brush.clone_from(&brush));
    layers
}

/// Strands that hang from a circle around the head's top and curl, drawn by these layers.
fn drawing(layers: &[Layer], order: Order) -> Drawing {
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
    let count = 24;
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
    let strand = |id| StrandInfo {
        id,
        mean: Vec3::ZERO,
        size: 24.0,
        taper: NO_TAPER,
        colors: [NO_COLOR; 2],
        level: 0,
        lift: 0.0,
        left_out_by: 0,
    };
    let strands: Vec<StrandInfo> = (0..count as u32).map(strand).collect();
    let clump = Varied::new(&Values::defaults(clump::Program::PARAMS));
    let all = vec![0..paths.len(); layers.len()];
    let decals = layers
        .iter()
        .enumerate()
        .filter(|(_, layer)| layer.is_decal());
    let decals = decals.map(|(index, layer)| Decal {
        layer: index,
        on_hair: true,
        marks: 0,
        reach_m: 0.24 * layer.reach,
        is_shadow: layer.program.casts(),
    });
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
            layers,
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
        decals: decals.collect(),
        background: Some([0.5; 3]),
        order,
        edge_depth_m: 0.005,
        brush: Brush::Circle,
        features: Features::NONE,
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

const LINE: &str = "(effect: \"hair.silhouette\", params: (color: \"0000FF\"))";
const ALL: &str = "[(effect: \"hair.silhouette\", params: (color: \"0000FF\")), (effect: \"hair.base\"), (effect: \"hair.cel\", params: (feathers: 2, color: \"202020\"))]";

/// The mean of how much of a stroke a brush covers, and a picture with it.
fn picture(
    list: &str,
    name: &str,
    brush: Option<Arc<BrushTexture>>,
    order: Order,
    samples: u32,
) -> Picture {
    draw(&drawing(&layers(list, name, brush), order), samples, 1)
}

#[test]
fn what_covers_all_is_as_without_a_brush_bit_for_bit() {
    for order in Order::ALL {
        for name in ["hair.silhouette", "hair.base", "hair.cel"] {
            for samples in [1, 4, 5] {
                let whole = picture(ALL, name, None, order, samples);
                assert!(
                    picture(ALL, name, even(1.0), order, samples) == whole,
                    "{order:?}, {name}"
                );
            }
        }
    }
}

#[test]
fn what_covers_nothing_is_as_without_the_layer() {
    let lists = [
        (
            "hair.silhouette",
            "[(effect: \"hair.base\"), (effect: \"hair.cel\", params: (feathers: 2, color: \"202020\"))]",
        ),
        (
            "hair.cel",
            "[(effect: \"hair.silhouette\", params: (color: \"0000FF\")), (effect: \"hair.base\")]",
        ),
    ];
    for order in Order::ALL {
        for (name, others) in lists {
            let none = picture(ALL, name, even(0.0), order, 4);
            assert!(
                none == picture(others, name, None, order, 4),
                "{order:?}, {name}"
            );
        }
    }
    // Not even depth is left: other strands and the background show.
    let nothing = picture(
        "[(effect: \"hair.base\")]",
        "hair.base",
        even(0.0),
        Order::Rounded,
        4,
    );
    assert!(
        nothing
            .pixels
            .iter()
            .all(|pixel| *pixel == [0.5, 0.5, 0.5, 1.0])
    );
}

/// An outline stays one where the clump is left bare.
#[test]
fn outlines_do_not_fill_what_is_bare() {
    let list = format!("[{LINE}, (effect: \"hair.base\")]");
    let blue = |picture: &Picture| -> f32 {
        picture
            .pixels
            .iter()
            .map(|pixel| (pixel[2] - 0.5).max(0.0))
            .sum()
    };
    let filled = picture(&format!("[{LINE}]"), "", None, Order::Rounded, 4);
    let lines = picture(&list, "hair.base", even(0.0), Order::Rounded, 4);
    assert!(
        blue(&lines) < 0.8 * blue(&filled),
        "{} {}",
        blue(&lines),
        blue(&filled)
    );
    assert!(blue(&lines) > 0.1 * blue(&filled));
}

/// Of one strand a half covers half of its samples, with one sample all or nothing.
#[test]
fn samples_are_covered_by_their_share() {
    let list = format!("[{LINE}]");
    let light = |coverage: f32, samples| -> f32 {
        let picture = picture(
            &list,
            "hair.silhouette",
            even(coverage),
            Order::StrandFirst,
            samples,
        );
        // Blue that was put over gray.
        picture
            .pixels
            .iter()
            .map(|pixel| (0.5 - pixel[0]).max(0.0))
            .sum()
    };
    let whole = light(1.0, 16);
    for coverage in [0.25, 0.5, 0.75] {
        let share = light(coverage, 16) / whole;
        // Up to three strands lie over each other, and have parts of their own.
        let most = 1.0 - (1.0 - coverage) * (1.0 - coverage) * (1.0 - coverage);
        assert!(
            share > coverage - 0.05 && share < most,
            "{coverage}: {share}"
        );
    }
    assert_eq!(light(0.45, 1), 0.0);
    assert_eq!(light(0.55, 1), light(1.0, 1));
}

#[test]
fn threads_change_no_bit() {
    for text in [
        "(kind: pencil)",
        "(kind: dry_ink)",
        "(kind: crayon, fit: stretch)",
    ] {
        let drawing = drawing(&layers(ALL, "hair.base", tool(text)), Order::Rounded);
        let one = draw(&drawing, 4, 1);
        assert!(one == draw(&drawing, 4, 3), "{text}");
        assert!(
            one != picture(ALL, "hair.base", None, Order::Rounded, 4),
            "{text}"
        );
    }
}

/// Decals, and shadows of hair on hair.
#[test]
fn decals_have_brushes() {
    let decal = "(effect: \"hair.cel\", clip: \"hair\", reach: 0.3, params: (feathers: 2, color: \"F02020\"))";
    let shadow = "(effect: \"hair.cast\", clip: \"hair\", reach: 0.001, params: (distance: 0.1, color: \"205020\"))";
    for (name, layer) in [("hair.cel", decal), ("hair.cast", shadow)] {
        let list = format!("[(effect: \"hair.base\"), {layer}]");
        let of = |brush| picture(&list, name, brush, Order::Rounded, 4);
        let (whole, none) = (of(None), of(even(0.0)));
        assert!(
            none == picture("[(effect: \"hair.base\")]", "", None, Order::Rounded, 4),
            "{name}"
        );
        assert!(of(even(1.0)) == whole, "{name}");
        assert!(whole != none, "{name}");
        let some = of(tool("(kind: crayon)"));
        assert!(some != whole && some != none, "{name}");
    }
}

#[test]
fn drawings_are_checked() {
    let good = drawing(&layers(ALL, "hair.base", even(0.5)), Order::Rounded);
    let mut rasterizer = Rasterizer::new(1, Some(1)).unwrap();
    let mut error = |change: fn(&mut Drawing)| {
        let mut drawing = good.clone();
        change(&mut drawing);
        rasterizer.draw(&drawing).unwrap_err()
    };
    let joints = good.clump.len();
    let found = joints - 1;
    let lack = DrawError::AlongStrands { found, joints };
    assert_eq!(
        error(|it| it.brushwork.joints.truncate(it.clump.len() - 1)),
        lack
    );
    assert_eq!(error(|it| it.brushwork.joints[3].s = f32::NAN), lack);
    assert_eq!(error(|it| it.brushwork.joints[3].whole = -1.0), lack);
    assert_eq!(
        error(|it| it.brushwork.layers[0].layer = 9),
        DrawError::BrushedLayer(9)
    );
}

/// Lengths are those of the strand, whatever the near plane or the picture leaves of it.
#[test]
fn joints_know_where_along_their_strand_they_are() {
    let drawing = drawing(&layers(ALL, "hair.base", even(0.5)), Order::Rounded);
    for run in &drawing.runs {
        let joints: &[AlongStrand] = &drawing.brushwork.joints[run.joints.clone()];
        assert_eq!(joints[0].s, 0.0);
        let last = joints[joints.len() - 1];
        assert!((last.s - last.whole).abs() < 1e-5 * last.whole && last.s > 1.0);
        assert!(joints.iter().all(|joint| joint.whole == last.whole));
        assert!(joints.windows(2).all(|pair| pair[0].s < pair[1].s));
    }
}

proptest! {
    /// Of many samples a stroke covers as many as its coverage says, whatever the strand.
    #[test]
    fn coverage_is_the_share_of_samples(coverage in 0.0..1.0_f32, samples in 2..64_u32, first: u32) {
        let covered = |strand: u32| {
            let parts = (0..samples).map(|sample| scatter(strand, sample));
            parts.filter(|part| coverage > *part).count() as f32 / samples as f32
        };
        // With two samples a strand's share is 0, a half or 1, and off by 0.25 in the mean square:
        // the mean of 2,500 strands is off by 0.005, and 0.03 are six of that.
        let strands = 2500;
        let mut sum = 0.0;
        for strand in 0..strands {
            let share = covered(first.wrapping_add(strand));
            prop_assert!((share - coverage).abs() < 3.0 / samples as f32, "{}", share);
            sum += share;
        }
        let mean = sum / strands as f32;
        prop_assert!((mean - coverage).abs() < 0.03, "{mean}");
    }
}
