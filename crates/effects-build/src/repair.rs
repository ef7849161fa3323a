//! Repairs for `naga-rust-back` 0.4.0, each tested in `effects/tests/wgsl.rs`. They change what the
//! CPU's translation sees only; the GPU gets the author's text.

use naga::{Expression, MathFunction, Module, Span};

/// Changes the module so that its translation means what WGSL says.
pub(crate) fn for_translation(module: &mut Module) {
    for (_, function) in module.functions.iter_mut() {
        initialise_locals(function);
        reorder_smoothstep(function);
    }
}

/// WGSL zeroes `var x: T;`, the translation leaves it unassigned.
fn initialise_locals(function: &mut naga::Function) {
    let types: Vec<_> = function
        .local_variables
        .iter()
        .map(|(_, v)| (v.init, v.ty))
        .collect();
    let inits: Vec<_> = types
        .into_iter()
        .map(|(init, ty)| {
            init.unwrap_or_else(|| {
                function
                    .expressions
                    .append(Expression::ZeroValue(ty), Span::UNDEFINED)
            })
        })
        .collect();
    for ((_, variable), init) in function.local_variables.iter_mut().zip(inits) {
        variable.init = Some(init);
    }
}

/// The runtime's `x.smoothstep(low, high)` takes x first, WGSL's takes it last; the translation
/// passes WGSL's order on.
fn reorder_smoothstep(function: &mut naga::Function) {
    for (_, expression) in function.expressions.iter_mut() {
        if let Expression::Math {
            fun: MathFunction::SmoothStep,
            arg: low,
            arg1: Some(high),
            arg2: Some(x),
            ..
        } = *expression
        {
            *expression = Expression::Math {
                fun: MathFunction::SmoothStep,
                arg: x,
                arg1: Some(low),
                arg2: Some(high),
                arg3: None,
            };
        }
    }
}
