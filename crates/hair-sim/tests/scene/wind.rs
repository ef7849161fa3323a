use glam::{DVec3, Vec3};
use hair_sim::{GRAVITY, Params, Solver, Surroundings, Wind};

use crate::{LENGTH, after, farthest, in_wind, params, shape, straight};

#[test]
fn steady_wind_on_round_particles_is_as_another_gravity() {
    let p = Params {
        drag: 3.0,
        drag_along: 1.0,
        damping: 0.2,
        ..params(30.0)
    };
    let rest = straight(Vec3::ZERO, Vec3::X);
    let steady = DVec3::new(2.0, 0.5, -1.0);
    let wind = in_wind(Wind {
        steady,
        ..Wind::default()
    });
    let blown = after(&rest, &p, &wind, 0.05, 2000);
    let gravity = Surroundings {
        gravity: DVec3::new(0.0, -GRAVITY, 0.0) + steady * 3.0,
        ..Surroundings::default()
    };
    let pulled = after(&rest, &p, &gravity, 0.05, 2000);
    let error = farthest(&blown, &pulled);
    assert!(error < 1e-7, "{error}");
}

#[test]
fn wind_tilts_a_limp_strand_by_the_drag_across_it() {
    // Straight at the angle where drag across it balances its weight across it: tan = rate * speed / g, whatever the drag
    // along it is.
    for along in [0.0, 0.5, 1.0] {
        let p = Params {
            drag: 3.0,
            drag_along: along,
            damping: 0.05,
            ..params(1e7)
        };
        let wind = in_wind(Wind {
            steady: DVec3::new(2.0, 0.0, 0.0),
            ..Wind::default()
        });
        let points = after(&straight(Vec3::ZERO, Vec3::NEG_Y), &p, &wind, 0.05, 1000);
        let link = points[20] - points[2];
        let tan = link.x / -link.y;
        assert!((tan - 6.0 / GRAVITY).abs() < 1e-3, "{along}: {tan}");
    }
}

#[test]
fn gusts_move_hair_and_other_seeds_move_it_otherwise() {
    let (mut solver, start) = Solver::new(&straight(Vec3::ZERO, Vec3::X), &params(20.0)).unwrap();
    let blow = |solver: &mut Solver, seed: u64, gust: f64| {
        let mut state = start.clone();
        let surroundings = in_wind(Wind {
            gust,
            seed,
            ..Wind::default()
        });
        let mut felt = 0;
        for _ in 0..48 {
            felt += solver
                .step(&mut state, &surroundings, 1.0 / 24.0)
                .unwrap()
                .wind;
        }
        assert_eq!(felt > 0, gust > 0.0);
        shape(solver, &state)
    };
    let calm = blow(&mut solver, 1, 0.0);
    let one = blow(&mut solver, 1, 5.0);
    let other = blow(&mut solver, 2, 5.0);
    assert!(farthest(&calm, &one) > 1e-3);
    assert!(farthest(&one, &other) > 1e-3);
    assert_eq!(one, blow(&mut solver, 1, 5.0));
}

#[test]
fn gusts_are_of_second_order() {
    is_of_second_order("in gusts", |_| Wind {
        steady: DVec3::new(3.0, 0.0, 1.0),
        gust: 4.0,
        size: 0.3,
        ..Wind::default()
    });
}

#[test]
fn a_wind_that_rises_and_falls_is_of_second_order() {
    is_of_second_order("in a changing wind", |time| Wind {
        steady: DVec3::new(3.0, 0.0, 1.0) * (1.0 - (5.0 * time).cos()),
        ..Wind::default()
    });
}

fn is_of_second_order(name: &str, wind: impl Fn(f64) -> Wind) {
    let shapes = |rate: u32| {
        let rest = straight(Vec3::ZERO, Vec3::NEG_Y);
        let (mut solver, mut state) = Solver::new(&rest, &params(50.0)).unwrap();
        let mut shapes = Vec::new();
        for step in 0..2 * rate {
            let [before, now] =
                [step, step + 1].map(|step| wind(f64::from(step) / f64::from(rate)));
            let surroundings = Surroundings {
                wind_before: Some(before),
                ..in_wind(now)
            };
            solver
                .step(&mut state, &surroundings, 1.0 / f64::from(rate))
                .unwrap();
            if (step + 1) % (rate / 24) == 0 {
                shapes.extend(shape(&solver, &state));
            }
        }
        shapes
    };
    let truth = shapes(24 * 64);
    let errors = [24, 48, 96, 192].map(|rate| {
        let shapes = shapes(rate);
        let apart = (shapes.iter().zip(&truth)).map(|(a, b)| (*a - *b).length_squared());
        let error = (apart.sum::<f64>() / shapes.len() as f64).sqrt() / LENGTH;
        println!("{name}, steps of 1/{rate} s: {error:.5}");
        error
    });
    let slope = (errors[1] / errors[3]).log2() / 2.0;
    assert!(slope > 1.5, "{name}: {slope}");
}
