//! Hair that is moved out of bodies as a whole: what is styled in them, what guides carry, and what the solver leaves in them between two particles.

use glam::{DVec3, Vec3};
use hair_sim::Collider;

/// How often points are moved out: each move may push others in.
const CLEARINGS: u32 = 16;
/// Where along a link it is looked at, beside its ends.
const ALONG: [f64; 3] = [0.25, 0.5, 0.75];
/// What is as near as this, m, is near enough.
const NEAR: f64 = 1e-5;

/// Moves the points of a strand behind the first `held` out of bodies, with the links between them, until each is as far away as `gap` says of it,
/// in m; a link as far as that of its ends which says less. Whether any moved.
pub(crate) fn clear(
    points: &mut [Vec3],
    held: usize,
    colliders: &[Collider],
    gap: impl Fn(usize) -> f64,
) -> bool {
    let held = held.max(1);
    let mut has_moved = false;
    for _ in 0..CLEARINGS {
        let mut moves = false;
        let mut before = distance(points[held - 1], colliders);
        for i in held..points.len() {
            let here = distance(points[i], colliders);
            let length = f64::from(points[i].distance(points[i - 1]));
            // A place between is no nearer than the nearer end less half the link.
            let is_clear = before.min(here) - 0.5 * length > gap(i).max(gap(i - 1));
            before = here;
            if is_clear {
                continue;
            }
            if let Some(push) = push(points[i].as_dvec3(), colliders, gap(i)) {
                points[i] += push.as_vec3();
                moves = true;
            }
            for t in ALONG {
                let place = points[i - 1].as_dvec3().lerp(points[i].as_dvec3(), t);
                let Some(push) = push(place, colliders, gap(i).min(gap(i - 1))) else {
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
                points[i - 1] += (push * before).as_vec3();
                points[i] += (push * here).as_vec3();
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

/// How far a place is from the nearest body, m, negative inside.
pub(crate) fn distance(at: Vec3, colliders: &[Collider]) -> f64 {
    let at = at.as_dvec3();
    let distances = colliders.iter().map(|collider| collider.distance(at));
    distances.fold(f64::INFINITY, f64::min)
}

/// What takes a place out of the body that it is deepest in, to `gap` m from it; nothing where it is out of all.
fn push(at: DVec3, colliders: &[Collider], gap: f64) -> Option<DVec3> {
    let mut deepest: Option<(f64, &Collider)> = None;
    for collider in colliders {
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

    #[test]
    fn strands_are_moved_out_with_their_links() {
        let ball = Shape::Sphere {
            center: DVec3::new(0.0, -0.1, 0.0),
            radius: 0.05,
        };
        let ball = Collider::fixed(ball, Pose::IDENTITY);
        let straight: Vec<Vec3> = (0..9)
            .map(|i| Vec3::new(0.004, -0.025 * i as f32, 0.0))
            .collect();
        let mut moved = straight.clone();
        assert!(clear(&mut moved, 1, &[ball], |_| 0.001));
        assert_eq!(moved[..2], straight[..2]);
        for link in moved.windows(2) {
            for share in 0..=20 {
                let at = link[0].lerp(link[1], share as f32 / 20.0);
                let depth = -distance(at, &[ball]);
                assert!(depth < 5e-4, "{depth}");
            }
        }
        // What is out stays, to the bit, and so does what may be inside.
        let beside: Vec<Vec3> = straight.iter().map(|p| *p + Vec3::X * 0.2).collect();
        let mut same = beside.clone();
        assert!(!clear(&mut same, 1, &[ball], |_| 0.001));
        assert_eq!(same, beside);
        let mut same = straight.clone();
        assert!(!clear(&mut same, 1, &[ball], |_| -0.06));
        assert_eq!(same, straight);
    }
}
