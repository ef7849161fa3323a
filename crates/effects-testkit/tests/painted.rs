//! An effect that paints passes; spoilt in one way, it fails the check that is there for that.

use effects::wgsl::{Lookup, Stroke, Vec3, Vec4, vec3};
use effects::{
    Input, Joints, Param, Parameters as _, Registry, SampleBlock, SampleInput, SampleSet, Samples,
    Section as _, StrokeEffect, Texture, Value, Values,
};
use effects_testkit::conforms;
use std::marker::PhantomData;

effects::effect!("painted");

/// A way to spoil the effect of `painted.wgsl`.
trait Spoil: Send + Sync + 'static {
    const PAINTS: Option<&'static [SampleInput]> = <Program as effects::Program>::PAINTS;
    const WGSL: &'static str = Program::WGSL;
    fn paint(good: Vec3<f32>, _samples: &SampleBlock, _index: usize) -> Vec3<f32> {
        good
    }
}

struct Painted<S>(PhantomData<fn() -> S>);

impl<S: Spoil> effects::Parameters for Painted<S> {
    type Params = Params;
    const PARAMS: &'static [Param] = Program::PARAMS;
    const INPUTS: &'static [Input] = Program::INPUTS;
    const WGSL: &'static str = S::WGSL;
    fn params(values: &Values) -> Params {
        Program::params(values)
    }
    fn set_number(params: &mut Params, index: usize, value: f32) {
        Program::set_number(params, index, value);
    }
}

impl<S: Spoil> effects::Program for Painted<S> {
    const PAINTS: Option<&'static [SampleInput]> = S::PAINTS;
    const PLACES: bool = <Program as effects::Program>::PLACES;
    fn stroke(joints: &Joints, index: usize, instance: u32, seed: u32, params: &Params) -> Stroke {
        <Program as effects::Program>::stroke(joints, index, instance, seed, params)
    }
    fn place(samples: &SampleBlock, index: usize, seed: u32, params: &Params) -> Option<Lookup> {
        <Program as effects::Program>::place(samples, index, seed, params)
    }
    fn paint(
        samples: &SampleBlock,
        index: usize,
        seed: u32,
        texel: Vec4<f32>,
        params: &Params,
    ) -> Vec3<f32> {
        let good = <Program as effects::Program>::paint(samples, index, seed, texel, params);
        S::paint(good, samples, index)
    }
}

impl<S: Spoil> StrokeEffect for Painted<S> {
    type Program = Self;
    const ID: &'static str = "test.painted";
    const DOC: &'static str = "strokes that are painted by sample";
}

struct Not;
impl Spoil for Not {}

#[test]
fn it_conforms() {
    effects_testkit::assert_conforms::<Painted<Not>>();
    effects_testkit::assert_steady::<Painted<Not>>(&[]);
}

#[track_caller]
fn assert_fails<S: Spoil>(expected: &str) {
    let failures = conforms::<Painted<S>>().unwrap_err();
    assert!(failures.to_string().contains(expected), "{failures}");
}

struct Negative;
impl Spoil for Negative {
    fn paint(good: Vec3<f32>, samples: &SampleBlock, index: usize) -> Vec3<f32> {
        if samples.w[index] > 0.6 {
            vec3([0.0, -0.1, 0.0])
        } else {
            good
        }
    }
}

struct NotANumber;
impl Spoil for NotANumber {
    fn paint(good: Vec3<f32>, samples: &SampleBlock, index: usize) -> Vec3<f32> {
        good * vec3([f32::NAN * samples.u[index]; 3])
    }
}

struct ByPlaceInTheList;
impl Spoil for ByPlaceInTheList {
    fn paint(good: Vec3<f32>, _: &SampleBlock, index: usize) -> Vec3<f32> {
        good + vec3([index as f32; 3])
    }
}

struct Undeclared;
impl Spoil for Undeclared {
    fn paint(good: Vec3<f32>, samples: &SampleBlock, index: usize) -> Vec3<f32> {
        good * vec3([samples.depth[index]; 3])
    }
}

struct OtherRust;
impl Spoil for OtherRust {
    fn paint(good: Vec3<f32>, _: &SampleBlock, _: usize) -> Vec3<f32> {
        good * vec3([0.9; 3])
    }
}

struct NeverPaints;
impl Spoil for NeverPaints {
    const PAINTS: Option<&'static [SampleInput]> = None;
}

#[test]
fn spoilt_ones_fail() {
    assert_fails::<Negative>("`paint` gives green -0.1");
    assert_fails::<NotANumber>("NaN");
    assert_fails::<ByPlaceInTheList>("at another place in the list");
    assert_fails::<Undeclared>(
        "it reads what of a sample it doesn't declare; it declares color, normal",
    );
    assert_fails::<OtherRust>("is the Rust made by effects_build?");
    assert_fails::<NeverPaints>("`tones` is a texture, which `place` looks up");
}

#[test]
fn presets_say_textures_and_programs_look_them_up() {
    let mut registry = Registry::new();
    registry.register::<Painted<Not>>().unwrap();
    let effect = registry.get("test.painted").unwrap();
    let mut values = Values::defaults(effect.params());
    assert!(matches!(values.texture("tones"), Texture::Ramp(_)));
    assert_eq!(values.texture("pattern"), &Texture::None);
    values
        .set_text("test.painted", "pattern", "\"teeth.png\"")
        .unwrap();
    assert_eq!(
        values.texture("pattern"),
        &Texture::File("teeth.png".to_owned())
    );
    let mut asked = Vec::new();
    let missing = values.read_textures(|file| {
        asked.push(file.to_owned());
        Err(())
    });
    assert!(missing.is_err() && asked == ["teeth.png"]);
    let image = effects::Image::from_srgb([1, 1], &[65535, 0, 0, 65535]).unwrap();
    let image = std::sync::Arc::new(image);
    values
        .read_textures(|_| Ok::<_, ()>(image.clone()))
        .unwrap();
    assert!(matches!(values.texture("pattern"), Texture::Image { .. }));
    let written = effects::preset::edit::written(&values.get(1).unwrap(), &effect.params()[1].kind);
    assert_eq!(written, "\"teeth.png\"");

    // Red where the pattern is looked up.
    values.set_text("test.painted", "roundness", "0").unwrap();
    let program = effect.program(&values);
    let read = program.paints().unwrap();
    assert!(read.has(SampleInput::Level) && !read.has(SampleInput::Depth));
    assert_eq!(program.source().paint.unwrap().textures.len(), 2);
    let up = vec![vec3([0.0, 0.0, 1.0]); 2];
    let samples = Samples {
        color: vec![vec3([1.0; 3]); 2],
        normal: up.clone(),
        tube: up.clone(),
        light_direction: up,
        u: vec![0.0; 2],
        w: vec![0.0; 2],
        seed: vec![1; 2],
        level: vec![0, 1],
        ..Samples::default()
    };
    let mut colors = Vec::new();
    program.paint(&samples, 0..2, 5, &mut colors);
    let [white, red] = colors[..] else { panic!() };
    assert!(white.x > 0.9 && white.y == white.x, "{white:?}");
    assert!(red.x > 0.9 && red.y == 0.0, "{red:?}");
    // A parameter that varies along the strand needs to know where.
    values.set(
        2,
        Value::Varying(effects::Variation {
            curve: vec![(0.0, 0.0), (1.0, 1.0)],
            vary: 0.0,
        }),
    );
    let read = effect.program(&values).paints().unwrap();
    assert!(read.has(SampleInput::U) && read.has(SampleInput::Seed));
    assert!(!SampleSet::default().has(SampleInput::U));

    for (text, message) in [
        ("\"\"", "it is empty"),
        ("teeth.png", "write \"teeth.png\""),
        (
            "[(1, \"FFFFFF\"), (0, \"000000\")]",
            "0 after 1; write [(0, ",
        ),
        ("(steps: [(0, \"FFF\")])", "no colour"),
        ("None", "write none"),
    ] {
        let kind = &effect.params()[0].kind;
        let error = effects::preset::read_value(text, kind).unwrap_err();
        assert!(error.contains(message), "{text}: {error}");
    }
}
