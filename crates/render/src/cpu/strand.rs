//! One strand in one tile: its strokes in their order, then the strand against what is there.
//!
//! What can't be seen is not worked out. First come the masks of what each stroke covers; from the
//! highest stroke down each takes the samples that are left. Of these only those get a depth where the
//! stroke's nearest disc in the tile would show; only those are rounded that still would, as rounding takes
//! them deeper; and only those that then show in the picture get a colour.

use super::segment::{Segment, Stroke};
use super::stroke::{Depths, Placed};
use super::tile::{
    HEIGHT, LANES, Lanes, Mask, NO_SAMPLES, Plane, ROWS, Target, both, cells, greater, has,
    is_empty, plane, select, without,
};
use crate::drawing::Order;
use glam::Vec2;
use std::ops::Range;

/// Part of an inverse depth below which two are the same: the rounding of a ramp's ends.
const SAME_DEPTH: f32 = 1e-6;

/// What stays the same from strand to strand.
pub(super) struct TileContext<'a> {
    pub(super) order: Order,
    pub(super) edge_depth_m: f32,
    pub(super) strokes: &'a [Stroke],
    pub(super) segments: &'a [Segment],
    /// The tile's upper left pixel.
    pub(super) origin: [usize; 2],
    /// The samples that are worked on, from their pixel's corner.
    pub(super) samples: &'a [Vec2],
}

/// The working memory of one strand.
pub(super) struct StrandPlanes {
    /// The strand's segments that cover something, in drawing order.
    placed: Vec<Placed>,
    /// Its strokes, lowest first; the clump before them.
    strokes: Vec<Covered>,
    depths: Depths,
    /// The least ratio of the stroke that is being shaded.
    ratio: Plane,
    /// Segments of a stroke from the nearest to the farthest.
    by_depth: Vec<Near>,
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

/// A segment's range of depths.
struct Near {
    placed: usize,
    /// Least and greatest.
    inv_depth: [f32; 2],
    biased: [f32; 2],
    /// The greatest of this and all farther segments.
    biased_from_here: f32,
}

impl StrandPlanes {
    pub(super) fn new() -> Self {
        Self {
            placed: Vec::new(),
            strokes: Vec::new(),
            depths: Depths {
                inv_depth: plane(),
                biased: plane(),
            },
            ratio: plane(),
            by_depth: Vec::new(),
        }
    }

    /// Draws a strand of the tile with those segments.
    #[inline(always)]
    pub(super) fn draw(
        &mut self,
        scene: &TileContext,
        tile: &[u32],
        part: &Part,
        target: &mut Target,
    ) {
        let strand = &tile[part.segments.clone()];
        let open = scene.open(part, target);
        if is_empty(&open) {
            return;
        }
        self.place(scene, strand, &open);
        match scene.order {
            Order::Rounded | Order::StrandFirst => {
                let id = scene.segments[strand[0] as usize].strand;
                self.draw_as_one(scene, u32::MAX - id, target);
            }
            Order::Shifted => self.draw_each(scene, target),
        }
    }

    /// Finds which of the open samples each stroke covers, and leaves out those that cover none.
    #[inline(always)]
    fn place(&mut self, scene: &TileContext, strand: &[u32], open: &Mask) {
        self.placed.clear();
        self.strokes.clear();
        let number = |i: u32| scene.segments[i as usize].stroke;
        for stroke in strand.chunk_by(|&a, &b| number(a) == number(b)) {
            let first = self.placed.len();
            let mut samples = NO_SAMPLES;
            for &index in stroke {
                let segment = &scene.segments[index as usize];
                let placed = Placed::new(index, segment, scene.origin, scene.samples, open);
                for row in 0..ROWS {
                    samples[row] |= placed.covered[row] & open[row];
                }
                self.placed.push(placed);
            }
            if is_empty(&samples) {
                self.placed.truncate(first);
                continue;
            }
            self.strokes.push(Covered {
                number: number(stroke[0]),
                segments: first..self.placed.len(),
                samples,
            });
        }
        if let Some(clump) = self.strokes.first().filter(|stroke| stroke.number == 0) {
            self.place_base(scene, clump.segments.clone(), open);
        }
    }

    /// Adds the strokes that are the clump and its sides, whose segments these are.
    #[inline(always)]
    fn place_base(&mut self, scene: &TileContext, segments: Range<usize>, open: &Mask) {
        let drawn_as = |placed: &Placed| scene.segments[placed.segment as usize].drawn_as;
        let mut first = segments.start;
        while first < segments.end {
            let number = drawn_as(&self.placed[first]);
            let ahead = &self.placed[first..segments.end];
            let part = ahead.partition_point(|placed| drawn_as(placed) <= number);
            let mut samples = NO_SAMPLES;
            for placed in &ahead[..part] {
                for row in 0..ROWS {
                    samples[row] |= placed.covered[row] & open[row];
                }
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
    fn draw_as_one(&mut self, scene: &TileContext, priority: u32, target: &mut Target) {
        let (clump, strokes) = match self.strokes.split_first_mut() {
            Some((clump, strokes)) if clump.number == 0 => (Some(clump), strokes),
            _ => (None, &mut self.strokes[..]),
        };
        let clump_samples = clump.as_ref().map_or(NO_SAMPLES, |clump| clump.samples);
        let rank = |stroke: &Covered| scene.strokes[stroke.number as usize - 1].rank;
        let mut shown = NO_SAMPLES;
        for stroke in strokes.iter_mut().rev() {
            let is_clipped = rank(stroke) >= 0;
            for row in 0..ROWS {
                let may = select(is_clipped, clump_samples[row], u32::MAX);
                stroke.samples[row] &= may & !shown[row];
                shown[row] |= stroke.samples[row];
            }
        }
        self.depths.clear(&shown);
        let is_round = scene.order == Order::Rounded;
        for stroke in strokes.iter().filter(|stroke| rank(stroke) < 0) {
            let placed = &self.placed[stroke.segments.clone()];
            let outside = without(&stroke.samples, &clump_samples);
            let near = scene.before(placed, &outside, target);
            shown = without(&shown, &without(&outside, &near));
            let outside = near;
            measure(scene, placed, outside, &mut self.by_depth, &mut self.depths);
            if is_round {
                let near = self.depths.before(&outside, target);
                shown = without(&shown, &without(&outside, &near));
                round(
                    scene,
                    placed,
                    &near,
                    true,
                    &mut self.ratio,
                    &mut self.depths,
                );
            }
        }
        if let Some(clump) = clump {
            let placed = &self.placed[clump.segments.clone()];
            let inside = both(&shown, &clump_samples);
            let near = scene.before(placed, &inside, target);
            shown = without(&shown, &without(&inside, &near));
            let inside = near;
            measure(scene, placed, inside, &mut self.by_depth, &mut self.depths);
            if is_round {
                let near = self.depths.before(&inside, target);
                shown = without(&shown, &without(&inside, &near));
                round(
                    scene,
                    placed,
                    &near,
                    false,
                    &mut self.ratio,
                    &mut self.depths,
                );
            }
        }
        composite(&self.depths, &mut shown, priority, target);
        for stroke in strokes {
            stroke.samples = both(&stroke.samples, &shown);
            shade(
                scene,
                &self.placed[stroke.segments.clone()],
                &stroke.samples,
                &mut self.ratio,
                target,
            );
        }
    }

    /// Each stroke by itself against what is there.
    #[inline(always)]
    fn draw_each(&mut self, scene: &TileContext, target: &mut Target) {
        for stroke in &mut self.strokes {
            let placed = &self.placed[stroke.segments.clone()];
            self.depths.clear(&stroke.samples);
            measure(
                scene,
                placed,
                stroke.samples,
                &mut self.by_depth,
                &mut self.depths,
            );
            composite(&self.depths, &mut stroke.samples, stroke.number, target);
            shade(scene, placed, &stroke.samples, &mut self.ratio, target);
        }
    }
}

/// Works out the depths of the samples, which the segments cover.
///
/// From the nearest segment to the farthest: a sample that one covers needs no other that is farther
/// all along.
#[inline(always)]
fn measure(
    scene: &TileContext,
    placed: &[Placed],
    mut samples: Mask,
    by_depth: &mut Vec<Near>,
    depths: &mut Depths,
) {
    if is_empty(&samples) {
        return;
    }
    by_depth.clear();
    by_depth.extend(placed.iter().enumerate().map(|(i, placed)| {
        let segment = &scene.segments[placed.segment as usize];
        let biased = segment.inv_depth_biased.range();
        Near {
            placed: i,
            inv_depth: segment.inv_depth.range(),
            biased,
            biased_from_here: biased[1],
        }
    }));
    by_depth.sort_by(|a, b| b.inv_depth[1].total_cmp(&a.inv_depth[1]));
    for i in (1..by_depth.len()).rev() {
        by_depth[i - 1].biased_from_here = by_depth[i - 1]
            .biased_from_here
            .max(by_depth[i].biased_from_here);
    }
    let reaches = |least: f32, greatest: f32| least + SAME_DEPTH * least.abs() >= greatest;
    for (i, near) in by_depth.iter().enumerate() {
        let placed = &placed[near.placed];
        let segment = &scene.segments[placed.segment as usize];
        placed.measure(segment, scene.samples, &samples, depths);
        let hides_the_rest = by_depth.get(i + 1).is_some_and(|next| {
            reaches(near.inv_depth[0], next.inv_depth[1])
                & reaches(near.biased[0], next.biased_from_here)
        });
        if hides_the_rest {
            samples = without(&samples, &placed.covered);
        }
    }
}

/// Takes the samples, which the segments cover, as much deeper as they are far from the stroke's middle.
#[inline(always)]
fn round(
    scene: &TileContext,
    placed: &[Placed],
    samples: &Mask,
    is_outline: bool,
    ratio: &mut Plane,
    depths: &mut Depths,
) {
    if is_empty(samples) {
        return;
    }
    for cell in cells(samples) {
        ratio[cell.index] = [1.0; LANES];
    }
    for placed in placed {
        let segment = &scene.segments[placed.segment as usize];
        placed.ratio(segment, scene.samples, samples, ratio);
    }
    for cell in cells(samples) {
        let mut part = ratio[cell.index];
        if is_outline {
            for k in 0..LANES {
                part[k] *= part[k];
                part[k] *= part[k];
            }
        }
        let nearest = &mut depths.inv_depth[cell.index];
        let biased = &mut depths.biased[cell.index];
        for k in 0..LANES {
            let deeper_m = scene.edge_depth_m * part[k];
            let is_taken = has(cell.bits, k);
            nearest[k] = select(is_taken, deeper(nearest[k], deeper_m), nearest[k]);
            biased[k] = select(is_taken, deeper(biased[k], deeper_m), biased[k]);
        }
    }
}

/// The inverse depth of what lies so many metres deeper. There is nothing deeper than 0 or below.
#[inline(always)]
fn deeper(inv_depth: f32, metres: f32) -> f32 {
    inv_depth / (1.0 + metres * greater(inv_depth, 0.0))
}

/// Puts the samples into the picture; those that don't show are taken away.
#[inline(always)]
fn composite(depths: &Depths, samples: &mut Mask, priority: u32, target: &mut Target) {
    let offered = *samples;
    for cell in cells(&offered) {
        let (depth, biased) = (&depths.inv_depth[cell.index], &depths.biased[cell.index]);
        let shown = target.offer(cell, depth, biased, priority);
        samples[cell.row] &= !((cell.bits & !shown) << cell.column);
    }
}

/// Gives the samples, which the stroke covers, its colour.
#[inline(always)]
fn shade(
    scene: &TileContext,
    placed: &[Placed],
    samples: &Mask,
    ratio: &mut Plane,
    target: &mut Target,
) {
    if is_empty(samples) {
        return;
    }
    let segment = |placed: &Placed| &scene.segments[placed.segment as usize];
    let first = segment(&placed[0]);
    let is_one_color = placed.iter().all(|placed| {
        let segment = segment(placed);
        segment.is_one_color() && segment.color == first.color
    });
    if is_one_color {
        let color = first.color.map(|channel| channel.start);
        for cell in cells(samples) {
            for (plane, value) in target.color.iter_mut().zip(color) {
                fill(&mut plane[cell.index], value, cell.bits);
            }
        }
        return;
    }
    for cell in cells(samples) {
        ratio[cell.index] = [f32::INFINITY; LANES];
    }
    for placed in placed {
        placed.shade(
            segment(placed),
            scene.samples,
            samples,
            ratio,
            &mut target.color,
        );
    }
}

#[inline(always)]
fn fill(lanes: &mut Lanes, value: f32, bits: u32) {
    for k in 0..LANES {
        lanes[k] = select(has(bits, k), value, lanes[k]);
    }
}

/// A strand's part of a tile.
pub(super) struct Part {
    /// Its segments in drawing order, among the tile's.
    pub(super) segments: Range<usize>,
    /// No disc of it is nearer than these.
    inv_depth: f32,
    biased: f32,
    /// Rows that it may reach.
    rows: Range<usize>,
    /// Columns that it may reach, a bit for each.
    columns: u32,
}

impl TileContext<'_> {
    /// Replaces `parts` by the strands of a tile, in the order in which they are best drawn.
    #[inline(always)]
    pub(super) fn strands(&self, tile: &[u32], parts: &mut Vec<Part>) {
        let segment = |i: u32| &self.segments[i as usize];
        parts.clear();
        let mut start = 0;
        for strand in tile.chunk_by(|&a, &b| segment(a).strand == segment(b).strand) {
            let mut part = Part {
                segments: start..start + strand.len(),
                inv_depth: f32::NEG_INFINITY,
                biased: f32::NEG_INFINITY,
                rows: segment(strand[0]).rows_in(self.origin[1]),
                columns: 0,
            };
            start = part.segments.end;
            for &index in strand {
                let segment = segment(index);
                part.inv_depth = part.inv_depth.max(segment.inv_depth.range()[1]);
                part.biased = part.biased.max(segment.inv_depth_biased.range()[1]);
                let rows = segment.rows_in(self.origin[1]);
                part.rows = part.rows.start.min(rows.start)..part.rows.end.max(rows.end);
                part.columns |= segment.columns_in(self.origin[0]);
            }
            parts.push(part);
        }
        // What lies behind the nearer ones is then seen to be hidden. Shifted strokes of equal depth
        // need their strands' order.
        if self.order != Order::Shifted {
            parts.sort_by(|a, b| b.inv_depth.total_cmp(&a.inv_depth));
        }
    }

    /// Those of the samples where segments that cover them may show.
    #[inline(always)]
    fn before(&self, placed: &[Placed], samples: &Mask, target: &Target) -> Mask {
        let (mut depth, mut biased) = (f32::NEG_INFINITY, f32::NEG_INFINITY);
        for placed in placed {
            let segment = &self.segments[placed.segment as usize];
            depth = depth.max(segment.inv_depth.range()[1]);
            biased = biased.max(segment.inv_depth_biased.range()[1]);
        }
        target.before(samples, |_| ([depth; LANES], [biased; LANES]))
    }

    /// The samples that the strand may reach where it is not sure, for a whole chunk, to be hidden.
    #[inline(always)]
    fn open(&self, part: &Part, target: &Target) -> Mask {
        let mut open = NO_SAMPLES;
        for sample in 0..self.samples.len() {
            for row in sample * HEIGHT + part.rows.start..sample * HEIGHT + part.rows.end {
                open[row] = part.columns & target.open(row, part.inv_depth, part.biased);
            }
        }
        open
    }
}
