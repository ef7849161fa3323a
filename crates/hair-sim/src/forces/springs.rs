//! Springs that hold single particles: goals, and the other hair.

use crate::lanes::{Lane, Number, Vec3, stored};

/// All springs of a particle together, per mass.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Spring<T = Lane> {
    /// Sum of stiffnesses in 1/s^2.
    pub stiffness: T,
    /// Sum of stiffness times place, from the root, at the two stages of the step.
    pub mid: Vec3<T>,
    pub end: Vec3<T>,
    /// Sum of damping rates in 1/s, and of rate times velocity.
    pub rate: T,
    pub flow: Vec3<T>,
}
stored!(Spring {
    stiffness,
    mid,
    end,
    rate,
    flow
});

impl Spring {
    pub(crate) const NONE: Self = Self {
        stiffness: Lane::ZERO,
        mid: Vec3::ZERO,
        end: Vec3::ZERO,
        rate: Lane::ZERO,
        flow: Vec3::ZERO,
    };
}

impl<T: Number> Spring<T> {
    /// Adds a spring to a place that moves evenly from `before` to `now` within `dt`, damped critically.
    #[inline(always)]
    pub(crate) fn pull(
        &mut self,
        stiffness: T,
        before: Vec3<T>,
        now: Vec3<T>,
        gamma: f64,
        dt: f64,
    ) {
        let mid = before + (now - before) * gamma;
        self.stiffness = self.stiffness + stiffness;
        self.mid += mid.scale(stiffness);
        self.end += now.scale(stiffness);
        let root = stiffness.sqrt();
        let rate = root + root;
        self.rate = self.rate + rate;
        self.flow += (now - before).scale(rate * T::splat(1.0 / dt));
    }
}
