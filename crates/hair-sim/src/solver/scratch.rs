//! What a step works with.

use crate::lanes::Vec3;

use super::{chain::Chain, load::Loads, rods};

/// Lists that a step works with; their content decides nothing.
#[derive(Clone, Debug)]
pub(crate) struct Scratch {
    /// The stage in the middle and the one at the end.
    pub mid: Chain,
    pub end: Chain,
    /// What the safe integrator has come to.
    pub trial: Chain,
    /// The turn of every joint at the start of the step.
    pub turn_start: Vec<Vec3>,
    pub work: Work,
}

/// What a stage works with.
#[derive(Clone, Debug)]
pub(crate) struct Work {
    pub loads: Loads,
    /// The turns of joints that damping holds to.
    pub past: Vec<Vec3>,
    pub newton: rods::Scratch,
}

impl Scratch {
    /// For batches of at most so many links in a row, and planes.
    pub(crate) fn new(count: usize, planes: usize) -> Self {
        Self {
            mid: Chain::new(count),
            end: Chain::new(count),
            trial: Chain::new(count),
            turn_start: vec![Vec3::ZERO; count],
            work: Work {
                loads: Loads::new(count, planes),
                past: vec![Vec3::ZERO; count],
                newton: rods::Scratch::new(count),
            },
        }
    }
}
