//! A drawing's strokes taken apart into segments, in the order in which they are drawn. All get their bounds and nearest depths, by
//! which tiles tell what may be seen there; shapes are worked out for those alone.

use super::bin::{Bins, Bounds, cells};
use super::tile::{greater, lesser};
use crate::drawing::{Disc, Drawing, Order, Run, Stretch};
use glam::{DVec2, Vec2};
use rayon::prelude::*;
use std::ops::Range;
use stroke_path::sweep::{Brush, Circle, Sweep, visible_part};

/// A stroke of each strand. They sort as they lie, low first: by rank, layer, instance.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Stroke {
    pub(super) rank: i32,
    pub(super) layer: usize,
    pub(super) instance: usize,
}

/// A value that runs linearly along a segment.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Ramp {
    /// At u = 0.
    pub(super) start: f32,
    /// At u = 1, less that at 0.
    pub(super) rise: f32,
}

impl Ramp {
    #[inline]
    fn new(start: f32, end: f32) -> Self {
        Self {
            start,
            rise: end - start,
        }
    }

    /// The greatest value that [`at`](Self::at) takes on from 0 to 1.
    #[inline(always)]
    pub(super) fn greatest(&self) -> f32 {
        self.start + greater(self.rise, 0.0)
    }

    #[inline(always)]
    pub(super) fn at(&self, u: f32) -> f32 {
        self.start + u * self.rise
    }
}

/// A piece of a stroke between two joints: what is needed to find the tiles where it may be seen. Its [`Shape`] is worked out there,
/// as many a segment is hidden.
#[derive(Clone, Debug, Default)]
pub(super) struct Segment {
    /// The strand's number.
    pub(super) strand: u32,
    /// 0 for the clump, or 1 more than the place in [`strokes_in_order`].
    pub(super) stroke: u32,
    /// Of a clump's segment: the stroke that is the same discs, and has no segments of its own. 0 if
    /// there is none. The colour is that stroke's.
    pub(super) drawn_as: u32,
    /// The first joint, and where its disc lies in its list, and the colour in the layer's. The other joint's are the next.
    pub(super) joint: u32,
    disc: u32,
    color: u32,
    /// One of the clump's sides.
    is_side: bool,
    /// There is no other joint: a segment from the first to itself.
    is_dot: bool,
    /// All of it lies in the picture.
    is_whole: bool,
    pub(super) bounds: Bounds,
    /// No disc of it is nearer than these.
    pub(super) inv_depth: f32,
    pub(super) biased: f32,
}

/// What tiles ask of a segment before it may be seen, in a list of its own: to look into [`Segment`]s, which lie elsewhere for each band, takes longer than
/// all that is done with it.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Reach {
    /// Its number, from that of some segment on.
    pub(super) segment: u32,
    pub(super) strand: u32,
    pub(super) bounds: Bounds,
    pub(super) inv_depth: f32,
    pub(super) biased: f32,
}

/// What a segment is on the screen; u as in [`Sweep`], from the larger disc to the smaller.
#[derive(Clone, Debug)]
pub(super) struct Shape {
    pub(super) sweep: Sweep,
    pub(super) inv_depth: Ramp,
    pub(super) inv_depth_biased: Ramp,
    pub(super) color: [Ramp; 3],
    /// The way from the first joint to the next: rises where the path runs to the smaller disc.
    pub(super) way: Ramp,
}

/// What strokes are collected.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// Those that are ordered by depth, and the clumps.
    Ordered,
    /// Those that are drawn on what is seen of the others.
    Decals,
}

/// The strokes of that kind that a strand has, lowest first.
pub(super) fn strokes_in_order(drawing: &Drawing, kind: Kind) -> Vec<Stroke> {
    if drawing.clump.is_empty() {
        return Vec::new(); // with no joints any number of instances is legal
    }
    let is_meant = |layer: usize| drawing.decal(layer).is_some() == (kind == Kind::Decals);
    let mut strokes: Vec<Stroke> = drawing
        .layers
        .iter()
        .enumerate()
        .filter(|(layer, _)| is_meant(*layer))
        .flat_map(|(layer, strokes)| {
            (0..strokes.instances).map(move |instance| Stroke {
                rank: strokes.rank,
                layer,
                instance,
            })
        })
        .collect();
    strokes.sort_unstable();
    strokes
}

/// How many strands' segments a thread works out at a time.
const GROUP: usize = 16;

/// The segments of a drawing by strand, then the clump and the strokes from the lowest to the highest. Kept from picture to
/// picture.
#[derive(Default)]
pub(super) struct Segments {
    list: Vec<Segment>,
    groups: Vec<Group>,
}

/// Neighbouring strands.
#[derive(Default)]
struct Group {
    /// Its places in the list: enough for all that it may have. Behind the segments that may be seen come some that
    /// lie in no bounds.
    places: Range<usize>,
    /// Its segments by the bands of the picture that they reach, numbered from the group's first.
    bands: Bins<Reach>,
}

impl Segments {
    /// Takes those of a checked drawing that may be seen in place of what was there, sorted into bands of tiles so many
    /// pixels high. The strokes are all of one kind.
    pub(super) fn collect(
        &mut self,
        drawing: &Drawing,
        strokes: &[Stroke],
        kind: Kind,
        tile_height: usize,
    ) {
        let bands = (drawing.size[1] as usize).div_ceil(tile_height);
        let strands: Vec<&[Run]> = drawing.runs.chunk_by(|a, b| a.strand == b.strand).collect();
        let own = strands.par_chunks(GROUP);
        let own: Vec<Vec<Numbered>> = own.map(|group| on_group(drawing, strokes, group)).collect();
        let strands = strands.into_par_iter().enumerate().with_min_len(GROUP);
        let strands =
            strands.map(|(i, runs)| Strand::new(drawing, strokes, kind, &own[i / GROUP], runs));
        let strands: Vec<Strand> = strands.collect();
        let groups = &mut self.groups;
        groups.resize_with(strands.len().div_ceil(GROUP), Group::default);
        let of_groups = strands.par_chunks(GROUP);
        let counts = of_groups.clone().map(|strands| {
            let counts = strands.iter().map(Strand::most_segments);
            counts.sum::<usize>()
        });
        groups
            .par_iter_mut()
            .zip(counts)
            .for_each(|(group, count)| group.places.end = count);
        let mut end = 0;
        for group in groups.iter_mut() {
            group.places = end..end + group.places.end;
            end = group.places.end;
        }
        self.list.resize(end, Segment::default());
        let mut rest = &mut self.list[..];
        let mut lists = Vec::with_capacity(groups.len());
        for group in groups.iter() {
            let (list, behind) = rest.split_at_mut(group.places.len());
            lists.push(list);
            rest = behind;
        }
        let groups = groups.par_iter_mut().zip(lists).zip(of_groups);
        // One by one, as another thread that has surfaces to sort comes later.
        groups.with_max_len(1).for_each(|((group, list), strands)| {
            let mut number = 0;
            for strand in strands {
                strand.for_each(|segment| {
                    list[number] = segment;
                    number += 1;
                });
            }
            for segment in &mut list[number..] {
                segment.bounds = Bounds::default();
            }
            let reaches = list[..number].iter().zip(0..).map(|(segment, i)| Reach {
                segment: i,
                strand: segment.strand,
                bounds: segment.bounds,
                inv_depth: segment.inv_depth,
                biased: segment.biased,
            });
            let of_bands = reaches.map(|it| (it, cells(it.bounds.y(), tile_height)));
            group.bands.fill(bands, of_bands);
        });
    }

    /// All of them, by number.
    pub(super) fn list(&self) -> &[Segment] {
        &self.list
    }

    /// Those that reach a band, in order: some at a time, with what is to be added to their numbers.
    pub(super) fn of_band(&self, band: usize) -> impl Iterator<Item = (u32, &[Reach])> {
        let groups = self.groups.iter();
        groups.map(move |group| (group.places.start as u32, group.bands.bin(band)))
    }
}

/// A stroke, and 1 more than its place in [`strokes_in_order`].
#[derive(Clone, Copy)]
struct Numbered {
    stroke: Stroke,
    number: u32,
}

/// Those of the layers that draw on any joint of some neighbouring strands. Where there are many objects each has layers of its own:
/// to try them all on each strand would take time by the square of the objects.
fn on_group(drawing: &Drawing, strokes: &[Stroke], strands: &[&[Run]]) -> Vec<Numbered> {
    let (first, last) = (strands[0], strands[strands.len() - 1]);
    let (start, end) = (first[0].joints.start, last[last.len() - 1].joints.end);
    let is_there = |numbered: &Numbered| {
        let joints = &drawing.layers[numbered.stroke.layer].joints;
        joints.start < end && start < joints.end
    };
    let all = strokes.iter().zip(1..);
    let all = all.map(|(&stroke, number)| Numbered { stroke, number });
    all.filter(is_there).collect()
}

/// A strand of a drawing.
struct Strand<'a> {
    drawing: &'a Drawing,
    /// Of the whole drawing.
    strokes: &'a [Stroke],
    /// Those that this strand may have.
    own: &'a [Numbered],
    runs: &'a [Run],
    /// The strokes that are the clump and its sides, disc for disc, and drawn with it.
    base: &'a [Numbered],
    /// Whether its clump has segments.
    has_clump: bool,
}

/// The discs of a stretch.
struct Drawn {
    /// As [`Segment`] has them.
    stroke: u32,
    drawn_as: u32,
    is_side: bool,
    /// The first joint.
    joint: usize,
    /// Their places in their list: the clump's, the sides' or a layer's.
    discs: Range<usize>,
    /// The place of the first one's colour.
    first_color: usize,
}

impl<'a> Strand<'a> {
    fn new(
        drawing: &'a Drawing,
        strokes: &'a [Stroke],
        kind: Kind,
        own: &'a [Numbered],
        runs: &'a [Run],
    ) -> Self {
        let has_clump = drawing.order != Order::Shifted && kind == Kind::Ordered;
        let is_base = |strokes: &&[Numbered]| {
            strokes[0].stroke.rank >= 0 && runs.iter().all(|run| is_clump(drawing, strokes, run))
        };
        let base = match has_clump {
            false => None,
            true => own.windows(clumps(drawing)).find(is_base),
        };
        Self {
            drawing,
            strokes,
            own,
            runs,
            base: base.unwrap_or_default(),
            has_clump,
        }
    }

    /// What is drawn, in order.
    fn parts(&self) -> impl Iterator<Item = Drawn> {
        let Self {
            drawing,
            strokes: _,
            own,
            runs,
            base,
            has_clump,
        } = *self;
        let parts = 0..if has_clump { clumps(drawing) } else { 0 };
        let clump = parts.flat_map(move |part| {
            let of_clump = move |stretch: Stretch, drawn_as, first_color| Drawn {
                stroke: 0,
                drawn_as,
                is_side: part > 0,
                joint: stretch.joints.start,
                discs: stretch.places(),
                first_color,
            };
            let of_base = base.get(part).map(|&Numbered { stroke, number }| {
                let layer = &drawing.layers[stroke.layer];
                (runs.iter())
                    .flat_map(move |run| layer.on(stroke.instance, &run.joints))
                    .filter_map(move |stretch| {
                        let clump = clump_on(drawing, part, &stretch.joints).next()?;
                        Some(of_clump(clump, number, stretch.first))
                    })
            });
            let is_bare = of_base.is_none();
            let bare = runs.iter().filter(move |_| is_bare);
            let bare = bare.flat_map(move |run| clump_on(drawing, part, &run.joints));
            let bare = bare.map(move |stretch| of_clump(stretch, 0, 0));
            of_base.into_iter().flatten().chain(bare)
        });
        let is_base = |number: u32| base.iter().any(|stroke| stroke.number == number);
        let others = own.iter().filter(move |stroke| !is_base(stroke.number));
        let others = others.flat_map(move |&Numbered { stroke, number }| {
            let layer = &drawing.layers[stroke.layer];
            let stretches = runs
                .iter()
                .flat_map(move |run| layer.on(stroke.instance, &run.joints));
            stretches.map(move |stretch| Drawn {
                stroke: number,
                drawn_as: 0,
                is_side: false,
                joint: stretch.joints.start,
                discs: stretch.places(),
                first_color: stretch.first,
            })
        });
        clump.chain(others)
    }

    /// How many segments it has at most.
    fn most_segments(&self) -> usize {
        self.parts().map(|part| (part.discs.len() - 1).max(1)).sum()
    }

    /// Gives each segment that may be seen, in order.
    fn for_each(&self, mut give: impl FnMut(Segment)) {
        let strand = self.runs[0].strand;
        for part in self.parts() {
            let all = discs(self.drawing, self.strokes, part.stroke, part.is_side);
            let own = &all[part.discs.clone()];
            // One joint alone is a segment from itself to itself.
            for i in 0..(own.len() - 1).max(1) {
                let (a, b) = (&own[i], &own[(i + 1).min(own.len() - 1)]);
                if a.radius <= 0.0 && b.radius <= 0.0 {
                    continue;
                }
                if let Some((bounds, is_whole)) = bounds(a, b, self.drawing.size) {
                    give(Segment {
                        strand,
                        stroke: part.stroke,
                        drawn_as: part.drawn_as,
                        joint: (part.joint + i) as u32,
                        disc: (part.discs.start + i) as u32,
                        color: (part.first_color + i) as u32,
                        is_side: part.is_side,
                        is_dot: own.len() == 1,
                        is_whole,
                        bounds,
                        inv_depth: greater(a.inv_depth, b.inv_depth),
                        biased: greater(a.inv_depth_biased, b.inv_depth_biased),
                    });
                }
            }
        }
    }
}

/// The list that holds the discs of a stroke, 0 being the clump or its sides.
#[inline(always)] // into kernels that are compiled for several instruction sets
fn discs<'a>(drawing: &'a Drawing, strokes: &[Stroke], stroke: u32, is_side: bool) -> &'a [Disc] {
    match stroke {
        0 if is_side => &drawing.sides,
        0 => &drawing.clump,
        number => &drawing.layers[strokes[number as usize - 1].layer].discs,
    }
}

/// How many strokes a clump is made of.
fn clumps(drawing: &Drawing) -> usize {
    if drawing.sides.is_empty() { 1 } else { 3 }
}

/// The stretches of a run's clump, part 0, or of one of its sides.
fn clump_on<'a>(
    drawing: &'a Drawing,
    part: usize,
    run: &Range<usize>,
) -> impl Iterator<Item = Stretch> + use<'a> {
    let middle = (part == 0).then(|| Stretch {
        joints: run.clone(),
        first: run.start,
    });
    let sides = (part > 0).then(|| drawing.side_on(part - 1, run));
    middle.into_iter().chain(sides.into_iter().flatten())
}

/// Whether strokes of one layer cover what the clump and its sides cover, disc for disc.
fn is_clump(drawing: &Drawing, strokes: &[Numbered], run: &Run) -> bool {
    let of_layer = strokes[0].stroke.layer;
    let layer = &drawing.layers[of_layer];
    strokes
        .iter()
        .zip(0..)
        .all(|(Numbered { stroke, .. }, part)| {
            let own = layer.on(stroke.instance, &run.joints);
            let own = own.map(|stretch| (stretch.joints.clone(), &layer.discs[stretch.places()]));
            let is_of_one_layer = stroke.layer == of_layer;
            let of_part = if part == 0 {
                &drawing.clump
            } else {
                &drawing.sides
            };
            let clump = clump_on(drawing, part, &run.joints);
            let clump = clump.map(|stretch| (stretch.joints.clone(), &of_part[stretch.places()]));
            is_of_one_layer && is_same(clump, own)
        })
}

/// Whether stretches of joints have the same discs, of which the first ones may go on where they have no size.
fn is_same<'a>(
    mut longer: impl Iterator<Item = (Range<usize>, &'a [Disc])>,
    stretches: impl Iterator<Item = (Range<usize>, &'a [Disc])>,
) -> bool {
    let is_same = |(a, b): (&Disc, &Disc)| a.center == b.center && a.radius == b.radius;
    let is_nothing = |discs: &[Disc]| discs.iter().all(|disc| disc.radius == 0.0);
    let mut rest: (Range<usize>, &[Disc]) = (0..0, &[]);
    for (joints, discs) in stretches {
        while rest.0.end <= joints.start {
            if !is_nothing(rest.1) {
                return false;
            }
            let Some(next) = longer.next() else {
                return false;
            };
            rest = next;
        }
        if joints.start < rest.0.start || rest.0.end < joints.end {
            return false;
        }
        let (before, here) = rest.1.split_at(joints.start - rest.0.start);
        let (here, after) = here.split_at(joints.len());
        if !is_nothing(before) || !here.iter().zip(discs).all(is_same) {
            return false;
        }
        rest = (joints.end..rest.0.end, after);
    }
    is_nothing(rest.1) && longer.all(|(_, discs)| is_nothing(discs))
}

type ColoredDisc = (Disc, [f32; 3]);

/// The part of what lies between two discs that may be seen in a picture of that size, as in [`visible_part`].
#[inline(always)]
fn seen_part(a: &Disc, b: &Disc, size: [u32; 2]) -> Option<[f64; 2]> {
    // A pixel more than the picture makes up for rounding.
    let min = DVec2::splat(-1.0);
    let max = DVec2::new(f64::from(size[0]), f64::from(size[1])) + 1.0;
    visible_part(circle(a), circle(b), min, max)
}

/// The pixels that the segment between two discs may reach, if any, and whether all of it lies in the picture.
#[inline]
fn bounds(a: &Disc, b: &Disc, size: [u32; 2]) -> Option<(Bounds, bool)> {
    let around = |a: &Disc, b: &Disc| {
        let (min_a, min_b) = (a.center - a.radius, b.center - b.radius);
        let (max_a, max_b) = (a.center + a.radius, b.center + b.radius);
        let min = Vec2::new(lesser(min_a.x, min_b.x), lesser(min_a.y, min_b.y));
        let max = Vec2::new(greater(max_a.x, max_b.x), greater(max_a.y, max_b.y));
        (min, max)
    };
    let (mut min, mut max) = around(a, b);
    let [width, height] = size.map(|side| side as f32);
    let is_inside = (min.x >= 0.0) & (min.y >= 0.0) & (max.x <= width) & (max.y <= height);
    if !is_inside {
        let [from, to] = seen_part(a, b, size)?;
        let part = |u| between((*a, [0.0; 3]), (*b, [0.0; 3]), u).0;
        (min, max) = around(&part(from), &part(to));
    }
    Some((Bounds::of_box(min, max, size)?, is_inside))
}

impl Segment {
    /// Its joints, from the root's side on.
    pub(super) fn joints(&self) -> [usize; 2] {
        let first = self.joint as usize;
        [first, first + usize::from(!self.is_dot)]
    }

    /// Its radii at these, px.
    #[inline(always)]
    pub(super) fn radii(&self, drawing: &Drawing, strokes: &[Stroke]) -> [f32; 2] {
        let discs = discs(drawing, strokes, self.stroke, self.is_side);
        let first = self.disc as usize;
        [first, first + usize::from(!self.is_dot)].map(|disc| discs[disc].radius)
    }

    /// 1 more than the place of the stroke whose colour it has, in [`strokes_in_order`]; 0 where it has none.
    #[inline(always)]
    pub(super) fn colored(&self) -> u32 {
        if self.stroke > 0 {
            self.stroke
        } else {
            self.drawn_as
        }
    }

    /// Its shape, as far as it may be seen.
    #[inline(always)]
    pub(super) fn shape(&self, drawing: &Drawing, strokes: &[Stroke]) -> Option<Shape> {
        let discs = discs(drawing, strokes, self.stroke, self.is_side);
        let first = self.disc as usize;
        let next = usize::from(!self.is_dot);
        let mut colors = [[0.0; 3]; 2];
        let colored = self.colored();
        if colored > 0 {
            let layer = &drawing.layers[strokes[colored as usize - 1].layer];
            let first = self.color as usize;
            colors = [layer.colors[first], layer.colors[first + next]];
        }
        let (a, b) = ((discs[first], colors[0]), (discs[first + next], colors[1]));
        if self.is_whole {
            return Shape::new(a, b, [0.0, 1.0], drawing.brush);
        }
        Shape::seen(a, b, drawing.size, drawing.brush)
    }
}

impl Shape {
    /// The part of the segment between two joints that may be seen in a picture of that size, if any.
    #[inline(always)]
    fn seen(a: ColoredDisc, b: ColoredDisc, size: [u32; 2], brush: Brush) -> Option<Self> {
        let [from, to] = seen_part(&a.0, &b.0, size)?;
        Self::new(between(a, b, from), between(a, b, to), [from, to], brush)
    }

    /// That between two discs, which lie so far on the way from one joint to the other.
    #[inline(always)]
    fn new(a: ColoredDisc, b: ColoredDisc, [from, to]: [f64; 2], brush: Brush) -> Option<Self> {
        let shrinks = a.0.radius >= b.0.radius;
        let (large, small) = if shrinks { (a, b) } else { (b, a) };
        let way = if shrinks { [from, to] } else { [to, from] };
        let sweep = Sweep::new(circle(&large.0), circle(&small.0))?;
        let sweep = match brush {
            Brush::Circle => sweep,
            Brush::Semicircle => sweep.with_semicircles(shrinks),
        };
        Some(Self {
            sweep,
            inv_depth: Ramp::new(large.0.inv_depth, small.0.inv_depth),
            inv_depth_biased: Ramp::new(large.0.inv_depth_biased, small.0.inv_depth_biased),
            color: [
                Ramp::new(large.1[0], small.1[0]),
                Ramp::new(large.1[1], small.1[1]),
                Ramp::new(large.1[2], small.1[2]),
            ],
            way: Ramp::new(way[0] as f32, way[1] as f32),
        })
    }

    pub(super) fn is_one_color(&self) -> bool {
        self.color.iter().all(|channel| channel.rise == 0.0)
    }
}

#[inline]
fn circle(disc: &Disc) -> Circle {
    Circle {
        center: disc.center.as_dvec2(),
        radius: f64::from(disc.radius),
    }
}

/// What runs linearly between two joints, at `u` of the way. The ends stay bit for bit.
fn between(a: ColoredDisc, b: ColoredDisc, u: f64) -> ColoredDisc {
    if u == 0.0 {
        return a;
    }
    if u == 1.0 {
        return b;
    }
    let mix = |a: f32, b: f32| (f64::from(a) + u * (f64::from(b) - f64::from(a))) as f32;
    let disc = Disc {
        center: (a.0.center.as_dvec2().lerp(b.0.center.as_dvec2(), u)).as_vec2(),
        radius: mix(a.0.radius, b.0.radius).max(0.0),
        inv_depth: mix(a.0.inv_depth, b.0.inv_depth),
        inv_depth_biased: mix(a.0.inv_depth_biased, b.0.inv_depth_biased),
    };
    (disc, [0, 1, 2].map(|i| mix(a.1[i], b.1[i])))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn disc(x: f32, radius: f32, inv_depth: f32) -> Disc {
        Disc {
            center: Vec2::new(x, 5.0),
            radius,
            inv_depth,
            inv_depth_biased: inv_depth + 1.0,
        }
    }

    #[test]
    fn a_far_segment_keeps_its_depth_and_color_where_it_is_seen() {
        let far = 1e6;
        let a = (disc(-far, 1.0, 1.0), [0.0, 0.5, 1.0]);
        let b = (disc(far, 3.0, 3.0), [1.0, 0.5, 0.0]);
        let segment = Shape::seen(a, b, [10, 10], Brush::Circle).unwrap();
        // The middle of the screen is the middle of the segment.
        let local = segment.sweep.local(DVec2::new(5.0, 5.0)).as_vec2();
        assert!(segment.sweep.covers(local.x, local.y));
        let (u, ratio) = segment.sweep.attribute_point(local.x, local.y);
        assert!(ratio < 1e-6);
        assert!((segment.inv_depth.at(u) - 2.0).abs() < 1e-4);
        assert!((segment.inv_depth_biased.at(u) - 3.0).abs() < 1e-4);
        assert!((segment.color[0].at(u) - 0.5).abs() < 1e-4);
        let across = segment.sweep.local(DVec2::new(5.0, 6.95)).as_vec2();
        assert!(segment.sweep.covers(across.x, across.y));
        let outside = segment.sweep.local(DVec2::new(5.0, 7.05)).as_vec2();
        assert!(!segment.sweep.covers(outside.x, outside.y));
    }

    #[test]
    fn what_is_not_seen_is_left_out() {
        let new = |a, b| {
            let shape = Shape::seen((a, [0.0; 3]), (b, [0.0; 3]), [10, 10], Brush::Circle);
            shape.and_then(|_| bounds(&a, &b, [10, 10]))
        };
        assert!(new(disc(20.0, 1.0, 1.0), disc(30.0, 1.0, 1.0)).is_none());
        assert!(new(disc(1.0, 0.0, 1.0), disc(9.0, 0.0, 1.0)).is_none());
        assert!(new(disc(1.0, 0.0, 1.0), disc(9.0, 0.1, 1.0)).is_some());
    }
}
