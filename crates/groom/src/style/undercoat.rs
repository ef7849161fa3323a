//! A coat of flat clumps below all zones, so that no scalp shows between them.

use super::Scalp;
use crate::shell::{Place, Shell, between, direction};
use glam::Vec3;

/// Rings around the whorl, and clumps of the longest ring.
const RINGS: u32 = 10;
const CLUMPS: u32 = 12;
/// Points of a clump, and its length in shares of its ring: ends are thin, so each overlaps the next
/// by two thirds.
const POINTS: u32 = 9;
const LENGTH: f32 = 3.0;
/// How deep the middle line lies below the skin, in radii: discs stand out of the head's outline, and a
/// coat should not.
const DEPTH: f32 = 0.5;
/// Radius of a clump in distances from ring to ring.
const SPREAD: f32 = 1.35;

/// The clumps of the undercoat: points and size (1/300 head heights).
///
/// They run around the head in rings, along the hairline rather than across it, so that the lowest
/// ring is the hairline.
pub(super) fn undercoat(scalp: &Scalp, shell: &Shell) -> Vec<(Vec<Vec3>, f32)> {
    let mut clumps = Vec::new();
    let whorl = direction(scalp.whorl);
    for ring in 0..RINGS {
        let share = (ring as f32 + 0.5) / RINGS as f32;
        let next = share + 1.0 / RINGS as f32;
        let count = (CLUMPS * (ring + 1)).div_ceil(RINGS).max(3);
        for clump in 0..count {
            let first = (clump as f32 + 0.5 * (ring % 2) as f32) / count as f32;
            let longitude = |t: f32| 360.0 * (first + LENGTH * t / count as f32);
            // The rings are widest apart in the middle of the clump or near it.
            let [inner, outer] = [share, next]
                .map(|share| shell.above(ring_direction(scalp, whorl, share, longitude(0.5)), 0.0));
            let radius = SPREAD * (outer - inner).length() / shell.height();
            let point = |i: u32| {
                let t = i as f32 / (POINTS - 1) as f32;
                let way = ring_direction(scalp, whorl, share, longitude(t));
                shell.above(way, -DEPTH * radius)
            };
            clumps.push(((0..POINTS).map(point).collect(), 300.0 * radius));
        }
    }
    clumps
}

/// The direction at `share` of the way from the whorl to the hairline at a longitude (degrees).
fn ring_direction(scalp: &Scalp, whorl: Vec3, share: f32, longitude: f32) -> Vec3 {
    let hairline = direction(Place {
        longitude,
        latitude: scalp.hairline_at(longitude),
    });
    between(whorl, hairline, share)
}
