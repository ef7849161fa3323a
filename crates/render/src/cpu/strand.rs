//! One strand in one tile: its strokes in their order, then the strand against what is there.
//!
//! What can't be seen is not worked out. First come the masks of what each stroke covers; from the
//! highest stroke down each takes the samples that are left. Then cell by cell: where the
//! stroke's nearest disc in the tile would show, its segments give depth and roundness, and what of that shows in the picture
//! goes there; only that gets a colour.

use super::bin::Bounds;
use super::brush::{Beside, StrokeBrush};
use super::instructions::Instructions;
use super::reached::Reached;
use super::segment::{Segment, Stroke};
use super::shown::Shown;
use super::stroke::{Depths, Nearest, Placed, Places, Ratios, Shaded, Unasked};
use super::tile::{
    Cell, LANES, LaneMask, Lanes, Mask, NO_SAMPLES, OneByOne, ROWS, Stack, Target, add, any, both,
    cells, columns, greater, is_empty, lesser, overwrite, without,
};
use crate::drawing::{Drawing, Order};
use std::ops::Range;

/// What stays the same from strand to strand.
pub(super) struct TileContext<'a> {
    pub(super) drawing: &'a Drawing,
    pub(super) strokes: &'a [Stroke],
    pub(super) segments: &'a [Segment],
    /// The tile's upper left pixel.
    pub(super) origin: [usize; 2],
    /// The samples that are worked on.
    pub(super) stack: &'a Stack,
    /// What all of it is compiled for.
    pub(super) instructions: Instructions,
}

/// The working memory of one strand.
pub(super) struct StrandMasks {
    /// The strand's segments that cover something, in drawing order.
    placed: Vec<Placed>,
    /// Its strokes, lowest first; the clump before them.
    strokes: Vec<Covered>,
    /// Where brushes left bare what strokes that are clipped to the clump reach; of drawings without brushes anything.
    bare: Mask,
    row: Reached,
    /// Of strokes with brushes: their samples.
    beside: Beside,
    /// Strands whose outlines are left for [`StrandMasks::draw_outlines`].
    outlined: Vec<Outlined>,
    /// Of a strand's outlines from the lowest to the highest: how near any is up to there.
    nearest: Vec<[f32; 2]>,
}

/// Outlines that lie deeper than their clump by so many times the way from its middle to its edge are drawn after all clumps. Others would have them draw
/// what they hide.
const DEEP: f32 = 4.0;

/// A strand whose outlines are still to be drawn.
struct Outlined {
    /// Their segments in drawing order, among the tile's.
    segments: Range<usize>,
    /// The columns of each row of stacks that the strand may reach.
    reach: [u32; ROWS],
    /// The samples that the clump covers: it is drawn as strokes that lie higher.
    clump: Mask,
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

/// How much deeper than its middle a stroke lies towards its edge.
#[derive(Clone, Copy, PartialEq)]
enum Roundness {
    Flat,
    /// By the square of distance over radius.
    Clump,
    /// By its eighth power.
    Outline,
}

impl StrandMasks {
    pub(super) fn new() -> Self {
        Self {
            placed: Vec::new(),
            strokes: Vec::new(),
            bare: NO_SAMPLES,
            row: Reached::default(),
            beside: Beside::new(),
            outlined: Vec::new(),
            nearest: Vec::new(),
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
        let is_left = scene.are_deep(outlines, clump) && self.are_outlines_beside(scene);
        if is_left {
            let from = start + clump.len();
            self.outlined.push(Outlined {
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
        if !scene.drawing.brushwork.is_empty() {
            self.thin(scene);
        }
    }

    /// Adds a stroke of such segments, where it covers any open samples.
    #[inline(always)]
    fn place_stroke(&mut self, scene: &TileContext, stroke: &[u32], open: &[u32; ROWS]) {
        let first = self.placed.len();
        let mut samples = NO_SAMPLES;
        for &index in stroke {
            if let Some(placed) = Placed::new(scene, index, open) {
                add(&mut samples, &placed.covered);
                self.placed.push(placed);
            }
        }
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

    /// Draws the outlines of the strands that were drawn, to be called after the last of a tile.
    #[inline(always)]
    pub(super) fn draw_outlines<const TELLS: bool>(
        &mut self,
        scene: &TileContext,
        tile: &[u32],
        target: &mut Target,
        told: &mut Shown,
    ) {
        let outlined = std::mem::take(&mut self.outlined);
        for strand in &outlined {
            self.outline::<TELLS>(scene, &tile[strand.segments.clone()], strand, target, told);
        }
        self.outlined = outlined;
        self.outlined.clear();
    }

    /// Draws the outlines of a strand, the highest first: where one and all lower ones are hidden it hides none of them.
    #[inline(always)]
    fn outline<const TELLS: bool>(
        &mut self,
        scene: &TileContext,
        segments: &[u32],
        strand: &Outlined,
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
            self.placed.clear();
            let mut samples = NO_SAMPLES;
            for &index in stroke {
                if let Some(placed) = Placed::new(scene, index, &open) {
                    add(&mut samples, &placed.covered);
                    self.placed.push(placed);
                }
            }
            let samples = without(&samples, &drawn);
            if is_empty(&samples) {
                continue;
            }
            add(&mut drawn, &samples);
            let mut shown = NO_SAMPLES;
            let offer = Offer {
                scene,
                placed: &self.placed,
                roundness: of_outline,
                priority,
            };
            offer.make::<false>(&samples, &mut self.row, target, &mut shown, unasked);
            target.show_stroke(&shown, true);
            if !TELLS {
                shade(&self.placed, &shown, &mut self.row, target);
                continue;
            }
            tell::<true>(
                &self.placed,
                &shown,
                &mut self.row,
                #[inline(always)]
                |cell, places, lanes| {
                    paint(target, cell, &places.color, lanes);
                    told.put_stroke(cell, places, lanes);
                },
            );
        }
    }

    /// Takes from the strokes what their brushes leave bare: what is drawn of a strand is as if they didn't cover it. Where the strand is drawn as
    /// one, samples that a higher stroke takes are not looked at.
    #[inline(never)] // drawings without brushes have none of it in their loops
    fn thin(&mut self, scene: &TileContext) {
        scene.instructions.run(
            #[inline(always)]
            || self.thin_all(scene),
        );
    }

    #[inline(always)]
    fn thin_all(&mut self, scene: &TileContext) {
        self.bare = NO_SAMPLES;
        let is_one = scene.drawing.order != Order::Shifted;
        let clump = match self.strokes.first() {
            Some(clump) if clump.number == 0 => clump.samples,
            _ => NO_SAMPLES,
        };
        let mut taken = NO_SAMPLES;
        for covered in self.strokes.iter_mut().rev() {
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
                brush.thin(placed, (&mut self.row, &mut self.beside), &mut left);
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
            offer.make::<false>(&outside, &mut self.row, target, &mut shown, unasked);
        }
        // What shows is told at once where a stroke is the clump: others, which are fewer, afterwards.
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
                offer.make::<true>(
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
            } else {
                offer.make::<false>(&inside, &mut self.row, target, &mut shown, unasked);
            }
        }
        let mut told_of_clump = NO_SAMPLES;
        for stroke in strokes {
            let placed = &self.placed[stroke.segments.clone()];
            let samples = both(&stroke.samples, &shown);
            target.show_stroke(&samples, rank(stroke) < 0);
            if !TELLS {
                shade(placed, &samples, &mut self.row, target);
                continue;
            }
            if is_clump(stroke) {
                add(&mut told_of_clump, &samples);
                continue;
            }
            tell::<true>(
                placed,
                &samples,
                &mut self.row,
                #[inline(always)]
                |cell, places, lanes| {
                    paint(target, cell, &places.color, lanes);
                    told.put_stroke(cell, places, lanes);
                },
            );
        }
        if TELLS && let Some(clump) = clump {
            let placed = &self.placed[clump.segments.clone()];
            let samples = without(&both(&clump_samples, &shown), &told_of_clump);
            tell::<false>(
                placed,
                &samples,
                &mut self.row,
                #[inline(always)]
                |cell, places, lanes| {
                    told.put_clump(cell, places, lanes);
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
                offer.make::<true>(
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
                offer.make::<false>(&stroke.samples, &mut self.row, target, &mut shown, unasked);
                shade(placed, &shown, &mut self.row, target);
            }
            let place = stroke.number.checked_sub(1);
            let is_outline = place.is_some_and(|place| scene.strokes[place as usize].rank < 0);
            target.show_stroke(&shown, is_outline);
        }
    }
}

/// Nobody asks where samples that show lie.
fn unasked(_: &mut Target, _: usize, _: &Places<true>, _: &LaneMask) {}

/// A stroke that is held against what the samples show.
struct Offer<'a> {
    scene: &'a TileContext<'a>,
    /// Its segments.
    placed: &'a [Placed],
    roundness: Roundness,
    /// Decides among equal depths.
    priority: u32,
}

impl Offer<'_> {
    /// Puts the samples, which the segments cover, into the picture; those that show are added to `shown`. Where it `TELLS`, gives the axis
    /// points of these.
    #[inline(always)]
    fn make<const TELLS: bool>(
        &self,
        samples: &Mask,
        segments: &mut Reached,
        target: &mut Target,
        shown: &mut Mask,
        mut give: impl FnMut(&mut Target, usize, &Places<true>, &LaneMask),
    ) {
        let (mut nearest, mut biased) = (f32::NEG_INFINITY, f32::NEG_INFINITY);
        for placed in self.placed {
            nearest = greater(placed.shape.inv_depth.greatest(), nearest);
            biased = greater(placed.shape.inv_depth_biased.greatest(), biased);
        }
        for row in 0..ROWS {
            let wanted = columns(samples, row);
            if wanted == 0 {
                continue;
            }
            segments.find(self.placed, row, wanted);
            for cell in cells(row, wanted) {
                let taken = target.may_show(cell, &cell.lanes(samples), nearest, biased);
                if !any(&taken) {
                    continue;
                }
                if TELLS {
                    let mut places = Places::new();
                    let depths = self.depths(segments, cell, &taken, &mut places);
                    let wins = target.offer(cell, &taken, &depths, self.priority);
                    cell.add_to(shown, &wins);
                    give(target, cell.index, &places, &wins);
                    continue;
                }
                let depths = match self.roundness {
                    Roundness::Flat => self.depths(segments, cell, &taken, &mut Unasked),
                    _ => self.depths(segments, cell, &taken, &mut Ratios::new()),
                };
                let wins = target.offer(cell, &taken, &depths, self.priority);
                cell.add_to(shown, &wins);
            }
        }
    }

    /// The depths of some samples of a cell, by how far they are from the stroke's middle.
    #[inline(always)]
    fn depths(
        &self,
        segments: &mut Reached,
        cell: Cell,
        samples: &LaneMask,
        nearest: &mut impl Nearest,
    ) -> Depths {
        let mut depths = Depths::new();
        segments.measure(self.placed, cell, samples, &mut depths, nearest);
        if self.roundness == Roundness::Flat {
            return depths;
        }
        let mut part = *nearest.ratios();
        for k in 0..LANES {
            part[k] = lesser(part[k], 1.0);
        }
        if self.roundness == Roundness::Outline {
            for k in 0..LANES {
                let square = part[k] * part[k];
                part[k] = square * square;
            }
        }
        for k in 0..LANES {
            let deeper_m = self.scene.drawing.edge_depth_m * part[k];
            depths.inv_depth[k] = deeper(depths.inv_depth[k], deeper_m);
            depths.biased[k] = deeper(depths.biased[k], deeper_m);
        }
        depths
    }
}

/// The inverse depth of what lies so many metres deeper. There is nothing deeper than 0 or below.
#[inline(always)]
fn deeper(inv_depth: f32, metres: f32) -> f32 {
    inv_depth / (1.0 + metres * greater(inv_depth, 0.0))
}

/// Gives the samples, which the stroke covers, its colour.
#[inline(always)]
fn shade(placed: &[Placed], samples: &Mask, segments: &mut Reached, target: &mut Target) {
    let first = &placed[0].shape;
    let is_one_color = placed
        .iter()
        .all(|Placed { shape, .. }| shape.is_one_color() && shape.color == first.color);
    let color = first.color.map(|channel| [channel.start; LANES]);
    for row in 0..ROWS {
        let wanted = columns(samples, row);
        if wanted == 0 {
            continue;
        }
        if is_one_color {
            for cell in cells(row, wanted) {
                paint(target, cell.index, &color, &cell.lanes(samples));
            }
            continue;
        }
        segments.find(placed, row, wanted);
        for cell in cells(row, wanted) {
            let (mut stroke, lanes) = (Shaded::new(), cell.lanes(samples));
            segments.find_nearest(placed, cell, &lanes, &mut stroke);
            paint(target, cell.index, &stroke.color, &lanes);
        }
    }
}

/// Finds the axis points of the samples, which the segments cover, and gives them cell by cell. Where they are `COLORED`, with the colours
/// there.
#[inline(always)]
fn tell<const COLORED: bool>(
    placed: &[Placed],
    samples: &Mask,
    segments: &mut Reached,
    mut give: impl FnMut(usize, &Places<COLORED>, &LaneMask),
) {
    for row in 0..ROWS {
        let wanted = columns(samples, row);
        if wanted == 0 {
            continue;
        }
        segments.find(placed, row, wanted);
        for cell in cells(row, wanted) {
            let (mut places, lanes) = (Places::new(), cell.lanes(samples));
            segments.find_nearest(placed, cell, &lanes, &mut places);
            give(cell.index, &places, &lanes);
        }
    }
}

#[inline(always)]
fn paint(target: &mut Target, cell: usize, color: &[Lanes; 3], samples: &LaneMask) {
    for (plane, color) in target.color.iter_mut().zip(color) {
        overwrite(&mut plane[cell], color, samples);
    }
}

/// A strand's part of a tile.
pub(super) struct Part {
    /// Its segments in drawing order, among the tile's.
    pub(super) segments: Range<usize>,
    /// No disc of it is nearer than these.
    inv_depth: f32,
    biased: f32,
    /// Rows of stacks that it may reach.
    rows: Range<usize>,
    /// Columns that it may reach, a bit for each.
    columns: u32,
}

impl TileContext<'_> {
    /// Replaces `parts` by the strands of a tile, in the order in which they are best drawn.
    #[inline(always)]
    pub(super) fn strands(&self, tile: &[u32], parts: &mut Vec<Part>) {
        parts.clear();
        let mut rest = tile.iter().zip(0..);
        let Some((&first, _)) = rest.next() else {
            return;
        };
        let mut start = 0;
        let first = &self.segments[first as usize];
        let (mut strand, mut bounds) = (first.strand, first.bounds);
        let (mut inv_depth, mut biased) = (first.inv_depth, first.biased);
        let part = |segments: Range<usize>, inv_depth, biased, bounds: &Bounds| Part {
            segments,
            inv_depth,
            biased,
            rows: bounds.rows_in(self.origin[1], self.stack),
            columns: bounds.columns_in(self.origin[0]),
        };
        for (&index, place) in rest {
            let segment = &self.segments[index as usize];
            if segment.strand != strand {
                parts.push(part(start..place, inv_depth, biased, &bounds));
                start = place;
                (strand, bounds) = (segment.strand, segment.bounds);
                (inv_depth, biased) = (segment.inv_depth, segment.biased);
                continue;
            }
            bounds = bounds.around(&segment.bounds);
            inv_depth = greater(segment.inv_depth, inv_depth);
            biased = greater(segment.biased, biased);
        }
        parts.push(part(start..tile.len(), inv_depth, biased, &bounds));
        // What lies behind the nearer ones is then seen to be hidden. Shifted strokes of equal depth
        // need their strands' order.
        if self.drawing.order != Order::Shifted {
            parts.sort_by(|a, b| b.inv_depth.total_cmp(&a.inv_depth));
        }
    }

    /// Whether the lowest outline of a strand lies so much deeper than its clump that other strands hide most of it.
    #[inline(always)]
    fn are_deep(&self, outlines: &[u32], clump: &[u32]) -> bool {
        let segment = |i: u32| &self.segments[i as usize];
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
        outline < deeper(nearest, DEEP * self.drawing.edge_depth_m)
    }

    /// The columns of each row of stacks that the strand may reach where it is not sure, for a whole cell, to be hidden.
    #[inline(always)]
    fn open(&self, part: &Part, target: &Target) -> [u32; ROWS] {
        let mut open = [0; ROWS];
        for row in OneByOne::of(&part.rows) {
            open[row] = part.columns & target.open(row, part.inv_depth, part.biased);
        }
        open
    }
}
