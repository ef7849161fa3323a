//! Strokes that threads have made of some neighbouring joints, and how they become one list.

use super::NO_DISC;
use crate::drawing::{Disc, Stretch};
use rayon::prelude::*;

/// A stroke on some neighbouring joints.
pub(super) struct Made {
    pub(super) number: usize,
    /// Where it is drawn; their discs follow each other.
    pub(super) stretches: Vec<Stretch>,
    pub(super) discs: Vec<Disc>,
    pub(super) colors: Vec<[f32; 3]>,
}

impl Made {
    pub(super) fn new(number: u32) -> Self {
        Self {
            number: number as usize,
            stretches: Vec::new(),
            discs: Vec::new(),
            colors: Vec::new(),
        }
    }

    /// Makes room for as many discs: lists that grow are moved.
    pub(super) fn reserve(&mut self, discs: usize) {
        self.discs.reserve(discs);
        self.colors.reserve(discs);
    }

    /// Numbers the discs of all stretches one behind the other.
    pub(super) fn number_discs(&mut self) {
        let mut first = 0;
        for stretch in &mut self.stretches {
            stretch.first = first;
            first += stretch.joints.len();
        }
    }

    /// Adds where a strand's stroke is drawn, whose discs lie behind those so far.
    pub(super) fn push_stretches(&mut self, drawn: &[Stretch]) {
        for stretch in drawn {
            match self.stretches.last_mut() {
                Some(last) if last.joints.end == stretch.joints.start => {
                    last.joints.end = stretch.joints.end;
                }
                _ => self.stretches.push(stretch.clone()),
            }
        }
    }

    /// Adds where it is drawn to what its stroke has on the joints before; its discs lie from place `first` on.
    fn add_stretches(&self, first: usize, all: &mut Vec<Stretch>) {
        for stretch in &self.stretches {
            let first = first + stretch.first;
            match all.last_mut() {
                Some(last)
                    if last.joints.end == stretch.joints.start && last.places().end == first =>
                {
                    last.joints.end = stretch.joints.end;
                }
                _ => all.push(Stretch {
                    joints: stretch.joints.clone(),
                    first,
                }),
            }
        }
    }
}

/// Puts strokes one behind the other, in all threads, in place of what the lists had: these are megabytes.
pub(super) fn put_together(
    made: Vec<Made>,
    stretches: &mut [Vec<Stretch>],
    discs: &mut Vec<Disc>,
    colors: &mut Vec<[f32; 3]>,
) {
    let count = |of: fn(&Made) -> usize| -> usize { made.iter().map(of).sum() };
    set_length(discs, count(|made| made.discs.len()), NO_DISC);
    set_length(colors, count(|made| made.colors.len()), [0.0; 3]);
    let (mut discs, mut colors) = (&mut discs[..], &mut colors[..]);
    let mut first = 0;
    let with_places = made.into_iter().map(|made| {
        made.add_stretches(first, &mut stretches[made.number]);
        first += made.discs.len();
        let (own_discs, own_colors);
        (own_discs, discs) = std::mem::take(&mut discs).split_at_mut(made.discs.len());
        (own_colors, colors) = std::mem::take(&mut colors).split_at_mut(made.colors.len());
        (made, own_discs, own_colors)
    });
    let with_places: Vec<_> = with_places.collect();
    with_places
        .into_par_iter()
        .for_each(|(made, discs, colors)| {
            discs.copy_from_slice(&made.discs);
            colors.copy_from_slice(&made.colors);
        });
}

/// Gives a list a length without looking at what it has, which is to be written over. Dense hair has long ones: they don't grow by doubling.
fn set_length<T: Copy>(list: &mut Vec<T>, length: usize, anything: T) {
    list.reserve_exact(length.saturating_sub(list.len()));
    list.resize(length, anything);
}
