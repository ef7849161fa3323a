//! Which strands are neighbours: see [`crate::forces::mutual`].

use glam::DVec3;

use crate::{
    forces::mutual::{Mutual, Pair},
    lanes::{LANES, Lane, Vec3},
};

use super::batch::{Batch, BatchState};

/// One strand as its neighbours see it.
struct Strand {
    id: u32,
    batch: usize,
    lane: usize,
    root: DVec3,
    particles: Vec<DVec3>,
}

/// The pairs of every batch, and the index of every batch's first particle in the list of all.
pub(super) fn pairs(
    batches: &[Batch],
    states: &[BatchState],
    ids: &[u32],
    mutual: &Mutual,
) -> (Vec<Vec<Pair>>, Vec<usize>) {
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
    for strand in &strands {
        for (n, other) in nearest(strand, &strands, mutual.neighbours).enumerate() {
            let count = batches[strand.batch].count();
            for k in (1..strand.particles.len()).step_by(2) {
                let Some(partner) = closest(strand.particles[k], &other.particles) else {
                    continue;
                };
                let list = &mut pairs[strand.batch];
                let slot = slots[strand.batch][n * count + k].get_or_insert_with(|| {
                    list.push(Pair {
                        at: k,
                        other: [0; LANES],
                        on: Lane::ZERO,
                        linked: Lane::ZERO,
                        offset: Vec3::ZERO,
                        length: Lane::ZERO,
                    });
                    list.len() - 1
                });
                let pair = &mut list[*slot];
                let apart = other.particles[partner] - strand.particles[k];
                let frame = states[strand.batch].frames[k].get(strand.lane);
                let lane = strand.lane;
                pair.other[lane] = (first[other.batch] + partner * LANES + other.lane) as u32;
                pair.on[lane] = 1.0;
                pair.offset.set(lane, frame.conjugate() * apart);
                pair.length[lane] = apart.length();
                pair.linked[lane] = f64::from(u8::from(apart.length() < mutual.reach));
            }
        }
    }
    (pairs, first)
}

/// The strands with the nearest roots; of the same distance, the lower id first.
fn nearest<'a>(
    strand: &Strand,
    all: &'a [Strand],
    count: usize,
) -> impl Iterator<Item = &'a Strand> {
    let mut others: Vec<(f64, u32, usize)> = all
        .iter()
        .enumerate()
        .filter(|(_, o)| (o.batch, o.lane) != (strand.batch, strand.lane))
        .map(|(i, o)| ((o.root - strand.root).length_squared(), o.id, i))
        .collect();
    let count = count.min(others.len());
    if count > 0 {
        others.select_nth_unstable_by(count - 1, |a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        others[..count].sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    }
    others.truncate(count);
    others.into_iter().map(|o| &all[o.2])
}

fn closest(to: DVec3, particles: &[DVec3]) -> Option<usize> {
    let distance = |p: &DVec3| (*p - to).length_squared();
    (0..particles.len())
        .min_by(|&a, &b| distance(&particles[a]).total_cmp(&distance(&particles[b])))
}
