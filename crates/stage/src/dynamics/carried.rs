//! Strands that guides carry.

use glam::{DQuat, Quat, Vec3};
use groom::Guides;
use hair_sim::Strands;
use std::ops::Range;

/// Guides that carry one strand.
const CARRIERS: usize = 3;

/// Strands that are not simulated, with what carries them.
#[derive(Default)]
pub(crate) struct Carried {
    /// Points of each carried strand.
    ranges: Vec<Range<usize>>,
    /// Guides of each: strand of the solver, points of the scene, weight.
    carriers: Vec<[(usize, f32); CARRIERS]>,
    /// Points of the scene of each guide.
    guides: Vec<Range<usize>>,
    /// All points of the scene's free strands at rest.
    rest: Vec<Vec3>,
}

/// Chooses at most `most` of the free strands as guides, by their indices, and what carries the others.
/// `parts` are the points of the scene that each free strand is.
pub(crate) fn choose(free: &Strands, parts: &[Range<usize>], most: u32) -> (Vec<usize>, Carried) {
    let most = most.max(1) as usize;
    if free.len() <= most {
        return ((0..free.len()).collect(), Carried::default());
    }
    let guides = Guides::choose(free, most);
    let mut is_guide = vec![false; free.len()];
    for &guide in &guides.kept {
        is_guide[guide] = true;
    }
    let shapes: Vec<[Vec3; 4]> = free.iter().map(shape).collect();
    let mut rest = vec![Vec3::ZERO; parts.iter().map(|part| part.end).max().unwrap_or(0)];
    for (part, points) in parts.iter().zip(free.iter()) {
        rest[part.clone()].copy_from_slice(points);
    }
    let others: Vec<usize> = (0..free.len()).filter(|i| !is_guide[*i]).collect();
    let carried = Carried {
        ranges: others.iter().map(|&i| parts[i].clone()).collect(),
        carriers: others
            .iter()
            .map(|&i| nearest(&shapes, i, &guides.kept))
            .collect(),
        guides: guides.kept.iter().map(|&i| parts[i].clone()).collect(),
        rest,
    };
    (guides.kept, carried)
}

/// A strand's points at four places along it.
fn shape(points: &[Vec3]) -> [Vec3; 4] {
    [0.0, 0.33, 0.67, 1.0].map(|u| at(points, u))
}

/// The point at share `u` of a chain of points, by number.
fn at(points: &[Vec3], u: f32) -> Vec3 {
    let place = u * (points.len() - 1) as f32;
    let first = (place as usize).min(points.len() - 2);
    points[first].lerp(points[first + 1], place - first as f32)
}

/// The guides nearest to a strand in root and shape, with weights that add up to 1.
fn nearest(shapes: &[[Vec3; 4]], strand: usize, guides: &[usize]) -> [(usize, f32); CARRIERS] {
    let mut found = [(0, f32::INFINITY); CARRIERS];
    for (number, &guide) in guides.iter().enumerate() {
        let apart: f32 = (0..4)
            .map(|i| shapes[strand][i].distance_squared(shapes[guide][i]))
            .sum();
        if apart < found[CARRIERS - 1].1 {
            let place = found
                .iter()
                .position(|(_, other)| apart < *other)
                .unwrap_or(0);
            found[place..].rotate_right(1);
            found[place] = (number, apart);
        }
    }
    let closeness = found.map(|(_, apart)| 1.0 / (apart + 1e-8));
    let sum: f32 = closeness.iter().sum();
    std::array::from_fn(|i| (found[i].0, closeness[i] / sum))
}

impl Carried {
    /// The points of each carried strand.
    pub fn ranges(&self) -> &[Range<usize>] {
        &self.ranges
    }

    /// Moves the carried strands: each keeps its place in the frames of its guides, whose links have turned
    /// as `turns` says (one rotation a link).
    pub fn carry(&self, points: &mut [Vec3], turns: impl Fn(usize) -> Vec<DQuat>) {
        let turned = self.turned(&turns);
        for (range, carriers) in self.ranges.iter().zip(&self.carriers) {
            let last = (range.len() - 1) as f32;
            // The root stays with the head.
            for point in range.clone().skip(1) {
                let u = (point - range.start) as f32 / last;
                let rest = self.rest[point];
                points[point] = carriers
                    .iter()
                    .map(|&(guide, weight)| {
                        let own = self.guides[guide].clone();
                        let offset = rest - at(&self.rest[own.clone()], u);
                        weight * (at(&points[own], u) + link_at(&turned[guide], u) * offset)
                    })
                    .sum();
            }
        }
    }

    /// Turns the normals of the carried strands as their guides' links have turned.
    pub fn turn(&self, rest: &[Vec3], normals: &mut [Vec3], turns: impl Fn(usize) -> Vec<DQuat>) {
        let turned = self.turned(&turns);
        for (range, carriers) in self.ranges.iter().zip(&self.carriers) {
            let last = (range.len() - 1) as f32;
            for point in range.clone() {
                let u = (point - range.start) as f32 / last;
                let turn = |&(guide, weight): &(usize, f32)| {
                    weight * (link_at(&turned[guide], u) * rest[point])
                };
                let sum: Vec3 = carriers.iter().map(turn).sum();
                normals[point] = sum.normalize_or(normals[point]);
            }
        }
    }

    /// How each guide's links have turned; nothing where nothing is carried.
    fn turned(&self, turns: &dyn Fn(usize) -> Vec<DQuat>) -> Vec<Vec<Quat>> {
        let guides = 0..self.guides.len();
        guides
            .map(|guide| turns(guide).iter().map(|turn| turn.as_quat()).collect())
            .collect()
    }
}

/// The turn of the link at share `u` of a guide.
fn link_at(links: &[Quat], u: f32) -> Quat {
    links[((u * links.len() as f32) as usize).min(links.len() - 1)]
}
