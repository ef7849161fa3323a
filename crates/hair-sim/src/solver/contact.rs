//! Contact of particles with bodies: once a step, the path of every particle against every body gives at most one
//! plane, behind which the particle is held in the stages of the step; two of different bodies where any is no part of the figure. Other hair
//! gives it one more: see [`super::locks`].
//!
//! Its parts, of which each imports those above it alone: `path`, the way of a place; `link`, what lies between two particles; `guard`, what is near a
//! body at all; `find`, which particles have a plane; `keep_out`, what is in a body all the same.

pub(crate) mod find;
pub(crate) mod guard;
pub(crate) mod keep_out;
mod link;
mod path;

use glam::DVec3;

use crate::lanes::{Lane, Mask, Sym3, Vec3};

use super::{
    batch::{Batch, BatchState, CREEP},
    link::Node,
};

/// The time in s in which a contact settles. At steps above it contact is as good as rigid.
const SETTLE: f64 = 2e-4;

/// The speed in m/s at which a strand that is found inside a body is pushed out, and that where hair may be pressed between two, unless the body is faster: what is
/// pressed against a head or shoulders has no room to go to, and would be thrown.
const PUSH_OUT: f64 = 3.0;
const WEDGED_OUT: f64 = 0.3;

/// Where friction holds a particle, that speed becomes so much less in every step, and this at the least: what sticks creeps a finite way,
/// about one step's at [`CREEP`], and comes to rest.
const STICKS: f64 = 0.25;
const LEAST_CREEP: f64 = 1e-8;

/// Bodies nearer than this, in m, are prepared for, whether or not the free motion meets them.
const NEAR: f64 = 2e-3;

/// A particle closer to the surface than this, in m, touches it, and one that a stage's answer leaves behind a plane by less waits
/// for the next step, which starts with the plane: half the radius of a hair.
const TOUCH: f64 = 2e-5;

/// Where hair may be pressed between two bodies, a particle that one pushes out by more than this in a step, in m, leaves it no faster than it did before. A stage that puts it elsewhere says
/// that it goes on there, more than twice as fast as it took to get there: from one to the other it would be thrown twice as fast each time.
const PUSHED: f64 = 8e-3;

/// What has a plane before it, of a body or of other hair, leaves that no faster than this, in m/s, or than it did before: a stage that stops what comes fast turns its speed about. Between an arm and
/// a side a tip bounced twice as fast each time. What is recalled gets over a shoulder by as much as the first; locks that jam shake each other the less, the less the second is.
const OFF_BODIES: f64 = 2.0;
const OFF_HAIR: f64 = 1.75;

/// Hair that is beside a figure is pushed towards it by no more than this in a step, in m, where another body comes: pushed all the way at once it trembles more under that.
const REACHED: f64 = 5e-3;

/// The pressure of the last step foretells that a particle is held which is no farther than this, in m, from its plane without it. What jams between two bodies is
/// pressed by thousands of m/s^2, and by the next step the plane may be that of another place: held there, a lock was drawn to it by decimetres at once.
pub(super) const REBOUND: f64 = 5e-3;

/// A plane that holds a particle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Contact {
    /// 1 for strands that have the plane here, else 0.
    pub on: Lane,
    /// 1 where it holds, in the stage at hand.
    pub holds: Lane,
    /// The particle y is kept at normal . y >= mid, end, from the root.
    pub normal: Vec3,
    pub mid: Lane,
    pub end: Lane,
    /// The surface's velocity from the root, in m/s.
    pub flow: Vec3,
    /// Coulomb's coefficient, the rate of friction in 1/s, and the speed in m/s below which it is viscous.
    pub friction: Lane,
    pub slip: Lane,
    pub creep: Lane,
    /// The pressure of the last step in m/s^2, and that which friction is known to be bound by: nothing where the last step was a blow.
    pub press: Lane,
    pub bound: Lane,
    /// How fast the particle may leave the plane after the step, in m/s.
    pub leaves: Lane,
}

impl Contact {
    pub(crate) const NONE: Self = Self {
        on: Lane::ZERO,
        holds: Lane::ZERO,
        normal: Vec3::ZERO,
        mid: Lane::ZERO,
        end: Lane::ZERO,
        flow: Vec3::ZERO,
        friction: Lane::ZERO,
        slip: Lane::ZERO,
        creep: Lane::ZERO,
        press: Lane::ZERO,
        bound: Lane::ZERO,
        leaves: Lane::ZERO,
    };

    /// As where no strand has a plane.
    pub(crate) fn clear(&mut self) {
        (self.on, self.holds) = (Lane::ZERO, Lane::ZERO);
    }

    /// Puts a plane before particle `k` of a strand; what the state knows of it is at `slot`.
    pub(crate) fn set(
        &mut self,
        lane: usize,
        surface: &Surface,
        (batch, state): (&Batch, &BatchState),
        (slot, k): (usize, usize),
    ) {
        let (normal, flow) = (surface.normal, surface.flow);
        let (press, creep) = (state.press[slot][lane], state.creep[slot][lane]);
        self.on[lane] = 1.0;
        self.press[lane] = press;
        self.normal.set(lane, normal);
        self.mid[lane] = surface.mid;
        self.end[lane] = surface.end;
        self.flow.set(lane, flow);
        let velocity = state.v[k].get(lane) - flow;
        let out = velocity.dot(normal);
        let is_pushed = surface.start - normal.dot(state.y[k].get(lane)) > PUSHED;
        self.leaves[lane] = out.max(match batch.is_of_body(slot) {
            _ if is_pushed => 0.0,
            true => OFF_BODIES,
            false => OFF_HAIR,
        });
        let sliding = (velocity - normal * out).length();
        let bound = if creep > 0.0 { press } else { 0.0 };
        let sticks = bound > 0.0 && sliding <= creep;
        let (creep, speed) = if sticks {
            let creep = (STICKS * creep).max(LEAST_CREEP);
            (creep, creep)
        } else {
            (CREEP, sliding.max(CREEP))
        };
        self.bound[lane] = bound;
        self.creep[lane] = creep;
        self.friction[lane] = batch.friction[lane];
        self.slip[lane] = self.friction[lane] * bound / speed;
    }

    /// Leaves so much of its friction.
    pub(crate) fn loosen(&mut self, grip: Lane) {
        self.friction = self.friction * grip;
        self.slip = self.slip * grip;
    }

    /// Where a particle at `y` is behind the plane at `level` and was not held, in the strands that have the plane: or is expected to be, no farther than `most`, in m,
    /// before it.
    #[inline(always)]
    pub(crate) fn is_due(&self, why: Due, y: Vec3, level: Lane, most: f64) -> Mask {
        let level = match why {
            Due::Expected(d) if most.is_infinite() => level + self.press * d * d,
            Due::Expected(d) => level + (self.press * d * d).min(Lane::splat(most)),
            Due::Passed => level - Lane::splat(TOUCH),
        };
        let half = Lane::splat(0.5);
        (self.on.gt(half))
            .and(self.holds.lt(half))
            .and(self.normal.dot(y).lt(level))
    }

    /// Adds the plane's force in the lanes of `mask` to a particle of `mass` in a stage of length `d`.
    #[inline(always)]
    pub(crate) fn hold(
        &mut self,
        node: &mut Node,
        mask: Mask,
        mass: Lane,
        level: Lane,
        d: Lane,
        free_y: Vec3,
    ) {
        let here = mask.pick(mass, Lane::ZERO);
        let spring = here * d * d * (1.0 / (SETTLE * SETTLE));
        let damper = here * d * (1.0 / SETTLE);
        let slide = here * d * self.slip;
        let n = Sym3::outer(slide, self.normal, spring + damper - slide);
        let carried = free_y + self.flow * d;
        let out = self.normal * (spring * level + (damper - slide) * self.normal.dot(carried));
        node.n += n;
        node.b += out + carried * slide;
        self.holds = mask.pick(Lane::ONE, self.holds);
    }

    /// By how much a particle that has this velocity leaves the plane faster than it may, in m/s.
    #[inline(always)]
    pub(crate) fn too_fast(&self, velocity: Vec3) -> Lane {
        let out = self.normal.dot(velocity - self.flow);
        (out - self.leaves).max(Lane::ZERO) * self.on
    }

    /// The pressure on a particle at `y` at the end of a step, in m/s^2.
    #[inline(always)]
    pub(crate) fn pressure(&self, y: Vec3) -> Lane {
        self.pressure_at(self.end, y)
    }

    /// The same of a stage in which the plane is at `level`.
    #[inline(always)]
    fn pressure_at(&self, level: Lane, y: Vec3) -> Lane {
        let depth = (level - self.normal.dot(y)).max(Lane::ZERO);
        depth * self.holds * (1.0 / (SETTLE * SETTLE))
    }

    /// Forgets what held, and friction whose bound is not known: every stage finds its own.
    #[inline(always)]
    pub(crate) fn forget(&mut self) {
        self.holds = Lane::ZERO;
        self.slip = (self.bound.gt(Lane::ZERO)).pick(self.slip, Lane::ZERO);
    }

    /// Adds friction whose bound is not known to a particle that is held, in the strands of `among`, by the pressure of a stage's
    /// answer `y`. Returns the strands where it does.
    #[inline(always)]
    pub(crate) fn rub(
        &mut self,
        node: &mut Node,
        mass: Lane,
        (level, d): (Lane, Lane),
        (y, free_y): (Vec3, Vec3),
        among: Mask,
    ) -> Mask {
        let press = self.pressure_at(level, y);
        let here = (press * self.friction).gt(Lane::ZERO).and(among);
        let new = (here.and(self.bound.gt(Lane::ZERO).not())).and(self.slip.gt(Lane::ZERO).not());
        if !new.any() {
            return new;
        }
        let carried = free_y + self.flow * d;
        let way = y - carried;
        let way = way - self.normal * self.normal.dot(way);
        let speed = (way.length_squared().sqrt() / d).max(Lane::splat(CREEP));
        let slip = new.pick(self.friction * press / speed, Lane::ZERO);
        self.slip += slip;
        let slide = mass * d * slip;
        node.n += Sym3::outer(slide, self.normal, Lane::ZERO - slide);
        node.b += (carried - self.normal * self.normal.dot(carried)) * slide;
        new
    }
}

/// What a particle can't pass in a step: its normal, how far along it the surface is from the root at the start, at the middle stage and at the end, in m,
/// and its velocity from the root, in m/s.
pub(crate) struct Surface {
    pub normal: DVec3,
    pub start: f64,
    pub mid: f64,
    pub end: f64,
    pub flow: DVec3,
}

impl Surface {
    /// Leaves a particle that is at `y` from the root as much room as another that is against it needs: where there is none, as under an arm that lies on a back, hair
    /// goes into this body, and not into the other, or off to their sides.
    pub(crate) fn give_way(&mut self, other: &Self, y: DVec3) {
        let against = -self.normal.dot(other.normal);
        if against <= 0.0 {
            return;
        }
        for (own, other_level) in [(&mut self.mid, other.mid), (&mut self.end, other.end)] {
            let out = (other_level - other.normal.dot(y)).max(-REACHED);
            let lack = *own - self.normal.dot(y + other.normal * out);
            *own -= against * against * lack.max(0.0);
        }
    }
}

/// When a plane begins to hold a particle.
#[derive(Clone, Copy)]
pub(crate) enum Due {
    /// In a stage of this length in s that had better start with the plane: without the pressure of the last step, the predicted
    /// particle would be behind it (the primal-dual active set of Hintermüller et al. 2003).
    Expected(Lane),
    /// A stage's answer is behind the plane.
    Passed,
}

#[cfg(test)]
mod tests {
    use super::*;

    fn surface(normal: DVec3, level: f64) -> Surface {
        Surface {
            normal,
            start: level,
            mid: level,
            end: level,
            flow: DVec3::ZERO,
        }
    }

    /// An arm's underside against a back at 0 mm, and what is left of it: as it was where there is room, at the back where there is none, and on the way there no farther than hair is
    /// pushed in a step.
    #[test]
    fn an_arm_leaves_hair_the_room_that_a_back_needs() {
        let back = surface(DVec3::Z, 0.0);
        let left = |underside: f64, y: f64, normal: DVec3| {
            let mut arm = surface(normal, -underside);
            arm.give_way(&back, DVec3::Z * y);
            assert_eq!(arm.mid, arm.end);
            -arm.end
        };
        for (underside, y, expected) in [
            (0.02, 0.005, 0.02),
            (0.002, 0.005, 0.002),
            (-0.003, 0.001, 0.0),
            (0.002, 0.015, 0.01),
            // In the back already: out of that first.
            (-0.003, -0.004, 0.0),
        ] {
            let left = left(underside, y, DVec3::NEG_Z);
            assert!((left - expected).abs() < 1e-12, "{left} for {expected}");
        }
        // At its side hair gets out.
        for normal in [DVec3::X, DVec3::Z] {
            assert_eq!(left(-0.003, 0.001, normal), -0.003);
        }
    }
}
