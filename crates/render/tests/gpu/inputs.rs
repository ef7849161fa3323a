//! What a joint offers and a preset says is the same on a graphics card, for inputs and parameters that no effect of inkstrand's own has.

use crate::scene::{Scene, driver, layers, registry};
use effects::wgsl::{Stroke, vec2, vec3};
use effects::{Input, Joints, Param, ParamKind, Parameters, Program, StrokeEffect, Values};
use render::cpu::{Evaluator, Rasterizer};
use render::{Drawing, Picture};

/// Its strokes are as wide as it is late and as hair is far, and coloured by where head and strands are.
struct Telling;

struct TellingProgram;

/// A parameter of each kind that no effect of inkstrand's own has, beside a plain one.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Told {
    share: u32,
    is_wide: bool,
    shift: i32,
    scale: [f32; 2],
    tint: [f32; 3],
}

const fn param(name: &'static str, kind: ParamKind) -> Param {
    Param {
        name,
        doc: "what strokes tell",
        unit: "",
        kind,
    }
}

impl Parameters for TellingProgram {
    type Params = Told;
    const PARAMS: &'static [Param] = &[
        param(
            "share",
            ParamKind::Integer {
                min: 0,
                max: 9,
                default: 1,
            },
        ),
        param("is_wide", ParamKind::Flag { default: true }),
        param(
            "shift",
            ParamKind::Integer {
                min: -9,
                max: 9,
                default: -4,
            },
        ),
        param(
            "scale",
            ParamKind::Pair {
                min: 0.0,
                max: 9.0,
                default: [1.0, 3.0],
            },
        ),
        param(
            "tint",
            ParamKind::Triple {
                min: 0.0,
                max: 9.0,
                default: [3.0, 2.0, 1.0],
            },
        ),
    ];
    const INPUTS: &'static [Input] = &[
        Input::StrandMean,
        Input::HeadCenter,
        Input::HeadHeight,
        Input::StrandSize,
        Input::Depth,
        Input::Time,
    ];
    const WGSL: &'static str = concat!(
        "struct Params { share: u32, is_wide: bool, shift: i32, scale: vec2<f32>, tint: vec3<f32> }
        struct Inputs {
            strand_mean: vec3<f32>, head_center: vec3<f32>, head_height: f32, strand_size: f32, depth: f32, time: f32,
        }
        fn stroke(joint: Inputs, instance: u32, params: Params) -> Stroke {
            let wide = select(0.0, 1.0, params.is_wide);
            let width = f32(params.share) * (params.scale.x * joint.depth + params.scale.y * joint.time + 0.2 * wide * joint.strand_size);
            let color = params.tint * abs(joint.strand_mean - joint.head_center) + vec3<f32>(joint.head_height);
            return Stroke(vec2<f32>(f32(params.shift), 0.0), width, 0.0, color);
        }\n",
        include_str!("../../../../shaders/prelude.wgsl")
    );
    fn params(values: &Values) -> Told {
        Told {
            share: values.integer("share").unsigned_abs(),
            is_wide: values.flag("is_wide"),
            shift: values.integer("shift"),
            scale: values.pair("scale"),
            tint: values.triple("tint"),
        }
    }
}

impl Program for TellingProgram {
    fn stroke(joints: &Joints, i: usize, _: u32, _: u32, told: &Told) -> Stroke {
        let [near, late] = told.scale;
        let wide = f32::from(u8::from(told.is_wide));
        let width =
            near * joints.depth[i] + late * joints.time[i] + 0.2 * wide * joints.strand_size[i];
        let [mean, center] = [joints.strand_mean[i], joints.head_center[i]].map(|v| v.to_array());
        let color =
            [0, 1, 2].map(|k| told.tint[k] * (mean[k] - center[k]).abs() + joints.head_height[i]);
        Stroke {
            offset: vec2([told.shift as f32, 0.0]),
            radius: told.share as f32 * width,
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
fn inputs_and_parameters_of_all_kinds_agree() {
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
