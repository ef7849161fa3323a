//! Row 2: roots that jump, flip, spin, start and stop.

use glam::{DQuat, DVec3};
use hair_sim::{Material, Params, Pose, Roots, Solver, Surroundings};

use crate::{check, step, style};

fn run(name: &str, pose: impl Fn(usize) -> Pose, frames: usize) {
    for gamma in [0.01, 10.0, 1e4] {
        let params = Params {
            material: Material::from_gamma(gamma, 0.3),
            ..Params::default()
        };
        let rest = style(16, 20, 0.3);
        let (mut solver, mut state) = Solver::new(&rest, &params).unwrap();
        let mut fallbacks = 0;
        for frame in 0..frames {
            let surroundings = Surroundings {
                roots: Roots::Head(pose(frame)),
                ..Surroundings::default()
            };
            fallbacks += step(&mut solver, &mut state, &surroundings, 1.0 / 24.0);
            check(&solver, &state, &rest, name);
        }
        println!(
            "{name}, gamma {gamma}: {fallbacks} fallbacks in {} steps",
            frames * 16
        );
        // Then it comes to rest: nothing is left that turns by itself.
        let last = pose(frames - 1);
        let surroundings = Surroundings {
            roots: Roots::Head(last),
            ..Surroundings::default()
        };
        for _ in 0..480 {
            step(&mut solver, &mut state, &surroundings, 1.0 / 24.0);
        }
        let before: Vec<DVec3> = (0..16).flat_map(|s| solver.points(&state, s)).collect();
        step(&mut solver, &mut state, &surroundings, 1.0 / 24.0);
        let after = (0..16).flat_map(|s| solver.points(&state, s));
        let speed = before
            .iter()
            .zip(after)
            .map(|(a, b)| (*a - b).length() * 24.0);
        let speed = speed.fold(0.0, f64::max);
        println!("   at the end {speed:.1e} m/s");
        assert!(speed < 0.02, "{name}, gamma {gamma}: {speed} m/s");
    }
}

fn turned(rotation: DQuat) -> Pose {
    Pose {
        rotation,
        translation: DVec3::ZERO,
    }
}

fn moved(translation: DVec3) -> Pose {
    Pose {
        rotation: DQuat::IDENTITY,
        translation,
    }
}

#[test]
fn a_jump_of_100_m_in_a_frame() {
    run(
        "jump",
        |i| moved(DVec3::X * if i < 5 { 0.0 } else { 100.0 }),
        24,
    );
}

#[test]
fn a_flip_in_a_frame() {
    let half = |i: usize| std::f64::consts::PI * f64::from(u8::from(i % 6 > 2));
    run(
        "flip about X",
        |i| turned(DQuat::from_rotation_x(half(i))),
        24,
    );
    run(
        "flip about Y",
        |i| turned(DQuat::from_rotation_y(half(i))),
        24,
    );
}

#[test]
fn a_spin_of_50_rad_a_second() {
    run(
        "spin",
        |i| turned(DQuat::from_rotation_y(i as f64 * 50.0 / 24.0)),
        48,
    );
    run(
        "tumble",
        |i| turned(DQuat::from_rotation_z(i as f64 * 50.0 / 24.0)),
        48,
    );
}

#[test]
fn start_and_stop_at_10_m_a_second() {
    let place = |i: usize| DVec3::Z * (10.0 / 24.0 * i.clamp(5, 20) as f64);
    run("dash", |i| moved(place(i)), 30);
}
