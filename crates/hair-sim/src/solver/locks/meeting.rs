//! Two links on their ways in a step: whether they meet, and the plane between them.

use glam::DVec3;

use crate::forces::mutual::Course;

use super::NEAR;

/// Links that are found in each other part by this much of what they lack in a step, at this speed in m/s at the most.
const PART: f64 = 0.2;
const PART_SPEED: f64 = 0.1;

/// How much a plane goes with the mean of two links' motion, where they differ: with 1 locks that lie on each other shake for ever.
const WITH_MEAN: f64 = 0.5;

/// Looks along the way of two links for where they meet; they touch where they are farther apart by less than this share.
const MOST_LOOKS: usize = 12;
pub(super) const TOUCH: f64 = 0.02;

/// Links nearer than this, in m, have no way out.
const LEAST_APART: f64 = 1e-9;

/// A link's ends, root end first, in a step.
pub(super) type Link = [Course; 2];

/// How two links meet in a step.
pub(super) struct Meeting {
    /// Where on each link, as a share of it.
    pub at: [f64; 2],
    /// Towards the first link.
    pub normal: DVec3,
    /// How far behind the plane each link would be at the start, and at the end.
    pub past: f64,
    pub push: [f64; 2],
    /// How much nearer they are at the start than they should be, in m.
    pub lacks: f64,
    /// The way of the plane in the step.
    pub flow: DVec3,
}

impl Meeting {
    /// None unless two links that keep `keep` metres from each other come as near as that by their own motion in a step of `dt` seconds, or so near
    /// that what acts in the step may bring them together: by as much again as they move against each other, or go against their roots (`own`,
    /// in m, of both together), whichever is less, and by [`NEAR`]. `shift` is the mean way of both roots.
    #[inline(always)]
    pub(super) fn of(
        link: &Link,
        other: &Link,
        (keep, own): (f64, f64),
        (shift, dt): (DVec3, f64),
    ) -> Option<Self> {
        // No two points of both come nearer by more than this.
        let way = |of: &Course| of.now - of.before;
        let (a, b, c, d) = (way(&link[0]), way(&link[1]), way(&other[0]), way(&other[1]));
        let most = (a - c).length_squared().max((a - d).length_squared());
        let most = most.max((b - c).length_squared().max((b - d).length_squared()));
        let most = most.sqrt();
        let touch = keep * (1.0 + TOUCH);
        let reach = touch + NEAR + own.min(most);
        let start = closest(at_time(link, 0.0), at_time(other, 0.0));
        let distance = start.apart.length();
        // Along the way by steps in which they cannot meet, until they touch.
        let (mut found, mut left, mut t) = (start, distance, 0.0);
        for _ in 0..MOST_LOOKS {
            if left <= touch || t >= 1.0 || left > reach + (1.0 - t) * most {
                break;
            }
            t = (t + (left - keep) / most).min(1.0);
            found = closest(at_time(link, t), at_time(other, t));
            left = found.apart.length();
        }
        if left > reach || left < LEAST_APART {
            return None;
        }
        let normal = found.apart / left;
        let at = [found.at, found.other_at];
        let on = |of: &Link, at: f64, t: f64| {
            let [start, end] = at_time(of, t);
            start + (end - start) * at
        };
        let before = [on(link, at[0], 0.0), on(other, at[1], 0.0)];
        let ways = [
            on(link, at[0], 1.0) - before[0],
            on(other, at[1], 1.0) - before[1],
        ];
        let mean = (ways[0] + ways[1]) * 0.5;
        // Against the roots.
        let [own, its] = ways.map(|way| normal.dot(way - shift));
        let along = normal.dot(shift) + shared_way(own, its);
        // What lies in each other parts slowly.
        let lacks = (keep - distance).max(0.0);
        let part = (PART * lacks).min(PART_SPEED * dt);
        let keep = keep.min(distance + part);
        let past = 0.5 * (keep - normal.dot(before[0] - before[1]));
        Some(Self {
            at,
            normal,
            past,
            lacks,
            push: [
                past + along - normal.dot(ways[0]),
                past - along + normal.dot(ways[1]),
            ],
            flow: mean + normal * (along - normal.dot(mean)),
        })
    }
}

/// How far the plane between two links goes that would go so far.
///
/// Neither strand knows what the other weighs there, so a plane that went with their mean motion would make energy of a light one that
/// strikes a heavy one. It goes with what both do, and by a part with the rest of their mean.
fn shared_way(one: f64, other: f64) -> f64 {
    let both = if one * other <= 0.0 {
        0.0
    } else if one.abs() < other.abs() {
        one
    } else {
        other
    };
    both + WITH_MEAN * (0.5 * (one + other) - both)
}

/// The ends of a link at a share of the step.
#[inline(always)]
fn at_time(link: &Link, t: f64) -> [DVec3; 2] {
    let at = |end: &Course| end.before + (end.now - end.before) * t;
    [at(&link[0]), at(&link[1])]
}

/// The places on two segments that are nearest to each other, as shares of them, and the way to the first from the other.
#[derive(Clone, Copy)]
pub(super) struct Closest {
    at: f64,
    other_at: f64,
    pub apart: DVec3,
}

/// After Ericson 2005, *Real-time collision detection*, 5.1.9.
#[inline(always)]
pub(super) fn closest([a, b]: [DVec3; 2], [c, d]: [DVec3; 2]) -> Closest {
    const LEAST: f64 = 1e-24;
    let (along, other, between) = (b - a, d - c, a - c);
    let (aa, ee, ff) = (
        along.length_squared(),
        other.length_squared(),
        other.dot(between),
    );
    let cc = along.dot(between);
    let (at, other_at) = if aa <= LEAST && ee <= LEAST {
        (0.0, 0.0)
    } else if aa <= LEAST {
        (0.0, (ff / ee).clamp(0.0, 1.0))
    } else if ee <= LEAST {
        ((-cc / aa).clamp(0.0, 1.0), 0.0)
    } else {
        let bb = along.dot(other);
        let area = aa * ee - bb * bb;
        // Of parallel ones any place will do; the middle changes least.
        let at = if area > 1e-9 * aa * ee {
            ((bb * ff - cc * ee) / area).clamp(0.0, 1.0)
        } else {
            0.5
        };
        let other_at = (bb * at + ff) / ee;
        if other_at < 0.0 {
            ((-cc / aa).clamp(0.0, 1.0), 0.0)
        } else if other_at > 1.0 {
            (((bb - cc) / aa).clamp(0.0, 1.0), 1.0)
        } else {
            (at, other_at)
        }
    };
    Closest {
        at,
        other_at,
        apart: between + along * at - other * other_at,
    }
}
