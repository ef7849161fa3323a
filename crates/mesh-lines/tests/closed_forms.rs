//! Contours of surfaces whose contours are known exactly.

mod shapes;

use glam::{DVec3, Vec3};
use mesh_lines::{
    Line, Place, TURN_COSINE, View, borders, contours, creases, curvatures, facing, walk_to_zero,
};
use shapes::{Shape, cube, cup, ellipsoid, eyes, grid, sphere, torus};

fn contours_from(shape: &Shape, view: &View) -> Vec<Line> {
    let surface = shape.surface();
    contours(&surface, view, &facing(&surface, view)).unwrap()
}

fn view_from(eye: DVec3) -> View {
    View::perspective(eye.as_vec3()).unwrap()
}

/// Whether all segments lie in the triangle that they name, and each joint on two of them.
fn assert_chained(line: &Line, shape: &Shape) {
    let surface = shape.surface();
    for segment in 0..line.segments.len() {
        for (along, end) in [(segment as f64, 0), (segment as f64 + 0.999_999_999, 1)] {
            let place = line.place(&surface, along);
            assert!(
                (place.weights.element_sum() - 1.0).abs() < 1e-9,
                "{place:?}"
            );
            assert!(place.weights.min_element() > -1e-9);
            let off = surface
                .point(place)
                .distance(line.ends(segment)[end].position);
            assert!(off < 1e-6, "joint {segment}: {off}");
        }
    }
}

#[test]
fn a_sphere_has_the_circle_of_its_tangents() {
    let center = DVec3::new(0.3, -0.2, 0.5);
    for count in [8, 16, 32] {
        let shape = sphere(count, center, 1.0);
        let triangles = 0..shape.topology.triangles().len() as u32;
        let sagitta = 1.02
            * triangles
                .map(|t| shape.surface().sagitta(t))
                .fold(0.0, f64::max);
        for eye in eyes(50, 1.3, 9.0).map(|eye| eye + center) {
            let lines = contours_from(&shape, &view_from(eye));
            assert_eq!(lines.len(), 1);
            assert!(lines[0].closed && lines[0].segments.iter().all(|s| !s.folded));
            assert_chained(&lines[0], &shape);
            // The tangents touch a circle in the plane n . (eye - centre) = r^2.
            let away = eye - center;
            for point in &lines[0].points {
                let off_plane = ((point.position - center).dot(away) - 1.0) / away.length();
                let off_sphere = point.position.distance(center) - 1.0;
                // f is linear between points of a sphere: no error at all in that plane.
                assert!(off_plane.abs() < 1e-6, "{off_plane}");
                assert!(off_sphere < 1e-6 && off_sphere > -sagitta, "{off_sphere}");
            }
        }
    }
}

#[test]
fn an_orthographic_eye_sees_a_spheres_equator() {
    let shape = sphere(24, DVec3::ZERO, 2.0);
    for eye in eyes(50, 1.0, 1.0) {
        let lines = contours_from(&shape, &View::orthographic(eye.as_vec3()).unwrap());
        assert_eq!(lines.len(), 1);
        let off = lines[0]
            .points
            .iter()
            .map(|p| p.position.dot(eye).abs())
            .fold(0.0, f64::max);
        assert!(off < 2e-3, "{off}");
    }
}

#[test]
fn an_ellipsoid_has_the_curve_of_its_polar_plane() {
    let axes = DVec3::new(1.0, 0.4, 0.7);
    let mut last = f64::INFINITY;
    for count in [8, 16, 32] {
        let shape = ellipsoid(count, DVec3::ZERO, axes);
        let mut worst = 0.0_f64;
        for eye in eyes(60, 1.5, 6.0) {
            let lines = contours_from(&shape, &view_from(eye));
            assert_eq!(lines.len(), 1);
            assert!(lines[0].closed);
            // sum p_i e_i / a_i^2 = 1, as a distance from that plane.
            let polar = eye / (axes * axes);
            let off = |p: DVec3| ((p.dot(polar) - 1.0) / polar.length()).abs();
            worst = lines[0]
                .points
                .iter()
                .map(|p| off(p.position))
                .fold(worst, f64::max);
        }
        // Halved triangles: a quarter of the error.
        assert!(worst < last / 3.0, "{count}: {worst} after {last}");
        last = worst;
    }
    assert!(last < 2e-3, "{last}");
}

/// The closed form of the torus: n . (eye - p) at angles u, v, where n . p = R cos v + r.
fn torus_facing(eye: DVec3, large: f64, small: f64, point: DVec3) -> f64 {
    let ring = DVec3::new(point.x, point.y, 0.0).normalize();
    let normal = (point - ring * large).normalize();
    normal.dot(eye) - large * normal.dot(ring) - small
}

/// How many loops the torus' contour has. At angle u around the axis f = A cos v + e_z sin v - r with A = rho cos(u - u_e) - R, which has two zeros where A^2 + e_z^2 > r^2. So
/// there are two loops, of the near and the far half, unless the nearest circle of the tube is around the eye.
fn torus_loops(eye: DVec3, large: f64, small: f64) -> usize {
    let from_tube = (eye.truncate().length() - large).hypot(eye.z);
    if from_tube < small { 1 } else { 2 }
}

#[test]
fn ten_thousand_eyes_miss_no_loop_of_a_torus() {
    let [large, small] = [1.0, 0.35];
    let shape = torus([48, 32], large, small);
    let surface = shape.surface();
    let mut worst = 0.0_f64;
    let mut counts = [0; 3];
    let bound = (std::f64::consts::TAU / 32.0).powi(2) * 0.5;
    for eye in eyes(10_000, 0.0, 5.0) {
        // Where an eye is just at the surface, triangles decide.
        let from_tube = (eye.truncate().length() - large).hypot(eye.z);
        if (from_tube - small).abs() < 0.03 {
            continue;
        }
        let view = view_from(eye);
        let lines = contours(&surface, &view, &facing(&surface, &view)).unwrap();
        let loops = torus_loops(eye.as_vec3().as_dvec3(), large, small);
        assert_eq!(lines.len(), loops, "{eye}");
        counts[loops] += 1;
        for line in &lines {
            assert!(line.closed, "{eye}");
            for point in line.points.iter().step_by(7) {
                // f of linear triangles against that of the surface, in units of the eye's distance.
                let distance = point.position.distance(eye) + small;
                worst =
                    worst.max((torus_facing(eye, large, small, point.position) / distance).abs());
            }
        }
    }
    assert!(counts[1] > 50 && counts[2] > 9000, "{counts:?}");
    assert!(worst < bound, "{worst}");
}

#[test]
fn cusps_of_a_torus_are_where_the_line_of_sight_is_asymptotic() {
    // Seen from a side a little above, the inner loop has four cusps.
    let [large, small] = [1.0, 0.35];
    let shape = torus([256, 128], large, small);
    let eye = DVec3::new(0.0, -4.0, 1.2);
    let lines = contours_from(&shape, &view_from(eye));
    let mut cusps = 0;
    for line in &lines {
        for i in 0..line.segments.len() {
            let next = (i + 1) % line.segments.len();
            if line.segments[i].folded == line.segments[next].folded {
                continue;
            }
            cusps += 1;
            // Normal curvature along the line of sight: cos v / (R + r cos v) around the axis, 1 / r around the tube.
            let p = line.points[next].position;
            let ring = DVec3::new(p.x, p.y, 0.0).normalize();
            let normal = (p - ring * large).normalize();
            let around = DVec3::new(-ring.y, ring.x, 0.0);
            let along = (eye - p).normalize();
            let bend = normal.dot(ring) / p.truncate().length() * along.dot(around).powi(2)
                + along.dot(around.cross(normal)).powi(2) / small;
            assert!(bend.abs() < 0.05, "{bend} at {p}");
        }
    }
    assert_eq!(cusps, 4);
}

#[test]
fn curvatures_are_those_of_the_torus() {
    let [large, small] = [1.0, 0.35];
    let shape = torus([96, 64], large, small);
    let surface = shape.surface();
    for (curvature, position) in curvatures(&surface).iter().zip(surface.positions()) {
        let p = position.as_dvec3();
        let ring = DVec3::new(p.x, p.y, 0.0).normalize();
        let normal = (p - ring * large).normalize();
        let expected = [1.0 / small, normal.dot(ring) / p.truncate().length()];
        for i in 0..2 {
            assert!(
                (curvature.principal[i] - expected[i]).abs() < 0.02,
                "{curvature:?} {expected:?}"
            );
        }
        // The smaller one goes around the axis.
        let around = DVec3::new(-ring.y, ring.x, 0.0);
        assert!(curvature.directions[1].dot(around).abs() > 0.999);
        assert!((curvature.second_form(around * 2.0) - 4.0 * expected[1]).abs() < 0.1);
    }
}

#[test]
fn a_cube_has_twelve_creases_and_a_square_four_borders() {
    let shape = cube(Vec3::ZERO, Vec3::ONE).sharp();
    let surface = shape.surface();
    let lines = creases(&surface, TURN_COSINE);
    assert_eq!(lines.len(), 12);
    let mut middles: Vec<[i32; 3]> = lines
        .iter()
        .map(|line| {
            assert!(!line.closed && line.segments.len() == 1);
            (line.position(0.5) * 2.0)
                .to_array()
                .map(|c| c.round() as i32)
        })
        .collect();
    middles.sort_unstable();
    middles.dedup();
    assert_eq!(middles.len(), 12, "once each");
    assert!(borders(&surface, TURN_COSINE).is_empty());
    // Its faces are flat: each faces the eye or doesn't.
    assert!(contours_from(&shape, &view_from(DVec3::new(3.0, 2.0, -4.0))).is_empty());

    let sheet = grid([5, 5], [false, false], |u, v| DVec3::new(u, v, 0.0)).sharp();
    let edges = borders(&sheet.surface(), TURN_COSINE);
    assert_eq!(edges.len(), 4);
    assert!(edges.iter().all(|edge| edge.segments.len() == 5));
    assert!(creases(&sheet.surface(), TURN_COSINE).is_empty());
    // Where chains may turn as they like, the border is one.
    let edges = borders(&sheet.surface(), -1.0);
    assert!(edges.len() == 1 && edges[0].closed && edges[0].segments.len() == 20);

    let rims = borders(&cup(40, 12).surface(), TURN_COSINE);
    let rim = rims.iter().max_by_key(|rim| rim.points.len()).unwrap();
    assert!(rim.closed && rim.segments.len() == 40);
}

#[test]
fn ways_up_and_down_end_on_the_contour_straight_beside_them() {
    let shape = sphere(24, DVec3::ZERO, 1.0);
    let surface = shape.surface();
    let eye = DVec3::new(0.0, 0.0, 5.0);
    let view = view_from(eye);
    let values = facing(&surface, &view);
    let mut ended = 0;
    for triangle in 0..shape.topology.triangles().len() as u32 {
        let from = Place {
            triangle,
            weights: DVec3::new(0.5, 0.2, 0.3),
        };
        let point = surface.point(from);
        // The contour is where z = 1/5: this far from it around the sphere.
        let way = (point.z.atan2(point.truncate().length()) - 0.2_f64.asin()).abs();
        let reach = 0.1;
        let Some(to) = walk_to_zero(&surface, &values, &view, from, reach) else {
            assert!(
                view.image_distance(point, on_contour(point)) > 0.9 * reach || way > 0.5,
                "{point}"
            );
            continue;
        };
        ended += 1;
        let end = surface.point(to);
        assert!((end.z - 0.2).abs() < 1e-5, "{end}");
        // Along a meridian, but for the triangles.
        let turn = end
            .truncate()
            .normalize()
            .distance(point.truncate().normalize());
        assert!(turn < 0.12 * way + 0.01, "{point} {end}");
    }
    assert!(ended > 500, "{ended}");
}

/// The point of the contour of a sphere around 0 seen from (0, 0, 5) that is on the same meridian.
fn on_contour(point: DVec3) -> DVec3 {
    (point.truncate().normalize() * (1.0_f64 - 0.04).sqrt()).extend(0.2)
}
