//! Levels of strands, as cartoonists lay hair over hair: those of a higher level lie before those of a lower one, whatever the camera.

use effects::wgsl::hash;
use effects::{clump, layer_seed};
use glam::Vec3;
use hair_io::Nearest;
use rayon::prelude::*;

/// How many of the nearest roots are looked at for a neighbour, at most: more only where many are at one place.
const NEAR: usize = 1024;

/// The level of each strand, 0 the lowest, by the clump's parameters; all 0 where there is one. `roots` are seen from the head's
/// middle.
pub(crate) fn levels(params: &clump::Params, seed: u32, ids: &[u32], roots: &[Vec3]) -> Vec<u32> {
    let count = params.levels.max(1);
    let seed = layer_seed(seed, "levels");
    let random: Vec<u32> = ids.iter().map(|id| hash(seed ^ hash(*id))).collect();
    if count == 1 || params.level_choice != clump::Params::LEVEL_CHOICE_APART {
        return random.iter().map(|random| random % count).collect();
    }
    apart(count, &random, &right_neighbours(roots))
}

/// Levels that differ from those of both neighbours, where each strand has one to its right and some to its left. Three always do: who is
/// left when those of at most two neighbours go one after the other has none.
fn apart(count: u32, random: &[u32], right: &[Option<usize>]) -> Vec<u32> {
    let mut beside = vec![Vec::new(); right.len()];
    for (strand, right) in right.iter().enumerate() {
        if let Some(right) = *right {
            beside[strand].push(right);
            beside[right].push(strand);
        }
    }
    let mut left: Vec<usize> = beside.iter().map(Vec::len).collect();
    let is_easy = |left: usize| left <= 2;
    let mut next: Vec<usize> = (0..left.len()).filter(|i| is_easy(left[*i])).collect();
    let mut is_taken = vec![false; left.len()];
    let mut order = Vec::new();
    while let Some(strand) = next.pop() {
        if std::mem::replace(&mut is_taken[strand], true) {
            continue;
        }
        order.push(strand);
        for other in &beside[strand] {
            left[*other] -= 1;
            if is_easy(left[*other]) && !is_taken[*other] {
                next.push(*other);
            }
        }
    }
    let mut levels = vec![None; right.len()];
    for strand in order.into_iter().rev() {
        // The least common among the neighbours, from a random one on.
        let common = |level: u32| {
            let others = beside[strand].iter();
            others
                .filter(|other| levels[**other] == Some(level))
                .count()
        };
        let from_random = (0..count).map(|step| (random[strand] % count + step) % count);
        levels[strand] = from_random.min_by_key(|level| common(*level));
    }
    levels.into_iter().map(Option::unwrap_or_default).collect()
}

/// Of each strand the one whose root is the nearest to its right, as seen from outside; none where there is none. Roots at one place follow
/// each other.
fn right_neighbours(roots: &[Vec3]) -> Vec<Option<usize>> {
    let nearest = Nearest::new(roots.iter().copied());
    let right_of = |strand: usize| {
        let is_right = |other: usize| {
            let turned = (turn(roots[other]) - turn(roots[strand])).rem_euclid(4.0);
            turned > 2.0 || (roots[other] == roots[strand] && other > strand)
        };
        let mut count = 8;
        loop {
            let near = nearest.find(roots[strand], count);
            let right = near
                .iter()
                .map(|(_, other)| *other)
                .find(|other| is_right(*other));
            if right.is_some() || near.len() < count || count >= NEAR {
                return right;
            }
            count *= 4;
        }
    };
    (0..roots.len()).into_par_iter().map(right_of).collect()
}

/// How far around the head's axis a root lies: 0 to 4, rising to the left as seen from outside.
fn turn(root: Vec3) -> f32 {
    let length = root.x.abs() + root.z.abs();
    let x = if length > 0.0 { root.x / length } else { 1.0 };
    if root.z < 0.0 { 3.0 + x } else { 1.0 - x }
}

#[cfg(test)]
mod tests {
    use super::*;
    use effects::{Parameters, Values};

    fn params(levels: u32, apart: bool) -> clump::Params {
        let params = clump::Program::params(&Values::defaults(clump::Program::PARAMS));
        clump::Params {
            levels,
            level_choice: u32::from(apart),
            ..params
        }
    }

    fn ring(count: usize) -> Vec<Vec3> {
        let at = |i: usize| {
            let angle = i as f32 / count as f32 * std::f32::consts::TAU;
            Vec3::new(angle.cos(), effects::wgsl::random(i as u32, 1), angle.sin())
        };
        (0..count).map(at).collect()
    }

    #[test]
    fn neighbours_differ_where_they_are_to() {
        for count in [2, 3, 7, 100, 1001] {
            let roots = ring(count);
            let ids: Vec<u32> = (0..count as u32).collect();
            let right = right_neighbours(&roots);
            let levels = levels(&params(3, true), 5, &ids, &roots);
            for (strand, right) in right.iter().enumerate() {
                // Of two that face each other neither is to the right.
                assert!(right.is_some() || count == 2, "{count}: {strand}");
                assert!(right.is_none_or(|right| levels[strand] != levels[right]));
            }
            assert!(levels.iter().all(|level| *level < 3));
            if count > 50 {
                let of = |wanted| levels.iter().filter(|level| **level == wanted).count();
                assert!((0..3).all(|level| of(level) > count / 6), "{levels:?}");
            }
        }
    }

    #[test]
    fn one_strand_equal_roots_and_one_level() {
        let of = |levels_: u32, roots: &[Vec3]| {
            let ids: Vec<u32> = (0..roots.len() as u32).collect();
            levels(&params(levels_, true), 5, &ids, roots)
        };
        assert_eq!(of(3, &[]), Vec::<u32>::new());
        assert_eq!(of(3, &[Vec3::ONE]).len(), 1);
        assert_eq!(of(1, &ring(5)), [0; 5]);
        let equal = of(3, &[Vec3::ONE; 9]);
        let right = right_neighbours(&[Vec3::ONE; 9]);
        for (strand, right) in right.iter().enumerate().take(8) {
            assert_ne!(equal[strand], equal[right.unwrap()]);
        }
    }

    #[test]
    fn random_levels_hang_on_the_seed_and_the_strand() {
        let roots = ring(300);
        let ids: Vec<u32> = (100..400).collect();
        let of = |seed| levels(&params(3, false), seed, &ids, &roots);
        assert_eq!(of(1), of(1));
        assert_ne!(of(1), of(2));
        let shares = [0, 1, 2].map(|level| of(1).iter().filter(|l| **l == level).count());
        assert!(
            shares.iter().all(|share| (70..130).contains(share)),
            "{shares:?}"
        );
    }
}
