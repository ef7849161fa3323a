use glam::{DVec3, Vec3};
use hair_sim::{
    Acceleration, Mutual, Params, Pose, Roots, Solver, State, Strands, Surroundings, Wind,
};

use crate::{line, params, step_on};

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
    for i in 0..240 {
        // What changes by nothing that counts keeps it awake.
        let mut surroundings = Surroundings::default();
        surroundings.gravity.x = 1e-300 * f64::from(i % 2);
        let stats = solver.step(&mut state, &surroundings, 1.0 / 24.0);
        links = stats.unwrap().links;
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
fn links_do_not_hold_back_what_moves_together() {
    // A row that is shaken: links between strands that all move alike have nothing to do.
    let swing = |rate: i32, mutual: Option<Mutual>| {
        let (mut solver, mut state) = Solver::new(&row(8), &params(200.0)).unwrap();
        if let Some(mutual) = mutual {
            solver.interact(&mut state, &mutual).unwrap();
        }
        let dt = 1.0 / f64::from(rate);
        let pose = |step: i32| Pose {
            translation: DVec3::Z * (0.05 * (1.0 - (8.0 * dt * f64::from(step.max(0))).cos())),
            ..Pose::IDENTITY
        };
        let mut shapes = Vec::new();
        for step in 0..3 * rate / 2 {
            let ends = [step, step + 1];
            let around = |s: i32| [s - 1, s, s + 1].map(pose);
            let surroundings = Surroundings {
                roots: Roots::Head(pose(step + 1)),
                acceleration: Some(ends.map(|s| Acceleration::between(around(s), dt))),
                ..Surroundings::default()
            };
            solver.step(&mut state, &surroundings, dt).unwrap();
            shapes.extend(solver.points(&state, 3));
        }
        shapes
    };
    let mutual = Mutual {
        break_at: 1.0,
        repulsion: 0.0,
        ..Mutual::default()
    };
    let apart = [24, 48, 96, 192].map(|rate| {
        let (free, linked) = (swing(rate, None), swing(rate, Some(mutual)));
        let apart = (free.iter().zip(&linked)).map(|(a, b)| (*a - *b).length_squared());
        let apart = 1e3 * (apart.sum::<f64>() / free.len() as f64).sqrt();
        println!(
            "linked strands that move together, steps of 1/{rate} s: {apart:.2} mm from free ones"
        );
        apart
    });
    let slope = (apart[1] / apart[3]).log2() / 2.0;
    assert!(slope > 1.8 && apart[3] < 0.5, "{slope}: {apart:?}");
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
            let surroundings = Surroundings {
                wind: Wind {
                    gust: 4.0,
                    size: 0.03,
                    ..Wind::default()
                },
                ..Surroundings::default()
            };
            links.push(
                solver
                    .step(&mut state, &surroundings, 1.0 / 24.0)
                    .unwrap()
                    .links,
            );
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
        let surroundings = Surroundings {
            gravity: DVec3::new(-1.5, -9.81, 0.0),
            ..Surroundings::default()
        };
        let mut pushed = 0;
        for _ in 0..480 {
            pushed += solver
                .step(&mut state, &surroundings, 1.0 / 60.0)
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

/// Links that are much faster than a step don't shake hair for ever.
#[test]
fn stiff_links_come_to_rest() {
    for (dt, link) in [(1.0 / 60.0, 1e4), (1.0 / 24.0, 4e3)] {
        let mut rest = Strands::new();
        for i in 0..40_u32 {
            let root = Vec3::new(0.006 * (i % 8) as f32, 1.6, 0.006 * (i / 8) as f32);
            rest.push(i, &line(root, 16, 0.25), None).unwrap();
        }
        let (mut solver, mut state) = Solver::new(&rest, &Params::default()).unwrap();
        let mutual = Mutual {
            link,
            repulsion: 0.0,
            ..Mutual::default()
        };
        solver.interact(&mut state, &mutual).unwrap();
        let mut late = 0.0_f64;
        for frame in 0..(20.0 / dt) as i32 {
            let time = f64::from(frame) * dt;
            let head = Pose {
                translation: DVec3::X * 0.1 * (time.min(0.5) * std::f64::consts::TAU).sin(),
                ..Pose::IDENTITY
            };
            step_on(head, &mut solver, &mut state, dt);
            if time > 15.0 {
                for strand in 0..solver.len() {
                    let speeds = solver.velocities(&state, strand).map(DVec3::length);
                    late = speeds.fold(late, f64::max);
                }
            }
        }
        assert!(
            late < 0.05,
            "links of {link}, steps of {dt}: {late} m/s after 15 s"
        );
    }
}

/// Strands of a single link are linked as longer ones are.
#[test]
fn strands_of_one_link_have_partners() {
    for points in [2, 3] {
        let mut strands = Strands::new();
        for s in 0..4 {
            let root = Vec3::X * (0.004 * s as f32);
            let line: Vec<Vec3> = (0..points)
                .map(|i| root + Vec3::NEG_Y * (0.02 * i as f32))
                .collect();
            strands.push(s, &line, None).unwrap();
        }
        let (mut solver, mut state) = Solver::new(&strands, &params(50.0)).unwrap();
        solver.interact(&mut state, &Mutual::default()).unwrap();
        let stats = solver
            .step(&mut state, &Surroundings::default(), 1.0 / 60.0)
            .unwrap();
        assert_eq!(stats.links, 4 * 3, "{points} points");
    }
}
