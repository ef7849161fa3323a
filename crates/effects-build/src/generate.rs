//! The Rust source of an effect: the translator's output less what the prelude gives to all, and an
//! implementation of `effects::Program` over it.

use crate::check::{self, Paints};
use crate::choices;
use crate::compose::{Entry, PRELUDE, Source};
use crate::depth;
use crate::error::BuildError;
use crate::inputs::Input;
use crate::params::{Kind, Param};
use crate::repair;
use naga::Module;
use proc_macro2::TokenStream;
use quote::{format_ident, quote};
use std::collections::HashSet;
use syn::Item;

/// Rust items for the prelude alone, all public, for `effects::wgsl`.
pub(crate) fn prelude() -> Result<String, BuildError> {
    let docs = prelude_docs()?;
    let mut items = prelude_items()?;
    for item in &mut items {
        let (visibility, attributes, name) = match item {
            Item::Fn(f) => {
                // Into effects, which are crates of their own, and into loops that are compiled for other instructions.
                f.attrs.push(syn::parse_quote!(#[inline(always)]));
                repair::bits_in_rust(f);
                (&mut f.vis, &mut f.attrs, f.sig.ident.to_string())
            }
            Item::Struct(s) => (&mut s.vis, &mut s.attrs, s.ident.to_string()),
            Item::Const(c) => (&mut c.vis, &mut c.attrs, c.ident.to_string()),
            _ => continue,
        };
        *visibility = syn::parse_quote!(pub);
        if let Some((_, doc)) = docs.iter().find(|(documented, _)| *documented == name) {
            attributes.push(syn::parse_quote!(#[doc = #doc]));
        }
        if name.starts_with("v_") {
            attributes.push(syn::parse_quote!(#[doc(hidden)]));
        }
    }
    Ok(print(items))
}

/// Rust items for an effect, or for the clump.
pub(crate) fn effect(
    mut module: Module,
    source: &Source,
    params: &[Param],
    entry: Entry,
    paints: Paints,
) -> Result<String, BuildError> {
    repair::for_translation(&mut module);
    name_entries(&mut module);
    let shared: HashSet<String> = prelude_items()?.iter().filter_map(item_name).collect();
    let mut items = translate(&module, &source.path)?;
    items.retain(|item| item_name(item).is_none_or(|name| !shared.contains(&name)));
    for item in &mut items {
        document(item, params);
        if let Item::Fn(f) = item {
            // So that where radii alone are asked for the rest is not worked out.
            f.attrs.push(syn::parse_quote!(#[inline(always)]));
        }
    }
    let own = quote! { #(#items)* };
    let choices = named_choices(params);
    let program = match entry {
        Entry::Effect => effect_program(&module, source, params, paints),
        Entry::Clump => clump_program(source, params),
    };
    let inputs = (!source.is_for_meshes).then(|| {
        quote!(
            pub use self::translated::Inputs;
        )
    });
    let file: syn::File = syn::parse2(quote! {
        #inputs
        pub use self::translated::Params;
        #[allow(
            missing_docs,
            unused,
            non_upper_case_globals,
            unused_qualifications,
            clippy::all
        )]
        mod translated {
            use ::effects::wgsl::*;
            #own
        }
        #choices
        #program
    })
    .map_err(|e| BuildError(format!("{}: {e}", source.path)))?;
    Ok(prettyplease::unparse(&file))
}

fn effect_program(
    module: &Module,
    source: &Source,
    params: &[Param],
    paints: Paints,
) -> TokenStream {
    let common = program_items(source, params);
    let gather = fields(&source.inputs, Input::value);
    let may_be_nearer = depth::may_be_nearer(module);
    let painting = painting(module, source, params, paints);
    let stroke = (!source.is_for_meshes).then(|| {
        let for_stroke = knowing("stroke", choices::of(module, "entry_stroke", params));
        let in_block = in_block(
            &source.inputs,
            quote!(translated::entry_stroke(joint, ::effects::rt::Scalar(instance), params(lane))),
        );
        quote! {
            #[inline(always)]
            fn stroke(
                joints: &::effects::Joints,
                index: usize,
                instance: u32,
                seed: u32,
                params: &Params,
            ) -> ::effects::wgsl::Stroke {
                let _ = (joints, index, seed);
                translated::entry_stroke(Inputs { #gather }, ::effects::rt::Scalar(instance), *params)
            }
            #[inline(always)]
            fn strokes(
                joints: &::effects::Joints,
                block: ::core::ops::Range<usize>,
                instance: u32,
                seed: u32,
                params: impl Fn(usize) -> Params,
                mut give: impl FnMut(usize, ::effects::wgsl::Stroke),
            ) {
                #in_block
            }
            #for_stroke
        }
    });
    quote! {
        /// The effect's WGSL, and the same in Rust.
        #[derive(Clone, Copy, Debug)]
        pub struct Program;
        impl ::effects::Parameters for Program {
            #common
        }
        impl ::effects::Program for Program {
            const MAY_BE_NEARER: bool = #may_be_nearer;
            #stroke
            #painting
        }
    }
}

/// What an effect that paints has beside its strokes.
fn painting(module: &Module, source: &Source, params: &[Param], paints: Paints) -> TokenStream {
    let (Some(inputs), true) = (&source.sample_inputs, paints != Paints::No) else {
        return TokenStream::new();
    };
    let variants = inputs.iter().map(|input| {
        let variant = input.variant();
        quote!(::effects::SampleInput::#variant)
    });
    let fields = fields(inputs, Input::of_block);
    let sample = quote! {
        let _ = (samples, index, seed);
        let at = translated::Sample { #fields };
    };
    let for_place = knowing("place", choices::of(module, "entry_place", params));
    let for_paint = knowing("paint", choices::of(module, "entry_paint", params));
    let (place, texel) = match paints {
        Paints::WithTexture => {
            let place = quote! {
                const PLACES: bool = true;
                #[inline(always)]
                fn place(
                    samples: &::effects::SampleBlock,
                    index: usize,
                    seed: u32,
                    params: &Params,
                ) -> ::core::option::Option<::effects::wgsl::Lookup> {
                    #sample
                    Some(translated::entry_place(at, *params))
                }
            };
            (Some(place), Some(quote!(texel,)))
        }
        Paints::Plainly | Paints::No => (None, None),
    };
    quote! {
        const PAINTS: ::core::option::Option<&'static [::effects::SampleInput]> = Some(&[#(#variants),*]);
        #place
        #for_place
        #for_paint
        #[inline(always)]
        fn paint(
            samples: &::effects::SampleBlock,
            index: usize,
            seed: u32,
            texel: ::effects::wgsl::Vec4<f32>,
            params: &Params,
        ) -> ::effects::wgsl::Vec3<f32> {
            let _ = texel;
            #sample
            translated::entry_paint(at, #texel *params)
        }
    }
}

/// `knowing_place` or `knowing_paint`, where the function switches on a choice.
fn knowing(function: &str, choice: Option<(&str, u32)>) -> TokenStream {
    let Some((name, count)) = choice else {
        return TokenStream::new();
    };
    let (function, field) = (format_ident!("knowing_{function}"), format_ident!("{name}"));
    let known = (0..count).map(|choice| match choice + 1 == count {
        true => quote!(_ => work(&Params { #field: #choice, ..*params })),
        false => quote!(#choice => work(&Params { #field: #choice, ..*params })),
    });
    quote! {
        #[inline(always)]
        fn #function(params: &Params, mut work: impl FnMut(&Params)) {
            match params.#field { #(#known),* }
        }
    }
}

fn clump_program(source: &Source, params: &[Param]) -> TokenStream {
    let common = program_items(source, params);
    let in_block = in_block(
        &source.inputs,
        quote!(translated::entry_clump(joint, params(lane))),
    );
    quote! {
        /// The clump's WGSL, and the same in Rust.
        #[derive(Clone, Copy, Debug)]
        pub struct Program;
        impl Program {
            #[doc = "The clumps of a block's joints, as `strokes` of an effect's program."]
            #[inline(always)]
            fn clumps(
                joints: &::effects::Joints,
                block: ::core::ops::Range<usize>,
                seed: u32,
                params: impl Fn(usize) -> Params,
                mut give: impl FnMut(usize, ::effects::wgsl::Clump),
            ) {
                #in_block
            }
        }
        impl ::effects::Parameters for Program {
            #common
        }
    }
}

/// Gives what is `worked_out` of each `joint` of a block.
fn in_block(inputs: &[&Input], worked_out: TokenStream) -> TokenStream {
    let blocks = inputs.iter().map(|input| input.block());
    let at = fields(inputs, Input::at);
    quote! {
        let _ = (joints, seed);
        let first = block.start;
        #(#blocks)*
        for lane in 0..::effects::LANES {
            let joint = Inputs { #at };
            give(lane, #worked_out);
        }
    }
}

/// Gives the functions that are called from outside names that no variable has: the translator numbers names that are there twice,
/// over all functions.
fn name_entries(module: &mut Module) {
    for (_, function) in module.functions.iter_mut() {
        if let Some(name @ ("stroke" | "clump" | "place" | "paint")) = function.name.as_deref() {
            function.name = Some(format!("entry_{name}"));
        }
    }
}

/// What both kinds of source share: the parameters, the inputs and the text for the GPU.
fn program_items(source: &Source, params: &[Param]) -> TokenStream {
    let text = &source.text;
    let inputs = source.inputs.iter().map(|input| {
        let variant = input.variant();
        quote!(::effects::Input::#variant)
    });
    let textures = params
        .iter()
        .filter(|p| matches!(p.kind, Kind::Texture { .. }));
    let textures: Vec<&str> = textures.map(|param| param.name.as_str()).collect();
    let table = params.iter().map(table_row);
    let fields = params.iter().map(|p| {
        let (field, name) = (format_ident!("{}", p.name), &p.name);
        let value = match p.kind {
            Kind::Number { .. } => quote!(values.number(#name)),
            Kind::Integer { .. } => quote!(values.integer(#name).unsigned_abs()),
            Kind::Signed { .. } => quote!(values.integer(#name)),
            Kind::Flag { .. } => quote!(values.flag(#name)),
            Kind::Pair { .. } => quote!(::effects::wgsl::vec2(values.pair(#name))),
            Kind::Triple { .. } => quote!(::effects::wgsl::vec3(values.triple(#name))),
            Kind::Choice { .. } => quote!(values.choice(#name)),
            Kind::Color { .. } => quote!(::effects::wgsl::vec3(values.color(#name))),
            Kind::OptionalColor { .. } => {
                quote!(::effects::wgsl::color_or_none(values.optional_color(#name)))
            }
            Kind::Texture { .. } => {
                let index = textures.iter().position(|texture| texture == name);
                let index = index.unwrap_or_default() as u32;
                quote!(#index)
            }
        };
        quote!(#field: #value)
    });
    let numbers = params.iter().enumerate().filter_map(|(index, param)| {
        let field = format_ident!("{}", param.name);
        let is_number = matches!(param.kind, Kind::Number { .. });
        is_number.then(|| quote!(if index == #index { params.#field = value; }))
    });
    let (mut rows, mut of_lane) = (Vec::new(), Vec::new());
    for (index, param) in params.iter().enumerate() {
        if let Kind::Number { .. } = param.kind {
            let (field, row) = (
                format_ident!("{}", param.name),
                format_ident!("row_{}", param.name),
            );
            rows.push(quote!(let #row = numbers[#index];));
            of_lane.push(quote!(#field: #row[lane],));
        }
    }
    let others = (rows.len() < params.len()).then(|| quote!(..params));
    quote! {
        type Params = Params;
        const PARAMS: &'static [::effects::Param] = &[#(#table),*];
        const INPUTS: &'static [::effects::Input] = &[#(#inputs),*];
        const WGSL: &'static str = #text;
        fn params(values: &::effects::Values) -> Params {
            let _ = values;
            Params { #(#fields),* }
        }
        fn set_number(params: &mut Params, index: usize, value: f32) {
            #(#numbers)*
            let _ = (params, index, value);
        }
        #[inline(always)]
        fn with_numbers<const N: usize>(
            params: &Params,
            numbers: &[[f32; N]],
        ) -> impl Fn(usize) -> Params {
            let _ = (params, numbers);
            let params = *params;
            #(#rows)*
            move |lane| {
                let _ = (lane, params);
                Params { #(#of_lane)* #others }
            }
        }
    }
}

fn table_row(param: &Param) -> TokenStream {
    let Param {
        name, doc, unit, ..
    } = param;
    let kind = match &param.kind {
        Kind::Number {
            min,
            max,
            default,
            varies,
        } => {
            quote!(Number { min: #min, max: #max, default: #default, varies: #varies })
        }
        Kind::Flag { default } => quote!(Flag { default: #default }),
        Kind::Pair { min, max, default } => {
            quote!(Pair { min: #min, max: #max, default: [#(#default),*] })
        }
        Kind::Triple { min, max, default } => {
            quote!(Triple { min: #min, max: #max, default: [#(#default),*] })
        }
        Kind::Integer { min, max, default } | Kind::Signed { min, max, default } => {
            quote!(Integer { min: #min, max: #max, default: #default })
        }
        Kind::Choice { names, default } => {
            let default = *default as usize;
            quote!(Choice { names: &[#(#names),*], default: #default })
        }
        Kind::Color { default } => quote!(Color { default: #default }),
        Kind::OptionalColor { default: None } => quote!(OptionalColor { default: None }),
        Kind::OptionalColor { default: Some(hex) } => {
            quote!(OptionalColor { default: Some(#hex) })
        }
        Kind::Texture { default, repeats } => {
            quote!(Texture { default: #default, repeats: #repeats })
        }
    };
    quote!(::effects::Param {
        name: #name,
        doc: #doc,
        unit: #unit,
        kind: ::effects::ParamKind::#kind
    })
}

/// `Params::KIND_RING` for the choice `ring` of the parameter `kind`, so that nobody compares with a number.
fn named_choices(params: &[Param]) -> TokenStream {
    let constants = params.iter().flat_map(|param| {
        let names = match &param.kind {
            Kind::Choice { names, .. } => &names[..],
            _ => &[],
        };
        names.iter().zip(0u32..).map(|(choice, index)| {
            let name = format!("{}_{choice}", param.name).to_uppercase();
            let name = name.replace(|c: char| !c.is_ascii_alphanumeric(), "_");
            let (name, doc) = (
                format_ident!("{name}"),
                format!("`{choice}`, a choice of [`{0}`](Self::{0}).", param.name),
            );
            quote!(#[doc = #doc] pub const #name: u32 = #index;)
        })
    });
    let constants: Vec<_> = constants.collect();
    if constants.is_empty() {
        return TokenStream::new();
    }
    quote! {
        #[allow(dead_code, reason = "not all that a preset may say makes a difference in Rust")]
        impl Params {
            #(#constants)*
        }
    }
}

/// The declared inputs' values.
fn fields(inputs: &[&Input], value: fn(&Input) -> TokenStream) -> TokenStream {
    let fields = inputs.iter().map(|input| {
        let (field, value) = (format_ident!("{}", input.name), value(input));
        match input.name {
            // The list has the strand's part.
            "seed" => quote!(seed: ::effects::wgsl::hash(seed ^ #value)),
            _ => quote!(#field: #value),
        }
    });
    quote!(#(#fields),*)
}

/// Gives the fields of `Params` their documentation.
fn document(item: &mut Item, params: &[Param]) {
    let Item::Struct(structure) = item else {
        return;
    };
    if structure.ident != "Params" {
        return;
    }
    for (field, param) in structure.fields.iter_mut().zip(params) {
        let doc = if param.unit.is_empty() {
            param.doc.clone()
        } else {
            format!("{} Unit: {}.", param.doc, param.unit)
        };
        field.attrs.push(syn::parse_quote!(#[doc = #doc]));
    }
}

fn prelude_items() -> Result<Vec<Item>, BuildError> {
    let mut module = naga::front::wgsl::parse_str(PRELUDE)
        .map_err(|e| BuildError(e.emit_to_string_with_path(PRELUDE, "prelude.wgsl")))?;
    repair::for_translation(&mut module);
    translate(&module, "prelude.wgsl")
}

/// Names in the prelude with their comments.
fn prelude_docs() -> Result<Vec<(String, String)>, BuildError> {
    let source = Source {
        path: "prelude.wgsl".to_owned(),
        text: PRELUDE.to_owned(),
        author_length: PRELUDE.len(),
        shared: None,
        inputs: Vec::new(),
        sample_inputs: None,
        is_for_meshes: false,
    };
    let (module, _) = check::parse(&source)?;
    let Some(comments) = &module.doc_comments else {
        return Ok(Vec::new());
    };
    let text = |lines: &Vec<String>| {
        let lines = lines
            .iter()
            .map(|line| line.trim().trim_start_matches('/').trim_end());
        lines.collect::<Vec<_>>().join("\n")
    };
    let functions = comments
        .functions
        .iter()
        .map(|(f, doc)| (&module.functions[*f].name, doc));
    let types = comments
        .types
        .iter()
        .map(|(t, doc)| (&module.types[*t].name, doc));
    Ok(functions
        .chain(types)
        .filter_map(|(name, doc)| Some((name.clone()?, text(doc))))
        .collect())
}

fn translate(module: &Module, path: &str) -> Result<Vec<Item>, BuildError> {
    let info =
        check::validate(module).map_err(|e| BuildError(format!("{path}: {e:?} (after repair)")))?;
    let config = naga_rust_back::Config::new()
        .public_items(true)
        .runtime_path("::effects::rt");
    let rust = naga_rust_back::write_string(module, &info, config)
        .map_err(|e| BuildError(format!("{path}: {e}")))?;
    // Builtins whose own code compilers don't take into that of their callers: `effects::wgsl` has them once more.
    let rust = rust
        .replace(".smoothstep(", ".smooth_step(")
        .replace(".cast_elem_as_f32(", ".as_f32(")
        .replace(".cast_elem_as_u32(", ".as_u32(")
        .replace(".cast_elem_as_i32(", ".as_i32(");
    let file: syn::File = syn::parse_str(&rust)
        .map_err(|e| BuildError(format!("{path}: the translation is not Rust: {e}")))?;
    Ok(file.items)
}

fn item_name(item: &Item) -> Option<String> {
    match item {
        Item::Fn(f) => Some(f.sig.ident.to_string()),
        Item::Struct(s) => Some(s.ident.to_string()),
        Item::Const(c) => Some(c.ident.to_string()),
        Item::Impl(i) => match &*i.self_ty {
            syn::Type::Path(path) => Some(path.path.segments.last()?.ident.to_string()),
            _ => None,
        },
        _ => None,
    }
}

fn print(items: Vec<Item>) -> String {
    prettyplease::unparse(&syn::parse_quote!(#(#items)*))
}
