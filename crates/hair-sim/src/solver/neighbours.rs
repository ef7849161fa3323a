//! Which strands are neighbours: see [`crate::forces::mutual`].

use std::{cmp::Ordering, collections::HashMap};

use glam::DVec3;

use crate::{
    forces::mutual::{Mutual, Pair},
    lanes::{LANES, Lane, Mask, Quat, Vec3},
    threads::join,
};

use super::{
    batch::{Batch, BatchState},
    rods::Rods,
    sleep::Islands,
};

/// One strand as its neighbours see it.
struct Strand {
    id: u32,
    batch: usize,
    lane: usize,
    root: DVec3,
    particles: Vec<DVec3>,
}

/// The pairs of every batch, and who acts on whom by them. Particles are numbered batch by batch, particle by particle, lane by lane.
pub(super) fn pairs(
    batches: &[Batch],
    states: &[BatchState],
    ids: &[u32],
    mutual: &Mutual,
) -> (Vec<Vec<Pair>>, Islands) {
    let mut first = Vec::with_capacity(batches.len());
    let mut total = 0;
    let mut strands = Vec::new();
    for (b, (batch, state)) in batches.iter().zip(states).enumerate() {
        first.push(total);
        total += batch.count() * LANES;
        for lane in 0..LANES {
            // A root alone has nothing to act with, and would take the place of a neighbour that has.
            let acts = state.set_aside[lane].is_none() && batch.counts[lane] > 0;
            let Some(index) = batch.strands[lane].filter(|_| acts) else {
                continue;
            };
            let root = state.root.get(lane);
            strands.push(Strand {
                id: ids[index],
                batch: b,
                lane,
                root,
                particles: (0..batch.counts[lane])
                    .map(|k| root + state.y[k].get(lane))
                    .collect(),
            });
        }
    }
    let mut pairs: Vec<Vec<Pair>> = batches.iter().map(|_| Vec::new()).collect();
    // Slot (neighbour, particle) of a batch: its pair in the list.
    let mut slots: Vec<Vec<Option<usize>>> = batches
        .iter()
        .map(|b| vec![None; b.count() * mutual.neighbours])
        .collect();
    let cells = Cells::new(&strands);
    let mut nearest = vec![Vec::new(); strands.len()];
    cells.find_nearest(&strands, &strands, mutual.neighbours, &mut nearest);
    let place = |strand: &Strand| (strand.batch, strand.lane);
    let meet = (strands.iter().zip(&nearest))
        .flat_map(|(one, nearest)| nearest.iter().map(move |&i| (one, i)))
        .map(|(one, i)| [place(one), place(&strands[i])]);
    let islands = Islands::new(batches.len(), meet);
    let frames: Vec<Vec<Quat>> = (batches.iter().zip(states))
        .map(|(batch, state)| {
            let mut frames = Rods::frames_one_by_one(batch, state);
            (0..batch.count()).map(|_| frames()).collect()
        })
        .collect();
    for (strand, nearest) in strands.iter().zip(nearest) {
        for (n, other) in nearest.into_iter().map(|i| &strands[i]).enumerate() {
            let count = batches[strand.batch].count();
            // Every second one; of a single link its end.
            let own = strand.particles.len();
            for k in (own.min(2) - 1..own).step_by(2) {
                let Some(partner) = closest(strand.particles[k], &other.particles) else {
                    continue;
                };
                let list = &mut pairs[strand.batch];
                let slot = slots[strand.batch][n * count + k].get_or_insert_with(|| {
                    list.push(Pair {
                        at: k,
                        other: [0; LANES],
                        on: Mask::NONE,
                        linked: Mask::NONE,
                        offset: Vec3::ZERO,
                        length: Lane::ZERO,
                    });
                    list.len() - 1
                });
                let pair = &mut list[*slot];
                let apart = other.particles[partner] - strand.particles[k];
                let frame = frames[strand.batch][k].get(strand.lane);
                let lane = strand.lane;
                pair.other[lane] = (first[other.batch] + partner * LANES + other.lane) as u32;
                pair.on.set(lane, true);
                pair.offset.set(lane, frame.conjugate() * apart);
                pair.length[lane] = apart.length();
                pair.linked.set(lane, apart.length() < mutual.reach);
            }
        }
    }
    // Of a strand's particle, nearest neighbour first, whatever strands are beside it in the batch.
    let pairs = (slots.iter().zip(batches).zip(pairs))
        .map(|((slots, batch), pairs)| in_order(slots, batch.count(), &pairs))
        .collect();
    (pairs, islands)
}

/// The pairs of a batch by their particles, and of each by its neighbours. `slots` has their places, neighbour by neighbour, for `count`
/// particles each.
fn in_order(slots: &[Option<usize>], count: usize, pairs: &[Pair]) -> Vec<Pair> {
    let of = |k| slots.iter().skip(k).step_by(count).flatten();
    (0..count)
        .flat_map(of)
        .map(|&slot| pairs[slot].clone())
        .collect()
}

/// The strands by the cubes of space that their roots are in.
struct Cells {
    /// The edge of a cube in m.
    size: f64,
    strands: HashMap<[i64; 3], Vec<usize>>,
}

impl Cells {
    /// With a few strands in each cube that has any, where roots lie on a surface, however far from it some lie.
    fn new(strands: &[Strand]) -> Self {
        let extent = DVec3::from_array([0, 1, 2].map(|axis| nine_tenths(strands, axis))).length();
        let size = (extent / (strands.len() as f64).sqrt()).max(1e-9);
        let mut cells = Self {
            size,
            strands: HashMap::new(),
        };
        for (i, strand) in strands.iter().enumerate() {
            let cell = cells.cell(strand.root);
            cells.strands.entry(cell).or_default().push(i);
        }
        cells
    }

    fn cell(&self, at: DVec3) -> [i64; 3] {
        (at / self.size).floor().to_array().map(|v| v as i64)
    }

    /// The same of each of some strands.
    fn find_nearest(
        &self,
        of: &[Strand],
        all: &[Strand],
        count: usize,
        nearest: &mut [Vec<usize>],
    ) {
        // A task for fewer of them costs more than they do.
        if of.len() > 16 {
            let half = of.len() / 2;
            let ((of, other), (one, two)) = (of.split_at(half), nearest.split_at_mut(half));
            join(
                || self.find_nearest(of, all, count, one),
                || self.find_nearest(other, all, count, two),
            );
            return;
        }
        for (strand, nearest) in of.iter().zip(nearest) {
            *nearest = self.nearest(strand, all, count);
        }
    }

    /// The strands with the nearest roots, nearest first; of the same distance, the lower id first.
    fn nearest(&self, strand: &Strand, all: &[Strand], count: usize) -> Vec<usize> {
        let count = count.min(all.len() - 1);
        let order = |a: &usize, b: &usize| {
            let distance = |i: usize| (all[i].root - strand.root).length_squared();
            (distance(*a).total_cmp(&distance(*b))).then(all[*a].id.cmp(&all[*b].id))
        };
        let is_other = |i: &usize| (all[*i].batch, all[*i].lane) != (strand.batch, strand.lane);
        let [x, y, z] = self.cell(strand.root);
        // Cubes around that of the root, until none farther away can hold a nearer one; where they are almost all empty,
        // all strands.
        for ring in 1..=4 {
            let mut found = Vec::new();
            for i in x - ring..=x + ring {
                for j in y - ring..=y + ring {
                    for k in z - ring..=z + ring {
                        let here = self.strands.get(&[i, j, k]);
                        found.extend(here.into_iter().flatten().copied().filter(is_other));
                    }
                }
            }
            let certain = self.size * ring as f64;
            let is_certain = |i: &&usize| (all[**i].root - strand.root).length() <= certain;
            if found.iter().filter(is_certain).count() >= count {
                return first(found, count, order);
            }
        }
        first((0..all.len()).filter(is_other).collect(), count, order)
    }
}

/// How far roots lie apart along an axis, without a twentieth at either end.
fn nine_tenths(strands: &[Strand], axis: usize) -> f64 {
    let mut places: Vec<f64> = strands.iter().map(|strand| strand.root[axis]).collect();
    places.sort_unstable_by(f64::total_cmp);
    let at = |twentieths: usize| places.get(places.len() * twentieths / 20).copied();
    at(19).unwrap_or(0.0) - at(1).unwrap_or(0.0)
}

/// The first `count` in an order.
fn first(
    mut all: Vec<usize>,
    count: usize,
    order: impl Fn(&usize, &usize) -> Ordering,
) -> Vec<usize> {
    if 0 < count && count < all.len() {
        all.select_nth_unstable_by(count - 1, &order);
    }
    all.truncate(count);
    all.sort_by(order);
    all
}

fn closest(to: DVec3, particles: &[DVec3]) -> Option<usize> {
    let distance = |p: &DVec3| (*p - to).length_squared();
    (0..particles.len())
        .min_by(|&a, &b| distance(&particles[a]).total_cmp(&distance(&particles[b])))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn strand(i: usize, root: DVec3) -> Strand {
        Strand {
            id: i as u32,
            batch: i,
            lane: 0,
            root,
            particles: Vec::new(),
        }
    }

    #[test]
    fn cells_find_what_a_look_at_all_finds() {
        let spread = |i: usize, k: usize| ((i * 7919 + k * 104_729) % 1009) as f64 / 1009.0;
        let place = |i: usize| DVec3::new(spread(i, 1), spread(i, 2), 0.1 * spread(i, 3));
        // Many side by side, two in one place, and one far away.
        let mut strands: Vec<Strand> = (0..300).map(|i| strand(i, place(i))).collect();
        strands.push(strand(300, place(17)));
        strands.push(strand(301, DVec3::splat(90.0)));
        let cells = Cells::new(&strands);
        for strand in &strands {
            let mut all: Vec<usize> = (0..strands.len()).filter(|&i| i != strand.batch).collect();
            all.sort_by(|&a, &b| {
                let distance = |i: usize| (strands[i].root - strand.root).length_squared();
                distance(a).total_cmp(&distance(b)).then(a.cmp(&b))
            });
            assert_eq!(cells.nearest(strand, &strands, 16), all[..16]);
        }
        // What is far away leaves the others in cubes of their own.
        let most = cells.strands.values().map(Vec::len).max();
        assert!(most < Some(30), "{most:?}");
        let one = &strands[..1];
        assert!(Cells::new(one).nearest(&one[0], one, 4).is_empty());
    }
}
