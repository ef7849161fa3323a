//! Samples that know what they show: a graphics card tells, paints and draws lines as the CPU does.

use crate::agree::{on_cpu, share_beyond};
use crate::scene::{Scene, camera, driver, noop, registry};
use effects::{Image, Variation};
use render::cpu::{Evaluator, Rasterizer};
use render::gpu::{GpuError, Offscreen, PassFormat, Renderer};
use render::{Drawing, EdgeChannel, Edges, Feature, Features, Sample, SamplePlanes};
use std::sync::Arc;

const SAMPLES: u32 = 4;

/// Adds all samples of some planes.
fn add(planes: &SamplePlanes, told: &mut Vec<Sample>) {
    let [width, height] = planes.size().map(|side| side as usize);
    for picture in 0..planes.samples().len() {
        for y in 0..height {
            told.extend((0..width).map(|x| planes.sample(picture, x, y)));
        }
    }
}

fn told_by_cpu(scene: &Scene) -> Vec<Sample> {
    let mut drawing = Drawing::default();
    Evaluator::default()
        .evaluate(&scene.frame(), &mut drawing)
        .unwrap();
    let mut told = Vec::new();
    Rasterizer::new(SAMPLES, Some(1))
        .unwrap()
        .draw_samples(&drawing, &mut SamplePlanes::default(), |planes| {
            add(planes, &mut told);
        })
        .unwrap();
    told
}

fn told_by_card(card: &mut Offscreen, scene: &Scene) -> Vec<Sample> {
    let mut told = Vec::new();
    let mut planes = SamplePlanes::default();
    card.draw_samples(&scene.frame(), SAMPLES, &mut planes, |planes| {
        add(planes, &mut told);
    })
    .unwrap();
    told
}

/// Whether a feature is another but for single precision.
fn differs(a: &Sample, b: &Sample, feature: Feature) -> bool {
    if feature.is_id() {
        return a.id(feature) != b.id(feature);
    }
    let reach = match feature {
        Feature::Pixels => 0.5,
        Feature::V | Feature::W => 0.01,
        Feature::Normal => 0.02,
        _ => 0.002,
    };
    (0..feature.components()).any(|component| {
        let difference = a.number(feature, component) - b.number(feature, component);
        difference.abs() > reach || difference.is_nan()
    })
}

/// In every order and brush, with one object and with two; but for samples whose winner is decided by rounding.
#[test]
fn every_feature_agrees() {
    let Some(mut card) = driver() else { return };
    for seed in 0..9 {
        let mut scene = match seed % 3 {
            0 => Scene::random_pair(seed),
            _ => Scene::random(seed),
        };
        scene.features = Features::of(Feature::ALL);
        let (cpu, gpu) = (told_by_cpu(&scene), told_by_card(&mut card, &scene));
        assert_eq!(cpu.len(), gpu.len());
        let pairs = || cpu.iter().zip(&gpu);
        let hair = pairs().filter(|(cpu, _)| cpu.object % 2 == 1).count();
        assert!(hair > 500, "seed {seed}: {hair} samples show hair");
        let ids: Vec<Feature> = Feature::ALL.iter().copied().filter(|f| f.is_id()).collect();
        let is_other = |(a, b): &(&Sample, &Sample)| ids.iter().any(|id| differs(a, b, *id));
        let others: Vec<_> = pairs().filter(is_other).collect();
        // Some lie on edges, which a real card, that multiplies and adds in one, rounds otherwise: four of 29,100 on an H200.
        let most = match card.info().device_type {
            wgpu::DeviceType::Cpu => 2,
            _ => 5,
        };
        let count = others.len();
        assert!(
            count <= most,
            "seed {seed}: {count} ids, such as {others:?}"
        );
        for &feature in Feature::ALL.iter().filter(|feature| !feature.is_id()) {
            let is_off =
                |pair: &(&Sample, &Sample)| !is_other(pair) && differs(pair.0, pair.1, feature);
            let off: Vec<_> = pairs().filter(is_off).collect();
            assert!(
                off.len() <= 2,
                "seed {seed}, {:?}: {feature:?} of {} samples, such as {:?}",
                scene.order,
                off.len(),
                off.first()
            );
        }
    }
}

/// What isn't declared isn't there, on either.
#[test]
fn features_are_told_where_they_are_declared() {
    let Some(mut card) = driver() else { return };
    let mut scene = Scene::random(4);
    for feature in [Feature::Strand, Feature::Normal, Feature::W] {
        scene.features = Features::of(&[feature]);
        let (cpu, gpu) = (told_by_cpu(&scene), told_by_card(&mut card, &scene));
        let is_off = |(a, b): &(&Sample, &Sample)| Feature::ALL.iter().any(|f| differs(a, b, *f));
        let off = cpu.iter().zip(&gpu).filter(is_off).count();
        assert!(off <= 2, "{feature:?}: {off}");
    }
}

/// A picture with 4 x 2 texels, some of which show less than all.
fn picture() -> Arc<Image> {
    let texels: Vec<u16> = (0..8)
        .flat_map(|i: u16| [8000 * i, 65535 - 7000 * i, 20_000, 65535 - 5000 * (i % 3)])
        .collect();
    Arc::new(Image::from_srgb([4, 2], &texels).unwrap())
}

/// One layer that paints, whose texture files are that picture.
fn paint(scene: &mut Scene, params: &str) {
    let text = format!(
        "[(effect: \"hair.silhouette\"), (effect: \"hair.toon\", params: ({params})), (effect: \"hair.cel\")]"
    );
    let mut reader = effects::preset::Reader::new("test", &text);
    let registry = registry();
    let mut specs = reader.layers(&text, &registry, &[]);
    reader.report().unwrap();
    for spec in &mut specs {
        let read = |_: &str| Ok::<_, std::convert::Infallible>(picture());
        spec.values.read_textures(read).unwrap();
    }
    scene.layers = specs.iter().map(|spec| spec.build()).collect();
    let joints = scene.layer_joints[0].clone();
    scene.layer_joints = vec![joints; scene.layers.len()];
    if let Some(second) = &mut scene.second {
        while second.layers() > scene.layers.len() {
            second.drop_layer(0);
        }
    }
}

/// The rows of a gradient that are far from each other.
const ROWS: &str = "tones: [(v: 0, steps: [(0, \"302080\"), (0.4, \"FFFFFF\")]), \
     (v: 1, stops: [(0, \"D05020\"), (0.5, \"FFE080\"), (1, \"FFFFFF\")])]";

#[test]
fn paint_agrees() {
    let Some(mut card) = driver() else { return };
    let ways = [
        "",
        "tones: none",
        "mode: add, roundness: 1",
        "mode: replace, detail: along, ROWS",
        "detail: across, ROWS",
        "detail: depth, depth_from: eye, near: 1, far: 4, ROWS",
        "detail: facing, exponent: 2, ROWS",
        "detail: blinn, exponent: 20, ROWS",
        "detail: weighted, weight: 0.3, ROWS",
        "tones: \"a.png\", detail: along, mode: replace",
        "rim: \"FFD0A0\", rim_width: 0.4",
        "root_fade: 0.4, roundness: (value: 0.6, vary: 0.3)",
    ];
    for (params, seed) in ways.iter().zip(0..) {
        let mut scene = match seed % 4 {
            0 => Scene::random_pair(seed),
            _ => Scene::random(seed),
        };
        let plain = on_cpu(&scene, SAMPLES);
        paint(&mut scene, &params.replace("ROWS", ROWS));
        let cpu = on_cpu(&scene, SAMPLES);
        let gpu = card.draw(&scene.frame(), SAMPLES).unwrap();
        let wrong = share_beyond(&cpu, &gpu, 2.0 / 255.0);
        assert!(
            wrong <= 0.003,
            "{params}, {:?}: {:.2} %",
            scene.order,
            100.0 * wrong
        );
        assert!(
            share_beyond(&cpu, &plain, 0.01) > 0.02,
            "{params}: it paints"
        );
    }
}

fn edges(width_px: f32) -> Edges {
    Edges {
        channel: EdgeChannel::Strand,
        threshold: 0.5,
        step_m: 0.01,
        width_px: Variation::constant(width_px),
        seed: 3,
        fade_to: 0.0,
        color: [0.8, 0.1, 0.0],
    }
}

const CHANNELS: [EdgeChannel; 6] = [
    EdgeChannel::Level,
    EdgeChannel::Strand,
    EdgeChannel::Object,
    EdgeChannel::Normal,
    EdgeChannel::Depth,
    EdgeChannel::Color,
];

#[test]
fn lines_agree() {
    let Some(mut card) = driver() else { return };
    for (channel, seed) in CHANNELS.into_iter().zip(0..) {
        for (width_px, fade_to) in [(0.6, 0.0), (7.0, 0.6), (40.0, 0.0)] {
            let mut scene = Scene::random(seed);
            let plain = on_cpu(&scene, SAMPLES);
            scene.passes = vec![Edges {
                channel,
                fade_to,
                ..edges(width_px)
            }];
            let cpu = on_cpu(&scene, SAMPLES);
            let gpu = card.draw(&scene.frame(), SAMPLES).unwrap();
            let wrong = share_beyond(&cpu, &gpu, 2.0 / 255.0);
            assert!(
                wrong <= 0.001,
                "{channel:?}, {width_px} px: {:.2} %",
                100.0 * wrong
            );
            let drawn = share_beyond(&cpu, &plain, 0.01);
            assert!(drawn > 0.005, "{channel:?}, {width_px} px: lines are there");
        }
    }
}

/// The second goes over what the first has drawn, whose width varies, and both over what is painted.
#[test]
fn passes_follow_each_other_and_paint() {
    let Some(mut card) = driver() else { return };
    let mut scene = Scene::random_pair(1);
    paint(&mut scene, ROWS);
    let mut first = edges(3.0);
    first.width_px = Variation {
        curve: vec![(0.1, 0.5), (0.4, 6.0), (0.9, 2.0)],
        vary: 0.5,
    };
    let second = Edges {
        channel: EdgeChannel::Color,
        color: [0.0, 0.0, 1.0],
        ..edges(1.5)
    };
    scene.passes = vec![first, second];
    for samples in [1, 3, 5] {
        let (cpu, gpu) = (
            on_cpu(&scene, samples),
            card.draw(&scene.frame(), samples).unwrap(),
        );
        let wrong = share_beyond(&cpu, &gpu, 2.0 / 255.0);
        assert!(wrong <= 0.001, "{samples}: {:.2} %", 100.0 * wrong);
    }
}

/// What no frame needs has no pipeline, buffer or texture; what one does is made once.
#[test]
fn nothing_is_there_for_samples_that_show_colours_alone() {
    let mut card = Offscreen::on(noop(wgpu::Limits::default())).unwrap();
    let plain = Scene::random(3);
    card.draw(&plain.frame(), SAMPLES).unwrap();
    let before = card.stats();
    let mut scene = Scene::random(3);
    scene.passes = vec![edges(1.5)];
    paint(&mut scene, "tones: \"a.png\"");
    card.draw(&scene.frame(), SAMPLES).unwrap();
    assert!(card.stats().made > 8 && card.stats().bytes > before.bytes);
    for _ in 0..2 {
        card.draw(&scene.frame(), SAMPLES).unwrap();
        assert_eq!(card.stats().made, 0);
    }
    let mut telling = Scene::random(3);
    telling.features = Features::of(Feature::ALL);
    card.draw(&telling.frame(), SAMPLES).unwrap();
    let after = card.stats();
    assert_eq!(
        (after.pipelines, after.buffers),
        (before.pipelines, before.buffers),
        "a picture needs no features"
    );
}

/// In somebody's pass samples are painted and drawn on, too, and each is kept.
#[test]
fn a_painted_frame_is_prepared_for_a_pass() {
    let gpu = noop(wgpu::Limits::default());
    let mut renderer = Renderer::new(&gpu.device, &gpu.queue).unwrap();
    let mut scene = Scene::random(3);
    paint(&mut scene, "tones: \"a.png\"");
    scene.passes = vec![edges(2.0)];
    for samples in [4, 1] {
        let format = PassFormat {
            color: wgpu::TextureFormat::Rgba8UnormSrgb,
            depth: None,
            samples,
        };
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let prepared = renderer.prepare(&mut encoder, &scene.frame(), SAMPLES, format);
        prepared.unwrap();
        gpu.queue.submit([encoder.finish()]);
        gpu.check().unwrap();
    }
}

#[test]
fn what_a_card_cannot_draw_is_told() {
    let limits = wgpu::Limits {
        max_texture_dimension_2d: 64,
        max_texture_dimension_1d: 64,
        ..wgpu::Limits::default()
    };
    let mut card = Offscreen::on(noop(limits)).unwrap();
    let mut scene = Scene::random(3);
    scene.passes = vec![edges(2.0)];
    let whole = std::mem::replace(&mut scene.camera, camera([60, 50]));
    card.draw(&scene.frame(), SAMPLES).unwrap();
    scene.camera = whole;
    let error = card.draw(&scene.frame(), SAMPLES).unwrap_err();
    let is_limit = matches!(
        error,
        GpuError::Limit {
            has: 64,
            needs: 97,
            ..
        }
    );
    assert!(is_limit, "{error}");
    // And without them again.
    scene.passes.clear();
    card.draw(&scene.frame(), SAMPLES).unwrap();

    let drawing = Drawing {
        size: [8, 8],
        passes: vec![edges(2.0)],
        features: render::DrawnFeatures {
            declared: edges(2.0).features(),
            ..render::DrawnFeatures::default()
        },
        ..Drawing::default()
    };
    let error = card.draw_strokes(&drawing, SAMPLES).unwrap_err();
    assert!(matches!(error, GpuError::Unsupported(_)), "{error}");
}
