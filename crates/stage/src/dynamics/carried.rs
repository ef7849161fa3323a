//! Strands that guides carry.

use glam::{DQuat, Quat, Vec3};
use groom::Guides;
use hair_sim::{Pose, Strands};
use rayon::prelude::*;
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
    /// How far each point of each carried strand is at rest from its places on its guides, strand by strand.
    offsets: Vec<Vec<[Vec3; CARRIERS]>>,
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
    let carriers: Vec<[(usize, f32); CARRIERS]> = others
        .iter()
        .map(|&i| nearest(&shapes, i, &guides.kept))
        .collect();
    let offsets_of = |(&strand, carriers): (&usize, &[(usize, f32); CARRIERS])| {
        let points = free.strand(strand);
        let offsets = (0..).zip(points).map(|(i, point)| {
            let u = share(i, points.len());
            carriers.map(|(guide, _)| *point - at(free.strand(guides.kept[guide]), u))
        });
        offsets.collect()
    };
    let carried = Carried {
        ranges: others.iter().map(|&i| parts[i].clone()).collect(),
        offsets: others.iter().zip(&carriers).map(offsets_of).collect(),
        carriers,
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
    let first = (place as i32).min(points.len() as i32 - 2);
    let (share, first) = (place - first as f32, first as usize);
    let ends = &points[first..first + 2];
    ends[0].lerp(ends[1], share)
}

/// How far along a strand of so many points one of them is, by number: 0 to 1.
fn share(point: usize, points: usize) -> f32 {
    point as f32 / (points - 1) as f32
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

    /// Puts the carried strands where they are at rest, on a head in this pose.
    pub fn at_rest(&self, head: Pose, points: &mut [Vec3]) {
        for range in &self.ranges {
            let rest = &self.rest[range.clone()];
            for (point, rest) in points[range.clone()].iter_mut().zip(rest) {
                *point = (head.rotation * rest.as_dvec3() + head.translation).as_vec3();
            }
        }
    }

    /// Moves the carried strands: each keeps its place in the frames of its guides, whose links have turned
    /// as `turns` says (one rotation a link). `keep_out` may then move the points of each, of which it is told the
    /// first one's place in the scene; that is the root.
    pub fn carry(
        &self,
        points: &mut [Vec3],
        turns: impl Fn(usize) -> Vec<DQuat> + Sync,
        keep_out: impl Fn(usize, &mut [Vec3]) + Sync,
    ) {
        let turned = self.turned(turns);
        let now: Vec<Vec<Vec3>> = (self.guides.iter())
            .map(|own| points[own.clone()].to_vec())
            .collect();
        let strands = self.strands_of(points);
        (strands.into_par_iter()).zip(&self.offsets).for_each(
            |((range, carriers, moved), offsets)| {
                let count = moved.len();
                let carriers = carriers.map(|(guide, weight)| {
                    let (now, turned): (&[Vec3], &[Quat]) = (&now[guide], &turned[guide]);
                    (now, turned, weight)
                });
                // The root stays with the head.
                for (i, (point, offsets)) in moved.iter_mut().zip(offsets).enumerate().skip(1) {
                    let u = share(i, count);
                    *point = (carriers.iter().zip(offsets))
                        .map(|(&(now, turned, weight), &offset)| {
                            weight * (at(now, u) + link_at(turned, u) * offset)
                        })
                        .sum();
                }
                keep_out(range.start, moved);
            },
        );
    }

    /// Turns the normals of the carried strands as their guides' links have turned.
    pub fn turn(
        &self,
        rest: &[Vec3],
        normals: &mut [Vec3],
        turns: impl Fn(usize) -> Vec<DQuat> + Sync,
    ) {
        let turned = self.turned(turns);
        let strands = self.strands_of(normals);
        strands
            .into_par_iter()
            .for_each(|(range, carriers, normals)| {
                let last = (range.len() - 1) as f32;
                for (i, normal) in normals.iter_mut().enumerate() {
                    let u = i as f32 / last;
                    let turn = |&(guide, weight): &(usize, f32)| {
                        weight * (link_at(&turned[guide], u) * rest[range.start + i])
                    };
                    let sum: Vec3 = carriers.iter().map(turn).sum();
                    *normal = sum.normalize_or(*normal);
                }
            });
    }

    /// The carried strands, what carries them, and their part of a list of all points. Strands lie one after the other in it.
    fn strands_of<'a, 'b>(&'a self, list: &'b mut [Vec3]) -> Vec<Strand<'a, 'b>> {
        let strands = self.ranges.iter().zip(&self.carriers);
        strands
            .zip(parts_of(list, self.ranges.iter()))
            .map(|((range, carriers), own)| (range, carriers, own))
            .collect()
    }

    /// How each guide's links have turned; nothing where nothing is carried.
    fn turned(&self, turns: impl Fn(usize) -> Vec<DQuat> + Sync) -> Vec<Vec<Quat>> {
        let guides = (0..self.guides.len()).into_par_iter();
        guides
            .map(|guide| turns(guide).iter().map(|turn| turn.as_quat()).collect())
            .collect()
    }
}

/// The places of a carried strand in the list of all points, what carries it, and its part of a list.
type Strand<'a, 'b> = (
    &'a Range<usize>,
    &'a [(usize, f32); CARRIERS],
    &'b mut [Vec3],
);

/// The parts of a list in these ranges, which ascend.
pub(super) fn parts_of<'a, 'b>(
    list: &'b mut [Vec3],
    ranges: impl Iterator<Item = &'a Range<usize>>,
) -> impl Iterator<Item = &'b mut [Vec3]> {
    let mut left = (list, 0);
    ranges.map(move |range| {
        let (list, from) = std::mem::take(&mut left);
        let (_, rest) = list.split_at_mut(range.start - from);
        let (own, rest) = rest.split_at_mut(range.len());
        left = (rest, range.end);
        own
    })
}

/// The turn of the link at share `u` of a guide.
fn link_at(links: &[Quat], u: f32) -> Quat {
    let link = (u * links.len() as f32) as i32;
    links[link.min(links.len() as i32 - 1) as usize]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Strands in a row, of which some carry the others; the guides have moved and turned.
    fn carried(threads: usize) -> (usize, Vec<Vec3>) {
        let (mut free, mut parts) = (Strands::new(), Vec::new());
        for strand in 0..60_u32 {
            let points: Vec<Vec3> = (0..5)
                .map(|i| Vec3::new(strand as f32, -(i as f32), (strand * i % 7) as f32) * 0.01)
                .collect();
            let first = parts.last().map_or(3, |part: &Range<usize>| part.end + 2);
            parts.push(first..first + points.len());
            free.push(strand, &points, None).unwrap();
        }
        let (guides, carried) = choose(&free, &parts, 7);
        let mut points = vec![Vec3::ZERO; parts[59].end];
        for &guide in &guides {
            for (i, point) in parts[guide].clone().enumerate() {
                points[point] = free.strand(guide)[i] + Vec3::X * (i as f32 * 0.004);
            }
        }
        let turns = |guide: usize| vec![DQuat::from_rotation_z(0.1 * guide as f64); 4];
        let floor = |_, points: &mut [Vec3]| {
            for point in &mut points[1..] {
                point.y = point.y.max(-0.035);
            }
        };
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        let pool = pool.build().unwrap();
        pool.install(|| carried.carry(&mut points, turns, floor));
        (guides.len(), points)
    }

    #[test]
    fn carried_strands_are_the_same_for_any_number_of_threads() {
        let (guides, one) = carried(1);
        assert_eq!((guides, &one), (carried(3).0, &carried(3).1));
        // All but roots have moved, and only guides' tips are where the others are kept out.
        let moved = one.iter().filter(|point| **point != Vec3::ZERO).count();
        assert!(moved > 60 * 4, "{moved}");
        assert_eq!(one.iter().filter(|point| point.y < -0.036).count(), guides);
    }
}
