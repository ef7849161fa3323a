//! Outlines that lie deep behind their clumps: they are drawn once all strands of a tile are, which hide most of them.

use super::context::TileContext;
use super::offer::{Offer, Roundness, deeper, paint, shade, tell, unasked};
use super::reached::Reached;
use super::segment::Segment;
use super::shown::Shown;
use super::stroke::Placed;
use super::tile::{Mask, NO_SAMPLES, ROWS, Target, add, greater, is_empty, without};
use crate::drawing::Order;
use std::ops::Range;

/// Outlines that lie deeper than their clump by so many times the way from its middle to its edge are drawn after all clumps. Others would have them draw
/// what they hide.
const DEEP: f32 = 4.0;

/// A strand whose outlines are still to be drawn.
pub(super) struct Outlined {
    /// Their segments in drawing order, among the tile's.
    pub(super) segments: Range<usize>,
    /// The columns of each row of stacks that the strand may reach.
    pub(super) reach: [u32; ROWS],
    /// The samples that the clump covers: it is drawn as strokes that lie higher.
    pub(super) clump: Mask,
}

/// Those of a tile.
#[derive(Default)]
pub(super) struct Outlines {
    strands: Vec<Outlined>,
    /// Of a strand's outlines from the lowest to the highest: how near any is up to there.
    nearest: Vec<[f32; 2]>,
}

impl Outlines {
    /// Leaves a strand's for later.
    #[inline(always)]
    pub(super) fn push(&mut self, strand: Outlined) {
        self.strands.push(strand);
    }

    /// Draws the outlines of the strands that were drawn, to be called after the last of a tile.
    #[inline(always)]
    pub(super) fn draw<const TELLS: bool>(
        &mut self,
        scene: &TileContext,
        tile: &[u32],
        (placed, row): (&mut Vec<Placed>, &mut Reached),
        target: &mut Target,
        told: &mut Shown,
    ) {
        let strands = std::mem::take(&mut self.strands);
        for strand in &strands {
            let segments = &tile[strand.segments.clone()];
            self.draw_strand::<TELLS>(scene, segments, strand, (placed, row), target, told);
        }
        self.strands = strands;
        self.strands.clear();
    }

    /// Draws the outlines of a strand, the highest first: where one and all lower ones are hidden it hides none of them.
    #[inline(always)]
    fn draw_strand<const TELLS: bool>(
        &mut self,
        scene: &TileContext,
        segments: &[u32],
        strand: &Outlined,
        (placed, row): (&mut Vec<Placed>, &mut Reached),
        target: &mut Target,
        told: &mut Shown,
    ) {
        let segment = |i: u32| &scene.segments[i as usize];
        let strokes = || segments.chunk_by(|&a, &b| segment(a).stroke == segment(b).stroke);
        self.nearest.clear();
        let mut nearest = [f32::NEG_INFINITY; 2];
        for stroke in strokes() {
            for &index in stroke {
                let Segment {
                    inv_depth, biased, ..
                } = segment(index);
                nearest = [
                    greater(*inv_depth, nearest[0]),
                    greater(*biased, nearest[1]),
                ];
            }
            self.nearest.push(nearest);
        }
        let of_outline = match scene.drawing.order {
            Order::Rounded => Roundness::Outline,
            _ => Roundness::Flat,
        };
        let priority = u32::MAX - segment(segments[0]).strand;
        let mut drawn = strand.clump;
        for (stroke, nearest) in strokes().rev().zip(self.nearest.iter().rev()) {
            let mut open = strand.reach;
            target.close(&mut open, *nearest);
            if open == [0; ROWS] {
                continue;
            }
            placed.clear();
            let samples = Placed::add_all(scene, stroke, &open, placed);
            let samples = without(&samples, &drawn);
            if is_empty(&samples) {
                continue;
            }
            add(&mut drawn, &samples);
            let mut shown = NO_SAMPLES;
            let offer = Offer {
                scene,
                placed,
                roundness: of_outline,
                priority,
            };
            offer.make::<false, false>(&samples, row, target, &mut shown, unasked);
            target.show_stroke(&shown, true);
            if !TELLS {
                shade(placed, &shown, row, target);
                continue;
            }
            tell::<true>(
                placed,
                &shown,
                row,
                #[inline(always)]
                |cell, places, lanes| {
                    paint(target, cell, &places.color, lanes);
                    told.put_stroke(cell, places, lanes);
                    told.put_outside(cell, places, lanes);
                },
            );
        }
    }
}

/// Whether the lowest outline of a strand lies so much deeper than its clump that other strands hide most of it.
#[inline(always)]
pub(super) fn are_deep(scene: &TileContext, outlines: &[u32], clump: &[u32]) -> bool {
    let segment = |i: u32| &scene.segments[i as usize];
    let Some(&lowest) = outlines.first() else {
        return false;
    };
    let (mut outline, mut nearest) = (f32::NEG_INFINITY, f32::NEG_INFINITY);
    for &i in outlines {
        if segment(i).stroke != segment(lowest).stroke {
            break;
        }
        outline = greater(segment(i).inv_depth, outline);
    }
    for &i in clump {
        nearest = greater(segment(i).inv_depth, nearest);
    }
    outline < deeper(nearest, DEEP * scene.drawing.edge_depth_m)
}
