//! How often the safe integrator is needed where nothing is extreme: hair on a head that shakes, in wind.

use glam::{DQuat, DVec3};
use hair_sim::{Collider, Material, Mutual, Params, Pose, Roots, Scene, Shape, Solver, Wind};

use crate::{check, style};

/// Steps of strands by the safe integrator, and all, in two seconds.
fn shake(gamma: f64, rate: u32) -> (usize, usize) {
    let rest = style(40, 20, 0.25);
    let params = Params {
        material: Material::from_gamma(gamma, 0.25),
        ..Params::default()
    };
    let (mut solver, mut state) = Solver::new(&rest, &params).unwrap();
    solver.interact(&mut state, &Mutual::default()).unwrap();
    let dt = 1.0 / f64::from(rate);
    let head = |i: u32| {
        let angle = 0.6 * (std::f64::consts::TAU * dt * f64::from(i)).sin();
        Pose {
            rotation: DQuat::from_rotation_y(angle) * DQuat::from_rotation_x(0.3 * angle),
            translation: DVec3::ZERO,
        }
    };
    let (mut fallbacks, mut steps) = (0, 0);
    let mut acted = [0; 3];
    for i in 0..2 * rate {
        let colliders = [Collider {
            shape: Shape::Sphere {
                center: DVec3::ZERO,
                radius: 0.1,
            },
            before: head(i),
            now: head(i + 1),
        }];
        let scene = Scene {
            roots: Roots::Head(head(i + 1)),
            wind: Wind {
                steady: DVec3::new(0.0, 0.0, -3.0),
                gust: 2.0,
                ..Wind::default()
            },
            colliders: &colliders,
            ..Scene::default()
        };
        let stats = solver.step(&mut state, &scene, dt).unwrap();
        assert_eq!((stats.set_aside, stats.asleep), (0, 0));
        let acts = [stats.contacts, stats.wind, stats.links];
        acted = std::array::from_fn(|i| acted[i] + acts[i]);
        fallbacks += stats.fallbacks;
        steps += stats.strands;
    }
    check(&solver, &state, &rest, "ordinary");
    // The share means nothing unless bodies, wind and other hair were there.
    assert!(acted.iter().all(|&count| count > steps), "{acted:?}");
    (fallbacks, steps)
}

#[test]
fn the_safe_integrator_is_seldom_needed() {
    for gamma in [1.0, 10.0, 100.0] {
        for rate in [24, 60, 120] {
            let (fallbacks, steps) = shake(gamma, rate);
            let share = fallbacks as f64 / steps as f64;
            println!(
                "gamma {gamma}, 1/{rate} s: {:.2} % of {steps} steps by the safe integrator",
                100.0 * share
            );
            assert!(share <= 0.01, "gamma {gamma}, 1/{rate} s: {share}");
        }
    }
}
