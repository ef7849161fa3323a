//! An island as a surface, and distances on it.

use super::MeshHair;
use super::islands::{PlaceBits, key};
use super::section::Line;
use glam::DVec3;
use std::cmp::Reverse;
use std::collections::{BinaryHeap, HashMap, HashSet};

/// How far along a line a place may come to lie from where it was before, as a share of the line: a curl's next turn is farther.
const WINDOW: f64 = 0.12;
/// How far levels of distances from a corner of a ribbon's end are off at its other corner, in half widths, and a little more.
const SLANT: f64 = 2.2;

/// An island whose corners at one place are one.
pub(super) struct Surface {
    /// In metres, finite.
    pub places: Vec<DVec3>,
    pub triangles: Vec<[usize; 3]>,
    /// One a place, or none.
    pub depths: Vec<f32>,
    /// The places where it was cut off triangles that are no hair, or another group's.
    pub rim: Vec<usize>,
    /// The places beside each, with their distances in metres.
    beside: Vec<Vec<(usize, f64)>>,
}

impl Surface {
    /// The surface of these triangles, all of which have finite corners; `borders` are places that islands share.
    pub fn new(hair: &MeshHair, triangles: &[usize], borders: &HashSet<PlaceBits>) -> Self {
        let mut number = HashMap::new();
        let mut surface = Self {
            places: Vec::new(),
            triangles: Vec::new(),
            depths: Vec::new(),
            rim: Vec::new(),
            beside: Vec::new(),
        };
        for &triangle in triangles {
            let corners = hair.triangles[triangle].map(|corner| {
                let corner = corner as usize;
                *number
                    .entry(key(hair.positions[corner]))
                    .or_insert_with(|| {
                        surface.places.push(hair.positions[corner].as_dvec3());
                        surface.depths.extend(hair.depths.get(corner));
                        surface.places.len() - 1
                    })
            });
            surface.triangles.push(corners);
        }
        let mut beside = vec![HashSet::new(); surface.places.len()];
        for &[a, b, c] in &surface.triangles {
            for (from, to) in [(a, b), (b, c), (c, a)] {
                beside[from].insert(to);
                beside[to].insert(from);
            }
        }
        let sorted = |(own, others): (usize, HashSet<usize>)| {
            let mut others: Vec<usize> = others.into_iter().collect();
            others.sort_unstable();
            let far = |other| (other, surface.places[own].distance(surface.places[other]));
            others.into_iter().map(far).collect()
        };
        surface.beside = beside.into_iter().enumerate().map(sorted).collect();

        let rim = number.iter().filter(|(place, _)| borders.contains(*place));
        surface.rim = rim.map(|(_, number)| *number).collect();
        surface.rim.sort_unstable();
        surface
    }

    /// The places of each triangle's corners.
    pub fn corners(&self) -> impl Iterator<Item = [DVec3; 3]> {
        let places = &self.places;
        self.triangles
            .iter()
            .map(|t| t.map(|corner| places[corner]))
    }

    /// How far each place is from the nearest of `from` along edges, in metres (Dijkstra).
    pub fn distances(&self, from: &[usize]) -> Vec<f64> {
        let mut distances = vec![f64::INFINITY; self.places.len()];
        // Distances are 0 and more, whose bits are in their order.
        let mut next = BinaryHeap::new();
        for &place in from {
            distances[place] = 0.0;
            next.push(Reverse((0.0_f64.to_bits(), place)));
        }
        while let Some(Reverse((bits, place))) = next.pop() {
            let so_far = f64::from_bits(bits);
            if so_far > distances[place] {
                continue;
            }
            for &(other, far) in &self.beside[place] {
                let through = so_far + far;
                if through < distances[other] {
                    distances[other] = through;
                    next.push(Reverse((through.to_bits(), other)));
                }
            }
        }
        distances
    }

    /// The first of the farthest places.
    pub fn farthest(&self, distances: &[f64]) -> usize {
        let mut found = 0;
        for (place, distance) in distances.iter().enumerate() {
            if distance.is_finite() && *distance > distances[found] {
                found = place;
            }
        }
        found
    }
}

/// How far along a line each place is, in metres, before its first point below 0; `along` tells how far it was along another one.
/// Nothing where the line has no length.
pub(super) fn along_line(places: &[DVec3], along: &[f64], line: &Line) -> Option<Vec<f64>> {
    let ([low, high], radius, line) = (line.span, line.radius, &line.points);
    let mut starts = vec![0.0];
    for link in line.windows(2) {
        starts.push(starts[starts.len() - 1] + link[0].distance(link[1]));
    }
    let length = starts[starts.len() - 1];
    let last = line.len().checked_sub(2)?;
    if !(length > 0.0 && high > low) {
        return None;
    }
    let one = |(place, before): (&DVec3, &f64)| {
        let expected = (before - low) / (high - low) * length;
        let reach = WINDOW * length + SLANT * radius;
        let mut best = (f64::INFINITY, expected);
        for (link, ends) in line.windows(2).enumerate() {
            if starts[link + 1] < expected - reach || starts[link] > expected + reach {
                continue;
            }
            let way = ends[1] - ends[0];
            let Some(unit) = way.try_normalize() else {
                continue;
            };
            let from = if link == 0 { f64::NEG_INFINITY } else { 0.0 };
            let to = if link == last {
                f64::INFINITY
            } else {
                way.length()
            };
            let at = (*place - ends[0]).dot(unit).clamp(from, to);
            let away = place.distance_squared(ends[0] + at * unit);
            if away < best.0 {
                best = (away, starts[link] + at);
            }
        }
        best.1
    };
    Some(places.iter().zip(along).map(one).collect())
}

/// The least and the greatest.
pub(super) fn range(numbers: &[f64]) -> (f64, f64) {
    let start = (f64::INFINITY, f64::NEG_INFINITY);
    numbers.iter().fold(start, |(low, high), &number| {
        (low.min(number), high.max(number))
    })
}
