//! The CPU's code is what its WGSL says: the WGSL is read and worked out here, expression by expression,
//! without the translator that made the Rust.

mod interpret;
mod math;
mod value;

use crate::hair;
use crate::joint::{InputValue, Joint};
use crate::paint::paint;
use crate::sample::{self, Sample};
use crate::strokes::evaluate;
use crate::values::{Case, extremes, some_instances};
use effects::wgsl::{Lookup, Stroke, vec2};
use effects::{
    AnyEffect, Input, LayerProgram, PaintSource, Param, ParamKind, SampleInput, Section as _,
    Value as Setting, Values,
};
use interpret::Interpreter;
use naga::TypeInner;
use value::Value;

/// Cases of parameters that are tried, at most.
const CASES: usize = 24;
/// The layer's seed in [`evaluate`].
const SEED: u32 = 1;

pub(crate) fn check(effect: &dyn AnyEffect) -> Result<(), String> {
    let module = naga::front::wgsl::parse_str(effect.wgsl())
        .map_err(|error| format!("WGSL is not WGSL: {}", error.emit_to_string(effect.wgsl())))?;
    let interpreter = Interpreter::new(&module);
    let mut joints: Vec<Joint> = hair::joints().into_iter().step_by(11).collect();
    joints.extend(hair::hostile_joints().iter().map(|(_, joint)| joint));
    let cases = extremes(effect);
    // Those that vary are mixed by Rust; the defaults and some extremes will do.
    let plain = |case: &&Case| !is_varied(&case.values);
    let step = cases.len().div_ceil(CASES);
    for case in cases.iter().filter(plain).step_by(step) {
        let program = effect.program(&case.values);
        let params = params(&module, &case.values)?;
        for instance in some_instances(program.instances()) {
            let strokes = evaluate(&*program, &joints, instance);
            for (joint, rust) in joints.iter().zip(&strokes) {
                let arguments = [
                    inputs(&module, joint)?,
                    Value::U32(instance),
                    params.clone(),
                ];
                let wgsl = interpreter.call("stroke", &arguments)?;
                if let Some(difference) = difference(rust, &wgsl) {
                    return Err(format!(
                        "{}: stroke {instance}'s {difference}; is the Rust made by effects_build?",
                        case.name
                    ));
                }
            }
        }
    }
    Ok(())
}

fn is_varied(values: &Values) -> bool {
    let table = values.table().iter();
    table
        .map(|param| values.value(param.name))
        .any(|value| matches!(value, Setting::Varying(_)))
}

/// The same of what is painted.
pub(crate) fn check_paint(effect: &dyn AnyEffect) -> Result<(), String> {
    if effect.paints().is_none() {
        return Ok(());
    }
    let module = naga::front::wgsl::parse_str(effect.wgsl())
        .map_err(|error| format!("WGSL is not WGSL: {}", error.emit_to_string(effect.wgsl())))?;
    let interpreter = Interpreter::new(&module);
    let mut samples: Vec<Sample> = sample::samples().into_iter().step_by(11).collect();
    samples.extend(sample::hostile_samples().iter().map(|(_, sample)| sample));
    let cases = extremes(effect);
    let plain = |case: &&Case| !is_varied(&case.values);
    let step = cases.len().div_ceil(CASES);
    for case in cases.iter().filter(plain).step_by(step) {
        let program = effect.program(&case.values);
        let params = params(&module, &case.values)?;
        for (sample, rust) in samples.iter().zip(paint(&*program, &samples)) {
            let mut arguments = vec![sample_inputs(&module, sample)?];
            if let Some(texel) = texel(&*program, &interpreter, &arguments[0], &params)? {
                arguments.push(texel);
            }
            arguments.push(params.clone());
            let wgsl = interpreter.call("paint", &arguments)?.numbers();
            let same = rust.to_array().iter().zip(&wgsl).all(|(rust, wgsl)| {
                (rust - wgsl).abs() <= 1e-5 * (1.0 + wgsl.abs()) || rust.is_nan() && wgsl.is_nan()
            });
            if !same {
                return Err(format!(
                    "{}: the colour is {rust:?} in Rust and {wgsl:?} in WGSL; is the Rust made by effects_build?",
                    case.name
                ));
            }
        }
    }
    Ok(())
}

/// What `place` finds, of an effect that has it.
fn texel(
    program: &dyn LayerProgram,
    interpreter: &Interpreter,
    at: &Value,
    params: &Value,
) -> Result<Option<Value>, String> {
    let Some(PaintSource {
        places: true,
        textures,
        ..
    }) = program.source().paint
    else {
        return Ok(None);
    };
    let place = interpreter.call("place", &[at.clone(), params.clone()])?;
    let Value::List(fields) = &place else {
        return Err(format!("`place` gives {place:?}"));
    };
    let (Some(Value::U32(texture)), &[x, y, size]) = (fields.first(), &place.numbers()[..]) else {
        return Err(format!("`place` gives {place:?}"));
    };
    let lookup = Lookup {
        texture: *texture,
        at: vec2([x, y]),
        size,
    };
    let texture = textures.get(*texture as usize);
    let texel = texture.map_or([0.0; 4], |(texture, repeats)| {
        texture.texel(&lookup, *repeats).to_array()
    });
    Ok(Some(Value::list(texel)))
}

/// The WGSL's `Sample` of a sample.
fn sample_inputs(module: &naga::Module, sample: &Sample) -> Result<Value, String> {
    structure(module, "Sample", |name| {
        let mut inputs = SampleInput::ALL.iter().filter(|input| input.name() == name);
        let input = inputs
            .next()
            .ok_or_else(|| format!("a sample has no `{name}`"))?;
        Ok(sample.get(*input, SEED).into())
    })
}

/// The WGSL's `Inputs` at a joint.
fn inputs(module: &naga::Module, joint: &Joint) -> Result<Value, String> {
    structure(module, "Inputs", |name| {
        let mut inputs = Input::ALL.iter().filter(|input| input.name() == name);
        let input = inputs
            .next()
            .ok_or_else(|| format!("there is no input `{name}`"))?;
        Ok(joint.get(*input, SEED).into())
    })
}

/// The WGSL's `Params` with these values.
fn params(module: &naga::Module, values: &Values) -> Result<Value, String> {
    structure(module, "Params", |name| {
        if !values.table().iter().any(|param| param.name == name) {
            return Err(format!("WGSL has a parameter `{name}`, the table has not"));
        }
        Ok(match values.value(name) {
            Setting::Number(number) => Value::F32(*number),
            Setting::Integer(number) if is_signed(module, name) => Value::I32(*number),
            Setting::Integer(number) => Value::U32(number.unsigned_abs()),
            Setting::Flag(flag) => Value::Bool(*flag),
            Setting::Pair(pair) => Value::list(*pair),
            Setting::Triple(triple) => Value::list(*triple),
            Setting::Choice(index) => Value::U32(*index),
            Setting::Texture(_) => {
                let is_texture = |param: &&Param| matches!(param.kind, ParamKind::Texture { .. });
                let before = values.table().iter().take_while(|param| param.name != name);
                Value::U32(before.filter(is_texture).count() as u32)
            }
            Setting::Color(color) if is_four(module, name) => {
                let present = color.map_or(0.0, |_| 1.0);
                let [red, green, blue] = color.unwrap_or_default();
                Value::list([red, green, blue, present])
            }
            Setting::Color(color) => Value::list(color.unwrap_or_default()),
            other => return Err(format!("{name} is {other:?}")),
        })
    })
}

/// Whether a parameter is a `vec4`: a colour, or none.
fn is_four(module: &naga::Module, name: &str) -> bool {
    let size = naga::VectorSize::Quad;
    matches!(type_of(module, name), Some(TypeInner::Vector { size: s, .. }) if *s == size)
}

/// Whether a parameter is an `i32`.
fn is_signed(module: &naga::Module, name: &str) -> bool {
    let scalar = naga::Scalar::I32;
    matches!(type_of(module, name), Some(TypeInner::Scalar(s)) if *s == scalar)
}

/// The type of a parameter.
fn type_of<'m>(module: &'m naga::Module, name: &str) -> Option<&'m TypeInner> {
    let members = members(module, "Params");
    let member = members.iter().find(|m| m.name.as_deref() == Some(name))?;
    Some(&module.types[member.ty].inner)
}

fn members<'m>(module: &'m naga::Module, name: &str) -> &'m [naga::StructMember] {
    let mut types = module.types.iter().map(|(_, ty)| ty);
    match types
        .find(|ty| ty.name.as_deref() == Some(name))
        .map(|ty| &ty.inner)
    {
        Some(TypeInner::Struct { members, .. }) => members,
        _ => &[],
    }
}

/// The struct of this name with a value for each member.
fn structure(
    module: &naga::Module,
    name: &str,
    value: impl Fn(&str) -> Result<Value, String>,
) -> Result<Value, String> {
    let members = members(module, name).iter();
    let values = members.map(|member| value(member.name.as_deref().unwrap_or_default()));
    Ok(Value::List(values.collect::<Result<_, _>>()?))
}

impl From<InputValue> for Value {
    fn from(value: InputValue) -> Self {
        match value {
            InputValue::Number(number) => Self::F32(number),
            InputValue::Whole(number) => Self::U32(number),
            InputValue::Pair(pair) => Self::list([pair.x, pair.y]),
            InputValue::Triple(triple) => Self::list(triple.to_array()),
        }
    }
}

/// The first number in which a stroke is not what WGSL makes of it.
fn difference(rust: &Stroke, wgsl: &Value) -> Option<String> {
    let numbers = wgsl.numbers();
    let [red, green, blue] = rust.color.to_array();
    let rust = [
        ("offset.x", rust.offset.x),
        ("offset.y", rust.offset.y),
        ("radius", rust.radius),
        ("depth_offset", rust.depth_offset),
        ("red", red),
        ("green", green),
        ("blue", blue),
    ];
    if numbers.len() != rust.len() {
        return Some(format!("WGSL gives {} numbers", numbers.len()));
    }
    let pairs = rust.into_iter().zip(numbers);
    pairs.into_iter().find_map(|((name, rust), wgsl)| {
        // Nothing is said of the order in which a sum is made.
        let same =
            (rust - wgsl).abs() <= 1e-5 * (1.0 + wgsl.abs()) || rust.to_bits() == wgsl.to_bits();
        let both_nan = rust.is_nan() && wgsl.is_nan();
        (!same && !both_nan).then(|| format!("{name} is {rust} in Rust and {wgsl} in WGSL"))
    })
}
