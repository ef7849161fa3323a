//! Row 8: the momentum of a strand that flies freely.
//!
//! Every strand has a root, so a free one is made of two. A strand that is bent point-symmetrically about its middle, where it
//! flies freely, has there neither a force (those of its halves are opposite) nor a moment (the curvature is its own
//! opposite, so none). Each half then moves as a strand on a root that flies along and resists no turn.

use glam::{DQuat, DVec3, Vec3};
use hair_sim::{
    GRAVITY, Material, Natural, Params, Pose, Profile, Roots, Scene, Solver, State, Strands,
};

use crate::check;

/// Links of a half, and its length in m.
const LINKS: usize = 20;
const LENGTH: f64 = 0.3;

/// A half: straight by nature and at rest, its first joint all but without stiffness.
struct Half {
    rest: Strands,
    solver: Solver,
    state: State,
    /// 1 or -1: everything that happens to one half happens to the other the other way.
    sign: f64,
}

impl Half {
    fn new(sign: f64) -> Self {
        let points: Vec<Vec3> = (0..=LINKS)
            .map(|i| Vec3::X * (sign * LENGTH * i as f64 / LINKS as f64) as f32)
            .collect();
        let mut rest = Strands::new();
        rest.push(0, &points, None).unwrap();
        let params = Params {
            material: Material::from_gamma(2.0, LENGTH),
            stiffness: Profile {
                root: 1e-9,
                middle: 1.0,
                tip: 1.0,
            },
            natural: Natural::Styled,
            damping: 0.0,
            drag: 0.0,
            ..Params::default()
        };
        let (solver, state) = Solver::new(&rest, &params).unwrap();
        Self {
            rest,
            solver,
            state,
            sign,
        }
    }

    fn step(&mut self, pull: DVec3, gravity: DVec3, middle: DVec3, dt: f64) {
        let scene = Scene {
            roots: Roots::Head(Pose {
                rotation: DQuat::IDENTITY,
                translation: middle,
            }),
            gravity: gravity + pull * self.sign,
            ..Scene::default()
        };
        let stats = self.solver.step(&mut self.state, &scene, dt).unwrap();
        assert_eq!((stats.fallbacks, stats.set_aside), (0, 0));
        check(&self.solver, &self.state, &self.rest, "flight");
    }

    /// Momentum over mass per length, and its moment about `middle`. The first and last particles have half a link's mass.
    fn momentum(&self, middle: DVec3) -> (DVec3, DVec3) {
        let points = self.solver.points(&self.state, 0);
        let velocities = self.solver.velocities(&self.state, 0);
        let link = LENGTH / LINKS as f64;
        let (mut sum, mut moment) = (DVec3::ZERO, DVec3::ZERO);
        for (i, (at, velocity)) in points.zip(velocities).enumerate() {
            let mass = if i == 0 || i == LINKS {
                0.5 * link
            } else {
                link
            };
            sum += velocity * mass;
            moment += (at - middle).cross(velocity * mass);
        }
        (sum, moment)
    }
}

/// What became of a strand in a second of flight: how far its momentum is from what it must be over that of its spinning, the same of
/// the moment of its momentum, and how far it bent, in lengths.
fn fly(dt: f64) -> (f64, f64, f64) {
    let mut halves = [1.0, -1.0].map(Half::new);
    // It is set spinning and bending, for a tenth of a second, in more than one plane.
    let spins = (0.1 / dt).round() as usize;
    for i in 0..spins {
        let turn = i as f64 / spins as f64;
        let pull = DVec3::new(0.0, 60.0 * (1.0 - turn), 60.0 * turn);
        for half in &mut halves {
            half.step(pull, DVec3::ZERO, DVec3::ZERO, dt);
        }
    }
    let spin =
        |halves: &[Half], middle: DVec3| halves.iter().map(|h| h.momentum(middle).1).sum::<DVec3>();
    let start = spin(&halves, DVec3::ZERO);
    let shape = |half: &Half| {
        half.solver
            .points(&half.state, 0)
            .last()
            .unwrap_or(DVec3::NAN)
    };
    let size = halves[0].momentum(DVec3::ZERO).0.length();

    // Then it is thrown: all of it at once, so that its parts feel nothing of it.
    let (throw, gravity) = (DVec3::new(1.0, 3.0, -0.5), DVec3::NEG_Y * GRAVITY);
    let (mut off, mut spin_off, mut bent) = (0.0_f64, 0.0_f64, 0.0_f64);
    for i in 1..=(1.0 / dt).round() as usize {
        let t = i as f64 * dt;
        let middle = throw * t + gravity * (0.5 * t * t);
        let pull = if i == 1 { middle / (dt * dt) } else { gravity };
        for half in &mut halves {
            half.step(DVec3::ZERO, pull, middle, dt);
        }
        let sum: DVec3 = halves.iter().map(|h| h.momentum(middle).0).sum();
        // In the middle of the step: the root's velocity is that of its way in it.
        let expected = (throw + gravity * (t - 0.5 * dt)) * (2.0 * LENGTH);
        off = off.max((sum - expected).length() / size);
        spin_off = spin_off.max((spin(&halves, middle) - start).length() / start.length());
        let reach = (shape(&halves[0]) - middle).length() / LENGTH;
        bent = bent.max(1.0 - reach);
    }
    (off, spin_off, bent)
}

#[test]
fn a_strand_that_flies_freely_keeps_its_momentum() {
    let mut spins = Vec::new();
    for rate in [24, 96, 384, 1536] {
        let (momentum, spin, bent) = fly(1.0 / f64::from(rate));
        println!(
            "1/{rate} s: momentum within {momentum:.1e}, its moment within {spin:.1e}; bent by {bent:.3} L"
        );
        spins.push(spin);
    }
}
