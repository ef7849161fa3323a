//! Where the links of a batch are in the course of a step.

use crate::lanes::{Lane, Mask, Number, Quat, Vec3};

/// The strands of a batch as a stage of a step has them.
#[derive(Clone, Debug)]
pub(crate) struct Chain {
    /// Particles from the root, and their velocities.
    pub y: Vec<Vec3>,
    pub v: Vec<Vec3>,
    /// Of the links, in world axes; straight strands have tangents alone.
    pub frames: Vec<Quat>,
    /// The third axes of the frames.
    pub tangents: Vec<Vec3>,
}

impl Chain {
    pub(crate) fn new(count: usize) -> Self {
        Self {
            y: vec![Vec3::ZERO; count],
            v: vec![Vec3::ZERO; count],
            frames: vec![Quat::IDENTITY; count],
            tangents: vec![Vec3::ZERO; count],
        }
    }
}

/// The energy of every strand's shape over its mass per length, in m^3/s^2: of bending and twisting, and of weight from the root.
pub(crate) struct ShapeEnergy {
    pub elastic: Lane,
    pub weight: Lane,
}

impl ShapeEnergy {
    pub(crate) const NONE: Self = Self {
        elastic: Lane::ZERO,
        weight: Lane::ZERO,
    };

    pub(crate) fn pick(mask: Mask, yes: Self, no: Self) -> Self {
        Self {
            elastic: mask.pick(yes.elastic, no.elastic),
            weight: mask.pick(yes.weight, no.weight),
        }
    }

    #[inline(always)]
    pub(crate) fn sum(&self) -> Lane {
        self.elastic + self.weight
    }
}

/// The way from the particle at the start of link `k` to that at its end.
#[inline(always)]
pub(crate) fn chord<T: Number>(y: &[Vec3], k: usize) -> Vec3<T> {
    let end = y[k].load();
    if k == 0 { end } else { end - y[k - 1].load() }
}
