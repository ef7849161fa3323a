//! Whatever the mesh and the eye: an answer or an error, soon.

mod shapes;

use glam::{DVec3, Vec3};
use mesh_lines::{
    Bvh, Frame, Line, MeshError, Span, Surface, TURN_COSINE, Topology, Tracker, View, borders,
    contours, creases, curvatures, facing, visible,
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
            span.start < span.end && span.end <= span.start + count && span.start >= 0.0,
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
    for shortest in [-1.0, f64::NAN, f64::INFINITY] {
        let error = visible(&surface, &shape.bvh(), &view, &[], shortest).unwrap_err();
        assert_eq!(
            error.to_string(),
            "the shortest piece's length must be 0 or a positive, finite number"
        );
    }
    assert!(visible(&surface, &shape.bvh(), &view, &[], 0.0).is_ok());
}

/// A sphere's frame, changed; what the tracker says to it after the right one, and that it is as it was.
fn refusal(change: impl Fn(&mut Frame, &mut Vec<Line>, &mut Vec<Span>)) -> MeshError {
    let shape = sphere(6, DVec3::ZERO, 1.0);
    let surface = shape.surface();
    let view = from(Vec3::new(0.5, 1.0, 4.0));
    let values = facing(&surface, &view);
    let mut lines = shape.lines(&view);
    let mut spans = visible(&surface, &shape.bvh(), &view, &lines, 1e-3).unwrap();
    let (right_lines, right_spans) = (lines.clone(), spans.clone());
    let right = Frame {
        surface: &surface,
        view: &view,
        facing: &values,
        lines: &right_lines,
        spans: &right_spans,
        pixel: 1e-3,
        period_px: 100.0,
    };
    let mut tracker = Tracker::default();
    let before = tracker.step(&right).unwrap().to_vec();
    assert!(!before.is_empty());
    let mut wrong = right;
    change(&mut wrong, &mut lines, &mut spans);
    let error = tracker
        .step(&Frame {
            lines: &lines,
            spans: &spans,
            ..wrong
        })
        .unwrap_err();
    assert_eq!(tracker.paths(), before);
    let after = tracker.step(&right).unwrap();
    assert!(after.iter().all(|path| !path.is_new));
    error
}

#[test]
fn frames_that_do_not_fit_together_are_refused() {
    let span = MeshError::OtherSpan { span: 0 };
    let line = MeshError::OtherLine { line: 0 };
    assert_eq!(refusal(|_, _, spans| spans[0].line = 7), span);
    assert_eq!(refusal(|_, lines, _| lines.clear()), span);
    assert_eq!(refusal(|_, lines, _| lines[0].segments.clear()), span);
    for bad in [-1.0, 1e4, f64::NAN, f64::INFINITY] {
        assert_eq!(refusal(|_, _, spans| spans[0].start = bad), span);
        assert_eq!(refusal(|_, _, spans| spans[0].end = bad), span);
    }
    assert_eq!(refusal(|_, lines, _| lines[0].points.clear()), line);
    assert_eq!(
        refusal(|_, lines, _| lines[0].segments[3].triangle = 432),
        line
    );
    assert_eq!(
        refusal(|_, lines, _| lines[0].points[3].place.triangle = u32::MAX),
        line
    );
    for (error, message) in [
        (
            refusal(|_, lines, _| lines[0].points[3].position.x = f64::NAN),
            "a position of line 0 is NaN or infinite",
        ),
        (
            refusal(|frame, _, _| frame.period_px = 1e-310),
            "the length of span 0 is NaN or infinite",
        ),
        (
            refusal(|frame, _, _| frame.pixel = 1e-310),
            "the length of span 0 is NaN or infinite",
        ),
    ] {
        assert_eq!(error.to_string(), message);
    }
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert_eq!(
            refusal(|frame, _, _| frame.pixel = bad).to_string(),
            "a pixel's length must be a positive, finite number"
        );
    }
}

#[test]
fn a_tracker_is_of_one_mesh() {
    let mut tracker = Tracker::default();
    let view = from(Vec3::new(0.5, 1.0, 4.0));
    let mut step = |count: u32| {
        let shape = sphere(count, DVec3::ZERO, 1.0);
        let surface = shape.surface();
        let values = facing(&surface, &view);
        let lines = shape.lines(&view);
        let spans = visible(&surface, &shape.bvh(), &view, &lines, 1e-3).unwrap();
        let frame = Frame {
            surface: &surface,
            view: &view,
            facing: &values,
            lines: &lines,
            spans: &spans,
            pixel: 1e-3,
            period_px: 100.0,
        };
        tracker.step(&frame).map(<[_]>::len)
    };
    assert_eq!(step(6), Ok(1));
    for other in [5, 7] {
        assert_eq!(
            step(other),
            Err(MeshError::OtherMesh {
                triangles: (other * other * 12) as usize,
                triangles_before: 432,
                vertices: (other * other * 6 + 2) as usize,
                vertices_before: 218
            })
        );
    }
    assert_eq!(step(6), Ok(1));
}

#[test]
fn lines_of_another_mesh_are_refused() {
    let [small, large] = [4, 8].map(|count| sphere(count, DVec3::ZERO, 1.0));
    let view = from(Vec3::new(0.5, 1.0, 4.0));
    assert_eq!(
        visible(
            &small.surface(),
            &small.bvh(),
            &view,
            &large.lines(&view),
            0.0
        ),
        Err(MeshError::OtherLine { line: 0 })
    );
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

#[test]
fn a_million_faces_are_read_seen_and_followed() {
    let shape = sphere(410, DVec3::ZERO, 1.0);
    let count = shape.topology.triangles().len();
    assert!(count > 1_000_000, "{count}");
    all_of(
        &shape.topology,
        &shape.positions,
        &from(Vec3::new(3.0, 2.0, 1.0)),
    );
}

/// As files of characters hide parts: what is shrunk to a point takes no longer than where it is seen.
#[test]
fn what_is_shrunk_to_a_point_is_soon_done() {
    let (mut positions, mut triangles) = (Vec::new(), Vec::new());
    for i in 0..1_500u16 {
        let low = Vec3::new(f32::from(i % 40), f32::from(i / 40), 0.0);
        let one = cube(low, low + 0.5);
        let first = positions.len() as u32;
        positions.extend(&one.positions);
        let own = one.topology.triangles().iter();
        triangles.extend(own.map(|corners| corners.map(|corner| first + corner)));
    }
    let topology = Topology::new(&positions, &triangles).unwrap();
    let topology = topology.with_creases(&positions, TURN_COSINE).unwrap();
    let view = from(Vec3::new(15.0, 30.0, 60.0));
    // The shortest of three: something else may run beside.
    let took = |positions: &[Vec3]| {
        let tries = [(); 3].map(|()| {
            let start = std::time::Instant::now();
            all_of(&topology, positions, &view);
            start.elapsed().as_secs_f32()
        });
        tries.into_iter().fold(f32::INFINITY, f32::min)
    };
    let apart_s = took(&positions);
    let shrunk_s = took(&vec![Vec3::ONE; positions.len()]);
    assert!(
        shrunk_s < 2.0 * apart_s + 0.1,
        "{shrunk_s} s, {apart_s} s where they are apart"
    );
}

#[test]
fn needles_and_faces_on_edge_have_lines() {
    // A fan of needles in planes through the eye, and a sheet that is seen exactly from its side.
    let eye = Vec3::new(0.0, 0.0, 4.0);
    let mut positions = vec![Vec3::ZERO];
    let mut triangles = Vec::new();
    for i in 0..64 {
        let (sin, cos) = (i as f32 * 0.1).sin_cos();
        let first = positions.len() as u32;
        positions.push(Vec3::new(cos, sin, 0.0));
        positions.push(Vec3::new(cos, sin, 1e-6));
        triangles.push([0, first, first + 1]);
    }
    let first = positions.len() as u32;
    positions.extend(
        [
            [0.5, 0.0, -1.0],
            [0.5, 0.0, 1.0],
            [2.0, 0.0, 1.0],
            [2.0, 0.0, -1.0],
        ]
        .map(Vec3::from),
    );
    triangles.extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
    let topology = Topology::new(&positions, &triangles).unwrap();
    all_of(&topology, &positions, &from(eye));
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
