//! What brushes leave of the strokes of a strand in a tile: the samples that they keep bare are taken away before anything is drawn.

use super::reached::Reached;
use super::segment::Stroke;
use super::strand::TileContext;
use super::stroke::{Placed, Places};
use super::tile::{Cell, LANES, LaneMask, Lanes, Mask, ROWS, Stack, cells, columns, select};
use crate::brushwork::BrushedLayer;
use crate::drawing::scatter;
use effects::{BrushPlaces, StrandBrush};

/// A sample of a stroke, and the axis point that is the nearest to it.
pub(super) struct Beside {
    cell: Cell,
    lane: usize,
    segment: u32,
    /// From the segment's first joint to the next.
    way: f32,
    across: f32,
}

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
    pub(super) fn thin(
        &self,
        placed: &[Placed],
        (segments, beside): (&mut Reached, &mut Vec<Beside>),
        samples: &mut Mask,
    ) {
        beside.clear();
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
                for lane in (0..LANES).filter(|&lane| lanes[lane] != 0) {
                    beside.push(Beside {
                        cell,
                        lane,
                        segment: places.index[lane],
                        way: places.way[lane],
                        across: across[lane],
                    });
                }
            }
        }
        // Most cells have few samples of a thin stroke: those of several are looked up together.
        for some in beside.chunks(LANES) {
            let mut wanted = [0; LANES];
            let mut segments = [0; LANES];
            let (mut way, mut across, mut parts) = ([0.0; LANES], [0.0; LANES], [0.0; LANES]);
            for (k, sample) in some.iter().enumerate() {
                wanted[k] = u32::MAX;
                segments[k] = sample.segment;
                way[k] = sample.way;
                across[k] = sample.across;
                parts[k] = self.parts[sample.lane];
            }
            let bare = self.bare_of(&wanted, &segments, (&way, &across), &parts);
            for (k, sample) in some.iter().enumerate() {
                if bare[k] != 0 {
                    sample.cell.take_lane_from(samples, sample.lane);
                }
            }
        }
    }

    /// Those of some samples of a cell that it leaves bare, by their places: segments, the way from their first joints to the next, and across.
    #[inline(always)]
    pub(super) fn bare(
        &self,
        samples: &LaneMask,
        segments: &[u32; LANES],
        way: &Lanes,
        across: &Lanes,
    ) -> LaneMask {
        self.bare_of(samples, segments, (way, across), &self.parts)
    }

    /// The same of samples whose coverage must exceed so much.
    #[inline(always)]
    fn bare_of(
        &self,
        samples: &LaneMask,
        segments: &[u32; LANES],
        (way, across): (&Lanes, &Lanes),
        parts: &Lanes,
    ) -> LaneMask {
        let (mut from, mut to) = (Ends::ZERO, Ends::ZERO);
        let mut before = None;
        for k in 0..LANES {
            if samples[k] == 0 {
                continue;
            }
            // Most samples of a cell are of one segment.
            match before {
                Some(other) if segments[other] == segments[k] => {
                    from.copy(other, k);
                    to.copy(other, k);
                }
                _ => self.load(segments[k], k, &mut from, &mut to),
            }
            before = Some(k);
        }
        let mut places = BrushPlaces {
            s: between(way, &from.s, &to.s),
            whole: between(way, &from.whole, &to.whole),
            v: *across,
            pixels: between(way, &from.pixels, &to.pixels),
            radius_px: between(way, &from.radius_px, &to.radius_px),
        };
        if self.is_outline {
            places = places.on_outline(&between(way, &from.clump_px, &to.clump_px));
        }
        let coverage = self.brush.coverages(&places);
        let mut bare = *samples;
        for k in 0..LANES {
            bare[k] &= select(coverage[k] <= parts[k], u32::MAX, 0);
        }
        bare
    }

    /// What the joints of a segment have, for one lane.
    #[inline(always)]
    fn load(&self, segment: u32, lane: usize, from: &mut Ends, to: &mut Ends) {
        let drawing = self.scene.drawing;
        let segment = &self.scene.segments[segment as usize];
        let (joints, radii) = (segment.joints(), segment.radii(drawing, self.scene.strokes));
        for (end, i) in [from, to].into_iter().zip(0..) {
            let along = &drawing.brushwork.joints[joints[i]];
            end.s[lane] = along.s;
            end.whole[lane] = along.whole;
            end.pixels[lane] = along.pixels;
            end.radius_px[lane] = radii[i];
            if self.is_outline {
                end.clump_px[lane] = drawing.clump[joints[i]].radius;
            }
        }
    }
}

/// Numbers on the way from those of first joints to those of second ones.
#[inline(always)]
fn between(way: &Lanes, from: &Lanes, to: &Lanes) -> Lanes {
    let mut between = *from;
    for k in 0..LANES {
        between[k] += way[k] * (to[k] - from[k]);
    }
    between
}

/// What the first joints of segments have, or the second ones, as [`BrushPlaces`] has it; and the radius of the clump.
struct Ends {
    s: Lanes,
    whole: Lanes,
    pixels: Lanes,
    radius_px: Lanes,
    clump_px: Lanes,
}

impl Ends {
    const ZERO: Self = Self {
        s: [0.0; LANES],
        whole: [0.0; LANES],
        pixels: [0.0; LANES],
        radius_px: [0.0; LANES],
        clump_px: [0.0; LANES],
    };

    /// Makes a lane's the same as another's.
    #[inline(always)]
    fn copy(&mut self, from: usize, to: usize) {
        for lanes in [
            &mut self.s,
            &mut self.whole,
            &mut self.pixels,
            &mut self.radius_px,
            &mut self.clump_px,
        ] {
            lanes[to] = lanes[from];
        }
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
