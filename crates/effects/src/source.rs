//! What a graphics card needs to evaluate a program: its WGSL, and its parameters as words.

use crate::joints::Input;
use crate::param::{Param, ParamKind, Values};
use crate::samples::SampleInput;
use crate::texture::Texture;
use crate::variation::Varying;
use crate::wgsl::color_or_none;

/// A program for a graphics card.
#[derive(Clone, Copy, Debug)]
pub struct ProgramSource<'a> {
    /// The author's text, `struct Inputs` with the declared inputs, and the prelude.
    pub wgsl: &'static str,
    /// The inputs that are read, in the order of the fields of `struct Inputs`.
    pub inputs: &'static [Input],
    /// The fields of `struct Params`, in their order.
    pub params: &'static [Param],
    /// The parameters in their order, as 32-bit words: a number, a whole number, a flag (0 or 1) and a choice take one, two and
    /// three numbers as many, a colour three, a colour or none four, a texture one: its number among the textures. A number that varies has in its place where among these words its table
    /// begins: its seed, the share by which strands differ, its least and its greatest value, the number of
    /// places along the strand, then each place with its value.
    pub words: &'a [u32],
    /// The parameters that vary, by their indices.
    pub varying: &'a [usize],
    /// How what its strokes show is painted; nothing where they are as they are.
    pub paint: Option<PaintSource<'a>>,
}

/// What a program that paints has beside its strokes: `fn paint` and, where there is a texture to be looked up, `fn place`.
#[derive(Clone, Copy, Debug)]
pub struct PaintSource<'a> {
    /// What is read of a sample, in the order of the fields of `struct Sample`.
    pub inputs: &'static [SampleInput],
    /// Whether there is a `place`, and `paint` takes the texel that is found there.
    pub places: bool,
    /// The textures, by the number that their parameters have, and whether they repeat.
    pub textures: &'a [(Texture, bool)],
}

/// The words of [`ProgramSource::words`].
pub(crate) fn words(params: &[Param], values: &Values, varying: &[Varying]) -> Vec<u32> {
    let mut words = Vec::new();
    // Where each table's place is to be noted.
    let mut notes = Vec::new();
    for (index, param) in params.iter().enumerate() {
        if varying.iter().any(|v| v.index == index) {
            notes.push(words.len());
            words.push(0);
            continue;
        }
        let bits = |numbers: &[f32]| numbers.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
        words.extend(match param.kind {
            ParamKind::Number { .. } => bits(&[values.number(param.name)]),
            ParamKind::Integer { .. } => vec![values.integer(param.name) as u32],
            ParamKind::Flag { .. } => vec![u32::from(values.flag(param.name))],
            ParamKind::Pair { .. } => bits(&values.pair(param.name)),
            ParamKind::Triple { .. } => bits(&values.triple(param.name)),
            ParamKind::Choice { .. } => vec![values.choice(param.name)],
            ParamKind::Texture { .. } => vec![texture_number(params, index)],
            ParamKind::Color { .. } => bits(&values.color(param.name)),
            // Programs have none.
            ParamKind::Text | ParamKind::Size { .. } => Vec::new(),
            ParamKind::OptionalColor { .. } => {
                let color = color_or_none(values.optional_color(param.name));
                bits(&[color.x, color.y, color.z, color.w])
            }
        });
    }
    for (varying, note) in varying.iter().zip(notes) {
        words[note] = words.len() as u32;
        let [min, max] = varying.range;
        let curve = &varying.variation.curve;
        words.push(varying.seed);
        words.extend([varying.variation.vary, min, max].map(f32::to_bits));
        words.push(curve.len() as u32);
        for (place, value) in curve {
            words.extend([place.to_bits(), value.to_bits()]);
        }
    }
    words
}

/// Which of the textures a parameter is.
fn texture_number(params: &[Param], index: usize) -> u32 {
    let is_texture = |param: &&Param| matches!(param.kind, ParamKind::Texture { .. });
    params[..index].iter().filter(is_texture).count() as u32
}
