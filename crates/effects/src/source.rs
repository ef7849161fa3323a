//! What a graphics card needs to evaluate a program: its WGSL, and its parameters as words.

use crate::joints::Input;
use crate::param::{Param, ParamKind, Values};
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
    /// three numbers as many, a colour three, a colour or none four. A number that varies has in its place where among these words its table
    /// begins: its seed, the share by which strands differ, its least and its greatest value, the number of
    /// places along the strand, then each place with its value.
    pub words: &'a [u32],
    /// The parameters that vary, by their indices.
    pub varying: &'a [usize],
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
