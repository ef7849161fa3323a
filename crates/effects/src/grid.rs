//! Points by the cubes that they lie in, so that those near a place are found without asking all.

use glam::Vec3;
use std::ops::RangeInclusive;

/// Points, by cubes of one size: for effects that ask which strands are neighbours.
#[derive(Clone, Debug)]
pub struct Grid {
    /// Edge of a cube, metres.
    edge_m: f32,
    /// Each point's cube and its index, by these.
    points: Vec<(Cube, usize)>,
}

/// A cube's number along each axis.
type Cube = [i32; 3];

impl Grid {
    /// Of points (m) with their indices; `edge_m` is above 0.
    #[must_use]
    pub fn new(points: impl IntoIterator<Item = (usize, Vec3)>, edge_m: f32) -> Self {
        let mut grid = Self {
            edge_m,
            points: Vec::new(),
        };
        grid.points = (points.into_iter())
            .map(|(index, point)| (grid.cube_of(point), index))
            .collect();
        grid.points.sort_unstable();
        grid
    }

    fn cube_of(&self, point: Vec3) -> Cube {
        point.to_array().map(|x| (x / self.edge_m).floor() as i32)
    }

    /// The points of the cube of `point` and of those around it: all that lie no farther than an edge, and some more. In the same order in each run.
    pub fn around(&self, point: Vec3) -> impl Iterator<Item = usize> {
        let center = self.cube_of(point);
        (0..=1).flat_map(move |ring| self.in_ring(center, ring))
    }

    /// The indices of the `number` least distances, the least first, and of equal ones by their indices; of fewer where fewer points have one. A `distance` (m) is at
    /// least as large as how far the point is from `point`.
    pub fn nearest(
        &self,
        point: Vec3,
        number: usize,
        distance: impl Fn(usize) -> Option<f32>,
    ) -> Vec<usize> {
        let center = self.cube_of(point);
        let mut best: Vec<(f32, usize)> = Vec::new();
        let take = |best: &mut Vec<(f32, usize)>, index: usize| {
            let Some(own) = distance(index) else { return };
            let by_distance =
                |other: &(f32, usize)| other.0.total_cmp(&own).then(other.1.cmp(&index)).is_lt();
            let place = best.partition_point(by_distance);
            if place < number {
                best.truncate(number - 1);
                best.insert(place, (own, index));
            }
        };
        for ring in 0.. {
            // More cubes than there are points take longer than all points, and may lie beyond them.
            let side = 2 * ring as usize + 1;
            if side * side * side > 27 + self.points.len() {
                best.clear();
                (self.points.iter()).for_each(|(_, index)| take(&mut best, *index));
                break;
            }
            (self.in_ring(center, ring)).for_each(|index| take(&mut best, index));
            // What lies beyond is at least as far as this.
            let beyond_m = ring as f32 * self.edge_m;
            if number == 0 || (best.get(number - 1)).is_some_and(|(last, _)| *last < beyond_m) {
                break;
            }
        }
        best.into_iter().map(|(_, index)| index).collect()
    }

    /// The points of the cubes that are so many away from a cube, along the axis on which they are the farthest.
    fn in_ring(&self, center: Cube, ring: i32) -> impl Iterator<Item = usize> {
        let rows = (-ring..=ring).flat_map(move |x| (-ring..=ring).map(move |y| (x, y)));
        // Beyond the last cube there is none.
        let rows = rows.filter_map(move |(x, y)| {
            let row = [center[0].checked_add(x)?, center[1].checked_add(y)?];
            Some((row, x.abs() == ring || y.abs() == ring))
        });
        rows.flat_map(move |(row, is_face)| {
            let z = center[2];
            let ends = [z.checked_sub(ring), z.checked_add(ring)];
            // Inside of the ring's faces only its two ends belong to it.
            let stretches = match is_face {
                true => [Some(z.saturating_sub(ring)..=z.saturating_add(ring)), None],
                false => ends.map(|end| end.map(|end| end..=end)),
            };
            let stretches = stretches.into_iter().flatten();
            stretches.flat_map(move |z| self.in_row(row, z))
        })
    }

    /// The points of the cubes that have these numbers along two axes, and along the third one of `z`.
    fn in_row(&self, [x, y]: [i32; 2], z: RangeInclusive<i32>) -> impl Iterator<Item = usize> {
        let first = [x, y, *z.start()];
        let last = [x, y, *z.end()];
        let begin = self.points.partition_point(|(cube, _)| *cube < first);
        self.points[begin..]
            .iter()
            .take_while(move |(cube, _)| *cube <= last)
            .map(|(_, index)| *index)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::wgsl::random_signed;

    fn points(count: usize) -> Vec<Vec3> {
        let number = |i: usize, axis: u32| 0.3 * random_signed(7, 3 * i as u32 + axis);
        (0..count)
            .map(|i| Vec3::new(number(i, 0), number(i, 1), number(i, 2)))
            .collect()
    }

    #[test]
    fn the_nearest_is_that_of_all() {
        let all = points(400);
        for edge_m in [0.01, 0.07, 3.0] {
            let grid = Grid::new(all.iter().copied().enumerate(), edge_m);
            for (k, point) in points(450).into_iter().enumerate() {
                // Every third has no distance.
                let distance = |i: usize| (i % 3 != k % 3).then(|| 1.5 * all[i].distance(point));
                let of_all = (0..all.len()).filter_map(|i| distance(i).map(|own| (own, i)));
                let mut of_all: Vec<(f32, usize)> = of_all.collect();
                of_all.sort_by(|a, b| a.0.total_cmp(&b.0));
                for number in [0, 1, 5, 300] {
                    let first = of_all.iter().take(number).map(|(_, i)| *i);
                    assert_eq!(
                        grid.nearest(point, number, distance),
                        first.collect::<Vec<_>>()
                    );
                }
            }
        }
        // Too far apart for any number of cubes.
        let far = [Vec3::ZERO, Vec3::splat(3e9), Vec3::splat(-1e30)];
        let grid = Grid::new(far.into_iter().enumerate(), 1e-3);
        let others = |i: usize| (i != 1).then(|| far[i].distance(far[1]));
        assert_eq!(grid.nearest(far[1], 1, others), [0]);
        // In the last cube each point is there once.
        let last = (0..60).map(|i| Vec3::splat(3e9 + 1e6 * i as f32));
        let last: Vec<Vec3> = last.collect();
        let grid = Grid::new(last.iter().copied().enumerate(), 1e-3);
        let others = |i: usize| Some(last[i].distance(last[0]));
        assert_eq!(grid.nearest(last[0], 5, others), [0, 1, 2, 3, 4]);
        let none = Grid::new([], 0.1);
        assert!(none.nearest(Vec3::ZERO, 1, |_| Some(0.0)).is_empty());
    }

    #[test]
    fn all_within_an_edge_are_around() {
        let all = points(400);
        let grid = Grid::new(all.iter().copied().enumerate(), 0.1);
        for point in points(50) {
            let around: Vec<usize> = grid.around(point).collect();
            let near = |i: &usize| all[*i].distance(point) <= 0.1;
            assert!((0..all.len()).filter(near).all(|i| around.contains(&i)));
            assert!(around.len() < all.len());
        }
    }
}
