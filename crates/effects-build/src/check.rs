//! What an effect may contain: valid WGSL, the right entry function, and only those builtins whose
//! answers on the CPU are tested to be WGSL's.

use crate::compose::{Entry, Source};
use crate::error::BuildError;
use crate::places;
use crate::repair;
use naga::valid::{Capabilities, ModuleInfo, ValidationFlags, Validator};
use naga::{
    BinaryOperator, Expression, Handle, MathFunction as Math, Module, Scalar, Span, TypeInner,
};

/// Parses and validates a composed source, and tells its expressions' types. Errors begin with the
/// author's place, naga's own text and the source line follow.
pub(crate) fn parse(source: &Source) -> Result<(Module, ModuleInfo), BuildError> {
    let mut options = naga::front::wgsl::Options::new();
    options.parse_doc_comments = true;
    let module = naga::front::wgsl::Frontend::new_with_options(options)
        .parse(&source.text)
        .map_err(|error| {
            let text = error.emit_to_string_with_path(&source.text, &source.path);
            let span = error.labels().next().map(|(span, _)| span);
            places::error(source, span, error.message(), &text)
        })?;
    let info = validate(&module).map_err(|error| {
        let text = error.emit_to_string_with_path(&source.text, &source.path);
        // The innermost of the nested places that naga names.
        let length = |span: &Span| span.to_range().map_or(usize::MAX, |range| range.len());
        let span = error.spans().map(|(span, _)| *span).min_by_key(length);
        places::error(source, span, &error.to_string(), &text)
    })?;
    Ok((module, info))
}

#[allow(clippy::result_large_err, reason = "naga's own type, once a build")]
pub(crate) fn validate(
    module: &Module,
) -> Result<ModuleInfo, naga::WithSpan<naga::valid::ValidationError>> {
    Validator::new(ValidationFlags::all(), Capabilities::empty()).validate(module)
}

/// The type of a struct by its name.
pub(crate) fn named_type(module: &Module, name: &str) -> Option<Handle<naga::Type>> {
    module
        .types
        .iter()
        .find(|(_, ty)| ty.name.as_deref() == Some(name))
        .map(|(handle, _)| handle)
}

/// A function that callers know: name, arguments with their types, type of the result.
struct Signature(
    &'static str,
    &'static [(&'static str, &'static str)],
    &'static str,
);

const STROKE: Signature = Signature(
    "stroke",
    &[
        ("joint", "Inputs"),
        ("instance", "u32"),
        ("params", "Params"),
    ],
    "Stroke",
);
const CLUMP: Signature = Signature(
    "clump",
    &[("joint", "Inputs"), ("params", "Params")],
    "Clump",
);
const PLACE: Signature = Signature("place", &[("at", "Sample"), ("params", "Params")], "Lookup");
const PAINT: Signature = Signature(
    "paint",
    &[("at", "Sample"), ("params", "Params")],
    "vec3<f32>",
);
const PAINT_WITH_TEXEL: Signature = Signature(
    "paint",
    &[
        ("at", "Sample"),
        ("texel", "vec4<f32>"),
        ("params", "Params"),
    ],
    "vec3<f32>",
);

impl std::fmt::Display for Signature {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self(name, arguments, result) = self;
        let arguments = arguments.iter().map(|(name, ty)| format!("{name}: {ty}"));
        let arguments = arguments.collect::<Vec<_>>().join(", ");
        write!(f, "fn {name}({arguments}) -> {result}")
    }
}

/// What an effect does beside its strokes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Paints {
    No,
    /// `paint` alone.
    Plainly,
    /// `place` says where a texture is looked up, `paint` gets what is there.
    WithTexture,
}

/// Checks that the entry functions are there, with the arguments that the callers give.
pub(crate) fn entry_points(
    module: &Module,
    source: &Source,
    entry: Entry,
) -> Result<Paints, BuildError> {
    let signature = match entry {
        Entry::Effect => STROKE,
        Entry::Clump => CLUMP,
    };
    if !source.is_for_meshes && !has(module, source, &signature)? {
        return Err(BuildError(format!(
            "{}:1:1: an effect needs the function `{signature}`",
            source.path
        )));
    }
    if source.sample_inputs.is_none() {
        // What is no paint may be called so.
        return Ok(Paints::No);
    }
    let places = has(module, source, &PLACE)?;
    let paint = if places { PAINT_WITH_TEXEL } else { PAINT };
    if !has(module, source, &paint)? {
        return Err(BuildError(format!(
            "{}:1:1: an effect that reads {} needs the function `{paint}`",
            source.path,
            if source.is_for_meshes {
                "meshes"
            } else {
                "samples"
            }
        )));
    }
    Ok(if places {
        Paints::WithTexture
    } else {
        Paints::Plainly
    })
}

/// Whether there is a function of this name, which then must have these arguments and this result.
fn has(module: &Module, source: &Source, signature: &Signature) -> Result<bool, BuildError> {
    let Signature(name, arguments, result) = signature;
    let Some((handle, function)) = module
        .functions
        .iter()
        .find(|(_, f)| f.name.as_deref() == Some(*name))
    else {
        return Ok(false);
    };
    let found = function.arguments.iter().map(|a| type_name(module, a.ty));
    let returned = function.result.as_ref().map(|r| type_name(module, r.ty));
    if !found.eq(arguments.iter().map(|(_, ty)| (*ty).to_owned()))
        || returned.as_deref() != Some(*result)
    {
        let span = module.functions.get_span(handle);
        return Err(source.error(span, format!("this function must be `{signature}`")));
    }
    Ok(true)
}

/// The name of a type, of those that entry functions have.
fn type_name(module: &Module, ty: Handle<naga::Type>) -> String {
    match &module.types[ty] {
        naga::Type {
            name: Some(name), ..
        } => name.clone(),
        naga::Type { inner, .. } => match *inner {
            TypeInner::Scalar(Scalar::U32) => "u32".to_owned(),
            TypeInner::Vector {
                size,
                scalar: Scalar::F32,
            } => format!("vec{}<f32>", size as u8),
            _ => "another type".to_owned(),
        },
    }
}

/// Refuses what the CPU would answer differently, or not at all.
pub(crate) fn builtins(
    module: &Module,
    info: &ModuleInfo,
    source: &Source,
) -> Result<(), BuildError> {
    if let Some((handle, _)) = module.global_variables.iter().next() {
        let span = module.global_variables.get_span(handle);
        return Err(source.error(span, "an effect has no variables outside its functions"));
    }
    for (function_handle, function) in module.functions.iter() {
        let type_of = |expression: Handle<Expression>| {
            let types = &info[function_handle];
            types[expression].ty.inner_with(&module.types)
        };
        for (handle, expression) in function.expressions.iter() {
            let refuse =
                |message: String| Err(source.error(function.expressions.get_span(handle), message));
            match *expression {
                Expression::Math { fun, .. } if !is_tested(fun) => {
                    return refuse(format!(
                        "`{}` is not available in effects: {}",
                        format!("{fun:?}").to_lowercase(),
                        instead_of(fun)
                    ));
                }
                Expression::Swizzle { size, pattern, .. } if !is_permutation(size, &pattern) => {
                    return refuse(
                        "this swizzle is not available in effects: write its components out, \
                         as in `vec2<f32>(v.z, v.x)`"
                            .to_owned(),
                    );
                }
                Expression::Select {
                    condition, accept, ..
                } => {
                    if let (&TypeInner::Vector { size, .. }, TypeInner::Scalar(_)) =
                        (type_of(accept), type_of(condition))
                    {
                        return refuse(format!(
                            "`select` between vectors takes a condition for each component in \
                             effects: write it as `vec{}<bool>(condition)`",
                            size as u8
                        ));
                    }
                }
                Expression::As { convert: None, .. } if !repair::is_of_bits(function) => {
                    return refuse(
                        "`bitcast` is not available in effects: use `bits_of(x)` and `of_bits(bits)`"
                            .to_owned(),
                    );
                }
                Expression::Binary {
                    op: BinaryOperator::ShiftLeft | BinaryOperator::ShiftRight,
                    right,
                    ..
                } if !is_constant(function, right) => {
                    return refuse("a shift needs a constant number of bits in effects".to_owned());
                }
                _ => {}
            }
        }
    }
    Ok(())
}

/// Whether a number, or each of a vector's, is the same whenever the function is called.
fn is_constant(function: &naga::Function, number: Handle<Expression>) -> bool {
    match function.expressions[number] {
        Expression::Literal(_) | Expression::Constant(_) => true,
        Expression::Splat { value, .. } => is_constant(function, value),
        _ => false,
    }
}

/// Whether a swizzle only reorders the first components: those are all that the runtime has.
fn is_permutation(size: naga::VectorSize, pattern: &[naga::SwizzleComponent; 4]) -> bool {
    let size = size as usize;
    (0..size).all(|component| pattern[..size].iter().any(|c| *c as usize == component))
}

/// The builtins whose translation is tested in `effects` against their definition.
fn is_tested(fun: Math) -> bool {
    matches!(
        fun,
        Math::Abs
            | Math::Min
            | Math::Max
            | Math::Clamp
            | Math::Saturate
            | Math::Ceil
            | Math::Floor
            | Math::Trunc
            | Math::Dot
            | Math::Cross
            | Math::Distance
            | Math::Length
            | Math::Normalize
            | Math::Sign
            | Math::Mix
            | Math::SmoothStep
            | Math::Sqrt
    )
}

fn instead_of(fun: Math) -> &'static str {
    match fun {
        Math::Sin | Math::Cos | Math::Tan => {
            "WGSL's is good to 2^-11 only; use `sin_pi(x)`, which is sin(pi x)"
        }
        Math::Fract => "use `x - floor(x)`",
        Math::Round => "use `floor(x + 0.5)`",
        Math::InverseSqrt => "use `1.0 / sqrt(x)`",
        Math::Step => "use `select(0.0, 1.0, x >= edge)`",
        Math::Fma => "its rounding differs from driver to driver; use `a * b + c`",
        Math::Reflect => "use `v - 2.0 * dot(n, v) * n`",
        _ => {
            "use abs, min, max, clamp, saturate, ceil, floor, trunc, dot, cross, distance, length, \
             normalize, sign, mix, smoothstep, sqrt, select, and the prelude's functions"
        }
    }
}
