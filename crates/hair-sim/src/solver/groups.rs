//! Batches are stepped in groups, beside each other.

use super::{
    batch::{Batch, BatchState},
    scratch::Scratch,
};
use crate::{stats::Stats, threads::join};

/// Steps batches in groups, each by a task of its own and in its own scratch. The first of them is number `first` of all, and `group`
/// of them make a group.
pub(super) fn step_all<F>(
    batches: &[Batch],
    states: &mut [BatchState],
    scratch: &mut [Scratch],
    (first, group): (usize, usize),
    step: &F,
) -> Stats
where
    F: Fn(usize, &Batch, &mut BatchState, &mut Scratch) -> Stats + Sync,
{
    match scratch {
        [] => Stats::default(),
        [scratch] => (batches.iter().zip(states).enumerate())
            .map(|(i, (batch, state))| step(first + i, batch, state, scratch))
            .fold(Stats::default(), Stats::plus),
        _ => {
            let half = scratch.len() / 2;
            let middle = half * group;
            let (batches, later_batches) = batches.split_at(middle);
            let (states, later_states) = states.split_at_mut(middle);
            let (scratch, later_scratch) = scratch.split_at_mut(half);
            let later = (first + middle, group);
            let (sum, more) = join(
                || step_all(batches, states, scratch, (first, group), step),
                || step_all(later_batches, later_states, later_scratch, later, step),
            );
            sum.plus(more)
        }
    }
}
