//! Strands at rest that lie in bodies are moved out of them, before they are what the solver holds to.

use glam::{DVec3, Vec3};

use super::shape::Collider;

/// How often a point, and a whole strand, is looked at again.
const ROUNDS: usize = 8;
/// Places looked at between two points.
const PLACES: usize = 4;
/// What is left of this, in m, is let be.
const LEFT: f64 = 2e-5;

/// Moves the points of a strand, root first, out of bodies as they are when a step starts, so that they and the links between them keep `keep`
/// metres from them. The root stays. A strand that leaves a body may do so as steeply as one metre in two: where its root is in the body, its first
/// points may be, too. Links keep their lengths only roughly. Returns how many points were moved.
///
/// A style's shape is what its strands hold to, so what lies in a body is best moved before [`Solver::new`](crate::Solver::new): the solver lets strands
/// stay as deep as they start.
///
/// ```
/// use glam::{DVec3, Vec3};
/// use hair_sim::{Collider, Pose, Shape, keep_out};
///
/// let head = Shape::Sphere { center: DVec3::ZERO, radius: 0.1 };
/// let head = Collider::fixed(head, Pose::IDENTITY);
/// // From the crown, straight through the head.
/// let mut points: Vec<Vec3> = (0..=10).map(|i| Vec3::new(0.02, 0.1 - 0.02 * i as f32, 0.0)).collect();
/// let moved = keep_out(&mut points, &[head], 0.001);
/// assert_eq!(moved, 10);
/// assert!(points[1..].iter().all(|point| point.length() > 0.1005));
/// ```
pub fn keep_out(points: &mut [Vec3], colliders: &[Collider], keep: f64) -> usize {
    let Some((&root, _)) = points.split_first() else {
        return 0;
    };
    if !points.iter().all(|point| point.is_finite()) {
        return 0;
    }
    let before: Vec<DVec3> = points.iter().map(|point| point.as_dvec3()).collect();
    let root_distance = nearest(colliders, root.as_dvec3()).map_or(keep, |near| near.0);
    let mut along = 0.0;
    // How far every point has to keep.
    let keeps: Vec<f64> = (before.iter().enumerate())
        .map(|(i, point)| {
            along += if i > 0 {
                point.distance(before[i - 1])
            } else {
                0.0
            };
            keep.min(root_distance + 0.5 * along)
        })
        .collect();
    let mut now = before.clone();
    for i in 1..now.len() {
        now[i] = outside(colliders, now[i], keeps[i]);
    }
    for _ in 0..ROUNDS {
        let mut is_out = true;
        for i in 1..now.len() {
            for place in 1..PLACES {
                let share = place as f64 / PLACES as f64;
                let at = now[i - 1].lerp(now[i], share);
                let wanted = keeps[i - 1] + (keeps[i] - keeps[i - 1]) * share;
                let Some((distance, normal)) = nearest(colliders, at) else {
                    continue;
                };
                if distance < wanted - LEFT {
                    is_out = false;
                    let out = normal * (wanted - distance);
                    now[i] += out;
                    if i > 1 {
                        now[i - 1] += out;
                    }
                }
            }
        }
        if is_out {
            break;
        }
    }
    let mut moved = 0;
    for (point, (now, before)) in points.iter_mut().zip(now.iter().zip(&before)) {
        if now != before && now.is_finite() {
            *point = now.as_vec3();
            moved += 1;
        }
    }
    moved
}

/// How far a place is from the nearest body, or in the deepest, and the way out.
fn nearest(colliders: &[Collider], at: DVec3) -> Option<(f64, DVec3)> {
    let places = colliders.iter().map(|collider| {
        let local = collider.before.to_local(at);
        (collider.shape.distance_before(local), collider, local)
    });
    let (distance, collider, local) = places.min_by(|one, other| one.0.total_cmp(&other.0))?;
    Some((
        distance,
        collider.before.rotation * collider.shape.normal_before(local),
    ))
}

/// The place outside of all bodies that lies next on the way out.
fn outside(colliders: &[Collider], mut at: DVec3, keep: f64) -> DVec3 {
    for _ in 0..ROUNDS {
        match nearest(colliders, at) {
            Some((distance, normal)) if distance < keep - LEFT => at += normal * (keep - distance),
            _ => break,
        }
    }
    at
}
