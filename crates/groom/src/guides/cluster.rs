//! Points to groups of near ones.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use crate::nearest::{Nearest, distance_squared};

/// How often points go over to the nearest mean: twenty rounds would lower errors by 1 % more.
const ROUNDS: usize = 6;

/// The group, below `n`, of every point: `n` groups, 1 to as many as points, none of them empty, with
/// a small sum of squared distances from the points to their group's mean.
///
/// Lloyd's rounds (1982, "Least squares quantization in PCM") from the cells of [`split`]. The same
/// points in the same order give the same groups; ties go to the lower index.
pub(super) fn group<const D: usize>(points: &[[f64; D]], n: usize) -> Vec<usize> {
    let mut group_of = split(points, n);
    for _ in 0..ROUNDS {
        let means = means(points, &group_of, n);
        if !go_over(points, &means, &mut group_of) {
            break;
        }
    }
    group_of
}

/// The points of every group, the nearest to the group's mean first, the first of equal ones first.
pub(super) fn by_distance_to_mean<const D: usize>(
    points: &[[f64; D]],
    group_of: &[usize],
    n: usize,
) -> Vec<Vec<usize>> {
    let mut groups = vec![Vec::new(); n];
    for (i, &group) in group_of.iter().enumerate() {
        groups[group].push(i);
    }
    for (group, mean) in groups.iter_mut().zip(means(points, group_of, n)) {
        let distance = |i: usize| distance_squared(&points[i], &mean);
        group.sort_by(|&a, &b| distance(a).total_cmp(&distance(b)));
    }
    groups
}

/// Moves every point to the group of the nearest of these points, one of every group, which stay.
pub(super) fn join_nearest<const D: usize>(
    points: &[[f64; D]],
    chosen: &[usize],
    group_of: &mut [usize],
) {
    let middles: Vec<[f64; D]> = chosen.iter().map(|&i| points[i]).collect();
    go_over(points, &middles, group_of);
    // Where two are at one place, one of them has gone over to the other.
    for (group, &i) in chosen.iter().enumerate() {
        group_of[i] = group;
    }
}

/// Moves every point to the group with the nearest middle; whether any has moved. A group keeps its
/// last point, so that none is ever empty.
fn go_over<const D: usize>(
    points: &[[f64; D]],
    middles: &[[f64; D]],
    group_of: &mut [usize],
) -> bool {
    let mut counts = vec![0usize; middles.len()];
    group_of.iter().for_each(|&group| counts[group] += 1);
    let tree = Nearest::new(middles.iter().copied());
    let mut found = Vec::with_capacity(2);
    let mut has_moved = false;
    for (point, group) in points.iter().zip(group_of) {
        if counts[*group] == 1 {
            continue;
        }
        found.clear();
        found.push((distance_squared(point, &middles[*group]), *group));
        tree.find(point, 1, &mut found);
        let to = found[0].1;
        if to != *group {
            counts[*group] -= 1;
            counts[to] += 1;
            *group = to;
            has_moved = true;
        }
    }
    has_moved
}

fn means<const D: usize>(points: &[[f64; D]], group_of: &[usize], n: usize) -> Vec<[f64; D]> {
    let mut sums = vec![[0.0; D]; n];
    let mut counts = vec![0usize; n];
    for (point, &group) in points.iter().zip(group_of) {
        add(&mut sums[group], point);
        counts[group] += 1;
    }
    for (sum, &count) in sums.iter_mut().zip(&counts) {
        *sum = sum.map(|x| x / count as f64);
    }
    sums
}

fn add<const D: usize>(sum: &mut [f64; D], point: &[f64; D]) {
    for (sum, x) in sum.iter_mut().zip(point) {
        *sum += x;
    }
}

/// Points that may still be split.
struct Cell {
    /// Ascending.
    members: Vec<usize>,
    /// The sum of squared distances to the mean.
    error: f64,
    /// The axis of the largest variance, and the mean there.
    axis: usize,
    mean: f64,
}

/// The group of every point after splitting all points `n - 1` times: each time the cell with the
/// largest sum of squared distances to its mean, at its mean, across its axis of largest variance.
///
/// Var-Part (Su and Dy 2007, "In search of deterministic methods for initializing k-means and
/// Gaussian mixture clustering"): no chance in it, about N log `n` steps, and after Lloyd's rounds as
/// good as k-means++ on real grooms. Farthest points would start at the strays.
fn split<const D: usize>(points: &[[f64; D]], n: usize) -> Vec<usize> {
    let mut cells = vec![Cell::new(points, (0..points.len()).collect())];
    // Errors are 0 or more: their bits are in the order of their values. Ties go to the older cell.
    let rank = |cells: &[Cell], at: usize| (cells[at].error.to_bits(), Reverse(at));
    let mut largest = BinaryHeap::from([rank(&cells, 0)]);
    while cells.len() < n
        && let Some((_, Reverse(at))) = largest.pop()
    {
        let [low, high] = cells[at].halves(points);
        cells[at] = Cell::new(points, low);
        cells.push(Cell::new(points, high));
        for at in [at, cells.len() - 1] {
            if cells[at].members.len() > 1 {
                largest.push(rank(&cells, at));
            }
        }
    }
    let mut group_of = vec![0; points.len()];
    for (group, cell) in cells.iter().enumerate() {
        cell.members.iter().for_each(|&i| group_of[i] = group);
    }
    group_of
}

impl Cell {
    fn new<const D: usize>(points: &[[f64; D]], members: Vec<usize>) -> Self {
        let mut mean = [0.0; D];
        members.iter().for_each(|&i| add(&mut mean, &points[i]));
        mean = mean.map(|x| x / members.len() as f64);
        let mut errors = [0.0; D];
        for &i in &members {
            let away: [f64; D] = std::array::from_fn(|axis| points[i][axis] - mean[axis]);
            add(&mut errors, &away.map(|x| x * x));
        }
        let wider = |a: usize, b: usize| if errors[b] > errors[a] { b } else { a };
        let axis = (1..D).fold(0, wider);
        Self {
            members,
            error: errors.iter().sum(),
            axis,
            mean: mean[axis],
        }
    }

    /// Two parts of a cell of two members or more, neither of them empty.
    fn halves<const D: usize>(&self, points: &[[f64; D]]) -> [Vec<usize>; 2] {
        let is_low = |&i: &usize| points[i][self.axis] <= self.mean;
        let (low, high): (Vec<_>, Vec<_>) = self.members.iter().partition(|&i| is_low(i));
        if low.is_empty() || high.is_empty() {
            // Points at one place, or so near that their mean falls beside them.
            let (low, high) = self.members.split_at(self.members.len() / 2);
            [low.to_vec(), high.to_vec()]
        } else {
            [low, high]
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// The sum of squared distances to the groups' means.
    fn error(points: &[[f64; 2]], group_of: &[usize], n: usize) -> f64 {
        let means = means(points, group_of, n);
        let away = |(point, &group)| distance_squared(point, &means[group]);
        points.iter().zip(group_of).map(away).sum()
    }

    proptest! {
        #[test]
        fn clouds_far_apart_are_groups(
            clouds in prop::array::uniform3(
                prop::collection::vec(prop::array::uniform2(-1.0f64..1.0), 1..20)),
        ) {
            // Each cloud is twice as far from the last as that is from the one before: a mean falls
            // into none of them.
            let (mut points, mut cloud_of) = (Vec::new(), Vec::new());
            for (k, (cloud, at)) in clouds.iter().zip([0.0, 100.0, 4000.0]).enumerate() {
                points.extend(cloud.iter().map(|p| [p[0] + at, p[1]]));
                cloud_of.extend(cloud.iter().map(|_| k));
            }
            let group_of = group(&points, 3);
            for (i, j) in (0..points.len()).flat_map(|i| (0..i).map(move |j| (i, j))) {
                prop_assert_eq!(group_of[i] == group_of[j], cloud_of[i] == cloud_of[j]);
            }
        }

        #[test]
        fn rounds_make_errors_smaller(
            points in prop::collection::vec(prop::array::uniform2(-1.0f64..1.0), 20..100),
            n in 2usize..10,
        ) {
            let before = error(&points, &split(&points, n), n);
            prop_assert!(error(&points, &group(&points, n), n) <= before * (1.0 + 1e-12));
        }
    }

    #[test]
    fn a_square_of_a_hundred_in_four_is_four_squares() {
        let points: Vec<[f64; 2]> = (0..100)
            .map(|i| [f64::from(i % 10), f64::from(i / 10)])
            .collect();
        let group_of = group(&points, 4);
        let quarter = |i: usize| usize::from(i % 10 < 5) + 2 * usize::from(i / 10 < 5);
        for (i, j) in (0..100).flat_map(|i| (0..100).map(move |j| (i, j))) {
            assert_eq!(group_of[i] == group_of[j], quarter(i) == quarter(j));
        }
        let groups = by_distance_to_mean(&points, &group_of, 4);
        assert_eq!(groups[group_of[0]][0], 22);
    }
}
