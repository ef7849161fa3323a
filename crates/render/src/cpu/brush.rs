//! What brushes leave of the strokes of a strand in a tile: the samples that they keep bare are taken away before anything is drawn.

use super::reached::Reached;
use super::segment::Stroke;
use super::strand::TileContext;
use super::stroke::{Placed, Places};
use super::tile::{LANES, LaneMask, Lanes, Mask, ROWS, Stack, cells, columns};
use crate::brushwork::BrushedLayer;
use crate::drawing::scatter;
use effects::StrandBrush;

/// A stroke's brush.
pub(super) struct StrokeBrush<'a> {
    scene: &'a TileContext<'a>,
    brush: StrandBrush<'a>,
    /// Whether it shows outside of its clump alone.
    is_outline: bool,
    /// What coverage must exceed in each lane.
    parts: Lanes,
}

impl<'a> StrokeBrush<'a> {
    /// That of a layer's stroke, on the strand of a segment.
    #[inline(always)]
    pub(super) fn new(
        scene: &'a TileContext<'a>,
        layer: &'a BrushedLayer,
        stroke: &Stroke,
        segment: u32,
    ) -> Self {
        let [joint, _] = scene.segments[segment as usize].joints();
        let strand = scene.drawing.brushwork.joints[joint].strand;
        let seed = layer.stroke_seed(stroke.instance, strand);
        Self {
            scene,
            brush: layer.of_stroke(seed),
            is_outline: stroke.rank < 0 && scene.drawing.decal(stroke.layer).is_none(),
            parts: parts(seed, scene.stack),
        }
    }

    /// Takes from the samples, which the segments of the stroke cover, those that it leaves bare.
    #[inline(always)]
    pub(super) fn thin(&self, placed: &[Placed], segments: &mut Reached, samples: &mut Mask) {
        for row in 0..ROWS {
            let wanted = columns(samples, row);
            if wanted == 0 {
                continue;
            }
            segments.find(placed, row, wanted);
            for cell in cells(row, wanted) {
                let (mut places, lanes) = (Places::<false>::new(), cell.lanes(samples));
                segments.find_nearest(placed, cell, &lanes, &mut places);
                let across = places.across();
                let bare = self.bare(&lanes, &places.index, &places.way, &across);
                cell.take_from(samples, &bare);
            }
        }
    }

    /// Those of some samples that it leaves bare, by their places: segments, the way from their first joints to the next, and across.
    #[inline(always)]
    pub(super) fn bare(
        &self,
        samples: &LaneMask,
        segments: &[u32; LANES],
        way: &Lanes,
        across: &Lanes,
    ) -> LaneMask {
        let drawing = self.scene.drawing;
        let mut bare = [0; LANES];
        for k in 0..LANES {
            if samples[k] == 0 {
                continue;
            }
            let segment = &self.scene.segments[segments[k] as usize];
            let joints = segment.joints();
            let [from, to] = joints.map(|joint| &drawing.brushwork.joints[joint]);
            let radii = segment.radii(drawing, self.scene.strokes);
            let mut place = from.between(to, way[k], across[k], radii);
            if self.is_outline {
                let [from, to] = joints.map(|joint| drawing.clump[joint].radius);
                place = place.on_outline(from + way[k] * (to - from));
            }
            if self.brush.coverage(&place) <= self.parts[k] {
                bare[k] = u32::MAX;
            }
        }
        bare
    }
}

/// The part that a stroke of that seed has in each sample of a cell.
#[inline(always)]
fn parts(seed: u32, stack: &Stack) -> Lanes {
    let together = stack.of_pixel;
    let mut parts = [0.5; LANES];
    if together > 1 {
        for (k, part) in parts.iter_mut().enumerate() {
            *part = scatter(seed, (stack.first + k % together) as u32);
        }
    }
    parts
}
