//! What goes wrong on a graphics card is told, and nothing panics.

use crate::scene::{Scene, camera, driver, driver_gpu, layers, noop, registry};
use effects::wgsl::Stroke;
use effects::{Input, Joints, Param, Parameters, Program, StrokeEffect, Values};
use render::gpu::{GpuError, Offscreen, PassDepth, PassFormat, Renderer};
use render::{DrawError, FrameError};

#[test]
fn limits_that_are_too_small_are_named() {
    let limits = wgpu::Limits {
        max_storage_buffers_per_shader_stage: 6,
        ..Default::default()
    };
    let Err(error) = Offscreen::on(noop(limits)) else {
        panic!("6 storage buffers are not enough");
    };
    let text = error.to_string();
    assert!(
        matches!(
            error,
            GpuError::Limit {
                has: 6,
                needs: 8,
                ..
            }
        ),
        "{text}"
    );
    assert!(text.contains("limit of 6 for storage buffers in a shader, where 8 are needed"));
}

#[test]
fn a_frame_that_does_not_fit_is_refused_and_the_next_one_drawn() {
    let limits = wgpu::Limits {
        max_storage_buffer_binding_size: 96 << 10,
        ..Default::default()
    };
    let mut card = Offscreen::on(noop(limits)).unwrap();
    let scene = Scene::random(1);
    let error = card.draw(&scene.frame(), 4).unwrap_err();
    let GpuError::TooLarge { what, bytes, most } = &error else {
        panic!("{error}");
    };
    assert!(*most == 96 << 10 && *bytes > *most, "{what}");
    let mut small = Scene::random(1);
    small.camera = camera([16, 16]);
    small.layers.truncate(1);
    small.layer_joints.truncate(1);
    card.draw(&small.frame(), 1).unwrap();
}

/// An effect whose WGSL no driver takes: it says so by a name that isn't there.
struct Broken;

struct BrokenProgram;

impl Parameters for BrokenProgram {
    type Params = ();
    const PARAMS: &'static [Param] = &[];
    const INPUTS: &'static [Input] = &[Input::U];
    const WGSL: &'static str = "fn stroke() -> Nonsense {}";
    fn params(_: &Values) {}
}

impl Program for BrokenProgram {
    fn stroke(_: &Joints, _: usize, _: u32, _: u32, (): &()) -> Stroke {
        unreachable!("it is for the graphics card alone")
    }
}

impl StrokeEffect for Broken {
    type Program = BrokenProgram;
    const ID: &'static str = "test.broken";
    const DOC: &'static str = "an effect that no driver takes";
}

#[test]
fn a_shader_that_is_refused_is_named_and_the_next_frame_drawn() {
    let mut registry = registry();
    registry.register::<Broken>().unwrap();
    let mut broken = Scene::random(2);
    broken.layers = layers("[(effect: \"test.broken\")]", &registry);
    broken.layer_joints.truncate(1);
    let mut cards = vec![Offscreen::on(noop(wgpu::Limits::default())).unwrap()];
    cards.extend(driver());
    for mut card in cards {
        let error = card.draw(&broken.frame(), 4).unwrap_err();
        let text = error.to_string();
        assert!(matches!(error, GpuError::Shader { .. }), "{text}");
        assert!(
            text.contains("test.broken") && text.contains("Nonsense"),
            "{text}"
        );
        card.draw(&Scene::random(2).frame(), 4).unwrap();
    }
}

#[test]
fn a_lost_card_says_so_from_then_on() {
    let scene = Scene::random(2);
    let cards = [Some(noop(wgpu::Limits::default())), driver_gpu()];
    for gpu in cards.into_iter().flatten() {
        let device = gpu.device.clone();
        let mut card = Offscreen::on(gpu).unwrap();
        card.draw(&scene.frame(), 4).unwrap();
        device.destroy();
        for _ in 0..2 {
            let error = card.draw(&scene.frame(), 4).unwrap_err();
            assert!(matches!(error, GpuError::Lost(_)), "{error}");
        }
    }
}

#[test]
fn frames_that_are_none_are_refused_as_on_the_cpu() {
    let mut card = Offscreen::on(noop(wgpu::Limits::default())).unwrap();
    let mut scene = Scene::random(2);
    for samples in [0, 257] {
        let error = card.draw(&scene.frame(), samples).unwrap_err();
        assert!(matches!(error, GpuError::Samples(_)), "{error}");
    }
    scene.background = Some([f32::NAN, 0.0, 0.0]);
    assert!(matches!(
        card.draw(&scene.frame(), 4),
        Err(GpuError::Frame(FrameError::Draw(DrawError::Background)))
    ));
    scene.background = None;
    scene.surfaces[0].triangles.push([0, 1, 99]);
    assert!(matches!(
        card.draw(&scene.frame(), 4),
        Err(GpuError::Frame(FrameError::Draw(
            DrawError::TriangleIndex { .. }
        )))
    ));
    scene.surfaces.clear();
    card.draw(&scene.frame(), 4).unwrap();
}

#[test]
fn passes_that_cannot_be_are_refused_in_words() {
    let gpu = noop(wgpu::Limits::default());
    let mut renderer = Renderer::new(&gpu.device, &gpu.queue).unwrap();
    let scene = Scene::random(2);
    let good = PassFormat {
        color: wgpu::TextureFormat::Bgra8Unorm,
        depth: Some(PassDepth {
            format: wgpu::TextureFormat::Depth32Float,
            compare: wgpu::CompareFunction::Less,
            mapping: [1.0, -0.1],
        }),
        samples: 4,
    };
    let mut refused = |pass: PassFormat| {
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let prepared = renderer.prepare(&mut encoder, &scene.frame(), 4, pass);
        prepared.map_err(|error| error.to_string())
    };
    refused(good).unwrap();
    let with_depth = |change: fn(&mut PassDepth)| {
        let mut pass = good;
        pass.depth.iter_mut().for_each(change);
        pass
    };
    let color = |color| PassFormat { color, ..good };
    let cases = [
        (PassFormat { samples: 3, ..good }, "1, 2, 4, 8 and 16"),
        (color(wgpu::TextureFormat::Depth32Float), "Depth32Float"),
        (color(wgpu::TextureFormat::Rgba8Uint), "Rgba8Uint"),
        (color(wgpu::TextureFormat::Bc1RgbaUnorm), "Bc1RgbaUnorm"),
        (
            PassFormat {
                samples: 1,
                ..color(wgpu::TextureFormat::Rgba32Float)
            },
            "can't be blended",
        ),
        (
            with_depth(|depth| depth.format = wgpu::TextureFormat::Rgba8Unorm),
            "depths in Rgba8Unorm",
        ),
        (
            with_depth(|depth| depth.compare = wgpu::CompareFunction::Equal),
            "Less, LessEqual, Greater or GreaterEqual",
        ),
        (with_depth(|depth| depth.mapping[1] = f32::NAN), "NaN"),
    ];
    for (pass, words) in cases {
        let error = refused(pass).unwrap_err();
        assert!(error.contains(words), "{error}");
    }
    gpu.check().unwrap();
}

#[test]
fn a_pass_has_one_sample_or_all() {
    let gpu = noop(wgpu::Limits::default());
    let mut renderer = Renderer::new(&gpu.device, &gpu.queue).unwrap();
    let scene = Scene::random(2);
    let format = |samples| PassFormat {
        color: wgpu::TextureFormat::Rgba8UnormSrgb,
        depth: None,
        samples,
    };
    let mut prepare = |samples| {
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let prepared = renderer.prepare(&mut encoder, &scene.frame(), 4, format(samples));
        gpu.queue.submit([encoder.finish()]);
        prepared
    };
    prepare(4).unwrap();
    prepare(1).unwrap();
    let error = prepare(2).unwrap_err();
    assert!(
        matches!(
            error,
            GpuError::PassSamples {
                pass: 2,
                prepared: 4
            }
        ),
        "{error}"
    );
    gpu.check().unwrap();
}
