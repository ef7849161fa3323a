//! The way of a place of a strand through the world in a step, and the plane of a body that it meets.

use glam::DVec3;

use crate::collision::shape::{Collider, Shape};

use super::{NEAR, OUT_WITHIN, PUSH_OUT, TOUCH};

/// The way through the world in a step of `dt` seconds of what keeps `keep` metres from bodies.
pub(super) struct Path {
    pub from: DVec3,
    pub to: DVec3,
    pub keep: f64,
    pub dt: f64,
    /// Whether it is of a link, which comes out of a body slowly: what is out at once comes with a speed, and bounces.
    pub is_link: bool,
}

/// A plane in a body's space.
pub(super) struct Plane {
    pub at: DVec3,
    pub normal: DVec3,
    /// How far the path's end is behind it.
    pub depth: f64,
}

/// Where a path ends in a body's space, how far from its surface that is, and how long the path is there, in m.
#[derive(Clone, Copy, Debug)]
pub(super) struct End {
    pub at: DVec3,
    pub distance: f64,
    pub way: f64,
}

impl End {
    pub(super) fn new(collider: &Collider, from: DVec3, to: DVec3) -> Self {
        let at = collider.now.to_local(to);
        let way = if collider.moves() {
            let from = collider.before.to_local(from);
            let change = (collider.shape.change(at).abs()).max(collider.shape.change(from).abs());
            (at - from).length() + change
        } else {
            (to - from).length()
        };
        Self {
            at,
            distance: collider.shape.distance(at),
            way,
        }
    }
}

impl Path {
    /// The plane before a path with this end.
    pub(super) fn against(&self, collider: &Collider, end: &End) -> Option<Plane> {
        let shape = &collider.shape;
        let (to, way, end) = (end.at, end.way, end.distance - self.keep);
        // The whole path is within `way` of its end.
        if end > way + NEAR {
            return None;
        }
        let from = collider.before.to_local(self.from);
        let start = shape.distance_before(from) - self.keep;
        if start <= TOUCH {
            // It touches already. The surface near the end, where that is the same side.
            let (first, last) = (shape.normal_before(from), self.surface(shape, to, end));
            let (at, normal) = if first.dot(last.1) > 0.5 {
                last
            } else {
                (from - first * (start + shape.change(from)), first)
            };
            let speed = match self.is_link {
                true => (-start / OUT_WITHIN).clamp(0.0, PUSH_OUT),
                false => PUSH_OUT,
            };
            let level = (start + speed * self.dt).min(0.0);
            return Some(self.plane(at + normal * level, normal, to));
        }
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
            distance = shape.distance_at(at, t) - self.keep;
            if distance <= TOUCH {
                let normal = shape.normal(at);
                // Where the surface there is when the step ends.
                let distance = distance + (1.0 - t) * shape.change(at);
                return Some(self.plane(at - normal * distance, normal, to));
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
        let (Shape::Grid(grid) | Shape::Deforming { now: grid, .. }) = shape else {
            return (at, normal);
        };
        let there = shape.normal(at);
        if distance.abs() > NEAR || there.dot(normal) < 0.9 {
            return (at, normal);
        }
        (at - there * (grid.distance(at) - self.keep), there)
    }

    fn plane(&self, at: DVec3, normal: DVec3, end: DVec3) -> Plane {
        Plane {
            at,
            normal,
            depth: (at - end).dot(normal),
        }
    }
}
