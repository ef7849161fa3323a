//! A stroke of a layer on the strands of some neighbouring joints: evaluated where it is needed, smoothed, and put on the screen.

use super::super::instructions::Instructions;
use super::made::Made;
use super::{LARGEST_PX, NO_DISC, Sight, runs_of};
use crate::drawing::{Brush, Disc, Stretch};
use crate::frame::{Frame, Object};
use effects::smooth::{self, Smoother};
use effects::{Joints, Layer, Strokes};
use glam::Vec2;
use std::ops::Range;
use stroke_path::PathRun;

/// A thread's working memory.
#[derive(Default)]
pub(super) struct Scratch {
    strokes: Strokes,
    /// Of a strand's joints.
    pub(super) radii: Vec<f32>,
    /// Where its stroke is drawn.
    drawn: Vec<Stretch>,
    /// The radii of the strand without what its pieces share, and where they are.
    whole: Vec<f32>,
    places: Vec<f32>,
    smoother: Smoother,
}

/// Some neighbouring joints of a layer.
pub(super) struct Part<'a> {
    pub(super) instructions: Instructions,
    pub(super) frame: &'a Frame<'a>,
    pub(super) object: &'a Object<'a>,
    pub(super) layer: &'a Layer,
    pub(super) layer_number: usize,
    pub(super) inputs: &'a Joints,
    pub(super) joints: Range<usize>,
    pub(super) seen_length: &'a [f32],
    pub(super) needed: &'a [bool],
    pub(super) lift: &'a [f32],
    pub(super) seed: u32,
}

impl Part<'_> {
    /// Makes stroke `number` of each run where it has a size.
    pub(super) fn evaluate(&self, number: u32, scratch: &mut Scratch) -> Made {
        let mut made = Made::new(number);
        let is_unneeded = |joints: &Range<usize>| {
            let needed = self.needed.get(joints.clone());
            needed.is_some_and(|needed| !needed.contains(&true))
        };
        if is_unneeded(&self.joints) {
            return made;
        }
        let is_direct = self.is_mostly_there(number, scratch);
        if is_direct {
            made.reserve(self.joints.len());
        }
        for pieces in self.strands() {
            let joints = pieces[0].joints.start..pieces[pieces.len() - 1].joints.end;
            let strand = &self.frame.strands[pieces[0].strand];
            if !is_unneeded(&joints) && !strand.is_left_out_by(self.layer_number) {
                self.evaluate_strand(pieces, &joints, is_direct, scratch, &mut made);
            }
        }
        made.number_discs();
        made
    }

    /// Adds what the stroke has on a strand, of these pieces and joints.
    fn evaluate_strand(
        &self,
        pieces: &[PathRun],
        joints: &Range<usize>,
        is_direct: bool,
        scratch: &mut Scratch,
        made: &mut Made,
    ) {
        let (frame, layer, inputs) = (self.frame, self.layer, self.inputs);
        let program = &layer.program;
        let number = made.number as u32;
        let Scratch { radii, strokes, .. } = scratch;
        radii.clear();
        strokes.clear();
        let start = joints.start;
        for (i, run) in pieces.iter().enumerate() {
            let part = self.counted(pieces, i);
            if part.is_empty() {
                continue;
            }
            if is_direct {
                // Those beside, to which strokes taper, too.
                let part = part.start.saturating_sub(1).max(run.joints.start)
                    ..(part.end + 1).min(run.joints.end);
                strokes.resize(part.start - start);
                program.evaluate(inputs, part.clone(), number, self.seed, strokes);
                radii.resize(part.start - start, 0.0);
                radii.extend_from_slice(&strokes.radius[part.start - start..]);
                continue;
            }
            let extent = program.extent(inputs, part, number, self.seed);
            radii.resize(extent.start - start, 0.0);
            program.radii(inputs, extent, number, self.seed, radii);
        }
        radii.resize(joints.len(), 0.0);
        // A stroke that an effect failed to work out is not drawn.
        let size = |radius: f32| {
            if radius.is_finite() {
                radius.max(0.0)
            } else {
                0.0
            }
        };
        radii.iter_mut().for_each(|radius| *radius = size(*radius));
        self.smooth(pieces, start, scratch);

        let Scratch {
            strokes,
            radii,
            drawn,
            ..
        } = scratch;
        leave_out_unneeded(self.needed, joints, radii);
        drawn.clear();
        find_stretches(pieces, start, radii, drawn);
        for stretch in drawn.iter_mut() {
            stretch.first = made.discs.len();
            let joints = stretch.joints.clone();
            let places = joints.start - start..joints.end - start;
            let first = match is_direct {
                true => places.start,
                false => {
                    strokes.clear();
                    program.evaluate(inputs, joints.clone(), number, self.seed, strokes);
                    0
                }
            };
            self.push_discs(joints, &radii[places], strokes, first, made);
        }
        if frame.brush == Brush::Semicircle {
            self.go_around_flat_ends(pieces, &radii[..], drawn, &mut made.discs);
        }
        made.push_stretches(drawn);
    }

    /// Adds discs of these joints and radii, and their colours, which lie from `first` on in `strokes`. One that an effect failed to work out is not
    /// drawn.
    fn push_discs(
        &self,
        joints: Range<usize>,
        radii: &[f32],
        strokes: &Strokes,
        first: usize,
        made: &mut Made,
    ) {
        let Self { frame, inputs, .. } = self;
        let (paths, count) = (frame.paths, joints.len());
        let sight = Sight::of(frame, self.object);
        let layer_offset = self.layer.depth_offset;
        let of = first..first + count;
        let (offsets, colors) = (&strokes.offset[of.clone()], &strokes.color[of.clone()]);
        let depth_offsets = &strokes.depth_offset[of];
        let (shifts, clump_radii) = (
            &inputs.clump_shift[joints.clone()],
            &inputs.clump_radius[joints.clone()],
        );
        let (centers, depths, px_per_metre) = (
            &paths.center[joints.clone()],
            &paths.depth[joints.clone()],
            &paths.px_per_metre[joints.clone()],
        );
        let lifts = self.lift.get(joints);
        let radii = &radii[..count];
        let start = made.discs.len();
        made.discs.resize(start + count, NO_DISC);
        made.colors.resize(start + count, [0.0; 3]);
        let (to_discs, to_colors) = (&mut made.discs[start..], &mut made.colors[start..]);
        let (to_discs, to_colors) = (&mut to_discs[..count], &mut to_colors[..count]);
        self.instructions.run(
            #[inline(always)]
            || {
                for k in 0..count {
                    let [red, green, blue] = colors[k].to_array();
                    let (x, y, depth_offset) = (offsets[k].x, offsets[k].y, depth_offsets[k]);
                    let all = [x, y, radii[k], depth_offset, red, green, blue];
                    let is_there = (all.iter()).fold(true, |all, number| all & number.is_finite());
                    let or_nothing = |number: f32| if is_there { number } else { 0.0 };
                    let offset =
                        Vec2::new(shifts[k].x + or_nothing(x), shifts[k].y + or_nothing(y));
                    let lift = lifts.map_or(0.0, |lifts| lifts[k]);
                    to_discs[k] = sight.disc(
                        (centers[k], depths[k], px_per_metre[k]),
                        offset,
                        or_nothing(radii[k]),
                        clump_radii[k],
                        layer_offset + or_nothing(depth_offset) - lift,
                    );
                    to_colors[k] = [red, green, blue].map(or_nothing);
                }
            },
        );
    }

    /// Moves the tips of strokes that are wider than their clump on by what they are wider, or an outline
    /// would end where its clump does. `drawn` are those of a strand of these pieces and radii.
    fn go_around_flat_ends(
        &self,
        pieces: &[PathRun],
        radii: &[f32],
        drawn: &[Stretch],
        discs: &mut [Disc],
    ) {
        let paths = self.frame.paths;
        let tips = pieces.iter().map(|run| run.joints.end - 1);
        for tip in tips.filter(|&tip| paths.u[tip] == 1.0) {
            let Some(stretch) = drawn.iter().find(|s| s.joints.contains(&tip)) else {
                continue;
            };
            let radius = radii[tip - pieces[0].joints.start];
            let wider = (radius - self.inputs.clump_radius[tip]).max(0.0);
            let unit_px = self.object.head.unit_m() * paths.px_per_metre[tip];
            // The path on the screen, of which `across` is a right angle to the right.
            let ahead = -paths.across[tip].perp();
            let disc = &mut discs[stretch.first + tip - stretch.joints.start];
            disc.center += ahead * (wider * unit_px).min(LARGEST_PX);
        }
    }

    /// Whether strokes are best worked out at once, as they have a size at most joints: else radii come first. The first strand tells.
    fn is_mostly_there(&self, number: u32, scratch: &mut Scratch) -> bool {
        if self.layer.program.shortest() > 0.0 {
            return false; // smoothing takes radii alone
        }
        let strands = self.strands();
        let mut parts = strands.flat_map(|pieces| (0..pieces.len()).map(move |i| (pieces, i)));
        let part = parts.find_map(|(pieces, i)| {
            let part = self.counted(pieces, i);
            let strand = &self.frame.strands[pieces[i].strand];
            let is_there = !part.is_empty() && !strand.is_left_out_by(self.layer_number);
            is_there.then_some(part)
        });
        let Some(part) = part else {
            return false;
        };
        let Self { inputs, seed, .. } = *self;
        let program = &self.layer.program;
        let extent = program.extent(inputs, part.clone(), number, seed);
        if 2 * extent.len() < part.len() {
            return false;
        }
        scratch.radii.clear();
        program.radii(inputs, extent, number, seed, &mut scratch.radii);
        let sizes = scratch.radii.iter().filter(|radius| **radius > 0.0);
        2 * sizes.count() > part.len()
    }

    /// Of the joints of piece `i` of a strand those whose radii are asked for: where strokes make a difference, and as far as smoothing
    /// looks from there.
    fn counted(&self, pieces: &[PathRun], i: usize) -> Range<usize> {
        let all = pieces[i].joints.clone();
        if self.needed.is_empty() {
            return all;
        }
        let is_needed = |joint: &usize| self.needed[*joint];
        let length_m = self.layer.program.shortest() * self.object.head.height_m;
        if length_m > 0.0 && pieces.len() > 1 {
            // It looks from piece to piece.
            let mut joints = pieces.iter().flat_map(|piece| piece.joints.clone());
            return match joints.any(|joint| is_needed(&joint)) {
                true => all,
                false => all.start..all.start,
            };
        }
        let Some(first) = all.clone().find(is_needed) else {
            return all.start..all.start;
        };
        let last = all.clone().rfind(is_needed).unwrap_or(first);
        if length_m <= 0.0 {
            return first..last + 1;
        }
        let places = &self.seen_length[all.clone()];
        let seen = smooth::seen_from(places, first - all.start..last + 1 - all.start, length_m);
        all.start + seen.start..all.start + seen.end
    }

    /// Their runs by strands, as far as smoothing knows: pieces of one, of which each overlaps the one before.
    fn strands(&self) -> impl Iterator<Item = &[PathRun]> {
        self.runs().chunk_by(|_, next| next.overlap > 0)
    }

    /// Their runs.
    fn runs(&self) -> &[PathRun] {
        runs_of(self.frame.paths, &self.joints)
    }

    /// Takes stretches and gaps of a strand's stroke that are too short away, as they are seen: hair that
    /// points at the eye would show long ones as dots. Its joints begin at `start`.
    fn smooth(&self, pieces: &[PathRun], start: usize, scratch: &mut Scratch) {
        let length_m = self.layer.program.shortest() * self.object.head.height_m;
        if length_m <= 0.0 {
            return;
        }
        let Scratch {
            radii,
            whole,
            places,
            smoother,
            ..
        } = scratch;
        // Pieces together, and what they share once.
        let joints = || {
            let own = |run: &PathRun| run.joints.start + run.overlap..run.joints.end;
            pieces.iter().flat_map(own)
        };
        whole.clear();
        whole.extend(joints().map(|i| radii[i - start]));
        if whole.iter().all(|radius| *radius == 0.0) {
            return;
        }
        places.clear();
        places.extend(joints().map(|i| self.seen_length[i]));
        smoother.smooth(places, whole, length_m);
        for (i, radius) in joints().zip(whole.iter()) {
            radii[i - start] = *radius;
        }
        for piece in pieces {
            let shared = piece.joints.start..piece.joints.start + piece.overlap;
            for i in shared {
                radii[i - start] = radii[i - piece.overlap - start];
            }
        }
    }
}

/// Adds where a stroke with these radii on neighbouring runs, from joint `start` on, is drawn: where it has a size, and at the joints beside, to
/// which it tapers.
pub(super) fn find_stretches(
    runs: &[PathRun],
    start: usize,
    radii: &[f32],
    stretches: &mut Vec<Stretch>,
) {
    for run in runs {
        let has_size = |&joint: &usize| radii[joint - start] > 0.0;
        let mut rest = run.joints.clone();
        while let Some(first) = rest.find(has_size) {
            let end = rest.find(|joint| !has_size(joint));
            let end = end.map_or(run.joints.end, |end| end + 1);
            let first = first.saturating_sub(1).max(run.joints.start);
            match stretches.last_mut() {
                // There is no gap but what tapers.
                Some(last) if last.joints.end >= first => last.joints.end = end,
                _ => stretches.push(Stretch {
                    joints: first..end,
                    first: 0,
                }),
            }
        }
    }
}

/// Takes their sizes from discs of all joints where strokes make no difference.
pub(super) fn leave_out(needed: &[bool], discs: &mut [Disc]) {
    for (disc, is_needed) in discs.iter_mut().zip(needed) {
        disc.radius = if *is_needed { disc.radius } else { 0.0 };
    }
}

/// Takes their sizes from joints at which strokes make no difference.
pub(super) fn leave_out_unneeded(needed: &[bool], joints: &Range<usize>, radii: &mut [f32]) {
    let needed = needed.get(joints.clone()).unwrap_or_default();
    for (radius, is_needed) in radii.iter_mut().zip(needed) {
        *radius = if *is_needed { *radius } else { 0.0 };
    }
}
