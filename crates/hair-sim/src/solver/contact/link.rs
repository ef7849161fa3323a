//! What lies between two particles of a strand: a link may cut a body that neither of its ends touches.
//!
//! Where it would, its ends are kept farther from the body than they would be alone. How much farther hangs on where they are and nothing else,
//! and changes evenly as they move: so a link that rests on a body needs no plane of its own, which would come and go.

use glam::DVec3;

use crate::collision::shape::{Collider, Shape};

use super::{
    NEAR,
    path::{Path, Plane},
};

/// A link is on another side of a body than it was where the cosine of its normals is less than this.
const SAME_SIDE: f64 = 0.5;

/// Particles that are slower than this, in m/s, ...
pub(super) const SLOW: f64 = 0.12;

/// What a link lacks in the body in which it is deepest.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lack {
    /// The body's number.
    pub body: usize,
    /// How deep the link is in it at the end of its way, in m; less than 0 outside.
    pub depth: f64,
    /// By how much both its ends have to be farther from the body than they would be alone, in m.
    pub lifts: [f64; 2],
    /// The plane that both ends have to stay before, in the body's space, as the link would pass through the body: a place and its normal.
    plane: Option<(DVec3, DVec3)>,
}

impl Lack {
    /// Of the link between two particles with these ways, `length` metres long.
    pub(super) fn deepest(colliders: &[Collider], ends: &[Path; 2], length: f64) -> Option<Self> {
        let mut deepest: Option<Self> = None;
        for (body, collider) in colliders.iter().enumerate() {
            let Some(lack) = Self::of((body, collider), ends, length) else {
                continue;
            };
            if deepest.as_ref().is_none_or(|last| lack.depth > last.depth) {
                deepest = Some(lack);
            }
        }
        deepest
    }

    fn of((body, collider): (usize, &Collider), ends: &[Path; 2], length: f64) -> Option<Self> {
        let shape = &collider.shape;
        let to = ends.each_ref().map(|path| {
            let at = collider.now.to_local(path.to);
            let from = collider.before.to_local(path.from);
            let way = (at - from).length_squared();
            let slow = SLOW * path.dt;
            let at = from.lerp(at, way / (way + slow * slow));
            (at, shape.distance(at))
        });
        let keep = ends[0].keep.min(ends[1].keep);
        let way = (ends.iter())
            .map(|path| (path.to - path.from).length())
            .fold(0.0, f64::max);
        // No place on it is nearer than this.
        let reach = keep + way + NEAR;
        if 0.5 * (to[0].1 + to[1].1 - length) > reach {
            return None;
        }
        let middle = Path {
            from: ends[0].from.lerp(ends[1].from, 0.5),
            to: ends[0].to.lerp(ends[1].to, 0.5),
            keep,
            dt: ends[0].dt,
        };
        let last = shape.normal(collider.now.to_local(middle.to));
        let crossed = (middle.against(collider)).filter(|plane| plane.normal.dot(last) < SAME_SIDE);
        if let Some(plane) = crossed {
            return Some(Self {
                body,
                depth: plane.depth,
                lifts: [0.0; 2],
                plane: Some((plane.at, plane.normal)),
            });
        }
        let nearest = to[0].1.min(to[1].1);
        let middle = shape.distance(to[0].0.lerp(to[1].0, 0.5));
        let curve = (2.0 * (to[0].1 - 2.0 * middle + to[1].1)).max(0.0);
        let found = lowest(shape, to, keep + NEAR);
        let least = found.map_or(nearest, |(_, least)| least);
        Some(Self {
            body,
            depth: keep - least,
            lifts: to.map(|(_, distance)| {
                let most = if found.is_some() {
                    f64::INFINITY
                } else {
                    curve
                };
                (distance - least).clamp(0.0, most)
            }),
            plane: None,
        })
    }

    /// The plane of a body that it would pass through, before the end of a way.
    pub(super) fn plane(&self, body: usize, path: &Path, collider: &Collider) -> Option<Plane> {
        let (at, normal) = self.plane.filter(|_| self.body == body)?;
        let end = collider.now.to_local(path.to);
        Some(Plane {
            at,
            normal,
            depth: (at - end).dot(normal),
        })
    }
}

/// The place between two, of which the distances from a surface are known, that is nearest to it or deepest in it: as a share of the way from the
/// first, with its distance. None where that is one of both, or farther than `most` metres.
///
/// By a parabola through three places: bodies are smooth against links.
pub(super) fn lowest(
    shape: &Shape,
    [(from, start), (to, end)]: [(DVec3, f64); 2],
    most: f64,
) -> Option<(f64, f64)> {
    let middle = shape.distance(from.lerp(to, 0.5));
    let slope = 4.0 * middle - 3.0 * start - end;
    let curve = 2.0 * (start - 2.0 * middle + end);
    let share = -slope / (2.0 * curve);
    // NaN where all are alike.
    if !(share > 0.0 && share < 1.0 && curve > 0.0) {
        return None;
    }
    let expected = start + share * (slope + share * curve);
    if expected > most {
        return None;
    }
    let least = shape.distance(from.lerp(to, share));
    Some((share, least))
}
