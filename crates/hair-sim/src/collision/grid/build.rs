//! The distances of a grid's points from a mesh: exact near its triangles, then passed on, then given their sign.

use glam::DVec3;

use crate::lanes::instructions::Instructions;
use crate::lanes::{Lane, Number, Vec3};
use crate::threads::join;

#[cfg(target_arch = "x86_64")]
use crate::lanes::avx2::Avx2;

/// How many cells around a triangle get exact distances.
const BAND: f64 = 2.0;

/// Layers of points that are worth a task.
const LAYERS: usize = 8;

/// Sweeps along all diagonals, and how often.
const DIAGONALS: usize = 8;
const ROUNDS: usize = 2;

/// A point that knows no triangle yet.
const NONE: u32 = u32::MAX;

/// How it is told what is inside.
#[derive(Clone, Copy)]
pub(super) enum Inside {
    /// Rays cross the mesh an odd number of times.
    Odd,
    /// Rays leave more than they enter.
    Wound,
}

/// Of the six rays from a point along the axes so many say inside where it is.
const INSIDE: u8 = 4;

/// A triangle, made ready to be asked often: its three sides beside each other, the first one twice.
struct Facet {
    from: Vec3,
    along: Vec3,
    /// The squares of the sides' lengths.
    squared: Lane,
    corner: DVec3,
    normal: DVec3,
    /// The normal's; 0 of a triangle without an area.
    length: f64,
    /// Its bounds.
    low: DVec3,
    high: DVec3,
}

impl Facet {
    fn new(&[a, b, c]: &[DVec3; 3]) -> Self {
        let (mut from, mut along) = (Vec3::ZERO, Vec3::ZERO);
        for (lane, [start, end]) in [[a, b], [b, c], [c, a], [a, b]].into_iter().enumerate() {
            from.set(lane, start);
            along.set(lane, end - start);
        }
        let normal = (b - a).cross(c - a);
        Self {
            from,
            along,
            squared: along.length_squared(),
            corner: a,
            normal,
            length: normal.length_squared().sqrt(),
            low: a.min(b).min(c),
            high: a.max(b).max(c),
        }
    }

    /// Its distance from a point (Ericson 2005, 5.1.5: by the regions of Voronoi).
    #[inline(always)]
    fn distance<T: Number>(&self, at: DVec3) -> f64 {
        let (zero, one) = (T::splat(0.0), T::splat(1.0));
        let along = self.along.load::<T>();
        let place = Vec3::all(at) - self.from.load();
        let beside = along.cross(place).dot(Vec3::all(self.normal));
        if self.length > 0.0 && !T::any(beside.less(zero)) {
            return (at - self.corner).dot(self.normal).abs() / self.length;
        }
        let squared = self.squared.load::<T>();
        let t = T::choose(zero.less(squared), place.dot(along) / squared, zero);
        let t = T::choose(t.less(zero), zero, t);
        let t = T::choose(one.less(t), one, t);
        let sides = (place - along.scale(t)).length_squared().store();
        sides[0].min(sides[1]).min(sides[2]).sqrt()
    }
}

/// The points of a regular grid.
pub(super) struct Points {
    pub origin: DVec3,
    pub cell: f64,
    pub size: [usize; 3],
}

impl Points {
    /// Their distances from a mesh, negative inside.
    pub(super) fn distances(&self, triangles: &[[DVec3; 3]], inside: Inside) -> Vec<f32> {
        let mut values = match Instructions::best() {
            Instructions::Compiled => self.lengths::<Lane>(triangles),
            #[cfg(target_arch = "x86_64")]
            Instructions::Avx2 => self.lengths::<Avx2>(triangles),
        };
        self.sign(inside, triangles, &mut values);
        values
    }

    /// The same without their signs.
    fn lengths<T: Number>(&self, triangles: &[[DVec3; 3]]) -> Vec<f32> {
        let facets: Vec<Facet> = triangles.iter().map(Facet::new).collect();
        let [nx, ny, nz] = self.size;
        let mut values = vec![f32::MAX; nx * ny * nz];
        let mut nearest = vec![NONE; nx * ny * nz];
        self.near::<T>(&facets, 0, (&mut values, &mut nearest));
        self.spread::<T>(&facets, (&mut values, &mut nearest));
        values
    }

    fn index(&self, x: usize, y: usize, z: usize) -> usize {
        (z * self.size[1] + y) * self.size[0] + x
    }

    #[inline(always)]
    fn place(&self, x: usize, y: usize, z: usize) -> DVec3 {
        self.origin + DVec3::new(x as f64, y as f64, z as f64) * self.cell
    }

    /// Exact distances around every triangle, of layers of points from the `first` on.
    fn near<T: Number>(
        &self,
        facets: &[Facet],
        first: usize,
        (values, nearest): (&mut [f32], &mut [u32]),
    ) {
        let of_layer = self.size[0] * self.size[1];
        let layers = values.len() / of_layer;
        if layers > LAYERS {
            let half = layers / 2;
            let (values, later_values) = values.split_at_mut(half * of_layer);
            let (nearest, later_nearest) = nearest.split_at_mut(half * of_layer);
            join(
                || self.near::<T>(facets, first, (values, nearest)),
                || self.near::<T>(facets, first + half, (later_values, later_nearest)),
            );
            return;
        }
        T::run(
            #[inline(always)]
            || {
                for (number, facet) in (0..).zip(facets) {
                    let from = (facet.low - self.origin) / self.cell - BAND;
                    let to = (facet.high - self.origin) / self.cell + BAND;
                    let from = from.max(DVec3::ZERO);
                    let range = |from: f64, to: f64, size: usize| {
                        from as usize..(to as usize).min(size - 1) + 1
                    };
                    let rows = range(from.y, to.y, self.size[1]);
                    let columns = range(from.x, to.x, self.size[0]);
                    let own = range(from.z, to.z, self.size[2]);
                    for z in own.start.max(first)..own.end.min(first + layers) {
                        for y in rows.clone() {
                            let row = self.index(0, y, z - first);
                            for x in columns.clone() {
                                let distance = facet.distance::<T>(self.place(x, y, z)) as f32;
                                if distance < values[row + x] {
                                    values[row + x] = distance;
                                    nearest[row + x] = number;
                                }
                            }
                        }
                    }
                }
            },
        );
    }

    /// Passes nearest triangles on, in sweeps along all diagonals (Zhao 2005's order).
    fn spread<T: Number>(&self, facets: &[Facet], (values, nearest): (&mut [f32], &mut [u32])) {
        // By which sweep points last changed, from 2 on; 1 is before all of them. What has not changed since a point was last asked for its
        // triangle in the same direction has nothing to offer.
        let mut changed: Vec<u8> = nearest.iter().map(|n| u8::from(*n != NONE)).collect();
        let of_row = |row: &[u8]| row.iter().copied().fold(0, u8::max);
        let rows = changed.chunks(self.size[0]).map(of_row);
        let mut rows: Vec<u8> = rows.collect();
        for sweep in 0..ROUNDS * DIAGONALS {
            let number = |sweep: usize| sweep as u8 + 2;
            let is_same = |bit: usize, other: usize| (sweep ^ other) & bit == 0;
            let asked = [1, 2, 4].map(|bit| {
                let before = (0..sweep).rev().find(|other| is_same(bit, *other));
                before.map_or(0, number)
            });
            let sweep = Sweep {
                points: self,
                facets,
                diagonal: sweep % DIAGONALS,
                number: number(sweep),
                asked,
            };
            T::run(
                #[inline(always)]
                || sweep.run::<T>((values, nearest), (&mut changed, &mut rows)),
            );
        }
    }

    /// Negative where most rays say inside.
    fn sign(&self, inside: Inside, triangles: &[[DVec3; 3]], values: &mut [f32]) {
        let mut votes = vec![0_u8; values.len()];
        for axis in 0..3 {
            self.vote(inside, triangles, axis, &mut votes);
        }
        for (value, votes) in values.iter_mut().zip(votes) {
            if votes >= INSIDE {
                *value = -*value;
            }
        }
    }

    fn vote(&self, inside: Inside, triangles: &[[DVec3; 3]], axis: usize, votes: &mut [u8]) {
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        let size = self.size;
        // Rays a little off the grid, so that they meet no edge of a mesh that lies on it.
        let shift = 1.1e-4 * self.cell;
        let mut crossings: Vec<Vec<(f64, i32)>> = vec![Vec::new(); size[u] * size[v]];
        for corners in triangles {
            let p = corners.map(|c| c - self.origin);
            let low = |k: usize| p[0][k].min(p[1][k]).min(p[2][k]) / self.cell;
            let high = |k: usize| p[0][k].max(p[1][k]).max(p[2][k]) / self.cell;
            for j in (low(v).max(0.0) as usize)..=(high(v) as usize).min(size[v] - 1) {
                for i in (low(u).max(0.0) as usize)..=(high(u) as usize).min(size[u] - 1) {
                    let a = i as f64 * self.cell + shift;
                    let b = j as f64 * self.cell + 1.7 * shift;
                    if let Some(crossing) = crossing(p, axis, u, v, a, b) {
                        crossings[j * size[u] + i].push(crossing);
                    }
                }
            }
        }
        for j in 0..size[v] {
            for i in 0..size[u] {
                let line = &mut crossings[j * size[u] + i];
                line.sort_by(|a, b| a.0.total_cmp(&b.0));
                let whole: i32 = line.iter().map(|crossing| crossing.1).sum();
                let (mut passed, mut within) = (0, 0);
                for k in 0..size[axis] {
                    let at = k as f64 * self.cell;
                    while let Some((_, enters)) = line.get(passed).filter(|(d, _)| *d < at) {
                        passed += 1;
                        within += enters;
                    }
                    let own = match inside {
                        Inside::Odd => 2 * (passed % 2) as u8,
                        // Those behind it, seen from the other side, it would leave as often as it enters.
                        Inside::Wound => u8::from(within > 0) + u8::from(within > whole),
                    };
                    let mut cell = [0; 3];
                    (cell[axis], cell[u], cell[v]) = (k, i, j);
                    votes[self.index(cell[0], cell[1], cell[2])] += own;
                }
            }
        }
    }
}

/// Points one after the other, each of which is offered the triangles of those before it.
struct Sweep<'a> {
    points: &'a Points,
    facets: &'a [Facet],
    /// Bits of the axes along which it goes down.
    diagonal: usize,
    number: u8,
    /// Which sweep last asked along each axis in this direction.
    asked: [u8; 3],
}

impl Sweep<'_> {
    #[inline(always)]
    fn is_down(&self, axis: usize) -> bool {
        self.diagonal >> axis & 1 == 1
    }

    /// The place of a number in the order along an axis.
    #[inline(always)]
    fn order(&self, axis: usize, i: usize) -> usize {
        match self.is_down(axis) {
            true => self.points.size[axis] - 1 - i,
            false => i,
        }
    }

    /// The one before that along an axis.
    #[inline(always)]
    fn before(&self, axis: usize, i: usize) -> Option<usize> {
        match self.is_down(axis) {
            true => Some(i + 1).filter(|&i| i < self.points.size[axis]),
            false => i.checked_sub(1),
        }
    }

    #[inline(always)]
    fn run<T: Number>(
        &self,
        (values, nearest): (&mut [f32], &mut [u32]),
        (changed, rows): (&mut [u8], &mut [u8]),
    ) {
        let [nx, ny, nz] = self.points.size;
        let mut asks = vec![0; nx];
        // To the point before along each axis.
        let steps = [1, nx, nx * ny].map(|step| step as isize);
        let steps: [isize; 3] = std::array::from_fn(|axis| match self.is_down(axis) {
            true => steps[axis],
            false => -steps[axis],
        });
        for z in (0..nz).map(|k| self.order(2, k)) {
            for y in (0..ny).map(|j| self.order(1, j)) {
                let row = z * ny + y;
                let before = [
                    Some(row),
                    self.before(1, y).map(|y| z * ny + y),
                    self.before(2, z).map(|z| z * ny + y),
                ];
                let has_changed =
                    |axis: &usize| before[*axis].is_some_and(|row| rows[row] > self.asked[*axis]);
                if !(0..3).any(|axis| has_changed(&axis)) {
                    continue;
                }
                asks.fill(0);
                for axis in (0..3).filter(has_changed) {
                    let from = before[axis].map_or(0, |row| row * nx);
                    self.ask(axis, &changed[from..from + nx], &mut asks);
                }
                let mut last_has_changed = false;
                for x in (0..nx).map(|i| self.order(0, i)) {
                    let asks = asks[x] | u8::from(last_has_changed);
                    last_has_changed = false;
                    if asks == 0 {
                        continue;
                    }
                    let own = row * nx + x;
                    for axis in 0..3 {
                        if asks >> axis & 1 == 0 {
                            continue;
                        }
                        let triangle = nearest[own.wrapping_add_signed(steps[axis])];
                        if triangle == nearest[own] {
                            continue;
                        }
                        let at = self.points.place(x, y, z);
                        let distance = self.facets[triangle as usize].distance::<T>(at) as f32;
                        if distance < values[own] {
                            (values[own], nearest[own]) = (distance, triangle);
                            (changed[own], rows[row]) = (self.number, self.number);
                            last_has_changed = true;
                        }
                    }
                }
            }
        }
    }

    /// Marks those points of a row, by the axis' bit, before which along that axis is one that has changed since it was asked; `changed` is of the row
    /// that these lie in.
    #[inline(always)]
    fn ask(&self, axis: usize, changed: &[u8], asks: &mut [u8]) {
        let count = asks.len() - usize::from(axis == 0);
        // Along the row it's the neighbour on one side or the other.
        let [to, from] = match (axis, self.is_down(0)) {
            (0, false) => [1, 0],
            (0, true) => [0, 1],
            _ => [0, 0],
        };
        let asked = self.asked[axis];
        let changed = &changed[from..from + count];
        for (ask, changed) in asks[to..to + count].iter_mut().zip(changed) {
            *ask |= u8::from(*changed > asked) << axis;
        }
    }
}

/// Where a line along `axis` through (a, b) of the other two crosses a triangle, and whether it enters there, 1, or leaves, -1.
fn crossing(p: [DVec3; 3], axis: usize, u: usize, v: usize, a: f64, b: f64) -> Option<(f64, i32)> {
    let area = |q: DVec3, r: DVec3| (q[u] - a) * (r[v] - b) - (q[v] - b) * (r[u] - a);
    let w = [area(p[1], p[2]), area(p[2], p[0]), area(p[0], p[1])];
    let (enters, leaves) = (w.iter().all(|&w| w < 0.0), w.iter().all(|&w| w > 0.0));
    let sum = w[0] + w[1] + w[2];
    ((enters || leaves) && sum != 0.0).then(|| {
        let depth = (w[0] * p[0][axis] + w[1] * p[1][axis] + w[2] * p[2][axis]) / sum;
        (depth, if enters { 1 } else { -1 })
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Ericson's, side by side.
    fn distance_to(p: DVec3, &[a, b, c]: &[DVec3; 3]) -> f64 {
        let edge = |from: DVec3, to: DVec3| {
            let along = to - from;
            let squared = along.length_squared();
            let t = match squared > 0.0 {
                true => ((p - from).dot(along) / squared).clamp(0.0, 1.0),
                false => 0.0,
            };
            (p - from - along * t).length_squared()
        };
        let normal = (b - a).cross(c - a);
        let beside = |from: DVec3, to: DVec3| (to - from).cross(p - from).dot(normal) >= 0.0;
        let squared = normal.length_squared();
        if squared > 0.0 && beside(a, b) && beside(b, c) && beside(c, a) {
            return (p - a).dot(normal).abs() / squared.sqrt();
        }
        edge(a, b).min(edge(b, c)).min(edge(c, a)).sqrt()
    }

    /// As [`Points::lengths`], but every point asks all its neighbours in every sweep.
    fn by_definition(points: &Points, triangles: &[[DVec3; 3]]) -> Vec<f32> {
        let [nx, ny, nz] = points.size;
        let mut values = vec![f32::MAX; nx * ny * nz];
        let mut nearest = vec![NONE; values.len()];
        let places = || (0..nz).flat_map(move |z| (0..ny).map(move |y| (y, z)));
        let places = || places().flat_map(move |(y, z)| (0..nx).map(move |x| [x, y, z]));
        for (number, triangle) in triangles.iter().enumerate() {
            let [a, b, c] = *triangle;
            let low = (a.min(b).min(c) - points.origin) / points.cell - BAND;
            let high = (a.max(b).max(c) - points.origin) / points.cell + BAND;
            for (i, [x, y, z]) in places().enumerate() {
                let place = DVec3::new(x as f64, y as f64, z as f64);
                if place.cmpge(low.max(DVec3::ZERO).floor()).all()
                    && place.cmple(high.floor()).all()
                {
                    let distance = distance_to(points.place(x, y, z), triangle) as f32;
                    if distance < values[i] {
                        (values[i], nearest[i]) = (distance, number as u32);
                    }
                }
            }
        }
        for sweep in 0..ROUNDS * DIAGONALS {
            let is_down = |axis: usize| sweep >> axis & 1 == 1;
            let order = |axis: usize, i: usize| match is_down(axis) {
                false => i,
                true => points.size[axis] - 1 - i,
            };
            for place in places() {
                let at: [usize; 3] = std::array::from_fn(|axis| order(axis, place[axis]));
                let own = points.index(at[0], at[1], at[2]);
                for axis in (0..3).filter(|&axis| place[axis] > 0) {
                    let mut other = place;
                    other[axis] -= 1;
                    let [x, y, z] = std::array::from_fn(|axis| order(axis, other[axis]));
                    let triangle = nearest[points.index(x, y, z)];
                    if triangle != NONE {
                        let place = points.place(at[0], at[1], at[2]);
                        let distance = distance_to(place, &triangles[triangle as usize]) as f32;
                        if distance < values[own] {
                            (values[own], nearest[own]) = (distance, triangle);
                        }
                    }
                }
            }
        }
        values
    }

    fn triangle() -> impl Strategy<Value = [DVec3; 3]> {
        // Corners of meshes are in single precision.
        let single = |of: [f32; 3]| DVec3::from_array(of.map(f64::from));
        let place = move || prop::array::uniform3(0.02..0.2_f32).prop_map(single);
        let flat = (place(), place()).prop_map(|(a, b)| [a, b, a.lerp(b, 0.5)]);
        prop_oneof![
            4 => prop::array::uniform3(place()),
            1 => flat,
            1 => place().prop_map(|a| [a; 3]),
        ]
    }

    proptest! {
        /// Triangles prepared, points that ask nothing and layers side by side change no bit.
        #[test]
        fn lengths_are_those_of_the_definition(
            triangles in prop::collection::vec(triangle(), 1..12),
            size in prop::array::uniform3(2..24_usize),
            cell in 0.008..0.03_f64,
        ) {
            let points = Points { origin: DVec3::ZERO, cell, size };
            let expected = by_definition(&points, &triangles);
            prop_assert_eq!(&points.lengths::<Lane>(&triangles), &expected);
            #[cfg(target_arch = "x86_64")]
            if Instructions::best() == Instructions::Avx2 {
                prop_assert_eq!(&points.lengths::<Avx2>(&triangles), &expected);
            }
        }
    }
}
