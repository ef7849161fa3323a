//! The sweep against a dense system whose derivatives are differences.

use super::*;
use crate::{
    params::{Material, Params},
    rest::{RestStrand, turn},
    solver::batch::Batch,
};
use glam::{DMat3, DQuat, DVec3};
use proptest::prelude::*;

/// Everything that a stage minimises, of one strand of a batch.
struct Dense {
    base: DQuat,
    frames: Vec<DQuat>,
    lengths: Vec<f64>,
    stiffness: Vec<DVec3>,
    natural: Vec<DVec3>,
    past: Vec<DVec3>,
    nodes: Vec<(DMat3, DVec3)>,
    h2: f64,
    damping: f64,
}

impl Dense {
    fn turned(&self, link: usize, by: DVec3) -> Vec<DQuat> {
        let mut frames = self.frames.clone();
        frames[link] = DQuat::from_scaled_axis(by) * frames[link];
        frames
    }

    fn joint(&self, frames: &[DQuat], k: usize) -> DVec3 {
        turn(if k == 0 { self.base } else { frames[k - 1] }, frames[k])
    }

    fn particles(&self, frames: &[DQuat]) -> Vec<DVec3> {
        let mut y = DVec3::ZERO;
        let step = |(frame, length): (&DQuat, &f64)| {
            y += *frame * DVec3::Z * *length;
            y
        };
        frames.iter().zip(&self.lengths).map(step).collect()
    }

    fn energy(&self, frames: &[DQuat]) -> f64 {
        let mut sum = 0.0;
        for (y, (n, b)) in self.particles(frames).into_iter().zip(&self.nodes) {
            sum += 0.5 * y.dot(*n * y) - b.dot(y);
        }
        for k in 0..frames.len() {
            let u = self.joint(frames, k);
            let (e, rate) = (u - self.natural[k], u - self.past[k]);
            let weigh = |v: DVec3| (v * v).dot(self.stiffness[k]);
            sum += 0.5 * self.h2 * (weigh(e) + self.damping * weigh(rate));
        }
        sum
    }

    /// The slope of the energy in the turn of every link.
    fn gradient(&self) -> Vec<f64> {
        let h = 1e-5;
        let slope = |i: usize| {
            let by = DVec3::AXES[i % 3] * h;
            let at = |by| self.energy(&self.turned(i / 3, by));
            (at(by) - at(-by)) / (2.0 * h)
        };
        (0..3 * self.frames.len()).map(slope).collect()
    }

    /// Gauss and Newton's matrix: of slopes of particles and joints, and of tension across the links.
    fn matrix(&self) -> Vec<Vec<f64>> {
        let n = self.frames.len();
        let mut matrix = vec![vec![0.0; 3 * n]; 3 * n];
        let y = self.particles(&self.frames);
        let h = 1e-5;
        // Columns: the turn of a link about an axis.
        let particles: Vec<Vec<DVec3>> = (0..3 * n)
            .map(|i| {
                let at = |h: f64| self.particles(&self.turned(i / 3, DVec3::AXES[i % 3] * h));
                at(h)
                    .iter()
                    .zip(at(-h))
                    .map(|(a, b)| (*a - b) / (2.0 * h))
                    .collect()
            })
            .collect();
        let joints: Vec<Vec<DVec3>> = (0..3 * n)
            .map(|i| {
                let at = |h: f64, k| self.joint(&self.turned(i / 3, DVec3::AXES[i % 3] * h), k);
                (0..n).map(|k| (at(h, k) - at(-h, k)) / (2.0 * h)).collect()
            })
            .collect();
        for i in 0..3 * n {
            for j in 0..3 * n {
                for k in 0..n {
                    matrix[i][j] += particles[i][k].dot(self.nodes[k].0 * particles[j][k]);
                    let stiffness = self.stiffness[k] * (self.h2 * (1.0 + self.damping));
                    matrix[i][j] += joints[i][k].dot(stiffness * joints[j][k]);
                }
            }
        }
        for k in 0..n {
            let tangent = self.frames[k] * DVec3::Z;
            let force: DVec3 = (k..n)
                .map(|i| self.nodes[i].0 * y[i] - self.nodes[i].1)
                .sum();
            let tension = (-force.dot(tangent) * self.lengths[k]).max(0.0);
            for (i, a) in DVec3::AXES.into_iter().enumerate() {
                for (j, b) in DVec3::AXES.into_iter().enumerate() {
                    let across = a.dot(b) - tangent[i] * tangent[j];
                    matrix[3 * k + i][3 * k + j] += tension * across;
                }
            }
        }
        matrix
    }
}

/// Gauss's elimination with pivots.
fn solve(mut matrix: Vec<Vec<f64>>, mut right: Vec<f64>) -> Vec<f64> {
    let n = right.len();
    for i in 0..n {
        let pivot = (i..n).max_by(|&a, &b| matrix[a][i].abs().total_cmp(&matrix[b][i].abs()));
        let pivot = pivot.unwrap();
        matrix.swap(i, pivot);
        right.swap(i, pivot);
        for row in i + 1..n {
            let factor = matrix[row][i] / matrix[i][i];
            for column in i..n {
                matrix[row][column] -= factor * matrix[i][column];
            }
            right[row] -= factor * right[i];
        }
    }
    for i in (0..n).rev() {
        let known: f64 = (i + 1..n).map(|j| matrix[i][j] * right[j]).sum();
        right[i] = (right[i] - known) / matrix[i][i];
    }
    right
}

/// What the sweep is given of a batch, and the same of each of its strands.
struct Stage {
    batch: Batch,
    base: Quat,
    chain: Chain,
    nodes: Vec<Node>,
    past: Vec<Vec3>,
    elastic: Elastic,
    dense: Vec<Dense>,
}

/// Two strands of different lengths in a batch, crooked, pulled to and fro.
fn stage(counts: [usize; 2], mut number: impl FnMut() -> f64) -> Stage {
    let mut vector = || DVec3::new(number(), number(), number());
    let mut members = Vec::new();
    for count in counts {
        let mut at = DVec3::ZERO;
        let mut along = DVec3::X;
        let mut points = vec![at.as_vec3()];
        for _ in 0..count {
            along = (along + 0.4 * vector()).normalize_or(along);
            at += along * (0.05 + 0.01 * vector().x);
            points.push(at.as_vec3());
        }
        let params = Params {
            // Stiffness and inertia of like size.
            material: Material::from_gamma(5.0, 0.05 * count as f64),
            ..Params::default()
        };
        let rest = RestStrand::new(&points, &params).unwrap();
        members.push((rest, params));
    }
    let of: Vec<_> = (members.iter().enumerate())
        .map(|(i, m)| (i, &m.0, &m.1))
        .collect();
    let batch = Batch::new(&of);
    let count = batch.count();
    let (h2, damping) = (0.02, 0.3);
    let mut stage = Stage {
        base: batch.base,
        chain: Chain::new(count),
        nodes: vec![Node::<Lane>::zero(); count],
        past: vec![Vec3::ZERO; count],
        elastic: Elastic {
            h2: Lane::splat(h2),
            damping: Lane::splat(damping),
        },
        dense: Vec::new(),
        batch,
    };
    for (lane, (rest, _)) in members.iter().enumerate() {
        let mut dense = Dense {
            base: rest.base,
            frames: Vec::new(),
            lengths: rest.links.iter().map(|l| l.length).collect(),
            stiffness: rest
                .links
                .iter()
                .map(|l| DVec3::new(l.bend, l.bend, l.twist))
                .collect(),
            natural: rest.links.iter().map(|l| l.natural).collect(),
            past: Vec::new(),
            nodes: Vec::new(),
            h2,
            damping,
        };
        for (k, link) in rest.links.iter().enumerate() {
            let frame = DQuat::from_scaled_axis(0.3 * vector()) * link.frame;
            dense.frames.push(frame);
            let past = link.natural + 0.2 * vector();
            dense.past.push(past);
            let pull = vector();
            let outer = DMat3::from_cols(pull * pull.x, pull * pull.y, pull * pull.z);
            let n = (DMat3::IDENTITY + outer) * link.mass;
            let b = 0.5 * link.mass * vector();
            dense.nodes.push((n, b));
            stage.chain.frames[k].set(lane, frame);
            stage.past[k].set(lane, past);
            let node = &mut stage.nodes[k];
            let mut pulls = Vec3::ZERO;
            pulls.set(lane, pull);
            let mut mass = Lane::ZERO;
            mass[lane] = link.mass;
            node.n += Sym3::outer(mass, pulls, mass);
            node.b.set(lane, b);
        }
        for (k, y) in dense.particles(&dense.frames).into_iter().enumerate() {
            stage.chain.y[k].set(lane, y);
        }
        stage.dense.push(dense);
    }
    // Where a shorter strand ends, as `BatchState::new` has it.
    for (lane, dense) in stage.dense.iter().enumerate() {
        let last = dense.frames.len() - 1;
        for k in last + 1..count {
            let (frame, y) = (stage.chain.frames[last], stage.chain.y[last]);
            stage.chain.frames[k].set(lane, frame.get(lane));
            stage.chain.y[k].set(lane, y.get(lane));
        }
    }
    stage.chain.tangents = stage.chain.frames.iter().map(|f| f.tangent()).collect();
    stage
}

impl Stage {
    fn model(&self) -> Model<'_> {
        Model {
            base: &self.base,
            nodes: &self.nodes,
            past: &self.past,
            elastic: self.elastic,
        }
    }

    /// The turn of every link in one sweep, and the largest.
    fn sweep(&self) -> (Vec<Vec3>, Lane) {
        let (links, model) = (&self.batch.links, self.model());
        let mut ready = vec![JointMoment::<Lane>::zero(); links.len()];
        let mut eliminations = vec![Elimination::<Lane>::zero(); links.len()];
        let mut turns = vec![Vec3::ZERO; links.len()];
        joints::<Lane>(links, &model, &self.chain, &mut ready);
        ascend::<Lane>(links, &self.nodes, &self.chain, &ready, &mut eliminations);
        let largest = descend::<Lane>(links, &self.chain.tangents, &eliminations, &mut turns);
        (turns, largest)
    }
}

fn counts() -> impl Strategy<Value = [usize; 2]> {
    [1..7_usize, 1..7_usize]
}

fn numbers() -> impl Strategy<Value = Vec<f64>> {
    proptest::collection::vec(-1.0..1.0_f64, 400)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn one_sweep_solves_the_dense_system(counts in counts(), numbers in numbers()) {
        let mut numbers = numbers.into_iter().cycle();
        let stage = stage(counts, || numbers.next().unwrap());
        let (turns, largest) = stage.sweep();
        for (lane, dense) in stage.dense.iter().enumerate() {
            let right = dense.gradient().into_iter().map(|g| -g).collect();
            let expected = solve(dense.matrix(), right);
            let size = expected.iter().map(|v| v * v).sum::<f64>().sqrt();
            let mut most = 0.0_f64;
            for k in 0..dense.frames.len() {
                let expected = DVec3::from_slice(&expected[3 * k..]);
                let off = (turns[k].get(lane) - expected).length();
                prop_assert!(off < 1e-5 * (size + 1e-3), "link {k}: {} {expected}", turns[k].get(lane));
                most = most.max(turns[k].get(lane).length());
            }
            prop_assert!((largest[lane] - most).abs() < 1e-12 * (1.0 + most));
        }
    }

    #[test]
    fn the_potential_is_the_energy_that_the_module_says(counts in counts(), numbers in numbers()) {
        let mut numbers = numbers.into_iter().cycle();
        let stage = stage(counts, || numbers.next().unwrap());
        let links = &stage.batch.links;
        let sum = potential(links, &stage.model(), &stage.chain);
        for (lane, dense) in stage.dense.iter().enumerate() {
            let expected = dense.energy(&dense.frames);
            prop_assert!((sum[lane] - expected).abs() < 1e-12 * (1.0 + expected.abs()));
        }
    }

    #[test]
    fn a_strand_s_turns_are_its_own(counts in counts(), numbers in numbers()) {
        let run = |other: f64| {
            let mut numbers = numbers.iter().copied().cycle();
            let mut stage = stage(counts, || numbers.next().unwrap());
            for node in &mut stage.nodes {
                node.b.x[1] += other;
            }
            let (turns, _) = stage.sweep();
            turns.iter().map(|t| t.get(0)).collect::<Vec<DVec3>>()
        };
        prop_assert_eq!(run(0.0), run(1.0));
        prop_assert_eq!(run(0.0), run(f64::NAN));
    }
}
