//! Links on their ways in a step, four pairs at once: whether they meet, and the planes between them.

use glam::DVec3;

use crate::lanes::{Lane, Number, Vec3, stored};

use super::NEAR;

/// Links that are found in each other part by this much of what they lack in a step, at this speed in m/s at the most.
const PART: f64 = 0.2;
const PART_SPEED: f64 = 0.1;

/// How much a plane goes with the mean of two links' motion, where they differ: with 1 locks that lie on each other shake for ever.
const WITH_MEAN: f64 = 0.5;

/// Looks along the way of two links for where they meet; they touch where they are farther apart by less than this share.
const MOST_LOOKS: usize = 12;
pub(super) const TOUCH: f64 = 0.02;

/// What acts in a step may bring links together that move against each other, or against their roots, by as much again. By this share of how far they
/// keep apart they don't pass through each other, nor in the next step, which finds them nearer than they keep and has a plane.
pub(super) const SLOW: f64 = 0.5;

/// Links nearer than this, in m, have no way out.
const LEAST_APART: f64 = 1e-9;

/// Links on their ways in a step: where their ends are at the start, root end first, and where at its end.
#[derive(Clone, Copy, Debug)]
pub(super) struct Links<T = Lane> {
    pub start: Vec3<T>,
    pub end: Vec3<T>,
    start_now: Vec3<T>,
    end_now: Vec3<T>,
}
stored!(Links {
    start,
    end,
    start_now,
    end_now
});

impl Links {
    pub(super) const NONE: Self = Self {
        start: Vec3::ZERO,
        end: Vec3::ZERO,
        start_now: Vec3::ZERO,
        end_now: Vec3::ZERO,
    };

    /// Sets one of them by its ends, before and after.
    #[inline(always)]
    pub(super) fn set(&mut self, lane: usize, [start, end]: [[DVec3; 2]; 2]) {
        self.start.set(lane, start[0]);
        self.end.set(lane, end[0]);
        self.start_now.set(lane, start[1]);
        self.end_now.set(lane, end[1]);
    }
}

impl<T: Number> Links<T> {
    /// The ways of their ends.
    #[inline(always)]
    fn ways(&self) -> [Vec3<T>; 2] {
        [self.start_now - self.start, self.end_now - self.end]
    }

    /// Their ends at a share of the step.
    #[inline(always)]
    fn at_time(&self, t: T) -> [Vec3<T>; 2] {
        let [start, end] = self.ways();
        [self.start + start.scale(t), self.end + end.scale(t)]
    }

    /// A place on them, by the share of them before it: where it is at the start, and its way.
    #[inline(always)]
    fn course(&self, at: T) -> [Vec3<T>; 2] {
        let before = self.start + (self.end - self.start).scale(at);
        let [start, end] = self.at_time(T::splat(1.0));
        [before, start + (end - start).scale(at) - before]
    }
}

/// How links meet in a step.
#[derive(Clone, Debug)]
pub(super) struct Meeting {
    /// 1 where they do, else 0.
    pub meets: Lane,
    /// Where on each link, as a share of it.
    pub at: [Lane; 2],
    /// Towards the first link.
    pub normal: Vec3,
    /// How far behind the plane each link would be at the start, and at the end.
    pub past: Lane,
    pub push: [Lane; 2],
    /// How much nearer they are at the start than they should be, in m.
    pub lacks: Lane,
    /// The way of the plane in the step.
    pub flow: Vec3,
}

impl Meeting {
    /// Links that keep `keep` metres from each other meet where they come as near as that by their own motion in a step of `dt` seconds, or so near
    /// that what acts in the step may bring them together: by as much again as they move against each other, or go against their
    /// roots (`own`, in m, of both together), whichever is less, where that isn't [`SLOW`], and by [`NEAR`]. `shift` is the mean way of both roots.
    /// Of what they would part by if they are found in each other they do this share: `parts`. None where none do.
    #[inline(always)]
    pub(super) fn of<T: Number>(
        link: &Links<T>,
        other: &Links<T>,
        (keep, own, parts): (T, T, T),
        (shift, dt): (Vec3<T>, f64),
    ) -> Option<Self> {
        let (zero, one, half) = (T::splat(0.0), T::splat(1.0), T::splat(0.5));
        // No two points of both come nearer by more than this.
        let ([a, b], [c, d]) = (link.ways(), other.ways());
        let nearer = most((a - c).length_squared(), (a - d).length_squared());
        let nearer = most(nearer, (b - c).length_squared());
        let nearer = most(nearer, (b - d).length_squared()).sqrt();
        let touch = keep * T::splat(1.0 + TOUCH);
        let acts = least(own, nearer);
        let acts = T::choose((keep * T::splat(SLOW)).less(acts), acts, zero);
        let reach = touch + T::splat(NEAR) + acts;
        let start = closest([link.start, link.end], [other.start, other.end]);
        let distance = start.apart.length_squared().sqrt();
        // Along the way by steps in which they cannot meet, until they touch.
        let (mut found, mut left, mut t) = (start, distance, zero);
        for _ in 0..MOST_LOOKS {
            let is_far = (reach + (one - t) * nearer).less(left);
            let ends = T::choose(is_far, one, T::choose(t.less(one), zero, one));
            let ends = half.less(T::choose(touch.less(left), ends, one));
            if T::all(ends) {
                break;
            }
            t = T::choose(ends, t, least(t + (left - keep) / nearer, one));
            let next = closest(link.at_time(t), other.at_time(t));
            left = T::choose(ends, left, next.apart.length_squared().sqrt());
            found = Closest::choose(ends, found, next);
        }
        let is_out = T::choose(left.less(T::splat(LEAST_APART)), zero, one);
        let meets = T::choose(reach.less(left), zero, is_out);
        if T::all(meets.less(half)) {
            return None;
        }
        let apart = found.apart;
        let normal = Vec3::new(apart.x / left, apart.y / left, apart.z / left);
        // Where they are to touch, before and after, and its way.
        let [before, way] = link.course(found.at);
        let [its_before, its_way] = other.course(found.other_at);
        let mean = (way + its_way).scale(half);
        // Against the roots.
        let (own, its) = (normal.dot(way - shift), normal.dot(its_way - shift));
        let along = normal.dot(shift) + shared_way(own, its);
        // What lies in each other parts slowly.
        let lacks = most(keep - distance, zero);
        let part = parts * least(T::splat(PART) * lacks, T::splat(PART_SPEED * dt));
        let keep = least(keep, distance + part);
        let past = half * (keep - normal.dot(before - its_before));
        let push = [
            past + along - normal.dot(way),
            past - along + normal.dot(its_way),
        ];
        let flow = mean + normal.scale(along - normal.dot(mean));
        Some(Self {
            meets: meets.store(),
            at: [found.at.store(), found.other_at.store()],
            normal: normal.store(),
            past: past.store(),
            push: [push[0].store(), push[1].store()],
            lacks: lacks.store(),
            flow: flow.store(),
        })
    }
}

/// How far the plane between two links goes that would go so far.
///
/// Neither strand knows what the other weighs there, so a plane that went with their mean motion would make energy of a light one that
/// strikes a heavy one. It goes with what both do, and by a part with the rest of their mean.
#[inline(always)]
fn shared_way<T: Number>(one: T, other: T) -> T {
    let smaller = T::choose(one.abs().less(other.abs()), one, other);
    let both = T::choose(T::splat(0.0).less(one * other), smaller, T::splat(0.0));
    both + T::splat(WITH_MEAN) * (T::splat(0.5) * (one + other) - both)
}

#[inline(always)]
pub(super) fn least<T: Number>(one: T, other: T) -> T {
    T::choose(other.less(one), other, one)
}

#[inline(always)]
pub(super) fn most<T: Number>(one: T, other: T) -> T {
    T::choose(one.less(other), other, one)
}

/// What is nearest to a share of a segment on it.
#[inline(always)]
fn on_segment<T: Number>(at: T) -> T {
    least(most(at, T::splat(0.0)), T::splat(1.0))
}

/// The places on two segments that are nearest to each other, as shares of them, and the way to the first from the other.
#[derive(Clone, Copy)]
pub(super) struct Closest<T> {
    at: T,
    other_at: T,
    pub apart: Vec3<T>,
}

impl<T: Number> Closest<T> {
    #[inline(always)]
    fn choose(condition: T::Condition, yes: Self, no: Self) -> Self {
        Self {
            at: T::choose(condition, yes.at, no.at),
            other_at: T::choose(condition, yes.other_at, no.other_at),
            apart: Vec3::choose(condition, yes.apart, no.apart),
        }
    }
}

/// After Ericson 2005, *Real-time collision detection*, 5.1.9.
#[inline(always)]
pub(super) fn closest<T: Number>([a, b]: [Vec3<T>; 2], [c, d]: [Vec3<T>; 2]) -> Closest<T> {
    let (zero, one) = (T::splat(0.0), T::splat(1.0));
    let (along, other, between) = (b - a, d - c, a - c);
    let (aa, ee, ff) = (
        along.length_squared(),
        other.length_squared(),
        other.dot(between),
    );
    let (bb, cc) = (along.dot(other), along.dot(between));
    let area = aa * ee - bb * bb;
    // Of parallel ones any place will do; the middle changes least.
    let crosses = (T::splat(1e-9) * aa * ee).less(area);
    let at = on_segment((bb * ff - cc * ee) / area);
    let at = T::choose(crosses, at, T::splat(0.5));
    let other_at = (bb * at + ff) / ee;
    let (before, after) = (other_at.less(zero), one.less(other_at));
    let of_end = on_segment(T::choose(before, -cc, bb - cc) / aa);
    let at = T::choose(before, of_end, T::choose(after, of_end, at));
    let other_at = on_segment(other_at);
    // Links that fold up to a point on their ways.
    let least = T::splat(1e-24);
    let (is_long, other_is_long) = (least.less(aa), least.less(ee));
    let to_point = on_segment(-cc / aa);
    let from_point = on_segment(ff / ee);
    let at = T::choose(other_is_long, at, to_point);
    let other_at = T::choose(is_long, other_at, from_point);
    let (at, other_at) = (
        T::choose(is_long, at, zero),
        T::choose(other_is_long, other_at, zero),
    );
    Closest {
        at,
        other_at,
        apart: between + along.scale(at) - other.scale(other_at),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lanes::LANES;

    /// Numbers from -1 to 1.
    fn noise(seed: usize) -> f64 {
        ((seed * 7919 + seed * seed * 31) % 2003) as f64 / 1001.0 - 1.0
    }

    fn place(seed: usize) -> DVec3 {
        DVec3::from_array([0, 1, 2].map(|axis| noise(3 * seed + axis)))
    }

    /// Links of 2 cm: some across each other, some side by side, some folded up to a point.
    fn links(seed: usize) -> Links {
        let mut links = Links::NONE;
        for lane in 0..LANES {
            let seed = 64 * seed + 8 * lane;
            let along = match seed / 8 % 5 {
                0 => DVec3::ZERO,
                1 | 2 => DVec3::X * 0.02,
                _ => place(seed) * 0.02,
            };
            let (start, way) = (place(seed + 1) * 0.02, place(seed + 2) * 0.01);
            let end = start + along;
            let turn = place(seed + 3) * 1e-3 * noise(seed);
            links.set(lane, [[start, start + way], [end, end + way + turn]]);
        }
        links
    }

    #[test]
    fn no_places_on_two_links_are_nearer_than_the_closest() {
        for seed in 0..300 {
            let (link, other) = (links(2 * seed), links(2 * seed + 1));
            let found = closest([link.start, link.end], [other.start, other.end]);
            for lane in 0..LANES {
                let on = |of: &Links, at: f64| of.start.get(lane).lerp(of.end.get(lane), at);
                let (at, other_at) = (found.at[lane], found.other_at[lane]);
                let apart = found.apart.get(lane);
                assert!((apart - (on(&link, at) - on(&other, other_at))).length() < 1e-12);
                for (i, j) in (0..=20).flat_map(|i| (0..=20).map(move |j| (i, j))) {
                    let place = on(&link, f64::from(i) / 20.0);
                    let its = on(&other, f64::from(j) / 20.0);
                    assert!(apart.length() <= (place - its).length() + 1e-12);
                }
            }
        }
    }

    /// Whether links meet is told by many looks along their ways, and they meet where they touch.
    #[test]
    fn links_meet_that_come_near_on_their_ways() {
        let (keep, own) = (0.004, 0.003);
        let (mut meet, mut pass) = (0, 0);
        for seed in 0..300 {
            let (link, other) = (links(2 * seed), links(2 * seed + 1));
            let lanes = (Lane::splat(keep), Lane::splat(own), Lane::ONE);
            let meeting = Meeting::of(&link, &other, lanes, (Vec3::ZERO, 1.0 / 60.0));
            for lane in 0..LANES {
                let looks = (0..=200).map(|i| {
                    let t = Lane::splat(f64::from(i) / 200.0);
                    let apart = closest(link.at_time(t), other.at_time(t)).apart;
                    apart.get(lane).length()
                });
                let nearest = looks.fold(f64::INFINITY, f64::min);
                let meets = (meeting.as_ref()).is_some_and(|meeting| meeting.meets[lane] > 0.0);
                // What the looks may miss of ways of up to 2 cm against each other.
                if nearest < keep - 2e-4 {
                    assert!(meets, "{seed}, {lane}: {nearest}");
                    meet += 1;
                }
                if nearest > keep * (1.0 + TOUCH) + NEAR + own {
                    assert!(!meets, "{seed}, {lane}: {nearest}");
                    pass += 1;
                }
            }
        }
        assert!(meet > 100 && pass > 100, "{meet}, {pass}");
    }
}
