//! The segments of a stroke that reach a row of cells, and which of them make a difference in one.
//!
//! Joints of a wide stroke lie closer to each other than it is wide, so that many segments cover a sample; but its depth is that of the
//! nearest disc, and its colour that of the nearest point of the axis. So those that were the nearest in the last cell come first, and others
//! are worked out only where they may be nearer yet: the same bits, as they would have changed nothing.

use super::stroke::{Depths, Nearest, Placed, Ratios, slack};
use super::tile::{Cell, LaneMask, columns};

/// So many segments are all worked out: to choose among them would take longer.
const FEW: usize = 4;

/// Segments of a stroke that cover some samples of a row of stacks.
#[derive(Default)]
pub(super) struct Reached {
    /// Their places among the stroke's segments, and the columns.
    segments: Vec<(usize, u32)>,
    /// As [`Nearest::may_gain`] asks for.
    slack: f32,
    /// Of the last cell: the place of a segment near the eye, and of one near the axis.
    to_eye: usize,
    to_axis: usize,
}

impl Reached {
    /// Finds those that cover one of the columns.
    #[inline(always)]
    pub(super) fn find(&mut self, placed: &[Placed], row: usize, wanted: u32) {
        self.segments.clear();
        for (i, placed) in placed.iter().enumerate() {
            let reached = columns(&placed.covered, row) & wanted;
            if reached != 0 {
                self.segments.push((i, reached));
            }
        }
        if self.segments.len() > FEW {
            self.slack = slack(self.segments.len());
        }
        self.to_eye = self.to_eye.min(placed.len() - 1);
        self.to_axis = self.to_axis.min(placed.len() - 1);
    }

    /// Offers those to `depths` and `nearest`, in order, that may make a difference to them at some samples of a cell; elsewhere these are
    /// numbers without meaning.
    #[inline(always)]
    pub(super) fn measure(
        &mut self,
        placed: &[Placed],
        cell: Cell,
        samples: &LaneMask,
        depths: &mut Depths,
        nearest: &mut impl Nearest,
    ) {
        if self.segments.len() <= FEW {
            for &(place, reached) in &self.segments {
                if reached & cell.columns() != 0 {
                    let at = placed[place].at(cell);
                    depths.offer(&placed[place], &at);
                    nearest.offer(&placed[place], &at);
                }
            }
            return;
        }
        let first = self.to_eye;
        depths.offer(&placed[first], &placed[first].at(cell));
        let known = self.known(placed, cell);
        for &(place, reached) in &self.segments {
            if reached & cell.columns() == 0 {
                continue;
            }
            let segment = &placed[place];
            let at = segment.at(cell);
            if place != first && depths.may_gain(segment, &at, samples) {
                depths.offer(segment, &at);
                self.to_eye = place;
            }
            if nearest.may_gain(&known, segment, &at, samples, self.slack) {
                nearest.offer(segment, &at);
                self.to_axis = place;
            }
        }
    }

    /// Offers those to `nearest`, in order, that may make a difference to it at some samples of a cell.
    #[inline(always)]
    pub(super) fn find_nearest(
        &mut self,
        placed: &[Placed],
        cell: Cell,
        samples: &LaneMask,
        nearest: &mut impl Nearest,
    ) {
        if self.segments.len() <= FEW {
            for &(place, reached) in &self.segments {
                if reached & cell.columns() != 0 {
                    nearest.offer(&placed[place], &placed[place].at(cell));
                }
            }
            return;
        }
        let known = self.known(placed, cell);
        for &(place, reached) in &self.segments {
            if reached & cell.columns() == 0 {
                continue;
            }
            let segment = &placed[place];
            let at = segment.at(cell);
            if nearest.may_gain(&known, segment, &at, samples, self.slack) {
                nearest.offer(segment, &at);
                self.to_axis = place;
            }
        }
    }

    /// The ratios of the segment that was near the axis in the last cell. It is offered in its turn once more, as of equals the first one is
    /// taken.
    #[inline(always)]
    fn known(&self, placed: &[Placed], cell: Cell) -> Ratios {
        let mut known = Ratios::new();
        known.offer(&placed[self.to_axis], &placed[self.to_axis].at(cell));
        known
    }
}

#[cfg(test)]
mod tests {
    use super::super::context::TileContext;
    use super::super::instructions::Instructions;
    use super::super::segment::{Kind, Segments, strokes_in_order};
    use super::super::stroke::Places;
    use super::super::tile::{ROWS, Stack, cells};
    use super::*;
    use crate::drawing::{Disc, Drawing, LayerStrokes, Run, Stretches};
    use crate::samples::sample_positions;
    use glam::Vec2;
    use proptest::prelude::*;
    use std::f32::consts::TAU;

    /// A stroke of these discs, of another colour at each.
    fn stroke(discs: Vec<Disc>) -> Drawing {
        let joints = discs.len();
        let color = |i: usize| [i as f32 / joints as f32, (i % 7) as f32 / 7.0, 0.5];
        Drawing {
            size: [32, 32],
            runs: vec![Run {
                strand: 0,
                joints: 0..joints,
            }],
            layers: vec![LayerStrokes {
                name: "base".to_owned(),
                joints: 0..joints,
                rank: 0,
                instances: 1,
                stretches: Stretches::Everywhere,
                colors: (0..joints).map(color).collect(),
                discs: discs.clone(),
            }],
            clump: discs,
            ..Drawing::default()
        }
    }

    /// A wide stroke that runs round and round within a few pixels; what goes from one number to another does so from root to tip.
    fn curl(turns: f32, joints: usize, out: [f32; 2], radius: [f32; 2], unrest: u32) -> Drawing {
        let between = |[from, to]: [f32; 2], t: f32| from + (to - from) * t;
        let disc = |i: usize| {
            let t = i as f32 / (joints - 1) as f32;
            let unrest = ((i as u32).wrapping_mul(unrest) >> 20) as f32 / 4096.0 - 0.5;
            let way = Vec2::from_angle(turns * TAU * t);
            let inv_depth = 0.25 + 0.01 * way.y + 0.002 * unrest;
            Disc {
                center: Vec2::splat(9.3) + (between(out, t) + unrest) * way,
                radius: between(radius, t),
                inv_depth,
                inv_depth_biased: inv_depth + 0.001 * t,
            }
        };
        stroke((0..joints).map(disc).collect())
    }

    /// A stroke that goes to and fro, each time so much farther down: what lies below it lies now on one side of it, now on the other, each time
    /// a little nearer.
    fn shuttle(times: usize, down: f32) -> Drawing {
        let disc = |i: usize| Disc {
            center: Vec2::new(
                if i.is_multiple_of(2) { 3.0 } else { 15.0 },
                8.0 + i as f32 * down,
            ),
            radius: 7.0,
            inv_depth: 0.25,
            inv_depth_biased: 0.25,
        };
        stroke((0..times).map(disc).collect())
    }

    /// Bits of all that a sample is told: depths, place and colour.
    fn told(depths: &Depths, places: &Places<true>, k: usize) -> [u32; 8] {
        let [red, green, blue] = places.color.map(|color| color[k].to_bits());
        let across = places.across()[k].to_bits();
        let depths = [depths.inv_depth[k], depths.biased[k]].map(f32::to_bits);
        let [index, way] = [places.index[k], places.way[k].to_bits()];
        [depths[0], depths[1], index, way, across, red, green, blue]
    }

    /// Compares what samples are told with what they are where all segments are offered.
    fn is_as_by_all(drawing: &Drawing) -> Result<(), TestCaseError> {
        let strokes = strokes_in_order(drawing, Kind::Ordered);
        let mut segments = Segments::default();
        segments.collect(drawing, &strokes, Kind::Ordered, 32);
        let stacks = Stack::of_pixel(&sample_positions(4).unwrap());
        let scene = TileContext {
            drawing,
            strokes: &strokes,
            segments: segments.list(),
            origin: [0, 0],
            stack: &stacks[0],
            instructions: Instructions::Compiled,
        };
        let is_of_clump = |i: &u32| scene.segments[*i as usize].stroke == 0;
        let of_clump = (0..scene.segments.len() as u32).filter(is_of_clump);
        let of_clump: Vec<u32> = of_clump.collect();
        let mut placed = Vec::new();
        let covered = Placed::add_all(&scene, &of_clump, &[u32::MAX; ROWS], &mut placed);
        let mut reached = Reached::default();
        for row in (0..ROWS).filter(|row| columns(&covered, *row) != 0) {
            reached.find(&placed, row, columns(&covered, row));
            for cell in cells(row, columns(&covered, row)) {
                let samples = cell.lanes(&covered);
                let (mut depths, mut places) = (Depths::new(), Places::<true>::new());
                reached.measure(&placed, cell, &samples, &mut depths, &mut places);
                let mut nearest = Places::<true>::new();
                reached.find_nearest(&placed, cell, &samples, &mut nearest);
                let (mut all_depths, mut all) = (Depths::new(), Places::<true>::new());
                for segment in &placed {
                    all_depths.offer(segment, &segment.at(cell));
                    all.offer(segment, &segment.at(cell));
                }
                for k in (0..samples.len()).filter(|k| samples[*k] != 0) {
                    let expected = told(&all_depths, &all, k);
                    prop_assert_eq!(told(&depths, &places, k), expected);
                    prop_assert_eq!(told(&all_depths, &nearest, k), expected);
                }
            }
        }
        Ok(())
    }

    proptest! {
        #[test]
        fn what_is_left_out_of_a_curl_would_change_nothing(
            turns in 0.3_f32..6.0,
            joints in 8_usize..400,
            out in prop::array::uniform2(0.2_f32..4.0),
            radius in prop::array::uniform2(0.5_f32..7.0),
            unrest: u32,
        ) {
            is_as_by_all(&curl(turns, joints, out, radius, unrest))?;
        }

        /// Each that is left out might have kept the next one from deciding on a side.
        #[test]
        fn what_is_left_out_of_a_shuttle_would_change_nothing(times in 8_usize..600, down in 1e-4_f32..4e-3) {
            is_as_by_all(&shuttle(times, down))?;
        }
    }
}
