//! How large the clump of a guide is, from what it stands for.

use std::collections::HashSet;
use std::f64::consts::TAU;

use glam::{DVec3, Vec3};
use hair_sim::Strands;

use super::Guides;
use super::line::{Line, resample};
use crate::nearest::{Found, Nearest};

/// How many neighbours [`spacing`] looks at: five of the six that a hexagonal packing has, so that
/// one missing neighbour, at the hairline, doesn't count the next ring.
const NEIGHBOURS: usize = 5;
/// Radius of a clump in units of the spacing of roots: neighbours overlap, 1.5 times the scalp's width.
const RADIUS_IN_SPACINGS: f64 = 0.75;
/// Where a clump is widest, in shares of its length.
const WIDEST: [f64; 4] = [0.3, 0.35, 0.4, 0.45];
/// How many of the strands' points a clump is to cover there: a few stray.
const COVERED: f64 = 0.9;
/// How far the strands' spread may move a clump's radius from the one by scalp, as a factor.
const MOST_SPREAD: f64 = 2.0;
/// A default clump's radius at its root, as a share of its size.
const SIZE_AT_ROOT: f64 = 0.85;
/// By how much a clump may grow to hide roots that no clump covers.
const MOST_GROWTH: f64 = 1.3;
/// How many points of guides are looked at to find the clump that covers a root.
const GUIDES_NEARBY: usize = 8;
/// The largest radius, head heights.
const LARGEST_RADIUS: f64 = 0.12;

impl Guides {
    /// The clump sizes of the guides (radius in 1/300 of the head's height, here given in metres),
    /// so that together they look like all strands. `strands` are those the guides were chosen from.
    ///
    /// A clump's radius is the geometric mean of two: by the scalp that its strands' roots hold
    /// (their spacing, squared and added up), and by the strands' distance from the guide across it
    /// where a clump is widest (9 of 10 are covered). The second is at least half, at most twice the
    /// first, and where the guide stands for itself alone it is left out. A clump is not wider than
    /// half its length. Then clumps beside bare roots grow, by 1.3 at most. None is larger than 0.12
    /// head heights.
    ///
    /// # Panics
    ///
    /// When `strands` are fewer than the guides were chosen from.
    #[must_use]
    pub fn sizes(&self, strands: &Strands, head_height_m: f32) -> Vec<f32> {
        let head_height_m = f64::from(head_height_m);
        let largest_m = LARGEST_RADIUS * head_height_m;
        let spacing = spacing(strands);
        // A root on its own stands for its share of the scalp: half a ball of 0.4 head heights.
        let alone_m = (TAU / strands.len() as f64).sqrt() * 0.4 * head_height_m;
        let widest: Vec<_> = strands
            .iter()
            .map(|points| resample(points, WIDEST).0)
            .collect();
        let radius_m = |(&guide, members): (&usize, Vec<usize>)| {
            let area: f64 = members.iter().map(|&i| spacing[i] * spacing[i]).sum();
            let across_m = if area > 0.0 { area.sqrt() } else { alone_m };
            let by_scalp = RADIUS_IN_SPACINGS * across_m;
            let by_spread = spread(guide, &members, &widest).unwrap_or(by_scalp);
            let by_spread = by_spread.clamp(by_scalp / MOST_SPREAD, by_scalp * MOST_SPREAD);
            // A clump is longer than wide, and no ball the size of a head.
            let (_, length_m) = resample(strands.strand(guide), []);
            let longest_m = if length_m > 0.0 {
                length_m / 4.0
            } else {
                f64::INFINITY
            };
            (by_scalp * by_spread).sqrt().min(longest_m).min(largest_m)
        };
        let mut radii_m: Vec<f64> = self.kept.iter().zip(self.members()).map(radius_m).collect();
        if self.kept.len() < strands.len() {
            self.hide_bare_roots(strands, &mut radii_m);
        }
        let size = |radius_m: f64| (radius_m.min(largest_m) / head_height_m * 300.0) as f32;
        radii_m.into_iter().map(size).collect()
    }

    /// Lets clumps grow that are the nearest, in their own radii, to roots outside of all.
    fn hide_bare_roots(&self, strands: &Strands, radii_m: &mut [f64]) {
        let lines: Vec<Line> = self
            .kept
            .iter()
            .map(|&i| Line::new(strands.strand(i)))
            .collect();
        let points = || {
            lines
                .iter()
                .enumerate()
                .flat_map(|(k, l)| l.points().iter().map(move |p| (k, p)))
        };
        let guide_at: Vec<usize> = points().map(|(k, _)| k).collect();
        let tree = Nearest::new(points().map(|(_, p)| p.to_array()));
        let mut growth = vec![1.0f64; radii_m.len()];
        let mut found: Vec<Found> = Vec::with_capacity(GUIDES_NEARBY + 1);
        for (root, &own) in strands.roots().zip(&self.guide_of) {
            let root = root.as_dvec3();
            found.clear();
            tree.find(&root.to_array(), GUIDES_NEARBY, &mut found);
            let nearby = found
                .iter()
                .map(|&(_, at)| guide_at[at])
                .chain([own as usize]);
            let reach = |guide: usize| {
                let distance = lines[guide].distance_squared(root).sqrt();
                (distance / (radii_m[guide] * SIZE_AT_ROOT), guide)
            };
            let first = |a: (f64, usize), b: (f64, usize)| if b < a { b } else { a };
            if let Some((ratio, guide)) = nearby.map(reach).reduce(first) {
                growth[guide] = growth[guide].max(ratio.min(MOST_GROWTH));
            }
        }
        radii_m
            .iter_mut()
            .zip(growth)
            .for_each(|(radius, growth)| *radius *= growth);
    }
}

/// The distance, in metres, that [`COVERED`] of the members' points keep from the guide, across its
/// way, where a clump is widest. None where the guide has no members but itself.
fn spread(guide: usize, members: &[usize], widest: &[[DVec3; WIDEST.len()]]) -> Option<f64> {
    let middle = &widest[guide];
    let along = (middle[WIDEST.len() - 1] - middle[0]).normalize_or_zero();
    let others = members.iter().filter(|&&i| i != guide);
    let pairs = others.flat_map(|&i| widest[i].iter().zip(middle));
    let mut away: Vec<f64> = pairs
        .map(|(point, middle)| (*point - *middle).reject_from_normalized(along).length())
        .collect();
    away.sort_by(f64::total_cmp);
    let last = away.len().checked_sub(1)?;
    Some(away[(last as f64 * COVERED) as usize])
}

/// Every root's mean distance to its five nearest neighbours (fewer where there are fewer), in
/// metres.
///
/// Roots at the very same place count as one, so the result is above 0, except where a root has no
/// neighbour elsewhere: there it is 0.
fn spacing(strands: &Strands) -> Vec<f64> {
    let mut seen = HashSet::new();
    // + 0.0 makes one zero of two.
    let key = |root: &Vec3| root.to_array().map(|x| (x + 0.0).to_bits());
    let places = strands.roots().filter(|root| seen.insert(key(root)));
    let tree = Nearest::new(places.map(|place| place.as_dvec3().to_array()));
    let mut found: Vec<Found> = Vec::with_capacity(NEIGHBOURS + 2);
    let mut mean = |root: Vec3| {
        found.clear();
        tree.find(&root.as_dvec3().to_array(), NEIGHBOURS + 1, &mut found);
        let neighbours = found.get(1..).unwrap_or_default();
        let sum: f64 = neighbours.iter().map(|(squared, _)| squared.sqrt()).sum();
        sum / neighbours.len().max(1) as f64
    };
    strands.roots().map(&mut mean).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn strands<'a>(strands: impl IntoIterator<Item = &'a [Vec3]>) -> Strands {
        let mut all = Strands::new();
        for (id, points) in strands.into_iter().enumerate() {
            all.push(id as u32, points, None).unwrap();
        }
        all
    }

    /// Straight strands of 0.2 m down from a square grid with this spacing, which come together to
    /// `gather` of their distance at the middle.
    fn curtain(spacing_m: f32, gather: f32) -> Strands {
        let strand = |i: i32| {
            let root = Vec3::new((i % 20) as f32, 0.0, (i / 20) as f32) * spacing_m;
            let middle = Vec3::new(9.5, 0.0, 9.5) * spacing_m;
            let below = middle + (root - middle) * gather - Vec3::Y * 0.05;
            [root, below, below - Vec3::Y * 0.15]
        };
        let all: Vec<_> = (0..400).map(strand).collect();
        strands(all.iter().map(<[Vec3; 3]>::as_slice))
    }

    proptest! {
        #[test]
        fn coincident_roots_do_not_spoil_the_spacing(
            roots in prop::collection::vec(prop::array::uniform3(-1.0f32..1.0), 10..100),
        ) {
            let roots: Vec<Vec3> = roots.into_iter().map(Vec3::from).collect();
            let once = spacing(&strands(roots.chunks(1)));
            let twice = [roots.clone(), roots].concat();
            let twice = spacing(&strands(twice.chunks(1)));
            prop_assert!(once.iter().all(|s| *s > 0.0));
            prop_assert_eq!(&twice[..once.len()], &once[..]);
            prop_assert_eq!(&twice[once.len()..], &once[..]);
        }
    }

    #[test]
    fn a_grid_has_the_spacing_of_its_neighbours() {
        let grid: Vec<Vec3> = (0..81)
            .map(|i| Vec3::new((i % 9) as f32, (i / 9) as f32, 0.0))
            .collect();
        let middle = spacing(&strands(grid.chunks(1)))[40];
        assert!((middle - (4.0 + 2.0f64.sqrt()) / 5.0).abs() < 1e-6);
        assert_eq!(spacing(&strands([Vec3::ONE; 3].chunks(1))), [0.0; 3]);
        assert_eq!(spacing(&strands([])), []);
    }

    #[test]
    fn kept_strands_have_the_size_of_their_spacing() {
        let strands = curtain(0.004, 1.0);
        let all = Guides::choose(&strands, 400).sizes(&strands, 0.3);
        // Units of 1 mm. In the middle a root's five neighbours are 4 mm away, one of them across.
        let expected = 0.75 * 4.0 * (4.0 + 2.0f32.sqrt()) / 5.0;
        assert!((all[210] - expected).abs() < 1e-3, "{}", all[210]);
    }

    #[test]
    fn sizes_come_from_the_scalp_held_and_the_spread() {
        let mean = |gather: f32, n: usize| {
            let strands = curtain(0.004, gather);
            let sizes = Guides::choose(&strands, n).sizes(&strands, 0.3);
            sizes.iter().sum::<f32>() / n as f32
        };
        // 400 roots on a square of 80 mm, 25 guides: 16 mm from guide to guide.
        let straight = mean(1.0, 25);
        assert!((8.0..16.0).contains(&straight), "{straight}");
        assert!((1.8..2.2).contains(&(mean(1.0, 25) / mean(1.0, 100))));
        // Strands that part make larger clumps, those that gather smaller ones while the scalp stays
        // hidden.
        let (parting, gathered) = (mean(2.0, 25), mean(0.3, 25));
        assert!(parting > 1.2 * straight, "{parting} {straight}");
        assert!(gathered < straight, "{gathered} {straight}");
    }

    #[test]
    fn the_spread_is_across_the_guide() {
        let strand = |x: f32, y: f32| [Vec3::new(x, y, 0.0), Vec3::new(x, y - 1.0, 0.0)];
        // Moved along the guide, and beside it by 1 to 11.
        let mut all = vec![strand(0.0, 0.0), strand(0.0, 0.5)];
        all.extend((1..=11).map(|k| strand(k as f32, 0.0)));
        let widest: Vec<_> = all
            .iter()
            .map(|points| resample(points, WIDEST).0)
            .collect();
        let members: Vec<usize> = (0..all.len()).collect();
        assert_eq!(spread(0, &members[..1], &widest), None);
        assert_eq!(spread(0, &members[..2], &widest), Some(0.0));
        // Of the twelve others the tenth.
        assert_eq!(spread(0, &members, &widest), Some(10.0));
    }

    #[test]
    fn clumps_have_limits() {
        let size = |points: &[&[Vec3]], n: usize| {
            let strands = strands(points.iter().copied());
            Guides::choose(&strands, n).sizes(&strands, 0.3)
        };
        // Apart by more than a head; shorter than their spacing; alone; without length; none.
        let long: &[Vec3] = &[Vec3::ZERO, Vec3::X * 9.0];
        let far: &[Vec3] = &[Vec3::Y * 5.0, Vec3::Y * 5.01];
        assert_eq!(size(&[long, far], 2)[0], 36.0);
        assert!((size(&[long, far], 2)[1] - 2.5).abs() < 1e-3);
        assert_eq!(size(&[long], 1), [36.0]);
        assert!(size(&[&long[..1]; 4], 2).iter().all(|size| *size > 0.0));
        assert_eq!(size(&[], 3), []);
    }
}
