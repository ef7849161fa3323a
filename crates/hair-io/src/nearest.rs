//! Nearest points: a k-d tree.

use glam::{DVec3, Vec3};

/// Points ordered so that each half of a range lies on one side of its middle point.
///
/// Answers do not depend on the order of equal distances: ties go to the lower index.
pub struct Nearest {
    /// Positions with their index in the list the tree was made from.
    points: Vec<(DVec3, usize)>,
}

impl Nearest {
    /// A tree of finite points.
    pub fn new(points: impl IntoIterator<Item = Vec3>) -> Self {
        let points = points
            .into_iter()
            .enumerate()
            .map(|(i, p)| (p.as_dvec3(), i));
        let mut points: Vec<_> = points.collect();
        halve(&mut points, 0);
        Self { points }
    }

    /// The `count` points nearest to `from` as (distance, index), nearest first; fewer where there
    /// are fewer.
    #[must_use]
    pub fn find(&self, from: Vec3, count: usize) -> Vec<(f64, usize)> {
        let mut found = Vec::with_capacity(count + 1);
        if count > 0 {
            search(&self.points, 0, from.as_dvec3(), count, &mut found);
        }
        found
    }
}

fn halve(points: &mut [(DVec3, usize)], axis: usize) {
    if points.len() > 1 {
        let middle = points.len() / 2;
        let (low, _, high) = points.select_nth_unstable_by(middle, |a, b| {
            a.0[axis].total_cmp(&b.0[axis]).then(a.1.cmp(&b.1))
        });
        halve(low, (axis + 1) % 3);
        halve(high, (axis + 1) % 3);
    }
}

/// Puts the nearest of `points` into `found`, which is sorted and holds at most `count`.
fn search(
    points: &[(DVec3, usize)],
    axis: usize,
    from: DVec3,
    count: usize,
    found: &mut Vec<(f64, usize)>,
) {
    if points.is_empty() {
        return;
    }
    let middle = points.len() / 2;
    let (point, index) = points[middle];
    let here = (point.distance(from), index);
    let place = found.partition_point(|f| *f < here);
    if place < count {
        found.insert(place, here);
        found.truncate(count);
    }
    let (low, high) = (&points[..middle], &points[middle + 1..]);
    let across = from[axis] - point[axis];
    let (near, far) = if across < 0.0 {
        (low, high)
    } else {
        (high, low)
    };
    let next = (axis + 1) % 3;
    search(near, next, from, count, found);
    // Equal distances are looked at too: a lower index may be there.
    if found.len() < count || across.abs() <= found[found.len() - 1].0 {
        search(far, next, from, count, found);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn finds_what_looking_at_all_points_finds(
            points in prop::collection::vec(prop::array::uniform3(-4i8..4), 0..80),
            from in prop::array::uniform3(-5.0f32..5.0), count in 0usize..8,
        ) {
            let points: Vec<Vec3> = points.iter().map(|p| Vec3::from(p.map(f32::from))).collect();
            let from = Vec3::from(from);
            let distance = |p: &Vec3| p.as_dvec3().distance(from.as_dvec3());
            let mut all: Vec<_> = points.iter().map(distance).zip(0usize..).collect();
            all.sort_by(|a, b| a.partial_cmp(b).unwrap());
            all.truncate(count);
            prop_assert_eq!(Nearest::new(points).find(from, count), all);
        }
    }
}
