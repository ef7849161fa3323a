//! Hair that lies so densely that it hides much of itself: whether it does, and its cover.

use super::super::cover::{Clump, Cover, Link, Scene};
use super::super::tile::lesser;
use super::room::Room;
use super::{SOME_RUNS, View};
use crate::drawing::{Brush, Order};
use crate::frame::Object;
use effects::Layer;
use glam::Vec2;
use stroke_path::PathRun;

/// How many clumps must lie one over the other, on average, for it to be worth while to find out which of them are hidden.
const LEAST_LAYERS: f32 = 32.0;

/// The same where there are so many links of clumps that what is hidden would take long.
const LEAST_OF_MANY: f32 = 18.0;
const MANY: usize = 1 << 16;

/// To put a link into the cover by samples takes as long as it covers samples, and spares no more than its strokes take: it may cover so many for each of these.
const MOST_SAMPLES: f32 = 12.0;

/// Whether a layer's strokes are their clumps, so that nothing is seen through them.
fn is_cover(layer: &Layer) -> bool {
    layer.program.is_clump() && layer.rank >= 0 && layer.brush.is_none()
}

/// Clumps that are as wide as this on average, px, are looked at by cells: they cover many wholly.
const WIDE_PX: f32 = 4.0;

/// Fills the cover by hair, where a frame's hair may hide much of itself; and says what is hidden for sure already.
pub(super) fn covers(
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
    let radius_px = radii / count as f32;
    let is_by_samples = radius_px < WIDE_PX && !samples.is_empty();
    let strokes = |object: &Object| -> u32 {
        let layers = object.layers.iter();
        layers.map(|layer| layer.program.instances()).sum()
    };
    let strokes = frame.objects.iter().map(strokes).max().unwrap_or(0);
    let most = MOST_SAMPLES * strokes as f32 * count as f32;
    let is_worth_it = !is_by_samples || area * samples.len() as f32 <= most;
    if !(is_dense && is_worth_it) {
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
    let mut parts = Vec::new();
    let mut of_runs = Vec::new();
    for object in &frame.objects {
        let start = runs.partition_point(|run| run.joints.start < object.joints.start);
        let end = runs.partition_point(|run| run.joints.end <= object.joints.end);
        let own = &runs[start..end.max(start)];
        if is_by_samples {
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
