//! One strand in one tile: its strokes in their order, then the strand against what is there.
//!
//! What can't be seen is not worked out. First come the masks of what each stroke covers; from the
//! highest stroke down each takes the samples that are left. Then cell by cell: where the
//! stroke's nearest disc in the tile would show, its segments give depth and roundness, and what of that shows in the picture
//! goes there; only that gets a colour.

use super::brush::{LookUps, StrokeBrush};
use super::context::{Part, TileContext};
use super::offer::{Offer, Roundness, paint, shade, tell, unasked};
use super::outlines::{Outlined, Outlines, are_deep};
use super::reached::Reached;
use super::shown::Shown;
use super::stroke::Placed;
use super::tile::{
    Cell, Mask, NO_SAMPLES, ROWS, Target, add, both, cells, columns, greater, is_empty, without,
};
use crate::drawing::Order;
use std::ops::Range;

/// The working memory of one strand.
pub(super) struct StrandMasks {
    /// The strand's segments that cover something, in drawing order.
    placed: Vec<Placed>,
    /// Its strokes, lowest first; the clump before them.
    strokes: Vec<Covered>,
    /// Where brushes left bare what strokes that are clipped to the clump reach; of drawings without brushes anything.
    bare: Mask,
    row: Reached,
    /// Of a stroke with a brush.
    look_ups: LookUps,
    /// Those that are left for [`Self::draw_outlines`].
    outlines: Outlines,
}

/// A stroke in the tile.
struct Covered {
    /// 0 for the clump, or 1 more than the stroke's place in the order of strokes.
    number: u32,
    /// Its segments among the placed ones.
    segments: Range<usize>,
    /// The samples that it covers; then those of them that it gives its colour.
    samples: Mask,
}

impl StrandMasks {
    pub(super) fn new() -> Self {
        Self {
            placed: Vec::new(),
            strokes: Vec::new(),
            bare: NO_SAMPLES,
            row: Reached::default(),
            look_ups: LookUps::default(),
            outlines: Outlines::default(),
        }
    }

    /// Draws a strand of the tile with those segments. Where it `TELLS`, what shows of it is noted.
    #[inline(always)]
    pub(super) fn draw<const TELLS: bool>(
        &mut self,
        scene: &TileContext,
        tile: &[u32],
        part: &Part,
        target: &mut Target,
        shown: &mut Shown,
    ) {
        let strand = &tile[part.segments.clone()];
        let open = scene.open(part, target);
        if open == [0; ROWS] {
            return;
        }
        self.place(scene, strand, part.segments.start, &open);
        if !scene.drawing.brushwork.is_empty() {
            self.thin(scene, target);
        }
        match scene.drawing.order {
            Order::Rounded | Order::StrandFirst => {
                let id = scene.segments[strand[0] as usize].strand;
                self.draw_as_one::<TELLS>(scene, u32::MAX - id, target, shown);
            }
            Order::Shifted => self.draw_each::<TELLS>(scene, target, shown),
        }
    }

    /// Finds which of the open samples each stroke covers, and leaves out those that cover none. Outlines are left for later where that makes no
    /// difference.
    #[inline(always)]
    fn place(&mut self, scene: &TileContext, strand: &[u32], start: usize, open: &[u32; ROWS]) {
        self.placed.clear();
        self.strokes.clear();
        let number = |i: u32| scene.segments[i as usize].stroke;
        let is_outline =
            |i: &u32| number(*i) > 0 && scene.strokes[number(*i) as usize - 1].rank < 0;
        let (clump, rest) = strand.split_at(strand.partition_point(|i| number(*i) == 0));
        let (outlines, above) = rest.split_at(rest.partition_point(is_outline));
        self.place_stroke(scene, clump, open);
        let is_left = are_deep(scene, outlines, clump) && self.are_outlines_beside(scene);
        if is_left {
            let from = start + clump.len();
            self.outlines.push(Outlined {
                segments: from..from + outlines.len(),
                reach: *open,
                clump: self
                    .strokes
                    .first()
                    .map_or(NO_SAMPLES, |clump| clump.samples),
            });
        }
        let placed = if is_left { above } else { rest };
        for stroke in placed.chunk_by(|&a, &b| number(a) == number(b)) {
            self.place_stroke(scene, stroke, open);
        }
        if let Some(clump) = self.strokes.first().filter(|stroke| stroke.number == 0) {
            self.place_base(clump.segments.clone());
        }
    }

    /// Adds a stroke of such segments, where it covers any open samples.
    #[inline(always)]
    fn place_stroke(&mut self, scene: &TileContext, stroke: &[u32], open: &[u32; ROWS]) {
        let first = self.placed.len();
        let samples = Placed::add_all(scene, stroke, open, &mut self.placed);
        if is_empty(&samples) {
            self.placed.truncate(first);
            return;
        }
        self.strokes.push(Covered {
            number: scene.segments[stroke[0] as usize].stroke,
            segments: first..self.placed.len(),
            samples,
        });
    }

    /// Whether a strand's outlines show beside its clump alone, as that is drawn as strokes above them; the clump is placed. What is nearest is
    /// the same in any order: so they can be drawn when all clumps are, which hide most of what lies deeper.
    #[inline(always)]
    fn are_outlines_beside(&self, scene: &TileContext) -> bool {
        if scene.drawing.order == Order::Shifted || !scene.drawing.brushwork.is_empty() {
            return false;
        }
        self.placed.iter().all(|placed| placed.drawn_as > 0)
    }

    /// Draws the outlines that were left of the strands of a tile, after the last of them.
    #[inline(always)]
    pub(super) fn draw_outlines<const TELLS: bool>(
        &mut self,
        scene: &TileContext,
        tile: &[u32],
        target: &mut Target,
        told: &mut Shown,
    ) {
        let memory = (&mut self.placed, &mut self.row);
        (self.outlines).draw::<TELLS>(scene, tile, memory, target, told);
    }

    /// Takes from the strokes what their brushes leave bare: what is drawn of a strand is as if they didn't cover it. Where the strand is drawn as
    /// one, samples that a higher stroke takes are not looked at.
    #[inline(never)] // drawings without brushes have none of it in their loops
    fn thin(&mut self, scene: &TileContext, target: &Target) {
        scene.instructions.run(
            #[inline(always)]
            || self.thin_all(scene, target),
        );
    }

    #[inline(always)]
    fn thin_all(&mut self, scene: &TileContext, target: &Target) {
        let seen = self.may_show(target);
        self.bare = NO_SAMPLES;
        let is_one = scene.drawing.order != Order::Shifted;
        let clump = match self.strokes.first() {
            Some(clump) if clump.number == 0 => clump.samples,
            _ => NO_SAMPLES,
        };
        let mut taken = NO_SAMPLES;
        for covered in self.strokes.iter_mut().rev() {
            let reached = covered.samples;
            covered.samples = both(&covered.samples, &seen);
            let Some(place) = covered.number.checked_sub(1) else {
                continue;
            };
            let stroke = &scene.strokes[place as usize];
            let is_clipped = is_one && stroke.rank >= 0;
            if is_clipped {
                covered.samples = both(&covered.samples, &clump);
            } else if is_one {
                covered.samples = without(&covered.samples, &both(&self.bare, &clump));
            }
            if let Some(layer) = scene.drawing.brushwork.of_layer(stroke.layer) {
                let placed = &self.placed[covered.segments.clone()];
                let brush = StrokeBrush::new(scene, layer, stroke, placed[0].index);
                let wanted = without(&covered.samples, &taken);
                let mut left = wanted;
                brush.thin(placed, &mut self.look_ups, &reached, &mut left);
                let bare = without(&wanted, &left);
                covered.samples = without(&covered.samples, &bare);
                if stroke.rank >= 0 {
                    add(&mut self.bare, &bare);
                }
            }
            if is_one {
                add(&mut taken, &covered.samples);
            }
        }
    }

    /// The samples of its strokes in which not all of the strand that lies in their row is hidden.
    #[inline(always)]
    fn may_show(&self, target: &Target) -> Mask {
        let mut all = NO_SAMPLES;
        for stroke in &self.strokes {
            add(&mut all, &stroke.samples);
        }
        let mut seen = NO_SAMPLES;
        for row in 0..ROWS {
            let reached = columns(&all, row);
            if reached == 0 {
                continue;
            }
            let (mut nearest, mut biased) = (f32::NEG_INFINITY, f32::NEG_INFINITY);
            for placed in &self.placed {
                if columns(&placed.covered, row) != 0 {
                    nearest = greater(placed.shape.inv_depth.greatest(), nearest);
                    biased = greater(placed.shape.inv_depth_biased.greatest(), biased);
                }
            }
            for cell in cells(row, reached) {
                let shows = target.may_show(cell, &cell.lanes(&all), nearest, biased);
                cell.add_to(&mut seen, &shows);
            }
        }
        seen
    }

    /// Adds the strokes that are the clump and its sides, whose segments these are.
    #[inline(always)]
    fn place_base(&mut self, segments: Range<usize>) {
        let drawn_as = |placed: &Placed| placed.drawn_as;
        let mut first = segments.start;
        while first < segments.end {
            let number = drawn_as(&self.placed[first]);
            let ahead = &self.placed[first..segments.end];
            let part = ahead.partition_point(|placed| drawn_as(placed) <= number);
            let mut samples = NO_SAMPLES;
            for placed in &ahead[..part] {
                add(&mut samples, &placed.covered);
            }
            let stroke = Covered {
                number,
                segments: first..first + part,
                samples,
            };
            first += part;
            if number > 0 && !is_empty(&stroke.samples) {
                let place = self.strokes.partition_point(|s| s.number < number);
                self.strokes.insert(place, stroke);
            }
        }
    }

    /// Within the clump at the clump's depth, outside it strokes of negative rank at their own; then
    /// all of it against what is there.
    #[inline(always)]
    fn draw_as_one<const TELLS: bool>(
        &mut self,
        scene: &TileContext,
        priority: u32,
        target: &mut Target,
        told: &mut Shown,
    ) {
        let (clump, strokes) = match self.strokes.split_first_mut() {
            Some((clump, strokes)) if clump.number == 0 => (Some(clump), strokes),
            _ => (None, &mut self.strokes[..]),
        };
        let clump_samples = clump.as_ref().map_or(NO_SAMPLES, |clump| clump.samples);
        let rank = |stroke: &Covered| scene.strokes[stroke.number as usize - 1].rank;
        let has_brushes = !scene.drawing.brushwork.is_empty();
        let mut drawn = NO_SAMPLES;
        for stroke in strokes.iter_mut().rev() {
            // Brushes are through with both before.
            if rank(stroke) >= 0 && !has_brushes {
                stroke.samples = both(&stroke.samples, &clump_samples);
            }
            stroke.samples = without(&stroke.samples, &drawn);
            add(&mut drawn, &stroke.samples);
        }
        let [of_clump, of_outline] = match scene.drawing.order {
            Order::Rounded => [Roundness::Clump, Roundness::Outline],
            _ => [Roundness::Flat; 2],
        };
        let mut shown = NO_SAMPLES;
        for stroke in strokes.iter().filter(|stroke| rank(stroke) < 0) {
            let placed = &self.placed[stroke.segments.clone()];
            let outside = without(&stroke.samples, &clump_samples);
            let offer = Offer {
                scene,
                placed,
                roundness: of_outline,
                priority,
            };
            offer.make::<false, false>(&outside, &mut self.row, target, &mut shown, unasked);
        }
        // Where the clump shows is told at once, and of the stroke that is the clump all else: others, which are fewer, afterwards.
        let is_clump = |stroke: &Covered| {
            let segments_of_clump = clump.as_ref().map(|clump| &clump.segments);
            segments_of_clump == Some(&stroke.segments)
        };
        if let Some(clump) = &clump {
            let placed = &self.placed[clump.segments.clone()];
            let inside = both(&drawn, &clump_samples);
            let offer = Offer {
                scene,
                placed,
                roundness: of_clump,
                priority,
            };
            if TELLS && strokes.iter().any(is_clump) {
                offer.make::<true, true>(
                    &inside,
                    &mut self.row,
                    target,
                    &mut shown,
                    #[inline(always)]
                    |target, cell, places, lanes| {
                        paint(target, cell, &places.color, lanes);
                        told.put_stroke(cell, places, lanes);
                        told.put_clump(cell, places, lanes);
                    },
                );
            } else if TELLS {
                offer.make::<true, false>(
                    &inside,
                    &mut self.row,
                    target,
                    &mut shown,
                    #[inline(always)]
                    |_, cell, places, lanes| told.put_clump(cell, places, lanes),
                );
            } else {
                offer.make::<false, false>(&inside, &mut self.row, target, &mut shown, unasked);
            }
        }
        for stroke in strokes {
            let placed = &self.placed[stroke.segments.clone()];
            let samples = both(&stroke.samples, &shown);
            let rank = rank(stroke);
            target.show_stroke(&samples, rank < 0);
            if !TELLS {
                shade(placed, &samples, &mut self.row, target);
                continue;
            }
            if is_clump(stroke) {
                continue;
            }
            let outside = without(&samples, &clump_samples);
            tell::<true>(
                placed,
                &samples,
                &mut self.row,
                #[inline(always)]
                |cell, places, lanes| {
                    paint(target, cell, &places.color, lanes);
                    told.put_stroke(cell, places, lanes);
                    if rank < 0 {
                        let outside = Cell::of_index(cell).lanes(&outside);
                        told.put_outside(cell, places, &outside);
                    }
                },
            );
        }
    }

    /// Each stroke by itself against what is there.
    #[inline(always)]
    fn draw_each<const TELLS: bool>(
        &mut self,
        scene: &TileContext,
        target: &mut Target,
        told: &mut Shown,
    ) {
        for stroke in &self.strokes {
            let placed = &self.placed[stroke.segments.clone()];
            let offer = Offer {
                scene,
                placed,
                roundness: Roundness::Flat,
                priority: stroke.number,
            };
            let mut shown = NO_SAMPLES;
            if TELLS {
                offer.make::<true, true>(
                    &stroke.samples,
                    &mut self.row,
                    target,
                    &mut shown,
                    #[inline(always)]
                    |target, cell, places, lanes| {
                        paint(target, cell, &places.color, lanes);
                        told.put_stroke(cell, places, lanes);
                        told.put_clump(cell, places, lanes);
                    },
                );
            } else {
                offer.make::<false, false>(
                    &stroke.samples,
                    &mut self.row,
                    target,
                    &mut shown,
                    unasked,
                );
                shade(placed, &shown, &mut self.row, target);
            }
            let place = stroke.number.checked_sub(1);
            let is_outline = place.is_some_and(|place| scene.strokes[place as usize].rank < 0);
            target.show_stroke(&shown, is_outline);
        }
    }
}
