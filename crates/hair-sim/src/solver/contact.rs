//! Contact of particles with bodies: once a step, the path of every particle against every body gives at most one
//! plane, behind which the particle is held in the stages of the step. Other hair gives it one more: see [`super::locks`].

use glam::{DMat3, DVec3};

use crate::{
    collision::shape::{Collider, Shape},
    lanes::{LANES, Lane, Mask, Number, Sym3, Vec3},
};

use super::{
    batch::{Batch, BatchState, CREEP},
    link::Node,
    stage::GAMMA,
};

/// The time in s in which a contact settles. At steps above it contact is as good as rigid.
const SETTLE: f64 = 2e-4;

/// The speed in m/s at which a strand that is found inside a body is pushed out.
const PUSH_OUT: f64 = 3.0;

/// Where friction holds a particle, that speed becomes so much less in every step, and this at the least: what sticks creeps a finite way,
/// about one step's at [`CREEP`], and comes to rest.
const STICKS: f64 = 0.25;
const LEAST_CREEP: f64 = 1e-8;

/// Bodies nearer than this, in m, are prepared for, whether or not the free motion meets them.
const NEAR: f64 = 2e-3;

/// A particle closer to the surface than this, in m, touches it, and one that a stage's answer leaves behind a plane by less waits
/// for the next step, which starts with the plane: half the radius of a hair.
const TOUCH: f64 = 2e-5;

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
    /// Rate of friction in 1/s, and the speed in m/s below which it is viscous.
    pub slip: Lane,
    pub creep: Lane,
    /// The pressure of the last step in m/s^2, and that which friction is known to be bound by: nothing where the last step was a blow.
    pub press: Lane,
    pub bound: Lane,
}

impl Contact {
    pub(crate) const NONE: Self = Self {
        on: Lane::ZERO,
        holds: Lane::ZERO,
        normal: Vec3::ZERO,
        mid: Lane::ZERO,
        end: Lane::ZERO,
        flow: Vec3::ZERO,
        slip: Lane::ZERO,
        creep: Lane::ZERO,
        press: Lane::ZERO,
        bound: Lane::ZERO,
    };

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
        let sliding = (velocity - normal * velocity.dot(normal)).length();
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
        self.slip[lane] = batch.friction[lane] * bound / speed;
    }

    /// Where a particle at `y` is behind the plane at `level` and was not held, in the strands that have the plane.
    #[inline(always)]
    pub(crate) fn is_due(&self, why: Due, y: Vec3, level: Lane) -> Mask {
        let level = match why {
            Due::Expected(d) => level + self.press * d * d,
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
        (friction, mass): (Lane, Lane),
        (level, d): (Lane, Lane),
        (y, free_y): (Vec3, Vec3),
        among: Mask,
    ) -> Mask {
        let press = self.pressure_at(level, y);
        let here = (press * friction).gt(Lane::ZERO).and(among);
        let new = (here.and(self.bound.gt(Lane::ZERO).not())).and(self.slip.gt(Lane::ZERO).not());
        if !new.any() {
            return new;
        }
        let carried = free_y + self.flow * d;
        let way = y - carried;
        let way = way - self.normal * self.normal.dot(way);
        let speed = (way.length_squared().sqrt() / d).max(Lane::splat(CREEP));
        let slip = new.pick(friction * press / speed, Lane::ZERO);
        self.slip += slip;
        let slide = mass * d * slip;
        node.n += Sym3::outer(slide, self.normal, Lane::ZERO - slide);
        node.b += (carried - self.normal * self.normal.dot(carried)) * slide;
        new
    }
}

/// What a particle can't pass in a step: its normal, how far along it the surface is from the root at the middle stage and at the end, in m,
/// and its velocity from the root, in m/s.
pub(crate) struct Surface {
    pub normal: DVec3,
    pub mid: f64,
    pub end: f64,
    pub flow: DVec3,
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

/// A ball around a body, and how the body moves in a step: what lies far off is known by this alone.
#[derive(Clone, Debug)]
pub(crate) struct Guard {
    center: DVec3,
    radius: f64,
    /// From where something was, as the body carries it along: `carry` times the place, and `shift`.
    carry: DMat3,
    shift: DVec3,
}

impl Guard {
    pub(crate) fn new(collider: &Collider) -> Self {
        let (center, radius) = collider.shape.ball();
        let (before, now) = (collider.before, collider.now);
        let carry = DMat3::from_quat(now.rotation) * DMat3::from_quat(before.rotation).transpose();
        Self {
            center: now.to_world(center),
            radius,
            carry,
            shift: now.translation - carry * before.translation,
        }
    }

    /// Whether particles that go from `from` to `to` and keep `keep` may come near the body. A little more than
    /// [`Path::against`] asks for, which has the last word.
    #[inline(always)]
    fn is_near<T: Number>(&self, from: Vec3<T>, to: Vec3<T>, keep: T) -> Mask {
        const MARGIN: f64 = 1e-6;
        let carried = Vec3::all(self.shift)
            + Vec3::all(self.carry.x_axis).scale(from.x)
            + Vec3::all(self.carry.y_axis).scale(from.y)
            + Vec3::all(self.carry.z_axis).scale(from.z);
        let way = (to - carried).length_squared().sqrt();
        let reach = way + keep + T::splat(self.radius + NEAR + MARGIN);
        let apart = (to - Vec3::all(self.center)).length_squared().sqrt();
        let (apart, reach) = (apart.store(), reach.store());
        // NaN is near.
        reach.lt(apart).not()
    }
}

/// The depth at which every particle of a strand may stay: that of the style, where it starts inside a body.
pub(crate) fn settle_in(batch: &Batch, state: &mut BatchState, colliders: &[Collider]) {
    for k in 0..batch.count() {
        for lane in 0..LANES {
            let at = state.root.get(lane) + state.y[k].get(lane);
            let depth = colliders
                .iter()
                .map(|c| c.at_start().distance(c.before.to_local(at)) - batch.thickness[lane])
                .fold(0.0, f64::min);
            state.skin[k][lane] = depth;
        }
    }
}

/// Finds the planes of a step of `dt` seconds, at whose end the roots are at `root`. Returns the number of particles that have one;
/// their places on the strands are added to `touched`.
pub(crate) fn detect<T: Number>(
    batch: &Batch,
    state: &BatchState,
    (colliders, guards): (&[Collider], &[Guard]),
    (root, dt): (Vec3, f64),
    active: Mask,
    contacts: &mut [Contact],
    touched: &mut Vec<usize>,
) -> usize {
    T::run(
        #[inline(always)]
        move || {
            let mut count = 0;
            // What is unknown was a blow, which is over.
            let known = T::condition(&Mask::new(state.restart).not());
            for k in 0..batch.count() {
                let contact = &mut contacts[k];
                contact.on = Lane::ZERO;
                contact.holds = Lane::ZERO;
                let y0 = state.y[k].load::<T>();
                let a = Vec3::choose(known, state.a[k].load(), Vec3::zero());
                let y1 = y0 + state.v[k].load() * dt + a * (0.5 * dt * dt);
                let (p0, p1) = (state.root.load() + y0, root.load() + y1);
                let keep = batch.thickness.load::<T>() + state.skin[k].load();
                let mut near = Mask::NONE;
                for guard in guards {
                    near = near.or(guard.is_near(p0, p1, keep));
                }
                let near = near.and(active);
                if !near.any() {
                    continue;
                }
                let (p0, p1, keep) = (p0.store(), p1.store(), keep.store());
                for lane in 0..LANES {
                    if !near.get(lane) || k >= batch.counts[lane] {
                        continue;
                    }
                    let path = Path {
                        from: p0.get(lane),
                        to: p1.get(lane),
                        keep: keep[lane],
                        dt,
                    };
                    let Some((collider, plane)) = path.first(colliders) else {
                        continue;
                    };
                    count += 1;
                    if touched.last() != Some(&k) {
                        touched.push(k);
                    }
                    let (before, now) = (collider.before, collider.now);
                    let normal = now.rotation * plane.normal;
                    let s0 = before.to_world(plane.at - plane.normal * collider.grown(plane.at));
                    let s1 = now.to_world(plane.at);
                    let (s0, s1) = (s0 - state.root.get(lane), s1 - root.get(lane));
                    let surface = Surface {
                        normal,
                        mid: normal.dot(s0 + (s1 - s0) * GAMMA),
                        end: normal.dot(s1),
                        flow: (s1 - s0) / dt,
                    };
                    contact.set(lane, &surface, (batch, state), (k, k));
                }
            }
            count
        },
    )
}

/// A particle's way through the world in a step.
struct Path {
    from: DVec3,
    to: DVec3,
    keep: f64,
    dt: f64,
}

/// A plane in a body's space.
struct Plane {
    at: DVec3,
    normal: DVec3,
    /// How far the path's end is behind it.
    depth: f64,
}

impl Path {
    /// The body whose plane the path's end is deepest behind.
    fn first<'a, 'b>(&self, colliders: &'b [Collider<'a>]) -> Option<(&'b Collider<'a>, Plane)> {
        let mut best: Option<(&Collider, Plane)> = None;
        for collider in colliders {
            let Some(plane) = self.against(collider) else {
                continue;
            };
            if best.as_ref().is_none_or(|(_, b)| plane.depth > b.depth) {
                best = Some((collider, plane));
            }
        }
        best
    }

    fn against(&self, collider: &Collider) -> Option<Plane> {
        let (shape, was) = (&collider.shape, collider.at_start());
        let to = collider.now.to_local(self.to);
        let end = shape.distance(to) - self.keep;
        let moves = collider.before != collider.now;
        let way = if moves {
            (to - collider.before.to_local(self.from)).length()
        } else {
            (self.to - self.from).length()
        };
        // The whole path is within `way` of its end.
        if end > way + NEAR {
            return None;
        }
        let from = collider.before.to_local(self.from);
        let start = was.distance(from) - self.keep;
        if start <= TOUCH {
            // It touches already. The surface near the end, where that is the same side.
            let (first, last) = (was.normal(from), self.surface(shape, to, end));
            let (at, normal) = if first.dot(last.1) > 0.5 {
                last
            } else {
                (from - first * (start - collider.grown(from)), first)
            };
            let level = (start + PUSH_OUT * self.dt).min(0.0);
            return Some(self.plane(at + normal * level, normal, to));
        }
        // What the surface comes nearer by itself, where the shape changes.
        let grows = collider.grown(from).abs().max(collider.grown(to).abs());
        let way = way + grows;
        // Along the path by steps that cannot pass the surface (Hart 1996, sphere tracing).
        let (mut t, mut distance) = (0.0, start);
        for _ in 0..64 {
            // Too short a way to the end for both ends to reach the surface on it.
            if distance + end > (1.0 - t) * way + 2.0 * TOUCH {
                break;
            }
            t += distance.max(TOUCH) / way;
            if t >= 1.0 {
                break;
            }
            let at = from + (to - from) * t;
            let at_end = shape.distance(at) - self.keep;
            distance = at_end + collider.grown(at) * (1.0 - t);
            if distance <= TOUCH {
                let normal = shape.normal(at);
                return Some(self.plane(at - normal * at_end, normal, to));
            }
        }
        // Not met by the free motion: what the strand does may still bring it there.
        let (at, normal) = self.surface(shape, to, end);
        Some(self.plane(at, normal, to))
    }

    /// The surface nearest to a place at this distance from it: a point of it, and its normal there.
    fn surface(&self, shape: &Shape, place: DVec3, distance: f64) -> (DVec3, DVec3) {
        let normal = shape.normal(place);
        let at = place - normal * distance;
        // The distances of a grid are not exact, and its normals jump from cell to cell: what rests would be held now by one plane, now by
        // another, would they hang on where its motion points to.
        if !shape.is_sampled() {
            return (at, normal);
        }
        let there = shape.normal(at);
        if distance.abs() > NEAR || there.dot(normal) < 0.9 {
            return (at, normal);
        }
        (at - there * (shape.distance(at) - self.keep), there)
    }

    fn plane(&self, at: DVec3, normal: DVec3, end: DVec3) -> Plane {
        Plane {
            at,
            normal,
            depth: (at - end).dot(normal),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pose::Pose;
    use glam::DQuat;

    #[test]
    fn a_ball_around_a_body_hides_nothing_that_the_body_meets() {
        let shape = Shape::Capsule {
            from: DVec3::new(-0.1, 0.0, 0.05),
            to: DVec3::new(0.2, 0.1, 0.0),
            radius: 0.05,
        };
        let collider = Collider {
            shape,
            before: Pose {
                rotation: DQuat::from_rotation_x(0.4),
                translation: DVec3::new(0.0, 0.3, 0.0),
            },
            now: Pose {
                rotation: DQuat::from_rotation_y(1.1),
                translation: DVec3::new(0.02, 0.25, 0.01),
            },
            was: None,
        };
        let guard = Guard::new(&collider);
        let (mut met, mut hidden) = (0, 0);
        for i in 0..20_000 {
            let spread = |k: i32| f64::from((i * 7919 + k * 104_729) % 1009) / 1009.0 - 0.5;
            let from = DVec3::new(spread(1), spread(2) + 0.3, spread(3));
            let to = from + DVec3::new(spread(4), spread(5), spread(6)) * 0.05;
            let path = Path {
                from,
                to,
                keep: 1e-3,
                dt: 0.01,
            };
            let keep = Lane::splat(path.keep);
            let near = guard.is_near(Vec3::splat(from), Vec3::splat(to), keep);
            let meets = path.against(&collider).is_some();
            assert!(near.get(0) || !meets, "{from} {to}");
            met += usize::from(meets);
            hidden += usize::from(!near.get(0));
        }
        assert!(met > 1000 && hidden > 1000, "{met} {hidden}");
    }
}
