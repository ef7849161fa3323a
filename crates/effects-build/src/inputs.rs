//! What a joint offers, and a painted sample: the tables of all inputs. WGSL's `struct Inputs` and `struct Sample` are made from them,
//! and in Rust `effects::Input`, the lists of `effects::Joints`, their like for samples, and what tests of effects need.
//!
//! A new input is a row here, and what works it out: the compiler asks for that in `render`, on the CPU in
//! `cpu/evaluate.rs` and on a graphics card in `gpu/inputs.rs`, and for values to try it with in `effects-testkit`.

use Offered::{Both, ToEffects, ToHair, ToMeshes};
use Type::{F32, U32, Vec2, Vec3};
use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};

/// Something that a joint or a sample offers. What an effect does not declare is not there.
pub(crate) struct Input {
    /// The field's name in WGSL, and the list's in Rust.
    pub name: &'static str,
    pub ty: Type,
    pub offered: Offered,
    /// What it is, with its unit.
    pub doc: &'static str,
    /// What it is where its list is empty, in Rust. The lists of others are never empty where they are read.
    pub where_empty: Option<fn() -> TokenStream>,
}

/// The type of an input.
#[derive(Clone, Copy)]
pub(crate) enum Type {
    F32,
    U32,
    Vec2,
    Vec3,
}

impl Type {
    pub fn in_wgsl(self) -> &'static str {
        match self {
            F32 => "f32",
            U32 => "u32",
            Vec2 => "vec2<f32>",
            Vec3 => "vec3<f32>",
        }
    }

    fn in_rust(self) -> TokenStream {
        match self {
            F32 => quote!(f32),
            U32 => quote!(u32),
            Vec2 => quote!(::effects::wgsl::Vec2<f32>),
            Vec3 => quote!(::effects::wgsl::Vec3<f32>),
        }
    }
}

/// Who may declare an input.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Offered {
    /// Of joints: effects alone, as it comes from the clump, or is a layer's own.
    ToEffects,
    /// Of samples: those that show strokes alone.
    ToHair,
    /// Of samples: those that show meshes alone.
    ToMeshes,
    /// Effects and the clump; samples of strokes and of meshes.
    Both,
}

const fn input(name: &'static str, ty: Type, offered: Offered, doc: &'static str) -> Input {
    Input {
        name,
        ty,
        offered,
        doc,
        where_empty: None,
    }
}

impl Input {
    const fn where_empty(self, value: fn() -> TokenStream) -> Self {
        Self {
            where_empty: Some(value),
            ..self
        }
    }
}

/// All inputs, in the order in which they stand in `struct Inputs`.
#[rustfmt::skip]
pub(crate) const INPUTS: &[Input] = &[
    input("position", Vec3, Both, "place in the world, metres"),
    input("forward", Vec3, Both, "unit vector to the next joint; at the tip that of the joint before; where a layer of the look paints, along the strand"),
    input("backward", Vec3, Both, "unit vector to the joint before (B in 5.4); at the root that of the next joint; where a layer of the look paints, back along the strand"),
    input("u", F32, Both, "place along the strand, 0 at the root, 1 at the tip"),
    input("arc_length", F32, Both, "length of the strand up to here, metres"),
    input("strand", U32, Both, "the strand's stable id"),
    input("seed", U32, Both, "for `random`: a hash of style seed, layer name and strand"),
    input("strand_mean", Vec3, Both, "mean of the strand's particles, metres (c_mean in 5.4)"),
    input("head_center", Vec3, Both, "centre of the head, metres (c_head in 5.4)"),
    input("head_height", F32, Both, "height of the head, metres"),
    input("strand_size", F32, Both, "the strand's full size, 1/300 of the head's height"),
    input("strand_taper", Vec2, Both, "the strand's own root size and start of shrinking, in place of the clump's; below 0 the clump's")
        // Where no strand has one.
        .where_empty(|| quote!(::effects::wgsl::vec2([-1.0; 2]))),
    input("strand_color", Vec3, Both, "the strand's own colour, linear, in place of the clump's; below 0 the clump's")
        .where_empty(|| quote!(::effects::wgsl::vec3([-1.0; 3]))),
    input("strand_tip_color", Vec3, Both, "the strand's own colour at its tip, linear, in place of the clump's; below 0 the clump's")
        .where_empty(|| quote!(::effects::wgsl::vec3([-1.0; 3]))),
    input("light_direction", Vec3, Both, "unit vector to the light"),
    input("light_distance", F32, Both, "distance to the light, head heights; 1e6 for a direction"),
    input("light_on_screen", Vec3, Both, "unit vector to the light as it is seen: x right, y down, z to the eye"),
    input("view_direction", Vec3, Both, "unit vector to the eye"),
    input("depth", F32, Both, "distance from the eye along the view's axis, head heights"),
    input("time", F32, Both, "time of the scene, seconds: what reads it changes while nothing moves"),
    input("across", Vec2, Both, "unit vector across the path on the screen (x right, y down)"),
    input("material_normal", Vec3, Both, "unit vector across the strand that turns as it twists, outwards at rest; cross(forward, it) is the binormal")
        // The clump declares it, and reads it where its parameters say so.
        .where_empty(|| quote!(::effects::wgsl::vec3([0.0; 3]))),
    input("rest_position", Vec3, Both, "where the strand is here at rest, head heights from the head's centre: x to its left, y up, z to the face; on a contour of a surface, which is at rest nowhere, a place that stays with it from frame to frame: x is how far along it is"),
    input("rest_forward", Vec3, Both, "unit vector along the strand at rest, to the next joint, in the head's axes: x to its left, y up, z to the face; 0 on lines of surfaces, which are at rest nowhere"),
    input("from_ends", Vec2, Both, "how far it is, as it is seen, to where the strand begins (x) and where it ends (y), metres at its depth"),
    input("path_weight", F32, Both, "how much of a path that the effect made is there, as its `make_paths` says it; 1 on strands"),
    input("unit", F32, ToEffects, "one unit of the layer's widths in 1/300 of the head's height: 1, or a pixel's size at 720 lines")
        .where_empty(|| quote!(1.0)),
    input("normal", Vec3, ToEffects, "the clump's unit normal (5.4)"),
    input("clump_radius", F32, ToEffects, "the clump's radius, 1/300 of the head's height (5.3)"),
    input("clump_color", Vec3, ToEffects, "the clump's basic colour, linear"),
    input("clump_shift", Vec2, ToEffects, "how far the clump's strokes are moved on the screen (x right, y down), away from its outer end, 1/300 of the head's height; 0 but where a flat clump points to or from the eye"),
    input("gray", F32, ToEffects, "max(light . normal, 0)"),
];

/// What a painted sample offers, in the order in which it stands in `struct Sample`.
#[rustfmt::skip]
pub(crate) const SAMPLE_INPUTS: &[Input] = &[
    input("color", Vec3, Both, "own colour of the stroke here, or of the mesh in light with its picture, linear"),
    input("shade_color", Vec3, ToMeshes, "the mesh's own colour away from the light with its picture, linear"),
    input("position", Vec3, Both, "place in the world, metres: of hair that of the stroke's axis beside the sample"),
    input("forward", Vec3, ToHair, "unit vector along the strand, to its tip"),
    input("normal", Vec3, Both, "unit normal: of hair the clump's (5.4), of a mesh as smooth as its corners' are"),
    input("occlusion", F32, ToMeshes, "how much the mesh lies in shadow whatever the light, 0 to 1, or 3 in the shadow of hair: what is to be taken off the cosine to the light"),
    input("tube", Vec3, ToHair, "unit normal of the stroke as a round tube: `rounded(normal, tube, roundness)` is between both"),
    input("u", F32, ToHair, "place along the strand, 0 at the root, 1 at the tip"),
    input("s", F32, ToHair, "length of the strand up to here, head heights"),
    input("v", F32, ToHair, "place across the stroke, -1 to 1"),
    input("w", F32, ToHair, "place across the clump, -1 to 1"),
    input("strand", U32, ToHair, "the strand's stable id"),
    input("seed", U32, ToHair, "for `random`: a hash of style seed, layer name and strand"),
    input("level", U32, ToHair, "0 back, 1 middle, 2 front, where the clump has levels; else 0"),
    input("depth", F32, Both, "distance from the eye along the view's axis, head heights"),
    input("head_depth", F32, Both, "the same of the head's centre, head heights"),
    input("light_direction", Vec3, Both, "unit vector to the light"),
    input("light_distance", F32, Both, "distance to the light, head heights; 1e6 for a direction"),
    input("view_direction", Vec3, Both, "unit vector to the eye"),
    input("pixels", F32, Both, "pixels that a head's height takes at this depth"),
    input("time", F32, Both, "time of the scene, seconds: what reads it changes while nothing moves"),
];

/// `for_each_input!` and `for_each_sample_input!`, which give the tables to a macro of another crate: for each input its comment, its
/// name as an enum's and as a list's, and its type.
pub(crate) fn for_each_input() -> TokenStream {
    let (joints, samples) = (
        for_each(&format_ident!("for_each_input"), INPUTS),
        for_each(&format_ident!("for_each_sample_input"), SAMPLE_INPUTS),
    );
    quote!(#joints #samples)
}

fn for_each(name: &Ident, table: &[Input]) -> TokenStream {
    let rows = table.iter().map(|input| {
        let (variant, name) = (
            format_ident!("{}", variant(input.name)),
            format_ident!("{}", input.name),
        );
        let (doc, ty) = (input.doc, input.ty.in_rust());
        quote!(#[doc = #doc] #variant #name: #ty,)
    });
    quote! {
        #[doc(hidden)]
        #[macro_export]
        macro_rules! #name {
            ($rows:ident) => { $rows! { #(#rows)* } };
        }
    }
}

impl Input {
    /// Its name in `effects::Input` or `effects::SampleInput`.
    pub fn variant(&self) -> Ident {
        format_ident!("{}", variant(self.name))
    }

    /// Its value at `index` of the lists `joints`.
    pub fn value(&self) -> TokenStream {
        let name = format_ident!("{}", self.name);
        match self.where_empty {
            Some(value) => {
                let value = value();
                quote!(joints.#name.get(index).copied().unwrap_or(#value))
            }
            None => quote!(joints.#name[index]),
        }
    }

    /// A variable for its values of the joints of a block, which begins at `first` of the lists `joints`.
    pub fn block(&self) -> TokenStream {
        let (name, block) = (format_ident!("{}", self.name), self.block_name());
        match self.where_empty {
            Some(value) => {
                let value = value();
                quote!(let #block = ::effects::block_or(&joints.#name, first, #value);)
            }
            None => quote!(let #block = ::effects::block(&joints.#name, first);),
        }
    }

    /// Its value of joint `lane` of that block.
    pub fn at(&self) -> TokenStream {
        let block = self.block_name();
        quote!(#block[lane])
    }

    fn block_name(&self) -> Ident {
        format_ident!("block_{}", self.name)
    }
}

impl Input {
    /// Its value of sample `index` of the block `samples`.
    pub fn of_block(&self) -> TokenStream {
        let name = format_ident!("{}", self.name);
        match self.ty {
            Vec3 => quote!(samples.#name.at(index)),
            F32 | U32 | Vec2 => quote!(samples.#name[index]),
        }
    }
}

/// `clump_radius` as `ClumpRadius`.
fn variant(name: &str) -> String {
    let capital = |word: &str| {
        let (first, rest) = word.split_at(1);
        first.to_uppercase() + rest
    };
    name.split('_').map(capital).collect()
}
