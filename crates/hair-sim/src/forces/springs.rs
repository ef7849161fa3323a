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
    /// Sum of damping rates in 1/s, and of rate times velocity at the two stages.
    pub rate: T,
    pub flow_mid: Vec3<T>,
    pub flow_end: Vec3<T>,
}
stored!(Spring {
    stiffness,
    mid,
    end,
    rate,
    flow_mid,
    flow_end
});

impl Spring {
    pub(crate) const NONE: Self = Self {
        stiffness: Lane::ZERO,
        mid: Vec3::ZERO,
        end: Vec3::ZERO,
        rate: Lane::ZERO,
        flow_mid: Vec3::ZERO,
        flow_end: Vec3::ZERO,
    };
}

impl<T: Number> Spring<T> {
    /// Adds a spring to a place that moves from `before` to `now` within `dt` under an even `acceleration`, damped critically.
    #[inline(always)]
    pub(crate) fn pull(
        &mut self,
        stiffness: T,
        before: Vec3<T>,
        now: Vec3<T>,
        acceleration: Vec3<T>,
        gamma: f64,
        dt: f64,
    ) {
        let way = now - before;
        let gain = acceleration * dt;
        let mid = before + way * gamma - gain * (0.5 * gamma * (1.0 - gamma) * dt);
        self.stiffness = self.stiffness + stiffness;
        self.mid += mid.scale(stiffness);
        self.end += now.scale(stiffness);
        let root = stiffness.sqrt();
        let rate = root + root;
        self.rate = self.rate + rate;
        let velocity = way * (1.0 / dt);
        self.flow_mid += (velocity + gain * (gamma - 0.5)).scale(rate);
        self.flow_end += (velocity + gain * 0.5).scale(rate);
    }
}
