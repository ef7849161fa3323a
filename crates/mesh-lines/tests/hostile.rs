//! Whatever the mesh and the eye: an answer or an error, soon.

mod shapes;

use glam::{DVec3, Vec3};
use mesh_lines::{
    Bvh, Frame, MeshError, Surface, TURN_COSINE, Topology, Tracker, View, borders, contours,
    creases, curvatures, facing, visible,
};
use proptest::prelude::*;
use shapes::{bumpy, cube, eyes, sphere};

/// Everything that the crate does, once, and what holds of any result.
fn all_of(topology: &Topology, positions: &[Vec3], view: &View) {
    let surface = Surface::new(topology, positions).unwrap();
    let values = facing(&surface, view);
    let mut lines = contours(&surface, view, &values).unwrap();
    let ends = lines.iter().filter(|line| !line.closed).count();
    if (0..topology.triangles().len() as u32).all(|t| topology.is_closed(t))
        && topology.sharp().is_empty()
    {
        assert_eq!(ends, 0);
    }
    lines.extend(creases(&surface, TURN_COSINE));
    lines.extend(borders(&surface, TURN_COSINE));
    for line in &lines {
        assert_eq!(
            line.points.len(),
            line.segments.len() + usize::from(!line.closed)
        );
        assert!(
            line.points
                .iter()
                .all(|point| point.position.is_finite() && point.place.weights.is_finite())
        );
    }
    let bends = curvatures(&surface);
    assert!(
        bends
            .iter()
            .all(|bend| bend.principal.iter().all(|k| !k.is_nan()))
    );
    let spans = visible(&surface, &Bvh::new(&surface), view, &lines, 1e-3).unwrap();
    for span in &spans {
        let count = lines[span.line].segments.len() as f64;
        assert!(
            span.start < span.end && span.end - span.start <= count && span.start >= 0.0,
            "{span:?} {count}"
        );
    }
    let mut tracker = Tracker::default();
    for _ in 0..2 {
        let frame = Frame {
            surface: &surface,
            view,
            facing: &values,
            lines: &lines,
            spans: &spans,
            pixel: 1e-3,
            period_px: 100.0,
        };
        let paths = tracker.step(&frame).unwrap();
        assert!(
            paths
                .iter()
                .flat_map(|path| &path.joints)
                .all(|joint| joint.t.is_finite())
        );
    }
}

fn from(eye: Vec3) -> View {
    View::perspective(eye).unwrap()
}

#[test]
fn nothing_and_one_triangle() {
    all_of(&Topology::new(&[], &[]).unwrap(), &[], &from(Vec3::ONE));
    all_of(
        &Topology::new(&[Vec3::ONE; 4], &[]).unwrap(),
        &[Vec3::ONE; 4],
        &from(Vec3::ONE),
    );
    let positions = [Vec3::ZERO, Vec3::X, Vec3::Y];
    let topology = Topology::new(&positions, &[[0, 1, 2]]).unwrap();
    for eye in [
        Vec3::Z,
        -Vec3::Z,
        Vec3::X * 3.0,
        Vec3::ZERO,
        Vec3::new(0.2, 0.2, 0.0),
    ] {
        all_of(&topology, &positions, &from(eye));
    }
    all_of(&topology, &positions, &View::orthographic(Vec3::X).unwrap());
    // All in one point, and all in one line.
    all_of(&topology, &[Vec3::ONE; 3], &from(Vec3::ONE));
    all_of(
        &topology,
        &[Vec3::ZERO, Vec3::X, Vec3::X * 2.0],
        &from(Vec3::ONE),
    );
}

#[test]
fn a_contour_through_two_triangles_alone_has_finite_t() {
    let positions = [
        Vec3::new(-3.0, 3.0, 0.0),
        Vec3::new(0.0, 1.0, 0.0),
        Vec3::new(2.0, 2.0, 1.0),
        Vec3::new(3.0, 0.0, -3.0),
        Vec3::new(-2.0, 2.0, -1.0),
    ];
    let topology = Topology::new(&positions, &[[1, 4, 3], [4, 2, 0]]).unwrap();
    let eye = Vec3::new(-3.0, 2.0, 3.0);
    all_of(&topology, &positions, &from(eye));
    all_of(&topology, &positions, &View::orthographic(eye).unwrap());
}

#[test]
fn bad_numbers_are_named() {
    assert!(matches!(
        View::perspective(Vec3::NAN),
        Err(MeshError::NotFinite { what: "eye", .. })
    ));
    assert_eq!(View::orthographic(Vec3::ZERO), Err(MeshError::NoDirection));
    let bad = [Vec3::ZERO, Vec3::X * f32::INFINITY];
    assert_eq!(
        Topology::new(&bad, &[]).unwrap_err(),
        MeshError::NotFinite {
            what: "position",
            index: 1
        }
    );
    let shape = sphere(2, DVec3::ZERO, 1.0);
    let surface = shape.surface();
    let view = from(Vec3::X * 3.0);
    let mut values = facing(&surface, &view);
    values[3] = f64::NAN;
    assert_eq!(
        contours(&surface, &view, &values).unwrap_err().to_string(),
        "value 3 is NaN or infinite"
    );
    values.pop();
    assert!(matches!(
        contours(&surface, &view, &values),
        Err(MeshError::Count { .. })
    ));
    for shortest in [-1.0, f64::NAN] {
        assert!(visible(&surface, &shape.bvh(), &view, &[], shortest).is_err());
    }
}

#[test]
fn eyes_inside_on_and_at_huge_and_tiny_meshes() {
    for scale in [1e-30, 1e-6, 1.0, 1e9, 1e30] {
        let shape = bumpy(8).moved(|p| p * scale);
        let turned = cube(Vec3::splat(-0.7), Vec3::splat(0.9))
            .sharp()
            .moved(|p| p * scale);
        for shape in [shape, turned] {
            let mut eyes: Vec<Vec3> = eyes(12, 0.0, 3.0)
                .map(|eye| eye.as_vec3() * scale)
                .collect();
            eyes.extend([shape.positions[5], Vec3::ZERO, Vec3::splat(1e30)]);
            for eye in eyes {
                all_of(&shape.topology, &shape.positions, &from(eye));
            }
            all_of(
                &shape.topology,
                &shape.positions,
                &View::orthographic(Vec3::new(1e-30, 0.0, 1e-30)).unwrap(),
            );
        }
    }
}

#[test]
fn an_eye_inside_of_a_sphere_sees_nothing_of_it() {
    let shape = sphere(8, DVec3::ZERO, 1.0);
    let view = from(Vec3::new(0.2, 0.1, 0.0));
    assert!(shape.lines(&view).is_empty());
}

#[test]
fn an_inside_out_mesh_is_read_as_the_right_one() {
    let shape = bumpy(12);
    let inside_out: Vec<[u32; 3]> = shape
        .topology
        .triangles()
        .iter()
        .map(|&[a, b, c]| [b, a, c])
        .collect();
    let other = Topology::new(&shape.positions, &inside_out).unwrap();
    let view = from(Vec3::new(1.0, 2.0, 4.0));
    let seen = |topology: &Topology| {
        let surface = Surface::new(topology, &shape.positions).unwrap();
        let lines = contours(&surface, &view, &facing(&surface, &view)).unwrap();
        let spans = visible(&surface, &Bvh::new(&surface), &view, &lines, 0.0).unwrap();
        spans.iter().map(|span| span.end - span.start).sum::<f64>()
    };
    assert_eq!(seen(&other), seen(&shape.topology));
}

#[test]
fn many_edges_may_meet_in_a_vertex() {
    let count = 2_000;
    let mut positions = vec![Vec3::Y];
    positions.extend((0..count).map(|i| {
        let (sin, cos) = (i as f32 / count as f32 * std::f32::consts::TAU).sin_cos();
        Vec3::new(cos, (i % 2) as f32 * 0.01, sin)
    }));
    let triangles: Vec<[u32; 3]> = (0..count)
        .map(|i| [0, (i + 1) % count + 1, i + 1])
        .collect();
    let topology = Topology::new(&positions, &triangles)
        .unwrap()
        .with_creases(&positions, 0.999)
        .unwrap();
    assert!(topology.sharp().len() > 2_000);
    all_of(&topology, &positions, &from(Vec3::new(3.0, 2.0, 1.0)));
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 120, failure_persistence: None, ..ProptestConfig::default() })]

    /// Few vertices, many triangles, on a grid: non-manifold edges, repeated and flipped triangles, needles, triangles through each other, eyes in their planes.
    #[test]
    fn soups_have_lines(
        corners in prop::collection::vec(prop::array::uniform3(-3i8..4), 3..12),
        triangles in prop::collection::vec(prop::array::uniform3(0usize..100), 0..40),
        eye in prop::array::uniform3(-4i8..5),
        sharp in any::<bool>(),
    ) {
        let positions: Vec<Vec3> = corners.iter().map(|c| Vec3::from(c.map(f32::from))).collect();
        let triangles: Vec<[u32; 3]> = triangles.iter().map(|t| t.map(|v| (v % positions.len()) as u32)).collect();
        let mut topology = Topology::new(&positions, &triangles).unwrap();
        if sharp {
            topology = topology.with_creases(&positions, 0.7).unwrap();
        }
        let eye = Vec3::from(eye.map(f32::from));
        all_of(&topology, &positions, &from(eye));
        if let Ok(view) = View::orthographic(eye) {
            all_of(&topology, &positions, &view);
        }
    }
}
