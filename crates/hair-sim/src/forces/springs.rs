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

impl Spring {
    /// Adds a spring to a place that moves from `before` to `now` within `dt` under an even `acceleration`, damped critically.
    #[inline(always)]
    pub(crate) fn pull<T: Number>(
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
        let root = stiffness.sqrt();
        let rate = root + root;
        let velocity = way * (1.0 / dt);
        let flow_mid = velocity + gain * (gamma - 0.5);
        let flow_end = velocity + gain * 0.5;
        self.add(Spring {
            stiffness,
            mid: mid.scale(stiffness),
            end: now.scale(stiffness),
            rate,
            flow_mid: flow_mid.scale(rate),
            flow_end: flow_end.scale(rate),
        });
    }

    #[inline(always)]
    pub(crate) fn add<T: Number>(&mut self, more: Spring<T>) {
        // Number by number: the whole spring does not fit in registers.
        self.stiffness = (self.stiffness.load::<T>() + more.stiffness).store();
        self.rate = (self.rate.load::<T>() + more.rate).store();
        let add = |sum: &mut Vec3, more: Vec3<T>| *sum = (sum.load::<T>() + more).store();
        add(&mut self.mid, more.mid);
        add(&mut self.end, more.end);
        add(&mut self.flow_mid, more.flow_mid);
        add(&mut self.flow_end, more.flow_end);
    }
}
