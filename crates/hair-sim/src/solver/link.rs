//! Links and particles: their constants, and what a stage makes of them.

use crate::lanes::{Lane, Number, Sym3, Vec3, stored};

/// A link and the joint at its root end: see [`crate::rest::RestLink`].
#[derive(Clone, Copy, Debug)]
pub(crate) struct Link<T = Lane> {
    pub length: T,
    pub bend: T,
    pub twist: T,
    pub natural: Vec3<T>,
    /// 1 for links of strands, 0 for those that only fill the batch.
    pub counts: T,
}
stored!(Link {
    length,
    bend,
    twist,
    natural,
    counts
});

/// The particle at a link's tip end.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Particle<T = Lane> {
    pub mass: T,
    /// In 1/s.
    pub drag: T,
    /// In 1/s^2.
    pub goal: T,
    /// The share of the wind that reaches it.
    pub wind: T,
}
stored!(Particle {
    mass,
    drag,
    goal,
    wind
});

/// The quadratic model of what acts on one particle: its gradient at y is N y - b.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Node<T = Lane> {
    pub n: Sym3<T>,
    pub b: Vec3<T>,
}
stored!(Node { n, b });

impl<T: Number> Node<T> {
    pub(crate) fn zero() -> Self {
        Self {
            n: Sym3::diagonal(T::splat(0.0)),
            b: Vec3::zero(),
        }
    }
}

/// How joints resist in a stage.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Elastic<T = Lane> {
    /// The square of the stage's length in s.
    pub h2: T,
    /// Time of damping over the time from `past` to the stage's end.
    pub damping: T,
}
stored!(Elastic { h2, damping });
