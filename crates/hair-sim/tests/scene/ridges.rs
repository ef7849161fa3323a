//! Links don't cut what their particles don't touch.

use glam::{DVec3, Vec3};
use hair_sim::{
    Collider, Material, Natural, Params, Pose, Roots, Shape, Solver, State, Strands, Surroundings,
};

use crate::among;

const LINKS: usize = 20;

/// A ridge along the first axis through the origin.
fn ridge(radius: f64) -> Shape<'static> {
    Shape::Capsule {
        from: DVec3::NEG_X,
        to: DVec3::X,
        radius,
    }
}

/// Strands beside each other in front of a ridge that point over it, with links of `link` metres.
fn strands(radius: f64, link: f64) -> Strands {
    let mut strands = Strands::new();
    for id in 0..4 {
        // At four places of the links over its crest, rising and falling.
        let back = 0.08 + link * f64::from(id) / 4.0;
        let root = DVec3::new(0.03 * f64::from(id), radius + 0.01, -back);
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

/// The place of a spline through four points, between the middle two: Catmull and Rom's with knots by the roots of the lengths, as strands are
/// drawn (Barry and Goldman's pyramid).
fn on_spline(p: [DVec3; 4], share: f64) -> DVec3 {
    let mut knots = [0.0; 4];
    for i in 1..4 {
        knots[i] = knots[i - 1] + p[i].distance(p[i - 1]).sqrt().max(1e-9);
    }
    let t = knots[1] + share * (knots[2] - knots[1]);
    let mix = |a: DVec3, b: DVec3, from: f64, to: f64| a.lerp(b, (t - from) / (to - from));
    let a: [DVec3; 3] = std::array::from_fn(|i| mix(p[i], p[i + 1], knots[i], knots[i + 1]));
    let b: [DVec3; 2] = std::array::from_fn(|i| mix(a[i], a[i + 1], knots[i], knots[i + 2]));
    mix(b[0], b[1], knots[1], knots[2])
}

/// How deep strands are in a body, in m: their links, and the curves through their particles.
fn depths(solver: &Solver, state: &State, distance: impl Fn(DVec3) -> f64) -> [f64; 2] {
    let mut deepest = [0.0_f64; 2];
    for strand in 0..solver.len() {
        let points: Vec<DVec3> = solver.points(state, strand).collect();
        let last = points.len() - 1;
        for k in 0..last {
            let before = if k > 0 {
                points[k - 1]
            } else {
                2.0 * points[0] - points[1]
            };
            let after = if k + 1 < last {
                points[k + 2]
            } else {
                2.0 * points[last] - points[last - 1]
            };
            for i in 1..=24 {
                let share = f64::from(i) / 24.0;
                let on_link = points[k].lerp(points[k + 1], share);
                let on_curve = on_spline([before, points[k], points[k + 1], after], share);
                deepest[0] = deepest[0].max(-distance(on_link));
                deepest[1] = deepest[1].max(-distance(on_curve));
            }
        }
    }
    deepest
}

/// The deepest in two seconds in which strands fall on a ridge, and are drawn over it to and fro and along it, at `speed` m/s at most.
fn drawn_over(
    speed: f64,
    radius: f64,
    link: f64,
    gamma: f64,
    rate: f64,
) -> ([f64; 2], usize, usize) {
    let (mut solver, mut state) =
        Solver::new(&strands(radius, link), &params(gamma, link)).unwrap();
    let colliders = [Collider::fixed(ridge(radius), Pose::IDENTITY)];
    let (mut deepest, mut fallbacks, mut contacts) = ([0.0_f64; 2], 0, 0);
    for step in 1..=(2.5 * rate) as usize {
        let time = (step as f64 / rate - 0.5).max(0.0);
        // 0.54 m/s across it and half as much along it.
        let time = time * speed / 0.6;
        let swing = DVec3::new(0.05 * (5.0 * time).sin(), 0.0, 0.06 * (9.0 * time).sin());
        let surroundings = Surroundings {
            roots: Roots::Head(Pose {
                translation: swing,
                ..Pose::IDENTITY
            }),
            ..among(&colliders)
        };
        let stats = solver.step(&mut state, &surroundings, 1.0 / rate).unwrap();
        fallbacks += stats.fallbacks;
        contacts += stats.contacts;
        let distance = |at: DVec3| (at.y * at.y + at.z * at.z).sqrt() - radius;
        let now = depths(&solver, &state, distance);
        deepest = std::array::from_fn(|i| deepest[i].max(now[i]));
    }
    (deepest, fallbacks, contacts)
}

/// With the links that styles have. In a step of 1/24 s hair that is drawn fast goes farther than a thin ridge is wide: that is held to
/// what it is.
#[test]
fn links_do_not_cut_ridges() {
    let mut is_held = true;
    for (rate, speed, most) in [
        (24.0, 0.6, [7e-3, 6e-3]),
        (24.0, 0.2, [2.5e-3, 1.5e-3]),
        (60.0, 0.6, [2e-3, 1.5e-3]),
        (120.0, 0.6, [2e-3, 1.5e-3]),
    ] {
        for radius in [0.015, 0.04] {
            let mut worst = [0.0_f64; 2];
            let (mut fallbacks, mut contacts) = (0, 0);
            for link in [0.015, 0.02, 0.03] {
                for gamma in [5.0, 30.0, 200.0] {
                    let (deepest, fell_back, met) = drawn_over(speed, radius, link, gamma, rate);
                    worst = std::array::from_fn(|i| worst[i].max(deepest[i]));
                    fallbacks += fell_back;
                    contacts += met;
                }
            }
            println!(
                "1/{rate} s, {speed} m/s over a ridge of {radius} m: links {:.2} mm in it, curves {:.2} mm; {contacts} contacts, {fallbacks} steps by the safe integrator",
                worst[0] * 1e3,
                worst[1] * 1e3,
            );
            assert!(contacts > 1000);
            is_held &= worst[0] < most[0] && worst[1] < most[1];
        }
    }
    assert!(is_held);
}
