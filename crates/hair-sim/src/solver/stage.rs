//! What the stages of a step start from.

use crate::{
    forces::wind::Gusts,
    lanes::{Lane, Number, Quat, Sym3, Vec3},
};

use super::{
    batch::Batch,
    link::{Elastic, Node, Particle},
};

/// Where in a step its middle stage is: 2 - sqrt 2.
pub(crate) const GAMMA: f64 = 0.585_786_437_626_904_9;

/// An implicit step, of which the integrator's are made.
pub(crate) struct Stage<'a> {
    /// In s.
    pub length: Lane,
    /// Time of damping over the stage's own.
    pub damping: Lane,
    /// The frame of the skin.
    pub base: Quat,
    /// Gravity less the acceleration of the root.
    pub pull: Vec3,
    /// The root, its velocity, and the air.
    pub root: Vec3,
    pub velocity: Vec3,
    pub gusts: &'a Gusts<'a>,
    /// Whether it is that in the middle of a step; else the step's end is its own.
    pub is_mid: bool,
}

impl Stage<'_> {
    #[inline(always)]
    pub(crate) fn elastic(&self) -> Elastic {
        Elastic {
            h2: self.length * self.length,
            damping: self.damping,
        }
    }
}

/// What a stage minimises over the shapes of a chain, beside the springs of its links.
pub(crate) struct Model<'a> {
    /// The frame of the skin.
    pub base: &'a Quat,
    /// Of the particles.
    pub nodes: &'a [Node],
    /// The turns of joints that damping holds to.
    pub past: &'a [Vec3],
    pub elastic: Elastic,
}

/// Two lists that are added, each times its own number.
pub(crate) type Sum<'a> = [(&'a [Vec3], Lane); 2];

/// Where particles would be at a stage's end without forces, link by link.
pub(crate) struct FreeMotion<'a> {
    y_of: Sum<'a>,
    v_of: Sum<'a>,
    /// The stage's, in s.
    length: Lane,
    /// What gravity and the root's acceleration move a particle by.
    fall: Vec3,
    particles: &'a [Particle],
    y: &'a mut [Vec3],
    v: &'a mut [Vec3],
    nodes: &'a mut [Node],
}

impl<'a> FreeMotion<'a> {
    /// Of a stage that starts from the positions `y_of` and velocities `v_of`; [`Self::place`] stores them in `y` and `v`, and
    /// mass and weight in `nodes`.
    pub(crate) fn new(
        batch: &'a Batch,
        stage: &Stage,
        (y_of, v_of): (Sum<'a>, Sum<'a>),
        (y, v): (&'a mut [Vec3], &'a mut [Vec3]),
        nodes: &'a mut [Node],
    ) -> Self {
        let count = batch.count();
        let cut = |sum: Sum<'a>| sum.map(|(list, factor)| (&list[..count], factor));
        Self {
            y_of: cut(y_of),
            v_of: cut(v_of),
            length: stage.length,
            fall: stage.pull * (stage.length * stage.length),
            particles: &batch.particles[..count],
            y: &mut y[..count],
            v: &mut v[..count],
            nodes: &mut nodes[..count],
        }
    }

    /// Prepares particle `k`, and returns where its free motion ends.
    #[inline(always)]
    pub(crate) fn place<T: Number>(&mut self, k: usize) -> Vec3<T> {
        let y = sum(&self.y_of, k);
        let v = sum(&self.v_of, k);
        let place = y + v.scale(self.length.load::<T>());
        self.y[k] = y.store();
        self.v[k] = v.store();
        let mass = self.particles[k].mass.load();
        let node = Node {
            n: Sym3::diagonal(mass),
            b: (place + self.fall.load()).scale(mass),
        };
        self.nodes[k] = node.store();
        place
    }
}

#[inline(always)]
fn sum<T: Number>(of: &Sum, k: usize) -> Vec3<T> {
    let [(one, factor), (other, times)] = of;
    one[k].load::<T>().scale(factor.load()) + other[k].load().scale(times.load())
}
