//! A coat of clumps below all zones, so that no scalp shows between them. Either a few broad ones, most of them from the whorl to
//! the hairline and the others along it, which make a smooth dome; or, as first styles have it, rings along the hairline and a cap
//! of narrow ones that run from the whorl outwards. Roots of other clumps sink into both.

use super::scalp::Scalp;
use crate::shell::{Place, Shell, between, direction};
use glam::Vec3;

/// Rings between whorl and hairline, those of them that there are, and clumps of the longest ring.
const RINGS: u32 = 10;
const FIRST_RING: u32 = 5;
const RING_CLUMPS: u32 = 12;
/// Length of a ring's clump in shares of its ring: ends are thin, so each overlaps the next by two thirds.
const RING_LENGTH: f32 = 3.0;
/// Radius of a ring's clump in distances from ring to ring.
const RING_SPREAD: f32 = 1.35;
/// Clumps of the cap. They begin beyond the whorl and end between it and the hairline, in shares of that
/// way, and are as wide as they lie apart in the middle of it.
const CAP_CLUMPS: u32 = 22;
const CAP_START: f32 = -0.12;
const CAP_END: f32 = 0.85;
const CAP_WIDEST: f32 = 0.5;
/// Radius of a cap's clump in distances from one to the next where it is widest.
const CAP_SPREAD: f32 = 0.9;
/// The broad coat: where its clumps along the hairline lie, in shares of the way from the whorl, and their radius in head heights;
/// where those from the whorl end, where they are widest, and how they overlap there.
const BORDER_SHARE: f32 = 0.9;
const BORDER_RADIUS: f32 = 0.095;
const BROAD_END: f32 = 1.0;
const BROAD_WIDEST: f32 = 0.6;
const BROAD_SPREAD: f32 = 1.02;
/// Points of a clump.
const POINTS: u32 = 9;
/// How deep the middle line lies below the skin, in radii: discs stand out of the head's outline, and a
/// coat should not. Flat ones that turn away stand out by less: any deeper and the scalp shows over them.
const DEPTH: f32 = 0.35;

/// The clumps of the undercoat: points and size (1/300 head heights). The cap stands `cap` head heights
/// above the skin at the whorl, less and less towards the hairline.
///
/// `count` broad clumps, most of them from the whorl to the hairline, the others along it; or rings of narrow ones if it is 0.
pub(super) fn undercoat(
    scalp: &Scalp,
    cap: f32,
    count: u32,
    shell: &Shell,
) -> Vec<(Vec<Vec3>, f32)> {
    let coat = Coat { scalp, cap, shell };
    let mut clumps = Vec::new();
    if count > 0 {
        let border = (count / 3).max(3);
        coat.border(border, &mut clumps);
        let locks = count.saturating_sub(border).max(3);
        let turns = (0..locks).map(|lock| lock as f32 / locks as f32);
        clumps.extend(turns.map(|turn| coat.broad_lock(360.0 * turn, 360.0 / locks as f32)));
        return clumps;
    }
    for ring in FIRST_RING..RINGS {
        coat.ring(ring, &mut clumps);
    }
    let turns = (0..CAP_CLUMPS).map(|clump| clump as f32 / CAP_CLUMPS as f32);
    clumps.extend(turns.map(|turn| coat.lock(360.0 * turn)));
    clumps
}

struct Coat<'a> {
    scalp: &'a Scalp,
    cap: f32,
    shell: &'a Shell,
}

impl Coat<'_> {
    /// Clumps along the hairline rather than across it, so that the lowest ring is the hairline.
    fn ring(&self, ring: u32, clumps: &mut Vec<(Vec<Vec3>, f32)>) {
        let share = (ring as f32 + 0.5) / RINGS as f32;
        let next = share + 1.0 / RINGS as f32;
        let count = (RING_CLUMPS * (ring + 1)).div_ceil(RINGS).max(3);
        for clump in 0..count {
            let first = (clump as f32 + 0.5 * (ring % 2) as f32) / count as f32;
            let longitude = |t: f32| 360.0 * (first + RING_LENGTH * t / count as f32);
            // The rings are widest apart in the middle of the clump or near it.
            let radius = RING_SPREAD * self.distance([share, next].map(|s| (s, longitude(0.5))));
            let point = |t: f32| self.point(share, longitude(t), radius);
            clumps.push((even_points(point), 300.0 * radius));
        }
    }

    /// A clump of the cap, towards a longitude (degrees).
    fn lock(&self, longitude: f32) -> (Vec<Vec3>, f32) {
        let next = longitude + 360.0 / CAP_CLUMPS as f32;
        let neighbours = [longitude, next].map(|longitude| (CAP_WIDEST, longitude));
        let radius = CAP_SPREAD * self.distance(neighbours);
        let share = |t: f32| CAP_START + (CAP_END - CAP_START) * t;
        let points = even_points(|t| {
            if share(t) < 0.0 {
                self.point(-share(t), longitude + 180.0, radius)
            } else {
                self.point(share(t), longitude, radius)
            }
        });
        (points, 300.0 * radius)
    }

    /// Broad clumps along the hairline.
    fn border(&self, count: u32, clumps: &mut Vec<(Vec<Vec3>, f32)>) {
        for clump in 0..count {
            let first = clump as f32 / count as f32;
            let longitude = |t: f32| 360.0 * (first + RING_LENGTH * t / count as f32);
            let radius = BORDER_RADIUS;
            let point = |t: f32| self.point(BORDER_SHARE, longitude(t), radius);
            clumps.push((even_points(point), 300.0 * radius));
        }
    }

    /// A broad clump from beyond the whorl to the hairline, towards a longitude; neighbours are `apart` degrees away.
    fn broad_lock(&self, longitude: f32, apart: f32) -> (Vec<Vec3>, f32) {
        let neighbours = [longitude, longitude + apart].map(|longitude| (BROAD_WIDEST, longitude));
        let radius = BROAD_SPREAD * self.distance(neighbours);
        let share = |t: f32| CAP_START + (BROAD_END - CAP_START) * t;
        let points = even_points(|t| {
            if share(t) < 0.0 {
                self.point(-share(t), longitude + 180.0, radius)
            } else {
                self.point(share(t), longitude, radius)
            }
        });
        (points, 300.0 * radius)
    }

    /// The distance between two places (share of the way from the whorl to the hairline, longitude), in
    /// head heights.
    fn distance(&self, places: [(f32, f32); 2]) -> f32 {
        let [a, b] = places
            .map(|(share, longitude)| self.shell.above(self.direction(share, longitude), 0.0));
        (b - a).length() / self.shell.height()
    }

    /// A point of a clump of that radius (head heights).
    fn point(&self, share: f32, longitude: f32, radius: f32) -> Vec3 {
        let lift = self.cap * (1.0 - share * share) - DEPTH * radius;
        self.shell.above(self.direction(share, longitude), lift)
    }

    /// The direction at `share` of the way from the whorl to the hairline at a longitude (degrees).
    fn direction(&self, share: f32, longitude: f32) -> Vec3 {
        let hairline = direction(Place {
            longitude,
            latitude: self.scalp.hairline_at(longitude),
        });
        between(direction(self.scalp.whorl), hairline, share)
    }
}

fn even_points(point: impl Fn(f32) -> Vec3) -> Vec<Vec3> {
    let places = (0..POINTS).map(|i| i as f32 / (POINTS - 1) as f32);
    places.map(point).collect()
}
