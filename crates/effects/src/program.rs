//! What the translated code of an effect, or of the clump, implements.

use crate::joints::{Input, Joints};
use crate::param::{Param, ParamKind, Values};
use crate::samples::{SampleBlock, SampleInput};
use crate::wgsl::{Lookup, Stroke, Vec3, Vec4, vec2, vec3};
use std::ops::Range;

/// Parameters with their table, and the WGSL that reads them. Implemented by the translated code.
pub trait Parameters: Send + Sync + 'static {
    /// The parameters as the WGSL has them.
    type Params: Clone + Send + Sync + std::fmt::Debug + PartialEq + 'static;
    /// What parameters there are.
    const PARAMS: &'static [Param];
    /// The inputs that are read, in the order of the fields of `struct Inputs`.
    const INPUTS: &'static [Input];
    /// The composed WGSL, for the GPU.
    const WGSL: &'static str;
    /// The parameters of these values; what varies has its value at the root.
    fn params(values: &Values) -> Self::Params;
    /// Sets number `index` of [`Self::PARAMS`].
    fn set_number(params: &mut Self::Params, index: usize, value: f32) {
        let _ = (params, index, value);
    }
    /// The parameters of each joint or sample of a block, with those `numbers`: a row for each of [`Self::PARAMS`], of which those that are no numbers are not looked at.
    #[inline(always)]
    fn with_numbers<const N: usize>(
        params: &Self::Params,
        numbers: &[[f32; N]],
    ) -> impl Fn(usize) -> Self::Params {
        move |lane| {
            let mut params = params.clone();
            for (index, (param, row)) in Self::PARAMS.iter().zip(numbers).enumerate() {
                if let ParamKind::Number { .. } = param.kind {
                    Self::set_number(&mut params, index, row[lane]);
                }
            }
            params
        }
    }
}

/// An effect's WGSL in Rust. Implemented by the translated code.
pub trait Program: Parameters {
    /// The disc of stroke `instance` at joint `index`. `seed` is the layer's. Of an effect for meshes it has no size.
    fn stroke(
        joints: &Joints,
        index: usize,
        instance: u32,
        seed: u32,
        params: &Self::Params,
    ) -> Stroke {
        let _ = (joints, index, instance, seed, params);
        Stroke {
            offset: vec2([0.0; 2]),
            radius: 0.0,
            depth_offset: 0.0,
            color: vec3([0.0; 3]),
        }
    }

    /// [`Self::stroke`] of a block's joints, [`LANES`](crate::LANES) at most, in a loop that compiles to vector instructions: `give` gets the number of each joint, from 0
    /// on, with its disc, and `params` tells its parameters. What it gets of more joints than these is anything.
    #[inline(always)]
    fn strokes(
        joints: &Joints,
        block: Range<usize>,
        instance: u32,
        seed: u32,
        params: impl Fn(usize) -> Self::Params,
        mut give: impl FnMut(usize, Stroke),
    ) {
        for (lane, index) in block.enumerate() {
            give(
                lane,
                Self::stroke(joints, index, instance, seed, &params(lane)),
            );
        }
    }

    /// Calls `work` with the parameters. Where strokes switch on a choice, `work` is compiled once for each, which it then knows.
    #[inline(always)]
    fn knowing_stroke(params: &Self::Params, mut work: impl FnMut(&Self::Params)) {
        work(params);
    }

    /// Whether a stroke's own `depth_offset` may be below 0; that it never is, is told from the WGSL where only written numbers are
    /// given.
    const MAY_BE_NEARER: bool = true;

    /// What is read of a sample, in the order of the fields of `struct Sample`, by an effect that paints what its strokes show;
    /// nothing where it doesn't.
    const PAINTS: Option<&'static [SampleInput]> = None;

    /// Where sample `index` looks a texture up; nothing where the effect has no `place`.
    fn place(
        samples: &SampleBlock,
        index: usize,
        seed: u32,
        params: &Self::Params,
    ) -> Option<Lookup> {
        let _ = (samples, index, seed, params);
        None
    }

    /// Calls `work` with the parameters. Where [`Self::place`] switches on a choice, `work` is compiled once for each, which it then knows.
    #[inline(always)]
    fn knowing_place(params: &Self::Params, mut work: impl FnMut(&Self::Params)) {
        work(params);
    }

    /// The same for [`Self::paint`].
    #[inline(always)]
    fn knowing_paint(params: &Self::Params, mut work: impl FnMut(&Self::Params)) {
        work(params);
    }

    /// Whether there is a [`Self::place`].
    const PLACES: bool = false;

    /// The linear colour of sample `index`. `texel` is what [`Self::place`] found, linear and with its coverage. Only asked where
    /// [`Self::PAINTS`].
    fn paint(
        samples: &SampleBlock,
        index: usize,
        seed: u32,
        texel: Vec4<f32>,
        params: &Self::Params,
    ) -> Vec3<f32> {
        let _ = (samples, index, seed, texel, params);
        Vec3 {
            x: 0.0,
            y: 0.0,
            z: 0.0,
        }
    }
}
