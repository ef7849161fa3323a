//! Repairs for `naga-rust-back` 0.4.0, each tested in `effects/tests/wgsl.rs`. They change what the
//! CPU's translation sees only; the GPU gets the author's text.

use naga::{Expression, MathFunction, Module, Span};

/// Changes the module so that its translation means what WGSL says.
pub(crate) fn for_translation(module: &mut Module) {
    for (_, function) in module.functions.iter_mut() {
        initialise_locals(function);
        reorder_smoothstep(function);
        if is_of_bits(function) {
            cast_in_place_of_bitcast(function);
        }
    }
}

/// Whether it is one of the prelude's functions that give a number's bits, and the other way round: what the translation makes of
/// these is replaced by [`bits_in_rust`].
pub(crate) fn is_of_bits(function: &naga::Function) -> bool {
    let name = function.name.as_deref();
    name == Some("bits_of") || name == Some("of_bits")
}

/// The translation has no `bitcast`.
fn cast_in_place_of_bitcast(function: &mut naga::Function) {
    for (_, expression) in function.expressions.iter_mut() {
        if let Expression::As { convert, .. } = expression {
            *convert = Some(size_of::<f32>() as u8);
        }
    }
}

/// The translation of `bits_of` or `of_bits`, which does what its name says.
pub(crate) fn bits_in_rust(function: &mut syn::ItemFn) {
    let bits: syn::Expr = match function.sig.ident.to_string().as_str() {
        "v_bits_of" => syn::parse_quote!(number.0.to_bits()),
        "v_of_bits" => syn::parse_quote!(f32::from_bits(number.0)),
        _ => return,
    };
    for input in &mut function.sig.inputs {
        if let syn::FnArg::Typed(argument) = input {
            argument.pat = syn::parse_quote!(number);
        }
    }
    function.block = syn::parse_quote!({ ::effects::rt::Scalar(#bits) });
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
