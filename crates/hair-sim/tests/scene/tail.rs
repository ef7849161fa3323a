//! A ponytail in a turn of the head: what volume it keeps, and into how many groups it opens.

use glam::{DQuat, DVec2, DVec3, Vec3};
use hair_sim::{
    Acceleration, Material, Mutual, Natural, Params, Pose, Profile, Roots, Solver, State, Strands,
    Surroundings,
};

const CLUMPS: usize = 20;
const LINKS: usize = 20;
const LENGTH: f64 = 0.4;
/// Of a clump, in m.
const RADIUS: f64 = 0.006;
/// Where the tail is tied, behind the head's axis.
const TIE: DVec3 = DVec3::new(0.0, 0.0, -0.1);

/// Clumps from a tie of 8 mm radius into a round tail of 25 mm, which leaves the head backwards and hangs down.
fn tail() -> Strands {
    let mut strands = Strands::new();
    for id in 0..CLUMPS {
        // The golden angle: evenly over a disc.
        let (angle, share) = (
            id as f64 * 2.399_963,
            ((id as f64 + 0.5) / CLUMPS as f64).sqrt(),
        );
        let across = DVec2::from_angle(angle) * share;
        let points: Vec<Vec3> = (0..=LINKS)
            .map(|i| {
                let along = LENGTH * i as f64 / LINKS as f64;
                // Backwards for a quarter of a circle of 5 cm, then down.
                let bend = (along / 0.05).min(std::f64::consts::FRAC_PI_2);
                let down = (along - 0.05 * std::f64::consts::FRAC_PI_2).max(0.0);
                let middle =
                    TIE + DVec3::new(0.0, 0.05 * (bend.cos() - 1.0) - down, -0.05 * bend.sin());
                let out = DVec3::new(0.0, bend.cos(), -bend.sin());
                let wide = 0.008 + 0.017 * (along / 0.1).min(1.0);
                (middle + (DVec3::X * across.x + out * across.y) * wide).as_vec3()
            })
            .collect();
        strands.push(id as u32, &points, None).unwrap();
    }
    strands
}

/// As a look's soft hair.
fn params() -> Params {
    Params {
        material: Material::from_gamma(25.0, LENGTH),
        stiffness: Profile {
            root: 6.0,
            middle: 1.0,
            tip: 0.4,
        },
        natural: Natural::Balanced,
        damping: 0.02,
        drag: 1.6,
        goal: Profile {
            root: 40.0,
            middle: 4.0,
            tip: 0.0,
        },
        ..Params::default()
    }
}

/// The discs of clumps where the tail is cut across at particle `k`.
fn cut(shapes: &[Vec<DVec3>], k: usize) -> Vec<DVec2> {
    let mean = |k: usize| shapes.iter().map(|shape| shape[k]).sum::<DVec3>() / CLUMPS as f64;
    let (middle, along) = (mean(k), (mean(k + 1) - mean(k - 1)).normalize());
    let across = along.any_orthonormal_pair();
    let place = |shape: &Vec<DVec3>| {
        // Where the strand passes the plane.
        let far = |i: usize| (shape[i] - middle).dot(along);
        let pass = (0..LINKS).filter(|&i| far(i) <= 0.0 && far(i + 1) > 0.0);
        let i = pass.min_by_key(|i| i.abs_diff(k));
        let at = i.map_or(shape[k], |i| {
            shape[i].lerp(shape[i + 1], far(i) / (far(i) - far(i + 1)))
        }) - middle;
        DVec2::new(at.dot(across.0), at.dot(across.1))
    };
    shapes.iter().map(place).collect()
}

/// The area that discs cover together, in m^2.
fn area(discs: &[DVec2]) -> f64 {
    const CELL: f64 = 0.001;
    let (mut low, mut high) = (DVec2::MAX, DVec2::MIN);
    for disc in discs {
        (low, high) = (low.min(*disc - RADIUS), high.max(*disc + RADIUS));
    }
    let size = ((high - low) / CELL).ceil();
    let mut count = 0;
    for i in 0..size.x as usize {
        for j in 0..size.y as usize {
            let at = low + DVec2::new(i as f64 + 0.5, j as f64 + 0.5) * CELL;
            count += usize::from(
                discs
                    .iter()
                    .any(|disc| disc.distance_squared(at) < RADIUS * RADIUS),
            );
        }
    }
    count as f64 * CELL * CELL
}

/// The groups of discs between which there are gaps of more than half a disc's width.
fn groups(discs: &[DVec2]) -> usize {
    let mut of: Vec<usize> = (0..discs.len()).collect();
    for i in 0..discs.len() {
        for j in 0..i {
            if discs[i].distance(discs[j]) < 3.0 * RADIUS {
                let (one, other) = (of[i], of[j]);
                of.iter_mut()
                    .filter(|of| **of == one)
                    .for_each(|of| *of = other);
            }
        }
    }
    of.sort_unstable();
    of.dedup();
    of.len()
}

/// What a turn of the head by 60 degrees in 0.3 s makes of a tail: the least volume over that at rest, the groups at its lower half when it is
/// fastest, and how far the tips go.
#[derive(Debug)]
struct Turned {
    volume: f64,
    groups: usize,
    fastest: f64,
    after: f64,
}

fn turned(mutual: Option<&Mutual>, rate: f64) -> Turned {
    let (mut solver, mut state) = Solver::new(&tail(), &params()).unwrap();
    if let Some(mutual) = mutual {
        solver.interact(&mut state, mutual).unwrap();
    }
    let angle = |t: f64| {
        let u = ((t - 0.1) / 0.3).clamp(0.0, 1.0);
        60.0_f64.to_radians() * u * u * u * (10.0 - 15.0 * u + 6.0 * u * u)
    };
    let pose = |t: f64| Pose {
        rotation: DQuat::from_rotation_y(angle(t)),
        translation: DVec3::ZERO,
    };
    let shapes = |solver: &Solver, state: &State| -> Vec<Vec<DVec3>> {
        (0..CLUMPS)
            .map(|s| solver.points(state, s).collect())
            .collect()
    };
    let cuts = [6, 9, 12, 15, 18];
    let volume =
        |shapes: &[Vec<DVec3>]| -> f64 { cuts.iter().map(|&k| area(&cut(shapes, k))).sum() };
    let at_rest = volume(&shapes(&solver, &state));
    let mut turned = Turned {
        volume: 1.0,
        groups: 1,
        fastest: 0.0,
        after: 1.0,
    };
    for step in 1..=(1.5 * rate) as usize {
        let t = step as f64 / rate;
        let h = 1e-3;
        let acceleration = |t: f64| Acceleration::between([t - h, t, t + h].map(pose), h);
        let surroundings = Surroundings {
            roots: Roots::Head(pose(t)),
            acceleration: Some([t - 1.0 / rate, t].map(acceleration)),
            ..Surroundings::default()
        };
        solver.step(&mut state, &surroundings, 1.0 / rate).unwrap();
        let now = shapes(&solver, &state);
        turned.after = volume(&now) / at_rest;
        turned.volume = turned.volume.min(turned.after);
        let speed = (0..CLUMPS)
            .map(|s| solver.velocities(&state, s).last().unwrap().length())
            .sum::<f64>()
            / CLUMPS as f64;
        if speed > turned.fastest {
            turned.fastest = speed;
            turned.groups = groups(&cut(&now, 15));
        }
    }
    turned
}

/// With links and volume as looks have them. What opens into groups is shown, and isn't held: nothing here makes groups.
#[test]
fn a_tail_keeps_its_volume_in_a_turn_of_the_head() {
    let as_looks_have_it = Mutual {
        neighbours: 4,
        link: 40.0,
        reach: 0.12 * 0.24,
        break_at: 0.1 * 0.24,
        mends: true,
        repulsion: 200.0,
        distance: 0.06 * 0.24,
    };
    for (rate, least) in [(24.0, 0.88), (60.0, 0.9), (120.0, 0.9)] {
        let free = turned(None, rate);
        let linked = turned(Some(&as_looks_have_it), rate);
        println!(
            "1/{rate} s: {:.2} of its volume at least ({:.2} without links and volume), {:.2} after; {} groups at {:.2} m/s",
            linked.volume, free.volume, linked.after, linked.groups, linked.fastest
        );
        assert!(linked.volume > least && linked.after > 0.95, "{linked:?}");
    }
}
