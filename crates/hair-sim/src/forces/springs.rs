//! Springs that hold single particles: goals, and the other hair.

use crate::lanes::{Lane, Vec3};

/// All springs of a particle together, per mass.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Spring {
    /// Sum of stiffnesses in 1/s^2.
    pub stiffness: Lane,
    /// Sum of stiffness times place, from the root, at the two stages of the step.
    pub mid: Vec3,
    pub end: Vec3,
    /// Sum of damping rates in 1/s, and of rate times velocity.
    pub rate: Lane,
    pub flow: Vec3,
}

impl Spring {
    pub(crate) const NONE: Self = Self {
        stiffness: Lane::ZERO,
        mid: Vec3::ZERO,
        end: Vec3::ZERO,
        rate: Lane::ZERO,
        flow: Vec3::ZERO,
    };

    /// Adds a spring to a place that moves evenly from `before` to `now` within `dt`, damped critically.
    #[inline(always)]
    pub(crate) fn pull(&mut self, stiffness: Lane, before: Vec3, now: Vec3, gamma: f64, dt: f64) {
        let mid = before + (now - before) * gamma;
        self.stiffness += stiffness;
        self.mid += mid * stiffness;
        self.end += now * stiffness;
        let rate = stiffness.sqrt() * 2.0;
        self.rate += rate;
        self.flow += (now - before) * (rate * (1.0 / dt));
    }
}
