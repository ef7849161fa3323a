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

/// A link is on another side of a body than it was where the cosine of its normals is less than this, and its middle went farther than that, in m.
const SAME_SIDE: f64 = 0.5;
pub(super) const CROSSES: f64 = 5e-3;

/// Particles that are slower than this, in m/s, have their planes by where they are, and fast ones by where they go: what is about to come to rest
/// would be thrown to and fro by what it did last.
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
    /// Of the link between two particles with these ways, `length` metres long, in bodies of these numbers in which the strand's root is so deep each.
    pub(super) fn deepest<'a: 'b, 'b>(
        colliders: impl Iterator<Item = (usize, (&'b Collider<'a>, f64))>,
        ends: [Path; 2],
        length: f64,
    ) -> Option<Self> {
        let mut deepest: Option<Self> = None;
        for (body, (collider, root)) in colliders {
            // The distances of a grid turn at every cell: hair that lies on it would tremble with what they say of links.
            if collider.shape.is_sampled() {
                continue;
            }
            let ends = ends.map(|path| path.led_out(root));
            let Some(lack) = Self::of((body, collider), &ends, length) else {
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
        let keep = ends[0].keep.min(ends[1].keep);
        let ways = ends.each_ref().map(|path| (path.to - path.from).length());
        // A body that is farther from a place than this from an end isn't near it.
        let reach = keep + ways[0].max(ways[1]) + NEAR;
        let place = |path: &Path| {
            let at = collider.now.to_local(path.to);
            let from = collider.before.to_local(path.from);
            let (way, slow) = ((at - from).length_squared(), SLOW * path.dt);
            let at = from.lerp(at, way / (way + slow * slow));
            (at, shape.distance(at))
        };
        let start = place(&ends[0]);
        if start.1 - length > reach {
            return None;
        }
        let to = [start, place(&ends[1])];
        // No place on it is nearer than this.
        if 0.5 * (to[0].1 + to[1].1 - length) > reach {
            return None;
        }
        if let Some(plane) = Self::crosses(collider, ends, keep) {
            return Some(Self {
                body,
                depth: plane.depth,
                lifts: [0.0; 2],
                plane: Some((plane.at, plane.normal)),
            });
        }
        let middle = shape.distance(to[0].0.lerp(to[1].0, 0.5));
        let found = lowest(shape, to, middle, keep + NEAR);
        let least = found.map_or(to[0].1.min(to[1].1), |(_, least)| least);
        // One that touches with an end goes on from there.
        let most = match found {
            Some(_) => f64::INFINITY,
            None => (2.0 * (to[0].1 - 2.0 * middle + to[1].1)).max(0.0),
        };
        Some(Self {
            body,
            depth: keep - least,
            lifts: to.map(|(_, distance)| (distance - least).clamp(0.0, most)),
            plane: None,
        })
    }

    /// The plane of a body through which the link between two particles with these ways would pass.
    fn crosses(collider: &Collider, ends: &[Path; 2], keep: f64) -> Option<Plane> {
        let middle = Path {
            from: ends[0].from.lerp(ends[1].from, 0.5),
            to: ends[0].to.lerp(ends[1].to, 0.5),
            keep,
            ..ends[0]
        };
        let at = collider.now.to_local(middle.to);
        if (at - collider.before.to_local(middle.from)).length_squared() < CROSSES * CROSSES {
            return None;
        }
        let plane = middle.against(collider)?;
        let last = collider.shape.normal(at);
        (plane.normal.dot(last) < SAME_SIDE).then_some(plane)
    }

    /// The plane of a body that it would pass through, before the end of a way.
    pub(super) fn plane(&self, body: usize, path: &Path, collider: &Collider) -> Option<Plane> {
        let (at, normal) = self.plane.filter(|_| self.body == body)?;
        let end = collider.now.to_local(path.to);
        let plane = Plane {
            at,
            normal,
            depth: (at - end).dot(normal),
        };
        Some(path.within_reach(plane, collider))
    }
}

/// The place between two, of which and of whose middle the distances from a surface are known, that is nearest to it or deepest in it: as a share of the way from the
/// first, with its distance. None where that is one of both, or farther than `most` metres.
///
/// By a parabola through three places: bodies are smooth against links.
pub(super) fn lowest(
    shape: &Shape,
    [(from, start), (to, end)]: [(DVec3, f64); 2],
    middle: f64,
    most: f64,
) -> Option<(f64, f64)> {
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

#[cfg(test)]
mod tests {
    use super::super::PUSH_OUT;
    use super::*;
    use crate::pose::Pose;

    #[test]
    fn the_lowest_place_between_two_is_found() {
        let ridge = Shape::Capsule {
            from: DVec3::NEG_Z,
            to: DVec3::Z,
            radius: 0.04,
        };
        let mut found = 0;
        for i in 0..4000 {
            let spread = |k: i32| f64::from((i * 7919 + k * 104_729) % 1009) / 1009.0 - 0.5;
            let from = DVec3::new(-0.01 + 0.01 * spread(1), 0.045 + 0.01 * spread(2), 0.0);
            let to = from + DVec3::new(0.02, 0.01 * spread(3), 0.01 * spread(4));
            let ends = [from, to].map(|at| (at, ridge.distance(at)));
            let middle = ridge.distance(from.lerp(to, 0.5));
            let exact = (0..=2000)
                .map(|i| ridge.distance(from.lerp(to, f64::from(i) / 2000.0)))
                .fold(f64::INFINITY, f64::min);
            let least = match lowest(&ridge, ends, middle, f64::INFINITY) {
                Some((share, distance)) => {
                    found += 1;
                    assert_eq!(distance, ridge.distance(from.lerp(to, share)));
                    distance
                }
                None => ends[0].1.min(ends[1].1),
            };
            assert!((least - exact).abs() < 5e-5, "{least} {exact}");
        }
        assert!(found > 1000, "{found}");
    }

    /// A link across a ridge has both its ends lifted until it touches, one that leaves it has not, and one that goes through it is kept before it.
    #[test]
    fn a_link_over_a_ridge_lifts_its_ends() {
        let ridge = Shape::Capsule {
            from: DVec3::NEG_Z,
            to: DVec3::Z,
            radius: 0.04,
        };
        let colliders = [Collider::fixed(ridge, Pose::IDENTITY)];
        let path = |from: DVec3, to: DVec3| Path {
            from,
            to,
            keep: 0.0,
            push_out: PUSH_OUT,
            lift: 0.0,
            leads_out: 0.0,
            way_out: None,
            dt: 1.0 / 60.0,
        };
        let still = |at: DVec3| path(at, at);
        let of = |ends: [Path; 2]| {
            let far = colliders.iter().map(|body| (body, f64::INFINITY));
            Lack::deepest(far.enumerate(), ends, 0.02)
        };
        let (x, y) = (0.01, 0.0398);
        let across = of([-x, x].map(|x| still(DVec3::new(x, y, 0.0)))).unwrap();
        let height = ridge.distance(DVec3::new(x, y, 0.0));
        assert!((across.depth - 2e-4).abs() < 1e-6, "{across:?}");
        for lift in across.lifts {
            assert!((lift - (height + 2e-4)).abs() < 1e-6, "{across:?}");
        }
        let leaves = of([0.0, 0.02].map(|x| still(DVec3::new(x, 0.041 + 0.2 * x, 0.0)))).unwrap();
        assert!(leaves.depth < 0.0 && leaves.lifts[0] == 0.0, "{leaves:?}");
        let through =
            of([-x, x].map(|x| path(DVec3::new(x, 0.06, 0.0), DVec3::new(x, -0.06, 0.0))));
        let (at, normal) = through.unwrap().plane.unwrap();
        assert!(normal.y > 0.99 && (at.y - 0.04).abs() < 1e-3);
    }
}
