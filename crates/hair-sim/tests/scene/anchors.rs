use glam::{DVec3, Vec3};
use hair_sim::{Anchor, DynamicsError, Params, Solver, State, Stats, Strands, Surroundings, Wind};

use crate::{farthest, params, shape, straight};

/// Of the tip of a strand of 20 links, which stays at a place.
fn at_tip(place: DVec3, stiffness: f64) -> Anchor {
    Anchor {
        strand: 0,
        point: 20,
        stiffness,
        places: [place; 2],
        follows: false,
    }
}

fn held(anchors: &[Anchor]) -> Surroundings<'_> {
    Surroundings {
        anchors,
        ..Surroundings::default()
    }
}

fn step(solver: &mut Solver, state: &mut State, surroundings: &Surroundings, dt: f64) -> Stats {
    let stats = solver.step(state, surroundings, dt).unwrap();
    assert_eq!(stats.set_aside, 0);
    stats
}

#[test]
fn an_anchor_holds_its_point() {
    // Hair that hangs through, between its root and its tip.
    let rest = straight(Vec3::ZERO, Vec3::X);
    let (mut solver, mut state) = Solver::new(&rest, &params(100.0)).unwrap();
    let place = DVec3::new(0.15, 0.0, 0.0);
    let anchors = [at_tip(place, 1e6)];
    for _ in 0..240 {
        step(&mut solver, &mut state, &held(&anchors), 1.0 / 60.0);
    }
    let points = shape(&solver, &state);
    let away = points[20].distance(place);
    println!("the tip is {away:.1e} m away, the middle {} m", points[10]);
    // Half of the strand hangs on it: 10 g of a link, and the rope's pull along itself.
    assert!(away < 5e-4, "{away}");
    assert!(points[10].y < -0.03, "{}", points[10]);
}

#[test]
fn an_anchor_takes_its_point_along() {
    // How far the tip is from a place that goes along a circle about the root, faster and faster, in steps of `dt` seconds.
    let away = |dt: f64| {
        let rest = straight(Vec3::ZERO, Vec3::X);
        let (mut solver, mut state) = Solver::new(&rest, &params(20.0)).unwrap();
        let place = |time: f64| {
            let angle = 0.5 * std::f64::consts::PI * time * time;
            DVec3::new(angle.cos(), 0.0, angle.sin()) * 0.19
        };
        let (mut time, mut farthest) = (0.0, 0.0_f64);
        while time < 0.7 {
            let anchors = [Anchor {
                places: [place(time), place(time + dt)],
                follows: false,
                ..at_tip(DVec3::ZERO, 1e6)
            }];
            step(&mut solver, &mut state, &held(&anchors), dt);
            time += dt;
            // It starts 1 cm away.
            if time > 0.2 {
                let tip = shape(&solver, &state)[20];
                farthest = farthest.max(tip.distance(place(time)));
            }
        }
        println!("steps of {dt:.4} s: {farthest:.1e} m away at up to 0.4 m/s");
        farthest
    };
    let (coarse, fine) = (away(1.0 / 24.0), away(1.0 / 48.0));
    assert!(coarse < 1e-3 && fine < coarse, "{coarse} {fine}");
}

#[test]
fn an_anchor_does_not_hang_on_the_step() {
    let in_steps = |dt: f64| {
        let rest = straight(Vec3::ZERO, Vec3::X);
        let (mut solver, mut state) = Solver::new(&rest, &params(50.0)).unwrap();
        let anchors = [at_tip(DVec3::new(0.12, 0.05, 0.03), 3000.0)];
        for _ in 0..(20.0 / dt) as u32 {
            step(&mut solver, &mut state, &held(&anchors), dt);
        }
        shape(&solver, &state)
    };
    let error = farthest(&in_steps(1.0 / 24.0), &in_steps(1.0 / 240.0));
    assert!(error < 1e-6, "{error}");
}

/// Nine strands, more than there are lanes.
fn nine() -> Strands {
    let mut strands = Strands::new();
    for strand in 0..9 {
        let root = Vec3::Z * (0.01 * strand as f32);
        let points: Vec<Vec3> = (0..=20)
            .map(|i| root + Vec3::X * (0.01 * i as f32))
            .collect();
        strands.push(strand, &points, None).unwrap();
    }
    strands
}

/// All points of nine strands in wind after half a second with these anchors.
fn blown(anchors: &[Anchor]) -> Vec<Vec<DVec3>> {
    let (mut solver, mut state) = Solver::new(&nine(), &params(30.0)).unwrap();
    let wind = Wind {
        steady: DVec3::Z,
        ..Wind::default()
    };
    let surroundings = Surroundings {
        anchors,
        wind,
        ..Surroundings::default()
    };
    for _ in 0..30 {
        step(&mut solver, &mut state, &surroundings, 1.0 / 60.0);
    }
    (0..9)
        .map(|strand| solver.points(&state, strand).collect())
        .collect()
}

#[test]
fn an_anchor_is_nothing_to_other_strands() {
    let of = |strand: usize, point: usize| Anchor {
        strand,
        point,
        ..at_tip(DVec3::new(0.1, 0.05, 0.02), 1e4)
    };
    let free = blown(&[]);
    let own = blown(&[of(3, 12), of(8, 20)]);
    for strand in 0..9 {
        let is_held = [3, 8].contains(&strand);
        assert_eq!(free[strand] != own[strand], is_held, "{strand}");
    }
    // In any order, and of what isn't there, or is a root.
    assert!(own == blown(&[of(8, 20), of(3, 12)]));
    assert!(free == blown(&[of(9, 3), of(2, 21), of(4, 0), of(usize::MAX, usize::MAX)]));
    // None that pulls is none.
    let weak = Anchor {
        stiffness: 0.0,
        ..of(3, 12)
    };
    assert!(free == blown(&[weak]));
}

#[test]
fn what_an_anchor_holds_sleeps_until_that_moves() {
    let rest = straight(Vec3::ZERO, Vec3::X);
    let params = Params {
        damping: 0.05,
        ..params(20.0)
    };
    let (mut solver, mut state) = Solver::new(&rest, &params).unwrap();
    let place = DVec3::new(0.17, 0.02, 0.0);
    let anchors = [at_tip(place, 1e5)];
    let dt = 1.0 / 60.0;
    for _ in 0..6000 {
        step(&mut solver, &mut state, &held(&anchors), dt);
    }
    let stats = step(&mut solver, &mut state, &held(&anchors), dt);
    assert_eq!((stats.asleep, stats.strands), (1, 0));
    // One that moves, pulls otherwise, pulls at another point, or is gone, wakes it.
    let further = place + DVec3::Y * 1e-3;
    let others = [
        Anchor {
            places: [place, further],
            follows: false,
            ..anchors[0]
        },
        at_tip(place, 2e5),
        Anchor {
            point: 19,
            ..anchors[0]
        },
    ];
    for other in others {
        let mut woken = state.clone();
        let stats = step(&mut solver, &mut woken, &held(&[other]), dt);
        assert_eq!((stats.asleep, stats.strands), (0, 1), "{other:?}");
    }
    let stats = step(&mut solver, &mut state, &held(&[]), dt);
    assert_eq!((stats.asleep, stats.strands), (0, 1));
}

#[test]
fn anchors_that_are_none_are_refused() {
    let rest = straight(Vec3::ZERO, Vec3::X);
    let (mut solver, mut state) = Solver::new(&rest, &params(20.0)).unwrap();
    let good = at_tip(DVec3::X, 1.0);
    for places in [[DVec3::NAN, DVec3::X], [DVec3::X, DVec3::INFINITY]] {
        let bad = Anchor { places, ..good };
        let refused = solver.step(&mut state, &held(&[good, bad]), 0.01);
        assert_eq!(refused, Err(DynamicsError::Surroundings("anchor")));
    }
    for stiffness in [-1.0, f64::NAN, f64::INFINITY, 1e10] {
        let bad = Anchor { stiffness, ..good };
        let refused = solver.step(&mut state, &held(&[good, bad]), 0.01);
        let message = refused.unwrap_err().to_string();
        let expected = format!("anchor 1: its stiffness is {stiffness}, and must be from 0 to 1e9");
        assert!(message.contains(&expected), "{message}");
    }
    // A pull as strong as there may be, far beyond the strand's reach, breaks nothing.
    let hard = at_tip(DVec3::new(1e3, -1e3, 5.0), 1e9);
    for _ in 0..20 {
        step(&mut solver, &mut state, &held(&[hard]), 1.0 / 24.0);
    }
    let points = shape(&solver, &state);
    assert!(points.iter().all(|point| point.is_finite()));
    let length: f64 = points
        .windows(2)
        .map(|link| link[0].distance(link[1]))
        .sum();
    assert!((length - 0.2).abs() < 1e-5, "{length}");
}
