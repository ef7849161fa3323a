//! Links don't cut what their particles don't touch.

use glam::{DVec3, Vec3};
use hair_sim::{
    Collider, Material, Natural, Params, Pose, Roots, Shape, Solver, State, Strands, Surroundings,
};

use crate::{among, farthest};

const LINKS: usize = 20;
const RADII: [f64; 2] = [0.015, 0.04];
const LINK_LENGTHS: [f64; 3] = [0.01, 0.018, 0.025];
const GAMMAS: [f64; 3] = [5.0, 30.0, 200.0];

/// How deep links may be in a ridge, in m.
const MOST: f64 = 5e-4;

/// A ridge along the first axis through the origin.
fn ridge(radius: f64) -> [Collider<'static>; 1] {
    let shape = Shape::Capsule {
        from: DVec3::NEG_X,
        to: DVec3::X,
        radius,
    };
    [Collider::fixed(shape, Pose::IDENTITY)]
}

/// Strands beside each other in front of a ridge that point over it, with links of `link` metres, and their roots `up` over its crest.
fn strands(radius: f64, link: f64, up: f64) -> Strands {
    let mut strands = Strands::new();
    for id in 0..4 {
        // At four places of the links over its crest, rising and falling.
        let back = radius + 0.04 + link * f64::from(id) / 4.0;
        let root = DVec3::new(0.03 * f64::from(id), radius + up, -back);
        let rise = 0.1 - 0.1 * f64::from(id % 2);
        let along = DVec3::new(0.1, rise, 1.0).normalize();
        let points: Vec<Vec3> = (0..=LINKS)
            .map(|i| (root + along * (link * i as f64)).as_vec3())
            .collect();
        strands.push(id as u32, &points, None).unwrap();
    }
    strands
}

fn params(gamma: f64, link: f64) -> Params {
    Params {
        material: Material::from_gamma(gamma, link * LINKS as f64),
        natural: Natural::Styled,
        damping: 0.02,
        ..Params::default()
    }
}

/// How deep the links of all strands are in a ridge, in m.
fn depth(solver: &Solver, state: &State, radius: f64) -> f64 {
    let mut deepest = 0.0_f64;
    for strand in 0..solver.len() {
        let points: Vec<DVec3> = solver.points(state, strand).collect();
        for ends in points.windows(2) {
            for i in 1..=24 {
                let at = ends[0].lerp(ends[1], f64::from(i) / 24.0);
                deepest = deepest.max(radius - at.y.hypot(at.z));
            }
        }
    }
    deepest
}

fn places(solver: &Solver, state: &State) -> Vec<DVec3> {
    (0..solver.len())
        .flat_map(|strand| solver.points(state, strand))
        .collect()
}

/// How a head is shifted after so many seconds.
type Motion = fn(f64) -> DVec3;

/// What came of a scene.
#[derive(Default)]
struct Found {
    deepest: f64,
    contacts: usize,
    fallbacks: usize,
    steps: usize,
    /// The last step in which anything was awake.
    awake: usize,
    /// The fastest particle in the last step, in m/s.
    speed: f64,
}

fn run(
    motion: Motion,
    (radius, link, gamma, up): (f64, f64, f64, f64),
    rate: f64,
    seconds: f64,
) -> Found {
    let strands = strands(radius, link, up);
    let (mut solver, mut state) = Solver::new(&strands, &params(gamma, link)).unwrap();
    let colliders = ridge(radius);
    let mut found = Found::default();
    for step in 1..=(seconds * rate) as usize {
        let before = places(&solver, &state);
        let surroundings = Surroundings {
            roots: Roots::Head(Pose {
                translation: motion(step as f64 / rate),
                ..Pose::IDENTITY
            }),
            ..among(&colliders)
        };
        let stats = solver.step(&mut state, &surroundings, 1.0 / rate).unwrap();
        found.fallbacks += stats.fallbacks;
        found.contacts += stats.contacts;
        found.steps += stats.strands;
        if stats.strands > 0 {
            found.awake = step;
        }
        let now = depth(&solver, &state, radius);
        found.deepest = found.deepest.max(now);
        found.speed = farthest(&before, &places(&solver, &state)) * rate;
    }
    found
}

/// Over all ridges, lengths of links and stiffnesses: how deep links are at most, in m, and how fast particles are in the end, in m/s.
fn worst(name: &str, motion: Motion, up: f64, rate: f64, seconds: f64) -> [f64; 2] {
    let mut all = [0.0_f64; 2];
    for radius in RADII {
        for link in LINK_LENGTHS {
            let mut sum = Found::default();
            for gamma in GAMMAS {
                let found = run(motion, (radius, link, gamma, up), rate, seconds);
                sum.deepest = sum.deepest.max(found.deepest);
                sum.contacts += found.contacts;
                sum.fallbacks += found.fallbacks;
                sum.steps += found.steps;
                sum.awake = sum.awake.max(found.awake);
                sum.speed = sum.speed.max(found.speed);
            }
            println!(
                "{name}, 1/{rate} s, ridge of {:2.0} mm, links of {:2.0}: {:.2} mm in it; {} contacts, {} of {} steps safe; awake for {:.1} s, {:.2} mm/s in the end",
                radius * 1e3,
                link * 1e3,
                sum.deepest * 1e3,
                sum.contacts,
                sum.fallbacks,
                sum.steps,
                sum.awake as f64 / rate,
                sum.speed * 1e3,
            );
            assert!(sum.contacts > 100);
            all = [all[0].max(sum.deepest), all[1].max(sum.speed)];
        }
    }
    all
}

fn still(_: f64) -> DVec3 {
    DVec3::ZERO
}

/// After it has come down, across the ridge at up to 0.54 m/s and half as fast along it.
fn drawn(time: f64) -> DVec3 {
    let time = (time - 0.5).max(0.0);
    DVec3::new(0.05 * (5.0 * time).sin(), 0.0, 0.06 * (9.0 * time).sin())
}

/// Down onto it from above at up to 1.9 m/s, again and again.
fn thrown(time: f64) -> DVec3 {
    DVec3::new(0.0, 0.12 * (1.0 - (16.0 * time).cos()), 0.0)
}

#[test]
fn links_of_draped_hair_do_not_cut_ridges() {
    let worst = [24.0, 60.0].map(|rate| worst("draped", still, 0.01, rate, 12.0));
    assert!(worst.iter().all(|worst| worst[0] < MOST), "{worst:?}");
    // It comes to rest as it lies.
    assert!(worst.iter().all(|worst| worst[1] < 1e-3), "{worst:?}");
}

#[test]
fn links_of_drawn_hair_do_not_cut_ridges() {
    let worst = [24.0, 60.0].map(|rate| worst("drawn", drawn, 0.01, rate, 2.5));
    assert!(worst.iter().all(|worst| worst[0] < MOST), "{worst:?}");
}

#[test]
fn links_of_thrown_hair_do_not_cut_ridges() {
    let worst = [24.0, 60.0].map(|rate| worst("thrown", thrown, 0.01, rate, 2.0));
    assert!(worst.iter().all(|worst| worst[0] < MOST), "{worst:?}");
}
