//! A program's parameters, of which some vary along a strand and from strand to strand.

use crate::joints::{Input, InputSet, Joints, LANES, block};
use crate::param::{Param, ParamKind, Value, Values};
use crate::program::Parameters;
use crate::seed::layer_seed;
use crate::source::{self, ProgramSource};
use crate::variation::Varying;
use crate::wgsl::hash;
use std::ops::Range;

/// The parameters `P` of one layer, or of the clump, of which some may vary.
#[derive(Clone, Debug)]
pub struct Varied<P: Parameters> {
    base: P::Params,
    varying: Vec<Varying>,
    /// Where any varies, what all are where nothing does.
    numbers: Vec<f32>,
    /// For a graphics card: [`ProgramSource::words`] and [`ProgramSource::varying`].
    words: Vec<u32>,
    indices: Vec<usize>,
}

impl<P: Parameters> Varied<P> {
    /// The parameters of these values.
    #[must_use]
    pub fn new(values: &Values) -> Self {
        let varying = P::PARAMS.iter().enumerate().filter_map(|(index, param)| {
            let (Value::Varying(variation), ParamKind::Number { min, max, .. }) =
                (values.value(param.name), param.kind)
            else {
                return None;
            };
            Some(Varying {
                index,
                seed: layer_seed(0, param.name),
                range: [min, max],
                variation: variation.clone(),
            })
        });
        let varying: Vec<Varying> = varying.collect();
        Self {
            base: P::params(values),
            words: source::words(P::PARAMS, values, &varying),
            numbers: match varying.is_empty() {
                true => Vec::new(),
                false => P::PARAMS
                    .iter()
                    .map(|param| number(param, values))
                    .collect(),
            },
            indices: varying.iter().map(|v| v.index).collect(),
            varying,
        }
    }

    /// The program for a graphics card.
    #[must_use]
    pub fn source(&self) -> ProgramSource<'_> {
        ProgramSource {
            wgsl: P::WGSL,
            inputs: P::INPUTS,
            params: P::PARAMS,
            words: &self.words,
            varying: &self.indices,
            paint: None,
        }
    }

    /// The parameters where nothing varies; what varies has its value at the root.
    #[must_use]
    pub fn base(&self) -> &P::Params {
        &self.base
    }

    /// The parameters where all that varies is as large as it gets.
    #[must_use]
    pub fn greatest(&self) -> P::Params {
        let mut params = self.base.clone();
        for varying in &self.varying {
            P::set_number(&mut params, varying.index, varying.greatest());
        }
        params
    }

    /// Whether any parameter varies.
    #[must_use]
    pub fn varies(&self) -> bool {
        !self.varying.is_empty()
    }

    /// What is read of a joint, also to know how parameters vary.
    #[must_use]
    pub fn inputs(&self) -> InputSet {
        let own = InputSet::of(P::INPUTS);
        if self.varying.is_empty() {
            own
        } else {
            own.union(InputSet::of(&[Input::U, Input::Seed]))
        }
    }

    /// Calls `evaluate` with the parameters of each of these joints. `seed` is the layer's. Costs
    /// nothing where nothing varies.
    #[inline]
    pub fn for_each(
        &self,
        joints: &Joints,
        range: Range<usize>,
        seed: u32,
        mut evaluate: impl FnMut(usize, &P::Params),
    ) {
        if self.varying.is_empty() {
            return range.for_each(|i| evaluate(i, &self.base));
        }
        let mut params = self.base.clone();
        for i in range {
            let (u, strand) = (joints.u[i], hash(seed ^ joints.seed[i]));
            for varying in &self.varying {
                P::set_number(&mut params, varying.index, varying.at(u, strand));
            }
            evaluate(i, &params);
        }
    }

    /// The numbers of a block of joints or samples where nothing varies: [`Parameters::with_numbers`].
    #[inline]
    pub(crate) fn numbers<const N: usize>(&self) -> Vec<[f32; N]> {
        self.numbers.iter().map(|number| [*number; N]).collect()
    }

    /// Sets those that vary of the block from joint `first` on. `seed` is the layer's.
    #[inline(always)]
    pub(crate) fn fill(
        &self,
        numbers: &mut [[f32; LANES]],
        joints: &Joints,
        first: usize,
        seed: u32,
    ) {
        let (u, strand) = (block(&joints.u, first), block(&joints.seed, first));
        self.fill_at(numbers, &u, strand, seed);
    }

    /// The same at places along strands, of these parts of their seeds.
    #[inline(always)]
    pub(crate) fn fill_at<const N: usize>(
        &self,
        numbers: &mut [[f32; N]],
        u: &[f32; N],
        mut strand: [u32; N],
        seed: u32,
    ) {
        for strand in &mut strand {
            *strand = hash(seed ^ *strand);
        }
        for varying in &self.varying {
            numbers[varying.index] = varying.at_all(u, &strand);
        }
    }
}

/// What a parameter is where it doesn't vary, if it is a number.
fn number(param: &Param, values: &Values) -> f32 {
    match param.kind {
        ParamKind::Number { .. } => values.number(param.name),
        _ => 0.0,
    }
}
