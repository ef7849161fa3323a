//! Meshes made of known lines.

use super::*;
use proptest::prelude::*;
use std::f32::consts::TAU;

/// Middle of the skulls of these tests.
const SKULL: Vec3 = Vec3::new(0.0, 1.6, 0.0);
const LINK_M: f32 = 0.015;

#[derive(Default)]
struct Made {
    positions: Vec<Vec3>,
    triangles: Vec<[u32; 3]>,
}

impl Made {
    /// A tube around a line, with an ellipse of these half axes as its section at each share of it; closed at both ends.
    fn tube(line: impl Fn(f32) -> Vec3, rows: u32, axes: impl Fn(f32) -> [f32; 2]) -> Self {
        const SIDES: u32 = 12;
        let mut made = Self::default();
        for row in 0..=rows {
            let u = row as f32 / rows as f32;
            let way = (line((u + 0.01).min(1.0)) - line((u - 0.01).max(0.0))).normalize();
            let wide = Vec3::X.reject_from(way).try_normalize().unwrap_or(Vec3::Z);
            let thin = way.cross(wide);
            let [a, b] = axes(u);
            for side in 0..SIDES {
                let (sin, cos) = (side as f32 / SIDES as f32 * TAU).sin_cos();
                made.positions
                    .push(line(u) + wide * a * cos + thin * b * sin);
            }
        }
        for row in 0..rows {
            for side in 0..SIDES {
                let at = |row: u32, side: u32| row * SIDES + side % SIDES;
                let [a, b, c, d] = [
                    at(row, side),
                    at(row, side + 1),
                    at(row + 1, side),
                    at(row + 1, side + 1),
                ];
                made.triangles.extend([[a, b, c], [b, d, c]]);
            }
        }
        for (row, place) in [(0, line(0.0)), (rows, line(1.0))] {
            made.positions.push(place);
            let middle = made.positions.len() as u32 - 1;
            let fan = (0..SIDES).map(|s| [middle, row * SIDES + (s + 1) % SIDES, row * SIDES + s]);
            made.triangles.extend(fan);
        }
        made
    }

    fn found(&self, depths: &[f32]) -> Locks {
        self.found_in(&vec![Some(0); self.triangles.len()], depths)
    }

    fn found_in(&self, groups: &[Option<u32>], depths: &[f32]) -> Locks {
        let hair = MeshHair {
            positions: &self.positions,
            triangles: &self.triangles,
            groups,
            depths,
        };
        locks(&hair, SKULL, LINK_M)
    }

    fn only(&self, depths: &[f32]) -> Lock {
        let found = self.found(depths);
        assert_eq!((found.locks.len(), found.shells), (1, 0));
        found.locks.into_iter().next().unwrap()
    }

    fn and(mut self, other: Self) -> Self {
        let first = self.positions.len() as u32;
        self.positions.extend(other.positions);
        self.triangles
            .extend(other.triangles.iter().map(|t| t.map(|i| i + first)));
        self
    }
}

/// A lock of 24 cm that hangs from the side of the head.
fn hanging(u: f32) -> Vec3 {
    Vec3::new(0.09, 1.62 - 0.24 * u, 0.02)
}

/// A quarter of a circle of 12 cm around the skull, from the crown to the brow.
fn quarter(u: f32) -> Vec3 {
    let (sin, cos) = (0.25 * u * TAU).sin_cos();
    SKULL + Vec3::new(0.0, 0.12 * cos, 0.12 * sin)
}

/// A curl of two turns.
fn curl(u: f32) -> Vec3 {
    let (sin, cos) = (2.0 * u * TAU).sin_cos();
    Vec3::new(0.1 + 0.03 * cos, 1.6 - 0.25 * u, 0.03 * sin)
}

/// The greatest distance in mm of a lock's middle from a line.
fn off_mm(lock: &Lock, line: impl Fn(f32) -> Vec3) -> f32 {
    let off = |place: Vec3| {
        (0..=2000)
            .map(|i| line(i as f32 / 2000.0).distance(place))
            .fold(f32::INFINITY, f32::min)
    };
    lock.middle().map(off).fold(0.0, f32::max) * 1e3
}

#[test]
fn cones_and_bent_tubes_have_their_middle_and_width() {
    type Line = fn(f32) -> Vec3;
    let cases: [(&str, Line, f32); 3] = [
        ("cone", hanging, 0.3),
        ("quarter", quarter, 1.0),
        ("curl", curl, 2.5),
    ];
    for (name, line, limit_mm) in cases {
        let radius = |u: f32| 0.012 * (1.0 - u) + 1e-4;
        let tube = Made::tube(line, 40, |u| [radius(u); 2]);
        // The nearer to the root, the higher.
        let depths: Vec<f32> = tube.positions.iter().map(|p| 10.0 * (2.0 - p.y)).collect();
        let lock = tube.only(&depths);
        assert!(
            off_mm(&lock, line) < limit_mm,
            "{name}: {} mm",
            off_mm(&lock, line)
        );
        let middle: Vec<Vec3> = lock.middle().collect();
        let ends = [
            (middle[0], line(0.0)),
            (middle[middle.len() - 1], line(1.0)),
        ];
        for (found, expected) in ends {
            assert!(
                found.distance(expected) < 2.5e-3,
                "{name}: {found} {expected}"
            );
        }
        let widths: Vec<f32> = lock.half_widths().collect();
        for (index, width) in widths.iter().enumerate() {
            let expected = radius(index as f32 / (widths.len() - 1) as f32);
            assert!(
                (width - expected).abs() < 1e-3,
                "{name} {index}: {width} {expected}"
            );
        }
    }
}

#[test]
fn the_root_is_where_the_head_is_or_the_bones_begin() {
    // Upwards from below: the end near the skull is its last.
    let reversed = Made::tube(|u| hanging(1.0 - u), 20, |_| [0.01; 2]);
    let root = |lock: &Lock| lock.middle().next().unwrap();
    assert!(root(&reversed.only(&[])).distance(hanging(0.0)) < 2e-3);
    // Bones say otherwise: it swings at the upper end.
    let depths: Vec<f32> = reversed
        .positions
        .iter()
        .map(|p| if p.y > 1.5 { 2.0 } else { 0.0 })
        .collect();
    assert!(root(&reversed.only(&depths)).distance(hanging(1.0)) < 2e-3);
}

#[test]
fn ribbons_are_strands_side_by_side() {
    let ribbon = Made::tube(quarter, 30, |_| [0.04, 0.003]);
    let lock = ribbon.only(&[]);
    assert!(!lock.is_tuft());
    assert!(off_mm(&lock, quarter) < 1.0, "{}", off_mm(&lock, quarter));
    let strands = lock.strands(0.012);
    assert_eq!(strands.len(), 4);
    for (index, strand) in strands.iter().enumerate() {
        let x = 0.02 * (index as f32 - 1.5);
        let middle = strand.points[strand.points.len() / 2];
        assert!((middle.x.abs() - x.abs()).abs() < 1e-3, "{middle}");
        let from_middle = (middle - SKULL).with_x(0.0).length();
        assert!((from_middle - 0.12).abs() < 1e-3, "{from_middle}");
    }
    // Together they are as wide as the ribbon, and a little wider.
    let half_width = strands[0].half_widths[5];
    assert!((0.010..0.0125).contains(&half_width), "{half_width}");
    assert_eq!(lock.strands(0.04).len(), 1);
}

/// A ball of hair: a ring of strands from its place at the skull over its surface to the other end.
#[test]
fn balls_are_bundles() {
    let center = SKULL + Vec3::new(0.0, 0.2, -0.1);
    let (radius, away) = (0.08, (center - SKULL).normalize());
    // Its poles lie sideways: the root is found where the skull is.
    let axes = |u: f32| [radius * (1.0 - (2.0 * u - 1.0).powi(2)).max(1e-6).sqrt(); 2];
    let ball = Made::tube(|u| center + Vec3::X * radius * (2.0 * u - 1.0), 24, axes);
    let lock = ball.only(&[]);
    assert!(lock.is_tuft());
    let root = lock.middle().next().unwrap();
    assert!(root.distance(center - away * radius) < 0.015, "{root}");
    let strands = lock.strands(0.015);
    assert!((10..=32).contains(&strands.len()), "{}", strands.len());
    for strand in &strands {
        for (place, half) in strand.points.iter().zip(&strand.half_widths) {
            let reach = place.distance(center) + half;
            assert!(reach < 1.08 * radius, "{reach}");
        }
        let middle = strand.points.len() / 2;
        let reach = strand.points[middle].distance(center) + strand.half_widths[middle];
        assert!(reach > 0.94 * radius, "{reach}");
    }
    // However fine strands are asked for, there are no gaps between them.
    for widest in [0.015, 0.004, 0.0005] {
        let strands = lock.strands(widest);
        assert!(strands.len() <= 64, "{}", strands.len());
        let middle = strands[0].points.len() / 2;
        for (own, next) in strands.iter().zip(strands.iter().cycle().skip(1)) {
            let apart = own.points[middle].distance(next.points[middle]);
            let wide = own.half_widths[middle] + next.half_widths[middle];
            assert!(apart < wide, "{widest}: {apart} apart, {wide} wide");
        }
    }
}

/// A half of a ball's shell around the skull.
fn cap() -> Made {
    cap_around(SKULL)
}

/// The same around another middle.
fn cap_around(center: Vec3) -> Made {
    let mut made = Made::default();
    let place = |row: u32, side: u32| {
        let (sin, cos) = (row as f32 / 8.0 * 0.25 * TAU).sin_cos();
        let (x, z) = ((side % 16) as f32 / 16.0 * TAU).sin_cos();
        center + 0.12 * Vec3::new(sin * x, cos, sin * z)
    };
    for (row, side) in (0..8).flat_map(|row| (0..16).map(move |side| (row, side))) {
        let first = made.positions.len() as u32;
        made.positions.extend([
            place(row, side),
            place(row, side + 1),
            place(row + 1, side),
            place(row + 1, side + 1),
        ]);
        made.triangles
            .extend([[0, 2, 1], [1, 2, 3]].map(|t| t.map(|i| i + first)));
    }
    made
}

#[test]
fn caps_are_no_locks_and_what_is_cut_off_them_is_one() {
    let cap = cap();
    let found = cap.found(&[]);
    assert_eq!((found.locks.len(), found.shells), (0, 1));
    // The skull's middle need not be the cap's.
    for off in [Vec3::Y * 0.05, Vec3::Z * -0.03] {
        assert_eq!(cap_around(SKULL + off).found(&[]).shells, 1);
    }
    // The front of its last three rows swings.
    let swings = |t: &[u32; 3]| {
        let middle = t
            .iter()
            .map(|i| cap.positions[*i as usize] - SKULL)
            .sum::<Vec3>()
            / 3.0;
        middle.y < 0.06 && middle.z > 0.06 && middle.x.abs() < 0.05
    };
    let groups: Vec<Option<u32>> = cap
        .triangles
        .iter()
        .map(|t| swings(t).then_some(3))
        .collect();
    let found = cap.found_in(&groups, &[]);
    assert_eq!((found.locks.len(), found.shells), (1, 0));
    let middle: Vec<Vec3> = found.locks[0].middle().collect();
    let (root, tip) = (middle[0], middle[middle.len() - 1]);
    assert!(
        root.y > tip.y + 0.02 && tip.y < SKULL.y + 0.015,
        "{root} {tip}"
    );
    let expected = groups.iter().filter(|group| group.is_some()).count();
    assert_eq!(found.locks[0].triangles.len(), expected);
}

#[test]
fn islands_are_told_apart_and_seams_are_none() {
    let two = Made::tube(hanging, 10, |_| [0.01; 2]).and(Made::tube(
        |u| hanging(u) - Vec3::X * 0.18,
        10,
        |_| [0.01; 2],
    ));
    let found = two.found(&[]);
    assert_eq!(found.locks.len(), 2);
    let numbers = islands(&two.positions, &two.triangles);
    assert_eq!(numbers[0], 0);
    assert!(
        numbers
            .iter()
            .all(|n| *n == 0 || *n == two.triangles.len() / 2)
    );
    // The same with corners of their own for each triangle, as hard edges and seams of textures have.
    let flat = Made {
        positions: two
            .triangles
            .iter()
            .flat_map(|t| t.map(|i| two.positions[i as usize]))
            .collect(),
        triangles: (0..two.triangles.len() as u32)
            .map(|t| [3 * t, 3 * t + 1, 3 * t + 2])
            .collect(),
    };
    assert_eq!(flat.found(&[]).locks.len(), 2);
    // Two groups are two islands.
    let one = Made::tube(hanging, 10, |_| [0.01; 2]);
    let groups: Vec<_> = one
        .triangles
        .iter()
        .map(|t| Some(u32::from(one.positions[t[0] as usize].y > 1.5)))
        .collect();
    assert_eq!(one.found_in(&groups, &[]).locks.len(), 2);
}

#[test]
fn broken_triangles_are_no_hair() {
    let mut tube = Made::tube(hanging, 20, |_| [0.01; 2]);
    let good = tube.only(&[]).middle().collect::<Vec<_>>();
    let count = tube.triangles.len();
    tube.positions
        .extend([Vec3::NAN, Vec3::splat(f32::INFINITY)]);
    let nan = tube.positions.len() as u32 - 2;
    tube.triangles
        .extend([[0, 1, nan], [0, nan + 1, 1], [0, 1, 9999], [5, 5, 5]]);
    let found = tube.found(&[]);
    assert_eq!(found.locks.len(), 1);
    assert!(
        found.locks[0]
            .triangles
            .iter()
            .all(|t| *t < count || *t == count + 3)
    );
    for (a, b) in found.locks[0].middle().zip(good) {
        assert!(a.distance(b) < 1e-5);
    }
    let point = Made {
        positions: vec![Vec3::ONE; 3],
        triangles: vec![[0, 1, 2]],
    };
    assert!(point.found(&[]).locks.is_empty());
    assert!(Made::default().found(&[]).locks.is_empty());
}

proptest! {
    #[test]
    fn strands_are_finite_whatever_is_given(
        corners in prop::collection::vec(prop::array::uniform3(prop_oneof![-1.0f32..1.0, Just(0.0), Just(1e30), Just(f32::NAN)]), 1..24),
        triangles in prop::collection::vec(prop::array::uniform3(0u32..26), 0..24),
    ) {
        let positions: Vec<Vec3> = corners.into_iter().map(Vec3::from).collect();
        let made = Made { positions, triangles };
        for lock in made.found(&[]).locks {
            prop_assert!(!lock.triangles.is_empty());
            for strand in lock.strands(0.02) {
                prop_assert!(strand.points.len() > 1 && strand.points.len() == strand.half_widths.len());
                prop_assert!(strand.points.iter().all(|p| p.is_finite()));
                prop_assert!(strand.half_widths.iter().all(|w| w.is_finite() && *w >= 0.0));
            }
        }
    }
}
