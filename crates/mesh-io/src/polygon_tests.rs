use std::collections::HashMap;
use std::f64::consts::{PI, TAU};

use glam::DQuat;
use proptest::prelude::*;

use super::*;

/// A polygon of the plane somewhere in space.
fn in_space(flat: &[DVec2], turn: [f64; 3]) -> Vec<DVec3> {
    let turn = DQuat::from_scaled_axis(DVec3::from_array(turn));
    let place = |p: &DVec2| turn * p.extend(0.0) + DVec3::new(3.0, -2.0, 1.0);
    flat.iter().map(place).collect()
}

fn on_plane(flat: &[DVec2]) -> Vec<DVec3> {
    flat.iter().map(|p| p.extend(0.0)).collect()
}

fn points(flat: &[[f64; 2]]) -> Vec<DVec2> {
    flat.iter().copied().map(DVec2::from_array).collect()
}

fn fan(count: usize) -> Vec<[usize; 3]> {
    (2..count).map(|corner| [0, corner - 1, corner]).collect()
}

/// A polygon around the middle, of so large radii.
fn star(radii: &[f64]) -> Vec<DVec2> {
    let angle = |i: usize| TAU * i as f64 / radii.len() as f64;
    let radii = radii.iter().enumerate();
    radii
        .map(|(i, radius)| DVec2::from_angle(angle(i)) * *radius)
        .collect()
}

/// Whether triangles are those of a polygon whose sides don't cross: none is turned over, or is in another, and they have its sides
/// and no other border.
fn check(flat: &[DVec2], triangles: &[[usize; 3]]) -> Result<(), TestCaseError> {
    let count = flat.len();
    prop_assert_eq!(triangles.len(), count - 2);
    let area_of = |corners: &[usize]| -> f64 {
        let next = corners.iter().cycle().skip(1);
        corners
            .iter()
            .zip(next)
            .map(|(a, b)| flat[*a].perp_dot(flat[*b]))
            .sum()
    };
    let whole = area_of(&(0..count).collect::<Vec<_>>());
    // Where none is turned over, as often as the polygon goes round a place, so many triangles are there.
    let mut sum = 0.0;
    let mut sides: HashMap<[usize; 2], i32> = HashMap::new();
    for triangle in triangles {
        let area = area_of(triangle);
        prop_assert!(
            area * whole.signum() > -1e-9 * whole.abs(),
            "{triangle:?} {area}"
        );
        sum += area;
        let [a, b, c] = *triangle;
        for [from, to] in [[a, b], [b, c], [c, a]] {
            *sides.entry([from, to]).or_default() += 1;
            *sides.entry([to, from]).or_default() -= 1;
        }
    }
    prop_assert!((sum - whole).abs() <= 1e-9 * whole.abs());
    let sides: HashMap<_, _> = sides.into_iter().filter(|(_, times)| *times > 0).collect();
    let own = (0..count).map(|from| ([from, (from + 1) % count], 1));
    prop_assert_eq!(sides, own.collect());
    Ok(())
}

/// A band of so many turns, wound up.
fn spiral(corners: usize) -> Vec<DVec2> {
    let half = corners / 2;
    let at = |i: usize, radius: f64| {
        let turns = 10.0 * i as f64 / half as f64;
        DVec2::from_angle(TAU * turns) * (radius + turns)
    };
    let outwards = (0..half).map(|i| at(i, 1.5));
    outwards
        .chain((0..half).rev().map(|i| at(i, 1.0)))
        .rev()
        .collect()
}

/// A comb, aslant so that the boxes of its teeth have many others in them.
fn comb(teeth: usize) -> Vec<DVec2> {
    let tooth = |i: usize| {
        [
            DVec2::new(i as f64, 0.0),
            DVec2::new(i as f64 + 0.5, teeth as f64),
        ]
    };
    let end = [
        DVec2::new(teeth as f64, 0.0),
        DVec2::new(teeth as f64, -1.0),
        DVec2::new(0.0, -1.0),
    ];
    let corners = (0..teeth).flat_map(tooth).chain(end);
    let aslant = DVec2::from_angle(PI / 4.0);
    corners.map(|corner| aslant.rotate(corner)).rev().collect()
}

#[test]
fn a_convex_polygon_is_the_fan_that_it_was() {
    for count in 3..40 {
        let radii: Vec<f64> = (0..count).map(|_| 2.0).collect();
        for turn in [[0.0; 3], [0.4, -1.0, 2.0], [PI, 0.0, 0.0]] {
            assert_eq!(triangles(&in_space(&star(&radii), turn)), fan(count));
        }
    }
    // With corners in the middle of sides, and not quite in a plane.
    let square = points(&[[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [2.0, 2.0], [0.0, 2.0]]);
    assert_eq!(triangles(&on_plane(&square)), fan(5));
    let bent = [DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.7), DVec3::Y];
    assert_eq!(triangles(&bent), fan(4));
}

#[test]
fn a_concave_quad_is_cut_from_its_hollow() {
    let arrow = points(&[[0.0, 0.0], [2.0, -1.0], [0.5, 0.0], [2.0, 1.0]]);
    for first in 0..4 {
        for turn in [[0.0; 3], [0.4, -1.0, 2.0], [PI, 0.0, 0.0]] {
            let mut corners = in_space(&arrow, turn);
            corners.rotate_left(first);
            let hollow = (2 + 4 - first) % 4;
            let found = triangles(&corners);
            assert_eq!(found.len(), 2);
            assert!(found.iter().all(|triangle| triangle.contains(&hollow)));
            if hollow % 2 == 0 {
                assert_eq!(found, fan(4));
            }
        }
    }
}

#[test]
fn what_is_wound_up_or_has_teeth_is_cut_right() {
    for flat in [spiral(30), spiral(2000), comb(1), comb(7), comb(1000)] {
        for first in [0, 1, flat.len() / 3] {
            let mut flat = flat.clone();
            flat.rotate_left(first);
            check(&flat, &triangles(&in_space(&flat, [1.0, 2.0, 3.0]))).unwrap();
        }
    }
}

#[test]
fn corners_on_straight_sides_stay_corners() {
    // An L, each side of which other faces share half by half.
    let flat = points(&[
        [0.0, 0.0],
        [1.0, 0.0],
        [2.0, 0.0],
        [2.0, 0.5],
        [2.0, 1.0],
        [1.5, 1.0],
        [1.0, 1.0],
        [1.0, 1.5],
        [1.0, 2.0],
        [0.5, 2.0],
        [0.0, 2.0],
        [0.0, 1.0],
    ]);
    for first in 0..flat.len() {
        let mut flat = flat.clone();
        flat.rotate_left(first);
        let found = triangles(&on_plane(&flat));
        // Where no triangle of the fan is turned over it stays, though some have no area.
        if found.len() == flat.len() - 2 {
            check(&flat, &found).unwrap();
        } else {
            assert!(found.iter().all(|triangle| triangle[0] == 0));
        }
    }
    let mut from_a_tip = flat;
    from_a_tip.rotate_left(3);
    check(&from_a_tip, &triangles(&on_plane(&from_a_tip))).unwrap();
}

#[test]
fn a_hole_that_a_bridge_joins_stays_one() {
    // A square with a square hole, and the way there and back.
    let flat = points(&[
        [0.0, 0.0],
        [3.0, 0.0],
        [3.0, 3.0],
        [0.0, 3.0],
        [0.0, 0.0],
        [1.0, 1.0],
        [1.0, 2.0],
        [2.0, 2.0],
        [2.0, 1.0],
        [1.0, 1.0],
    ]);
    for first in 0..flat.len() {
        let mut flat = flat.clone();
        flat.rotate_left(first);
        let found = triangles(&on_plane(&flat));
        let areas = found
            .iter()
            .map(|triangle| turn(triangle.map(|corner| flat[corner])) / 2.0);
        assert!(areas.clone().all(|area| area > 0.0), "{found:?}");
        assert_eq!(areas.sum::<f64>(), 8.0);
    }
}

#[test]
fn what_touches_an_ear_from_within_is_in_the_way() {
    // A cut from the opposite side ends in the corner (0, 0) itself.
    let flat = points(&[
        [0.0, 0.0],
        [4.0, 0.0],
        [4.0, 3.0],
        [0.0, 0.0],
        [3.0, 4.0],
        [0.0, 4.0],
    ]);
    for first in 0..flat.len() {
        let mut flat = flat.clone();
        flat.rotate_left(first);
        let found = triangles(&on_plane(&flat));
        let areas = found
            .iter()
            .map(|triangle| turn(triangle.map(|corner| flat[corner])) / 2.0);
        assert!(areas.clone().all(|area| area > 0.0), "{found:?}");
        assert_eq!(areas.sum::<f64>(), 12.0);
    }
}

#[test]
fn what_is_no_polygon_has_what_triangles_there_are() {
    assert!(triangles(&[]).is_empty());
    assert!(triangles(&[DVec3::X; 2]).is_empty());
    assert!(triangles(&[DVec3::X; 9]).is_empty());
    let line: Vec<DVec3> = (0..9).map(|i| DVec3::splat(f64::from(i % 5))).collect();
    assert!(triangles(&line).is_empty());
    // Corners that are there twice, a whisker and back, and a bow.
    let doubled = points(&[
        [0.0, 0.0],
        [2.0, 0.0],
        [2.0, 0.0],
        [0.5, 0.5],
        [0.0, 2.0],
        [0.0, 2.0],
    ]);
    let found = triangles(&on_plane(&doubled));
    assert_eq!(found.len(), 2);
    assert!(found.iter().all(|triangle| triangle.contains(&3)));
    let whisker = points(&[
        [0.0, 0.0],
        [2.0, 0.0],
        [5.0, 0.0],
        [2.0, 0.0],
        [0.5, 0.5],
        [0.0, 2.0],
    ]);
    let found = triangles(&on_plane(&whisker));
    assert!(found.iter().all(|triangle| triangle.contains(&4)));
    let bow = points(&[[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]]);
    assert_eq!(triangles(&on_plane(&bow)), fan(4));
    // The largest and the smallest numbers that files can have.
    for scale in [f64::from(f32::MAX), 1e-45] {
        let arrow = [[1.0, -1.0], [0.25, 0.0], [1.0, 1.0], [0.0, 0.0]];
        let arrow = points(&arrow).into_iter().map(|p| (p * scale).extend(0.0));
        assert_eq!(triangles(&arrow.collect::<Vec<_>>()).len(), 2);
    }
}

#[test]
fn polygons_of_many_corners_take_no_time() {
    const CORNERS: usize = 100_000;
    let mut hash = 1_u64;
    let mut random = || {
        hash = hash.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        (hash >> 40) as f64 / (1 << 24) as f64
    };
    let tangle: Vec<DVec2> = (0..CORNERS)
        .map(|_| DVec2::new(random(), random()))
        .collect();
    let few = [0.0, 1.0, 2.0, 3.0].map(|x| DVec2::new(x, (x * x) % 3.0));
    let same: Vec<DVec2> = (0..CORNERS)
        .map(|_| few[(4.0 * random()) as usize])
        .collect();
    let mut straight: Vec<DVec2> = (0..CORNERS).map(|i| DVec2::new(i as f64, 0.0)).collect();
    straight.extend(points(&[[CORNERS as f64, 5.0], [1.0, 1.0], [0.0, 5.0]]));
    straight.rotate_left(CORNERS / 2);
    let radii: Vec<f64> = (0..CORNERS).map(|_| 1.0 + random()).collect();
    for flat in [spiral(CORNERS), star(&radii)] {
        check(&flat, &triangles(&on_plane(&flat))).unwrap();
    }
    for flat in [tangle, same, straight] {
        assert!(triangles(&on_plane(&flat)).len() <= flat.len() - 2);
    }
}

proptest! {
    #[test]
    fn a_star_has_triangles_of_itself_alone(
        radii in prop::collection::vec(0.05..1.0_f64, 4..60),
        turn in prop::array::uniform3(-3.0..3.0_f64),
    ) {
        let flat = star(&radii);
        check(&flat, &triangles(&in_space(&flat, turn)))?;
    }

    #[test]
    fn any_corners_have_triangles_of_their_own(corners in prop::collection::vec(prop::array::uniform3(-2..3_i8), 0..40)) {
        let corners: Vec<DVec3> = corners.into_iter().map(|p| DVec3::from_array(p.map(f64::from))).collect();
        let found = triangles(&corners);
        prop_assert!(found.len() <= corners.len().saturating_sub(2));
        prop_assert!(found.iter().flatten().all(|corner| *corner < corners.len()));
    }
}
