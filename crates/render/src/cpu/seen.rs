//! Where along a path strokes are needed: not where no picture can show them, not behind a head, and not behind other hair.

mod dense;
mod room;
mod segments;
mod shadow;

use self::dense::covers;
use self::room::{HIDDEN, Room};
use self::segments::Segments;
use super::cover::Cover;
use crate::drawing::{Disc, Order};
use crate::frame::Frame;
use effects::{Joints, Layer};
use glam::Vec2;
use rayon::prelude::*;
use stroke_path::PathRun;

/// Runs that a thread works on at a time, at least.
const SOME_RUNS: usize = 64;

/// Where strokes make a difference: for each joint of a frame whether a stroke's disc there does. Both lists are empty where all do.
///
/// Of a joint that makes none both segments are unseen, with any size of its own, so that with a radius of 0 it makes the same picture.
#[derive(Default)]
pub(super) struct Needed {
    /// Of all strokes, and of the clump.
    pub(super) all: Vec<bool>,
    /// Of strokes that show within their clump alone, and aren't it.
    pub(super) within: Vec<bool>,
}

impl Needed {
    /// As all joints do.
    pub(super) fn clear(&mut self) {
        self.all.clear();
        self.within.clear();
    }

    /// That of a layer's strokes.
    pub(super) fn of(&self, order: Order, layer: &Layer) -> &[bool] {
        match is_within(order, layer) && !layer.program.is_clump() {
            true => &self.within,
            false => &self.all,
        }
    }
}

/// Whether a layer's strokes show within their clump alone, at its depth; made paths have none but their strokes.
fn is_within(order: Order, layer: &Layer) -> bool {
    let is_clipped = layer.rank >= 0 && order != Order::Shifted;
    is_clipped && !layer.program.has_own_paths() && !layer.is_decal()
}

/// Finds where strokes are needed. Keeps its memory.
#[derive(Default)]
pub(super) struct Seen {
    cover: Cover,
    rooms: Vec<Room>,
    /// For each joint whether other hair hides all between it and the next one; empty where nothing is known.
    hidden: Vec<bool>,
}

/// What is looked at.
#[derive(Clone, Copy)]
struct View<'a> {
    frame: &'a Frame<'a>,
    joints: &'a Joints,
    clumps: &'a [Disc],
    cover: Option<&'a Cover>,
}

/// The number of a run, and whether its joints make a difference.
type OfRun<'a> = (usize, &'a mut [bool], &'a mut [bool]);

impl Seen {
    /// Finds where a frame's strokes are needed. `clumps` are the discs of all clumps but made paths'; `samples` are those of each pixel, where
    /// they are known.
    pub(super) fn find(
        &mut self,
        frame: &Frame,
        joints: &Joints,
        (clumps, samples): (&[Disc], &[Vec2]),
        needed: &mut Needed,
    ) {
        let Needed { all, within } = needed;
        all.clear();
        within.clear();
        self.rooms.clear();
        let rooms = (frame.objects.iter()).flat_map(|object| Room::all_of(frame, object));
        self.rooms.extend(rooms);
        let view = View {
            frame,
            joints,
            clumps,
            cover: None,
        };
        let hidden = &mut self.hidden;
        hidden.clear();
        let has_cover = covers(&view, samples, &self.rooms, &mut self.cover, hidden);
        let view = View {
            cover: has_cover.then_some(&self.cover),
            ..view
        };
        all.resize(frame.paths.len(), false);
        within.resize(frame.paths.len(), false);
        let (mut rest, mut rest_within) = (&mut all[..], &mut within[..]);
        let runs = &frame.paths.runs;
        let own = runs.iter().enumerate().map(|(number, run)| {
            let (own, own_within);
            (own, rest) = std::mem::take(&mut rest).split_at_mut(run.joints.len());
            (own_within, rest_within) =
                std::mem::take(&mut rest_within).split_at_mut(run.joints.len());
            (number, own, own_within)
        });
        let own: Vec<OfRun> = own.collect();
        let rooms = &self.rooms;
        own.into_par_iter().with_min_len(SOME_RUNS).for_each_init(
            Segments::default,
            |segments, (number, all, within)| {
                let run = &runs[number];
                let hidden = hidden.get(run.joints.clone()).unwrap_or_default();
                let room = rooms.partition_point(|room| room.joints.end <= run.joints.start);
                let is_of_piece =
                    |other: Option<&PathRun>| other.is_some_and(|other| other.piece == run.piece);
                let before = number.checked_sub(1).and_then(|before| runs.get(before));
                // Samples of a piece show all of its runs as one.
                let is_whole = !is_of_piece(before) && !is_of_piece(runs.get(number + 1));
                let view = View {
                    cover: view.cover.filter(|_| is_whole),
                    ..view
                };
                // Each as if it were seen by itself: no head hides one of several.
                let hides = if is_whole { HIDDEN } else { 0 };
                let links = &hidden[..hidden.len().saturating_sub(1)];
                if is_whole && !links.is_empty() && !links.contains(&false) {
                    return; // nothing of it is seen
                }
                segments.find(&view, &rooms[room], (run, hides, hidden), all, within);
            },
        );
        if !within.contains(&false) {
            all.clear();
            within.clear();
        }
    }
}
