//! Small vibrations.

use glam::{DVec3, Vec3};
use hair_sim::{GRAVITY, Params, Solver, Surroundings};

use crate::{LENGTH, along, bare, settle, tip};

/// The frequency (rad/s) at which a strand that hangs along -Y swings, near `expected`, under `gravity`.
fn frequency(gamma: f64, gravity: f64, expected: f64) -> f64 {
    let strand = along(20, Vec3::NEG_Y);
    let slow = Params {
        damping: 0.5,
        drag: 20.0,
        ..bare(gamma)
    };
    // Pushed aside a little, and let go.
    let push = gravity.max(GRAVITY / gamma) * 1e-3;
    let pushed = Surroundings {
        gravity: DVec3::new(push, -gravity, 0.0),
        ..Surroundings::default()
    };
    let (mut solver, mut state) = Solver::new(&strand, &slow).unwrap();
    settle(&mut solver, &mut state, &pushed);
    let (mut solver, _) = Solver::new(&strand, &bare(gamma)).unwrap();
    let free = Surroundings {
        gravity: DVec3::new(0.0, -gravity, 0.0),
        ..Surroundings::default()
    };
    let (periods, samples) = (20, 250);
    let dt = std::f64::consts::TAU / expected / f64::from(samples);
    let count = periods * samples;
    let path: Vec<f64> = (0..count)
        .map(|_| {
            solver.step(&mut state, &free, dt).unwrap();
            tip(&solver, &state).x
        })
        .collect();
    // The peak of the spectrum under a window of von Hann.
    let power = |omega: f64| {
        let (mut re, mut im) = (0.0, 0.0);
        for (i, x) in path.iter().enumerate() {
            let u = i as f64 / f64::from(count);
            let window = 0.5 - 0.5 * (std::f64::consts::TAU * u).cos();
            let phase = omega * dt * i as f64;
            re += x * window * phase.cos();
            im += x * window * phase.sin();
        }
        re * re + im * im
    };
    let (mut low, mut high) = (expected * 0.97, expected * 1.03);
    for _ in 0..40 {
        let (a, b) = (low + (high - low) * 0.382, low + (high - low) * 0.618);
        if power(a) < power(b) {
            low = a;
        } else {
            high = b;
        }
    }
    0.5 * (low + high)
}

#[test]
fn the_first_frequencies_are_those_of_theory() {
    let pendulum = (GRAVITY / LENGTH).sqrt();
    // A cantilever without gravity: beta^2 sqrt(EI / (rho S L^4)), beta = 1.8751.
    let beam = 1.875_104_068_711_961_f64.powi(2) * (GRAVITY / LENGTH).sqrt();
    let mut text = String::new();
    let mut check = |name: &str, gamma: f64, gravity: f64, expected: f64| {
        let error = frequency(gamma, gravity, expected) / expected - 1.0;
        text += &format!("{name} {gamma}: {:.3} %\n", error * 100.0);
        assert!(error.abs() < 0.005, "{text}");
    };
    check("cantilever", 1.0, 0.0, beam);
    // j_0 / 2: Bernoulli's chain.
    check("chain", 1e9, GRAVITY, 1.202_412_778_847_886 * pendulum);
    for (gamma, omega) in [
        (0.01, 35.182_484_434_747_92),
        (1.0, 3.732_625_698_648_374),
        (10.0, 1.673_408_831_630_585),
        (100.0, 1.286_874_191_632_712),
        (1000.0, 1.223_659_314_227_097),
        (10_000.0, 1.208_647_075_497_233),
    ] {
        check("hanging rod", gamma, GRAVITY, omega * pendulum);
    }
    println!("{text}");
}
