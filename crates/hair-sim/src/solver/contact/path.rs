//! The way of a place through the world in a step, and the plane of a body that it meets.

use glam::DVec3;

use crate::collision::shape::{Collider, Shape};

use super::{NEAR, TOUCH};

/// The speed in m/s at which a particle that is nearer to a body than it keeps for its links' sake is pushed out. What a link needs grows as fast as the link
/// turns: pushed fast, a strand that swings against a ball was thrown back as far as it came, for ever. Slower still its links would be in the body for long.
const LIFT_OUT: f64 = 1e-3;

/// A particle's way through the world in a step of `dt` seconds, on which it keeps `keep` metres from bodies.
#[derive(Clone, Copy)]
pub(super) struct Path {
    pub from: DVec3,
    pub to: DVec3,
    pub keep: f64,
    /// How fast it is pushed out of a body that it is in, in m/s.
    pub push_out: f64,
    /// How much of what it keeps is for the sake of its links, in m.
    pub lift: f64,
    /// How much farther out of a body than the root of its strand it may have to be, in m: [`LEADS_OUT`](crate::LEADS_OUT) of the hair
    /// between them.
    pub leads_out: f64,
    /// The way out of a body that it begins in, in the body's space; nothing where that is the shortest.
    pub way_out: Option<DVec3>,
    pub dt: f64,
}

/// A plane in a body's space.
pub(super) struct Plane {
    pub at: DVec3,
    pub normal: DVec3,
    /// How far the path's end is behind it.
    pub depth: f64,
}

impl Path {
    /// The same against a body in which the strand's root is so deep: its distance from the surface in m, less than 0.
    #[inline(always)]
    pub(super) fn led_out(self, root: f64) -> Self {
        Self {
            keep: self.keep.min(root + self.leads_out),
            ..self
        }
    }

    /// The body whose plane the path's end is deepest behind.
    pub(super) fn first<'a, 'b>(
        &self,
        colliders: &'b [Collider<'a>],
    ) -> Option<(&'b Collider<'a>, Plane)> {
        let mut best: Option<(&Collider, Plane)> = None;
        for collider in colliders {
            let Some(plane) = self.met(collider) else {
                continue;
            };
            if best.as_ref().is_none_or(|(_, b)| plane.depth > b.depth) {
                best = Some((collider, plane));
            }
        }
        best
    }

    /// The plane of a body that the path meets, or comes near, within reach.
    #[inline(always)]
    pub(super) fn against(&self, collider: &Collider) -> Option<Plane> {
        Some(self.within_reach(self.met(collider)?, collider))
    }

    /// The plane, but no farther in front of where the path begins than it is pushed out. A plane goes on beyond its body: what began behind it is beside the body or
    /// past it, and would be fetched from there at once.
    pub(super) fn within_reach(&self, plane: Plane, collider: &Collider) -> Plane {
        let from = collider.before.to_local(self.from);
        let behind = (plane.at - from).dot(plane.normal);
        let comes = self.push_out * self.dt + collider.grown(from).max(0.0);
        let back = (behind - comes).max(0.0);
        Plane {
            at: plane.at - plane.normal * back,
            depth: plane.depth - back,
            ..plane
        }
    }

    /// The plane that it meets, or comes near, wherever it begins.
    #[inline(always)]
    pub(super) fn met(&self, collider: &Collider) -> Option<Plane> {
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
            let first = self.way_out.unwrap_or_else(|| was.normal(from));
            let (place, end) = self.slide(shape, (from, first), (to, end));
            let last = self.surface(shape, place, end);
            let (at, normal) = if first.dot(last.1) > 0.5 {
                last
            } else {
                (from - first * (start - collider.grown(from)), first)
            };
            let own = start + self.lift;
            let pushed = (own + self.push_out * self.dt).min(0.0) - self.lift;
            let lifted = (start + LIFT_OUT * self.dt).min(0.0);
            let level = pushed.max(lifted);
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

    /// Where what touches a body at `from` goes when it is held there, and its distance: `to` as far as it doesn't go in. Deep in a body that is known by a
    /// grid its distances say little of the surface there: what rests would be held now by one plane, now by another, and never come to rest.
    fn slide(
        &self,
        shape: &Shape,
        (from, normal): (DVec3, DVec3),
        (to, end): (DVec3, f64),
    ) -> (DVec3, f64) {
        let out = normal.dot(to - from);
        if out >= 0.0 || !shape.is_sampled() {
            return (to, end);
        }
        let place = to - normal * out;
        (place, shape.distance(place) - self.keep)
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
