//! Straight strands against the energy that a stage minimises, and against the same strands with their twist solved.

use super::*;
use crate::{
    Collider, Material, Mutual, Natural, Params, Pose, Roots, Shape, Solver, Strands, Surroundings,
    Wind, rest::RestStrand,
};
use glam::{DMat3, DQuat, DVec2, DVec3, Vec3 as Point};
use proptest::prelude::*;

const LENGTH: f64 = 0.3;

/// A curvature in 1/m that nothing shows but that twist is solved.
const NEARLY_STRAIGHT: f64 = 1e-6;

/// Straight by nature, whatever they are styled like.
fn straight(gamma: f64) -> Params {
    Params {
        material: Material::from_gamma(gamma, LENGTH),
        natural: Natural::Curl {
            curvature: 0.0,
            torsion: 0.0,
        },
        ..Params::default()
    }
}

/// What a stage minimises over the directions of a strand's links, one strand and link after the other.
struct Whole {
    base: DQuat,
    lengths: Vec<f64>,
    bend: Vec<f64>,
    nodes: Vec<(DMat3, DVec3)>,
    past: Vec<DVec2>,
    damping: f64,
}

impl Whole {
    fn energy(&self, tangents: &[DVec3]) -> f64 {
        let (mut t, mut y, mut sum) = (self.base * DVec3::Z, DVec3::ZERO, 0.0);
        let mut axes = [self.base * DVec3::X, self.base * DVec3::Y];
        for (k, &next) in tangents.iter().enumerate() {
            // 2 tan(angle / 2), towards the link, in the axes of the link before.
            let tangent = 2.0 * ((1.0 - t.dot(next)) / (1.0 + t.dot(next))).sqrt();
            let towards = DVec2::new(axes[0].dot(next), axes[1].dot(next));
            let turn = tangent * towards.normalize_or_zero();
            let strain =
                turn.length_squared() + self.damping * (turn - self.past[k]).length_squared();
            sum += 0.5 * self.bend[k] * strain;
            let carry = DQuat::from_rotation_arc(t, next);
            axes = axes.map(|axis| carry * axis);
            t = next;
            y += next * self.lengths[k];
            let (n, b) = self.nodes[k];
            sum += 0.5 * y.dot(n * y) - b.dot(y);
        }
        sum
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// With the moments by way of the frames beyond that damping needs.
    #[test]
    fn sweeps_come_to_the_least_energy(
        count in 1..7_usize,
        damping in 0.0..2.0_f64,
        numbers in proptest::collection::vec(-1.0..1.0_f64, 200),
    ) {
        let mut numbers = numbers.into_iter().cycle();
        let mut vector = || DVec3::from_array([(); 3].map(|()| numbers.next().unwrap()));
        let params = Params {
            damping: 0.0,
            ..straight(5.0)
        };
        let points: Vec<Point> = (0..=count)
            .map(|i| Point::X * (LENGTH as f32 * i as f32 / count as f32))
            .collect();
        let rest = RestStrand::new(&points, &params).unwrap();
        let batch = Batch::new(&[(0, &rest, &params)]);
        prop_assert!(batch.is_straight);

        let mut stage = Whole {
            base: rest.base,
            lengths: rest.links.iter().map(|link| link.length).collect(),
            bend: rest.links.iter().map(|link| link.bend).collect(),
            nodes: Vec::new(),
            past: Vec::new(),
            damping,
        };
        let mut nodes = vec![Node::<Lane>::zero(); count];
        let mut past = vec![Vec3::ZERO; count];
        let mut chain = Chain::new(count);
        // As stiff as heavy.
        let h2 = 1e-4 * params.material.bending().recip();
        for (k, link) in rest.links.iter().enumerate() {
            let pull = vector();
            let n = (DMat3::IDENTITY + DMat3::from_cols(pull * pull.x, pull * pull.y, pull * pull.z)) * link.mass;
            let b = 0.3 * link.mass * vector();
            let turn = 0.4 * vector().truncate();
            stage.nodes.push((n, b));
            stage.past.push(turn);
            stage.bend[k] *= h2;
            let mut pulls = Vec3::ZERO;
            pulls.set(0, pull);
            nodes[k].n = Sym3::outer(Lane::splat(link.mass), pulls, Lane::splat(link.mass));
            nodes[k].b.set(0, b);
            past[k].set(0, DVec3::new(-turn.y, turn.x, 0.0));
            chain.tangents[k] = Vec3::splat((rest.base * DVec3::Z + 0.3 * vector()).normalize());
        }
        lay_out::<Lane>(&batch.links, &mut chain, |_, t| t);

        let model = Model {
            base: &batch.base,
            nodes: &nodes,
            past: &past,
            elastic: Elastic {
                h2: Lane::splat(h2),
                damping: Lane::splat(damping),
            },
        };
        let mut scratch = Scratch::new(count);
        let mut largest = f64::MAX;
        for _ in 0..400 {
            let (links, all) = (&batch.links, Mask::NONE.not());
            largest = newton::<Lane>(links, &model, &mut chain, &mut scratch, 0.5, all).0[0];
        }
        // Where it jumps between two shapes it has found neither.
        prop_assume!(largest < 1e-9);

        let tangents: Vec<DVec3> = chain.tangents.iter().map(|t| t.get(0)).collect();
        let scale: f64 = stage.bend.iter().sum();
        for k in 0..count {
            let across = &scratch.acrosses[k];
            for axis in [across.first.get(0), across.second.get(0)] {
                // Of fourth order, so that its steps may be long: rounding of energies makes no more than 1e-12 of it.
                let h = 1e-3;
                let at = |by: f64| {
                    let mut moved = tangents.clone();
                    moved[k] = (moved[k] + axis * by).normalize();
                    stage.energy(&moved)
                };
                let slope = (8.0 * (at(h) - at(-h)) - (at(2.0 * h) - at(-2.0 * h))) / (12.0 * h);
                prop_assert!(slope.abs() < 1e-8 * scale, "link {k} of {count}: {slope:e} of {scale:e}");
            }
        }
    }
}

/// Strands on a ball of 0.1 m that point away from it, of different lengths, and one that starts crooked.
fn strands() -> Strands {
    let mut strands = Strands::new();
    for s in 0..6_u32 {
        let turn = s as f32 * 1.1;
        let out = Point::new(turn.cos(), 0.4, turn.sin()).normalize();
        let count = 16 + s % 3;
        let points: Vec<Point> = (0..=count)
            .map(|i| {
                let u = i as f32 / count as f32;
                let crooked = if s == 5 { 0.02 * (9.0 * u).sin() } else { 0.0 };
                out * (0.101 + LENGTH as f32 * u) + Point::Y * crooked
            })
            .collect();
        strands.push(s, &points, None).unwrap();
    }
    strands
}

/// The farthest that any point is from where it is with the twist solved, in m, in half a second in which the head nods and turns.
fn apart(params: &Params, mutual: Option<Mutual>, ball: bool, rate: u32) -> f64 {
    let mut runs = [0.0, NEARLY_STRAIGHT].map(|curvature| {
        let natural = Natural::Curl {
            curvature,
            torsion: 0.0,
        };
        let params = Params { natural, ..*params };
        let (mut solver, mut state) = Solver::new(&strands(), &params).unwrap();
        let is_straight = curvature == 0.0;
        assert!((solver.batches.iter()).all(|batch| batch.is_straight == is_straight));
        if let Some(mutual) = &mutual {
            solver.interact(&mut state, mutual).unwrap();
        }
        (solver, state)
    });
    let dt = 1.0 / f64::from(rate);
    let head = |step: u32| {
        let time = dt * f64::from(step);
        Pose {
            rotation: DQuat::from_rotation_y(0.8 * (5.0 * time).sin())
                * DQuat::from_rotation_x(0.4 * (3.0 * time).sin()),
            translation: DVec3::X * (0.05 * (4.0 * time).sin()),
        }
    };
    let mut most = 0.0_f64;
    let mut contacts = 0;
    for step in 0..rate / 2 {
        let colliders = [Collider {
            shape: Shape::Sphere {
                center: DVec3::ZERO,
                radius: 0.1,
            },
            before: head(step),
            now: head(step + 1),
            was: None,
        }];
        let surroundings = Surroundings {
            roots: Roots::Head(head(step + 1)),
            colliders: if ball { &colliders } else { &[] },
            wind: Wind {
                steady: DVec3::new(2.0, 0.0, -1.0),
                gust: 3.0,
                ..Wind::default()
            },
            ..Surroundings::default()
        };
        for (solver, state) in &mut runs {
            let stats = solver.step(state, &surroundings, dt).unwrap();
            assert_eq!((stats.strands, stats.set_aside), (6, 0));
            contacts += stats.contacts;
        }
        let [(one, first), (other, second)] = &runs;
        for strand in 0..6 {
            for (a, b) in one.points(first, strand).zip(other.points(second, strand)) {
                most = most.max((a - b).length());
            }
        }
    }
    assert_eq!(contacts > 0, ball);
    most
}

/// Prints how far apart they are as well.
#[test]
#[allow(
    clippy::print_stdout,
    reason = "it shows what leaving the twist out changes"
)]
fn they_move_as_with_their_twist() {
    let undamped = Params {
        damping: 0.0,
        ..straight(30.0)
    };
    let links = Mutual {
        reach: 0.2,
        ..Mutual::default()
    };
    for (name, params, mutual, ball) in [
        ("undamped", undamped, None, false),
        ("of Gamma 1", straight(1.0), None, false),
        ("of Gamma 30", straight(30.0), None, false),
        ("linked", straight(30.0), Some(links), false),
        ("on a ball", straight(30.0), None, true),
    ] {
        let [coarse, fine] = [60, 240].map(|rate| apart(&params, mutual, ball, rate) / LENGTH);
        println!(
            "strands {name}: {coarse:.1e} of their length apart in steps of 1/60 s, {fine:.1e} of 1/240 s"
        );
        // What is left in fine steps is what damping twists; the rest are the errors of steps, which are not the same ones.
        assert!(coarse < 0.1 && fine < 0.01, "{name}");
    }
}

#[test]
fn what_is_bent_or_twisted_solves_its_twist() {
    let is_straight = |params: &Params| {
        let (solver, _) = Solver::new(&strands(), params).unwrap();
        (solver
            .batches
            .iter()
            .flat_map(|batch| batch.strands.iter().flatten().map(|_| batch.is_straight)))
        .collect::<Vec<_>>()
    };
    assert_eq!(is_straight(&straight(10.0)), [true; 6]);
    let curled = Natural::Curl {
        curvature: 1.0,
        torsion: 0.0,
    };
    let curly = Params {
        natural: curled,
        ..straight(10.0)
    };
    let damped = Params {
        damping: 0.1,
        ..straight(10.0)
    };
    let mut soft = straight(10.0);
    soft.material.twist_ratio = 0.1;
    for params in [curly, damped, soft] {
        assert_eq!(is_straight(&params), [false; 6]);
    }
    // Of the styled shapes five are straight.
    let styled = Params {
        natural: Natural::Styled,
        ..straight(10.0)
    };
    let straights = is_straight(&styled).iter().filter(|is| **is).count();
    assert_eq!(straights, 5);
}

/// Where a strand is shorter than those beside it, what fills its lane up decides nothing.
#[test]
fn longer_strands_beside_it_do_not_change_a_strand() {
    let path = |others: u32| {
        let mut rest = Strands::new();
        for s in 0..=others {
            let count = if s == 0 { 7 } else { 12 + s };
            let points: Vec<Point> = (0..=count)
                .map(|i| Point::new(0.02 * i as f32, 0.0, 0.01 * s as f32))
                .collect();
            rest.push(s, &points, None).unwrap();
        }
        let params = Params {
            damping: 0.004,
            ..straight(50.0)
        };
        let (mut solver, mut state) = Solver::new(&rest, &params).unwrap();
        let first = solver.places[0].0;
        assert!(solver.batches[first].is_straight);
        assert_eq!(solver.batches[first].count() > 7, others > 0);
        let mut path = Vec::new();
        for step in 0..120 {
            // A root that turns to and fro, so that links beyond the end would lag behind.
            let turn = DQuat::from_rotation_z((0.4 * f64::from(step)).sin());
            let surroundings = Surroundings {
                roots: Roots::Head(Pose {
                    rotation: turn,
                    translation: DVec3::ZERO,
                }),
                ..Surroundings::default()
            };
            solver.step(&mut state, &surroundings, 1.0 / 60.0).unwrap();
            path.extend(solver.points(&state, 0));
        }
        path
    };
    assert_eq!(path(0), path(3));
}

/// The scratch that batches work in one after the other decides nothing, whatever was left in it.
#[test]
fn what_is_left_of_other_batches_decides_nothing() {
    let path = |left: f64| {
        let undamped = Params {
            damping: 0.0,
            ..straight(1e4)
        };
        let (mut solver, mut state) = Solver::new(&strands(), &undamped).unwrap();
        let (mut path, mut fallbacks) = (Vec::new(), 0);
        for step in 0..24 {
            for scratch in &mut solver.scratch {
                let work = &mut scratch.work;
                for list in [
                    &mut work.past,
                    &mut scratch.turn_start,
                    &mut work.newton.curled.turns,
                    &mut work.newton.straight.moves,
                ] {
                    list.fill(Vec3::splat(DVec3::splat(left)));
                }
            }
            // A head that is thrown about, so that the safe integrator is needed.
            let surroundings = Surroundings {
                roots: Roots::Head(Pose {
                    rotation: DQuat::from_rotation_x(f64::from(step % 3) * 2.0),
                    translation: DVec3::ZERO,
                }),
                ..Surroundings::default()
            };
            let stats = solver.step(&mut state, &surroundings, 1.0 / 24.0).unwrap();
            assert_eq!(stats.set_aside, 0);
            fallbacks += stats.fallbacks;
            path.extend((0..6).flat_map(|s| solver.points(&state, s).collect::<Vec<_>>()));
        }
        assert!(fallbacks > 0);
        path
    };
    assert_eq!(path(0.0), path(f64::NAN));
}

/// Straight strands keep no frames, and others need them.
#[test]
fn a_state_without_frames_is_refused_where_they_are_needed() {
    let (_, mut state) = Solver::new(&strands(), &straight(10.0)).unwrap();
    let (mut solver, _) = Solver::new(&strands(), &Params::default()).unwrap();
    let refused = solver.step(&mut state, &Surroundings::default(), 1.0 / 24.0);
    assert_eq!(refused, Err(crate::DynamicsError::State));
    // Five of the six are straight as they are styled, so they stand in other places.
    let styled = Params {
        natural: Natural::Styled,
        ..straight(10.0)
    };
    let (mut solver, _) = Solver::new(&strands(), &styled).unwrap();
    let refused = solver.step(&mut state, &Surroundings::default(), 1.0 / 24.0);
    assert_eq!(refused, Err(crate::DynamicsError::State));
}
