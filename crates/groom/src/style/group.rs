//! Clumps that come together in groups: big, middle and small ones, each with a longest clump in its middle.

use super::description::Zone;
use super::row::size_class;
use crate::random::Random;

/// How much groups differ in how far they swing, as a share.
const SWINGS: f32 = 0.4;
/// Share of groups that are of a middle or small size.
const MIXED: f32 = 0.7;

/// The groups of a row, or of gathered hair.
pub(super) struct Groups {
    groups: Vec<Group>,
    peak: f32,
}

struct Group {
    /// Where it begins and ends along the row, 0 to 1.
    from: f32,
    to: f32,
    length: f32,
    swing: f32,
}

/// A clump's place in its group.
#[derive(Clone, Copy, Debug)]
pub(super) struct Member {
    /// The middle of its group along the row, 0 to 1.
    pub middle: f32,
    /// Its length, as a share of the zone's.
    pub length: f32,
    /// Its share of the zone's sideways leans.
    pub swing: f32,
}

impl Groups {
    pub fn new(seed: u32, zone: &Zone, row: u32, side: f32) -> Self {
        let name = format!("{}, groups", zone.name);
        let half = u32::from(side < 0.0);
        let classes: Vec<(f32, Random)> = (0..zone.groups)
            .map(|group| {
                let index = (row * zone.groups + group) * 2 + half;
                let mut random = Random::new(seed, &name, index);
                (size_class(MIXED, &mut random), random)
            })
            .collect();
        let total: f32 = classes.iter().map(|(class, _)| class).sum();
        let mut taken = 0.0;
        let groups = classes.into_iter().map(|(class, mut random)| {
            let from = taken / total;
            taken += class;
            Group {
                from,
                to: taken / total,
                // A small group is a short one.
                length: 1.0
                    + zone.length_variation * (0.6 * random.around_zero() + 0.6 * (class - 0.8)),
                swing: 1.0 + SWINGS * random.around_zero(),
            }
        });
        Self {
            groups: groups.collect(),
            peak: zone.peak,
        }
    }

    /// The group of a clump at a place along its row.
    pub fn member(&self, along: f32) -> Option<Member> {
        let is_after = |group: &&Group| along < group.to;
        let group = self.groups.iter().find(is_after).or(self.groups.last())?;
        let middle = 0.5 * (group.from + group.to);
        let half = 0.5 * (group.to - group.from);
        let off = ((along - middle) / half.max(1e-6)).abs().min(1.0);
        Some(Member {
            middle,
            length: group.length * (1.0 - self.peak * off),
            swing: group.swing,
        })
    }

    /// The group of a clump of gathered hair: they take turns, the first of each is its longest.
    pub fn of_gathered(&self, clump: u32) -> Option<Member> {
        let count = self.groups.len();
        let group = self.groups.get(clump as usize % count.max(1))?;
        let rank = (clump as usize / count).min(4) as f32 / 4.0;
        Some(Member {
            middle: 0.5,
            length: group.length * (1.0 - self.peak * rank),
            swing: group.swing,
        })
    }
}
