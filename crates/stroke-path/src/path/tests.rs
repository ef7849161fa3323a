use super::*;
use crate::camera::OrbitView;
use glam::DVec3;
use proptest::prelude::*;

mod cut;

const PARTICLES: PathKind = PathKind::Linear { subdivision: 1 };
const SPLINE: PathKind = PathKind::CatmullRom { subdivision: 5 };
const KINDS: [PathKind; 4] = [
    PARTICLES,
    PathKind::Linear { subdivision: 3 },
    SPLINE,
    PathKind::CatmullRom { subdivision: 64 },
];

/// 2 m in front of the origin, 200 x 100 pixels, 50 pixels to the metre at 1 m.
fn camera(near_m: f32) -> Camera {
    let view = OrbitView {
        target: Vec3::ZERO,
        yaw_degrees: 0.0,
        pitch_degrees: 0.0,
        distance_m: 2.0,
        vertical_fov_degrees: 90.0,
    };
    Camera::orbit(view, [200, 100], near_m).unwrap()
}

fn paths_of(particles: &[Vec3], kind: PathKind) -> Paths {
    let mut paths = Paths::new();
    paths.push_strand(7, particles, kind, &camera(0.5)).unwrap();
    paths
}

fn interpolate(paths: &Paths, arc: f32) -> Option<Vec3> {
    let segments = paths.runs.iter().flat_map(|run| {
        let joints = run.joints.clone();
        joints.clone().zip(joints.skip(1))
    });
    for (a, b) in segments {
        let (from, to) = (paths.arc_length[a], paths.arc_length[b]);
        if (from..=to).contains(&arc) && to > from {
            let t = (arc - from) / (to - from);
            return Some(paths.position[a].lerp(paths.position[b], t));
        }
    }
    None
}

/// What holds of any paths.
fn check_invariants(paths: &Paths, near_m: f32) {
    let joints = paths.len();
    for len in [
        paths.u.len(),
        paths.arc_length.len(),
        paths.forward.len(),
        paths.backward.len(),
        paths.center.len(),
        paths.depth.len(),
        paths.px_per_metre.len(),
        paths.across.len(),
    ] {
        assert_eq!(len, joints);
    }
    for j in 0..joints {
        assert!(paths.position[j].is_finite());
        assert!(paths.arc_length[j].is_finite() && paths.arc_length[j] >= 0.0);
        assert!((0.0..=1.0).contains(&paths.u[j]));
        assert!((paths.forward[j].length() - 1.0).abs() < 1e-5);
        assert!((paths.backward[j].length() - 1.0).abs() < 1e-5);
        assert!((paths.across[j].length() - 1.0).abs() < 1e-5);
        assert!(paths.center[j].is_finite());
        assert!(paths.depth[j].is_finite() && paths.depth[j] >= near_m);
        assert!(paths.px_per_metre[j].is_finite() && paths.px_per_metre[j] >= 0.0);
    }
    let mut end = 0;
    for run in &paths.runs {
        assert_eq!(run.joints.start, end, "runs lie end to end");
        end = run.joints.end;
        assert!(!run.joints.is_empty());
        assert!(paths.u[run.joints.clone()].is_sorted());
        assert!(paths.arc_length[run.joints.clone()].is_sorted());
    }
    assert_eq!(end, joints);
}

#[test]
fn a_hanging_strand_has_known_attributes() {
    let particles = [Vec3::ZERO, Vec3::NEG_Y, Vec3::new(0.0, -1.0, 1.0)];
    let paths = paths_of(&particles, PARTICLES);
    check_invariants(&paths, 0.5);
    assert_eq!(
        paths.runs,
        [PathRun {
            strand: 7,
            piece: 7,
            joints: 0..3,
            overlap: 0,
        }]
    );
    assert_eq!(paths.position, particles);
    assert_eq!(paths.u, [0.0, 0.5, 1.0]);
    assert_eq!(paths.arc_length, [0.0, 1.0, 2.0]);
    assert_eq!(paths.forward, [Vec3::NEG_Y, Vec3::Z, Vec3::Z]);
    assert_eq!(paths.backward, [Vec3::Y, Vec3::Y, Vec3::NEG_Z]);
    assert_eq!(paths.depth, [2.0, 2.0, 1.0]);
    for (j, (y, px)) in [(50.0, 25.0), (75.0, 25.0), (100.0, 50.0)]
        .into_iter()
        .enumerate()
    {
        assert!(paths.center[j].distance(Vec2::new(100.0, y)) < 1e-4);
        assert!((paths.px_per_metre[j] - px).abs() < 1e-4);
        assert!(paths.across[j].distance(Vec2::NEG_X) < 1e-6);
    }
}

#[test]
fn short_strands() {
    for kind in KINDS {
        assert!(paths_of(&[], kind).runs.is_empty());
        let one = paths_of(&[Vec3::X], kind);
        check_invariants(&one, 0.5);
        assert_eq!(one.runs.len(), 1);
        assert_eq!((one.len(), one.u[0], one.arc_length[0]), (1, 0.0, 0.0));
        assert_eq!((one.forward[0], one.backward[0]), (Vec3::NEG_Y, Vec3::Y));
        let subdivision = kind.subdivision().unwrap() as usize;
        let two = paths_of(&[Vec3::ZERO, Vec3::X], kind);
        check_invariants(&two, 0.5);
        assert_eq!(two.len(), subdivision + 1);
        assert!((two.arc_length[subdivision] - 1.0).abs() < 1e-5);
        let three = paths_of(&[Vec3::ZERO, Vec3::X, Vec3::Y], kind);
        check_invariants(&three, 0.5);
        assert_eq!(three.len(), 2 * subdivision + 1);
    }
}

#[test]
fn coinciding_particles_take_the_nearest_direction() {
    let x = Vec3::X;
    let doubled = [Vec3::ZERO, Vec3::ZERO, x, x, x, x + Vec3::Y, x + Vec3::Y];
    let paths = paths_of(&doubled, PARTICLES);
    check_invariants(&paths, 0.5);
    let (f, b) = (&paths.forward, &paths.backward);
    assert_eq!(f[..2], [Vec3::X; 2]);
    assert_eq!(f[2..], [Vec3::Y; 5]);
    assert_eq!(b[..5], [Vec3::NEG_X; 5]);
    assert_eq!(b[5..], [Vec3::NEG_Y; 2]);
    for kind in KINDS {
        let paths = paths_of(&doubled, kind);
        check_invariants(&paths, 0.5);
        let point = paths_of(&[x; 4], kind);
        check_invariants(&point, 0.5);
        assert!(point.forward.iter().all(|f| *f == Vec3::NEG_Y));
        assert!(point.backward.iter().all(|b| *b == Vec3::Y));
    }
}

#[test]
fn the_near_plane_cuts_and_interpolates() {
    // The plane z = 1.5 is the near plane. Seen, away, seen again.
    let particles = [
        Vec3::new(0.0, 0.0, 1.0),
        Vec3::new(0.0, 2.0, 2.0),
        Vec3::new(4.0, 2.0, 3.0),
        Vec3::new(4.0, -1.0, 0.0),
    ];
    let paths = paths_of(&particles, PARTICLES);
    check_invariants(&paths, 0.5);
    let joints: Vec<_> = paths.runs.iter().map(|r| r.joints.clone()).collect();
    assert_eq!(joints, [0..2, 2..4]);
    assert_eq!(paths.position[1], Vec3::new(0.0, 1.0, 1.5));
    assert_eq!(paths.depth[1..3], [0.5, 0.5]);
    assert!((paths.u[1] - 0.5 / 3.0).abs() < 1e-6);
    assert!((paths.arc_length[1] - 5.0_f32.sqrt() / 2.0).abs() < 1e-6);
    // Half a metre above the axis at half a metre's depth, 50 pixels to the metre at 1 m.
    assert!(paths.center[1].distance(Vec2::new(100.0, -50.0)) < 1e-3);
    let f = [particles[1] - particles[0], particles[2] - particles[1]].map(Vec3::normalize);
    assert!(paths.forward[1].distance((f[0] + f[1]).normalize()) < 1e-6);
    assert!(paths.position[2].distance(Vec3::new(4.0, 0.5, 1.5)) < 1e-6);
    assert!((paths.u[2] - 2.5 / 3.0).abs() < 1e-6);

    let behind = paths_of(&particles[1..3], SPLINE);
    assert!(behind.runs.is_empty() && behind.is_empty());
    assert_eq!(behind.dropped(), 0);
}

#[test]
fn touching_the_near_plane_is_not_seen() {
    let touch = [Vec3::Z * 3.0, Vec3::Z * 1.5, Vec3::new(1.0, 0.0, 3.0)];
    assert!(paths_of(&touch, PARTICLES).runs.is_empty());
    assert!(paths_of(&touch[1..2], PARTICLES).runs.is_empty());
}

#[test]
fn a_strand_along_the_line_of_sight_keeps_its_side() {
    let at = Vec3::new;
    // Straight at the eye from the start: +x.
    let paths = paths_of(&[at(0.0, 0.0, 0.0), at(0.0, 0.0, 1.0)], SPLINE);
    assert!(paths.across.iter().all(|a| *a == Vec2::X));
    // Off the axis, along the ray to the eye, after a piece that runs to the right.
    let particles = [at(0.0, 1.0, 0.0), at(0.5, 1.0, 0.0), at(0.25, 0.5, 1.0)];
    let paths = paths_of(&particles, PARTICLES);
    assert!(paths.across[0].distance(Vec2::Y) < 1e-6);
    assert_eq!(paths.across[1..], [paths.across[0]; 2]);
}

#[test]
fn far_strands_are_dropped_and_counted() {
    let mut paths = paths_of(&[Vec3::ZERO, Vec3::X], PARTICLES);
    let before = paths.clone();
    let far = [Vec3::ZERO, Vec3::splat(f32::MAX)];
    for kind in KINDS {
        paths.push_strand(8, &far, kind, &camera(0.5)).unwrap();
    }
    assert_eq!(paths.dropped(), KINDS.len());
    assert_eq!(paths.runs, before.runs);
    check_invariants(&paths, 0.5);
    paths.clear();
    assert_eq!((paths.dropped(), paths.len()), (0, 0));
}

#[test]
fn a_bad_subdivision_appends_nothing() {
    let mut paths = paths_of(&[Vec3::ZERO, Vec3::X], PARTICLES);
    let kind = PathKind::CatmullRom { subdivision: 65 };
    let refused = paths.push_strand(8, &[Vec3::ZERO], kind, &camera(0.5));
    assert_eq!(refused, Err(PathError::Subdivision(65)));
    assert_eq!((paths.runs.len(), paths.len()), (1, 2));
}

#[test]
fn memory_is_kept() {
    let strand: Vec<Vec3> = (0..20).map(|i| Vec3::Y * (i as f32 * -0.1)).collect();
    let mut paths = paths_of(&strand, SPLINE);
    let capacities = |p: &Paths| {
        [
            p.position.capacity(),
            p.across.capacity(),
            p.whole.capacity(),
        ]
    };
    let before = capacities(&paths);
    assert!(before.iter().all(|capacity| *capacity > 0));
    for len in [20, 1, 20, 3] {
        paths.clear();
        paths
            .push_strand(1, &strand[..len], SPLINE, &camera(0.5))
            .unwrap();
        assert_eq!(capacities(&paths), before);
    }
}

/// Points within the picture, beside it, and behind the camera.
fn near_points(len: Range<usize>) -> impl Strategy<Value = Vec<Vec3>> {
    prop::collection::vec(
        prop::array::uniform3(-3.0..3.0_f32).prop_map(Vec3::from),
        len,
    )
}

/// Finite points of every size, with many that coincide.
fn hostile_points() -> impl Strategy<Value = Vec<Vec3>> {
    let number = prop_oneof![
        Just(0.0_f32),
        Just(1.5),
        Just(f32::MAX),
        Just(f32::MIN_POSITIVE),
        -1e-20..1e-20_f32,
        -3.0..3.0_f32,
        -1e12..1e12_f32,
        any::<f32>().prop_filter("finite", |x| x.is_finite()),
    ];
    let point = prop_oneof![
        prop::array::uniform3(number).prop_map(Vec3::from),
        Just(Vec3::ZERO),
        Just(Vec3::new(0.0, 0.0, 1.5)),
    ];
    prop::collection::vec(point, 0..12)
}

proptest! {
    #[test]
    fn hostile_points_make_finite_paths_or_none(
        strands in prop::collection::vec(hostile_points(), 1..4),
        kind in prop::sample::select(KINDS.to_vec()),
        near_m in prop_oneof![Just(0.5_f32), Just(1e-30), Just(1e30)],
    ) {
        let mut paths = Paths::new();
        for (i, particles) in strands.iter().enumerate() {
            paths.push_strand(i, particles, kind, &camera(near_m)).unwrap();
            check_invariants(&paths, near_m);
        }
    }

    #[test]
    fn paths_pass_through_their_particles(
        particles in near_points(1..9),
        kind in prop::sample::select(KINDS.to_vec()),
    ) {
        // From far enough to see all of it.
        let camera = Camera::orbit(
            OrbitView {
                target: Vec3::ZERO,
                yaw_degrees: 20.0,
                pitch_degrees: -10.0,
                distance_m: 20.0,
                vertical_fov_degrees: 30.0,
            },
            [64, 64],
            0.1,
        ).unwrap();
        let mut paths = Paths::new();
        paths.push_strand(0, &particles, kind, &camera).unwrap();
        check_invariants(&paths, 0.1);
        prop_assert_eq!(paths.runs.len(), 1);
        let subdivision = kind.subdivision().unwrap() as usize;
        let last = particles.len() - 1;
        prop_assert_eq!(paths.len(), last * subdivision + 1);
        for (i, particle) in particles.iter().enumerate() {
            prop_assert_eq!(paths.position[i * subdivision], *particle);
            let u = i as f32 / last.max(1) as f32;
            prop_assert_eq!(paths.u[i * subdivision], u);
        }
        prop_assert!(paths.u.windows(2).all(|u| u[0] < u[1]));
        for j in 1..paths.len() {
            let step = paths.position[j] - paths.position[j - 1];
            let length = paths.arc_length[j] - paths.arc_length[j - 1];
            prop_assert!((length - step.length()).abs() < 1e-5);
            if step.length() > 1e-3 {
                prop_assert!(paths.forward[j - 1].distance(step.normalize()) < 1e-5);
                prop_assert!(paths.backward[j].distance(-step.normalize()) < 1e-5);
            }
        }
    }

    /// Clipping against brute force: every point of the path is in a run or not by its depth.
    #[test]
    fn runs_are_what_is_in_front(particles in near_points(2..9)) {
        let paths = paths_of(&particles, PARTICLES);
        check_invariants(&paths, 0.5);
        prop_assert!(paths.runs.iter().all(|run| run.joints.len() >= 2));
        let mut arc = 0.0;
        for p in particles.windows(2) {
            let length = p[0].distance(p[1]);
            for k in 0..40 {
                let t = k as f32 / 40.0;
                let point = p[0].lerp(p[1], t);
                let depth = camera(0.5).depth(point);
                let found = interpolate(&paths, arc + length * t);
                if depth > 0.5 + 1e-3 {
                    let found = found.expect("a point in front is in a run");
                    prop_assert!(found.distance(point) < 1e-3);
                } else if depth < 0.5 - 1e-3 {
                    // A neighbouring run may still hold its own end.
                    prop_assert!(found.is_none_or(|f| f.distance(point) < 2e-3 + length * 1e-3), "{point}");
                }
            }
            arc += length;
        }
    }

    #[test]
    fn parts_are_put_together_as_if_made_at_once(
        strands in prop::collection::vec(near_points(0..9), 1..6),
        first in 0..6usize,
    ) {
        let push = |paths: &mut Paths, strand: usize| {
            let particles = &strands[strand];
            let middle = (2 * particles.len()).saturating_sub(2) / 2;
            let cut = Cut { at: middle, overlap: middle..=middle };
            let cuts = if particles.len() > 2 { vec![cut] } else { Vec::new() };
            paths.push_pieces(strand, particles, &cuts, None, SPLINE, &camera(0.5)).unwrap();
        };
        let (mut whole, mut start, mut rest) = (Paths::new(), Paths::new(), Paths::new());
        for strand in 0..strands.len() {
            push(&mut whole, strand);
            push(if strand < first { &mut start } else { &mut rest }, strand);
        }
        start.append(&rest);
        prop_assert_eq!(&start.runs, &whole.runs);
        prop_assert_eq!((start.len(), start.dropped()), (whole.len(), whole.dropped()));
        prop_assert_eq!(&start.position, &whole.position);
        prop_assert_eq!(&start.across, &whole.across);
        prop_assert_eq!(&start.px_per_metre, &whole.px_per_metre);
        // What is appended behind goes on from there.
        push(&mut start, strands.len() - 1);
        push(&mut whole, strands.len() - 1);
        prop_assert_eq!(start.runs, whole.runs);
    }

    /// Cutting adds joints; it changes none.
    #[test]
    fn clipping_keeps_the_attributes_of_the_whole_strand(particles in near_points(1..9)) {
        let whole = {
            let mut paths = Paths::new();
            let far = Camera::orbit(
                OrbitView {
                    target: Vec3::ZERO,
                    yaw_degrees: 0.0,
                    pitch_degrees: 0.0,
                    distance_m: 20.0,
                    vertical_fov_degrees: 30.0,
                },
                [64, 64],
                0.1,
            ).unwrap();
            paths.push_strand(0, &particles, SPLINE, &far).unwrap();
            paths
        };
        let cut = paths_of(&particles, SPLINE);
        let seen: Vec<usize> = (0..whole.len())
            .filter(|&j| camera(0.5).depth(whole.position[j]) > 0.5)
            .collect();
        let kept: Vec<usize> = (0..cut.len()).filter(|&j| cut.depth[j] > 0.5).collect();
        prop_assert_eq!(seen.len(), kept.len());
        for (&w, &c) in seen.iter().zip(&kept) {
            prop_assert_eq!(whole.position[w], cut.position[c]);
            prop_assert_eq!(whole.u[w], cut.u[c]);
            prop_assert_eq!(whole.arc_length[w], cut.arc_length[c]);
            prop_assert_eq!(whole.forward[w], cut.forward[c]);
            prop_assert_eq!(whole.backward[w], cut.backward[c]);
        }
    }

    /// Against a small step along F, projected in f64.
    #[test]
    fn across_is_perpendicular_on_the_screen(particles in near_points(2..6)) {
        let camera = camera(0.5);
        let paths = paths_of(&particles, PARTICLES);
        let screen = |p: DVec3| {
            let depth = 2.0 - p.z;
            glam::DVec2::new(p.x, -p.y) * f64::from(camera.focal_px()) / depth
        };
        for j in 0..paths.len() {
            let (at, f) = (paths.position[j].as_dvec3(), paths.forward[j].as_dvec3());
            let step = (screen(at + f * 1e-6) - screen(at - f * 1e-6)) / 2e-6;
            // Pixels per metre along the strand; 0 along the line of sight.
            if step.length() > 0.1 {
                let across = paths.across[j].as_dvec2();
                prop_assert!((across - step.normalize().perp()).length() < 1e-3);
            }
        }
    }
}
