//! Which segments of one run make a difference.

use super::super::cover::Area;
use super::super::tile::lesser;
use super::View;
use super::room::{COVER_MARGIN_PX, DEEP, HIDDEN, ReachPx, Room};
use glam::Vec2;
use stroke_path::PathRun;

/// What a thread knows of a run's segments.
#[derive(Default)]
pub(super) struct Segments {
    /// Of its joints: the sides on which they lie, and how far discs reach.
    sides: Vec<u8>,
    reaches: Vec<ReachPx>,
    /// Whether anything may be seen of each segment, and where its clump lies if that may be.
    seen: Vec<bool>,
    clumps: Vec<Option<Area>>,
    /// Where all of each segment's strokes lie, if only other hair may hide them.
    areas: Vec<Option<Area>>,
}

impl Segments {
    pub(super) fn find(
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
            |(i, reach): (usize, &ReachPx)| room.sides(view.frame, view.joints, i, reach);
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
