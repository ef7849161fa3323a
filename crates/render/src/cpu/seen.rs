//! Where along a path strokes are needed: not where no picture can show them, not behind a head, and not behind other hair.

use super::cover::{Area, Clump, Cover, Link, Scene, Swath};
use super::tile::lesser;
use crate::drawing::{Brush, Disc, Order};
use crate::frame::{Ball, CLUMP_REACH, Frame, Object, reach_of};
use effects::{Joints, Layer, Reach};
use glam::{Vec2, Vec3};
use rayon::prelude::*;
use std::ops::Range;
use stroke_path::PathRun;

/// A pixel more than the picture makes up for rounding.
const MARGIN_PX: f32 = 1.0;
/// The same against what hair covers, which is thinner there than it is.
const COVER_MARGIN_PX: f32 = 0.125;

/// Sides on which a disc lies wholly: beyond an edge of the picture, or behind a head. What is between two discs of one side, as all
/// discs of a segment are, is there too, since each is convex.
const LEFT: u8 = 1;
const RIGHT: u8 = 2;
const ABOVE: u8 = 4;
const BELOW: u8 = 8;
const HIDDEN: u8 = 16;
/// Not a side: it is deeper than the middle of the head's ball, and so seen nowhere before it.
const DEEP: u8 = 32;

/// Runs that a thread works on at a time, at least.
const SOME_RUNS: usize = 64;

/// Where strokes make a difference: for each joint of a frame whether a stroke's disc there does. Both lists are empty where all do.
///
/// Of a joint that makes none both segments are unseen, with any size of its own, so that with a radius of 0 it makes the same picture.
#[derive(Default)]
pub(super) struct Needed {
    /// Of all strokes, and of the clump.
    pub(super) all: Vec<bool>,
    /// Of strokes that show within their clump alone, and aren't it.
    pub(super) within: Vec<bool>,
}

impl Needed {
    /// As all joints do.
    pub(super) fn clear(&mut self) {
        self.all.clear();
        self.within.clear();
    }

    /// That of a layer's strokes.
    pub(super) fn of(&self, order: Order, layer: &Layer) -> &[bool] {
        match is_within(order, layer) && !layer.program.is_clump() {
            true => &self.within,
            false => &self.all,
        }
    }
}

/// Whether a layer's strokes show within their clump alone, at its depth; made paths have none but their strokes.
fn is_within(order: Order, layer: &Layer) -> bool {
    let is_clipped = layer.rank >= 0 && order != Order::Shifted;
    is_clipped && !layer.program.has_own_paths() && !layer.is_decal()
}

/// Finds where strokes are needed. Keeps its memory.
#[derive(Default)]
pub(super) struct Seen {
    cover: Cover,
    rooms: Vec<Room>,
    /// For each joint whether other hair hides all between it and the next one; empty where nothing is known.
    hidden: Vec<bool>,
}

/// The number of a run, and whether its joints make a difference.
type OfRun<'a> = (usize, &'a mut [bool], &'a mut [bool]);

/// What a thread knows of a run's segments.
#[derive(Default)]
struct Segments {
    /// Of its joints: the sides on which they lie, and how far discs reach.
    sides: Vec<u8>,
    reaches: Vec<ReachPx>,
    /// Whether anything may be seen of each segment, and where its clump lies if that may be.
    seen: Vec<bool>,
    clumps: Vec<Option<Area>>,
    /// Where all of each segment's strokes lie, if only other hair may hide them.
    areas: Vec<Option<Area>>,
}

impl Seen {
    /// Finds where a frame's strokes are needed. `clumps` are the discs of all clumps but made paths'; `samples` are those of each pixel, where
    /// they are known.
    pub(super) fn find(
        &mut self,
        frame: &Frame,
        joints: &Joints,
        (clumps, samples): (&[Disc], &[Vec2]),
        needed: &mut Needed,
    ) {
        let Needed { all, within } = needed;
        all.clear();
        within.clear();
        self.rooms.clear();
        let rooms = (frame.objects.iter()).flat_map(|object| Room::all_of(frame, object));
        self.rooms.extend(rooms);
        let view = View {
            frame,
            joints,
            clumps,
            cover: None,
        };
        let hidden = &mut self.hidden;
        hidden.clear();
        let has_cover = covers(&view, samples, &self.rooms, &mut self.cover, hidden);
        let view = View {
            cover: has_cover.then_some(&self.cover),
            ..view
        };
        all.resize(frame.paths.len(), false);
        within.resize(frame.paths.len(), false);
        let (mut rest, mut rest_within) = (&mut all[..], &mut within[..]);
        let runs = &frame.paths.runs;
        let own = runs.iter().enumerate().map(|(number, run)| {
            let (own, own_within);
            (own, rest) = std::mem::take(&mut rest).split_at_mut(run.joints.len());
            (own_within, rest_within) =
                std::mem::take(&mut rest_within).split_at_mut(run.joints.len());
            (number, own, own_within)
        });
        let own: Vec<OfRun> = own.collect();
        let rooms = &self.rooms;
        own.into_par_iter().with_min_len(SOME_RUNS).for_each_init(
            Segments::default,
            |segments, (number, all, within)| {
                let run = &runs[number];
                let hidden = hidden.get(run.joints.clone()).unwrap_or_default();
                let room = rooms.partition_point(|room| room.joints.end <= run.joints.start);
                let is_of_piece =
                    |other: Option<&PathRun>| other.is_some_and(|other| other.piece == run.piece);
                let before = number.checked_sub(1).and_then(|before| runs.get(before));
                // Samples of a piece show all of its runs as one.
                let is_whole = !is_of_piece(before) && !is_of_piece(runs.get(number + 1));
                let view = View {
                    cover: view.cover.filter(|_| is_whole),
                    ..view
                };
                // Each as if it were seen by itself: no head hides one of several.
                let hides = if is_whole { HIDDEN } else { 0 };
                let links = &hidden[..hidden.len().saturating_sub(1)];
                if is_whole && !links.is_empty() && !links.contains(&false) {
                    return; // nothing of it is seen
                }
                segments.find(&view, &rooms[room], (run, hides, hidden), all, within);
            },
        );
        if !within.contains(&false) {
            all.clear();
            within.clear();
        }
    }
}

impl Segments {
    fn find(
        &mut self,
        view: &View,
        room: &Room,
        (run, hides, hidden): (&PathRun, u8, &[bool]),
        all: &mut [bool],
        within: &mut [bool],
    ) {
        let Self {
            sides,
            reaches,
            seen,
            clumps,
            areas,
        } = self;
        reaches.clear();
        reaches.extend(run.joints.clone().map(|i| room.reach_px(view, i)));
        let joints = run.joints.clone().zip(&*reaches);
        sides.clear();
        let shown_by_itself = HIDDEN & !hides;
        let of_joint =
            |(i, reach): (usize, &ReachPx)| room.sides(view.frame, view.joints, i, reach.all);
        sides.extend(joints.map(|joint| of_joint(joint) & !shown_by_itself));
        // One joint alone is a segment from itself to itself.
        let last = sides.len() - 1;
        let pairs = (0..last.max(1)).map(|k| [k, (k + 1).min(last)]);
        seen.clear();
        clumps.clear();
        areas.clear();
        let centers = &view.frame.paths.center[run.joints.clone()];
        let area = |[a, b]: [usize; 2], reach: fn(&ReachPx) -> f32| {
            let [ra, rb] = [a, b].map(|k| Vec2::splat(reach(&reaches[k]) + COVER_MARGIN_PX));
            Area {
                low: (centers[a] - ra).min(centers[b] - rb),
                high: (centers[a] + ra).max(centers[b] + rb),
            }
        };
        let common = |[a, b]: [usize; 2]| sides[a] & sides[b];
        let on_picture = |ends| common(ends) & !(HIDDEN | DEEP) == 0;
        for ends in pairs.clone() {
            let may_be = common(ends) & !DEEP == 0;
            let Some(cover) = view.cover else {
                seen.push(may_be);
                continue;
            };
            let swath = |reach: fn(&ReachPx) -> f32| {
                let reach_px = ends.map(|k| reach(&reaches[k]));
                room.swath(view, ends.map(|k| run.joints.start + k), reach_px)
            };
            let is_hidden = hidden.get(ends[0]).copied().unwrap_or(false);
            let is_seen = may_be && !is_hidden && !cover.hides(&swath(|reach| reach.all));
            let shows = is_seen && !cover.hides(&swath(|reach| reach.clump));
            let clump = area(ends, |reach| reach.clump);
            let strokes = area(ends, |reach| reach.all);
            seen.push(is_seen);
            clumps.push(shows.then_some(clump));
            areas.push(on_picture(ends).then_some(strokes));
        }
        let is_hidden = |(ends, is_seen): ([usize; 2], &bool)| !is_seen && on_picture(ends);
        if view.cover.is_none() && seen.contains(&true) && pairs.clone().zip(&*seen).any(is_hidden)
        {
            let strokes = |ends| on_picture(ends).then(|| area(ends, |reach| reach.all));
            areas.extend(pairs.clone().map(strokes));
        }
        // What a sample shows of a strand is of all its segments there, also of those that a head or other hair hides by themselves.
        let shown = || {
            let areas = areas.iter().zip(&*seen).enumerate();
            areas.filter_map(|(k, (area, is_seen))| Some((k, area.as_ref().filter(|_| *is_seen)?)))
        };
        let strokes = |k: usize| {
            let ends = [k, (k + 1).min(last)];
            let reach_px = ends.map(|end| reaches[end].all + COVER_MARGIN_PX);
            (ends.map(|end| centers[end]), reach_px[0].max(reach_px[1]))
        };
        for (k, [a, b]) in pairs.clone().enumerate() {
            // What the head hides lies in its ball's shadow, where nothing deep is seen.
            let is_behind_head = common([a, b]) & HIDDEN != 0;
            let lies_over = |hidden: &Area| {
                let mut shown = shown().filter(|(other, area)| {
                    let is_deep = common([*other, (other + 1).min(last)]) & DEEP != 0;
                    !(is_behind_head && is_deep) && area.meets(hidden)
                });
                shown.any(|(other, _)| {
                    let ((own, reach), (others, others_reach)) = (strokes(k), strokes(other));
                    distance(own, others) <= reach + others_reach
                })
            };
            let hidden = areas.get(k).and_then(Option::as_ref);
            let is_needed = seen[k] || hidden.is_some_and(lies_over);
            all[a] |= is_needed;
            all[b] |= is_needed;
        }
        if view.cover.is_none() {
            within.copy_from_slice(all);
            return;
        }
        // Strokes reach over to where the clump of another segment shows.
        let is_shown = clumps.iter().any(Option::is_some);
        for (ends, clump) in pairs.zip(&*clumps).filter(|_| is_shown) {
            let is_needed = clump.is_some() || {
                let area = area(ends, |reach| reach.within);
                clumps.iter().flatten().any(|clump| clump.meets(&area))
            };
            within[ends[0]] |= is_needed;
            within[ends[1]] |= is_needed;
        }
    }
}

/// How far two lines from point to point are from each other.
fn distance(a: [Vec2; 2], b: [Vec2; 2]) -> f32 {
    let to_line = |point: Vec2, [from, to]: [Vec2; 2]| {
        let way = to - from;
        let share = (point - from).dot(way) / way.length_squared().max(f32::MIN_POSITIVE);
        point.distance(from + share.clamp(0.0, 1.0) * way)
    };
    let side = |[from, to]: [Vec2; 2], point: Vec2| (to - from).perp_dot(point - from);
    let crosses = |one, [from, to]: [Vec2; 2]| side(one, from) * side(one, to) < 0.0;
    if crosses(a, b) && crosses(b, a) {
        return 0.0;
    }
    let of_ends = [
        to_line(a[0], b),
        to_line(a[1], b),
        to_line(b[0], a),
        to_line(b[1], a),
    ];
    of_ends.into_iter().fold(f32::INFINITY, lesser)
}

/// How far discs of a joint reach from its place on the screen, pixels.
struct ReachPx {
    all: f32,
    /// Those of strokes that show within their clump alone.
    within: f32,
    /// The clump's.
    clump: f32,
}

/// What is looked at.
#[derive(Clone, Copy)]
struct View<'a> {
    frame: &'a Frame<'a>,
    joints: &'a Joints,
    clumps: &'a [Disc],
    cover: Option<&'a Cover>,
}

/// How many clumps must lie one over the other, on average, for it to be worth while to find out which of them are hidden.
const LEAST_LAYERS: f32 = 32.0;

/// The same where there are so many links of clumps that what is hidden would take long.
const LEAST_OF_MANY: f32 = 8.0;
const MANY: usize = 1 << 16;

/// Whether a layer's strokes are their clumps, so that nothing is seen through them.
fn is_cover(layer: &Layer) -> bool {
    layer.program.is_clump() && layer.rank >= 0 && layer.brush.is_none()
}

/// Clumps that are as wide as this on average, px, are looked at by cells: they cover many wholly.
const WIDE_PX: f32 = 4.0;

/// Fills the cover by hair, where a frame's hair may hide much of itself; and says what is hidden for sure already.
fn covers(
    view: &View,
    samples: &[Vec2],
    rooms: &[Room],
    cover: &mut Cover,
    hidden: &mut Vec<bool>,
) -> bool {
    let View { frame, clumps, .. } = *view;
    let covers = |object: &Object| {
        let mut layers = object.layers.iter().zip(object.layer_joints);
        layers.any(|(layer, drawn)| is_cover(layer) && !drawn.is_empty())
    };
    let is_useless = frame.order == Order::Shifted || !frame.decals.is_empty();
    if is_useless || !frame.objects.iter().any(covers) {
        return false; // each stroke by its own depth, whatever its clump; decals of hidden hair show elsewhere; or there are lines alone
    }
    let size = Vec2::from(frame.camera.size_px().map(|side| side as f32));
    let (mut low, mut high) = (size, Vec2::ZERO);
    let (mut area, mut radii, mut count) = (0.0, 0.0, 0);
    let runs = &frame.paths.runs;
    for run in runs {
        for pair in clumps[run.joints.clone()].windows(2) {
            let center = pair[0].center;
            if center.cmpge(Vec2::ZERO).all() && center.cmple(size).all() {
                (low, high) = (low.min(center), high.max(center));
                let radius = lesser(pair[0].radius, pair[1].radius);
                area += 2.0 * radius * center.distance(pair[1].center);
                radii += radius;
                count += 1;
            }
        }
    }
    let around = (high - low).max(Vec2::ONE);
    let least = match count < MANY {
        true => LEAST_LAYERS,
        false => LEAST_OF_MANY,
    };
    let is_dense = area > least * around.x * around.y;
    if !is_dense {
        return false;
    }
    let edge_depth_m = match frame.order {
        Order::Rounded => frame.edge_depth_m,
        _ => 0.0,
    };
    let is_covered = |object: &Object, run: &PathRun| {
        let strand = &frame.strands[run.strand];
        let layers = object.layers.iter().zip(object.layer_joints).enumerate();
        let mut layers = layers.filter(|(_, (layer, _))| is_cover(layer));
        layers.any(|(number, (_, drawn))| {
            let draws = drawn.start <= run.joints.start && run.joints.end <= drawn.end;
            draws && !strand.is_left_out_by(number)
        })
    };
    let radius_px = radii / count as f32;
    let mut parts = Vec::new();
    let mut of_runs = Vec::new();
    for object in &frame.objects {
        let start = runs.partition_point(|run| run.joints.start < object.joints.start);
        let end = runs.partition_point(|run| run.joints.end <= object.joints.end);
        let own = &runs[start..end.max(start)];
        if radius_px < WIDE_PX && !samples.is_empty() {
            let own = own.iter().filter(|run| is_covered(object, run));
            of_runs.extend(own.map(|run| {
                let ends = usize::from(frame.brush == Brush::Semicircle);
                Clump {
                    first: run.joints.start,
                    discs: &clumps[run.joints.clone()],
                    covering: run.joints.len().saturating_sub(1 + ends),
                }
            }));
        }
        let length = own.len().div_ceil(rayon::current_num_threads());
        for runs in own.chunks(length.max(SOME_RUNS)) {
            let runs = runs.iter().filter(move |run| is_covered(object, run));
            parts.push(runs.flat_map(move |run| {
                // A tip of half discs may be drawn farther on than its clump ends.
                let ends = usize::from(frame.brush == Brush::Semicircle);
                let discs = &clumps[run.joints.start..run.joints.end - ends];
                discs
                    .windows(2)
                    .map(|pair| -> Link { [&pair[0], &pair[1]] })
            }));
        }
    }
    if !of_runs.is_empty() {
        let middle = |clump: &Clump| clump.discs[clump.discs.len() / 2].inv_depth;
        of_runs.sort_by(|a, b| middle(b).total_cmp(&middle(a)));
        let around_px = Vec2::splat(2.0 * WIDE_PX);
        let low = (low - around_px).max(Vec2::ZERO).floor();
        let high = (high + around_px).min(size).ceil();
        let scene = Scene {
            size: frame.camera.size_px(),
            part: [
                low.x as usize..high.x as usize,
                low.y as usize..high.y as usize,
            ],
            surfaces: &frame.surfaces,
            brush: frame.brush,
            edge_depth_m,
            clumps: &of_runs,
        };
        let reaches: Vec<f32> = (rooms.iter())
            .flat_map(|room| room.joints.clone().map(|i| room.reach_px(view, i).all))
            .collect();
        let swath = |i: usize| {
            let room = match rooms {
                [room] => room,
                _ => &rooms[rooms.partition_point(|room| room.joints.end <= i)],
            };
            room.swath(view, [i, i + 1], [reaches[i], reaches[i + 1]])
        };
        hidden.resize(clumps.len(), false);
        if cover.fill_by_samples(samples, &scene, &swath, hidden) {
            return true;
        }
        hidden.clear();
    }
    cover.fill(
        frame.camera.size_px(),
        frame.brush,
        edge_depth_m,
        radius_px,
        parts,
    );
    true
}

/// What strokes on some joints take of the screen around their clumps, and what hides them.
struct Room {
    /// The joints of an object's hair, or of paths that an effect made, up to the next room's.
    joints: Range<usize>,
    reach: RoomAround,
    /// The same of strokes that show within their clump alone, and aren't it.
    within: RoomAround,
    /// How far strokes of which no more is known reach beyond their clump.
    beyond: Vec<Beyond>,
    unit_m: f32,
    /// How much nearer than their clumps strokes may lie among strands, metres.
    nearer_m: f32,
    /// How much nearer than they are decals may be drawn, metres.
    decals_m: f32,
    shadow: Option<Shadow>,
}

/// How far strokes reach from their clumps' middles.
#[derive(Clone, Copy)]
struct RoomAround {
    /// In radii of the clump, and in 1/300 of the head's height.
    clumps: f32,
    units: f32,
    pixels_px: f32,
}

const NOTHING_AROUND: RoomAround = RoomAround {
    clumps: 0.0,
    units: 0.0,
    pixels_px: 0.0,
};

impl RoomAround {
    fn add(&mut self, frame: &Frame, layer: &Layer) {
        let reach = reach_of(layer, frame.brush);
        self.clumps = self.clumps.max(reach.clumps);
        if layer.is_in_pixels() {
            let pixels_px = reach.units * frame.camera.size_px()[1] as f32 / 720.0;
            self.pixels_px = self.pixels_px.max(pixels_px);
        } else {
            self.units = self.units.max(reach.units);
        }
    }
}

/// The lesser of both: a part of the clump's radius, and a width in 1/300 of the head's height and in pixels.
struct Beyond {
    clumps: f32,
    units: f32,
    pixels_px: f32,
}

impl Beyond {
    /// That of a layer's strokes, where it says it.
    fn of(frame: &Frame, layer: &Layer) -> Option<Self> {
        let Reach { clumps, units } = layer.program.beyond()?;
        // Tips of half discs are moved on by what they are wider.
        let times = match frame.brush {
            Brush::Circle => 1.0,
            Brush::Semicircle => 2.0,
        };
        let (units, pixels) = match layer.is_in_pixels() {
            true => (0.0, units),
            false => (units, 0.0),
        };
        Some(Self {
            clumps: times * clumps,
            units: times * units,
            pixels_px: times * pixels * frame.camera.size_px()[1] as f32 / 720.0,
        })
    }

    /// Pixels, of a clump of this radius where a unit is so large.
    fn px(&self, radius: f32, unit_px: f32) -> f32 {
        let width_px = self.units * unit_px + self.pixels_px;
        lesser(self.clumps * radius * unit_px, width_px)
    }
}

impl Room {
    /// Those of an object, by rising joints.
    fn all_of(frame: &Frame, object: &Object) -> Vec<Self> {
        let layers = || object.layers.iter().zip(object.layer_joints);
        let mut made: Vec<&Range<usize>> = layers()
            .filter(|(layer, _)| layer.program.has_own_paths())
            .map(|(_, joints)| joints)
            .collect();
        made.sort_by_key(|joints| joints.start);
        let mut ends: Vec<usize> = made.iter().flat_map(|own| [own.start, own.end]).collect();
        ends.push(object.joints.end);
        let mut start = object.joints.start;
        let mut rooms = Vec::with_capacity(ends.len());
        for end in ends {
            let joints = start..end.max(start);
            start = joints.end;
            if joints.is_empty() {
                continue;
            }
            let own =
                layers().filter(|(_, drawn)| drawn.start < joints.end && joints.start < drawn.end);
            let own = own.map(|(layer, _)| layer);
            rooms.push(Self::of(frame, object, joints.clone(), own));
        }
        rooms
    }

    fn of<'a>(
        frame: &Frame,
        object: &Object,
        joints: Range<usize>,
        layers: impl Iterator<Item = &'a Layer>,
    ) -> Self {
        let clump = RoomAround {
            clumps: CLUMP_REACH.clumps,
            units: CLUMP_REACH.units,
            pixels_px: 0.0,
        };
        let (mut reach, mut within, mut beyond) = (NOTHING_AROUND, clump, Vec::new());
        let (mut nearer, mut decals) = (0.0_f32, 0.0_f32);
        for layer in layers {
            if layer.is_decal() {
                // Of their own depth, which may be moved as far as their place is.
                let moved = layer.program.reach().units / 300.0 + (-layer.depth_offset).max(0.0);
                decals = decals.max(layer.reach + moved);
            }
            if is_within(frame.order, layer) {
                within.add(frame, layer);
                continue;
            }
            nearer = nearer.max(match layer.program.may_be_nearer() {
                true => f32::INFINITY,
                false => -layer.depth_offset,
            });
            match Beyond::of(frame, layer).filter(|_| !layer.is_decal()) {
                Some(own) => beyond.push(own),
                None => reach.add(frame, layer),
            }
        }
        Self {
            joints,
            reach,
            within,
            beyond,
            unit_m: object.head.unit_m(),
            nearer_m: nearer * object.head.height_m,
            decals_m: decals * object.head.height_m,
            shadow: object.solid.and_then(|ball| Shadow::new(frame, ball)),
        }
    }

    fn reach_px(&self, View { frame, joints, .. }: &View, i: usize) -> ReachPx {
        let unit_px = self.unit_m * frame.paths.px_per_metre[i];
        let (radius, shift) = (joints.clump_radius[i], joints.clump_shift[i].length().0);
        let reach = |around: &RoomAround| {
            (shift + around.clumps * radius + around.units) * unit_px + around.pixels_px
        };
        // Where a clump is hardly flat it is one disc, of its radius and as far off as it is shifted.
        let clumps = match shift < 0.19 * radius {
            true => 1.0,
            false => CLUMP_REACH.clumps,
        };
        let clump_px = (shift + clumps * radius) * unit_px;
        let beyond = self.beyond.iter().map(|beyond| beyond.px(radius, unit_px));
        ReachPx {
            all: reach(&self.reach).max(clump_px + beyond.fold(0.0, f32::max)),
            within: reach(&self.within),
            clump: clump_px,
        }
    }

    /// The sides on which all discs of joint `i` lie, which reach so far (px).
    fn sides(&self, frame: &Frame, joints: &Joints, i: usize, reach_px: f32) -> u8 {
        let paths = frame.paths;
        let reach_px = reach_px + MARGIN_PX;
        let (center, size) = (
            paths.center[i],
            frame.camera.size_px().map(|side| side as f32),
        );
        let side = |is_there: bool, side: u8| if is_there { side } else { 0 };
        let nearest_m = paths.depth[i] - joints.clump_radius[i] * self.unit_m - self.decals_m;
        let is_hidden = |shadow: &Shadow| shadow.holds(center, reach_px, nearest_m);
        let is_deep = |shadow: &Shadow| nearest_m >= shadow.depth_m;
        side(center.x < -reach_px, LEFT)
            | side(center.x > size[0] + reach_px, RIGHT)
            | side(center.y < -reach_px, ABOVE)
            | side(center.y > size[1] + reach_px, BELOW)
            | side(self.shadow.as_ref().is_some_and(is_hidden), HIDDEN)
            | side(self.shadow.as_ref().is_some_and(is_deep), DEEP)
    }

    /// What all strokes between two joints may reach that reach so far, px.
    fn swath(&self, view: &View, ends: [usize; 2], reach_px: [f32; 2]) -> Swath {
        let centers = ends.map(|i| view.frame.paths.center[i]);
        let reach_px = reach_px[0].max(reach_px[1]) + COVER_MARGIN_PX;
        Swath::new(centers, reach_px, self.nearness(view, ends))
    }

    /// No disc at two neighbouring joints is nearer, 1/m, and none between them than what runs linearly.
    fn nearness(&self, View { frame, clumps, .. }: &View, ends: [usize; 2]) -> [f32; 2] {
        let nearness = ends.map(|i| clumps[i].inv_depth.max(clumps[i].inv_depth_biased));
        if self.nearer_m <= 0.0 {
            return nearness;
        }
        let nearest_m = nearness.map(|nearness| 1.0 / nearness - self.nearer_m);
        let near_m = frame.camera.near_m();
        // It bulges towards the linear one, but for what is cut off.
        match nearest_m.iter().all(|depth_m| *depth_m >= near_m) {
            true => nearest_m.map(|depth_m| 1.0 / depth_m),
            false => [1.0 / nearest_m[0].min(nearest_m[1]).max(near_m); 2],
        }
    }
}

/// What lies behind a ball, seen from the eye.
struct Shadow {
    middle_px: Vec2,
    focal_px: f32,
    /// Towards the ball's middle, and the cosine and sine of the angle at which the ball is seen around it.
    axis: Vec3,
    cos: f32,
    sin: f32,
    /// Depth of the ball's middle, metres.
    depth_m: f32,
}

impl Shadow {
    /// None of a ball that is behind the eye or around it.
    fn new(frame: &Frame, ball: Ball) -> Option<Self> {
        let camera = frame.camera;
        let view = camera.view_from_world(ball.center);
        let distance = view.length();
        if view.z - ball.radius_m <= camera.near_m() {
            return None;
        }
        let sin = ball.radius_m / distance;
        Some(Self {
            middle_px: 0.5 * Vec2::from(camera.size_px().map(|side| side as f32)),
            focal_px: camera.focal_px(),
            axis: view / distance,
            cos: (1.0 - sin * sin).max(0.0).sqrt(),
            sin,
            depth_m: view.z,
        })
    }

    /// Whether a disc on the screen, whose nearest point has that depth (m), lies wholly in it.
    fn holds(&self, center: Vec2, radius_px: f32, nearest_m: f32) -> bool {
        if nearest_m < self.depth_m {
            return false;
        }
        let at = (center - self.middle_px) / self.focal_px;
        let direction = Vec3::new(at.x, -at.y, 1.0).normalize(); // the screen's y points down
        // The disc is seen at this angle at most; its cosine is 1 at most.
        let angle = radius_px / self.focal_px;
        angle < self.sin && direction.dot(self.axis) >= self.cos + self.sin * angle
    }
}
