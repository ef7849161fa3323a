//! Choosing guide strands from a dense groom by their roots.

use std::collections::HashSet;

use glam::Vec3;

use crate::nearest::Nearest;

/// How many neighbours [`spacing`] looks at: five of the six that a hexagonal packing has, so that
/// one missing neighbour, at the hairline, doesn't count the next ring.
const NEIGHBOURS: usize = 5;

/// The indices of `n` roots spread evenly over the scalp, ascending: farthest-point sampling
/// (Gonzalez 1985, "Clustering to minimize the maximum intercluster distance"), which leaves gaps
/// at most twice as large as the best choice of `n` would.
///
/// It starts with the root nearest to the roots' mean; ties go to the lowest index, so the same
/// roots give the same guides. `n` of all roots or more keeps all. Takes `n` x `roots.len()` steps.
/// The roots must be finite.
#[must_use]
pub fn spread_evenly(roots: &[Vec3], n: usize) -> Vec<usize> {
    if n >= roots.len() {
        return (0..roots.len()).collect();
    }
    if n == 0 {
        return Vec::new();
    }
    let mean = roots.iter().map(|r| r.as_dvec3()).sum::<glam::DVec3>() / roots.len() as f64;
    let from_mean = roots.iter().map(|r| -r.as_dvec3().distance_squared(mean));
    let mut next = largest(from_mean);

    // The squared distance to the nearest root chosen; below 0: chosen itself.
    let mut gap = vec![f64::INFINITY; roots.len()];
    let mut chosen = Vec::with_capacity(n);
    loop {
        chosen.push(next);
        gap[next] = -1.0;
        if chosen.len() == n {
            chosen.sort_unstable();
            return chosen;
        }
        let from = roots[next].as_dvec3();
        for (gap, root) in gap.iter_mut().zip(roots) {
            *gap = gap.min(root.as_dvec3().distance_squared(from));
        }
        next = largest(gap.iter().copied());
    }
}

/// The index of the largest value, the first of equal ones.
fn largest(values: impl Iterator<Item = f64>) -> usize {
    let mut best = (0, f64::NEG_INFINITY);
    for (index, value) in values.enumerate() {
        if value > best.1 {
            best = (index, value);
        }
    }
    best.0
}

/// The largest gap that a choice of roots leaves: the distance from any root to the nearest chosen
/// one, at its largest, in the roots' units. Infinite when nothing is chosen from some roots.
///
/// # Panics
///
/// When a chosen index is not below `roots.len()`.
#[must_use]
pub fn covering_radius(roots: &[Vec3], chosen: &[usize]) -> f32 {
    let tree = Nearest::new(chosen.iter().map(|&i| roots[i]));
    let gap = |root: &Vec3| tree.find(*root, 1).first().map_or(f64::INFINITY, |f| f.0);
    roots.iter().map(gap).fold(0.0, f64::max) as f32
}

/// Each root's mean distance to its five nearest neighbours (fewer where there are fewer), in the
/// roots' units.
///
/// Roots at the very same place count as one, so the result is above 0, except where a root has no
/// neighbour elsewhere: there it is 0. The roots must be finite.
#[must_use]
pub fn spacing(roots: &[Vec3]) -> Vec<f32> {
    let mut seen = HashSet::new();
    // + 0.0 makes one zero of two.
    let key = |root: &Vec3| root.to_array().map(|x| (x + 0.0).to_bits());
    let places = roots.iter().filter(|root| seen.insert(key(root)));
    let tree = Nearest::new(places.copied());
    let mean = |root: &Vec3| {
        let found = tree.find(*root, NEIGHBOURS + 1);
        let neighbours = found.get(1..).unwrap_or_default();
        let sum: f64 = neighbours.iter().map(|f| f.0).sum();
        (sum / neighbours.len().max(1) as f64).min(f64::from(f32::MAX)) as f32
    };
    roots.iter().map(mean).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn clouds() -> impl Strategy<Value = Vec<Vec3>> {
        prop::collection::vec(prop::array::uniform3(-1.0f32..1.0), 30..200).prop_map(|points| {
            points
                .into_iter()
                .map(|p| Vec3::from(p).normalize_or(Vec3::Y) * 0.1)
                .collect()
        })
    }

    /// Farthest-point sampling from a given start, written as plainly as can be.
    fn from_start(roots: &[Vec3], n: usize, start: usize) -> Vec<usize> {
        let mut chosen = vec![start];
        while chosen.len() < n {
            let gap = |r: &Vec3| {
                chosen
                    .iter()
                    .map(|&c| r.distance(roots[c]))
                    .fold(f32::MAX, f32::min)
            };
            let gaps: Vec<f32> = roots.iter().map(gap).collect();
            chosen.push(
                (0..roots.len())
                    .max_by(|&a, &b| gaps[a].total_cmp(&gaps[b]))
                    .unwrap(),
            );
        }
        chosen
    }

    proptest! {
        #[test]
        fn gaps_are_as_small_as_from_other_starts(roots in clouds(), n in 4usize..24) {
            let chosen = spread_evenly(&roots, n);
            prop_assert_eq!(chosen.len(), n);
            prop_assert!(chosen.is_sorted_by(|a, b| a < b));
            let gap = covering_radius(&roots, &chosen);
            for start in [0, roots.len() / 3, roots.len() / 2, roots.len() - 1] {
                let other = covering_radius(&roots, &from_start(&roots, n, start));
                prop_assert!(gap <= 1.5 * other, "{gap} against {other} from root {start}");
            }
        }

        #[test]
        fn the_covering_radius_is_what_looking_at_all_pairs_gives(roots in clouds(), n in 1usize..9) {
            let chosen = from_start(&roots, n, 0);
            let gap = |r: &Vec3| chosen.iter().map(|&c| r.distance(roots[c])).fold(f32::MAX, f32::min);
            let expected = roots.iter().map(gap).fold(0.0, f32::max);
            prop_assert!((covering_radius(&roots, &chosen) - expected).abs() < 1e-6);
        }

        #[test]
        fn any_count_of_any_roots_is_kept_once(
            places in prop::collection::vec(0u8..4, 0..30), n in 0usize..40,
        ) {
            let roots: Vec<Vec3> = places.iter().map(|&p| Vec3::X * f32::from(p)).collect();
            let chosen = spread_evenly(&roots, n);
            prop_assert_eq!(chosen.len(), n.min(roots.len()));
            prop_assert!(chosen.is_sorted_by(|a, b| a < b));
        }

        #[test]
        fn coincident_roots_do_not_spoil_the_spacing(roots in clouds()) {
            let once = spacing(&roots);
            let twice = spacing(&[roots.clone(), roots.clone()].concat());
            prop_assert!(once.iter().all(|s| *s > 0.0));
            prop_assert_eq!(&twice[..roots.len()], &once[..]);
            prop_assert_eq!(&twice[roots.len()..], &once[..]);
        }
    }

    #[test]
    fn ties_go_to_the_lowest_index() {
        let square = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::X + Vec3::Y];
        assert_eq!(spread_evenly(&square, 2), [0, 3]);
        assert_eq!(spread_evenly(&[Vec3::ONE; 5], 3), [0, 1, 2]);
        assert_eq!(spread_evenly(&square, 9), [0, 1, 2, 3]);
        assert!(covering_radius(&square, &[]).is_infinite());
        assert_eq!(covering_radius(&[], &[]), 0.0);
    }

    #[test]
    fn a_grid_has_the_spacing_of_its_neighbours() {
        let grid: Vec<Vec3> = (0..81)
            .map(|i| Vec3::new((i % 9) as f32, (i / 9) as f32, 0.0))
            .collect();
        let middle = spacing(&grid)[40];
        assert!((middle - (4.0 + 2.0f32.sqrt()) / 5.0).abs() < 1e-6);
        assert_eq!(spacing(&[Vec3::ONE; 3]), [0.0; 3]);
        assert_eq!(spacing(&[Vec3::ONE]), [0.0]);
        assert_eq!(spacing(&[]), []);
        let pair = spacing(&[Vec3::ZERO, Vec3::splat(f32::MAX)]);
        assert!(pair.iter().all(|s| s.is_finite()));
    }
}
