//! Hair that is moved out of bodies as a whole: what is styled in them, what guides carry, and what the solver leaves in them between two particles.

use glam::{DVec3, Vec3};
use hair_sim::Collider;

/// How often points are moved out: each move may push others in.
const CLEARINGS: u32 = 16;
/// Where along a link it is looked at: at its end, and on the way there.
const PLACES: [f64; 4] = [1.0, 0.25, 0.5, 0.75];
/// What part of a point's way the next one goes along, towards the tip and towards the root.
const BEYOND: f32 = 0.75;
const BEHIND: f32 = 0.5;
/// What is as near as this, m, is near enough.
const NEAR: f64 = 1e-5;

/// How far the places of the link that ends at a point are kept from bodies, m; below 0, how deep they may be.
pub(crate) type Gap = [f32; PLACES.len()];

/// Moves the points of a strand behind the first `held` out of bodies, with the way that is drawn between them, until each place is as far away as
/// `gap` says of the link that ends at a point, which is `most` m at most. Whether any moved: what is clear stays, to the bit.
pub(crate) fn clear(
    points: &mut [Vec3],
    held: usize,
    colliders: &[Collider],
    most: f64,
    gap: impl Fn(usize) -> Gap,
) -> bool {
    let held = held.max(1);
    let mut has_moved = false;
    for _ in 0..CLEARINGS {
        let mut moves = false;
        let mut near = Near::new(points, held - 1, colliders);
        for i in held..points.len() {
            if near.is_clear(points, i, most) {
                continue;
            }
            let mut moves_here = false;
            for (t, gap) in PLACES.into_iter().zip(gap(i)) {
                let place = on_path(points, i, t);
                // What has been moved may have come near others.
                let may_meet = |body: &usize| moves_here || near.may_meet(*body);
                let Some(push) = push(place, colliders, may_meet, f64::from(gap)) else {
                    continue;
                };
                // As little as moves the place by that much; what is held stays.
                let (before, here) = match i == held {
                    true => (0.0, 1.0),
                    false => {
                        let squared = (1.0 - t) * (1.0 - t) + t * t;
                        ((1.0 - t) / squared, t / squared)
                    }
                };
                let (before, here) = ((push * before).as_vec3(), (push * here).as_vec3());
                points[i - 1] += before;
                points[i] += here;
                take_along(&mut points[i + 1..], here, BEYOND);
                let behind = &mut points[held..(i - 1).max(held)];
                take_along(behind.iter_mut().rev(), before, BEHIND);
                moves_here = true;
            }
            if moves_here {
                near = Near::new(points, i, colliders);
                moves = true;
            }
        }
        if !moves {
            return has_moved;
        }
        has_moved = true;
    }
    has_moved
}

/// Moves the next points of a strand by less and less, so that it bends and does not break.
fn take_along<'p>(points: impl IntoIterator<Item = &'p mut Vec3>, by: Vec3, share: f32) {
    let mut by = by;
    for point in points {
        by *= share;
        if f64::from(by.length_squared()) < NEAR * NEAR {
            return;
        }
        *point += by;
    }
}

/// How far the places of a strand's links are from bodies, for each point those of the link that ends there: `most` m where they are farther away.
/// The first point has no link.
pub(crate) fn gaps(points: &[Vec3], colliders: &[Collider], most: f32) -> Vec<Gap> {
    let mut gaps = vec![[most; PLACES.len()]; points.len()];
    let mut near = Near::new(points, 0, colliders);
    for i in 1..points.len() {
        if near.is_clear(points, i, f64::from(most)) {
            continue;
        }
        for (t, gap) in PLACES.into_iter().zip(&mut gaps[i]) {
            let place = on_path(points, i, t);
            let bodies = colliders.iter().enumerate();
            for (_, collider) in bodies.filter(|(body, _)| near.may_meet(*body)) {
                *gap = gap.min(collider.distance(place) as f32);
            }
        }
    }
    gaps
}

/// How far a strand is from each body at the point that it has been followed to.
struct Near<'a> {
    colliders: &'a [Collider<'a>],
    bodies: Vec<Body>,
}

struct Body {
    /// No more than the distance there, m.
    distance: f64,
    /// Whether the way to there may come nearer than was asked for.
    may_meet: bool,
}

impl<'a> Near<'a> {
    fn new(points: &[Vec3], at: usize, colliders: &'a [Collider<'a>]) -> Self {
        let at = points[at].as_dvec3();
        let body = |collider: &Collider| Body {
            distance: collider.distance(at),
            may_meet: false,
        };
        Self {
            bodies: colliders.iter().map(body).collect(),
            colliders,
        }
    }

    /// Whether the way to the point that was gone on to last may meet a body.
    fn may_meet(&self, body: usize) -> bool {
        self.bodies[body].may_meet
    }

    /// Goes on to the next point, `to`. Whether all on the way that is drawn there is farther from bodies than `gap` m.
    fn is_clear(&mut self, points: &[Vec3], to: usize, gap: f64) -> bool {
        let link = f64::from(points[to].distance(points[to - 1]));
        // No place of the spline is farther than this from the link.
        let bulge = 0.125 * bend(points, to - 1).max(bend(points, to));
        let mut is_clear = true;
        for (body, collider) in self.bodies.iter_mut().zip(self.colliders) {
            let before = body.distance;
            // Nothing on the way is nearer than this: so the distance itself is not asked for.
            body.distance -= link;
            body.may_meet = body.distance - bulge <= gap;
            if body.may_meet {
                body.distance = collider.distance(points[to].as_dvec3());
                // A place of the link is no nearer than the mean of its ends less half of it.
                body.may_meet = 0.5 * (before + body.distance - link) - bulge <= gap;
                is_clear &= !body.may_meet;
            }
        }
        is_clear
    }
}

/// How far the links at a point are from going on straight and even, m: their difference.
fn bend(points: &[Vec3], at: usize) -> f64 {
    match (at.checked_sub(1), points.get(at + 1)) {
        (Some(before), Some(after)) => {
            let bend = points[before] + *after - 2.0 * points[at];
            f64::from(bend.length())
        }
        _ => 0.0,
    }
}

/// A place on the way that is drawn through points, Catmull and Rom's spline: at `t`, 0 to 1, of the link that ends at a point.
fn on_path(points: &[Vec3], to: usize, t: f64) -> DVec3 {
    let [b, c] = [points[to - 1], points[to]].map(|point| point.as_dvec3());
    if t == 1.0 {
        return c;
    }
    let a = (to.checked_sub(2)).map_or(2.0 * b - c, |i| points[i].as_dvec3());
    let d = (points.get(to + 1)).map_or(2.0 * c - b, |point| point.as_dvec3());
    let (from, to, way) = (0.5 * (c - a), 0.5 * (d - b), c - b);
    b + (from + (3.0 * way - 2.0 * from - to + (from + to - 2.0 * way) * t) * t) * t
}

/// What takes a place out of the body that it is deepest in, of those that it may meet, to `gap` m from it; nothing where it is out of all.
fn push(
    at: DVec3,
    colliders: &[Collider],
    may_meet: impl Fn(&usize) -> bool,
    gap: f64,
) -> Option<DVec3> {
    let mut deepest: Option<(f64, &Collider)> = None;
    for (_, collider) in colliders
        .iter()
        .enumerate()
        .filter(|(body, _)| may_meet(body))
    {
        let distance = collider.distance(at);
        if distance < gap - NEAR && deepest.is_none_or(|(other, _)| distance < other) {
            deepest = Some((distance, collider));
        }
    }
    let (distance, collider) = deepest?;
    Some(collider.outwards(at) * (gap - distance))
}

#[cfg(test)]
mod tests {
    use super::*;
    use hair_sim::{Pose, Shape};
    use proptest::prelude::*;

    fn ball(y: f64, radius: f64) -> Collider<'static> {
        let center = DVec3::new(0.0, y, 0.0);
        Collider::fixed(Shape::Sphere { center, radius }, Pose::IDENTITY)
    }

    /// How far a place is from the nearest body, m, negative inside.
    fn distance(at: DVec3, colliders: &[Collider]) -> f64 {
        let distances = colliders.iter().map(|collider| collider.distance(at));
        distances.fold(f64::INFINITY, f64::min)
    }

    /// The nearest place to bodies of the way that is drawn through points.
    fn nearest(points: &[Vec3], colliders: &[Collider]) -> f64 {
        let links = 1..points.len();
        let places =
            links.flat_map(|to| (0..=20).map(move |t| on_path(points, to, f64::from(t) / 20.0)));
        places
            .map(|at| distance(at, colliders))
            .fold(f64::INFINITY, f64::min)
    }

    #[test]
    fn strands_are_moved_out_with_their_links() {
        let ball = ball(-0.1, 0.05);
        let straight: Vec<Vec3> = (0..9)
            .map(|i| Vec3::new(0.004, -0.025 * i as f32, 0.0))
            .collect();
        let mut moved = straight.clone();
        assert!(clear(&mut moved, 1, &[ball], 1e-3, |_| [1e-3; 4]));
        assert_eq!(moved[0], straight[0]);
        let depth = -nearest(&moved, &[ball]);
        assert!(depth < 5e-4, "{depth}");
        // What may be inside stays.
        let mut same = straight.clone();
        assert!(!clear(&mut same, 1, &[ball], -0.06, |_| [-0.06; 4]));
        assert_eq!(same, straight);
    }

    proptest! {
        /// What is as far away as it began stays, to the bit, wherever that is.
        #[test]
        fn what_is_as_near_as_it_began_stays(
            way in prop::array::uniform3(-1.0_f32..1.0),
            from in prop::array::uniform3(-0.2_f32..0.2),
            radius in 0.01..0.15_f64,
        ) {
            let colliders = [ball(-0.1, radius), ball(0.3, 0.1)];
            let way = Vec3::from(way).normalize_or(Vec3::X) * 0.02;
            let side = way.any_orthogonal_vector();
            let at = |i: u32| Vec3::from(from) + way * i as f32 + side * (0.6 * i as f32).sin();
            let points: Vec<Vec3> = (0..12).map(at).collect();
            let own = gaps(&points, &colliders, 1e-3);
            for i in 1..points.len() {
                for (t, gap) in PLACES.into_iter().zip(own[i]) {
                    let place = on_path(&points, i, t);
                    prop_assert_eq!(gap, 1e-3_f32.min(distance(place, &colliders) as f32));
                }
            }
            let mut same = points.clone();
            prop_assert!(!clear(&mut same, 1, &colliders, 1e-3, |i| own[i]));
            prop_assert!(same == points);
        }
    }
}
