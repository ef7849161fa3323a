use glam::{DVec3, Vec3};
use hair_sim::{Mutual, Params, Scene, Solver, State, Strands, Wind};

use crate::params;

/// A row of hanging strands, 6 mm apart.
fn row(count: u32) -> Strands {
    let mut strands = Strands::new();
    for s in 0..count {
        let root = Vec3::X * (0.006 * s as f32);
        let points: Vec<Vec3> = (0..=20)
            .map(|i| root + Vec3::NEG_Y * (0.01 * i as f32))
            .collect();
        strands.push(s, &points, None).unwrap();
    }
    strands
}

fn spread(solver: &Solver, state: &State, a: usize, b: usize) -> f64 {
    let tip = |s| solver.points(state, s).last().unwrap();
    (tip(a) - tip(b)).length()
}

#[test]
fn hair_at_rest_stays_at_rest() {
    let p = Params {
        natural: hair_sim::Natural::Balanced,
        ..params(50.0)
    };
    let (mut solver, mut state) = Solver::new(&row(8), &p).unwrap();
    solver.interact(&mut state, &Mutual::default()).unwrap();
    let before: Vec<DVec3> = (0..8).flat_map(|s| solver.points(&state, s)).collect();
    let mut links = 0;
    for _ in 0..240 {
        links = solver
            .step(&mut state, &Scene::default(), 1.0 / 24.0)
            .unwrap()
            .links;
    }
    // 8 strands, 10 particles each, 2 to 4 neighbours within 2 cm.
    assert!(links > 200, "{links}");
    let after = (0..8).flat_map(|s| solver.points(&state, s));
    let drift = before
        .iter()
        .zip(after)
        .map(|(a, b)| (*a - b).length())
        .fold(0.0, f64::max);
    assert!(drift < 1e-8, "{drift}");
}

#[test]
fn links_hold_neighbours_together_until_they_break() {
    // A wind that blows one end of the row more than the other, by its gusts.
    let run = |mutual: Option<Mutual>| {
        let (mut solver, mut state) = Solver::new(&row(8), &params(200.0)).unwrap();
        if let Some(mutual) = mutual {
            solver.interact(&mut state, &mutual).unwrap();
        }
        let mut most = 0.0_f64;
        let mut links = Vec::new();
        for _ in 0..96 {
            let scene = Scene {
                wind: Wind {
                    gust: 4.0,
                    size: 0.03,
                    ..Wind::default()
                },
                ..Scene::default()
            };
            links.push(solver.step(&mut state, &scene, 1.0 / 24.0).unwrap().links);
            for s in 0..7 {
                most = most.max((spread(&solver, &state, s, s + 1) - 0.006).abs());
            }
        }
        (most, links)
    };
    let (free, none) = run(None);
    assert_eq!(none[50], 0);
    let strong = Mutual {
        link: 2000.0,
        break_at: 1.0,
        ..Mutual::default()
    };
    let (held, all) = run(Some(strong));
    assert!(held < 0.5 * free, "{held} {free}");
    assert_eq!(all.iter().min(), all.iter().max());
    let weak = Mutual {
        link: 1.0,
        break_at: 0.002,
        mends: false,
        ..Mutual::default()
    };
    let (_, broken) = run(Some(weak));
    assert!(broken.windows(2).all(|w| w[1] <= w[0]), "{broken:?}");
    assert!(broken[95] < broken[0] / 2, "{broken:?}");
}

#[test]
fn repulsion_keeps_strands_apart() {
    // Gravity from the side presses a row against a neighbour that is far stiffer.
    let run = |repulsion: f64| {
        let (mut solver, mut state) =
            Solver::with(&row(2), |s| params(if s == 0 { 1e-3 } else { 100.0 })).unwrap();
        let mutual = Mutual {
            link: 0.0,
            repulsion,
            ..Mutual::default()
        };
        solver.interact(&mut state, &mutual).unwrap();
        let scene = Scene {
            gravity: DVec3::new(-1.5, -9.81, 0.0),
            ..Scene::default()
        };
        let mut pushed = 0;
        for _ in 0..480 {
            pushed += solver
                .step(&mut state, &scene, 1.0 / 60.0)
                .unwrap()
                .repulsions;
        }
        let tip = |s| solver.points(&state, s).last().unwrap().x;
        (tip(1) - tip(0), pushed)
    };
    let (through, _) = run(0.0);
    let (apart, pushed) = run(4000.0);
    assert!(through < -0.01, "{through}");
    assert!(apart > 0.0 && pushed > 100, "{apart} {pushed}");
}
