//! What swings comes back to where it hangs, whatever presses on it.

use glam::{DQuat, DVec3, Vec3};
use hair_sim::{Anchor, Collider, Params, Pose, Roots, Shape, Solver, Strands, Surroundings};

use crate::{line, step_on};

/// From 0 to 1 as time does, without a jolt.
fn ease(t: f64) -> f64 {
    let t = t.min(1.0);
    3.0 * t * t - 2.0 * t * t * t
}

/// Thirty locks that keep out of each other, on a head that goes 25 cm aside in a quarter of a second. They press on each other as they swing, for long in thin air.
#[test]
fn locks_that_swing_come_back() {
    for (drag, seconds) in [(2.0, 20), (0.5, 90)] {
        let worst = swing_back(drag, seconds);
        println!("drag {drag}: {worst:.1e} m");
        assert!(
            worst < 5e-3,
            "drag {drag}: a tip is {worst} m from where it hangs"
        );
    }
}

/// How far a tip of such locks is at most from where it hangs after some seconds, in m.
fn swing_back(drag: f64, seconds: u32) -> f64 {
    const DT: f64 = 1.0 / 60.0;
    let mut rest = Strands::new();
    for i in 0..30_u32 {
        let root = Vec3::new(0.009 * (i % 6) as f32, 0.0, 0.009 * (i / 6) as f32);
        rest.push(
            i,
            &line(root, 16, 0.3 + 0.005 * ((i * 7) % 11) as f32),
            None,
        )
        .unwrap();
    }
    let params = Params {
        lock_radius: 0.004,
        drag,
        ..Params::default()
    };
    let (mut solver, mut state) = Solver::new(&rest, &params).unwrap();
    for frame in 1..=60 * seconds {
        let head = Pose {
            translation: DVec3::X * 0.25 * ease(f64::from(frame) * DT / 0.25),
            ..Pose::IDENTITY
        };
        step_on(head, &mut solver, &mut state, DT);
    }
    let off = |i: usize| {
        let styled = rest.strand(i).last().unwrap().as_dvec3() + DVec3::X * 0.25;
        (solver.points(&state, i).last().unwrap() - styled).length()
    };
    (0..30).map(off).fold(0.0, f64::max)
}

/// A tail that is tied and lies on the head under its tie.
#[test]
fn a_tied_tail_swings_out() {
    const DT: f64 = 1.0 / 60.0;
    let (mut points, mut angle, step) = (Vec::new(), 0.7_f32, 0.3 / 24.0_f32);
    for _ in 0..=24 {
        if angle > 0.0 {
            points.push(Vec3::new(0.0, 0.101 * angle.sin(), -0.101 * angle.cos()));
            angle -= step / 0.101;
        } else {
            points.push(*points.last().unwrap() - Vec3::Y * step);
        }
    }
    let mut rest = Strands::new();
    rest.push(0, &points, None).unwrap();
    let params = Params {
        drag: 0.5,
        ..Params::default()
    };
    let (mut solver, mut state) = Solver::new(&rest, &params).unwrap();
    let (tied, mut before, mut asleep) = (points[4].as_dvec3(), Pose::IDENTITY, 0);
    for frame in 1..=60 * 15 {
        let turn = DQuat::from_rotation_y(0.9 * ease(f64::from(frame) * DT / 0.3));
        let now = Pose {
            rotation: turn,
            translation: DVec3::ZERO,
        };
        let places = [before.rotation * tied, turn * tied];
        let shape = Shape::Sphere {
            center: DVec3::ZERO,
            radius: 0.1,
        };
        let surroundings = Surroundings {
            roots: Roots::Head(now),
            anchors: &[Anchor {
                strand: 0,
                point: 4,
                stiffness: 1e5,
                places,
                follows: false,
            }],
            colliders: &[Collider {
                shape,
                before,
                now,
                was: None,
            }],
            ..Default::default()
        };
        asleep = solver.step(&mut state, &surroundings, DT).unwrap().asleep;
        before = now;
    }
    let hangs = before.rotation * points[24].as_dvec3();
    let off = (solver.points(&state, 0).last().unwrap() - hangs).length();
    assert!(
        off < 5e-3,
        "the tip is {off} m from where it hangs, {asleep} asleep"
    );
}
