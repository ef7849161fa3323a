//! One strand in one tile: its strokes in their order, then the strand against what is there.

use super::segment::{Segment, Stroke};
use super::stroke::{Depths, Placed};
use super::tile::{
    HEIGHT, LANES, Lanes, NOTHING, Plane, Region, Target, WIDTH, overwrite, plane, select,
};
use crate::drawing::Order;
use glam::Vec2;

/// What stays the same from strand to strand.
pub(super) struct Scene<'a> {
    pub(super) order: Order,
    pub(super) strokes: &'a [Stroke],
    pub(super) segments: &'a [Segment],
    /// The tile's upper left pixel.
    pub(super) origin: [usize; 2],
    /// The samples that are worked on, from their pixel's corner.
    pub(super) samples: &'a [Vec2],
}

/// The planes of one strand; each strand clears what it touches.
pub(super) struct StrandPlanes {
    /// The clump, which the strokes of rank 0 and above are clipped to.
    clump: Depths,
    /// The stroke that is being drawn.
    stroke: Depths,
    /// The least ratio of the stroke, or infinity where it doesn't cover.
    ratio: Plane,
    stroke_color: [Plane; 3],
    /// What the strand shows.
    shown: Depths,
    color: [Plane; 3],
}

impl StrandPlanes {
    pub(super) fn new() -> Self {
        let depths = || Depths {
            inv_depth: plane(),
            biased: plane(),
        };
        Self {
            clump: depths(),
            stroke: depths(),
            ratio: plane(),
            stroke_color: [plane(), plane(), plane()],
            shown: depths(),
            color: [plane(), plane(), plane()],
        }
    }

    /// Draws the segments of one strand, given by their indices in drawing order.
    pub(super) fn draw(&mut self, scene: &Scene, strand: &[u32], target: &mut Target) {
        let region = scene.region(strand);
        clear(&region, &mut self.clump);
        clear(&region, &mut self.shown);
        let mut has_clump = false;
        for stroke in strand.chunk_by(|&a, &b| scene.number(a) == scene.number(b)) {
            let number = scene.number(stroke[0]);
            let Some(place) = number.checked_sub(1) else {
                for placed in scene.placed(stroke) {
                    placed.measure(scene.samples, &mut self.clump);
                }
                has_clump = true;
                continue;
            };
            let rank = scene.strokes[place as usize].rank;
            match scene.order {
                Order::StrandFirst if rank < 0 => self.stroke(scene, stroke, Clip::Nowhere),
                Order::StrandFirst if has_clump => self.stroke(scene, stroke, Clip::ToClump),
                Order::StrandFirst => {}
                Order::Shifted => {
                    self.stroke(scene, stroke, Clip::Nowhere);
                    self.composite(&region, number as i32, target);
                    clear(&region, &mut self.shown);
                }
            }
        }
        if scene.order == Order::StrandFirst {
            self.composite(&region, 0, target);
        }
    }

    /// Lays one stroke over what the strand shows so far.
    fn stroke(&mut self, scene: &Scene, stroke: &[u32], clip: Clip) {
        let region = scene.region(stroke);
        region.fill(&mut self.ratio, f32::INFINITY);
        let first = &scene.segments[stroke[0] as usize];
        let one_color = stroke.iter().all(|&i| {
            let segment = &scene.segments[i as usize];
            segment.is_one_color() && segment.color == first.color
        });
        for placed in scene.placed(stroke) {
            if one_color {
                placed.cover(scene.samples, &mut self.ratio);
            } else {
                placed.shade(scene.samples, &mut self.ratio, &mut self.stroke_color);
            }
        }
        if clip == Clip::Nowhere {
            clear(&region, &mut self.stroke);
            for placed in scene.placed(stroke) {
                placed.measure(scene.samples, &mut self.stroke);
            }
        }
        let color = one_color.then(|| first.color.map(|channel| [channel.start; LANES]));
        for span in region.spans() {
            for cell in span {
                self.settle(cell, clip, color);
            }
        }
    }

    /// Where the stroke may show, the strand takes on its colour: in the clump at the clump's depth,
    /// outside it at the stroke's own. `color` is that of a stroke of one colour.
    #[inline]
    fn settle(&mut self, cell: usize, clip: Clip, color: Option<[Lanes; 3]>) {
        let ratio = self.ratio[cell];
        if ratio == [f32::INFINITY; LANES] {
            return;
        }
        let clump = self.clump.inv_depth[cell];
        let clump_biased = self.clump.biased[cell];
        let (own, own_biased) = match clip {
            Clip::Nowhere => (self.stroke.inv_depth[cell], self.stroke.biased[cell]),
            Clip::ToClump => ([NOTHING; LANES], [NOTHING; LANES]),
        };
        let mut depth = self.shown.inv_depth[cell];
        let mut biased = self.shown.biased[cell];
        let mut shows = [0.0; LANES];
        for k in 0..LANES {
            let is_inside = clump[k] > NOTHING;
            let new = select(is_inside, clump[k], own[k]);
            let new = select(ratio[k] < f32::INFINITY, new, NOTHING);
            let new_biased = select(is_inside, clump_biased[k], own_biased[k]);
            let is_shown = new > NOTHING;
            depth[k] = select(is_shown, new, depth[k]);
            biased[k] = select(is_shown, new_biased, biased[k]);
            shows[k] = select(is_shown, 1.0, 0.0);
        }
        self.shown.inv_depth[cell] = depth;
        self.shown.biased[cell] = biased;
        for channel in 0..3 {
            let new = color.map_or(self.stroke_color[channel][cell], |color| color[channel]);
            overwrite(&mut self.color[channel][cell], &new, &shows);
        }
    }

    /// Puts what the strand shows into the picture: behind no surface, nearer than the strands
    /// before it, or as near but with a higher stroke.
    fn composite(&self, region: &Region, stroke: i32, target: &mut Target) {
        for span in region.spans() {
            for cell in span {
                self.composite_cell(cell, stroke, target);
            }
        }
    }

    #[inline]
    fn composite_cell(&self, cell: usize, stroke: i32, target: &mut Target) {
        let depth = self.shown.inv_depth[cell];
        if depth == [NOTHING; LANES] {
            return;
        }
        let biased = self.shown.biased[cell];
        let (surface, hollow) = (target.surface[cell], target.hollow[cell]);
        let mut nearest = target.strand[cell];
        let mut top = target.stroke[cell];
        let mut wins = [0.0; LANES];
        for k in 0..LANES {
            let before_wall = depth[k] / (1.0 + hollow[k] * depth[k]);
            let against = select(hollow[k] > 0.0, before_wall, biased[k]);
            let depth = select(surface[k] <= against, depth[k], NOTHING);
            // Where there is nothing, no stroke is higher than what is there.
            let stroke = select(depth > NOTHING, stroke, -1);
            let is_better = (depth > nearest[k]) | ((depth == nearest[k]) & (stroke > top[k]));
            nearest[k] = select(is_better, depth, nearest[k]);
            top[k] = select(is_better, stroke, top[k]);
            wins[k] = select(is_better, 1.0, 0.0);
        }
        target.strand[cell] = nearest;
        target.stroke[cell] = top;
        for (target, color) in target.color.iter_mut().zip(&self.color) {
            overwrite(&mut target[cell], &color[cell], &wins);
        }
    }
}

/// Where a stroke may show.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Clip {
    Nowhere,
    ToClump,
}

impl<'a> Scene<'a> {
    fn number(&self, segment: u32) -> u32 {
        self.segments[segment as usize].stroke
    }

    fn placed(&self, segments: &[u32]) -> impl Iterator<Item = Placed<'a>> {
        segments.iter().map(|&i| {
            let segment = &self.segments[i as usize];
            let bounds = segment.reach(self.origin, [WIDTH, HEIGHT]);
            Placed::new(segment, bounds, self.origin)
        })
    }

    fn region(&self, segments: &[u32]) -> Region {
        let bounds = segments.iter().map(|&i| {
            let segment = &self.segments[i as usize];
            segment.reach(self.origin, [WIDTH, HEIGHT])
        });
        Region::around(bounds, self.samples.len())
    }
}

fn clear(region: &Region, depths: &mut Depths) {
    region.fill(&mut depths.inv_depth, NOTHING);
    region.fill(&mut depths.biased, NOTHING);
}
