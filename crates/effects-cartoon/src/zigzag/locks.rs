//! Strands that are linked stand for those around them.
//!
//! In dense hair neighbours are so near that a link between two is shorter than a tooth of the strip's edge, and no two shine at quite the same place: a
//! strip of their links has frayed edges. The source averages particles in groups (Shin, Haller, Mukundan, section 3.4.2), which come and go;
//! here who stands for whom is chosen by the hair at rest.

use super::{Beside, FAINT, Highlight};
use effects::{Grid, Hair};

/// Strands that are linked are at least so far apart where hair is dense, in parts of the distance of `merge`.
const APART: f32 = 0.3;

/// A strand with those around it for which it stands.
pub(super) struct Lock {
    /// Its index.
    pub strand: usize,
    /// All of them, itself the first.
    all: Vec<usize>,
}

/// The locks of hair whose highlights are drawn to one line within so many metres: by the index of their strands. Of highlights that stay
/// where they are each strand is a lock.
pub(super) fn of(hair: &Hair, within_m: f32) -> Vec<Lock> {
    let of_one = |strand| Lock {
        strand,
        all: vec![strand],
    };
    if within_m <= 0.0 {
        return (0..hair.strands.len()).map(of_one).collect();
    }
    let rest: Vec<Beside> = hair.strands.iter().map(Beside::of).collect();
    let apart_m = APART * within_m;
    let grid = Grid::new(
        rest.iter().map(|strand| strand.points[1]).enumerate(),
        apart_m,
    );
    let mut locks: Vec<Lock> = Vec::new();
    // Of strands that are linked.
    let mut lock_of: Vec<Option<usize>> = vec![None; rest.len()];
    for (strand, own) in rest.iter().enumerate() {
        let farthest_m = |other: &usize| own.farthest_m(&rest[*other]);
        let linked = grid
            .around(own.points[1])
            .filter(|other| lock_of[*other].is_some());
        let near = linked.filter(|other| farthest_m(other) < apart_m);
        let nearest = near.min_by(|a, b| farthest_m(a).total_cmp(&farthest_m(b)));
        match nearest.and_then(|other: usize| lock_of[other]) {
            Some(lock) => locks[lock].all.push(strand),
            None => {
                lock_of[strand] = Some(locks.len());
                locks.push(of_one(strand));
            }
        }
    }
    locks
}

impl Lock {
    /// The mean of its strands' highlights.
    pub fn mean(&self, shining: &[Highlight]) -> Highlight {
        let (mut place, mut amount, mut weights) = (0.0, 0.0, 0.0);
        for strand in &self.all {
            let own = shining[*strand];
            // Where none of them shines the mean's place must not hang on what hardly does.
            let weight = own.amount + FAINT;
            place += weight * own.place;
            weights += weight;
            amount += own.amount;
        }
        Highlight {
            place: place / weights,
            amount: amount / self.all.len() as f32,
        }
    }
}
