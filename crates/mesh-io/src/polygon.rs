//! Polygons cut into triangles.
//!
//! Code of our own: what there is leaves out corners in the middle of a straight side, which are other faces' corners too, and takes
//! the square or the cube of their number on hostile polygons.

use std::collections::VecDeque;
use std::ops::Range;

use glam::{DVec2, DVec3};

/// How many corners are looked at for each one before the rest becomes a fan, so that no polygon takes the square of its number: those
/// whose sides don't cross need fewer, up to a hundred thousand corners.
const MOST_LOOKS: usize = 200;

/// The sine below which a corner is in the middle of a straight side, but for rounding: it is part of other ears, if there are any.
const NEARLY_STRAIGHT: f64 = 1e-5;

/// The triangles with an area of a polygon with these corners, as indices of corners, which go round as the polygon does. As many as it
/// has corners but two, where none is without an area.
///
/// What is right is told on the polygon's plane, by Newell's normal. A fan around the first corner stays one where none of its triangles
/// is turned over, as of all that is convex; else one ear after the other is cut off. Of a polygon without an area, or that crosses
/// itself, no triangles are right: what is left when there is no ear becomes a fan.
pub(crate) fn triangles(corners: &[DVec3]) -> Vec<[usize; 3]> {
    let area = |[a, b, c]: [usize; 3]| (corners[b] - corners[a]).cross(corners[c] - corners[a]);
    let fan = || (2..corners.len()).map(|corner| [0, corner - 1, corner]);
    let normal: DVec3 = fan().map(area).sum();
    let is_turned_over = |triangle| area(triangle).dot(normal) < 0.0;
    let mut triangles: Vec<_> = match normal.try_normalize() {
        Some(normal) if fan().any(is_turned_over) => {
            let (x, y) = normal.any_orthonormal_pair();
            let flat = corners.iter().map(|corner| corner - corners[0]);
            Ring::new(flat.map(|p| DVec2::new(p.dot(x), p.dot(y))).collect()).cut()
        }
        _ => fan().collect(),
    };
    triangles.retain(|triangle| area(*triangle) != DVec3::ZERO);
    triangles
}

/// What is left of a polygon on its plane while ears are cut off: corners that turn left and have nothing of the polygon in their
/// triangle.
struct Ring {
    places: Vec<DVec2>,
    before: Vec<usize>,
    after: Vec<usize>,
    is_cut: Vec<bool>,
    /// The corners that don't turn left, as a tree: the middle one parts those before it from those behind it, and these are parted so
    /// again. No other corner is ever in an ear alone.
    hollow: Vec<Hollow>,
    looks_left: usize,
}

#[derive(Clone, Copy)]
struct Hollow {
    corner: usize,
    place: DVec2,
    /// The box around all of the tree's part that it parts.
    bounds: [DVec2; 2],
}

impl Ring {
    fn new(places: Vec<DVec2>) -> Self {
        let count = places.len();
        let mut ring = Self {
            before: (0..count).map(|i| (i + count - 1) % count).collect(),
            after: (0..count).map(|i| (i + 1) % count).collect(),
            is_cut: vec![false; count],
            hollow: Vec::new(),
            looks_left: count.saturating_mul(MOST_LOOKS),
            places,
        };
        let hollow = (0..count).filter(|corner| ring.is_hollow(*corner));
        let unparted = |corner: usize| {
            let place = ring.places[corner];
            let bounds = [place; 2];
            Hollow {
                corner,
                place,
                bounds,
            }
        };
        let mut hollow: Vec<_> = hollow.map(unparted).collect();
        make_tree(&mut hollow);
        ring.hollow = hollow;
        ring
    }

    /// The triangles of the whole, some of which may be without an area.
    fn cut(mut self) -> Vec<[usize; 3]> {
        let count = self.places.len();
        let mut triangles = Vec::with_capacity(count - 2);
        for bluntest in [NEARLY_STRAIGHT, 0.0] {
            // Each corner may be an ear once, and again when one beside it was cut off. Then it waits behind all others, or one corner
            // would have the triangles of many.
            let mut waiting: VecDeque<usize> = self.rest().collect();
            let mut waits = vec![1; count];
            while let Some(corner) = waiting.pop_front() {
                waits[corner] -= 1;
                let comes_again = waits[corner] > 0 && !self.goes_back(corner);
                if self.is_cut[corner] || comes_again || !self.is_ear(corner, bluntest) {
                    continue;
                }
                let [before, after] = [self.before[corner], self.after[corner]];
                triangles.push([before, corner, after]);
                self.is_cut[corner] = true;
                self.after[before] = after;
                self.before[after] = before;
                if triangles.len() == count - 2 {
                    return triangles;
                }
                for neighbour in [before, after] {
                    waits[neighbour] += 1;
                    // What has no area is nothing's inside, but may look like it.
                    match self.goes_back(neighbour) {
                        true => waiting.push_front(neighbour),
                        false => waiting.push_back(neighbour),
                    }
                }
            }
        }
        let rest: Vec<usize> = self.rest().collect();
        let pairs = rest.windows(2).skip(1);
        triangles.extend(pairs.map(|pair| [rest[0], pair[0], pair[1]]));
        triangles
    }

    /// The corners that are left.
    fn rest(&self) -> impl Iterator<Item = usize> {
        (0..self.places.len()).filter(|corner| !self.is_cut[*corner])
    }

    /// Whether a corner is an ear, no blunter than this: the sine of how far the polygon turns there.
    fn is_ear(&mut self, corner: usize, bluntest: f64) -> bool {
        let ear = self.around(corner);
        let [a, b, c] = ear;
        let least = bluntest * (a - b).length() * (c - b).length();
        self.goes_back(corner)
            || turn(ear) > least && !self.is_in_the_way(0..self.hollow.len(), ear)
    }

    /// Whether the polygon stands still at a corner or goes back on itself.
    fn goes_back(&self, corner: usize) -> bool {
        let ear = self.around(corner);
        let [a, b, c] = ear;
        turn(ear) == 0.0 && (a - b).dot(c - b) >= 0.0
    }

    /// Whether a corner of a part of the tree is in this ear, or it can't be found out within what may be looked at.
    fn is_in_the_way(&mut self, part: Range<usize>, ear: [DVec2; 3]) -> bool {
        if part.is_empty() {
            return false;
        }
        if self.looks_left == 0 {
            return true;
        }
        self.looks_left -= 1;
        let middle = part.start + part.len() / 2;
        let hollow = self.hollow[middle];
        !misses(ear, hollow.bounds)
            && (self.is_in(hollow, ear)
                || self.is_in_the_way(part.start..middle, ear)
                || self.is_in_the_way(middle + 1..part.end, ear))
    }

    /// Whether what is left of the polygon comes into an ear at this corner.
    fn is_in(&self, Hollow { corner, place, .. }: Hollow, [a, b, c]: [DVec2; 3]) -> bool {
        let is_inside = |[from, to]: [DVec2; 2]| turn([from, to, place]) >= 0.0;
        let is_near =
            place != a && place != c && [[a, b], [b, c], [c, a]].into_iter().all(is_inside);
        if !is_near || self.is_cut[corner] || !self.is_hollow(corner) {
            return false;
        }
        // At the ear's own place it may be of a hole, or touch it from within.
        let [before, _, after] = self.around(corner);
        let is_between = |place| turn([a, b, place]) > 0.0 && turn([b, c, place]) > 0.0;
        place != b || is_between(before) || is_between(after)
    }

    /// Whether a corner doesn't turn left.
    fn is_hollow(&self, corner: usize) -> bool {
        turn(self.around(corner)) <= 0.0
    }

    /// The places of a corner and of those beside it.
    fn around(&self, corner: usize) -> [DVec2; 3] {
        [self.before[corner], corner, self.after[corner]].map(|corner| self.places[corner])
    }
}

/// Twice a triangle's area, above 0 where it goes round to the left.
fn turn([a, b, c]: [DVec2; 3]) -> f64 {
    (b - a).perp_dot(c - a)
}

/// Whether nothing of a box is in a triangle that goes round to the left: so for all of it beyond one side of either.
fn misses([a, b, c]: [DVec2; 3], [low, high]: [DVec2; 2]) -> bool {
    let is_beyond = |[from, to]: [DVec2; 2]| {
        let inwards = (to - from).perp();
        let innermost = DVec2::select(inwards.cmpgt(DVec2::ZERO), high, low);
        (innermost - from).dot(inwards) < 0.0
    };
    let (least, most) = (a.min(b).min(c), a.max(b).max(c));
    least.cmpgt(high).any()
        || most.cmplt(low).any()
        || [[a, b], [b, c], [c, a]].into_iter().any(is_beyond)
}

/// Orders these so that the middle one parts those before it from those behind it, along the longer side of the box around all, and
/// these in turn.
fn make_tree(part: &mut [Hollow]) {
    let Some(first) = part.first() else {
        return;
    };
    let all = || part.iter().map(|hollow| hollow.place);
    let bounds = [DVec2::min, DVec2::max].map(|further| all().fold(first.place, further));
    let sides = bounds[1] - bounds[0];
    let along = |hollow: &Hollow| match sides.x > sides.y {
        true => hollow.place.x,
        false => hollow.place.y,
    };
    let middle = part.len() / 2;
    let (before, own, behind) =
        part.select_nth_unstable_by(middle, |a, b| along(a).total_cmp(&along(b)));
    own.bounds = bounds;
    make_tree(before);
    make_tree(behind);
}

#[cfg(test)]
#[path = "polygon_tests.rs"]
mod tests;
