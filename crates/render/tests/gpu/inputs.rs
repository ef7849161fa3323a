//! What a joint offers is the same on a graphics card, for inputs that no effect of inkstrand's own reads there.

use crate::scene::{Scene, driver, layers, registry};
use effects::wgsl::{Stroke, vec2, vec3};
use effects::{Input, Joints, Param, ParamKind, Parameters, Program, StrokeEffect, Values};
use render::cpu::{Evaluator, Rasterizer};
use render::{Drawing, Picture};

/// Its strokes are as wide as it is late and as hair is far, and coloured by where head and strands are.
struct Telling;

struct TellingProgram;

impl Parameters for TellingProgram {
    type Params = u32;
    const PARAMS: &'static [Param] = &[Param {
        name: "share",
        doc: "how much of it all",
        unit: "",
        kind: ParamKind::Integer {
            min: 0,
            max: 9,
            default: 1,
        },
    }];
    const INPUTS: &'static [Input] = &[
        Input::StrandMean,
        Input::HeadCenter,
        Input::HeadHeight,
        Input::StrandSize,
        Input::Depth,
        Input::Time,
    ];
    const WGSL: &'static str = concat!(
        "struct Params { share: u32 }
        struct Inputs {
            strand_mean: vec3<f32>, head_center: vec3<f32>, head_height: f32, strand_size: f32, depth: f32, time: f32,
        }
        fn stroke(joint: Inputs, instance: u32, params: Params) -> Stroke {
            let width = f32(params.share) * (joint.depth + 3.0 * joint.time + 0.2 * joint.strand_size);
            let color = 3.0 * abs(joint.strand_mean - joint.head_center) + vec3<f32>(joint.head_height);
            return Stroke(vec2<f32>(0.0), width, 0.0, color);
        }\n",
        include_str!("../../../../shaders/prelude.wgsl")
    );
    fn params(values: &Values) -> u32 {
        values.integer("share").unsigned_abs()
    }
}

impl Program for TellingProgram {
    fn stroke(joints: &Joints, i: usize, _: u32, _: u32, share: &u32) -> Stroke {
        let width = joints.depth[i] + 3.0 * joints.time[i] + 0.2 * joints.strand_size[i];
        let [mean, center] = [joints.strand_mean[i], joints.head_center[i]].map(|v| v.to_array());
        let color = [0, 1, 2].map(|k| 3.0 * (mean[k] - center[k]).abs() + joints.head_height[i]);
        Stroke {
            offset: vec2([0.0; 2]),
            radius: *share as f32 * width,
            depth_offset: 0.0,
            color: vec3(color),
        }
    }
}

impl StrokeEffect for Telling {
    type Program = TellingProgram;
    const ID: &'static str = "test.telling";
    const DOC: &'static str = "strokes that tell of their inputs";
}

fn on_cpu(scene: &Scene) -> Picture {
    let mut drawing = Drawing::default();
    let mut evaluator = Evaluator::default();
    evaluator.evaluate(&scene.frame(), &mut drawing).unwrap();
    Rasterizer::new(1, Some(1)).unwrap().draw(&drawing).unwrap()
}

#[test]
fn places_sizes_depth_and_time_agree() {
    let Some(mut card) = driver() else { return };
    let mut registry = registry();
    registry.register::<Telling>().unwrap();
    for seed in 0..6 {
        let mut scene = Scene::random_pair(seed);
        scene.layers[0] = layers("[(effect: \"test.telling\")]", &registry).remove(0);
        let (cpu, gpu) = (on_cpu(&scene), card.draw(&scene.frame(), 1).unwrap());
        let pixels = cpu.pixels.iter().zip(&gpu.pixels);
        let differs = |(a, b): &(&[f32; 4], &[f32; 4])| (0..4).any(|k| (a[k] - b[k]).abs() > 0.01);
        let wrong = pixels.filter(differs).count();
        assert!(wrong <= 10, "seed {seed}: {wrong} pixels");
        scene.layers.remove(0);
        scene.layer_joints.remove(0);
        scene
            .second
            .iter_mut()
            .for_each(|second| second.drop_layer(0));
        assert!(on_cpu(&scene) != cpu, "seed {seed}: it is seen");
    }
}
