//! Strands that guides carry.

use glam::{DQuat, Quat, Vec3, Vec3A};
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
    /// Guides of each.
    carriers: Vec<[Carrier; CARRIERS]>,
    /// Where points of a strand of so many points are on guides of so many.
    places: Vec<((usize, usize), Vec<Place>)>,
    /// Points of the scene of each guide.
    guides: Vec<Range<usize>>,
    /// All points of the scene's free strands at rest.
    rest: Vec<Vec3>,
    /// How far each point of each carried strand is at rest from its places on its guides, strand by strand.
    offsets: Vec<Vec<[Vec3; CARRIERS]>>,
}

/// A guide of a carried strand: its number, how much it counts, and which of [`Carried`]'s places its points have there.
#[derive(Clone, Copy, Debug)]
struct Carrier {
    guide: usize,
    weight: f32,
    places: usize,
}

/// A place on a guide: the link, by number, and how far along it.
#[derive(Clone, Copy, Debug)]
struct Place {
    link: usize,
    share: f32,
}

impl Place {
    /// At share `u` of a chain of so many points, by number.
    fn new(u: f32, points: usize) -> Self {
        let place = u * (points - 1) as f32;
        let link = (place as i32).min(points as i32 - 2);
        Self {
            link: link as usize,
            share: place - link as f32,
        }
    }
}

/// A link of a guide: its ends, and how it has turned.
#[derive(Clone, Copy, Debug)]
struct Link {
    ends: [Vec3A; 2],
    turn: Turn,
}

/// A rotation, made ready to turn vectors to the bits that a [`Quat`] turns them to.
#[derive(Clone, Copy, Debug)]
struct Turn {
    axis: Vec3A,
    /// Of the vector itself, and of its cross product with the axis.
    shares: [f32; 2],
}

impl From<Quat> for Turn {
    fn from(turn: Quat) -> Self {
        let (axis, w) = (Vec3A::new(turn.x, turn.y, turn.z), turn.w);
        Self {
            axis,
            shares: [w * w - axis.dot(axis), w * 2.0],
        }
    }
}

impl Turn {
    #[inline(always)]
    fn of(&self, v: Vec3A) -> Vec3A {
        let Self { axis, shares } = *self;
        v * shares[0] + axis * (v.dot_into_vec(axis) * 2.0) + axis.cross(v) * shares[1]
    }
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
    let mut places = Vec::new();
    let mut carrier = |strand: usize, (guide, weight): (usize, f32)| {
        let counts = (parts[strand].len(), parts[guides.kept[guide]].len());
        let known = places.iter().position(|(of, _)| *of == counts);
        let places = known.unwrap_or_else(|| {
            let of = |i| Place::new(share(i, counts.0), counts.1);
            places.push((counts, (0..counts.0).map(of).collect()));
            places.len() - 1
        });
        Carrier {
            guide,
            weight,
            places,
        }
    };
    let carriers: Vec<[Carrier; CARRIERS]> = others
        .iter()
        .map(|&i| nearest(&shapes, i, &guides.kept).map(|own| carrier(i, own)))
        .collect();
    let offsets_of = |(&strand, carriers): (&usize, &[Carrier; CARRIERS])| {
        let points = free.strand(strand);
        let offsets = (0..).zip(points).map(|(i, point)| {
            let u = share(i, points.len());
            carriers.map(|own| *point - at(free.strand(guides.kept[own.guide]), u))
        });
        offsets.collect()
    };
    let carried = Carried {
        ranges: others.iter().map(|&i| parts[i].clone()).collect(),
        offsets: others.iter().zip(&carriers).map(offsets_of).collect(),
        carriers,
        places,
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
    let Place { link, share } = Place::new(u, points.len());
    points[link].lerp(points[link + 1], share)
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
    /// first one's place in the scene; that is the root. It works with what `start` makes for each task.
    pub fn carry<T>(
        &self,
        points: &mut [Vec3],
        turns: impl Fn(usize) -> Vec<DQuat> + Sync,
        (start, keep_out): (
            impl Fn() -> T + Sync + Send,
            impl Fn(&mut T, usize, &mut [Vec3]) + Sync,
        ),
    ) {
        let guides = self.guides_now(points, &turns);
        let strands = self.strands_of(points);
        (strands.into_par_iter()).zip(&self.offsets).for_each_init(
            start,
            |work, ((range, carriers, moved), offsets)| {
                let carriers = carriers.map(|own| {
                    let (links, places) = (&guides[own.guide], &self.places[own.places].1);
                    (&links[..], &places[..moved.len()], own.weight)
                });
                // The root stays with the head.
                for (i, (point, offsets)) in moved.iter_mut().zip(offsets).enumerate().skip(1) {
                    let mut sum = Vec3A::ZERO;
                    for (&(links, places, weight), offset) in carriers.iter().zip(offsets) {
                        let Place { link, share } = places[i];
                        let Link { ends, turn } = &links[link];
                        let guide = ends[0].lerp(ends[1], share);
                        sum += weight * (guide + turn.of(Vec3A::from(*offset)));
                    }
                    *point = sum.into();
                }
                keep_out(work, range.start, moved);
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
                for (i, normal) in normals.iter_mut().enumerate() {
                    let turn = |own: &Carrier| {
                        let place = self.places[own.places].1[i];
                        own.weight * (turned[own.guide][place.link] * rest[range.start + i])
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

    /// The links of each guide as they stand in a list of all points, and have turned.
    fn guides_now(
        &self,
        points: &[Vec3],
        turns: &(impl Fn(usize) -> Vec<DQuat> + Sync),
    ) -> Vec<Vec<Link>> {
        let guides = self.guides.par_iter().enumerate();
        let links_of = |(guide, own): (usize, &Range<usize>)| {
            let links = points[own.clone()].windows(2).zip(turns(guide));
            let link = |(ends, turn): (&[Vec3], DQuat)| Link {
                ends: [ends[0].into(), ends[1].into()],
                turn: turn.as_quat().into(),
            };
            links.map(link).collect()
        };
        guides.map(links_of).collect()
    }
}

/// The places of a carried strand in the list of all points, what carries it, and its part of a list.
type Strand<'a, 'b> = (&'a Range<usize>, &'a [Carrier; CARRIERS], &'b mut [Vec3]);

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
        let floor = |_: &mut (), _, points: &mut [Vec3]| {
            for point in &mut points[1..] {
                point.y = point.y.max(-0.035);
            }
        };
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        let pool = pool.build().unwrap();
        pool.install(|| carried.carry(&mut points, turns, (|| (), floor)));
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

    /// Each point is where its guides have it, to the bit, also where they have another number of points.
    #[test]
    fn carried_points_keep_their_places_on_their_guides() {
        let (mut free, mut parts) = (Strands::new(), Vec::new());
        for strand in 0..30_u32 {
            let count = 5 + strand as usize % 3;
            let points: Vec<Vec3> = (0..count)
                .map(|i| Vec3::new(strand as f32, -(i as f32), (strand * i as u32 % 7) as f32))
                .collect();
            let first = parts.last().map_or(0, |part: &Range<usize>| part.end);
            parts.push(first..first + count);
            free.push(strand, &points, None).unwrap();
        }
        let (guides, carried) = choose(&free, &parts, 8);
        let shift = |strand: usize| Vec3::new(0.1, 0.03 * strand as f32, -0.2);
        let mut points = vec![Vec3::ZERO; parts[29].end];
        for &guide in &guides {
            for (i, point) in parts[guide].clone().enumerate() {
                points[point] = free.strand(guide)[i] + shift(guide);
            }
        }
        let turns = |guide: usize| {
            let links = parts[guides[guide]].len() - 1;
            let turn = |link: usize| DQuat::from_rotation_z(0.1 * (guide + link) as f64);
            (0..links).map(turn).collect::<Vec<_>>()
        };
        let before = points.clone();
        carried.carry(&mut points, turns, (|| (), |_, _, _| {}));
        let mut counts = (0, 0);
        for (strand, range) in carried.ranges.iter().enumerate() {
            for i in 1..range.len() {
                let u = share(i, range.len());
                let of = |(own, offset): (&Carrier, &Vec3)| {
                    let now = &before[parts[guides[own.guide]].clone()];
                    counts.0 += usize::from(now.len() != range.len());
                    let turns = turns(own.guide);
                    let link = (u * turns.len() as f32) as usize;
                    let turn = turns[link.min(turns.len() - 1)].as_quat();
                    own.weight * (at(now, u) + turn * *offset)
                };
                let carriers = carried.carriers[strand].iter();
                let there: Vec3 = carriers.zip(&carried.offsets[strand][i]).map(of).sum();
                assert_eq!(points[range.start + i], there);
                counts.1 += 1;
            }
        }
        assert!(counts.0 > 20 && counts.1 > 80, "{counts:?}");
    }
}
