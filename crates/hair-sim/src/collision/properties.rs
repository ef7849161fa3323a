use super::{blocks::blocks, grid::SignedDistance, shape::Shape};
use crate::lanes::{Lane, Vec3 as LaneVec3};
use glam::DVec3;
use proptest::prelude::*;

fn vector(size: f64) -> impl Strategy<Value = DVec3> {
    let side = || -size..size;
    [side(), side(), side()].prop_map(DVec3::from_array)
}

const HALF: DVec3 = DVec3::new(0.06, 0.04, 0.09);

/// A box of twelve triangles.
fn grid(cell: f64) -> SignedDistance {
    let (points, triangles) = blocks(&[[-HALF.as_vec3(), HALF.as_vec3()]]);
    SignedDistance::new(&points, &triangles, cell).unwrap()
}

/// The distance from the box, in closed form.
fn from_box(at: DVec3) -> f64 {
    let out = at.abs() - HALF;
    out.max(DVec3::ZERO).length() + out.max_element().min(0.0)
}

/// The slope of a distance, by differences.
fn slope(shape: &Shape, at: DVec3) -> DVec3 {
    let h = 1e-6;
    let along = |d: DVec3| (shape.distance(at + d) - shape.distance(at - d)) / (2.0 * h);
    DVec3::new(
        along(DVec3::X * h),
        along(DVec3::Y * h),
        along(DVec3::Z * h),
    )
}

proptest! {
    #[test]
    fn normals_are_the_slopes_of_distances(at in vector(0.5), a in vector(0.2), b in vector(0.2), radius in 0.0..0.3_f64) {
        let ball = Shape::Sphere { center: a, radius };
        let capsule = Shape::Capsule { from: a, to: b, radius };
        for shape in [ball, capsule] {
            // On the line itself there is no direction.
            if shape.distance(at) + radius > 1e-3 {
                prop_assert!((slope(&shape, at) - shape.normal(at)).length() < 1e-5);
            }
        }
    }

    #[test]
    fn distances_side_by_side_are_those_one_by_one(at in prop::array::uniform4(vector(0.2))) {
        let grid = grid(0.02);
        let mut places = LaneVec3::ZERO;
        for (lane, at) in at.into_iter().enumerate() {
            places.set(lane, at);
        }
        let distances: Lane = grid.distances(places);
        prop_assert_eq!(distances, Lane(at.map(|at| grid.distance(at))));
    }

    #[test]
    fn no_distance_grows_faster_than_the_way(at in vector(0.5), to in vector(0.5), a in vector(0.2), b in vector(0.2), radius in 0.0..0.3_f64) {
        let capsule = Shape::Capsule { from: a, to: b, radius };
        let grown = (capsule.distance(at) - capsule.distance(to)).abs();
        prop_assert!(grown <= at.distance(to) + 1e-15);
    }

    #[test]
    fn a_capsule_is_the_union_of_its_balls(at in vector(0.5), a in vector(0.2), b in vector(0.2), radius in 0.0..0.3_f64) {
        let capsule = Shape::Capsule { from: a, to: b, radius }.distance(at);
        let nearest = (0..=1000)
            .map(|i| Shape::Sphere { center: a.lerp(b, f64::from(i) * 1e-3), radius }.distance(at))
            .fold(f64::INFINITY, f64::min);
        prop_assert!(capsule <= nearest + 1e-14);
        prop_assert!(nearest - capsule < 1e-3 * a.distance(b) + 1e-14);
    }
}

#[test]
fn the_grid_of_a_box_has_the_box_s_distances() {
    for cell in [0.004, 0.008] {
        let grid = grid(cell);
        let mut runner = proptest::test_runner::TestRunner::deterministic();
        runner
            .run(&vector(0.12), |at| {
                let (found, truth) = (grid.distance(at), from_box(at));
                if !at.abs().cmple(HALF + 2.9 * cell).all() {
                    // Outside of the grid: a bound, that grows outwards as the distance does.
                    prop_assert!(found > 0.7 * truth - cell && found < truth + 0.87 * cell);
                    prop_assert!(grid.distance(at * 1.02) > found, "{at}: {found}");
                    return Ok(());
                }
                // Between grid points edges are rounded, by less than half a diagonal of a cell.
                prop_assert!((found - truth).abs() < 0.87 * cell, "{at}: {found} {truth}");
                if truth.abs() > 0.87 * cell {
                    prop_assert_eq!(found < 0.0, truth < 0.0);
                }
                // Outside, away from the creases of the distance, the slope is a unit vector.
                if (0.0..2.0 * cell).contains(&truth)
                    && at.abs().cmplt(HALF - 2.0 * cell).bitmask().count_ones() == 2
                {
                    prop_assert!((grid.gradient(at).length() / cell - 1.0).abs() < 0.02);
                }
                Ok(())
            })
            .unwrap();
    }
}
