//! Hair that a body presses on another, or whose roots it swallows: there may be no place in which it is out of both.

use glam::{DVec3, Vec3};
use hair_sim::{Collider, Params, Pose, Shape, SignedDistance, Solver, Strands, Surroundings};

use crate::farthest;

/// The radius of what hair is rooted on, m.
const HEAD: f64 = 0.1;
const FRAME_S: f64 = 1.0 / 24.0;

/// Strands of twelve links that stand off the top of a ball, and fall down on its right side.
fn hair() -> Strands {
    let mut strands = Strands::new();
    for i in 0..8 {
        let angle = 0.12 * (i as f32 - 3.5);
        let root = Vec3::new(0.08, 0.064, 0.0) + Vec3::Z * 0.1 * angle;
        let points = (0..=12).map(|k| root + Vec3::new(0.7, -0.7, angle) * 0.025 * k as f32);
        strands.push(i, &points.collect::<Vec<_>>(), None).unwrap();
    }
    strands
}

/// A ball around the origin, of that radius in m.
fn ball<'a>(radius: f64) -> Shape<'a> {
    Shape::Sphere {
        center: DVec3::ZERO,
        radius,
    }
}

/// The same as a mesh.
fn ball_of_triangles(radius: f64) -> SignedDistance {
    let (rings, around) = (24_u32, 48_u32);
    let point = |i: u32, j: u32| {
        let [polar, angle] = [i as f32 / rings as f32 * 0.5, j as f32 / around as f32]
            .map(|part| part * std::f32::consts::TAU);
        let level = polar.sin();
        Vec3::new(level * angle.cos(), polar.cos(), level * angle.sin()) * radius as f32
    };
    let points: Vec<Vec3> = (0..=rings)
        .flat_map(|i| (0..around).map(move |j| point(i, j)))
        .collect();
    let triangles: Vec<[u32; 3]> = (0..rings * around)
        .flat_map(|i| {
            let [a, b] = [i, i / around * around + (i + 1) % around];
            [[a, b, b + around], [a, b + around, a + around]]
        })
        .collect();
    SignedDistance::new(&points, &triangles, radius / 18.0).unwrap()
}

/// How far a particle goes at most in a frame, m: while a ball of that radius comes in from the right within a second, to where it lies `gap` m from the
/// head, `height` m above its middle, and in the last of twenty seconds.
fn moves([head, comes]: [Shape; 2], [radius, gap, height]: [f64; 3]) -> [f64; 2] {
    let params = Params {
        natural: hair_sim::Natural::Styled,
        ..Params::default()
    };
    let (mut solver, mut state) = Solver::new(&hair(), &params).unwrap();
    let head = Collider::fixed(head, Pose::IDENTITY);
    let apart = HEAD + gap + radius;
    let end = DVec3::new((apart * apart - height * height).sqrt(), height, 0.0);
    let place = |time: f64| Pose {
        translation: end + DVec3::X * 0.5 * (1.0 - time.min(1.0)),
        ..Pose::IDENTITY
    };
    let mut most = [0.0_f64; 2];
    for frame in 0..480 {
        let times = [frame, frame + 1].map(|frame| f64::from(frame) * FRAME_S);
        let comes = Collider {
            shape: comes,
            before: place(times[0]),
            now: place(times[1]),
            was: None,
        };
        let surroundings = Surroundings {
            colliders: &[head, comes],
            ..Surroundings::default()
        };
        let before: Vec<_> = (0..8)
            .map(|i| solver.points(&state, i).collect::<Vec<_>>())
            .collect();
        solver.step(&mut state, &surroundings, FRAME_S).unwrap();
        for (i, before) in before.iter().enumerate() {
            let now: Vec<_> = solver.points(&state, i).collect();
            let part = usize::from(frame >= 456);
            most[part] = most[part].max(farthest(before, &now));
        }
    }
    most
}

/// Held by the plane of one body alone, what lies between two was thrown from one to the other, by up to 10 cm a frame, for ever.
#[test]
fn what_is_pressed_between_two_bodies_comes_to_rest() {
    let mut worst = 0.0_f64;
    for radius in [0.03, 0.06, 0.12] {
        for gap in [0.002, 0.0, -0.01, -0.03, -0.06] {
            for height in [0.0, 0.05, -0.05, 0.064] {
                let [comes, rests] = moves([HEAD, radius].map(ball), [radius, gap, height]);
                println!(
                    "{radius} {gap:.3} {height:.2}: {:.1} {:.3} mm",
                    comes * 1e3,
                    rests * 1e3
                );
                worst = worst.max(rests);
            }
        }
    }
    assert!(worst < 1e-4, "{worst}");
}

/// So were meshes, between which a particle had but one plane: by up to 1 cm.
#[test]
fn what_is_pressed_between_two_meshes_comes_to_rest() {
    let head = ball_of_triangles(HEAD);
    let mut worst = 0.0_f64;
    for radius in [0.03, 0.06] {
        let other = ball_of_triangles(radius);
        let meshes = [&head, &other].map(Shape::Grid);
        for gap in [0.002, -0.01, -0.03] {
            for height in [0.05, 0.064] {
                let [comes, rests] = moves(meshes, [radius, gap, height]);
                println!(
                    "{radius} {gap:.3} {height:.2}: {:.1} {:.3} mm",
                    comes * 1e3,
                    rests * 1e3
                );
                worst = worst.max(rests);
            }
        }
    }
    assert!(worst < 1e-4, "{worst}");
}

/// A ball that swallows the roots of hair lets it out by and by. What was to be out at once stood on end.
#[test]
fn what_is_rooted_in_a_body_is_not_pulled_taut() {
    let root = Vec3::new(0.0, 0.06, 0.0);
    let points: Vec<Vec3> = (0..=12)
        .map(|k| root + Vec3::X * 0.025 * k as f32)
        .collect();
    let mut strands = Strands::new();
    strands.push(0, &points, None).unwrap();
    let (mut solver, mut state) = Solver::new(&strands, &Params::default()).unwrap();
    let place = |time: f64| Pose {
        translation: DVec3::NEG_Y * 0.3 * (1.0 - time).max(0.0),
        ..Pose::IDENTITY
    };
    for frame in 0..120 {
        let times = [frame, frame + 1].map(|frame| f64::from(frame) * FRAME_S);
        let comes = Collider {
            shape: ball(HEAD),
            before: place(times[0]),
            now: place(times[1]),
            was: None,
        };
        let surroundings = Surroundings {
            colliders: &[comes],
            ..Surroundings::default()
        };
        solver.step(&mut state, &surroundings, FRAME_S).unwrap();
    }
    let points: Vec<DVec3> = solver.points(&state, 0).collect();
    let upright = (points[2] - points[0]).y / 0.05;
    assert!(upright < 0.6, "{upright}");
    for (k, point) in points.iter().enumerate().skip(5) {
        assert!(point.length() > HEAD, "{k}: {}", point.length());
    }
}
