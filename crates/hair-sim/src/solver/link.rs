//! Links and particles: their constants, and what a stage makes of them.

use glam::DVec3;

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

/// What acts on a link between its ends: the same model of a place that lies `back` before its end, as a share of the link.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Lever {
    /// Whether anything does.
    pub on: bool,
    pub node: Node,
    pub back: Lane,
}

impl Lever {
    pub(crate) const NONE: Self = Self {
        on: false,
        node: Node {
            n: Sym3 {
                xx: Lane::ZERO,
                yy: Lane::ZERO,
                zz: Lane::ZERO,
                xy: Lane::ZERO,
                xz: Lane::ZERO,
                yz: Lane::ZERO,
            },
            b: Vec3::ZERO,
        },
        back: Lane::ZERO,
    };

    /// What acts at a share of the link from its start: nothing yet, unless it was taken up before.
    pub(crate) fn take_up(&mut self, share: Lane) -> &mut Node {
        if !self.on {
            *self = Self::NONE;
            self.on = true;
        }
        self.back = Lane::ONE - share;
        &mut self.node
    }

    /// Nothing acts on a strand's link any more.
    pub(crate) fn let_go(&mut self, lane: usize) {
        let n = &mut self.node.n;
        for of_matrix in [
            &mut n.xx, &mut n.yy, &mut n.zz, &mut n.xy, &mut n.xz, &mut n.yz,
        ] {
            of_matrix[lane] = 0.0;
        }
        self.node.b.set(lane, DVec3::ZERO);
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
