//! What lies between a point and the eye: rays through a mesh.

use crate::{
    Surface, View,
    tree::{Box3, Tree},
};
use glam::{DVec3, Vec3A};
use std::ops::{ControlFlow, Range};

/// A tree of boxes around the triangles of a mesh, which rays ask.
#[derive(Clone, Debug)]
pub struct Bvh(Tree);

/// Where a ray meets a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// The triangle's index.
    pub triangle: u32,
    /// How far from the ray's start, in lengths of its direction.
    pub distance: f64,
    /// True if the ray comes from the side to which the triangle's normal points.
    pub from_front: bool,
}

/// A start and a direction of any length, followed up to a distance in lengths of the direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Where it starts.
    pub origin: DVec3,
    /// Where to.
    pub direction: DVec3,
    /// Hits nearer than this one don't count.
    pub from: f64,
    /// Hits from this one on don't count.
    pub to: f64,
}

impl Ray {
    /// From a point to the eye, or without end where the eye is infinitely far away.
    #[must_use]
    pub fn to_eye(point: DVec3, view: &View) -> Self {
        Self {
            origin: point,
            direction: view.towards(point),
            from: 0.0,
            to: view.way(),
        }
    }
}

impl Bvh {
    /// Sorts the triangles of a mesh; about `n log n`.
    #[must_use]
    pub fn new(surface: &Surface) -> Self {
        let boxes: Vec<Box3> = (0..surface.topology().triangles().len() as u32)
            .map(|triangle| bounds(surface, triangle))
            .collect();
        Self(Tree::new(&boxes))
    }

    /// Fits the tree to the same mesh after it has moved: much faster than a new one. Of a mesh that is wholly elsewhere, as a crumpled cloth, a
    /// new one is faster to ask.
    ///
    /// # Panics
    ///
    /// When the mesh has fewer triangles.
    pub fn refit(&mut self, surface: &Surface) {
        self.0.refit(|triangle| bounds(surface, triangle));
    }

    /// The largest of all coordinates, without its sign; 0 for no mesh.
    pub(crate) fn farthest_coordinate(&self) -> f64 {
        let bounds = self.0.bounds();
        bounds.map_or(0.0, |b| {
            f64::from(b.low.abs().max(b.high.abs()).max_element())
        })
    }

    /// Calls `hit` for all triangles that a ray meets, in no particular order, until told to stop.
    ///
    /// Nothing slips through between two triangles with a common edge: a ray that meets the edge meets both. Triangles
    /// along the ray are not met.
    pub fn hits(&self, surface: &Surface, ray: &Ray, mut hit: impl FnMut(Hit) -> ControlFlow<()>) {
        // One that goes nowhere, such as a segment of what is shrunk to a point, meets nothing, and any box might hold what it meets.
        if ray.direction == DVec3::ZERO {
            return;
        }
        let slabs = Slabs::of(ray, self.farthest_coordinate());
        self.0.visit(
            |bounds| slabs.may_meet(bounds),
            |triangle| match meets(surface, triangle, ray) {
                Some(found) => hit(found),
                None => ControlFlow::Continue(()),
            },
        );
    }

    /// True if a ray meets a triangle that isn't `skipped`.
    #[must_use]
    pub fn is_blocked(
        &self,
        surface: &Surface,
        ray: &Ray,
        mut skipped: impl FnMut(u32) -> bool,
    ) -> bool {
        let mut blocked = false;
        self.hits(surface, ray, |hit| {
            if skipped(hit.triangle) {
                return ControlFlow::Continue(());
            }
            blocked = true;
            ControlFlow::Break(())
        });
        blocked
    }

    /// The first triangle that a ray meets; of several at one distance the one of the lowest index.
    #[must_use]
    pub fn nearest(&self, surface: &Surface, ray: &Ray) -> Option<Hit> {
        let mut nearest: Option<Hit> = None;
        let key = |hit: &Hit| (hit.distance, hit.triangle);
        self.hits(surface, ray, |hit| {
            if nearest.is_none_or(|before| key(&hit) < key(&before)) {
                nearest = Some(hit);
            }
            ControlFlow::Continue(())
        });
        nearest
    }
}

fn bounds(surface: &Surface, triangle: u32) -> Box3 {
    let corners = surface.topology().triangles()[triangle as usize];
    Box3::of(corners.map(|vertex| surface.positions()[vertex as usize]))
}

/// What boxes are asked with whether a ray may meet something in them, for all three axes at once: in f32, and for boxes that are larger by more than
/// f32 may be wrong by. So what lies in a box is never missed, and which triangles are met is [`meets`]'s to say.
struct Slabs {
    /// Where the ray starts, farther on than it does and less far on: seen so, boxes are larger.
    start_high: Vec3A,
    start_low: Vec3A,
    inverse: Vec3A,
    from: f32,
    to: f32,
}

/// How wrong f32 may be about places, as a share of the largest coordinate: rounding the start, subtracting, dividing and multiplying are each
/// wrong by no more than two of its last digits (2 to the power of -24), of what is at most twice as large.
const MARGIN: f64 = 1.0 / (1 << 20) as f64;

/// Beyond these lengths f32 may have no number for what is multiplied and divided.
const LENGTHS: Range<f64> = 1e-30..1e30;

impl Slabs {
    /// Those of a ray, among boxes with coordinates up to the farthest one.
    fn of(ray: &Ray, farthest: f64) -> Self {
        let size = farthest.max(ray.origin.abs().max_element());
        let speed = ray.direction.length();
        if !(LENGTHS.contains(&size) && LENGTHS.contains(&speed)) {
            return Self::EVERYWHERE;
        }
        let margin = size * MARGIN;
        // From one side of all boxes to the other it isn't farther than that.
        let reach = ray.from.abs().max(ray.to.abs()).min(4.0 * size / speed);
        // Along an axis on which it hardly moves it may as well move by the margin, and there is a number to divide by.
        let least = margin / reach;
        let moving = |speed: f64| speed.abs().max(least).copysign(speed);
        let direction = DVec3::from(ray.direction.to_array().map(moving));
        let in_f32 = |place: DVec3| Vec3A::from(place.as_vec3());
        Self {
            start_high: in_f32(ray.origin + 2.0 * margin),
            start_low: in_f32(ray.origin - 2.0 * margin),
            inverse: in_f32(direction.recip()),
            from: (ray.from as f32).next_down(),
            to: (ray.to as f32).next_up(),
        }
    }

    /// Any box may be met.
    const EVERYWHERE: Self = Self {
        start_high: Vec3A::ZERO,
        start_low: Vec3A::ZERO,
        inverse: Vec3A::ZERO,
        from: f32::NEG_INFINITY,
        to: f32::INFINITY,
    };

    /// True if the ray may meet something in a box.
    #[inline]
    fn may_meet(&self, bounds: &Box3) -> bool {
        let low = (bounds.low - self.start_high) * self.inverse;
        let high = (bounds.high - self.start_low) * self.inverse;
        let enter = low.min(high).max_element().max(self.from);
        let leave = low.max(high).min_element().min(self.to);
        enter <= leave
    }
}

/// By the signs of three volumes, each of which two triangles with a common edge have bit for bit alike but for the sign
/// (the idea of Woop, Benthin and Wald, *Watertight ray/triangle intersection*, 2013).
fn meets(surface: &Surface, triangle: u32, ray: &Ray) -> Option<Hit> {
    let [a, b, c] = surface.corners(triangle).map(|corner| corner - ray.origin);
    let [u, v, w] = [b.cross(c), c.cross(a), a.cross(b)].map(|normal| ray.direction.dot(normal));
    // All three at once: which of them has another sign no processor guesses.
    let from_front = (u <= 0.0) & (v <= 0.0) & (w <= 0.0);
    let from_back = (u >= 0.0) & (v >= 0.0) & (w >= 0.0);
    if from_front == from_back {
        // Missed, or along the triangle (all are 0).
        return None;
    }
    let point = (a * u + b * v + c * w) / (u + v + w);
    let distance = point.dot(ray.direction) / ray.direction.length_squared();
    (distance >= ray.from && distance < ray.to).then_some(Hit {
        triangle,
        distance,
        from_front,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Topology;
    use glam::Vec3;
    use proptest::prelude::*;

    #[test]
    fn nothing_slips_through_an_edge_or_a_vertex() {
        // A fan around the origin, and rays at its vertices and edges.
        let mut positions = vec![Vec3::ZERO];
        positions.extend((0..7).map(|i| {
            let (sin, cos) = (i as f32 * std::f32::consts::TAU / 7.0).sin_cos();
            Vec3::new(cos, sin, 0.3 * sin)
        }));
        let triangles: Vec<[u32; 3]> = (0..7).map(|i| [0, i + 1, (i + 1) % 7 + 1]).collect();
        let topology = Topology::new(&positions, &triangles).unwrap();
        let surface = Surface::new(&topology, &positions).unwrap();
        let bvh = Bvh::new(&surface);
        let eye = Vec3::new(0.2, 0.1, 4.0);
        for spoke in 1..8 {
            for share in [0.0, 0.1, 0.7] {
                let target = (positions[spoke] * share).as_dvec3();
                let ray = Ray {
                    origin: eye.as_dvec3(),
                    direction: target - eye.as_dvec3(),
                    from: 0.0,
                    to: 2.0,
                };
                let hit = bvh.nearest(&surface, &ray).unwrap();
                assert!((hit.distance - 1.0).abs() < 1e-6 && hit.from_front);
            }
        }
    }

    proptest! {
        #[test]
        fn the_tree_finds_what_looking_at_all_finds(
            corners in prop::collection::vec(prop::array::uniform3(-4i8..4), 3..90),
            rays in prop::collection::vec(prop::array::uniform6(-6i8..6), 20),
            shift in prop::array::uniform3(-1f32..1.0),
        ) {
            let mut positions: Vec<Vec3> = corners.iter().map(|c| Vec3::from(c.map(f32::from))).collect();
            let triangles: Vec<[u32; 3]> = (0..positions.len() as u32 / 3).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
            let topology = Topology::new(&positions, &triangles).unwrap();
            let mut bvh = Bvh::new(&Surface::new(&topology, &positions).unwrap());
            for (i, position) in positions.iter_mut().enumerate() {
                *position += Vec3::from(shift) * (i % 5) as f32;
            }
            let surface = Surface::new(&topology, &positions).unwrap();
            bvh.refit(&surface);
            for numbers in rays {
                let [a, b, c, d, e, f] = numbers.map(f64::from);
                let ray = Ray { origin: DVec3::new(a, b, c), direction: DVec3::new(d, e, f), from: 0.0, to: f64::INFINITY };
                let expected: Vec<Hit> = (0..triangles.len() as u32).filter_map(|t| meets(&surface, t, &ray)).collect();
                let mut found = Vec::new();
                bvh.hits(&surface, &ray, |hit| { found.push(hit); ControlFlow::Continue(()) });
                found.sort_by_key(|hit| hit.triangle);
                prop_assert_eq!(found, expected);
            }
        }

        /// However large or small all is, and however slowly a ray moves along an axis. All numbers are whole ones times a power of two, so that which
        /// triangles are met is exact.
        #[test]
        fn boxes_hide_nothing_that_is_met(
            corners in prop::collection::vec(prop::array::uniform3(-4i8..4), 3..60),
            rays in prop::collection::vec((prop::array::uniform6(-4i8..4), 0..120i32, -8.0..2.0, -1.0..8.0), 20),
            size in -110..110i32,
        ) {
            let size = f64::from(size).exp2();
            let at = |c: [i8; 3]| Vec3::from(c.map(|x| (f64::from(x) * size) as f32));
            let positions: Vec<Vec3> = corners.into_iter().map(at).collect();
            let triangles: Vec<[u32; 3]> = (0..positions.len() as u32 / 3).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
            let topology = Topology::new(&positions, &triangles).unwrap();
            let surface = Surface::new(&topology, &positions).unwrap();
            let bvh = Bvh::new(&surface);
            for ([a, b, c, d, e, f], slow, from, to) in rays {
                let slow = f64::from(-slow).exp2();
                let moving = |x: i8| if x == 0 { slow } else { f64::from(x) } * size;
                let origin = at([a, b, c]).as_dvec3();
                let ray = Ray { origin, direction: DVec3::from([d, e, f].map(moving)), from, to };
                let expected: Vec<Hit> = (0..triangles.len() as u32).filter_map(|t| meets(&surface, t, &ray)).collect();
                let mut found = Vec::new();
                bvh.hits(&surface, &ray, |hit| { found.push(hit); ControlFlow::Continue(()) });
                found.sort_by_key(|hit| hit.triangle);
                prop_assert_eq!(found, expected);
            }
        }
    }
}
