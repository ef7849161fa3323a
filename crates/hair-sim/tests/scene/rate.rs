//! The rate of frames doesn't show in how hair swings.

use glam::{DQuat, DVec3, Vec3};
use hair_sim::{
    GRAVITY, Material, Natural, Params, Pose, Profile, Solver, State, Strands, Surroundings,
};
use std::f64::consts::TAU;

use crate::{line, step_on};

/// What a strand of a style is made of: weight against stiffness, damping in s, drag in 1/s, pull to the style in 1/s^2.
struct Hair {
    name: &'static str,
    gamma: f64,
    damping: f64,
    drag: f64,
    hold: [f64; 3],
}

impl Hair {
    fn params(&self, length: f64) -> Params {
        let [root, middle, tip] = self.hold;
        Params {
            material: Material::from_gamma(self.gamma, length),
            stiffness: Profile {
                root: 6.0,
                middle: 1.0,
                tip: 0.4,
            },
            natural: Natural::Balanced,
            damping: self.damping,
            drag: self.drag,
            goal: Profile { root, middle, tip },
            ..Params::default()
        }
    }
}

fn hanging(length: f64) -> Strands {
    let points: Vec<Vec3> = (0..=20)
        .map(|i| Vec3::NEG_Y * (length * f64::from(i) / 20.0) as f32)
        .collect();
    let mut strands = Strands::new();
    strands.push(0, &points, None).unwrap();
    strands
}

/// Pushed aside by gravity, let go, and looked at two seconds later: how far it was pushed, the swing's size, both in lengths, and its angle in its cycle, at
/// `frequency` (rad/s), in steps of `dt` s.
fn swing(params: &Params, length: f64, push: f64, frequency: f64, dt: f64) -> [f64; 3] {
    let slow = Params {
        damping: 0.5,
        drag: 20.0,
        ..*params
    };
    let strands = hanging(length);
    let (mut solver, mut state) = Solver::new(&strands, &slow).unwrap();
    let pushed = Surroundings {
        gravity: DVec3::new(push * GRAVITY, -GRAVITY, 0.0),
        ..Surroundings::default()
    };
    for _ in 0..2000 {
        solver.step(&mut state, &pushed, 0.01).unwrap();
    }
    let tip = |solver: &Solver, state: &State| solver.points(state, 0).last().unwrap().x / length;
    let start = tip(&solver, &state);
    let (mut solver, _) = Solver::new(&strands, params).unwrap();
    let cycle = TAU / frequency;
    let [mut re, mut im, mut sum] = [0.0; 3];
    let count = ((2.0 + cycle) / dt).ceil() as usize;
    for i in 1..=count {
        solver
            .step(&mut state, &Surroundings::default(), dt)
            .unwrap();
        let t = i as f64 * dt;
        // A window of von Hann, two cycles wide.
        let u = (t - 2.0) / cycle;
        if u.abs() < 1.0 {
            let window = 0.5 + 0.5 * (0.5 * TAU * u).cos();
            let x = tip(&solver, &state);
            re += window * x * (frequency * t).cos();
            im -= window * x * (frequency * t).sin();
            sum += window;
        }
    }
    [start, 2.0 * re.hypot(im) / sum, im.atan2(re)]
}

#[test]
fn hair_swings_alike_at_any_rate_of_frames() {
    let free = [0.0; 3];
    let hair = |name, gamma, damping, drag, hold| Hair {
        name,
        gamma,
        damping,
        drag,
        hold,
    };
    let kinds = [
        hair("limp", 150.0, 0.01, 1.0, [10.0, 0.0, 0.0]),
        hair("soft", 25.0, 0.02, 1.6, [40.0, 4.0, 0.0]),
        hair("springy", 8.0, 0.01, 1.6, [80.0, 25.0, 8.0]),
        hair("springy, free", 8.0, 0.01, 1.6, free),
        hair("springy, undamped", 8.0, 0.0, 0.0, free),
        hair("stiff, undamped", 1.5, 0.0, 0.0, free),
        hair("limp, undamped", 150.0, 0.0, 0.0, free),
    ];
    for kind in &kinds {
        for length in [0.1, 0.25, 0.5] {
            let params = kind.params(length);
            let longest = params.longest_step(length, GRAVITY);
            let stiffness = params.stiffness.at(0.3);
            let bends = 12.36 * params.material.bending() * stiffness / length.powi(4);
            let frequency = (1.53 * GRAVITY / length + bends + params.goal.at(0.8)).sqrt();
            for push in [0.2, 1.0] {
                let [one, two, three] = [24.0, 30.0, 60.0_f64].map(|rate| {
                    let parts = (1.0 / rate / longest - 1e-6).ceil();
                    (
                        parts,
                        swing(&params, length, push, frequency, 1.0 / rate / parts),
                    )
                });
                let [start, ..] = three.1;
                for (rate, (parts, found)) in [(24, one), (30, two)] {
                    let [_, size, angle] = found;
                    let [_, fine_size, fine_angle] = three.1;
                    let turns = (angle - fine_angle) / TAU;
                    let lag = turns - turns.round();
                    let off = size / fine_size - 1.0;
                    println!(
                        "{}, {length} m, pushed by {push} g: {:.1e} of it left; in {parts} steps of 1/{rate} s {off:+.3} of that in {} of 1/60, \
                         {lag:+.3} of a cycle",
                        kind.name,
                        fine_size / start,
                        three.0
                    );
                    let what = format!("{}, {length} m, {push} g, 1/{rate} s", kind.name);
                    if fine_size > 0.01 * start && kind.hold == free {
                        assert!(off.abs() < 0.1 && lag.abs() < 0.1, "{what}: {off} {lag}");
                    }
                    assert!(
                        (size - fine_size).abs() < 0.1 * start,
                        "{what}: {size} {fine_size}"
                    );
                }
            }
        }
    }
}

/// One frame of 180 is taken in two steps, of which the first is up to a microsecond short.
#[test]
fn a_tiny_step_changes_little() {
    let run = |tiny: Option<f64>| {
        let mut rest = Strands::new();
        let root = Vec3::new(0.0, 1.6, 0.1);
        rest.push(0, &line(root, 16, 0.25), None).unwrap();
        let (mut solver, mut state) = Solver::new(&rest, &Params::default()).unwrap();
        let (mut time, mut tips) = (0.0_f64, Vec::new());
        for frame in 0..180 {
            let whole = 1.0 / 60.0;
            let steps = match tiny {
                Some(tiny) if frame == 60 => vec![tiny, whole - tiny],
                _ => vec![whole],
            };
            for dt in steps {
                time += dt;
                let head = Pose {
                    rotation: DQuat::from_rotation_y(0.6 * (4.0 * time).sin()),
                    translation: DVec3::X * 0.1 * (5.0 * time).sin(),
                };
                step_on(head, &mut solver, &mut state, dt);
            }
            tips.push(solver.points(&state, 0).last().unwrap());
        }
        tips
    };
    let whole = run(None);
    for tiny in [1e-4, 1e-6] {
        let cut = run(Some(tiny));
        let off = whole
            .iter()
            .zip(&cut)
            .map(|(a, b)| a.distance(*b))
            .fold(0.0, f64::max);
        assert!(off < 5e-3, "one step of {tiny} s moves the tip by {off} m");
    }
}
